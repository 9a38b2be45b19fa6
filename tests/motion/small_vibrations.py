"""Free vibrations of scenes about their equilibrium, started from the shape of a mode."""

from __future__ import annotations

import re

import funicular as fu
import numpy as np
from funicular.base.rotations import product, turned_by
from funicular.parts.cable import Cable
from funicular.parts.load import Load
from funicular.parts.part import Part
from funicular.parts.point_force import PointForce
from funicular.results.equilibrium import Equilibrium
from funicular.results.modes import Modes

STATE = ("nodal_vectors", "position", "orientation", "modal_coordinates", "s")
"""What results tell of a state."""


def free_to_vibrate(scene: fu.Scene) -> bool:
    """Return whether the modes of a scene without dampers and loads are its vibrations: no drives, flows, contact or
    friction.
    """
    driven = any(joint.is_driven for joint in scene.joints.values()) or any(
        slide.is_driven or slide.friction is not None for slide in scene.slides.values())
    grows = any(cable.grows for cable in scene.cables.values())
    return not (driven or grows or scene.branches or scene.fluids or scene.motions or scene.contacts or scene.crossings)


def undamped(scene: fu.Scene) -> fu.Scene:
    """Return a scene without damping and without loads."""
    return scene.with_parts(_undamped(part) for part in scene.parts() if not isinstance(part, Load))


def _undamped(part: Part) -> Part:
    still = {"damping_time": 0.0, "mass_damping": 0.0}
    if isinstance(part, Cable) and part.pieces is not None:
        return part.remade({"pieces": [each.remade({"material": each.material.remade(still)}) for each in part.pieces]})
    if isinstance(part, Cable):
        return part.remade({"material": part.material.remade(still)})
    return part.remade({"damping": 0.0}) if isinstance(part, PointForce) else part.as_made()


def lowest_modes(scene: fu.Scene, rest: Equilibrium, n: int) -> Modes:
    """Return n modes about an equilibrium, or all modes of a scene with fewer degrees of freedom."""
    try:
        return scene.modes(n, about=rest)
    except fu.SceneError as error:
        there = re.search(r"has (\d+) degrees of freedom", str(error))
        assert there is not None, error
        return scene.modes(int(there[1]), about=rest)


def displaced(scene: fu.Scene, rest: Equilibrium, modes: Modes, mode: int, size: float) -> dict[str, np.ndarray]:
    """Return the state at rest displaced by a mode of a given largest displacement in m, without velocities.

    A slope counts with a tenth of the length of its cable: a mode may have all nodes of the mesh among its own.
    """
    slopes = [np.linalg.norm(modes[f"{name}.nodal_vectors"][mode][:, 1:], axis=-1).max() * cable.length / 10
              for name, cable in scene.cables.items() if f"{name}.nodal_vectors" in modes.keys()]
    size = size / max([1.0, *slopes])
    state = {name: np.array(rest[name]) for name in rest.keys() if name.endswith(STATE)}
    for name in modes.keys():
        part, quantity = name.split(".")
        shape = size * modes[name][mode]
        if quantity == "rotation":
            state[f"{part}.orientation"] = product(state[f"{part}.orientation"], turned_by(shape))
        else:
            state[f"{part}.{'position' if quantity == 'displacement' else quantity}"] += shape
    for name in scene.cables:
        state[f"{name}.nodal_velocity"] = 0.0 * state[f"{name}.nodal_vectors"]
    for name in scene.bodies:
        state[f"{name}.velocity"] = state[f"{name}.angular_velocity"] = np.zeros(3)
    return state
