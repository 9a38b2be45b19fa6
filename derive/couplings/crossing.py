"""Contact of two lines at their closest points: a cable under the bar of a body, a cable that crosses another.

Each line is known at its point by position, slope, curvature r_xx, and the rates of the first two. In the plane the
second line is a bar square to it, which is seen as a point. The points are closest where the displacement d from
the second to the first is square to both lines. These conditions give the motion of the points along their lines. The
normal n is square to both slopes and has a given sign (``side``), so that the gap keeps its sign where the lines pass
through each other.

The force on the first line is N n, with N = k p^e (1 + damping p') of the penetration p = radii - n.d: the law of Hunt
& Crossley, J. Appl. Mech. 42 (1975) 440-445. k p^e is c_1 p + c_2 p sqrt(|p|), of which one coefficient is zero. It is
odd in p, so that it is smooth across p = 0, where a run ends contact.

Friction is Coulomb's, -mu N v/sqrt(v.v + v0^2) by the slip v: the part of the relative velocity of both lines'
particles at the points that is square to n. Or it sticks (`stretch`): the spring is stretched by the integral of v over
the step. Its components are along the last line that has a slope and square to that line, and turn with it. The
particles at the points change as these move along their lines: v is the rate of d, less the rates of the arc-lengths
times the slopes. Within the step d, slopes and arc-lengths are cubics through values and rates at both ends. Simpson's
rule then leaves an error of the fifth order in the step. The displacement of the particles at one end alone, along the
tangent plane there, leaves one of the second. All forces act at the points on the axes.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import sympy as sp

from ..codegen.family import CouplingFamily
from ..codegen.program import Program
from .crossing_stretch import Motion, Stretch, jacobian_along, stretch_after, turned_stretch
from .stretch import sliding_force, sticking_force

CROSSINGS = {3: "crossing", 2: "planar_crossing"}
PENALTY = ("radii", "side", "linear", "root", "damping", "least", "friction", "v0")
NEGLIGIBLE = sp.Rational(1, 10**16)  # share of the square of a line's size: shorter displacements are rounding
SOURCE = "Hunt & Crossley 1975; closest points by the implicit function theorem"
NONE = np.zeros(0, dtype=object)


class _Lines(NamedTuple):
    """The data of both lines: the displacement between the points, slopes and curvatures."""

    d: np.ndarray
    t: np.ndarray
    k: np.ndarray

    @property
    def signs(self) -> list[int]:
        """Return the sign of each point in d."""
        return [1, -1][: len(self.t)]


def families() -> list[CouplingFamily]:
    """Return the families in space and in the plane."""
    return CouplingFamily.each("crossing", "contact of lines at their closest points", CROSSINGS, build)


def build(dim: int) -> list[Program]:
    """Return the kernels in space or in the plane."""
    return [closest(dim), contact(dim), force(dim), motion(dim), stretch(dim), turned(dim), sticking(dim),
            sliding(dim), step(dim)]


def _lines(p: Program, dim: int, with_curvature: bool = True) -> _Lines:
    """Declare the data of both lines; in the plane the second has its point alone."""
    shape = (dim - 1, dim)
    d = p.input("d", dim, "m", "position of the first point less that of the second")
    t = p.input("t", shape, "1", "slopes of the lines")
    return _Lines(d, t, p.input("k", shape, "1/m", "curvatures r_xx of the lines") if with_curvature else t)


def _solve(p: Program, lines: _Lines, right: Sequence[Sequence[sp.Expr]]) -> list[list[sp.Expr]]:
    """Return the solutions of the conditions' matrix for right sides, each (lines,)."""
    t, k, d, signs = lines.t, lines.k, lines.d, lines.signs
    n = len(t)
    matrix = [[sign * t[i].dot(t[j]) + (k[i].dot(d) if i == j else 0) for j, sign in enumerate(signs)]
              for i in range(n)]
    matrix = [[p.define(f"J_{i}{j}", entry) for j, entry in enumerate(row)] for i, row in enumerate(matrix)]
    if n == 1:
        inverse = p.define("inv_J", 1 / matrix[0][0])
        return [[inverse * each[0]] for each in right]
    (a, b), (c, e) = matrix
    inverse = p.define("inv_J", 1 / p.define("det_J", a * e - b * c))
    return [[inverse * (e * x - b * y), inverse * (a * y - c * x)] for x, y in right]


