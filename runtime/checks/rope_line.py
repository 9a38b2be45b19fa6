"""Ropes as drawn, in the words of cables along which slides run."""

from __future__ import annotations

import numpy as np

from ..base.deferred import dataclass
from ..parts.rope import Rope
from ..parts.rope_route import DrawnRoute
from ..parts.scene_data import SceneData
from ..parts.validation import LENGTH_TOLERANCE


@dataclass(frozen=True)
class RopeLine:
    """The straight spans of a rope as drawn: a slide is in one of them."""

    rope: Rope
    route: DrawnRoute

    @property
    def where(self) -> str:
        """Return its name in messages."""
        return self.rope.where

    @property
    def length(self) -> float:
        """Return the stress-free length of the rope, without what is wound on drums, m."""
        return self.route.free_length

    @property
    def _ends(self) -> np.ndarray:
        """Return (spans, 2): the stress-free arc-lengths of the ends of its spans, m."""
        return np.array(self.route.arc_lengths(self.rope.first_arc_length))

    @property
    def _chords(self) -> tuple[np.ndarray, np.ndarray]:
        """Return (spans, 3) each: the starts of its spans, and their chords, m."""
        found = np.zeros((2, len(self.route.spans), 3))
        found[0, :, : self.rope.dim] = [span.start for span in self.route.spans]
        found[1, :, : self.rope.dim] = [span.end - span.start for span in self.route.spans]
        return found[0], found[1]

    def slope(self, s: float) -> np.ndarray:
        """Return (3,): the derivative of the place by the stress-free arc-length, in the span that has s, m."""
        span = self.rope.span_at(self.route, s)
        slope: np.ndarray = self._chords[1][span] / np.diff(self._ends[span])
        return slope

    def point(self, s: float) -> np.ndarray:
        """Return (3,): the place of the stress-free arc-length s, m, in a span."""
        span = self.rope.span_at(self.route, s)
        point: np.ndarray = self._chords[0][span] + (s - self._ends[span, 0]) * self.slope(s)
        return point

    def points_at(self, s: np.ndarray) -> np.ndarray:
        """Return (n, 3): the places of stress-free arc-lengths (n,), m."""
        return np.array([self.point(float(each)) for each in s]).reshape(-1, 3)

    def nearest_s(self, point: np.ndarray) -> np.ndarray:
        """Return (n,): the stress-free arc-lengths, m, nearest to a point (3,) in each span, the nearest first."""
        starts, chords = self._chords
        share = np.sum((point - starts) * chords, axis=1) / np.sum(chords**2, axis=1)
        share = np.clip(share, LENGTH_TOLERANCE, 1 - LENGTH_TOLERANCE)
        gaps = np.linalg.norm(starts + share[:, None] * chords - point, axis=1)
        first, last = self._ends.T
        found: np.ndarray = (first + share * (last - first))[np.argsort(gaps, kind="stable")]
        return found


def rope_line(scene: SceneData, name: str) -> RopeLine:
    """Return a rope of a scene as drawn. Raises ValueError for an impossible route."""
    rope = scene.ropes[name]
    return RopeLine(rope, scene.route_of(rope))
