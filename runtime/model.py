"""The model: what the engine integrates, made from a scene; and the run of it.

Coordinates, unknowns and their order are those of engine/engine.h.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from funicular.elements import gauge
from funicular.errors import FunicularWarning, SceneError
from funicular.libraries import kernels_of, tables_of
from funicular.parts import Cable
from funicular.scene import Scene
from funicular.settings import RunSettings
from funicular.stiffness import section_stiffness

DIM = 3
MOST_OUTPUT = 4e9  # bytes
RIGID_DOFS, RIGID_CONFIGURATION = 6, 7


@dataclass
class CableModel:
    """One cable: constants of its (equal) elements and where its coordinates are."""

    name: str
    element: str
    law: str
    n_elements: int
    first: int
    length: float
    tau: float
    m: np.ndarray
    A: np.ndarray
    gravity: np.ndarray
    shape: tuple[int, int, int]
    vectors: tuple[str, ...]
    tables: int = 0

    @property
    def coordinates(self) -> slice:
        """Its part of q, v and the dofs."""
        return slice(self.first, self.first + int(np.prod(self.shape)))


@dataclass
class RigidModel:
    """One rigid body: inertia, weight and where its coordinates are."""

    name: str
    mass: float
    inertia: np.ndarray
    gravity: np.ndarray
    configuration: int
    dof: int


@dataclass
class JointModel:
    """One slide: kernels, the two bodies (indices), the rider's point and where it starts."""

    name: str
    kernel: str
    cable: int
    rider: int
    u: tuple[float, float, float]
    mass: float
    s: float
    element: int
    director: np.ndarray


@dataclass
class Model:
    """Arrays that the engine reads; see engine/engine.h for their meaning."""

    cables: list[CableModel]
    rigids: list[RigidModel]
    joints: list[JointModel]
    q: np.ndarray
    v: np.ndarray
    weight: np.ndarray
    place: np.ndarray
    n_band: int
    n_border_dof: int
    width: int
    pins: dict[str, slice] = field(default_factory=dict)

    @property
    def n_q(self) -> int:
        """Length of the configuration."""
        return len(self.q)

    @property
    def n_dof(self) -> int:
        """Length of the velocities."""
        return len(self.v)

    @property
    def kernels(self) -> list[str]:
        """Names of the kernel families that the scene touches."""
        return sorted(
            {c.element for c in self.cables} | {j.kernel for j in self.joints} | ({"rigid"} if self.rigids else set())
        )


@dataclass
class Recording:
    """What a run left, as plain arrays; nt output times. Units SI."""

    status: str
    message: str
    time: np.ndarray
    cables: dict[str, dict]
    bodies: dict[str, dict]
    slides: dict[str, dict]
    pins: dict[str, dict]
    energy: dict[str, np.ndarray]
    report: dict


def build(scene: Scene) -> Model:
    """Number the coordinates of a scene and evaluate the constants of its elements."""
    gravity = np.array(scene.gravity)
    cables, at = [], 0
    for cable in scene.cables.values():
        cables.append(_cable(cable, gravity, at))
        at = cables[-1].coordinates.stop
    n_flexible = at
    rigids = [
        RigidModel(
            body.name,
            body.mass,
            np.array(body.inertia),
            body.mass * gravity,
            n_flexible + RIGID_CONFIGURATION * k,
            n_flexible + RIGID_DOFS * k,
        )
        for k, body in enumerate(scene.bodies.values())
    ]
    q = np.concatenate(
        [c.nodal_vectors.ravel() for c in scene.cables.values()]
        + [[*b.position, *b.orientation] for b in scene.bodies.values()]
        + [[]]
    )
    v = np.concatenate([np.zeros(n_flexible)] + [[*b.velocity, *b.angular_velocity] for b in scene.bodies.values()])
    pins = {}
    fixed = np.zeros(len(v), dtype=bool)
    by_name = {c.name: c for c in cables}
    for pin in scene.pins:
        cable = by_name[pin.cable]
        start = cable.first + scene.cables[pin.cable].node_at(pin.s) * cable.shape[1] * DIM
        pins[pin.label] = slice(start, start + DIM)
        fixed[pins[pin.label]] = True
    place = np.where(fixed, -1, np.cumsum(~fixed) - 1)
    weight = np.concatenate(
        [_cable_weights(c) for c in scene.cables.values()] + [_rigid_weights(b) for b in scene.bodies.values()] + [[]]
    )
    bodies = list(scene.bodies)
    joints = [
        _joint(slide, scene, list(scene.cables).index(slide.along), bodies.index(slide.body))
        for slide in scene.slides.values()
    ]
    return Model(
        cables,
        rigids,
        joints,
        q,
        v,
        weight,
        place,
        n_band=int(np.sum(~fixed[:n_flexible])),
        n_border_dof=RIGID_DOFS * len(rigids),
        width=max((2 * c.shape[1] * DIM - 1 for c in cables), default=0),
        pins=pins,
    )


