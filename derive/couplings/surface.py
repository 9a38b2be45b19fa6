"""Contact of cables and bodies with surfaces: distance of each shape with its derivatives, and the force.

Places y are those of a point of the axis of a cable, or of the centre of a body's sphere, from the shape's origin along
its axes. The distance of a plane and of a round shape (sphere, cylinder) is exact. That of a terrain of the height h is
the vertical one over sqrt(1 + h'^2), which is exact to first order at the surface; forces are along its exact gradient.

The normal force is p = k d^e (1 + c d'), with the depth d below the surface and e = 1 or 3/2 (Hertz): the law of Hunt &
Crossley, J. Appl. Mech. 42 (1975) 440-445, whose damping makes no jump where contact begins. Friction is Coulomb's with
a tangential spring from an anchor on the surface (`stretch`). That of a rope may also be regularised by the velocity w
past the surface, with t its part along the surface: -mu p t/sqrt(t.t + v0^2).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from ..algebra.tangent_frame import cross, moment_of
from ..codegen.family import CouplingFamily
from ..codegen.program import DirectionalDerivative, Program
from .frame import TURNS
from .stretch import sliding_force, sliding_force_at, sticking_force

SURFACES = {3: "surface", 2: "planar_surface"}
SOURCE = "Hunt & Crossley 1975; Wriggers 2006"
PLACE = "the point from the shape's origin, along its axes"
HEIGHTS = {2: ("h", "h_1", "h_11", "h_111"),
           3: ("h", "h_1", "h_2", "h_11", "h_12", "h_22", "h_111", "h_112", "h_122", "h_222")}
"""Inputs of a terrain's kernel: derivatives of its height along the first and the second horizontal axis."""


def families() -> list[CouplingFamily]:
    """Return the families in space and in the plane."""
    return CouplingFamily.each("surface", "surfaces and contact with them", SURFACES, build)


def build(dim: int) -> list[Program]:
    """Return the kernels in space or in the plane."""
    return [*(make(dim) for make in (flat, rounded, terrain)), push(dim, hertz=False), push(dim, hertz=True),
            *(make(dim) for make in (frictionless, sticking, sliding, slipping, reaction, motion, slip))]


def _program(dim: int, name: str, doc: str) -> Program:
    return Program(f"{SURFACES[dim]}_{name}", doc, SOURCE)


def flat(dim: int) -> Program:
    """Return the kernel of the distance from a plane."""
    p = _program(dim, "flat", "distance from a plane, and its gradient")
    y = p.input("y", dim, "m", PLACE)
    normal = p.input("normal", dim, "1", "unit normal of the plane")
    p.stage("distance")
    p.output("g", y.dot(normal), "m", "distance")
    p.output("g_y", normal, "1", "gradient")
    return p


def rounded(dim: int) -> Program:
    """Return the kernel of the distance from a sphere, about an axis of no length, or from a cylinder."""
    p = _program(dim, "rounded", "distance from a sphere or a cylinder, with its derivatives")
    y = p.input("y", dim, "m", PLACE)
    axis = p.input("axis", dim, "1", "unit vector along the axis; zero for a sphere")
    radius = p.input("radius", (), "m", "radius")
    p.stage("distance")
    w = p.vector("w", y - p.define("along", axis.dot(y)) * axis)
    size = p.define("size", sp.sqrt(w.dot(w)))
    inverse = p.define("inv_size", 1 / size)
    n = p.vector("n", inverse * w)
    p.output("g", size - radius, "m", "distance")
    p.output("g_y", n, "1", "gradient")
    p.output("g_yy", inverse * (np.eye(dim, dtype=int) - np.outer(axis, axis) - np.outer(n, n)), "1/m",
             "second derivative")
    return p


