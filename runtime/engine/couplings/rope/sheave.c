/* Sheaves: two tangent points, and the wrap between them, as one coupling. Derivatives are first by the places and
 * slopes of both nodes, the centre, and the material coordinates (y); the angles of the wrap follow from the places
 * (z).
 *
 * In space the wrap lies in the plane of the groove, to which all vectors here belong; in the place of the slope of a
 * node is its length, which alone friction needs. The conditions of tangent points are those of tangent_point.c. */
#include "bodies/model.h"
#include "bodies/unknowns.h"
#include "couplings/common/couplings.h"
#include "couplings/rope/rope.h"

#include <math.h>
#include <string.h>

enum { DIM = 2, ENDS = 2, MAX_CONDITIONS = ENDS * FU_FOOT_CONDITIONS, MAX_ZONES = 16, SPACE = 3 };
/* y: of each node the place and the slope; the centre; the rotation of the sheave; s of the ends of the zones; in space
 * the place of the centre along the axis */
enum { NODE = 2 * DIM, SLOPE = DIM, CENTRE = ENDS * NODE, TURN = CENTRE + DIM, MATERIAL = TURN + 1 };
enum {
    ACROSS = MATERIAL + MAX_ZONES + 1,
    Y = ACROSS + 1,
    IN_SPACE = ENDS * 2,
    COLUMNS = Y - DIM + IN_SPACE + FU_ATTACHMENT_COORDINATES
};
/* z: the same with the angles of both tangent points in the place of those of the nodes */
enum {
    Z_SLOPE = ENDS,
    Z_CENTRE = Z_SLOPE + ENDS * DIM,
    Z_TURN = Z_CENTRE + DIM,
    Z_MATERIAL = Z_TURN + 1,
    Z = Z_MATERIAL + MAX_ZONES + 1
};
/* of a zone: angles of its ends, centre, s of its ends */
enum { U_CENTRE = ENDS, U_MATERIAL = U_CENTRE + DIM, U = U_MATERIAL + ENDS };

typedef struct {
    double tension_on, tension_off, wrap_angle, force[3], material_speed, slip, normal_force, torque, angle, residual,
        fleet_angle_on, fleet_angle_off;
} sheave_output;

/* A sheave at a state: the centre, both tangent points, and the angles with their rates. */
typedef struct {
    const double *q;
    fu_attachment_state centre;
    double c[DIM], c_rate[DIM], c_acc[DIM], across, across_rate, across_acc, centre_acc[SPACE];
    double own_rate, turn_rate, turn_acc; /* own: relative to the carrier */
    double stretch[ENDS][SPACE];          /* in space: direction of the slope */
    double s[MAX_ZONES + 1], s_rate[MAX_ZONES + 1], s_acc[MAX_ZONES + 1];
    double x[ENDS][DIM], slope[ENDS][DIM], x_rate[ENDS][DIM], slope_rate[ENDS][DIM];
    double phi[ENDS], phi_rate[ENDS], phi_acc[ENDS];
    double phi_x[ENDS][DIM], phi_xx[ENDS][DIM * DIM], rate_x[ENDS][DIM], acc_x[ENDS][DIM], acc_v[ENDS][DIM];
} view;

static const fu_sheave *sheave_of(const fu_coupling *coupling)
{
    return (const fu_sheave *)coupling;
}

/* Returns the number of conditions of a tangent point. */
static int conditions_of(const fu_sheave *sheave)
{
    return sheave->foot ? FU_FOOT_CONDITIONS : DIM;
}

static int columns(const fu_sheave *sheave)
{
    return Z_MATERIAL + sheave->n_zones + 1;
}

static double stretch_at(const view *at, int k)
{
    return sqrt(fu_dot(DIM, at->slope[k], at->slope[k]));
}

/* Computes the angles of both tangent points: the wrap counts the turns by which its stretch is nearest to the mean of
 * both spans. */
static void find_angles(const fu_sheave *sheave, view *at)
{
    const double length = 0.5 * (stretch_at(at, 0) + stretch_at(at, 1)) * (at->s[sheave->n_zones] - at->s[0]);
    const double *a = at->x[0], *b = at->x[1], turn = 2.0 * acos(-1.0);
    const double part = sheave->sense * atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
    const double wrap = part + turn * round((length / sheave->radius - part) / turn);
    at->phi[0] = atan2(a[1], a[0]);
    at->phi[1] = at->phi[0] + sheave->sense * wrap;
}

/* Computes the parts of a vector in the plane of the groove. */
static void into_groove(const fu_sheave *sheave, const double *vector, double out[DIM])
{
    for (int i = 0; i < DIM; ++i) {
        out[i] = 0.0;
        for (int d = 0; d < SPACE; ++d) out[i] += sheave->groove[d * DIM + i] * vector[d];
    }
}

/* Returns the part about the axis of a rotation, of whose parts in space each is `stride` after the last one. */
static double about_axis(const fu_sheave *sheave, const double *turn, int stride)
{
    double sum = 0.0;
    if (!sheave->foot) return turn[0];
    for (int d = 0; d < SPACE; ++d) sum += sheave->axis[d] * turn[d * stride];
    return sum;
}

/* Computes the motion of a node from the centre, with the acceleration x_acc, in space. */
static void look_in_space(const fu_sheave *sheave, const fu_state *state, const double *v, const double *a, int k,
                          view *out, double x_acc[DIM])
{
    const int r = sheave->nodes[k];
    const double *slope = state->q + r + SPACE, size = sqrt(fu_dot(SPACE, slope, slope));
    double x[SPACE], rate[SPACE], acc[SPACE];
    for (int d = 0; d < SPACE; ++d) {
        x[d] = state->q[r + d] - out->centre.p[d];
        rate[d] = v[r + d] - out->centre.v[d];
        acc[d] = a[r + d] - out->centre_acc[d];
        out->stretch[k][d] = slope[d] / size;
    }
    into_groove(sheave, x, out->x[k]);
    into_groove(sheave, rate, out->x_rate[k]);
    into_groove(sheave, acc, x_acc);
    out->slope[k][0] = size;
    out->slope[k][1] = out->slope_rate[k][0] = out->slope_rate[k][1] = 0.0;
}

/* Computes the motion of a node from the centre, with the acceleration x_acc, in the plane. */
static void look_in_plane(const fu_sheave *sheave, const fu_state *state, const double *v, const double *a, int k,
                          view *out, double x_acc[DIM])
{
    const int r = sheave->nodes[k], slope = r + SLOPE;
    for (int d = 0; d < DIM; ++d) {
        out->x[k][d] = state->q[r + d] - out->centre.p[d];
        out->slope[k][d] = state->q[slope + d];
        out->x_rate[k][d] = v[r + d] - out->centre.v[d];
        out->slope_rate[k][d] = v[slope + d];
        x_acc[d] = a[r + d] - out->c_acc[d];
    }
}

/* Computes the motion of the centre, with these accelerations of the dofs. */
static void look_at_centre(const fu_sheave *sheave, const double *a, view *out)
{
    const fu_attachment_state *centre = &out->centre;
    for (int d = 0; d < (sheave->foot ? SPACE : DIM); ++d) {
        out->centre_acc[d] = centre->bias[d];
        for (int i = 0; i < centre->n; ++i) out->centre_acc[d] += centre->P[d * centre->n + i] * a[centre->at[i]];
    }
    if (sheave->foot) {
        into_groove(sheave, centre->p, out->c);
        into_groove(sheave, centre->v, out->c_rate);
        into_groove(sheave, out->centre_acc, out->c_acc);
        out->across = fu_dot(SPACE, sheave->axis, centre->p);
        out->across_rate = fu_dot(SPACE, sheave->axis, centre->v);
        out->across_acc = fu_dot(SPACE, sheave->axis, out->centre_acc);
        return;
    }
    memcpy(out->c, centre->p, sizeof out->c);
    memcpy(out->c_rate, centre->v, sizeof out->c_rate);
    memcpy(out->c_acc, out->centre_acc, sizeof out->c_acc);
}

