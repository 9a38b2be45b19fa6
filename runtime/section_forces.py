"""Section forces: what one part of a cable exerts on the other across a cut, by the elastic law (not by damping)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from funicular.cables import EXACT, Cable
from funicular.errors import FunicularError, UnknownResultError, near
from funicular.libraries import kernels_of
from funicular.stiffness import section_stiffness
from funicular.validation import show

if TYPE_CHECKING:
    import xarray
    from funicular.equilibrium import Equilibrium
    from funicular.results import Run

PLACES = 8
"""Places on each element, where none are asked for."""

GLOBAL = {
    "force": ("N", "force on the part before the cut"),
    "moment": ("N m", "moment on the part before the cut"),
}
CABLE = {
    "tension": ("N", "force along the tangent"),
    "shear": ("N", "size of the force across the tangent"),
    "strain": ("1", "axial strain"),
    "curvature": ("1/m", "size of the curvature strain"),
}
BEAM = {
    "tension": ("N", "force along the tangent"),
    "shear": ("N", "size of the force across the tangent"),
    "shear_y": ("N", "force along the section's height"),
    "shear_z": ("N", "force along the section's width"),
    "torque": ("N m", "moment about the tangent"),
    "moment_y": ("N m", "moment about the section's height"),
    "moment_z": ("N m", "moment about the section's width"),
    "strain": ("1", "axial strain"),
    "shear_strain_y": ("1", "shear strain along the height"),
    "shear_strain_z": ("1", "shear strain along the width"),
    "twist": ("1/m", "torsion strain"),
    "curvature_y": ("1/m", "curvature strain about the height"),
    "curvature_z": ("1/m", "curvature strain about the width"),
}


def section_forces(cable: Cable, nodal_vectors: np.ndarray, s: np.ndarray) -> dict[str, np.ndarray]:
    """The forces in sections of a cable.

    nodal_vectors: (times, nodes, vectors, 3); s: (n,) arc-lengths in m. At a node, where the forces of an element
    may jump, those of the element that begins there. Returns force and moment (times, n, 3), along the ground's axes,
    and the components that `CABLE` or `BEAM` lists (times, n).
    """
    kernel = getattr(kernels_of(cable.library), f"{cable.element}_{cable.kernel_law}_section_forces")
    length, dim = cable.length / cable.elements, cable.dim
    stiffness = section_stiffness(cable.stiffness_law, cable.section, cable.material, dim)
    element = np.clip(np.floor(s / length * (1 + EXACT)).astype(int), 0, cable.elements - 1)
    reference = cable.reference
    shape = (len(nodal_vectors), len(s))
    force, moment, strain = (np.zeros((*shape, n)) for n in (3, 3, 6))
    axes = np.zeros((*shape, 3, 3))
    for k, (place, at) in enumerate(zip(s, element, strict=True)):
        x = min(max(place - at * length, 0.0), length)
        e0 = [] if reference is None else [reference[at]]
        for time, e in enumerate(nodal_vectors[:, at : at + 2, :, :dim].reshape(len(nodal_vectors), -1, dim)):
            cut = kernel(length, x, e, stiffness, *e0)
            force[time, k], moment[time, k], axes[time, k], strain[time, k] = cut
    return {"force": force, "moment": moment} | _components(cable, force, moment, axes, strain)


def _components(cable: Cable, force, moment, axes, strain) -> dict[str, np.ndarray]:
    tension, shear_y, shear_z = np.moveaxis(np.einsum("tsij,tsj->tsi", axes, force), -1, 0)
    across = np.linalg.norm(force - tension[..., None] * axes[..., 0, :], axis=-1)
    strains = np.moveaxis(strain, -1, 0)
    if not cable.kind_of_element.director:
        return {"tension": tension, "shear": across, "strain": strains[0], "curvature": strains[5]}
    moments = np.moveaxis(np.einsum("tsij,tsj->tsi", axes, moment), -1, 0)
    return dict(zip(BEAM, (tension, across, shear_y, shear_z, *moments, *strains), strict=True))


def dataset(state: Run | Equilibrium, name: str, s=None) -> xarray.Dataset:
    """See `Run.section_forces`; of an equilibrium without the time."""
    import xarray

    cables = state.scene.cables
    name = getattr(name, "name", name)
    if name not in cables:
        raise UnknownResultError(f'there is no cable "{name}"; {near(name, cables)}')
    cable = cables[name]
    if s is None:
        s = np.linspace(0, cable.length, PLACES * cable.elements + 1)
    try:
        s = np.atleast_1d(np.asarray(s, dtype=float))
    except (TypeError, ValueError):
        raise FunicularError(f'section forces of "{name}": s must be arc-lengths in m, got {s!r}') from None
    off = (s < -EXACT * cable.length) | (s > (1 + EXACT) * cable.length) | ~np.isfinite(s)
    if s.ndim != 1 or off.any():
        wrong = show(float(s[off][0]), "m") if s.ndim == 1 else f"an array of shape {s.shape}"
        raise FunicularError(f'section forces of "{name}": s must lie on the cable, in [0, {cable.length:.9g}] m, '
                             f"got {wrong}")
    vectors = state[f"{name}.nodal_vectors"]
    values = section_forces(cable, vectors if vectors.ndim == 4 else vectors[None], s)
    labels = GLOBAL | (BEAM if cable.kind_of_element.director else CABLE)
    found = xarray.Dataset(
        {key: (("time", "s", "xyz")[: value.ndim], value, {"units": labels[key][0], "long_name": labels[key][1]})
         for key, value in values.items()},
        {"s": ("s", s, {"units": "m", "long_name": "undeformed arc-length"}), "xyz": ["x", "y", "z"]},
        {"cable": name, "element": cable.element, "law": cable.law})
    if vectors.ndim == 3:
        return found.isel(time=0)
    return found.assign_coords(time=("time", state.time, {"units": "s", "long_name": "time"}))
