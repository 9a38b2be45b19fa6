"""Stiffness of a section in an elastic law, S of the kernels `stiffness`.

A further law is one function and one entry in `_BY_KIND`, or in `variants` if it runs on the kernels of another one.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import cast

import numpy as np

from ..base.deferred import dataclass
from ..kernels.elements import built_in_laws
from .cubic_segments import RESIDUAL_STIFFNESS, TRANSITION_STRAIN
from .material import Material
from .section import Section
from .tension_table import TensionTable


def section_stiffness(law: str, section: Section, material: Material, dim: int = 3) -> np.ndarray:
    """Return S of an elastic law, in N times even powers of m.

    law: of this package, or one of `variants`; dim: 2 for a planar element, else 3. Cables: (2,) [EA, EI], (3,) with an
    assumed axial strain, see `_assumed`, (4,) without stiffness in compression, see `_tension_only`, (147,) by a table,
    see `_tabulated`. Continuum: (9, 6), planar (4, 6), the integrals over the section of D11, D22, D33, D12, D13, D23,
    G12, G13, G23 (planar: D11, D22, D12, G12) times 1, y², z², y⁴, y²z², z⁴. Structural: (10,), planar (4,), see
    `_structural`.
    """
    if law in variants():
        return variants()[law].stiffness(section, material, dim)
    traits = built_in_laws()[law]
    return _BY_KIND[traits.kind, traits.membrane](section, material, dim)


def lengths_in_stiffness(law: str, section: Section, material: Material, dim: int = 3) -> np.ndarray:
    """Return, in the shape of S, the power of length of each number: 2 for an area, 4 for a second moment, 0 for zeros
    and numbers without a unit.
    """
    S = section_stiffness(law, section, material, dim)
    doubled = section_stiffness(law, cast(Section, _Doubled(section)), material, dim)
    return np.rint(np.log2(np.divide(doubled, S, out=np.ones_like(S), where=S != 0)))


@dataclass(frozen=True)
class _Doubled:
    """A section of twice the size."""

    section: Section

    def moments(self) -> np.ndarray:
        """Return the moments of the scaled section."""
        return self.section.moments() * 2.0 ** np.array([2, 4, 4, 6, 6, 6])

    def shear_factors(self, poisson_ratio: float) -> tuple[float, float]:
        """Return its shear factors."""
        return self.section.shear_factors(poisson_ratio)

    @property
    def torsion_constant(self) -> float:
        """Return its torsion constant in m⁴."""
        return 16.0 * self.section.torsion_constant

    @property
    def torque_per_tension(self) -> float:
        """Return its torque per tension in m."""
        return 2.0 * self.section.torque_per_tension

    @property
    def tension_table(self) -> TensionTable | None:
        """Return its table, of forces that do not change with its size."""
        return self.section.tension_table


@dataclass(frozen=True)
class Variant:
    """A law that differs from another one only by the stiffness of the section.

    kernel_law: the other law, whose kernels it uses; membrane: representation of the axial strain of a cable.
    """

    kernel_law: str
    stiffness: Callable[[Section, Material, int], np.ndarray]
    membrane: str = ""


@cache
def variants() -> dict[str, Variant]:
    """Return the variants by name: "poisson_split", and for each assumed strain of a cable the reduced one."""
    reduced = {law_of_measures(traits.strain, traits.curvature, "reduced"): Variant(law, _reduced, "reduced")
               for law, traits in built_in_laws().items() if traits.membrane == "assumed"}
    return {"poisson_split": Variant("continuum", _poisson_split)} | reduced


def law_of_measures(strain: str, curvature: str, membrane: str) -> str:
    """Return the name of a cable's law by its measures."""
    return "_".join([strain, curvature, *([membrane] if membrane != "full" else [])])


def measures_of_law(law: str) -> dict[str, str]:
    """Return the measures in the name of a cable's law by keyword; empty for another law."""
    measures = dict(zip(("strain", "curvature", "membrane"), (*law.split("_", 2), "full"), strict=False))
    return measures if len(measures) == 3 and law_of_measures(**measures) == law else {}


STABILISATION = 0.01
"""Stiffness of the upper modes of a reduced axial strain over the axial stiffness."""


def kernel_law(law: str) -> str:
    """Return the law whose kernels a law runs on."""
    return variants()[law].kernel_law if law in variants() else law


def is_reduced(law: str) -> bool:
    """Return whether a cable's law has a reduced axial strain."""
    return law in variants() and variants()[law].membrane == "reduced"


