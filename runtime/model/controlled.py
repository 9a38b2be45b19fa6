"""Weights of degrees of freedom in the error that steps are chosen by, for given quantities."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from ..checks.placement import AXES
from ..errors import SceneError, near
from ..parts.locations import connected
from ..parts.scene_data import SceneData
from .model import BodyModel, CableModel, Model, SlideModel
from .span_coordinates import SpanCoordinates

COUNTED = {"rigid_body": ("position", "orientation"), "modal_body": ("position", "orientation", "modal_coordinates"),
           "cable": ("position", "nodal_vectors"), "slide": ("s",)}
"""Results whose errors are estimated, by kind of part; a position may be one of its components, "A.position.y".
In a plane that is turned against the ground's axes, all components of a position count with one of them."""


def controlled_weights(quantities: Sequence[str], scene: SceneData, model: Model) -> np.ndarray:
    """Return the weights (n_dof,) of degrees of freedom in the error that steps are chosen by, m: those of the model
    where a quantity depends on the dof, 0 elsewhere.

    The s of a slide depends on the positions of its rider and its cable. Raises SceneError for a quantity without an
    error estimate.
    """
    weights = np.zeros(model.n_dof)
    for quantity in quantities:
        name, what, axis = _parsed(quantity, scene)
        axis = _in_plane(model, axis, f'quantities: "{quantity}"')
        if name in scene.slides:
            _count_slide(model, model.slides[list(scene.slides).index(name)], weights)
        elif name in scene.cables:
            _count_cable(model, model.cables[list(scene.cables).index(name)], what, axis, weights)
        else:
            _count_body(model, model.bodies[list(scene.bodies).index(name)], what, axis, weights)
    return weights


def counted_weights(quantities: Sequence[str], controlled: np.ndarray, scene: SceneData, model: Model) -> np.ndarray:
    """Return the weights (n_dof,) of degrees of freedom in the error that counts, m: `controlled_weights` of named
    parts, less elsewhere.

    The weight of a part of mass m connected with a named one of mass M is multiplied by m/M, at most 1: by conservation
    of momentum its error displaces the named part by that fraction. Unconnected parts have no weight.
    """
    weights, masses = controlled.copy(), _masses(scene)
    named = {part for quantity in quantities for part in _parts_of(_parsed(quantity, scene)[0], scene)}
    for name in named:
        for other in connected(scene, name) - named:
            dofs = _dofs(model, other)
            share = min(1.0, masses[other] / masses[name])
            weights[dofs] = np.maximum(weights[dofs], share * model.weight[dofs])
    return weights


def _parts_of(name: str, scene: SceneData) -> list[str]:
    """Return the cable or body of that name, or those of the slide of that name, without ropes."""
    if name not in scene.slides:
        return [name]
    slide = scene.slides[name]
    return [each for each in (slide.along, slide.rider.on) if each is not None and each not in scene.ropes]


def _masses(scene: SceneData) -> dict[str, float]:
    """Return the masses of cables, with point masses on them, and bodies, kg."""
    found = {name: part.mass for parts in (scene.cables, scene.bodies) for name, part in parts.items()}
    for mass in scene.point_masses.values():
        found[mass.on] += mass.mass
    return found


def _dofs(model: Model, name: str) -> slice:
    """Return the degrees of freedom of a cable or body."""
    for cable in model.cables:
        if cable.name == name:
            return cable.coordinates
    body = next(body for body in model.bodies if body.name == name)
    return slice(body.dof, body.dof + (6 if model.dim == 3 else 3) + body.modes)


def nameable(scene: SceneData) -> list[str]:
    """Return the quantities by which steps can be chosen, without components."""
    parts = {**scene.bodies, **scene.cables, **scene.slides}
    return [f"{name}.{what}" for name, part in parts.items() for what in COUNTED[part.kind]]


def _parsed(quantity: str, scene: SceneData) -> tuple[str, str, str]:
    """Return the name of the part, the quantity, and the axis or "". Raises SceneError."""
    known = nameable(scene)
    name, _, rest = quantity.partition(".")
    what, _, axis = rest.partition(".")
    if f"{name}.{what}" not in known:
        raise SceneError("run", f'quantities: the error of "{quantity}" is not estimated', near(quantity, known))
    if axis and (what != "position" or axis not in (AXES[: scene.dim] if scene.plane_axes is None else AXES)):
        raise SceneError("run", f'quantities: the error of "{quantity}" is not estimated',
                         f"{name}.{what} has no component {axis}; take {name}.{what}" if what != "position" else
                         f"take {', '.join(f'{name}.position.{one}' for one in AXES[: scene.dim])} or all of it")
    return name, what, axis


def _in_plane(model: Model, axis: str, where: str) -> str:
    """Return the axis of the model along an axis of the ground, "" for all where none is.

    Raises SceneError for one across the plane of the model.
    """
    if not axis or model.plane_axes is None:
        return axis
    along = np.abs(model.plane_axes.plane.axes[AXES.index(axis)])
    if not np.any(along[: model.dim]):
        raise SceneError("run", f"{where} is always the same: the scene lies in a plane across {axis}",
                         "take another component")
    return AXES[int(np.argmax(along))] if np.count_nonzero(along) == 1 else ""


def _components(start: int, dim: int, axis: str) -> Iterable[int]:
    return [start + AXES.index(axis)] if axis else range(start, start + dim)


def _count_cable(model: Model, cable: CableModel, what: str, axis: str, weights: np.ndarray) -> None:
    """Weigh the positions of a cable's nodes, or one component, or all nodal vectors."""
    for node in model.nodes[cable.name]:
        for vector in node.names if what == "nodal_vectors" else ("r",):
            for i in _components(node.dofs(vector)[0], model.dim, axis):
                weights[i] = model.weight[i]


def _count_body(model: Model, body: BodyModel, what: str, axis: str, weights: np.ndarray) -> None:
    """Weigh a body's position, orientation or modes; rotations move its origin about the mass centre."""
    turns = slice(body.dof + model.dim, body.dof + (6 if model.dim == 3 else 3))
    modes = slice(turns.stop, turns.stop + body.modes)
    if what == "position":
        for i in _components(body.dof, model.dim, axis):
            weights[i] = model.weight[i]
        weights[turns] = np.maximum(weights[turns], np.linalg.norm(body.centre))
    elif what == "orientation":
        weights[turns] = np.maximum(weights[turns], model.weight[turns])
    else:
        weights[modes] = model.weight[modes]


def _count_span(model: Model, span: SpanCoordinates, weights: np.ndarray) -> None:
    """Weigh the positions of the nodes of a span of a rope, and the material coordinates of its ends."""
    for node in map(span.node, range(span.n_elements + 1)):
        places = slice(node.start, node.start + span.dim)
        weights[places] = model.weight[places]
    for s in span.s:
        weights[s] = model.weight[s]


def _count_slide(model: Model, slide: SlideModel, weights: np.ndarray) -> None:
    """Weigh the positions of the rider and the cable or span of a slide."""
    if slide.coordinates is None:
        _count_cable(model, model.cables[slide.cable], "position", "", weights)
    else:
        _count_span(model, slide.coordinates, weights)
    rider = slide.rider
    if rider.cable >= 0:
        _count_cable(model, model.cables[rider.cable], "position", "", weights)
    elif rider.body >= 0:
        body = model.bodies[rider.body]
        for what in ("position", "orientation", *(["modal_coordinates"] if body.modes else [])):
            _count_body(model, body, what, "", weights)
