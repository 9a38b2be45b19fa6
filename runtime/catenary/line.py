"""A catenary of spans, and its state of rest with wires that do not bend, in closed form."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate
from typing import Annotated, Any

import numpy as np
from pydantic import model_validator

from ..parts.part import Part
from ..parts.schemas import checked, list_schema, number_schema
from ..parts.validation import Count, items, number, positive, positive_number, show, shown
from .wires import Droppers, End, SteadyArm, Wire

SYMMETRY_TOLERANCE = 1e-9
"""Part of the span by which droppers and their mirror images may differ."""


@dataclass(frozen=True)
class Span:
    """A span of a line: its droppers, the place of its first mast and its length, in m along the track."""

    droppers: Droppers
    start: float
    length: float

    @property
    def fractions(self) -> np.ndarray:
        """Return the places of the droppers, from 0 to 1 of the span."""
        return np.array(self.droppers.at) / self.length

    @property
    def is_symmetric(self) -> bool:
        """Return whether the droppers are their mirror images about the middle of the span."""
        at, depths = np.array(self.droppers.at), self.droppers.depths
        off = np.abs([at - (self.length - at[::-1]), depths - depths[::-1]])
        return bool((off <= SYMMETRY_TOLERANCE * self.length).all())


@dataclass(frozen=True)
class AtRest:
    """Spans of strings: forces of the droppers (N), distances of their ends (m), the messenger's heights there (m),
    each of one span after the other, and the lengths of both wires along their shapes by span (m).
    """

    forces: np.ndarray
    distances: np.ndarray
    heights: np.ndarray
    contact_lengths: np.ndarray
    messenger_lengths: np.ndarray


def _one_or_list(of: Callable[[Any], Any], what: str) -> Callable[[Any], Any]:
    """Return the check of a value, or of a list of one or more of them."""
    def check(value: Any) -> Any:
        if isinstance(value, list | tuple | np.ndarray):
            if (given := items(value, 1)) is None:
                raise ValueError(f"must be {what}, or a list of them, got {shown(value)}")
            return tuple(map(of, given))
        return of(value)

    return check


LENGTHS = {"anyOf": [number_schema("m"), list_schema("m", 1, None)]}
Lengths = Annotated[float | tuple[float, ...], checked(_one_or_list(lambda value: positive_number(value, "m"),
                                                                    "a length"), LENGTHS)]
Sides = Annotated[float | tuple[float, ...], checked(_one_or_list(lambda value: number(value, "m"), "an offset"),
                                                     LENGTHS)]


class Line(Part):
    """A catenary: spans of a contact wire that hangs by droppers from a messenger.

    spans: their number; span: the length of each, in m, or a list of lengths; droppers: of each span, or a list, one
    `Droppers` for each; height: from the contact wire at the outer droppers up to the messenger at the masts, at rest,
    in m; support: the vertical stiffness of the messenger's supports, in N/m. stagger: the offset of the contact wire
    across the track (z) at the first mast, in m, with alternating sides, or a list, one for each mast;
    messenger_stagger: that of the messenger, as the contact wire if not given. Without staggers the line is planar.
    ends: of both wires, at the first and at the last mast.
    """

    spans: Count
    span: Lengths
    height: Annotated[float, positive("m")]
    contact: Wire
    messenger: Wire
    droppers: Droppers | tuple[Droppers, ...]
    support: Annotated[float, positive("N/m")]
    steady_arm: SteadyArm = SteadyArm()
    stagger: Sides = 0.0
    messenger_stagger: Sides | None = None
    gravity: Annotated[float, positive("m/s²")] = 9.81
    ends: tuple[End, End] = (End(), End())

    @model_validator(mode="after")
    def _has_a_value_for_each_span(self) -> Line:
        for name, count, of in (("span", self.spans, "span"), ("droppers", self.spans, "span"),
                                ("stagger", self.spans + 1, "mast"), ("messenger_stagger", self.spans + 1, "mast")):
            value = getattr(self, name)
            if isinstance(value, tuple) and len(value) != count:
                raise ValueError(f"has {self.spans} spans, but {len(value)} values of {name}",
                                 f"give {count}, one for each {of}, or one value")
        if not any(span.droppers.at for span in self.each):
            raise ValueError("has no droppers", "give some in one of its spans")
        for k, span in enumerate(self.each):
            for j, x in enumerate(span.droppers.at):
                if not 0 < x < span.length:
                    raise ValueError(f"dropper {j + 1} of span {k + 1} must hang between its masts, from 0 to "
                                     f"{show(span.length, 'm')}, got {show(x, 'm')}",
                                     "count its place from the first mast of the span")
        if all(end.weights for end in self.ends):
            raise ValueError("has weights at both ends, and nothing holds its wires along the track",
                             "hold them at one end: a line with a fixed point in its middle is two lines")
        return self

    @model_validator(mode="after")
    def _hangs(self) -> Line:
        strings = self.strings
        names = [(k, j) for k, span in enumerate(self.formed) for j in range(len(span.droppers.at))]
        depths = np.concatenate([span.droppers.depths for span in self.formed])
        for at, (k, j) in enumerate(names):
            force, length = strings.forces[at], strings.distances[at]
            who = f"dropper {j + 1}" + f" of span {k + 1}" * (len(self.formed) > 1)
            if force <= 0:
                raise ValueError(f"{who} would have to push with {show(-force, 'N')} to bring the wire "
                                 f"{show(depths[at], 'm')} below the outer ones",
                                 "give a sag that the wire hangs in by its weight, or leave the dropper out")
            if length <= 0:
                below = self.height - strings.heights[at]
                raise ValueError(f"{who} would have the length {show(length, 'm')}: the messenger hangs "
                                 f"{show(below, 'm')} below its supports there",
                                 "raise height or the messenger's tension")
        return self

    @cached_property
    def masts(self) -> tuple[float, ...]:
        """Return the places of the masts, in m along the track."""
        if isinstance(self.span, tuple):
            return tuple(accumulate(self.span, initial=0.0))
        return tuple(mast * self.span for mast in range(self.spans + 1))

    @cached_property
    def each(self) -> tuple[Span, ...]:
        """Return the spans, one after the other."""
        lengths = self.span if isinstance(self.span, tuple) else (self.span,) * self.spans
        droppers = self.droppers if isinstance(self.droppers, tuple) else (self.droppers,) * self.spans
        return tuple(map(Span, droppers, self.masts, lengths))

    @cached_property
    def repeats(self) -> bool:
        """Return whether all spans are equal and symmetric, so that they repeat the form of one."""
        first = self.each[0]
        equal = all((span.length, span.droppers) == (first.length, first.droppers) for span in self.each)
        alternating = all(side == (-1) ** mast * sides[0] for sides in self.sides for mast, side in enumerate(sides))
        level = all(end.height is None for end in self.ends)
        return equal and alternating and level and first.is_symmetric

    @property
    def formed(self) -> tuple[Span, ...]:
        """Return the spans whose form is that of the line: the first one if the others repeat it, or all."""
        return self.each[:1] if self.repeats else self.each

    @cached_property
    def strings(self) -> AtRest:
        """Return the formed spans at rest with wires that do not bend."""
        return _at_rest(self)

    @cached_property
    def contact_shares(self) -> tuple[np.ndarray, np.ndarray]:
        """Return where the spans begin along the contact wire, and their lengths, see `shares`."""
        in_plane = np.tile(self.strings.contact_lengths, self.spans // len(self.formed))
        return shares(np.hypot(in_plane, np.diff(self.sides[0])))

    @cached_property
    def hanging(self) -> np.ndarray:
        """Return the mass that hangs from the messenger at each dropper of the formed spans, in kg: the dropper and
        its clamp.
        """
        own = by_dropper(self.formed, "mass") * self.strings.distances
        return np.asarray(by_dropper(self.formed, "messenger_clamp") + own)

    @cached_property
    def sides(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the offsets of contact wire and messenger across the track at the masts, in m."""
        upper = self.stagger if self.messenger_stagger is None else self.messenger_stagger
        contact, messenger = (each if isinstance(each, tuple) else
                              tuple((-1) ** mast * each for mast in range(self.spans + 1))
                              for each in (self.stagger, upper))
        return contact, messenger

    @property
    def planar(self) -> bool:
        """Return whether the line lies in the plane of the track."""
        return not any(map(any, self.sides))

    @property
    def length(self) -> float:
        """Return the length of all spans, in m."""
        return self.masts[-1]


