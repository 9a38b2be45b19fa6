"""Materials: isotropic elastic constants, density and damping."""

from math import inf, isclose
from typing import Annotated, cast

import numpy as np
from pydantic import model_validator

from .part import Part
from .validation import bounded, finite, not_negative, positive

INCOMPRESSIBLE = 0.5
"""The largest Poisson ratio: no change of volume."""
MODULUS_TOLERANCE = 1e-5
"""Relative difference of G and E / 3, written with a few digits, that means a Poisson ratio of 0.5."""
PoissonRatio = Annotated[float, bounded("", lambda ratio: -1 < ratio <= INCOMPRESSIBLE, "be above -1 and at most 0.5",
                                        exclusiveMinimum=-1, maximum=INCOMPRESSIBLE)]


class Material(Part):
    """An isotropic St. Venant-Kirchhoff material with Kelvin-Voigt and mass-proportional damping.

    youngs_modulus: Pa
    density: kg/m³
    poisson_ratio: one of this and ``shear_modulus``, or both if they agree; 0.5 suits the laws that need E and G alone:
        of cables, "structural" and planar ones
    shear_modulus: Pa
    damping_time: retardation time τ of stress = elasticity (strain + τ strain rate), s
    mass_damping: α of the force -α density velocity on each volume, as of a surrounding fluid, 1/s
    thermal_expansion: strain free of stress by a rise of temperature, as of the ``temperature`` of a cable, 1/K
    """

    youngs_modulus: Annotated[float, positive("Pa")]
    density: Annotated[float, positive("kg/m³")]
    poisson_ratio: PoissonRatio | None = None
    shear_modulus: Annotated[float, positive("Pa")] | None = None
    damping_time: Annotated[float, not_negative("s")] = 0.0
    mass_damping: Annotated[float, not_negative("1/s")] = 0.0
    thermal_expansion: Annotated[float, finite("1/K")] | None = None

    @model_validator(mode="after")
    def _shear_is_settled(self) -> "Material":
        E, nu, G = self.youngs_modulus, self.poisson_ratio, self.shear_modulus
        if nu is None and G is None:
            raise ValueError("poisson_ratio or shear_modulus is missing", "give one of the two")
        if nu is None and G is not None and G < E / 3 * (1 - MODULUS_TOLERANCE):
            raise ValueError(f"shear_modulus must be at least youngs_modulus / 3 = {E / 3:.9g} Pa, got {G:.9g} Pa",
                             f"the Poisson ratio E / (2 G) - 1 = {E / (2 * G) - 1:.9g} must be above -1 and "
                             "at most 0.5")
        if nu is not None and G is not None and not isclose(G, E / (2 * (1 + nu)), rel_tol=1e-6):
            raise ValueError(f"shear_modulus {G:.9g} Pa and poisson_ratio {nu:.9g} disagree: "
                             f"E / (2 (1 + ν)) = {E / (2 * (1 + nu)):.9g} Pa", "give one of the two")
        return self

    def poisson(self) -> float:
        """Return the Poisson ratio ν, whichever constant was given.

        >>> import funicular as fu
        >>> steel = fu.Material(youngs_modulus=2.1e11, shear_modulus=8.4e10, density=7850)
        >>> round(steel.poisson(), 9)
        0.25
        """
        if self.shear_modulus is None or self.poisson_ratio is not None:
            return cast(float, self.poisson_ratio)  # one of the two is given
        return self.youngs_modulus / (2 * self.shear_modulus) - 1

    @property
    def is_incompressible(self) -> bool:
        """Return whether its Poisson ratio is 0.5, within the digits of E and G."""
        return self.poisson() >= INCOMPRESSIBLE - (MODULUS_TOLERANCE if self.poisson_ratio is None else 0.0)

    def lame(self) -> tuple[float, float]:
        """Return Lamé's constants (λ, μ) in Pa; λ is infinite for an incompressible material."""
        E, nu = self.youngs_modulus, self.poisson()
        if self.is_incompressible:
            return inf, E / (2 * (1 + nu))
        return E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))

    def elasticity(self) -> np.ndarray:
        """Return (9,): the orthotropic constants [D11, D22, D33, D12, D13, D23, G12, G13, G23] in Pa."""
        lam, mu = self.lame()
        return np.array([lam + 2 * mu] * 3 + [lam] * 3 + [mu] * 3)
