"""Materials."""

from __future__ import annotations

from math import isclose
from typing import Annotated

import numpy as np
from funicular.validation import Part, not_negative, positive, within
from pydantic import model_validator

POISSON_RANGE = (-1.0, 0.5)


class Material(Part):
    """An isotropic St. Venant-Kirchhoff material with Kelvin-Voigt and mass-proportional damping.

    youngs_modulus in Pa; density in kg/m³; one of poisson_ratio (1) and shear_modulus (Pa), or both if they
    agree; damping_time: the retardation time τ in s, stress = elasticity (strain + τ strain rate); mass_damping: the
    α in 1/s of the force -α density velocity on each volume, as of a surrounding fluid.
    """

    youngs_modulus: Annotated[float, positive("Pa")]
    density: Annotated[float, positive("kg/m³")]
    poisson_ratio: Annotated[float, within(*POISSON_RANGE, ends=False)] | None = None
    shear_modulus: Annotated[float, positive("Pa")] | None = None
    damping_time: Annotated[float, not_negative("s")] = 0.0
    mass_damping: Annotated[float, not_negative("1/s")] = 0.0

    @model_validator(mode="after")
    def _shear_is_settled(self) -> Material:
        E, nu, G = self.youngs_modulus, self.poisson_ratio, self.shear_modulus
        if nu is None and G is None:
            raise ValueError("poisson_ratio or shear_modulus is missing", "give one of the two")
        if nu is None and not E / (2 * G) - 1 < POISSON_RANGE[1]:
            raise ValueError(
                f"shear_modulus must be above youngs_modulus / 3 = {E / 3:.6g} Pa, got {G:g} Pa",
                f"the Poisson ratio would be {E / (2 * G) - 1:.6g}, which must lie inside (-1, 0.5)",
            )
        if nu is not None and G is not None and not isclose(G, E / (2 * (1 + nu)), rel_tol=1e-6):
            raise ValueError(
                f"shear_modulus {G:g} Pa and poisson_ratio {nu:g} disagree: "
                f"E / (2 (1 + ν)) = {E / (2 * (1 + nu)):.6g} Pa",
                "give one of the two",
            )
        return self

    def poisson(self) -> float:
        """The Poisson ratio ν, whichever constant was given."""
        if self.poisson_ratio is not None:
            return self.poisson_ratio
        return self.youngs_modulus / (2 * self.shear_modulus) - 1

    def lame(self) -> tuple[float, float]:
        """Lamé's constants (λ, μ) in Pa."""
        E, nu = self.youngs_modulus, self.poisson()
        return E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))

    def elasticity(self) -> np.ndarray:
        """The orthotropic constants of the stiffness.

        Returns (9,): [D11, D22, D33, D12, D13, D23, G12, G13, G23] in Pa.
        """
        lam, mu = self.lame()
        return np.array([lam + 2 * mu] * 3 + [lam] * 3 + [mu] * 3)
