"""The sliding joint (eq 19-37): a point of a rider stays on the centreline of a cable at arc-length s.

Everything is differentiated from C = A_t' (r(s) - p). The derivations are by the cable's nodal vectors e, by the
rider's coordinates, by s, and along the motion; Q_d is the second derivative along the motion with q'' = s'' = 0.
Cable and rider are both planar, with C = (C_l, C_m), or both spatial.

On a rope the ends of the element flow, too (span.py): the material coordinates s1, s2 of its nodes are coordinates of
the cable, after e. The slide's s counts along the material, so that x = s - s1 and l = s2 - s1.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from ..algebra.axis import Axis
from ..algebra.discrete_axis import DiscreteShapes, middle_and_change
from ..algebra.discrete_gradient import STATES
from ..algebra.tangent_frame import cross, tangent_frame
from ..bodies import kernels as body_kernels
from ..bodies.body import Rider
from ..codegen.program import DirectionalDerivative, Program, jacobian
from ..spec import Element

ENTRIES = {2: ("l", "m"), 3: ("l", "m1", "m2")}  # of C, by dim
DISCRETE_GRADIENT, FLOWING_GRADIENT = "discrete_gradient", "flowing_gradient"  # kernels on a cable, on a rope
N_ENDS = 2  # material coordinates s1, s2 of an element whose ends flow
_C_DOC = "constraint in the tangent frame: C_l, then C_m across the cable"


class Slide:
    """Symbols that every kernel of the joint starts from: inputs, derivatives and r_p = r - p."""

    def __init__(self, program: Program, element: Element, rider: Rider, flows: bool):
        self.program, self.element, self.rider, self.flows = program, element, rider, flows
        self.entries = ENTRIES[element.dim]
        self.axis = Axis(program, element)
        self.e = self.axis.coordinates()
        self.b, self.u = rider.configuration(program), rider.attachment(program)
        self.by_s = DirectionalDerivative(program, "ds", {self.axis.x: 1})
        x, l = self.axis.x, self.axis.length
        of_ends = [{x: -1, l: -1}, {l: 1}] if flows else []
        self.by_cable = [*(DirectionalDerivative(program, f"de{k}", {symbol: 1})
                           for k, symbol in enumerate(self.e.ravel())),
                         *(DirectionalDerivative(program, f"ds{k + 1}", of_end) for k, of_end in enumerate(of_ends))]
        program.stage("centreline at s and rider's point (eq 19)")
        self.axes = rider.axes(program, self.b)
        self.by_rider = rider.tangents(program, self.b, self.axes)
        # from the first node and from the rider's origin: no digits are lost far from the global origin
        self.r = self.axis.vector("r", self.axis.shape(), self.e)
        arm = rider.arm(program, self.axes, self.u)
        gap = program.vector("gap", self.e[0] - rider.origin(self.b))
        self.r_p = program.vector("r_p", gap + (self.r - arm))

    def _director(self) -> tuple[np.ndarray, list[Any]]:
        """Return the director of a spatial frame, and its entries that move with e.

        It is a slope of the element, or a fixed direction from outside, which decides the directions of the two normals
        and not their plane. A planar frame needs neither; the input stays, so that all slides have one signature.
        """
        outside = self.program.input("director", self.element.dim, "1",
                                     "a direction off the tangent; used in space, where an element has none")
        if self.element.dim == 2 or not self.element.director:
            return outside, []
        slope = self.axis.shape(self.element.director.partition("_")[2])
        director = self.axis.vector("n", slope, self.e)
        return director, [*director]

    def constraint(self) -> np.ndarray:
        """Return C = A_t' r_p (dim,), m, with the cut (r_p, r_x, director) through which it is differentiated."""
        self.program.stage("tangent and director")
        self.t = self.by_s.array(self.r)
        director, moving = self._director()
        self.program.stage("tangent frame (eq 13-18)")
        self.A_t = tangent_frame(self.program, self.t, director)
        self.program.stage("C (eq 20)")
        self.C = self.named("C_", self.A_t.T.dot(self.r_p))
        self.cut = [*self.r_p, *self.t, *moving]
        self.program.stage("derivatives of C by r_p, r_x, director")
        self.C_cut = jacobian(self.program, self.C, self.cut)
        return self.C

    def cable_rates(self) -> np.ndarray:
        """Declare the input v, the rates of the cable's coordinates, and return it."""
        if not self.flows:
            return self.program.input("v", self.e.shape, "m/s, 1/s", "rates of the nodal vectors")
        return self.program.input("v", self.e.size + N_ENDS, "m/s, 1/s", "rates of the nodal vectors, and of s1, s2")

    def cable_motion(self, v: np.ndarray, s_rate: sp.Symbol) -> dict[sp.Symbol, sp.Expr]:
        """Return the rates of e, x and l."""
        motion = dict(zip(self.e.ravel(), v.ravel(), strict=False)) | {self.axis.x: s_rate}
        if not self.flows:
            return motion
        first, last = v[-N_ENDS:]
        return motion | {self.axis.x: s_rate - first, self.axis.length: last - first}

    def named(self, name: str, values: np.ndarray, suffix: str = "") -> np.ndarray:
        """Return the entries of something like C, named in the program."""
        return np.array([self.program.define(f"{name}{entry}{suffix}", value)
                         for entry, value in zip(self.entries, values, strict=True)])

    def by_arc_length(self) -> np.ndarray:
        """Return C_s (dim,). dr_p/ds = r_x is along i: along j and k it is zero but for rounding."""
        dim = len(self.r_p)
        C_s = self.C_cut[:, dim:].dot(self.by_s.array(np.array(self.cut[dim:], dtype=object)))
        C_s[0] += self.A_t[:, 0].dot(self.t)
        return np.asarray(C_s)

    def through_cut(self, derivation: DirectionalDerivative) -> np.ndarray:
        """Return the variation of C along a motion (eq 22), by the chain rule through the cut: (dim,)."""
        return np.asarray(self.C_cut.dot(derivation.array(np.array(self.cut, dtype=object))))


