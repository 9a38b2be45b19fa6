"""The ways through time, as the engine takes them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

HIGH_ORDER_BELOW = 1e-6
"""Tolerances below this are worth a method of order 8."""


@dataclass(frozen=True)
class GeneralisedAlpha:
    """alpha_m, alpha_f, beta, gamma for a spectral radius at infinite frequency (Chung & Hulbert 1993)."""

    spectral_radius: float
    name, order = "genalpha", 2

    @property
    def parameters(self) -> tuple[float, float, float, float]:
        """As fu_genalpha has them."""
        alpha_m = (2 * self.spectral_radius - 1) / (self.spectral_radius + 1)
        alpha_f = self.spectral_radius / (self.spectral_radius + 1)
        return alpha_m, alpha_f, (1 - alpha_m + alpha_f) ** 2 / 4, 0.5 - alpha_m + alpha_f


class Explicit:
    """A Runge-Kutta method of order 5 (Dormand & Prince 1980) or 8 (Hairer, Norsett & Wanner 1993), as scipy has it.

    ``order`` is that of the embedded error estimate, by which steps are chosen.
    """

    name = "explicit"

    def __init__(self, order: int):
        from scipy.integrate import DOP853, RK45

        of = {5: RK45, 8: DOP853}[order]
        self.A, self.b, self.c = np.array(of.A), np.array(of.B), np.array(of.C)
        self.A = np.pad(self.A, [(0, 0), (0, len(self.b) - self.A.shape[1])])
        self.error, self.coarse = (np.array(of.E), None) if order == 5 else (np.array(of.E5), np.array(of.E3))
        self.order = of.error_estimator_order


def explicit(tol: float) -> Explicit:
    """The method that suits a tolerance."""
    return Explicit(8 if tol < HIGH_ORDER_BELOW else 5)
