"""Bending of a taut cable below the resolution of its mesh: along the line of its tension, and beside kinks of it.

Away from point forces a taut cable follows the line of its force n, which turns by n x n'/n^2 per length. Beside a kink
of n by an angle 2 theta0 it bends as an elastica with straight ends: E I theta'^2/2 = N (1 - cos theta), with the angle
theta between tangent and force. Hence M = 2 sqrt(N E I) sin(theta/2), and tan(theta/4) = tan(theta0/4)
exp(-d/sqrt(E I/N)) at a distance d. At a section of fixed direction, theta0 is the angle between this direction and the
force. Each side carries half of a moment on a point, which decays likewise.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

MAX_DECAY_LENGTHS = 40.0
"""Distance from a kink, in lengths sqrt(E I/N), beyond which its bending is zero."""


class Kink(NamedTuple):
    """A kink at s (T,): axis (T, 3) and angle theta0 (T,) of its sides, and a moment (T, 3) on the point, N m.

    side: the cuts that it bends, -1 before it, 1 after it, 0 both.
    """

    s: np.ndarray
    axis: np.ndarray
    theta: np.ndarray
    moment: np.ndarray
    side: int = 0


def between(s: np.ndarray, before: np.ndarray, after: np.ndarray, moment: np.ndarray) -> Kink:
    """Return the kink between two forces (T, 3), with a moment (T, 3) on the point."""
    axis, angle = _turn(before, after)
    return Kink(s, axis, angle / 2, moment)


def fixed_direction(s: np.ndarray, direction: np.ndarray, force: np.ndarray, side: int) -> Kink:
    """Return a section of fixed direction (T, 3) with this force on one side, as half of a kink."""
    axis, theta = _turn(direction, force) if side > 0 else _turn(force, direction)
    return Kink(s, axis, theta, np.zeros_like(force), side)


def of_joint(s: np.ndarray, before: np.ndarray, after: np.ndarray, EI: tuple[float, float]) -> list[Kink]:
    """Return both sides of a joint of two pieces, between moments (T, 3) of their lines with EI in N m² of each.

    Beside it the moment differs from that of the line by a exp(-d/sqrt(E I/N)). The moment is continuous, and the
    direction, whose change on each side is a/sqrt(E I N): a sqrt(E I) on the other side has the opposite sign.
    """
    roots = np.sqrt(EI)
    if not roots.sum() > 0:
        return []
    jump, none = 2 * (after - before) / roots.sum(), np.zeros(len(s))
    return [Kink(s, np.zeros_like(before), none, jump * root, side) for root, side in zip(roots, (-1, 1), strict=True)]


def of_hinge(s: np.ndarray, before: np.ndarray, after: np.ndarray) -> list[Kink]:
    """Return both sides of a hinge, which carries no moment, between moments (T, 3) of the lines."""
    none = np.zeros(len(s))
    return [Kink(s, np.zeros_like(before), none, 2 * side * moment, side)
            for moment, side in ((before, -1), (after, 1))]


Stiffness = Callable[[np.ndarray], np.ndarray]
"""E I (T, n), N m^2, of bending about directions (T, n or 1, 3)."""


def line_bending(stiffness: Stiffness, force: np.ndarray, change: np.ndarray) -> np.ndarray:
    """Return the moment (T, n, 3) of a line along the force; change (T, n, 3): derivative of the force by the
    stress-free length.
    """
    square = np.sum(force**2, axis=-1)[..., None]
    turn = np.cross(force, change) / np.where(square > 0, square, 1.0)
    return stiffness(turn)[..., None] * turn


def beside(kink: Kink, s: np.ndarray, after: np.ndarray, stiffness: Stiffness, force: np.ndarray,
           growth: np.ndarray) -> np.ndarray:
    """Return the moment (T, n, 3) beside a kink at cuts s (T or 1, n) with these forces.

    after (T or 1, n): whether a cut at the kink is on the side of larger s. growth (T, n): the stress-free length over
    that of s.
    """
    place = kink.s[:, None]
    EI = stiffness(np.where(np.any(kink.axis, axis=-1)[:, None], kink.axis, kink.moment)[:, None])
    found = np.zeros_like(force)
    size = np.linalg.norm(force, axis=-1)
    bent = np.sqrt(EI / np.where(size > 0, size, np.inf))
    distance = growth * np.abs(s - place)
    beyond = np.where(distance <= 1e-12 * np.max(np.abs(s), initial=0.0), after, s > place)
    near = (distance < MAX_DECAY_LENGTHS * bent) & (bent > 0) & ((kink.side == 0) | (beyond == (kink.side > 0)))
    if not near.any():
        return found
    row = np.broadcast_to(np.arange(len(force))[:, None], near.shape)[near]
    size, bent, distance = size[near], bent[near], distance[near]
    beyond = np.broadcast_to(beyond, near.shape)[near]
    decay = np.exp(-distance / bent)
    theta = 4 * np.arctan(np.tan(kink.theta[row] / 4) * decay)
    bending = 2 * size * bent * np.sin(theta / 2)
    couple = kink.moment[row] * (np.where(beyond, -0.5, 0.5) * decay)[:, None]
    found[near] = bending[:, None] * kink.axis[row] + couple
    return found


def _turn(before: np.ndarray, after: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the axis (T, 3) and the angle (T,), up to pi, of the rotation between directions (T, 3)."""
    cross = np.cross(before, after)
    sine = np.linalg.norm(cross, axis=-1)
    return cross / np.where(sine > 0, sine, 1.0)[:, None], np.arctan2(sine, np.sum(before * after, axis=-1))