/* Computes a sheave at a state, with these accelerations of the dofs (null: zero). */
static void look(const fu_model *model, const fu_coupling *coupling, const fu_state *state, const double *a, view *out)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const double *v = state->v ? state->v : model->zero;
    const fu_state moving = {.t = state->t, .q = state->q, .v = (double *)v};
    fu_attachment_state *centre = &out->centre;
    if (!a) a = model->zero;
    out->q = state->q;
    fu_attachment_at(model, &sheave->attachments[0], &moving, 0.0, FU_POINT | FU_AXES, centre);
    look_at_centre(sheave, a, out);
    for (int k = 0; k < ENDS; ++k) {
        double x_acc[DIM];
        (sheave->foot ? look_in_space : look_in_plane)(sheave, state, v, a, k, out, x_acc);
        sheave->kernel->angle(out->x[k], out->x_rate[k], x_acc, &out->phi_rate[k], &out->phi_acc[k], out->phi_x[k],
                              out->phi_xx[k], out->rate_x[k], out->acc_x[k], out->acc_v[k]);
    }
    for (int j = 0; j <= sheave->n_zones; ++j) {
        out->s[j] = state->q[sheave->s[j]];
        out->s_rate[j] = v[sheave->s[j]];
        out->s_acc[j] = a[sheave->s[j]];
    }
    out->s[sheave->n_zones] += sheave->closing;
    out->own_rate = sheave->turn < 0 ? 0.0 : v[sheave->turn];
    out->turn_rate = out->own_rate + about_axis(sheave, centre->omega, 1);
    out->turn_acc = sheave->turn < 0 ? 0.0 : a[sheave->turn];
    for (int i = 0; i < centre->n; ++i)
        out->turn_acc += about_axis(sheave, centre->T + i, centre->n) * a[centre->at[i]];
    find_angles(sheave, out);
}

/* A zone of the wrap: where its numbers are among z, and their weights: angles of its ends are combinations. */
typedef struct {
    double share[ENDS], phi[ENDS], phi_rate[ENDS], phi_acc[ENDS], l;
    const double *s_rate, *s_acc;
    int first; /* of its ends */
} zone;

static zone zone_of(const fu_sheave *sheave, const view *at, int j)
{
    zone out = {.s_rate = at->s_rate + j, .s_acc = at->s_acc + j, .first = j, .l = at->s[j + 1] - at->s[j]};
    for (int e = 0; e < ENDS; ++e) {
        const double share = (double)(j + e) / sheave->n_zones;
        out.share[e] = share;
        out.phi[e] = at->phi[0] + share * (at->phi[1] - at->phi[0]);
        out.phi_rate[e] = at->phi_rate[0] + share * (at->phi_rate[1] - at->phi_rate[0]);
        out.phi_acc[e] = at->phi_acc[0] + share * (at->phi_acc[1] - at->phi_acc[0]);
    }
    return out;
}

/* The change of a number of a zone by z: n entries. */
typedef struct {
    int n, at[ENDS];
    double value[ENDS];
} entry;

static entry entry_of(const zone *of, int k)
{
    if (k < ENDS) return (entry){2, {0, 1}, {1.0 - of->share[k], of->share[k]}};
    if (k < U_MATERIAL) return (entry){1, {Z_CENTRE + k - U_CENTRE}, {1.0}};
    return (entry){1, {Z_MATERIAL + of->first + k - U_MATERIAL}, {1.0}};
}

/* Adds n numbers of a zone, the k-th of which is number which[k], to those of z. */
static void add_zone(const zone *of, int n, const int *which, const double *u, double *z)
{
    for (int k = 0; k < n; ++k) {
        const entry to = entry_of(of, which[k]);
        for (int i = 0; i < to.n; ++i) z[to.at[i]] += to.value[i] * u[k];
    }
}

/* Adds a matrix of a zone (rows x columns) times a factor to one of z; a row or column LENGTH is that of the length. */
enum { LENGTH = -1 };
static void add_zone_matrix(const zone *of, int n_rows, const int *rows, int n_columns, const int *which, double factor,
                            const double *from, double (*A)[Z])
{
    for (int i = 0; i < n_rows; ++i)
        for (int j = 0; j < n_columns; ++j)
            for (int r = 0; r < (rows[i] == LENGTH ? ENDS : 1); ++r)
                for (int c = 0; c < (which[j] == LENGTH ? ENDS : 1); ++c) {
                    const entry row = entry_of(of, rows[i] == LENGTH ? U_MATERIAL + r : rows[i]);
                    const entry column = entry_of(of, which[j] == LENGTH ? U_MATERIAL + c : which[j]);
                    const double sign =
                        (rows[i] == LENGTH && !r ? -1.0 : 1.0) * (which[j] == LENGTH && !c ? -1.0 : 1.0);
                    for (int a = 0; a < row.n; ++a)
                        for (int b = 0; b < column.n; ++b)
                            A[row.at[a]][column.at[b]] +=
                                factor * sign * row.value[a] * column.value[b] * from[i * n_columns + j];
                }
}

static const int every[U] = {0, 1, 2, 3, 4, 5}, with_length[5] = {0, 1, 2, 3, LENGTH}, of_zone[3] = {0, 1, LENGTH},
                 damped[4] = {0, 1, U_MATERIAL, U_MATERIAL + 1};

/* Returns the place among y of a number of z that is not an angle. */
static int among_y(int k)
{
    return k < Z_CENTRE ? (k - Z_SLOPE) / DIM * NODE + SLOPE + (k - Z_SLOPE) % DIM : CENTRE + k - Z_CENTRE;
}

/* Adds forces by z to those by y. */
static void add_by_angles(const fu_sheave *sheave, const view *at, const double *of_z, double *y)
{
    for (int k = 0; k < ENDS; ++k)
        for (int d = 0; d < DIM; ++d) {
            const double force = of_z[k] * at->phi_x[k][d];
            y[k * NODE + d] += force;
            y[CENTRE + d] -= force;
        }
    for (int k = Z_SLOPE; k < columns(sheave); ++k) y[among_y(k)] += of_z[k];
}

/* Adds the inertial forces by z. */
static void add_inertia(const fu_sheave *sheave, const view *at, double *z)
{
    z[Z_TURN] += sheave->inertia * at->turn_acc;
    for (int j = 0; j < sheave->n_zones; ++j) {
        const zone of = zone_of(sheave, at, j);
        double u[U];
        sheave->kernel->inertia(sheave->rho, sheave->radius, of.phi, of.l, of.phi_rate, at->c_rate, of.s_rate,
                                of.phi_acc, at->c_acc, of.s_acc, u);
        add_zone(&of, U, every, u, z);
    }
}

/* A point of friction at an end of a zone: its zones with their angles and lengths, its rates, and the tangent point
 * that it is, -1 for none. The k-th angle is that of the end of zone first + k. */
typedef struct {
    int first, zones, foot;
    double phi[3], share[3], l[2], phi_rate, s_rate;
} friction_point;

enum { SIDES = 2 };

static int has_friction(const fu_sheave *sheave)
{
    return sheave->friction > 0.0;
}

static friction_point point_of(const fu_sheave *sheave, const view *at, int j)
{
    const int n = sheave->n_zones, first = j > 0 ? j - 1 : 0, last = j < n ? j + 1 : n;
    friction_point out = {first, last - first, j == 0 ? 0 : j == n ? 1 : -1, .s_rate = at->s_rate[j]};
    for (int k = 0; k <= out.zones; ++k) {
        out.share[k] = (double)(first + k) / n;
        out.phi[k] = at->phi[0] + out.share[k] * (at->phi[1] - at->phi[0]);
        if (k < out.zones) out.l[k] = at->s[first + k + 1] - at->s[first + k];
    }
    out.phi_rate = at->phi_rate[0] + (double)j / n * (at->phi_rate[1] - at->phi_rate[0]);
    return out;
}

static void friction_at(const fu_sheave *sheave, const view *at, int j, double *F, double numbers[3], double *power)
{
    const friction_point p = point_of(sheave, at, j);
    const fu_sheave_kernels *kernel = sheave->kernel;
    if (p.foot < 0)
        kernel->friction(sheave->A, sheave->sense, sheave->rho, sheave->radius, sheave->g, sheave->friction,
                         sheave->slip_velocity, p.phi, p.l, p.phi_rate, at->turn_rate, p.s_rate, F, numbers, power);
    else
        (p.foot ? kernel->friction_off : kernel->friction_on)(
            sheave->A, sheave->sense, sheave->rho, sheave->radius, sheave->g, sheave->friction, sheave->slip_velocity,
            p.phi, p.l, at->slope[p.foot], p.phi_rate, at->turn_rate, p.s_rate, F, numbers, power);
}

/* Inertia and weight of the wrap along the axis, in space, with this gravity along it. */
typedef struct {
    double T, V, f[SPACE], M[SPACE], D[SPACE * SPACE], K[SPACE * DIM];
} motion_across;

