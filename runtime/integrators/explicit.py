"""An explicit Runge-Kutta method."""

from __future__ import annotations

import numpy as np

from . import dormand_prince as method
from .integrator import Demands, Integrator, StabilityLimit


class Explicit(Integrator):
    """The Runge-Kutta method of order 8 of Dormand & Prince (Hairer, Norsett & Wanner 1993, DOP853).

    Steps are chosen by its error estimate of order 7. Methods of order 5 have a third of its imaginary stability
    interval per evaluation, so that it is cheaper at any tolerance. The stability limit is that of step control: the
    imaginary stability interval of the method is 5.96, its real one 6.40.
    """

    name, order = "explicit", method.ERROR_ORDER
    stability = StabilityLimit(frequency=4.5, decay=6.0)

    @property
    def parameters(self) -> np.ndarray:
        """Return the number of stages, then A, b, c, and the weights of the two error estimates."""
        return np.concatenate([[method.STAGES], method.A.ravel(), method.B, method.C, method.ERROR,
                               method.COARSE_ERROR])

    @classmethod
    def cost(cls, demands: Demands) -> tuple[float, str]:
        """Return the evaluations per second that stability requires."""
        cost = method.STAGES * cls.stability.steps_per_second(demands.frequency, demands.decay)
        decay = f", fastest decay {demands.decay:.3g} 1/s" if demands.decay else ""
        return cost, (f"stability of the explicit method requires {cost:.3g} evaluations a second (highest frequency "
                      f"{demands.frequency:.3g} rad/s{decay})")
