"""A pantograph of arms and rods with joints, over a base that the train moves, and its kinematics.

In the plane, x along the track and y up, from the pivot of the lower arm on the base. The lower arm carries the knee
and the lower end of the guide; the upper arm turns about the knee, and a rod from the base holds a point of it; the
head turns about the end of the upper arm, and the guide holds a point of it. One coordinate, the turn of the lower arm,
determines all places and turns, by two intersections of circles; their rates follow from two linear equations.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any

import numpy as np
from pydantic import model_validator

from ..errors import SceneError
from ..parts.part import Part
from ..parts.schemas import checked, list_schema, some
from ..parts.validation import not_negative, positive, show, shown, vector
from .head import Head
from .pantograph import Pantograph

POINTS = "knee", "rod_base", "rod_top", "head", "guide_low", "guide_top"

DEAD_CENTRE_SINE = 1e-3
"""Sine of the angle of two members below which they count as in line: they transmit no force there."""

MAX_ITERATIONS, MAX_STEP, LAST_STEP = 100, 0.05, 1e-13
"""Newton's method for the turn of the lower arm at a height; steps in rad."""

def _point(value: Any) -> tuple[float, ...]:
    return vector(value, "m", 2)


def _two_points(value: Any) -> tuple[tuple[float, ...], ...]:
    if not isinstance(value, list | tuple | np.ndarray) or len(value) != 2:
        raise ValueError(f"must be two points (x, y), got {shown(value)}")
    return _point(value[0]), _point(value[1])


AnyPoint = Annotated[tuple[float, float], checked(_point, list_schema("m", 2, 2))]
TwoPoints = Annotated[tuple[tuple[float, float], tuple[float, float]],
                      checked(_two_points, some(2) | {"items": list_schema("m", 2, 2)})]


class Limb(Part):
    """An arm, a rod or a head: mass in kg; inertia in kg m², about its centre of mass and the axis across the track;
    centre: of mass as drawn, (x, y) in m; by default in the middle between its joints, of a head at its joint.
    """

    mass: Annotated[float, positive("kg")]
    inertia: Annotated[float, positive("kg m²")]
    centre: AnyPoint | None = None


