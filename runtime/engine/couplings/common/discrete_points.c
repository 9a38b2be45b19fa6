/* Forces on the points of attachments over a step that conserves energy: their work is that on the change of the place.
 *
 * A material point of a rope may pass ends of elements in a step. The step, along which nodes and material coordinates
 * change linearly, is then divided at these instants (derive/couplings/rope_point.py). */
#include "bodies/model.h"
#include "bodies/state.h"
#include "couplings/common/attachments.h"

enum { SPAN_ENDS = 2, ROPE_ELEMENT = 4 /* vectors of an element */ };

/* Numbers of a rope at a part of a step: nodal vectors of an element, s1 and s2. */
typedef struct {
    double e[FU_MAX_COORDINATES], s[SPAN_ENDS];
} rope_at;

static double between(const fu_state *now, const fu_state *next, double part, int dof)
{
    return (1.0 - part) * now->q[dof] + part * next->q[dof];
}

static void look(const fu_attachment *on, const fu_state *now, const fu_state *next, double part, int first, int n,
                 rope_at *out)
{
    for (int i = 0; i < n; ++i) out->e[i] = between(now, next, part, first + i);
    for (int i = 0; i < SPAN_ENDS; ++i) out->s[i] = between(now, next, part, on->span_s[i]);
}

/* Returns the distance of the point beyond a node of the span at a state, m. */
static double beyond(const fu_attachment *on, const fu_state *state, int node)
{
    const double first = state->q[on->span_s[0]], length = state->q[on->span_s[1]] - first;
    return on->material - first - on->share[node] * length;
}

/* Returns the element of the point at a state. */
static int element_of(const fu_attachment *on, const fu_state *state)
{
    int element = 0;
    while (element < on->span_elements - 1 && beyond(on, state, element + 1) > 0.0) ++element;
    return element;
}

static void add_on_rope(const fu_model *model, const fu_attachment *on, const fu_state *now, const fu_state *next,
                        const double *force, double factor, double *f)
{
    const int dim = model->dim, n = ROPE_ELEMENT * dim, all = n + SPAN_ENDS, last = element_of(on, next);
    double begin = 0.0;
    for (int element = element_of(on, now);; element += last > element ? 1 : -1) {
        const int node = element + (last > element), first = on->node + element * (n / SPAN_ENDS);
        const double from = beyond(on, now, node), to = beyond(on, next, node);
        const double end = element == last ? 1.0 : from / (from - to);
        double P[3 * FU_ATTACHMENT_COORDINATES];
        rope_at ends[2];
        look(on, now, next, begin, first, n, &ends[0]);
        look(on, now, next, end, first, n, &ends[1]);
        on->rope->discrete_point(ends[0].e, ends[1].e, ends[0].s, ends[1].s, on->share + element, on->material, P);
        for (int i = 0; i < all; ++i) {
            double sum = 0.0;
            for (int d = 0; d < dim; ++d) sum += P[d * all + i] * force[d];
            f[i < n ? first + i : on->span_s[i - n]] += factor * (end - begin) * sum;
        }
        if (element == last) return;
        begin = end;
    }
}

void fu_add_point_over_step(const fu_model *model, const fu_attachment *on, const fu_state *now, const fu_state *next,
                            const double *force, double factor, double *f)
{
    fu_attachment_state at;
    if (on->rope) {
        add_on_rope(model, on, now, next, force, factor, f);
        return;
    }
    fu_attachment_at(model, on, now, 0.0, FU_PLACE, &at);
    fu_discrete_point(model, on, now, next, at.P);
    fu_add_wrench(model->dim, &at, force, 0, factor, f);
}
