"""The search for parameters with which the state of rest of a scene has given values.

Newton's steps on the parameters are damped; each begins from the state that the derivatives predict, and ends in a
state of rest (solve/adjustment/parameter_search.py).
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ...errors import EquilibriumError, FunicularWarning, SceneError
from ...parts.in_plane import in_plane
from ...parts.scene_data import SceneData
from ...parts.settings import EquilibriumSettings
from ...parts.spring import Spring
from ..statics.rest_state import Adjustment, RestState
from ..statics.stable_search import find_rest
from ..statics.starts import fitted
from ..statics.static import equilibrium, note
from ..statics.static_problem import StaticProblem
from .parameter_search import AtRest, ParameterSearch
from .parameters import Parameters
from .snapshots import Reader
from .unreachable import Linear, cause_of, why_unreachable

MIN_STEP_FRACTION = 2.0**-12
"""Smallest fraction of Newton's step; the search ends where it does not reduce the misfits."""
SUFFICIENT_DECREASE = 1e-4
"""Decrease of the misfits that a step must reach, as a fraction of that of the linear model."""
ROUNDING_MARGIN = 100.0
"""Misfits below this multiple of the tolerance are rounding where no step reduces them."""

S = TypeVar("S", bound=RestState)


def adjusted(scene: SceneData, settings: EquilibriumSettings, start: RestState | None, made: type[S],
             reader: Callable[[S, Sequence[str]], Reader]) -> S:
    """Return the state of rest with the values ``settings.to``, of the scene with ``settings.adjust`` adjusted.

    reader: makes the `Reader` of the named values of a state. Raises SceneError; EquilibriumError with the targets that
    are not reached and the cause.
    """
    adjust, to = settings.adjust, settings.to
    assert adjust is not None, "without parameters there is nothing to adjust"
    assert to is not None, "without targets there is nothing to adjust for"
    parameters = Parameters(scene, adjust)
    if len(adjust) < len(to):
        raise SceneError("equilibrium", f"{len(to)} targets cannot be reached with {len(adjust)} parameters: "
                         + ", ".join(to), "adjust as many parameters as there are targets, or more")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FunicularWarning)  # of the state returned alone
        rest = equilibrium(in_plane(scene), settings, start, made)
    read = reader(rest, list(to))
    search = ParameterSearch(parameters, settings, made, read)
    at = search.begin(rest)
    targets = np.array(list(to.values()))
    scales = np.where(read.in_metres, at.problem.size, np.maximum(np.abs(targets), np.abs(at.g)))
    scales = np.where(scales > 0, scales, 1.0)
    misfits = _found(search, at, to, scales)
    at = misfits.at
    found = find_rest(at.problem)
    state = made.of(at.problem, found or search.state(at.problem).stability)
    g = read.values(at.problem)
    left = float(np.max(np.abs(targets - g) / scales, initial=0.0))
    if found is None or left > ROUNDING_MARGIN * settings.tolerance:
        raise EquilibriumError("the targets are met by an unstable state of rest alone, which the search for a stable "
                               "one leaves; take seek_stable=False to have it, or other targets", state, 1.0)
    _, jacobian = search.linear(AtRest(at.problem, at.p, g))
    names = parameters.names
    state.adjustment = Adjustment(dict(zip(names, at.p.tolist(), strict=True)), dict(to),
                                  dict(zip(to, g.tolist(), strict=True)), jacobian, len(misfits.sizes) - 1,
                                  [*misfits.sizes[:-1], left])
    note(at.problem, state)
    return state


@dataclass
class _Approach:
    """The last state of the steps, and the largest misfits on the way.

    cause: why the targets are not reached, empty where they are; linear: the last model, None where the first state has
    the values already.
    """

    at: AtRest
    sizes: list[float]
    cause: str = ""
    linear: Linear | None = None


def _found(search: ParameterSearch[S], at: AtRest, to: Mapping[str, float], scales: np.ndarray) -> _Approach:
    """Return the state of rest with the target values. Raises EquilibriumError.

    A slack spring changes nothing, so that no derivative gives its length. The scene with all springs taut is therefore
    tried, too: first where the parameters of other parts are fewer than the targets, else last.
    """
    met = np.max(np.abs(np.array(list(to.values())) - at.g) / scales) <= search.settings.tolerance
    few = not met and len(search.parameters.names) - search.without_effect(at) < len(to)
    taut = _with_all_taut(search, to, scales) if few else None
    if not isinstance(taut, _Approach):
        found = _approach(search, at, to, scales)
        if not found.cause:
            return found
        taut = taut if few else _with_all_taut(search, to, scales)
    if isinstance(taut, _Approach):
        found = _approach(search, taut.at, to, scales)
        found.sizes[:0] = taut.sizes[:-1]  # towards the same values
    if found.cause:
        assert found.linear is not None, "there was one step at least"
        also = f"{found.cause}; with all springs taut, {taut}" if isinstance(taut, str) else found.cause
        raise EquilibriumError(why_unreachable(found.linear, found.at.g, to, also), search.state(found.at.problem), 1.0)
    return found


