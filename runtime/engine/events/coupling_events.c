/* Loops over the events of couplings (couplings/common/coupling_events.h). */
#include "couplings/common/coupling_events.h"
#include "equations/run.h"
#include "events/events.h"

/* Writes the event functions of all couplings to `out`, unless it is null; returns their number. */
int fu_coupling_event_functions(const fu_model *model, fu_event_function *out)
{
    int n = 0;
    FU_EACH_COUPLING(c, model->couplings, model->n_couplings) {
        if (!c->events) continue;
        const int first = n;
        if (c->events->functions) n += c->events->functions(c, out ? out + first : 0);
        else if (n++, out) out[first] = (fu_event_function){.direction = c->events->direction};
        for (int i = first; i < n && out; ++i) {
            out[i].kind = FU_EVENT_OF_COUPLING;
            out[i].index = c->number;
        }
    }
    return n;
}

/* Returns whether any coupling can change its state. */
int fu_couplings_can_act(const fu_model *model)
{
    FU_EACH_COUPLING(c, model->couplings, model->n_couplings)
        if (fu_can_act(c)) return 1;
    return 0;
}

/* Updates directions of motion at `now` after a jump of velocities. */
void fu_update_directions(fu_run *run)
{
    FU_EACH_COUPLING(c, run->model->couplings, run->model->n_couplings)
        if (c->events && c->events->update_direction) c->events->update_direction(run, c);
}

/* Determines the state of couplings at the start; returns a status. */
int fu_begin_couplings(fu_run *run)
{
    fu_update_directions(run);
    FU_EACH_COUPLING(c, run->model->couplings, run->model->n_couplings) {
        if (!c->events) continue;
        const fu_state_event_operations *of_state = c->events->of_state;
        const int status = of_state ? FU_RUNNING : c->events->begin(run, c);
        if (status) return status;
        if (of_state && of_state->begin) of_state->begin(run->model, c, &run->now);
    }
    return FU_RUNNING;
}
