"""The quantities of results with their units and meanings, and the labelled rows of a run."""

from __future__ import annotations

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


def labelled(rows: Any) -> tuple[dict[str, Variable], dict[str, Variable]]:
    """Return the labelled results and coordinates of `recording.Rows`."""
    variables = {}
    coords = {
        "time": Variable(("time",), rows.time, "s", "time"),
        "xyz": Variable(("xyz",), np.array(["x", "y", "z"]), "1", "axis"),
    }
    for name, cable in rows.cables.items():
        node, vector = f"{name}.node", f"{name}.vector"
        dims = ("time", node, vector, "xyz")
        coords[node] = Variable((node,), cable["node_s"], "m", "undeformed arc-length of the node")
        coords[vector] = Variable((vector,), np.array(cable["vector_names"]), "1", "nodal vector")
        variables[f"{name}.nodal_vectors"] = Variable(dims, cable["nodal_vectors"], "m (r), 1 (its gradients)",
                                                      "nodal vectors")
        variables[f"{name}.nodal_velocity"] = Variable(dims, cable["nodal_velocity"], "m/s (r), 1/s (its gradients)",
                                                       "rates of the nodal vectors")
    for name, body in rows.modal.items():
        mode, node = f"{name}.mode", f"{name}.node"
        eta, places = body["modal_coordinates"], body["nodes"]
        coords[mode] = Variable((mode,), np.arange(1, eta.shape[1] + 1), "1", "mode")
        coords[node] = Variable((node,), np.arange(places.shape[1]), "1", "node")
        variables[f"{name}.modal_coordinates"] = Variable(("time", mode), eta, "as the modes are", "modal coordinates")
        variables[f"{name}.modal_velocities"] = Variable(("time", mode), body["modal_velocities"],
                                                         "as the modes are, 1/s", "rates of the modal coordinates")
        variables[f"{name}.nodes"] = Variable(("time", node, "xyz"), places, "m", "places of the deformed body's nodes")
    for group, parts in rows.parts.items():
        for name, arrays in parts.items():
            for quantity, values in arrays.items():
                of = QUANTITIES[group][quantity]
                of_part = tuple(dim.format(part=name) for dim in of.dims)
                variables[f"{name}.{quantity}"] = Variable(of_part, values, of.units, of.long_name)
    for name, values in rows.energy.items():
        variables[f"energy.{name}"] = Variable(("time",), values, "J", ENERGIES[name])
    return variables, coords
