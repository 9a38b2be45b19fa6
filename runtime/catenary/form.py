"""The form of a catenary, lengths of droppers and wires for given heights and tensions, and scenes of whole ones."""

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

DRAWN_SEGMENTS = 16
"""Straight segments of a span with staggers, as drawn."""

ELEMENT_LENGTHS = 1.0, 1.0
"""Default length of the longest element of the contact wire and of the messenger, in m."""

ARM_LENGTH = 1.0
"""m: distance of supports and steady arms from their fixed points."""


@dataclass(frozen=True)
class Form:
    """A span at rest; longest: the longest element of the contact wire and of the messenger, in m.

    lengths: of the droppers, free of force, in m; tensions: their forces in N; stiffnesses: theirs in series with that
    of the dents in both wires that elements leave out, in N/m; contact_length, messenger_length: of the wires,
    undeformed, in m; height: of the contact wire at the masts over that at the outer droppers, in m; mast_force: the
    weight on an inner mast, in N; rest: the state of rest of the span.
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
    segments = [np.linspace(a, b, max(int(np.ceil((b - a) / longest - 1e-9)), 1) + 1)[:-1]
              for a, b in pairwise(ends.tolist())]
    return np.append(np.concatenate(segments), line.span) / line.span


def add_wire(scene: Scene, name: str, wire: Wire, start: float, end: float, height: float, nodes: np.ndarray,
             sides: tuple[float, ...] | None = None) -> None:
    """Add a wire along x at a height (m); nodes: their arc-lengths, undeformed.

    sides: offsets across the track (z), in m, at equal distances from start to end, where the wire is drawn along the
    track; without them it is planar.
    """
    section = {"area": wire.axial_stiffness / MODULUS, "second_moment_about_z": wire.bending_stiffness / MODULUS}
    density = wire.mass * (1 + wire.tension / wire.axial_stiffness) * MODULUS / wire.axial_stiffness
    drawn: dict[str, Any] = {"start": (start, height, 0), "end": (end, height, 0), "element": "cable8p"}
    if sides is not None:
        section["second_moment_about_y"] = section["second_moment_about_z"]
        drawn = {"points": _staggered(start, end, height, sides), "rest": "straight", "element": "cable12"}
    scene.cable(name, nodes=nodes, rest_length=float(nodes[-1]), strain="engineering", curvature="linear",
                membrane="reduced", section=GeneralSection(**section),
                material=Material(youngs_modulus=MODULUS, poisson_ratio=0.3, density=density,
                                  mass_damping=wire.mass_damping, damping_time=wire.damping_time), **drawn)


def _staggered(start: float, end: float, height: float, sides: tuple[float, ...]) -> list[tuple[float, float, float]]:
    """Return points from side to side across the track, at equal distances from start to end, in m."""
    spans = len(sides) - 1
    u = np.linspace(0, spans, DRAWN_SEGMENTS * spans + 1)
    before = np.minimum(u.astype(int), spans - 1)
    swing = (1 - np.cos(np.pi * (u - before))) / 2
    z = np.array(sides)[before] * (1 - swing) + np.array(sides)[before + 1] * swing
    return [(start + float(at) / spans * (end - start), height, float(side)) for at, side in zip(u, z, strict=True)]


def hold_ends(scene: Scene) -> None:
    """Hold the ends of the contact wire level and along the track, free to rise."""
    for s in (0.0, scene.cables["contact"].length):
        scene.motion("contact", s=s, displacement=(0, "free", 0), rotation=((0, 0, 1), 0))


def add_dropper(scene: Scene, name: str, messenger: str, places: tuple[float, float], masses: tuple[float, float], *,
                stiffness: float, length: float) -> None:
    """Add a dropper, free of force at a length (m), and the masses at its ends.

    places, masses: of its ends on the messenger and on the contact wire, in m and kg.
    """
    upper, lower = places
    scene.spring((messenger, upper), ("contact", lower), name=name, stiffness=stiffness, length=length,
                 tension_only=True)
    for wire, s, mass in zip((messenger, "contact"), places, masses, strict=True):
        if mass:
            scene.force(wire, s=s, value=(0, scene.gravity[1] * mass, 0))


def form(line: Line, longest: tuple[float, float] = ELEMENT_LENGTHS) -> Form:
    """Return the form of one span of a line: all spans are equal.

    The contact wire has the line's sags at the droppers and is level at the masts, where both wires have their
    tensions; the messenger turns freely on its supports. longest: length of the longest element of the contact wire,
    and of the messenger, in m. Raises SceneError; EquilibriumError, where there is no such form.
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
    contact, messenger = (missing_compliance(wire.tension, wire.bending_stiffness, mesh(line, each) * line.span,
                                             np.array(droppers.at))
                          for wire, each in zip((line.contact, line.messenger), longest, strict=True))
    missing = contact + messenger  # of both wires at each dropper, in m/N
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
    return _read(line, longest, missing, scene.equilibrium(adjust=adjust, to=to))


