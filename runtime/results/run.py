"""Results of a run: labelled arrays with units, energy balance, forces in sections.

SciPy, Matplotlib, xarray and the file format are imported by the methods that need them, not by `import funicular`.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from ..base.named_arrays import NamedArrays
from ..base.written_files import write_whole
from ..errors import (
    ConvergenceError,
    EndOfCableError,
    FunicularWarning,
    RopeLeftError,
    UnknownResultError,
    near,
)
from ..parts.cable import Cable
from ..parts.in_plane import in_plane
from ..parts.rope import Rope
from ..parts.scene_data import OfDrawing, SceneData
from ..parts.scene_text import dumps
from ..parts.settings import RunSettings
from ..parts.slide import Slide
from .quantities import ENERGIES, ComputedWhenRead, EnergyBalance, Variable
from .viewable import Viewable

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike  # 9 ms, for type checkers alone

    from ..model.initial_state import InitialState
    from ..model.model import Model
    from ..view.animation import Animation
    from .recording import Recording

TIME_TOLERANCE = 1e-9
"""Difference of equal times, over the last time of a run."""
BESIDE_THE_MIDDLE = ("returned beside the middle of the groove", "moved along the groove")
"""Events after which a rope without mass lies beside the middle of a groove (engine/events/taut_rope.c)."""
WRITE_BLOCK_BYTES = 1 << 22
NODAL_VECTORS, POSITION = ".nodal_vectors", ".position"
"""Ends of the names of a cable's nodal vectors, and of their positions."""
MAX_COSTS = 6
"""Slides and joints that a summary names with their times."""
COUNTS = {"steps": "taken", "rejected_steps": "rejected", "newton_iterations": "Newton iterations",
          "factorisations": "factorisations"}
"""Counts of a report in a summary."""


class ReadScene(Protocol):
    """Makes a scene from the text of its file; an argument, since scenes stand above results."""

    def __call__(self, text: str, origin: str, *, libraries: Iterable[str | os.PathLike[str]] = ()) -> SceneData:
        """Return the scene; origin: the name of the text in error messages. Raises SceneError."""


class SceneText:
    """A scene as text, written at its first use, with its reader and directories of elements that it may load."""

    def __init__(self, scene: SceneData | str, read: ReadScene, libraries: Iterable[str | os.PathLike[str]] = ()):
        """scene: its text, or the scene itself, which must not change any more."""
        self._scene, self.read, self.libraries = scene, read, libraries

    @property
    def toml(self) -> str:
        """Return the text of a scene file."""
        if not isinstance(self._scene, str):
            self._scene = dumps(self._scene)
        return self._scene

    def __getstate__(self) -> dict[str, Any]:
        """Return the state for pickling: the text, since a scene may hold functions."""
        return vars(self) | {"_scene": self.toml}


