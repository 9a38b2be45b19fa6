"""Linear combinations of signals: components of a prescribed motion along turned axes."""

from __future__ import annotations

import cmath
from collections.abc import Sequence
from math import comb

import numpy as np

from .signal import DEGREE, Constant, Signal, Sine

CANCELLATION_TOLERANCE = 1e-12
"""Of the largest term: rounding of a sum that is zero."""


class CombinedSignal(Signal):
    """The sum of ``factors`` times ``signals``, whose sines have one frequency; only in code."""

    form = "combined"
    signals: tuple[Signal, ...]
    factors: tuple[float, ...]

    def pieces(self) -> tuple[np.ndarray, np.ndarray]:
        """Return its polynomials between the breaks of all its signals, see `Signal.pieces`."""
        given = [(factor, *signal.pieces()) for factor, signal in zip(self.factors, self.signals, strict=True)]
        inner = [breaks for _, breaks, coefficients in given if len(coefficients) > 1]
        breaks = np.unique(np.concatenate(inner)) if inner else given[0][1]
        total = np.zeros((len(breaks) - 1, DEGREE + 1))
        middle = (breaks[1:] + breaks[:-1]) / 2
        for factor, own, coefficients in given:
            piece = np.clip(np.searchsorted(own, middle, side="right") - 1, 0, len(coefficients) - 1)
            total += factor * _shifted(coefficients[piece], breaks[:-1] - own[piece])
        return breaks, total

    @property
    def sine(self) -> Sine:
        """Return the sum of the sines, added as complex amplitudes."""
        sines = [(factor, signal.sine) for factor, signal in zip(self.factors, self.signals, strict=True)]
        total = sum((factor * sine.amplitude * cmath.exp(1j * sine.phase) for factor, sine in sines), 0j)
        return Sine(abs(total), next((sine.angular_frequency for _, sine in sines if sine.amplitude), 0.0),
                    cmath.phase(total))


def _shifted(coefficients: np.ndarray, by: np.ndarray) -> np.ndarray:
    """Return the coefficients (n, 7) of polynomials of t as polynomials of t - by, by (n,)."""
    made = np.zeros(coefficients.shape)
    for power in range(DEGREE + 1):
        for lower in range(power + 1):
            made[:, lower] += coefficients[:, power] * comb(power, lower) * by ** (power - lower)
    return made


def combined(factors: Sequence[float], signals: Sequence[Signal]) -> Signal:
    """Return the sum of factors times signals in its simplest form: 0 where all terms cancel to rounding.

    Raises ValueError(cause) for sines of several frequencies.
    """
    if len({signal.sine.angular_frequency for signal in signals if signal.sine.amplitude}) > 1:
        raise ValueError("is a sum of sines of several frequencies along the axes of the plane")
    terms = [(f, s) for f, s in zip(factors, signals, strict=True) if f and s != Constant(constant=0.0)]
    constants = [factor * signal.constant for factor, signal in terms if isinstance(signal, Constant)]
    if len(constants) == len(terms):
        total = sum(constants)
        is_zero = abs(total) <= CANCELLATION_TOLERANCE * max(map(abs, constants), default=0.0)
        return Constant(constant=0.0 if is_zero else total)
    if len(terms) == 1 and terms[0][0] == 1.0:
        return terms[0][1]
    made = CombinedSignal(signals=tuple(s for _, s in terms), factors=tuple(f for f, _ in terms))
    return Constant(constant=0.0) if _vanishes(made) else made


def _vanishes(made: CombinedSignal) -> bool:
    """Return whether the terms of a sum cancel at all times to rounding."""
    breaks, total = made.pieces()
    terms = [abs(factor) * max(np.abs(signal.value(breaks)).max(), abs(signal.sine.amplitude))
             for factor, signal in zip(made.factors, made.signals, strict=True)]
    times = np.diff(breaks)[:, None] ** np.arange(DEGREE + 1)
    return bool(max(np.abs(total * times).max(), made.sine.amplitude) <= CANCELLATION_TOLERANCE * max(terms))
