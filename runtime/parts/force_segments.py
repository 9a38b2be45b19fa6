"""Springs with piecewise linear tension: tension only, free play, tables."""

from collections.abc import Sequence
from typing import Annotated

import numpy as np
from pydantic import model_validator

from ..base.deferred import dataclass
from .part import Part
from .validation import check_function, list_of, show

PUSHES_ALONE, PULLS_AND_PUSHES, PULLS_ALONE, HAS_NO_FORCE = -1, 0, 1, 2
"""Signs of the force of a linear segment, as in runtime/engine/couplings/force/force.h."""


class ForceTable(Part):
    """Tension of a spring by its extension, with straight lines between the values and beyond them.

    extension: m
    tension: N, one for each extension

    >>> import funicular as fu
    >>> fu.ForceTable(extension=[0, 0.1, 0.2], tension=[0, 10, 40]).tension
    (0.0, 10.0, 40.0)
    """

    extension: Annotated[tuple[float, ...], list_of("m", least=2)]
    tension: Annotated[tuple[float, ...], list_of("N", least=2)]

    @model_validator(mode="after")
    def _is_a_function(self) -> "ForceTable":
        check_function(self.extension, "extension", "m", self.tension, "tension")
        steps = np.diff(self.extension)
        if not steps.min() > 1e-12 * (1 + np.abs(self.extension).max()):
            k = int(np.argmin(steps))
            raise ValueError(f"extension must increase by more than rounding, got {show(self.extension[k + 1], 'm')} "
                             f"after {show(self.extension[k], 'm')}")
        return self


@dataclass(frozen=True)
class Segment:
    """A linear segment up to the extension ``end`` (m): ``tension`` (N) at ``at`` (m), of slope ``stiffness`` (N/m).

    sense: signs of its force; energy: at ``at``, in J.
    """

    end: float
    at: float
    tension: float
    stiffness: float
    sense: int = PULLS_AND_PUSHES
    energy: float = 0.0


def pulling(start: float, stiffness: float) -> list[Segment]:
    """Return the segments of a spring without force up to an extension, and with tension beyond it."""
    return [Segment(start, start, 0.0, 0.0, HAS_NO_FORCE), Segment(np.inf, start, 0.0, stiffness, PULLS_ALONE)]


def with_play(play: float, stiffness: float) -> list[Segment]:
    """Return the segments of a spring without force over the length ``play`` (m) about zero extension."""
    half = play / 2
    return [Segment(-half, -half, 0.0, stiffness, PUSHES_ALONE), *pulling(half, stiffness)]


def tabulated(table: ForceTable, pulls_alone: bool) -> list[Segment]:
    """Return the segments of a table; pulls_alone: without its compression.

    Raises ValueError for a table without compression that has no tension, or loses it with extension.
    """
    x, T = np.array(table.extension), np.array(table.tension)
    slopes = np.diff(T) / np.diff(x)
    ends = [*x[1:-1], np.inf]
    segments = [Segment(end, at, tension, slope) for end, at, tension, slope in zip(ends, x, T, slopes, strict=False)]
    if not pulls_alone:
        return _with_energies(segments)
    if slopes[-1] < 0 or not (T[-1] > 0 or slopes[-1] > 0):
        raise ValueError("with tension_only, a table must have tension at large extensions",
                         "give a last segment with positive, not decreasing tension")
    start = _loses_force(x, T, slopes)
    taut = [Segment(p.end, max(p.at, start), p.tension + p.stiffness * max(start - p.at, 0.0), p.stiffness, PULLS_ALONE)
            for p in segments if p.end > start]
    return _with_energies([Segment(start, start, 0.0, 0.0, HAS_NO_FORCE), *taut])


def _loses_force(x: np.ndarray, T: np.ndarray, slopes: np.ndarray) -> float:
    """Return the extension at which the tension of a table begins."""
    if T[0] > 0:
        if slopes[0] <= 0:
            raise ValueError("with tension_only, a table must have no tension at small extensions",
                             "let it begin with zero tension")
        return float(x[0] - T[0] / slopes[0])
    last = int(np.flatnonzero(T <= 0)[-1])
    if np.any(T[:last] > 0):
        raise ValueError("with tension_only, a table must not lose its tension as it is extended",
                         "give tensions that stay positive")
    return float(x[last] - T[last] / slopes[min(last, len(slopes) - 1)])


def _with_energies(segments: Sequence[Segment]) -> list[Segment]:
    """Return the segments with their energies; that of a table is zero at zero extension."""
    at = [p.at for p in segments]
    rises = [p.tension * (b - p.at) + p.stiffness * (b - p.at) ** 2 / 2
             for p, b in zip(segments[:-1], at[1:], strict=True)]
    energies = np.cumsum([0.0, *rises])
    if segments[0].sense == PULLS_AND_PUSHES:
        k = int(np.searchsorted([p.end for p in segments[:-1]], 0.0))
        energies -= energies[k] + segments[k].tension * -at[k] + segments[k].stiffness * at[k] ** 2 / 2
    return [Segment(p.end, p.at, p.tension, p.stiffness, p.sense, float(energy))
            for p, energy in zip(segments, energies, strict=True)]
