"""The form of a catenary, lengths of droppers and wires for given heights and tensions, and scenes of whole ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import SceneError, near
from ..parts.signal import Ramp, Signal
from ..parts.spring import Spring
from ..parts.validation import items, shown
from ..scene.scene import Scene
from .building import Section, SpanForm, add_spans, along_contact, hold_ends, mesh, named, tie_messengers
from .line import Line, by_span
from .local_sag import missing_compliance
from .overlap import in_sections

if TYPE_CHECKING:
    from ..results.equilibrium import Equilibrium

ELEMENT_LENGTHS = 1.0, 1.0
"""Default length of the longest element of the contact wire and of the messenger, in m."""

BREAKING_TIME = 1e-3
"""s: in which the stiffness of a dropper that breaks falls to zero."""

ARM_LENGTH = 1.0
"""m: distance of supports and steady arms from their fixed points."""


@dataclass(frozen=True)
class Form:
    """A line at rest; longest: the longest element of the contact wire and of the messenger, in m.

    contact_length: of the contact wire in the first span, undeformed, in m; spans: the form of each; heights: of the
    contact wire at the masts over that at the outer droppers, in m; mast_forces: the weight on each inner mast, in N;
    rest: the state of rest of the spans that were formed: one, if equal and symmetric ones repeat it, or all.
    """

    line: Line
    longest: tuple[float, float]
    contact_length: float
    spans: tuple[SpanForm, ...]
    heights: tuple[float, ...]
    mast_forces: tuple[float, ...]
    rest: Equilibrium

    @property
    def lengths(self) -> np.ndarray:
        """Return the lengths of the droppers of the formed spans, free of force, in m."""
        return np.concatenate([span.lengths for span in self.spans[:len(self.line.formed)]])

    @property
    def tensions(self) -> np.ndarray:
        """Return the forces in the droppers of the formed spans, in N."""
        return np.concatenate([span.tensions for span in self.spans[:len(self.line.formed)]])


def form(line: Line, longest: float | tuple[float, float] = ELEMENT_LENGTHS) -> Form:
    """Return the form of a line. Of equal, symmetric spans one is formed, which the others repeat.

    The contact wire has the line's sags at the droppers, and both wires have their tensions at an outer mast; the
    messenger turns freely on its supports. longest: length of the longest element of the contact wire, and of the
    messenger, in m, or of both. Raises SceneError; EquilibriumError, where there is no such form.
    """
    longest = _of_both(longest)
    guess, contact_length = _guess(line, longest)
    scene = Scene(gravity=(0, -line.gravity, 0))
    heights = [line.ends[0].height or 0.0, *[0.0] * (len(guess) - 1), line.ends[1].height or 0.0]
    section, stretches = Section(line), (line.contact.stretch, line.messenger.stretch)
    add_spans(scene, section, guess, contact_length, heights, longest, line.planar, stretches)
    contact_length /= line.contact.stretch
    tie_messengers(scene, section, len(guess))
    for mast in range(1, len(guess)):  # as its support holds the messenger, and its steady arm the contact wire
        before = scene.cables[f"messenger_{mast}"]
        scene.motion(before, s=before.length, displacement=("free", 0, 0))
        if not line.planar:
            scene.motion("contact", s=along_contact(line, contact_length, mast), displacement=("free", "free", 0))
    hold_ends(scene, section, len(guess), [end.remade({"weights": False}) for end in line.ends])
    adjust, to = _targets(scene, line, guess, contact_length)
    return _read(line, longest, guess, scene.equilibrium(adjust=adjust, to=to))


def _targets(scene: Scene, line: Line, guess: Sequence[SpanForm], contact_length: float
             ) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the lengths to adjust, and the heights, places and tensions to which they are adjusted.

    Wires have their tensions at the end with weights, by default at the first one.
    """
    adjust: dict[str, Any] = {"contact.rest_length": "free"}
    to: dict[str, Any] = {}
    for k, each in enumerate(guess):
        adjust[f"messenger_{k + 1}.rest_length"] = "free"
        if k:
            to[f"messenger_{k + 1}@0.position.x"] = line.masts[k]
        places = along_contact(line, contact_length, k, each.span.fractions)
        for j, (s, depth) in enumerate(zip(places.tolist(), each.span.droppers.depths.tolist(), strict=True)):
            adjust[f"dropper_{k + 1}_{j + 1}.length"] = "free"
            to[f"contact@{s:.15g}.position.y"] = -depth
    for names, tension in ((("contact",) * 2, line.contact.tension),
                           (("messenger_1", f"messenger_{len(guess)}"), line.messenger.tension)):
        if line.ends[1].weights:
            to[f"{names[1]}@{scene.cables[names[1]].length:.15g}.force.x"] = tension
        else:
            to[f"{names[0]}@0.force.x"] = -tension
    return adjust, to


