"""The form of a catenary: the lengths of its droppers and wires, by the heights and tensions that are asked for."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ..parts.material import Material
from ..parts.section import GeneralSection
from ..scene.scene import Scene
from .line import Line
from .local_sag import missing_compliance
from .wires import MODULUS, Wire

if TYPE_CHECKING:
    from ..results.equilibrium import Equilibrium

PIECES = 16
"""Of a span with staggers, as it is drawn."""

LONGEST = 1.0, 1.0
"""Of an element of the contact wire and of the messenger, in m, where nothing else is said."""


@dataclass(frozen=True)
class Form:
    """A span at rest, on meshes with elements of `longest` or shorter: of the contact wire, of the messenger, in m.

    lengths: of the droppers, free of force, in m; tensions: their forces in N; stiffnesses: theirs, and that of the
    dents in both wires that elements leave out, in series, in N/m; contact_length, messenger_length: of the wires,
    undeformed, in m; height: of the contact wire at the masts over that at the outer droppers, in m; mast_force: the
    weight that an inner mast bears, in N; rest: the state of rest of the span.
    """

    line: Line
    longest: tuple[float, float]
    lengths: np.ndarray
    tensions: np.ndarray
    stiffnesses: np.ndarray
    contact_length: float
    messenger_length: float
    height: float
    mast_force: float
    rest: Equilibrium


def mesh(line: Line, longest: float) -> np.ndarray:
    """Return the places of the nodes of a span, from 0 to 1 of it: masts, droppers, and equal elements between."""
    ends = np.array([0.0, *line.droppers.at, line.span])
    pieces = [np.linspace(a, b, max(int(np.ceil((b - a) / longest - 1e-9)), 1) + 1)[:-1]
              for a, b in pairwise(ends.tolist())]
    return np.append(np.concatenate(pieces), line.span) / line.span


def add_wire(scene: Scene, name: str, wire: Wire, start: float, end: float, height: float, nodes: np.ndarray,
             sides: tuple[float, ...] | None = None) -> None:
    """Add a wire along x at a height (m), whose nodes have these arc-lengths, undeformed.

    sides: where it is across the track (z), in m, at equal distances from start to end: a wire in space, along the
    track there as drawn; without them it is planar.
    """
    section = {"area": wire.axial_stiffness / MODULUS, "second_moment_about_z": wire.bending_stiffness / MODULUS}
    density = wire.mass * (1 + wire.tension / wire.axial_stiffness) * MODULUS / wire.axial_stiffness
    drawn: dict[str, Any] = {"start": (start, height, 0), "end": (end, height, 0), "element": "cable8p"}
    if sides is not None:
        section["second_moment_about_y"] = section["second_moment_about_z"]
        drawn = {"points": _snake(start, end, height, sides), "rest": "straight", "element": "cable12"}
    scene.cable(name, nodes=nodes, rest_length=float(nodes[-1]), strain="engineering", curvature="linear",
                membrane="reduced", section=GeneralSection(**section),
                material=Material(youngs_modulus=MODULUS, poisson_ratio=0.3, density=density,
                                  mass_damping=wire.mass_damping, damping_time=wire.damping_time), **drawn)


def _snake(start: float, end: float, height: float, sides: tuple[float, ...]) -> list[tuple[float, float, float]]:
    """Return points from side to side across the track, at equal distances from start to end, in m."""
    spans = len(sides) - 1
    u = np.linspace(0, spans, PIECES * spans + 1)
    before = np.minimum(u.astype(int), spans - 1)
    swing = (1 - np.cos(np.pi * (u - before))) / 2
    z = np.array(sides)[before] * (1 - swing) + np.array(sides)[before + 1] * swing
    return [(start + float(at) / spans * (end - start), height, float(side)) for at, side in zip(u, z, strict=True)]


def missing_at_droppers(line: Line, longest: tuple[float, float]) -> np.ndarray:
    """Return by how much less elements of both wires give way to each dropper than the wires do, in m/N."""
    at = np.array(line.droppers.at)
    missing = [missing_compliance(wire.tension, wire.bending_stiffness, mesh(line, each) * line.span, at)
               for wire, each in zip((line.contact, line.messenger), longest, strict=True)]
    return missing[0] + missing[1]


def hold_ends(scene: Scene) -> None:
    """Hold the ends of the contact wire, which is free to rise, and is level and along the track there."""
    for s in (0.0, scene.cables["contact"].length):
        scene.motion("contact", s=s, displacement=(0, "free", 0), rotation=((0, 0, 1), 0))


def add_dropper(scene: Scene, name: str, messenger: str, places: tuple[float, float], masses: tuple[float, float], *,
                stiffness: float, length: float) -> None:
    """Add a dropper, free of force at a length (m), and what hangs at its ends.

    places, masses: of its ends on the messenger and on the contact wire, the arc-lengths in m, and the masses in kg.
    """
    upper, lower = places
    scene.spring((messenger, upper), ("contact", lower), name=name, stiffness=stiffness, length=length,
                 tension_only=True)
    for wire, s, mass in zip((messenger, "contact"), places, masses, strict=True):
        if mass:
            scene.force(wire, s=s, value=(0, scene.gravity[1] * mass, 0))


def form(line: Line, longest: tuple[float, float] = LONGEST) -> Form:
    """Return the form of a line's spans, found for one of them: the others repeat it.

    The contact wire lies at the droppers as the line's sags say, is level at the masts and pulls there with its
    tension, as the messenger does, which turns freely on its supports. longest: of an element of the contact wire, and
    of the messenger, in m. Raises SceneError; EquilibriumError, where that is not to be had.
    """
    droppers, strings = line.droppers, line.strings
    scene = Scene(gravity=(0, -line.gravity, 0))
    for name, wire, length, height, each, side in (
            ("contact", line.contact, strings.contact_length, 0.0, longest[0], line.staggers[0]),
            ("messenger", line.messenger, strings.messenger_length, line.height, longest[1], line.staggers[1])):
        nodes = mesh(line, each) * np.hypot(length, 2 * side) / (1 + wire.tension / wire.axial_stiffness)
        add_wire(scene, name, wire, 0.0, line.span, height, nodes, None if line.planar else (side, -side))
    lengths = {name: cable.length for name, cable in scene.cables.items()}
    for s in (0.0, lengths["messenger"]):
        scene.pin("messenger", s=s)
    hold_ends(scene)
    adjust, to = {"contact.rest_length": "free", "messenger.rest_length": "free"}, {}
    missing = missing_at_droppers(line, longest)
    for k, x in enumerate(droppers.at):
        upper, lower = (x / line.span * lengths[name] for name in ("messenger", "contact"))
        aside = (line.staggers[1] - line.staggers[0]) * (1 - 2 * x / line.span)
        distance, force = float(np.hypot(strings.distances[k], aside)), float(strings.forces[k])
        stiffness = 1 / (1 / droppers.stiffness_of(distance) + float(missing[k]))
        add_dropper(scene, f"dropper_{k + 1}", "messenger", (upper, lower), (line.hanging[k], droppers.contact_clamp),
                    stiffness=stiffness, length=distance - force / stiffness)
        adjust[f"dropper_{k + 1}.length"] = "free"
        to[f"contact@{lower:.15g}.position.y"] = -float(droppers.depths[k])
    to |= {"contact@0.force.x": -line.contact.tension, "messenger@0.force.x": -line.messenger.tension}
    return _read(line, longest, scene.equilibrium(adjust=adjust, to=to))


def _read(line: Line, longest: tuple[float, float], rest: Equilibrium) -> Form:
    names = [f"dropper_{k + 1}" for k in range(len(line.droppers.at))]
    forces = np.array([float(rest[f"{name}.tension"]) for name in names])
    missing = missing_at_droppers(line, longest)
    distances = np.array([float(rest[f"{name}.length"]) for name in names]) - missing * forces
    lengths = np.array([rest.adjusted[f"{name}.length"] for name in names])
    if line.droppers.axial_stiffness is not None:  # which is over this length, not over the distance
        lengths = distances / (1 + forces / line.droppers.axial_stiffness)
    own = np.array([line.droppers.stiffness_of(length) for length in lengths.tolist()])
    mast = 2 * float(rest["messenger@0.force"][1])
    return Form(line, longest, lengths, forces, 1 / (1 / own + missing), rest.adjusted["contact.rest_length"],
                rest.adjusted["messenger.rest_length"], float(rest["contact.position"][0, 1]), mast, rest)
