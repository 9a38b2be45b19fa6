/* A distributed force on the material of a rope in a span (derive/couplings/span_force.py). The loaded part of an
 * element ends at a node or at a material point, so that it changes with the material coordinates. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/force/force.h"

#include <string.h>

enum { ENDS = FU_SPAN_ENDS, LOCAL = FU_SPAN_LOCAL, POINTS = 2 };

/* Gauss's rule on [0, 1] that is exact for cubic elements. */
static const double PLACES[POINTS] = {0.21132486540518713, 0.7886751345948129}, WEIGHT = 0.5;

static const fu_line_load *load_of(const fu_coupling *coupling)
{
    return (const fu_line_load *)coupling;
}

/* Computes the force of a length, N/m. */
static void force_of_length(const fu_model *model, const fu_line_load *load, double t, double F[3])
{
    const double scale = fu_scale_at(model, load->signal, t) * model->load_fraction;
    for (int d = 0; d < 3; ++d) F[d] = scale * load->value[d];
}

/* The loaded part of an element: shares of its ends, and their derivatives by the material coordinates of the element's
 * ends, zero at a node. */
typedef struct {
    double share[ENDS], by_s[ENDS][ENDS];
} loaded_part;

/* Computes the loaded part; returns zero for none. */
static int part_of(const fu_line_load *load, const fu_span_element *it, loaded_part *out)
{
    memset(out, 0, sizeof *out);
    out->share[1] = 1.0;
    for (int i = 0; i < ENDS; ++i) {
        const double at = load->between[i];
        if (i ? at >= it->s[1] : at <= it->s[0]) continue;
        load->on.kernel->share(at, it->s, &out->share[i], out->by_s[i]);
    }
    return out->share[0] < out->share[1];
}

static void force(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double *f)
{
    const fu_line_load *load = load_of(coupling);
    double F[3], of_e[FU_MAX_COORDINATES], of_ends[ENDS];
    loaded_part part;
    force_of_length(model, load, t, F);
    for (int d = 0; d < 3; ++d) F[d] = -F[d];
    for (int k = 0; k < load->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &load->on, k, q, 0, 0);
        if (!part_of(load, &it, &part)) continue;
        const double length = part.share[1] - part.share[0];
        for (int g = 0; g < POINTS; ++g) {
            load->on.kernel->line_force(WEIGHT * length, it.l, it.e, part.share[0] + length * PLACES[g], F, of_e,
                                        of_ends);
            fu_add_span_force(&load->on, &it, of_e, of_ends, 0.0, f);
        }
    }
}

/* Adds the derivatives of the forces on an element by the ends of its loaded part. */
static void add_by_ends(const fu_line_load *load, const fu_span_element *it, const loaded_part *part, const double *F,
                        double stiffness, double (*local)[LOCAL])
{
    const int n = load->on.kernel->coordinates;
    double of_all[LOCAL];
    for (int i = 0; i < ENDS; ++i) {
        if (part->by_s[i][0] == 0.0 && part->by_s[i][1] == 0.0) continue;
        load->on.kernel->line_force(1.0, it->l, it->e, part->share[i], F, of_all, of_all + n);
        for (int row = 0; row < n + ENDS; ++row)
            for (int j = 0; j < ENDS; ++j)
                local[row][n + j] += (i ? stiffness : -stiffness) * of_all[row] * part->by_s[i][j];
    }
}

/* Subtracts stiffness times the derivatives of the load from a system. */
static void matrix(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double stiffness,
                   fu_system *system)
{
    const fu_line_load *load = load_of(coupling);
    const int n = load->on.kernel->coordinates, all = n + ENDS;
    const double none[9] = {0.0};
    double F[3], D[LOCAL * LOCAL], K[LOCAL * LOCAL], local[LOCAL][LOCAL];
    loaded_part part;
    force_of_length(model, load, state->t, F);
    for (int k = 0; k < load->on.n_elements; ++k) {
        const fu_span_element it = fu_span_element_at(model, &load->on, k, state->q, 0, 0);
        if (!part_of(load, &it, &part)) continue;
        const double length = part.share[1] - part.share[0];
        memset(local, 0, sizeof local);
        for (int g = 0; g < POINTS; ++g) {
            load->on.kernel->line_force_tangent(WEIGHT * length, it.l, it.e, it.v, it.s_rate,
                                                part.share[0] + length * PLACES[g], F, none, none, none, D, K);
            fu_add_by_length(all, n, -stiffness, K, local);
        }
        add_by_ends(load, &it, &part, F, -stiffness, local);
        fu_add_span_matrix(model, &load->on, &it, local, system);
    }
}

static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    matrix(model, coupling, at->next, at->weights.stiffness, system);
}

/* The middle moves by half of psi, which is in weights.stiffness. */
static void step_tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *at, fu_system *system)
{
    matrix(model, coupling, at->middle, at->weights.stiffness, system);
}

static const fu_field fields[] = {
    FU_SPAN_FIELDS(fu_line_load, on),
    FU_FIELD(fu_line_load, signal, FU_INTEGER, 0),
    FU_FIELD_ARRAY(fu_line_load, value, FU_REAL),
    FU_FIELD_ARRAY(fu_line_load, between, FU_REAL),
    {0},
};

static const fu_supply_operations supply = {.force = force};
const fu_coupling_type fu_line_load_type = {.name = "line load",
                                            .size = sizeof(fu_line_load),
                                            .fields = fields,
                                            .supply = &supply,
                                            .tangent = tangent,
                                            .step_tangent = step_tangent};
