/* Wheels: centre and rotation, bearing and drive of sheaves and drums. */
#include "couplings/wheel/wheel.h"
#include "bodies/model.h"
#include "bodies/unknowns.h"

#include <math.h>
#include <string.h>

enum { DIM = FU_GROOVE, SPACE = 3 };

void fu_into_groove(const fu_wheel_state *at, const double *vector, double out[DIM])
{
    for (int i = 0; i < DIM; ++i) {
        out[i] = 0.0;
        for (int d = 0; d < SPACE; ++d) out[i] += at->groove[d * DIM + i] * vector[d];
    }
}

void fu_out_of_groove(const fu_wheel_state *at, const double *parts, double out[SPACE])
{
    for (int d = 0; d < SPACE; ++d) out[d] = fu_dot(DIM, at->groove + d * DIM, parts);
}

/* Computes the parts of a vector along the axes of the groove. */
static void into_axes(const fu_wheel_state *at, const double *vector, double out[SPACE])
{
    fu_into_groove(at, vector, out);
    out[DIM] = fu_dot(SPACE, at->axis, vector);
}

/* Returns the part about the axis of a rotation, of whose parts in space each is `stride` after the last one. */
static double about_axis(const fu_wheel *wheel, const fu_wheel_state *at, const double *turn, int stride)
{
    double sum = 0.0;
    if (!wheel->foot) return turn[0];
    for (int d = 0; d < SPACE; ++d) sum += at->axis[d] * turn[d * stride];
    return sum;
}

/* Computes the groove and the axis in space, and gravity in their axes. */
static void find_groove(const fu_wheel *wheel, fu_wheel_state *out)
{
    memcpy(out->g, wheel->g, sizeof out->g);
    if (!wheel->foot) return;
    memcpy(out->groove, wheel->groove, sizeof out->groove);
    memcpy(out->axis, wheel->axis, sizeof out->axis);
    if (!wheel->tilts) return;
    for (int d = 0; d < SPACE; ++d) {
        memcpy(out->groove + d * DIM, out->centre.A + d * SPACE, sizeof(double) * DIM);
        out->axis[d] = out->centre.A[d * SPACE + DIM];
    }
    into_axes(out, wheel->g, out->g);
}

/* Computes the rotation of a groove that turns, with these accelerations of the dofs. */
static void find_tilting(const double *a, fu_wheel_state *out)
{
    const fu_attachment_state *centre = &out->centre;
    double alpha[SPACE];
    for (int d = 0; d < SPACE; ++d) {
        alpha[d] = centre->alpha[d];
        for (int i = 0; i < centre->n; ++i) alpha[d] += centre->T[d * centre->n + i] * a[centre->at[i]];
    }
    into_axes(out, centre->omega, out->omega);
    into_axes(out, alpha, out->omega_acc);
    out->turn_acc += fu_dot(SPACE, out->axis, centre->alpha);
}

/* Computes the motion of the centre, with these accelerations of the dofs. */
static void find_centre(const fu_wheel *wheel, const double *a, fu_wheel_state *out)
{
    const fu_attachment_state *centre = &out->centre;
    for (int d = 0; d < (wheel->foot ? SPACE : DIM); ++d) {
        out->acc[d] = centre->bias[d];
        for (int i = 0; i < centre->n; ++i) out->acc[d] += centre->P[d * centre->n + i] * a[centre->at[i]];
    }
    if (wheel->foot) {
        fu_into_groove(out, centre->p, out->c);
        fu_into_groove(out, centre->v, out->c_rate);
        fu_into_groove(out, out->acc, out->c_acc);
        fu_into_groove(out, centre->bias, out->c_bias);
        out->across = fu_dot(SPACE, out->axis, centre->p);
        out->across_rate = fu_dot(SPACE, out->axis, centre->v);
        out->across_acc = fu_dot(SPACE, out->axis, out->acc);
        return;
    }
    memcpy(out->c, centre->p, sizeof out->c);
    memcpy(out->c_rate, centre->v, sizeof out->c_rate);
    memcpy(out->c_acc, out->acc, sizeof out->c_acc);
    memcpy(out->c_bias, centre->bias, sizeof out->c_bias);
}