def _cable(cable: Cable, gravity: np.ndarray, first: int) -> CableModel:
    kernels, vectors = kernels_of(cable.library), cable.kind_of_element.nodal_vectors
    element, law, length = cable.element, cable.law, cable.length / cable.elements
    section, density = cable.section.moments(), cable.material.density
    stiffness = getattr(kernels, f"{element}_{law}_stiffness")
    return CableModel(
        cable.name, element, law, cable.elements, first, length, cable.material.damping_time,
        m=getattr(kernels, f"{element}_mass")(length, density, section),
        A=stiffness(length, section_stiffness(cable.kind_of_element.laws[law], cable.section, cable.material)),
        gravity=getattr(kernels, f"{element}_gravity")(length, density, section, gravity),
        shape=(cable.elements + 1, len(vectors), DIM), vectors=vectors, tables=tables_of(cable.library))


def _cable_weights(cable: Cable) -> np.ndarray:
    """How far a unit of each nodal vector moves a point: 1 for positions, and lengths for the slopes."""
    area, iyy, izz = cable.section.moments()[:3]
    unit = gauge(cable.kind_of_element.nodal_vectors, cable.length / cable.elements, np.sqrt(iyy / area),
                 np.sqrt(izz / area))
    return np.repeat(np.tile(list(unit), cable.elements + 1), DIM)


def _rigid_weights(body) -> np.ndarray:
    """1 for the centre, the largest radius of gyration for rotations."""
    radius = np.sqrt(np.max(np.linalg.eigvalsh(np.array(body.inertia))) / body.mass)
    return np.repeat([1.0, radius], DIM)


def _joint(slide, scene: Scene, cable: int, rider: int) -> JointModel:
    along, body = scene.cables[slide.along], scene.bodies[slide.body]
    at = slide.s / along.length * along.elements
    node = along.node_at(slide.s)
    if node is not None:  # on a node: the element that the body moves into
        forward = np.dot(along.axes[0], body.velocity) >= 0
        at = node if forward else node - 1
    return JointModel(
        slide.name,
        f"slide_{along.element}_rigid",
        cable,
        rider,
        slide.at,
        body.mass,
        slide.s,
        int(np.clip(np.floor(at), 0, along.elements - 1)),
        along.axes[1],
    )


def generalised_alpha(spectral_radius: float) -> tuple[float, float, float, float]:
    """alpha_m, alpha_f, beta, gamma for a spectral radius at infinite frequency (Chung & Hulbert 1993)."""
    alpha_m = (2 * spectral_radius - 1) / (spectral_radius + 1)
    alpha_f = spectral_radius / (spectral_radius + 1)
    return alpha_m, alpha_f, (1 - alpha_m + alpha_f) ** 2 / 4, 0.5 - alpha_m + alpha_f


def simulate(scene: Scene, settings: RunSettings, on_progress: Callable[[float], None]) -> Recording:
    """Integrate a checked scene; calls on_progress(time reached in s) about twenty times a second."""
    from funicular.engine import Engine

    begin = time.perf_counter()
    model = build(scene)
    output_step = settings.output_step
    _check_size(model, settings)
    engine = Engine(model)
    messages = []
    if settings.step is not None:
        step = output_step / np.ceil(output_step / settings.step * (1 - 1e-9))
        if step < settings.step * (1 - 1e-6):
            messages.append(f"step {settings.step:.6g} s was made {step:.6g} s, so that steps end on output times")
    set_up = time.perf_counter() - begin
    status, change = engine.start(
        duration=settings.duration,
        output_step=output_step,
        tol=settings.tol,
        step=settings.step or 0.0,
        scheme=generalised_alpha(settings.spectral_radius),
        first_step=min(output_step, 1e-3 * settings.duration),
    )
    if status == "singular":
        raise SceneError("scene", "the equations are singular at the start: a joint holds what another one holds "
                         "already, or a cable's director lies along its tangent", "look at the slides, and at up")
    largest = float(np.max(np.abs(change) * model.weight, initial=0.0))  # rates of slopes and turns as those of points
    if largest > 1e-9 * (1.0 + np.max(np.abs(model.v) * model.weight, initial=0.0)):
        messages.append(f"initial velocities broke a joint: changed by up to {largest:.3g} m/s to keep it")
        warnings.warn(messages[-1], FunicularWarning, stacklevel=3)
    if status is None:
        status = engine.advance(on_progress)
    wall = time.perf_counter() - begin
    return _recording(model, engine, settings, status, messages, {"set_up": set_up, "total": wall})


