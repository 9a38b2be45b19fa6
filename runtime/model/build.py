"""The model: what the engine integrates, made from a scene; and the run of it.

Coordinates, unknowns and their order are those of engine/engine.h.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from scipy.sparse import csr_array

from ..checks.velocity_jumps import velocity_jumps
from ..errors import FunicularWarning, SceneError
from ..kernels.elements import gauge
from ..kernels.libraries import kernels_of, tables_of
from ..parts import Cable, ModalBody, RigidBody, Slide
from ..parts.end_stops import Buffer, HardStop, Stop
from ..parts.friction import Friction
from ..parts.settings import RunSettings
from ..results.recording import Recording, named, recorded
from ..results.streaming import Stream, pauses
from ..rotations import rotate
from ..scene import Scene
from ..solve import reduced_strain
from ..solve.diagnosis import notes
from ..solve.event_watcher import Watcher
from ..solve.integrators import choose
from ..solve.long_runs import LongRun
from ..solve.progress import Meter
from ..solve.threads import share_elements
from .attachments import AttachmentBuilder, AttachmentModel, JointModel, linked, tied
from .body_modes import Shape
from .constants import constants
from .loads import Actions, DeadLoad, LoadModel, SignalModel, SpringModel
from .redundant_constraints import settle
from .unknowns import Node, Reduction, supports

MOST_OUTPUT = 4e9  # bytes
RESISTANCES = {2: "planar_resistance", 3: "resistance"}
BODIES = {2: ("planar_rigid", 4, 3), 3: ("rigid", 7, 6)}
"""Kernels, length of the configuration and dofs of a rigid body, by dimension of the scene."""
RIDERS = {2: "planar_point", 3: "point"}
"""Kernels of a slide whose rider is a point of anything else."""


@dataclass
class CableModel:
    """One cable: constants of its elements and where its coordinates are; A (1 or elements, constants)."""

    name: str
    element: str
    law: str
    n_elements: int
    first: int
    length: float
    tau: float
    mass_damping: float
    m: np.ndarray
    A: np.ndarray
    shape: tuple[int, int, int]
    vectors: tuple[str, ...]
    library: str | None

    @property
    def coordinates(self) -> slice:
        """Its part of q, v and the dofs."""
        return slice(self.first, self.first + int(np.prod(self.shape)))

    def kernel(self, name: str) -> Callable:
        """A kernel of its element."""
        return getattr(kernels_of(self.library), f"{self.element}_{name}")


@dataclass
class ShapeModel:
    """Modes of a body as the engine takes them: S (n + 1, dim), X (n + 1, n + 1, dim, dim), gravity (dim,)."""

    S: np.ndarray
    X: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    gravity: np.ndarray
    fields: Shape


@dataclass
class BodyModel:
    """One body: kernels of its frame, inertia, where its coordinates are; `shape` is that of a modal one.

    The engine's frame is at the mass centre of a rigid body, `centre` in its axes from the origin that the user sees.
    """

    name: str
    kernel: str
    mass: float
    inertia: np.ndarray
    centre: np.ndarray
    configuration: int
    dof: int
    shape: ShapeModel | None = None

    @property
    def modes(self) -> int:
        """Number of modes."""
        return 0 if self.shape is None else len(self.shape.stiffness)

    @property
    def modal_kernel(self) -> str:
        """Name of the kernels of its modes."""
        return self.kernel.replace("rigid", "modal")


@dataclass
class SlideModel:
    """One slide: kernels, its cable and its rider, its unknowns, what drives it, and where it starts.

    rider_is_rigid: the kernels take the rider's own configuration; max_multipliers: how many it may have; drive: a
    signal, or -1;
    resistance: kernels of friction and buffers, or none; ends: what waits at the start and at the end of the cable.
    """

    name: str
    kernel: str
    cable: int
    rider: AttachmentModel
    rider_is_rigid: bool
    unknown: int
    multiplier: int
    max_multipliers: int
    drive: int
    carries_director: bool
    mass: float
    s: float
    element: int
    director: np.ndarray
    resistance: str = ""
    friction: Friction | None = None
    ends: tuple[str | Stop, str | Stop] = ("error", "error")


@dataclass
class Model:
    """Arrays that the engine reads; see engine/engine.h for their meaning. tables: addresses of further kernels."""

    dim: int
    cables: list[CableModel]
    bodies: list[BodyModel]
    slides: list[SlideModel]
    joints: list[JointModel]
    springs: list[SpringModel]
    signals: list[SignalModel]
    motions: list[MotionModel]
    dead_loads: list[DeadLoad]
    loads: list[LoadModel]
    q: np.ndarray
    v: np.ndarray
    weight: np.ndarray
    gravity: np.ndarray
    place: np.ndarray
    combinations: csr_array
    n_band: int
    n_border_dof: int
    n_extra: int
    n_multipliers: int
    width: int
    chains: np.ndarray
    nodes: dict[str, list[Node]]
    tables: list[int] = field(default_factory=list)

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
        return sorted({c.element for c in self.cables} | {f"{c.element}_{c.law}" for c in self.cables}
                      | {slide.kernel for slide in self.slides} | {body.kernel for body in self.bodies}
                      | {joint.kernel for joint in self.joints}
                      | {slide.resistance for slide in self.slides if slide.resistance}
                      | {spring.kernel for spring in self.springs}
                      | {body.modal_kernel for body in self.bodies if body.modes})


@dataclass
class MotionModel:
    """A dof that follows a signal: base + linear f + cosine cos f + sine sin f."""

    dof: int
    signal: int
    base: float
    linear: float
    cosine: float
    sine: float


def build(scene: Scene) -> Model:
    """Number the coordinates of a scene and evaluate the constants of its elements. Raises SceneError."""
    dim = scene.dim
    cables, at = [], 0
    for cable in scene.cables.values():
        cables.append(_cable(cable, at))
        at = cables[-1].coordinates.stop
    n_flexible = at
    rigids = _bodies(scene, n_flexible)
    nodal = {c.name: part.nodal_vectors[..., :dim] for c, part in zip(cables, scene.cables.values(), strict=True)}
    nodes = {c.name: [Node(scene.cables[c.name].where, c.vectors,
                           c.first + k * int(np.prod(c.shape[1:])), vectors)
                      for k, vectors in enumerate(nodal[c.name])] for c in cables}
    holder = AttachmentBuilder(scene, cables, rigids)
    actions = Actions(scene, holder)
    elements = np.array([(node.first, 2 * node.vectors.size) for each in nodes.values() for node in each[:-1]],
                        dtype=int).reshape(-1, 2)
    reduction = supports(scene, nodes, actions.signal).reduce(n_flexible, elements)
    for load in scene.loads.values():
        actions.load(load)
    joints = []
    for slide in scene.slides.values():
        joints.append(_joint(slide, scene, holder, actions.signal, len(joints),
                             sum(joint.max_multipliers for joint in joints)))
    links, used, held = [], (1 + dim) * len(joints), sum(joint.max_multipliers for joint in joints)
    for k, part in enumerate([*scene.slides.values(), *scene.joints.values()]):
        if k >= len(joints):
            links.append(linked(holder, part, actions.signal, used, held))
        elif part.frame == "point":
            continue
        else:
            links.append(tied(holder, part, k, used, held))
        used, held = used + links[-1].rows, held + links[-1].rows
    springs = [actions.spring(spring, used + dim * k) for k, spring in enumerate(scene.springs.values())]
    gravity = np.array(scene.gravity)[:dim]
    n_of_bodies = sum(_dofs(body, dim) for body in rigids)
    return Model(
        dim, cables, rigids, joints, links, springs, actions.signals,
        [MotionModel(dof, p.signal, p.base, p.linear, p.cosine, p.sine) for dof, p in reduction.prescribed],
        actions.dead, actions.turning,
        q=np.concatenate([n.ravel() for n in nodal.values()] + [_attitude(b, dim) for b in scene.bodies.values()]
                         + [[]]),
        v=np.concatenate([_moving(scene, reduction)] + [_velocity(b, dim) for b in scene.bodies.values()]),
        weight=np.concatenate([_cable_weights(c) for c in scene.cables.values()]
                              + [_body_weights(b, dim) for b in scene.bodies.values()] + [[]]),
        gravity=np.concatenate([_gravity(m, c, gravity) for m, c in zip(cables, scene.cables.values(), strict=True)]
                               + [_body_gravity(b, gravity) for b in rigids] + [[]]),
        place=np.concatenate([reduction.place, reduction.n_unknowns + np.arange(n_of_bodies)]).astype(int),
        combinations=reduction.combinations,
        n_band=reduction.numbering.n_band,
        n_border_dof=reduction.n_unknowns - reduction.numbering.n_band + n_of_bodies,
        n_extra=used + dim * len(springs),
        n_multipliers=held,
        width=reduction.numbering.width,
        chains=reduction.numbering.chains,
        nodes=nodes,
        tables=[tables_of(name) for name in scene.libraries],
    )


def _cable(cable: Cable, first: int) -> CableModel:
    element, law, length = cable.element, cable.kernel_law, cable.length / cable.elements
    kernels, vectors = kernels_of(cable.library), cable.kind_of_element.nodal_vectors
    m = getattr(kernels, f"{element}_mass")(length, cable.material.density, cable.section.mass_moments())
    return CableModel(
        cable.name, element, law, cable.elements, first, length, cable.material.damping_time,
        cable.material.mass_damping, m, constants(cable), (cable.elements + 1, len(vectors), cable.dim), vectors,
        cable.library)


def _gravity(model: CableModel, cable: Cable, gravity: np.ndarray) -> np.ndarray:
    """(coordinates,): generalised weight of a cable; two elements meet at an inner node."""
    first, second = model.kernel("gravity")(model.length, cable.material.density, cable.section.mass_moments(),
                                            gravity).reshape(2, *model.shape[1:])
    weight = np.zeros(model.shape)
    weight[:-1] += first
    weight[1:] += second
    return weight.ravel()


def _moving(scene: Scene, reduction: Reduction) -> np.ndarray:
    """Rates of the cables' nodal vectors at the start, but for what supports hold."""
    asked = np.concatenate([*(cable.nodal_rates[..., : scene.dim].ravel() for cable in scene.cables.values()), []])
    unknowns, free, tied = np.zeros(reduction.combinations.shape[1]), reduction.place >= 0, reduction.place < -1
    unknowns[reduction.place[free]] = asked[free]
    given = np.zeros(len(asked))
    given[free] = unknowns[reduction.place[free]]
    given[tied] = (reduction.combinations @ unknowns)[-2 - reduction.place[tied]]
    return given


