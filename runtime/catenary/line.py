"""A catenary of equal spans, and its state of rest with wires that do not bend, in closed form."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

import numpy as np
from pydantic import model_validator

from ..parts.part import Part
from ..parts.validation import Count, finite, positive, show
from .wires import Droppers, SteadyArm, Wire

SYMMETRY_TOLERANCE = 1e-9
"""Part of the span by which droppers and their mirror images may differ."""

@dataclass(frozen=True)
class AtRest:
    """A span of strings: forces of the droppers (N), distances of their ends (m), the messenger's heights there (m),
    and the lengths of both wires along their shapes (m).
    """

    forces: np.ndarray
    distances: np.ndarray
    heights: np.ndarray
    contact_length: float
    messenger_length: float


class Line(Part):
    """A catenary: equal spans of a contact wire that hangs by droppers from a messenger.

    spans: their number; span: the length of each, in m; height: from the contact wire at the outer droppers up to the
    messenger at the masts, at rest, in m; support: the vertical stiffness of the messenger's supports, in N/m. stagger:
    the offset of the contact wire across the track (z) at the first mast, in m, with alternating sides;
    messenger_stagger: that of the messenger, as the contact wire if not given. Without staggers the line is planar.
    """

    spans: Count
    span: Annotated[float, positive("m")]
    height: Annotated[float, positive("m")]
    contact: Wire
    messenger: Wire
    droppers: Droppers
    support: Annotated[float, positive("N/m")]
    steady_arm: SteadyArm = SteadyArm()
    stagger: Annotated[float, finite("m")] = 0.0
    messenger_stagger: Annotated[float, finite("m")] | None = None
    gravity: Annotated[float, positive("m/s²")] = 9.81

    @model_validator(mode="after")
    def _hangs(self) -> Line:
        first, last = self.droppers.at[0], self.droppers.at[-1]
        if first <= 0 or last >= self.span:
            wrong = first if first <= 0 else last
            raise ValueError(f"droppers must hang between the masts, from 0 to {show(self.span, 'm')}, got one at "
                             f"{show(wrong, 'm')}")
        for name, values, mirrored in (
                ("places", np.array(self.droppers.at), self.span - np.array(self.droppers.at[::-1])),
                ("sag", self.droppers.depths, self.droppers.depths[::-1])):
            k = int(np.argmax(np.abs(values - mirrored)))
            if abs(values[k] - mirrored[k]) > SYMMETRY_TOLERANCE * self.span:
                raise ValueError(f"droppers must be symmetric about the middle of the span: the {name} of dropper "
                                 f"{k + 1} is {show(float(values[k]), 'm')}, that of its mirror image "
                                 f"{show(float(mirrored[k]), 'm')}", "one span is formed, and the others by symmetry")
        strings = self.strings
        for k, (force, length) in enumerate(zip(strings.forces, strings.distances, strict=True)):
            if force <= 0:
                raise ValueError(f"dropper {k + 1} would have to push with {show(-force, 'N')} to bring the wire "
                                 f"{show(self.droppers.depths[k], 'm')} below the outer ones",
                                 "give a sag that the wire hangs in by its weight, or leave the dropper out")
            if length <= 0:
                below = self.height - strings.heights[k]
                raise ValueError(f"dropper {k + 1} would have the length {show(length, 'm')}: the messenger hangs "
                                 f"{show(below, 'm')} below its supports there",
                                 "raise height or the messenger's tension")
        return self

    @cached_property
    def strings(self) -> AtRest:
        """Return a span at rest with wires that do not bend."""
        return _at_rest(self.span, self.height, self.contact, self.messenger, self.droppers, self.gravity)

    @cached_property
    def hanging(self) -> tuple[float, ...]:
        """Return the mass that hangs from the messenger at each dropper, in kg: the dropper and its clamp."""
        return tuple((self.droppers.messenger_clamp + self.droppers.mass * self.strings.distances).tolist())

    @property
    def staggers(self) -> tuple[float, float]:
        """Return the offsets of contact wire and messenger across the track at the first mast, in m."""
        return self.stagger, self.stagger if self.messenger_stagger is None else self.messenger_stagger

    @property
    def planar(self) -> bool:
        """Return whether the line lies in the plane of the track."""
        return not any(self.staggers)

    @property
    def length(self) -> float:
        """Return the length of all spans, in m."""
        return self.spans * self.span


def _at_rest(span: float, height: float, contact: Wire, messenger: Wire, droppers: Droppers, gravity: float) -> AtRest:
    """Return a span at rest: the contact wire has the given depths at the droppers, and is level at the masts."""
    x, depths = np.array(droppers.at), droppers.depths
    gaps = np.diff(x)
    carried = np.append(x[0], gaps / 2) + np.append(gaps / 2, span - x[-1])
    slopes = np.concatenate([[0.0], -np.diff(depths) / gaps, [0.0]])
    forces = gravity * (contact.mass * carried + droppers.contact_clamp) - contact.tension * np.diff(slopes)
    own, distances = gravity * messenger.mass, np.full(len(x), height)
    for _ in range(3):  # the weight of the droppers, a small part, depends on their lengths
        loads = forces + gravity * (droppers.messenger_clamp + droppers.mass * distances)
        heights = height + _deflection(span, messenger.tension, own, x, loads, x)
        distances = heights + depths
    fine = np.linspace(0, span, 4001)
    drawn = np.stack([_contact_shape(span, gravity * contact.mass / contact.tension / 2, x, depths, fine),
                      _deflection(span, messenger.tension, own, x, loads, fine)])
    lengths = np.hypot(fine[1], np.diff(drawn, axis=1)).sum(axis=1)
    return AtRest(forces, distances, heights, float(lengths[0]), float(lengths[1]))


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
