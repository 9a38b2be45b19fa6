/* Algorithmic dissipation of the energy-momentum method: stresses by fast vibrations, without an effect on slow
 * motion.
 *
 * Over a step a strain changes by dE = B psi, with the rates of strain B in the middle as in damping_force. Its
 * stress gets the addition
 *     S = D (viscosity (g_1 - g_0) + inertia (r_1 - r_0)),   g_1 - g_0 = dE - (g_0 + g_1)/(2 lag),   r_0 + r_1 = 2 dE,
 * with the stiffness D. The first part is a Maxwell element between the strain and a quantity that follows it within
 * `lag` steps, g being their difference; the second is inertia against strain, r being the change that the
 * velocities at an end of the step would make in one. The work of S over the step, S dE, is dissipated as
 *     viscosity D (g_1 - g_0)^2
 * and stored in
 *     viscosity/(2 lag) D g^2 + inertia/2 D r^2,
 * which is returned or lost: the energy never exceeds its start.
 *
 * r_0 = h B v_0 at the start of the step; if its energy would exceed that of r_1 of the step before, it is shortened
 * to that. S is of the order of h^2 in slow motion, and zero in rigid motion. The aim is that of Armero & Romero
 * (Comput. Methods Appl. Mech. Eng. 190 (2001) 6783-6824); the form is linear: an oscillator of stiffness D has
 *     p^2 (1 + lag p) + (h omega)^2 (1 + p/a)^3 = 0
 * for its eigenvalues (1 + p/2)/(1 - p/2), with the three numbers of integrators/energy.py, and all three reach the
 * spectral radius as h omega grows.
 *
 * B of a spatial cable contains a rotation about the tangent where it is bent (cable_damping.py), which would change
 * the momentum. A rotation of the cable as a whole is subtracted, v - omega x r, the one that leaves its forces
 * without a moment.
 *
 * g of a bent cable has directions in space, which do not rotate with the cable: that changes S by the order of h^2. */
#include "bodies/growth.h"
#include "equations/run.h"
#include "integrators/algorithmic_dissipation.h"

#include <math.h>
#include <string.h>

#define MIN_PIVOT 1e-14 /* of the largest pivot: a smaller one belongs to a rotation without strain */

static const double none[FU_MAX_RATES];

/* A moving cable, and the rotation that is subtracted from its motion. */
typedef struct {
    const fu_cable *cable;
    const double *q, *v;
    double weight, omega[3];
} moving;

const fu_algorithmic *fu_algorithmic_of(const fu_run *run)
{
    return (const fu_algorithmic *)run->parameters;
}

/* Returns the number of values of an element: g, and the energy of r. */
static long numbers_of(const fu_cable *cable)
{
    return cable->law->rates + 1;
}

/* Returns the number of its values in a state. */
long fu_algorithmic_state(const fu_run *run)
{
    long numbers = 0;
    FU_EACH_CABLE(cable, run->model) numbers += numbers_of(cable) * cable->n_elements;
    return fu_algorithmic_of(run)->weight != 0.0 ? numbers : 0;
}

/* Returns the values of a cable's k-th element in an array of all. */
static double *state_of(const fu_cable *cable, double *numbers, int k)
{
    return numbers + cable->dissipation_state + k * numbers_of(cable);
}

/* Returns the head of the work space, laid out as in a state: r, the change by the velocities at the start of the step,
 * and its energy. */
static double *expected_of(const fu_run *run)
{
    return run->scratch;
}

static int entry_of(const fu_cable *cable, int k)
{
    return fu_element_entry(cable, k);
}

/* Adds omega x r over an element's vectors, r from the cable's first node. */
static void turn(const moving *m, int k, const double omega[3], double *turned)
{
    const fu_cable *cable = m->cable;
    const double *e = m->q + entry_of(cable, k), *origin = m->q + cable->first;
    for (int i = 0; i < cable->coordinates; i += 3) {
        double r[3];
        for (int d = 0; d < 3; ++d) r[d] = e[i + d] - (i % cable->per_node ? 0.0 : origin[d]);
        for (int d = 0; d < 3; ++d)
            turned[i + d] += omega[(d + 1) % 3] * r[(d + 2) % 3] - omega[(d + 2) % 3] * r[(d + 1) % 3];
    }
}

/* Returns the rate of the growth factor of an element. */
static double growing(const moving *m, int k)
{
    return m->cable->growth < 0 ? 0.0 : fu_growth(m->cable, k, m->v);
}