def terrain(dim: int) -> Program:
    """Return the kernel of the distance from a surface given by its height over horizontal axes; y[1] is up."""
    p = _program(dim, "terrain", "distance from a height field, with its derivatives")
    y = p.input("y", dim, "m", PLACE)
    heights = p.input("h", len(HEIGHTS[dim]), "m, ...", "height there, and its derivatives " + ", ".join(HEIGHTS[dim]))
    value = dict(zip(HEIGHTS[dim], heights, strict=True))
    axes = {1: 0} if dim == 2 else {1: 0, 2: 2}  # the entries of y that the horizontal axes are

    def along(k: int) -> dict[sp.Symbol, sp.Expr]:
        """Return the derivatives by an entry of y: of itself, and of heights where it is horizontal."""
        known = {s: sp.Integer(s == y[k]) for s in y}
        axis = next((a for a, at in axes.items() if at == k), None)
        for name, symbol in value.items():
            more = "h_" + "".join(sorted(name[2:] + str(axis)))
            known[symbol] = value.get(more, sp.S.Zero) if axis is not None else sp.S.Zero
        return known

    p.stage("distance")
    slopes = [value[f"h_{axis}"] for axis in axes]
    slant = p.define("slant", sp.sqrt(1 + sum(slope * slope for slope in slopes)))
    inverse = p.define("inv_slant", 1 / slant)
    g = p.define("distance", (y[1] - value["h"]) * inverse)
    p.stage("derivatives")
    by = [DirectionalDerivative(p, f"d{k}", along(k)) for k in range(dim)]
    gradient = p.vector("n", [d(g) for d in by])
    second: list[list[sp.Expr]] = [[sp.S.Zero] * dim for _ in range(dim)]
    for i in range(dim):
        for j in range(i + 1):
            second[i][j] = second[j][i] = p.define(f"n_{i}{j}", by[j](gradient[i]))
    p.output("g", g, "m", "distance")
    p.output("g_y", gradient, "1", "gradient")
    p.output("g_yy", second, "1/m", "second derivative")
    return p


def push(dim: int, hertz: bool) -> Program:
    """Return the kernel of the law of contact at a depth: normal force and energy, at an instant and over a step."""
    p = _program(dim, "push_hertz" if hertz else "push",
                 f"normal force of contact by the depth to the power {'3/2' if hertz else '1'}, and derivatives")
    depth = p.input("depth", (), "m", "depth d below the surface")
    rate = p.input("depth_rate", (), "m/s", "its rate")
    k, c = p.input("law", 2, "N/m^e (a length), s/m", "stiffness, damping")
    later = p.input("depth_next", (), "m", "depth at the end of a step")
    p.stage("force")
    if hertz:
        root, next_root = p.define("root", sp.sqrt(depth)), p.define("next_root", sp.sqrt(later))
        elastic = p.define("spring", k * depth * root)
        by_depth = p.define("stiffness", sp.Rational(3, 2) * k * root)
        stored = sp.Rational(2, 5) * elastic * depth
        # of (b^5 - a^5)/(b^2 - a^2), with the roots a and b of the depths
        total = p.define("inv_sum", 1 / (root + next_root))
        mean = sp.Rational(2, 5) * k * p.define("sum_4", later * later + later * next_root * root + later * depth
                                                + next_root * root * depth + depth * depth) * total
    else:
        elastic, by_depth, stored = p.define("spring", k * depth), k, k * depth * depth / 2
        mean = k * (depth + later) / 2
    damped = p.define("damped", 1 + c * rate)
    p.output("p", elastic * damped, "N (a length)", "normal force")
    p.output("p_d", by_depth * damped, "N/m (a length)", "derivative by the depth")
    p.output("p_rate", elastic * c, "N s/m (a length)", "derivative by its rate")
    p.output("p_e", elastic, "N (a length)", "the part that is elastic")
    p.output("U", stored, "J (a length)", "stored energy")
    p.output("mean", mean, "N (a length)", "change of the stored energy over a step over that of the depth")
    return p


def _moving(p: Program, dim: int, normal_force: sp.Symbol, n: np.ndarray, H: np.ndarray, w: np.ndarray, by_d: sp.Symbol,
            by_rate: sp.Symbol, x: np.ndarray | None = None) -> tuple[list[Any], list[Any]]:
    """Return the derivations by the place y and by the velocity w: of n by H, of the normal force by depth and its
    rate, of w itself.
    """
    turned = p.vector("Hw", H @ w)
    of_place, of_rate = [], []
    for k in range(dim):
        known = {n[i]: H[i, k] for i in range(dim)} | {normal_force: -by_d * n[k] - by_rate * turned[k]}
        if x is not None:
            known |= {x[i]: sp.Integer(i == k) for i in range(dim)}
        of_place.append(DirectionalDerivative(p, f"dy{k}", known))
        of_rate.append(DirectionalDerivative(p, f"dw{k}", {normal_force: -by_rate * n[k]}
                                             | {w[i]: sp.Integer(i == k) for i in range(dim)}))
    return of_place, of_rate


