"""The scene: what the user describes, and how it is run."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable

import numpy as np
from funicular.errors import ConvergenceError, EndOfCableError, FunicularWarning, SceneError, near
from funicular.materials import Material
from funicular.parts import EXACT, Cable, Pin, RigidBody, Slide
from funicular.progress import progress_bar
from funicular.results import Run, check_writable
from funicular.sections import Section
from funicular.settings import RunSettings
from funicular.validation import show, vector

MOVABLE = 1e-3
"""A rider nearer to its cable than this part of the cable's length is moved onto it at the start."""

RESERVED = ("energy", "time")


class Scene:
    """Cables, bodies, and what joins them.

    ``gravity`` in m/s²; ``cables``, ``bodies`` and ``slides`` are dicts by name, ``pins`` is a list; ``messages``
    tells what was adjusted; ``run_settings`` holds the settings that a scene file gives.
    """

    def __init__(self, gravity=(0, -9.81, 0)):
        """An empty scene; gravity: 3 numbers in m/s². Raises SceneError."""
        try:
            self.gravity = vector(gravity, "m/s²")
        except ValueError as error:
            raise SceneError("scene", f"gravity {error}") from None
        self.cables: dict[str, Cable] = {}
        self.bodies: dict[str, RigidBody] = {}
        self.slides: dict[str, Slide] = {}
        self.pins: list[Pin] = []
        self.messages: list[str] = []
        self.run_settings: dict = {}

    def cable(
        self,
        name: str,
        *,
        start,
        end,
        elements: int,
        section: Section,
        material: Material,
        element: str = "beam24",
        library: str | os.PathLike | None = None,
        strain: str | None = None,
        curvature: str | None = None,
        up=(0, 1, 0),
    ) -> Cable:
        """Add a straight cable of equal elements; see `Cable`. Raises SceneError."""
        return self.add(
            Cable(
                name=name,
                start=start,
                end=end,
                elements=elements,
                element=element,
                library=library,
                strain=strain,
                curvature=curvature,
                section=section,
                material=material,
                up=up,
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
                angular_velocity=angular_velocity,
            )
        )

    def pin(self, cable: Cable | str, *, s: float) -> Pin:
        """Hold the node of ``cable`` at arc-length ``s`` (m) in its place. Raises SceneError."""
        return self.add(Pin(cable=cable, s=s))

    def slide(
        self, body: RigidBody | str, *, along: Cable | str, s: float, at=(0, 0, 0), name: str | None = None
    ) -> Slide:
        """Let the point ``at`` of ``body`` ride the cable ``along``, from ``s`` on; see `Slide`.

        A body slightly off the cable is moved onto it, with a `FunicularWarning`. Raises SceneError.
        """
        named = {} if name is None else {"name": name}
        return self.add(Slide(body=body, along=along, s=s, at=at, **named))

    def add(self, part: Cable | RigidBody | Pin | Slide) -> Cable | RigidBody | Pin | Slide:
        """Add a part made elsewhere; the methods above end here. Raises SceneError."""
        match part:
            case Cable():
                self._claim(part)
                self.cables[part.name] = part
            case RigidBody():
                self._claim(part)
                self.bodies[part.name] = part
            case Pin():
                self._check_pin(part)
                self.pins.append(part)
            case Slide():
                self._claim(part)
                cable = self._check_slide(part)
                part = part.model_copy(update={"s": min(max(part.s, 0.0), cable.length)})
                self._seat(part)
                self.slides[part.name] = part
        return part

    def check(self) -> None:
        """Check the scene as a whole, as `run` does first. Raises SceneError."""
        if not self.cables and not self.bodies:
            raise SceneError("scene", "is empty: there is nothing to simulate", "add a cable or a rigid body")
        for slide in self.slides.values():
            gap, where = self._gap(slide)
            if gap > EXACT * self.cables[slide.along].length:
                raise SceneError(
                    slide.where, where, f'body "{slide.body}" rides more than one cable: it cannot be moved for each'
                )

    def run(
        self,
        duration: float | None = None,
        *,
        tol: float | None = None,
        step: float | None = None,
        output_step: float | None = None,
        integrator: str | None = None,
        spectral_radius: float | None = None,
        save: str | os.PathLike | None = None,
        progress: bool | Callable[[float], None] | None = None,
    ) -> Run:
        """Simulate the scene for ``duration`` (s); see `RunSettings` for the settings and their defaults.

        Settings not given here are the scene file's, if it gave them. save: a netCDF file, tried before the
        run and written also when that stops early. progress: a bar (True), none (False), a bar if a terminal
        watches (None), or a function of the time reached.

        Raises SceneError, ResultFileError; EndOfCableError and ConvergenceError, whose ``run`` holds
        everything up to then. Ctrl-C returns what was computed, with a `FunicularWarning`.
        """
        given = {
            "duration": duration,
            "tol": tol,
            "step": step,
            "output_step": output_step,
            "integrator": integrator,
            "spectral_radius": spectral_radius,
            "save": None if save is None else os.fspath(save),
        }
        settings = RunSettings(**self.run_settings | {k: v for k, v in given.items() if v is not None})
        self.check()
        if settings.save is not None:
            check_writable(settings.save)

        from funicular.model import simulate

        with progress_bar(settings.duration, progress) as on_progress:
            recording = simulate(self, settings, on_progress)
        run = Run.from_recording(recording, self, settings)
        if settings.save is not None:
            run.save(settings.save)
        match recording.status:
            case "end_of_cable":
                raise EndOfCableError(recording.message, run)
            case "no_convergence":
                raise ConvergenceError(recording.message, run)
            case "interrupted":
                warnings.warn(recording.message, FunicularWarning, stacklevel=2)
        return run

    def to_toml(self) -> str:
        """The scene as the text of a scene file."""
        from funicular.scene_file import dumps

        return dumps(self)

    def _claim(self, part: Cable | RigidBody | Slide) -> None:
        """Results are addressed by name, so that all named parts share one space of names."""
        for kind, named in (("cable", self.cables), ("rigid_body", self.bodies), ("slide", self.slides)):
            if part.name in named:
                raise SceneError(part.where, f"there is already a {kind} of that name", "give each part its own name")
        if part.name in RESERVED:
            raise SceneError(part.where, "that name is taken by the results", "give another one")

    def _cable(self, name: str, place: str, s: float) -> Cable:
        """The cable ``name``, on which ``s`` must lie."""
        if name not in self.cables:
            raise SceneError(place, f'there is no cable "{name}"', near(name, self.cables))
        cable = self.cables[name]
        if not -EXACT * cable.length <= s <= (1 + EXACT) * cable.length:
            raise SceneError(place, f"s must lie on the cable, in [0, {cable.length:.9g}] m, got {s:.9g} m")
        return cable

    def _check_pin(self, pin: Pin) -> None:
        cable = self._cable(pin.cable, pin.where, pin.s)
        node = cable.node_at(pin.s)
        if node is None:
            nodes = cable.node_s
            if len(nodes) > 12:  # a long list helps less than the two neighbours
                right = int(np.searchsorted(nodes, pin.s))
                nodes = nodes[right - 1 : right + 1]
            raise SceneError(
                pin.where,
                f"s must be a node of the cable, got {show(pin.s, 'm')}",
                f"nodes {'near it ' if len(cable.node_s) > 12 else ''}are at "
                + ", ".join(f"{s:.9g}" for s in nodes)
                + " m",
            )
        if any(other.cable == pin.cable and cable.node_at(other.s) == node for other in self.pins):
            raise SceneError(pin.where, f"the node at s = {show(pin.s, 'm')} is already pinned")

    def _check_slide(self, slide: Slide) -> Cable:
        if slide.body not in self.bodies:
            raise SceneError(slide.where, f'there is no rigid_body "{slide.body}"', near(slide.body, self.bodies))
        for other in self.slides.values():
            if (other.body, other.along, other.at) == (slide.body, slide.along, slide.at):
                raise SceneError(slide.where, f'holds the same point of body "{slide.body}" on cable "{slide.along}" '
                                 f'as slide "{other.name}"', "leave one of them out, or give them different points at")
        return self._cable(slide.along, slide.where, slide.s)

    def _gap(self, slide: Slide) -> tuple[float, str]:
        """The distance in m from the rider's point to its place on the cable, and a sentence on it."""
        point = self.bodies[slide.body].point(slide.at)
        gap = float(np.linalg.norm(point - self.cables[slide.along].point(slide.s)))
        return gap, (
            f'the point of body "{slide.body}" at {show(point, "m")} is {gap:.6g} m '
            f'away from cable "{slide.along}" at s = {slide.s:.9g} m'
        )

    def _seat(self, slide: Slide) -> None:
        """Bring the rider's point onto the cable by a small move, refuse a large one."""
        cable, body = self.cables[slide.along], self.bodies[slide.body]
        gap, where = self._gap(slide)
        if gap <= EXACT * cable.length:
            return
        start = body.point(slide.at)
        position = body.position + cable.point(slide.s) - start
        if gap > MOVABLE * cable.length:
            remedy = (
                f"start the body at position {show(position, 'm')}, or slide from s = {cable.nearest_s(start):.6g} m"
            )
            raise SceneError(slide.where, where, remedy)
        self.bodies[body.name] = body.model_copy(update={"position": tuple(position.tolist())})
        message = f'{slide.where}: body "{body.name}" was moved by {gap:.6g} m onto cable "{cable.name}"'
        self.messages.append(message)
        warnings.warn(message, FunicularWarning, stacklevel=4)
