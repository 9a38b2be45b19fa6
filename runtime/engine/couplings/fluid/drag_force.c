/* Forces of a fluid at a point of a span of a rope or of a body: drag and lift by the relative velocity
 * (derive/couplings/drag.py), with their derivatives. */
#include "bodies/model.h"
#include "couplings/fluid/drag.h"

#include <math.h>
#include <string.h>

static void add_to(int n, const double *x, double *sum)
{
    for (int i = 0; i < n; ++i) sum[i] += x[i];
}

/* Computes a x b; in the plane a[0] times b rotated by a right angle. */
static void cross(int dim, const double *a, const double *b, double out[3])
{
    if (dim == 2) {
        out[0] = -a[0] * b[1];
        out[1] = a[0] * b[0];
        return;
    }
    fu_cross(a, b, out);
}

void fu_drag_polar(int dim, const fu_drag *drag, const double *chord, const double *span, const double *w, int n,
                   double *coefficients)
{
    const double *of[3] = {drag->polar_drag, drag->polar_lift, drag->polar_moment};
    memset(coefficients, 0, sizeof(double) * 2 * (size_t)n);
    coefficients[2] = drag->foil_lift;
    if (!drag->n_angles) return;
    double normal[3];
    cross(dim, span, chord, normal);
    const double angle = atan2(fu_dot(dim, w, normal), fu_dot(dim, w, chord));
    for (int k = 0; k < n; ++k) {
        const fu_signal polar = {drag->n_angles, drag->angles, of[k], 0.0, 0.0, 0.0};
        coefficients[2 * k] = fu_signal_at(&polar, angle, &coefficients[2 * k + 1], 0);
    }
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
    fu_drag_polar(dim, drag, chord, span, out->w, 2, coefficients);
    drag->kernel->on_foil(out->w, span, drag->foil, coefficients, f, by_w);
    add_to(dim, f, out->f);
    add_to(dim * dim, by_w, out->by_w);
    for (int k = 0; k < turns; ++k) { /* a rotation of the body is the opposite rotation of the flow */
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

static void scale(int n, double by, double *x)
{
    for (int i = 0; i < n; ++i) x[i] *= by;
}

/* Multiplies the forces of full wetting by the wet part, and computes their derivative by position through it. */
static void take_wet_part(int dim, const fu_wetness *wet, fu_drag_action *out)
{
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
            out->by_wet[i * dim + j] = (out->f[i] + out->buoyancy[i]) * wet->slope * wet->up[j];
    scale(3, wet->part, out->f);
    scale(3, wet->part, out->buoyancy);
    scale(9, wet->part, out->by_slope);
    scale(9, wet->part, out->by_w);
    scale(9, wet->part, out->by_turn);
}

void fu_drag_act(const fu_model *model, const fu_drag *drag, double t, const fu_drag_place *at, const double *A,
                 fu_drag_action *out)
{
    fu_wetness wet;
    fu_fluid_at(model, drag, t, at->r, &out->flow, drag->wet == FU_ALL_WET ? 0 : &wet);
    for (int d = 0; d < model->dim; ++d) out->w[d] = out->flow.U[d] - at->v[d];
    if (drag->on.kernel)
        drag->kernel->along_cable(at->r_x, out->w, drag->coefficients, out->f, out->by_slope, out->by_w);
    else drag->kernel->on_point(out->w, drag->coefficients, out->f, out->by_w);
    if (drag->lift[0] != 0.0) add_lift(drag, at, out);
    if (drag->is_foil) add_foil(model->dim, drag, A, out);
    memcpy(out->buoyancy, drag->buoyancy, sizeof out->buoyancy);
    if (drag->wet == FU_ALL_WET) memset(out->by_wet, 0, sizeof out->by_wet);
    else take_wet_part(model->dim, &wet, out);
}

void fu_drag_by_place(int dim, const fu_drag_action *a, double out[9])
{
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) {
            out[i * dim + j] = a->by_wet[i * dim + j];
            for (int k = 0; k < dim; ++k) out[i * dim + j] += a->by_w[i * dim + k] * a->flow.gradient[k * dim + j];
        }
}

void fu_drag_whole_force(const fu_model *model, const fu_drag_action *a, double force[3])
{
    for (int d = 0; d < model->dim; ++d) force[d] = model->load_fraction * (a->f[d] + a->buoyancy[d]);
}

void fu_drag_add_powers(const fu_model *model, const fu_drag_place *at, const fu_drag_action *a, double weight,
                        fu_drag_powers *sum)
{
    const double part = weight * model->load_fraction;
    sum->dissipated += part * fu_dot(model->dim, a->f, a->w);
    sum->external += part * (fu_dot(model->dim, a->f, a->flow.U) + fu_dot(model->dim, a->buoyancy, at->v));
}