class JointedPantograph(Part):
    """A pantograph of two arms: rigid bodies with hinges, on a base that the train moves.

    Points are (x, y) in m as drawn, at the height of contact with the contact wire at the outer droppers: x
    along the track, y up, from the pivot of the lower arm on the base. knee: of lower and upper arm. rod_base and
    rod_top: the ends of the thrust rod, on the base and on the upper arm. head: on the end of the upper arm, about
    which the carrier of the collector turns. guide: the ends of the rod without mass that keeps it level, on the lower
    arm and on the carrier. lower, upper, rod, carrier, collector: mass, inertia and centre of each, see `Limb`.
    reach in m: how far the collector is over the head; it moves up and down on the carrier, on suspension_stiffness in
    N/m and suspension_damping in N s/m. damper in N s/m, between damper_at, points of the base and of the lower arm.

    uplift in N: the force at rest on a wire at the height drawn; or moment in N m, which raises the lower arm and makes
    it. aerodynamic in N s²/m²: times the square of the speed, on the carrier. contact_stiffness and tilting_head as of
    `Pantograph`. Points, masses and damping that are not given are chosen, and of no type that is built: 15 kg move
    with the head, and the static force changes by 3 % within 0.15 m up or down.
    """

    knee: AnyPoint = (1.2, 0.85)
    rod_base: AnyPoint = (0.53, -0.04)
    rod_top: AnyPoint = (1.33, 0.71)
    head: AnyPoint = (0.19, 1.5)
    guide: TwoPoints = ((1.25, 0.89), (0.18, 1.65))
    lower: Limb = Limb(mass=24.0, inertia=4.3)
    upper: Limb = Limb(mass=13.0, inertia=2.1)
    rod: Limb = Limb(mass=3.0, inertia=0.3)
    carrier: Limb = Limb(mass=3.0, inertia=0.1)
    collector: Limb = Limb(mass=7.2, inertia=0.5)
    reach: Annotated[float, not_negative("m")] = 0.2
    suspension_stiffness: Annotated[float, positive("N/m")] = 4200.0
    suspension_damping: Annotated[float, not_negative("N s/m")] = 10.0
    damper: Annotated[float, not_negative("N s/m")] = 3300.0
    damper_at: TwoPoints = ((0.45, 0.0), (0.3, 0.21))
    uplift: Annotated[float, not_negative("N")] | None = None
    moment: Annotated[float, not_negative("N m")] | None = None
    aerodynamic: Annotated[float, not_negative("N s²/m²")] = 0.0
    contact_stiffness: Annotated[float, positive("N/m")] = 50e3
    tilting_head: Head | None = None

    @model_validator(mode="after")
    def _lifts(self) -> JointedPantograph:
        if (self.uplift is None) == (self.moment is None):
            raise ValueError("has no uplift" if self.uplift is None else "has two uplifts",
                             "give uplift (N, at the collector) or moment (N m, on the lower arm)")
        knee, base, top, head, low, high = (self.joints[name] for name in POINTS)
        for what, first, second in (("rod and the upper arm's lever", top - base, top - knee),
                                    ("guide and the carrier's lever", high - low, high - head)):
            size = float(np.linalg.norm(first) * np.linalg.norm(second))
            if not abs(across(first) @ second) > DEAD_CENTRE_SINE * size:
                raise ValueError(f"the {what} are in line, or one of them has no length: the posture is not determined",
                                 "move an end of one of them")
        if not abs(self.rates()[1]) > DEAD_CENTRE_SINE * float(np.linalg.norm(knee)):
            raise ValueError("the head does not rise as the lower arm turns: a moment on it exerts no vertical force",
                             "draw it at another height")
        return self

    @cached_property
    def joints(self) -> dict[str, np.ndarray]:
        """Return the joints as drawn, (2,) each in m, by name."""
        points = self.knee, self.rod_base, self.rod_top, self.head, *self.guide
        return {name: np.array(point) for name, point in zip(POINTS, points, strict=True)}

    @cached_property
    def centres(self) -> dict[str, np.ndarray]:
        """Return the centres of mass as drawn, (2,) each in m, by body; that of the collector is where it is held."""
        knee, base, top, head = (self.joints[name] for name in POINTS[:4])
        own = {"lower": knee / 2, "upper": (knee + head) / 2, "rod": (base + top) / 2, "carrier": head}
        for name in own:
            given = getattr(self, name).centre
            own[name] = own[name] if given is None else np.array(given)
        return own | {"collector": head + np.array([0.0, self.reach])}

    def posture(self, turn: float = 0.0) -> Posture:
        """Return the posture with the lower arm turned by an angle (rad) from where it is drawn. Raises SceneError."""
        found = moved(self.joints, turn)
        if found is None:
            raise SceneError("jointed pantograph", f"cannot turn its lower arm by {turn:.6g} rad: the rods do not "
                             "reach", "take a smaller angle, or longer rods")
        return found

    def places(self, turn: float = 0.0) -> dict[str, tuple[np.ndarray, np.ndarray, float]]:
        """Return centre of mass (2,) in m, velocity (2,) and turn rate of each body for 1 rad/s of the lower arm.

        The collector does not move on the carrier.
        """
        posture = self.posture(turn)
        speeds, rates = posture.rates()
        zero = np.zeros(2)
        hinges = {"lower": (zero, zero, zero), "rod": (self.joints["rod_base"],) * 2 + (zero,)}
        for body, hinge in (("upper", "knee"), ("carrier", "head"), ("collector", "head")):
            hinges[body] = self.joints[hinge], posture.points[hinge], speeds[hinge]
        found = {}
        for body, (drawn, now, speed) in hinges.items():
            turns_with = "carrier" if body == "collector" else body
            angle, rate = posture.turns[turns_with], rates[turns_with]
            arm = turned(self.centres[body] - drawn, angle)
            found[body] = now + arm, speed + rate * across(arm), rate
        return found

    def rates(self, turn: float = 0.0) -> np.ndarray:
        """Return the velocity (2,) of the collector in m, along the track and up, for 1 rad/s of the lower arm."""
        return self.places(turn)["collector"][1]

    def weight_moment(self, turn: float = 0.0, gravity: float = 9.81) -> float:
        """Return the power of the weights in W for 1 rad/s of the lower arm, by virtual work; gravity in m/s²."""
        return -gravity * float(sum(getattr(self, body).mass * speed[1]
                                    for body, (_, speed, _) in self.places(turn).items()))

    def moment_at(self, gravity: float = 9.81) -> float:
        """Return the moment (N m) on the lower arm, along the axis across the track, z, that makes the uplift."""
        if self.moment is not None:
            return float(np.sign(self.rates()[1])) * self.moment
        assert self.uplift is not None, "one of both is given"
        return self.uplift * float(self.rates()[1]) - self.weight_moment(0.0, gravity)

    def static_force(self, raised: float = 0.0, gravity: float = 9.81) -> float:
        """Return the force (N) on a wire at rest, with the carrier raised by some m from its drawn height.

        By virtual work; gravity in m/s². Raises SceneError where arms and rods do not reach.
        """
        return self._force(self._turn(raised), gravity)

    def _force(self, turn: float, gravity: float) -> float:
        return (self.moment_at(gravity) + self.weight_moment(turn, gravity)) / float(self.rates(turn)[1])

    def _turn(self, raised: float) -> float:
        """Return the angle (rad) of the lower arm with the carrier raised by some m."""
        turn, height = 0.0, self.centres["collector"][1] + raised
        for _ in range(MAX_ITERATIONS):
            if moved(self.joints, turn) is None:
                break
            place, speed, _ = self.places(turn)["collector"]
            step = float((height - place[1]) / speed[1])
            if abs(step) < LAST_STEP:
                return turn
            turn += float(np.clip(step, -MAX_STEP, MAX_STEP))
        raise SceneError("jointed pantograph", f"does not reach {show(raised, 'm')} from where it is drawn",
                         "take a height that its arms reach")

    def equivalent(self, gravity: float = 9.81) -> Pantograph:
        """Return the pantograph of two masses with the same small motions about the drawn posture.

        Its uplift gives the same static force on a wire at the drawn height, with its suspension compressed. The lower
        mass is the kinetic energy of all that moves with the carrier over the square of its vertical speed, with the
        collector's motion along the track; its spring is the decrease of the static force with the height, its damper
        has the same power. Raises SceneError where the static force grows with the height.
        """
        rise = float(self.rates()[1])
        mass = sum(getattr(self, body).mass * float(speed @ speed) + getattr(self, body).inertia * rate**2
                   for body, (_, speed, rate) in self.places().items()) / rise**2 - self.collector.mass
        step = 1e-4
        stiffness = -(self._force(step, gravity) - self._force(-step, gravity)) / (
            self.places(step)["collector"][0][1] - self.places(-step)["collector"][0][1])
        if stiffness < 0:
            raise SceneError("jointed pantograph", f"has a static force that grows with the height, by "
                             f"{-stiffness:.6g} N/m: no chain of masses on springs does so",
                             "draw it where the force falls with the height")
        pressed = self.static_force(gravity=gravity) * (1 + stiffness / self.suspension_stiffness)
        on_base, on_arm = (np.array(point) for point in self.damper_at)
        gap = on_arm - on_base
        ratio = float(across(on_arm) @ gap) / float(np.linalg.norm(gap)) / rise
        return Pantograph(masses=[self.collector.mass, mass], stiffness=[self.suspension_stiffness, stiffness],
                          damping=[self.suspension_damping, self.damper * ratio**2],
                          uplift=pressed, aerodynamic=self.aerodynamic,
                          contact_stiffness=self.contact_stiffness, tilting_head=self.tilting_head)


