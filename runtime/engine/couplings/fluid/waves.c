/* Linear waves (derive/couplings/waves.py): elevation of the surface, and velocity of the fluid. Frequencies are those
 * at a fixed place: a current does not change the length of the waves. */
#include "bodies/model.h"
#include "couplings/fluid/drag.h"

#include <math.h>

#define MAX_DECAY 40.0 /* exponent of depth beyond which a wave moves nothing, exp(-40) = 4e-18 */

fu_elevation fu_elevation_at(const fu_model *model, const fu_drag *drag, double t, const double *r)
{
    const int dim = model->dim;
    const fu_waves *waves = &drag->waves;
    fu_elevation out = {0.0, 0.0, {0.0}};
    for (int i = 0; i < waves->n_waves; ++i) {
        double eta, rate, slope[3];
        drag->kernel->wave_elevation(r, t, waves->wave_vectors + i * dim, waves->wave_numbers + i * FU_WAVE_NUMBERS,
                                     &eta, &rate, slope);
        out.eta += eta;
        out.rate += rate;
        for (int d = 0; d < dim; ++d) out.slope[d] += slope[d];
    }
    return out;
}

/* The height at which waves have the velocity of a point, above the still level, with its derivatives (Wheeler). */
typedef struct {
    double Z, rate, by_place[3];
} wave_height;

/* Returns that height, between the bed and the still level, which is that of the surface. */
static wave_height height_at(const fu_model *model, const fu_drag *drag, double t, const double *r)
{
    const fu_waves *waves = &drag->waves;
    const double height = drag->flow.base + fu_dot(model->dim, drag->flow.up, r) - drag->surface;
    const double bed = waves->inv_depth > 0.0 ? -1.0 / waves->inv_depth : -HUGE_VAL;
    const fu_elevation at = fu_elevation_at(model, drag, t, r);
    wave_height out;
    drag->kernel->wave_stretching(height, at.eta, at.rate, at.slope, drag->flow.up, waves->inv_depth, &out.Z, &out.rate,
                                  out.by_place);
    if (out.Z > 0.0 || out.Z < bed) out = (wave_height){out.Z > 0.0 ? 0.0 : bed, 0.0, {0.0}};
    return out;
}

void fu_add_waves(const fu_model *model, const fu_drag *drag, double t, const double *r, fu_flow_state *out)
{
    const int dim = model->dim;
    const fu_waves *waves = &drag->waves;
    const wave_height at = height_at(model, drag, t, r);
    for (int i = 0; i < waves->n_waves; ++i) {
        const double *wave = waves->wave_numbers + i * FU_WAVE_NUMBERS;
        double potential, U[3], rate[3], gradient[9];
        if (wave[3] * at.Z < -MAX_DECAY) continue;
        drag->kernel->wave_velocity(r, t, waves->wave_vectors + i * dim, wave, drag->flow.up, at.Z, at.rate,
                                    at.by_place, &potential, U, rate, gradient);
        for (int d = 0; d < dim; ++d) {
            out->U[d] += U[d];
            out->rate[d] += rate[d];
        }
        for (int d = 0; d < dim * dim; ++d) out->gradient[d] += gradient[d];
    }
}
