"""What a run left: the engine's rows as named arrays, in three dimensions whatever the scene's."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..checks.placement import ends_of, joined, node_of
from ..parts.modal_body import ModalBody
from ..parts.settings import RunSettings
from ..rotations import rotate
from ..scene import Scene
from ..solve.diagnosis import stopped

if TYPE_CHECKING:
    from ..model.attachments import JointModel
    from ..model.build import Model
    from ..solve.event_watcher import Watcher


@dataclass
class Rows:
    """Output rows as plain arrays by name, time first. Units SI, vectors with three components."""

    time: np.ndarray
    cables: dict[str, dict]
    bodies: dict[str, dict]
    modal: dict[str, dict]
    slides: dict[str, dict]
    pins: dict[str, dict]
    clamps: dict[str, dict]
    motions: dict[str, dict]
    ties: dict[str, dict]
    joints: dict[str, dict]
    springs: dict[str, dict]
    energy: dict[str, np.ndarray]


@dataclass
class Recording(Rows):
    """What a run left: the rows that are still in memory, and how it went."""

    status: str
    message: str
    report: dict


def spatial(vectors: np.ndarray) -> np.ndarray:
    """(..., 2 or 3) -> (..., 3)."""
    return np.concatenate([vectors, np.zeros((*vectors.shape[:-1], 3 - vectors.shape[-1]))], axis=-1)


def given(model: Model, nodes, reaction: np.ndarray, q: np.ndarray) -> dict[str, np.ndarray]:
    """Force and moment that supports or joins give to nodes at one place.

    reaction, q: (time, dofs) generalised forces and configuration. Returns force, moment (time, 3) in N, N m: the
    moment is what the forces on the slopes turn the section by, sum of r_k x f_k.
    """
    force, moment = np.zeros((len(q), 3)), np.zeros((len(q), 3))
    for node in nodes:
        force += spatial(reaction[:, node.dofs("r")])
        for name in {"r_x", "r_y", "r_z"} & set(node.names):
            at = node.dofs(name)
            moment += np.cross(spatial(q[:, at]), spatial(reaction[:, at]))
    return {"force": force, "moment": moment}


def support_reaction(model: Model, scene: Scene, part, reaction: np.ndarray, q: np.ndarray) -> dict[str, np.ndarray]:
    """Force and moment of a pin, clamp or motion on its node and those joined to it."""
    nodes = joined(scene, node_of(scene, part))
    return given(model, [model.nodes[cable][k] for cable, k in nodes], reaction, q)


def tie_force(model: Model, scene: Scene, join, reaction: np.ndarray, q: np.ndarray) -> dict[str, np.ndarray]:
    """Force and moment of a join on the node of its `cable`: what the nodes on that side of it are given.

    A support on that side gives a part that is not the join's: then it is minus what the other side is given.
    """
    held = {node_of(scene, support) for support in scene.supports}
    one, other = ends_of(scene, join)
    sign, near = 1.0, joined(scene, one, without=join)
    if near & held:
        sign, near = -1.0, joined(scene, other, without=join)
    found = given(model, [model.nodes[cable][k] for cable, k in near], reaction, q)
    return {name: sign * value for name, value in found.items()}


def body_state(model: Model, body, q: np.ndarray) -> dict[str, np.ndarray]:
    """position, orientation of a body from configurations (time, n_q)."""
    b = body.configuration
    if model.dim == 3:
        centre, orientation = q[:, b : b + 3], q[:, b + 3 : b + 7]
    else:
        half = np.arctan2(q[:, b + 3], q[:, b + 2]) / 2
        zero = np.zeros_like(half)
        centre, orientation = spatial(q[:, b : b + 2]), np.stack([np.cos(half), zero, zero, np.sin(half)], axis=1)
    return {"position": centre - rotate(orientation, body.centre) if body.centre.any() else centre,
            "orientation": orientation}


def body_rates(model: Model, body, orientation: np.ndarray, v: np.ndarray, a: np.ndarray | None = None) -> dict:
    """velocity of a body's origin, angular_velocity, and with accelerations theirs, from rates (time, n_dof)."""
    at = slice(body.dof, body.dof + model.dim)
    turn = slice(at.stop, at.stop + (3 if model.dim == 3 else 1))
    velocity, omega = spatial(v[:, at]), _turning(v[:, turn])
    swing = np.cross(omega, body.centre)
    found = {"velocity": velocity - rotate(orientation, swing) if body.centre.any() else velocity,
             "angular_velocity": omega}
    if a is not None:
        acceleration, alpha = spatial(a[:, at]), _turning(a[:, turn])
        if body.centre.any():
            acceleration = acceleration - rotate(orientation, np.cross(alpha, body.centre) + np.cross(omega, swing))
        found |= {"acceleration": acceleration, "angular_acceleration": alpha}
    return found