/* Computes f of D (weight dE - relaxed), and dE, by the rates v of an element and that of its growth factor, to whose
 * dof it adds the force; returns their work. */
static double law_force(const moving *m, int k, const double *v, double growth_rate, const double *relaxed, double *f,
                        double *dE, double *on_growth)
{
    const fu_cable *cable = m->cable;
    const double *e = m->q + entry_of(cable, k);
    if (cable->growth < 0) {
        cable->law->algorithmic_force(fu_element_length(cable, k), e, v, fu_element_constants(cable, k), m->weight,
                                      relaxed, f, dE);
        return fu_dot(cable->coordinates, f, v);
    }
    fu_grown grown;
    fu_grow(cable, k, fu_growth(cable, k, m->q), e, &grown);
    fu_grow_rates(cable, growth_rate, v, &grown);
    cable->law->algorithmic_force(grown.l, grown.e, grown.v, grown.A, m->weight, relaxed, f, dE);
    const double work = fu_dot(cable->coordinates, f, grown.v);
    if (on_growth) *on_growth += fu_growth_force(cable, &grown, f);
    fu_forces_on_given(cable, grown.g, f);
    return work;
}

/* The same of the motion without its rotation. */
static double element_force(const moving *m, int k, const double *relaxed, double *f, double *dE, double *on_growth)
{
    const fu_cable *cable = m->cable;
    const double back[3] = {-m->omega[0], -m->omega[1], -m->omega[2]};
    double v[FU_MAX_COORDINATES];
    memcpy(v, m->v + entry_of(cable, k), sizeof(double) * (size_t)cable->coordinates);
    if (cable->law->spins) turn(m, k, back, v);
    return law_force(m, k, v, growing(m, k), relaxed, f, dE, on_growth);
}

/* Solves N x = b, with N symmetric and positive semidefinite; x is zero for N zero. */
static void solve(double N[9], double b[3], double x[3])
{
    const double least = MIN_PIVOT * fmax(N[0], fmax(N[4], N[8]));
    int order[3], n = 0, left[3] = {1, 1, 1};
    for (; n < 3; ++n) {
        int i = left[0] ? 0 : left[1] ? 1 : 2;
        for (int k = 0; k < 3; ++k)
            if (left[k] && N[4 * k] > N[4 * i]) i = k;
        if (!(N[4 * i] > least)) break;
        left[i] = 0;
        order[n] = i;
        for (int k = 0; k < 3; ++k) {
            if (!left[k]) continue;
            const double factor = N[3 * k + i] / N[4 * i];
            for (int j = 0; j < 3; ++j) N[3 * k + j] -= factor * N[3 * i + j];
            b[k] -= factor * b[i];
        }
    }
    x[0] = x[1] = x[2] = 0.0;
    while (n--) {
        const int i = order[n];
        x[i] = (b[i] - fu_dot(3, N + 3 * i, x)) / N[4 * i];
    }
}

typedef void (*stress_of)(const fu_run *run, const fu_cable *cable, int k, double *relaxed);

/* Kinds of `relaxed`, the part of dE without stress: of the whole stress, of its second part, of none. */
static void of_both(const fu_run *run, const fu_cable *cable, int k, double *relaxed)
{
    const fu_algorithmic *a = fu_algorithmic_of(run);
    const double *g = state_of(cable, run->now.dissipation_state, k), *r = state_of(cable, expected_of(run), k);
    const double maxwell = 2.0 * a->viscosity / (2.0 * a->lag + 1.0);
    for (int i = 0; i < cable->law->rates; ++i) relaxed[i] = maxwell * g[i] + 2.0 * a->inertia * r[i];
}

static void of_inertia(const fu_run *run, const fu_cable *cable, int k, double *relaxed)
{
    const double *r = state_of(cable, expected_of(run), k);
    for (int i = 0; i < cable->law->rates; ++i) relaxed[i] = 2.0 * fu_algorithmic_of(run)->inertia * r[i];
}

static void of_none(const fu_run *run, const fu_cable *cable, int k, double *relaxed)
{
    (void)run, (void)k;
    memset(relaxed, 0, sizeof(double) * (size_t)cable->law->rates);
}

