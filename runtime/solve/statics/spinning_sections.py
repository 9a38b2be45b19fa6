"""Sections of a thin beam that spin in the direction of the least stiffness; see `notes.spinning_sections`."""

from __future__ import annotations

import numpy as np

from ...model.model import CableModel
from ...model.unknowns import by_unknowns
from ..notes.spinning_sections import has_sections, stable_length, torsion_ratio
from .stability import lowest_direction
from .static_problem import StaticProblem

MAX_AXIS_TURN_RATIO = 0.1
"""Upper bound of the turn of the axis over the turn of the sections that spin about it."""


def spinning(problem: StaticProblem) -> str:
    """Return the end of a message: the cable whose sections spin in the direction of the least stiffness, and the
    elements to take; empty for another direction.
    """
    model, direction, q = problem.model, lowest_direction(problem), problem.engine.state()["q"]
    for cable in filter(has_sections, model.cables):
        dofs = by_unknowns(model.unknown_of_dof[cable.coordinates], model.combinations, len(direction))
        axis, turned = _turns(cable, (dofs @ direction).reshape(cable.shape))
        part, nodal = problem.scene.cables[cable.name], cable.nodal(q)
        longest = stable_length(cable, float(torsion_ratio(cable, part, nodal)))
        if turned > 0.0 and axis <= MAX_AXIS_TURN_RATIO * turned and longest < cable.mesh.lengths.max():
            return (f'; sections of cable "{cable.name}" spin in it while its axis rests: elements of '
                    f"{cable.mesh.lengths.max():.3g} m are too long for the torsion of so thin a beam, take elements "
                    f'of at most {longest:.2g} m, or element="cable12", which has no torsion')
    return ""


def _turns(cable: CableModel, moved: np.ndarray) -> tuple[float, float]:
    """Return the largest turns of the axis and of the sections of a cable in a change of its nodal vectors."""
    def largest(name: str) -> float:
        return float(np.abs(moved[:, cable.vectors.index(name)]).max())

    return max(largest("r") / cable.mesh.lengths.min(), largest("r_x")), max(largest("r_y"), largest("r_z"))
