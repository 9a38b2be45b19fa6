"""Scenes in the axes of their plane, in which it is z = 0."""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Callable, Iterable
from functools import singledispatch
from typing import Any, TypeVar

import numpy as np

from ..base.rotations import conjugate, rotate
from ..errors import SceneError
from .cable import Cable
from .curves import shape_through
from .event import Event
from .modal_body import ModalBody
from .part import Part, about_fields
from .paths import COMPONENTS
from .plane import PLANE_ROUNDING, Plane, aligned, called, flattened
from .plane_axes import UNTURNED, PlaneAxes
from .scene_data import SceneData
from .schemas import HOLDER, LENGTHS, ORIENTATION, POINT, TENSOR, Turning
from .signal import Constant, Signal, combined
from .support import Motion
from .velocity_table import VelocityTable

S = TypeVar("S", bound=SceneData)


def in_plane(scene: S) -> S:
    """Return the scene in the axes of the plane of its planar cables; itself for z = 0 and for spatial scenes.

    Raises SceneError for parts that cannot be turned.
    """
    plane = scene.plane
    return scene if plane is None else into_plane(scene, plane)


def into_plane(scene: S, plane: Plane) -> S:
    """Return a scene, planar or spatial, in the axes of a plane, without new checks.

    Raises SceneError for parts that cannot be turned.
    """
    axes = PlaneAxes(plane, scene.bodies.copy(), _size(scene.cables.values()))
    made = scene.replaced(lambda part: turned(part, axes, scene))
    made.gravity, made.plane_axes, made.drawn = _vector(axes, None, scene.gravity), axes, scene
    return made


def turned_alone(scene: SceneData, plane: Plane, part: Part) -> Part:
    """Return a part, of the scene or about to join it, in the axes of a plane, for checks of the plane.

    Cables, which lie in planes of their own, and events, which do not act, are returned as they are. Raises SceneError.
    """
    if isinstance(part, Cable | Event):
        return part
    planar = next(iter(scene.cables.values()))
    axes = PlaneAxes(plane, ChainMap[Any, Any]({part.given_name: part}, scene.bodies), _size([planar]))
    return turned(part, axes, scene)


def _size(cables: Iterable[Cable]) -> float:
    """Return the largest coordinate in m of the points of cables."""
    return max((abs(x) for cable in cables for point in cable.drawn_through for x in point), default=0.0)


def _vector(axes: PlaneAxes, on: str | None, vector: Any, is_point: bool = False) -> tuple[float, ...]:
    """Return a point or a direction, in the axes of the ground or of a body, in those that it has in the plane.

    Modal bodies keep their axes.
    """
    made = np.array(vector)
    if on is None:
        made = flattened(axes.plane.points_into(made), axes.size) if is_point else aligned(axes.plane.into(made))
        return tuple(made.tolist())
    if (turn := axes.turn_of(on)) is not None:
        made = aligned(rotate(conjugate(turn), made))
    return tuple((flattened(made, PLANE_ROUNDING * axes.size) if is_point else made).tolist())


def _tensor(axes: PlaneAxes, body: str, tensor: Any) -> tuple[tuple[float, ...], ...]:
    """Return a symmetric tensor (3, 3) in the axes of a body in those that it has in the plane."""
    turn = axes.turn_of(body)
    own = np.eye(3) if turn is None else rotate(turn, np.eye(3)).T  # columns: the axes in the plane
    found = own.T @ np.array(tensor) @ own
    found[np.abs(found) <= PLANE_ROUNDING * np.abs(found).max()] = 0.0
    return tuple(map(tuple, ((found + found.T) / 2).tolist()))


def _orientation(axes: PlaneAxes, body: str, orientation: Any) -> tuple[float, ...]:
    """Return the unit quaternion of a body in the plane; rigid bodies start unturned."""
    made = axes.into(body, "orientation", np.array(orientation)) if axes.turn_of(body) is None else UNTURNED
    return tuple(made.tolist())


def _vectors(axes: PlaneAxes, turning: Turning, on: str | None, value: Any) -> Any:
    """Return the vectors of a field, in the axes of the ground or of the body `on`, in those of the plane."""
    if turning.turns == LENGTHS or not isinstance(value, tuple | list):
        return value
    if turning.turns in (TENSOR, ORIENTATION):
        assert on is not None, "tensors and orientations are of a body"
        return _tensor(axes, on, value) if turning.turns == TENSOR else _orientation(axes, on, value)
    is_point = turning.turns == POINT
    if len(value) and isinstance(value[0], tuple | list):
        return tuple(_vector(axes, on, each, is_point) for each in value)
    return _vector(axes, on, value, is_point)