def build(name: str, element: Element, rider: Rider, flows: bool = False) -> list[Program]:
    """Return the kernels of the slide of a rider on a cable of this element, or on a rope, whose elements flow."""
    return [kernel(name, element, rider, flows)
            for kernel in (_constraint, _terms, _residual, _tangent, _discrete_gradient)]


def _constraint(name: str, element: Element, rider: Rider, flows: bool) -> Program:
    p = Program(f"{name}_constraint", "C, C_s and the Newton step for s", "eq 19-22")
    slide = Slide(p, element, rider, flows)
    C = slide.constraint()
    p.stage("C_s, eq 23")
    C_s = slide.by_arc_length()
    p.output("C", C, "m", _C_DOC)
    p.output("C_s", C_s, "1", "derivative of C by s")
    # C_L = C_l fixes s, and C_M = (C_m1, C_m2) stays (eq 21)
    p.output("s_step", [-C[0] / p.define("C_ls", C_s[0])], "m", "Newton step of C_l(s) = 0")
    p.output("A_t", slide.A_t, "1", "tangent frame, columns i j (k), eq 18")
    return p


def _terms(name: str, element: Element, rider: Rider, flows: bool) -> Program:
    p = Program(f"{name}_terms", "terms of the equations of motion with the slide", "eq 20-37")
    slide = Slide(p, element, rider, flows)
    v = slide.cable_rates()
    w = slide.rider.velocity(p)
    C = slide.constraint()
    p.stage("C_s and C_q (eq 23)")
    C_s = slide.named("C_s", slide.by_arc_length())
    by_q = slide.by_cable + slide.by_rider
    C_q = np.stack([slide.named("C_q", slide.through_cut(d), f"_{k}") for k, d in enumerate(by_q)], axis=1)
    p.stage("G (eq 24) and the rate of s (eq 25)")
    inverse = p.define("inv_C_sl", 1 / C_s[0])
    G = np.array([p.define(f"G_{k}", -inverse * c) for k, c in enumerate(C_q[0])])
    velocities = np.concatenate([v.ravel(), w])
    s_rate = p.define("sdot", G.dot(velocities))
    p.stage("Q_d: second derivative along the motion (eq 33)")
    motion = slide.cable_motion(v, s_rate) | slide.rider.rate(slide.b, slide.axes, w)
    # velocities are held: the derivation knows s_rate as a constant, not as the function of q that it is
    along = DirectionalDerivative(p, "dt", motion | {s_rate: 0})
    Q_d = slide.named("Q_d", along.array(along.array(C)))
    p.stage("H (eq 31) and W (eq 37)")
    H = C_q[1:] + np.outer(C_s[1:], G)
    W = -Q_d[1:] + C_s[1:] * inverse * Q_d[0]  # C_M'' after elimination of s'' (eq 35)
    p.output("C", C, "m", _C_DOC)
    p.output("C_q", C_q, "1, m", "derivatives of C by the cable, then the rider")
    p.output("C_s", C_s, "1", "derivative of C by s")
    p.output("G", G, "1, m", "ds = G dq, eq 24")
    p.output("s_rate", [s_rate], "m/s", "rate of s, eq 25")
    p.output("Q_d", Q_d, "m/s^2", "second derivative of C at zero accelerations, eq 33")
    p.output("H", H, "1, m", "Jacobian of the constraints that stay, eq 31")
    p.output("W", W, "m/s^2", "H q'' = W (eq 36)")
    # s'' = -Q_dl/C_sl + G q'' (eq 34): the paper prints the last term with the wrong sign
    p.output("s_bias", [-inverse * Q_d[0]], "m/s^2", "s'' - G q'', eq 34 with its sign corrected")
    return p


