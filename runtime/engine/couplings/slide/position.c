/* Position of a slide on its cable: s by C_l = 0, eq 21, and the director that follows the tangent there. */
#include "bodies/model.h"
#include "couplings/slide/slide.h"

#include <math.h>

/* of Newton's method, which converges quadratically unless there is no such point of the cable near */
#define MAX_ITERATIONS 50
/* of an element and of s: a correction that is rounding ends the iteration */
#define ROUNDING_OF_LENGTH 1e-15
/* of an element: a correction of this size is sufficient if rounding keeps it from shrinking */
#define LENGTH_TOLERANCE 1e-12
/* cosine of the angle between tangent and director from which on another axis replaces the director: 8 degrees */
#define MAX_ALIGNMENT 0.99

/* Returns the Newton step for s of a slide, m, and the unit tangent there. */
static double evaluate_constraint(const fu_model *model, const fu_state *state, int j, double s, double i[3])
{
    const int dim = model->dim;
    double A_t[9];
    const double step = fu_slide_step(model, state, j, s, A_t);
    for (int d = 0; d < dim; ++d) i[d] = A_t[d * dim];
    return step;
}

/* Solves C_l(s) = 0 for s by Newton's method, eq 21 on the curve of the element of s; returns 0 on convergence. */
int fu_find_arc_length(const fu_model *model, const fu_state *state, int j, double *s)
{
    const double length = fu_mean_element(model, state, j);
    double step = 0.0, tangent[3];
    for (int i = 0; i < MAX_ITERATIONS; ++i) {
        step = evaluate_constraint(model, state, j, *s, tangent);
        *s += step;
        if (fabs(step) <= ROUNDING_OF_LENGTH * (length + fabs(*s))) return 0;
    }
    return fabs(step) <= LENGTH_TOLERANCE * length ? 0 : 1;
}

/* Rotates the director, if no element gives it, with the tangent: it becomes its component normal to the tangent, of
 * unit length. If the tangent has approached it, the axis least along the tangent replaces it. */
void fu_update_director(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    const int j = coupling->index;
    double *d = fu_slide_numbers_of(model, state, j)->director, i[3];
    if (!model->slides[j].carries_director) return;
    evaluate_constraint(model, state, j, state->s[j], i);
    double along = fu_dot(3, i, d);
    if (!(fabs(along) < MAX_ALIGNMENT)) {
        const double x = fabs(i[0]), y = fabs(i[1]), z = fabs(i[2]);
        const int least = x <= y && x <= z ? 0 : y <= z ? 1 : 2;
        for (int k = 0; k < 3; ++k) d[k] = k == least;
        along = i[least];
    }
    for (int k = 0; k < 3; ++k) d[k] -= along * i[k];
    const double size = sqrt(fu_dot(3, d, d));
    for (int k = 0; k < 3; ++k) d[k] /= size;
}
