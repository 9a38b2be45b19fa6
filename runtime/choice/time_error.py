"""The integrator of a run and that of its probes, and the error of their steps.

Generalised-alpha is the cheapest integrator at loose tolerances, but it estimates its error from positions alone. Its
error is measured as the distance to the automatic choice on a coarse mesh. It depends little on the mesh and is about
proportional to the tolerance. Two probes of one tolerance share most of it, so that probes can tell meshes apart with
steps much longer than those of the run.

Where the motion is small the linear model about the start is tried, which takes the same steps: what it leaves out is
its distance to generalised-alpha.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..integrators import AUTO
from ..results.trajectories import largest_change
from .motion import along
from .probes import OUTPUT_TIMES, Probe

DAMPING = "genalpha"
"""The integrator that is compared with the automatic choice."""

LINEAR = "linear"
"""The linear model about the start, in time by the method of `DAMPING`."""

SMALL_MOTION = 0.02
"""Largest motion of a cable, over its length, for which the linear model is tried: what it leaves out is of second
order."""

LINEAR_SHARE = 0.25
"""Largest part of the tolerance for what the linear model leaves out."""

LINEAR_START = 2e4
"""Elements times steps of a run from which the linear model is tried: its matrices cost as much as so many."""

RETRY_TOL_RATIO = 10.0
"""Ratio of the tolerance of the run to that of a last attempt, where the automatic choice fails."""

MAX_TIME_SHARE = 0.5
"""Largest part of the tolerance for the error of generalised-alpha; model and mesh get the rest."""

ASSUMED_ERROR = 0.2
"""Error in time of the automatic choice over its tolerance; it is seldom larger (tests/benchmarks/model_choice.py)."""

PROBE_TOL_RATIO = 4.0
"""Ratio of the tolerance of the first probes to that of the run; 1 with friction, where the error of generalised-alpha
jumps as steps grow."""

MAX_PROBE_TOL = 1e-2
"""Largest tolerance of a probe's time integration."""

FIRST_PROBE_ERROR, LAST_PROBE_ERROR = 3.0, 1.0
"""Largest error of a probe's steps over the tolerance of the run: at first, and for meshes whose difference is not far
above it."""

SEPARATE_ERROR_SHARE = 0.25
"""Part of the error of their steps that two probes do not share, about."""

MIN_TOL_RATIO = 0.05
"""Ratio to the tolerance of the run below which the error of generalised-alpha does not follow its tolerance."""

AUTO_WORK_GROWTH = 2.5
"""Ratio by which the work of the automatic choice grows more than that of generalised-alpha from the coarse mesh to
that of the run: a finer mesh has faster vibrations, which radau follows and the explicit method must resolve."""

AUTO_WORK_POWER, DAMPING_WORK_POWER = 0.22, 0.5
"""Powers of 1 / tolerance in the work of integrators: measured on the scenes of tests/benchmarks/model_choice.py, and
of a method of second order."""

MIN_STEPS_PER_OUTPUT, MAX_ITERATIONS_PER_STEP = 3.0, 4.0
"""Bounds beyond which output times or Newton's method limit the steps, whose error then falls more slowly than the
tolerance."""

MIN_ERROR_RATE = 0.5
"""Error of generalised-alpha over its tolerance that is assumed there."""

FINEST_TOL_RATIO = 4.0
"""Ratio of tolerances that measures the error of generalised-alpha on the finest mesh: about as good as the distance to
the automatic choice, for 1.2 to 2 times the work of the probe instead of 2 to 7 times."""

DISTRUST_RATIO = 3.0
"""Ratio of the error of generalised-alpha on the finest mesh to that on the coarse one above which it does not follow
its tolerance, as where short waves grow that only fine meshes have."""


@dataclass(frozen=True)
class InTime:
    """The integrators of a run and of its probes.

    integrator, tol: of the run; error: of its steps, over the largest change; probed, probe_tol: the integrator of
    probes and its tolerance; rate: their error over that tolerance; work_ratio: the work of a run over that of a probe
    with its models; tried: the tolerance of the comparison; why: the reason in words.
    """

    integrator: str
    tol: float
    error: float
    probed: str
    probe_tol: float
    rate: float
    work_ratio: float
    tried: float
    why: str

    @property
    def noise(self) -> float:
        """Return the distance of two probes that is due to their steps alone, about."""
        return SEPARATE_ERROR_SHARE * self.rate * self.probe_tol

    def distrusts(self, apart: float) -> bool:
        """Return whether probes by generalised-alpha err too much to tell meshes apart; apart: on a fine mesh."""
        return bool(np.isfinite(apart)) and apart > DISTRUST_RATIO * self.rate * self.probe_tol

    def automatic(self, tol: float, why: str) -> InTime:
        """Return the automatic choice for the run and its probes; tol: that of the choice; why: in words."""
        own = min(tol, self.tried)
        return replace(self, integrator=AUTO, tol=own, error=ASSUMED_ERROR * tol, probed=AUTO, probe_tol=self.tried,
                       rate=ASSUMED_ERROR, work_ratio=(self.tried / own) ** AUTO_WORK_POWER,
                       why=f"integrator {AUTO}, by stiffness and tolerance: {why}")

    def tightened(self, tol: float) -> InTime | None:
        """Return it with probes of a smaller error, None where that is small already; tol: that of the choice."""
        least = LAST_PROBE_ERROR * tol / self.rate
        if self.probed != DAMPING or least >= self.probe_tol:
            return None
        return replace(self, probe_tol=least,
                       work_ratio=self.work_ratio * (least / self.probe_tol) ** DAMPING_WORK_POWER)


