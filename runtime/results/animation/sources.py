"""The frames of a run, of a scene as drawn, of states of rest and of a mode."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial

import numpy as np

from ...base.rotations import product, rotate, turned_by
from ...model.cables import arrays_of
from ...parts.event import first_times
from ...parts.modal_body import ModalBody
from ...parts.rigid_body import RigidBody
from ...parts.scene_data import SceneData
from ...solve.modes.modes import Modes
from ...solve.statics.rest_state import RestState
from ..recorded import Recorded
from ..section_forces.balance import Cuts
from ..section_forces.balance_limits import known_method
from ..section_forces.components import components
from ..section_forces.forces import at_start, constitutive, of_equilibrium, of_linear_model
from ..section_forces.forces import of_run as forces_of_run
from .frames import Frames, SectionForces, no_forces
from .ropes import ropes_as_drawn

MAX_BALANCED = 400_000
"""Sections over all instants; with more, forces are those of the elastic law."""


def is_balanced(instants: int, sections: int) -> bool:
    """Return whether the forces in a number of sections are computed by balance."""
    return instants * sections <= MAX_BALANCED


def drawn(scene: SceneData) -> dict[str, np.ndarray]:
    """Return nodal vectors of cables, lines of ropes, positions of bodies and slides by name, as the scene is drawn."""
    found: dict[str, np.ndarray] = {f"{name}.nodal_vectors": cable.nodal_vectors
                                    for name, cable in scene.cables.items()}
    for name, body in scene.bodies.items():
        position, orientation = body.frame
        found |= {f"{name}.position": position, f"{name}.orientation": orientation}
        if isinstance(body, ModalBody):
            found |= {f"{name}.modal_coordinates": np.zeros(body.shape.n),
                      f"{name}.nodes": position + rotate(orientation, body.shape.nodes)}
    found |= ropes_as_drawn(scene)
    return found | {f"{name}.s": np.array(slide.arc_length) for name, slide in scene.slides.items()}


def _frames(scene: SceneData, time: np.ndarray, found: Mapping[str, np.ndarray], load: np.ndarray,
            forces: SectionForces) -> Frames:
    """Return the frames with these arrays by name, (T, ...), displacements from the scene as drawn."""
    return Frames(scene, time, found.__getitem__, found.__contains__, drawn(scene).__getitem__, load, forces)


def _law(scene: SceneData, time: np.ndarray, value: Callable[[str], np.ndarray],
         start: Callable[[str], np.ndarray] | None = None) -> SectionForces:
    """Return the section forces by the elastic law at times (T,); value, start: nodal vectors by name, see `Instants`.
    """
    def forces(cable: str, s: np.ndarray) -> dict[str, np.ndarray]:
        part = scene.cables[cable]
        name = f"{cable}.nodal_vectors"
        cuts = Cuts(arrays_of(part).model(0), s[None], True)
        force, moment, axes, strain = constitutive(part, value(name), cuts, time,
                                                   None if start is None else start(name))
        return {"force": force, "moment": moment} | components(part, force, moment, axes, strain)

    return forces


def of_scene(scene: SceneData) -> Frames:
    """Return the one frame of a scene as it is drawn, with its loads and waves at the start."""
    found = {name: value[None] for name, value in drawn(scene).items()}
    frames = _frames(scene, np.zeros(1), found, np.ones(1), _law(scene, np.zeros(1), found.__getitem__))
    return replace(frames, moves=True)


def of_run(run: Recorded, numbers: np.ndarray) -> Frames:
    """Return the frames of a run at the output times with these numbers."""
    @cache
    def value(name: str) -> np.ndarray:
        return np.asarray(run[name][numbers])

    def forces(cable: str, s: np.ndarray) -> dict[str, np.ndarray]:
        if not is_balanced(len(numbers), len(s)) or known_method(run.scene, run.model, cable, False) != "balance":
            start = partial(at_start, run) if of_linear_model(run) else None
            return _law(run.scene, run.time[numbers], value, start)(cable, s)
        return forces_of_run(run, cable, s[None], numbers)

    return Frames(run.scene, run.time[numbers], value, run.__contains__, drawn(run.scene).__getitem__,
                  np.ones(len(numbers)), forces, moves=True, happened=first_times(run.report.get("events", ())))


def of_states(states: Sequence[RestState]) -> Frames:
    """Return a frame of each state of rest; the time is its number in the sequence."""
    scene, load = states[0].scene, np.array([state.load_fraction for state in states])

    def forces(cable: str, s: np.ndarray) -> dict[str, np.ndarray]:
        method = known_method(scene, states[0].model, cable, True)
        found = [of_equilibrium(state, cable, s[None], method=method) for state in states]
        return {key: np.concatenate([each[key] for each in found]) for key in found[0]}

    found = {name: np.stack([state[name] for state in states]) for name in states[0].keys()}
    return _frames(scene, np.arange(len(states), dtype=float), found, load, forces)


def of_mode(modes: Modes, number: int, scene: SceneData, about: Mapping[str, np.ndarray], amplitude: float,
            phase: np.ndarray) -> Frames:
    """Return the frames of a mode at phases (T,) in rad, its largest displacement ``amplitude`` in m.

    about: the state of equilibrium, by name. Rigid bodies rotate by finite angles, which keeps their shape; nodes of
    cables and modal bodies, and spans of ropes, move along straight lines.
    """
    factor = amplitude * np.cos(phase)
    found: dict[str, np.ndarray] = {}
    for name in scene.cables:
        key = f"{name}.nodal_vectors"
        found[key] = about[key] + np.multiply.outer(factor, modes[key][number])
    for name, rope in scene.ropes.items():
        moved = {f"{name}.position": f"{name}.displacement", f"{name}.s": f"{name}.s"}
        moved |= {f"{wheel.name}.angle": f"{wheel.name}.angle" for wheel in rope.wheels}
        found |= {key: about[key] + np.multiply.outer(factor, modes[shape][number] if shape in modes else 0 * at)
                  for key, shape in moved.items() if (at := about[key]) is not None}
        found |= {f"{sheave.name}.wrap_angle": np.broadcast_to(about[f"{sheave.name}.wrap_angle"], len(phase))
                  for sheave in rope.sheaves}
    for name, body in scene.bodies.items():
        found |= {f"{name}.{key}": value
                  for key, value in _vibrating(modes, number, name, body, about, factor).items()}
    frames = _frames(scene, phase, found, np.zeros(len(phase)), no_forces)
    return replace(frames, reference=about.__getitem__)


def _vibrating(modes: Modes, number: int, name: str, body: RigidBody | ModalBody, about: Mapping[str, np.ndarray],
               factor: np.ndarray) -> dict[str, np.ndarray]:
    """Return position, orientation, and of a modal body nodes and modal coordinates, at multiples (T,) of a mode."""
    position, orientation = about[f"{name}.position"], about[f"{name}.orientation"]
    moved, turn = modes[f"{name}.displacement"][number], modes[f"{name}.rotation"][number]
    turned = product(orientation, turned_by(np.multiply.outer(factor, turn)))
    if isinstance(body, RigidBody):  # the mode is that of the mass centre
        centre = position + rotate(orientation, body.centre) + np.multiply.outer(factor, moved)
        return {"position": centre - rotate(turned, body.centre), "orientation": turned}
    fields, position = body.shape, position + np.multiply.outer(factor, moved)
    back = orientation * np.array([1.0, -1.0, -1.0, -1.0])
    bent = fields.nodes + np.einsum("m,mnd->nd", about[f"{name}.modal_coordinates"], fields.modes)
    strained = rotate(back, modes[f"{name}.nodes"][number] - moved) - np.cross(turn, bent)
    eta = np.linalg.lstsq(fields.modes.reshape(fields.n, -1).T, strained.ravel(), rcond=None)[0]
    coordinates = about[f"{name}.modal_coordinates"] + np.multiply.outer(factor, eta)
    nodes = about[f"{name}.nodes"] + np.multiply.outer(factor, modes[f"{name}.nodes"][number])
    return {"position": position, "orientation": turned, "modal_coordinates": coordinates, "nodes": nodes}
