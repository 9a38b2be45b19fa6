"""Cables that are softer along their axis than they are, for a while: what they weigh and how they bend stays."""

from __future__ import annotations

import numpy as np

from ...model.constants import constants
from ...parts.section_stiffness import section_stiffness
from .static_problem import StaticProblem

MIN_AXIAL_STIFFNESS_RATIO = 12.0
"""Lower bound of EA l²/EI of the shortest element: an element softer along its axis than in bending folds up."""


class Softening:
    """factor: that of EA at which a cable's own loads stretch it by about its length; None where nothing is softened.

    Cables are softened whose law takes EA and EI, that of all cable elements; beams have a section that resists.
    """

    def __init__(self, problem: StaticProblem):
        self.engine, self.cables = problem.engine, []
        positions = problem.weight == 1.0
        load = float(np.abs(problem.load_vector()[positions]).sum())
        for k, (model, cable) in enumerate(zip(problem.model.cables, problem.scene.cables.values(), strict=True)):
            S = section_stiffness(cable.stiffness_law, cable.section, cable.material, cable.dim)
            if S.shape not in ((2,), (3,)):  # EA, EI, and EA of the upper modes of an assumed strain
                continue
            least = max(load, MIN_AXIAL_STIFFNESS_RATIO * S[1] / float(model.mesh.lengths.min()) ** 2) / S[0]
            if least < 1.0:
                self.cables.append((k, cable, least))
        self.factor = min((least for *_, least in self.cables), default=None)

    def apply(self, factor: float) -> None:
        """Multiply EA by this factor, or by the least that a cable admits."""
        for k, cable, least in self.cables:
            self.engine.stiffen(k, constants(cable, max(factor, least)))
