"""Components of section forces along and across the cable, on meshes that resolve its bending and on coarser ones."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from ...parts.cable import Cable
from ...parts.piece import UniformPiece
from .balance import Cuts, of_cuts
from .layer import Kink, beside, line_bending

MIN_UNRESOLVED = 1e-4
"""Smallest value of `unresolved` at which bending is corrected."""

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
    """Return the components (T, n), named by `labels`, of force and moment (T, n, 3) along axes (T, n, 3, 3)."""
    return _named(cable, *_split(force, axes[..., 0, :]), moment, axes, strain)


def _split(vector: np.ndarray, tangent: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the component (T, n) of vectors (T, n, 3) along the tangent, and their transverse part (T, n, 3)."""
    along = np.einsum("tsi,tsi->ts", vector, tangent)
    return along, vector - along[..., None] * tangent


def unresolved(cable: Cable, force: np.ndarray, element: np.ndarray, growth: np.ndarray) -> np.ndarray:
    """Return the part (T, n) of a kink that elements of these numbers (T or 1, n) smear into an arc, 0 to 1.

    growth (T, n): of the elements, see `ElementForces`.

    Under an axial force N a cable bends beside a point force over sqrt(E I / N), a cubic over an element of length l.
    N l^2 and 12 E I are the shares of tension and bending in the stiffness against a kink; with their ratio x, the part
    is x^2/(1 + x^2).
    """
    bending = 12 * of_cuts(cable, element, lambda piece: piece.material.youngs_modulus * float(
        max(piece.section.moments()[1 : cable.dim])))
    tension = np.linalg.norm(force, axis=-1) * np.square(growth * cable.mesh.each_length(element))
    x = np.divide(tension, bending, out=np.full(np.shape(tension), 1e100), where=np.broadcast_to(
        np.greater(bending, 0.0), np.shape(tension)))  # without bending stiffness it is all of it
    return np.asarray(x**2 / (1 + x**2))


def _bending(k: int, piece: UniformPiece) -> float:
    """Return Young's modulus times a moment of the section of a piece."""
    return piece.material.youngs_modulus * float(piece.section.moments()[k])


def taut_bending(cable: Cable, force: np.ndarray, change: np.ndarray, axes: np.ndarray, cuts: Cuts,
                 growth: np.ndarray, kinks: Callable[[], list[Kink]]) -> np.ndarray:
    """Return the bending moment (T, n, 3) of a taut cable along the line of its force, see layer.py.

    Zero where the mesh resolves the bending, and in compression.
    """
    pulls = np.einsum("tsi,tsi->ts", force, axes[..., 0, :]) > 0
    if not np.any(pulls & (unresolved(cable, force, cuts.element, growth) > MIN_UNRESOLVED)):
        return np.zeros_like(force)
    yy, zz = (of_cuts(cable, cuts.element, partial(_bending, k)) for k in (1, 2))

    def stiffness(about: np.ndarray) -> np.ndarray:
        if cable.dim == 2 or np.all(yy == zz):
            return np.broadcast_to(yy, force.shape[:2])
        by_y, by_z = (np.einsum("tsi,tsi->ts", axes[..., k, :], np.broadcast_to(about, force.shape)) ** 2
                      for k in (1, 2))
        return np.asarray((zz * by_y + yy * by_z) / _not_zero(by_y + by_z))

    moment = line_bending(stiffness, force, change)
    for kink in kinks():
        moment = moment + beside(kink, cuts.s, cuts.after, stiffness, force, growth)
    return np.where(pulls[..., None], moment, 0.0)


def balanced_components(cable: Cable, balance: tuple[np.ndarray, np.ndarray], law: tuple[np.ndarray, np.ndarray],
                        taut: np.ndarray, axes: np.ndarray, strain: np.ndarray, cuts: Cuts,
                        growth: np.ndarray) -> dict[str, np.ndarray]:
    """Return force, moment and components in balance; balance, law: (force, moment), each (T, n, 3).

    A mesh too coarse for the bending of a taut cable has a wrong tangent and wrong points of the centreline beside a
    kink. The force across this tangent is then no shear, and its moment about these points no bending. There, weighted
    by `unresolved`, the angle between force and tangent is that of the elastic law, and the transverse moment that of
    `taut_bending`. Size and direction of the force, and torque, stay.
    """
    force, moment = balance
    w, tangent = unresolved(cable, force, cuts.element, growth), axes[..., 0, :]
    (along, across), (_, bent) = _split(force, tangent), _split(law[0], tangent)
    size, off, by_law = (np.linalg.norm(value, axis=-1) for value in (force, across, bent))
    angle = (1 - w) * np.arctan2(off, np.abs(along)) + w * np.arcsin(np.minimum(by_law, size) / _not_zero(size))
    tension = np.copysign(size * np.cos(angle), along)
    shear = (1 - w)[..., None] * across + w[..., None] * bent
    shear = shear * (size * np.sin(angle) / _not_zero(np.linalg.norm(shear, axis=-1)))[..., None]
    bending = _split(np.where((along > 0)[..., None], taut, law[1]), tangent)[1]
    moment = moment + w[..., None] * (bending - _split(moment, tangent)[1])
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
