"""Base of integrators: name, parameters, capabilities, cost."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cache
from typing import ClassVar

import numpy as np

from ..base.deferred import dataclass


@dataclass(frozen=True)
class Demands:
    """Demands of a scene on an integrator: highest frequency, rad/s, and rate of decay, 1/s, of its parts, rate of its
    motion as a whole, 1/s, friction of slides, and the tolerance.
    """

    frequency: float
    decay: float
    slow: float
    friction: bool
    tol: float


@dataclass(frozen=True)
class StabilityLimit:
    """Upper bounds of the step times the highest frequency and times the highest rate of decay."""

    frequency: float
    decay: float

    def part(self, step: float, frequency: float, decay: float) -> float:
        """Return a step in s as a fraction of the limit; from 1 on it is unstable."""
        return step * self.steps_per_second(frequency, decay)

    def steps_per_second(self, frequency: float, decay: float) -> float:
        """Return the least number of steps per second."""
        return max(frequency / self.frequency, decay / self.decay)


class Integrator(ABC):
    """A method of integration in time; the engine's part of the same name is in engine/integrators/.

    order: of the error in positions that steps are chosen by; error_overestimate: ratio of the estimate to the local
    error; retry_factor: bound of the steps after a failed one, as a fraction of it, 0 where failures are cheap;
    default_spectral_radius: None without a spectral radius; stability: None for unconditional stability;
    loses_energy_by_spectral_radius: whether a radius below 1 dissipates energy that the balance does not count; the
    other flags say which scenes it can run.
    """

    name: ClassVar[str]
    order: int
    error_overestimate: ClassVar[float] = 1.0
    retry_factor: ClassVar[float] = 0.0
    default_spectral_radius: ClassVar[float | None] = None
    stability: ClassVar[StabilityLimit | None] = None
    loses_energy_by_spectral_radius: ClassVar[bool] = False
    takes_modal_bodies: ClassVar[bool] = True
    takes_friction_and_stops: ClassVar[bool] = True
    needs_discrete_gradient: ClassVar[bool] = False
    is_linear: ClassVar[bool] = False
    """Whether it takes the linear model of motion about the start."""

    @property
    @abstractmethod
    def parameters(self) -> np.ndarray:
        """Return the parameters in the order of the engine's structure."""

    @classmethod
    def of(cls, spectral_radius: float | None = None, friction: bool = False) -> Integrator:
        """Return the integrator, with this spectral radius at infinite frequency if it has one.

        None: the default, which may be another one for scenes with friction by forces of constraints.
        """
        return _made(cls)

    cost_of_evaluation: ClassVar[float] = 1.0
    """Cost of an evaluation of eq 38, or of an iteration, with the rest of the step, in evaluations."""

    @classmethod
    def cost(cls, demands: Demands) -> tuple[float, str] | None:
        """Return the cost of a second of a scene in evaluations of eq 38, and its reason; None: not for "auto"."""
        return None


@cache
def _made(kind: type[Integrator]) -> Integrator:
    """Return the integrator of a class without parameters, made once."""
    return kind()
