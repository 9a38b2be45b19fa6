"""Models of rigid and modal bodies: inertia, configuration, weight."""

from __future__ import annotations

import numpy as np

from ..base.rotations import cross, rotate
from ..parts.joint import Joint
from ..parts.modal_body import ModalBody
from ..parts.point_force import PointForce
from ..parts.rigid_body import RigidBody, largest_moment
from ..parts.scene_data import SceneData
from .elimination import MAX_DENSE_BORDER
from .model import BodyModel, ShapeModel

BODIES = {2: ("planar_rigid", 4, 3), 3: ("rigid", 7, 6)}
"""Kernels, length of the configuration and dofs of a rigid body, by dimension of the scene."""


def body_models(scene: SceneData, at: int) -> list[BodyModel]:
    """Return the bodies in the scene's order, with coordinates from `at` on."""
    dim, made, dof = scene.dim, [], at
    is_small = len(scene.bodies) * BODIES[dim][2] <= MAX_DENSE_BORDER
    held = {*scene.bodies} if is_small else _held_in_rotation(scene)
    kernel, n_configuration, n_velocity = BODIES[dim]
    for body in scene.bodies.values():
        shape = _shape(body, np.array(scene.gravity)[:dim]) if isinstance(body, ModalBody) else None
        centre = np.zeros(3) if isinstance(body, ModalBody) else np.array(body.centre)
        made.append(BodyModel(body.name, kernel, body.mass, np.array(body.inertia), centre, at, dof, shape,
                              shape is None and body.name not in held))
        at += n_configuration + made[-1].modes
        dof += n_velocity + made[-1].modes
    return made


def _held_in_rotation(scene: SceneData) -> set[str]:
    """Return the names of bodies whose rotations may depend on other parts: on all but joints of points and forces
    between points, of which those at the mass centre of a rigid body have no moment.
    """
    held: set[str] = set()
    for part in scene.parts():
        if not isinstance(part, PointForce) and not (isinstance(part, Joint) and part.is_of_points):
            held.update(part.refers_to())
            continue
        for end in (part.a, part.b):
            body = scene.bodies.get(end.on or "")
            if body is not None and (isinstance(body, ModalBody) or any(body.arm(end.point))):
                held.add(body.name)
    return held


def _shape(body: ModalBody, gravity: np.ndarray) -> ShapeModel:
    shape, dim = body.shape, len(gravity)
    return ShapeModel(shape.S[:, :dim], shape.X[:, :, :dim, :dim], shape.stiffness, shape.damping(body.damping_ratio),
                      gravity, shape)


def dofs_of(body: BodyModel, dim: int) -> int:
    """Return the number of its degrees of freedom."""
    return BODIES[dim][2] + body.modes


def configuration_of(body: RigidBody | ModalBody, dim: int) -> np.ndarray:
    """Return its configuration at the start: position in m, orientation, and modal coordinates, which are zero."""
    if isinstance(body, ModalBody):
        (position, orientation), modes = body.frame, np.zeros(body.shape.n)
    else:
        position, orientation, modes = body.point(body.centre), np.array(body.orientation), np.zeros(0)
    if dim == 2:
        w, _, _, z = orientation
        orientation = np.array([w * w - z * z, 2 * w * z])
    return np.array([*position[:dim], *orientation, *modes])


def velocity_of(body: RigidBody | ModalBody, dim: int) -> np.ndarray:
    """Return the initial velocities of a body; modal velocities are zero."""
    turning = np.array(body.angular_velocity)
    velocity, modes = np.array(body.velocity), np.zeros(0)
    if isinstance(body, ModalBody):
        modes = np.zeros(body.shape.n)
    else:
        velocity = velocity + rotate(body.orientation, tuple(cross(turning, body.centre).tolist()))
    return np.concatenate([velocity[:dim], turning[2 if dim == 2 else 0 :], modes])


def body_weights(body: RigidBody | ModalBody, dim: int) -> np.ndarray:
    """Return the weights (dofs,): 1 for the origin, the largest radius of gyration for rotations, the root mean square
    displacement for modes.
    """
    largest = body.inertia[2][2] if dim == 2 else largest_moment(body.inertia)
    modes = np.sqrt(np.diag(body.shape.modal_mass) / body.mass) if isinstance(body, ModalBody) else np.zeros(0)
    return np.concatenate([np.ones(dim), np.full(1 if dim == 2 else 3, np.sqrt(largest / body.mass)), modes])


def body_gravity(body: BodyModel, gravity: np.ndarray) -> np.ndarray:
    """Return the gravity (dofs,) of a rigid body in N; zeros for a modal one, whose forces include it as they depend on
    rotation and deformation.
    """
    weight = np.zeros(dofs_of(body, len(gravity)))
    if not body.modes:
        weight[: len(gravity)] = body.mass * gravity
    return weight
