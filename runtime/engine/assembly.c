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
        rigid_inertia_force(body->mass, body->J, rest, a + body->dof, f + body->dof);
    }
}

/* f += elastic, damping and gyroscopic forces, as they stand on the left of the equations of motion */
void fu_internal_forces(const fu_model *model, const double *q, const double *v, double *f)
{
    double part[FU_MAX_COORDINATES];
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node) {
            cable->law->elastic_force(cable->length, q + at, cable->A, part);
            for (int i = 0; i < cable->coordinates; ++i) f[at + i] += part[i];
            if (cable->tau > 0.0) {
                cable->law->damping_force(cable->length, q + at, v + at, cable->A, cable->tau, part);
                for (int i = 0; i < cable->coordinates; ++i) f[at + i] += part[i];
            }
        }
    }
    const double none[6] = {0};
    for (int b = 0; b < model->n_rigids; ++b) {
        const fu_rigid *body = &model->rigids[b];
        rigid_inertia_force(body->mass, body->J, v + body->dof, none, part);
        for (int i = 3; i < 6; ++i) f[body->dof + i] += part[i];
    }
}

/* f -= external forces */
void fu_external_forces(const fu_model *model, double *f)
{
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node)
            for (int i = 0; i < cable->coordinates; ++i) f[at + i] -= cable->gravity[i];
    }
    for (int b = 0; b < model->n_rigids; ++b)
        for (int i = 0; i < 3; ++i) f[model->rigids[b].dof + i] -= model->rigids[b].gravity[i];
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
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node) {
            if (stiffness != 0.0) {
                cable->law->elastic_tangent(cable->length, q + at, cable->A, K);
                if (cable->tau > 0.0) {
                    cable->law->damping_tangent(cable->length, q + at, v + at, cable->A, cable->tau, rate, Q);
                    for (int i = 0; i < n * n; ++i) K[i] += Q[i];
                }
                for (int i = 0; i < n * n; ++i) K[i] *= stiffness;
            } else {
                for (int i = 0; i < n * n; ++i) K[i] = 0.0;
            }
            for (int j = 0; j < vectors; ++j)
                for (int i = 0; i < vectors; ++i)
                    for (int d = 0; d < dim; ++d)
                        K[(j * dim + d) * n + i * dim + d] += inertia * cable->m[j * vectors + i];
            const int *place = model->place + at;
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
        const int *place = model->place + body->dof;
        rigid_inertia_tangent(body->mass, body->J, v + body->dof, K, Q);
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j)
                fu_system_add(system, place[i], place[j],
                              inertia * K[6 * i + j] + stiffness * rate * Q[6 * i + j]);
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
        rigid_kinetic_energy(model->rigids[b].mass, model->rigids[b].J, v + model->rigids[b].dof, part);
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
            cable->law->energy(cable->length, q + at, cable->A, &part);
            total += part;
        }
    }
    return total;
}

double fu_potential_energy(const fu_model *model, const double *q)
{
    double total = 0.0;
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node)
            for (int i = 0; i < cable->coordinates; ++i) total -= cable->gravity[i] * q[at + i];
    }
    for (int b = 0; b < model->n_rigids; ++b)
        for (int i = 0; i < 3; ++i) total -= model->rigids[b].gravity[i] * q[model->rigids[b].configuration + i];
    return total;
}

/* power taken out by damping */
double fu_dissipation(const fu_model *model, const double *q, const double *v)
{
    double total = 0.0, part;
    for (int c = 0; c < model->n_cables; ++c) {
        const fu_cable *cable = &model->cables[c];
        if (cable->tau <= 0.0) continue;
        for (int k = 0, at = cable->first; k < cable->n_elements; ++k, at += cable->per_node) {
            cable->law->dissipation(cable->length, q + at, v + at, cable->A, cable->tau, &part);
            total += part;
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
