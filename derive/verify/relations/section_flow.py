"""Relations of the kernel of a section in a flow: forces from another formula, and their derivatives."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..methods import Relation
from ..motion import cross
from ..numbers import State
from .paths import unit

MOVED = ("t", "d", "w")


def _angle(t: Any, d: Any, w: Any) -> tuple[Any, Any]:
    """Return a sine and a cosine of the angle from chord to flow about t, both times the same."""
    square = t.dot(t)
    return cross(d, w).dot(t) * square**0.5, d.dot(w) * square - d.dot(t) * w.dot(t)


def _coefficients(s: State, now: tuple[Any, ...]) -> Any:
    """Return C_D, C_L and C_M at moved vectors, to first order in the turn of the angle."""
    (sine, cosine), (old_sine, old_cosine) = _angle(*now), _angle(*(s[name] for name in MOVED))
    turned = (sine * old_cosine - cosine * old_sine) / (cosine * old_cosine + sine * old_sine)
    return s["polar"][0::2] + s["polar"][1::2] * turned


def _forces(s: State, now: tuple[Any, ...]) -> Any:
    """Return (3, 3): the forces on r, t and d, with t and d not made unit."""
    (t, d, w), (scale, width, _) = now, s["c_section"]
    drag, lift, moment = _coefficients(s, now)
    square, normal = t.dot(t), cross(t, d)
    across = cross(cross(t, w), t) / square
    speed = across.dot(across) ** 0.5
    force = scale * speed * (drag * square**0.5 * across + lift * cross(t, w))
    # t x f_t + d x f_d is the moment against t, and neither does work in a change of length or shear
    on_chord = -moment * scale * width * speed**2 * square / normal.dot(normal) * normal
    return np.array([force, -d.dot(t) / square * on_chord, on_chord])


def section_flow() -> list[Relation]:
    """Return the relations of forces and derivatives, by entry j of t, d and w one after the other."""
    def moved(k, s, t, j):
        return _forces(s, tuple(s[name] + t * unit(s[name], j % 3) if j // 3 == n else s[name]
                                for n, name in enumerate(MOVED)))

    return [Relation("on_section", "f", "forces in another form", 0, lambda k, s, t, j: _forces(
                s, tuple(s[name] for name in MOVED))),
            Relation("on_section", "K", "df by t, d and w, coefficients with the angle", 1, moved, 9)]
