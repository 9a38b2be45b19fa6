"""Motions of cosseratbench's scenarios: positions and directors of all rods at even times."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..results.run import Run
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

    Raises NotImplementedError for what cannot be modelled, ConvergenceError where a run ends early.
    """
    positions, directors = [], []
    for rod in scenario.rods:
        made = scene_of(scenario, [rod], elements, choices.rods_of(scenario))
        run = _run(made, scenario, frames, choices)
        positions.append(run["rod0.position"])
        directors.append(_directors(rod, made, run, elements))
    return positions, directors


def _run(made: RodScene, scenario: Scenario, frames: int, choices: Choices) -> Run:
    return made.scene.run(duration=scenario.duration, output_step=scenario.duration / (frames - 1),
                          tol=choices.tol_of(scenario), integrator=INTEGRATOR,
                          absolute_tol=LEAST_ERROR * min(rod.length for rod in scenario.rods),
                          initial=made.start or None)


def _directors(rod: Rod, made: RodScene, run: Run, elements: int) -> np.ndarray:
    """Return the directors (frames, elements, 3) of the only rod of a scene."""
    positions, names = run["rod0.position"], made.cables[0].kind_of_element.nodal_vectors
    if "r_y" in names:
        return of_sections(run["rod0.nodal_vectors"][:, :, names.index("r_y")], positions)
    clamped = [end for end, (_, condition, _) in zip((0, -1), ends_of(rod), strict=True) if condition == CLAMPED]
    return untwisted(rod.directors(elements), positions, clamped[0] if clamped else None)
