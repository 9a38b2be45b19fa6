"""Results of a run: labelled arrays with units, energy balance, forces in sections."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from ..base.named_arrays import NamedArrays
from ..base.written_files import write_whole
from ..errors import FunicularWarning, UnknownResultError, near
from ..parts.cable import Cable
from ..parts.laid import laid
from ..parts.scene_data import OfDrawing, SceneData
from ..parts.scene_text import dumps
from ..parts.settings import RunSettings
from ..parts.slide import Slide
from .quantities import ENERGIES, Variable, labelled
from .viewable import Viewable

if TYPE_CHECKING:
    # These bring SciPy or xarray along: `import funicular` does without.
    import xarray
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike  # 9 ms, and for type checkers alone

    from ..model.initial_state import InitialState
    from ..model.model import Model
    from ..view.animation import Animation
    from .recording import Recording

SAME_TIME = 1e-9
"""Times that differ by this part of the run's last one are taken as equal."""

_BLOCK = 1 << 22
"""Bytes that are written at once."""


class ReadScene(Protocol):
    """Makes a scene of the text of its file; results are handed one, since scenes stand above them."""

    def __call__(self, text: str, origin: str, *, libraries: Iterable[str | os.PathLike] = ()) -> SceneData:
        """Return the scene; origin: what error messages call the text. Raises SceneError."""


class SceneText:
    """A scene as text, what reads it, and directories of elements that it may load then.

    Most runs are never asked for the text: of a scene it is written when it is read first.
    """

    def __init__(self, scene: SceneData | str, read: ReadScene, libraries: Iterable[str | os.PathLike] = ()):
        """scene: its text, or the scene itself, which must not change any more."""
        self._scene, self.read, self.libraries = scene, read, libraries

    @property
    def toml(self) -> str:
        """Return the text of a scene file."""
        if not isinstance(self._scene, str):
            self._scene = dumps(self._scene)
        return self._scene

    def __getstate__(self) -> dict:
        """Return what is pickled: the text, since a scene may have functions."""
        return vars(self) | {"_scene": self.toml}


class EnergyBalance(NamedTuple):
    """residual (time,): kinetic + elastic + potential + dissipated - external, minus the same at the start, in J.

    exchanged: the most energy that had changed its kind at any time, half the sum of these changes, in J;
    relative (time,): residual / exchanged, the residual itself if nothing was exchanged.
    """

    residual: np.ndarray
    exchanged: float
    relative: np.ndarray


