/* Public: couplings that may act: couplings/common/proximity.c; bounding spheres for their clearances:
 * couplings/common/spheres.c. */
#ifndef FUNICULAR_COUPLINGS_COMMON_PROXIMITY_H
#define FUNICULAR_COUPLINGS_COMMON_PROXIMITY_H

#include "bodies/model.h"
#include "couplings/common/coupling.h"

/* Pairs of one first part, from `first` on: the least of their limits beyond the motion of their parts, m, and the
 * largest lever, m, where these were last compared; the total motion of the first part and of carriers there. */
typedef struct {
    int first, n;
    double margin, lever, travelled, carried, carried_turn;
} fu_pair_group;

/* A cable or a body: limits of its displacement, m, and rotation since the last search before far pairs may be near;
 * its total displacement and rotation until then; the largest radius of its points. */
typedef struct {
    double displacement, turn, travelled, turned, radius;
    int pairs;      /* number of its pairs */
    int is_carrier; /* it is the second part of one */
    fu_pair_group group;
} fu_mover;

/* A coupling with a clearance: total motion of its parts at which it is measured again. */
typedef struct {
    double limit, lever;
    int between[2], coupling;
} fu_pair;

/* State of the search. */
struct fu_proximity {
    int n_movers, n_pairs, n_near, n_near_functions;
    int is_known, age; /* the lists belong to a configuration; steps since then */
    double *at;        /* that configuration */
    /* of the second parts of all pairs: the sums over searches of the largest displacement and rotation, and the
     * largest limits of both until the next search */
    double carried, carried_turn, carrier_displacement, carrier_turn;
    fu_mover *movers;
    fu_pair *pairs;           /* in order of their first parts */
    double *displacements;    /* work space: 2 x n_movers */
    char *is_far, *is_alone;  /* of each coupling; is_alone: fu_acts_alone */
    const fu_coupling **near; /* those that may act while no part has exceeded its limit, in their order */
    int *near_functions;      /* likewise, with those of the user */
};

/* Bytes of the structure in one block with n event functions; places it in such a block of zeros. */
size_t fu_proximity_size(const fu_model *model, int n_event_functions);
void fu_proximity_place(fu_model *model, int n_event_functions, void *memory);

/* Whether couplings of a type only act while their parts are near: nothing else needs them. */
int fu_acts_alone(const fu_coupling *coupling);
/* A moving part's body, null for a cable; the largest displacement of points of a cable by a change of its nodal
 * vectors, or the speed by their rates; the distance of a moving part from its position at the last search, m, and the
 * norm of the change of its axes; whether none exceeds its limit. */
const fu_body *fu_body_of_mover(const fu_model *model, int mover);
double fu_most_of_cable(const fu_cable *cable, const double *to, const double *from);
void fu_mover_gone_by(const fu_model *model, int mover, const double *q, double *displacement, double *turn);
int fu_movers_are_near(const fu_model *model, const double *q);

extern const fu_clearance fu_no_clearance; /* of a coupling that may act */
double fu_sphere_about(const fu_cable *cable, const double *q, int element, double middle[3]);
double fu_distance_between(int dim, const double *a, const double *b);
const double *fu_place_of_body(const fu_model *model, const fu_state *state, int body);

#endif
