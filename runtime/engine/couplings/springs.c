/* Springs and dampers: the law of the force between two points, by the kernels of derive/couplings/spring.py. */
#include "engine.h"

/* Parameters of the law: N/m, N s/m, m. */
typedef struct {
    double stiffness, damping, length;
} fu_spring;
_Static_assert(sizeof(fu_spring) <= FU_MAX_PARAMETERS * sizeof(double), "a spring's parameters are those of a point force");

static const fu_spring *spring_of(const fu_coupling *coupling)
{
    return (const fu_spring *)((const fu_point_force *)coupling)->parameters;
}

static const fu_spring_kernels *kernels_of(const fu_coupling *coupling)
{
    return ((const fu_point_force *)coupling)->kernels;
}

static void force(const fu_coupling *coupling, const double *gap, const double *rate, double *f)
{
    const fu_spring *spring = spring_of(coupling);
    kernels_of(coupling)->force(spring->stiffness, spring->damping, spring->length, gap, rate, f);
}

static void tangent(const fu_coupling *coupling, const double *gap, const double *rate, double *f, double *by_gap,
                    double *by_rate)
{
    const fu_spring *spring = spring_of(coupling);
    kernels_of(coupling)->tangent(spring->stiffness, spring->damping, spring->length, gap, rate, f, by_gap, by_rate);
}

static double step_force(const fu_coupling *coupling, const double *gap, const double *gap_next, double h, double *f)
{
    const fu_spring *spring = spring_of(coupling);
    double power;
    kernels_of(coupling)->discrete_force(spring->stiffness, spring->damping, spring->length, h, gap, gap_next, f, &power);
    return power;
}

static double energy(const fu_coupling *coupling, const double *gap)
{
    const fu_spring *spring = spring_of(coupling);
    double stored;
    kernels_of(coupling)->energy(spring->stiffness, spring->length, gap, &stored);
    return stored;
}

static double dissipation(const fu_coupling *coupling, const double *gap, const double *rate)
{
    const fu_spring *spring = spring_of(coupling);
    double power;
    kernels_of(coupling)->dissipation(spring->damping, spring->length, gap, rate, &power);
    return power;
}

static const fu_point_law law = {force, tangent, step_force, energy, dissipation};

const fu_coupling_type fu_spring_type = {.name = "spring", .law = &law, FU_POINT_FORCE_OPERATIONS};
