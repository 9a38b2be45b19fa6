"""The line at rest with wires that do not bend: in closed form, and where the search for its form begins."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .line import Line


@dataclass(frozen=True)
class AtRest:
    """A span of strings: forces of the droppers (N), distances of their ends (m), the messenger's heights there (m),
    the lengths of both wires along their shapes (m), and the force of a mast on the messenger (N), from both sides.
    """

    forces: np.ndarray
    distances: np.ndarray
    heights: np.ndarray
    contact_length: float
    messenger_length: float
    mast_force: float


def at_rest(line: Line) -> AtRest:
    """Return the span at rest: the contact wire has the given depths at the droppers, and is level at the masts."""
    x, depths, droppers = np.array(line.droppers.at), line.droppers.depths, line.droppers
    gaps = np.diff(x)
    carried = np.concatenate([[x[0]], gaps / 2, [0]])[:-1] + np.concatenate([gaps / 2, [line.span - x[-1]]])
    slopes = np.concatenate([[0.0], -np.diff(depths) / gaps, [0.0]])
    forces = line.gravity * (line.contact.mass * carried + droppers.contact_clamp) - line.contact.tension * np.diff(slopes)
    distances = np.full(len(x), line.height)
    for _ in range(3):  # the droppers' own weight depends on their lengths: a small part of the whole
        loads = forces + line.gravity * (droppers.messenger_clamp + droppers.mass * distances)
        heights = line.height + _deflection(line, x, loads, x)
        distances = heights + depths
    fine = np.linspace(0, line.span, 4001)
    drawn = np.stack([_contact_shape(line, x, depths, fine), _deflection(line, x, loads, fine)])
    lengths = np.hypot(fine[1], np.diff(drawn, axis=1)).sum(axis=1)
    mast = line.gravity * line.messenger.mass * line.span + float(loads.sum())
    return AtRest(forces, distances, heights, float(lengths[0]), float(lengths[1]), mast)


def _deflection(line: Line, x: np.ndarray, loads: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return the height of the messenger over its supports under its weight and these loads."""
    own = line.gravity * line.messenger.mass * at * (line.span - at) / 2
    low, high = np.minimum.outer(at, x), np.maximum.outer(at, x)
    return -(own + (loads * low * (line.span - high)).sum(axis=1) / line.span) / line.messenger.tension


def _contact_shape(line: Line, x: np.ndarray, depths: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return the height of the contact wire over that at the outer droppers: parabolas between the droppers."""
    bend = line.gravity * line.contact.mass / line.contact.tension / 2
    y = np.interp(at, x, -depths)
    k = np.clip(np.searchsorted(x, at), 1, max(len(x) - 1, 1))
    if len(x) > 1:
        y = np.where((at >= x[0]) & (at <= x[-1]), y - bend * (at - x[k - 1]) * (x[k] - at), y)
    y = np.where(at < x[0], -depths[0] - bend * (x[0] ** 2 - at**2), y)
    return np.where(at > x[-1], -depths[-1] - bend * ((line.span - x[-1]) ** 2 - (line.span - at) ** 2), y)
