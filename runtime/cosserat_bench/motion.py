"""Motions of cosseratbench's scenarios: positions and directors of all rods at even times."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from ..base.rotations import cross as cross_product
from ..errors import FunicularWarning
from ..parts.cable import Cable
from ..results.run import Run
from .contacts import (
    beyond_a_cylinder,
    cross,
    line_of,
    may_meet,
    near,
    overlapping,
    passes_into_itself,
    side_by_side,
    tangents_of,
)
from .rods import CLAMPED, ends_of, scene_of

if TYPE_CHECKING:
    from cosseratbench.scenario import Rod, Scenario

INTEGRATOR = "radau"
"""Rods are stiff, and radau damps the vibrations that its steps do not follow."""

REST_TOL, MOTION_TOL = 1e-3, 1e-4
"""Tolerances of runs whose result is a state of rest, and a motion."""

ABSOLUTE_TOL = 1e-7
"""Absolute tolerance, over the length of the shortest rod."""

DAMPING_RATIO = 0.95
"""Damping ratio of the slowest vibration on the way to rest: it remains within 1e-4 of rest sooner than with critical
damping."""


@dataclass(frozen=True)
class Choices:
    """Numerical choices: the tolerance (None: `REST_TOL` or `MOTION_TOL`), a factor of its steps, and whether rods
    resist bending.
    """

    tol: float | None = None
    time_step_scale: float = 1.0
    bending: bool = True

    def tol_of(self, scenario: Scenario) -> float:
        """Return the tolerance of a run. The error that radau estimates grows with the fourth power of the step."""
        usual = REST_TOL if scenario.quasi_static else MOTION_TOL
        return (usual if self.tol is None else self.tol) * self.time_step_scale**4

    @staticmethod
    def damping_rate(scenario: Scenario) -> float:
        """Return the rate of damping proportional to mass, in 1/s, on the way to rest, else 0."""
        return 2 * DAMPING_RATIO * scenario.slowest_frequency() if scenario.quasi_static else 0.0


def moved(scenario: Scenario, elements: int, frames: int,
          choices: Choices) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Return positions (frames, nodes, 3) in m and directors (frames, elements, 3) of each rod.

    Rods in contact are in one scene, the others each in its own: first those that start close to each other, then again
    with those that may have met. A warning reports contact that is left out. Raises NotImplementedError for features
    that cannot be modelled, ConvergenceError where a run ends early.
    """
    if scenario.self_contact and scenario.obstacles:
        raise NotImplementedError("contact of a rod with itself")
    close = near(scenario)
    pairs = {pair for pair in close if not _side_by_side(scenario, pair)}
    while True:
        motions = _motions(scenario, pairs, elements, frames, choices)
        lines = [line_of(each.vectors, each.names, rod) for each, rod in zip(motions, scenario.rods, strict=True)]
        more = {pair for pair in may_meet(scenario, lines) - pairs if not _side_by_side(scenario, pair)}
        if not more:
            break
        pairs |= more
    found = overlapping(scenario, lines)
    if (close | pairs) & set(found):
        raise NotImplementedError("contact of two rods at more than one point")
    if beyond_a_cylinder(scenario, lines):
        raise NotImplementedError("contact at the end of a cylinder")
    passing = [(f"rods {i} and {j} pass into each other", frame) for (i, j), frame in found.items()]
    passing += [(f"rod {k} passes into itself", frame)
                for k, (rod, line) in enumerate(zip(scenario.rods, lines, strict=True))
                if (frame := passes_into_itself(rod, line)) is not None]
    for what, frame in passing:
        time = scenario.duration * frame / (frames - 1)
        warnings.warn(f"{what} from t = {time:.4g} s on: this contact is not modelled, and from there on the motion is "
                      "not that of the scenario", FunicularWarning, stacklevel=3)
    return [each.positions for each in motions], [each.directors for each in motions]


def _side_by_side(scenario: Scenario, pair: tuple[int, int]) -> bool:
    return side_by_side(*(scenario.rods[k] for k in pair))


@dataclass(frozen=True)
class _RodMotion:
    """Positions (frames, nodes, 3), directors (frames, elements, 3) and nodal vectors (frames, nodes, vectors, 3)."""

    positions: np.ndarray
    directors: np.ndarray
    vectors: np.ndarray
    names: tuple[str, ...]


