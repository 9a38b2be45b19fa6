"""The kinematics of a pantograph's arms: two arms, a rod that leads the upper one, a rod that keeps the head level.

In the plane, x along the track and y up, from the pivot of the lower arm on the base. The lower arm carries the knee
and the lower end of the guide; the upper arm turns about the knee, and a rod from the base holds a point of it; the
head turns about the upper arm's end, and the guide holds a point of it. One coordinate, the turn of the lower arm,
tells the places and turns of all, by two intersections of circles; their rates follow from two linear equations.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

POINTS = "knee", "rod_base", "rod_top", "head", "guide_low", "guide_top"


@dataclass(frozen=True)
class Posture:
    """Where the joints are, (2,) each in m by name, and how far the bodies have turned from where they were drawn, in
    rad by name: "lower", "upper", "rod", "carrier".
    """

    points: dict[str, np.ndarray]
    turns: dict[str, float]

    def rates(self) -> tuple[dict[str, np.ndarray], dict[str, float]]:
        """Return the velocities (2,) of the joints, in m, and the rates of the turns, for 1 rad/s of the lower arm."""
        knee, base, top, head, low, high = (self.points[name] for name in POINTS)
        turn = {"lower": 1.0}
        v_knee, v_low = across(knee), across(low)
        to_top, to_high = across(top - knee), across(high - head)
        turn["upper"] = -float(v_knee @ (top - base)) / float(to_top @ (top - base))
        v_top, v_head = v_knee + turn["upper"] * to_top, v_knee + turn["upper"] * across(head - knee)
        turn["rod"] = float(v_top @ across(top - base)) / float((top - base) @ (top - base))
        turn["carrier"] = float((v_low - v_head) @ (high - low)) / float(to_high @ (high - low))
        velocities = v_knee, np.zeros(2), v_top, v_head, v_low, v_head + turn["carrier"] * to_high
        return dict(zip(POINTS, velocities, strict=True)), turn


def across(r: np.ndarray) -> np.ndarray:
    """Return the velocity (2,) of a point at r (2,) from the centre of a turn, for 1 rad/s."""
    return np.array([-r[1], r[0]])


def turned(r: np.ndarray, angle: float) -> np.ndarray:
    """Return r (2,), turned by an angle (rad)."""
    return np.cos(angle) * r + np.sin(angle) * across(r)


def moved(drawn: dict[str, np.ndarray], turn: float) -> Posture | None:
    """Return the posture with the lower arm turned by an angle (rad) from where it is drawn; None where the rods do not
    reach.

    drawn: the joints as drawn, (2,) each in m. Joints stay on the side of the line through their neighbours on which
    they are drawn.
    """
    was = [drawn[name] for name in POINTS]
    knee, low = turned(was[0], turn), turned(was[4], turn)
    top = _third(was[1], knee, was[1], was[0], was[2])
    if top is None:
        return None
    upper = _angle(was[2] - was[0], top - knee)
    head = knee + turned(was[3] - was[0], upper)
    high = _third(low, head, was[4], was[3], was[5])
    if high is None:
        return None
    turns = {"lower": turn, "upper": upper, "rod": _angle(was[2] - was[1], top - was[1]),
             "carrier": _angle(was[5] - was[3], high - head)}
    return Posture(dict(zip(POINTS, (knee, was[1], top, head, low, high), strict=True)), turns)


def _third(a: np.ndarray, b: np.ndarray, was_a: np.ndarray, was_b: np.ndarray, was_c: np.ndarray) -> np.ndarray | None:
    """Return the third corner (2,) over a and b, as far from them as it was and on the same side; None if too far."""
    from_a, from_b = (float(np.linalg.norm(was_c - each)) for each in (was_a, was_b))
    base = float(np.linalg.norm(b - a))
    along = (from_a**2 - from_b**2 + base**2) / (2 * base)
    square = from_a**2 - along**2
    if square < 0:
        return None
    side = float(np.sign(across(was_b - was_a) @ (was_c - was_a)))
    return a + (along * (b - a) + side * np.sqrt(square) * across(b - a)) / base


def _angle(before: np.ndarray, after: np.ndarray) -> float:
    """Return the angle (rad) from one direction (2,) to another, between -π and π."""
    return float(np.arctan2(across(before) @ after, before @ after))