enum { OF_ACROSS = 3 };

/* Computes the places among y of w, s_a and s_b of the kernel. */
static void places_across(const fu_sheave *sheave, int at[OF_ACROSS])
{
    at[0] = ACROSS;
    at[1] = MATERIAL;
    at[2] = MATERIAL + sheave->n_zones;
}

static motion_across across_of(const fu_sheave *sheave, const view *at, double gravity)
{
    const int n = sheave->n_zones;
    const double s_rate[ENDS] = {at->s_rate[0], at->s_rate[n]};
    motion_across out;
    sheave->foot->across(sheave->rho, at->s[n] - at->s[0], at->across, gravity, at->across_rate, at->across_acc, s_rate,
                         &out.T, &out.V, out.f, out.M, out.D, out.K);
    return out;
}

/* Adds its forces by y. */
static void add_across(const fu_sheave *sheave, const view *at, double gravity, double *y)
{
    const motion_across motion = across_of(sheave, at, gravity);
    int place[OF_ACROSS];
    places_across(sheave, place);
    for (int i = 0; i < OF_ACROSS; ++i) y[place[i]] += motion.f[i];
}

/* Adds its derivatives by y: D by rates, K by places. */
static void add_across_matrices(const fu_sheave *sheave, const view *at, double factor, double (*D)[Y], double (*K)[Y])
{
    const motion_across motion = across_of(sheave, at, sheave->g[DIM]);
    int place[OF_ACROSS];
    places_across(sheave, place);
    for (int i = 0; i < OF_ACROSS; ++i) {
        for (int j = 0; j < OF_ACROSS; ++j) D[place[i]][place[j]] += factor * motion.D[i * OF_ACROSS + j];
        K[place[i]][ACROSS] += factor * motion.K[i * DIM];
        for (int e = 0; e < ENDS; ++e) K[place[i]][place[1 + e]] += (e ? factor : -factor) * motion.K[i * DIM + 1];
    }
}

/* Adds all forces by z but those of inertia: of both energies, of damping and friction. */
static void add_static_forces(const fu_sheave *sheave, const view *at, double *z)
{
    for (int j = 0; j < sheave->n_zones; ++j) {
        const zone of = zone_of(sheave, at, j);
        double f[U_MATERIAL + 1], u[U], damping[4];
        sheave->kernel->force(sheave->A, sheave->sense, sheave->rho, sheave->g, sheave->radius, of.phi, at->c, of.l, f);
        memcpy(u, f, sizeof(double) * U_MATERIAL);
        u[U_MATERIAL] = -f[U_MATERIAL];
        u[U_MATERIAL + 1] = f[U_MATERIAL];
        add_zone(&of, U, every, u, z);
        if (sheave->tau == 0.0) continue;
        sheave->kernel->damping_force(sheave->A, sheave->tau, sheave->radius, of.phi, of.l, of.phi_rate, of.s_rate,
                                      damping);
        add_zone(&of, 4, damped, damping, z);
    }
    for (int j = 0; has_friction(sheave) && j <= sheave->n_zones; ++j) {
        double F[3], numbers[3], power;
        const double share = (double)j / sheave->n_zones;
        friction_at(sheave, at, j, F, numbers, &power);
        z[0] += (1.0 - share) * F[0];
        z[1] += share * F[0];
        z[Z_TURN] += F[1];
        z[Z_MATERIAL + j] += F[2];
    }
}

/* Computes the conditions of both tangent points, their derivatives by x and slope (2 x 4 each), and those of J'
 * multipliers (4 x 4 each). */
static void conditions(const fu_sheave *sheave, const view *at, const double *multipliers, double *phi,
                       double (*J)[DIM * NODE], double (*K)[NODE * NODE])
{
    for (int k = 0; k < ENDS; ++k)
        sheave->kernel->tangent_point(at->x[k], at->slope[k], sheave->tangent_radius[k], multipliers + DIM * k,
                                      phi + DIM * k, J[k], K[k]);
}

/* Adds the forces of the tangent points on the dofs, in space. */
static void add_multipliers_in_space(const fu_sheave *sheave, const view *at, const double *multipliers, double *phi,
                                     double *f)
{
    for (int k = 0; k < ENDS; ++k, multipliers += FU_FOOT_CONDITIONS, phi += FU_FOOT_CONDITIONS) {
        double rows[FU_FOOT_CONDITIONS * FU_FOOT_DOFS];
        fu_tangent_point foot;
        fu_tangent_point_at(sheave, k, &at->centre, at->q, multipliers, &foot);
        fu_tangent_point_rows(&foot, rows);
        memcpy(phi, foot.phi, sizeof foot.phi);
        for (int r = 0; r < FU_FOOT_CONDITIONS; ++r)
            for (int j = 0; j < foot.n; ++j) f[foot.dofs[j]] += rows[r * foot.n + j] * multipliers[r];
    }
}

/* The same by y, without the forces on the chords: those on the nodes, and their opposites on the centre. */
static void add_multipliers_on_nodes(const fu_sheave *sheave, const view *at, const double *multipliers, double *phi,
                                     double *y)
{
    for (int k = 0; k < ENDS; ++k, multipliers += FU_FOOT_CONDITIONS, phi += FU_FOOT_CONDITIONS) {
        double on_node[SPACE] = {0.0}, in_groove[DIM];
        fu_tangent_point foot;
        fu_tangent_point_at(sheave, k, &at->centre, at->q, multipliers, &foot);
        memcpy(phi, foot.phi, sizeof foot.phi);
        for (int r = 0; r < FU_FOOT_CONDITIONS; ++r)
            for (int d = 0; d < SPACE; ++d) on_node[d] += foot.J[r * FU_FOOT_VECTORS + d] * multipliers[r];
        into_groove(sheave, on_node, in_groove);
        y[ACROSS] -= fu_dot(SPACE, sheave->axis, on_node);
        for (int d = 0; d < DIM; ++d) {
            y[k * NODE + d] += in_groove[d];
            y[CENTRE + d] -= in_groove[d];
        }
    }
}

/* Adds the forces of the tangent points by y. */
static void add_multipliers(const fu_sheave *sheave, const view *at, const double *multipliers, double *phi, double *y)
{
    double J[ENDS][DIM * NODE], K[ENDS][NODE * NODE];
    conditions(sheave, at, multipliers, phi, J, K);
    for (int k = 0; k < ENDS; ++k)
        for (int r = 0; r < DIM; ++r)
            for (int i = 0; i < NODE; ++i) {
                const double force = J[k][r * NODE + i] * multipliers[DIM * k + r];
                y[k * NODE + i] += force;
                if (i < DIM) y[CENTRE + i] -= force;
            }
}

/* Computes the force on the centre from forces by y. */
static void force_on_centre(const fu_sheave *sheave, const double *y, double out[SPACE])
{
    out[DIM] = 0.0;
    for (int d = 0; d < (sheave->foot ? SPACE : DIM); ++d)
        out[d] = sheave->foot ? fu_dot(DIM, sheave->groove + d * DIM, y + CENTRE) + sheave->axis[d] * y[ACROSS]
                              : y[CENTRE + d];
}

/* Computes the moment on the carrier from forces by y. */
static void moment_on_carrier(const fu_sheave *sheave, const double *y, double out[SPACE])
{
    for (int d = 0; d < SPACE; ++d) out[d] = sheave->foot ? sheave->axis[d] * y[TURN] : d ? 0.0 : y[TURN];
}

/* Adds forces by y to those on the dofs; in space there are none on the slopes. */
static void scatter(const fu_sheave *sheave, const view *at, const double *y, double *f)
{
    for (int k = 0; k < ENDS && !sheave->foot; ++k)
        for (int i = 0; i < NODE; ++i) f[sheave->nodes[k] + i] += y[k * NODE + i];
    for (int k = 0; k < ENDS && sheave->foot; ++k)
        for (int d = 0; d < SPACE; ++d) f[sheave->nodes[k] + d] += fu_dot(DIM, sheave->groove + d * DIM, y + k * NODE);
    for (int j = 0; j <= sheave->n_zones; ++j) f[sheave->s[j]] += y[MATERIAL + j];
    if (sheave->turn >= 0) f[sheave->turn] += y[TURN];
    double on_centre[SPACE], moment[SPACE];
    force_on_centre(sheave, y, on_centre);
    moment_on_carrier(sheave, y, moment);
    fu_add_wrench(sheave->foot ? SPACE : DIM, &at->centre, on_centre, moment, 1.0, f);
}