def closest(dim: int) -> Program:
    """Return the kernel of the distances to the closest points along both lines."""
    p = Program(f"{CROSSINGS[dim]}_closest", "a step of Newton's method to the closest points", SOURCE)
    lines = _lines(p, dim)
    p.stage("conditions of closeness")
    gaps = [p.define(f"h_{i}", t.dot(lines.d)) for i, t in enumerate(lines.t)]
    (step,) = _solve(p, lines, [[-gap for gap in gaps]])
    p.output("step", step, "m", "changes of the arc-lengths of both points, the first's alone in the plane")
    return p


def _normal(p: Program, lines: _Lines, side: sp.Expr) -> np.ndarray:
    """Return the unit vector square to both lines, of the given side."""
    if len(lines.t) == 1:
        x, y = lines.t[0]
        square = np.array([y, -x])
    else:
        square = p.vector("m", np.cross(*lines.t))
    inverse = p.define("inv_m", 1 / p.define("len_m", sp.sqrt(square.dot(square))))
    return p.vector("n", p.define("side_m", side * inverse) * square)


def _law(p: Program, n: np.ndarray, d: np.ndarray, u: np.ndarray, c: np.ndarray) -> dict[str, Any]:
    """Return penetration, its rate, the force k p^e without and with damping, and the speed that divides the slip."""
    radii, _, linear, root, damping, least, friction, v0 = c
    depth = p.define("depth", radii - n.dot(d))
    rate = p.define("rate", -n.dot(u))
    size = p.define("root_p", sp.sqrt(p.define("size_p", sp.sqrt(depth * depth + least * least))))
    elastic = p.define("elastic", depth * (linear + root * size))
    normal = p.define("N_law", elastic * (1 + damping * rate))
    slip = p.vector("slip", u + rate * n)
    speed = p.define("inv_speed", 1 / p.define("speed", sp.sqrt(slip.dot(slip) + v0 * v0)))
    friction_force = p.define("friction_force", friction * normal * speed)
    return {"depth": depth, "rate": rate, "elastic": elastic, "root": size, "normal": normal,
            "friction_force": friction_force, "slip": slip, "force": p.vector("F", normal * n - friction_force * slip)}


def _penalty(p: Program) -> np.ndarray:
    return p.input("c", len(PENALTY), "m, 1, N/m, N/m^1.5, s/m, m, 1, m/s",
                   "sum of the radii, sign of the normal, coefficients of p and p^1.5, damping, least |p|, "
                   "coefficient of friction, speed at which it is 0.7 of its full value")


def contact(dim: int) -> Program:
    """Return the kernel of the results of a contact at closest points."""
    p = Program(f"{CROSSINGS[dim]}_contact", "penetration and contact force at closest points", SOURCE)
    lines = _lines(p, dim, with_curvature=False)
    u = p.input("u", dim, "m/s", "rate of the displacement d between the points on their lines")
    c = _penalty(p)
    p.stage("normal")
    n = _normal(p, lines, c[1])
    p.stage("law")
    law = _law(p, n, lines.d, u, c)
    depth, linear, root = law["depth"], c[2], c[3]
    p.output("n", n, "1", "normal, from the second line to the first")
    p.output("p", [depth, law["rate"]], "m, m/s", "penetration, and its rate")
    p.output("N", [law["normal"]], "N", "size of the force along the normal")
    p.output("f", law["force"], "N", "force on the first line, with friction")
    p.output("U", [depth * depth * (linear / 2 + sp.Rational(2, 5) * root * law["root"])], "J", "energy of k p^e")
    slip = law["slip"]
    p.output("P", [law["elastic"] * c[4] * law["rate"] ** 2 + law["friction_force"] * slip.dot(slip)], "W",
             "power that damping and friction dissipate")
    return p


def _points_by(p: Program, lines: _Lines, moving: list[sp.Expr]) -> np.ndarray:
    """Return the derivatives of the arc-lengths of the closest points by d and the slopes."""
    p.stage("closest points: derivatives of the arc-lengths by d and by the slopes")
    gaps = [slope.dot(lines.d) for slope in lines.t]
    columns = _solve(p, lines, [[-sp.diff(gap, symbol) for gap in gaps] for symbol in moving])
    return np.array([[p.define(f"s{i}_{j}", column[i]) for j, column in enumerate(columns)]
                     for i in range(len(lines.t))])