def _cable_weights(cable: Cable) -> np.ndarray:
    """How far a unit of each nodal vector moves a point: 1 for positions, and lengths for the slopes."""
    area, iyy, izz = cable.section.moments()[:3]
    unit = gauge(cable.kind_of_element.nodal_vectors, cable.length / cable.elements, np.sqrt(iyy / area),
                 np.sqrt(izz / area))
    return np.repeat(np.tile(list(unit), cable.elements + 1), cable.dim)


def _bodies(scene: Scene, at: int) -> list[BodyModel]:
    """Bodies in the scene's order, their coordinates from `at` on."""
    dim, made, dof = scene.dim, [], at
    kernel, n_configuration, n_velocity = BODIES[dim]
    for body in scene.bodies.values():
        shape = _shape(body, np.array(scene.gravity)[:dim]) if isinstance(body, ModalBody) else None
        centre = np.zeros(3) if shape else np.array(body.centre)
        made.append(BodyModel(body.name, kernel, body.mass, np.array(body.inertia), centre, at, dof, shape))
        at += n_configuration + made[-1].modes
        dof += n_velocity + made[-1].modes
    return made


def _shape(body: ModalBody, gravity: np.ndarray) -> ShapeModel:
    shape, dim = body.shape, len(gravity)
    return ShapeModel(shape.S[:, :dim], shape.X[:, :, :dim, :dim], shape.stiffness, shape.damping(body.damping_ratio),
                      gravity, shape)


