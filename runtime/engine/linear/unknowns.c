/* Dofs and unknowns: dofs = T unknowns, each row of T empty, a single one, or a combination. */
#include "engine.h"

typedef struct {
    int n;
    const int *unknown;
    const double *value;
} row;

static row row_of(const fu_model *model, const int *unknown)
{
    static const double one = 1.0;
    if (*unknown >= 0) return (row){1, unknown, &one};
    if (*unknown == -1) return (row){0, 0, 0};
    const int *start = model->combination_start - 2 - *unknown;
    return (row){start[1] - start[0], model->combination_unknown + start[0], model->combination_value + start[0]};
}

/* Computes x = T' force, over the band and the border's dofs. */
void fu_gather(const fu_model *model, const double *force, double *x)
{
    for (int i = 0; i < model->n_band + model->n_border_dof; ++i) x[i] = 0.0;
    for (int i = 0; i < model->n_dof; ++i) {
        const int unknown = model->unknown_of_dof[i];
        if (unknown >= 0) x[unknown] += force[i];
        else if (unknown < -1) {
            const row r = row_of(model, &unknown);
            for (int k = 0; k < r.n; ++k) x[r.unknown[k]] += r.value[k] * force[i];
        }
    }
}

/* Computes dofs = T x. */
void fu_spread(const fu_model *model, const double *x, double *dofs)
{
    for (int i = 0; i < model->n_dof; ++i) {
        const int unknown = model->unknown_of_dof[i];
        dofs[i] = unknown >= 0 ? x[unknown] : 0.0;
        if (unknown < -1) {
            const row r = row_of(model, &unknown);
            for (int k = 0; k < r.n; ++k) dofs[i] += r.value[k] * x[r.unknown[k]];
        }
    }
}

/* Returns the number that `fu_add` takes for the k-th unknown beyond the dofs. */
int fu_extra(const fu_model *model, int k)
{
    return model->n_dof + k;
}

static void touch(fu_span *span, int row)
{
    if (row < span->first) span->first = row;
    if (row >= span->end) span->end = row + 1;
}

/* Adds a value to the system at these numbers of unknowns. */
static void add(fu_system *s, int row, int column, double value)
{
    const int n = s->n;
    if (row < 0 || column < 0) return; /* a fixed dof */
    if (row < n && column < n)
        s->K[(long)column * (3 * s->width + 1) + 2 * s->width + row - column] += value;
    else if (row < n) {
        s->B[(long)(column - n) * n + row] += value;
        touch(&s->span_B[(column - n) * 2 * s->n_chains + s->half[row]], row);
    } else if (column < n) {
        s->C[(long)(row - n) * n + column] += value;
        touch(&s->span_C[(row - n) * 2 * s->n_chains + s->half[column]], column);
    } else
        s->D[(long)(column - n) * s->m + row - n] += value;
}

/* Adds a value at dofs (or extra unknowns) i, j to the system, T' value T; does nothing where the system is null. */
void fu_add(const fu_model *model, fu_system *system, int i, int j, double value)
{
    if (!system) return;
    const int beyond = model->n_band + model->n_border_dof - model->n_dof;
    const int unknown_i = i < model->n_dof ? model->unknown_of_dof[i] : beyond + i;
    const int unknown_j = j < model->n_dof ? model->unknown_of_dof[j] : beyond + j;
    if (unknown_i >= -1 && unknown_j >= -1) {
        add(system, unknown_i, unknown_j, value);
        return;
    }
    const row a = row_of(model, &unknown_i), b = row_of(model, &unknown_j);
    for (int k = 0; k < a.n; ++k)
        for (int m = 0; m < b.n; ++m)
            add(system, a.unknown[k], b.unknown[m], value * a.value[k] * b.value[m]);
}

/* Returns the largest of what the dofs move points by, as a length; a NaN where one is. */
double fu_size(const fu_model *model, const double *dofs)
{
    const double *weight = model->weight;
    double largest[4] = {0.0}, check = 0.0; /* maxima that do not wait for each other, and do not see a NaN */
    int i = 0;
    for (; i + 4 <= model->n_dof; i += 4)
        for (int k = 0; k < 4; ++k) {
            const double size = fabs(dofs[i + k]) * weight[i + k];
            largest[k] = size > largest[k] ? size : largest[k];
            check += 0.0 * size;
        }
    for (; i < model->n_dof; ++i) {
        const double size = fabs(dofs[i]) * weight[i];
        largest[0] = size > largest[0] ? size : largest[0];
        check += 0.0 * size;
    }
    return check + fmax(fmax(largest[0], largest[1]), fmax(largest[2], largest[3]));
}