def modal_state(model: Model, body, state: dict[str, np.ndarray], q: np.ndarray, v: np.ndarray | None = None) -> dict:
    """modal_coordinates (time, mode) and nodes (time, node, 3) of a modal body whose frame's `state` is known.

    With v (time, n_dof) modal_velocities, too.
    """
    start = body.configuration + (7 if model.dim == 3 else 4)
    eta, fields = q[:, start : start + body.modes], body.shape.fields
    place = fields.nodes + np.einsum("tk,kni->tni", eta, fields.modes)
    rate = body.dof + (6 if model.dim == 3 else 3)
    return {"modal_coordinates": eta,
            "nodes": state["position"][:, None] + rotate(state["orientation"][:, None], place)} | (
                {} if v is None else {"modal_velocities": v[:, rate : rate + body.modes]})


def named(model: Model, scene: Scene, engine) -> Rows:
    """The engine's rows by name."""
    rows = engine.rows()
    q, v, a = rows["q"], rows["v"], rows["acceleration"]
    cables = {}
    for cable in model.cables:
        at, shape = cable.coordinates, (len(q), *cable.shape)
        cables[cable.name] = {
            "nodal_vectors": spatial(q[:, at].reshape(shape)),
            "nodal_velocity": spatial(v[:, at].reshape(shape)),
            "node_s": cable.length * np.arange(cable.shape[0]),
            "vector_names": cable.vectors,
        }
    bodies, modal = {}, {}
    for body in model.bodies:
        state = body_state(model, body, q)
        bodies[body.name] = state | body_rates(model, body, state["orientation"], v, a)
        if body.modes:
            modal[body.name] = modal_state(model, body, state, q, v)
    slides = {}
    for k, joint in enumerate(model.slides):
        slides[joint.name] = {"s": rows["s"][:, k], **engine.slide_row(rows["slide"][:, k])}
        slides[joint.name]["residual"] = np.linalg.norm(slides[joint.name]["residual"], axis=-1)

    for k, link in enumerate(model.joints):
        if link.slide is not None:
            slides[link.slide]["moment"] = joint_state(link, rows["joint"][:, k])["moment"]

    def held(part) -> dict[str, np.ndarray]:
        return support_reaction(model, scene, part, rows["reaction"], q)

    return Rows(
        time=rows["time"],
        cables=cables,
        bodies=bodies,
        modal=modal,
        slides=slides,
        pins={pin.label: {"force": held(pin)["force"]} for pin in scene.pins},
        clamps={clamp.label: held(clamp) for clamp in scene.clamps},
        motions={motion.label: held(motion) for motion in scene.motions},
        ties={name: tie_force(model, scene, join, rows["reaction"], q) for name, join in scene.ties.items()},
        joints={link.name: joint_state(link, rows["joint"][:, k])
                for k, link in enumerate(model.joints) if link.slide is None},
        springs={spring.name: spring_state(model, spring, rows["spring"][:, k], q)
                 for k, spring in enumerate(model.springs)},
        energy={name: rows[name] for name in ("kinetic", "elastic", "potential", "dissipated", "external")},
    )