def _check_size(model: Model, settings: RunSettings) -> None:
    """Refuse what no memory holds, before it is asked for."""
    per_row = 8 * (model.n_q + 3 * model.n_dof + 11 * len(model.joints) + 5)
    need = per_row * settings.duration / settings.output_step
    if not need < MOST_OUTPUT:
        raise SceneError("run", f"output_step {settings.output_step:.6g} s makes {need:.3g} bytes of results, more "
                         f"than {MOST_OUTPUT:.3g}", "take a larger output_step")


def _recording(
    model: Model, engine, settings: RunSettings, status: str, messages: list[str], seconds: dict[str, float]
) -> Recording:
    rows = engine.rows()
    q, v, a = rows["q"], rows["v"], rows["acceleration"]
    cables = {}
    for cable in model.cables:
        at, shape = cable.coordinates, (len(q), *cable.shape)
        cables[cable.name] = {
            "nodal_vectors": q[:, at].reshape(shape),
            "nodal_velocity": v[:, at].reshape(shape),
            "node_s": cable.length * np.arange(cable.shape[0]),
            "vector_names": cable.vectors,
        }
    bodies = {}
    for body in model.rigids:
        b, d = body.configuration, body.dof
        bodies[body.name] = {
            "position": q[:, b : b + 3],
            "orientation": q[:, b + 3 : b + 7],
            "velocity": v[:, d : d + 3],
            "angular_velocity": v[:, d + 3 : d + 6],
            "acceleration": a[:, d : d + 3],
            "angular_acceleration": a[:, d + 3 : d + 6],
        }
    slides = {}
    for k, joint in enumerate(model.joints):
        slides[joint.name] = {"s": rows["s"][:, k], **engine.joint_row(rows["joint"][:, k])}
        slides[joint.name]["residual"] = np.linalg.norm(slides[joint.name]["residual"], axis=-1)
    statistics = engine.statistics
    statistics["time_s"] = seconds | statistics["time_s"]
    report = {
        "status": status,
        "integrator": "genalpha",
        "spectral_radius": settings.spectral_radius,
        "tol": settings.tol if settings.step is None else None,
        "step": settings.step,
        "unknowns": model.n_band + model.n_border_dof + 4 * len(model.joints),
        "kernels": model.kernels,
        "messages": messages,
        **statistics,
    }
    return Recording(
        status="no_convergence" if status == "singular" else status,
        message=_message(model, engine, status, settings),
        time=rows["time"],
        cables=cables,
        bodies=bodies,
        slides=slides,
        pins={label: {"force": rows["reaction"][:, at]} for label, at in model.pins.items()},
        energy={name: rows[name] for name in ("kinetic", "elastic", "potential", "dissipated")},
        report=report,
    )


def _message(model: Model, engine, status: str, settings: RunSettings) -> str:
    when = f"t = {engine.time:.6g} s of {settings.duration:.6g} s"
    match status:
        case "end_of_cable":
            joint = model.joints[engine.stopped_joint]
            cable = model.cables[joint.cable]
            middle = 0.5 * cable.n_elements * cable.length
            end = "end" if engine.rows()["s"][-1, engine.stopped_joint] > middle else "start"
            return (
                f'slide "{joint.name}": ran off the {end} of cable "{cable.name}" at {when}; '
                "what was computed up to there is kept"
            )
        case "no_convergence":
            return (
                f"no step converged at {when}, down to the smallest step; what was computed up to there is "
                "kept. Try a smaller tol or step, or damping_time in the material"
            )
        case "singular":
            return (
                f"the equations are singular at {when}: a joint or the mass matrix is degenerate "
                "(is a cable's director parallel to its tangent?)"
            )
        case "interrupted":
            return f"interrupted at {when}; what was computed up to there is kept"
    return f"completed {settings.duration:.6g} s"
