/* Events of drag in a fluid with a table: a part leaves the table, or is entirely within it again; with those of
 * surfaces (events/fluid_surface.c). */
#include "bodies/model.h"
#include "couplings/common/coupling_events.h"
#include "events/fluid_surface.h"

#include <math.h>

#define N_TABLE_FUNCTIONS 1 /* event functions of the table, before those of surfaces */
/* of an axis of a table: smaller distances beyond an edge are at it, as of a run that ends with a table */
#define EDGE_TOLERANCE 1e-9

/* Returns the distance of a position within the table, with a surface that of the nearest position in the fluid. */
static double margin_at(const fu_model *model, const fu_drag *drag, double t, const double *r)
{
    const double height = fu_drag_height(model, drag, t, r), to = fmin(fmax(height, drag->bottom), drag->surface);
    double at[3];
    for (int d = 0; d < model->dim; ++d) at[d] = r[d] + (to - height) * drag->flow.up[d];
    return fu_flow_margin(model, &drag->flow, t, at);
}

/* Returns the least distance within the table over all of a part in the fluid, relative to the axes of the table;
 * negative beyond its edges. */
static double margin(const fu_model *model, const fu_drag *drag, const fu_state *state)
{
    double least = 1.0;
    const int nodes = fu_drag_nodes(drag);
    for (int k = 0; k < nodes; ++k)
        least = fmin(least, margin_at(model, drag, state->t, fu_drag_node(model, drag, k, state->q)));
    if (!nodes) {
        fu_attachment_state end;
        fu_attachment_at(model, &drag->attachments[0], state, 0.0, FU_POINT, &end);
        least = margin_at(model, drag, state->t, end.p);
    }
    return least + EDGE_TOLERANCE;
}

static int has_edges(const fu_drag *drag)
{
    return drag->flow.degree > 0;
}

/* Returns flags by the number of the event function: nonzero for a negative value. */
static int *is_outside(const fu_coupling *coupling, const fu_state *state)
{
    return state->flags + coupling->flags;
}

static int functions(const fu_coupling *coupling, fu_event_function *out)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    const int n = has_edges(drag);
    if (n && out) *out = (fu_event_function){.which = 0, .direction = 0};
    return n + fu_surface_event_functions(drag, N_TABLE_FUNCTIONS, out ? out + n : 0);
}

static double value_of(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int which)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    return which < N_TABLE_FUNCTIONS ? margin(model, drag, state)
                                     : fu_surface_event_value(model, drag, state, which - N_TABLE_FUNCTIONS);
}

static int sign(const fu_model *model, const fu_coupling *coupling, const fu_state *state, int which)
{
    (void)model;
    return is_outside(coupling, state)[which] ? -1 : 1;
}

/* Records the side of a surface. Of a table, records that a part leaves the table, or is entirely within it again. The
 * velocity is continuous there, its derivatives are not. */
static const char *pass_edge(const fu_model *model, const fu_coupling *coupling, fu_state *now, int which, int side)
{
    (void)model;
    is_outside(coupling, now)[which] = side < 0;
    if (which >= N_TABLE_FUNCTIONS) return 0;
    return side < 0 ? "leaves the table of its fluid" : "is back in the table of its fluid";
}

static int can_act(const fu_coupling *coupling)
{
    const fu_drag *drag = (const fu_drag *)coupling;
    return has_edges(drag) || drag->wet != FU_ALL_WET;
}

static void begin(const fu_model *model, const fu_coupling *coupling, fu_state *now)
{
    fu_event_function at[FU_DRAG_FLAGS];
    const int n = functions(coupling, at);
    *is_outside(coupling, now) = margin(model, (const fu_drag *)coupling, now) < 0.0;
    for (int k = 0; k < n; ++k)
        is_outside(coupling, now)[at[k].which] = value_of(model, coupling, now, at[k].which) < 0.0;
}

static const fu_state_event_operations of_state = {.value = value_of, .change = pass_edge, .begin = begin};

const fu_coupling_events fu_drag_events = {
    .of_state = &of_state, .functions = functions, .sign = sign, .can_act = can_act};
