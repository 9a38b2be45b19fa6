"""Thin beams whose elements are too long for their torsion.

Where an element bends by an angle a under the tension N, a twist between its nodes turns the half-way frame away from
the chord, which lets the element lengthen: N (a L)² times a small number, against the torsional stiffness GJ. In beams
far thinner than their elements are long, sections then spin though nothing twists them: an instability of the mesh,
which ends as elements become shorter.
"""

from __future__ import annotations

import numpy as np

from ...model.model import CableModel
from ...model.unknowns import by_unknowns
from .stability import lowest_direction
from .static_problem import StaticProblem

AT_REST = 0.1
"""Of how sections turn: how the axis turns at most where sections spin about it."""
MOST = 20.0
"""Of N (a L)²/GJ, up to which sections rest: ropes of 0.1 to 10 mm over 100 m do so at 19 to 49, and spin at 120."""


def spinning(problem: StaticProblem) -> str:
    """Return, as messages end, of which cable sections spin in the direction of the least stiffness, and the elements
    to take; empty where it is another direction.
    """
    model, direction, q = problem.model, lowest_direction(problem), problem.engine.state()["q"]
    for cable in model.cables:
        if not {"r_y", "r_z"} <= set(cable.vectors):
            continue
        dofs = by_unknowns(model.unknown_of_dof[cable.coordinates], model.combinations, len(direction))
        axis, turned = _turns(cable, (dofs @ direction).reshape(cable.shape))
        longest = _longest(problem, cable, q[cable.coordinates].reshape(cable.shape))
        if turned > 0.0 and axis <= AT_REST * turned and longest < cable.mesh.lengths.max():
            return (f'; sections of cable "{cable.name}" spin in it while its axis rests: elements of '
                    f"{cable.mesh.lengths.max():.3g} m are too long for the torsion of so thin a beam, take elements "
                    f'of at most {longest:.2g} m, or element="cable12", which has no torsion')
    return ""


def _turns(cable: CableModel, moved: np.ndarray) -> tuple[float, float]:
    """Return how far the axis and the sections of a cable turn at most in a change of its nodal vectors."""
    def largest(name: str) -> float:
        return float(np.abs(moved[:, cable.vectors.index(name)]).max())

    return max(largest("r") / cable.mesh.lengths.min(), largest("r_x")), max(largest("r_y"), largest("r_z"))


def _longest(problem: StaticProblem, cable: CableModel, nodal: np.ndarray) -> float:
    """Return how long elements may be, m, by the tension and the angles of those that there are."""
    part = problem.scene.cables[cable.name]
    slope = nodal[:, cable.vectors.index("r_x")]
    stretch = np.linalg.norm(slope, axis=1)
    tangent = slope / stretch[:, None]
    angle = np.arccos(np.clip(np.einsum("ij,ij->i", tangent[1:], tangent[:-1]), -1.0, 1.0))
    section, material = part.section, part.material
    tension = material.youngs_modulus * section.area * ((stretch[1:] + stretch[:-1]) / 2 - 1.0)
    torsion = material.lame()[1] * section.torsion_constant
    lengths = cable.mesh.lengths
    ratio = float((tension * (angle * lengths) ** 2).max()) / torsion  # grows as the fourth power of the length
    return float(lengths.max()) * (MOST / ratio) ** 0.25 if ratio > 0.0 else np.inf
