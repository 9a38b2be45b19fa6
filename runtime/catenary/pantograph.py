"""A pantograph as a chain of masses over a base that the train moves."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from pydantic import model_validator

from ..parts.part import Part
from ..parts.schemas import checked
from ..parts.solids import Box
from ..parts.validation import not_negative, positive, shown, vector
from ..scene.scene import Scene
from .base import COLLECTOR, RADIUS, TURNING, add_base

APART = 0.5
"""m: of the masses, one below the other, as they are drawn; their springs are free of force so."""


def _each(unit: str, above: bool) -> Any:
    """Return the check of a list of numbers, one at least, which are not negative, or above nil."""
    def check(value: Any) -> tuple[float, ...]:
        value = value.tolist() if isinstance(value, np.ndarray) else value
        if not isinstance(value, list | tuple) or not value:
            raise ValueError(f"must be a list of numbers, one at least, got {shown(value)}")
        numbers = vector(value, unit, len(value))
        for number in numbers:
            if number < 0 or (above and number == 0):
                raise ValueError(f"must {'be above nil' if above else 'not be negative'}, got {number:.9g} {unit}")
        return numbers

    return checked(check, {"type": "array", "items": {"type": "number"}})


class Pantograph(Part):
    """A chain of masses, from the collector down to the base, which the train moves.

    masses in kg; stiffness in N/m and damping in N s/m: of the spring and the damper below each mass, the last of them
    on the base. They are free of force where the collector meets the contact wire's height at its outer droppers; each
    mass bears its weight. uplift in N: the static force on the lowest mass; aerodynamic in N s²/m²: times the square
    of the speed, added to it. contact_stiffness in N/m, between wire and collector; the scene's
    contact has it in series with the dent in the wire that elements leave out, see `local_sag`.
    """

    masses: Annotated[tuple[float, ...], _each("kg", above=True)]
    stiffness: Annotated[tuple[float, ...], _each("N/m", above=False)]
    damping: Annotated[tuple[float, ...], _each("N s/m", above=False)]
    uplift: Annotated[float, not_negative("N")]
    aerodynamic: Annotated[float, not_negative("N s²/m²")] = 0.0
    contact_stiffness: Annotated[float, positive("N/m")] = 50e3

    @model_validator(mode="after")
    def _is_a_chain(self) -> Pantograph:
        for name in ("stiffness", "damping"):
            if len(getattr(self, name)) != len(self.masses):
                raise ValueError(f"has {len(self.masses)} masses, but {len(getattr(self, name))} values of {name}",
                                 "give one for each mass, of what is below it")
        for k, (stiffness, damping) in enumerate(zip(self.stiffness, self.damping, strict=True)):
            if not stiffness and not damping:
                raise ValueError(f"has nothing below mass {k + 1}", "give it stiffness or damping")
        return self

    def lift(self, speed: float) -> float:
        """Return the uplift force (N) at a speed (m/s), static and aerodynamic."""
        return self.uplift + self.aerodynamic * speed**2


def add_masses(scene: Scene, pantograph: Pantograph, place: tuple[float, float], speed: float, name: str) -> None:
    """Add the bodies of a pantograph to a scene, with its collector at (x, y) in m, at a speed (m/s) along x."""
    at, height = place
    bodies = [f"{name}_{k + 1}" for k in range(len(pantograph.masses))]
    for k, body in enumerate(bodies):
        scene.rigid_body(body, mass=pantograph.masses[k], inertia=(TURNING,) * 3,
                         position=(at, height - k * APART, 0), velocity=(speed, 0, 0),
                         shape=Box(size=(0.8, 2 * RADIUS, 0.8) if k else COLLECTOR))
    base = add_base(scene, name, (at, height - len(bodies) * APART), speed)
    for k, (body, below) in enumerate(zip(bodies, [*bodies[1:], base], strict=True)):
        scene.joint("prismatic", base, body, axis=(0, 1, 0), name=f"{name}_guide_{k + 1}")
        lift = pantograph.lift(speed) if below == base else 0.0
        scene.force(body, value=(0, lift - pantograph.masses[k] * scene.gravity[1], 0), name=f"{name}_lift_{k + 1}")
        scene.spring(body, below, stiffness=pantograph.stiffness[k], damping=pantograph.damping[k], length=APART,
                     name=f"{name}_spring_{k + 1}")
