/* What a fluid does at a place of a cable or of a body: drag and lift by the velocity past it (derive/couplings/drag.py), with their
 * derivatives. */
#include "engine.h"

#include <math.h>

static void add_to(int n, const double *x, double *sum)
{
    for (int i = 0; i < n; ++i) sum[i] += x[i];
}

/* Makes a x b; in the plane b turned by a quarter times a[0]. */
static void cross(int dim, const double *a, const double *b, double out[3])
{
    if (dim == 2) {
        out[0] = -a[0] * b[1];
        out[1] = a[0] * b[0];
        return;
    }
    fu_cross(a, b, out);
}

/* Makes coefficients of drag and lift, each with its derivative by the angle of attack, of the flow w past axes by rows of A. */
static void coefficients_of(int dim, const fu_drag *drag, const double *chord, const double *span, const double *w,
                            double coefficients[4])
{
    coefficients[0] = coefficients[1] = coefficients[3] = 0.0;
    coefficients[2] = drag->foil_lift;
    if (!drag->n_angles) return;
    double normal[3];
    cross(dim, span, chord, normal);
    const double angle = atan2(fu_dot(dim, w, normal), fu_dot(dim, w, chord));
    const fu_signal of_drag = {drag->n_angles, drag->angles, drag->polar_drag, 0.0, 0.0, 0.0};
    const fu_signal of_lift = {drag->n_angles, drag->angles, drag->polar_lift, 0.0, 0.0, 0.0};
    coefficients[0] = fu_signal_at(&of_drag, angle, &coefficients[1], 0);
    coefficients[2] = fu_signal_at(&of_lift, angle, &coefficients[3], 0);
}

/* Adds drag and lift on a body with a span, of axes A. */
static void add_foil(int dim, const fu_drag *drag, const double *A, fu_drag_action *out)
{
    const int turns = dim == 3 ? 3 : 1;
    double span[3] = {drag->span[0]}, chord[3], coefficients[4], f[3], by_w[9];
    for (int d = 0; d < dim; ++d) {
        chord[d] = fu_dot(dim, A + d * dim, drag->chord);
        if (dim == 3) span[d] = fu_dot(dim, A + d * dim, drag->span);
    }
    coefficients_of(dim, drag, chord, span, out->w, coefficients);
    drag->kernel->on_foil(out->w, span, drag->foil, coefficients, f, by_w);
    add_to(dim, f, out->f);
    add_to(dim * dim, by_w, out->by_w);
    for (int k = 0; k < turns; ++k) { /* by a turn of the body, as if the flow had turned back */
        const double axis[3] = {k == 0, k == 1, k == 2};
        double turned[3], flow[3];
        cross(dim, axis, f, turned);
        cross(dim, axis, out->w, flow);
        for (int d = 0; d < dim; ++d) out->by_turn[d * turns + k] = turned[d] - fu_dot(dim, by_w + d * dim, flow);
    }
}

static void add_lift(const fu_drag *drag, const fu_drag_place *at, fu_drag_action *out)
{
    double f[3], by_slope[9], by_w[9];
    drag->kernel->lift_along_cable(at->r_x, out->w, drag->lift, f, by_slope, by_w);
    add_to(3, f, out->f);
    add_to(9, by_slope, out->by_slope);
    add_to(9, by_w, out->by_w);
}

void fu_drag_act(const fu_model *model, const fu_drag *drag, double t, const fu_drag_place *at, const double *A, fu_drag_action *out)
{
    fu_flow_at(model, &drag->flow, t, at->r, &out->flow);
    for (int d = 0; d < model->dim; ++d) out->w[d] = out->flow.U[d] - at->v[d];
    if (drag->cable >= 0)
        drag->kernel->along_cable(at->r_x, out->w, drag->coefficients, out->f, out->by_slope, out->by_w);
    else
        drag->kernel->on_point(out->w, drag->coefficients, out->f, out->by_w);
    if (drag->lift[0] != 0.0) add_lift(drag, at, out);
    if (drag->is_foil) add_foil(model->dim, drag, A, out);
}
