"""Trials of integrators that scenes of one shape share: what lost with the first one is not tried with the others."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..parts.scene_data import SceneData

if TYPE_CHECKING:  # bring SciPy
    from ..integrators import Integrator
    from .integrator_choice import Rival

ALIKE = 2.0
"""Times the cost that the rival has in the first scene: what costs more is tried anew."""


@dataclass
class SharedTrials:
    """The outcome of the first scene's trial.

    Each scene chooses by its own numbers. Where that comes to the trial that the first scene had, and the first one's
    was lost, the rival begins; its cost is known beforehand. A trial that is won costs nothing, and is not left out.

    lost: its shape, the names of both methods, and the rival's cost; None where none was lost. is_open: whether the
    first scene is still to come or under way, whose trial is the one that counts.
    """

    lost: tuple[tuple, str, str, float] | None = None
    is_open: bool = True

    def of(self, scene: SceneData, method: Integrator, reason: str,
           rival: Rival | None) -> tuple[Integrator, str, Rival | None]:
        """Return the choice for a scene, as `choose` does, of which this is the choice by its own numbers."""
        if self.lost is None or rival is None:
            return method, reason, rival
        shape, tried, better, cost = self.lost
        if (method.name, rival.method.name) != (tried, better) or rival.cost > ALIKE * cost or shape_of(scene) != shape:
            return method, reason, rival
        return rival.method, f"{reason}; {method.name} on trial lost in the first scene, which has the same shape", None

    def note(self, scene: SceneData, method: Integrator, rival: Rival) -> None:
        """Take note that a trial of a method was lost, if it is the first scene's."""
        if self.is_open:
            self.lost = shape_of(scene), method.name, rival.method.name, rival.cost


def shape_of(scene: SceneData) -> tuple:
    """Return what scenes of one shape have in common: their parts by kind and name, elements and laws; all but numbers.
    """
    return scene.dim, *((type(part), part.given_name) for part in scene.parts()), *(
        (cable.element, cable.elements, cable.law, cable.library) for cable in scene.cables.values())
