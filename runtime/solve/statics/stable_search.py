"""The search for a stable state of rest under the load that is on, from wherever the state is.

Newton's method ends at any state of rest, on unstable branches too: a slack cable drawn straight stays straight, under
compression. Such cables are therefore first put into the shape of strings (`string_start`). Where Newton's method ends
at an unstable state, or at none, the search starts again: from the shape of strings for all cables, and by two methods
that descend from the first state, `stiffen`, for scenes with cables, and `relax`.
"""

from __future__ import annotations

import numpy as np

from .lying import left, lying
from .softening import Softening
from .stability import Stability, lowest_direction, stability
from .static_problem import StaticProblem
from .string_start import hang

MAX_RELAXATIONS = 400
MAX_SHORT_STEPS = 1000
"""Steps of a relaxation that are shorter than a tenth of a cable radius."""
MAX_STEP_MOVE = 0.2
"""Largest move in a step, as a fraction of the scene's size."""
MAX_DISTANCE = 10.0
"""Distance, as a multiple of the scene's size, beyond which a scene does not come to rest."""
MIN_MASS_RATIO = 1e-12
"""Mass of the pseudo-dynamics over that of the fastest vibration, below which steps are those of Newton."""
PUSH_SIZE = 1e-3
"""Size of the push off an unstable branch, as a fraction of the scene's size."""
STIFFENING_FACTOR = 100.0
"""Ratio of the stiffnesses of two consecutive stages of `stiffen`."""

BRANCH_CHOICE_REMEDY = ("; the branch that the search leaves on is not determined, and other such states may exist: "
                        "draw the scene slightly bent, or add a small load, to choose")


def find_rest(problem: StaticProblem) -> Stability | None:
    """Bring the static state to rest, stable if that can be found; None where there is none, or none was found.

    What was passed on the way, and what is doubtful, is added to problem.messages.
    """
    places = lying(problem.scene, problem.model, problem.keep()["q"])
    begin, told = problem.keep(), list(problem.messages)
    found = _search(problem)
    if problem.settings.seek_stable and places and not problem.held and (found is None or left(problem, places)):
        problem.held = True  # it is long, and a second time no better
        away, messages = problem.keep(), problem.messages
        problem.restore(begin)
        problem.messages = told
        if (held := relax(problem, min(place.step for place in places), MAX_SHORT_STEPS)) is not None:
            return held
        problem.restore(away)
        problem.messages = messages
    return found


def _search(problem: StaticProblem) -> Stability | None:
    """Do the same without regard to what cables lie on."""
    begin, passed = problem.keep(), None
    passed_at, problem.pushed = begin, False
    if problem.settings.seek_stable and (stable := from_strings(problem, every=False)) is not None:
        return stable
    problem.restore(begin)
    if problem.newton():
        found = stability(problem)
        if not found.unstable or not problem.settings.seek_stable:
            return found
        passed, passed_at = found, problem.keep()
    for descend in (from_strings, stiffen, relax) if problem.settings.seek_stable else (relax,):
        problem.restore(begin)
        if (stable := descend(problem)) is not None:
            if passed is not None:
                _tell(problem, passed)
            return stable
    if passed is not None:
        problem.restore(passed_at)
    return passed


def _tell(problem: StaticProblem, passed: Stability) -> None:
    """Add the message of an unstable state that was passed."""
    problem.messages.append(f"Newton's method found a state of rest that is {passed}; the search went on to a stable "
                            f"one{BRANCH_CHOICE_REMEDY * problem.pushed}")


def from_strings(problem: StaticProblem, every: bool = True) -> Stability | None:
    """Find a stable state from where cables are that hang as strings do, see `hang`: by Newton's method, from the
    unstable state that this finds, pushed off it, by `relax`, or by that alone; else None.
    """
    if not hang(problem, every):
        return None
    hung = problem.keep()
    if not problem.newton():
        problem.restore(hung)
        return relax(problem)
    found = stability(problem)
    if not found.unstable:
        return found
    problem.move(PUSH_SIZE * problem.size * lowest_direction(problem))
    stable = relax(problem)
    if stable is not None:
        problem.pushed = True
        _tell(problem, found)
    return stable


def relax(problem: StaticProblem, longest: float = np.inf, most: int = MAX_RELAXATIONS) -> Stability | None:
    """Relax by pseudo-transient continuation (Kelley & Keyes 1998): implicit Euler without regard to accuracy, its step
    growing as the motion fades; to a stable state, or None.

    A step never goes along a direction of negative curvature: it is made shorter until mass outweighs that, so that it
    descends (the test of curvature is that of Chiang & Zavala 2016). A state that its symmetry keeps at rest on an
    unstable branch is pushed off along the direction of the least curvature. Where any state of rest will do
    (seek_stable), neither is done. longest: of the steps, m; most: so many.
    """
    longest = min(longest, MAX_STEP_MOVE * problem.size)
    mass, near, kept, begin = 1e-3 * problem.fastest, 1e-5, problem.keep(), problem.keep()
    least, descends = MIN_MASS_RATIO * problem.fastest, problem.settings.seek_stable
    for _ in range(most):
        problem.iterations += 1
        change, size, heavier = _correction(problem, mass, descends, longest)
        if change is None:
            mass *= heavier
            if not mass < 1e30:
                return None
            continue
        problem.move(change)
        if not np.isfinite(np.linalg.norm(problem.residual())):
            problem.restore(kept)
            mass *= 100.0
            continue
        kept = problem.keep()
        if problem.distance(begin) > MAX_DISTANCE * problem.size:
            return None
        mass = max(least, mass * (0.5 if size < 0.1 * longest else 1.0))
        if mass > 100 * least and size > near * problem.size:
            continue
        if descends and stability(problem).unstable:
            if size < 1e-6 * problem.size and mass <= least:
                problem.move(PUSH_SIZE * problem.size * lowest_direction(problem))
                kept = problem.keep()
                problem.pushed = True
            continue
        if problem.newton() and not ((found := stability(problem)).unstable and descends):
            return found
        problem.restore(kept)
        near *= 0.1
        mass *= 10.0
        if near < 1e-10:
            return None
    return None


def _correction(problem: StaticProblem, mass: float, descends: bool,
                longest: float) -> tuple[np.ndarray | None, float, float]:
    """Return a correction with so much mass, its size in m, and, where there is none, what the mass must grow by.

    There is none where the matrix is singular, the correction is too large or, if it is to descend, goes along a
    direction of negative curvature.
    """
    try:
        change = problem.solver(mass)(-problem.residual())
    except RuntimeError:
        return None, np.inf, 10.0
    size = problem.length(change)
    if not size < longest or (descends and problem.curvature(change, mass) < 0):
        return None, size, 4.0
    return change, size, 1.0


def stiffen(problem: StaticProblem) -> Stability | None:
    """Make cables first so soft along their axis that their loads put all of them in tension, then stiffer in stages,
    each starting from the one before; the last is the true scene. None where there is no cable to soften.

    A slack cable that is as stiff as it is would fold up in short waves while it falls into its shape.
    """
    softening = Softening(problem)
    if softening.factor is None:
        return None
    found, factor = None, softening.factor
    try:
        while True:
            softening.apply(factor)
            if factor < softening.factor * STIFFENING_FACTOR and found is None:
                found = relax(problem)
            else:
                kept = problem.keep()
                found = stability(problem) if problem.newton() else None
                if found is None or found.unstable:
                    problem.restore(kept)
                    found = relax(problem)
            if found is None or factor == 1.0:
                return found
            factor = min(1.0, factor * STIFFENING_FACTOR)
    finally:
        softening.apply(1.0)
