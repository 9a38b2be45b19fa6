"""A trial of the integrator that a scene's data let expect to be the cheaper one: its cost is measured as it runs.

What steps must follow, an estimate by a scene's stiffness and tolerance cannot know: how much of a motion is vibration.
What stability asks of the explicit method is known beforehand. So the run begins with an implicit one, and where what
remains would cost more at its present rate than the rival may cost, it begins anew with that, on trial itself where it
has a rival. Costs are counted in evaluations of eq 38 and not in seconds: a run takes the same course on any machine.
"""

from __future__ import annotations

from ...engine import Engine
from ...integrators import Integrator
from .integrator_choice import Rival
from .long_runs import LongRun
from .sink import Sink

PART = 0.25
"""Of the duration: what is run on trial."""

SHARE = 0.05
"""Of the other's cost: after each such share it is judged anew what remains."""


SETTLED = 4
"""Shares after which the rate counts as it is: the motion may begin with a shock."""

MOST_WORK = 1e15
"""Evaluations that no trial comes to: a count of more, as of absurd stiffnesses, is none that C can hold."""

CLEARLY = 10.0
"""Times the other's cost that what remains must take before."""


def on_trial(engine: Engine, rival: Rival, method: Integrator, duration: float, every: int, follow: LongRun,
             stream: Sink | None) -> tuple[str, str]:
    """Run a started engine as far as it takes to judge its method by its cost; every: rows between pauses, at which the
    stream may take them.

    Returns the status that the run has come to, "running" where there is more of it, and why the rival is the cheaper
    one, or "" where it is not. The first share of the cost, in which steps find their size, does not count.
    """
    share = max(1, int(min(SHARE * rival.cost / method.cost_of_evaluation, MOST_WORK)))
    before, shares = engine.time, 0
    while True:
        shares += 1
        status = engine.advance(follow, every, stream, most_evaluations=shares * share)
        time = engine.time
        if status != "running" or time >= PART * duration:
            return status, ""
        remains = SHARE * (duration - time) / max(time - before, 1e-12 * duration)
        if shares > 1 and remains > (CLEARLY if shares < SETTLED else 1.0):
            spent = shares * SHARE * rival.cost
            return status, (f"{method.name} on trial took work like {spent:.3g} to t = {time:.3g} s: what remains "
                            f"would take {remains:.2g} times the work that calls for {rival.method.name}")
        before = time