def force(dim: int) -> Program:
    """Return the kernel of the force on the first line, and of its derivatives and those of the closest points."""
    p = Program(f"{CROSSINGS[dim]}_force", "contact force, and its derivatives with the closest points moving", SOURCE)
    lines = _lines(p, dim)
    w, u = _rates(p, lines)
    c = _penalty(p)
    p.stage("normal")
    n = _normal(p, lines, c[1])
    p.stage("law")
    F = _law(p, n, lines.d, u, c)["force"]
    return _with_points_moving(p, lines, F, _Moving(w, u))


class _Moving(NamedTuple):
    """What a force depends on besides d and slopes, none where it does not: rates of the slopes and of d, curvatures,
    and the arc-lengths that points have moved by; derivatives of curvatures along the lines, and in time; a chain of
    definitions as `jacobian_along` takes it.
    """

    w: np.ndarray = NONE
    u: np.ndarray = NONE
    k: np.ndarray = NONE
    e: np.ndarray = NONE
    third: np.ndarray = NONE
    k_rate: np.ndarray = NONE
    chain: tuple[np.ndarray, ...] = ()


def _with_points_moving(p: Program, lines: _Lines, F: np.ndarray, of: _Moving,
                        constant: Sequence[sp.Symbol] = ()) -> Program:
    """Return the kernel with the force F on the first line and its derivatives, those of the closest points in them."""
    dim, t, k = len(lines.d), lines.t, lines.k
    moving = [*lines.d, *t.ravel()]
    s_by = _points_by(p, lines, moving)
    by_rates = of.w.ravel() if len(of.e) else NONE
    p.stage("derivatives of the force where the points stay")
    at_point = jacobian_along(p, F, [*moving, *of.u, *by_rates, *of.k.ravel(), *of.e], of.chain, constant)
    by_d, by_t, by_u, by_w, by_k, by_e = np.split(
        at_point, np.cumsum([dim, t.size, len(of.u), len(by_rates), of.k.size]), axis=1)
    p.stage("derivatives of the force along the lines")
    along = []
    for i, sign in enumerate(lines.signs):
        own = slice(dim * i, dim * (i + 1))
        rate = sign * by_d @ t[i] + by_t[:, own] @ k[i] + sign * by_u @ of.w[i]
        if len(of.e):
            rate = rate + by_w[:, own] @ of.k_rate[i] + by_k[:, own] @ of.third[i] + by_e[:, i]
        along.append(p.vector(f"F_s{i}", rate))
    total = at_point[:, :len(moving)] + np.stack(along, axis=-1) @ s_by
    p.output("F", F, "N", "force on the first line; its opposite acts on the second")
    p.output("F_d", total[:, :dim], "N/m", "derivatives of F by d, with the closest points moving")
    p.output("F_t", total[:, dim:], "N", "derivatives of F by the slopes, likewise")
    p.output("F_u", by_u, "N s/m", "derivatives of F by u")
    if len(of.e):
        p.output("F_w", by_w, "N s", "derivatives of F by the rates of the slopes")
        p.output("F_k", by_k, "N m", "derivatives of F by the curvatures")
    else:
        p.output("s_d", s_by[:, :dim], "1", "derivatives of the arc-lengths of the closest points by d")
        p.output("s_t", s_by[:, dim:], "m", "derivatives of these by the slopes")
    return p


def _motion(p: Program, lines: _Lines, w: np.ndarray, u: np.ndarray) -> Motion:
    """Return the motion of the closest points."""
    (rates,) = _solve(p, lines, [[-t.dot(u) - w[i].dot(lines.d) for i, t in enumerate(lines.t)]])
    s_rate = np.array([p.define(f"s_rate_{i}", rate) for i, rate in enumerate(rates)])
    d_rate = u
    for sign, rate, t in zip(lines.signs, s_rate, lines.t, strict=True):
        d_rate = d_rate + sign * rate * t
    t_rate = np.stack([w[i] + rate * lines.k[i] for i, rate in enumerate(s_rate)])
    return Motion(s_rate, t_rate, p.vector("rate_d", d_rate))


