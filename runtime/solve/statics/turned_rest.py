"""The search for rest by steps of prescribed angles that are far from those of the state."""

from __future__ import annotations

from .stability import Stability
from .stable_search import find_rest
from .static_problem import StaticProblem
from .turns import ANGLE_STEP, MAX_DIRECTION_TURN, MIN_STEP_FRACTION, largest_turn, too_long


def turned_rest(problem: StaticProblem) -> Stability | None:
    """Search as `find_rest` does, and follow the prescribed angles from those of the state. None also where they cannot
    be followed: the state is restored.
    """
    turns = problem.turns
    if turns.fraction == 1.0:
        return find_rest(problem)
    begin, whole = problem.keep(), ANGLE_STEP / turns.largest
    reached, step = turns.fraction, whole
    moving = find_rest(problem) is not None
    while moving and reached < 1.0:
        kept = problem.keep()
        turns.go(min(1.0, reached + step))
        problem.restore(kept)
        found = problem.newton() or find_rest(problem) is not None
        if found and (largest_turn(problem.model, kept["q"], problem.keep()["q"]) <= MAX_DIRECTION_TURN
                      or step <= MIN_STEP_FRACTION * whole):  # it snaps
            turns.lost = too_long(problem.model, problem.keep()["q"], begin["q"])
            reached = turns.furthest = turns.fraction
            step = min(2 * step, whole)
            moving = not turns.lost
            continue
        turns.go(reached)
        problem.restore(kept)
        step /= 2
        moving = step >= MIN_STEP_FRACTION * whole
    if moving:
        return find_rest(problem)
    turns.go(0.0)
    problem.restore(begin)
    return None
