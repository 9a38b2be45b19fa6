"""The model of a scene: parts in the scene's order, numbered coordinates, constants of elements."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ..kernels.libraries import tables_of
from ..parts.scene_data import SceneData
from .attachments import ModelBuilder
from .bodies import body_gravity, body_models, body_weights, configuration_of, dofs_of, velocity_of
from .border import ACCELERATIONS, NEWTON, elimination
from .cables import CableArrays, arrays_of, cable_rates, level_tied_slopes, turn_to_clamps
from .coupling import number
from .cutting import attached
from .driven_dofs import DrivenDofs
from .kinds import COUPLINGS
from .model import CableModel, Model, MotionModel
from .point_masses import with_masses, with_weights
from .rope_model import rope_models, turn_motions
from .rope_rates import follow
from .unknowns import Node, supports


def build(scene: SceneData, supplied: bool = False) -> Model:
    """Number the coordinates of a scene and evaluate the constants of its elements. Raises SceneError.

    A scene of planar elements lies in the plane z = 0 (see parts/in_plane.py). supplied: whether the stress-free length
    of ropes is free, see `RopeModel.supply`.
    """
    assert scene.plane is None, "a scene in another plane is laid into z = 0 first"
    dim, gravity = scene.dim, np.array(scene.gravity)[: scene.dim]
    drawn, described = list(map(arrays_of, scene.cables.values())), list(scene.bodies.values())
    cables: list[CableModel] = []
    n_flexible = 0
    for cable in drawn:
        cables.append(with_masses(cable.model(n_flexible), scene.masses_on(cable.cable.name)))
        n_flexible = cables[-1].coordinates.stop
    ropes = rope_models(scene, n_flexible, supplied)
    driven = DrivenDofs.of(scene, ropes[-1].coordinates.stop if ropes else n_flexible)
    bodies = body_models(scene, driven.let_grow(cables, scene))
    nodal = [cable.vectors[..., :dim].copy() for cable in drawn]
    level_tied_slopes(scene, nodal)
    turn_to_clamps(scene, nodal)
    nodes = {model.name: _nodes(model, scene.cables[model.name].where, vectors)
             for model, vectors in zip(cables, nodal, strict=True)}
    builder = ModelBuilder(scene, cables, ropes, bodies, driven.dofs)
    reduction = supports(scene, nodes, builder.signals.add).reduce(n_flexible, elements_of(cables), attached(scene))
    couplings = [model for kind in COUPLINGS for model in kind.models(builder)]
    n_extra, n_multipliers = number(couplings)
    n_of_bodies = sum(dofs_of(body, dim) for body in bodies)
    is_free = np.concatenate([*(~rope.fixed for rope in ropes), driven.still > 0, np.ones(n_of_bodies, dtype=bool)])
    beside_cables = np.where(is_free, reduction.n_unknowns + is_free.cumsum() - 1, -1)
    numbering = reduction.numbering
    model = Model(
        dim, cables, ropes, bodies, couplings, builder.signals,
        [*(MotionModel(dof, p.signal, p.base, p.linear, p.cosine, p.sine) for dof, p in reduction.prescribed),
         *(MotionModel(dof, signal, 0.0, 1.0, 0.0, 0.0) for dof, signal in turn_motions(ropes, builder.signals)),
         *driven.motions(builder.signals)],
        q=_joined(*(vectors.ravel() for vectors in nodal), *(rope.q for rope in ropes), driven.start,
                  *(configuration_of(body, dim) for body in described)),
        v=_joined(cable_rates(scene, reduction), *(0 * rope.q for rope in ropes), driven.still,
                  *(velocity_of(body, dim) for body in described)),
        weight=_joined(*(cable.weights for cable in drawn), *(rope.weight for rope in ropes), driven.still,
                       *(body_weights(body, dim) for body in described)),
        gravity=_joined(*_weights(scene, drawn, cables, gravity), *(0 * rope.q for rope in ropes), driven.still,
                        *(body_gravity(body, gravity) for body in bodies)),
        unknown_of_dof=np.concatenate([reduction.unknown_of_dof, beside_cables]).astype(int),
        combinations=reduction.combinations,
        n_band=numbering.n_band,
        n_border_dof=reduction.n_unknowns - numbering.n_band + int(is_free.sum()),
        n_extra=n_extra, n_multipliers=n_multipliers, width=numbering.width, chains=numbering.chains,
        nodes=nodes,
        tables=[tables_of(name) for name in scene.libraries],
        plane_axes=scene.plane_axes, driven=range(driven.first, driven.stop),
    )
    for rope in ropes:
        follow(model, rope)
    model.newton, model.accelerations = elimination(model, NEWTON), elimination(model, ACCELERATIONS)
    return model


def _weights(scene: SceneData, drawn: list[CableArrays], cables: list[CableModel], gravity: np.ndarray
             ) -> Iterator[np.ndarray]:
    """Yield the generalised gravity (coordinates,) of each cable, with that of point masses on it."""
    for cable, model in zip(drawn, cables, strict=True):
        yield with_weights(cable.gravity(gravity), model, scene.masses_on(model.name), gravity)


def elements_of(cables: list[CableModel]) -> np.ndarray:
    """Return (elements, 2): the first dof and the number of dofs of each element, by cable."""
    found = [np.zeros((0, 2), dtype=int)]
    for cable in cables:
        size = math.prod(cable.shape[1:])
        of_cable = np.empty((cable.n_elements, 2), dtype=int)
        of_cable[:, 0] = cable.first + size * cable.mesh.first_node(np.arange(cable.n_elements))
        of_cable[:, 1] = 2 * size
        found.append(of_cable)
    return np.concatenate(found)


def _joined(*arrays: np.ndarray) -> np.ndarray:
    return np.concatenate([*arrays, []])


def _nodes(cable: CableModel, where: str, vectors: np.ndarray) -> list[Node]:
    """Return the nodes of a cable, with its nodal vectors (nodes, vectors, dim) as drawn."""
    size = math.prod(cable.shape[1:])
    return [Node(where, cable.vectors, cable.first + k * size, each) for k, each in enumerate(vectors)]
