"""Knots of signals: the instants at which one is not smooth, where integration steps end.

A piecewise polynomial has a knot where two pieces meet. A step over a knot sees one function where there are two:
neither its result nor its estimate of the error is of the method's order, and a pulse shorter than the step is not seen
at all. Knots that do not matter are left out, so that a table of many samples of a smooth function does not rule the
steps. Where tol chooses the steps, they end where such a table turns round as well: a smooth pulse is short beside the
steps of a scene at rest.
"""

from __future__ import annotations

import math

import numpy as np

from .model import Model
from .signals import SignalModel

HIGHER, ACCELERATION, RATE = range(3)
"""What jumps: nothing that the motion follows at once, the acceleration of what a signal drives, its rate; the order of
engine/bodies/motions.h."""

ROUNDING = 1e-14
"""Of a signal's largest value: a smaller difference of two pieces is rounding."""
TINY = 1e-300
"""Of no signal: what a constant is compared with."""
ONE_INSTANT = 1e-12
"""Of the duration: knots that are no farther apart are one (engine/equations/run.h)."""


def knots(model: Model, duration: float, tol: float, turns: bool = True) -> tuple[np.ndarray, np.ndarray]:
    """Return the times of the knots that count, in s, increasing, and what jumps at each.

    turns: whether the instants at which tables turn round are among them. A knot at the end of the run is one of them:
    the last row is of the instant before it.
    """
    driving, inertial = driving_signals(model), {drag.signal for drag in model.drags if drag.has_inertia}
    found = [each for number, signal in enumerate(model.signals)
             for each in _of_signal(signal, number in driving, number in inertial, tol)]
    if model.drags:
        found += _of_tables(model)
    if turns:
        found += [each for signal in model.signals for each in _turns(signal.breaks, signal.coefficients[:, 0], tol)
                  if each[0] < (1 - ONE_INSTANT) * duration]
    found = [each for each in found if ONE_INSTANT < each[0] / duration < 1 + ONE_INSTANT]
    times: list[float] = []
    jumps: list[float] = []
    for time, jump in sorted(found):
        if times and time - times[-1] <= ONE_INSTANT * duration:
            times[-1], jumps[-1] = time, max(jump, jumps[-1])
        else:
            times.append(time)
            jumps.append(jump)
    return np.array(times), np.array(jumps, dtype=int)


def driving_signals(model: Model) -> set[int]:
    """Return the numbers of the signals that prescribe a motion; the others scale loads."""
    return {motion.signal for motion in model.motions} | {coupling.drive for coupling in model.couplings}


def _of_tables(model: Model) -> list[tuple[float, int]]:
    """Return the times of the tables of fluids: a gust between two of them may be shorter than a step. Between straight
    lines the acceleration of the fluid jumps, which is a force where its inertia counts.
    """
    kinds = {id(drag.fluid): (drag.fluid.table, ACCELERATION if drag.has_inertia and drag.degree == 1 else HIGHER)
             for drag in model.drags if drag.fluid.table is not None}
    return [(float(time), kind) for table, kind in kinds.values() for time in table.grid.axes.get("time", ())]


def _of_signal(signal: SignalModel, drives: bool, accelerates: bool, tol: float) -> list[tuple[float, int]]:
    """Return `of_pieces` of a signal; accelerates: its rate is that of a fluid, whose inertia makes it a force."""
    found = of_pieces(signal.breaks, signal.coefficients, drives or accelerates, tol)
    return found if drives else [(time, min(jump, ACCELERATION)) for time, jump in found]


def of_pieces(breaks: np.ndarray, coefficients: np.ndarray, drives: bool, tol: float) -> list[tuple[float, int]]:
    """Return the time and jump of each knot of a piecewise polynomial that counts.

    A knot counts where the piece before it, continued over the shorter one of the two that meet there, parts from the
    one after it by more than tol of the signal; of a signal that prescribes a motion, also where their rates do. No
    step sees a jump of the rate, and what is lost at several adds up: all that are left out may be tol of the rate.
    """
    if len(coefficients) < 2:
        return []
    length = np.diff(breaks)[:, None]
    powers = np.arange(coefficients.shape[1])
    at_end = np.array([[math.comb(n, k) for k in powers] for n in powers])  # 0 where k > n
    ends = (coefficients * length**powers) @ at_end / length**powers  # of each piece about its end
    jumps = np.abs(coefficients[1:] - ends[:-1])
    over = np.minimum(length[:-1], length[1:])
    values = coefficients[1:, 0]
    parting = jumps * over**powers / (tol * np.ptp(values) + ROUNDING * np.abs(values).max() + TINY)
    kinds = np.full(len(parting), HIGHER)
    counts = parting.sum(axis=1) > 1
    if drives:
        rates = np.abs([coefficients[:-1, 1], ends[:-1, 1], np.diff(coefficients[:, 0]) / length[:-1, 0]])
        of_rates = powers * jumps * over ** (powers - 1.0) / (tol * rates.max() + TINY)
        rounding = ROUNDING * np.abs(values).max() / over[:, 0]
        leaps = jumps[:, 1] > tol / len(jumps) * rates.max() + rounding + TINY
        kinds[np.maximum(parting, of_rates)[:, 2] > 1] = ACCELERATION
        kinds[leaps] = RATE
        counts |= (of_rates.sum(axis=1) > 1) | leaps
    return list(zip(breaks[1:-1][counts].tolist(), kinds[counts].tolist(), strict=True))


def _turns(breaks: np.ndarray, values: np.ndarray, tol: float) -> list[tuple[float, int]]:
    """Return where values (n,) at breaks turn round by more than tol of their range on both sides; nothing jumps there.

    Where they stay for longer than they then move, the last break of their stay is one of these instants, too.
    """
    least = tol * np.ptp(values) + ROUNDING * np.abs(values).max() + TINY
    rises, falls, low, high = False, False, 0, 0  # low, high: breaks of the extremes since the last turn
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
