"""Spatial quantities of the states of a model: bodies, joints, point forces, reactions.

All are along the axes of the model, where a planar one lies in z = 0.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..base.rotations import conjugate, cross, product, rotate, unit
from ..parts.locations import ends_of, joined, node_of
from ..parts.scene_data import SceneData
from ..parts.support import Support, Tie
from .attachments import AttachmentModel
from .contacts import ContactModel
from .joints import JointModel
from .model import BodyModel, CableModel, Model
from .point_forces import PointForceModel
from .unknowns import Node


def spatial(vectors: np.ndarray) -> np.ndarray:
    """Return vectors (..., 2 or 3) as spatial ones, (..., 3), a copy."""
    if vectors.shape[-1] == 3:
        return vectors.copy()
    return np.concatenate([vectors, np.zeros((*vectors.shape[:-1], 3 - vectors.shape[-1]))], axis=-1)


def force_and_moment(nodes: Iterable[Node], reaction: np.ndarray, q: np.ndarray) -> dict[str, np.ndarray]:
    """Return the force and moment of supports or ties on nodes at one place.

    reaction, q: (time, dofs) generalised forces and configuration. Returns force, moment (time, 3) in N, N m: the
    moment is the sum of r_k x f_k over the slopes.
    """
    nodes, moment = [*nodes], np.zeros((len(q), 3))
    for node in nodes:
        for name in {"r_x", "r_y", "r_z"} & set(node.names):
            at = node.dofs(name)
            moment += cross(spatial(q[:, at]), spatial(reaction[:, at]))
    return {"force": _force(nodes, reaction), "moment": moment}


def _force(nodes: Iterable[Node], reaction: np.ndarray) -> np.ndarray:
    """Return the force (time, 3) in N of supports or ties on nodes, from generalised forces (time, dofs)."""
    force = np.zeros((len(reaction), 3))
    for node in nodes:
        force += spatial(reaction[:, node.dofs("r")])
    return force


def support_reaction(model: Model, scene: SceneData, part: Support, reaction: np.ndarray,
                     q: np.ndarray) -> dict[str, np.ndarray]:
    """Return the force and moment of a pin, clamp or motion on its node and the nodes joined to it."""
    return force_and_moment(_supported(model, scene, part), reaction, q)


def support_force(model: Model, scene: SceneData, part: Support, reaction: np.ndarray) -> np.ndarray:
    """Return the force (time, 3) in N of `support_reaction` alone, as that of a pin."""
    return _force(_supported(model, scene, part), reaction)


def _supported(model: Model, scene: SceneData, part: Support) -> list[Node]:
    """Return the node of a support and the nodes joined to it."""
    return _nodes(model, scene, joined(scene, node_of(scene, part)))


def _nodes(model: Model, scene: SceneData, at: Iterable[tuple[str, int]]) -> list[Node]:
    """Return nodes by cable and number, with the second ones at joints of pieces of a cable."""
    return [model.nodes[cable][each] for cable, k in at for each in scene.cables[cable].mesh.at_node(k)]


def tie_force(model: Model, scene: SceneData, tie: Tie, reaction: np.ndarray, q: np.ndarray) -> dict[str, np.ndarray]:
    """Return the force and moment of a tie on the node of its `cable`: the sum over the nodes on that side.

    A support on that side contributes to this sum; then the tie's is minus the sum over the other side.
    """
    supported = {node_of(scene, support) for support in scene.supports}
    one, other = ends_of(scene, tie)
    sign, near = 1.0, joined(scene, one, without=tie)
    if near & supported:
        sign, near = -1.0, joined(scene, other, without=tie)
    found = force_and_moment(_nodes(model, scene, near), reaction, q)
    return {name: sign * value for name, value in found.items()}


def body_state(model: Model, body: BodyModel, q: np.ndarray) -> dict[str, np.ndarray]:
    """Return position and orientation of a body in configurations (time, n_q)."""
    b = body.configuration
    if model.dim == 3:
        centre, orientation = q[:, b : b + 3], q[:, b + 3 : b + 7]
    else:
        half = np.arctan2(q[:, b + 3], q[:, b + 2]) / 2
        zero = np.zeros_like(half)
        centre, orientation = spatial(q[:, b : b + 2]), np.stack([np.cos(half), zero, zero, np.sin(half)], axis=1)
    return {"position": centre - rotate(orientation, body.centre) if body.centre.any() else centre,
            "orientation": orientation}


def body_rates(model: Model, body: BodyModel, orientation: np.ndarray, v: np.ndarray,
               a: np.ndarray | None = None) -> dict[str, np.ndarray]:
    """Return the velocity of a body's origin and angular_velocity from v (time, n_dof), and accelerations from a."""
    at = slice(body.dof, body.dof + model.dim)
    turn = slice(at.stop, at.stop + (3 if model.dim == 3 else 1))
    velocity, omega = spatial(v[:, at]), _turning(v[:, turn])
    swing = cross(omega, body.centre)
    found = {"velocity": velocity - rotate(orientation, swing) if body.centre.any() else velocity,
             "angular_velocity": omega}
    if a is not None:
        acceleration, alpha = spatial(a[:, at]), _turning(a[:, turn])
        if body.centre.any():
            acceleration = acceleration - rotate(orientation, cross(alpha, body.centre) + cross(omega, swing))
        found |= {"acceleration": acceleration, "angular_acceleration": alpha}
    return found