def _dofs(body: BodyModel, dim: int) -> int:
    return BODIES[dim][2] + body.modes


def _attitude(body: RigidBody | ModalBody, dim: int) -> np.ndarray:
    """Its configuration, undeformed."""
    if isinstance(body, ModalBody):
        (position, orientation), modes = body.frame, np.zeros(body.shape.n)
    else:
        position, orientation, modes = body.point(body.centre), body.orientation, np.zeros(0)
    if dim == 2:
        w, _, _, z = orientation
        orientation = w * w - z * z, 2 * w * z
    return np.array([*position[:dim], *orientation, *modes])


def _velocity(body: RigidBody | ModalBody, dim: int) -> np.ndarray:
    turning = np.array(body.angular_velocity)
    velocity, modes = np.array(body.velocity), np.zeros(0)
    if isinstance(body, ModalBody):
        modes = np.zeros(body.shape.n)
    else:
        velocity = velocity + rotate(body.orientation, np.cross(turning, body.centre))
    return np.concatenate([velocity[:dim], turning[2 if dim == 2 else 0 :], modes])


def _body_weights(body: RigidBody | ModalBody, dim: int) -> np.ndarray:
    """1 for the origin, the largest radius of gyration for turns, the root mean square of displacement for modes."""
    inertia = np.array(body.inertia)
    largest = inertia[2, 2] if dim == 2 else np.max(np.linalg.eigvalsh(inertia))
    modes = np.sqrt(np.diag(body.shape.modal_mass) / body.mass) if isinstance(body, ModalBody) else np.zeros(0)
    return np.concatenate([np.ones(dim), np.full(1 if dim == 2 else 3, np.sqrt(largest / body.mass)), modes])


