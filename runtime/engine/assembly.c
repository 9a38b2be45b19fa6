/* Sums over elements and bodies: forces, energies, and the band and body blocks of a Newton matrix. */
#include "engine.h"

/* f = M a */
void fu_mass_times(const fu_model *model, const double *a, double *f)
{
    double part[FU_MAX_COORDINATES];
    for (int i = 0; i < model->n_dof; ++i) f[i] = 0.0;
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node) {
            cable->kernel->inertia_force(cable->m, a + at, part);
            for (int i = 0; i < cable->coordinates; ++i) f[at + i] += part[i];
        }
    }
    const double rest[6] = {0};
    for (int b = 0; b < model->n_rigids; ++b) {
        const fu_rigid *body = &model->rigids[b];
        body->kernel->inertia_force(body->mass, body->J, rest, a + body->dof, f + body->dof);
    }
}

/* f += elastic, damping and gyroscopic forces, as they stand on the left of the equations of motion; not springs */
void fu_internal_forces(const fu_model *model, const double *q, const double *v, double *f)
{
    double part[FU_MAX_COORDINATES];
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node) {
            cable->law->elastic_force(cable->length, q + at, cable->A + (long)k * cable->A_stride, part);
            for (int i = 0; i < cable->coordinates; ++i) f[at + i] += part[i];
        }
    }
    fu_rate_forces(model, q, v, f);
}

/* f += discrete gradients of the elastic energies over a step */
void fu_discrete_forces(const fu_model *model, const double *q, const double *q_next, double *f)
{
    double part[FU_MAX_COORDINATES];
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node) {
            cable->law->discrete_force(cable->length, q + at, q_next + at, cable->A + (long)k * cable->A_stride, part);
            for (int i = 0; i < cable->coordinates; ++i) f[at + i] += part[i];
        }
    }
}

/* f += damping and gyroscopic forces */
void fu_rate_forces(const fu_model *model, const double *q, const double *v, double *f)
{
    double part[FU_MAX_COORDINATES];
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        if (cable->tau <= 0.0 && cable->mass_damping <= 0.0) continue;
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node) {
            const double *A = cable->A + (long)k * cable->A_stride;
            if (cable->tau > 0.0) {
                cable->law->damping_force(cable->length, q + at, v + at, A, cable->tau, part);
                for (int i = 0; i < cable->coordinates; ++i) f[at + i] += part[i];
            }
            if (cable->mass_damping > 0.0) {
                cable->kernel->inertia_force(cable->m, v + at, part);
                for (int i = 0; i < cable->coordinates; ++i) f[at + i] += cable->mass_damping * part[i];
            }
        }
    }
    const double none[6] = {0};
    for (int b = 0; b < model->n_rigids; ++b) {
        const fu_rigid *body = &model->rigids[b];
        body->kernel->inertia_force(body->mass, body->J, v + body->dof, none, part);
        for (int i = body->kernel->dim; i < body->kernel->velocity; ++i) f[body->dof + i] += part[i];
    }
}