def shares(lengths: Sequence[float] | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return where parts of these lengths begin and where the last one ends, (parts + 1,), and the lengths (parts,).

    All are over the first length: equal parts begin at whole numbers.
    """
    over = np.array(lengths) / lengths[0]
    return np.array([0.0, *accumulate(over.tolist())]), over


def by_dropper(spans: Sequence[Span], name: str) -> np.ndarray:
    """Return an attribute of the droppers of each span, for each of them."""
    return np.concatenate([np.full(len(span.droppers.at), getattr(span.droppers, name)) for span in spans])


def by_span(values: np.ndarray, spans: Sequence[Span]) -> list[np.ndarray]:
    """Return values of one dropper after the other by span."""
    return np.split(values, np.cumsum([len(span.droppers.at) for span in spans])[:-1])


def _at_rest(line: Line) -> AtRest:
    """Return spans at rest: the contact wire has the given depths at the droppers, and the given ends."""
    spans, contact, messenger = line.formed, line.contact, line.messenger
    length = spans[-1].start + spans[-1].length
    x = np.concatenate([span.start + np.array(span.droppers.at) for span in spans])
    depths = np.concatenate([span.droppers.depths for span in spans])
    gaps, to_ends = np.diff(x), (x[0], length - x[-1])
    outer = [(distance, 0.0) if end.height is None else (distance / 2, (end.height + depth) / distance)
             for end, distance, depth in zip(line.ends, to_ends, depths[[0, -1]], strict=True)]
    carried = np.append(outer[0][0], gaps / 2) + np.append(gaps / 2, outer[1][0])
    slopes = np.concatenate([[-outer[0][1]], -np.diff(depths) / gaps, [outer[1][1]]])
    forces = (line.gravity * (contact.mass * carried + by_dropper(spans, "contact_clamp"))
              - contact.tension * np.diff(slopes))
    own, distances = line.gravity * messenger.mass, np.full(len(x), line.height)
    for _ in range(3):  # the weight of the droppers, a small part, depends on their lengths
        loads = by_span(forces + line.gravity * (by_dropper(spans, "messenger_clamp")
                                                 + by_dropper(spans, "mass") * distances), spans)
        heights = line.height + np.concatenate([
            _deflection(span.length, messenger.tension, own, np.array(span.droppers.at), load, np.array(
                span.droppers.at)) for span, load in zip(spans, loads, strict=True)])
        distances = heights + depths
    lengths, anchors = [], [end.height for end in line.ends]
    points = (np.concatenate([[0.0] * (anchors[0] is not None), x, [length] * (anchors[1] is not None)]),
              np.concatenate([[-each for each in anchors[:1] if each is not None], depths,
                              [-each for each in anchors[1:] if each is not None]]))
    for span, load in zip(spans, loads, strict=True):
        fine = np.linspace(0, span.length, 4001)
        drawn = np.stack([
            _contact_shape(length, line.gravity * contact.mass / contact.tension / 2, *points, span.start + fine),
            _deflection(span.length, messenger.tension, own, np.array(span.droppers.at), load, fine)])
        lengths.append(np.hypot(fine[1], np.diff(drawn, axis=1)).sum(axis=1))
    return AtRest(forces, distances, heights, *np.transpose(lengths))


def _deflection(span: float, tension: float, own: float, x: np.ndarray, loads: np.ndarray,
                at: np.ndarray) -> np.ndarray:
    """Return the height of a string over its ends: own in N/m, its weight; loads in N, at x."""
    low, high = np.minimum.outer(at, x), np.maximum.outer(at, x)
    return np.asarray(-(own * at * (span - at) / 2 + (loads * low * (span - high)).sum(axis=1) / span) / tension)


def _contact_shape(span: float, bend: float, x: np.ndarray, depths: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return the height of the contact wire over that at the outer droppers: parabolas of curvature 2 bend (1/m)."""
    y = np.interp(at, x, -depths)
    k = np.clip(np.searchsorted(x, at), 1, max(len(x) - 1, 1))
    if len(x) > 1:
        y = np.where((at >= x[0]) & (at <= x[-1]), y - bend * (at - x[k - 1]) * (x[k] - at), y)
    y = np.where(at < x[0], -depths[0] - bend * (x[0] ** 2 - at**2), y)
    return np.asarray(np.where(at > x[-1], -depths[-1] - bend * ((span - x[-1]) ** 2 - (span - at) ** 2), y))
