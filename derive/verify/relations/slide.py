"""What the outputs of the slide's kernels are derivatives of, for any element and any rider.

s(q) is the root of C_l(q, s) = C_l at the sample, found by Newton in whatever numbers are in use: the samples are
off the joint, since the formulas hold there too.
"""

from __future__ import annotations

import numpy as np

from ...codegen.family import SlideFamily
from ..methods import Relation
from ..motion import RIDERS, frame, swung
from ..references import element as reference
from .paths import unit


class Curve:
    """Centreline of an element at arc-length x, from the reference shape functions (50 digits)."""

    def __init__(self, element, s):
        shape, at = reference.Shape(element, s["l"].item()), (s["x"].item(), 0, 0)
        self.point, self.tangent = (shape(at, d).dot(s["e"]) for d in ((0, 0, 0), (1, 0, 0)))
        by = tuple(element.director.partition("_")[2].count(c) for c in "xyz")
        self.director = shape(at, by).dot(s["e"]) if element.director else s["director"]


def slide(family: SlideFamily) -> list[Relation]:
    """Return the relations of the slide's kernels, eq 13-38."""
    element, rider = family.element, RIDERS[family.rider]
    n_e, n = element.n_coordinates, element.n_coordinates + rider.n_velocity

    def at(k, s, motion_e, motion_b):
        return {"e": s["e"] + motion_e.reshape(s["e"].shape), "b": rider.moved(k, s["b"], motion_b)}

    def by_coordinate(k, s, t, j):
        """Configuration with coordinate j of (e, rider) moved by t."""
        direction = t * unit(np.zeros(n), j)
        return at(k, s, direction[:n_e], direction[n_e:])

    def by_motion(k, s, t, accelerated=True):
        """Configuration at time t with the state's velocities and accelerations."""
        bend = t * t / 2 if accelerated else 0 * t
        return at(k, s, t * s["v"] + bend * s["vdot"], t * s["w"] + bend * s["wdot"])

    def closed(k, s, q, level=None):
        """s on C_l(q, s) = level, by default that of the state."""
        level = k("constraint", s)["C"][0] if level is None else level
        x = s["x"]
        for _ in range(12):
            now = k("constraint", s, x=x, **q)
            step = (now["C"][0] - level) / now["C_s"][0]
            x = x - step
            if abs(step) ** 2 < k.eps / 100:  # what is left is of the order of the square
                break
        return x

    def constraint(k, s, x=None, **q):
        return k("constraint", s, x=s["x"] if x is None else x, **q)["C"]

    def gap(k, s, **q):
        return k("residual", s, **q)["phi"]

    def lagrangian(get):
        """Path of a function of the state along (e, rider, s)."""
        def path(k, s, t, j):
            moved = by_coordinate(k, s, t, j) if j < n else {"x": s["x"] + t}
            return get(k, s, **moved)
        return path

    def reference_gap(k, s, t, j):
        return Curve(element, s).point - rider.point(s["b"], s["u"])

    def step(s):
        """From one end of a step to the other, over (e, rider, s)."""
        return np.concatenate([(s["e_next"] - s["e"]).ravel(), rider.step(s["b"], s["b_next"]),
                               [s["x_next"].item() - s["x"].item()]])

    def swept(k, s, t, j):
        """Change of the gap over a step as seen from a frame that turns with the rider."""
        here, there = (reference_gap(k, end, t, j) for end in (s, s | {name: s[f"{name}_next"] for name in "xeb"}))
        return there - here - swung(rider.turn(s["b"], step(s)[n_e:n]), (here + there) / 2)

    def seen(k, s, t, j):
        """The gap along (e, rider, s) as seen from a frame that turns with the rider."""
        path = lagrangian(gap)(k, s, t, j)
        if j < n_e or j == n:
            return path
        return path - swung(rider.turn(s["b"], t * unit(s["w"], j - n_e)), gap(k, s))

    def reference_frame(k, s, t, j):
        curve = Curve(element, s)
        return frame(k, curve.tangent, curve.director)

    def reference_constraint(k, s, t, j):
        return reference_frame(k, s, t, j).T.dot(reference_gap(k, s, t, j))

    def newton_step(k, s, t, j):
        return closed(k, s, {}, level=(1 - t) * k("constraint", s)["C"][0])

    def held(k, s, t, j):
        rate = k("terms", s)["s_rate"].item()
        return constraint(k, s, s["x"] + t * rate, **by_motion(k, s, t, accelerated=False))

    def kept(k, s, q):
        return constraint(k, s, closed(k, s, q), **q)[1:]

    def acceleration(s):
        return np.concatenate([s["vdot"].ravel(), s["wdot"]])

    def bend_left(k, s, t, j):
        q = by_motion(k, s, t)
        return t * t / 2 * k("terms", s)["H"].dot(acceleration(s)) - kept(k, s, q)

    def slide_left(k, s, t, j):
        return closed(k, s, by_motion(k, s, t)) - t * t / 2 * k("terms", s)["G"].dot(acceleration(s))

    return [
        Relation("constraint", "C", "A_t' (r - p) at 50 digits", 0, reference_constraint),
        Relation("constraint", "A_t", "Gram-Schmidt of r_x and the director", 0, reference_frame),
        Relation("constraint", "C_s", "dC/ds", 1, lambda k, s, t, j: constraint(k, s, s["x"] + t)),
        Relation("constraint", "s_step", "s on C_l(s) = (1 - t) C_l", 1, newton_step),
        Relation("terms", "C", "A_t' (r - p) at 50 digits", 0, reference_constraint),
        Relation("terms", "C_q", "dC/dq", 1, lambda k, s, t, j: constraint(k, s, **by_coordinate(k, s, t, j)), n),
        Relation("terms", "C_s", "dC/ds", 1, lambda k, s, t, j: constraint(k, s, s["x"] + t)),
        Relation("terms", "G", "ds/dq of s on C_l = const", 1,
                 lambda k, s, t, j: closed(k, s, by_coordinate(k, s, t, j)), n),
        Relation("terms", "s_rate", "ds/dt of s on C_l = const", 1,
                 lambda k, s, t, j: closed(k, s, by_motion(k, s, t))),
        Relation("terms", "Q_d", "d²C/dt² at q'' = s'' = 0", 2, held),
        Relation("terms", "H", "dC_m/dq along s(q)", 1, lambda k, s, t, j: kept(k, s, by_coordinate(k, s, t, j)), n),
        Relation("terms", "W", "H q'' - d²C_m/dt² along s(q)", 2, bend_left),
        Relation("terms", "s_bias", "d²s/dt² - G q''", 2, slide_left),
        Relation("residual", "phi", "r - p at 50 digits", 0, reference_gap),
        Relation("residual", "g", "d(f . phi) by (e, rider, s)", 1,
                 lagrangian(lambda k, s, **q: gap(k, s, **q).dot(s["f"])), n + 1),
        Relation("discrete_gradient", "G", "G step is the change of phi seen from the rider", 0, swept,
                 of=lambda k, s: k("discrete_gradient", s)["G"].dot(step(s))),
        Relation("discrete_gradient", "G", "derivatives of phi seen from the rider, over no step", 1, seen, n + 1,
                 of=lambda k, s: k("discrete_gradient", s, **{f"{name}_next": s[name] for name in "xeb"})["G"]),
        Relation("tangent", "J", "dphi by (e, rider, s)", 1, lagrangian(gap), n + 1),
        Relation("tangent", "K", "dg by (e, rider, s)", 1,
                 lagrangian(lambda k, s, **q: k("residual", s, **q)["g"]), n + 1),
    ]
