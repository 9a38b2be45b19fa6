"""A pantograph of arms and rods with joints, over a base that the train moves."""

from __future__ import annotations

from functools import cached_property
from typing import Annotated, Any

import numpy as np
from pydantic import model_validator

from ..errors import SceneError
from ..parts.part import Part
from ..parts.schemas import checked, list_schema, some
from ..parts.validation import not_negative, positive, show, shown, vector
from .linkage import POINTS, Posture, across, moved
from .pantograph import Pantograph

DEAD = 1e-3
"""Sine of the angle of two members below which they count as in line: no force is passed on there."""

ITERATIONS, LONGEST, EXACT = 100, 0.05, 1e-13
"""Of Newton's method for the turn of the lower arm at a height; its longest step, and the last one, in rad."""

Point = tuple[float, float]


def _point(value: Any) -> Point:
    x, y = vector(value, "m", 2)
    return x, y


def _two_points(value: Any) -> tuple[Point, Point]:
    if not isinstance(value, list | tuple | np.ndarray) or len(value) != 2:
        raise ValueError(f"must be two points (x, y), got {shown(value)}")
    return _point(value[0]), _point(value[1])


AnyPoint = Annotated[tuple[float, float], checked(_point, list_schema("m", 2, 2))]
TwoPoints = Annotated[tuple[tuple[float, float], tuple[float, float]],
                      checked(_two_points, some(2) | {"items": list_schema("m", 2, 2)})]


class Limb(Part):
    """An arm, a rod or a head: mass in kg; inertia in kg m², about its centre of mass and the axis across the track;
    centre: where that is as drawn, (x, y) in m, in the middle between its joints, of a head at its joint, if not given.
    """

    mass: Annotated[float, positive("kg")]
    inertia: Annotated[float, positive("kg m²")]
    centre: AnyPoint | None = None


class JointedPantograph(Part):
    """A pantograph of two arms: rigid bodies with hinges, on a base that the train moves.

    Points are (x, y) in m as drawn, at the height where it touches the contact wire at the outer droppers: x
    along the track, y up, from the pivot of the lower arm on the base. knee: of lower and upper arm. rod_base and
    rod_top: the ends of the thrust rod, on the base and on the upper arm. head: on the end of the upper arm, about
    which the carrier of the collector turns. guide: the ends of the rod without mass that keeps it level, on the lower
    arm and on the carrier. lower, upper, rod, carrier, collector: mass, inertia and centre of each, see `Limb`.
    reach in m: how far the collector is over the head; it moves up and down on the carrier, on suspension_stiffness in
    N/m and suspension_damping in N s/m. damper in N s/m, between damper_at, points of the base and of the lower arm.

    uplift in N: the force at rest on a wire at the height drawn; or moment in N m, which raises the lower arm and makes
    it. aerodynamic in N s²/m²: times the square of the speed, on the carrier. contact_stiffness as of `Pantograph`.
    Points, masses and damping that are not given are chosen, and of no type that is built: 15 kg move with the head,
    and the static force changes by 3 % within 0.15 m up or down.
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

    @model_validator(mode="after")
    def _lifts(self) -> JointedPantograph:
        if (self.uplift is None) == (self.moment is None):
            raise ValueError("has no uplift" if self.uplift is None else "has two uplifts",
                             "give uplift (N, at the collector) or moment (N m, on the lower arm)")
        knee, base, top, head, low, high = (self.joints[name] for name in POINTS)
        for what, first, second in (("rod and the upper arm's lever", top - base, top - knee),
                                    ("guide and the carrier's lever", high - low, high - head)):
            size = float(np.linalg.norm(first) * np.linalg.norm(second))
            if not abs(across(first) @ second) > DEAD * size:
                raise ValueError(f"the {what} are in line, or one of them has no length: what moves then is not led",
                                 "move an end of one of them")
        if not abs(self.rates()[1]) > DEAD * float(np.linalg.norm(knee)):
            raise ValueError("the head does not rise as the lower arm turns: no moment makes a force there",
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
        """Return of each body the centre of mass (2,) in m, its velocity (2,) and the rate of its turn for 1 rad/s of
        the lower arm; the collector does not move on the carrier.
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
            arm = self.centres[body] - drawn
            arm = np.cos(angle) * arm + np.sin(angle) * across(arm)
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
        """Return the force (N) on a wire at rest, with the carrier raised by some m from where it is drawn.

        By virtual work; gravity in m/s². Raises SceneError, where arms and rods do not reach there.
        """
        return self._force(self._turn(raised), gravity)

    def _force(self, turn: float, gravity: float) -> float:
        return (self.moment_at(gravity) + self.weight_moment(turn, gravity)) / float(self.rates(turn)[1])

    def _turn(self, raised: float) -> float:
        """Return the angle (rad) of the lower arm with the carrier raised by some m."""
        turn, height = 0.0, self.centres["collector"][1] + raised
        for _ in range(ITERATIONS):
            if moved(self.joints, turn) is None:
                break
            place, speed, _ = self.places(turn)["collector"]
            step = float((height - place[1]) / speed[1])
            if abs(step) < EXACT:
                return turn
            turn += float(np.clip(step, -LONGEST, LONGEST))
        raise SceneError("jointed pantograph", f"does not reach {show(raised, 'm')} from where it is drawn",
                         "take a height that its arms reach")

    def equivalent(self, gravity: float = 9.81) -> Pantograph:
        """Return the pantograph of two masses that moves as this one does in small motions about where it is drawn.

        Its uplift is such that it presses as much at rest on a wire at the height drawn, its suspension compressed.
        The lower mass is what moves with the carrier, by kinetic energy over the square of its vertical speed, with the
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
                          contact_stiffness=self.contact_stiffness)
