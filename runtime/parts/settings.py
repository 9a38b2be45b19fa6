"""The settings of runs, of equilibria and relaxations, and of modes."""

import math
import os
from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, model_validator

from ..integrators import AUTO, INTEGRATORS
from .part import Part
from .schemas import checked
from .validation import Count, Flag, Names, items, not_negative, number, one_of, positive, shown, within

SMALLEST_STEP = 1e-12
"""Of a run over its duration, as in engine/run/steps.c."""

COUNT_TOLERANCE = 1e-9
"""Relative rounding of a number of steps above a whole number."""

Duration = Annotated[float, positive("s")]


STEPS_OF_TOL = {"step", "absolute_tol"}
"""Settings of the steps that replace tol or act beside it."""


def overridden(settings: Mapping[str, Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings of a run, such as those of a scene file, with others given.

    A given tol also replaces a step and an absolute_tol, beside which it has no effect.
    """
    replaced = STEPS_OF_TOL if "tol" in given else set()
    return {name: value for name, value in settings.items() if name not in replaced} | dict(given)


class RunSettings(Part):
    """The settings of a run.

    duration: s
    tol: target error of positions, relative to the largest motion in the scene; it determines the steps
    absolute_tol: error allowed beside ``tol``, m; by default tol times 1e-6 of the scene's size
    quantities: results such as "A.position", "wire.position.y" or "trolley.s" that determine the error and the largest
        motion, by default all positions
    step: a fixed step, s, in the place of ``tol``; divided so that steps end at output times and where signals
        are not smooth
    output_step: s; by default a hundredth of the duration
    integrator: "explicit" (Runge-Kutta of order 8), "radau" (implicit, order 5, for stiff scenes), "genalpha"
        (implicit, order 2, with control of the dissipation), "energy" (order 2, keeps energy and momenta to rounding),
        "linear" (order 2, for small motions about the start: cables and joints are linear there, see
        `integrators.Linear`), or "auto": the cheapest of the first three for this scene and tol, genalpha where step or
        spectral_radius is given
    spectral_radius: of genalpha and linear (default 0.9, with friction 0.5) and energy (1) at infinite frequency: 1
        keeps and 0 removes the fastest vibrations, energy's of the cables, counted as dissipated
    model: "given", the elements as they are, or "auto": as `Scene.choose`, elements that are not given, and the
        integrator, are chosen for an error of model, mesh and time below tol
    initial: "drawn", "equilibrium" (static, under the loads at t = 0), "relaxed" (see `Scene.relax`), or a state that
        `Scene.run` is given
    save: the file to write, or None
    threads: number of threads for cables of some hundred elements or more, at most one per processor
    estimate: whether two more runs measure the error of the steps and of the mesh, in ``report["errors"]``, see
        `ErrorEstimate`
    """

    kind = "run"
    duration: Duration
    tol: Annotated[float, positive()] = 1e-4
    absolute_tol: Annotated[float, not_negative("m")] | None = None
    quantities: Names | None = None
    step: Duration | None = None
    output_step: Duration = Field(default_factory=lambda data: data["duration"] / 100)
    integrator: Annotated[str, one_of((AUTO, *INTEGRATORS))] = AUTO
    spectral_radius: Annotated[float, within(0, 1, ends=True)] | None = None
    model: Annotated[str, one_of(("given", "auto"))] = "given"
    initial: Annotated[str, one_of(("drawn", "equilibrium", "relaxed", "state"))] = "drawn"
    save: Annotated[str | None, BeforeValidator(
        lambda value: os.fspath(value) if isinstance(value, os.PathLike) else value)] = None
    threads: Count = 1
    estimate: Flag = False

    @model_validator(mode="after")
    def _steps_fit(self) -> "RunSettings":
        for name in ("step", "output_step"):
            value = getattr(self, name)
            if value is not None and value > self.duration:
                raise ValueError(f"{name} must not exceed the duration {self.duration:g} s, got {value:g} s")
        if self.step is not None and self.step < SMALLEST_STEP * self.duration:
            raise ValueError(f"step must not be below {SMALLEST_STEP:g} of the duration {self.duration:g} s, got "
                             f"{self.step:g} s")
        return self

    @property
    def step_taken(self) -> float | None:
        """Return the fixed step in s, divided so that steps end on output times; None without a fixed step."""
        if self.step is None:
            return None
        return self.output_step / math.ceil(self.output_step / self.step * (1 - COUNT_TOLERANCE))


FREE = "free"
"""The limits of a parameter without limits."""
Limits = tuple[float, float] | str
"""The least and the greatest value of a parameter, or "free"."""


def _adjust(value: Any) -> dict[str, Limits] | None:
    """Return limits by path from a list of paths or a table. Raises ValueError."""
    if value is None:
        return None
    if isinstance(value, list | tuple):
        value = dict.fromkeys(value, FREE) if all(isinstance(each, str) for each in value) else {}
    if not isinstance(value, Mapping) or not value or not all(isinstance(name, str) for name in value):
        raise ValueError("must name parameters", 'give such as {"dropper.length": (0.5, 1.2)}, or ["dropper.length"]')
    return {name: _limits(name, each) for name, each in value.items()}


def _limits(name: str, value: Any) -> Limits:
    if value is None or (isinstance(value, str) and value == FREE):
        return FREE
    if (given := items(value, 2, 2)) is None:
        raise ValueError(f'takes two limits of "{name}", got {shown(value)}', 'give (low, high), or "free"')
    low, high = map(number, given)
    if not low < high:
        raise ValueError(f'takes limits of "{name}" of which the second is above the first, got {low:g} and {high:g}')
    return low, high


def _to(value: Any) -> dict[str, float] | None:
    """Return values by name. Raises ValueError."""
    if value is None:
        return None
    if not isinstance(value, Mapping) or not value or not all(isinstance(name, str) for name in value):
        raise ValueError("must give values by name", 'such as {"wire@2.5.position.y": 5.3}')
    found = {}
    for name, each in value.items():
        try:
            found[name] = number(each)
        except ValueError as error:
            raise ValueError(f'"{name}" {error.args[0]}') from None
    return found


_LIMITS = {"anyOf": [{"const": FREE}, {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}]}
_ADJUST = {"anyOf": [{"type": "array", "items": {"type": "string"}, "minItems": 1},
                     {"type": "object", "additionalProperties": _LIMITS, "minProperties": 1}]}
_TO = {"type": "object", "additionalProperties": {"type": "number"}, "minProperties": 1}


Wraps = Annotated[str, one_of(("slip", "stick"))]
"""Whether ropes slip on the sheaves on which they have friction, or stick to them."""
IMPENDING = {"hoisting": -1.0, "lowering": 1.0}
"""The motions that ropes are about to begin, with their sense in the order of their routes."""


class EquilibriumSettings(Part):
    """The settings of a static equilibrium.

    load_steps: number of steps in which the loads rise from 0; a step that does not converge is divided
    tolerance: of the last correction of positions, relative to the size of the scene, and of the values in ``to``,
        relative to their scale
    max_iterations: of a load step
    method: "newton", which ends in a stable state, or "arc_length", which follows the path of equilibria, also past
        limit points and along unstable states
    largest_step: of a path, the largest difference of two successive states in the load fraction, and in positions
        relative to the size of the scene
    seek_stable: whether "newton" continues from an unstable state, with an error if it finds no stable one; else the
        result is the unstable state with its label
    scale_gravity: whether load fractions also apply to gravity; else gravity acts in full from the start
    impending: "hoisting" or "lowering", where ropes are about to slide towards their first or their last items: their
        friction is at its limit on all sheaves that are held or whose rotation is prescribed; on a sheave that turns
        freely there is none. By default ropes have no friction
    wraps: whether ropes "slip" without friction on their sheaves, or "stick" to those on which they have friction,
        held ones and those that turn: their material stays on the groove where it lies in the state to begin from, as
        drawn by default; beyond the tangent points it comes with the stretch of the spans there. Parts of a wrap slide
        where friction is at its limit; a wrap that slides as a whole is an error
    adjust: parameters of the scene, by paths as in sweeps, such as "dropper.length", with limits (low, high) or "free",
        that are adjusted until the state has the values ``to``
    to: values of the state by name, such as "A.position.y" or "wire@12.5.tension"
    """

    kind = "equilibrium"
    load_steps: Count = 1
    tolerance: Annotated[float, within(0, 1, ends=False)] = 1e-9
    max_iterations: Count = 50
    method: Annotated[str, one_of(("newton", "arc_length"))] = "newton"
    largest_step: Annotated[float, within(0, 1, ends=False)] = 0.1
    seek_stable: Flag = True
    scale_gravity: Flag = True
    impending: Annotated[str | None, one_of(IMPENDING, optional=True)] = None
    wraps: Wraps = "slip"
    adjust: Annotated[dict[str, Limits] | None, checked(_adjust, _ADJUST)] = None
    to: Annotated[dict[str, float] | None, checked(_to, _TO)] = None

    @model_validator(mode="after")
    def _adjusts_for_something(self) -> "EquilibriumSettings":
        if self.adjust is not None and self.to is None:
            raise ValueError("has parameters to adjust, but no values to adjust them for", "give to={...}")
        if self.to is not None and self.adjust is None:
            raise ValueError("has values to reach, but no parameters to adjust", "give adjust={...}")
        if self.adjust is not None and self.method != "newton":
            raise ValueError("adjusts parameters along no path of equilibria", 'take method="newton"')
        if self.impending is not None and self.method != "newton":
            raise ValueError("has friction of ropes at its limit along no path of equilibria", 'take method="newton"')
        return self

    @model_validator(mode="after")
    def _sticks_in_one_state(self) -> "EquilibriumSettings":
        if not self.sticks:
            return self
        if self.impending is not None:
            raise ValueError(f'has wraps="stick" and impending="{self.impending}"', "give one of them")
        if self.method != "newton":
            raise ValueError("has ropes that stick along no path of equilibria", 'take method="newton"')
        if self.adjust is not None:
            raise ValueError("adjusts no parameters of scenes with ropes that stick", "leave adjust out, or wraps")
        return self

    @property
    def sticks(self) -> bool:
        """Return whether ropes stick to their sheaves."""
        return self.wraps == "stick"

    @property
    def has_friction(self) -> bool:
        """Return whether ropes have friction on their sheaves."""
        return self.sticks or self.impending is not None


class RelaxationSettings(Part):
    """The settings of a relaxation, a damped motion to rest.

    tol: largest residual force relative to the largest load, for states with friction and where Newton's method does
        not reach rounding
    max_steps: of the motion
    """

    kind = "relax"
    tol: Annotated[float, within(0, 1, ends=False)] = 1e-6
    max_steps: Count = 20_000


class ModeSettings(Part):
    """The number of modes, and whether ropes "slip" or "stick" on the sheaves on which they have friction."""

    kind = "modes"
    n: Count
    wraps: Wraps = "slip"


class LinearSettings(Part):
    """The number of modes that a linear model keeps, all by default."""

    kind = "linearise"
    reduce: Count | None = None