def _body_gravity(body: BodyModel, gravity: np.ndarray) -> np.ndarray:
    """Of a modal body nothing: its weight turns and deforms with it, and is among its forces."""
    weight = np.zeros(_dofs(body, len(gravity)))
    if not body.modes:
        weight[: len(gravity)] = body.mass * gravity
    return weight


def _joint(slide: Slide, scene: Scene, holder: AttachmentBuilder, signal, number: int, multiplier: int) -> SlideModel:
    along, dim = scene.cables[slide.along], scene.dim
    axes = along.axes_at(slide.s)
    at = slide.s / along.length * along.elements
    node = along.node_at(slide.s)
    body = scene.bodies.get(slide.body)
    rider_is_rigid = isinstance(body, RigidBody)
    if node is not None:  # on a node: the element that the rider moves into
        forward = body is None or np.dot(axes[0], body.velocity) >= 0
        at = node if forward else node - 1
    rider = holder.end(slide.rider)
    driven, ends, friction = slide.prescribed is not None, (slide.at_start, slide.at_end), slide.friction
    may_hold = driven or (friction is not None and friction.sticks) or any(isinstance(end, HardStop) for end in ends)
    resistances = friction is not None or any(isinstance(end, Buffer) for end in ends)
    return SlideModel(
        slide.name,
        f"slide_{along.element}_{BODIES[dim][0] if rider_is_rigid else RIDERS[dim]}",
        holder.cable_index[slide.along],
        rider,
        rider_is_rigid,
        (1 + dim) * number,
        multiplier,
        dim - 1 + may_hold,
        signal(slide.prescribed) if driven else -1,
        dim == 3 and not along.kind_of_element.director,
        rider.mass,
        slide.s,
        int(np.clip(np.floor(at), 0, along.elements - 1)),
        axes[1],
        RESISTANCES[dim] * resistances,
        friction if resistances else None,
        ends,
    )


