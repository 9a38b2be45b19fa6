/* Friction of hard contacts at a discontinuity. Impact: tangential impulses against the sliding velocity, at most
 * friction times the normal impulse, and equal to it if the point still slides afterwards (Coulomb's law for impulses,
 * with Newton's restitution). After it, or where sliding stops: normal force, sticking and sliding of the points, by
 * the accelerations that follow. */
#include "equations/equations.h"
#include "equations/run.h"
#include "events/hard_contact.h"

#include <math.h>
#include <string.h>

#define MAX_SWEEPS 20000        /* largest number of sweeps over the points of an impact */
#define IMPULSE_TOLERANCE 1e-14 /* change of an impulse in a sweep, over the largest */
/* of the velocity below which a point comes to rest: slower points stick, if possible */
#define STICKING_SPEED 0.1
#define FRICTION_TOLERANCE 1e-9 /* of the friction limit: excess that breaks a point loose */
#define PULL_TOLERANCE 1e-10    /* of the largest force: a larger tension opens a point, a smaller one is rounding */
#define APPROACH_TOLERANCE 1e-6 /* of the accelerations: above the compliance of sticking */
#define MAX_CHANGES 200         /* largest number of changes of states of points */

enum { MAX_CONTACTS = FU_MAX_HARD_CONTACTS, MAX_ROWS = FU_SPACE * FU_MAX_HARD_CONTACTS };

/* Rows of an impact with friction: of each point its normal, then the directions across it. */
typedef struct {
    int n;
    double A[MAX_ROWS * MAX_ROWS], before[MAX_ROWS], after[MAX_ROWS], impulse[MAX_ROWS];
    fu_hard_along along[MAX_CONTACTS];
} friction_impulse;

static const double *row_of(const fu_active_contacts *t, const friction_impulse *r, int dim, int k)
{
    return k % dim ? r->along[k / dim].H[k % dim - 1] : t->row[k / dim].H;
}

/* Computes the rows, their compliance and the velocities before. */
static void prepare(fu_run *run, const fu_active_contacts *t, friction_impulse *r)
{
    const fu_model *model = run->model;
    const int dim = model->dim;
    r->n = t->n * dim;
    for (int k = 0; k < t->n; ++k)
        fu_hard_along_at(model, fu_hard_contact_of(t->of[k]), &run->now, &t->row[k], &r->along[k]);
    for (int k = 0; k < r->n; ++k) {
        fu_hard_respond(run, &t->row[k / dim], row_of(t, r, dim, k));
        for (int j = 0; j < r->n; ++j)
            r->A[j * r->n + k] = fu_hard_rate(&t->row[j / dim], row_of(t, r, dim, j), run->work);
        const fu_hard_along *along = &r->along[k / dim];
        r->before[k] = k % dim ? fu_dot(dim, along->t[k % dim - 1], along->past) : t->before[k / dim];
        r->impulse[k] = 0.0;
    }
}

static double velocity(const friction_impulse *r, int k)
{
    return r->before[k] + fu_dot(r->n, r->A + k * r->n, r->impulse);
}

/* Corrects the impulses of one point at fixed others; returns the largest change. */
static double mend(const fu_active_contacts *t, friction_impulse *r, int point, int dim)
{
    const int k = point * dim;
    const double friction = fu_hard_contact_of(t->of[point])->friction;
    double last[FU_SPACE], size = 0.0, stiff = 0.0, change = 0.0;
    memcpy(last, r->impulse + k, sizeof(double) * (size_t)dim);
    if (!(r->A[k * r->n + k] > 0.0)) return 0.0;
    r->impulse[k] = fmax(0.0, r->impulse[k] - (velocity(r, k) - t->target[point]) / r->A[k * r->n + k]);
    for (int d = 1; d < dim; ++d) stiff += r->A[(k + d) * r->n + k + d];
    for (int d = 1; d < dim; ++d) r->after[k + d] = velocity(r, k + d);
    for (int d = 1; d < dim && stiff > 0.0; ++d) {
        r->impulse[k + d] -=
            r->after[k + d] / stiff * (dim == 3 && fabs(r->A[(k + 1) * r->n + k + 2]) < 1e-12 * stiff ? 2.0 : 1.0);
        size += r->impulse[k + d] * r->impulse[k + d];
    }
    const double most = friction * r->impulse[k];
    for (int d = 1; d < dim && size > most * most; ++d) r->impulse[k + d] *= most / sqrt(size);
    for (int d = 0; d < dim; ++d) change = fmax(change, fabs(r->impulse[k + d] - last[d]));
    return change;
}

