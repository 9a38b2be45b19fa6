"""What an integrator says of itself: its name, its parameters, what it can do."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cache
from typing import ClassVar

import numpy as np


@dataclass(frozen=True)
class Demands:
    """What a scene asks of an integrator: highest frequency in rad/s and rate of decay in 1/s of its parts, the rate in
    1/s of its motion as a whole, whether slides rub, and the tolerance.
    """

    frequency: float
    decay: float
    slow: float
    friction: bool
    tol: float


@dataclass(frozen=True)
class StabilityLimit:
    """What the step times the highest frequency, or times the highest rate of decay, must stay below."""

    frequency: float
    decay: float

    def part(self, step: float, frequency: float, decay: float) -> float:
        """Return which part of the limit a step in s takes: 1 and more is unstable."""
        return step * self.steps_per_second(frequency, decay)

    def steps_per_second(self, frequency: float, decay: float) -> float:
        """Return how many steps a second there must be at least."""
        return max(frequency / self.frequency, decay / self.decay)


class Integrator(ABC):
    """A method of integration in time; the engine's part of the same name is in engine/integrators/.

    order: of the error in positions that steps are chosen by; error_overestimate: how much larger the estimate of the
    local error is than that error; retry_factor: what steps stay below for a while after one that failed, as a part of
    that one, 0 where failures are cheap; default_spectral_radius: None where the integrator has none; stability: None
    where steps of any size are stable; loses_energy_by_spectral_radius: whether one below 1 takes energy that
    nothing counts as dissipated; the other flags say which scenes it can run.
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

    @property
    @abstractmethod
    def parameters(self) -> np.ndarray:
        """Return the numbers that the engine's part takes, in the order of its structure."""

    @classmethod
    def of(cls, spectral_radius: float) -> Integrator:
        """Return the integrator with this spectral radius at infinite frequency, if it has one."""
        return _made(cls)

    cost_of_evaluation: ClassVar[float] = 1.0
    """Of an evaluation of eq 38, or of an iteration where these are not counted, with its share of the other work of a
    step, in evaluations alone."""

    @classmethod
    def cost(cls, demands: Demands) -> tuple[float, str] | None:
        """Return what a second of a scene costs, in evaluations of eq 38, and why; None: "auto" does not take it."""
        return None


@cache
def _made(kind: type[Integrator]) -> Integrator:
    """Return the integrator of a kind without parameters: its coefficients are the same in every run."""
    return kind()
