"""Relations of the kernels of ropes without mass."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np

from ...codegen.family import CouplingFamily
from ..methods import Relation
from ..numbers import State
from .paths import along, half, of, root

D, LENGTHS, RATES = (("d", 2),), (("lengths", 2),), (("rates", 2),)


def taut_rope(family: CouplingFamily) -> list[Relation]:
    """Return the relations of the kernels."""
    return [*_of_straight(), *_of_tension()]


def _of_straight() -> list[Relation]:
    def tangent(s: State) -> tuple[Any, Any]:
        """Return length and direction by the angle between d and the tangent, whose sine is the rise over |d|."""
        x, y = s["d"]
        size, angle = mpmath.hypot(x, y), mpmath.atan2(y, x) - mpmath.asin(s["rise"].item() / mpmath.hypot(*s["d"]))
        return (mpmath.sqrt(size - s["rise"].item()) * mpmath.sqrt(size + s["rise"].item()),
                [mpmath.cos(angle), mpmath.sin(angle)])

    def turned(k, s, t, j):
        """Return the sine of the change of the angle."""
        u, moved = k("straight", s)["u"], along(of("straight", "u"), D)(k, s, t, j)
        return u[0] * moved[1] - u[1] * moved[0]

    def force(k, s):
        found = k("straight", s)
        return s["w"][0] * found["l_d"] + s["w"][1] * found["b_d"]

    return [Relation("straight", "l", "by the angle between d and the tangent", 0, root(lambda s: [tangent(s)[0]])),
            Relation("straight", "u", "by the angle between d and the tangent", 0, root(lambda s: tangent(s)[1])),
            Relation("straight", "l_d", "dl by d", 1, along(of("straight", "l"), D), 2),
            Relation("straight", "b_d", "d(angle of u) by d", 1, turned, 2),
            Relation("straight_tangent", "K", "d(w . (l_d, b_d)) by d", 1, along(force, D), 2)]


def _of_tension() -> list[Relation]:
    def energy(s: State) -> Any:
        L, free = s["lengths"]
        return [s["EA"] * (L - free) ** 2 / (2 * free)]

    def power(s: State) -> Any:
        """Return tau EA L0 times the square of the rate of the stretch."""
        (L, free), (grows, frees) = s["lengths"], s["rates"]
        return [s["tau"] * s["EA"] * free * (grows / free - L * frees / free**2) ** 2]

    def both(k, s, t, j):
        """Return U + the half of P along a length and its rate: their derivatives are the forces, `kept` beside."""
        unit = np.array([1 - j, j])
        moved = k("energy", s, lengths=s["lengths"] + t * unit)["U"] - (s["kept"] * t if j else 0 * t)
        return moved + half(along(of("dissipation", "P"), RATES))(k, s, t, j)

    return [Relation("energy", "U", "EA (L - L0)²/(2 L0)", 0, root(energy)),
            Relation("dissipation", "P", "tau EA L0 (d(L/L0)/dt)²", 0, root(power)),
            Relation("tension", "f", "dU by the lengths, dP/2 by their rates, less what wheels hold", 1, both, 2),
            Relation("tension_tangent", "f", "dU by the lengths, dP/2 by their rates", 1, both, 2),
            Relation("tension_tangent", "K", "df by the lengths", 1, along(of("tension", "f"), LENGTHS), 2),
            Relation("tension_tangent", "D", "df by the rates", 1, along(of("tension", "f"), RATES), 2)]
