/* Events of drag in a fluid with a surface: the surface begins to cut a part, or the part is entirely on one side.
 * Forces and their first derivatives are continuous there, except those of added mass. Steps end there all the same: a
 * body in free fall has long ones, and would move deep into the fluid, or through a thin layer, without an effect on
 * the error estimate. */
#include "bodies/model.h"
#include "events/fluid_surface.h"

#include <math.h>

#define N_SURFACE_FUNCTIONS 2 /* event functions of each: first contact, and last */

static double level_of(const fu_drag *drag, int which)
{
    return which < N_SURFACE_FUNCTIONS ? drag->surface : drag->bottom;
}

static int is_level(double height)
{
    return fabs(height) < FU_NO_SURFACE;
}

int fu_surface_event_functions(const fu_drag *drag, int first, fu_event_function *out)
{
    int n = 0;
    for (int which = 0; which < FU_SURFACE_EVENT_FUNCTIONS; ++which) {
        if (drag->wet == FU_ALL_WET || !is_level(level_of(drag, which))) continue;
        if (out) out[n] = (fu_event_function){.which = first + which, .direction = 0};
        ++n;
    }
    return n;
}

/* Returns the lowest (sense 1) or the highest (-1) position above the surface, m: of a cable or a span among its nodes.
 * Waves are not evaluated at nodes that are farther than they reach. */
static double extreme_height(const fu_model *model, const fu_drag *drag, const fu_state *state, double sense)
{
    const int nodes = fu_drag_nodes(drag);
    if (!nodes) {
        fu_attachment_state end;
        fu_attachment_at(model, &drag->attachments[0], state, 0.0, FU_POINT, &end);
        return fu_drag_height(model, drag, state->t, end.p);
    }
    double found = HUGE_VAL;
    for (int k = 0; k < nodes; ++k) {
        const double *r = fu_drag_node(model, drag, k, state->q);
        const double still = sense * (drag->flow.base + fu_dot(model->dim, drag->flow.up, r));
        if (still - drag->waves.max_elevation >= found) continue;
        found = fmin(found, drag->waves.n_waves ? sense * fu_drag_height(model, drag, state->t, r) : still);
    }
    return sense * found;
}

double fu_surface_event_value(const fu_model *model, const fu_drag *drag, const fu_state *state, int which)
{
    const double reach = fu_wet_reach(drag);
    return which % N_SURFACE_FUNCTIONS == 0 ? level_of(drag, which) + reach - extreme_height(model, drag, state, 1.0)
                                            : level_of(drag, which) - reach - extreme_height(model, drag, state, -1.0);
}