/* Adds the moment of the bearing, between the sheave and its carrier. */
static void add_bearing(const fu_sheave *sheave, const view *at, double *f)
{
    if (sheave->turn >= 0) f[sheave->turn] += sheave->damping * at->own_rate;
}

static void inertial_force(const fu_model *model, const fu_coupling *coupling, const double *q, const double *a,
                           double *f)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const fu_state state = {.q = (double *)q, .v = (double *)model->zero};
    view at;
    double z[Z] = {0.0}, y[Y] = {0.0};
    look(model, coupling, &state, a, &at);
    add_inertia(sheave, &at, z);
    add_by_angles(sheave, &at, z, y);
    if (sheave->foot) add_across(sheave, &at, 0.0, y);
    scatter(sheave, &at, y, f);
}

/* --- derivatives ------------------------------------------------------------------------------------------------ */

/* The changes of z by the places of the nodes and the centre, which alone are not those of y: rows of the angles. */
static void of_angles(double (*by_x)[DIM], double (*J)[Y])
{
    memset(J, 0, sizeof(double) * ENDS * Y);
    for (int k = 0; k < ENDS; ++k)
        for (int d = 0; d < DIM; ++d) {
            J[k][k * NODE + d] = by_x[k][d];
            J[k][CENTRE + d] = -by_x[k][d];
        }
}

/* Adds J' A to B (Y x n_columns), where rows of z beside the angles are rows of y. */
static void add_from_left(const fu_sheave *sheave, double (*J)[Y], double (*A)[Y], double (*B)[Y])
{
    for (int k = 0; k < columns(sheave); ++k)
        for (int i = 0; i < (k < ENDS ? MATERIAL : 1); ++i) {
            const int row = k < ENDS ? i : among_y(k);
            const double factor = k < ENDS ? J[k][i] : 1.0;
            for (int j = 0; factor != 0.0 && j < Y; ++j) B[row][j] += factor * A[k][j];
        }
}

/* Adds J' A B to K, of A (Z x Z), J and B the changes of the angles by y; all: B has the other changes of z, too. */
static void add_product(const fu_sheave *sheave, double (*J)[Y], double (*A)[Z], double (*B)[Y], int all,
                        double (*K)[Y])
{
    double AB[Z][Y];
    memset(AB, 0, sizeof AB);
    for (int i = 0; i < columns(sheave); ++i) {
        for (int k = 0; k < ENDS; ++k)
            for (int j = 0; A[i][k] != 0.0 && j < MATERIAL; ++j) AB[i][j] += A[i][k] * B[k][j];
        for (int k = Z_SLOPE; all && k < columns(sheave); ++k) AB[i][among_y(k)] += A[i][k];
    }
    add_from_left(sheave, J, AB, K);
}

/* Adds to K the change of forces by the angles where these turn: the second derivatives of the angles by x. */
static void add_turning(const view *at, double factor, const double *of_z, double (*K)[Y])
{
    for (int k = 0; k < ENDS; ++k)
        for (int i = 0; i < DIM; ++i)
            for (int j = 0; j < DIM; ++j) {
                const double value = factor * of_z[k] * at->phi_xx[k][i * DIM + j];
                K[k * NODE + i][k * NODE + j] += value;
                K[k * NODE + i][CENTRE + j] -= value;
                K[CENTRE + i][k * NODE + j] -= value;
                K[CENTRE + i][CENTRE + j] += value;
            }
}

/* Adds the mass matrix, and the derivatives of the inertial forces by rates and places, each null where not needed. */
static void add_inertia_matrices(const fu_sheave *sheave, const view *at, double factor, double (*M)[Z], double (*D)[Z],
                                 double (*K)[Z])
{
    if (M) M[Z_TURN][Z_TURN] += factor * sheave->inertia;
    for (int j = 0; j < sheave->n_zones; ++j) {
        const zone of = zone_of(sheave, at, j);
        double M_u[U * U], D_u[U * U], K_u[U * 3];
        sheave->kernel->inertia_tangent(sheave->rho, sheave->radius, of.phi, of.l, of.phi_rate, at->c_rate, of.s_rate,
                                        of.phi_acc, at->c_acc, of.s_acc, M_u, D_u, K_u);
        if (M) add_zone_matrix(&of, U, every, U, every, factor, M_u, M);
        if (D) add_zone_matrix(&of, U, every, U, every, factor, D_u, D);
        if (K) add_zone_matrix(&of, U, every, 3, of_zone, factor, K_u, K);
    }
}

/* Adds the derivatives of friction at the j-th point. */
static void add_friction_matrices(const fu_sheave *sheave, const view *at, int j, double factor, double (*D)[Z],
                                  double (*K)[Z])
{
    const friction_point p = point_of(sheave, at, j);
    const fu_sheave_kernels *kernel = sheave->kernel;
    const double share = (double)j / sheave->n_zones;
    const int row[3] = {0, Z_TURN, Z_MATERIAL + j}, places = 2 * p.zones + 1 + (p.foot < 0 ? 0 : DIM);
    double of_place[3 * (3 + SIDES + DIM)], of_rate[3 * 3];
    if (p.foot < 0)
        kernel->friction_tangent(sheave->A, sheave->sense, sheave->rho, sheave->radius, sheave->g, sheave->friction,
                                 sheave->slip_velocity, p.phi, p.l, p.phi_rate, at->turn_rate, p.s_rate, of_place,
                                 of_rate);
    else
        (p.foot ? kernel->friction_off_tangent : kernel->friction_on_tangent)(
            sheave->A, sheave->sense, sheave->rho, sheave->radius, sheave->g, sheave->friction, sheave->slip_velocity,
            p.phi, p.l, at->slope[p.foot], p.phi_rate, at->turn_rate, p.s_rate, of_place, of_rate);
    for (int i = 0; i < 3; ++i)
        for (int e = 0; e < (i ? 1 : ENDS); ++e) { /* a force on the angle is one on those of both tangent points */
            double *to_K = K[i ? row[i] : e], *to_D = D[i ? row[i] : e];
            const double part = factor * (i ? 1.0 : e ? share : 1.0 - share), *of = of_place + i * places;
            for (int k = 0; k <= p.zones; ++k) {
                to_K[0] += part * (1.0 - p.share[k]) * of[k];
                to_K[1] += part * p.share[k] * of[k];
            }
            for (int k = 0; k < p.zones; ++k) {
                to_K[Z_MATERIAL + p.first + k + 1] += part * of[p.zones + 1 + k];
                to_K[Z_MATERIAL + p.first + k] -= part * of[p.zones + 1 + k];
            }
            for (int d = 0; p.foot >= 0 && d < DIM; ++d)
                to_K[Z_SLOPE + p.foot * DIM + d] += part * of[2 * p.zones + 1 + d];
            to_D[0] += part * (1.0 - share) * of_rate[i * 3];
            to_D[1] += part * share * of_rate[i * 3];
            to_D[Z_TURN] += part * of_rate[i * 3 + 1];
            to_D[Z_MATERIAL + j] += part * of_rate[i * 3 + 2];
        }
}

/* Adds the derivatives of the other forces by rates and places. */
static void add_static_matrices(const fu_sheave *sheave, const view *at, double factor, double (*D)[Z], double (*K)[Z])
{
    for (int j = 0; j < sheave->n_zones; ++j) {
        const zone of = zone_of(sheave, at, j);
        double K_u[5 * 5], D_4[4 * 4], K_4[4 * 3];
        sheave->kernel->tangent(sheave->A, sheave->sense, sheave->rho, sheave->g, sheave->radius, of.phi, at->c, of.l,
                                K_u);
        add_zone_matrix(&of, 5, with_length, 5, with_length, factor, K_u, K);
        if (sheave->tau == 0.0) continue;
        sheave->kernel->damping_tangent(sheave->A, sheave->tau, sheave->radius, of.phi, of.l, of.phi_rate, of.s_rate,
                                        D_4, K_4);
        add_zone_matrix(&of, 4, damped, 3, of_zone, factor, K_4, K);
        add_zone_matrix(&of, 4, damped, 4, damped, factor, D_4, D);
    }
    for (int j = 0; has_friction(sheave) && j <= sheave->n_zones; ++j)
        add_friction_matrices(sheave, at, j, factor, D, K);
}

