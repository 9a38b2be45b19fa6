"""The generalised-alpha method: parameters from the spectral radius."""

from __future__ import annotations

import numpy as np

from ..base.deferred import dataclass
from .integrator import Integrator


@dataclass(frozen=True)
class GeneralisedAlpha(Integrator):
    """Implicit, of order 2, with a spectral radius at infinite frequency (Chung & Hulbert 1993)."""

    spectral_radius: float = 0.9
    name, order, error_overestimate = "genalpha", 2, 2.0
    default_spectral_radius = 0.9
    loses_energy_by_spectral_radius = True
    cost_of_evaluation = 2.8

    @classmethod
    def of(cls, spectral_radius: float) -> Integrator:
        """Return the integrator with this spectral radius, see `Integrator.of`."""
        return cls(spectral_radius)

    @property
    def parameters(self) -> np.ndarray:
        """Return alpha_m, alpha_f, beta, gamma."""
        alpha_m = (2 * self.spectral_radius - 1) / (self.spectral_radius + 1)
        alpha_f = self.spectral_radius / (self.spectral_radius + 1)
        return np.array([alpha_m, alpha_f, (1 - alpha_m + alpha_f) ** 2 / 4, 0.5 - alpha_m + alpha_f])
