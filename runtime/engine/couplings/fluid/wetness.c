/* Fluids with a surface: the wet part of a body or of a cable's section (derive/couplings/wetness.py), and the
 * quadrature along an element cut by a surface.
 *
 * Along an element the wet part is 0, 1, or changes over the short length on which the surface cuts the section. The
 * quadrature ends where that length begins and ends, so that the integral is smooth in the coordinates. Within that
 * length points are denser near both ends, where the wet part has singular derivatives.
 */
#include "bodies/model.h"
#include "couplings/fluid/drag.h"

#include <math.h>

/* of half the height of a column: its ends are rounded by this to both sides (runtime/parts/drag.py) */
#define COLUMN_ROUNDING 0.05
/* of the radius of a section: beyond it matrices neglect the second derivative, which is singular at 1 */
#define MAX_SECTION_DEPTH 0.99
/* spans of an element, on each of which heights are a cubic: exact for cubic elements */
#define SPANS_PER_ELEMENT 4
#define MAX_CUTS 24 /* of an element by the edges of a section at two surfaces, in two configurations */
/* of an element's length times its steepest slope at the samples: variation of heights between samples */
#define HEIGHT_VARIATION 0.35
#define MIN_PART 1e-12 /* of an element: shorter parts have no points */

static double end_of(const fu_drag *drag)
{
    return drag->wet == FU_WET_COLUMN ? 1.0 + COLUMN_ROUNDING : 1.0;
}

double fu_wet_reach(const fu_drag *drag)
{
    return end_of(drag) * drag->extent;
}

/* Returns the part of the shape below a level. */
static fu_wetness below(const fu_drag *drag, double level, double height)
{
    const double u = (level - height) / drag->extent, end = end_of(drag);
    double e, c, c_u, c_uu;
    if (u <= -end) return (fu_wetness){.part = 0.0};
    if (u >= end) return (fu_wetness){.part = 1.0};
    if (drag->wet == FU_WET_SPHERE) drag->kernel->wet_sphere(&u, &e, &c, &c_u, &c_uu);
    else if (drag->wet == FU_WET_SECTION) {
        const double theta = asin(u);
        drag->kernel->wet_section(&theta, &e, &c, &c_u, &c_uu);
        if (fabs(u) > MAX_SECTION_DEPTH) c_uu = 0.0;
    } else {
        const double lower = -fabs(u), rounding = COLUMN_ROUNDING;
        c = 0.5 * (1.0 + lower);
        c_u = 0.5;
        c_uu = 0.0;
        if (lower < rounding - 1.0) drag->kernel->wet_column(&lower, &rounding, &e, &c, &c_u, &c_uu);
        if (u > 0.0) { /* the upper half is the lower one upside down */
            c = 1.0 - c;
            c_uu = -c_uu;
        }
    }
    return (fu_wetness){.part = c, .slope = -c_u / drag->extent, .curvature = c_uu / (drag->extent * drag->extent)};
}

fu_wetness fu_wet_at_height(const fu_drag *drag, double height)
{
    const fu_wetness top = below(drag, drag->surface, height), bottom = below(drag, drag->bottom, height);
    return (fu_wetness){.part = top.part - bottom.part,
                        .slope = top.slope - bottom.slope,
                        .curvature = top.curvature - bottom.curvature};
}

static double height_above_still_level(const fu_model *model, const fu_drag *drag, const double *r)
{
    return drag->flow.base + fu_dot(model->dim, drag->flow.up, r);
}

double fu_drag_height(const fu_model *model, const fu_drag *drag, double t, const double *r)
{
    const double height = height_above_still_level(model, drag, r);
    return drag->waves.n_waves ? height - fu_elevation_at(model, drag, t, r).eta : height;
}

int fu_near_surface(const fu_drag *drag, double height)
{
    const double reach = fu_wet_reach(drag) + drag->waves.max_elevation;
    return fabs(height - drag->surface) <= reach || fabs(height - drag->bottom) <= reach;
}

/* Heights of the axis over a span of an element: a0 + a1 x + a2 x^2 + a3 x^3, x from 0 to 1. */
typedef struct {
    double start, length, a[4];
} heights;

static double height_on(const heights *of, double x)
{
    return of->a[0] + x * (of->a[1] + x * (of->a[2] + x * of->a[3]));
}

static double slope_on(const heights *of, double x)
{
    return of->a[1] + x * (2.0 * of->a[2] + x * 3.0 * of->a[3]);
}

