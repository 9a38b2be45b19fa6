"""The integrator of a run and that of its probes, and what their steps err by.

Generalised-alpha is the cheapest integrator at loose tolerances, but estimates its error by positions alone. What it
errs by is seen from its distance to the automatic choice on a coarse mesh; it depends little on the mesh, and is about
proportional to the tolerance. Two probes of one tolerance have most of it in common, so that their meshes are told
apart by steps much longer than those of the run.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..integrators import AUTO
from .probes import INSTANTS, Probe

TIGHTER = 10.0
"""By what the tolerance of the automatic choice is made smaller where it ends nowhere with that of the run."""

SHARE = 0.5
"""Of the tolerance, at most, for the error of generalised-alpha in time; model and mesh get what it leaves."""

ASSUMED = 0.2
"""Of the tolerance: the error in time of the automatic choice, seldom more (tests/benchmarks/model_choice.py)."""

LOOSER = 4.0
"""Times the tolerance of the run: that of its first probes. With friction it is the run's, since the error of
generalised-alpha then jumps as steps grow."""

LOOSEST = 1e-2
"""Tolerance of a probe's time integration at most."""

AT_FIRST, AT_LAST = 3.0, 1.0
"""Times the tolerance of the run: what the steps of a probe may err by, at first, and where meshes are so close to each
other that this is not far less than their difference."""

APART = 0.25
"""Of what the steps of two probes err by: how far apart that brings them, about; the rest they have in common."""

TIGHTEST = 0.05
"""Of the tolerance: where generalised-alpha needs a smaller one, what it errs by does not follow its tolerance."""

DAMPING = "genalpha"
"""The integrator that is compared with the automatic choice."""

FINER = 2.5
"""By what the work of the automatic choice grows more than that of generalised-alpha from the coarse mesh to that of
the run: each finer mesh brings faster vibrations, which radau follows and the explicit method's steps must resolve."""

OF_AUTO, OF_DAMPING = 0.22, 0.5
"""Powers of 1 / tolerance that the work of integrators grows with: as measured on the scenes of the table
(tests/benchmarks/model_choice.py), and of second order."""

UNHURRIED, LABOURED = 3.0, 4.0
"""Steps to an output time below which, and iterations a step above which, steps are bounded by other things than
their error, which then falls more slowly than the tolerance."""

AT_LEAST = 0.5
"""Of its tolerance: what generalised-alpha is taken to err by there."""

SMALLER = 4.0
"""By what its tolerance is made smaller to see what generalised-alpha errs by on the finest mesh: about as much as its
distance to the automatic choice tells, for 1.2 to 2 times the work of the probe instead of 2 to 7 times."""

GROWN = 3.0
"""Times what it errs by on the coarse mesh: where generalised-alpha errs by more on the finest one, it does not follow
its tolerance, as where short waves grow that only fine meshes have."""


@dataclass(frozen=True)
class InTime:
    """integrator, tol: of the run; error: what it errs by in time, over the largest change; probed, probe_tol: the
    integrator of probes and its tolerance; rate: their error over that tolerance; longer: the work of a run over that
    of a probe with its models; tried: the tolerance of the comparison; why: in words.
    """

    integrator: str
    tol: float
    error: float
    probed: str
    probe_tol: float
    rate: float
    longer: float
    tried: float
    why: str

    @property
    def noise(self) -> float:
        """Return how far apart two probes are by their steps alone, about."""
        return APART * self.rate * self.probe_tol

    def distrusts(self, apart: float) -> bool:
        """Return whether probes by generalised-alpha err by more than is taken, so that they tell nothing.

        apart: how far one on a fine mesh is from the automatic choice.
        """
        return bool(np.isfinite(apart)) and apart > GROWN * self.rate * self.probe_tol

    def automatic(self, tol: float, why: str) -> InTime:
        """Return it with the automatic choice for the run and its probes; tol: that of the choice; why: in words."""
        own = min(tol, self.tried)
        return replace(self, integrator=AUTO, tol=own, error=ASSUMED * tol, probed=AUTO, probe_tol=self.tried,
                       rate=ASSUMED, longer=(self.tried / own) ** OF_AUTO,
                       why=f"integrator {AUTO}, by stiffness and tolerance: {why}")

    def tightened(self, tol: float) -> InTime | None:
        """Return it with probes of a smaller error, None where that is small already; tol: that of the choice."""
        least = AT_LAST * tol / self.rate
        if self.probed != DAMPING or least >= self.probe_tol:
            return None
        return replace(self, probe_tol=least, longer=self.longer * (least / self.probe_tol) ** OF_DAMPING)


def compared(probe: Callable[[str, float], Probe], difference: Callable[[Probe, Probe], float], asked: str,
             tol: float, rubs: bool = False) -> InTime:
    """Return the integrators: generalised-alpha where it agrees with the automatic choice, if need be with a smaller
    tolerance, for less work.

    probe: returns the run on a coarse mesh by an integrator and its tolerance; difference: of two of them; asked: the
    integrator of the settings; rubs: whether the scene has friction.
    """
    if asked != AUTO:
        return InTime(asked, tol, ASSUMED * tol, asked, min(tol, LOOSEST), ASSUMED, 1.0, tol,
                      f"integrator {asked}: as asked for")
    tried = min((1.0 if rubs else LOOSER) * tol, LOOSEST)
    found = probe(AUTO, tried)
    for shorter in (tol, tol / TIGHTER):  # steps that are too long may end nowhere
        if found.run is None and shorter < tried:
            tried = shorter
            found = probe(AUTO, tried)
    own = min(tol, tried)
    other = probe(DAMPING, tried)
    apart = difference(other, found)
    if found.run is None or not np.isfinite(apart):  # one of them fails
        return InTime(AUTO, own, ASSUMED * tol, AUTO, tried, ASSUMED, (tried / own) ** OF_AUTO, tried,
                      f"integrator {AUTO}, by stiffness and tolerance: on a coarse mesh {DAMPING} fails, or it does")
    rate = max(apart / tried, AT_LEAST if _is_bounded(other) else 1e-300)
    allowed, loose = min(SHARE * tol / rate, own), min(AT_FIRST * tol / rate, tried)
    work, probing = (other.work * (tried / one) ** OF_DAMPING for one in (allowed, loose))
    best = found.work * (tried / tol) ** OF_AUTO
    probed = (DAMPING, loose, rate) if probing <= FINER * found.work else (AUTO, tried, ASSUMED)
    spent = probing if probed[0] == DAMPING else found.work
    if allowed < TIGHTEST * tol or work >= FINER * best:
        return InTime(AUTO, own, ASSUMED * tol, *probed, best / spent, tried,
                      f"integrator {AUTO}, by stiffness and tolerance: {DAMPING}, whose error on a coarse mesh is "
                      f"{apart:.1e} with tol {tried:.2g}, is no cheaper")
    return InTime(DAMPING, allowed, rate * allowed, *probed, work / spent, tried,
                  f"integrator {DAMPING} with tol {allowed:.2g}: on a coarse mesh, with tol {tried:.2g}, within "
                  f"{apart:.1e} of the automatic choice ({found.run.report['integrator']}), for "
                  f"{other.work / found.work:.2g} of its work")


def _is_bounded(probe: Probe) -> bool:
    """Return whether the steps of a probe are bounded by output times or by Newton's method, rather than by their
    error.
    """
    assert probe.run is not None, "it has been compared"
    steps = probe.run.report["steps"]
    return steps < UNHURRIED * INSTANTS or probe.run.report["newton_iterations"] > LABOURED * steps
