/* Lengths that scale errors and rounding of a scene: equations/scene_size.c. */
#ifndef FUNICULAR_EQUATIONS_SCENE_SIZE_H
#define FUNICULAR_EQUATIONS_SCENE_SIZE_H

#include "bodies/model.h"

double fu_largest_motion(const fu_model *model, const double *from, const double *to);
double fu_controlled_motion(const fu_run *run);
double fu_extent(const fu_model *model, const double *origin, const double *q);
double fu_scene_size(const fu_model *model, const double *origin, const double *q);
double fu_longest_lever(const fu_model *model);

#endif