def _stretch(p: Program, lines: _Lines, side: sp.Expr, n: np.ndarray, w: np.ndarray, u: np.ndarray) -> Stretch:
    """Return the stretch of friction's spring after the step."""
    p.stage("rates of the closest points")
    return stretch_after(p, lines.d, lines.t, lines.signs, side, n, u, _motion(p, lines, w, u))


def motion(dim: int) -> Program:
    """Return the kernel of the motion of the closest points."""
    p = Program(f"{CROSSINGS[dim]}_motion", "motion of the closest points", SOURCE)
    lines = _lines(p, dim)
    w, u = _rates(p, lines)
    p.stage("conditions of closeness")
    rates = _motion(p, lines, w, u)
    p.output("s_dot", rates.s, "m/s", "rates of the arc-lengths")
    p.output("t_dot", rates.t, "1/s", "rates of the slopes at the closest points")
    p.output("d_dot", rates.d, "m/s", "rate of d")
    return p


def _rates(p: Program, lines: _Lines) -> tuple[np.ndarray, np.ndarray]:
    """Declare the rates of slopes and of d."""
    return (p.input("w", lines.t.shape, "1/s", "rates of the slopes"),
            p.input("u", len(lines.d), "m/s", "rate of the displacement d between the points on their lines"))


def stretch(dim: int) -> Program:
    """Return the kernel of the stretch of friction's spring without sliding."""
    p = Program(f"{CROSSINGS[dim]}_stretch", "stretch of the friction spring in stick", SOURCE)
    lines = _lines(p, dim)
    w, u = _rates(p, lines)
    c = _penalty(p)
    p.stage("normal")
    n = _normal(p, lines, c[1])
    found = _stretch(p, lines, c[1], n, w, u)
    p.output("now", found.now, "m", "stretch, square to the normal")
    p.output("old", found.old, "m", "that of the last step, turned with the lines")
    p.output("along", found.along, "1", "direction of the last line that has a slope")
    return p


def turned(dim: int) -> Program:
    """Return the kernel of the direction of a stretch that slides as the step ends."""
    p = Program(f"{CROSSINGS[dim]}_turned", "direction of a stretch that slides as the step ends", SOURCE)
    now = p.input("x_now", dim, "m", "stretch without sliding")
    old = p.input("x_old", dim, "m", "stretch of the last step, turned with the lines")
    slip_old = p.input("slip_old", dim, "m/s", "slip of the last step, turned with the lines")
    slip = p.input("slip", dim, "m/s", "slip")
    h = p.input("h", (), "s", "time since the last step")
    end = p.input("r_1", (), "m", "size of the stretch"), p.input("least", (), "m", "a negligible length")
    p.stage("direction")
    p.output("direction", turned_stretch(p, Stretch(now, old, old, old, slip_old, h, ()), slip, end), "m",
             "along the stretch, of no particular size")
    return p


