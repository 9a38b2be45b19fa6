"""Coordinates of a linear model by name: of joints and slides where they are minimal, else modal coordinates."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array

from ...base.rotations import conjugate, rotate
from ...model.attachments import AttachmentModel
from ...model.joints import JointModel
from ...model.model import Model
from ...model.states import attachment_points, body_state
from ...parts.joint import DRIVE_UNITS, Joint
from ...parts.scene_data import SceneData
from .equations import Equations

FREE = {"revolute": ("angle",), "prismatic": ("distance",), "cylindrical": ("angle", "distance")}
"""Coordinates of the kinds of joints along and about their axis."""


class Coordinate(NamedTuple):
    """A coordinate: name and unit, name of its rate, and its row (coordinates,) over all coordinates of the model."""

    name: str
    unit: str
    rate: str
    row: np.ndarray

    @property
    def rate_unit(self) -> str:
        """Return the unit of its rate."""
        return f"{self.unit}/s"


def of_parts(equations: Equations, scene: SceneData) -> list[Coordinate]:
    """Return the coordinates of slides and joints that are free."""
    model = equations.model
    found = []
    for slide in model.slides:
        for k in slide.free_coordinates:
            row = np.zeros(len(equations.kept))
            row[equations.kept == model.n_band + model.n_border_dof + k] = 1.0
            found.append(Coordinate(f"{slide.name}.s", "m", f"{slide.name}.s_rate", row))
    for joint in model.joints:
        part = scene.joints.get(joint.name) if joint.is_of_scene else None
        if part is not None and not part.is_driven and _is_on_bodies(joint):
            found += _of_joint(equations, part, joint)
    return found


def _is_on_bodies(joint: JointModel) -> bool:
    """Return whether both ends are on rigid bodies or the ground."""
    return all(end.modal is None and end.cable < 0 and end.span is None and end.node < 0 and end.slide < 0
               for end in joint.attachments)


def _of_joint(equations: Equations, part: Joint, joint: JointModel) -> Iterator[Coordinate]:
    """Yield the coordinates of a joint."""
    model = equations.model
    a, b = joint.attachments[::-1] if joint.reversed else joint.attachments
    q = equations.static.keep()["q"][None]
    axis = _axis_at(model, part, a, q)
    turn_a, turn_b = _turns(equations, a, q), _turns(equations, b, q)
    apart = (attachment_points(model, b, q) - attachment_points(model, a, q))[0]
    for quantity in FREE.get(part.joint_kind, ()):
        if quantity == "angle":
            row = axis @ (turn_b - turn_a)
        else:
            moved = _moves(equations, b, q, turn_b) - _moves(equations, a, q, turn_a)
            row = axis @ (moved - np.cross(turn_a.T, apart).T)
        yield Coordinate(f"{part.name}.{quantity}", DRIVE_UNITS[quantity], f"{part.name}.{quantity}_rate", row)


def _axis_at(model: Model, part: Joint, a: AttachmentModel, q: np.ndarray) -> np.ndarray:
    """Return the axis (3,) of a joint in a configuration, which turns with its end a."""
    axis = np.array(part.axis if part.axis is not None else (0.0, 0.0, 1.0), dtype=float)
    axis /= np.linalg.norm(axis)
    if a.body < 0:
        return axis
    drawn, now = (body_state(model, model.bodies[a.body], at)["orientation"][0] for at in (model.q[None], q))
    return np.asarray(rotate(now, rotate(conjugate(drawn), axis)))


def _turns(equations: Equations, end: AttachmentModel, q: np.ndarray) -> np.ndarray:
    """Return (3, coordinates): rotations of an end, along the ground's axes, by the coordinates."""
    model, T = equations.model, equations.dofs
    if end.body < 0:
        return np.zeros((3, T.shape[1]))
    body = model.bodies[end.body]
    turn = body.dof + model.dim
    if model.dim == 2:
        return np.concatenate([np.zeros((2, T.shape[1])), T[[turn]].toarray()])
    orientation = body_state(model, body, q)["orientation"][0]
    return np.asarray(rotate(orientation, T[turn : turn + 3].toarray().T).T)


def _moves(equations: Equations, end: AttachmentModel, q: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """Return (3, coordinates): displacements of an end by the coordinates."""
    model, T = equations.model, equations.dofs
    if end.body < 0:
        return np.zeros((3, T.shape[1]))
    body = model.bodies[end.body]
    state = body_state(model, body, q)
    centre = state["position"][0] + rotate(state["orientation"][0], body.centre)
    moved = np.zeros((3, T.shape[1]))
    moved[: model.dim] = csr_array(T[body.dof : body.dof + model.dim]).toarray()
    return np.asarray(moved + np.cross(turns.T, attachment_points(model, end, q)[0] - centre).T)
