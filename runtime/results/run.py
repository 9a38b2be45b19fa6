"""Results of a run: labelled arrays with units, and their files."""

from __future__ import annotations

import errno
import json
import os
import threading
import warnings
from collections.abc import Iterable, Mapping
from functools import cached_property
from operator import methodcaller
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from pydantic import BaseModel, ConfigDict

from ..errors import FunicularWarning, ResultFileError, UnknownResultError, near, shown_path
from .locks import Taken, created, lock
from .netcdf import ROW_CHECKSUM, File, Stored, Variable, create, last_report

if TYPE_CHECKING:
    import xarray

    from ..model.build import Model
    from ..parts.cable import Cable
    from ..parts.settings import RunSettings
    from ..scene import Scene

FILE_FORMAT = 3
"""Raised when a reader of older files could misread new ones."""
WITH_CHECKSUMS = 3
"""From this format on files have them; older ones are read all the same, with a warning."""
_BLOCK = 1 << 22
"""Bytes that are written at once."""


_XYZ, _TIME = ("time", "xyz"), ("time",)

_SUPPORT = {"force": (_XYZ, "N", "force on the cable"), "moment": (_XYZ, "N m", "moment on the cable")}

QUANTITIES = {
    "bodies": {
        "position": (_XYZ, "m", "position of the body's origin"),
        "orientation": (("time", "wxyz"), "1", "unit quaternion from body axes to the ground's"),
        "velocity": (_XYZ, "m/s", "velocity of the body's origin"),
        "angular_velocity": (_XYZ, "rad/s", "angular velocity in body axes"),
        "acceleration": (_XYZ, "m/s2", "acceleration of the body's origin"),
        "angular_acceleration": (_XYZ, "rad/s2", "angular acceleration in body axes"),
    },
    "slides": {
        "s": (_TIME, "m", "undeformed arc-length of the rider's place"),
        "s_rate": (_TIME, "m/s", "rate of s"),
        "s_acceleration": (_TIME, "m/s2", "second rate of s"),
        "force": (_XYZ, "N", "force on the rider"),
        "multiplier": (("time", "normal"), "N", "multipliers of the two constraints across the cable"),
        "traction": (_TIME, "N", "force on the rider along the cable; of a driven slide its drive's power over s_rate"),
        "moment": (_XYZ, "N m", "moment on the rider, of a slide that ties its axes to the cable's frame"),
        "residual": (_TIME, "m", "distance of the rider's point to the cable"),
    },
    "pins": {"force": _SUPPORT["force"]},
    "clamps": _SUPPORT,
    "motions": _SUPPORT,
    "ties": _SUPPORT,
    "joints": {
        "force": (_XYZ, "N", "force on what carries the end b, at that end"),
        "moment": (_XYZ, "N m", "moment on what carries the end b, about that end"),
        "residual": (_TIME, "1", "largest of its equations, in m or of cosines"),
    },
    "springs": {
        "force": (_XYZ, "N", "force on the first end"),
        "tension": (_TIME, "N", "force with which the ends are drawn together"),
        "length": (_TIME, "m", "distance of the ends"),
    },
}
ENERGIES = {
    "kinetic": "kinetic energy",
    "elastic": "elastic energy",
    "potential": "potential energy of gravity",
    "dissipated": "energy lost to damping, friction and impacts since the start",
    "external": "work of loads other than gravity, of drives and of prescribed motions since the start",
}


class EnergyBalance(NamedTuple):
    """residual (time,): kinetic + elastic + potential + dissipated - external, minus the same at the start, in J.

    exchanged: the most energy that had changed its kind at any time, half the sum of these changes, in J;
    relative (time,): residual / exchanged, the residual itself if nothing was exchanged.
    """

    residual: np.ndarray
    exchanged: float
    relative: np.ndarray