/* The dofs of a sheave and the change of y by them (Y x n), in `by`. */
static int columns_of(const fu_sheave *sheave, const view *at, const double *of_centre, int *dofs,
                      double (*by)[COLUMNS])
{
    int n = 0;
    memset(by, 0, sizeof(double) * Y * COLUMNS);
    for (int k = 0; k < ENDS && !sheave->foot; ++k)
        for (int i = 0; i < NODE; ++i, ++n) {
            dofs[n] = sheave->nodes[k] + i;
            by[k * NODE + i][n] = 1.0;
        }
    for (int k = 0; k < ENDS && sheave->foot; ++k)
        for (int i = 0; i < 2 * SPACE; ++i, ++n) {
            dofs[n] = sheave->nodes[k] + i;
            if (i >= SPACE) by[k * NODE + SLOPE][n] = at->stretch[k][i - SPACE];
            for (int j = 0; i < SPACE && j < DIM; ++j) by[k * NODE + j][n] = sheave->groove[i * DIM + j];
        }
    for (int j = 0; j <= sheave->n_zones; ++j, ++n) {
        dofs[n] = sheave->s[j];
        by[MATERIAL + j][n] = 1.0;
    }
    if (sheave->turn >= 0) {
        dofs[n] = sheave->turn;
        by[TURN][n++] = 1.0;
    }
    for (int i = 0; i < at->centre.n; ++i, ++n) {
        dofs[n] = at->centre.at[i];
        for (int d = 0; d < DIM && !sheave->foot; ++d) by[CENTRE + d][n] = of_centre[d * at->centre.n + i];
        for (int d = 0; d < SPACE && sheave->foot; ++d) {
            const double change = of_centre[d * at->centre.n + i];
            for (int j = 0; j < DIM; ++j) by[CENTRE + j][n] += sheave->groove[d * DIM + j] * change;
            by[ACROSS][n] += sheave->axis[d] * change;
        }
        by[TURN][n] = about_axis(sheave, at->centre.T + i, at->centre.n);
    }
    return n;
}

/* Adds by' K by_column of K (Y x Y) to a system. */
static void add_matrix(const fu_model *model, const fu_sheave *sheave, const view *at, const double *of_centre,
                       double (*K)[Y], fu_system *system)
{
    double by[Y][COLUMNS], by_column[Y][COLUMNS];
    int dofs[COLUMNS];
    const int n = columns_of(sheave, at, at->centre.P, dofs, by);
    columns_of(sheave, at, of_centre, dofs, by_column);
    for (int j = 0; j < n; ++j) {
        double column[Y];
        for (int i = 0; i < Y; ++i) {
            column[i] = 0.0;
            for (int k = 0; k < Y; ++k)
                if (by_column[k][j] != 0.0) column[i] += K[i][k] * by_column[k][j];
        }
        for (int i = 0; i < n; ++i) {
            double sum = 0.0;
            for (int k = 0; k < Y; ++k)
                if (by[k][i] != 0.0) sum += by[k][i] * column[k];
            if (sum != 0.0) fu_add(model, system, dofs[i], dofs[j], sum);
        }
    }
}

static void mass_matrix(const fu_model *model, const fu_coupling *coupling, const double *q, double scale,
                        fu_system *system)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const fu_state state = {.q = (double *)q, .v = (double *)model->zero};
    double M[Z][Z], J[ENDS][Y], K[Y][Y];
    view at;
    look(model, coupling, &state, 0, &at);
    memset(M, 0, sizeof M);
    memset(K, 0, sizeof K);
    add_inertia_matrices(sheave, &at, scale, M, 0, 0);
    of_angles(at.phi_x, J);
    add_product(sheave, J, M, J, 1, K);
    if (sheave->foot) K[ACROSS][ACROSS] += scale * across_of(sheave, &at, 0.0).M[0];
    add_matrix(model, sheave, &at, at.centre.P, K, system);
}

static double kinetic_energy(const fu_model *model, const fu_coupling *coupling, double t, const double *q,
                             const double *v, int past_fluid)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const fu_state state = {.q = (double *)q, .v = (double *)v};
    view at;
    (void)t, (void)past_fluid;
    look(model, coupling, &state, 0, &at);
    double total = 0.5 * sheave->inertia * at.turn_rate * at.turn_rate;
    if (sheave->foot) total += across_of(sheave, &at, 0.0).T;
    for (int j = 0; j < sheave->n_zones; ++j) {
        const zone of = zone_of(sheave, &at, j);
        double T;
        sheave->kernel->kinetic_energy(sheave->rho, sheave->radius, of.phi, of.l, of.phi_rate, at.c_rate, of.s_rate,
                                       &T);
        total += T;
    }
    return total;
}

static double potential_energy(const fu_model *model, const fu_coupling *coupling, const double *q)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const fu_state state = {.q = (double *)q, .v = (double *)model->zero};
    view at;
    double total = 0.0;
    look(model, coupling, &state, 0, &at);
    for (int j = 0; j < sheave->n_zones; ++j) {
        const zone of = zone_of(sheave, &at, j);
        double V;
        sheave->kernel->weight(sheave->rho, sheave->g, sheave->radius, of.phi, at.c, of.l, &V);
        total += V;
    }
    if (sheave->foot) total += across_of(sheave, &at, sheave->g[DIM]).V;
    return total;
}

/* --- the coupling ----------------------------------------------------------------------------------------------- */

/* Computes all forces by y but those of the tangent points, with these accelerations. */
static void forces_by_y(const fu_sheave *sheave, const view *at, double *y)
{
    double z[Z] = {0.0};
    memset(y, 0, sizeof(double) * Y);
    add_inertia(sheave, at, z);
    add_static_forces(sheave, at, z);
    add_by_angles(sheave, at, z, y);
    if (sheave->foot) add_across(sheave, at, sheave->g[DIM], y);
}

static void force(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *f)
{
    view at;
    double y[Y];
    look(model, coupling, state, 0, &at);
    forces_by_y(sheave_of(coupling), &at, y);
    scatter(sheave_of(coupling), &at, y, f);
    add_bearing(sheave_of(coupling), &at, f);
}

static void residual(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations, double *f,
                     double *internal)
{
    const fu_sheave *sheave = sheave_of(coupling);
    view at;
    double y[Y], phi[MAX_CONDITIONS];
    look(model, coupling, equations->next, 0, &at);
    forces_by_y(sheave, &at, y);
    (sheave->foot ? add_multipliers_in_space : add_multipliers)(sheave, &at, equations->next->forces + coupling->force,
                                                                phi, sheave->foot ? f : y);
    scatter(sheave, &at, y, f);
    add_bearing(sheave, &at, f);
    for (int r = 0; r < ENDS * conditions_of(sheave); ++r)
        internal[coupling->unknown + r] = -fu_row_unit(equations->weights.inertia, coupling->scale[r]) * phi[r];
}

/* Adds the derivatives of the conditions of a tangent point, and of their forces, in space. */
static void add_foot(const fu_model *model, const fu_coupling *coupling, const fu_tangent_point *foot, int first,
                     const double *by_psi, const fu_equations *equations, fu_system *system)
{
    const int own = fu_extra(model, coupling->unknown) + first, n = foot->n;
    const double *multipliers = equations->next->forces + coupling->force + first;
    double rows[FU_FOOT_CONDITIONS * FU_FOOT_DOFS], columns[FU_FOOT_CONDITIONS * FU_FOOT_DOFS],
        K[FU_FOOT_DOFS * FU_FOOT_DOFS];
    fu_tangent_point turned = *foot;
    fu_tangent_point_turn(by_psi, &turned);
    fu_tangent_point_rows(&turned, rows);
    fu_tangent_point_rows(foot, columns);
    fu_tangent_point_stiffness(foot, &turned, multipliers, K);
    for (int j = 0; j < n; ++j) {
        for (int r = 0; r < FU_FOOT_CONDITIONS; ++r) {
            const double unit = fu_row_unit(equations->weights.inertia, coupling->scale[first + r]);
            if (rows[r * n + j] != 0.0) fu_add(model, system, own + r, foot->dofs[j], unit * rows[r * n + j]);
            if (columns[r * n + j] != 0.0) fu_add(model, system, foot->dofs[j], own + r, unit * columns[r * n + j]);
        }
        for (int i = 0; i < n; ++i)
            if (K[i * n + j] != 0.0)
                fu_add(model, system, foot->dofs[i], foot->dofs[j], equations->weights.stiffness * K[i * n + j]);
    }
}

