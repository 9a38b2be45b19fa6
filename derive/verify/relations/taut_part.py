"""Relations of the kernels of straight parts of ropes without mass in space."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np

from ...codegen.family import CouplingFamily
from ..methods import Relation
from ..numbers import State
from .paths import of, root, unit

UNKNOWNS, PLACES, DIM = 4, 9, 3
SLOPE, GRADIENT = of("feet", "F_z"), of("moves", "F_p")


def taut_part(family: CouplingFamily) -> list[Relation]:
    """Return the relations of the kernels."""
    return [*_of_feet(), *_of_places(), *_of_wheel()]


def _by_unknowns(path):
    """Return the path along an unknown: angle and distance of one foot after the other."""
    def moved(k, s, t, j):
        name = "reach" if j % 2 else "angle"
        return path(k, s | {name: s[name] + t * unit(s[name], j // 2)})
    return moved


def _turned(s: State, t: Any, p: Any) -> State:
    """Return a state with places moved by t times p."""
    def turn(A: Any, w: Any) -> Any:
        W = np.array([[0 * w[0], -w[2], w[1]], [w[2], 0 * w[0], -w[0]], [-w[1], w[0], 0 * w[0]]])
        return A + t * W.dot(A)

    return s | {"d": s["d"] + t * p[:DIM], "one": turn(s["one"], p[DIM : 2 * DIM]),
                "other": turn(s["other"], p[2 * DIM :])}


def _by_places(path):
    """Return the path along d, or a rotation of a frame about an axis of the ground."""
    return lambda k, s, t, j: path(k, _turned(s, t, np.eye(PLACES, dtype=int)[j]))


def _of_feet() -> list[Relation]:
    def feet(s: State) -> Any:
        """Return both feet, from the angle of the radius in the groove."""
        found = []
        for k, name in enumerate(("one", "other")):
            at = s["angle"][k] - mpmath.pi / 2
            across = s["reach"][k] * (s[name][:, 0] * mpmath.cos(at) + s[name][:, 1] * mpmath.sin(at))
            found.append(across + s["aside"][k] * s[name][:, 2])
        return found

    def part(s: State) -> Any:
        one, other = feet(s)
        return s["d"] + other - one

    def length(s: State) -> Any:
        return mpmath.sqrt(part(s).dot(part(s)))

    def drawn(k, s):
        """Return F."""
        (R1, R2), (b1, b2) = s["R"], s["angle"]
        return k("feet", s)["l"] + R1 * b1 - R2 * b2

    return [Relation("feet", "s", "both feet", 0, root(lambda s: np.array(feet(s)))),
            Relation("feet", "l", "the distance of both feet", 0, root(lambda s: [length(s)])),
            Relation("feet", "u", "from one foot to the other", 0, root(lambda s: part(s) / length(s))),
            Relation("feet", "F_z", "d(l + R1 b1 - R2 b2) by angles and distances", 1, _by_unknowns(drawn), UNKNOWNS),
            Relation("feet", "F_zz", "dF_z by angles and distances", 1, _by_unknowns(SLOPE), UNKNOWNS)]


def _of_places() -> list[Relation]:
    def bend(k, s):
        """Return the rate of F_z."""
        return k("feet", s)["F_zz"].dot(s["z_rate"]) + k("moves", s)["F_zp"].dot(s["p_rate"])

    return [Relation("moves", "F_p", "dl by d and turns of both frames", 1, _by_places(of("feet", "l")), PLACES),
            Relation("moves", "F_zp", "dF_z by these", 1, _by_places(SLOPE), PLACES),
            Relation("tangent", "F_pp", "dF_p by these", 1, _by_places(GRADIENT), PLACES),
            Relation("tangent", "Q_z", "d(rate of F_z) by angles and distances", 1, _by_unknowns(bend), UNKNOWNS),
            Relation("tangent", "Q_p", "d(rate of F_z) by d and turns of both frames", 1, _by_places(bend), PLACES)]


def _of_wheel() -> list[Relation]:
    def rate(s: State) -> Any:
        return s["own"] + s["axis"].dot(s["omega"])

    def momentum(k, s, t, j):
        """Return the angular momentum after t: of another rate, about an axis that has turned."""
        return s["inertia"] * (rate(s) + t * s["acc"]) * (s["axis"] + t * np.cross(s["omega"], s["axis"]))

    def moved(k, s, t, j):
        """Return the moment after a turn of the axis, or another rate."""
        turned = s | {"axis": s["axis"] + t * np.cross(np.eye(DIM, dtype=int)[j % DIM], s["axis"])}
        faster = s | ({"own": s["own"] + t} if j == 2 * DIM else {"omega": s["omega"] + t * unit(s["omega"], j % DIM)})
        return k("spin", turned if j < DIM else faster)["moment"]

    return [Relation("spin", "E", "I (psi' + a . w)^2/2", 0, root(lambda s: [s["inertia"] * rate(s)**2 / 2])),
            Relation("spin", "force", "d(I (psi' + a . w))/dt", 0, root(lambda s: [s["inertia"] * s["acc"]])),
            Relation("spin", "moment", "d(I (psi' + a . w) a)/dt", 1, momentum),
            Relation("spin_tangent", "K", "dmoment by turns and rates", 1, moved, 2 * DIM + 1)]