class Run(Viewable, NamedArrays):
    """Results by name: ``run["A.position"]`` is a NumPy array (time, 3); `keys` lists the names.

    A run is a mapping: `keys`, `items` and a loop go through all results. variables: each with its unit, dimensions and
    meaning. report: steps, evaluations, error estimates, kernels, ``messages``, ``events``, ``integrator`` and
    ``integrator_reason``, ``choice`` and ``errors`` where they were asked for, and ``time_s``, the wall time by part:

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

    def __init__(self, variables: Mapping[str, Variable], coords: dict[str, Variable], report: dict,
                 scene_text: SceneText):
        """report: how the run went, status, message and messages among it; scene_text: the scene that was run.

        report["us_per_step"] is what each slide and joint takes of a step in µs, without solving for its forces.
        """
        self.variables, self.coords, self.report, self._scene_text = variables, coords, report, scene_text

    @classmethod
    def from_recording(cls, recording: Recording, scene: SceneData, settings: RunSettings,
                       read_scene: ReadScene) -> Run:
        """Label what was recorded of a run; read_scene: makes the scene of its text again."""
        variables, coords = labelled(recording)
        report = {
            **recording.report,
            "status": recording.status,
            "message": recording.message,
            "messages": [*(message for message in scene.messages
                           if settings.initial == "drawn" or not isinstance(message, OfDrawing)),
                         *recording.report.get("messages", [])],
            "settings": settings.field_values(),
        }
        return cls(variables, coords, report, SceneText(scene.copied(), read_scene, scene.libraries))

    @property
    def time(self) -> np.ndarray:
        """Return (time,): the times of the results, in s."""
        return self.coords["time"].values

    @property
    def status(self) -> str:
        """Return ``completed``, ``event`` (stopped by one), ``interrupted``, ``end_of_cable`` or ``no_convergence``.

        ``unfinished`` of a run that goes on, or was killed.
        """
        return self.report["status"]

    @property
    def events(self) -> list[dict]:
        """Return what has happened. Of the scene's events: name, time (s), and the state of bodies and slides there.

        Of slides: name, time (s), s (m), and what: "stuck", "broke loose", "turned round" (friction); "struck the end",
        "came to rest at the end", "left the end" (hard stops); "entered the buffer", "left the buffer"; "left".
        """
        return self.report["events"]

    @property
    def scene_toml(self) -> str:
        """Return the scene that was run, as the text of a scene file."""
        return self._scene_text.toml

    @property
    def libraries(self) -> Iterable[str | os.PathLike]:
        """Return the directories of elements that the scene may load when it is read back from its text."""
        return self._scene_text.libraries

    @cached_property
    def scene(self) -> SceneData:
        """Return the `funicular.Scene` that was run, read back from its text; what was adjusted then is in the report.

        Raises SceneError for a library that is not allowed.
        """
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FunicularWarning)
            return self._scene_text.read(self.scene_toml, "the scene of the run", libraries=self.libraries)

    def keys(self) -> list[str]:
        """Return the names of all results; a cable's ``wire.position`` is a part of its ``wire.nodal_vectors``."""
        return list(self.variables)

    def __len__(self) -> int:
        """Return the number of results; the number of times is ``len(run.time)``."""
        return len(self.variables)

    def __bool__(self) -> bool:
        """Return True: a run that ended before its first output time is one, too."""
        return True

    def __contains__(self, name: object) -> bool:
        """Return whether there is a result of that name."""
        return name in self.variables or name in self._positions or name == "time"

    def _ipython_key_completions_(self) -> list[str]:
        """Return what IPython offers after ``run["``."""
        return ["time", *self.variables, *self._positions]

    def __getitem__(self, name: str) -> np.ndarray:
        """Return the array called ``name``, time first; units and dimensions stand in ``variables[name]``."""
        if name == "time":
            return self.time
        if name in self._positions:
            return self.variables[self._positions[name]].values[:, :, 0]
        if name not in self.variables:
            known = [*self.variables, *self._positions]
            raise UnknownResultError(f'the run has no result "{name}"; {near(name, known)}')
        return self.variables[name].values

    @cached_property
    def _positions(self) -> dict[str, str]:
        """Return cables' positions of nodes, (time, node, 3) in m, by name; each is the first of these nodal vectors.
        """
        suffix = ".nodal_vectors"
        return {name.removesuffix(suffix) + ".position": name for name in self.variables if name.endswith(suffix)}

    def at(self, time: float) -> InitialState:
        """Return the state at an output time (s), for ``scene.run(initial=...)`` of this scene or one like it.

        Raises UnknownResultError where no row has that time: states are not interpolated.

        >>> import funicular as fu
        >>> scene = fu.load_scene("paper51")
        >>> run = scene.run(duration=0.02, output_step=0.01, tol=1e-3)
        >>> run.at(0.01)["A.position"].shape
        (3,)
        >>> later = scene.run(duration=0.01, tol=1e-3, initial=run.at(0.01))
        >>> bool(later["A.position"][0, 0] == run["A.position"][1, 0])
        True
        """
        from ..model.initial_state import InitialState, names_of  # brings SciPy, which results do without

        row = int(np.argmin(np.abs(self.time - time))) if len(self.time) else -1
        if row < 0 or abs(self.time[row] - time) > SAME_TIME * self.time[-1]:
            there = f"the nearest is {self.time[row]:.9g} s" if row >= 0 else "there is none"
            raise UnknownResultError(f"the run has no row at t = {time:.9g} s; {there}")
        sticking = [part.given_name or "" for part in self.scene.parts() if getattr(part, "has_friction_spring", False)]
        springs = [name for name in sticking if np.any(self[f"{name}.friction_force"][row])]
        return InitialState({name: self[name][row] for name in names_of(self.scene)}, float(self.time[row]), springs)

    def __repr__(self) -> str:
        """Return the status, times and number of results."""
        times = f"{len(self.time)} times to {self.time[-1]:.6g} s" if len(self.time) else "no times"
        return f"<funicular.Run: {self.status}, {times}, {len(self.keys())} results>"

    @property
    def dataset(self) -> xarray.Dataset:
        """Return all of it as an xarray.Dataset, with units, long names, the report and the scene as attributes."""
        import xarray  # 0.5 s, for those who ask for it

        from .files import WITH_CHECKSUMS, file_text

        def arrays(variables: Mapping[str, Variable]) -> dict:
            return {
                name: (v.dims, v.values, {"units": v.units, "long_name": v.long_name}) for name, v in variables.items()
            }

        attributes = {"funicular_format": WITH_CHECKSUMS - 1, "scene": self.scene_toml,
                      "report": file_text(self.report)}
        return xarray.Dataset(arrays(self.variables), arrays(self.coords), attributes)

    def save(self, path: str | os.PathLike) -> None:
        """Write a netCDF file that xarray opens; an older file stays until the new one is whole.

        Raises ResultFileError.
        """
        # The file format, for those who save: `import funicular` does without.
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
            block = max(1, _BLOCK // file.row_bytes)
            for first in range(0, len(self.time), block):
                file.write(first, {name: values[first : first + block] for name, values in rows.items()})

        write_whole(path, write, "the results")

    def energy_balance(self) -> EnergyBalance:
        """Return how well the energy balance closes; see `EnergyBalance`."""
        energies = {name: self[f"energy.{name}"] for name in ENERGIES if f"energy.{name}" in self}
        changes = np.array([(e - e[:1]) * (-1 if name == "external" else 1) for name, e in energies.items()])
        residual = changes.sum(axis=0)
        exchanged = float(np.abs(changes).sum(axis=0).max(initial=0.0) / 2)
        return EnergyBalance(residual, exchanged, residual / (exchanged or 1.0))

    @cached_property
    def model(self) -> Model:
        """Return the model of the scene, as it was drawn: numbers of its coordinates, what holds and joins them.

        That of planar cables is in the axes of their plane.
        """
        from ..model.build import build  # brings SciPy, which results alone do not need

        return build(laid(self.scene))

    def slack_elements(self, cable: Cable | str) -> xarray.DataArray:
        """Return which elements of ``cable`` are slack, (time, element): shorter in the middle than at rest.

        In cables with ``membrane="tension_only"`` these have hardly any stiffness along their axis. The report's events
        tell when the first of them became slack and when all were taut again, between the rows, too.
        """
        from .slack import slack_elements  # brings SciPy, as below

        return slack_elements(self, cable)

    def section_forces(self, cable: Cable | str, s: ArrayLike | Slide | None = None, *, method: str = "balance",
                       side: str = "after") -> xarray.Dataset:
        """Return the forces and moments in sections of ``cable``.

        s: arc-lengths (n,) in m; or the name of a slide on it, for the section where that is at each time. None given:
        along all of the cable, with both sides of supports, ties and loads.
        method: "balance", from what is in balance with the nodes' forces, loads, inertia and riders; "constitutive",
        from the elastic law and the strains of the mesh, without what Kelvin-Voigt damping adds. They go to the same as
        the mesh is refined, the second slowly: beside a point force, and wherever a cable turns within an element, it
        swings about the first by a tenth and more, which a `FunicularWarning` says. Vibrations of the mesh are in both.
        side: "after" or "before", of a force or moment on one point the side of larger or of smaller s. At the ends of
        the cable it is always the one inside.

        Returns a Dataset over (time, s): force and moment, on the part before the cut along the ground's axes (xyz), in
        N and N m; tension, shear and strain; curvature of cables; components along the section's axes of beams. Strains
        are those of the mesh. A taut cable bends beside a point force over sqrt(E I / N) alone. Where its elements are
        longer, tension is the size of the force, shear leaves out what is within that length of the point, and moment
        is that of an elastica along the line of the force, not of the mesh.
        Raises UnknownResultError; FunicularError where s is off the cable.
        """
        from .section_forces.forces import dataset  # brings SciPy, as above

        return dataset(self, cable, s, method=method, side=side)

    def animation(self, title: str | None = None) -> Animation:
        """Return the motion as pictures show it; see `Viewable.animation`. Raises FunicularError without results."""
        from .animation.clips import of_run  # brings SciPy, as above

        file = getattr(self.variables, "file", None)
        return of_run(self, title or ("run" if file is None else Path(file.path).stem))

    def sketch(self) -> Animation:
        """Return the motion without quantities and curves; see `Viewable.sketch`. Raises FunicularError."""
        from .animation.clips import of_run  # likewise

        return of_run(self, "run", with_results=False)

    def plot(self, what: str = "shape") -> Figure:
        """Return a Matplotlib figure: "shape", "acceleration", "slide", "energy", or "forces-wire" of the cable "wire".

        A notebook shows it, `matplotlib.pyplot.show` in a script. Raises FunicularError.
        """
        from ..view.files import new_figure  # brings Matplotlib
        from .pictures import plot

        return plot(self, what, new_figure())

    def save_plots(self, directory: str | os.PathLike, prefix: str = "", forces: bool = False) -> list[Path]:
        """Write the pictures that `funicular run --plot` writes, as PNG files with this prefix, and return their paths.

        forces: tension and moment along each cable, too. Raises ResultFileError.
        """
        from .pictures import save_plots  # likewise

        return save_plots(self, directory, prefix, forces)

    def overview(self) -> list[tuple[str, str]]:
        """Return how the run went, for a notebook; see `Viewable.overview`."""
        return self.summary_rows()

    def summary_rows(self) -> list[tuple[str, str]]:
        """Return what to tell about the run in short: pairs of a heading and a text."""
        report = self.report
        if not len(self.time):
            return [("status", f"{self.status} before the first output time: there are no results"),
                    *(("note", message) for message in report["messages"])]
        balance = self.energy_balance()
        rows = [("status", f"{self.status} at t = {self.time[-1]:.6g} s, {len(self.time)} times")]
        counts = [f"{report[key]} {text}" for key, text in _COUNTS.items() if key in report]
        if counts:
            rows.append(("steps", ", ".join(counts)))
        if "time_s" in report:
            parts = dict(report["time_s"])
            total = parts.pop("total")
            rows.append(("wall time", f"{total:.3g} s: " + ", ".join(f"{p} {s:.2g}" for p, s in parts.items())))
            if total > 0:
                rows.append(("real-time factor", f"{self.time[-1] / total:.3g} s of motion in 1 s of wall time"))
        if costs := report.get("us_per_step"):
            rows.append(("slides and joints", _dearest(costs)))
        rows += [(f"modes of {name}", text) for name, text in report.get("modes", {}).items()]
        rows.append(
            (
                "energy balance",
                f"off by {np.abs(balance.residual).max():.2g} J at most, "
                f"{np.abs(balance.relative).max():.2g} of the energy exchanged",
            )
        )
        if errors := report.get("errors"):
            rows.append(("estimated error", f"{_share(errors['both'])} of the largest motion: "
                         f"{_share(errors['time'])} of the steps, {_share(errors['mesh'])} of the mesh"))
        residuals = [np.max(self[key]) for key in self.keys() if key.endswith(".residual")]
        if residuals:
            rows.append(("joint residual", f"{max(residuals):.2g} m at most"))
        return rows + [("note", message) for message in report["messages"]]

    def summary(self) -> str:
        """Return a few lines on how the run went."""
        return "\n".join(f"{heading}: {text}" for heading, text in self.summary_rows())


def _dearest(costs: dict[str, float]) -> str:
    """Return what slides and joints take of a step, the dearest by name."""
    order = sorted(costs, key=costs.__getitem__, reverse=True)
    named = ", ".join(f"{name} {costs[name]:.3g}" for name in order[:_MOST_COSTS])
    rest = f" and {len(order) - _MOST_COSTS} more" if len(order) > _MOST_COSTS else ""
    return f"{sum(costs.values()):.3g} µs of a step: {named}{rest}"


_MOST_COSTS = 6


def _share(error: float) -> str:
    """Return an error over the largest motion in words."""
    return "unknown" if np.isnan(error) else f"{error:.1e}"


_COUNTS = {
    "steps": "taken",
    "rejected_steps": "rejected",
    "newton_iterations": "Newton iterations",
    "factorisations": "factorisations",
}
