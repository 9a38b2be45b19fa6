/* Springs and dampers: the law of the force between two points. A length of zero makes it k gap + c rate, smooth where the
 * points meet.
 */
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

static int dim_of(const fu_coupling *coupling)
{
    return ((const fu_point_force *)coupling)->dim;
}

/* Force on the first point, and its derivatives by the gap p_2 - p_1 and the gap's rate (dim x dim). */
static void force_of(const fu_coupling *coupling, const double *gap, const double *rate, double *force, double *by_gap,
                     double *by_rate)
{
    const fu_spring *spring = spring_of(coupling);
    const int dim = dim_of(coupling);
    const double k = spring->stiffness, c = spring->damping;
    if (spring->length == 0.0) {
        for (int i = 0; i < dim; ++i) {
            force[i] = k * gap[i] + c * rate[i];
            for (int j = 0; j < dim; ++j) {
                by_gap[i * dim + j] = i == j ? k : 0.0;
                by_rate[i * dim + j] = i == j ? c : 0.0;
            }
        }
        return;
    }
    double square = 0.0, closing = 0.0, n[3];
    for (int d = 0; d < dim; ++d) square += gap[d] * gap[d];
    const double length = sqrt(square);
    for (int d = 0; d < dim; ++d) n[d] = gap[d] / length;
    for (int d = 0; d < dim; ++d) closing += n[d] * rate[d];
    const double tension = k * (length - spring->length) + c * closing;
    for (int i = 0; i < dim; ++i) {
        force[i] = tension * n[i];
        for (int j = 0; j < dim; ++j) {
            by_gap[i * dim + j] = tension / length * ((i == j) - n[i] * n[j]) +
                                  n[i] * (k * n[j] + c / length * (rate[j] - closing * n[j]));
            by_rate[i * dim + j] = c * n[i] * n[j];
        }
    }
}

/* Force on the first point over a step that takes as much work as the spring stores, and as much more as the damper
 * dissipates; returns the latter's power. L_next - L is n . (gap_next - gap), n = (gap + gap_next)/(L + L_next). */
static double step_force(const fu_coupling *coupling, const double *gap, const double *gap_next, double h, double *force)
{
    const fu_spring *spring = spring_of(coupling);
    const int dim = dim_of(coupling);
    double square = 0.0, square_next = 0.0, closing = 0.0, power = 0.0;
    if (spring->length == 0.0) {
        for (int d = 0; d < dim; ++d) {
            const double rate = (gap_next[d] - gap[d]) / h;
            force[d] = 0.5 * spring->stiffness * (gap[d] + gap_next[d]) + spring->damping * rate;
            power += spring->damping * rate * rate;
        }
        return power;
    }
    for (int d = 0; d < dim; ++d) {
        square += gap[d] * gap[d];
        square_next += gap_next[d] * gap_next[d];
    }
    const double both = sqrt(square) + sqrt(square_next);
    for (int d = 0; d < dim; ++d) closing += (gap[d] + gap_next[d]) / both * (gap_next[d] - gap[d]) / h;
    const double tension = spring->stiffness * (0.5 * both - spring->length) + spring->damping * closing;
    for (int d = 0; d < dim; ++d) force[d] = tension * (gap[d] + gap_next[d]) / both;
    return spring->damping * closing * closing;
}

static double energy(const fu_coupling *coupling, const double *gap)
{
    const fu_spring *spring = spring_of(coupling);
    const double length = sqrt(gap[0] * gap[0] + gap[1] * gap[1] + gap[2] * gap[2]) - spring->length;
    return 0.5 * spring->stiffness * length * length;
}

/* power taken out by the damper */
static double dissipation(const fu_coupling *coupling, const double *gap, const double *rate)
{
    const fu_spring *spring = spring_of(coupling);
    double square = 0.0, along = 0.0, speed = 0.0;
    for (int d = 0; d < 3; ++d) {
        square += gap[d] * gap[d];
        along += gap[d] * rate[d];
        speed += rate[d] * rate[d];
    }
    return spring->damping * (spring->length == 0.0 ? speed : along * along / square);
}

static const fu_point_law law = {force_of, step_force, energy, dissipation};

const fu_coupling_type fu_spring_type = {.name = "spring", .law = &law, FU_POINT_FORCE_OPERATIONS};
