"""Relations of the kernels of slides, for any element and any rider.

s(q) is the root of C_l(q, s) = C_l at the sample, found by Newton in the kind of number in use: the samples are
off the joint, since the formulas hold there too. On a rope the nodes flow: s counts from where the first one is at the
sample, and x from where it is on the path.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...codegen.family import SlideFamily
from ...couplings.slide import DISCRETE_GRADIENT, FLOWING_GRADIENT, N_ENDS
from ..methods import Relation
from ..motion import RIDERS, frame, swung
from ..numbers import Numbers, State
from ..references import element as reference
from .paths import unit

FLOW = 0.2
"""m: of s1 in a step."""


class Curve:
    """Centreline of an element at arc-length x, from the reference shape functions (50 digits)."""

    def __init__(self, element: Any, s: Any):
        shape, at = reference.Shape(element, s["l"].item()), (s["x"].item(), 0, 0)
        self.point, self.tangent = (shape(at, d).dot(s["e"]) for d in ((0, 0, 0), (1, 0, 0)))
        by = tuple(element.director.partition("_")[2].count(c) for c in "xyz")
        self.director = shape(at, by).dot(s["e"]) if element.director else s["director"]


class Paths:
    """Finite motions of a slide: along one coordinate of (cable, rider, s), along the motion in time, over a step.

    n_e: number of coordinates of the cable: of e, and of s1 and s2 where the nodes flow.
    """

    def __init__(self, family: SlideFamily):
        self.element, self.rider, self.flows = family.element, RIDERS[family.rider], family.flows
        self.n_e = self.element.n_coordinates + N_ENDS * family.flows
        self.n = self.n_e + self.rider.n_velocity
        self.changing = "xebl" if family.flows else "xeb"

    def moved(self, k: Numbers, s: State, motion_e: np.ndarray, motion_b: np.ndarray) -> State:
        """Return e and b, and l and x of the same material where nodes flow, after a motion of cable and rider."""
        n = self.element.n_coordinates
        found = {"e": s["e"] + motion_e.ravel()[:n].reshape(s["e"].shape),
                 "b": self.rider.moved(k, s["b"], motion_b)}
        if not self.flows:
            return found
        first, last = motion_e[n:]
        return found | {"l": s["l"] + (last - first), "x": s["x"] - first}

    def by_coordinate(self, k: Numbers, s: State, t: Any, j: int) -> State:
        """Return the configuration with coordinate j of (e, rider) moved by t."""
        direction = t * unit(np.zeros(self.n), j)
        return self.moved(k, s, direction[: self.n_e], direction[self.n_e :])

    def by_motion(self, k: Numbers, s: State, t: Any, accelerated: bool = True) -> State:
        """Return the configuration at time t with the state's velocities and accelerations."""
        bend = t * t / 2 if accelerated else 0 * t
        return self.moved(k, s, t * s["v"] + bend * s["vdot"], t * s["w"] + bend * s["wdot"])

    def closed(self, k: Numbers, s: State, q: State, level: Any = None) -> Any:
        """Return x on C_l(q, s) = level, by default that of the state."""
        level = k("constraint", s)["C"][0] if level is None else level
        x = q.get("x", s["x"])
        for _ in range(12):
            now = k("constraint", s, **(q | {"x": x}))
            step = (now["C"][0] - level) / now["C_s"][0]
            x = x - step
            if abs(step) ** 2 < k.eps / 100:  # the rest is of second order
                break
        return x

    def constraint_along(self, k: Numbers, s: State, q: State) -> np.ndarray:
        """Return C_m along s(q)."""
        return constraint(k, s, **(q | {"x": self.closed(k, s, q)}))[1:]

    def arc_length(self, k: Numbers, s: State, q: State) -> Any:
        """Return s on C_l(q, s) = C_l of the state, from the place of the first node there."""
        return self.closed(k, s, q) + (s["x"] - q.get("x", s["x"]))

    def lagrangian(self, get: Callable[..., Any]) -> Callable[..., Any]:
        """Return the path of a function of the state along (e, rider, s)."""
        def path(k, s, t, j):
            return get(k, s, **(self.by_coordinate(k, s, t, j) if j < self.n else {"x": s["x"] + t}))
        return path

    # --- C and phi from shape functions at 50 digits ------------------------------------------------------------

    def reference_gap(self, k: Numbers, s: State, t: Any, j: int) -> np.ndarray:
        """Return r - p."""
        return Curve(self.element, s).point - self.rider.point(s["b"], s["u"])

    def reference_frame(self, k: Numbers, s: State, t: Any, j: int) -> np.ndarray:
        """Return the tangent frame by Gram-Schmidt."""
        curve = Curve(self.element, s)
        return frame(k, curve.tangent, curve.director)

    def reference_constraint(self, k: Numbers, s: State, t: Any, j: int) -> np.ndarray:
        """Return A_t' (r - p)."""
        return self.reference_frame(k, s, t, j).T.dot(self.reference_gap(k, s, t, j))

    # --- along the motion ---------------------------------------------------------------------------------------

    def newton_step(self, k: Numbers, s: State, t: Any, j: int) -> Any:
        """Return s on C_l(s) = (1 - t) C_l."""
        return self.closed(k, s, {}, level=(1 - t) * k("constraint", s)["C"][0])

    def unaccelerated(self, k: Numbers, s: State, t: Any, j: int) -> np.ndarray:
        """Return C at time t at constant velocities of all, s among them."""
        rate = k("terms", s)["s_rate"].item()
        q = self.by_motion(k, s, t, accelerated=False)
        return constraint(k, s, **(q | {"x": q.get("x", s["x"]) + t * rate}))

    def bend_left(self, k: Numbers, s: State, t: Any, j: int) -> np.ndarray:
        """Return t^2/2 H q'' - C_m along s(q), whose second derivative is W."""
        q = self.by_motion(k, s, t)
        return t * t / 2 * k("terms", s)["H"].dot(_acceleration(s)) - self.constraint_along(k, s, q)

    def slide_left(self, k: Numbers, s: State, t: Any, j: int) -> Any:
        """Return s - t^2/2 G q'', whose second derivative is s_bias."""
        return self.arc_length(k, s, self.by_motion(k, s, t)) - t * t / 2 * k("terms", s)["G"].dot(_acceleration(s))

    # --- over a step --------------------------------------------------------------------------------------------

    def step(self, s: State) -> np.ndarray:
        """Return the change over a step, over (e, rider, s); s1 and s2 of a rope both move by `FLOW` more."""
        change = s["x_next"].item() - s["x"].item()
        ends = [FLOW, FLOW + (s["l_next"].item() - s["l"].item())] if self.flows else []
        return np.concatenate([(s["e_next"] - s["e"]).ravel(), ends, self.rider.step(s["b"], s["b_next"]),
                               [change + FLOW * self.flows]])

    def swept(self, k: Numbers, s: State, t: Any, j: int) -> np.ndarray:
        """Return the change of the gap over a step as seen from a frame that turns with the rider."""
        here, there = (self.reference_gap(k, end, t, j)
                       for end in (s, s | {name: s[f"{name}_next"] for name in self.changing}))
        turn = self.rider.turn(s["b"], self.step(s)[self.n_e : self.n])
        return there - here - swung(turn, (here + there) / 2)

    def seen(self, k: Numbers, s: State, t: Any, j: int) -> np.ndarray:
        """Return the gap along (e, rider, s) as seen from a frame that turns with the rider."""
        path = self.lagrangian(gap)(k, s, t, j)
        if j < self.n_e or j == self.n:
            return path
        return path - swung(self.rider.turn(s["b"], t * unit(s["w"], j - self.n_e)), gap(k, s))


