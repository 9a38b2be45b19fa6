/* Sums over the elements of a span of a rope. */
#include "couplings/common/span_elements.h"
#include "bodies/model.h"
#include "bodies/unknowns.h"

enum { ENDS = FU_SPAN_ENDS };

const char *const fu_span_role[] = {"span", 0};

void fu_span_at_ends(const fu_span_elements *span, int k, const double *dofs, double out[ENDS])
{
    const double first = dofs[span->s[0]], change = dofs[span->s[1]] - first;
    for (int i = 0; i < ENDS; ++i) out[i] = first + span->share[k + i] * change;
}

fu_span_element fu_span_element_at(const fu_model *model, const fu_span_elements *span, int k, const double *q,
                                   const double *v, const double *a)
{
    fu_span_element it = {.number = k, .at = span->first + k * (span->kernel->coordinates / ENDS)};
    if (!v) v = model->zero;
    if (!a) a = model->zero;
    fu_span_at_ends(span, k, q, it.s);
    fu_span_at_ends(span, k, v, it.s_rate);
    fu_span_at_ends(span, k, a, it.s_acc);
    it.l = it.s[1] - it.s[0];
    it.e = q + it.at;
    it.v = v + it.at;
    it.a = a + it.at;
    return it;
}

void fu_add_span_force(const fu_span_elements *span, const fu_span_element *on, const double *of_e,
                       const double *of_ends, double of_length, double *f)
{
    for (int i = 0; i < span->kernel->coordinates; ++i) f[on->at + i] += of_e[i];
    for (int i = 0; i < ENDS; ++i) {
        const double force = (of_ends ? of_ends[i] : 0.0) + (i ? of_length : -of_length);
        const double share = span->share[on->number + i];
        f[span->s[0]] += (1.0 - share) * force;
        f[span->s[1]] += share * force;
    }
}

void fu_to_ends_of_span(const fu_span_elements *span, int k, double *first, double *last, int n, int stride)
{
    const double a = span->share[k], b = span->share[k + 1];
    for (int i = 0; i < n; ++i, first += stride, last += stride) {
        const double by_first = *first, by_last = *last;
        *first = (1.0 - a) * by_first + (1.0 - b) * by_last;
        *last = a * by_first + b * by_last;
    }
}

void fu_add_span_matrix(const fu_model *model, const fu_span_elements *span, const fu_span_element *on,
                        double (*K)[FU_SPAN_LOCAL], fu_system *system)
{
    const int n = span->kernel->coordinates;
    int dofs[FU_SPAN_LOCAL];
    for (int i = 0; i < n; ++i) dofs[i] = on->at + i;
    for (int i = 0; i < ENDS; ++i) dofs[n + i] = span->s[i];
    fu_to_ends_of_span(span, on->number, &K[0][n], &K[0][n + 1], n + ENDS, FU_SPAN_LOCAL);
    fu_to_ends_of_span(span, on->number, K[n], K[n + 1], n + ENDS, 1);
    for (int i = 0; i < n + ENDS; ++i)
        for (int j = 0; j < n + ENDS; ++j)
            if (K[i][j] != 0.0) fu_add(model, system, dofs[i], dofs[j], K[i][j]);
}

void fu_add_by_length(int rows, int n, double factor, const double *by, double (*local)[FU_SPAN_LOCAL])
{
    for (int i = 0; i < rows; ++i, by += n + 1) {
        for (int j = 0; j < n; ++j) local[i][j] += factor * by[j];
        local[i][n] -= factor * by[n];
        local[i][n + 1] += factor * by[n];
    }
}

void fu_add_by_rates(int all, double factor, const double *D, double (*local)[FU_SPAN_LOCAL])
{
    for (int i = 0; i < all; ++i)
        for (int j = 0; j < all; ++j) local[i][j] += factor * D[i * all + j];
}

void fu_add_by_energy(int n, double factor, const double *K, const double *K_l, double K_ll,
                      double (*local)[FU_SPAN_LOCAL])
{
    static const double sign[ENDS] = {-1.0, 1.0};
    for (int i = 0; i < n; ++i) {
        for (int j = 0; K && j < n; ++j) local[i][j] += factor * K[i * n + j];
        for (int e = 0; e < ENDS; ++e) {
            local[i][n + e] += factor * sign[e] * K_l[i];
            local[n + e][i] += factor * sign[e] * K_l[i];
        }
    }
    for (int i = 0; i < ENDS; ++i)
        for (int j = 0; j < ENDS; ++j) local[n + i][n + j] += factor * sign[i] * sign[j] * K_ll;
}
