"""Stiffness of a section, S of the kernels `stiffness`: what an elastic law takes of section and material.

A further law is one function and one entry in `_LAWS`.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from funicular.materials import Material
from funicular.sections import Section


def section_stiffness(law: str, section: Section, material: Material, dim: int = 3) -> np.ndarray:
    """S of an elastic law.

    law: a name in ``derive/laws``, or "poisson_split"; dim: 2 for a planar element, else 3.
    Returns, in N times even powers of m: (2,) [EA, EI] for cables; for a continuum (9, 6) or, planar, (4, 6): the
    integrals over the section of D11, D22, D33, D12, D13, D23, G12, G13, G23 (planar: D11, D22, D12, G12) times
    1, y², z², y⁴, y²z², z⁴.
    """
    return _LAWS.get(law, _cable)(section, material, dim)


def kernel_law(law: str) -> str:
    """The law whose kernels a law runs on: some differ by the stiffness of the section alone."""
    return "continuum" if law == "poisson_split" else law


def _cable(section: Section, material: Material, dim: int) -> np.ndarray:
    return material.youngs_modulus * section.moments()[:2]


def _continuum(section: Section, material: Material, dim: int) -> np.ndarray:
    """St. Venant-Kirchhoff, alike over the section."""
    return np.outer(_elasticity(material, dim), section.moments())


def _poisson_split(section: Section, material: Material, dim: int) -> np.ndarray:
    """The Poisson effect on the axis alone: an element whose section cannot warp locks under that of bending.

    The section's mean shear takes its shear factors, its twist its torsion constant. Gerstmayr, Matikainen & Mikkola,
    Multibody Syst. Dyn. 20 (2008) 359-384.
    """
    full, moments = _elasticity(material, dim), section.moments()
    lam, mu = material.lame()
    factors = section.shear_factors(lam / (2 * (lam + mu)))[: dim - 1]
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


def _elasticity(material: Material, dim: int) -> np.ndarray:
    """D11, D22, ... of the material; planar: of plane stress, for the width of a beam is free to change."""
    if dim == 3:
        return material.elasticity()
    lam, mu = material.lame()
    lam *= 2 * mu / (lam + 2 * mu)
    return np.array([lam + 2 * mu, lam + 2 * mu, lam, mu])


_LAWS: dict[str, Callable[[Section, Material, int], np.ndarray]] = {
    "continuum": _continuum, "poisson_split": _poisson_split}
