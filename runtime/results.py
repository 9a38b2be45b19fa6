"""Results of a run: labelled arrays with units, and their files."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from functools import cached_property
from operator import methodcaller
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from funicular.errors import ResultFileError, UnknownResultError, near
from funicular.netcdf import File, Stored, Variable, create, last_report

if TYPE_CHECKING:
    import xarray
    from funicular.cables import Cable
    from funicular.scene import Scene
    from funicular.settings import RunSettings

FILE_FORMAT = 2
"""Raised when a reader of older files could misread new ones."""
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
        "traction": (_TIME, "N", "force on the rider along the cable: of what drives or brakes it"),
        "moment": (_XYZ, "N m", "moment on the rider, of a slide that ties its axes to the cable's frame"),
        "residual": (_TIME, "m", "distance of the rider's point to the cable"),
    },
    "pins": {"force": _SUPPORT["force"]},
    "clamps": _SUPPORT,
    "motions": _SUPPORT,
    "joins": _SUPPORT,
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
    "dissipated": "energy lost to damping since the start",
    "external": "work of loads other than gravity and of prescribed motions since the start",
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

    def __init__(self, variables: Mapping[str, Variable], coords: dict[str, Variable], report: dict, scene_toml: str):
        """report: how the run went, status, message and messages among it; scene_toml: the scene as text.

        report["us_per_step"] tells what each slide and joint takes of a step in µs, without solving for its forces.
        """
        self.variables, self.coords = variables, coords
        self.report, self.scene_toml = report, scene_toml

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
        return cls(variables, coords, report, scene.to_toml())

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
        """The scene that was run, read back from its text."""
        from funicular.scene_file import loads

        return loads(self.scene_toml, "the scene of the run")

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
        return (
            f"<funicular.Run: {self.status}, {len(self.time)} times to {self.time[-1]:.6g} s, "
            f"{len(self.keys())} results>"
        )

    @property
    def dataset(self) -> xarray.Dataset:
        """All of it as an xarray.Dataset, with units, long names, the report and the scene as attributes."""
        import xarray

        def arrays(variables: Mapping[str, Variable]) -> dict:
            return {
                name: (v.dims, v.values, {"units": v.units, "long_name": v.long_name}) for name, v in variables.items()
            }

        attributes = {"funicular_format": FILE_FORMAT, "scene": self.scene_toml, "report": file_text(self.report)}
        return xarray.Dataset(arrays(self.variables), arrays(self.coords), attributes)

    def save(self, path: str | os.PathLike) -> None:
        """Write a netCDF file that xarray opens; an older file stays until the new one is whole.

        Raises ResultFileError.
        """
        check_writable(path)
        path = Path(path).resolve()  # a link keeps pointing to what it did
        part = path.with_name(f".{path.name}.{os.getpid()}.part")
        try:
            if isinstance(self.variables, Stored):
                described = self.variables.file.described(over_time=True)
                fixed = {name: v for name, v in self.coords.items() if name != "time"}
                create_file(part, fixed, described, self.scene_toml, self.report).copy_rows(self.variables.file)
            else:
                file = create_file(part, self.coords, self.variables, self.scene_toml, self.report)
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
        changes = np.array([(e - e[0]) * (-1 if name == "external" else 1) for name, e in energies.items()])
        residual = changes.sum(axis=0)
        exchanged = float(np.abs(changes).sum(axis=0).max() / 2)
        return EnergyBalance(residual, exchanged, residual / (exchanged or 1.0))

    def section_forces(self, cable: Cable | str, s=None) -> xarray.Dataset:
        """Forces and moments in sections of ``cable``, at arc-lengths ``s`` (n,) in m; none given: along all of it.

        Those of the elastic law: what Kelvin-Voigt damping adds is not in them.

        Returns a Dataset over (time, s): force and moment, on the part before the cut along the ground's axes (xyz), in
        N and N m; tension, shear and strain; curvature of cables; components along the section's axes of beams. At a
        node, where the forces of an element may jump, they are those of the element that begins there.
        Raises UnknownResultError; FunicularError where s is off the cable.
        """
        from funicular.section_forces import dataset

        return dataset(self, cable, s)

    def summary_rows(self) -> list[tuple[str, str]]:
        """What to tell about the run in short: pairs of a heading and a text."""
        report, balance = self.report, self.energy_balance()
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


def check_writable(path: str | os.PathLike) -> None:
    """Raises ResultFileError if a file cannot be written at ``path``; leaves nothing behind."""
    path = Path(path).resolve()
    if path.is_dir():
        raise ResultFileError(f"{path}: the results cannot be written here: this is a directory; add a name")
    if path.exists() and not path.is_file():
        raise ResultFileError(f"{path}: the results cannot be written here: this is a device, not a file")
    if path.exists() and not os.access(path, os.W_OK):
        raise ResultFileError(f"{path}: the results cannot be written here: the file is write-protected")
    probe = path.with_name(f".{path.name}.{os.getpid()}.probe")
    try:
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise ResultFileError(
            f"{path}: the results cannot be written here: {error.strerror}; "
            "give a path in a directory that exists and is yours to write to"
        ) from None


def over_time(coords: Mapping[str, Variable], variables: Mapping[str, Variable]) -> dict[str, np.ndarray]:
    """The values that make rows of a file."""
    return {"time": coords["time"].values} | {name: variable.values for name, variable in variables.items()}


def file_text(report: dict) -> str:
    """A report as it stands in a file, in one line."""
    return json.dumps(report, default=methodcaller("tolist"))


def create_file(path: str | os.PathLike, coords: Mapping[str, Variable], variables: Mapping[str, Variable], scene: str,
                report: dict, room: int = 0) -> File:
    """A new file of results, without rows; see `funicular.netcdf.create`. Raises OSError."""
    return create(path, coords, variables, {"funicular_format": FILE_FORMAT, "scene": scene}, file_text(report), room)


def load_run(path: str | os.PathLike) -> Run:
    """Open the results of a run, also of one that goes on or was killed; arrays are read when they are asked for.

    Raises ResultFileError, also for a damaged or foreign file.
    """
    path = Path(path)
    if not path.is_file():
        raise ResultFileError(f"{path}: there is no such file")
    try:
        file = File(path)
    except (OSError, ValueError) as error:
        raise ResultFileError(f"{path}: is no netCDF file, or was cut short or damaged: {error}") from error
    if "funicular_format" not in file.attributes:
        raise ResultFileError(f"{path}: is a netCDF file, but not one that funicular wrote")
    if file.attributes["funicular_format"] > FILE_FORMAT:
        raise ResultFileError(f"{path}: was written by a newer funicular; update this one to read it")
    names = [name for name, entry in file.entries.items() if entry.dims[:1] != (name,)]
    coords = {name: file.variable(name, file.read(name)) for name in file.entries if name not in set(names)}
    report = json.loads(last_report(file.attributes["report"]))
    if report["status"] == "unfinished":
        from funicular.streaming import events_kept

        report["events"] = events_kept(path)
    return Run(Stored(file, names), coords, report, file.attributes["scene"])
