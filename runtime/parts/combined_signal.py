"""Sums of signals, each times a number: components of a prescribed motion along turned axes."""

from __future__ import annotations

import cmath
from collections.abc import Sequence
from math import comb

import numpy as np

from .signal import DEGREE, Constant, Signal, Sine

ROUNDED = 1e-12
"""Of the largest term: what rounding may leave of a sum that is zero."""


class CombinedSignal(Signal):
    """The sum of ``factors`` times ``signals``, in code only; all sines among them have one frequency."""

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
    """Return the coefficients (n, 7) of polynomials of t as those of t - by; by: (n,)."""
    made = np.zeros(coefficients.shape)
    for power in range(DEGREE + 1):
        for lower in range(power + 1):
            made[:, lower] += coefficients[:, power] * comb(power, lower) * by ** (power - lower)
    return made


def combined(factors: Sequence[float], signals: Sequence[Signal]) -> Signal:
    """Return the sum of factors times signals, as simple as it is: 0 where all cancel but for rounding.

    Raises ValueError(cause) for sines of several frequencies, which no signal has.
    """
    factors, signals = zip(*[(f, s) for f, s in zip(factors, signals, strict=True) if f], strict=True)
    if all(isinstance(signal, Constant) for signal in signals):
        terms = [factor * signal.constant for factor, signal in zip(factors, signals, strict=True)
                 if isinstance(signal, Constant)]
        return Constant(constant=_rounded(sum(terms), max(map(abs, terms))))
    if len({signal.sine.angular_frequency for signal in signals if signal.sine.amplitude}) > 1:
        raise ValueError("is a sum of sines of several frequencies along the axes of the plane")
    moving = [(f, s) for f, s in zip(factors, signals, strict=True) if not _is_zero(s)]
    if len(moving) == 1 and moving[0][0] == 1.0:
        return moving[0][1]
    made = CombinedSignal(signals=tuple(s for _, s in moving), factors=tuple(f for f, _ in moving))
    return Constant(constant=0.0) if _vanishes(made) else made


def _rounded(value: float, largest: float) -> float:
    return 0.0 if abs(value) <= ROUNDED * largest else value


def _is_zero(signal: Signal) -> bool:
    return isinstance(signal, Constant) and signal.constant == 0.0


def _vanishes(made: CombinedSignal) -> bool:
    """Return whether the terms of a sum cancel each other at all times, but for rounding."""
    breaks, total = made.pieces()
    terms = [np.abs(factor * signal.value(breaks)).max() for factor, signal in zip(made.factors, made.signals,
                                                                                  strict=True)]
    sines = [abs(factor * signal.sine.amplitude) for factor, signal in zip(made.factors, made.signals, strict=True)]
    times = np.diff(breaks)[:, None] ** np.arange(DEGREE + 1)
    return bool(np.abs(total * times).max() <= ROUNDED * max(*terms, *sines)
                and made.sine.amplitude <= ROUNDED * max(*terms, *sines))
