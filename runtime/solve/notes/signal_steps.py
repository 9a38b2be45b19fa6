"""Signals that change too fast for a fixed step, which no error control shortens."""

from __future__ import annotations

import numpy as np

from ...model.breakpoints import of_polynomials
from ...parts.scene_data import SceneData
from ...parts.settings import RunSettings
from ...parts.signal import Constant, Integral, Signal, signals_of
from ...parts.validation import show

MIN_STEPS_PER_PERIOD = 8
"""Smallest number of steps that resolve a sine; the trapezoidal rule then errs by 5 % of its integral."""
RESOLVED_STEPS = 20
"""Steps per period, or per shortest segment of a signal, above which the integral needs no check."""
INTEGRAL_ERROR_LIMIT = 0.05
"""Error of the trapezoidal rule that a note reports, as a fraction of the integral of the variation."""


def unresolved(scene: SceneData, settings: RunSettings) -> list[str]:
    """Return a message for each signal that changes too fast for a fixed step; none where tol chooses the steps."""
    step = settings.step_taken
    if step is None:
        return []
    found = []
    for where, signal in ((part.where, signal) for part in scene.parts() for _, signal in signals_of(part)):
        if isinstance(signal, Constant):
            continue
        rate = signal.sine.angular_frequency / (2 * np.pi) if signal.sine.amplitude else 0.0
        if rate * step * MIN_STEPS_PER_PERIOD > 1:
            found.append(f"{where}: its sine has a period of {show(1 / rate, 's')}, and the fixed step is "
                         f"{show(step, 's')}: the steps do not follow it. Take a step of "
                         f"{show(1 / (RESOLVED_STEPS * rate), 's')} or less, or none, so that tol chooses it")
        elif (error := _error_of_integral(signal, step, settings)) > INTEGRAL_ERROR_LIMIT:
            found.append(f"{where}: the fixed step of {show(step, 's')} is too long for its signal, whose integral "
                         f"over time it misses by {error:.2g} of its size. Take a smaller step, or none, so that tol "
                         "chooses it")
    return found


def _error_of_integral(signal: Signal, step: float, settings: RunSettings) -> float:
    """Return the error of the trapezoidal rule on the steps of a run, over the variation of a signal's integral."""
    breaks, coefficients = signal.pieces()
    inner = breaks[(breaks > 0) & (breaks < settings.duration)]
    if np.diff(inner, prepend=0.0, append=settings.duration).min() > RESOLVED_STEPS * step:
        return 0.0
    found = of_polynomials(breaks, coefficients, False, settings.tol)
    breakpoints = [time for time, _ in found if 0 < time < settings.duration]
    times = np.union1d(np.arange(0.0, settings.duration, step), [*breakpoints, settings.duration])
    values, exact = signal.value(times), Integral(rate=signal).value(times)
    sums = np.cumsum(np.diff(times) * (values[1:] + values[:-1]) / 2)
    varying = exact - exact[-1] * times / times[-1]
    scale = np.abs(varying).max()
    return float(np.abs(sums - exact[1:]).max() / scale) if scale > 0 else 0.0