def _of_both(longest: float | tuple[float, float]) -> tuple[float, float]:
    """Return the lengths of the longest elements of the contact wire and of the messenger. Raises SceneError."""
    given = items([longest, longest] if isinstance(longest, int | float) else longest, 2, 2)
    if given is None or not all(isinstance(each, int | float) and 0 < each < np.inf for each in given):
        raise SceneError("form", f"longest must be one or two positive lengths in m, got {shown(longest)}",
                         "give that of the contact wire and that of the messenger")
    return float(given[0]), float(given[1])


def _guess(line: Line, longest: tuple[float, float]) -> tuple[list[SpanForm], float]:
    """Return the spans to form as those of strings, and the length of the contact wire in the first, in m.

    The wires have their lengths under tension.
    """
    spans, strings, (of_contact, of_messenger) = line.formed, line.strings, line.sides
    contact_length = float(np.hypot(strings.contact_lengths[0], of_contact[0] - of_contact[1]))
    found = []
    for k, (span, hanging, distances, forces) in enumerate(zip(spans, *(
            by_span(each, spans) for each in (line.hanging, strings.distances, strings.forces)), strict=True)):
        before, after = (of_messenger[mast] - of_contact[mast] for mast in (k, k + 1))
        aside = (before + after) / 2 + (before - after) / 2 * (1 - 2 * span.fractions)
        apart = np.hypot(distances, aside)
        own = np.array([span.droppers.stiffness_of(each) for each in apart.tolist()])
        stiffnesses = 1 / (1 / own + _missing(line, k, longest))
        length = float(np.hypot(strings.messenger_lengths[k], of_messenger[k] - of_messenger[k + 1]))
        found.append(SpanForm(span, length, hanging, apart - forces / stiffnesses, forces, stiffnesses))
    return found, contact_length


def _missing(line: Line, span: int, longest: tuple[float, float]) -> np.ndarray:
    """Return the compliance that the elements of both wires lack at each dropper of a span, in m/N."""
    of = line.each[span]
    contact, messenger = (missing_compliance(wire.tension, wire.bending_stiffness, mesh(of, each) * of.length,
                                             np.array(of.droppers.at))
                          for wire, each in zip((line.contact, line.messenger), longest, strict=True))
    return np.asarray(contact + messenger)