static void add_conditions_in_space(const fu_model *model, const fu_coupling *coupling, const view *at,
                                    const fu_equations *equations, const double *by_psi, fu_system *system)
{
    for (int k = 0; k < ENDS; ++k) {
        const int first = FU_FOOT_CONDITIONS * k;
        fu_tangent_point foot;
        fu_tangent_point_at(sheave_of(coupling), k, &at->centre, at->q,
                            equations->next->forces + coupling->force + first, &foot);
        add_foot(model, coupling, &foot, first, by_psi, equations, system);
    }
}

/* Adds the derivatives of the conditions, and of their forces, in the plane. */
static void add_conditions(const fu_model *model, const fu_coupling *coupling, const view *at,
                           const fu_equations *equations, const double *by_psi, double (*K_y)[Y], fu_system *system)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const int own = fu_extra(model, coupling->unknown);
    double phi[MAX_CONDITIONS], J[ENDS][DIM * NODE], K[ENDS][NODE * NODE], by[Y][COLUMNS], by_column[Y][COLUMNS];
    int dofs[COLUMNS];
    conditions(sheave, at, equations->next->forces + coupling->force, phi, J, K);
    const int n = columns_of(sheave, at, at->centre.P, dofs, by);
    columns_of(sheave, at, by_psi, dofs, by_column);
    for (int k = 0; k < ENDS; ++k) {
        for (int i = 0; i < NODE; ++i)
            for (int j = 0; j < NODE; ++j) {
                const double value = equations->weights.stiffness * K[k][i * NODE + j];
                K_y[k * NODE + i][k * NODE + j] += value;
                if (j < DIM) K_y[k * NODE + i][CENTRE + j] -= value;
                if (i < DIM) K_y[CENTRE + i][k * NODE + j] -= value;
                if (i < DIM && j < DIM) K_y[CENTRE + i][CENTRE + j] += value;
            }
        for (int r = 0; r < DIM; ++r)
            for (int j = 0; j < n; ++j) {
                const double unit = fu_row_unit(equations->weights.inertia, coupling->scale[DIM * k + r]);
                double row = 0.0, column = 0.0;
                for (int i = 0; i < NODE; ++i) {
                    const double value = J[k][r * NODE + i];
                    row += value * (by_column[k * NODE + i][j] - (i < DIM ? by_column[CENTRE + i][j] : 0.0));
                    column += value * (by[k * NODE + i][j] - (i < DIM ? by[CENTRE + i][j] : 0.0));
                }
                if (row != 0.0) fu_add(model, system, own + DIM * k + r, dofs[j], unit * row);
                if (column != 0.0) fu_add(model, system, dofs[j], own + DIM * k + r, unit * column);
            }
    }
}

/* Adds the change of the force and the moment on the carrier with its motion, at fixed ones. */
static void add_centre(const fu_model *model, const fu_sheave *sheave, const view *at, const fu_equations *equations,
                       const double *y, fu_system *system)
{
    const int n = at->centre.n;
    double on_centre[SPACE], moment[SPACE], K[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
    if (!n) return;
    force_on_centre(sheave, y, on_centre);
    moment_on_carrier(sheave, y, moment);
    fu_wrench_derivatives(model, &sheave->attachments[0], equations->next, on_centre, moment, n, K, 0, 0);
    fu_turn_attachment(model, &sheave->attachments[0], equations->psi, K, n, n, 0);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            if (K[i * n + j] != 0.0)
                fu_add(model, system, at->centre.at[i], at->centre.at[j], equations->weights.stiffness * K[i * n + j]);
}

/* Adds the derivatives by y of all forces but those of the tangent points: D by rates, K by places. */
static void add_derivatives(const fu_sheave *sheave, view *at, fu_weights w, double (*D)[Y], double (*K)[Y])
{
    double M_z[Z][Z], D_z[Z][Z], K_z[Z][Z], J[ENDS][Y], by[ENDS][Y], z[Z] = {0.0};
    memset(M_z, 0, sizeof M_z);
    memset(D_z, 0, sizeof D_z);
    memset(K_z, 0, sizeof K_z);
    if (w.inertia != 0.0 || w.rate != 0.0) add_inertia_matrices(sheave, at, w.stiffness, M_z, D_z, K_z);
    add_static_matrices(sheave, at, w.stiffness, D_z, K_z);
    of_angles(at->phi_x, J);
    add_product(sheave, J, K_z, J, 1, K);
    of_angles(at->rate_x, by);
    add_product(sheave, J, D_z, by, 0, K);
    of_angles(at->acc_x, by);
    add_product(sheave, J, M_z, by, 0, K);
    add_product(sheave, J, D_z, J, 1, D);
    of_angles(at->acc_v, by);
    add_product(sheave, J, M_z, by, 0, D);
    add_inertia(sheave, at, z);
    add_static_forces(sheave, at, z);
    add_turning(at, w.stiffness, z, K);
    if (sheave->foot) add_across_matrices(sheave, at, w.stiffness, D, K);
}

/* Adds the tangent; derivatives of the acceleration of the centre by rotations of its body are neglected. */
static void tangent(const fu_model *model, const fu_coupling *coupling, const fu_equations *equations,
                    fu_system *system)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const fu_weights w = equations->weights;
    const fu_state *next = equations->next;
    double K[Y][Y], D[Y][Y], y[Y], phi[MAX_CONDITIONS], by_psi[SPACE * FU_ATTACHMENT_COORDINATES];
    view at;
    look(model, coupling, next, next->acceleration, &at);
    memset(K, 0, sizeof K);
    memset(D, 0, sizeof D);
    add_derivatives(sheave, &at, w, D, K);
    memcpy(by_psi, at.centre.P, sizeof(double) * (size_t)(model->dim * at.centre.n));
    fu_turn_attachment(model, &sheave->attachments[0], equations->psi, by_psi, model->dim, at.centre.n, 0);
    if (sheave->foot) add_conditions_in_space(model, coupling, &at, equations, by_psi, system);
    else add_conditions(model, coupling, &at, equations, by_psi, K, system);
    add_matrix(model, sheave, &at, by_psi, K, system);
    for (int i = 0; i < Y; ++i)
        for (int j = 0; j < Y; ++j) D[i][j] *= w.rate;
    if (w.rate != 0.0) add_matrix(model, sheave, &at, at.centre.P, D, system);
    if (sheave->turn >= 0 && sheave->damping != 0.0)
        fu_add(model, system, sheave->turn, sheave->turn, w.stiffness * w.rate * sheave->damping);
    forces_by_y(sheave, &at, y);
    (sheave->foot ? add_multipliers_on_nodes : add_multipliers)(sheave, &at, next->forces + coupling->force, phi, y);
    add_centre(model, sheave, &at, equations, y, system);
}

static void rows_in_space(const fu_model *model, const fu_sheave *sheave, const fu_state *state, fu_rows *out)
{
    const double none[FU_FOOT_CONDITIONS] = {0.0};
    fu_attachment_state centre;
    fu_attachment_at(model, &sheave->attachments[0], state, 0.0, FU_POINT, &centre);
    for (int k = 0; k < ENDS; ++k) {
        double rows[FU_FOOT_CONDITIONS * FU_FOOT_DOFS], bias[FU_FOOT_CONDITIONS];
        fu_tangent_point foot;
        fu_tangent_point_at(sheave, k, &centre, state->q, none, &foot);
        fu_tangent_point_rows(&foot, rows);
        fu_tangent_point_bias(sheave, k, &foot, &centre, state->q, state->v, bias);
        out->n = ENDS * foot.n;
        memcpy(out->at + k * foot.n, foot.dofs, sizeof(int) * (size_t)foot.n);
        for (int r = 0; r < FU_FOOT_CONDITIONS; ++r) {
            const int row = FU_FOOT_CONDITIONS * k + r;
            double *H = out->H + row * out->n;
            out->C[row] = foot.phi[r];
            out->rate[row] = 0.0;
            out->W[row] = -bias[r];
            memset(H, 0, sizeof(double) * (size_t)out->n);
            memcpy(H + k * foot.n, rows + r * foot.n, sizeof(double) * (size_t)foot.n);
        }
    }
}