class Run:
    """Results by name: ``run["A.position"]`` is a NumPy array (time, 3); `keys` lists the names."""

    def __init__(self, variables: Mapping[str, Variable], coords: dict[str, Variable], report: dict, scene_toml: str,
                 libraries: Iterable[str | os.PathLike] = ()):
        """report: how the run went, status, message and messages among it; scene_toml: the scene as text.

        report["us_per_step"] tells what each slide and joint takes of a step in µs, without solving for its forces.
        libraries: directories of elements that the scene may load when it is read back from its text.
        """
        self.variables, self.coords = variables, coords
        self.report, self.scene_toml, self.libraries = report, scene_toml, libraries

    @classmethod
    def from_recording(cls, recording, scene: Scene, settings: RunSettings) -> Run:
        """Label what `funicular.model.simulate` recorded."""
        variables, coords = labelled(recording)
        report = {
            **recording.report,
            "status": recording.status,
            "message": recording.message,
            "messages": [*scene.messages, *recording.report.get("messages", [])],
            "settings": settings.model_dump(),
        }
        return cls(variables, coords, report, scene.to_toml(), scene.libraries)

    @property
    def time(self) -> np.ndarray:
        """(time,): the times of the results, in s."""
        return self.coords["time"].values

    @property
    def status(self) -> str:
        """``completed``, ``event`` (stopped by one), ``interrupted``, ``end_of_cable`` or ``no_convergence``.

        ``unfinished`` of a run that goes on, or was killed.
        """
        return self.report["status"]

    @property
    def events(self) -> list[dict]:
        """What has happened. Of the scene's events: name, time (s), and the state of bodies and slides there.

        Of slides: name, time (s), s (m), and what: "stuck", "broke loose", "turned round" (friction); "struck the end",
        "came to rest at the end", "left the end" (hard stops); "entered the buffer", "left the buffer"; "left".
        """
        return self.report["events"]

    @cached_property
    def scene(self) -> Scene:
        """The scene that was run, read back from its text; what was adjusted then is told in the report.

        Raises SceneError for a library that is not allowed.
        """
        from ..scene_file import loads

        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FunicularWarning)
            return loads(self.scene_toml, "the scene of the run", libraries=self.libraries)

    def keys(self) -> list[str]:
        """The names of all results; a cable's ``wire.position`` is a part of its ``wire.nodal_vectors``."""
        return list(self.variables)

    def __contains__(self, name: str) -> bool:
        """Whether there is a result of that name."""
        return name in self.variables or name in self._positions

    def __getitem__(self, name: str) -> np.ndarray:
        """The array called ``name``, time first; units and dimensions stand in ``variables[name]``."""
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
        """Cables' positions of nodes, (time, node, 3) in m, by name; each is the first of these nodal vectors."""
        suffix = ".nodal_vectors"
        return {name.removesuffix(suffix) + ".position": name for name in self.variables if name.endswith(suffix)}

    def __repr__(self) -> str:
        """Status, times and number of results."""
        times = f"{len(self.time)} times to {self.time[-1]:.6g} s" if len(self.time) else "no times"
        return f"<funicular.Run: {self.status}, {times}, {len(self.keys())} results>"

    @property
    def dataset(self) -> xarray.Dataset:
        """All of it as an xarray.Dataset, with units, long names, the report and the scene as attributes."""
        import xarray

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
        path = check_writable(path)
        check_free(path)
        part = path.with_name(f".{path.name}.{os.getpid()}-{threading.get_ident()}.part")
        report = file_text(self.report, len(self.time))
        try:
            if isinstance(self.variables, Stored):
                described = self.variables.file.described(over_time=True)
                fixed = {name: v for name, v in self.coords.items() if name != "time"}
                create_file(part, fixed, described, self.scene_toml, report).copy_rows(self.variables.file)
            else:
                file = create_file(part, self.coords, self.variables, self.scene_toml, report)
                rows = over_time(self.coords, self.variables)
                block = max(1, _BLOCK // file.row_bytes)
                for first in range(0, len(self.time), block):
                    file.write(first, {name: values[first : first + block] for name, values in rows.items()})
            part.replace(path)
        except OSError as error:
            raise ResultFileError(f"{path}: the results could not be written: {error}") from error
        finally:
            part.unlink(missing_ok=True)

    def energy_balance(self) -> EnergyBalance:
        """How well the energy books close; see `EnergyBalance`."""
        energies = {name: self[f"energy.{name}"] for name in ENERGIES if f"energy.{name}" in self}
        changes = np.array([(e - e[:1]) * (-1 if name == "external" else 1) for name, e in energies.items()])
        residual = changes.sum(axis=0)
        exchanged = float(np.abs(changes).sum(axis=0).max(initial=0.0) / 2)
        return EnergyBalance(residual, exchanged, residual / (exchanged or 1.0))

    @cached_property
    def model(self) -> Model:
        """The model of the scene, as it was drawn: numbers of its coordinates, what holds and joins them."""
        from ..model.build import build

        return build(self.scene)

    def section_forces(self, cable: Cable | str, s=None, *, method: str = "balance",
                       side: str = "after") -> xarray.Dataset:
        """Forces and moments in sections of ``cable``.

        s: arc-lengths (n,) in m; or the name of a slide on it, for the section where that is at each time. None given:
        along all of the cable, with both sides of supports, joins and loads.
        method: "balance", from what is in balance with the nodes' forces, loads, inertia and riders; "constitutive",
        from the elastic law and the strains of the mesh, without what Kelvin-Voigt damping adds. They go to the same as
        the mesh is refined, the second slowly: beside a point force, and wherever a cable turns within an element, it
        swings about the first by a tenth and more. Vibrations of the mesh are in both.
        side: "after" or "before", of a force or moment on one point the side of larger or of smaller s. At the ends of
        the cable it is always the one inside.

        Returns a Dataset over (time, s): force and moment, on the part before the cut along the ground's axes (xyz), in
        N and N m; tension, shear and strain; curvature of cables; components along the section's axes of beams. Strains
        are those of the mesh. A taut cable bends beside a point force over sqrt(E I / N) alone. Where its elements are
        longer, tension is the size of the force, shear leaves out what is within that length of the point, and moment
        is that of an elastica along the line of the force, not of the mesh.
        Raises UnknownResultError; FunicularError where s is off the cable.
        """
        from .section_forces import dataset

        return dataset(self, cable, s, method=method, side=side)

    def summary_rows(self) -> list[tuple[str, str]]:
        """What to tell about the run in short: pairs of a heading and a text."""
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
        residuals = [np.max(self[key]) for key in self.keys() if key.endswith(".residual")]
        if residuals:
            rows.append(("joint residual", f"{max(residuals):.2g} m at most"))
        return rows + [("note", message) for message in report["messages"]]

    def summary(self) -> str:
        """A few lines on how the run went."""
        return "\n".join(f"{heading}: {text}" for heading, text in self.summary_rows())


def _dearest(costs: dict[str, float]) -> str:
    """What slides and joints take of a step, the dearest by name."""
    order = sorted(costs, key=costs.__getitem__, reverse=True)
    named = ", ".join(f"{name} {costs[name]:.3g}" for name in order[:_MOST_COSTS])
    rest = f" and {len(order) - _MOST_COSTS} more" if len(order) > _MOST_COSTS else ""
    return f"{sum(costs.values()):.3g} µs of a step: {named}{rest}"


_MOST_COSTS = 6
_COUNTS = {
    "steps": "taken",
    "rejected_steps": "rejected",
    "newton_iterations": "Newton iterations",
    "factorisations": "factorisations",
}


def labelled(rows) -> tuple[dict[str, Variable], dict[str, Variable]]:
    """Results of the rows that `funicular.recording` names, with their labels; coordinates."""
    variables = {}
    coords = {
        "time": Variable(_TIME, rows.time, "s", "time"),
        "xyz": Variable(("xyz",), np.array(["x", "y", "z"]), "1", "axis"),
    }
    for name, cable in rows.cables.items():
        node, vector = f"{name}.node", f"{name}.vector"
        dims = ("time", node, vector, "xyz")
        coords[node] = Variable((node,), cable["node_s"], "m", "undeformed arc-length of the node")
        coords[vector] = Variable((vector,), np.array(cable["vector_names"]), "1", "nodal vector")
        variables[f"{name}.nodal_vectors"] = Variable(
            dims, cable["nodal_vectors"], "m (r), 1 (its gradients)", "nodal vectors"
        )
        variables[f"{name}.nodal_velocity"] = Variable(
            dims, cable["nodal_velocity"], "m/s (r), 1/s (its gradients)", "rates of the nodal vectors"
        )
    for name, body in getattr(rows, "modal", {}).items():
        mode, node = f"{name}.mode", f"{name}.node"
        eta, places = body["modal_coordinates"], body["nodes"]
        coords[mode] = Variable((mode,), np.arange(1, eta.shape[1] + 1), "1", "mode")
        coords[node] = Variable((node,), np.arange(places.shape[1]), "1", "node")
        variables[f"{name}.modal_coordinates"] = Variable(("time", mode), eta, "as the modes are", "modal coordinates")
        variables[f"{name}.modal_velocities"] = Variable(("time", mode), body["modal_velocities"],
                                                         "as the modes are, 1/s", "rates of the modal coordinates")
        variables[f"{name}.nodes"] = Variable(("time", node, "xyz"), places, "m", "places of the deformed body's nodes")
    for group, quantities in QUANTITIES.items():
        for name, arrays in getattr(rows, group, {}).items():
            for quantity, values in arrays.items():
                dims, units, long_name = quantities[quantity]
                variables[f"{name}.{quantity}"] = Variable(dims, values, units, long_name)
    for name, values in rows.energy.items():
        variables[f"energy.{name}"] = Variable(_TIME, values, "J", ENERGIES[name])
    return variables, coords


def check_writable(path: str | os.PathLike) -> Path:
    """The path without links. Raises ResultFileError if no file can be written there; leaves nothing behind."""
    try:
        resolved = Path(path).resolve()  # a link keeps pointing to what it did
        own = threading.get_native_id()  # several threads may look at once
        probe = resolved.with_name(f".{resolved.name}.{own}.probe")  # longer than other names that are needed
        if resolved.is_dir():
            cause, remedy = "this is a directory", "add a name"
        elif resolved.exists() and not resolved.is_file():
            cause, remedy = "this is a device, not a file", "give another path"
        elif resolved.exists() and not os.access(resolved, os.W_OK):
            cause, remedy = "the file is write-protected", "give another path"
        else:
            os.close(created(probe))
            probe.unlink()
            return resolved
    except ValueError as error:  # a NUL, half of a surrogate pair
        cause, remedy = f"this is no path: {error}", "give another one"
    except OSError as error:
        cause, remedy = error.strerror, "give a path in a directory that exists and is yours to write to"
        if error.errno == errno.ENAMETOOLONG:
            remedy = "give a shorter name, below 240 bytes"
    raise ResultFileError(f"{shown_path(path)}: the results cannot be written here: {cause}; {remedy}") from None


def check_free(path: Path) -> None:
    """Raises ResultFileError where a run is writing the file."""
    try:
        with open(path) as older:
            lock(older.fileno())
    except Taken:
        raise ResultFileError(f"{path}: a run is writing it; wait for its end, or give another name") from None
    except OSError:
        pass  # there is none


def over_time(coords: Mapping[str, Variable], variables: Mapping[str, Variable]) -> dict[str, np.ndarray]:
    """The values that make rows of a file."""
    return {"time": coords["time"].values} | {name: variable.values for name, variable in variables.items()}


def file_text(report: dict, rows: int | None = None) -> str:
    """A report as it stands in a file, in one line; rows: number of rows of a file that is whole."""
    return json.dumps(report if rows is None else {"rows": rows, **report}, default=methodcaller("tolist"))


def create_file(path: str | os.PathLike, coords: Mapping[str, Variable], variables: Mapping[str, Variable], scene: str,
                report: str, room: int = 0, descriptor: int | None = None) -> File:
    """A new file of results, without rows; report: from `file_text`; see `funicular.netcdf.create`. Raises OSError."""
    return create(path, coords, variables, {"funicular_format": FILE_FORMAT, "scene": scene}, report, room, descriptor)


class _Report(BaseModel):
    """What a report in a file must be, as far as there is any of it but for its status."""

    model_config = ConfigDict(strict=True, extra="allow", defer_build=True)

    status: str
    message: str
    messages: list[str]
    settings: dict
    events: list[dict] = []
    time_s: dict[str, float] = {}
    us_per_step: dict[str, float] = {}
    modes: dict[str, str] = {}
    rows: int | None = None


def load_run(path: str | os.PathLike, libraries: Iterable[str | os.PathLike] = (), salvage: bool = False) -> Run:
    """Open the results of a run, also of one that goes on or was killed; arrays are read when they are asked for.

    All of the file is checked: its header, its report and its rows have checksums.

    libraries: directories of elements (`funicular derive --spec`) that ``run.scene`` may load; they are machine code.
    salvage: leave out the rows that are damaged, with a `FunicularWarning`, where the file would be refused otherwise.
    Raises ResultFileError, also for a damaged or foreign file.
    """
    return opened(open_file(path), libraries, salvage)


def open_file(path: str | os.PathLike) -> File:
    """A file of results, open to be read. Raises ResultFileError."""
    if not os.path.isfile(path):
        raise ResultFileError(f"{shown_path(path)}: there is no such file")
    try:
        return File(path)
    except (OSError, ValueError) as error:
        raise ResultFileError(f"{path}: is no netCDF file, or was cut short or damaged: {error}") from error


def opened(file: File, libraries: Iterable[str | os.PathLike] = (), salvage: bool = False, check: bool = True) -> Run:
    """The results in an open file, see `load_run`; check: its rows, too. Raises ResultFileError."""
    path = file.path
    if "funicular_format" not in file.attributes:
        raise ResultFileError(f"{path}: is a netCDF file, but not one that funicular wrote")
    try:
        made = np.asarray(file.attributes["funicular_format"]).item()
        if not isinstance(made, int):
            raise ValueError("its format is no number")
        if made > FILE_FORMAT:
            raise ResultFileError(f"{path}: was written by a newer funicular; update this one to read it")
        if made >= WITH_CHECKSUMS and not file.has_checksums:
            raise ValueError("it lacks its checksums")
        report, scene = _read_report(file), file.attributes["scene"]
        rows = report.pop("rows", None)
        if check:
            _check_rows(file, rows, salvage)
        names = [name for name, entry in file.entries.items()
                 if entry.dims[:1] != (name,) and not (name == ROW_CHECKSUM and file.has_checksums)]
        coords = {name: file.variable(name, file.read(name)) for name in file.entries
                  if name not in {*names, ROW_CHECKSUM}}
        if not isinstance(scene, str) or "time" not in coords:
            raise ValueError("it has no times, or no scene")
    except (OSError, ValueError, LookupError, TypeError, OverflowError) as error:
        raise ResultFileError(f"{path}: is damaged: {error}") from error
    if report["status"] == "unfinished":
        from .streaming import add_events

        add_events(report, Path(path))
    return Run(Stored(file, names), coords, report, scene, libraries)


def _read_report(file: File) -> dict:
    """The report in a file. Raises ValueError, KeyError where it is damaged."""
    report = last_report(file.attributes["report"], file.has_checksums)
    _Report.model_validate(report)
    return report


def _check_rows(file: File, rows: int | None, salvage: bool) -> None:
    """Find damaged rows, to leave them out or to raise ResultFileError; warn where there are no checksums.

    rows: number of rows that the report tells, None where the run goes on.
    """
    if rows is not None and rows != file.rows:
        raise ValueError(f"its header says that it has {file.rows} times, its report {rows}")
    if not file.has_checksums:
        warnings.warn(f"{file.path}: has no checksums, as an older funicular or another program wrote it: damage to it "
                      "would not be found", FunicularWarning, stacklevel=4)
        return
    damaged = file.damaged_rows()
    if not len(damaged):
        return
    named = ", ".join(map(str, damaged[:_MOST_ROWS])) + (", ..." if len(damaged) > _MOST_ROWS else "")
    found = f"{file.path}: {len(damaged)} of its {file.rows} output times are damaged, those of the rows {named}"
    if not salvage or len(damaged) == file.rows:
        raise ResultFileError(f"{found}; take a copy of it, run the scene again, or read the other times with "
                              "load_run(path, salvage=True)")
    file.left_out = damaged
    warnings.warn(f"{found}; they are left out", FunicularWarning, stacklevel=4)


_MOST_ROWS = 10
"""Rows that a message names."""