@dataclass(frozen=True)
class Posture:
    """Places of the joints, (2,) each in m by name, and turns of the bodies from the drawn posture, in rad by name:
    "lower", "upper", "rod", "carrier".
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
    return np.asarray(np.cos(angle) * r + np.sin(angle) * across(r))


def moved(drawn: dict[str, np.ndarray], turn: float) -> Posture | None:
    """Return the posture with the lower arm turned by an angle (rad); None where the rods do not reach.

    drawn: the joints as drawn, (2,) each in m. Joints stay on their drawn side of the line through their neighbours.
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
    """Return the third corner (2,) over a and b at its drawn distances and side; None where it does not exist."""
    from_a, from_b = (float(np.linalg.norm(was_c - each)) for each in (was_a, was_b))
    base = float(np.linalg.norm(b - a))
    along = (from_a**2 - from_b**2 + base**2) / (2 * base)
    square = from_a**2 - along**2
    if square < 0:
        return None
    side = float(np.sign(across(was_b - was_a) @ (was_c - was_a)))
    return np.asarray(a + (along * (b - a) + side * np.sqrt(square) * across(b - a)) / base)


def _angle(before: np.ndarray, after: np.ndarray) -> float:
    """Return the angle (rad) from one direction (2,) to another, between -π and π."""
    return float(np.arctan2(across(before) @ after, before @ after))
