"""The quantities of results with their units and meanings, and the labelled rows of a run."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from threading import RLock
from typing import Any, NamedTuple

import numpy as np

from ..parts.kinds import KINDS
from ..parts.quantity import Quantity


class Variable(NamedTuple):
    """An array with the names of its dimensions, its unit and its meaning."""

    dims: tuple[str, ...]
    values: np.ndarray
    units: str
    long_name: str


class EnergyBalance(NamedTuple):
    """residual (time,): kinetic + elastic + potential + dissipated - external, minus the same at the start, in J.

    exchanged: the largest energy that had changed its kind at any time, half the sum of these changes, in J;
    relative (time,): residual / exchanged, the residual itself if nothing was exchanged.
    """

    residual: np.ndarray
    exchanged: float
    relative: np.ndarray


QUANTITIES: dict[str, dict[str, Quantity]] = {}
"""The results of the parts of each group, by name."""
for _kind in KINDS:
    for _part in (_kind, *_kind.parts_within):
        QUANTITIES.setdefault(_kind.group, {}).update(_part.results)

STORED_ENERGIES = ("kinetic", "elastic", "potential")
ENERGIES = {
    "kinetic": "kinetic energy",
    "elastic": "elastic energy",
    "potential": "potential energy of gravity",
    "dissipated": "energy lost to damping, friction and impacts since the start",
    "external": "work of loads other than gravity, of drives and of prescribed motions since the start",
}


def labelled(rows: Any) -> dict[str, Variable]:
    """Return the labelled results of `recording.Rows`."""
    variables = {}
    for name, cable in rows.cables.items():
        dims = ("time", f"{name}.node", f"{name}.vector", "xyz")
        variables[f"{name}.nodal_vectors"] = Variable(dims, cable["nodal_vectors"], "m (r), 1 (its gradients)",
                                                      "nodal vectors")
        variables[f"{name}.nodal_velocity"] = Variable(dims, cable["nodal_velocity"], "m/s (r), 1/s (its gradients)",
                                                       "rates of the nodal vectors")
    for name, body in rows.modal.items():
        mode = f"{name}.mode"
        variables[f"{name}.modal_coordinates"] = Variable(("time", mode), body["modal_coordinates"], "as the modes are",
                                                          "modal coordinates")
        variables[f"{name}.modal_velocities"] = Variable(("time", mode), body["modal_velocities"],
                                                         "as the modes are, 1/s", "rates of the modal coordinates")
        variables[f"{name}.nodes"] = Variable(("time", f"{name}.node", "xyz"), body["nodes"], "m",
                                              "places of the deformed body's nodes")
    for group, parts in rows.parts.items():
        for name, arrays in parts.items():
            for quantity, values in arrays.items():
                of = QUANTITIES[group][quantity]
                variables[f"{name}.{quantity}"] = Variable(of.dims_of(name), values, of.units, of.long_name)
    for name, values in rows.energy.items():
        variables[f"energy.{name}"] = Variable(("time",), values, "J", ENERGIES[name])
    return variables


class ComputedWhenRead(Mapping[str, Variable]):
    """Results by name, of which those of a part are computed when the first of them is read, and kept."""

    def __init__(self, results: Callable[[str | None], Mapping[str, Variable]]):
        """results: returns the results of a part, the name of a result up to the last dot, or with None of all."""
        self._results: Callable[[str | None], Mapping[str, Variable]] | None = results
        self._found: dict[str, Variable] = {}
        self._parts: set[str] = set()
        self._lock = RLock()

    def _of(self, name: str) -> Variable | None:
        """Return a result, None where there is none of this name."""
        found, part = self._found.get(name), name.rpartition(".")[0]
        if found is not None or self._results is None or part in self._parts:
            return found
        with self._lock:
            of_part = {} if self._results is None else self._results(part)
            for each, variable in of_part.items():
                self._found.setdefault(each, variable)
            if any(each.rpartition(".")[0] == part for each in of_part):
                self._parts.add(part)
                return self._found.get(name)
        return self._all().get(name)

    def _all(self) -> dict[str, Variable]:
        """Return all results; those that were read before stay the same arrays."""
        with self._lock:
            if self._results is not None:
                self._found = {name: self._found.get(name, each) for name, each in self._results(None).items()}
                self._results = None
        return self._found

    def __getitem__(self, name: str) -> Variable:
        """Return a result by its name; its part is computed if it was not. Raises KeyError."""
        found = self._of(name)
        if found is None:
            raise KeyError(name)
        return found

    def __contains__(self, name: object) -> bool:
        """Return whether there is such a result."""
        return isinstance(name, str) and self._of(name) is not None

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of all results."""
        return iter(self._all())

    def __len__(self) -> int:
        """Return the number of results."""
        return len(self._all())

    def __reduce__(self) -> tuple[type[dict[str, Variable]], tuple[dict[str, Variable]]]:
        """Return all results as a dict, for copies and other processes."""
        return dict, (dict(self._all()),)