void fu_wheel_at(const fu_model *model, const fu_wheel *wheel, const fu_state *state, const double *a,
                 fu_wheel_state *out)
{
    const fu_attachment_state *centre = &out->centre;
    fu_attachment_at(model, &wheel->attachments[0], state, 0.0, FU_POINT | FU_AXES, &out->centre);
    find_groove(wheel, out);
    find_centre(wheel, a, out);
    out->own_rate = wheel->turn < 0 ? 0.0 : state->v[wheel->turn];
    out->turn_rate = out->own_rate + about_axis(wheel, out, centre->omega, 1);
    out->turn_acc = wheel->turn < 0 ? 0.0 : a[wheel->turn];
    for (int i = 0; i < centre->n; ++i)
        out->turn_acc += about_axis(wheel, out, centre->T + i, centre->n) * a[centre->at[i]];
    if (wheel->tilts) find_tilting(a, out);
}

void fu_from_centre(const fu_wheel *wheel, const fu_wheel_state *at, const double *r, const double *v, const double *a,
                    double x[DIM], double rate[DIM], double acc[DIM])
{
    double apart[SPACE], apart_rate[SPACE], apart_acc[SPACE];
    for (int d = 0; d < SPACE; ++d) {
        apart[d] = r[d] - at->centre.p[d];
        apart_rate[d] = v[d] - at->centre.v[d];
        apart_acc[d] = a[d] - at->acc[d];
    }
    fu_into_groove(at, apart, x);
    fu_into_groove(at, apart_rate, rate);
    if (wheel->tilts) {
        double along_rate[SPACE], along_acc[SPACE];
        into_axes(at, apart_rate, along_rate);
        into_axes(at, apart_acc, along_acc);
        wheel->foot->turned_acc(at->omega, along_rate, along_acc, acc);
    } else fu_into_groove(at, apart_acc, acc);
}

/* --- forces ----------------------------------------------------------------------------------------------------- */

void fu_wheel_force(const fu_wheel *wheel, const fu_wheel_state *at, const double *forces, double out[SPACE])
{
    out[DIM] = 0.0;
    for (int d = 0; d < (wheel->foot ? SPACE : DIM); ++d)
        out[d] =
            wheel->foot ? fu_dot(DIM, at->groove + d * DIM, forces) + at->axis[d] * forces[FU_WHEEL_ACROSS] : forces[d];
}

/* Computes the force and the moment on the carrier from forces on a wheel. */
static void wrench_of(const fu_wheel *wheel, const fu_wheel_state *at, const double *forces, double force[SPACE],
                      double moment[SPACE])
{
    const double turning = forces[FU_WHEEL_TURN];
    fu_wheel_force(wheel, at, forces, force);
    for (int d = 0; d < SPACE; ++d) {
        moment[d] = wheel->foot ? at->axis[d] * turning : d ? 0.0 : turning;
        if (wheel->tilts) moment[d] += fu_dot(FU_TILTS, at->groove + d * DIM, forces + FU_WHEEL_TILT);
    }
}

void fu_wheel_add_forces(const fu_wheel *wheel, const fu_wheel_state *at, const double *forces, double *f)
{
    double force[SPACE], moment[SPACE];
    if (wheel->turn >= 0) f[wheel->turn] += forces[FU_WHEEL_TURN];
    wrench_of(wheel, at, forces, force, moment);
    fu_add_wrench(wheel->foot ? SPACE : DIM, &at->centre, force, moment, 1.0, f);
}

void fu_wheel_add_bearing(const fu_wheel *wheel, const fu_wheel_state *at, double *f)
{
    if (wheel->turn >= 0) f[wheel->turn] += wheel->damping * at->own_rate;
}

void fu_wheel_drive(const fu_model *model, const fu_coupling *coupling, double t, const double *q, double *f)
{
    const fu_wheel *wheel = (const fu_wheel *)coupling;
    const int signal = wheel->torque_signal;
    (void)q;
    if (wheel->turn < 0 || wheel->torque == 0.0) return;
    f[wheel->turn] -=
        model->load_fraction * wheel->torque * (signal < 0 ? 1.0 : fu_signal_at(&model->signals[signal], t, 0, 0));
}

const fu_supply_operations fu_wheel_supply = {.force = fu_wheel_drive};

int fu_wheel_may_be_open(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    (void)model, (void)coupling, (void)state;
    return 1;
}

/* --- derivatives ------------------------------------------------------------------------------------------------ */

void fu_wheel_moves(const fu_model *model, const fu_wheel_state *at, fu_centre_moves *out)
{
    memcpy(out->P, at->centre.P, sizeof(double) * (size_t)(model->dim * at->centre.n));
    memcpy(out->T, at->centre.T, sizeof(double) * (size_t)(fu_turns(model->dim) * at->centre.n));
}

