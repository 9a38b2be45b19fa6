/* Public: hard contact of a point of a body with a surface: a multiplier that pushes, and never pulls. */
#ifndef FUNICULAR_COUPLINGS_HARD_CONTACT_HARD_CONTACT_H
#define FUNICULAR_COUPLINGS_HARD_CONTACT_HARD_CONTACT_H

#include "couplings/contact/contact.h"
#include "linear/complementarity.h"

#define FU_MAX_HARD_CONTACTS FU_MAX_COMPLEMENTARY /* of a scene */

/* One point, the contact's only one. A row g = 0 of its distance, less its radius, has a multiplier while it is closed:
 * minus the normal force. */
typedef struct {
    fu_contact contact;   /* surface, point, radius */
    double restitution;   /* of the normal velocity, 0 to 1 */
    double rest_velocity; /* m/s: slower separations are none */
    double friction;      /* Coulomb's coefficient */
    double weight;        /* N: of the body, without gravity as under 1 m/s^2 */
    double stiffness;     /* N/m: in statics; large, so that redundant points share their force */
} fu_hard_contact;
extern const fu_coupling_type fu_hard_contact_type;

/* A point's part of a state: its mode, its last change, whether friction holds it, and the time of the change, s; the
 * present or last direction of sliding. */
typedef struct {
    int mode, news, sticks;
} fu_hard_flags;
typedef struct {
    double time, direction[FU_SPACE];
} fu_hard_numbers;

/* Apart; closed, with its row among the constraints; closed and redundant: its own multiplier is zero. */
enum { FU_APART, FU_CLOSED, FU_IMPLIED };
enum { FU_NO_NEWS, FU_STRUCK, FU_CAME_INTO_CONTACT, FU_LOST_CONTACT, FU_STUCK, FU_BROKE_LOOSE };

/* Numbers of a row of output: the force on the body, its friction, the distance. */
typedef struct {
    double force[3], friction_force[3], gap;
} fu_hard_contact_output;

/* Motion of a point along the surface: velocity past it, two tangential directions, their rows over the dofs of the
 * row, the rates of these velocities at zero accelerations, and the direction opposed by friction. */
typedef struct {
    double past[3], t[2][3], H[2][2 * FU_ATTACHMENT_COORDINATES], bias[2], direction[3],
        slip[2 * FU_ATTACHMENT_COORDINATES];
} fu_hard_along;

/* A point's row: distance g and its rate, g'' at zero accelerations of the coordinates, normal; H over the n dofs `at`,
 * those of the body, then those of the body of the surface. */
typedef struct {
    double g, rate, bias, normal[3], curvature[9];
    int n, at[2 * FU_ATTACHMENT_COORDINATES];
    double H[2 * FU_ATTACHMENT_COORDINATES];
} fu_hard_row;

/* couplings/hard_contact/hard_contact.c */
void fu_hard_row_at(const fu_model *model, const fu_hard_contact *contact, const fu_state *state, fu_hard_row *out);

/* couplings/hard_contact/state.c; the last: the distance of the point beyond the ends of its surface, m. */
fu_hard_flags *fu_hard_flags_of(const fu_coupling *coupling, const fu_state *state);
fu_hard_numbers *fu_hard_numbers_of(const fu_coupling *coupling, const fu_state *state);
double fu_hard_beyond(const fu_model *model, const fu_hard_contact *hard, const fu_state *state);

/* couplings/hard_contact/friction.c */
void fu_hard_along_at(const fu_model *model, const fu_hard_contact *contact, const fu_state *state,
                      const fu_hard_row *row, fu_hard_along *out);
double fu_hard_friction_limit(const fu_hard_contact *contact, double multiplier);
double fu_hard_softness(const fu_hard_contact *contact, double multiplier);

#endif
