"""The quantities of results, their units and what they are; rows of a run with these labels."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class Variable(NamedTuple):
    """An array with the names of its dimensions, its unit and what it is."""

    dims: tuple[str, ...]
    values: np.ndarray
    units: str
    long_name: str


_XYZ, _TIME = ("time", "xyz"), ("time",)

Labels = tuple[tuple[str, ...], str, str]
"""Names of the dimensions of a quantity, its unit and what it is."""

_SUPPORT: dict[str, Labels] = {"force": (_XYZ, "N", "force on the cable"),
                               "moment": (_XYZ, "N m", "moment on the cable")}

QUANTITIES: dict[str, dict[str, Labels]] = {
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


def labelled(rows) -> tuple[dict[str, Variable], dict[str, Variable]]:
    """Return results of the rows that `funicular.recording` names, with their labels; coordinates."""
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
                along, units, long_name = quantities[quantity]
                variables[f"{name}.{quantity}"] = Variable(along, values, units, long_name)
    for name, values in rows.energy.items():
        variables[f"energy.{name}"] = Variable(_TIME, values, "J", ENERGIES[name])
    return variables, coords