void fu_wheel_by_psi(const fu_model *model, const fu_wheel *wheel, const fu_wheel_state *at, const double *psi,
                     fu_centre_moves *out)
{
    fu_wheel_moves(model, at, out);
    fu_turn_attachment(model, &wheel->attachments[0], psi, out->P, model->dim, at->centre.n, 0);
    if (wheel->tilts) fu_turn_attachment(model, &wheel->attachments[0], psi, out->T, SPACE, at->centre.n, 0);
}

int fu_wheel_columns(const fu_wheel *wheel, const fu_wheel_state *at, const fu_centre_moves *moves, int first,
                     fu_wheel_column *out)
{
    const int n_centre = at->centre.n;
    int n = 0;
    if (wheel->turn >= 0) out[n++] = (fu_wheel_column){wheel->turn, first + FU_WHEEL_TURN, 1, {1.0}};
    for (int i = 0; i < n_centre; ++i, ++n) {
        out[n] = (fu_wheel_column){at->centre.at[i], first, FU_WHEEL_FORCES, {0.0}};
        for (int d = 0; d < DIM && !wheel->foot; ++d) out[n].value[d] = moves->P[d * n_centre + i];
        for (int d = 0; d < SPACE && wheel->foot; ++d) {
            const double change = moves->P[d * n_centre + i], turn = moves->T[d * n_centre + i];
            for (int j = 0; j < DIM; ++j) out[n].value[j] += at->groove[d * DIM + j] * change;
            out[n].value[FU_WHEEL_ACROSS] += at->axis[d] * change;
            for (int j = 0; j < FU_TILTS && wheel->tilts; ++j)
                out[n].value[FU_WHEEL_TILT + j] += at->groove[d * DIM + j] * turn;
        }
        out[n].value[FU_WHEEL_TURN] = about_axis(wheel, at, moves->T + i, n_centre);
    }
    return n;
}

/* Returns the entry of rows' K columns of one row and one column; most have one variable each. */
static double entry_of(const fu_wheel_column *row, const fu_wheel_column *column, int n_variables, const double *K)
{
    const double *first = K + row->row * n_variables;
    double sum = 0.0;
    if (row->n == 1 && column->n == 1) return row->value[0] * (column->value[0] * first[column->row]);
    for (int k = 0; k < row->n; ++k) sum += row->value[k] * fu_by_column(column, first + k * n_variables);
    return sum;
}

void fu_wheel_add_matrix(const fu_model *model, int n, const fu_wheel_column *rows, const fu_wheel_column *columns,
                         int n_variables, const double *K, fu_system *system)
{
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const double value = entry_of(&rows[i], &columns[j], n_variables, K);
            if (value != 0.0) fu_add(model, system, rows[i].dof, columns[j].dof, value);
        }
}

void fu_wheel_add_tangent(const fu_model *model, const fu_wheel *wheel, const fu_wheel_state *at,
                          const fu_equations *equations, const double *forces, fu_system *system)
{
    const fu_weights w = equations->weights;
    if (wheel->turn >= 0 && wheel->damping != 0.0)
        fu_add(model, system, wheel->turn, wheel->turn, w.stiffness * w.rate * wheel->damping);
    fu_wheel_add_carried(model, wheel, at, equations, forces, system);
}

void fu_wheel_add_carried(const fu_model *model, const fu_wheel *wheel, const fu_wheel_state *at,
                          const fu_equations *equations, const double *forces, fu_system *system)
{
    const fu_weights w = equations->weights;
    const int n = at->centre.n;
    double force[SPACE], moment[SPACE], K[FU_ATTACHMENT_COORDINATES * FU_ATTACHMENT_COORDINATES];
    if (!n) return;
    wrench_of(wheel, at, forces, force, moment);
    fu_wrench_derivatives(model, &wheel->attachments[0], equations->next, force, moment, n, K, 0, 0);
    fu_turn_attachment(model, &wheel->attachments[0], equations->psi, K, n, n, 0);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            if (K[i * n + j] != 0.0)
                fu_add(model, system, at->centre.at[i], at->centre.at[j], w.stiffness * K[i * n + j]);
}

/* --- the rope that presses on the groove ------------------------------------------------------------------------ */

double fu_wheel_outwards(const fu_wheel_state *at, double phi)
{
    return (at->g[0] - at->c_acc[0]) * cos(phi) + (at->g[1] - at->c_acc[1]) * sin(phi);
}

double fu_wheel_pressure(const fu_wheel *wheel, const fu_wheel_state *at, double phi, double tension, double speed,
                         double stretch)
{
    return tension - wheel->rho / stretch * (speed * speed + wheel->radius * fu_wheel_outwards(at, phi));
}