def turned_fields(part: Part, axes: PlaneAxes, holder: str | None = None) -> dict[str, Any]:
    """Return the fields of a part and of the parts in it that other axes change, in the axes of a plane.

    holder: the body in whose axes the holder of the part is.
    """
    about, changes = about_fields(type(part)), {}
    for name, value in part:
        if value is None:
            continue
        if isinstance(turning := about.get(name), Turning):
            on = holder if turning.of == HOLDER else None if turning.of is None else getattr(part, turning.of)
            changes[name] = _vectors(axes, turning, on, value)
        elif isinstance(value, VelocityTable):
            changes[name] = value.turned(axes.plane.axes)
        elif isinstance(value, Part) and (held := turned_fields(value, axes, getattr(part, "on", None))):
            changes[name] = value.model_copy(update=held)
        elif isinstance(value, tuple) and any(isinstance(each, Part) for each in value):
            changes[name] = tuple(each.model_copy(update=turned_fields(each, axes)) if isinstance(each, Part) else each
                                  for each in value)
    return changes


@singledispatch
def turned(part: Part, axes: PlaneAxes, scene: SceneData) -> Part:
    """Return a part of a scene in the axes of a plane. Raises SceneError."""
    changes = turned_fields(part, axes)
    return part.model_copy(update=changes) if changes else part


@turned.register
def _cable(part: Cable, axes: PlaneAxes, scene: SceneData) -> Cable:
    changes = turned_fields(part, axes)
    if part.dim == 2 and abs(axes.plane.into(part.normal)[2]) > 1 - PLANE_ROUNDING:  # height normal x tangent in z = 0
        changes["up"] = (0.0, 1.0, 0.0)
    made = Cable(**part.entries() | changes)
    if part.shape == "hanging":
        made = made.hanging_through(_vector(axes, None, point, is_point=True) for point in part.drawn_through)
    drawn, flat = shape_through(part.drawn_through), shape_through(made.drawn_through)
    if not drawn.straight:  # Akima splines, unlike cubic ones, depend on the axes
        along = np.linspace(0, 1, 8 * len(part.drawn_through))
        apart = axes.plane.points_into(drawn.point(along * drawn.length)) - flat.point(along * flat.length)
        if np.abs(apart).max() > PLANE_ROUNDING * max(axes.size, drawn.length):
            raise SceneError(part.where, f"its curve through the points changes in the axes of "
                             f"{called(axes.plane)}", "give more points")
    return made


@turned.register
def _modal_body(part: ModalBody, axes: PlaneAxes, scene: SceneData) -> ModalBody:
    changes = turned_fields(part, axes)
    del changes["orientation" if part.data is None else "up"]  # the other one says how it lies
    made = ModalBody(**part.entries() | changes)
    made.__dict__["shape"] = part.shape  # in body axes, which stay, so that modes keep their signs
    return made


@turned.register
def _motion(part: Motion, axes: PlaneAxes, scene: SceneData) -> Motion:
    changes = turned_fields(part, axes)
    if part.displacement is not None:
        try:
            changes["displacement"] = tuple(_component(axes.plane, k, part.displacement) for k in range(3))
        except ValueError as error:
            raise SceneError(part.where, f"displacement {error}",
                             f"prescribe or free directions in {called(axes.plane)} and across it") from None
    return part.model_copy(update=changes)


def _component(plane: Plane, k: int, displacement: tuple[Signal | None, ...]) -> Signal | None:
    """Return the component of a displacement along an axis of the plane; 0 for a free direction across the plane.

    Raises ValueError for a component that is partly free.
    """
    along = aligned(plane.axes[:, k])
    given = [(float(factor), signal) for factor, signal in zip(along, displacement, strict=True) if factor]
    prescribed = [(factor, signal) for factor, signal in given if signal is not None]
    if not prescribed:
        return None if k < 2 else Constant(constant=0.0)
    if len(prescribed) < len(given):
        raise ValueError("leaves a direction free that is neither an axis of the plane nor its normal")
    factors, signals = zip(*prescribed, strict=True)
    return combined(factors, signals)


@turned.register
def _event(part: Event, axes: PlaneAxes, scene: SceneData) -> Event:
    """Return an event with its threshold as a function of a state, whose results are along the ground's axes."""
    if part.quantity is None or part.quantity.partition(".")[0] in scene.slides or part.quantity.count(".") == 1:
        return part
    return part.model_copy(update={"quantity": None, "s": None, "value": 0.0, "function": _passing(part, scene)})


def _passing(event: Event, scene: SceneData) -> Callable[[float, Any], float]:
    """Return the function of time and state whose zeros are those of the quantity of an event minus its value."""
    assert event.quantity is not None, f"{event.where} has a function"
    name, what, axis = event.quantity.split(".")
    k, value = COMPONENTS[axis], event.value
    if name in scene.bodies:
        return lambda time, state: state[f"{name}.{what}"][k] - value
    assert event.s is not None, f"{event.where} is not complete"
    node = scene.cables[name].node(event.s)
    vectors = "nodal_vectors" if what == "position" else "nodal_velocity"
    return lambda time, state: state[f"{name}.{vectors}"][node, 0, k] - value