def moves_little(probe: Probe[Any]) -> bool:
    """Return whether the cables of a probe, of which there are some, move by little of their lengths."""
    if probe.run is None or not probe.scene.cables:
        return False
    return all(largest_change(along(cable, probe.run[f"{cable.name}.nodal_vectors"])) < SMALL_MOTION * cable.length
               for cable in probe.scene.cables.values())


def is_long(probe: Probe[Any], steps: float) -> bool:
    """Return whether a run of so many steps is long enough for the matrices of the linear model."""
    return sum(model.elements for model in probe.models.values()) * steps > LINEAR_START


def compared(probe: Callable[[str, float], Probe[Any]], difference: Callable[[Probe[Any], Probe[Any]], float],
             asked: str, tol: float, friction: bool = False) -> InTime:
    """Return the integrators: generalised-alpha where it agrees with the automatic choice for less work, the linear
    model where that agrees with generalised-alpha.

    Its tolerance is smaller than that of the run where this is needed. probe: returns the run on a coarse mesh by an
    integrator and its tolerance; difference: of two of them; asked: the integrator of the settings; friction: whether
    the scene has any.
    """
    if asked != AUTO:
        return InTime(asked, tol, ASSUMED_ERROR * tol, asked, min(tol, MAX_PROBE_TOL), ASSUMED_ERROR, 1.0, tol,
                      f"integrator {asked}: as asked for")
    tried = min((1.0 if friction else PROBE_TOL_RATIO) * tol, MAX_PROBE_TOL)
    found = probe(AUTO, tried)
    for shorter in (tol, tol / RETRY_TOL_RATIO):  # a run with too long steps may fail
        if found.run is None and shorter < tried:
            tried = shorter
            found = probe(AUTO, tried)
    own = min(tol, tried)
    other = probe(DAMPING, tried)
    apart = difference(other, found)
    if found.run is None or other.run is None or not np.isfinite(apart):
        return InTime(AUTO, own, ASSUMED_ERROR * tol, AUTO, tried, ASSUMED_ERROR, (tried / own) ** AUTO_WORK_POWER,
                      tried, f"integrator {AUTO}, by stiffness and tolerance: on a coarse mesh {DAMPING} fails, or it "
                      "does")
    steps, iterations = other.run.report["steps"], other.run.report["newton_iterations"]
    is_bounded = steps < MIN_STEPS_PER_OUTPUT * OUTPUT_TIMES or iterations > MAX_ITERATIONS_PER_STEP * steps
    rate = max(apart / tried, MIN_ERROR_RATE if is_bounded else 1e-300)
    allowed, loose = min(MAX_TIME_SHARE * tol / rate, own), min(FIRST_PROBE_ERROR * tol / rate, tried)
    work, probing = (other.work * (tried / one) ** DAMPING_WORK_POWER for one in (allowed, loose))
    best = found.work * (tried / tol) ** AUTO_WORK_POWER
    probed = (DAMPING, loose, rate) if probing <= AUTO_WORK_GROWTH * found.work else (AUTO, tried, ASSUMED_ERROR)
    spent = probing if probed[0] == DAMPING else found.work
    if allowed >= MIN_TOL_RATIO * tol and moves_little(other) and is_long(other, steps * work / other.work):
        linear = probe(LINEAR, tried)
        left_out, own_work = difference(linear, other), linear.work * work / other.work
        if left_out <= LINEAR_SHARE * tol and own_work < min(work, AUTO_WORK_GROWTH * best):
            return InTime(LINEAR, allowed, rate * allowed + left_out, *probed, own_work / spent, tried,
                          f"integrator {LINEAR} with tol {allowed:.2g}: on a coarse mesh within {left_out:.1e} of "
                          f"{DAMPING}, for {linear.work / other.work:.2g} of its work")
    if allowed < MIN_TOL_RATIO * tol or work >= AUTO_WORK_GROWTH * best:
        return InTime(AUTO, own, ASSUMED_ERROR * tol, *probed, best / spent, tried,
                      f"integrator {AUTO}, by stiffness and tolerance: {DAMPING}, whose error on a coarse mesh is "
                      f"{apart:.1e} with tol {tried:.2g}, is no cheaper")
    return InTime(DAMPING, allowed, rate * allowed, *probed, work / spent, tried,
                  f"integrator {DAMPING} with tol {allowed:.2g}: on a coarse mesh, with tol {tried:.2g}, within "
                  f"{apart:.1e} of the automatic choice ({found.run.report['integrator']}), for "
                  f"{other.work / found.work:.2g} of its work")
