"""What the steps of a run are chosen by: the degrees of freedom that its quantities move."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from ..checks.event_placement import AXES
from ..errors import SceneError, near
from ..parts.locations import connected
from ..parts.scene_data import SceneData
from .model import BodyModel, CableModel, Model, SlideModel

COUNTED = {"rigid_body": ("position", "orientation"), "modal_body": ("position", "orientation", "modal_coordinates"),
           "cable": ("position", "nodal_vectors"), "slide": ("s",)}
"""Results whose errors are estimated, by kind of part; a position may be one of its components, "A.position.y".
In a plane that is turned against the ground's axes, all components of a position count with one of them."""


def controlled_weights(quantities: Sequence[str], scene: SceneData, model: Model) -> np.ndarray:
    """Return the weight (n_dof,) of each degree of freedom in the error that steps are chosen by, m: the model's where
    a quantity depends on it, 0 elsewhere.

    What a slide's s is found from are the positions of its rider and of its cable. Raises SceneError for a quantity
    whose error is not estimated.
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
    """Return the weight (n_dof,) of each degree of freedom in the error that counts, m: `controlled_weights` of what is
    named, less elsewhere.

    An error of a part of mass m that is connected with a named one of mass M counts m/M times, and at most once: by so
    much it displaces the named part as their momentum is kept. Parts that nothing connects with a named one count
    nothing.
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
    """Return the cables and bodies that a named part is, or that a slide is between."""
    if name not in scene.slides:
        return [name]
    slide = scene.slides[name]
    return [each for each in (slide.along, slide.rider.on) if each is not None]


def _masses(scene: SceneData) -> dict[str, float]:
    """Return the masses of cables and bodies, kg."""
    return {**{name: cable.length * cable.material.density * cable.section.mass_moments()[0]
               for name, cable in scene.cables.items()}, **{name: body.mass for name, body in scene.bodies.items()}}


def _dofs(model: Model, name: str) -> slice:
    """Return the degrees of freedom of a cable or body."""
    for cable in model.cables:
        if cable.name == name:
            return cable.coordinates
    body = next(body for body in model.bodies if body.name == name)
    return slice(body.dof, body.dof + (6 if model.dim == 3 else 3) + body.modes)


def nameable(scene: SceneData) -> list[str]:
    """Return the quantities of a scene by which steps can be chosen, without their components."""
    parts = {**scene.bodies, **scene.cables, **scene.slides}
    return [f"{name}.{what}" for name, part in parts.items() for what in COUNTED[part.kind]]


def _parsed(quantity: str, scene: SceneData) -> tuple[str, str, str]:
    """Return the part's name, what of it, and the axis or ""; raises SceneError."""
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
    """Return the axis of the model along an axis of the ground; all of them, "", where it lies along none.

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
    """Let the positions of a cable's nodes count, or one component of them, or all nodal vectors."""
    for node in model.nodes[cable.name]:
        for vector in node.names if what == "nodal_vectors" else ("r",):
            for i in _components(node.dofs(vector)[0], model.dim, axis):
                weights[i] = model.weight[i]


def _count_body(model: Model, body: BodyModel, what: str, axis: str, weights: np.ndarray) -> None:
    """Let a body's position, orientation or modes count; turns move its origin about its mass centre."""
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


def _count_slide(model: Model, slide: SlideModel, weights: np.ndarray) -> None:
    """Let the positions count that a slide's s is found from: of its rider and of its cable."""
    _count_cable(model, model.cables[slide.cable], "position", "", weights)
    rider = slide.rider
    if rider.cable >= 0:
        _count_cable(model, model.cables[rider.cable], "position", "", weights)
    elif rider.body >= 0:
        body = model.bodies[rider.body]
        for what in ("position", "orientation", *(["modal_coordinates"] if body.modes else [])):
            _count_body(model, body, what, "", weights)