/* Returns the x in [low, high] at which heights, monotone there, reach a level (Newton's method with bisection). */
static double reached_at(const heights *of, double level, double low, double high)
{
    const double sense = height_on(of, high) > height_on(of, low) ? 1.0 : -1.0;
    double x = 0.5 * (low + high);
    for (int i = 0; i < 60; ++i) {
        const double over = sense * (height_on(of, x) - level), slope = sense * slope_on(of, x);
        if (over > 0.0) high = x;
        else low = x;
        const double next = slope > 0.0 ? x - over / slope : low;
        const double to = next > low && next < high ? next : 0.5 * (low + high);
        if (fabs(to - x) <= 1e-15) return to;
        x = to;
    }
    return x;
}

/* Computes the ends of the parts of [0, 1] with monotone heights; returns the number of parts. */
static int monotone_parts(const heights *of, double ends[4])
{
    const double a = 3.0 * of->a[3], b = of->a[2], c = of->a[1], square = b * b - a * c;
    int n = 0;
    ends[0] = 0.0;
    if (square > 0.0) {
        const double root = -(b + (b > 0.0 ? sqrt(square) : -sqrt(square)));
        double at[2] = {a != 0.0 ? root / a : -1.0, root != 0.0 ? c / root : -1.0};
        if (at[0] > at[1]) {
            const double first = at[1];
            at[1] = at[0];
            at[0] = first;
        }
        for (int k = 0; k < 2; ++k)
            if (at[k] > ends[n] && at[k] < 1.0) ends[++n] = at[k];
    }
    ends[++n] = 1.0;
    return n;
}

/* Adds the positions at which heights reach a level to the cuts, in increasing order. */
static void cut_at(const heights *of, double level, double cuts[MAX_CUTS], int *n)
{
    double ends[4];
    const int parts = monotone_parts(of, ends);
    for (int k = 0; k < parts && *n < MAX_CUTS; ++k) {
        const double from = height_on(of, ends[k]) - level, to = height_on(of, ends[k + 1]) - level;
        if (!((from < 0.0 && to >= 0.0) || (from >= 0.0 && to < 0.0))) continue;
        const double cut = of->start + of->length * reached_at(of, level, ends[k], ends[k + 1]);
        int at = (*n)++;
        for (; at > 0 && cuts[at - 1] > cut; --at) cuts[at] = cuts[at - 1];
        cuts[at] = cut;
    }
}

/* Gauss's rules on [0, 1]. */
static const double PLAIN[2][4] = {{0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970262},
                                   {0.1739274225687269, 0.32607257743127305, 0.32607257743127305, 0.1739274225687269}};
static const double GATHERED[2][8] = {
    {0.019855071751231912, 0.10166676129318664, 0.2372337950418355, 0.4082826787521751, 0.5917173212478248,
     0.7627662049581645, 0.8983332387068134, 0.9801449282487681},
    {0.05061426814518853, 0.11119051722668721, 0.15685332293894344, 0.18134189168918083, 0.18134189168918083,
     0.15685332293894344, 0.11119051722668721, 0.05061426814518853}};

/* An element of a cable, or of a span of a rope: its number, the number of its shape functions, its length, m. */
typedef struct {
    int number, n;
    double length, t;
    const fu_cable *cable;     /* null: of a span */
    const fu_span_element *on; /* null: of a cable */
} element;

/* Adds a point at x of an element; of a span without shape functions. */
static void add_point(const element *of, int part, double x, double weight, fu_drag_points *out)
{
    const int n = of->n;
    double *N = out->shapes + (size_t)out->n * 2 * (size_t)n, *N_x = N + n;
    if (of->cable) of->cable->kernel->on_axis(of->length, x, N, N_x);
    out->x[out->n] = x;
    out->part[out->n] = part;
    out->at[out->n++] = (fu_quadrature_point){weight, N, N_x, 0};
}

/* A configuration of an element: coordinates e, and the heights of its axis over its spans. */
typedef struct {
    const double *e;
    heights of[SPANS_PER_ELEMENT];
} shape;

/* Adds the points of a part of an element, unless it is dry; wet: wet parts of one or two configurations in the middle
 * of it. */
static void add_part(const element *of, int number, double from, double to, const fu_wetness *wet, int n_shapes,
                     fu_drag_points *out)
{
    const double part = to - from;
    int is_wet = 0, is_cut = 0;
    for (int k = 0; k < n_shapes; ++k) {
        is_wet |= wet[k].part != 0.0 || wet[k].slope != 0.0;
        is_cut |= wet[k].slope != 0.0;
    }
    if (part <= MIN_PART * of->length || !is_wet) return;
    for (int k = 0; k < 4 && !is_cut; ++k) add_point(of, number, from + part * PLAIN[0][k], part * PLAIN[1][k], out);
    for (int k = 0; k < 8 && is_cut; ++k) {
        const double x = GATHERED[0][k];
        add_point(of, number, from + part * x * x * (3.0 - 2.0 * x), part * 6.0 * x * (1.0 - x) * GATHERED[1][k], out);
    }
}

