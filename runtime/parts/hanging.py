"""The catenary: the shape of a hanging cable without stretch and bending stiffness."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from .validation import show

MIN_WIDTH = 1e-3
"""Of the span across gravity, over the chord."""
MIN_SLACK = 1e-9
"""Of a hanging cable: its length beyond the chord, over the chord."""


def hangs(span: float, length: float) -> bool:
    """Return whether a cable of a length hangs over a span, both in m."""
    return length > (1 + MIN_SLACK) * span


def catenary(start: Sequence[float], end: Sequence[float], length: float,
             gravity: Sequence[float]) -> Callable[[float], np.ndarray]:
    """Return the curve (3,) in m over u from 0 to 1, between two points (m), of a length (m), under gravity (m/s²).

    y = a cosh(x / a) above the lowest point, with sinh(h) / h = sqrt(length² - rise²) / width, h = width / (2 a), and
    the lowest point at width / 2 - a artanh(rise / length) from the start.

    Raises ValueError(cause, remedy) without gravity, for a vertical span, and for a length below the span.
    """
    chord, g = np.subtract(end, start), np.array(gravity, dtype=float)
    span, pull = float(np.linalg.norm(chord)), float(np.linalg.norm(g))
    if not pull > 0:
        raise ValueError("cannot hang without gravity", 'give the scene gravity, or leave shape="hanging" out')
    if not hangs(span, length):
        raise ValueError(f"hangs only where rest_length is above the distance of its ends, {show(span, 'm')}, got "
                         f"{show(length, 'm')}", 'give a longer rest_length, or leave shape="hanging" out')
    up = -g / pull
    rise = float(chord @ up)
    across = chord - rise * up
    width = float(np.linalg.norm(across))
    if not width > MIN_WIDTH * span:
        raise ValueError(f"cannot hang as a catenary: its end is above or below its start, {show(width, 'm')} beside "
                         "it", "move an end aside, or draw it through points")
    along = across / width
    a = 0.5 * width / _parameter(np.sqrt(length**2 - rise**2) / width)
    lowest = 0.5 * width - a * np.arctanh(rise / length)
    begin = np.sinh(-lowest / a)

    def point(u: float) -> np.ndarray:
        """Return the point (3,) at u; the ends are exact."""
        if u in (0.0, 1.0):
            return np.array(end if u else start, dtype=float)
        slope = begin + u * length / a
        x = lowest + a * np.arcsinh(slope)
        y = a * (np.hypot(1, slope) - np.hypot(1, begin))
        return np.array(start) + x * along + y * up

    return point


def _parameter(ratio: float) -> float:
    """Return x > 0 of sinh(x) / x = ratio > 1, by Newton's method on the convex log(sinh(x) / x)."""
    x = float(np.sqrt(6 * (ratio - 1))) if ratio < 3 else float(np.log(2 * ratio) + np.log(np.log(2 * ratio)))
    for _ in range(100):
        if x < 1e-2:
            value, slope = x * x / 6 - x**4 / 180, x / 3 - x**3 / 45
        else:
            value = x + np.log(-np.expm1(-2 * x) / 2) - np.log(x)
            slope = 1 / np.tanh(x) - 1 / x
        step = (value - np.log(ratio)) / slope
        x -= step
        if abs(step) <= 1e-15 * x:
            break
    return x
