"""Pantographs below a catenary: their bodies in the scene, the contact, and settings of its runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..errors import SceneError
from ..parts.cable import Cable
from ..parts.settings import overridden
from ..parts.solids import Box, Cylinder
from ..parts.validation import Vector
from ..scene.scene import Scene
from .building import named
from .head import RADIUS, REACH, add_head
from .jointed import JointedPantograph
from .local_sag import mean_missing_compliance
from .pantograph import Pantograph

RUN = {"initial": "equilibrium", "integrator": "genalpha", "spectral_radius": 0.5, "tol": 1e-6, "absolute_tol": 5e-3,
       "quantities": ["contact.position.y"], "output_step": 0.004}
"""Default settings of a run. With a larger radius, vibrations of the stiff droppers grow from step to step. With this
absolute_tol the standard deviation of the contact force is converged in time to less than 1 %, see
tests/benchmarks/pantographs.py; tol adds nothing to it."""

MAX_ERROR_RATE = 1.2e-3
"""m/s: largest absolute_tol over the duration of a run."""

INITIAL_PENETRATION = 1e-9
"""m: penetration of a jointed pantograph's collector as drawn, where the search for equilibrium begins."""

END_DISTANCE = 20.0
"""m: distance to the end of the line at which a run ends at the latest."""

SAMPLED_NODES = 80
"""Nodes of the contact wire, from its start, for the mean compliance that its elements lack."""

COLLECTOR = (0.3, 2 * RADIUS, 2 * REACH)
"""m: size of the collector as drawn, along the track, up, across."""

BASE_MASS, TURNING_INERTIA = 1.0, 1.0
"""kg, kg m²: of the base, whose motion is given, and of bodies that do not turn."""

MASS_DISTANCE = 0.5
"""m: vertical distance of the masses as drawn, where their springs are free of force."""

SUSPENSION_LEVER = 0.25
"""m: distance of the suspension's spring below the head as drawn, so that its length does not vanish."""

HINGES = (("base", "lower", "pivot"), ("lower", "upper", "knee"), ("base", "rod", "rod_base"),
          ("rod", "upper", "rod_top"), ("upper", "carrier", "head"))
"""Pairs of bodies with a hinge, and its point."""

RADII = {"lower": 0.04, "upper": 0.03, "rod": 0.02, "carrier": 0.02}
"""m: of arms and rods as drawn."""


def add_pantograph(scene: Scene, pantograph: Pantograph | JointedPantograph, at: float, speed: float,
                   name: str = "pantograph") -> None:
    """Add a pantograph below the contact wire at x = `at` (m), which moves along x at a speed (m/s).

    Its collector is name_1, its base name_base; the masses of a chain below the collector are name_2 and so on, the
    bodies of a jointed one name_lower, name_upper, name_rod and name_carrier; a head that tilts is name_tilting_head,
    its strips are name_strip_1 and so on. Its contact is name_contact, of several strips name_contact_1 and so on; with
    the contact wire of a second section name_section_2_contact. The scene's runs have the settings `RUN` by default,
    and end before the first pantograph is at the end of the line.
    Raises SceneError.
    """
    wires = [scene.cables[each] for each in named(scene.cables, "contact")]
    if not wires:
        raise SceneError("pantograph", 'there is no cable "contact"', "make the scene with funicular.catenary.scene")
    drawn = [np.transpose(wire.drawn_through) for wire in wires]
    begin, end = float(min(x[0] for x, *_ in drawn)), float(max(x[-1] for x, *_ in drawn))
    if not begin < at < end - END_DISTANCE or not 0 <= speed < np.inf:
        raise SceneError("pantograph", f"at {at:.6g} m with {speed:.6g} m/s does not move along the line",
                         f"begin between {begin:.6g} and {end - END_DISTANCE:.6g} m, with a speed that is not negative")
    has_tolerance = "absolute_tol" in scene.run_settings
    heights = {"quantities": [f"{wire.name}.position.y" for wire in wires]}
    scene.run_settings = settings = overridden(RUN | heights, scene.run_settings)
    duration = (end - END_DISTANCE - at) / speed if speed else 1.0
    settings["duration"] = min(duration, settings.get("duration", duration))
    if "absolute_tol" in settings and not has_tolerance:
        settings["absolute_tol"] = min(settings["absolute_tol"], MAX_ERROR_RATE * settings["duration"])
    height = min(float(y.min()) for x, y, _ in drawn if x[0] <= at <= x[-1]) - RADIUS
    strips = [(f"{name}_1", (0.0, 0.0, 0.0))]
    if isinstance(pantograph, JointedPantograph):
        height += INITIAL_PENETRATION
        _add_jointed(scene, pantograph, (at, height), speed, name)
    else:
        _add_masses(scene, pantograph, at, height, speed, name)
    if pantograph.tilting_head is not None:
        strips = add_head(scene, pantograph.tilting_head, name, (at, height), speed, wires[0].dim == 2)
    for wire in wires:
        _add_contacts(scene, wire, strips, pantograph.contact_stiffness, name)


