"""A catenary of equal spans."""

from __future__ import annotations

from functools import cached_property
from typing import Annotated

import numpy as np
from pydantic import model_validator

from ..parts.part import Part
from ..parts.validation import Count, finite, positive, show
from .strings import AtRest, at_rest
from .wires import Droppers, SteadyArm, Wire

EVEN = 1e-9
"""Of the span: by how much droppers and their mirror images may differ."""


class Line(Part):
    """A catenary: equal spans of a contact wire that hangs by droppers from a messenger.

    spans: how many; span: the length of each, in m; height: from the contact wire at the outer droppers up to the
    messenger at the masts, at rest, in m; support: the vertical stiffness of the messenger's supports, in N/m. stagger:
    where the contact wire is held across the track (z) at the first mast, in m, and on the other side at every second
    one; messenger_stagger: the messenger likewise, as the contact wire if not given. Without staggers the line is
    planar.
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
        self._check_symmetry()
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

    def _check_symmetry(self) -> None:
        """Raise ValueError where the droppers of a span are not those of its mirror image."""
        for name, values in (("places", self.droppers.at), ("sag", tuple(self.droppers.depths))):
            mirrored = np.array(values[::-1]) if name == "sag" else self.span - np.array(values[::-1])
            if np.abs(values - mirrored).max() > EVEN * self.span:
                k = int(np.argmax(np.abs(values - mirrored)))
                raise ValueError(f"droppers must be symmetric about the middle of the span: the {name} of dropper "
                                 f"{k + 1} is {show(float(values[k]), 'm')}, that of its mirror image "
                                 f"{show(float(mirrored[k]), 'm')}", "one span is formed, and the others by symmetry")

    @cached_property
    def strings(self) -> AtRest:
        """Return a span at rest with wires that do not bend."""
        return at_rest(self.span, self.height, self.contact, self.messenger, self.droppers, self.gravity)

    @cached_property
    def hanging(self) -> tuple[float, ...]:
        """Return what hangs from the messenger at each dropper, in kg: the dropper and its clamp."""
        return tuple((self.droppers.messenger_clamp + self.droppers.mass * self.strings.distances).tolist())

    @property
    def staggers(self) -> tuple[float, float]:
        """Return where contact wire and messenger are at the first mast across the track, in m."""
        return self.stagger, self.stagger if self.messenger_stagger is None else self.messenger_stagger

    @property
    def planar(self) -> bool:
        """Return whether the line lies in the plane of the track."""
        return not any(self.staggers)

    @property
    def length(self) -> float:
        """Return the length of all spans, in m."""
        return self.spans * self.span