def recorded(model: Model, scene: Scene, engine, settings: RunSettings, status: str, messages: list[str],
             reason: str, watcher: Watcher, seconds: dict[str, float]) -> Recording:
    """The engine's rows by name, and its report."""
    statistics = engine.statistics
    statistics["time_s"] = seconds | statistics["time_s"]
    report = {
        "status": status,
        "integrator": engine.integrator,
        "integrator_reason": reason,
        "spectral_radius": settings.spectral_radius,
        "tol": settings.tol if settings.step is None else None,
        "step": settings.step,
        "unknowns": model.n_band + model.n_border_dof + model.n_extra,
        "kernels": model.kernels,
        "messages": messages,
        "events": watcher.happened,
        **statistics,
        "us_per_step": _costs(model, engine),
        "modes": {body.name: body.modes_in_words for body in scene.bodies.values() if isinstance(body, ModalBody)},
    }
    return Recording(
        **vars(named(model, scene, engine)),
        status="no_convergence" if status in ("singular", "unstable") else status,
        message=_message(model, engine, status, settings, watcher),
        report=report,
    )


def _costs(model: Model, engine) -> dict[str, float]:
    """µs of a step that each slide and joint takes by itself; a slide that ties its rider's axes has both its parts."""
    found: dict[str, float] = {}
    if model.slides or model.joints:
        for part, seconds in zip([*model.slides, *model.joints], engine.costs(), strict=True):
            found[part.name] = found.get(part.name, 0.0) + 1e6 * float(seconds)
    return found


def joint_state(link: JointModel, numbers: np.ndarray) -> dict[str, np.ndarray]:
    """Force and moment on the end b, and residual, from the engine's numbers (..., FU_JOINT_OUTPUTS) of a joint."""
    sign = -1.0 if link.reversed else 1.0  # that has its ends at one point
    return {"force": sign * numbers[..., :3], "moment": sign * numbers[..., 3:6], "residual": numbers[..., 6]}


def _turning(rates: np.ndarray) -> np.ndarray:
    """Rotation about three axes, or about z alone."""
    return rates if rates.shape[1] == 3 else np.concatenate([np.zeros((len(rates), 2)), rates], axis=1)


def spring_state(model: Model, spring, force: np.ndarray, q: np.ndarray) -> dict[str, np.ndarray]:
    """Force on the first end, (time, 3) in N; length between the ends, in m; tension, in N, negative in compression."""
    gap, force = end_points(model, spring.ends[1], q) - end_points(model, spring.ends[0], q), spatial(force)
    length = np.linalg.norm(gap, axis=1)
    along = gap / np.where(length > 0, length, 1.0)[:, None]
    return {"force": force, "length": length, "tension": np.sum(force * along, axis=1)}


def end_points(model: Model, end, q: np.ndarray) -> np.ndarray:
    """(time, 3): where an end of a spring is."""
    if end.cable >= 0:
        cable = model.cables[end.cable]
        start = cable.first + end.element * cable.shape[1] * model.dim
        vectors = q[:, start : start + len(end.N) * model.dim].reshape(len(q), -1, model.dim)
        return spatial(np.einsum("k,tkd->td", end.N, vectors))
    if end.body >= 0:
        body = model.bodies[end.body]
        state, arm = body_state(model, body, q), body.centre + end.u
        if end.spot is not None:
            eta = modal_state(model, body, state, q)["modal_coordinates"]
            arm = spatial(end.spot[0] + eta @ end.spot[1])
        return state["position"] + rotate(state["orientation"], arm)
    return np.broadcast_to(np.array(end.u), (len(q), 3))


def _message(model: Model, engine, status: str, settings: RunSettings, watcher: Watcher) -> str:
    when = f"t = {engine.time:.6g} s of {settings.duration:.6g} s"
    match status:
        case "end_of_cable":
            joint = model.slides[engine.stopped_joint]
            cable = model.cables[joint.cable]
            middle = 0.5 * cable.n_elements * cable.length
            end = "end" if engine.stopped_s > middle else "start"
            return (
                f'slide "{joint.name}": ran off the {end} of cable "{cable.name}" at {when}; '
                "what was computed up to there is kept"
            )
        case "no_convergence" | "singular" | "unstable":
            return stopped(model, engine, status, settings)
        case "event":
            return f'stopped by event "{watcher.stopped_by}" at {when}'
        case "interrupted":
            goes_on = "" if settings.save is None else ", and resume goes on with it"
            return f"interrupted at {when}; what was computed up to there is kept{goes_on}"
    return f"completed {settings.duration:.6g} s"
