"""The parts of a catenary in a scene: wires between masts, their ends, droppers."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from ..parts.material import Material
from ..parts.section import GeneralSection
from ..scene.scene import Scene
from .line import Line, Span, shares
from .wires import MODULUS, End, Wire

DRAWN_SEGMENTS = 16
"""Straight segments of a span of a wire that is not straight, as drawn."""

Point = tuple[float, float, float]

NAMES = r"(section_[0-9]+_)?{}"
"""Pattern of names of parts of the first section of a catenary and of others."""


@dataclass(frozen=True)
class Section:
    """A line as one section of a catenary: counted from 1, its first mast at a place in m along the track."""

    line: Line
    number: int = 1
    start: float = 0.0

    def called(self, name: str) -> str:
        """Return the name of a part."""
        return called(self.number, name)

    @property
    def masts(self) -> list[float]:
        """Return the places of the masts, in m along the track."""
        return [self.start + mast for mast in self.line.masts]


def called(section: int, name: str) -> str:
    """Return the name of a part of a section, counted from 1."""
    return name if section == 1 else f"section_{section}_{name}"


def named(names: Iterable[str], name: str) -> list[str]:
    """Return which of these are names of the parts called so, a regular expression, in any section."""
    return [each for each in names if re.fullmatch(NAMES.format(name), each)]


@dataclass(frozen=True)
class SpanForm:
    """The form of a span; messenger_length: undeformed, in m.

    Of each dropper: the mass that hangs from the messenger there, in kg; its length free of force, in m; its tension in
    N; its stiffness in series with that of the dents in both wires that elements leave out, in N/m.
    """

    span: Span
    messenger_length: float
    hanging: np.ndarray
    lengths: np.ndarray
    tensions: np.ndarray
    stiffnesses: np.ndarray


def mesh(span: Span, longest: float) -> np.ndarray:
    """Return the places of the nodes of a span, from 0 to 1 of it: masts, droppers, and equal elements between."""
    ends = np.array([0.0, *span.droppers.at, span.length])
    segments = [np.linspace(a, b, max(int(np.ceil((b - a) / longest - 1e-9)), 1) + 1)[:-1]
              for a, b in pairwise(ends.tolist())]
    return np.append(np.concatenate(segments), span.length) / span.length


def along_contact(line: Line, first: float, span: int, fractions: Any = 0.0) -> Any:
    """Return arc-lengths of the contact wire, undeformed, at places of a span, from 0 to 1 of it, in m.

    first: the length in the first span, in m; span: counted from 0, `line.spans` for the end of the wire.
    """
    begin, over = line.contact_shares
    return (begin[span] + (fractions * over[span] if span < len(over) else 0.0)) * first


def add_wire(scene: Scene, name: str, wire: Wire, masts: Sequence[Point], nodes: np.ndarray, planar: bool) -> None:
    """Add a wire; masts: its points there, in m; nodes: arc-lengths, undeformed, in m; planar: if the scene is."""
    section = {"area": wire.axial_stiffness / MODULUS, "second_moment_about_z": wire.bending_stiffness / MODULUS}
    density = wire.mass * wire.stretch * MODULUS / wire.axial_stiffness
    drawn: dict[str, Any] = {"points": _drawn(masts), "rest": "straight"}
    if planar and len({y for _, y, _ in masts}) == 1:
        drawn = {"start": (*masts[0][:2], 0.0), "end": (*masts[-1][:2], 0.0)}
    if not planar:
        section["second_moment_about_y"] = section["second_moment_about_z"]
    scene.cable(name, nodes=nodes, rest_length=float(nodes[-1]), element="cable8p" if planar else "cable12",
                strain="engineering", curvature="linear", membrane="reduced", section=GeneralSection(**section),
                material=Material(youngs_modulus=MODULUS, poisson_ratio=0.3, density=density,
                                  mass_damping=wire.mass_damping, damping_time=wire.damping_time,
                                  thermal_expansion=wire.thermal_expansion), **drawn)


def _drawn(masts: Sequence[Point]) -> list[Point]:
    """Return points from mast to mast, which swing across the track, in m."""
    places, spans = np.array(masts), len(masts) - 1
    begin, over = shares(np.diff(places[:, 0]))
    u = np.linspace(0, spans, DRAWN_SEGMENTS * spans + 1)
    k = np.minimum(u.astype(int), spans - 1)
    swing = (1 - np.cos(np.pi * (u - k))) / 2
    y = places[k, 1] + (places[k + 1, 1] - places[k, 1]) * swing
    z = places[k, 2] * (1 - swing) + places[k + 1, 2] * swing
    x = places[0, 0] + (begin[k] + (u - k) * over[k]) / begin[-1] * (places[-1, 0] - places[0, 0])
    return list(zip(x.tolist(), y.tolist(), z.tolist(), strict=True))


def add_spans(scene: Scene, section: Section, spans: Sequence[SpanForm], contact_length: float,
              heights: Sequence[float], longest: tuple[float, float], planar: bool,
              stretches: tuple[float, float] = (1.0, 1.0)) -> None:
    """Add wires and droppers of spans from the first mast on.

    contact_length: in the first span; heights: of the contact wire at the masts; longest: elements, see `form`; all in
    m. planar: if the scene is. stretches: of contact wire and messenger, by which their given lengths are over the
    undeformed ones.
    """
    line, (of_contact, of_messenger) = section.line, section.line.sides
    nodes = [along_contact(line, contact_length, k, mesh(each.span, longest[0])) for k, each in enumerate(spans)]
    lower = list(zip(section.masts, heights, of_contact, strict=False))
    add_wire(scene, section.called("contact"), line.contact, lower,
             np.concatenate([*(each[:-1] for each in nodes), nodes[-1][-1:]]) / stretches[0], planar)
    upper = [(x, line.height, z) for x, z in zip(section.masts, of_messenger, strict=True)]
    for k, each in enumerate(spans):
        add_wire(scene, section.called(f"messenger_{k + 1}"), line.messenger, upper[k:k + 2],
                 mesh(each.span, longest[1]) * each.messenger_length / stretches[1], planar)
    for k, each in enumerate(spans):
        places = (each.span.fractions * (each.messenger_length / stretches[1]),
                  along_contact(line, contact_length / stretches[0], k, each.span.fractions))
        _add_droppers(scene, section, k, each, *(each.tolist() for each in places))


def tie_messengers(scene: Scene, section: Section, spans: int) -> None:
    """Tie the messengers of all spans together at the masts between, where they turn freely."""
    for k in range(1, spans):
        before = scene.cables[section.called(f"messenger_{k}")]
        scene.tie(before, s=before.length, to=section.called(f"messenger_{k + 1}"), at=0.0, rotation="free")


def hold_ends(scene: Scene, section: Section, spans: int, ends: Sequence[End]) -> None:
    """Hold the outer ends of both wires, or let weights pull them: messengers turn freely there.

    ends: at the first and at the last of the masts of all spans.
    """
    contact, first, last = map(section.called, ("contact", "messenger_1", f"messenger_{spans}"))
    line = section.line
    for name, s, end, along in ((first, 0.0, ends[0], -1.0), (last, scene.cables[last].length, ends[1], 1.0)):
        if end.weights:
            scene.motion(name, s=s, displacement=("free", 0, 0))
            scene.force(name, s=s, value=(along * line.messenger.tension, 0, 0))
        else:
            scene.pin(name, s=s)
    for s, end, along in ((0.0, ends[0], -1.0), (scene.cables[contact].length, ends[1], 1.0)):
        level: dict[str, Any] = {"rotation": ((0, 0, 1), 0)} if end.height is None else {}
        scene.motion(contact, s=s, displacement=("free" if end.weights else 0, "free" if level else 0, 0), **level)
        if end.weights:
            scene.force(contact, s=s, value=(along * line.contact.tension, 0, 0))


def _add_droppers(scene: Scene, section: Section, k: int, formed: SpanForm, on_messenger: list[float],
                  on_contact: list[float]) -> None:
    """Add the droppers of a span, counted from 0, at places on both wires, in m, and the masses at their ends."""
    wires = section.called(f"messenger_{k + 1}"), section.called("contact")
    growth = formed.span.droppers.growth(scene.temperature)
    for j, s in enumerate(zip(on_messenger, on_contact, strict=True)):
        upper, lower = zip(wires, s, strict=True)
        scene.spring(upper, lower, name=section.called(f"dropper_{k + 1}_{j + 1}"), tension_only=True,
                     stiffness=float(formed.stiffnesses[j]), length=float(growth * formed.lengths[j]))
        for (wire, place), mass in ((upper, float(formed.hanging[j])), (lower, formed.span.droppers.contact_clamp)):
            if mass:
                scene.force(wire, s=place, value=(0, scene.gravity[1] * mass, 0))
