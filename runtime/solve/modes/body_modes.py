"""Modes of a body and its inertia integrals, from a mesh of elements."""

from __future__ import annotations

import warnings
from functools import lru_cache

import numpy as np

from ...base.interruptions import interruptible, uninterrupted
from ...errors import FunicularWarning, enough_memory
from ...model.build import build
from ...model.model import CableModel
from ...parts.body_shape import Shape
from ...parts.cable import Cable
from ...parts.modal_body import ModalBody
from ...parts.scene_data import SceneData
from ...parts.support import Clamp
from ..linear.threads import one_blas_thread
from .modes import FREQUENCY_TOLERANCE, modes


def of_mesh(body: ModalBody) -> Shape:
    """Return the lowest modes of a straight mesh in the body's axes; integrals exact, by the elements' mass matrices.

    A unit of each mode moves the mass by 1 m in the mean square. Bodies of one description share the arrays, which are
    read-only.
    """
    shape, change = _computed(body.mesh, body.boundary == "attached", body.modes, body.offset)
    if change > FREQUENCY_TOLERANCE:
        warnings.warn(f"{body.where}: rounding of the stiffness may change the frequencies of its modes by up to "
                      f"{100 * min(change, 1.0):.2g} %; take fewer elements", FunicularWarning, stacklevel=2)
    return shape


@lru_cache(maxsize=32)
def _computed(cable: Cable, attached: bool, n: int, offset: float) -> tuple[Shape, float]:
    """Return n modes of a mesh, and the largest relative uncertainty of their frequencies by rounding."""
    scene = SceneData(gravity=(0, 0, 0))
    scene.put(cable)
    if attached:
        scene.put(Clamp(cable=cable, s=0.0))
        still = 0
    else:
        still = 3 if cable.dim == 2 else 6 if cable.kind_of_element.director else 5
    with warnings.catch_warnings(), uninterrupted(), one_blas_thread, enough_memory(), interruptible():
        warnings.simplefilter("ignore", FunicularWarning)  # on rounding that hides the rigid motions, which are known
        found = modes(scene, n + still)
    elastic, error = found.angular_frequency[still:], found.uncertainty[still:]
    change = float(np.max(error / np.maximum(elastic, np.finfo(float).tiny), initial=0.0))
    model = build(scene).cables[0]
    mass = cable.material.density * cable.section.area * cable.length
    vectors = found[f"{cable.name}.nodal_vectors"][still:]
    vectors = vectors * np.sqrt(mass / np.einsum("kkii->k", _integrals(model, vectors)[1]))[:, None, None, None]
    undeformed = cable.nodal_vectors - offset * np.array([v == "r" for v in model.vectors])[:, None] * [1.0, 0, 0]
    fields = np.concatenate([undeformed[None], vectors])
    S, X = _integrals(model, fields)
    rotary = cable.material.density * cable.length * cable.section.mass_moments()[1:3]
    for axis, value in zip("yz", rotary, strict=True):
        if f"r_{axis}" not in model.vectors:  # the element lacks this inertia, but in turns of the frame
            X[0, 0, "xyz".index(axis), "xyz".index(axis)] += value
    stiffness = mass * np.diag(found.angular_frequency[still:] ** 2)
    at = model.vectors.index("r")
    shape = Shape(undeformed[:, at], vectors[:, :, at], _section_turns(model.vectors, vectors), stiffness, mass, S, X)
    for array in (shape.nodes, shape.modes, shape.rotations, shape.stiffness, shape.S, shape.X):
        array.flags.writeable = False
    return shape, change


def _integrals(model: CableModel, fields: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return S and X of fields (k, node, vector, 3)."""
    ones = np.array([v == "r" for v in model.vectors] * 2, dtype=float)
    S, X = np.zeros((len(fields), 3)), np.zeros((len(fields), len(fields), 3, 3))
    for element in range(model.n_elements):
        d = fields[:, element : element + 2].reshape(len(fields), -1, 3)
        md = np.einsum("ab,kbi->kai", model.m[0], d)
        S += np.einsum("a,kai->ki", ones, md)
        X += np.einsum("kai,laj->klij", d, md)
    return S, X


def _section_turns(names: tuple[str, ...], vectors: np.ndarray) -> np.ndarray:
    """Return (n, N, 3): small turns of the sections; for cables those of the tangent, without twist."""
    by = {name: vectors[:, :, k] for k, name in enumerate(names)}
    turns = np.zeros((*vectors.shape[:2], 3))
    if "r_y" in by:
        turns[..., 2] = -by["r_y"][..., 0]
    else:
        turns[..., 2] = by["r_x"][..., 1]
    if "r_z" in by:
        turns[..., 1] = by["r_z"][..., 0]
        turns[..., 0] = (by["r_y"][..., 2] - by["r_z"][..., 1]) / 2
    elif "r_y" not in by:
        turns[..., 1] = -by["r_x"][..., 2]
    return turns