def _cable(section: Section, material: Material, dim: int) -> np.ndarray:
    return material.youngs_modulus * section.moments()[:2]


def _assumed(section: Section, material: Material, dim: int) -> np.ndarray:
    """Return EA, EI, and EA of the modes of axial strain that depend only on the lengths of the slopes."""
    EA, EI = _cable(section, material, dim)
    return np.array([EA, EI, EA])


def _tension_only(section: Section, material: Material, dim: int) -> np.ndarray:
    """Return EA, EI, the part of EA that remains in compression, and the strain of the transition."""
    return np.array([*_cable(section, material, dim), RESIDUAL_STIFFNESS, TRANSITION_STRAIN])


def _tabulated(section: Section, material: Material, dim: int) -> np.ndarray:
    """Return EA, EI, and the segments of the axial force."""
    assert section.tension_table is not None, f"{section.where} has no tension_table"
    return np.concatenate([_cable(section, material, dim), section.tension_table.numbers()])


def compressive_stiffness(membrane: str, section: Section, material: Material) -> float:
    """Return the axial stiffness of a cable in compression, in N."""
    if section.tension_table is not None:
        return section.tension_table.compressive_stiffness
    part = RESIDUAL_STIFFNESS if membrane == "tension_only" else 1.0
    return part * float(_cable(section, material, 3)[0])


def _reduced(section: Section, material: Material, dim: int) -> np.ndarray:
    """Return EA, EI, and the stiffness that stabilises the lengths of the slopes."""
    EA, EI = _cable(section, material, dim)
    return np.array([EA, EI, STABILISATION * EA])


def _continuum(section: Section, material: Material, dim: int) -> np.ndarray:
    """Return S of the St. Venant-Kirchhoff law of a homogeneous section."""
    return np.outer(_elasticity(material, dim), section.moments())


def _poisson_split(section: Section, material: Material, dim: int) -> np.ndarray:
    """Return S with the Poisson effect only on the axis: that of bending locks an element whose section cannot warp.

    Mean shear has shear factors, torsion the torsion constant (Gerstmayr, Matikainen & Mikkola, Multibody Syst. Dyn. 20
    (2008) 359-384).
    """
    full, moments = _elasticity(material, dim), section.moments()
    _, mu = material.lame()
    factors = section.shear_factors(material.poisson())[: dim - 1]
    shears = slice(-3, -1) if dim == 3 else slice(-1, None)  # G12, G13; planar G12
    free = full * 0
    free[:dim] = material.youngs_modulus
    free[dim * (dim + 1) // 2 :] = mu
    S = np.outer(free, moments)
    S[:, 0] += (full - free) * moments[0]
    S[shears, 0] *= factors
    if dim == 3:
        S[shears, 1:] *= section.torsion_constant / (moments[1] + moments[2])
    return S


def _structural(section: Section, material: Material, dim: int) -> np.ndarray:
    """Return EA, GA_y, GA_z, GJ, EI about y and about z, the stiffness of the strains of height, width and angle, and
    that of the torque by stretch.

    GA includes the shear factors. The strains of the section do not contribute to bending; their stiffness is that of
    the material under uniaxial stress. Planar: EA, GA_y, EI about z, and the stiffness of the height.
    """
    E, (_, G) = material.youngs_modulus, material.lame()
    area, yy, zz = section.moments()[:3]
    k_y, k_z = section.shear_factors(material.poisson())
    if dim == 2:
        return np.array([E * area, k_y * G * area, E * yy, E * area])
    return np.array([E * area, k_y * G * area, k_z * G * area, G * section.torsion_constant, E * zz, E * yy,
                     E * area, E * area, G * area, E * area * section.torque_per_tension])


def _elasticity(material: Material, dim: int) -> np.ndarray:
    """Return D11, D22, ... of the material; planar: of plane stress, as the width of a beam is free."""
    if dim == 3:
        return material.elasticity()
    lam, mu = material.lame()
    lam = 2 * mu if np.isinf(lam) else lam * (2 * mu / (lam + 2 * mu))
    return np.array([lam + 2 * mu, lam + 2 * mu, lam, mu])


_BY_KIND: dict[tuple[str, str], Callable[[Section, Material, int], np.ndarray]] = {
    ("continuum", ""): _continuum, ("structural", ""): _structural, ("cable", "full"): _cable,
    ("cable", "assumed"): _assumed, ("cable", "tension_only"): _tension_only, ("cable", "tabulated"): _tabulated}
"""By kind of the law and membrane, see `LawTraits`."""
