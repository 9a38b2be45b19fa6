"""Relations of the kernels of added mass: derivatives of the kinetic energy of the fluid, and of its impulse in time.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...codegen.family import CouplingFamily
from ..methods import Relation
from ..motion import swung_axes
from ..numbers import State
from .paths import entry, from_kernel, unit


def _along_cable(s: State, t: Any = 0, j: int = 0, name: str = "") -> Any:
    """Return T = (m_n |w_n|^2 + m_t |w_t|^2)/2 with entry j of an input moved by t."""
    s = {**s, name: s[name] + t * unit(s[name], j)} if name else s
    slope, w = s["t"], s["w"]
    along = slope * (slope.dot(w) / slope.dot(slope))
    normal, tangential = s["m"]
    return (normal * (w - along).dot(w - along) + tangential * along.dot(along)) / 2


def added_mass(family: CouplingFamily) -> list[Relation]:
    """Return the relations of impulses, their rates, forces on the slope and moments, with their derivatives."""
    dim = family.dim
    turns = 3 if dim == 3 else 1

    def of_point(k, s, t, j):
        at_rest = s["A"].T.dot(s["w"] + t * unit(s["w"], j))
        return at_rest.dot(s["C"].dot(at_rest)) / 2

    def swung(s, turn, t):
        """Return the state with the axes turned by t times a turn, to first order."""
        return {**s, "A": s["A"] + t * swung_axes(turn, s["A"])}

    def turned(output):
        return lambda k, s, t, j: k("inertia_of_point", swung(s, np.eye(turns, dtype=int)[j], t))[output]

    def minus_moment(k, s, t, j):
        return -of_point(k, {**swung(s, np.eye(turns, dtype=int)[j], t)}, 0, 0)

    def in_time(k, s, t, j):
        return k("impulse_of_point", swung({**s, "w": s["w"] + t * s["w_rate"]}, s["omega"], t))["p"]

    def along_in_time(k, s, t, j):
        return k("impulse_of_cable", s, t=s["t"] + t * s["t_rate"], w=s["w"] + t * s["w_rate"])["p"]

    def by(kernel, output, *names):
        return [Relation(kernel, f"{output}_{name}", f"d {output} by {name}", 1,
                         from_kernel(kernel, output, **{name: entry(name)}), turns if name == "omega" else dim)
                for name in names]

    def difference(s):
        """Return D = (a . M a - b . M b)/2 at t_next less that at t, for half sum and half difference of w."""
        a, b = (s["w"] + s["w_next"]) / 2, (s["w_next"] - s["w"]) / 2
        ends = [[_along_cable({**s, "t": s[t], "w": w}) for w in (a, b)] for t in ("t", "t_next")]
        return (ends[1][0] - ends[1][1]) - (ends[0][0] - ends[0][1])

    cable, point = "inertia_of_cable", "inertia_of_point"
    return [
        *(Relation(kernel, "p", "derivative of T by w", 1, lambda k, s, t, j: _along_cable(s, t, j, "w"), dim)
          for kernel in ("impulse_of_cable", cable)),
        *(Relation(kernel, "M", "d p by w", 1, from_kernel(kernel, "p", w=entry("w")), dim)
          for kernel in ("impulse_of_cable", cable, "impulse_of_point", point)),
        Relation(cable, "g", "derivative of T by t", 1, lambda k, s, t, j: _along_cable(s, t, j, "t"), dim),
        Relation(cable, "p_rate", "rate of p", 1, along_in_time),
        *by(cable, "p", "t"), *by(cable, "p_rate", "t", "t_rate", "w"), *by(cable, "g", "t", "w"),
        Relation("inertia_step", "dp", "p at the end of the step less that before", 0, lambda k, s, t, j: k(
            "impulse_of_cable", s, t=s["t_next"], w=s["w_next"])["p"] - k("impulse_of_cable", s)["p"]),
        Relation("inertia_step", "g", "g . (t_next - t) = D_next - D", 0, lambda k, s, t, j: difference(s),
                 of=lambda k, s: k("inertia_step", s)["g"].dot(s["t_next"] - s["t"])),
        *(Relation(kernel, "p", "derivative of w . A C A' w/2 by w", 1, of_point, dim)
          for kernel in ("impulse_of_point", point)),
        Relation(point, "p_rate", "rate of p", 1, in_time),
        Relation(point, "moment", "minus the derivative of w . A C A' w/2 by a turn", 1, minus_moment, turns),
        *(Relation(point, f"{output}_turn", f"d {output} by a turn", 1, turned(output), turns)
          for output in ("p", "p_rate", "moment")),
        *by(point, "p_rate", "omega", "w"), *by(point, "moment", "w"), *_body_over_step(),
    ]


def _body_over_step() -> list[Relation]:
    """Return the relations of a body's impulse over a step, of axes whose mean is the sample's A."""
    kernel = "inertia_of_point_step"

    def ends(s):
        half = swung_axes(s["theta"], s["A"]) / 2
        return s["A"] - half, s["A"] + half

    def step(k, s):
        before, after = ends(s)
        return k(kernel, {**s, "A": before, "A_next": after, "turning": s["A"].dot(s["turning"])})

    def impulses(k, s):
        return [k("impulse_of_point", s, A=A, w=s[w])["p"] for A, w in zip(ends(s), ("w", "w_next"), strict=True)]

    def work(k, s):
        """Return the change of the kinetic energy less the work of dp on the displacement of the point."""
        before, after = impulses(k, s)
        energy = (after.dot(s["w_next"]) - before.dot(s["w"])) / 2
        return energy - (after - before).dot((s["w"] + s["w_next"]) / 2 - more(k, s, 0, 0))

    def more(k, s, t, j):
        before, after = ends(s)
        return (after - before).dot(s["turning"]) / 4

    return [
        Relation(kernel, "dp", "p at the end of the step less that before", 0,
                 lambda k, s, t, j: impulses(k, s)[1] - impulses(k, s)[0], of=lambda k, s: step(k, s)["dp"]),
        Relation(kernel, "p", "its mean", 0, lambda k, s, t, j: sum(impulses(k, s)) / 2,
                 of=lambda k, s: step(k, s)["p"]),
        Relation(kernel, "moment", "moment . theta = change of T less dp . displacement/h", 0,
                 lambda k, s, t, j: work(k, s), of=lambda k, s: step(k, s)["moment"].dot(s["theta"])),
        Relation(kernel, "more", "mean of A y over both ends less A y of the means", 0, more,
                 of=lambda k, s: step(k, s)["more"]),
    ]
