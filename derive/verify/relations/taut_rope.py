"""Relations of the kernels of ropes without mass."""

from __future__ import annotations

from typing import Any

import mpmath

from ...codegen.family import CouplingFamily
from ..methods import Relation
from ..numbers import State
from .paths import along, of, root

D, LENGTHS, RATES = (("d", 2),), (("lengths", 2),), (("rates", 2),)


def taut_rope(family: CouplingFamily) -> list[Relation]:
    """Return the relations of the kernels."""
    return [*_of_straight(), *_of_tension(), *_of_chain()]


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
    def trapezoid(s: State) -> Any:
        """Return the stress-free length L0 that solves L0p - L0 = w (L0p/Lp + L0/L)/2, by iteration."""
        (L, w), (free, length) = s["lengths"], s["past"]
        return [mpmath.findroot(lambda x: free - x - w * (free / length + x / L) / 2, free)]

    def slack(s: State) -> Any:
        (free, length), w = s["past"], s["lengths"][1]
        return [free - w * (free / length + 1) / 2]

    def energy(s: State) -> Any:
        return [s["EA"] * (s["L"] - s["L0"]) ** 2 / (2 * s["L0"])]

    def by_length(k, s, t, j):
        """Return the path of U and of P/2 along L and its rate, at the stress-free length of the state."""
        free = k("free_length", s)["L0"][0]
        of_rope = {"L": s["lengths"][0] + t, "L0": free, "growth": s["rates"][0] + s["rates"][1] + t}
        found = k("energy", s | of_rope)
        return found["U"] + found["P"] / 2

    return [Relation("free_length", "L0", "the trapezoidal rule solved for it", 0, root(trapezoid)),
            Relation("free_length", "slack", "the same without stretch at the end", 0, root(slack)),
            Relation("energy", "U", "EA (L - L0)²/(2 L0)", 0, root(energy)),
            Relation("energy", "W", "U over L0", 0, root(lambda s: [energy(s)[0] / s["L0"]])),
            Relation("energy", "P", "tau EA (L' + w')²/L0", 0,
                     root(lambda s: [s["tau"] * s["EA"] * s["growth"] ** 2 / s["L0"]])),
            Relation("tension", "T", "dU/dL + d(P/2)/dL'", 1, by_length),
            Relation("tension_tangent", "T", "dU/dL + d(P/2)/dL'", 1, by_length),
            Relation("tension_tangent", "K", "dT by L and w", 1, along(of("tension", "T"), LENGTHS), 2),
            Relation("tension_tangent", "D", "dT by their rates", 1, along(of("tension", "T"), RATES), 2)]


def _of_chain() -> list[Relation]:
    def sums(s: State) -> Any:
        """Return the way without slip less the one by which a rope has the stress-free length L0,
        and r L0.
        """
        (L, w), (free, length) = s["lengths"], s["past"]
        L0 = L / (1 + s["ratio"] * s["x"])
        return [w - mpmath.findroot(lambda x: free - L0 - x * (free / length + L0 / L) / 2, 0.1), s["ratio"] * L0]

    def weighted(k, s):
        return s["weights"] @ k("slide", s)["sums"]

    def by_log(k, s, t, j):
        return weighted(k, s | {"ratio": s["ratio"] * mpmath.exp(t)})

    return [Relation("slide", "sums", "the trapezoidal rule, and the stress-free length", 0, root(sums)),
            Relation("slide", "sums_x", "d(sums) by x", 1, along(of("slide", "sums"), (("x", 1),))),
            Relation("slide_tangent", "K", "d(weights . sums) by L and w", 1, along(weighted, LENGTHS), 2),
            Relation("slide_tangent", "by_ratio", "d(weights . sums) by the logarithm of the ratio", 1, by_log)]