/* Returns the height above the origin of a point of an element's axis by its shape functions, or the slope of the
 * height by their slopes. */
static double along_axis(const fu_model *model, const fu_drag *drag, int n, const double *shape, const double *e)
{
    double sum = 0.0;
    for (int k = 0; k < n; ++k) sum += shape[k] * fu_dot(model->dim, drag->flow.up, e + k * model->dim);
    return sum;
}

/* Computes the height of a point of a cable above a surface with waves, and its slope by x. */
static void above_waves(const fu_model *model, const fu_drag *drag, double t, int n, const double *N, const double *N_x,
                        const double *e, double *height, double *slope)
{
    const int dim = model->dim;
    double r[3], r_x[3];
    fu_interpolate(dim, n * dim, N, e, r);
    fu_interpolate(dim, n * dim, N_x, e, r_x);
    const fu_elevation at = fu_elevation_at(model, drag, t, r);
    *height = height_above_still_level(model, drag, r) - at.eta;
    *slope = fu_dot(dim, drag->flow.up, r_x) - fu_dot(dim, at.slope, r_x);
}

/* Computes the height above the still level of the same, and its slope by x. */
static void above_still_level(const fu_model *model, const fu_drag *drag, int n, const double *N, const double *N_x,
                              const double *e, double *height, double *slope)
{
    *height = drag->flow.base + along_axis(model, drag, n, N, e);
    *slope = along_axis(model, drag, n, N_x, e);
}

/* Computes the height of a point at x of an element's axis, and its slope by x. */
static void axis_at(const fu_model *model, const fu_drag *drag, const element *of, const double *e, double x,
                    double *height, double *slope)
{
    if (of->cable) {
        double N[FU_MAX_COORDINATES], N_x[FU_MAX_COORDINATES];
        of->cable->kernel->on_axis(of->length, x, N, N_x);
        if (drag->waves.n_waves) above_waves(model, drag, of->t, of->n, N, N_x, e, height, slope);
        else above_still_level(model, drag, of->n, N, N_x, e, height, slope);
        return;
    }
    double r[3], r_S[3], velocity[3];
    drag->on.kernel->point(of->length, e, of->on->v, of->on->s_rate, x / of->length, r, r_S, velocity);
    *height = height_above_still_level(model, drag, r);
    *slope = fu_dot(model->dim, drag->flow.up, r_S);
}

/* The lowest and the highest of the samples of an element, m, and the steepest slope. */
typedef struct {
    double low, high, steepest;
} height_range;

static void widen(double height, double slope, height_range *range)
{
    range->low = fmin(range->low, height);
    range->high = fmax(range->high, height);
    range->steepest = fmax(range->steepest, fabs(slope));
}

/* Returns the range of heights above the surface with waves, or above the still level. */
static height_range range_of(const fu_model *model, const fu_drag *drag, const element *of, const double *e,
                             int with_waves)
{
    const int n = of->n, per_node = of->cable ? of->cable->per_node : drag->on.kernel->coordinates / FU_SPAN_ENDS;
    height_range range = {HUGE_VAL, -HUGE_VAL, 0.0};
    for (int k = 0; k < 2; ++k)
        widen(with_waves ? fu_drag_height(model, drag, of->t, e + k * per_node)
                         : height_above_still_level(model, drag, e + k * per_node),
              0.0, &range);
    for (int g = 0; g < drag->n_points; ++g) {
        double h, slope;
        if (of->cable) {
            const fu_quadrature_point point = fu_drag_point(drag, n, of->number, g);
            if (with_waves) above_waves(model, drag, of->t, n, point.N, point.N_x, e, &h, &slope);
            else above_still_level(model, drag, n, point.N, point.N_x, e, &h, &slope);
        } else axis_at(model, drag, of, e, of->length * PLAIN[0][g], &h, &slope);
        widen(h, slope, &range);
    }
    return range;
}

/* Returns whether a range with a margin is entirely on one side of each surface. */
static int is_clear(const fu_drag *drag, const element *of, const height_range *range, double margin)
{
    const double reach = margin + drag->extent + HEIGHT_VARIATION * of->length * range->steepest;
    return (range->low - reach > drag->surface || range->high + reach < drag->surface) &&
           (range->low - reach > drag->bottom || range->high + reach < drag->bottom);
}

/* Returns whether an element is entirely on one side of each surface; *height is then a height of it. */
static int is_uncut(const fu_model *model, const fu_drag *drag, const element *of, const double *e, double *height)
{
    height_range range = range_of(model, drag, of, e, 0);
    int uncut = is_clear(drag, of, &range, drag->waves.max_elevation);
    if (!uncut && drag->waves.n_waves) {
        range = range_of(model, drag, of, e, 1);
        uncut = is_clear(drag, of, &range, 0.0);
    }
    *height = range.low;
    return uncut;
}

