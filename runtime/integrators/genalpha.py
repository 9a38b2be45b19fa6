"""The generalised-alpha method: parameters from the spectral radius."""

from __future__ import annotations

from functools import cache
from typing import ClassVar

import numpy as np

from ..base.deferred import dataclass
from .integrator import Integrator


@dataclass(frozen=True)
class GeneralisedAlpha(Integrator):
    """Implicit, of order 2, with a spectral radius at infinite frequency (Chung & Hulbert 1993).

    Friction by the forces of constraints takes their oscillations from step to step, which follow a change of the step,
    as a force of one sign. With a radius of 0.9 the error then falls with the step, not with its square, and reaches 28
    tol (tests/benchmarks/choice.py, "friction that stops"); with 0.5 they vanish within a few steps.
    """

    spectral_radius: float = 0.9
    name, order, error_overestimate = "genalpha", 2, 2.0
    default_spectral_radius = 0.9
    default_with_friction: ClassVar[float] = 0.5
    loses_energy_by_spectral_radius = True
    cost_of_evaluation = 2.8

    @classmethod
    @cache
    def of(cls, spectral_radius: float | None = None, friction: bool = False) -> Integrator:
        """Return the integrator with this spectral radius, see `Integrator.of`."""
        default = cls.default_with_friction if friction else cls.default_spectral_radius
        return cls(default if spectral_radius is None else spectral_radius)

    @property
    def parameters(self) -> np.ndarray:
        """Return alpha_m, alpha_f, beta, gamma."""
        alpha_m = (2 * self.spectral_radius - 1) / (self.spectral_radius + 1)
        alpha_f = self.spectral_radius / (self.spectral_radius + 1)
        return np.array([alpha_m, alpha_f, (1 - alpha_m + alpha_f) ** 2 / 4, 0.5 - alpha_m + alpha_f])
