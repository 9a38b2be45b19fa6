/* How deep couplings have let parts sink below what they touch, at the ends of steps: rows of output may miss it. */
#include "engine.h"

/* Takes the depths at `now`, whose watched values are known. What is too far to be watched touches nothing. */
void fu_note_depths(fu_run *run)
{
    const fu_watch_list near = fu_near_watches(run, &run->now);
    for (int i = 0; i < near.n; ++i) {
        const int k = fu_watch_of(near, i);
        const fu_coupling *c = fu_own_coupling(run, k);
        if (!c || !c->type->events->depth) continue;
        const double depth = c->type->events->depth(run->model, c, &run->now, run->watched[k]);
        if (depth > run->deepest[c->number]) run->deepest[c->number] = depth;
    }
}
