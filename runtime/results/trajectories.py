"""Outputs of a run by name, as trajectories that do not depend on the mesh, and how far two runs are apart in them."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..errors import SceneError, near
from ..kernels.libraries import kernels_of
from ..parts.locations import node_of
from ..parts.scene_data import SceneData
from .quantities import QUANTITIES
from .run import Run

ENERGIES = ("energy.kinetic", "energy.elastic", "energy.potential")
PLACES = ("tip", "middle")


def default_outputs(scene: SceneData) -> list[str]:
    """Return where bodies and slides are, and of each cable the end, or its middle where the end is supported."""
    supported = {node_of(scene, support) for support in scene.supports}
    places = [f"{name}.{'middle' if (name, cable.elements) in supported else 'tip'}"
              for name, cable in scene.cables.items()]
    return [f"{name}.position" for name in scene.bodies] + [f"{name}.s" for name in scene.slides] + places


def check_output(scene: SceneData, name: str) -> None:
    """Raises SceneError where the scene gives no such output."""
    known = known_outputs(scene)
    if name not in known and _place(scene, name) is None:
        raise SceneError("bench", f'there is no output "{name}"', near(name, known)
                         + " or a place of a cable in m, such as " + f'"{next(iter(scene.cables), "wire")}@0.5"')


def known_outputs(scene: SceneData) -> list[str]:
    """Return the names of outputs, but for places of cables given by their arc-length."""
    parts: dict[str, Iterable[str]] = {"bodies": scene.bodies, "slides": scene.slides,
                                       "point_forces": scene.point_forces}
    results = [f"{name}.{quantity}" for group, named in parts.items() for name in named
               for quantity in QUANTITIES[group] if quantity not in ("orientation", "multiplier")]
    return results + [f"{name}.{place}" for name in scene.cables for place in PLACES] + list(ENERGIES)


def _place(scene: SceneData, name: str) -> tuple[str, float] | None:
    """Return the cable and arc-length of a place such as wire.tip or wire@0.5; None where it is none."""
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


ROUNDED = 1e-14
"""What rounding moves at rest, over the largest coordinate."""


def unit(scene: SceneData, name: str) -> str:
    """Return the unit of an output."""
    if name in ENERGIES:
        return "J"
    if _place(scene, name) is not None:
        return "m"
    quantity = name.rpartition(".")[2]
    return next(group[quantity].units for group in QUANTITIES.values() if quantity in group)


def trajectory(scene: SceneData, run: Run, name: str) -> np.ndarray:
    """Return (time, components): an output of a run of ``scene``."""
    if name in run:
        return run[name].reshape(len(run.time), -1)
    if (place := _place(scene, name)) is None:
        raise KeyError(name)
    cable, s = place
    described = scene.cables[cable]
    mesh = described.mesh
    element = int(mesh.element_at(s * (1 + 1e-12)))
    N = getattr(kernels_of(described.library), f"{described.element}_on_axis")(mesh.length(element),
                                                                              s - mesh.start(element))[0]
    vectors = run[f"{cable}.nodal_vectors"][:, element : element + 2]
    return np.einsum("k,tkd->td", N, vectors.reshape(len(vectors), len(N), 3))


def distance(found: np.ndarray, exact: np.ndarray) -> float:
    """Return the largest distance of two trajectories (..., components), over the output times, and points if any."""
    return float(np.linalg.norm(found - exact, axis=-1).max())


def largest_change(exact: np.ndarray) -> float:
    """Return what errors are relative to: the largest distance of a trajectory (time, ...) from its start."""
    return distance(exact, exact[:1])


def relative(scene: SceneData, found: dict[str, np.ndarray], exact: dict[str, np.ndarray]) -> float:
    """Return the largest of the outputs' errors, over the largest motion that an output of the same unit makes.

    Errors within rounding of the outputs are none. Others are infinite where the motion is rounding alone.
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
    """Return how much of a trajectory is rounding."""
    return ROUNDED * float(np.abs(motion).max(initial=0.0))
