/* Events of drag in a fluid with a surface: a surface begins to cut what the fluid acts on, or all of it is on one
 * side. Forces are continuous there, with their first derivatives but for that of added mass. Steps end there all the
 * same: a body that falls freely takes long ones, and would go deep into the fluid, or through a thin layer, in one
 * whose error estimate has not seen it.
 */
#include "bodies/model.h"
#include "events/fluid_surface.h"

#include <math.h>

#define OF_SURFACE 2 /* watches of each: the first touch, and the last */

static double level_of(const fu_drag *drag, int which)
{
    return which < OF_SURFACE ? drag->surface : drag->bottom;
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

/* Makes the lowest and the highest place, m: of a cable among its nodes. */
static void heights_of(const fu_model *model, const fu_drag *drag, const fu_state *state, double *low, double *high)
{
    if (drag->cable < 0) {
        fu_attachment_state end;
        fu_attachment_at(model, &drag->attachments[0], state, 0.0, FU_POINT, &end);
        *low = *high = fu_drag_height(model, drag, end.p);
        return;
    }
    const fu_cable *cable = &model->cables[drag->cable];
    *low = *high = fu_drag_height(model, drag, state->q + cable->first);
    for (int k = 1; k <= cable->n_elements; ++k) {
        const double height = fu_drag_height(model, drag, state->q + cable->first + k * cable->per_node);
        *low = fmin(*low, height);
        *high = fmax(*high, height);
    }
}

double fu_surface_event_value(const fu_model *model, const fu_drag *drag, const fu_state *state, int which)
{
    const double reach = fu_wet_reach(drag);
    double low, high;
    heights_of(model, drag, state, &low, &high);
    return which % OF_SURFACE == 0 ? level_of(drag, which) + reach - low : level_of(drag, which) - reach - high;
}
