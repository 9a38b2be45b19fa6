"""The search for a stable state of rest under the present load, from the present state.

Newton's method ends at any state of rest, on unstable branches too: a slack cable drawn straight stays straight, under
compression. Such cables are therefore first put into the shape of strings (`string_start`). Where Newton's method ends
at an unstable state, or at none, the search starts again: from the shape of strings for all cables, and by two methods
that descend from the first state, `stiffen`, for scenes with cables, and `relax`. All of these are needed: without
`stiffen` slack cables in load steps and along paths end at compressed states (tests/statics/test_slack_cables.py).
"""

from __future__ import annotations

import numpy as np

from ...model.constants import constants
from ...parts.section_stiffness import section_stiffness
from .lying import left, lying
from .stability import Stability, push_off, stability
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
MAX_MASS = 1e30
"""Factor of the mass above which no step descends."""
MIN_AXIAL_STIFFNESS_RATIO = 12.0
"""Lower bound of EA l²/EI of the shortest element: an element softer along its axis than in bending folds up."""
STIFFENING_FACTOR = 100.0
"""Ratio of the stiffnesses of two consecutive stages of `stiffen`."""

BRANCH_CHOICE_REMEDY = ("; the branch that the search leaves on is not determined, and other such states may exist: "
                        "draw the scene slightly bent, or add a small load, to choose")


def find_rest(problem: StaticProblem) -> Stability | None:
    """Bring the static state to rest, stable if that can be found; None where no state of rest was found.

    Adds the unstable states passed and what is doubtful to problem.messages.
    """
    places = lying(problem.scene, problem.model, problem.keep()["q"])
    begin, messages = problem.keep(), list(problem.messages)
    found = _search(problem)
    if problem.settings.seek_stable and places and not problem.held and (found is None or left(problem, places)):
        problem.held = True  # slow, and of no more use a second time
        away, messages, problem.messages = problem.keep(), problem.messages, messages
        problem.restore(begin)
        if (held := relax(problem, min(place.step for place in places), MAX_SHORT_STEPS)) is not None:
            return held
        problem.restore(away)
        problem.messages = messages
    return found


def _search(problem: StaticProblem) -> Stability | None:
    """Do the same regardless of surfaces that cables lie on."""
    begin, passed = problem.keep(), None
    passed_at, problem.pushed = begin, False
    for start in (from_single_strings, from_strings) if problem.settings.seek_stable else ():
        if (stable := start(problem, every=False)) is not None:
            return stable
        problem.restore(begin)
    if problem.newton():
        passed, passed_at = stability(problem), problem.keep()
        if not passed.unstable or not problem.settings.seek_stable:
            return passed
    for descend in (from_single_strings, from_strings, stiffen, relax) if problem.settings.seek_stable else (relax,):
        problem.restore(begin)
        if (stable := descend(problem)) is not None:
            if passed is not None:
                _report(problem, passed)
            return stable
    if passed is not None:
        problem.restore(passed_at)
    return passed


def _report(problem: StaticProblem, passed: Stability) -> None:
    """Add the message of an unstable state that the search has passed."""
    problem.messages.append(f"Newton's method found a state of rest that is {passed}; the search went on to a stable "
                            f"one{BRANCH_CHOICE_REMEDY * problem.pushed}")


def from_single_strings(problem: StaticProblem, every: bool = True) -> Stability | None:
    """Find a stable state from cables alone on two supports in the shape of strings without bending stiffness, by
    Newton's method; else None.
    """
    if not hang(problem, every, bending=False) or not problem.newton():
        return None
    found = stability(problem)
    return None if found.unstable else found


def from_strings(problem: StaticProblem, every: bool = True) -> Stability | None:
    """Find a stable state from cables in the shape of strings, see `hang`, by Newton's method, and by `relax` where
    that finds none, or from a push off the unstable state that it finds; else None.
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
    push_off(problem)
    stable = relax(problem)
    if stable is not None:
        problem.pushed = True
        _report(problem, found)
    return stable


def relax(problem: StaticProblem, longest: float = np.inf, most: int = MAX_RELAXATIONS) -> Stability | None:
    """Relax by pseudo-transient continuation (Kelley & Keyes 1998): implicit Euler without regard to accuracy, its step
    growing as the motion fades; to a stable state, or None.

    A step never follows a direction of negative curvature: it is shortened until mass outweighs that, so that it
    descends (the test of curvature is that of Chiang & Zavala 2016). A state that its symmetry keeps at rest on an
    unstable branch is pushed off along its lowest direction. Where any state of rest is wanted (seek_stable is False),
    neither is done. longest: step, in m; most: number of steps.
    """
    longest = min(longest, MAX_STEP_MOVE * problem.size)
    mass, near, kept, begin = 1e-3 * problem.fastest, 1e-5, problem.keep(), problem.keep()
    least, descends = MIN_MASS_RATIO * problem.fastest, problem.settings.seek_stable
    for _ in range(most):
        if not mass < MAX_MASS:
            return None
        problem.iterations += 1
        change, size, heavier = _correction(problem, mass, descends, longest)
        if change is None:
            mass *= heavier
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
                push_off(problem)
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
    problem.leaves_route()
    return None


def _correction(problem: StaticProblem, mass: float, descends: bool,
                longest: float) -> tuple[np.ndarray | None, float, float]:
    """Return the correction with this mass, its size in m, and the factor of the mass with which to try again.

    The correction is None where the matrix is singular, where it is too large or, if it must descend, where it follows
    a direction of negative curvature.
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
    """Soften cables along their axis until their loads put all of them in tension, then stiffen them in stages; each
    stage starts from the one before, and the last is the true scene. None where there is no cable to soften.

    A slack cable of its full axial stiffness would fold up in short waves while it falls into its shape.
    """
    softest = _softest(problem)
    if not softest:
        return None

    def apply(factor: float) -> None:
        for k, least in softest.items():
            problem.engine.stiffen(k, constants(cables[k], max(factor, least)))

    cables = list(problem.scene.cables.values())
    found, factor = None, min(softest.values())
    try:
        while True:
            apply(factor)
            if found is None:
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
        apply(1.0)


def _softest(problem: StaticProblem) -> dict[int, float]:
    """Return, by the number of a cable, the factor of EA at which its own loads stretch it by about its length.

    Cables are softened whose law takes EA and EI, that of all cable elements; sections of beams resist.
    """
    found = {}
    load = float(np.abs(problem.load_vector()[problem.weight == 1.0]).sum())
    for k, (model, cable) in enumerate(zip(problem.model.cables, problem.scene.cables.values(), strict=True)):
        sections = np.array([section_stiffness(cable.stiffness_law, piece.section, piece.material, cable.dim)
                             for piece in cable.uniform_pieces])
        if sections.shape[1:] not in ((2,), (3,)):  # EA, EI, and EA of the upper modes of an assumed strain
            continue
        EA, EI = sections[:, 0].min(), sections[:, 1].max()
        least = max(load, MIN_AXIAL_STIFFNESS_RATIO * EI / float(model.mesh.lengths.min()) ** 2) / EA
        if least < 1.0:
            found[k] = least
    return found
