"""Motions of cosseratbench's scenarios: positions and directors of all rods at even times."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from ..errors import FunicularWarning
from ..parts.cable import Cable
from ..results.run import Run
from .contacts import beyond_a_cylinder, cross, line_of, may_meet, near, overlapping, passes_into_itself, side_by_side
from .directors import of_sections, untwisted
from .rods import CLAMPED, RodOptions, RodScene, ends_of, scene_of

if TYPE_CHECKING:
    from cosseratbench.scenario import Rod, Scenario

INTEGRATOR = "radau"
"""Rods are stiff, and radau damps the vibrations that its steps do not follow."""

TO_REST, IN_MOTION = 1e-3, 1e-4
"""Tolerances of runs: where a state of rest is the result, and where the motion is."""

LEAST_ERROR = 1e-7
"""Error allowed beside the tolerance, in lengths of the shortest rod."""

DAMPING_RATIO = 0.95
"""Of the slowest vibration on the way to rest: it comes to within 1e-4 of rest, and stays there, sooner than with
critical damping."""


@dataclass(frozen=True)
class Choices:
    """Numerical choices: the tolerance (None: `TO_REST` or `IN_MOTION`), a factor of the steps that follow from it, and
    whether rods resist bending.
    """

    tol: float | None = None
    time_step_scale: float = 1.0
    bending: bool = True

    def tol_of(self, scenario: Scenario) -> float:
        """Return the tolerance of a run. The error that radau estimates grows with the fourth power of the step."""
        usual = TO_REST if scenario.quasi_static else IN_MOTION
        return (usual if self.tol is None else self.tol) * self.time_step_scale**4

    def rods_of(self, scenario: Scenario) -> RodOptions:
        """Return what is chosen of the rods. On the way to rest they are damped in proportion to mass."""
        rate = 2 * DAMPING_RATIO * scenario.slowest_frequency() if scenario.quasi_static else 0.0
        return RodOptions(damping_rate=rate, bending=self.bending)


def moved(scenario: Scenario, elements: int, frames: int,
          choices: Choices) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Return of each rod positions (frames, nodes, 3) in m and directors (frames, elements, 3).

    Rods that touch move together, the others each by itself: first those that start close to each other, then again
    with those that may have met. What is left out of that is warned of. Raises NotImplementedError for
    what cannot be modelled, ConvergenceError where a run ends early.
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
    _warn_of_what_is_left_out(scenario, lines, found)
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
    """Return the motion of each rod, where pairs of rods touch."""
    count = len(scenario.rods)
    touching = np.zeros((count, count))
    for pair in pairs:
        touching[pair] = 1
    groups, group_of = connected_components(csr_array(touching), directed=False)
    motions: list = [None] * count
    for group in range(groups):
        members = np.flatnonzero(group_of == group).tolist()
        rods = [scenario.rods[k] for k in members]
        made = scene_of(scenario, rods, elements, choices.rods_of(scenario))
        of = {k: (rod, cable) for k, rod, cable in zip(members, rods, made.cables, strict=True)}
        for i, j in sorted(pairs):
            if i in of:
                cross(made.scene, scenario, of[i], of[j])
        run = _run(made, scenario, frames, choices)
        for k, (rod, cable) in of.items():
            motions[k] = _motion_of(rod, cable, run, elements)
    return motions


def _run(made: RodScene, scenario: Scenario, frames: int, choices: Choices) -> Run:
    return made.scene.run(duration=scenario.duration, output_step=scenario.duration / (frames - 1),
                          tol=choices.tol_of(scenario), integrator=INTEGRATOR,
                          absolute_tol=LEAST_ERROR * min(rod.length for rod in scenario.rods),
                          initial=made.start or None)


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


def _warn_of_what_is_left_out(scenario: Scenario, lines: list[np.ndarray],
                              found: dict[tuple[int, int], int]) -> None:
    """Say which rods pass into themselves or, of those that started apart, into each other, and from when on."""
    passing = [(f"rods {i} and {j} pass into each other", frame) for (i, j), frame in found.items()]
    passing += [(f"rod {k} passes into itself", frame)
                for k, (rod, line) in enumerate(zip(scenario.rods, lines, strict=True))
                if (frame := passes_into_itself(rod, line)) is not None]
    for what, frame in passing:
        time = scenario.duration * frame / (len(lines[0]) - 1)
        warnings.warn(f"{what} from t = {time:.4g} s on: this contact is not modelled, and from there on the motion is "
                      "not that of the scenario", FunicularWarning, stacklevel=4)
