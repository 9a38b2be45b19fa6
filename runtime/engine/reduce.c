/* Dofs and unknowns: dofs = T unknowns, each row of T empty, a single one, or a combination. */
#include "engine.h"

typedef struct {
    int n;
    const int *place;
    const double *value;
} row;

static row row_of(const fu_model *model, const int *place)
{
    static const double one = 1.0;
    if (*place >= 0) return (row){1, place, &one};
    if (*place == -1) return (row){0, 0, 0};
    const int *start = model->combination_start - 2 - *place;
    return (row){start[1] - start[0], model->combination_place + start[0], model->combination_value + start[0]};
}

/* x = T' force, over the band and the bodies */
void fu_gather(const fu_model *model, const double *force, double *x)
{
    for (int i = 0; i < model->n_band + model->n_border_dof; ++i) x[i] = 0.0;
    for (int i = 0; i < model->n_dof; ++i) {
        const int place = model->place[i];
        if (place >= 0) x[place] += force[i];
        else if (place < -1) {
            const row r = row_of(model, &place);
            for (int k = 0; k < r.n; ++k) x[r.place[k]] += r.value[k] * force[i];
        }
    }
}

/* dofs = T x */
void fu_spread(const fu_model *model, const double *x, double *dofs)
{
    for (int i = 0; i < model->n_dof; ++i) {
        const int place = model->place[i];
        dofs[i] = place >= 0 ? x[place] : 0.0;
        if (place < -1) {
            const row r = row_of(model, &place);
            for (int k = 0; k < r.n; ++k) dofs[i] += r.value[k] * x[r.place[k]];
        }
    }
}

/* Number under which `fu_add` knows the k-th unknown beyond the dofs. */
int fu_extra(const fu_model *model, int k)
{
    return model->n_dof + k;
}

/* system += value at dofs (or extra unknowns) i, j: T' value T */
void fu_add(const fu_model *model, fu_system *system, int i, int j, double value)
{
    const int beyond = model->n_band + model->n_border_dof - model->n_dof;
    const int place_i = i < model->n_dof ? model->place[i] : beyond + i;
    const int place_j = j < model->n_dof ? model->place[j] : beyond + j;
    if (place_i >= -1 && place_j >= -1) {
        fu_system_add(system, place_i, place_j, value);
        return;
    }
    const row a = row_of(model, &place_i), b = row_of(model, &place_j);
    for (int k = 0; k < a.n; ++k)
        for (int m = 0; m < b.n; ++m)
            fu_system_add(system, a.place[k], b.place[m], value * a.value[k] * b.value[m]);
}

/* largest of what the dofs move points by, as a length; a NaN where one is */
double fu_size(const fu_model *model, const double *dofs)
{
    double largest = 0.0;
    for (int i = 0; i < model->n_dof; ++i) {
        const double size = fabs(dofs[i]) * model->weight[i];
        if (!(size <= largest)) largest = size;
    }
    return largest;
}
