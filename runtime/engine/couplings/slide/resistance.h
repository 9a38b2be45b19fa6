/* Resistance of slides, friction and buffers: couplings/slide/resistance.c. */
#ifndef FUNICULAR_COUPLINGS_SLIDE_RESISTANCE_H
#define FUNICULAR_COUPLINGS_SLIDE_RESISTANCE_H

#include "couplings/common/coupling.h"

/* R of a slide, the force along its cable times r_x, and its derivatives */
typedef struct {
    double R, by_t[3], by_u[3], by_f[3], by_s;
} fu_resistance;

void fu_resistance_at(const fu_model *model, const fu_state *state, int j, const double *t, const double *u,
                      const double *f, fu_resistance *resistance);
double fu_compression(const fu_model *model, const fu_state *state, int j, int side);
void fu_slide_motion(const fu_model *model, const fu_state *state, int j, const double *J, double *t, double *u);
void fu_resistance_rows(const fu_model *model, const fu_state *state, int j, const double *J,
                        const fu_resistance *resistance, double *by_place, double *by_rate);

/* Operations of a slide as a coupling (couplings/common/coupling.h). */
double fu_resistance_update(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                            const double *lambda, fu_accelerator *work);
void fu_resistance_accept(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const double *lambda, fu_accelerator *work);
double fu_resistance_friction_error(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int n,
                                    const double *weights, const double *multipliers, double square);
double fu_resistance_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                                 const fu_accelerator *work);
double fu_buffer_energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state);
double fu_lost_in_buffers(const fu_model *model, const fu_coupling *coupling, const fu_state *from, const fu_state *to,
                          int by_ends);
void fu_detect_buffers(const fu_model *model, const fu_coupling *coupling, fu_state *state);

#endif
