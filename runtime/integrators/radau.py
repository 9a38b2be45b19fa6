"""A collocation method for stiff scenes."""

from __future__ import annotations

import numpy as np

from .integrator import Demands, Integrator

EVALUATIONS_PER_RADIAN = 4e3
"""Evaluations of eq 38 per radian of the motion as a whole at tol = 1e-4 (tests/benchmarks/choice.py), proportional to
the third root of 1/tol."""
FRICTION_COST_FACTOR = 2.0
"""Factor for friction: its kink at a change of sign of the normal force needs short steps, as do vibrations of this
force, which radau would damp."""


class Radau(Integrator):
    """Radau IIA of three stages, of order 5 (Hairer & Wanner 1996, IV.5 and IV.8), from its nodes.

    Steps are chosen by an embedded estimate of order 3 and, for vibrations, by an estimate of the method's order that
    follows from it (engine/integrators/radau.c). Factorisations are expensive, so that steps after a failed one are
    limited.
    """

    name, order, retry_factor = "radau", 3, 0.65
    cost_of_evaluation = 2.8

    def __init__(self) -> None:
        root = np.sqrt(6.0)
        self.c = np.array([(4 - root) / 10, (4 + root) / 10, 1.0])
        powers = np.arange(3)
        values = self.c[:, None] ** powers  # of monomials at the nodes; their integrals from 0 to the nodes
        self.A = (self.c[:, None] ** (powers + 1) / (powers + 1)) @ np.linalg.inv(values)
        self.A_inverse = np.linalg.inv(self.A)
        eigenvalues, vectors = np.linalg.eig(self.A_inverse)
        real = int(np.argmin(np.abs(eigenvalues.imag)))
        up = int(np.argmax(eigenvalues.imag))
        self.gamma, self.alpha, self.beta = eigenvalues[real].real, eigenvalues[up].real, -eigenvalues[up].imag
        self.T = np.column_stack([vectors[:, real].real, vectors[:, up].real, vectors[:, up].imag])
        self.T_inverse = np.linalg.inv(self.T)
        # weights with 1/gamma at the start, of order 3; less those of the method, over gamma's share and by A^-1
        at_start = 1 / self.gamma
        embedded = np.linalg.solve(values.T, 1 / (powers + 1) - at_start * (powers == 0))
        self.error = (embedded - self.A[-1]) @ self.A_inverse / at_start

    @property
    def parameters(self) -> np.ndarray:
        """Return A, A^-1, c, T, T^-1, gamma, alpha, beta, and the weights of the error estimate."""
        return np.concatenate([self.A.ravel(), self.A_inverse.ravel(), self.c, self.T.ravel(), self.T_inverse.ravel(),
                               [self.gamma, self.alpha, self.beta], self.error])

    @classmethod
    def cost(cls, demands: Demands) -> tuple[float, str]:
        """Return the evaluations per second for the motion as a whole at the tolerance."""
        cost = EVALUATIONS_PER_RADIAN * demands.slow * (1e-4 / demands.tol) ** (1 / 3)
        if demands.friction:
            cost *= FRICTION_COST_FACTOR
        return cost, f"tol requires work of radau like {cost:.3g}"
