"""Outputs of a run by name, as trajectories independent of the mesh, and the distance of two runs in them."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..errors import SceneError, near
from ..parts.locations import node_of
from ..parts.scene_data import SceneData
from .quantities import QUANTITIES, STORED_ENERGIES
from .run import Run
from .shape_functions import on_axis

ENERGIES = tuple(f"energy.{name}" for name in STORED_ENERGIES)
PLACES = ("tip", "middle")
TRAJECTORIES = (("time",), ("time", "xyz"))
"""Dimensions of the results of ropes that do not depend on the mesh."""
ROUNDING_OF_POSITION = 1e-14
"""Rounding error of a trajectory over its largest coordinate."""


def default_outputs(scene: SceneData) -> list[str]:
    """Return the positions of bodies, slides and cable ends; of a supported end the middle of the cable.

    Without any, the speeds of ropes at their sheaves and drums.
    """
    supported = {node_of(scene, support) for support in scene.supports}
    places = [f"{name}.{'middle' if (name, cable.mesh.n_nodes - 1) in supported else 'tip'}"
              for name, cable in scene.cables.items()]
    found = [f"{name}.position" for name in scene.bodies] + [f"{name}.s" for name in scene.slides] + places
    return found or [f"{wheel.name}.material_speed" for rope in scene.ropes.values() for wheel in rope.wheels]


def check_output(scene: SceneData, name: str) -> None:
    """Raise SceneError if the scene has no such output."""
    known = known_outputs(scene)
    if name not in known and _place(scene, name) is None:
        raise SceneError("bench", f'there is no output "{name}"', near(name, known)
                         + " or a place of a cable in m, such as " + f'"{next(iter(scene.cables), "wire")}@0.5"')


def known_outputs(scene: SceneData) -> list[str]:
    """Return the names of outputs, without places of cables given by their arc-length."""
    parts: dict[str, Iterable[str]] = {"bodies": scene.bodies, "slides": scene.slides,
                                       "point_forces": scene.point_forces}
    results = [f"{name}.{quantity}" for group, named in parts.items() for name in named
               for quantity in QUANTITIES[group] if quantity not in ("orientation", "multiplier")]
    ropes = {rope.name: rope.results for rope in scene.ropes.values()}
    ropes |= {wheel.name: wheel.results for rope in scene.ropes.values() for wheel in rope.wheels}
    results += [f"{name}.{key}" for name, of in ropes.items() for key, each in of.items() if each.dims in TRAJECTORIES]
    return results + [f"{name}.{place}" for name in scene.cables for place in PLACES] + list(ENERGIES)


def _place(scene: SceneData, name: str) -> tuple[str, float] | None:
    """Return the cable and arc-length of a place such as wire.tip or wire@0.5; None for other names."""
    cable, _, place = name.rpartition(".") if name.endswith(PLACES) else name.rpartition("@")
    if cable not in scene.cables:
        return None
    length = scene.cables[cable].length
    if place in PLACES:
        return cable, length if place == "tip" else length / 2
    try:
        s = float(place)
    except ValueError:
        return None
    return (cable, s) if 0 <= s <= length else None


def unit(scene: SceneData, name: str) -> str:
    """Return the unit of an output."""
    if name in ENERGIES:
        return "J"
    if _place(scene, name) is not None:
        return "m"
    quantity = name.rpartition(".")[2]
    return next(group[quantity].units for group in QUANTITIES.values() if quantity in group)


def trajectory(scene: SceneData, run: Run, name: str) -> np.ndarray:
    """Return an output (time, components) of a run of ``scene``."""
    if name in run:
        return run[name].reshape(len(run.time), -1)
    if (place := _place(scene, name)) is None:
        raise KeyError(name)
    cable, s = place
    mesh = scene.cables[cable].mesh
    element = int(mesh.element_at(s * (1 + 1e-12)))
    N = on_axis(scene.cables[cable], element, s - mesh.start(element))[0]
    first = int(mesh.first_node(element))
    vectors = run[f"{cable}.nodal_vectors"][:, first : first + 2]
    return np.asarray(np.einsum("k,tkd->td", N, vectors.reshape(len(vectors), len(N), 3)))


def distance(found: np.ndarray, exact: np.ndarray) -> float:
    """Return the largest distance of two trajectories (..., components) over times and points."""
    return float(np.linalg.norm(found - exact, axis=-1).max())


def largest_change(exact: np.ndarray) -> float:
    """Return the largest distance of a trajectory (time, ...) from its start, the scale of its errors."""
    return distance(exact, exact[:1])


def relative(scene: SceneData, found: dict[str, np.ndarray], exact: dict[str, np.ndarray]) -> float:
    """Return the largest error of the outputs, relative to the largest motion of the outputs of the same unit.

    Errors within rounding are zero. Others are infinite if the motion is within rounding.
    """
    largest: dict[str, float] = {}
    for name, motion in exact.items():
        change = largest_change(motion)
        moved = change if change > _rounding(motion) else 0.0
        largest[unit(scene, name)] = max(largest.get(unit(scene, name), 0.0), moved)
    errors = {name: distance(found[name], exact[name]) for name in exact}
    return max((error / largest[unit(scene, name)] if largest[unit(scene, name)] else np.inf
                for name, error in errors.items() if error > _rounding(exact[name])), default=0.0)


def _rounding(motion: np.ndarray) -> float:
    """Return the rounding error of a trajectory."""
    return ROUNDING_OF_POSITION * float(np.abs(motion).max(initial=0.0))
