"""The scene: what the user describes, and how it is run."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from typing import TYPE_CHECKING

from .checks.placement import check_support, check_tie, placed_load, placed_spring
from .checks.planarity import check_plane
from .errors import ConvergenceError, EndOfCableError, FunicularWarning, ResultFileError, SceneError
from .parts import (
    EXACT,
    Cable,
    Clamp,
    DistributedForce,
    Event,
    Force,
    Joint,
    ModalBody,
    Moment,
    Motion,
    Pin,
    RigidBody,
    Slide,
    Spring,
    Tie,
)
from .parts.end_stops import Stop
from .parts.friction import Friction
from .parts.material import Material
from .parts.section import Section
from .parts.settings import EquilibriumSettings, ModeSettings, RunSettings
from .parts.support import Support
from .parts.validation import Part, show, shown, vector
from .results.run import Run
from .solve.progress import progress_bar
from .solve.threads import one_blas_thread

if TYPE_CHECKING:
    from .solve.modes import Modes
    from .solve.static import Equilibrium

RESERVED = ("energy", "time")


@contextmanager
def _in_memory() -> Iterator[None]:
    """For what may ask for more memory than there is."""
    try:
        yield
    except MemoryError:
        raise SceneError("scene", "takes more memory than this machine has",
                         "take fewer elements, fewer bodies and slides, or a larger output_step") from None


class Scene:
    """Cables, bodies, and what joins, holds and loads them.

    ``gravity`` in m/s²; ``cables``, ``bodies``, ``joints``, ``slides``, ``joins``, ``loads``, ``springs``, ``events``
    are dicts by name; ``pins``, ``clamps`` and ``motions`` are lists; ``messages`` tells what was adjusted;
    ``run_settings`` and ``equilibrium_settings`` hold the settings that a scene file gives.
    """

    def __init__(self, gravity=(0, -9.81, 0)):
        """An empty scene; gravity: 3 numbers in m/s². Raises SceneError."""
        try:
            self.gravity = vector(gravity, "m/s²")
        except ValueError as error:
            raise SceneError("scene", f"gravity {error}") from None
        self.cables: dict[str, Cable] = {}
        self.pins: list[Pin] = []
        self.clamps: list[Clamp] = []
        self.motions: list[Motion] = []
        self.ties: dict[str, Tie] = {}
        self.bodies: dict[str, RigidBody | ModalBody] = {}
        self.joints: dict[str, Joint] = {}
        self.slides: dict[str, Slide] = {}
        self.loads: dict[str, Force | DistributedForce | Moment] = {}
        self.springs: dict[str, Spring] = {}
        self.events: dict[str, Event] = {}
        self.messages: list[str] = []
        self.run_settings: dict = {}
        self.equilibrium_settings: dict = {}

    def cable(
        self,
        name: str,
        *,
        start=None,
        end=None,
        points=None,
        curve: Callable | None = None,
        elements: int,
        section: Section,
        material: Material,
        element: str = "beam24",
        library: str | os.PathLike | None = None,
        law: str | None = None,
        strain: str | None = None,
        curvature: str | None = None,
        membrane: str | None = None,
        up=(0, 1, 0),
        rest: str = "drawn",
        rest_length: float | None = None,
        velocity=(0, 0, 0),
        angular_velocity=(0, 0, 0),
    ) -> Cable:
        """Add a cable of equal elements: straight, through points, or along a curve; see `Cable`. Raises SceneError."""
        shape = {"start": start, "end": end, "points": points, "curve": curve, "law": law, "strain": strain,
                 "curvature": curvature, "membrane": membrane, "rest_length": rest_length}
        return self.add(
            Cable(
                name=name,
                elements=elements,
                element=element,
                library=library,
                section=section,
                material=material,
                up=up,
                rest=rest,
                velocity=velocity,
                angular_velocity=angular_velocity,
                **{keyword: value for keyword, value in shape.items() if value is not None},
            )
        )

    def rigid_body(
        self,
        name: str,
        *,
        mass: float,
        inertia,
        position,
        orientation=(1, 0, 0, 0),
        centre=(0, 0, 0),
        velocity=(0, 0, 0),
        angular_velocity=(0, 0, 0),
    ) -> RigidBody:
        """Add a rigid body; see `RigidBody`. Raises SceneError."""
        return self.add(
            RigidBody(
                name=name,
                mass=mass,
                inertia=inertia,
                position=position,
                velocity=velocity,
                orientation=orientation,
                centre=centre,
                angular_velocity=angular_velocity,
            )
        )

    def modal_body(
        self,
        name: str,
        *,
        start=None,
        end=None,
        section: Section | None = None,
        material: Material | None = None,
        up=(0, 1, 0),
        elements: int = 10,
        element: str = "beam24",
        law: str | None = None,
        modes: int = 5,
        boundary: str = "free",
        data: str | os.PathLike | None = None,
        orthogonal: bool = True,
        position=None,
        orientation=(1, 0, 0, 0),
        damping_ratio: float = 0.0,
        velocity=(0, 0, 0),
        angular_velocity=(0, 0, 0),
    ) -> ModalBody:
        """Add a body that deforms in a few modes: a beam, or what a file says; see `ModalBody`. Raises SceneError."""
        described = {"start": start, "end": end, "section": section, "material": material, "law": law, "data": data,
                     "position": position}
        return self.add(ModalBody(
            name=name, up=up, elements=elements, element=element, modes=modes, boundary=boundary, orthogonal=orthogonal,
            orientation=orientation, damping_ratio=damping_ratio, velocity=velocity, angular_velocity=angular_velocity,
            **{keyword: value for keyword, value in described.items() if value is not None}))

    def pin(self, cable: Cable | str, *, s: float) -> Pin:
        """Hold the node of ``cable`` at arc-length ``s`` (m) in its place. Raises SceneError."""
        return self.add(Pin(cable=cable, s=s))

    def clamp(self, cable: Cable | str, *, s: float, hold: str = "section") -> Clamp:
        """Hold the node of ``cable`` at ``s`` (m) in its place and direction; see `Clamp`. Raises SceneError."""
        return self.add(Clamp(cable=cable, s=s, hold=hold))

    def motion(self, cable: Cable | str, *, s: float, displacement=None, rotation=None) -> Motion:
        """Move the node of ``cable`` at ``s`` (m) as prescribed.

        displacement: 3 signals or numbers (m), None or "free" where it is free; rotation: an axis and a signal (rad);
        see `Motion`. Raises SceneError.
        """
        return self.add(Motion(cable=cable, s=s, displacement=displacement, rotation=rotation))

    def tie(self, cable: Cable | str, *, s: float, to: Cable | str, at: float, rotation: str = "rigid",
             name: str | None = None) -> Tie:
        """Tie nodes of two cables, at ``s`` and ``at`` (m), rigidly or as a hinge; see `Tie`. Raises SceneError."""
        return self.add(Tie(cable=cable, s=s, to=to, at=at, rotation=rotation, **_named(name)))

    def force(self, on: Cable | RigidBody | str, *, value, s: float | None = None, at=None, scale=1.0,
              follower: bool = False, name: str | None = None) -> Force:
        """Add a force of ``value`` (N) times the signal ``scale``; see `Force`. Raises SceneError."""
        place = {keyword: given for keyword, given in (("s", s), ("at", at)) if given is not None}
        return self.add(Force(on=on, value=value, scale=scale, follower=follower, **place, **_named(name)))

    def distributed_force(self, cable: Cable | str, *, value, start: float | None = None, stop: float | None = None,
                          scale=1.0, follower: bool = False, name: str | None = None) -> DistributedForce:
        """Add a force along a cable, ``value`` in N/m; see `DistributedForce`. Raises SceneError."""
        ends = {keyword: given for keyword, given in (("start", start), ("stop", stop)) if given is not None}
        return self.add(DistributedForce(cable=cable, value=value, scale=scale, follower=follower, **ends,
                                         **_named(name)))

    def moment(self, on: Cable | RigidBody | str, *, value, s: float | None = None, scale=1.0,
               name: str | None = None) -> Moment:
        """Add a moment of ``value`` (N m) times the signal ``scale``; see `Moment`. Raises SceneError."""
        place = {} if s is None else {"s": s}
        return self.add(Moment(on=on, value=value, scale=scale, **place, **_named(name)))

    def spring(self, a, b, *, stiffness: float, damping: float = 0.0, length: float | None = None,
               name: str | None = None) -> Spring:
        """Add a spring with a damper between two points; see `Spring`. Raises SceneError."""
        free = {} if length is None else {"length": length}
        return self.add(Spring(a=a, b=b, stiffness=stiffness, damping=damping, **free, **_named(name)))

    def event(self, name: str | None = None, *, quantity: str | None = None, s: float | None = None,
              value: float = 0.0, function: Callable | None = None, direction: str = "both",
              action: str = "record") -> Event:
        """Find the instants at which a quantity passes ``value``, or ``function(time, state)`` zero; see `Event`.

        They stand in ``run.events``; action "stop" ends the run at the first. Raises SceneError.
        """
        place = {} if s is None else {"s": s}
        return self.add(Event(quantity=quantity, value=value, function=function, direction=direction, action=action,
                              **place, **_named(name)))

    def joint(self, kind: str, a, b, *, axis=None, second_axis=None, up=None, angle=None, distance=None, velocity=None,
              length: float | None = None, name: str | None = None) -> Joint:
        """Tie two ends, free or driven by a signal.

        kind: "spherical", "revolute", "universal", "prismatic", "cylindrical", "weld" or "distance"; a, b: the ends, as
        of a spring; axis, second_axis, up: directions; angle (rad), distance (m) or velocity (rad/s, m/s): signals;
        length in m; see `Joint`. Ends with a small gap are brought together, with a `FunicularWarning`. Raises
        SceneError.
        """
        return self.add(Joint(kind=kind, a=a, b=b, **_given(
            axis=axis, second_axis=second_axis, up=up, angle=angle, distance=distance, velocity=velocity, length=length,
            name=name)))

    def slide(
        self,
        body: RigidBody | str | tuple,
        *,
        along: Cable | str,
        s: float,
        at=(0, 0, 0),
        frame: str = "point",
        roll: str = "free",
        up=None,
        drive=None,
        velocity=None,
        friction: Friction | None = None,
        at_start: str | Stop = "error",
        at_end: str | Stop = "error",
        name: str | None = None,
    ) -> Slide:
        """Let the point ``at`` of ``body``, or ("link", s) of a cable, ride the cable ``along``, from ``s`` (m) on.

        frame: "point", "tangent" or "section", what the rider's orientation keeps to; roll: "free" or "held", against
        the direction up; drive (m) or velocity (m/s): signals; friction: a `Friction`; at_start, at_end: "error",
        "leave", a `HardStop` or a `Buffer`; see `Slide`. A body slightly off the cable is moved onto it, with a
        `FunicularWarning`. Raises SceneError.
        """
        return self.add(Slide(body=body, along=along, s=s, at=at, frame=frame, roll=roll, at_start=at_start,
                              at_end=at_end, **_given(up=up, drive=drive, velocity=velocity, friction=friction,
                                                      name=name)))

    def add(self, part: Part) -> Part:
        """Add a part made elsewhere, complete it with what the scene knows; the methods above end here.

        Returns the part as it stands in the scene. Raises SceneError.
        """
        if isinstance(part, Tie | Joint | Force | DistributedForce | Moment | Spring | Event) and part.name is None:
            part = part.model_copy(update={"name": self._free_name(part.kind)})
        if hasattr(part, "name"):
            self._claim(part)
        check_plane(self, part)
        match part:
            case Cable():
                self._add_cable(part)
            case RigidBody() | ModalBody():
                self.bodies[part.name] = part
            case Pin() | Clamp() | Motion():
                check_support(self, part)
                {"pin": self.pins, "clamp": self.clamps, "motion": self.motions}[part.kind].append(part)
            case Tie():
                check_tie(self, part)
                self.ties[part.name] = part
            case Joint():
                from .checks.joint_placement import placed_joint

                self.joints[part.name] = part = placed_joint(self, part)
            case Slide():
                from .checks.slide_placement import placed_slide

                self.slides[part.name] = part = placed_slide(self, part)
            case Event():
                from .solve.event_watcher import check_event

                check_event(self, part)
                self.events[part.name] = part
            case Spring():
                self.springs[part.name] = part = placed_spring(self, part)
            case _:
                self.loads[part.name] = part = placed_load(self, part)
        return part

    @property
    def dim(self) -> int:
        """2 if its cables are planar, else 3."""
        return min((cable.dim for cable in self.cables.values()), default=3)

    @property
    def libraries(self) -> tuple[str, ...]:
        """Directories of the libraries that its cables' elements are from."""
        return tuple(sorted({cable.library for cable in self.cables.values() if cable.library is not None}))

    @property
    def supports(self) -> list[Support]:
        """All that holds or moves nodes: pins, clamps and motions."""
        return [*self.pins, *self.clamps, *self.motions]

    def parts(self) -> Iterator[Part]:
        """All parts, in an order in which they can be added."""
        for group in (self.cables, self.supports, self.ties, self.bodies, self.joints, self.slides, self.loads,
                      self.springs, self.events):
            yield from group.values() if isinstance(group, dict) else group

    def check(self) -> None:
        """Check the scene as a whole, as `run` does first. Raises SceneError."""
        from .checks.joint_placement import check_joint
        from .checks.slide_placement import check_on_cable

        if not self.cables and not self.bodies:
            raise SceneError("scene", "is empty: there is nothing to simulate", "add a cable or a rigid body")
        check_plane(self)
        for joint in self.joints.values():
            check_joint(self, joint)
        for body in self.bodies.values():
            if isinstance(body, ModalBody) and (idle := body.shape.indefinite(self.dim)):
                raise SceneError(body.where, f"its mass matrix is not positive definite: {idle}",
                                 "leave such a mode out, or give masses off the line that the others are on")
        for slide in self.slides.values():
            check_on_cable(self, slide)

    def run(
        self,
        duration: float | None = None,
        *,
        tol: float | None = None,
        step: float | None = None,
        output_step: float | None = None,
        integrator: str | None = None,
        spectral_radius: float | None = None,
        initial: str | Equilibrium | None = None,
        threads: int | None = None,
        save: str | os.PathLike | None = None,
        resume: bool = False,
        progress: bool | Callable[[float], None] | None = None,
    ) -> Run:
        """Simulate the scene for ``duration`` (s); see `RunSettings` for the settings and their defaults.

        Settings not given here are the scene file's, if it gave them. initial: "drawn", "equilibrium" (found first),
        or a state that `equilibrium` returned. save: a netCDF file, written while the run goes on, with a checkpoint
        (the same name and ``.state``) that stays when the run is killed or interrupted; results are read from the file
        when they are asked for. resume: go on from there, to the same numbers. progress: a bar (True), none (False), a
        bar if a terminal watches (None), or a function of the time reached.

        While it goes on the BLAS of NumPy and SciPy has one thread, in the whole process: what other threads of it
        compute meanwhile with large matrices takes longer.

        Raises SceneError, ResultFileError, EquilibriumError; EndOfCableError and ConvergenceError, whose ``run`` holds
        everything up to then. Ctrl-C returns what was computed, with a `FunicularWarning`.
        """
        state = None if initial is None or isinstance(initial, str) else _equilibrium_state(self, initial)
        given = {
            "duration": duration,
            "tol": tol,
            "step": step,
            "output_step": output_step,
            "integrator": integrator,
            "spectral_radius": spectral_radius,
            "initial": initial if state is None else "equilibrium",
            "threads": threads,
            "save": save,
        }
        settings = RunSettings(**self.run_settings | {k: v for k, v in given.items() if v is not None})
        self.check()
        if settings.initial == "drawn":
            self._check_motions_start_at_zero()
            from .checks.joint_placement import check_drive

            for joint in self.joints.values():
                check_drive(self, joint)
        if not isinstance(resume, bool):
            raise SceneError("run", f"resume must be true or false, got {shown(resume)}")
        if resume and settings.save is None:
            raise ResultFileError("run: there is nothing to resume without a file of results; name it with save")
        from .results.streaming import Stream

        saving = nullcontext() if settings.save is None else Stream(settings.save, self, settings, resume)
        with saving as stream, one_blas_thread, _in_memory():
            if settings.initial == "equilibrium" and state is None:
                state = self.equilibrium()
            from .model.build import simulate

            with progress_bar(settings.duration, progress) as on_progress:
                recording = simulate(self, settings, on_progress, initial=state, stream=stream)
            run = stream.finish(recording) if stream else Run.from_recording(recording, self, settings)
        match recording.status:
            case "end_of_cable":
                raise EndOfCableError(recording.message, run)
            case "no_convergence":
                raise ConvergenceError(recording.message, run)
            case "interrupted":
                warnings.warn(recording.message, FunicularWarning, stacklevel=2)
        return run

    def equilibrium(
        self,
        *,
        load_steps: int | None = None,
        tolerance: float | None = None,
        max_iterations: int | None = None,
        method: str | None = None,
        largest_step: float | None = None,
        seek_stable: bool | None = None,
        scale_gravity: bool | None = None,
        start: Equilibrium | None = None,
    ) -> Equilibrium:
        """Find the static equilibrium under all loads at t = 0; see `EquilibriumSettings` for the defaults.

        Settings not given here are the scene file's, if it gave them. The state is stable unless it says otherwise, in
        ``stable``, in ``messages`` and by a `FunicularWarning`; friction of slides is left out. start: a state of this
        scene, under the same loads or others, from which the search begins instead of as drawn; method "arc_length"
        goes on from its load_fraction in its sense, or, from a state under all its loads, anew from rest without loads.
        Raises SceneError; EquilibriumError, which keeps the state that was reached.
        """
        given = {"load_steps": load_steps, "tolerance": tolerance, "max_iterations": max_iterations, "method": method,
                 "largest_step": largest_step, "seek_stable": seek_stable, "scale_gravity": scale_gravity}
        begin = None if start is None else _equilibrium_state(self, start)
        settings = EquilibriumSettings(**self.equilibrium_settings | {k: v for k, v in given.items() if v is not None})
        self.check()

        from .solve.static import equilibrium

        with one_blas_thread, _in_memory():
            return equilibrium(self, settings, begin)

    def modes(self, n: int, about: Equilibrium | None = None) -> Modes:
        """The ``n`` lowest natural frequencies and shapes, about the scene as drawn or a state from `equilibrium`.

        As drawn, joints and slides bear nothing yet: what swings by its weight does so about its equilibrium alone.
        Damping and friction are left out; what rounding hides is told, as in `Modes`. Raises SceneError.
        """
        settings = ModeSettings(n=n)
        state = None if about is None else _equilibrium_state(self, about)
        self.check()

        from .solve.modes import modes

        with one_blas_thread, _in_memory():
            return modes(self, settings.n, state)

    def to_toml(self) -> str:
        """The scene as the text of a scene file."""
        from .scene_file import dumps

        return dumps(self)

    def _part_named(self, name: str, kind: str) -> Part | None:
        """The part whose name that is: results are addressed by name, so that all but events share one space of names.
        """
        groups = (self.cables, self.ties, self.bodies, self.joints, self.slides, self.loads, self.springs)
        return next((group[name] for group in ([self.events] if kind == "event" else groups) if name in group), None)

    def _claim(self, part: Part) -> None:
        if (other := self._part_named(part.name, part.kind)) is not None:
            article = "an" if part.kind == "event" else "a"
            raise SceneError(part.where, f"there is already {article} {other.kind} of that name",
                             "give each part its own name")
        if part.name in RESERVED:
            raise SceneError(part.where, "that name is taken by the results", "give another one")

    def _free_name(self, kind: str) -> str:
        """A name with a number that no part has: the least one where those below it are taken one after the other.

        Found by doubling and bisection, so that a thousand unnamed parts do not cost a million look-ups.
        """
        taken, free = 0, 1
        while self._part_named(f"{kind}_{free}", kind) is not None:
            taken, free = free, 2 * free
        while free - taken > 1:
            middle = (taken + free) // 2
            if self._part_named(f"{kind}_{middle}", kind) is None:
                free = middle
            else:
                taken = middle
        return f"{kind}_{free}"

    def _add_cable(self, cable: Cable) -> None:
        for other in self.cables.values():
            if other.dim != cable.dim:
                word = {2: "planar", 3: "spatial"}
                raise SceneError(
                    cable.where, f'{cable.element} is {word[cable.dim]}, but the elements of cable "{other.name}" '
                    f"({other.element}) are {word[other.dim]}", "take planar elements for all cables, or for none")
        self.cables[cable.name] = cable
        try:
            check_plane(self)
        except SceneError:
            del self.cables[cable.name]
            raise

    def _check_motions_start_at_zero(self) -> None:
        """A run that starts as drawn must not begin with a jump."""
        for motion in self.motions:
            length = self.cables[motion.cable].length
            starts = [(f"displacement {axis}", signal, length, "m")
                      for axis, signal in zip("xyz", motion.displacement or (), strict=False)
                      if signal is not None]
            starts += [("rotation", motion.rotation.angle, 1.0, "rad")] if motion.rotation else []
            for name, signal, size, unit in starts:
                if abs(value := float(signal.value(0.0))) > EXACT * size:
                    raise SceneError(motion.where, f"{name} is {show(value, unit)} at t = 0, but counts from the place "
                                     "drawn", 'let it start from 0, or start with initial="equilibrium"')


def _given(**values) -> dict:
    return {keyword: value for keyword, value in values.items() if value is not None}


def _named(name: str | None) -> dict:
    return _given(name=name)


def _equilibrium_state(scene: Scene, state: Equilibrium) -> Equilibrium:
    from .solve.static import Equilibrium

    if not isinstance(state, Equilibrium):
        raise SceneError("scene", "the state to start from must be one that equilibrium() returned, got "
                         + shown(state))
    state.check_fits(scene)
    return state