def modal_state(model: Model, body: BodyModel, state: dict[str, np.ndarray], q: np.ndarray,
                v: np.ndarray | None = None) -> dict[str, np.ndarray]:
    """Return modal_coordinates (time, mode) and nodes (time, node, 3) of a modal body from the `state` of its frame.

    With v (time, n_dof), modal_velocities, too.
    """
    assert body.shape is not None, "a rigid body has no modes"
    start = body.configuration + (7 if model.dim == 3 else 4)
    eta, fields = q[:, start : start + body.modes], body.shape.fields
    place = fields.nodes + np.einsum("tk,kni->tni", eta, fields.modes)
    rate = body.dof + (6 if model.dim == 3 else 3)
    return {"modal_coordinates": eta,
            "nodes": state["position"][:, None] + rotate(state["orientation"][:, None], place)} | (
                {} if v is None else {"modal_velocities": v[:, rate : rate + body.modes]})


def joint_state(joint: JointModel, outputs: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return the outputs of a joint with the force and moment (..., 3) on the end b."""
    sign = -1.0 if joint.reversed else 1.0  # a reversed joint has both ends at one point
    return outputs | {name: sign * outputs[name] for name in ("force", "moment")}


def _turning(rates: np.ndarray) -> np.ndarray:
    """Return angular rates (time, 1 or 3) as vectors (time, 3)."""
    return rates if rates.shape[1] == 3 else np.concatenate([np.zeros((len(rates), 2)), rates], axis=1)


def point_force_state(model: Model, between: PointForceModel, force: np.ndarray,
                      q: np.ndarray) -> dict[str, np.ndarray]:
    """Return the force on the first end, (time, 3) in N, the length in m, and the tension in N."""
    a, b = (attachment_points(model, each, q) for each in between.attachments)
    gap, force = b - a, spatial(force)
    length = np.linalg.norm(gap, axis=1)
    along = gap / np.where(length > 0, length, 1.0)[:, None]
    return {"force": force, "length": length, "tension": np.sum(force * along, axis=1)}


def attachment_points(model: Model, attachment: AttachmentModel, q: np.ndarray) -> np.ndarray:
    """Return (time, 3): positions of an attachment, m."""
    if attachment.cable >= 0:
        return spatial(np.einsum("k,tkd->td", attachment.N, _vectors_of(model, attachment, q)))
    if attachment.body >= 0:
        body = model.bodies[attachment.body]
        state, arm = body_state(model, body, q), body.centre + attachment.u
        if attachment.modal is not None:
            eta = modal_state(model, body, state, q)["modal_coordinates"]
            arm = spatial(attachment.modal[0] + eta @ attachment.modal[1])
        return np.asarray(state["position"] + rotate(state["orientation"], arm))
    if attachment.span is not None:
        return spatial(attachment.span.point(q, attachment.material))
    if attachment.node >= 0:
        return spatial(q[:, attachment.node : attachment.node + model.dim])
    return np.broadcast_to(np.array(attachment.u), (len(q), 3))


def attachment_axes(model: Model, attachment: AttachmentModel, q: np.ndarray) -> np.ndarray:
    """Return (time, 3, 3): the axes of an attachment to a body or a cable in space, by columns."""
    assert attachment.axes is not None, "an attachment without axes"
    if attachment.cable >= 0:
        return np.asarray(_frame_on_cable(model, attachment, q) @ attachment.axes)
    body = model.bodies[attachment.body]
    state = body_state(model, body, q)
    orientation = state["orientation"]
    if attachment.modal is not None:  # the section has turned by twice arctan(theta/2)
        theta = modal_state(model, body, state, q)["modal_coordinates"] @ attachment.modal[2]
        half = np.concatenate([np.ones((len(q), 1)), theta / 2], axis=1)
        orientation = product(orientation, half / np.linalg.norm(half, axis=1, keepdims=True))
    columns = [rotate(orientation, axis) for axis in attachment.axes.T]
    return np.stack(columns, axis=-1)


def _frame_on_cable(model: Model, attachment: AttachmentModel, q: np.ndarray) -> np.ndarray:
    """Return (time, 3, 3): the frame of two vectors of a cable, by columns, as in derive/couplings/frame.py."""
    vectors = _vectors_of(model, attachment, q)
    one, other = (np.broadcast_to(attachment.up, (len(q), 3)) if slope < 0 else np.einsum("k,tkd->td", S, vectors)
                  for slope, S in zip(attachment.slopes, attachment.S, strict=True))
    along, across = unit(one), unit(np.cross(one, other))
    return np.stack([along, np.cross(across, along), across], axis=-1)


def _vectors_of(model: Model, attachment: AttachmentModel, q: np.ndarray) -> np.ndarray:
    """Return (time, vectors, dim): the nodal vectors of the element of an attachment to a cable."""
    cable, n = model.cables[attachment.cable], len(attachment.N)
    found: np.ndarray = q[:, cable.dofs_of(attachment.element)].reshape(len(q), n, model.dim)
    return found


def element_coordinates(cable: CableModel, values: np.ndarray, element: np.ndarray | None = None) -> np.ndarray:
    """Return (T, elements, vectors, dim) of a cable from (T, n); with element (T,) those of one element each, (T,
    vectors, dim).
    """
    nodal = cable.nodal(values)
    if element is not None:
        rows = np.arange(len(values))
        node = cable.mesh.first_node(element)
        return np.concatenate([nodal[rows, node], nodal[rows, node + 1]], axis=1)
    return np.concatenate([nodal[:, cable.mesh.first], nodal[:, cable.mesh.last]], axis=2)


def positions(cable: CableModel) -> np.ndarray:
    """Return (vectors,): which of an element's nodal vectors are positions."""
    return np.array([name == "r" for name in cable.vectors] * 2)


def distances(model: Model, scene: SceneData, contact: ContactModel, q: np.ndarray,
              elements: np.ndarray | None = None) -> np.ndarray:
    """Return (T, elements, points): distances in m of the points of a contact from its surface, in configurations q (T,
    n_q), of some of its elements, counted from its first, or of all.
    """
    cable, surface = model.cables[contact.cable], scene.surfaces[scene.contacts[contact.name].b]
    elements = np.arange(contact.n_elements) if elements is None else elements
    vectors, node = cable.nodal(q), cable.mesh.first_node(contact.first + elements)
    both = np.concatenate([vectors[:, node], vectors[:, node + 1]], axis=2)
    N = np.broadcast_to(contact.N, (contact.n_elements, *contact.N.shape[1:]))[elements]
    points = spatial(np.einsum("egk,tekd->tegd", N, both))
    if surface.on is not None:
        frame = body_state(model, next(body for body in model.bodies if body.name == surface.on), q)
        turned = conjugate(frame["orientation"])[:, None, None]
        points = rotate(turned, points - frame["position"][:, None, None])
    return surface.geometry.distance(points)
