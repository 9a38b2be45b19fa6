"""The settings of a run, of searches for rest, and of an analysis of modes."""

from __future__ import annotations

import math
import os
from typing import Annotated, Any, ClassVar

from pydantic import BeforeValidator, Field, model_validator

from ..integrators import AUTO, INTEGRATORS, stable_at
from .part import Part
from .validation import Count, Flag, names, not_negative, one_of, positive, within

SMALLEST_STEP = 1e-12
"""Of the duration, as in engine/run/steps.c."""

ROUNDED = 1e-9
"""Of a number of steps: what it is above a whole number is rounding."""

Duration = Annotated[float, positive("s")]


def default_spectral_radius(integrator: str) -> float:
    """Return the spectral radius where none is given: the integrator's own, else that of the one for fixed steps."""
    own = INTEGRATORS[integrator].default_spectral_radius if integrator in INTEGRATORS else None
    own = stable_at(fixed_step=True).default_spectral_radius if own is None else own
    assert own is not None, "the integrator for fixed steps has one"
    return own


def _text_of_path(value: Any) -> Any:
    return os.fspath(value) if isinstance(value, os.PathLike) else value


class RunSettings(Part):
    """How a scene is run.

    duration in s; tol: the error aimed at in positions, relative to the largest motion in the scene, by which
    the step is chosen; absolute_tol in m is allowed beside it, tol times 1e-6 of the scene's size if not given;
    quantities: results such as "A.position", "wire.position.y" or "trolley.s" that alone count, in the error and in
    the motion that tol is relative to; step: a fixed step in s instead, divided where need be so that steps end on
    output times and where a signal is not smooth; output_step in s, a hundredth of the duration if not given;
    integrator: "explicit" (Runge-Kutta of order 8), "radau" (implicit, order 5, for stiff scenes), "genalpha"
    (implicit, order 2, with control of the dissipation), "energy" (order 2, keeps energy and momenta to rounding),
    or "auto": the cheapest of the first three for this scene and tol, genalpha where step or spectral_radius is given;
    spectral_radius of genalpha (0.9 if not given) and energy (1) at infinity: 1 keeps and 0 removes the fastest
    vibrations, energy's of the cables, counted as dissipated with what their algorithmic stresses hold at the time;
    model: "given", the cables' elements as they are, or "auto": those that were not given, and the integrator, are
    chosen so that the error of model, mesh and time stays below tol, as `Scene.choose` does;
    initial: "drawn", "equilibrium" (static, under the loads at t = 0), "relaxed" (at rest after a damped motion, see
    `Scene.relax`), or "state", one that `Scene.run` is given; save: the file to write, or None; threads that
    share the work on cables of some hundred elements or more, at most as many as there are processors; estimate:
    whether two more runs tell the error of the run, of its steps and of its mesh apart, in ``report["errors"]``, see
    `ErrorEstimate`.
    """

    kind: ClassVar[str] = "run"
    duration: Duration
    tol: Annotated[float, positive()] = 1e-4
    absolute_tol: Annotated[float, not_negative("m")] | None = None
    quantities: Annotated[tuple[str, ...], names()] | None = None
    step: Duration | None = None
    output_step: Duration = Field(default_factory=lambda data: data["duration"] / 100)
    integrator: Annotated[str, one_of((AUTO, *INTEGRATORS))] = AUTO
    spectral_radius: Annotated[float, within(0, 1, ends=True)] = Field(
        default_factory=lambda data: default_spectral_radius(data.get("integrator", AUTO)))
    model: Annotated[str, one_of(("given", "auto"))] = "given"
    initial: Annotated[str, one_of(("drawn", "equilibrium", "relaxed", "state"))] = "drawn"
    save: Annotated[str | None, BeforeValidator(_text_of_path)] = None
    threads: Count = 1
    estimate: Flag = False

    @model_validator(mode="after")
    def _steps_fit(self) -> RunSettings:
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
        """Return the fixed step in s, divided so that steps end on output times; None where tol chooses the steps."""
        if self.step is None:
            return None
        return self.output_step / math.ceil(self.output_step / self.step * (1 - ROUNDED))


class EquilibriumSettings(Part):
    """How a static equilibrium is sought.

    load_steps: in how many steps the loads are raised from 0, more where one does not converge; tolerance: of the
    last correction of positions, relative to the size of the scene; max_iterations of a load step; method: "newton",
    which ends in a stable state, or "arc_length", which follows the path of equilibria, also where the load falls again
    and where they are unstable; largest_step of such a path: what two states that follow each other differ by at most,
    of the load fraction, and of positions relative to the size of the scene; seek_stable: whether "newton" goes on
    where it has come to an unstable state, which else is returned with its label; scale_gravity: whether a load
    fraction p is p times gravity, too, or whether gravity is whole from the start.
    """

    kind: ClassVar[str] = "equilibrium"
    load_steps: Count = 1
    tolerance: Annotated[float, within(0, 1, ends=False)] = 1e-9
    max_iterations: Count = 50
    method: Annotated[str, one_of(("newton", "arc_length"))] = "newton"
    largest_step: Annotated[float, within(0, 1, ends=False)] = 0.1
    seek_stable: Flag = True
    scale_gravity: Flag = True


class RelaxationSettings(Part):
    """How a scene is brought to rest by a damped motion.

    tol: the largest force that may be left over, relative to the largest load, where Newton's method does not find the
    state to rounding, and where friction has part in it; max_steps of the motion.
    """

    kind: ClassVar[str] = "relax"
    tol: Annotated[float, within(0, 1, ends=False)] = 1e-6
    max_steps: Count = 20_000


class ModeSettings(Part):
    """How many modes are sought."""

    kind: ClassVar[str] = "modes"
    n: Count