/* inertia M + stiffness d(forces)/dq + stiffness rate d(forces)/dv, added to a cleared system */
void fu_dynamic_matrix(const fu_model *model, const double *q, const double *v, double inertia, double rate,
                       double stiffness, fu_system *system)
{
    double K[FU_MAX_COORDINATES * FU_MAX_COORDINATES], Q[FU_MAX_COORDINATES * FU_MAX_COORDINATES];
    const int rows = 3 * system->width + 1, diagonal = 2 * system->width;
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        const int n = cable->coordinates, dim = cable->kernel->dim, vectors = n / dim;
        const double mass = inertia + stiffness * rate * cable->mass_damping;
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node) {
            const double *A = cable->A + (long)k * cable->A_stride;
            if (stiffness != 0.0) {
                cable->law->elastic_tangent(cable->length, q + at, A, K);
                if (cable->tau > 0.0) {
                    cable->law->damping_tangent(cable->length, q + at, v + at, A, cable->tau, rate, Q);
                    for (int i = 0; i < n * n; ++i) K[i] += Q[i];
                }
                for (int i = 0; i < n * n; ++i) K[i] *= stiffness;
            } else {
                for (int i = 0; i < n * n; ++i) K[i] = 0.0;
            }
            for (int j = 0; j < vectors; ++j)
                for (int i = 0; i < vectors; ++i)
                    for (int d = 0; d < dim; ++d)
                        K[(j * dim + d) * n + i * dim + d] += mass * cable->m[j * vectors + i];
            const int *place = model->place + at;
            int combined = 0;
            for (int j = 0; j < n; ++j) combined |= place[j] < -1;
            if (combined) {
                for (int i = 0; i < n; ++i)
                    for (int j = 0; j < n; ++j) fu_add(model, system, at + i, at + j, K[i * n + j]);
                continue;
            }
            for (int j = 0; j < n; ++j) {
                if (place[j] < 0) continue;
                double *column = system->K + (long)place[j] * rows + diagonal - place[j];
                for (int i = 0; i < n; ++i)
                    if (place[i] >= 0) column[place[i]] += K[i * n + j];
            }
        }
    }
    for (int b = 0; b < model->n_rigids; ++b) {
        const fu_rigid *body = &model->rigids[b];
        const int size = body->kernel->velocity;
        body->kernel->inertia_tangent(body->mass, body->J, v + body->dof, K, Q);
        for (int i = 0; i < size; ++i)
            for (int j = 0; j < size; ++j)
                fu_add(model, system, body->dof + i, body->dof + j,
                       inertia * K[size * i + j] + stiffness * rate * Q[size * i + j]);
    }
}

double fu_kinetic_energy(const fu_model *model, const double *v)
{
    double total = 0.0, part[FU_MAX_COORDINATES];
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node) {
            cable->kernel->inertia_force(cable->m, v + at, part);
            for (int i = 0; i < cable->coordinates; ++i) total += 0.5 * part[i] * v[at + i];
        }
    }
    for (int b = 0; b < model->n_rigids; ++b) {
        model->rigids[b].kernel->kinetic_energy(model->rigids[b].mass, model->rigids[b].J, v + model->rigids[b].dof, part);
        total += part[0];
    }
    return total;
}

double fu_elastic_energy(const fu_model *model, const double *q)
{
    double total = 0.0, part;
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node) {
            cable->law->energy(cable->length, q + at, cable->A + (long)k * cable->A_stride, &part);
            total += part;
        }
    }
    return total + fu_spring_energy(model, q);
}

/* of gravity */
double fu_potential_energy(const fu_model *model, const double *q)
{
    double total = 0.0;
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        const int end = cable->first + (cable->n_elements + 1) * cable->per_node;
        for (int i = cable->first; i < end; ++i) total -= model->gravity[i] * q[i];
    }
    for (int b = 0; b < model->n_rigids; ++b) {
        const fu_rigid *body = &model->rigids[b];
        for (int i = 0; i < body->kernel->dim; ++i)
            total -= model->gravity[body->dof + i] * q[body->configuration + i];
    }
    return total;
}

/* power taken out by damping */
double fu_dissipation(const fu_model *model, const double *q, const double *v)
{
    double total = fu_spring_dissipation(model, q, v), part[FU_MAX_COORDINATES];
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        if (cable->tau <= 0.0 && cable->mass_damping <= 0.0) continue;
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node) {
            if (cable->tau > 0.0) {
                cable->law->dissipation(cable->length, q + at, v + at, cable->A + (long)k * cable->A_stride, cable->tau,
                                        part);
                total += part[0];
            }
            if (cable->mass_damping > 0.0) {
                cable->kernel->inertia_force(cable->m, v + at, part);
                for (int i = 0; i < cable->coordinates; ++i) total += cable->mass_damping * part[i] * v[at + i];
            }
        }
    }
    return total;
}

double fu_length(const fu_model *model, int joint)
{
    const fu_cable *cable = &model->cables[model->joints[joint].cable];
    return cable->n_elements * cable->length;
}

/* arc-length at an element's first node */
double fu_element_start(const fu_model *model, int joint, int element)
{
    return element * model->cables[model->joints[joint].cable].length;
}