def _with_all_taut(search: ParameterSearch[S], to: Mapping[str, float], scales: np.ndarray) -> _Approach | str | None:
    """Return the state of rest found with tension-only springs that push, too; why there is none, in words; None
    without such springs. Where all are taut in the end, the state is one of the scene itself.
    """
    scene, settings = search.parameters.scene, search.settings
    pulling = [part for part in scene.point_forces.values() if isinstance(part, Spring) and part.tension_only
               and part.table is None]
    if not pulling:
        return None
    assert settings.adjust is not None, "the search has parameters"
    both = scene.changed([(part, {"tension_only": False}) for part in pulling])
    pushing = ParameterSearch(Parameters(both, settings.adjust), settings, search.made, search.reader)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FunicularWarning)  # as above
            rest = equilibrium(in_plane(both), settings, None, search.made)
        found = _approach(pushing, pushing.begin(rest), to, scales)
        if found.cause:
            return found.cause
        at = found.at
        problem = StaticProblem(search.in_plane(search.parameters.scene_at(at.p)), settings)
    except (EquilibriumError, SceneError) as error:
        return str(error)
    if pushes := _pushing(pushing.state(at.problem), pulling, settings.tolerance):
        return pushes
    problem.restore(fitted(at.problem.keep(), problem.model))
    if find_rest(problem) is None:
        return "no state of rest was found"
    problem.iterations += at.problem.iterations
    return _Approach(AtRest(problem, at.p, search.reader.values(problem)), found.sizes)


def _pushing(state: RestState, springs: Sequence[Spring], tolerance: float) -> str:
    """Return in words which springs push in a state by more than this fraction of the largest of their forces; empty
    where none does.
    """
    tensions = {spring.name: float(state[f"{spring.name}.tension"]) for spring in springs}
    least = -ROUNDING_MARGIN * tolerance * max(abs(tension) for tension in tensions.values())
    pushes = {name: tension for name, tension in tensions.items() if tension < least}
    if not pushes:
        return ""
    worst = min(pushes, key=pushes.__getitem__)
    others = f", and {len(pushes) - 1} more would push" * (len(pushes) > 1)
    return f'"{worst}", which pulls alone, would push with {-pushes[worst]:.4g} N{others}'


def _approach(search: ParameterSearch[S], at: AtRest, to: Mapping[str, float], scales: np.ndarray) -> _Approach:
    """Take steps until the targets are met, or no step reduces the misfits."""
    targets, settings, parameters = np.array(list(to.values())), search.settings, search.parameters
    sizes: list[float] = []
    linear, reason = None, f"{settings.max_iterations} steps were not enough; take more max_iterations"
    for _ in range(settings.max_iterations + 1):
        misfit = (targets - at.g) / scales
        sizes.append(float(np.max(np.abs(misfit), initial=0.0)))
        if sizes[-1] <= settings.tolerance:
            return _Approach(at, sizes)
        rates, G = search.linear(at)
        linear = Linear.of(parameters, at.p, G, scales, misfit, parameters.sizes(at.problem.size))
        nearer, why = _step(search, at, linear, rates, targets, scales)
        if nearer is None:
            if sizes[-1] <= ROUNDING_MARGIN * settings.tolerance:
                return _Approach(at, sizes)
            reason = why
            break
        at = nearer
    assert linear is not None, "there is one iteration at least"
    return _Approach(at, sizes, cause_of(parameters, linear, list(to), reason), linear)


def _step(search: ParameterSearch[S], at: AtRest, linear: Linear, rates: np.ndarray, targets: np.ndarray,
          scales: np.ndarray) -> tuple[AtRest | None, str]:
    """Return a state nearer to the targets, by a fraction of Newton's step; None where there is none, and the cause."""
    reason = "no step comes nearer"
    before, part = float(np.linalg.norm(linear.misfit)), 1.0
    if not linear.gains > 0:
        return None, reason
    while part >= MIN_STEP_FRACTION:
        found = search.moved(at, part * linear.step, rates)
        if isinstance(found, str):
            reason = found
        elif np.linalg.norm((targets - found.g) / scales) <= before - SUFFICIENT_DECREASE * part * linear.gains:
            return found, ""
        part *= 0.5
    return None, reason
