/* Which couplings may act where: couplings/common/proximity.c. */
#ifndef FUNICULAR_COUPLINGS_COMMON_PROXIMITY_H
#define FUNICULAR_COUPLINGS_COMMON_PROXIMITY_H

#include "couplings/common/coupling.h"
#include "bodies/model.h"

/* A cable or a body: how far it may have gone, m, and turned, from where it was at the last look, before pairs that
 * were far may be near; how far it went and turned at all until then; the largest radius of its points. */
typedef struct {
    double way, turn, gone, turned, radius;
    int pairs; /* that it is in */
} fu_mover;

/* A coupling that has a clearance: what its movers have to have gone at all before it is to be looked at again. */
typedef struct {
    double limit, lever;
    int between[2], coupling;
} fu_pair;

/* What is known of them all. */
struct fu_proximity {
    int n_movers, n_pairs, n_near, n_near_functions;
    int is_known, age; /* the lists are of some configuration; steps since then */
    double *at;        /* that configuration */
    fu_mover *movers;
    fu_pair *pairs;
    double *ways;             /* work space: 2 x n_movers */
    char *is_far, *is_alone;  /* of each coupling; is_alone: fu_acts_alone */
    const fu_coupling **near; /* those that may act while no mover has gone farther than its way, in their order */
    int *near_functions;      /* likewise, those of the user among them */
};

/* Bytes that it takes in one block with n event_functions; computes it in such a block of zeros. */
size_t fu_proximity_size(const fu_model *model, int n_event_functions);
void fu_proximity_place(fu_model *model, int n_event_functions, void *memory);

/* Whether couplings of a type do nothing but act, by themselves, while what they are between is near: nothing else asks
 * for them. */
int fu_acts_alone(const fu_coupling *coupling);
/* A mover's body, null for a cable; how far points of a cable may be moved at most by numbers that its nodal vectors
 * differ by, or by their rates; how far a mover is from where it was at the last look, m, and the norm of the change of
 * its axes; whether none is farther than it may be. */
const fu_body *fu_body_of_mover(const fu_model *model, int mover);
double fu_most_of_cable(const fu_cable *cable, const double *to, const double *from);
void fu_mover_gone_by(const fu_model *model, int mover, const double *q, double *way, double *turn);
int fu_movers_are_near(const fu_model *model, const double *q);

#endif