int fu_impact_with_friction(fu_run *run, fu_active_contacts *t)
{
    const int dim = run->model->dim;
    friction_impulse r;
    prepare(run, t, &r);
    double change = INFINITY, largest = 0.0;
    for (int sweep = 0; sweep < MAX_SWEEPS && change > IMPULSE_TOLERANCE * largest; ++sweep) {
        change = 0.0;
        for (int k = 0; k < t->n; ++k) {
            change = fmax(change, mend(t, &r, k, dim));
            largest = fmax(largest, r.impulse[k * dim]);
        }
    }
    if (!(change <= sqrt(IMPULSE_TOLERANCE) * largest)) return 1;
    t->taken = 0.0;
    memset(run->before, 0, sizeof(double) * (size_t)run->model->n_dof);
    for (int k = 0; k < r.n; ++k) {
        r.after[k] = velocity(&r, k);
        t->taken -= 0.5 * r.impulse[k] * (r.before[k] + r.after[k]);
        fu_hard_push(run, &t->row[k / dim], row_of(t, &r, dim, k), r.impulse[k]);
        if (k % dim) continue;
        t->impulse[k / dim] = r.impulse[k];
        t->after[k / dim] = fabs(r.after[k] - t->target[k / dim]) <= sqrt(IMPULSE_TOLERANCE) * fabs(t->before[k / dim])
                                ? t->target[k / dim]
                                : r.after[k];
    }
    fu_response(run->model, &run->accelerator, run->before, run->work);
    return 0;
}

/* Sets a slow enough point to stick, or another one to slide. */
static void begin(fu_run *run, const fu_active_contacts *t, int k)
{
    const fu_hard_contact *contact = fu_hard_contact_of(t->of[k]);
    fu_hard_flags *flags = fu_hard_flags_of(t->of[k], &run->now);
    double *direction = fu_hard_numbers_of(t->of[k], &run->now)->direction;
    fu_hard_row row;
    fu_hard_along along;
    fu_hard_row_at(run->model, contact, &run->now, &row);
    fu_hard_along_at(run->model, contact, &run->now, &row, &along);
    const double speed = sqrt(fu_dot(run->model->dim, along.past, along.past));
    flags->sticks = speed <= STICKING_SPEED * contact->rest_velocity;
    for (int d = 0; d < run->model->dim && !flags->sticks; ++d) direction[d] = along.past[d] / speed;
}

/* Returns the relative excess of the tangential force over the friction limit. */
static double excess(const fu_run *run, const fu_coupling *c)
{
    const double *multipliers = run->now.forces + c->force;
    const double most = fu_hard_friction_limit(fu_hard_contact_of(c), multipliers[0]);
    double square = 0.0;
    for (int k = 1; k < c->n_forces; ++k) square += multipliers[k] * multipliers[k];
    return sqrt(square) / most - 1.0;
}

/* Computes the direction in which a sticking point would slide: against its tangential force. */
static void aim(fu_run *run, const fu_coupling *c)
{
    const int dim = run->model->dim;
    const double *multipliers = run->now.forces + c->force;
    fu_hard_row row;
    fu_hard_along along;
    double *direction = fu_hard_numbers_of(c, &run->now)->direction, square = 0.0;
    fu_hard_row_at(run->model, fu_hard_contact_of(c), &run->now, &row);
    fu_hard_along_at(run->model, fu_hard_contact_of(c), &run->now, &row, &along);
    for (int d = 0; d < dim; ++d) {
        direction[d] = 0.0;
        for (int k = 1; k < dim; ++k)
            direction[d] += multipliers[k] * along.t[k - 1][d]; /* minus the force on the body */
        square += direction[d] * direction[d];
    }
    for (int d = 0; d < dim && square > 0.0; ++d) direction[d] /= sqrt(square);
}

/* Computes these directions for sticking points without one: of points that break loose one after the other at one
 * instant, the forces released before would otherwise change the direction of the last. */
