/* Largest penetration of couplings, and their contact beyond the ends of surfaces, at the ends of steps, which rows of
 * output may miss. */
#include "couplings/common/coupling_events.h"
#include "equations/run.h"
#include "events/events.h"

#include <math.h>

double fu_beyond(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_coupling_events *events = coupling->events;
    return events && events->beyond ? events->beyond(model, coupling, state) : -INFINITY;
}

/* Records the penetrations at `now`, with known event functions. Distant pairs do not touch. */
void fu_record_penetrations(fu_run *run)
{
    const fu_event_function_list near = fu_near_event_functions(run, &run->now);
    for (int i = 0; i < near.n; ++i) {
        const int k = fu_event_function_of(near, i);
        const fu_coupling *c = fu_event_coupling(run, k);
        if (!c) continue;
        const fu_coupling_events *events = c->events;
        double *deepest = &run->deepest[c->number], *farthest = &run->farthest[c->number];
        if (events->depth) *deepest = fmax(*deepest, events->depth(run->model, c, &run->now, run->event_values[k]));
        *farthest = fmax(*farthest, fu_beyond(run->model, c, &run->now));
    }
}