/* Returns the cable with the rotation that leaves the forces of D (weight dE - relaxed) without a moment. */
static moving without_turn(const fu_run *run, const fu_cable *cable, const double *q, const double *v, double weight,
                           stress_of stress)
{
    moving m = {cable, q, v, weight, {0.0, 0.0, 0.0}};
    double N[9] = {0.0}, M[3] = {0.0};
    if (!cable->law->spins) return m;
    for (int k = 0; k < cable->n_elements; ++k) {
        double f[FU_MAX_COORDINATES], turns[3][FU_MAX_COORDINATES] = {{0.0}}, relaxed[FU_MAX_RATES], dE[FU_MAX_RATES];
        stress(run, cable, k, relaxed);
        element_force(&m, k, relaxed, f, dE, 0);
        for (int d = 0; d < 3; ++d) {
            const double axis[3] = {d == 0, d == 1, d == 2};
            turn(&m, k, axis, turns[d]);
            M[d] += fu_dot(cable->coordinates, f, turns[d]);
        }
        for (int d = 0; d < 3; ++d) {
            law_force(&m, k, turns[d], 0.0, none, f, dE, 0);
            for (int i = 0; i < 3; ++i) N[3 * d + i] += fu_dot(cable->coordinates, f, turns[i]);
        }
    }
    solve(N, M, m.omega);
    return m;
}

/* Computes r_0 of a step of h from `now`. */
void fu_algorithmic_start(fu_run *run, double h)
{
    const fu_algorithmic *a = fu_algorithmic_of(run);
    if (!(a->weight > 0.0)) return;
    FU_EACH_CABLE(cable, run->model) {
        const int n = cable->law->rates;
        const moving m = without_turn(run, cable, run->now.q, run->now.v, 1.0, of_none);
        for (int k = 0; k < cable->n_elements; ++k) {
            double f[FU_MAX_COORDINATES], *r = state_of(cable, expected_of(run), k);
            const double left = state_of(cable, run->now.dissipation_state, k)[n];
            const double energy = 0.5 * a->inertia * h * h * element_force(&m, k, none, f, r, 0);
            const double part = energy > left ? sqrt(left / energy) : 1.0;
            for (int i = 0; i < n; ++i) r[i] *= h * part;
            r[n] = part * part * energy;
        }
    }
}

/* Adds the forces of the step from `now` by psi; q is its middle. */
void fu_algorithmic_forces(fu_run *run, const double *q, double *force)
{
    const double weight = fu_algorithmic_of(run)->weight;
    if (!(weight > 0.0)) return;
    FU_EACH_CABLE(cable, run->model) {
        const moving m = without_turn(run, cable, q, run->psi, weight, of_both);
        for (int k = 0; k < cable->n_elements; ++k) {
            double f[FU_MAX_COORDINATES], relaxed[FU_MAX_RATES], dE[FU_MAX_RATES];
            of_both(run, cable, k, relaxed);
            element_force(&m, k, relaxed, f, dE, cable->growth < 0 ? 0 : force + fu_growth_dof(cable, k));
            for (int i = 0; i < cable->coordinates; ++i) force[entry_of(cable, k) + i] += f[i];
        }
    }
}

/* Updates the dissipation state at the end of an accepted step; returns the work of the stresses, J. */
double fu_algorithmic_account(fu_run *run, const double *q)
{
    const fu_algorithmic *a = fu_algorithmic_of(run);
    double work = 0.0;
    if (!(a->weight > 0.0)) return 0.0;
    FU_EACH_CABLE(cable, run->model) {
        const int n = cable->law->rates;
        const moving m = without_turn(run, cable, q, run->psi, a->weight, of_both);
        moving second = m;
        second.weight = 2.0 * a->inertia;
        for (int k = 0; k < cable->n_elements; ++k) {
            const double *psi = run->psi + entry_of(cable, k), *now = state_of(cable, run->now.dissipation_state, k);
            double *next = state_of(cable, run->next.dissipation_state, k);
            double f[FU_MAX_COORDINATES], relaxed[FU_MAX_RATES], dE[FU_MAX_RATES], on_growth = 0.0;
            of_both(run, cable, k, relaxed);
            element_force(&m, k, relaxed, f, dE, &on_growth);
            work += fu_dot(cable->coordinates, f, psi) + on_growth * growing(&m, k);
            for (int i = 0; i < n; ++i) next[i] = now[i] + 2.0 * (a->lag * dE[i] - now[i]) / (2.0 * a->lag + 1.0);
            of_inertia(run, cable, k, relaxed);
            const double gained = element_force(&second, k, relaxed, f, dE, 0);
            next[n] = fmax(0.0, state_of(cable, expected_of(run), k)[n] + gained);
        }
    }
    return work;
}