static void rows(const fu_model *model, const fu_coupling *coupling, const fu_state *state, fu_accelerator *work)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const double none[MAX_CONDITIONS] = {0.0};
    fu_rows *out = &work->rows[coupling->row];
    if (sheave->foot) {
        rows_in_space(model, sheave, state, out);
        return;
    }
    double J[ENDS][DIM * NODE], K[ENDS][NODE * NODE], by[Y][COLUMNS];
    view at;
    look(model, coupling, state, 0, &at);
    conditions(sheave, &at, none, out->C, J, K);
    out->n = columns_of(sheave, &at, at.centre.P, out->at, by);
    for (int k = 0; k < ENDS; ++k) {
        double bias[DIM];
        sheave->kernel->tangent_point_motion(at.x[k], at.x_rate[k], at.slope_rate[k], bias);
        for (int r = 0; r < DIM; ++r) {
            const int row = DIM * k + r;
            const double *of = J[k] + r * NODE;
            out->rate[row] = 0.0;
            out->W[row] = -bias[r];
            for (int d = 0; d < DIM; ++d) out->W[row] += of[d] * at.centre.bias[d];
            for (int j = 0; j < out->n; ++j) {
                double value = 0.0;
                for (int i = 0; i < NODE; ++i)
                    value += of[i] * (by[k * NODE + i][j] - (i < DIM ? by[CENTRE + i][j] : 0.0));
                out->H[row * out->n + j] = value;
            }
        }
    }
}

static void take_forces(const fu_model *model, const fu_coupling *coupling, const fu_accelerator *work, fu_state *state)
{
    (void)model;
    memcpy(state->forces + coupling->force, work->multipliers + coupling->multiplier,
           sizeof(double) * (size_t)(ENDS * conditions_of(sheave_of(coupling))));
}

static void gaps(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *phi)
{
    double J[ENDS][DIM * NODE], K[ENDS][NODE * NODE];
    view at;
    look(model, coupling, state, 0, &at);
    if (sheave_of(coupling)->foot) {
        double y[Y] = {0.0};
        add_multipliers_on_nodes(sheave_of(coupling), &at, state->forces + coupling->force, phi, y);
        return;
    }
    conditions(sheave_of(coupling), &at, state->forces + coupling->force, phi, J, K);
}

static double energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_sheave *sheave = sheave_of(coupling);
    double total = 0.0;
    view at;
    look(model, coupling, state, 0, &at);
    for (int j = 0; j < sheave->n_zones; ++j) {
        const zone of = zone_of(sheave, &at, j);
        double stored;
        sheave->kernel->energy(sheave->A, sheave->sense, sheave->radius, of.phi, of.l, &stored);
        total += stored;
    }
    return total;
}

static double dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                          const fu_accelerator *work)
{
    const fu_sheave *sheave = sheave_of(coupling);
    double total = 0.0, power;
    view at;
    (void)work;
    if (!coupling->is_damped) return 0.0;
    look(model, coupling, state, 0, &at);
    total += sheave->damping * at.own_rate * at.own_rate;
    for (int j = 0; sheave->tau > 0.0 && j < sheave->n_zones; ++j) {
        const zone of = zone_of(sheave, &at, j);
        sheave->kernel->dissipation(sheave->A, sheave->tau, sheave->radius, of.phi, of.l, of.phi_rate, of.s_rate,
                                    &power);
        total += power;
    }
    for (int j = 0; has_friction(sheave) && j <= sheave->n_zones; ++j) {
        double F[3], numbers[3];
        friction_at(sheave, &at, j, F, numbers, &power);
        total += power;
    }
    return total;
}

/* Subtracts the torque of the drive. */
static void drive(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double *f)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const int signal = sheave->torque_signal;
    (void)q;
    if (sheave->turn < 0 || sheave->torque == 0.0) return;
    f[sheave->turn] -=
        model->load_fraction * sheave->torque * (signal < 0 ? 1.0 : fu_signal_at(&model->signals[signal], t, 0, 0));
}

static int may_be_open(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    (void)model, (void)coupling, (void)state;
    return 1;
}

/* Returns the stretch of the span at a tangent point, in the plane along the groove. */
static double stretch_along(const fu_sheave *sheave, const view *at, int k, const double t[DIM])
{
    return sheave->foot ? at->slope[k][0] : fu_dot(DIM, t, at->slope[k]);
}

/* Returns the arm of a force along the groove over that of the tension, which in space leaves it at a fleet angle. */
static double arm_over_radius(const fu_sheave *sheave, const view *at, int k)
{
    return sheave->foot ? sqrt(fu_dot(DIM, at->x[k], at->x[k])) / sheave->tangent_radius[k] : 1.0;
}

/* Computes the tension at both tangent points from the balance of momentum at the nodes, through which material passes,
 * along the groove in the sense of travel, with the accelerations of `at`; the speed of the material past the centre;
 * and all forces by y. */
static void tensions(const fu_sheave *sheave, const view *at, const double *multipliers, double tension[ENDS],
                     double speed[ENDS], double phi[MAX_CONDITIONS], double y[Y])
{
    forces_by_y(sheave, at, y);
    (sheave->foot ? add_multipliers_on_nodes : add_multipliers)(sheave, at, multipliers, phi, y);
    for (int k = 0; k < ENDS; ++k) {
        const double s_rate = at->s_rate[k ? sheave->n_zones : 0];
        const double t[DIM] = {-sheave->sense * sin(at->phi[k]), sheave->sense * cos(at->phi[k])};
        const double along = arm_over_radius(sheave, at, k) * fu_dot(DIM, t, y + k * NODE);
        speed[k] = fu_dot(DIM, t, at->x_rate[k]) - stretch_along(sheave, at, k, t) * s_rate;
        const double velocity = speed[k] + fu_dot(DIM, t, at->c_rate);
        tension[k] = (k ? along : -along) - sheave->rho * s_rate * velocity;
    }
}

/* Returns the part of gravity, and of the acceleration of the centre, outwards at an angle. */
static double outwards(const fu_sheave *sheave, const view *at, double phi)
{
    return (sheave->g[0] - at->c_acc[0]) * cos(phi) + (sheave->g[1] - at->c_acc[1]) * sin(phi);
}

/* Returns the normal force on an angle: of a tension at a speed and a stretch of the rope. */
static double pressure(const fu_sheave *sheave, const view *at, double phi, double tension, double speed,
                       double stretch)
{
    return tension - sheave->rho / stretch * (speed * speed + sheave->radius * outwards(sheave, at, phi));
}

/* Returns the tension at an angle of a zone with this mean: it grows with the height, as on a smooth groove. */
static double tension_in(const fu_sheave *sheave, const view *at, const zone *of, double phi, double mean)
{
    const double half = 0.5 * (of->phi[1] - of->phi[0]), middle = 0.5 * (of->phi[0] + of->phi[1]);
    const double below = outwards(sheave, at, phi) - sin(half) / half * outwards(sheave, at, middle);
    return mean - sheave->rho * sheave->radius * below;
}

/* Returns the least normal force on an angle, N: of the zones at ends and middle, and of both tangent points with these
 * tensions. */
static double least_pressure(const fu_sheave *sheave, const view *at, const double tension[ENDS],
                             const double speeds[ENDS])
{
    double least = INFINITY;
    for (int k = 0; k < ENDS; ++k)
        least = fmin(least, pressure(sheave, at, at->phi[k], tension[k], speeds[k], stretch_at(at, k)));
    for (int j = 0; j < sheave->n_zones; ++j) {
        const zone of = zone_of(sheave, at, j);
        const double stretch = sheave->sense * sheave->radius * (of.phi[1] - of.phi[0]) / of.l;
        const double inside = sheave->A[0] * (stretch - 1.0);
        for (int part = j ? 0 : 1; part < (j + 1 < sheave->n_zones ? 3 : 2); ++part) { /* its inner end, the middle */
            const double x = 0.5 * part, rate = (1.0 - x) * of.phi_rate[0] + x * of.phi_rate[1];
            const double flow = (1.0 - x) * of.s_rate[0] + x * of.s_rate[1];
            const double speed = sheave->sense * sheave->radius * rate - stretch * flow;
            const double phi = (1.0 - x) * of.phi[0] + x * of.phi[1];
            const double tension = tension_in(sheave, at, &of, phi, inside);
            least = fmin(least, pressure(sheave, at, phi, tension, speed, stretch));
        }
    }
    return least;
}

double fu_wrap_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_sheave *sheave = sheave_of(coupling);
    view at;
    look(model, coupling, state, 0, &at);
    return sheave->sense * (at.phi[1] - at.phi[0]) - sheave->least_wrap;
}

/* A span is a minimum of the energy R phi + l while its length along the groove is above R tan f: else the tangent
 * point runs away along the groove. The margin has a reserve. */
