"""The line at rest with wires that do not bend: in closed form, and where the search for its form begins."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .wires import Droppers, Wire


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


def at_rest(span: float, height: float, contact: Wire, messenger: Wire, droppers: Droppers, gravity: float) -> AtRest:
    """Return a span at rest: the contact wire has the given depths at the droppers, and is level at the masts."""
    x, depths = np.array(droppers.at), droppers.depths
    gaps = np.diff(x)
    carried = np.append(x[0], gaps / 2) + np.append(gaps / 2, span - x[-1])
    slopes = np.concatenate([[0.0], -np.diff(depths) / gaps, [0.0]])
    forces = gravity * (contact.mass * carried + droppers.contact_clamp) - contact.tension * np.diff(slopes)
    own, distances = gravity * messenger.mass, np.full(len(x), height)
    for _ in range(3):  # the droppers' own weight depends on their lengths: a small part of the whole
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
    return -(own * at * (span - at) / 2 + (loads * low * (span - high)).sum(axis=1) / span) / tension


def _contact_shape(span: float, bend: float, x: np.ndarray, depths: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return the height of the contact wire over that at the outer droppers: parabolas of curvature 2 bend (1/m)."""
    y = np.interp(at, x, -depths)
    k = np.clip(np.searchsorted(x, at), 1, max(len(x) - 1, 1))
    if len(x) > 1:
        y = np.where((at >= x[0]) & (at <= x[-1]), y - bend * (at - x[k - 1]) * (x[k] - at), y)
    y = np.where(at < x[0], -depths[0] - bend * (x[0] ** 2 - at**2), y)
    return np.where(at > x[-1], -depths[-1] - bend * ((span - x[-1]) ** 2 - (span - at) ** 2), y)