def simulate(scene: Scene, settings: RunSettings, on_progress: Meter, initial=None,
             stream: Stream | None = None) -> Recording:
    """Integrate a checked scene; calls on_progress(time reached in s) about twenty times a second.

    initial: an `Equilibrium` of this scene to start from, at the scene's velocities; stream: takes the rows as they
    come, so that only the last ones are in what is returned.
    """
    from ..engine import Engine
    from ..solve import straight_struts

    begin = time.perf_counter()
    model = build(scene)
    if initial is not None:
        initial.start(model)
    output_step = settings.output_step
    pace = pauses(int(np.ceil(settings.duration / output_step)) + 1, _check_size(model, settings, stream))
    engine, watcher = Engine(model), Watcher(scene, model)
    engine.watch(watcher)
    messages = settle(model, engine)
    if initial is not None:
        messages += [f"equilibrium to start from: {message}" for message in initial.messages]
    if settings.step is not None:
        step = output_step / np.ceil(output_step / settings.step * (1 - 1e-9))
        if step < settings.step * (1 - 1e-6):
            messages.append(f"step {settings.step:.6g} s was made {step:.6g} s, so that steps end on output times")
    messages += share_elements(engine, settings.threads)
    method, reason = choose(settings, scene, model, engine)
    if method.name == "energy":
        _check_conserves(model, scene, engine, method)
    set_up, cpu = time.perf_counter() - begin, time.process_time()
    status, change = engine.start(
        duration=settings.duration,
        output_step=output_step,
        tol=settings.tol,
        step=settings.step or 0.0,
        method=method,
        first_step=min(output_step, 1e-3 * settings.duration),
        capacity=None if stream is None else pace.room,
    )
    if status == "singular" and engine.jammed >= 0:
        slide = list(scene.slides.values())[engine.jammed]
        raise SceneError(slide.where, "friction jams it at the start: the more it holds, the more it presses it on the "
                         "cable", "take a smaller coefficient, or the rider's point nearer to its centre of mass")
    if status == "singular":
        raise SceneError("scene", "the equations are singular at the start: a mass is zero, or a cable's director lies "
                         "along its tangent", "look at masses and inertias, and at up")
    if engine.closed > 1e-9 * engine.extent:
        messages.append(f"gaps of joints were closed at the start: things moved by up to {engine.closed:.3g} m")
    largest = float(np.max(np.abs(change) * model.weight, initial=0.0))  # rates of slopes and turns as those of points
    if largest > 1e-9 * (1.0 + np.max(np.abs(model.v) * model.weight, initial=0.0)):
        messages.append(f"initial velocities broke a joint: changed by up to {largest:.3g} m/s to keep it")
        warnings.warn(messages[-1], FunicularWarning, stacklevel=3)
    for jump in velocity_jumps(scene, settings.duration):
        messages.append(jump)
        warnings.warn(jump, FunicularWarning, stacklevel=3)
    if status is None:
        if stream is not None:
            stream.start(model, engine, partial(named, model, scene, engine), pace, watcher.happened)
        pace_watch = LongRun(model, engine, settings, watcher, on_progress)
        status = engine.advance(pace_watch, pace.every, stream)
        messages += pace_watch.notes()
    cpu, wall = time.process_time() - cpu, time.perf_counter() - begin + (stream.elapsed if stream else 0.0)
    if status == "completed":
        rows = engine.rows()
        for note in [*notes(engine, settings), *straight_struts.notes(scene, model, engine),
                     *reduced_strain.notes(scene, model, rows["time"], rows["q"])]:
            messages.append(note)
            warnings.warn(note, FunicularWarning, stacklevel=3)
    recording = recorded(model, scene, engine, settings, status, messages, reason, watcher,
                         {"set_up": set_up, "total": wall})
    recording.report["time_s"]["solve_cpu"] = cpu  # of the integration alone, whatever else the machine does
    return recording


def _check_conserves(model: Model, scene: Scene, engine, method) -> None:
    """Raise SceneError for what has no discrete gradient, or lacks the algorithmic dissipation that is asked for."""
    for body in model.bodies:
        if body.modes:
            raise SceneError(scene.bodies[body.name].where, 'integrator "energy" does not know modal bodies',
                             'take "radau" with a small tol, or "genalpha"')
    for cable in model.cables:
        if not hasattr(kernels_of(cable.library), f"{cable.element}_{cable.law}_discrete_force"):
            raise SceneError(scene.cables[cable.name].where,
                             f'integrator "energy" has no discrete gradient of the law "{cable.law}"',
                             "take another law, or another integrator")
    if method.spectral_radius < 1:
        for cable in [model.cables[i] for i in engine.without_algorithmic_force()]:
            raise SceneError(scene.cables[cable.name].where,
                             f'integrator "energy" has no algorithmic dissipation of the law "{cable.law}"',
                             "take spectral_radius = 1, another law, or another integrator")
    for slide in scene.slides.values():
        if slide.friction is not None or (slide.at_start, slide.at_end) != ("error", "error"):
            raise SceneError(slide.where, 'integrator "energy" knows neither friction nor ends of cables',
                             "take another integrator: genalpha, radau and explicit do")
    parts = [*(scene.joints[link.name] for link in model.joints if link.slide is None),
             *(slide for slide, joint in zip(scene.slides.values(), model.slides, strict=True)
               if not joint.rider_is_rigid or joint.drive >= 0 or slide.frame != "point")]
    for part in parts:
        raise SceneError(part.where, 'integrator "energy" has no discrete gradient of it',
                         "take another integrator: genalpha and radau know all joints")


def _check_size(model: Model, settings: RunSettings, stream: Stream | None) -> float:
    """Bytes of a row; refuses what no memory holds or, for a stream, what does not fit on its disk."""
    per_row = 8 * (model.n_q + 3 * model.n_dof + 12 * len(model.slides) + 7 * len(model.joints)
                   + 3 * len(model.springs) + 6)
    need = per_row * settings.duration / settings.output_step
    most, where = (MOST_OUTPUT, "") if stream is None else (stream.free, " that are free on the disk")
    if not need < most:
        raise SceneError("run", f"output_step {settings.output_step:.6g} s makes {need:.3g} bytes of results, more "
                         f"than the {most:.3g}{where}", "take a larger output_step")
    return per_row
