"""A pantograph as a chain of masses over a base that the train moves."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from pydantic import model_validator

from ..errors import SceneError
from ..parts.cable import Cable
from ..parts.part import Part
from ..parts.schemas import checked
from ..parts.settings import overridden
from ..parts.solids import Box
from ..parts.validation import not_negative, positive, shown, vector
from ..scene import Scene
from .local_sag import mean_missing_compliance

RUN = {"initial": "equilibrium", "integrator": "genalpha", "spectral_radius": 0.5, "tol": 1e-6, "absolute_tol": 5e-3,
       "quantities": ["contact.position.y"], "output_step": 0.004}
"""Settings of a run where no others are given. The droppers' stiffness makes vibrations that a larger radius would let
grow from step to step; absolute_tol is such that the standard deviation of the contact force is converged in time
to less than 1 %, see tests/benchmarks/README.md, and tol adds nothing to it."""

ERROR_RATE = 1.2e-3
"""m/s: what absolute_tol is at the most for the duration of a run, all of which shares in it."""

LEFT = 20.0
"""m: what a run leaves of the line before its end, at the most."""

APART = 0.5
"""m: of the masses, one below the other, as they are drawn; their springs are free of force so."""

BASE_MASS = 1.0
"""kg: of the base, which moves as it is told."""

RADIUS = 0.05
"""m: from the wire's axis to the middle of the collector where they touch; more than any penetration."""

NODES = 80
"""Of the contact wire, from its start on: on so many the mean is taken of what its elements leave of the dent."""

TURNING = 1.0
"""kg m²: moments of inertia of the masses, which do not turn."""


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


def add_pantograph(scene: Scene, pantograph: Pantograph, at: float, speed: float, name: str = "pantograph") -> None:
    """Add a pantograph below the contact wire at x = `at` (m), which moves along x at a speed (m/s) from the start on.

    Its bodies are name_1, the collector, to the lowest one, and name_base; its contact is name_contact. The scene's
    runs have the settings `RUN`, and end before the first pantograph is at the end of the line, where no others are
    given. Raises SceneError.
    """
    wire = scene.cables.get("contact")
    if wire is None:
        raise SceneError("pantograph", 'there is no cable "contact"', "make the scene with funicular.catenary.scene")
    (begin, level, _), (end, *_) = wire.drawn_through[0], wire.drawn_through[-1]
    if not begin < at < end - LEFT or not 0 <= speed < np.inf:
        raise SceneError("pantograph", f"at {at:.6g} m with {speed:.6g} m/s is not on its way along the line",
                         f"begin between {begin:.6g} and {end - LEFT:.6g} m, with a speed that is not negative")
    duration = (end - LEFT - at) / speed if speed else 1.0
    own = "absolute_tol" in scene.run_settings
    scene.run_settings = settings = overridden(RUN, scene.run_settings)
    settings["duration"] = min(duration, settings.get("duration", duration))
    if "absolute_tol" in settings and not own:
        settings["absolute_tol"] = min(settings["absolute_tol"], ERROR_RATE * settings["duration"])
    height = float(level) - RADIUS
    lowest = len(pantograph.masses) + 1
    bodies = [f"{name}_{k}" for k in range(1, lowest)] + [f"{name}_base"]
    for k, body in enumerate(bodies):
        mass = BASE_MASS if k == lowest - 1 else pantograph.masses[k]
        size = (0.3, 2 * RADIUS, 1.6) if k == 0 else (0.8, 2 * RADIUS, 0.8)
        scene.rigid_body(body, mass=mass, inertia=(TURNING,) * 3, position=(at, height - k * APART, 0),
                         velocity=(speed, 0, 0), shape=Box(size=size))
    base, y = bodies[-1], height - (lowest - 1) * APART
    scene.joint("prismatic", (at, y, 0), base, axis=(1, 0, 0), velocity=speed, name=f"{name}_drive")
    for k, body in enumerate(bodies[:-1]):
        scene.joint("prismatic", base, body, axis=(0, 1, 0), name=f"{name}_guide_{k + 1}")
        lift = pantograph.lift(speed) if k == lowest - 2 else 0.0
        scene.force(body, value=(0, lift - pantograph.masses[k] * scene.gravity[1], 0), name=f"{name}_lift_{k + 1}")
        scene.spring(body, bodies[k + 1], stiffness=pantograph.stiffness[k], damping=pantograph.damping[k],
                     length=APART, name=f"{name}_spring_{k + 1}")
    scene.crossing("contact", bodies[0], radius=RADIUS, side=(0, 1, 0), name=f"{name}_contact",
                   stiffness=1 / (1 / pantograph.contact_stiffness + _missing(wire)))


def _missing(wire: Cable) -> float:
    """Return by how much less the elements of the contact wire give way to a collector than the wire does, in m/N."""
    modulus, length = wire.material.youngs_modulus, wire.drawn_through[-1][0] - wire.drawn_through[0][0]
    tension = modulus * wire.section.area * (length / wire.length - 1)
    if tension <= 0:
        return 0.0
    nodes = wire.node_s[:NODES] * length / wire.length
    return mean_missing_compliance(tension, modulus * wire.section.second_moment_about_z, nodes)