/* Computes the heights of a configuration, and adds the positions at which a surface touches the edge of the section to
 * the cuts. */
static void cut_shape(const fu_model *model, const fu_drag *drag, const element *on, shape *of, double cuts[MAX_CUTS],
                      int *n_cuts)
{
    const double levels[4] = {drag->surface - drag->extent, drag->surface + drag->extent, drag->bottom - drag->extent,
                              drag->bottom + drag->extent};
    const double span = on->length / SPANS_PER_ELEMENT;
    double h[SPANS_PER_ELEMENT + 1], slope[SPANS_PER_ELEMENT + 1];
    for (int k = 0; k <= SPANS_PER_ELEMENT; ++k) {
        axis_at(model, drag, on, of->e, k * span, &h[k], &slope[k]);
        slope[k] *= span;
    }
    for (int k = 0; k < SPANS_PER_ELEMENT; ++k) {
        of->of[k] = (heights){k * span,
                              span,
                              {h[k], slope[k], 3.0 * (h[k + 1] - h[k]) - 2.0 * slope[k] - slope[k + 1],
                               2.0 * (h[k] - h[k + 1]) + slope[k] + slope[k + 1]}};
        for (int l = 0; l < 4; ++l) cut_at(&of->of[k], levels[l], cuts, n_cuts);
    }
}

/* Computes the points of an element that a surface may cut, in one or two configurations. */
static void cut_points(const fu_model *model, const fu_drag *drag, const element *of, shape *shapes, int n_shapes,
                       fu_drag_points *out)
{
    const double length = of->length, span = length / SPANS_PER_ELEMENT;
    double cuts[MAX_CUTS];
    int n_cuts = 0;
    for (int s = 0; s < n_shapes; ++s) cut_shape(model, drag, of, &shapes[s], cuts, &n_cuts);
    for (int k = 0; k <= n_cuts; ++k) {
        const double from = k ? cuts[k - 1] : 0.0, to = k < n_cuts ? cuts[k] : length,
                     middle = 0.5 * (from + to) / span;
        const int in = middle < SPANS_PER_ELEMENT - 1 ? (int)middle : SPANS_PER_ELEMENT - 1;
        fu_wetness wet[2];
        for (int s = 0; s < n_shapes; ++s) wet[s] = fu_wet_at_height(drag, height_on(&shapes[s].of[in], middle - in));
        add_part(of, k, from, to, wet, n_shapes, out);
    }
}

/* Computes the points of an element, in one or two configurations. */
static void points_of(const fu_model *model, const fu_drag *drag, const element *of, shape *shapes, int n_shapes,
                      fu_drag_points *out)
{
    out->n = 0;
    if (drag->wet != FU_ALL_WET) {
        double height, part[2] = {0.0};
        int uncut = 1;
        for (int s = 0; s < n_shapes && uncut; ++s) {
            uncut = is_uncut(model, drag, of, shapes[s].e, &height);
            if (uncut) part[s] = fu_wet_at_height(drag, height).part;
        }
        if (!uncut) {
            cut_points(model, drag, of, shapes, n_shapes, out);
            return;
        }
        if (part[0] == 0.0 && part[1] == 0.0) return;
    }
    for (int g = 0; g < drag->n_points; ++g) {
        out->x[g] = of->length * PLAIN[0][g];
        out->part[g] = 0;
        out->at[out->n++] = of->cable ? fu_drag_point(drag, of->n, of->number, g)
                                      : (fu_quadrature_point){.weight = of->length * PLAIN[1][g]};
    }
}

static element of_cable(const fu_model *model, const fu_drag *drag, double t, int number)
{
    const fu_cable *cable = &model->cables[drag->cable];
    return (element){number, cable->coordinates / model->dim, fu_element_length(cable, number), t, cable, 0};
}

void fu_drag_points_on(const fu_model *model, const fu_drag *drag, double t, int number, const double *e,
                       fu_drag_points *out)
{
    const element of = of_cable(model, drag, t, number);
    shape one[1] = {{.e = e}};
    points_of(model, drag, &of, one, 1, out);
}

void fu_drag_points_on_span(const fu_model *model, const fu_drag *drag, const fu_span_element *on, fu_drag_points *out)
{
    const element of = {on->number, 0, on->l, 0.0, 0, on};
    shape one[1] = {{.e = on->e}};
    points_of(model, drag, &of, one, 1, out);
}

/* The scheme that conserves energy takes no waves, so that the time does not matter. */
void fu_drag_points_over(const fu_model *model, const fu_drag *drag, int number, const double *e, const double *e_next,
                         fu_drag_points *out)
{
    const element of = of_cable(model, drag, 0.0, number);
    shape both[2] = {{.e = e}, {.e = e_next}};
    points_of(model, drag, &of, both, 2, out);
}
