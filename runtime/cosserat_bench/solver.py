"""The solver that cosseratbench finds through its entry point; this module alone needs that package."""

from __future__ import annotations

from importlib.metadata import version
from typing import Any

import numpy as np
from cosseratbench.scenario import Scenario
from cosseratbench.solver import Capability, Diverged
from cosseratbench.trajectory import Trajectory

from ..errors import ConvergenceError
from .contacts import near
from .motion import INTEGRATOR, Choices, moved
from .rods import element_of


class FunicularSolver:
    """Rods as cables, or as beams where torsion acts: of absolute nodal coordinates, with implicit steps by tolerance.

    tol: of the run, by default 1e-3 where a state of rest is the result and else 1e-4; time_step_scale: a factor of its
    steps; bending: False for rods without torsion that do not resist bending, as in references of perfectly flexible
    cables.
    """

    name = "funicular"
    backend_version = version("funicular")
    capabilities = frozenset({Capability.STRETCH, Capability.ROD_CONTACT, Capability.CYLINDER_CONTACT,
                              Capability.PLANE_CONTACT})

    def __init__(self, time_step_scale: float = 1.0, tol: float | None = None, bending: bool = True) -> None:
        self.choices = Choices(tol=tol, time_step_scale=time_step_scale, bending=bending)

    def settings(self, scenario: Scenario, *, n_elements: int, n_frames: int) -> dict[str, Any]:
        """Return the numerical choices for a scenario, as values of JSON."""
        alone = not near(scenario)
        return {
            "integrator": INTEGRATOR,
            "tolerance": self.choices.tol_of(scenario),
            "damping_rate": self.choices.damping_rate(scenario),
            "elements": sorted({element_of(scenario, rod, alone=alone) for rod in scenario.rods}),
        }

    def run(self, scenario: Scenario, *, n_elements: int, n_frames: int) -> Trajectory:
        """Return the motion of all rods. Raises NotImplementedError for features that are not modelled, Diverged."""
        try:
            positions, directors = moved(scenario, n_elements, n_frames, self.choices)
        except ConvergenceError as error:
            raise Diverged(str(error), time=float(error.run["time"][-1])) from error
        return Trajectory(np.linspace(0.0, scenario.duration, n_frames), tuple(positions), tuple(directors))