double fu_fleet_margin(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const double reserve = 3.0;
    double least = INFINITY;
    (void)model;
    for (int k = 0; k < ENDS; ++k) {
        const double fleet = fu_fleet_angle(sheave, k, state->q);
        const double length = state->q[sheave->span_s[ENDS * k + 1]] - state->q[sheave->span_s[ENDS * k]];
        least = fmin(least, length * cos(fleet) - reserve * sheave->radius * tan(fabs(fleet)));
    }
    return least;
}

/* Computes the tensions at both tangent points from the stretch of the spans there, and the speeds of the material. */
static void elastic_tensions(const fu_sheave *sheave, const view *at, double tension[ENDS], double speed[ENDS])
{
    for (int k = 0; k < ENDS; ++k) {
        const double t[DIM] = {-sheave->sense * sin(at->phi[k]), sheave->sense * cos(at->phi[k])};
        const double stretch = stretch_along(sheave, at, k, t);
        speed[k] = fu_dot(DIM, t, at->x_rate[k]) - stretch * at->s_rate[k ? sheave->n_zones : 0];
        tension[k] = sheave->A[0] * (stretch - 1.0);
    }
}

/* Without friction the tension at the tangent points is from the balance of the arc alone: multipliers of short steps
 * have little accuracy. With friction it is elastic: friction on a light rope accelerates its nodes at once. */
static double wrap_pressure(const fu_sheave *sheave, const view *at)
{
    const double none[MAX_CONDITIONS] = {0.0};
    double tension[ENDS], speed[ENDS], phi[MAX_CONDITIONS], y[Y];
    if (has_friction(sheave)) elastic_tensions(sheave, at, tension, speed);
    else tensions(sheave, at, none, tension, speed, phi, y);
    return least_pressure(sheave, at, tension, speed);
}

double fu_wrap_pressure(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    view at;
    look(model, coupling, state, state->acceleration, &at);
    return wrap_pressure(sheave_of(coupling), &at);
}

/* Returns in words what exceeds the limits of the engine. */
static const char *excess(const fu_coupling *coupling)
{
    return sheave_of(coupling)->n_zones > MAX_ZONES ? "zones" : 0;
}

static void outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                    const double *acceleration, const fu_accelerator *work, double *out)
{
    const fu_sheave *sheave = sheave_of(coupling);
    const double *multipliers = work ? work->multipliers + coupling->multiplier : state->forces + coupling->force;
    sheave_output *numbers = (sheave_output *)out;
    view at;
    double y[Y], phi[MAX_CONDITIONS], tension[ENDS], speed[ENDS], on_centre[SPACE];
    look(model, coupling, state, acceleration, &at);
    tensions(sheave, &at, multipliers, tension, speed, phi, y);
    *numbers = (sheave_output){.tension_on = tension[0], .tension_off = tension[1]};
    numbers->wrap_angle = sheave->sense * (at.phi[1] - at.phi[0]);
    force_on_centre(sheave, y, on_centre);
    for (int d = 0; d < SPACE; ++d) numbers->force[d] = -on_centre[d] + 0.0; /* no -0 */
    numbers->fleet_angle_on = sheave->foot ? fu_fleet_angle(sheave, 0, state->q) : 0.0;
    numbers->fleet_angle_off = sheave->foot ? fu_fleet_angle(sheave, 1, state->q) : 0.0;
    numbers->material_speed = -0.5 * (at.s_rate[0] + at.s_rate[sheave->n_zones]);
    numbers->normal_force = wrap_pressure(sheave, &at);
    numbers->angle = sheave->turn < 0 ? 0.0 : state->q[sheave->turn];
    for (int j = 0; has_friction(sheave) && j <= sheave->n_zones; ++j) {
        double F[3], of[3], power;
        friction_at(sheave, &at, j, F, of, &power);
        if (fabs(of[0]) > fabs(numbers->slip)) numbers->slip = of[0];
        numbers->torque -= F[1];
    }
    for (int r = 0; r < ENDS * conditions_of(sheave); ++r) numbers->residual = fmax(numbers->residual, fabs(phi[r]));
}

static const char *const foot_role[] = {"tangent_point", 0};

static const fu_field fields[] = {
    FU_FIELD(fu_sheave, kernel, FU_KERNELS, 0),
    FU_FIELD(fu_sheave, foot, FU_KERNELS, foot_role),
    FU_FIELD_ARRAY(fu_sheave, groove, FU_REAL),
    FU_FIELD_ARRAY(fu_sheave, axis, FU_REAL),
    FU_FIELD_ARRAY(fu_sheave, weight, FU_REAL),
    FU_FIELD(fu_sheave, limit, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_sheave, chord, FU_REAL),
    FU_FIELD_ARRAY(fu_sheave, span_first, FU_INTEGER),
    FU_FIELD_ARRAY(fu_sheave, span_elements, FU_INTEGER),
    FU_FIELD_ARRAY(fu_sheave, span_reach, FU_INTEGER),
    FU_FIELD_ARRAY(fu_sheave, span_s, FU_INTEGER),
    FU_FIELD(fu_sheave, share_before, FU_REALS, 0),
    FU_FIELD(fu_sheave, share_after, FU_REALS, 0),
    FU_FIELD_ARRAY(fu_sheave, attachments, FU_ATTACHMENT),
    FU_FIELD_ARRAY(fu_sheave, nodes, FU_INTEGER),
    FU_FIELD(fu_sheave, s, FU_INTEGERS, 0),
    FU_FIELD(fu_sheave, n_zones, FU_INTEGER, 0),
    FU_FIELD(fu_sheave, turn, FU_INTEGER, 0),
    FU_FIELD(fu_sheave, inertia, FU_REAL, 0),
    FU_FIELD(fu_sheave, friction, FU_REAL, 0),
    FU_FIELD(fu_sheave, slip_velocity, FU_REAL, 0),
    FU_FIELD(fu_sheave, least_wrap, FU_REAL, 0),
    FU_FIELD(fu_sheave, torque_signal, FU_INTEGER, 0),
    FU_FIELD(fu_sheave, torque, FU_REAL, 0),
    FU_FIELD(fu_sheave, closing, FU_REAL, 0),
    FU_FIELD(fu_sheave, damping, FU_REAL, 0),
    FU_FIELD(fu_sheave, radius, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_sheave, tangent_radius, FU_REAL),
    FU_FIELD(fu_sheave, sense, FU_REAL, 0),
    FU_FIELD(fu_sheave, rho, FU_REAL, 0),
    FU_FIELD(fu_sheave, tau, FU_REAL, 0),
    FU_FIELD_ARRAY(fu_sheave, g, FU_REAL),
    FU_FIELD_ARRAY(fu_sheave, A, FU_REAL),
    {0},
};

static const fu_output output_fields[] = {
    FU_OUTPUT(sheave_output, tension_on, "N", NULL),
    FU_OUTPUT(sheave_output, tension_off, "N", NULL),
    FU_OUTPUT(sheave_output, wrap_angle, "rad", NULL),
    FU_OUTPUT(sheave_output, force, "N", "direction"),
    FU_OUTPUT(sheave_output, material_speed, "m/s", NULL),
    FU_OUTPUT(sheave_output, slip, "m/s", NULL),
    FU_OUTPUT(sheave_output, normal_force, "N", NULL),
    FU_OUTPUT(sheave_output, torque, "N m", NULL),
    FU_OUTPUT(sheave_output, angle, "rad", NULL),
    FU_OUTPUT(sheave_output, residual, "m", NULL),
    FU_OUTPUT(sheave_output, fleet_angle_on, "rad", NULL),
    FU_OUTPUT(sheave_output, fleet_angle_off, "rad", NULL),
    FU_LAST_OUTPUT(sheave_output),
};

static const fu_inertia_operations inertia = {inertial_force, mass_matrix, kinetic_energy, potential_energy};
static const fu_supply_operations supply = {.force = drive};
static const fu_start_operations start = {.excess = excess, .may_be_open = may_be_open};

const fu_coupling_type fu_sheave_type = {
    .name = "sheave",
    .size = sizeof(fu_sheave),
    .fields = fields,
    .output_fields = output_fields,
    .inertia = &inertia,
    .supply = &supply,
    .start = &start,
    .residual = residual,
    .tangent = tangent,
    .rows = rows,
    .force = force,
    .take_forces = take_forces,
    .outputs = outputs,
    .gaps = gaps,
    .energy = energy,
    .dissipation = dissipation,
};