def _motions(scenario: Scenario, pairs: set[tuple[int, int]], elements: int, frames: int,
             choices: Choices) -> list[_RodMotion]:
    """Return the motion of each rod, with contact of pairs of rods."""
    count = len(scenario.rods)
    in_contact = np.zeros((count, count))
    for pair in pairs:
        in_contact[pair] = 1
    groups, group_of = connected_components(csr_array(in_contact), directed=False)
    motions: dict[int, _RodMotion] = {}
    for group in range(groups):
        members = np.flatnonzero(group_of == group).tolist()
        rods = [scenario.rods[k] for k in members]
        made = scene_of(scenario, rods, elements, choices.damping_rate(scenario), choices.bending)
        of = {k: (rod, cable) for k, rod, cable in zip(members, rods, made.cables, strict=True)}
        for i, j in sorted(pairs):
            if i in of:
                cross(made.scene, scenario, of[i], of[j])
        run = made.scene.run(duration=scenario.duration, output_step=scenario.duration / (frames - 1),
                             tol=choices.tol_of(scenario), integrator=INTEGRATOR,
                             absolute_tol=ABSOLUTE_TOL * min(rod.length for rod in scenario.rods),
                             initial=made.start or None)
        for k, (rod, cable) in of.items():
            motions[k] = _motion_of(rod, cable, run, elements)
    return [motions[k] for k in range(count)]


def _motion_of(rod: Rod, cable: Cable, run: Run, elements: int) -> _RodMotion:
    positions, names = run[f"{cable.name}.position"], tuple(cable.kind_of_element.nodal_vectors)
    vectors = run[f"{cable.name}.nodal_vectors"]
    if "r_y" in names:
        directors = of_sections(vectors[:, :, names.index("r_y")], positions)
    else:
        ends = zip((0, -1), ends_of(rod), strict=True)
        clamped = [element for element, (_, condition, _) in ends if condition == CLAMPED]
        directors = untwisted(rod.directors(elements), positions, clamped[0] if clamped else None)
    return _RodMotion(positions, directors, vectors, names)


def transported(directors: np.ndarray, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Return directions (..., 3) turned by the smallest rotation from unit tangents to others, none opposite."""
    axis = cross_product(before, after)
    cosine = np.sum(before * after, axis=-1, keepdims=True)
    along = np.sum(axis * directors, axis=-1, keepdims=True)
    return np.asarray(directors * cosine + cross_product(axis, directors) + axis * along / (1 + cosine))


def of_sections(heights: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """Return (frames, elements, 3): directors of beams, from their sections' heights (frames, nodes, 3)."""
    tangents = tangents_of(positions)
    middle = heights[:, :-1] + heights[:, 1:]
    across = middle - np.sum(middle * tangents, axis=-1, keepdims=True) * tangents
    return np.asarray(across / np.linalg.norm(across, axis=-1, keepdims=True))


def untwisted(first: np.ndarray, positions: np.ndarray, clamped: int | None) -> np.ndarray:
    """Return (frames, elements, 3): directors of a rod without twist, in frames with nodes at positions.

    Cables have no sections: their directors turn with the line and not about it (Bishop's frame), since a round rod
    without torsion does not twist. first: initial directors (elements, 3); clamped: the element at a clamp, 0 or -1,
    None without. An element at a clamp turns with its tangent since the start. Without a clamp the director of the
    first one turns with its tangent from frame to frame. The other elements follow along the rod.
    """
    tangents, turned = tangents_of(positions), np.empty((len(positions), *first.shape))
    order = range(len(first))[::-1 if clamped == -1 else 1]
    at = order[0]
    turned[0] = first
    if clamped is None:
        for frame in range(1, len(positions)):
            turned[frame, at] = transported(turned[frame - 1, at], tangents[frame - 1, at], tangents[frame, at])
    else:
        turned[1:, at] = transported(first[at], tangents[0, at], tangents[1:, at])
    for here, there in pairwise(order):
        turned[1:, there] = transported(turned[1:, here], tangents[1:, here], tangents[1:, there])
    return turned
