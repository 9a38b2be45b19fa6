"""The energy-momentum method: parameters and capabilities."""

from __future__ import annotations

import numpy as np

from ..base.deferred import dataclass
from .integrator import Integrator


@dataclass(frozen=True)
class EnergyMomentum(Integrator):
    """Implicit, of order 2; keeps energy and momenta to rounding (Simo & Tarnow 1992; Gonzalez 1996).

    Ropes with mass over sheaves have the momenta of their material as a state (derive/couplings/material_step.py), and
    their kinetic energy is that of these momenta; in space on bodies that turn, too (derive/couplings/turning_step.py).
    A run ends where a rope leaves its sheave. Friction that sticks is held by the sliding over each step. Where steps
    do not resolve the vibrations of a light wheel, above all fixed ones, points may stick and slide at one instant
    without end, which ends the run with an error. On ropes act spherical and distance joints, springs, slides, forces,
    loads and drag; where a rope in space flows past a joint or a spring, the angular momentum has an error of second
    order in the step.

    With a spectral radius below 1 at infinite frequency it keeps only momenta, and algorithmic dissipation damps fast
    vibrations of cables (engine/integrators/algorithmic_dissipation.c).
    """

    spectral_radius: float = 1.0
    name, order = "energy", 2
    default_spectral_radius = 1.0
    takes_modal_bodies = takes_friction_and_stops = False
    needs_discrete_gradient = True

    @classmethod
    def of(cls, spectral_radius: float | None = None, friction: bool = False) -> Integrator:
        """Return the integrator with this spectral radius, see `Integrator.of`."""
        return cls(cls.default_spectral_radius if spectral_radius is None else spectral_radius)

    @property
    def parameters(self) -> np.ndarray:
        """Return lag in steps, viscosity, inertia, and the weight that follows from them.

        The modulus 1 + inertia p^2 + viscosity p lag p/(1 + lag p) of elasticity and algorithmic stress equals
        (1 + p/a)^3/(1 + lag p), with p = -a where (1 + p/2)/(1 - p/2) is minus the spectral radius.
        """
        a = 2 * (1 + self.spectral_radius) / (1 - self.spectral_radius) if self.spectral_radius < 1 else np.inf
        lag, inertia, viscosity = 3 / a, 1 / (3 * a**2), 8 / (9 * a)
        return np.array([lag, viscosity, inertia, 2 * viscosity * lag / (2 * lag + 1) + 2 * inertia])
