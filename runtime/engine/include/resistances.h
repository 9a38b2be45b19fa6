/* Friction of slides, and buffers: couplings/resistances.c. */
#ifndef FUNICULAR_RESISTANCES_H
#define FUNICULAR_RESISTANCES_H

#include "common.h"

/* R of a slide, the force along its cable times r_x, and its derivatives */
typedef struct {
    double R, by_t[3], by_u[3], by_f[3], by_s;
} fu_resistance;
int fu_has_resistance(const fu_model *model, const fu_state *state, int j);
void fu_resistance_at(const fu_model *model, const fu_state *state, int j, const double *t, const double *u, const double *f,
              fu_resistance *resistance);
double fu_resistance_power(const fu_model *model, const fu_state *state, int j, const double *t, const double *u,
                      const double *f);
double fu_buffer_energy(const fu_model *model, const fu_state *state);
double fu_lost_in_buffers(const fu_model *model, const fu_state *from, const fu_state *to);
void fu_touch_buffers(const fu_model *model, fu_state *state);
double fu_compression(const fu_model *model, const fu_state *state, int j, int side);
void fu_slide_motion(const fu_model *model, const fu_state *state, int j, const double *J, double *t, double *u);
void fu_resistance_rows(const fu_model *model, const fu_state *state, int j, const double *J, const fu_resistance *resistance,
                   double *by_place, double *by_rate);

#endif
