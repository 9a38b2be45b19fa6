"""Components of section forces along the cable and across it, where a mesh shows how it bends and where it cannot."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from ...parts.cable import Cable
from .balance import Cuts
from .layer import Kink, beside, line_bending

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms, and for type checkers alone

SHOWN = 1e-4
"""Of a kink: where the mesh draws no more of it as an arc, nothing is put in its place."""

CABLE = {
    "tension": ("N", "force along the cable"),
    "shear": ("N", "size of the force across the cable"),
    "strain": ("1", "axial strain of the mesh"),
    "curvature": ("1/m", "size of the curvature strain of the mesh"),
}
BEAM = {
    "tension": ("N", "force along the beam"),
    "shear": ("N", "size of the force across the beam"),
    "shear_y": ("N", "force along the section's height"),
    "shear_z": ("N", "force along the section's width"),
    "torque": ("N m", "moment about the tangent"),
    "moment_y": ("N m", "moment about the section's height"),
    "moment_z": ("N m", "moment about the section's width"),
    "strain": ("1", "axial strain of the mesh"),
    "shear_strain_y": ("1", "shear strain of the mesh along the height"),
    "shear_strain_z": ("1", "shear strain of the mesh along the width"),
    "twist": ("1/m", "torsion strain of the mesh"),
    "curvature_y": ("1/m", "curvature strain of the mesh about the height"),
    "curvature_z": ("1/m", "curvature strain of the mesh about the width"),
}


def labels(cable: Cable) -> dict[str, tuple[str, str]]:
    """Return unit and long name of each component."""
    return BEAM if cable.kind_of_element.director else CABLE


def components(cable: Cable, force: np.ndarray, moment: np.ndarray, axes: np.ndarray,
               strain: np.ndarray) -> dict[str, np.ndarray]:
    """Return the components that `labels` names, (T, n): of force and moment (T, n, 3) along axes (T, n, 3, 3)."""
    along = np.einsum("tsi,tsi->ts", force, axes[..., 0, :])
    return _named(cable, along, force - along[..., None] * axes[..., 0, :], moment, axes, strain)


def unresolved(cable: Cable, force: np.ndarray, length: ArrayLike) -> np.ndarray:
    """Return (T, n): how much of a kink elements of a length (m) draw as an arc, from 0, nothing, to 1, all.

    Under an axial force N a cable bends beside a point force over sqrt(E I / N) alone, a cubic over an element of
    length l. N l^2 is what tension has of the stiffness against a kink, 12 E I what bending has: with their ratio x it
    is x^2/(1 + x^2).
    """
    yy, zz = cable.section.moments()[1:3]
    bending = 12 * cable.material.youngs_modulus * (yy if cable.dim == 2 else max(yy, zz))
    x = np.linalg.norm(force, axis=-1) * np.square(length) / bending
    return x**2 / (1 + x**2)


def taut_bending(cable: Cable, force: np.ndarray, change: np.ndarray, axes: np.ndarray, cuts: Cuts,
                 kinks: Callable[[], list[Kink]]) -> np.ndarray:
    """Return (T, n, 3): the moment of bending that a taut cable has along the line of its force, see
    results/section_forces/layer.py.

    Nil where the mesh shows all, and in compression.
    """
    pulls = np.einsum("tsi,tsi->ts", force, axes[..., 0, :]) > 0
    if not np.any(pulls & (unresolved(cable, force, cable.mesh.each_length(cuts.element)) > SHOWN)):
        return np.zeros_like(force)
    E, (yy, zz) = cable.material.youngs_modulus, cable.section.moments()[1:3]

    def stiffness(about: np.ndarray) -> np.ndarray:
        if cable.dim == 2 or yy == zz:
            return np.full(force.shape[:2], E * yy)
        by_y, by_z = (np.einsum("tsi,tsi->ts", axes[..., k, :], np.broadcast_to(about, force.shape)) ** 2
                      for k in (1, 2))
        return E * (zz * by_y + yy * by_z) / _not_zero(by_y + by_z)

    moment = line_bending(stiffness, force, change)
    for kink in kinks():
        moment = moment + beside(kink, cuts.s, cuts.after, stiffness, force)
    return np.where(pulls[..., None], moment, 0.0)


def balanced_components(cable: Cable, balance: tuple[np.ndarray, np.ndarray], law: tuple[np.ndarray, np.ndarray],
                        taut: np.ndarray, axes: np.ndarray, strain: np.ndarray, cuts: Cuts) -> dict[str, np.ndarray]:
    """Return force, moment and components in balance; (force, moment) of the balance and of the elastic law, (T, n, 3).

    Where a mesh cannot show how a taut cable bends, its tangent beside a kink is off, and so are the points of its
    centreline. The force across that tangent is then no shear, nor is the force's moment about those points bending.
    There, by the part that `unresolved` gives, the angle between force and tangent is the one that the elastic law has,
    and the moment across the tangent is that of `taut_bending`. A force's size and direction, and torque, stay.
    """
    force, moment = balance
    w, tangent = unresolved(cable, force, cable.mesh.each_length(cuts.element)), axes[..., 0, :]

    def parts(vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        along = np.einsum("tsi,tsi->ts", vector, tangent)
        return along, vector - along[..., None] * tangent

    (along, across), (_, bent) = parts(force), parts(law[0])
    size, off, by_law = (np.linalg.norm(value, axis=-1) for value in (force, across, bent))
    angle = (1 - w) * np.arctan2(off, np.abs(along)) + w * np.arcsin(np.minimum(by_law, size) / _not_zero(size))
    tension = np.copysign(size * np.cos(angle), along)
    shear = (1 - w)[..., None] * across + w[..., None] * bent
    shear = shear * (size * np.sin(angle) / _not_zero(np.linalg.norm(shear, axis=-1)))[..., None]
    bending = parts(np.where((along > 0)[..., None], taut, law[1]))[1]
    moment = moment + w[..., None] * (bending - parts(moment)[1])
    return {"force": force, "moment": moment} | _named(cable, tension, shear, moment, axes, strain)


def _not_zero(value: np.ndarray) -> np.ndarray:
    return np.where(value > 0, value, 1.0)


def _named(cable: Cable, tension: np.ndarray, shear: np.ndarray, moment: np.ndarray, axes: np.ndarray,
           strain: np.ndarray) -> dict[str, np.ndarray]:
    size, strains = np.linalg.norm(shear, axis=-1), np.moveaxis(strain, -1, 0)
    if not cable.kind_of_element.director:
        return {"tension": tension, "shear": size, "strain": strains[0], "curvature": strains[5]}
    moments = np.moveaxis(np.einsum("tsij,tsj->tsi", axes, moment), -1, 0)
    shears = (np.einsum("tsi,tsi->ts", axes[..., k, :], shear) for k in (1, 2))
    return dict(zip(BEAM, (tension, size, *shears, *moments, *strains), strict=True))