def _along_lines(p: Program, shape: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """Declare the rates of curvatures along the lines and in time."""
    return (p.input("third", shape, "1/m^2", "derivatives r_xxx of the lines"),
            p.input("k_rate", shape, "1/(m s)", "rates of the curvatures in time"))


def sticking(dim: int) -> Program:
    """Return the kernel of friction in stick, with its derivatives."""
    p = Program(f"{CROSSINGS[dim]}_sticking", "friction in stick, its derivatives with the points moving", SOURCE)
    lines = _lines(p, dim)
    w, u = _rates(p, lines)
    third, k_rate = _along_lines(p, lines.t.shape)
    c = _penalty(p)
    stiffness = p.input("k_t", (), "N/m", "stiffness of the spring")
    p.stage("normal")
    n = _normal(p, lines, c[1])
    found = _stretch(p, lines, c[1], n, w, u)
    F = sticking_force(p, found.now, stiffness)
    return _with_points_moving(p, lines, F, _Moving(w, u, lines.k, found.e, third, k_rate, found.chain))


def sliding(dim: int) -> Program:
    """Return the kernel of friction in sliding, with its derivatives."""
    p = Program(f"{CROSSINGS[dim]}_sliding", "friction in sliding, its derivatives with the points moving", SOURCE)
    lines = _lines(p, dim)
    w, u = _rates(p, lines)
    third, k_rate = _along_lines(p, lines.t.shape)
    c = _penalty(p)
    mu = p.input("mu", (), "1", "coefficient of friction")
    stiffness = p.input("k_t", (), "N/m", "stiffness of the spring")
    p.stage("normal")
    n = _normal(p, lines, c[1])
    p.stage("law")
    normal = _law(p, n, lines.d, u, c)["normal"]
    found = _stretch(p, lines, c[1], n, w, u)
    most = p.define("most", mu * normal)
    turned = turned_stretch(p, found, u - n.dot(u) * n, (p.define("r_1", most / stiffness), c[5]))
    F, sides = _sliding_force(p, found, turned, most)
    return _with_points_moving(p, lines, F, _Moving(w, u, lines.k, found.e, third, k_rate, found.chain), sides)


def _sliding_force(p: Program, found: Stretch, turned: np.ndarray, most: sp.Expr) -> tuple[np.ndarray, list[sp.Symbol]]:
    """Return the force and its constants: in the plane the spring is stretched to one of two sides."""
    if len(found.along) == 3:
        return sliding_force(p, turned, most), []
    size = p.define("x_along", found.now.dot(found.along))
    side = p.define("side_x", size / p.define("size", sp.sqrt(size * size)))
    return p.vector("F", -most * side * found.along), [side]


def step(dim: int) -> Program:
    """Return the kernel of the forces over a step that balance energy.

    The points are those closest in the middle of the step, with the changes of d and of the slopes over the step. The
    law's mean force N = (U_next - U)/(p_next - p) acts along a discrete gradient of the gap n.d = radii - p (Gonzalez
    1996). Its gradient half-way by d is n. A correction along the changes of d and of the slopes accounts for the rest
    of p - p_next, which is of third order in these changes.
    """
    p = Program(f"{CROSSINGS[dim]}_step", "forces over a step that balance energy", f"{SOURCE}; Gonzalez 1996")
    n = p.input("n", dim, "1", "normal half-way")
    displacement = p.input("displacement", dim, "m",
                           "change of d over the step, of the points that are closest half-way")
    turn = p.input("turn", (dim - 1, dim), "1", "changes of the slopes there")
    sizes = p.input("size", dim - 1, "m", "of the lines, with which changes of slopes count")
    depth, after = p.input("p", (), "m", "penetration"), p.input("p_next", (), "m", "that at the end of the step")
    h = p.input("h", (), "s", "length of the step")
    c = _penalty(p)
    _, _, linear, root, damping, least, friction, v0 = c
    p.stage("discrete gradient of the gap")
    squares = [p.define(f"square_{i}", size * size) for i, size in enumerate(sizes)]
    measure = p.define("measure", displacement.dot(displacement) + sum(
        square * (each.dot(each) + NEGLIGIBLE) for square, each in zip(squares, turn, strict=True)))
    along = p.define("along", n.dot(displacement))
    left = p.define("left", (depth - after - along) / measure)
    p.stage("law")
    penetration = p.define("penetration", after - depth)
    roots = [p.define(f"root_{i}", sp.sqrt(p.define(f"size_{i}", sp.sqrt(at * at + least * least))))
             for i, at in enumerate((depth, after))]
    half = p.define("half", (depth * depth + after * after) / 2)
    mean = p.define("mean_root", (roots[0] + roots[1]) / 2 + half / (
        (roots[0] + roots[1]) * (roots[0] * roots[0] + roots[1] * roots[1])))
    elastic = p.define("elastic", (depth + after) / 2 * (linear + sp.Rational(4, 5) * root * mean))
    normal = p.define("N_law", elastic * (1 + damping * penetration / h))
    p.stage("friction")
    slip = p.vector("slip", (displacement - along * n) / h)
    speed = p.define("speed", sp.sqrt(slip.dot(slip) + v0 * v0))
    friction_force = p.define("friction_force", friction * normal / speed)
    p.output("F", normal * (n + left * displacement) - friction_force * slip, "N",
             "force on the first line; its opposite acts on the second")
    p.output("M", np.array([normal * left * square * each for square, each in zip(squares, turn, strict=True)]), "N m",
             "force on the slopes")
    p.output("lost", [(normal - elastic) * penetration + friction_force * slip.dot(displacement)], "J",
             "dissipated energy")
    return p