def _add_contacts(scene: Scene, wire: Cable, strips: Sequence[tuple[str, Vector]], stiffness: float, name: str) -> None:
    """Add the contacts of a wire with the strips of a pantograph, each a body and the middle of the strip on it."""
    bar: dict[str, Any] = {} if wire.dim == 2 else {"axis": (0, 0, 1), "length": REACH}
    for k, (body, middle) in enumerate(strips):
        placed = bar | ({"at": middle} if any(middle) else {})
        numbered = f"_{k + 1}" * (len(strips) > 1)
        scene.crossing(wire.name, body, radius=RADIUS, side=(0, 1, 0), name=f"{name}_{wire.name}{numbered}",
                       stiffness=1 / (1 / stiffness + _missing(wire)), **placed)


def _missing(wire: Cable) -> float:
    """Return the compliance of the contact wire at a collector that its elements lack, in m/N."""
    modulus, length = wire.material.youngs_modulus, wire.drawn_length
    tension = modulus * wire.section.area * (length / wire.length - 1)
    if tension <= 0:
        return 0.0
    nodes = wire.node_s[:SAMPLED_NODES] * length / wire.length
    return mean_missing_compliance(tension, modulus * wire.section.second_moment_about_z, nodes)


def _add_base(scene: Scene, name: str, place: tuple[float, float], speed: float) -> str:
    """Add the base of a pantograph at (x, y) in m, which moves along x at a speed (m/s); return its name."""
    base, middle = f"{name}_base", (*place, 0.0)
    scene.rigid_body(base, mass=BASE_MASS, inertia=(TURNING_INERTIA,) * 3, position=middle, velocity=(speed, 0, 0),
                     shape=Box(size=(0.8, 2 * RADIUS, 0.8)))
    scene.joint("prismatic", middle, base, axis=(1, 0, 0), velocity=speed, name=f"{name}_drive")
    return base


def _add_masses(scene: Scene, pantograph: Pantograph, at: float, height: float, speed: float, name: str) -> None:
    """Add the bodies of a chain of masses, with its collector at a place and height in m, at a speed (m/s) along x."""
    bodies = [f"{name}_{k + 1}" for k in range(len(pantograph.masses))]
    for k, body in enumerate(bodies):
        scene.rigid_body(body, mass=pantograph.masses[k], inertia=(TURNING_INERTIA,) * 3,
                         position=(at, height - k * MASS_DISTANCE, 0), velocity=(speed, 0, 0),
                         shape=Box(size=(0.8, 2 * RADIUS, 0.8) if k else COLLECTOR))
    base = _add_base(scene, name, (at, height - len(bodies) * MASS_DISTANCE), speed)
    for k, (body, below) in enumerate(zip(bodies, [*bodies[1:], base], strict=True)):
        scene.joint("prismatic", base, body, axis=(0, 1, 0), name=f"{name}_guide_{k + 1}")
        lift = pantograph.lift(speed) if below == base else 0.0
        scene.force(body, value=(0, lift - pantograph.masses[k] * scene.gravity[1], 0), name=f"{name}_lift_{k + 1}")
        scene.spring(body, below, stiffness=pantograph.stiffness[k], damping=pantograph.damping[k],
                     length=MASS_DISTANCE, name=f"{name}_spring_{k + 1}")