class Run(Viewable, NamedArrays):
    """Results by name: ``run["A.position"]`` is a NumPy array (time, 3); `keys` lists the names.

    A run is a mapping of all results. variables: each with its unit, dimensions and meaning. report: steps,
    evaluations, error estimates, kernels, ``messages``, ``events``, ``integrator`` and ``integrator_reason``,
    ``choice`` and ``errors`` on request, and ``time_s``, the wall time by part:

    | part | work |
    |---|---|
    | set_up | model, engine, redundant constraints, choice of the integrator |
    | start | consistent start, first row |
    | residual, factorisation, solve | equations of motion, matrices, substitution |
    | step | rest of the steps: prediction, positions of slides, projection on joints |
    | error | estimates of the error |
    | output | rows of output |
    | results | notes, labelled arrays |
    | total | all of these, and the search for events |
    | solve_cpu | CPU time of the start and of all steps |
    """

    def __init__(self, variables: Mapping[str, Variable], coords: dict[str, Variable], report: dict[str, Any],
                 scene_text: SceneText):
        """report: with status, message and messages; scene_text: the scene of the run.

        report["us_per_step"]: time per step of each slide and joint in µs, without solving for its forces.
        """
        self.variables, self.coords, self.report, self._scene_text = variables, coords, report, scene_text

    @classmethod
    def from_recording(cls, recording: Recording, scene: SceneData, settings: RunSettings,
                       read_scene: ReadScene) -> Run:
        """Return the run of a recording; read_scene: makes the scene from its text."""
        kept = scene.copied()
        if recording.scene is scene:  # to which parts may be added before its results are read
            recording = replace(recording, scene=kept)
        report = {
            **recording.report,
            "status": recording.status,
            "message": recording.message,
            "messages": [*(message for message in scene.messages
                           if settings.initial == "drawn" or not isinstance(message, OfDrawing)),
                         *recording.report.get("messages", [])],
            "settings": settings.field_values(),
        }
        return cls(ComputedWhenRead(recording.variables), recording.coords, report,
                   SceneText(kept, read_scene, scene.libraries))

    @property
    def time(self) -> np.ndarray:
        """Return the times (time,) of the results in s."""
        return self.coords["time"].values

    @property
    def status(self) -> str:
        """Return ``completed``, ``event`` (stopped by one), ``interrupted``, ``end_of_cable``, ``rope_left`` or
        ``no_convergence``.

        ``unfinished`` of an active or killed run.
        """
        return str(self.report["status"])

    @property
    def events(self) -> list[dict[str, Any]]:
        """Return the events. Of the scene's events: name, time (s), and the state of bodies and slides.

        Of slides: name, time (s), s (m), and what: "stuck", "broke loose", "turned round" (friction); "struck the end",
        "came to rest at the end", "left the end" (hard stops); "entered the buffer", "left the buffer"; "left".
        """
        events: list[dict[str, Any]] = self.report["events"]
        return events

    @property
    def scene_toml(self) -> str:
        """Return the scene of the run as the text of a scene file."""
        return self._scene_text.toml

    @property
    def libraries(self) -> Iterable[str | os.PathLike[str]]:
        """Return the directories of elements that the scene may load."""
        return self._scene_text.libraries

    @cached_property
    def scene(self) -> SceneData:
        """Return the `funicular.Scene` of the run, read from its text; the report lists its adjustments.

        Raises SceneError for a library that is not allowed.
        """
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FunicularWarning)
            return self._scene_text.read(self.scene_toml, "the scene of the run", libraries=self.libraries)

    def keys(self) -> list[str]:
        """Return the names of all results; ``wire.position`` of a cable is a part of ``wire.nodal_vectors``."""
        return list(self.variables)

    def __len__(self) -> int:
        """Return the number of results; the number of times is ``len(run.time)``."""
        return len(self.variables)

    def __bool__(self) -> bool:
        """Return True, also for a run without output times."""
        return True

    def __contains__(self, name: object) -> bool:
        """Return whether there is a result of this name."""
        return name == "time" or (isinstance(name, str) and (self._nodal(name) or name) in self.variables)

    def _ipython_key_completions_(self) -> list[str]:
        """Return the completions after ``run["``."""
        return ["time", *self.variables, *self._positions]

    def __getitem__(self, name: str) -> np.ndarray:
        """Return the array of a name, time first; ``variables[name]`` has its unit and dimensions."""
        if name == "time":
            return self.time
        if (nodal := self._nodal(name)) is not None:
            return self.variables[nodal].values[:, :, 0]
        if name not in self.variables:
            known = [*self.variables, *self._positions]
            raise UnknownResultError(f'the run has no result "{name}"; {near(name, known)}')
        return self.variables[name].values

    def _nodal(self, name: str) -> str | None:
        """Return the name of the nodal vectors of which a result is the positions, None of other results."""
        nodal = name.removesuffix(POSITION) + NODAL_VECTORS
        return nodal if name.endswith(POSITION) and nodal in self.variables else None

    @property
    def _positions(self) -> list[str]:
        """Return the names of the positions of nodes, (time, node, 3) in m, which are parts of their nodal vectors."""
        return [name.removesuffix(NODAL_VECTORS) + POSITION for name in self.variables if name.endswith(NODAL_VECTORS)]

    def at(self, time: float) -> InitialState:
        """Return the state at an output time (s), for ``scene.run(initial=...)`` of this scene or a similar one.

        Raises UnknownResultError if no row has this time: states are not interpolated.

        >>> import funicular as fu
        >>> scene = fu.load_scene("paper51")
        >>> run = scene.run(duration=0.02, output_step=0.01, tol=1e-3)
        >>> run.at(0.01)["A.position"].shape
        (3,)
        >>> later = scene.run(duration=0.01, tol=1e-3, initial=run.at(0.01))
        >>> bool(later["A.position"][0, 0] == run["A.position"][1, 0])
        True
        """
        from ..model.initial_state import InitialState, names_of

        row = int(np.argmin(np.abs(self.time - time))) if len(self.time) else -1
        if row < 0 or abs(self.time[row] - time) > TIME_TOLERANCE * self.time[-1]:
            there = f"the nearest is {self.time[row]:.9g} s" if row >= 0 else "there is none"
            raise UnknownResultError(f"the run has no row at t = {time:.9g} s; {there}")
        sticking = [part.given_name or "" for part in self.scene.parts() if getattr(part, "has_friction_spring", False)]
        springs = [name for name in sticking if np.any(self[f"{name}.friction_force"][row])]
        springs += [name for name, branch in self.scene.branches.items() if np.any(self[branch.stress][row])]
        slips = {event["name"] for event in self.report["events"]
                 if event.get("what") == "slips" and event["time"] <= self.time[row]}
        holding = [sheave.name for part in self.scene.parts() for sheave in getattr(part, "holding_sheaves", ())]
        aside: set[str] = set()
        for event in self.report["events"]:
            if event["time"] <= self.time[row] and event.get("what") in (*BESIDE_THE_MIDDLE, "left the sheave"):
                (aside.add if event["what"] in BESIDE_THE_MIDDLE else aside.discard)(event["name"])
        return InitialState({name: self[name][row] for name in names_of(self.scene)}, float(self.time[row]), springs,
                            [name for name in holding if name in slips], sorted(aside))

    def __repr__(self) -> str:
        """Return the status, times and number of results."""
        times = f"{len(self.time)} times to {self.time[-1]:.6g} s" if len(self.time) else "no times"
        return f"<funicular.Run: {self.status}, {times}, {len(self.keys())} results>"

    @property
    def dataset(self) -> xarray.Dataset:
        """Return all results as an xarray.Dataset with units and long names; attributes: the report and the scene."""
        import xarray

        from .files import WITH_CHECKSUMS, file_text

        def arrays(variables: Mapping[str, Variable]) -> dict[str, Any]:
            return {
                name: (v.dims, v.values, {"units": v.units, "long_name": v.long_name}) for name, v in variables.items()
            }

        attributes = {"funicular_format": WITH_CHECKSUMS - 1, "scene": self.scene_toml,
                      "report": file_text(self.report)}
        return xarray.Dataset(arrays(self.variables), arrays(self.coords), attributes)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a netCDF file that xarray opens; an older file stays until the new one is complete.

        Raises ResultFileError.
        """
        from .files import check_free, check_writable, create_file, file_text, over_time
        from .netcdf import Stored

        path = check_writable(path)
        check_free(path)
        report = file_text(self.report, len(self.time))

        def write(part: Path) -> None:
            if isinstance(self.variables, Stored):
                described = self.variables.file.described(over_time=True)
                fixed = {name: v for name, v in self.coords.items() if name != "time"}
                create_file(part, fixed, described, self.scene_toml, report).copy_rows(self.variables.file)
                return
            file = create_file(part, self.coords, self.variables, self.scene_toml, report)
            rows = over_time(self.coords, self.variables)
            block = max(1, WRITE_BLOCK_BYTES // file.row_bytes)
            for first in range(0, len(self.time), block):
                file.write(first, {name: values[first : first + block] for name, values in rows.items()})

        write_whole(path, write, "the results")

    def energy_balance(self) -> EnergyBalance:
        """Return the residual of the energy balance; see `EnergyBalance`."""
        energies = {name: self[f"energy.{name}"] for name in ENERGIES if f"energy.{name}" in self}
        changes = np.array([(e - e[:1]) * (-1 if name == "external" else 1) for name, e in energies.items()])
        residual = changes.sum(axis=0)
        exchanged = float(np.abs(changes).sum(axis=0).max(initial=0.0) / 2)
        return EnergyBalance(residual, exchanged, residual / (exchanged or 1.0))

    @cached_property
    def model(self) -> Model:
        """Return the model of the scene as drawn: its coordinates, supports and couplings.

        A planar scene has a model in the axes of its plane.
        """
        from ..model.build import build

        return build(in_plane(self.scene))

    def slack_elements(self, cable: Cable | str) -> xarray.DataArray:
        """Return which elements of ``cable`` are slack, (time, element): shorter in the middle than at rest.

        With ``membrane="tension_only"`` they have almost no axial stiffness. The events of the report give the times,
        also between rows, at which the first element became slack and at which all were taut again.
        """
        from .slack import slack_elements

        return slack_elements(self, cable)

    def section_forces(self, cable: Cable | Rope | str, s: ArrayLike | Slide | None = None, *, method: str = "balance",
                       side: str = "after") -> xarray.Dataset:
        """Return the forces and moments in sections of ``cable``.

        s: arc-lengths (n,) in m; or the name of a slide, for its section at each time. By default along the whole
        cable, on both sides of supports, ties and loads.
        method: "balance", in balance with nodal forces, loads, inertia and riders; "constitutive", by the elastic law
        from the strains of the mesh, without Kelvin-Voigt damping. Both converge to the same values, the second one
        slowly: beside a point force, and wherever a cable turns within an element, it oscillates about the first by a
        tenth and more, which a `FunicularWarning` reports. Both contain vibrations of the mesh.
        side: "after" or "before", at a force or moment on a point the side of larger or smaller s. At the ends of the
        cable it is always the inner side.

        Returns a Dataset over (time, s): force and moment on the part before the cut along the ground's axes (xyz), in
        N and N m; tension, shear and strain; curvature of cables; components along the section's axes of beams. Strains
        are those of the mesh. A taut cable bends beside a point force within sqrt(E I / N) only. For longer elements,
        tension is the size of the force, shear excludes this length, and moment is that of an elastica along the line
        of the force, not of the mesh. Raises UnknownResultError; FunicularError for s off the cable.

        Of a rope: of its spans, over (time, point) with s of each point, and the number of its span; at given s, or at
        a slide on it, not a number while that part of the rope is on a sheave or a drum. In motion by the elastic law
        alone; "balance" at rest.
        """
        from .section_forces.ropes import section_forces

        return section_forces(self, cable, s, method=method, side=side)

    def animation(self, title: str | None = None) -> Animation:
        """Return the animation of the motion; see `Viewable.animation`. Raises FunicularError without results."""
        from .animation.clips import of_run

        file = getattr(self.variables, "file", None)
        return of_run(self, title or ("run" if file is None else Path(file.path).stem))

    def sketch(self) -> Animation:
        """Return the motion without quantities and curves; see `Viewable.sketch`. Raises FunicularError."""
        from .animation.clips import of_run

        return of_run(self, "run", with_results=False)

    def plot(self, what: str = "shape") -> Figure:
        """Return a Matplotlib figure: "shape", "acceleration", "slide", "rope", "energy", or "forces-wire" of the cable
        "wire".

        A notebook shows it, `matplotlib.pyplot.show` in a script. Raises FunicularError.
        """
        from ..view.files import new_figure
        from .pictures import plot

        return plot(self, what, new_figure())

    def save_plots(self, directory: str | os.PathLike[str], prefix: str = "", forces: bool = False) -> list[Path]:
        """Write the pictures of `funicular run --plot` as PNG files with this prefix, and return their paths.

        forces: also tension and moment along each cable. Raises ResultFileError.
        """
        from .pictures import save_plots

        return save_plots(self, directory, prefix, forces)

    def overview(self) -> list[tuple[str, str]]:
        """Return the summary for a notebook; see `Viewable.overview`."""
        return self.summary_rows()

    def summary_rows(self) -> list[tuple[str, str]]:
        """Return the summary of the run as pairs of a heading and a text."""
        report = self.report
        if not len(self.time):
            return [("status", f"{self.status} before the first output time: there are no results"),
                    *(("note", message) for message in report["messages"])]
        balance = self.energy_balance()
        rows = [("status", f"{self.status} at t = {self.time[-1]:.6g} s, {len(self.time)} times")]
        counts = [f"{report[key]} {text}" for key, text in COUNTS.items() if key in report]
        if counts:
            rows.append(("steps", ", ".join(counts)))
        if "time_s" in report:
            parts = dict(report["time_s"])
            total = parts.pop("total")
            rows.append(("wall time", f"{total:.3g} s: " + ", ".join(f"{p} {s:.2g}" for p, s in parts.items())))
            if total > 0:
                rows.append(("real-time factor", f"{self.time[-1] / total:.3g} s of motion in 1 s of wall time"))
        if costs := report.get("us_per_step"):
            rows.append(("slides and joints", _largest_costs(costs)))
        rows += [(f"modes of {name}", text) for name, text in report.get("modes", {}).items()]
        rows.append(("energy balance", f"off by {np.abs(balance.residual).max():.2g} J at most, "
                     f"{np.abs(balance.relative).max():.2g} of the energy exchanged"))
        if errors := report.get("errors"):
            rows.append(("estimated error", f"{_relative(errors['both'])} of the largest motion: "
                         f"{_relative(errors['time'])} of the steps, {_relative(errors['mesh'])} of the mesh"))
        residuals = [np.max(self[key]) for key in self.keys() if key.endswith(".residual")]
        if residuals:
            rows.append(("joint residual", f"{max(residuals):.2g} m at most"))
        return rows + [("note", message) for message in report["messages"]]

    def summary(self) -> str:
        """Return a few lines on how the run went."""
        return "\n".join(f"{heading}: {text}" for heading, text in self.summary_rows())


def _largest_costs(costs: dict[str, float]) -> str:
    """Return the time per step of slides and joints, the largest ones by name."""
    order = sorted(costs, key=costs.__getitem__, reverse=True)
    named = ", ".join(f"{name} {costs[name]:.3g}" for name in order[:MAX_COSTS])
    rest = f" and {len(order) - MAX_COSTS} more" if len(order) > MAX_COSTS else ""
    return f"{sum(costs.values()):.3g} µs of a step: {named}{rest}"


def _relative(error: float) -> str:
    return "unknown" if np.isnan(error) else f"{error:.1e}"


def raise_where_stopped(run: Run) -> None:
    """Raise EndOfCableError, RopeLeftError or ConvergenceError by the status of a run."""
    if run.status == "end_of_cable":
        raise EndOfCableError(run.report["message"], run)
    if run.status == "rope_left":
        raise RopeLeftError(run.report["message"], run)
    if run.status == "no_convergence":
        raise ConvergenceError(run.report["message"], run)
