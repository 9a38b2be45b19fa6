/* Which couplings may act where: couplings/proximity.c. */
#ifndef FUNICULAR_PROXIMITY_H
#define FUNICULAR_PROXIMITY_H

#include "coupling.h"
#include "model.h"

/* A cable or a body: how far it may have gone, m, and turned, from where it was at the last look, before pairs that were far may
 * be near; how far it went and turned at all until then; the largest radius of its points. */
typedef struct {
    double way, turn, gone, turned, radius;
    int pairs; /* that it is in */
} fu_mover;

/* A coupling that has a clearance: what its movers have to have gone at all before it is to be looked at anew. */
typedef struct {
    double limit, lever;
    int between[2], coupling;
} fu_pair;

/* What is known of them all. */
struct fu_proximity {
    int n_movers, n_pairs, n_near, n_near_watches;
    int is_known, age;    /* the lists are of some configuration; steps since then */
    double *at;           /* that configuration */
    fu_mover *movers;
    fu_pair *pairs;
    double *ways;         /* work space: 2 x n_movers */
    char *is_far, *is_alone; /* of each coupling; is_alone: fu_acts_alone */
    const fu_coupling **near; /* those that may act while no mover has gone farther than its way, in their order */
    int *near_watches;    /* likewise, those of the user's among them */
};

/* Bytes that it takes in one block with n watches; makes it in such a block of zeros. */
size_t fu_proximity_size(const fu_model *model, int n_watches);
void fu_proximity_place(fu_model *model, int n_watches, void *memory);

/* The watches that may pass zero up to a state (null: in no way), or within a step of h that leads to `next`. */
typedef struct {
    const int *list; /* null: all, in their order */
    int n;
} fu_watch_list;
fu_watch_list fu_near_watches(const fu_run *run, const fu_state *state);
fu_watch_list fu_near_watches_within(const fu_run *run, double h);
static inline int fu_watch_of(fu_watch_list list, int i)
{
    return list.list ? list.list[i] : i;
}
/* Whether a watch was passed over when values at `now` were taken. */
int fu_is_far_watch(const fu_run *run, int watch);

/* Looks anew at what may be near, after a step of h, where that may be needed, or in any case. */
void fu_look_around(fu_run *run, double h, int anew);

#endif
