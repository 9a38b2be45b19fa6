"""Breakpoints of signals: instants at which a signal is not smooth, where integration steps end.

A piecewise polynomial has a breakpoint where two pieces meet. In a step over a breakpoint, neither the result nor the
error estimate has the order of the method, and a pulse shorter than the step is missed. Negligible breakpoints are
omitted, so that a table of many samples of a smooth function does not limit the steps. With steps chosen by tol,
extremes of tables are breakpoints, too: a smooth pulse is short beside the steps of a scene at rest.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from ..parts.fluid import Fluid
from .loads import LoadModel
from .model import Model
from .signals import SignalModel

HIGHER, ACCELERATION, RATE = range(3)
"""What jumps at a breakpoint: a higher derivative, the acceleration or the rate of a driven motion; as in
engine/bodies/motions.h."""

WAVE_PART = 0.25
"""Of the shortest period: the longest step."""
SIGNAL_ROUNDING = 1e-14
"""Rounding of the difference of two pieces, as a fraction of the largest value of the signal."""
MIN_SIGNAL_RANGE = 1e-300
"""Positive bound for signals that are constant."""
INSTANT_TOLERANCE = 1e-12
"""Distance of coincident breakpoints, as a fraction of the duration (engine/equations/run.h)."""


def breakpoints(model: Model, duration: float, tol: float, turns: bool = True, nodes: bool = True
                ) -> tuple[np.ndarray, np.ndarray]:
    """Return the times of the significant breakpoints, in s, increasing, and what jumps at each.

    turns: whether extremes of tables are included; nodes: whether the passages of nodes by moving loads are, where the
    second derivative of a generalised force jumps, which a method of order 2 does not notice. A breakpoint at the end
    of the run is included: the last row is of the instant before it.
    """
    driving, inertial = driving_signals(model), {drag.signal for drag in model.drags if drag.has_inertia}
    found = [each for number, signal in enumerate(model.signals)
             for each in _of_signal(signal, number in driving, number in inertial, tol)]
    if model.drags:
        found += _of_tables(model) + (_of_waves(model, duration) if turns else [])
    found += _of_moving_loads(model, duration, nodes)
    if turns:
        found += [each for signal in model.signals for each in _turns(signal.breaks, signal.coefficients[:, 0], tol)
                  if each[0] < (1 - INSTANT_TOLERANCE) * duration]
    found = [each for each in found if INSTANT_TOLERANCE < each[0] / duration < 1 + INSTANT_TOLERANCE]
    times: list[float] = []
    jumps: list[float] = []
    for time, jump in sorted(found):
        if times and time - times[-1] <= INSTANT_TOLERANCE * duration:
            times[-1], jumps[-1] = time, max(jump, jumps[-1])
        else:
            times.append(time)
            jumps.append(jump)
    return np.array(times), np.array(jumps, dtype=int)


def driving_signals(model: Model) -> set[int]:
    """Return the numbers of the signals that prescribe motions; the others scale loads."""
    return {motion.signal for motion in model.motions} | {coupling.drive for coupling in model.couplings}


def _of_moving_loads(model: Model, duration: float, nodes: bool) -> list[tuple[float, int]]:
    """Return the times at which moving loads come on their cables and leave them, and pass their nodes."""
    found = []
    for load in (each for each in model.couplings if isinstance(each, LoadModel)):
        if load.presence >= 0:
            found += [(float(time), ACCELERATION) for time in model.signals[load.presence].breaks[1:-1]]
        if load.place >= 0 and nodes:
            levels = model.cables[load.on.cable].mesh.boundaries[1:-1] - load.x
            found += [(float(time), HIGHER) for time in model.signals[load.place].times_at(levels, duration)]
    return found


def _of_tables(model: Model) -> list[tuple[float, int]]:
    """Return the times of the tables of fluids, between which a gust may be shorter than a step.

    With linear interpolation the acceleration of the fluid jumps there, a force where added mass counts.
    """
    kinds = {id(drag.fluid): (drag.fluid.table, ACCELERATION if drag.has_inertia and drag.degree == 1 else HIGHER)
             for drag in model.drags if drag.fluid.table is not None}
    return [(float(time), kind) for table, kind in kinds.values() for time in table.grid.axes.get("time", ())]


def _of_waves(model: Model, duration: float) -> list[tuple[float, int]]:
    """Return times so near to each other that no step goes over a wave."""
    step = longest_step_in_waves(drag.fluid for drag in model.drags if drag.entries["n_waves"])
    return [(float(time), HIGHER) for time in step * np.arange(1, math.ceil(duration / step))]


def longest_step_in_waves(fluids: Iterable[Fluid]) -> float:
    """Return a quarter of the shortest period of the waves of fluids, s; infinite without waves."""
    return WAVE_PART * min((wave.period for fluid in fluids for wave in fluid.waves or ()), default=math.inf)


def _of_signal(signal: SignalModel, drives: bool, accelerates: bool, tol: float) -> list[tuple[float, int]]:
    """Return `of_polynomials` of a signal; accelerates: whether its rate is a force, as of a fluid with added mass."""
    found = of_polynomials(signal.breaks, signal.coefficients, drives or accelerates, tol)
    return found if drives else [(time, min(jump, ACCELERATION)) for time, jump in found]


def of_polynomials(breaks: np.ndarray, coefficients: np.ndarray, drives: bool, tol: float) -> list[tuple[float, int]]:
    """Return the time and the jump of each significant breakpoint of a piecewise polynomial.

    A breakpoint is significant where the pieces on both sides, continued over the length of the shorter one, differ by
    more than tol of the signal, or in their rates if the signal prescribes a motion. A step does not notice a jump of
    the rate, and such errors add up: the sum of the jumps omitted is at most tol of the rate.
    """
    if len(coefficients) < 2:
        return []
    length = np.diff(breaks)[:, None]
    powers = np.arange(coefficients.shape[1])
    at_end = np.array([[math.comb(n, k) for k in powers] for n in powers])  # 0 where k > n
    ends = (coefficients * length**powers) @ at_end / length**powers  # coefficients of each piece about its end
    jumps = np.abs(coefficients[1:] - ends[:-1])
    over = np.minimum(length[:-1], length[1:])
    values = coefficients[1:, 0]
    parting = jumps * over**powers / (tol * np.ptp(values) + SIGNAL_ROUNDING * np.abs(values).max() + MIN_SIGNAL_RANGE)
    kinds = np.full(len(parting), HIGHER)
    counts = parting.sum(axis=1) > 1
    if drives:
        rates = np.abs([coefficients[:-1, 1], ends[:-1, 1], np.diff(coefficients[:, 0]) / length[:-1, 0]])
        of_rates = powers * jumps * over ** (powers - 1.0) / (tol * rates.max() + MIN_SIGNAL_RANGE)
        rounding = SIGNAL_ROUNDING * np.abs(values).max() / over[:, 0]
        leaps = jumps[:, 1] > tol / len(jumps) * rates.max() + rounding + MIN_SIGNAL_RANGE
        kinds[np.maximum(parting, of_rates)[:, 2] > 1] = ACCELERATION
        kinds[leaps] = RATE
        counts |= (of_rates.sum(axis=1) > 1) | leaps
    return list(zip(breaks[1:-1][counts].tolist(), kinds[counts].tolist(), strict=True))


def _turns(breaks: np.ndarray, values: np.ndarray, tol: float) -> list[tuple[float, int]]:
    """Return the extremes of values (n,) at breaks, of more than tol of their range on both sides; nothing jumps there.

    The end of a constant part is included where it is longer than the change that follows.
    """
    least = tol * np.ptp(values) + SIGNAL_ROUNDING * np.abs(values).max() + MIN_SIGNAL_RANGE
    rises, falls, low, high = False, False, 0, 0  # low, high: breaks of the extremes since the last one
    turns, stays = [], []
    for k, value in enumerate(values):
        low, high = k if value < values[low] else low, k if value > values[high] else high
        if value - values[low] > least and not rises:
            rises, falls, turn, low, high = True, False, low, k, k
        elif values[high] - value > least and not falls:
            rises, falls, turn, low, high = False, True, high, k, k
        else:
            continue
        turns.append(turn)
        stays.append(k - 1)
    moved = breaks[[*turns[1:], high if rises else low]] - breaks[stays]
    stayed = breaks[stays] - np.maximum(breaks[turns], breaks[1])
    return [(float(breaks[k]), HIGHER) for k in [*turns, *np.array(stays, dtype=int)[stayed > moved]] if k > 0]
