"""A trial of the integrator with the lower expected cost: its cost is measured while it runs.

Stiffness and tolerance of a scene do not tell how much of its motion is vibration, which an implicit method must
resolve. The cost of the explicit method by its stability limit is known beforehand. The run therefore begins with an
implicit method. Where the rest would cost more at the present rate than the rival, the run begins anew with the rival.
That is on trial itself where it has a rival, or where its cost is an estimate: the measured cost of the method that
lost is then a rival. Costs are counted in evaluations of eq 38 and not in seconds: a run takes the same
course on any machine.
"""

from __future__ import annotations

from ...engine import Engine
from ...integrators import Integrator
from .integrator_choice import Rival
from .long_runs import LongRun
from .row_stream import RowStream

TRIAL_DURATION_FRACTION = 0.25
"""Fraction of the duration that a trial runs."""

ASSESSMENT_COST_FRACTION = 0.025
"""The remaining cost is assessed each time the trial has used this fraction of the rival's cost."""

SETTLING_ASSESSMENTS = 4
"""Number of assessments before the rate is used: the motion may begin with a shock."""

MOTION_GROWTH, GROWING_ASSESSMENTS = 1.3, 20
"""Growth of the largest motion between assessments above which the rate is not used, since the permitted error grows
with it, and the number of assessments up to which it is not."""

MAX_EVALUATIONS = 1e15
"""Upper bound of the evaluations of a trial; larger counts, as of absurd stiffnesses, do not fit an integer of C."""

EARLY_STOP_COST_RATIO = 10.0
"""Remaining cost over the rival's cost above which a trial stops before that."""


def next_rival(method: Integrator, cost: float, rival: Rival) -> Rival | None:
    """Return the rival of the method that replaces one which lost its trial: that one, by its cost in evaluations, or
    the next, whichever is cheaper; none where the cost is certain, as that of a limit of stability.
    """
    if rival.method.stability is not None:
        return None
    return min(filter(None, (rival.rival, Rival(method, cost))), key=lambda one: one.cost)


def on_trial(engine: Engine, rival: Rival, method: Integrator, duration: float, every: int, observer: LongRun,
             stream: RowStream | None) -> tuple[str, str, float]:
    """Run a started engine until the cost of its method is known; every: rows between pauses, at which the stream may
    take them.

    Returns the status of the run, "running" before its end, the reason for the rival, "" where it is not cheaper, and
    then the cost of the method for all of the run, in evaluations. The rate is that of the second half of the work
    done, since steps find their size in the first one.
    """
    share = max(1, int(min(ASSESSMENT_COST_FRACTION * rival.cost / method.cost_of_evaluation, MAX_EVALUATIONS)))
    times, motion = [engine.time], 0.0
    while True:
        shares = len(times)
        status = engine.advance(observer, every, stream, most_evaluations=shares * share, shown=observer.is_shown)
        time = engine.time
        if status != "running" or time >= TRIAL_DURATION_FRACTION * duration:
            return status, "", 0.0
        grows = shares < GROWING_ASSESSMENTS and engine.controlled_motion > MOTION_GROWTH * motion > 0.0
        motion = engine.controlled_motion
        half = shares // 2
        rate = (time - times[half]) / (shares - half)
        remains = ASSESSMENT_COST_FRACTION * (duration - time) / max(rate, 1e-12 * duration)
        if shares > 1 and not grows and remains > (EARLY_STOP_COST_RATIO if shares < SETTLING_ASSESSMENTS else 1.0):
            spent = shares * ASSESSMENT_COST_FRACTION * rival.cost
            return status, (f"{method.name} on trial took work like {spent:.3g} to t = {time:.3g} s: what remains "
                            f"would take {remains:.2g} times the work that calls for {rival.method.name}"), (
                                spent + remains * rival.cost)
        times.append(time)