def _read(line: Line, longest: tuple[float, float], missing: np.ndarray, rest: Equilibrium) -> Form:
    names = [f"dropper_{k + 1}" for k in range(len(line.droppers.at))]
    forces = np.array([float(rest[f"{name}.tension"]) for name in names])
    distances = np.array([float(rest[f"{name}.length"]) for name in names]) - missing * forces
    lengths = np.array([rest.adjusted[f"{name}.length"] for name in names])
    if line.droppers.axial_stiffness is not None:  # which is over this length, not over the distance
        lengths = distances / (1 + forces / line.droppers.axial_stiffness)
    own = np.array([line.droppers.stiffness_of(length) for length in lengths.tolist()])
    mast = 2 * float(rest["messenger@0.force"][1])
    return Form(line, longest, lengths, forces, 1 / (1 / own + missing), rest.adjusted["contact.rest_length"],
                rest.adjusted["messenger.rest_length"], float(rest["contact.position"][0, 1]), mast, rest)


def scene(line: Line | Form, longest: tuple[float, float] = ELEMENT_LENGTHS) -> Scene:
    """Return the scene of a formed catenary, x along the track, y up from the contact wire at the outer droppers.

    line: or its form, where it is known; longest: as in `form`. The contact wire is "contact", the messenger
    "messenger_1" from the first mast to the second, the droppers "dropper_1_1" and so on, supports and steady arms
    "support_1" and "arm_0" by their masts. Raises SceneError, EquilibriumError.
    """
    formed = form(line, longest) if isinstance(line, Line) else line
    line, droppers = formed.line, formed.line.droppers
    made = Scene(gravity=(0, -line.gravity, 0))
    place, of_messenger = (mesh(line, each) for each in formed.longest)
    nodes = np.concatenate([place[:-1] + k for k in range(line.spans)] + [[line.spans]]) * formed.contact_length
    of_contact, of_upper = (None if line.planar else _sides(line, side) for side in line.staggers)
    add_wire(made, "contact", line.contact, 0.0, line.length, formed.height, nodes, of_contact)
    hold_ends(made)
    for k in range(line.spans):
        add_wire(made, f"messenger_{k + 1}", line.messenger, k * line.span, (k + 1) * line.span, line.height,
                 of_messenger * formed.messenger_length, None if of_upper is None else of_upper[k:k + 2])
    for span in range(line.spans):
        messenger = f"messenger_{span + 1}"
        for k, x in enumerate(droppers.at):
            places = x / line.span * formed.messenger_length, (span + x / line.span) * formed.contact_length
            add_dropper(made, f"dropper_{span + 1}_{k + 1}", messenger, places,
                        (line.hanging[k], droppers.contact_clamp), stiffness=float(formed.stiffnesses[k]),
                        length=float(formed.lengths[k]))
    _add_masts(made, formed)
    return made


def _add_masts(made: Scene, formed: Form) -> None:
    line, arm = formed.line, formed.line.steady_arm
    of_contact, of_messenger = (_sides(line, side) for side in line.staggers)
    made.pin("messenger_1", s=0.0)
    made.pin(f"messenger_{line.spans}", s=made.cables[f"messenger_{line.spans}"].length)
    for mast in range(1, line.spans):
        x, z = mast * line.span, of_messenger[mast]
        before = made.cables[f"messenger_{mast}"]
        made.tie(before, s=before.length, to=f"messenger_{mast + 1}", at=0.0, rotation="free")
        made.spring((x, line.height + ARM_LENGTH, z), (before, before.length), name=f"support_{mast}",
                    stiffness=line.support, length=ARM_LENGTH - formed.mast_force / line.support)
        if not line.planar:
            made.motion(before, s=before.length, displacement=("free", "free", 0))
            side = of_contact[mast]  # a rod holds the contact wire on this side of the track, and pulls it there
            hinge = x, formed.height, side + float(np.copysign(arm.length, side))
            made.joint("distance", hinge, ("contact", mast * formed.contact_length), length=arm.length,
                       name=f"steady_arm_{mast}")
    for mast in range(line.spans + 1):
        if arm.stiffness:
            s = mast * formed.contact_length
            made.spring((mast * line.span, formed.height + ARM_LENGTH, of_contact[mast]), ("contact", s),
                        name=f"arm_{mast}", stiffness=arm.stiffness, length=ARM_LENGTH)


def _sides(line: Line, first: float) -> tuple[float, ...]:
    """Return the offsets of a wire across the track at the masts, in m."""
    return tuple((-1) ** mast * first for mast in range(line.spans + 1))