def _lagrangian(p: Program, element: Element, rider: Rider, flows: bool) -> tuple[Slide, np.ndarray, np.ndarray]:
    """Stage phi = r_p; return the slide, the Jacobian of phi by (e, rider, s), and the gradient of f . phi.

    The integrator carries s and the whole force f on the joint as unknowns instead of C_M and its multipliers:
    f . r_x = 0, the s-entry of the gradient, says that the multiplier of C_L drops out (eq 30), so that there is no
    force along the tangent. Same solutions and no frame in the Newton matrix, which is symmetric but for the rider's
    rotations (their bracket).
    """
    slide = Slide(p, element, rider, flows)
    f = p.input("f", element.dim, "N", "force of the joint on the rider")
    p.stage("Jacobian of phi")
    # d phi = phi_q dq + phi_s ds (eq 27)
    J = np.stack([d.array(slide.r_p) for d in (*slide.by_cable, *slide.by_rider, slide.by_s)], axis=1)
    p.stage("gradient of f . phi")
    g = np.array([p.define(f"g_{k}", f.dot(column)) for k, column in enumerate(J.T)])  # entry by entry (eq 29)
    return slide, J, g


def _residual(name: str, element: Element, rider: Rider, flows: bool) -> Program:
    p = Program(f"{name}_residual", "phi and the gradient of f . phi by (e, rider, s)", "eq 19, 28-30")
    slide, _, g = _lagrangian(p, element, rider, flows)
    p.output("phi", slide.r_p, "m", "r(s) - p")
    p.output("g", g, "N, N m", "gradient of f . phi, the terms of the slide in M q'' - Q and in the row of s (eq 28)")
    return p


def _tangent(name: str, element: Element, rider: Rider, flows: bool) -> Program:
    p = Program(f"{name}_tangent", "derivatives of phi and of the gradient of f . phi", "eq 19, 28-30")
    slide, J, g = _lagrangian(p, element, rider, flows)
    p.stage("derivative of the gradient")
    K = np.stack([d.array(g) for d in (*slide.by_cable, *slide.by_rider, slide.by_s)], axis=1)
    p.output("J", J, "1, m", "derivatives of phi by (e, rider, s)")
    p.output("K", K, "N/m, N, N m", "derivatives of g by (e, rider, s)")
    return p


def _discrete_gradient(name: str, element: Element, rider: Rider, flows: bool) -> Program:
    """Return the kernel of G (de, psi, ds) = phi_next - phi - theta x (phi_next + phi)/2, theta the rider's turn: zero
    on the joint.

    With N~ = (N(s) + N(s_next))/2 and the divided difference D = N[s, s_next] of the shape functions

        r_next - r = N~ de + D e~ ds,   (r_next + r)/2 = N~ e~ + D de ds/4.

    A force f acts on cable and rider at one place, N~ e~, so that it makes no moment; the part of r along which it does
    no work for that is D (e~ - theta x de/4) in place of r_x. After Gonzalez, Comput. Methods Appl. Mech. Eng. 174
    (1999) 165-174, for a constraint that turns with the scene.

    On a rope N_next - N = D_x dx + D_l dl, and each difference has such a part.
    """
    kernel = FLOWING_GRADIENT if flows else DISCRETE_GRADIENT
    p = Program(f"{name}_{kernel}", "discrete Jacobian of phi over a step", "eq 19")
    steps = DiscreteShapes(p, element, flows)
    e = p.input("e", (element.n_vectors, element.dim), "m, 1", "nodal vectors e, eq 1")
    e_next = p.input("e_next", e.shape, "m, 1", "nodal vectors at the end of the step")
    mean, slopes = steps.shapes()
    b = rider.configuration(p)
    step = body_kernels.Step(p, rider, b)
    p.stage("mean point and slope of the cable, from its first node")
    middle, change = middle_and_change(p, element, e, e_next)
    gaps = [p.vector(f"{state}_gap", vectors[0] - rider.origin(at))
            for state, vectors, at in zip(STATES, (e, e_next), (b, step.b_next), strict=True)]
    arm = p.vector("arm", sum(gaps) / 2 + mean.dot(middle))
    along = [p.vector(f"along{tag}", slope.dot(middle) - cross(step.theta, p.vector(f"swing{tag}",
                                                                                    slope.dot(change) / 4)))
             for tag, slope in slopes.items()]
    by_ends = [(-along[0] - along[1])[:, None], along[1][:, None]] if flows else []
    p.output("G", np.concatenate([np.kron(mean, np.eye(element.dim, dtype=int)), *by_ends, -step.jacobian(arm),
                                  along[0][:, None]], axis=1), "1, m",
             "by (e, rider, s); the rider's turn by its Cayley vector")
    return p
