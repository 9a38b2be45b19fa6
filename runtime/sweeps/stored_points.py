"""Stored results of each point of a sweep: results of its run by name, numbers from functions of it, or a dict."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from numbers import Real
from typing import Any

import numpy as np

from ..errors import SceneError, UnknownResultError, near
from ..parts.paths import COMPONENTS, label_of
from ..parts.scene_data import SceneData
from ..parts.validation import shown
from ..results.quantities import ENERGIES, QUANTITIES, Variable
from ..results.run import Run
from .identity import identity_of
from .parameters import SWEEP

TIME = "time"
OF_POINT = ".of_point"
"""Suffix of a coordinate that each point has as a variable."""


@dataclass(frozen=True)
class StoredPoint:
    """The stored results of one point: variables, coordinates of their dimensions, and output times (time,) in s.

    time: None where no variable is over time.
    """

    variables: dict[str, Variable]
    coords: dict[str, Variable] = field(default_factory=dict)
    time: np.ndarray | None = None

    def with_own_coords(self, names: Sequence[str]) -> StoredPoint:
        """Return it with the coordinates of these dimensions as variables."""
        own = {f"{name}{OF_POINT}": self.coords[name] for name in names if name in self.coords}
        others = {name: each for name, each in self.coords.items() if name not in names}
        return StoredPoint(self.variables | own, others, self.time)


@dataclass(frozen=True)
class Keep:
    """Names of results, or functions of the run, by their names in the sweep's dataset."""

    wanted: Mapping[str, str | Callable[[Run], Any]]

    @classmethod
    def of(cls, given: Any) -> Keep:
        """Return the results that a user names in a list, or in a dict from new names to names or functions.

        Raises SceneError.
        """
        if isinstance(given, str):
            given = [given]
        if isinstance(given, Mapping):
            wanted = dict(given)
        else:
            try:
                wanted = {name: name for name in given or ()}
            except TypeError:
                raise SceneError(SWEEP, f"keep must be a list of names of results, got {shown(given)}") from None
        for name, what in wanted.items():
            if not isinstance(name, str) or not name or not (isinstance(what, str) or callable(what)):
                raise SceneError(SWEEP, f"keep takes names of results and functions of a run, got {shown(what)}")
        return cls(wanted)

    @property
    def digest(self) -> str:
        """Return the digest of the names and functions."""
        texts = [f"{name} {what if isinstance(what, str) else identity_of(what)}" for name, what in self.wanted.items()]
        return hashlib.sha256("\n".join(texts).encode()).hexdigest()

    @property
    def takes_runs(self) -> bool:
        """Return whether functions take the runs, with their reports."""
        return any(callable(what) for what in self.wanted.values())

    def check(self, scene: SceneData) -> None:
        """Raise SceneError where there are no names, or one that is no result of this scene."""
        if not self.wanted:
            raise SceneError(SWEEP, "names no results to keep", 'give keep=["A.position", ...]; known: '
                             + ", ".join(known_results(scene)))
        known = known_results(scene)
        for what in self.wanted.values():
            if isinstance(what, str) and what not in known and what.rpartition(".")[0] not in known:
                raise SceneError(SWEEP, f'runs of this scene have no result "{what}"', near(what, known))

    def take(self, run: Run) -> StoredPoint:
        """Return the stored results of a run. Raises UnknownResultError, SceneError and any error of the functions."""
        variables = {}
        for name, what in self.wanted.items():
            variables[name] = _result(run, what) if isinstance(what, str) else as_variable(name, what(run))
        dims = {dim for variable in variables.values() for dim in variable.dims}
        coords = {dim: run.coords[dim] for dim in run.coords if dim in dims and dim != TIME}
        return StoredPoint(variables, coords, run.time if TIME in dims else None)


def known_results(scene: SceneData) -> list[str]:
    """Return the names of the results of runs of a scene, without components of vectors."""
    found = [f"{name}.{what}" for name in scene.cables for what in ("position", "nodal_vectors", "nodal_velocity")]
    for part in scene.parts():
        found += [f"{label_of(part)}.{quantity}" for quantity in QUANTITIES.get(part.group, {})]
    for name, body in scene.bodies.items():
        if body.kind == "modal_body":
            found += [f"{name}.{what}" for what in ("modal_coordinates", "modal_velocities", "nodes")]
    return found + [f"energy.{kind}" for kind in ENERGIES]


def _result(run: Run, name: str) -> Variable:
    """Return a result of a run by its name, or one component of it. Raises UnknownResultError."""
    if name in run.variables:
        return run.variables[name]
    whole, _, component = name.rpartition(".")
    if component in COMPONENTS and whole in run:
        variable = _result(run, whole)
        if variable.dims[-1] == "xyz":
            return Variable(variable.dims[:-1], variable.values[..., COMPONENTS[component]], variable.units,
                            f"{variable.long_name}, {component}")
        raise UnknownResultError(f'the result "{whole}" has no components, but {", ".join(variable.dims)}')
    values = run[name]  # the error names similar results
    return Variable((TIME, f"{whole}.node", "xyz"), values, "m", "positions of the nodes")


def as_variable(name: str, value: Any) -> Variable:
    """Return a number or an array of any shape, with numbered dimensions. Raises SceneError."""
    values = np.asarray(value)
    if values.dtype.kind not in "fiub" or not (isinstance(value, Real | np.ndarray | np.generic | list | tuple)):
        raise SceneError(SWEEP, f'the result kept as "{name}" must be a number or an array of numbers, got '
                         + shown(value))
    return Variable(tuple(f"{name}.{k}" for k in range(values.ndim)), values.astype(float), "", "")


def of_dict(data: Mapping[str, Any], keep: Keep) -> StoredPoint:
    """Return numbers and arrays to store, by name: all, or those named. Raises SceneError."""
    names: Iterable[Any] = [what for what in keep.wanted.values() if isinstance(what, str)] or data
    variables = {}
    for name in names:
        if name not in data:
            raise SceneError(SWEEP, f'the function returned no "{name}"', near(name, data))
        if not isinstance(name, str) or not name:
            raise SceneError(SWEEP, f"a name that the function returned must be a text, got {shown(name)}")
        variables[name] = as_variable(name, data[name])
    return StoredPoint(variables)