static void aim_all(fu_run *run, const fu_active_contacts *t, int *aimed)
{
    for (int k = 0; k < t->n; ++k) {
        const fu_hard_flags *flags = fu_hard_flags_of(t->of[k], &run->now);
        if (aimed[k] || flags->mode != FU_CLOSED || !flags->sticks || t->of[k]->n_forces == 1) continue;
        aim(run, t->of[k]);
        aimed[k] = 1;
    }
}

/* Changes the state of one point that cannot continue; returns 0 if all can. */
static int change_one(fu_run *run, const fu_active_contacts *t, const fu_coupling *loose, int *closed)
{
    const fu_model *model = run->model;
    double largest = 0.0, worst = FRICTION_TOLERANCE;
    const fu_coupling *breaks = 0;
    *closed = -1;
    for (int k = 0; k < t->n; ++k) largest = fmax(largest, fabs(run->now.forces[t->of[k]->force]));
    for (int k = 0; k < t->n; ++k) {
        fu_hard_flags *flags = fu_hard_flags_of(t->of[k], &run->now);
        if (!t->stays[k]) continue;
        if (flags->mode == FU_CLOSED && run->now.forces[t->of[k]->force] > PULL_TOLERANCE * largest) {
            flags->mode = FU_APART;
            return 1;
        }
        if (flags->mode == FU_CLOSED) continue; /* redundant points without friction may not be redundant with it */
        fu_hard_row row;
        fu_hard_row_at(model, fu_hard_contact_of(t->of[k]), &run->now, &row);
        double acceleration = row.bias, size = fabs(row.bias) + largest / t->of[k]->scale[0];
        for (int i = 0; i < row.n; ++i) {
            const double part = row.H[i] * run->now.acceleration[row.at[i]];
            acceleration += part;
            size += fabs(part);
        }
        if (flags->mode == FU_APART && fabs(acceleration) <= APPROACH_TOLERANCE * size) flags->mode = FU_IMPLIED;
        if (acceleration >= -APPROACH_TOLERANCE * size) continue;
        flags->mode = FU_CLOSED;
        begin(run, t, k);
        *closed = k;
        return 1;
    }
    for (int k = 0; k < t->n; ++k) {
        const fu_coupling *c = t->of[k];
        const fu_hard_flags *flags = fu_hard_flags_of(c, &run->now);
        if (flags->mode != FU_CLOSED || !flags->sticks || c->n_forces == 1) continue;
        const double over = c == loose ? INFINITY : excess(run, c);
        if (over > worst) worst = over, breaks = c;
    }
    if (breaks) fu_hard_flags_of(breaks, &run->now)->sticks = 0;
    return breaks != 0;
}

/* Removes the remaining velocity of sticking points. */
static int stop(fu_run *run)
{
    const fu_model *model = run->model;
    fu_state *now = &run->now;
    if (fu_project_velocities(model, now, &run->accelerator, run->work)) return 1;
    run->dissipated += fu_kinetic_energy(model, now->t, now->q, now->v);
    for (int i = 0; i < model->n_dof; ++i) now->v[i] += run->work[i];
    run->dissipated -= fu_kinetic_energy(model, now->t, now->q, now->v);
    return 0;
}

int fu_settle_friction(fu_run *run, fu_active_contacts *t, const fu_coupling *loose)
{
    int closed = -1, changes = 0, aimed[MAX_CONTACTS] = {0};
    for (int k = 0; k < t->n; ++k)
        if (fu_hard_flags_of(t->of[k], &run->now)->mode == FU_CLOSED && t->of[k]->n_forces > 1) begin(run, t, k);
    if (stop(run)) return 1;
    fu_complete(run, &run->now); /* sticking points share forces by normal forces, which the next one takes from here */
    for (; changes < MAX_CHANGES; ++changes) {
        if (fu_complete(run, &run->now)) {
            if (closed < 0) return 1;
            fu_hard_flags_of(t->of[closed], &run->now)->mode = FU_IMPLIED;
            closed = -1;
            continue;
        }
        aim_all(run, t, aimed);
        if (!change_one(run, t, loose, &closed)) return 0;
        loose = loose && !fu_hard_flags_of(loose, &run->now)->sticks ? 0 : loose;
    }
    return 1;
}