def constraint(k: Numbers, s: State, **q: np.ndarray) -> np.ndarray:
    """Return C at a configuration, of the kernel."""
    return k("constraint", s, **q)["C"]


def gap(k: Numbers, s: State, **q: np.ndarray) -> np.ndarray:
    """Return phi at a configuration, of the kernel."""
    return k("residual", s, **q)["phi"]


def _acceleration(s: State) -> np.ndarray:
    return np.concatenate([s["vdot"].ravel(), s["wdot"]])


def slide(family: SlideFamily) -> list[Relation]:
    """Return the relations of the slide's kernels, eq 13-38."""
    p = Paths(family)
    n = p.n
    return [*_of_constraint(p), *_of_terms(p),
            Relation("residual", "phi", "r - p at 50 digits", 0, p.reference_gap),
            Relation("residual", "g", "d(f . phi) by (e, rider, s)", 1,
                     p.lagrangian(lambda k, s, **q: gap(k, s, **q).dot(s["f"])), n + 1),
            *_over_a_step(p, FLOWING_GRADIENT if family.flows else DISCRETE_GRADIENT),
            Relation("tangent", "J", "dphi by (e, rider, s)", 1, p.lagrangian(gap), n + 1),
            Relation("tangent", "K", "dg by (e, rider, s)", 1,
                     p.lagrangian(lambda k, s, **q: k("residual", s, **q)["g"]), n + 1)]


def _over_a_step(p: Paths, kernel: str) -> list[Relation]:
    return [Relation(kernel, "G", "G step is the change of phi seen from the rider", 0, p.swept,
                     of=lambda k, s: k(kernel, s)["G"].dot(p.step(s))),
            Relation(kernel, "G", "derivatives of phi seen from the rider, over no step", 1, p.seen, p.n + 1,
                     of=lambda k, s: k(kernel, s, **{f"{name}_next": s[name] for name in p.changing})["G"])]


def _of_constraint(p: Paths) -> list[Relation]:
    return [Relation("constraint", "C", "A_t' (r - p) at 50 digits", 0, p.reference_constraint),
            Relation("constraint", "A_t", "Gram-Schmidt of r_x and the director", 0, p.reference_frame),
            Relation("constraint", "C_s", "dC/ds", 1, lambda k, s, t, j: constraint(k, s, x=s["x"] + t)),
            Relation("constraint", "s_step", "s on C_l(s) = (1 - t) C_l", 1, p.newton_step)]


def _of_terms(p: Paths) -> list[Relation]:
    return [Relation("terms", "C", "A_t' (r - p) at 50 digits", 0, p.reference_constraint),
            Relation("terms", "C_q", "dC/dq", 1,
                     lambda k, s, t, j: constraint(k, s, **p.by_coordinate(k, s, t, j)), p.n),
            Relation("terms", "C_s", "dC/ds", 1, lambda k, s, t, j: constraint(k, s, x=s["x"] + t)),
            Relation("terms", "G", "ds/dq of s on C_l = const", 1,
                     lambda k, s, t, j: p.arc_length(k, s, p.by_coordinate(k, s, t, j)), p.n),
            Relation("terms", "s_rate", "ds/dt of s on C_l = const", 1,
                     lambda k, s, t, j: p.arc_length(k, s, p.by_motion(k, s, t))),
            Relation("terms", "Q_d", "d²C/dt² at q'' = s'' = 0", 2, p.unaccelerated),
            Relation("terms", "H", "dC_m/dq along s(q)", 1,
                     lambda k, s, t, j: p.constraint_along(k, s, p.by_coordinate(k, s, t, j)), p.n),
            Relation("terms", "W", "H q'' - d²C_m/dt² along s(q)", 2, p.bend_left),
            Relation("terms", "s_bias", "d²s/dt² - G q''", 2, p.slide_left)]