def _inputs(p: Program, dim: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    n = p.input("n", dim, "1", "gradient of the distance")
    H = p.input("H", (dim, dim), "1/m", "its second derivative")
    w = p.input("w", dim, "m/s", "velocity of the point past the surface")
    normal_force = p.input("normal_force", 3, "N, N/m, N s/m (a length)",
                           "p, and its derivatives by the depth and by its rate")
    return n, H, w, normal_force


def _outputs(p: Program, f: np.ndarray, by: tuple[list[Any], list[Any]]) -> Program:
    p.stage("derivatives")
    f_y, f_w = (np.stack([d.array(f) for d in each], axis=-1) for each in by)
    p.output("f", f, "N (a length)", "force on the point")
    p.output("f_y", f_y, "N/m (a length)", "derivatives by its place")
    p.output("f_w", f_w, "N s/m (a length)", "derivatives by its velocity")
    return p


def frictionless(dim: int) -> Program:
    """Return the kernel of contact without friction."""
    p = _program(dim, "frictionless", "normal force of contact, and its derivatives")
    n, H, w, (normal_force, by_d, by_rate) = _inputs(p, dim)
    p.stage("normal force")
    by = _moving(p, dim, normal_force, n, H, w, by_d, by_rate)
    return _outputs(p, normal_force * n, by)


def _across(p: Program, dim: int, n: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Return the part of x across the normal, whose length need not be one."""
    square = p.define("nn", n.dot(n))
    return p.vector("t", x - p.define("along", n.dot(x)) * p.define("inv_nn", 1 / square) * n)


def sticking(dim: int) -> Program:
    """Return the kernel of the friction spring in stick."""
    p = _program(dim, "sticking", "friction in stick, and its derivatives")
    n = p.input("n", dim, "1", "gradient of the distance")
    H = p.input("H", (dim, dim), "1/m", "its second derivative")
    x = p.input("x", dim, "m", "the point from its anchor")
    k = p.input("k_t", (), "N/m (a length)", "stiffness")
    p.stage("friction")
    t = _across(p, dim, n, x)
    f = sticking_force(p, t, k)
    by = [DirectionalDerivative(p, f"dy{j}", {n[i]: H[i, j] for i in range(dim)}
                                | {x[i]: sp.Integer(i == j) for i in range(dim)}) for j in range(dim)]
    p.stage("derivatives")
    p.output("f", f, "N (a length)", "force on the point")
    p.output("f_y", np.stack([d.array(f) for d in by], axis=-1), "N/m (a length)", "derivatives by its place")
    p.output("t", t, "m", "the part of x along the surface")
    return _by_stretch(p, _along_each(p, dim, f, x))


def _along_each(p: Program, dim: int, f: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Return (dim, dim): the derivatives of f by x."""
    by = [DirectionalDerivative(p, f"dx{j}", {x[i]: sp.Integer(i == j) for i in range(dim)}) for j in range(dim)]
    return np.stack([d.array(f) for d in by], axis=-1)


def _by_stretch(p: Program, f_x: np.ndarray) -> Program:
    """Add the derivatives by x alone, which a sphere changes as it rolls in place."""
    p.output("f_x", f_x, "N/m (a length)", "derivatives by x alone")
    return p


def sliding(dim: int) -> Program:
    """Return the kernel of sliding friction: its size is mu times the normal force, its direction against x along the
    surface.
    """
    p = _program(dim, "sliding", "friction in sliding, and its derivatives")
    n, H, w, (normal_force, by_d, by_rate) = _inputs(p, dim)
    x = p.input("x", dim, "m", "the point from its anchor")
    mu = p.input("mu", (), "1", "coefficient of friction")
    p.stage("friction")
    t = _across(p, dim, n, x)
    f = sliding_force(p, t, mu * normal_force)
    _outputs(p, f, _moving(p, dim, normal_force, n, H, w, by_d, by_rate, x))
    # in the plane friction that slides has one direction, whatever the stretch is
    return _by_stretch(p, np.zeros((dim, dim), dtype=int) if dim == 2 else _along_each(p, dim, f, x))


def slipping(dim: int) -> Program:
    """Return the kernel of regularised friction, against the velocity along the surface."""
    p = _program(dim, "slipping", "regularised friction, and its derivatives")
    n, H, w, (normal_force, by_d, by_rate) = _inputs(p, dim)
    mu = p.input("mu", (), "1", "coefficient of friction")
    v0 = p.input("v0", (), "m/s", "velocity at which friction is 0.7 of its limit")
    p.stage("friction")
    inverse = p.define("inv_nn", 1 / p.define("nn", n.dot(n)))
    t = p.vector("t", inverse * cross(moment_of(n, w), n))  # no difference of the parts along the normal
    speed = p.define("speed", sp.sqrt(t.dot(t) + v0 * v0))
    f = sliding_force_at(p, t, mu * normal_force, speed)
    return _outputs(p, f, _moving(p, dim, normal_force, n, H, w, by_d, by_rate))


def reaction(dim: int) -> Program:
    """Return the kernel of the change of contact, and of its moments, along a motion of a sphere and of a surface.

    The force depends on place, velocity and stretch along axes that turn with the surface. The stretch of a sphere that
    rolls has the part turn x mean_arm; a turn phi changes `turn` by phi - turn x phi/2, to first order in `turn`.
    """
    p = _program(dim, "reaction", "change of contact along a motion of the point and of the surface")
    turns = TURNS[dim]
    x = p.input("x", dim, "m", "the point from the surface's origin")
    w = p.input("w", dim, "m/s", "velocity of the point past the surface")
    omega_o = p.input("omega_o", turns, "rad/s", "angular velocity of the surface, global axes")
    f = p.input("f", dim, "N (a length)", "force on the point")
    f_y, f_w, f_x = (p.input(name, (dim, dim), unit, f"its derivatives by {by}") for name, unit, by in (
        ("f_y", "N/m (a length)", "the place"), ("f_w", "N s/m (a length)", "the velocity"),
        ("f_x", "N/m (a length)", "the stretch alone")))
    H = p.input("H", (dim, dim), "1/m", "second derivative of the distance")
    radius = p.input("radius", (), "m", "radius of the sphere about the point")
    arm = p.input("arm", dim, "m", "from the point to where the force acts")
    turn = p.input("turn", turns, "rad", "turn of the sphere past the surface since the last step, global axes")
    mean_arm = p.input("mean_arm", dim, "m", "mean of the arms now and then")
    share = p.input("share", (), "1", "share of the arm in that mean")
    dr = p.input("dr", dim, "m", "change of x")
    dv = p.input("dv", dim, "m/s", "change of the velocity of the point past that of the surface's origin")
    turned, turned_o = (p.input(name, turns, "rad", f"turn of the {of}") for name, of in (
        ("dtheta", "sphere"), ("dtheta_o", "surface")))
    faster = p.input("domega_o", turns, "rad/s", "change of omega_o")
    p.stage("moments about the centre and about the surface's origin")
    moments = [np.array([p.define(f"{name}{k}", each) for k, each in enumerate(moment_of(of, f))])
               for name, of in (("near", arm), ("far", p.vector("lever", x + arm)))]
    p.stage("changes along axes of the surface")
    y = p.vector("y", dr - cross(turned_o, x))
    past = p.vector("past", dv - cross(omega_o, dr) - cross(faster, x) - cross(turned_o, w))
    arm_y = p.vector("arm_y", -radius * H.dot(y))
    relative = np.array([p.define(f"phi{k}", each) for k, each in enumerate(turned - turned_o)])
    rolled = relative - cross(turn, relative) / 2 if dim == 3 else relative
    stretch = p.vector("stretch", cross(rolled, mean_arm) + share * cross(turn, arm_y))
    p.stage("changes in global axes")
    force = p.vector("df", f_y.dot(y) + f_w.dot(past) + f_x.dot(stretch) + cross(turned_o, f))
    by = DirectionalDerivative(p, "d", dict(zip([*x, *arm, *f], [*dr, *(arm_y + cross(turned_o, arm)), *force],
                                                strict=True)))
    p.output("f_t", force, "N (a length)", "change of f")
    p.output("m_t", by.array(moments[0]), "N m (a length)", "change of arm x f")
    p.output("m_o_t", by.array(moments[1]), "N m (a length)", "change of (x + arm) x f")
    return p


class _Passing:
    """Inputs of a point that moves past a surface, and derivatives in time at zero accelerations of coordinates."""

    def __init__(self, p: Program, dim: int):
        self.program = p
        self.n = p.input("n", dim, "1", "gradient of the distance")
        self.H = p.input("H", (dim, dim), "1/m", "its second derivative")
        self.r, self.v, self.a = self._moving("", dim, "the point")
        self.r_o, self.v_o, self.a_o = self._moving("_o", dim, "the surface's origin")
        self.omega_o, self.alpha_o = self.turning("_o", dim, "the surface")
        p.stage("velocity past the surface")
        self.x = p.vector("x", self.r - self.r_o)
        self.past = p.vector("past", self.v - self.v_o - cross(self.omega_o, self.x))
        self.n_t = p.vector("n_t", cross(self.omega_o, self.n) + self.H @ self.past)

    def _moving(self, tag: str, dim: int, what: str) -> list[np.ndarray]:
        p = self.program
        return [p.input(f"r{tag}", dim, "m", f"position of {what}"), p.input(f"v{tag}", dim, "m/s", "its velocity"),
                p.input(f"a{tag}", dim, "m/s^2", "its acceleration at zero accelerations of the coordinates")]

    def turning(self, tag: str, dim: int, what: str) -> list[np.ndarray]:
        """Declare the angular velocity and acceleration of a body and return them."""
        p = self.program
        return [p.input(f"omega{tag}", TURNS[dim], "rad/s", f"angular velocity of {what}, global axes"),
                p.input(f"alpha{tag}", TURNS[dim], "rad/s^2", "its rate at zero accelerations of the coordinates")]

    def in_time(self, *more: tuple[np.ndarray, np.ndarray]) -> DirectionalDerivative:
        """Return the derivative in time; more: further inputs with their rates."""
        pairs = ((self.r, self.v), (self.v, self.a), (self.r_o, self.v_o), (self.v_o, self.a_o),
                 (self.omega_o, self.alpha_o), (self.n, self.n_t))
        on = {symbol: rate for of, by in (*pairs, *more) for symbol, rate in zip(of, by, strict=True)}
        return DirectionalDerivative(self.program, "dt", on)


def motion(dim: int) -> Program:
    """Return the kernel of both rates of a distance; the second at zero accelerations: -gamma of eq 10."""
    p = _program(dim, "motion", "rates of the distance of a moving point from a moving surface")
    of = _Passing(p, dim)
    g_t = p.define("rate", of.n.dot(of.past))
    p.stage("derivatives in time")
    p.output("g_t", g_t, "m/s", "rate of the distance")
    p.output("g_tt", of.in_time()(g_t), "m/s^2", "its second rate at zero accelerations of the coordinates")
    return p


def slip(dim: int) -> Program:
    """Return the kernel of the slip of a sphere past the surface at the point of contact, and its rate."""
    p = _program(dim, "slip", "velocity past a moving surface of the particle of a sphere in contact with it")
    of = _Passing(p, dim)
    radius = p.input("radius", (), "m", "radius of the sphere about the point")
    omega, alpha = of.turning("", dim, "the sphere")
    p.stage("slip")
    arm = p.vector("arm", -radius * of.n)
    w = p.vector("w", of.past + cross(p.vector("spin", omega - of.omega_o), arm))
    p.stage("derivatives in time")
    p.output("w", w, "m/s", "velocity of the particle past that of the surface")
    p.output("w_t", of.in_time((omega, alpha)).array(w), "m/s^2", "its rate at zero accelerations of the coordinates")
    return p