def _read(line: Line, longest: tuple[float, float], guess: Sequence[SpanForm], rest: Equilibrium) -> Form:
    """Return the form of a line from the state of rest of its formed spans."""
    spans = tuple(_read_span(line, k, longest, each, rest) for k, each in enumerate(guess))
    nodes = np.cumsum([0, *(len(mesh(each.span, longest[0])) - 1 for each in guess)])
    heights = rest["contact.position"][nodes, 1].tolist()
    forces = [float(rest[f"{motion.label}.force"][1]) for motion in rest.scene.motions
              if motion.cable.startswith("messenger")]
    if line.repeats:
        heights = [heights[0]] * (line.spans + 1)
        forces = [2 * float(rest["messenger_1@0.force"][1])] * (line.spans - 1)
    return Form(line, longest, rest.adjusted["contact.rest_length"] / float(line.contact_shares[0][len(guess)]),
                spans * (line.spans // len(guess)), tuple(heights), tuple(forces), rest)


def _read_span(line: Line, k: int, longest: tuple[float, float], guess: SpanForm, rest: Equilibrium) -> SpanForm:
    """Return the form of a span, counted from 0."""
    droppers, missing = guess.span.droppers, _missing(line, k, longest)
    names = [f"dropper_{k + 1}_{j + 1}" for j in range(len(guess.lengths))]
    forces = np.array([float(rest[f"{name}.tension"]) for name in names])
    distances = np.array([float(rest[f"{name}.length"]) for name in names]) - missing * forces
    lengths = np.array([rest.adjusted[f"{name}.length"] for name in names])
    if droppers.axial_stiffness is not None:  # which is over this length, not over the distance
        lengths = distances / (1 + forces / droppers.axial_stiffness)
    own = np.array([droppers.stiffness_of(length) for length in lengths.tolist()])
    return SpanForm(guess.span, rest.adjusted[f"messenger_{k + 1}.rest_length"], guess.hanging, lengths, forces,
                    1 / (1 / own + missing))


def scene(lines: Line | Form | Sequence[Line | Form], longest: float | tuple[float, float] = ELEMENT_LENGTHS, *,
          overlaps: int | Sequence[int] = 1, temperature: float | Signal | None = None,
          broken: Mapping[str, float] | None = None) -> Scene:
    """Return the scene of a formed catenary, x along the track, y up from the contact wire at the outer droppers.

    lines: a line or its form, where it is known; or several, the sections of the catenary, each of which has its last
    spans beside the first ones of the next; overlaps: the number of these spans, or one for each pair of sections.
    The wires are drawn straight: a run without a pantograph, whose settings say so, needs ``initial="equilibrium"``.
    longest: as in `form`. The contact wire is "contact", the messenger "messenger_1" from the first mast to the second,
    the droppers "dropper_1_1" and so on, supports and steady arms "support_1" and "arm_0" by their masts; in the second
    section "section_2_contact" and so on. temperature: above that of the form, in K, of the wires a number or a signal,
    of droppers with a ``thermal_expansion`` a number.
    broken: droppers by name with the time at which each breaks, in s, 0 for one that is missing from the start; their
    masses stay. Raises SceneError, EquilibriumError.
    """
    given = [lines] if isinstance(lines, Line | Form) else [*lines]
    sections = in_sections([each if isinstance(each, Line) else each.line for each in given], overlaps)
    made = Scene(gravity=(0, -sections[0].line.gravity, 0), temperature=temperature)
    for span in (span for section in sections for span in section.line.each):
        span.droppers.growth(made.temperature)
    formed = [form(each, longest) if isinstance(each, Line) else each for each in given]
    planar = all(section.line.planar for section in sections)
    for section, each in zip(sections, formed, strict=True):
        add_spans(made, section, each.spans, each.contact_length, each.heights, each.longest, planar)
        tie_messengers(made, section, section.line.spans)
        hold_ends(made, section, section.line.spans, section.line.ends)
        _add_masts(made, section, each, planar)
    for name, time in (broken or {}).items():
        made = _broken(made, name, time)
    return made


def _broken(made: Scene, name: str, time: float) -> Scene:
    """Return a scene whose dropper breaks at a time in s, or is missing if that is 0."""
    droppers = named(made.point_forces, "dropper_[0-9]+_[0-9]+")
    if name not in droppers:
        raise SceneError("catenary", f'there is no dropper "{name}" to break', near(name, droppers))
    if not 0 <= time < np.inf:
        raise SceneError("catenary", f"{name} cannot break at {time:.6g} s",
                         "give a time of the run, or 0 for a dropper that is missing")
    if not time:
        return made.without(name)
    dropper = made.point_forces[name]
    assert isinstance(dropper, Spring) and isinstance(dropper.stiffness, float), f"{name} is a spring"
    return made.replace(name, stiffness=Ramp(start=time, end=time + BREAKING_TIME, before=dropper.stiffness, after=0.0))


def _add_masts(made: Scene, section: Section, formed: Form, planar: bool) -> None:
    line, arm, called = section.line, section.line.steady_arm, section.called
    of_contact, of_messenger = line.sides
    places = [(called("contact"), along_contact(line, formed.contact_length, mast)) for mast in range(line.spans + 1)]
    for mast in range(1, line.spans):
        x, z = section.masts[mast], of_messenger[mast]
        before = made.cables[called(f"messenger_{mast}")]
        made.spring((x, line.height + ARM_LENGTH, z), (before, before.length), name=called(f"support_{mast}"),
                    stiffness=line.support, length=ARM_LENGTH - formed.mast_forces[mast - 1] / line.support)
        if not planar:
            made.motion(before, s=before.length, displacement=("free", "free", 0))
            side = of_contact[mast]  # a rod holds the contact wire on this side of the track, and pulls it there
            hinge = x, formed.heights[mast], side + float(np.copysign(arm.length, side))
            made.joint("distance", hinge, places[mast], length=arm.length, name=called(f"steady_arm_{mast}"))
    for mast, place in enumerate(places):
        if arm.stiffness:
            made.spring((section.masts[mast], formed.heights[mast] + ARM_LENGTH, of_contact[mast]), place,
                        name=called(f"arm_{mast}"), stiffness=arm.stiffness, length=ARM_LENGTH)