def _add_jointed(scene: Scene, pantograph: JointedPantograph, place: tuple[float, float], speed: float,
                 name: str) -> None:
    """Add the bodies of a jointed pantograph, with its collector at (x, y) in m, at a speed (m/s) along x."""
    gravity = -scene.gravity[1]
    pivot = np.array(place) - pantograph.centres["collector"]
    _add_base(scene, name, (float(pivot[0]), float(pivot[1])), speed)
    _add_bodies(scene, pantograph, pivot, speed, name)

    def at(body: str, point: tuple[float, float] | np.ndarray) -> tuple[str, tuple[float, float, float]]:
        """Return the attachment of a drawn point (2,) on a body."""
        x, y = np.array(point) - (0.0 if body == "base" else pantograph.centres[body])
        return _called(name, body), (float(x), float(y), 0.0)

    joints = pantograph.joints | {"pivot": np.zeros(2)}
    for first, second, point in HINGES:
        scene.joint("revolute", at(first, joints[point]), at(second, joints[point]), axis=(0, 0, 1),
                    name=f"{name}_{point}")
    scene.joint("distance", at("lower", joints["guide_low"]), at("carrier", joints["guide_top"]), name=f"{name}_guide")
    collector, carrier = _called(name, "collector"), _called(name, "carrier")
    scene.joint("prismatic", carrier, collector, axis=(0, 1, 0), name=f"{name}_suspension_guide")
    pressed = pantograph.static_force(gravity=gravity) + gravity * pantograph.collector.mass
    drop = np.array([0.0, pantograph.reach + SUSPENSION_LEVER])
    scene.spring(at("carrier", pantograph.centres["collector"] - drop), collector, name=f"{name}_suspension",
                 stiffness=pantograph.suspension_stiffness, damping=pantograph.suspension_damping,
                 length=float(drop[1]) + pressed / pantograph.suspension_stiffness)
    if pantograph.damper:
        on_base, on_arm = pantograph.damper_at
        scene.spring(at("base", on_base), at("lower", on_arm), stiffness=0.0, damping=pantograph.damper,
                     name=f"{name}_damper")
    scene.moment(_called(name, "lower"), value=(0, 0, pantograph.moment_at(gravity)), name=f"{name}_moment")
    if pantograph.aerodynamic:
        scene.force(carrier, value=(0, pantograph.aerodynamic * speed**2, 0), name=f"{name}_lift")


def _called(name: str, body: str) -> str:
    return f"{name}_1" if body == "collector" else f"{name}_{body}"


def _add_bodies(scene: Scene, pantograph: JointedPantograph, pivot: np.ndarray, speed: float, name: str) -> None:
    joints = pantograph.joints
    axes = {"lower": (np.zeros(2), joints["knee"]), "upper": (joints["rod_top"], joints["head"]),
            "rod": (joints["rod_base"], joints["rod_top"]), "carrier": (joints["head"], joints["guide_top"])}
    for body, centre in pantograph.centres.items():
        limb = getattr(pantograph, body)
        shape: Box | Cylinder = Box(size=COLLECTOR)
        if body in axes:
            start, end = axes[body]
            middle = (start + end) / 2 - centre
            shape = Cylinder(radius=RADII[body], length=float(np.linalg.norm(end - start)), axis=(*(end - start), 0.0),
                             at=(*middle, 0.0))
        x, y = pivot + centre
        scene.rigid_body(_called(name, body), mass=limb.mass, inertia=(limb.inertia,) * 3,
                         position=(float(x), float(y), 0.0), velocity=(speed, 0, 0), shape=shape)
