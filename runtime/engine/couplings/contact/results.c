/* Stored and dissipated energy of contact with a surface, its results, and the history of its friction. */
#include "bodies/model.h"
#include "couplings/common/accelerator.h"
#include "couplings/contact/contact.h"

#include <math.h>
#include <string.h>

static const fu_contact *of(const fu_coupling *coupling)
{
    return (const fu_contact *)coupling;
}

static void add_energy(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, int element,
                       int number, const fu_contact_point *point, void *context)
{
    (void)model, (void)on;
    *(double *)context += fu_contact_weight(contact, element, number) * (point->energy + point->spring_energy);
}

double fu_contact_energy(const fu_model *model, const fu_coupling *coupling, const fu_state *state)
{
    double sum = 0.0;
    fu_contact_visit(model, of(coupling), state, add_energy, &sum);
    return sum;
}

static void add_power(const fu_model *model, const fu_contact *contact, const fu_attachment_state *on, int element,
                      int number, const fu_contact_point *point, void *context)
{
    (void)model, (void)on;
    *(double *)context += fu_contact_weight(contact, element, number) * point->power;
}

/* The dissipation of damping in the normal force; that of friction is added step by step. */
double fu_contact_dissipation(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                              const fu_accelerator *work)
{
    double sum = 0.0;
    (void)work;
    if (coupling->is_damped) fu_contact_visit(model, of(coupling), state, add_power, &sum);
    return sum;
}

void fu_contact_reset(const fu_coupling *coupling, fu_state *state)
{
    const fu_contact *contact = of(coupling);
    if (coupling->n_numbers)
        memcpy(state->numbers + coupling->numbers, contact->marks, sizeof(double) * (size_t)coupling->n_numbers);
}

/* Updates the marks: the stretch of friction's springs, and the positions of the points; points without contact have no
 * stretch. */
void fu_contact_update_history(const fu_model *model, const fu_coupling *coupling, fu_state *state)
{
    const fu_contact *contact = of(coupling);
    const int dim = model->dim;
    fu_attachment_state on;
    if (contact->law.friction == 0.0) return;
    fu_surface_at(model, &contact->surface, state, &on);
    for (int e = 0; e < fu_contact_elements(contact); ++e)
        for (int k = 0; k < contact->n_points; ++k) {
            fu_contact_point point;
            fu_contact_place(model, contact, &on, state, e, k, &point);
            const int in_contact = fu_contact_is_active(model, contact, &on, &point);
            fu_friction_mark *mark = fu_contact_mark(contact, state, e, k);
            fu_contact_note(dim, &on, &point, mark);
            if (in_contact) memcpy(mark->stretch, point.stretch, sizeof(double) * (size_t)dim);
        }
    fu_friction_begin *begin = fu_contact_begin_of(contact, state);
    double unused[3];
    begin->time = state->t;
    if (fu_contact_rolls(contact)) fu_contact_axes(model, contact, &on, state, begin->axes, unused);
}

/* Sums over the points of a contact in their order, and the ends of the length in contact; values between two points
 * are linear. */
typedef struct {
    fu_contact_output *numbers;
    double s, depth;
    int begun;
} tally;

/* Adds a next point at s, with its penetration, to the length in contact, and updates its ends. */
static void take_into_length(tally *sum, double s, double depth)
{
    fu_contact_output *numbers = sum->numbers;
    if (!sum->begun) sum->depth = depth; /* from the start */
    if (depth > 0.0 || sum->depth > 0.0) {
        const double part = sum->depth > 0.0 && depth > 0.0 ? 0.0 : sum->depth / (sum->depth - depth);
        const double cut = sum->s + part * (s - sum->s);
        const double from = sum->depth > 0.0 ? sum->s : cut, to = depth > 0.0 ? s : part > 0.0 ? cut : s;
        if (numbers->touching == 0.0) numbers->first = from;
        numbers->touching += to - from;
        numbers->last = to;
    }
    sum->s = s;
    sum->depth = depth;
    sum->begun = 1;
}

void fu_contact_outputs(const fu_model *model, const fu_coupling *coupling, const fu_state *state,
                        const double *acceleration, const fu_accelerator *work, double *out)
{
    const fu_contact *contact = of(coupling);
    const int n = fu_contact_elements(contact);
    fu_attachment_state on;
    fu_contact_output *numbers = (fu_contact_output *)out;
    tally sum = {.numbers = numbers, .s = contact->start};
    (void)acceleration, (void)work;
    *numbers = (fu_contact_output){.penetration = 0.0};
    fu_surface_at(model, &contact->surface, state, &on);
    for (int e = 0; e < n; ++e) {
        fu_contact_heights heights;
        fu_contact_heights_of(model, contact, &on, state, e, &heights);
        for (int k = 0; k < contact->n_points; ++k) {
            fu_contact_point point;
            const double weight = fu_contact_weight(contact, e, k);
            const int in_contact = fu_contact_is_active_at(model, contact, &on, state, e, k, &heights, &point);
            if (contact->cable >= 0) take_into_length(&sum, contact->arc[(long)e * contact->n_points + k], point.depth);
            if (!in_contact) continue;
            for (int d = 0; d < model->dim; ++d) {
                numbers->force[d] += weight * point.f[d];
                numbers->friction_force[d] += weight * point.friction[d];
            }
            numbers->penetration = fmax(numbers->penetration, point.depth);
            if (contact->cable < 0) numbers->touching += 1.0;
        }
    }
    if (contact->cable >= 0) take_into_length(&sum, contact->stop, sum.depth); /* to its end */
}

/* Computes the force on each point, N/m or N, in order: out (points x 3). */
void fu_contact_densities(const fu_model *model, const fu_coupling *coupling, const fu_state *state, double *out)
{
    const fu_contact *contact = of(coupling);
    fu_attachment_state on;
    fu_surface_at(model, &contact->surface, state, &on);
    for (int e = 0; e < fu_contact_elements(contact); ++e)
        for (int k = 0; k < contact->n_points; ++k, out += 3) {
            fu_contact_point point;
            fu_contact_place(model, contact, &on, state, e, k, &point);
            const int in_contact = fu_contact_is_active(model, contact, &on, &point);
            for (int d = 0; d < 3; ++d) out[d] = in_contact && d < model->dim ? point.f[d] : 0.0;
        }
}
