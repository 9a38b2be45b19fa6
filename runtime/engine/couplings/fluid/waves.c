/* Linear waves at blocks of points (derive/couplings/waves.py): elevation of the surface, and velocity of the fluid.
 * Cosine and sine of the phase of each wave at a point are computed once for both. Frequencies are those at a fixed
 * place: a current does not change the length of the waves. */
#include "bodies/model.h"
#include "couplings/common/point_functions.h"
#include "couplings/fluid/drag.h"

#include <math.h>

#define MAX_DECAY 40.0     /* exponent of depth beyond which a wave moves nothing, exp(-40) = 4e-18 */
#define MAX_EXPONENT 700.0 /* beyond which exp(-x) has fewer digits */

FU_INLINE void broadcast(int n, const double *x, fu_points *out)
{
    for (int i = 0; i < n; ++i) out[i] = (fu_points){0.0} + x[i];
}

/* Takes the vector and the numbers of a wave. */
FU_INLINE void wave_of(int dim, const fu_waves *waves, int i, fu_points k[3], fu_points wave[FU_WAVE_NUMBERS])
{
    broadcast(dim, waves->wave_vectors + i * dim, k);
    broadcast(FU_WAVE_NUMBERS, waves->wave_numbers + i * FU_WAVE_NUMBERS, wave);
}

FU_INLINE void elevations(const fu_model *model, const fu_drag *drag, double t, const fu_points *r,
                          fu_wave_phase *phases, fu_block_elevation *out)
{
    const int dim = model->dim;
    const fu_drag_blocks *kernel = fu_drag_blocks_of(drag->kernel->name);
    const fu_points time = (fu_points){0.0} + t;
    *out = (fu_block_elevation){{0.0}, {0.0}, {{0.0}}};
    for (int i = 0; i < drag->waves.n_waves; ++i) {
        fu_points k[3], wave[FU_WAVE_NUMBERS], theta, eta, rate, slope[3];
        fu_wave_phase phase;
        wave_of(dim, &drag->waves, i, k, wave);
        kernel->wave_phase(r, &time, k, wave, &theta);
        fu_cosine_and_sine(&theta, &phase.cosine, &phase.sine);
        kernel->wave_elevation(k, wave, &phase.cosine, &phase.sine, &eta, &rate, slope);
        out->eta += eta;
        out->rate += rate;
        for (int d = 0; d < dim; ++d) out->slope[d] += slope[d];
        if (phases) phases[i] = phase;
    }
}

FU_SIMD_FUNCTION(fu_block_elevations, elevations,
                 (const fu_model *model, const fu_drag *drag, double t, const fu_points *r, fu_wave_phase *phases,
                  fu_block_elevation *out),
                 (model, drag, t, r, phases, out))

fu_elevation fu_elevation_at(const fu_model *model, const fu_drag *drag, double t, const double *r)
{
    fu_points place[3];
    fu_block_elevation at;
    fu_elevation out = {0.0, 0.0, {0.0}};
    broadcast(model->dim, r, place);
    fu_block_elevations(model, drag, t, place, 0, &at);
    out.eta = at.eta[0];
    out.rate = at.rate[0];
    for (int d = 0; d < model->dim; ++d) out.slope[d] = at.slope[d][0];
    return out;
}

/* The height at which waves have the velocity of a point, above the still level, with its derivatives (Wheeler). */
typedef struct {
    fu_points Z, rate, by_place[3];
} wave_height;

/* Computes that height, between the bed and the still level, which is that of the surface. */
FU_INLINE void height_at(int dim, const fu_drag *drag, const fu_drag_blocks *kernel, const fu_block_elevation *at,
                         const fu_points *r, const fu_points *up, wave_height *out)
{
    const fu_waves *waves = &drag->waves;
    const fu_points none = {0.0}, inv_depth = none + waves->inv_depth;
    const fu_points bed = none + (waves->inv_depth > 0.0 ? -1.0 / waves->inv_depth : -HUGE_VAL);
    fu_points height = none + (drag->flow.base - drag->surface);
    for (int d = 0; d < dim; ++d) height += r[d] * up[d];
    kernel->wave_stretching(&height, &at->eta, &at->rate, at->slope, up, &inv_depth, &out->Z, &out->rate,
                            out->by_place);
    const fu_point_bits above = (fu_point_bits)(out->Z > none), below = (fu_point_bits)(out->Z < bed);
    out->Z = FU_CHOSEN(above, none, FU_CHOSEN(below, bed, out->Z));
    out->rate = FU_CHOSEN(above | below, none, out->rate);
    for (int d = 0; d < dim; ++d) out->by_place[d] = FU_CHOSEN(above | below, none, out->by_place[d]);
}

FU_INLINE double largest(const fu_points *x)
{
    double found = (*x)[0];
    for (int p = 1; p < FU_BLOCK_POINTS; ++p) found = fmax(found, (*x)[p]);
    return found;
}

FU_INLINE void add_velocities(const fu_model *model, const fu_drag *drag, const fu_points *r,
                              const fu_block_elevation *at, const fu_wave_phase *phases, fu_block_fluid *out)
{
    const int dim = model->dim;
    const fu_drag_blocks *kernel = fu_drag_blocks_of(drag->kernel->name);
    wave_height height;
    fu_points up[3];
    broadcast(dim, drag->flow.up, up);
    height_at(dim, drag, kernel, at, r, up, &height);
    const double highest = largest(&height.Z);
    for (int i = 0; i < drag->waves.n_waves; ++i) {
        fu_points k[3], wave[FU_WAVE_NUMBERS], grow, potential, U[3], rate[3], gradient[9];
        if (drag->waves.wave_numbers[i * FU_WAVE_NUMBERS + 3] * highest < -MAX_DECAY) continue;
        wave_of(dim, &drag->waves, i, k, wave);
        const fu_points least = (fu_points){0.0} - MAX_EXPONENT;
        fu_points exponent = wave[3] * height.Z;
        exponent = FU_CHOSEN((fu_point_bits)(exponent < least), least, exponent);
        fu_exponential(&exponent, &grow);
        kernel->wave_velocity(k, wave, &phases[i].cosine, &phases[i].sine, &grow, up, &height.rate, height.by_place,
                              &potential, U, rate, gradient);
        for (int d = 0; d < dim; ++d) {
            out->U[d] += U[d];
            out->rate[d] += rate[d];
        }
        for (int d = 0; d < dim * dim; ++d) out->gradient[d] += gradient[d];
    }
}

FU_SIMD_FUNCTION(fu_block_add_waves, add_velocities,
                 (const fu_model *model, const fu_drag *drag, const fu_points *r, const fu_block_elevation *at,
                  const fu_wave_phase *phases, fu_block_fluid *out),
                 (model, drag, r, at, phases, out))
