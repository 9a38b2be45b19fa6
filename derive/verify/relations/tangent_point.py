"""Relations of the kernels of a tangent point of a rope on a sheave in space."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np

from ...codegen.family import CouplingFamily
from ...elements import ELEMENTS
from ..methods import Relation
from ..references.element import Shape
from .paths import along, of, root
from .turning_step import turning_step
from .turning_wheel import turning_wheel

INPUTS = (("x", 3), ("slope", 3), ("chord", 3), ("b", 1))
"""Names and sizes of the coordinates of the conditions."""
TURNED = (*INPUTS, ("axis", 3))
"""The same with an axis that turns."""


def tangent_point(family: CouplingFamily) -> list[Relation]:
    """Return the relations of the kernels."""
    return [*_of_conditions("", INPUTS), *_of_conditions("turned_", TURNED), *_of_chord(), *_of_motion_across(),
            *turning_wheel(), *turning_step()]


def _of_conditions(kind: str, inputs: tuple[tuple[str, int], ...]) -> list[Relation]:
    """Return the relations of conditions and their motion; kind: "turned_" with derivatives by the axis."""
    conditions, n = f"{kind}conditions", sum(size for _, size in inputs)

    def geodesic(s):
        axis, x = s["axis"], s["x"]
        length, b = mpmath.sqrt(s["chord"].dot(s["chord"])), s["b"].item()
        tension = mpmath.hypot(s["EA"].item() * (length - b) / b, s["limit"].item() * b)
        along = s["chord"] / length + s["weight"] * b / tension
        across, size = along - axis * axis.dot(along), mpmath.sqrt(along.dot(along))
        arm = mpmath.sqrt(x.dot(x)) * mpmath.sqrt(across.dot(across)) / size
        share = s["by_chord"].item()
        return [axis.dot(x), share * along.dot(x) + (1 - share) * s["slope"].dot(x), arm - s["R"].item()]

    def forces(k, s):
        return k(conditions, s)["J"].T.dot(s["f"])

    def drifting(k, s, t, j):
        return k(conditions, s, **{name: s[name] + t * s[f"{name}_rate"] for name, _ in inputs})["phi"]

    by = "x, the slope, the chord and b" + " and the axis" * (n > 10)
    return [Relation(conditions, "phi", "a . x, u . x or t . x, |x| times the part of e across a, less R", 0,
                     root(geodesic)),
            Relation(conditions, "J", f"dphi by {by}", 1, along(of(conditions, "phi"), inputs), n),
            Relation(conditions, "K", f"d(J' f) by {by}", 1, along(forces, inputs), n),
            Relation(f"{kind}motion", "Q_d", "d²phi/dt² at zero accelerations", 2, drifting)]


def _of_chord() -> list[Relation]:
    spec = ELEMENTS["cable12"]

    def moved(s: Any, t: Any) -> dict[str, Any]:
        return {"s": s["s"] + t * s["by_L"][0], "l": s["l"] + t * s["by_L"][1]}

    def along_span(value: str) -> Callable[..., Any]:
        return lambda k, s, t, j: k("chord", s | moved(s, t))[value]

    def shapes(s):
        return Shape(spec, s["l"].item())((s["s"].item(), 0, 0), (0, 0, 0))

    def by_e(k, s, t, j):
        unit = np.zeros(s["e"].size, dtype=int)
        unit[3 * j] = 1
        return k("chord", s, e=s["e"] + t * unit.reshape(s["e"].shape))["r"][0]

    return [Relation("chord", "N", "shape functions at 50 digits", 0, root(shapes)),
            Relation("chord", "N", "dr/de", 1, by_e, spec.n_vectors),
            Relation("chord", "r", "Σ N d at 50 digits", 0, root(lambda s: shapes(s).dot(s["e"]))),
            *(Relation("chord", output, f"d{value}/dL", 1, along_span(value))
              for output, value in (("N_L", "N"), ("r_L", "r"), ("r_LL", "r_L")))]


def _of_motion_across() -> list[Relation]:
    rates, places = (("w_rate", 1), ("s_rate", 2)), (("w", 1), ("l", 1))
    force = of("across", "f")

    def moved(s: Any, t: Any) -> dict[str, Any]:
        return {"w": s["w"] + t * s["w_rate"], "l": s["l"] + t * (s["s_rate"][1] - s["s_rate"][0]),
                "w_rate": s["w_rate"] + t * s["w_acc"]}

    def lagrange(k, s, t, j):
        """Return the path of d/dt dT/dv - d(T - V)/dq: dT by a rate is a difference over a unit, as T is quadratic."""
        def energy(sign, **changes):
            found = k("across", s | changes)
            return found["T"] - sign * found["V"]

        if j:
            return -energy(1, l=s["l"] + t * (2 * j - 3))
        now = moved(s, t)
        ahead, behind = (energy(0, **now | {"w_rate": now["w_rate"] + step}) for step in (1, -1))
        return (ahead - behind) / 2 - energy(1, w=s["w"] + t)

    def power(k, s):
        return force(k, s).dot(np.concatenate([[s["w_rate"]], s["s_rate"]]))

    def total(k, s, t, j):
        found = k("across", s | moved(s, t))
        return found["T"] + found["V"]

    return [Relation("across", "T", "rho l w'²/2", 0, root(lambda s: [s["rho"] * s["l"] * s["w_rate"] ** 2 / 2])),
            Relation("across", "V", "-rho l g w", 0, root(lambda s: [-s["rho"] * s["l"] * s["g"] * s["w"]])),
            Relation("across", "f", "d/dt dT/dv - d(T - V)/dq", 1, lagrange, 3),
            Relation("across", "f", "power: d(T + V)/dt", 1, total, of=power),
            Relation("across", "M", "df by w''", 1, along(force, (("w_acc", 1),)), 1),
            Relation("across", "D", "df by rates of w, s_a, s_b", 1, along(force, rates), 3),
            Relation("across", "K", "df by w and l", 1, along(force, places), 2)]
