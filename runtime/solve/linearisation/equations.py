"""Linear equations of motion over the coordinates of a state of rest, from the engine's tangents.

    M x'' + D x' + K x + F' f + r u = 0,    C x + g u = 0

x are the unknowns that are coordinates, those of driven slides included; f the forces of constraints, with columns F';
forces by laws are eliminated. Friction that sticks holds its coordinate by one more row of C.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csc_array, csr_array, vstack

from ...model.model import Model
from ...model.unknowns import by_unknowns
from ..linear.condensation import independent
from ..statics.static_problem import StaticState


@dataclass(frozen=True, eq=False)
class Equations:
    """Matrices over the coordinates, see the module.

    kept, forces, laws: numbers among the unknowns of the coordinates, of the forces of constraints, and of forces by
    laws. M, D, K (coordinates, coordinates); C (constraints, coordinates); columns (coordinates, forces) of F';
    law_stiffness, law_damping (laws, coordinates): forces by laws are minus these times x and x'.
    """

    static: StaticState
    kept: np.ndarray
    forces: np.ndarray
    laws: np.ndarray
    M: csc_array
    D: csc_array
    K: csc_array
    C: csc_array
    columns: csc_array
    by_laws: csr_array
    law_stiffness: csr_array
    law_damping: csr_array

    @property
    def model(self) -> Model:
        """Return the model of the static state."""
        return self.static.model

    @cached_property
    def dofs(self) -> csr_array:
        """Return T (n_dof, coordinates): dofs = T x and prescribed values."""
        model = self.model
        n = model.n_band + model.n_border_dof
        of_unknowns = by_unknowns(model.unknown_of_dof, model.combinations, n)
        return csr_array((of_unknowns.data, of_unknowns.indices, of_unknowns.indptr),
                         shape=(model.n_dof, len(self.kept)))

    def over_coordinates(self, residual: np.ndarray) -> np.ndarray:
        """Return a change of the residual (unknowns, k) over the coordinates, with forces by laws eliminated."""
        return np.asarray(residual[self.kept] - self.by_laws @ residual[self.laws])


def equations(static: StaticState, held: csr_array | None = None) -> Equations:
    """Return the equations about the present state; held (rows, coordinates): rows of coordinates that stick."""
    engine, model = static.engine, static.model
    full = engine.matrix(0.0, 0.0, 1.0).tocsr()
    damping = csr_array(engine.matrix(0.0, 1.0, 1.0) - full)
    n = model.n_band + model.n_border_dof
    own = [n + coupling.unknown + k for coupling in model.couplings for k in range(coupling.n_coordinates)]
    driven = np.array([n + coupling.unknown + k for coupling in model.couplings if coupling.is_driven
                       for k in range(coupling.n_coordinates)], dtype=int)
    forces, laws = (np.array([n + k for coupling in model.couplings if coupling.follows_law == is_law
                              for k in coupling.force_unknowns], dtype=int) for is_law in (False, True))
    kept = np.concatenate([np.arange(n), np.array(own, dtype=int)])
    of_contacts = {n + k for contact in model.hard_contacts for k in contact.force_unknowns}
    constraints = np.concatenate([forces, driven])
    rows = full[constraints][:, kept]
    if held is not None:
        rows = csr_array(vstack([rows, held]))
    C = independent(rows, [row for row, k in enumerate(constraints) if k in of_contacts])
    by_laws = csr_array(full[kept][:, laws])
    law_stiffness, law_damping = csr_array(full[laws][:, kept]), csr_array(damping[laws][:, kept])
    equilibrium = np.isin(kept, driven, invert=True).astype(float)[:, None]  # the row of a driven s is its constraint
    K = csr_array(full[kept][:, kept] - by_laws @ law_stiffness).multiply(equilibrium)
    D = csr_array(damping[kept][:, kept] - by_laws @ law_damping).multiply(equilibrium)
    M = engine.matrix(1.0, 0.0, 0.0).tocsr()[:n][:, :n].tocsc()
    M = csc_array((M.data, M.indices, np.append(M.indptr, np.full(len(own), M.indptr[-1]))),
                  shape=(len(kept), len(kept)))
    columns = csc_array(csr_array(full[kept][:, forces]).multiply(equilibrium))
    return Equations(static, kept, forces, laws, M, csc_array(D), csc_array(K), csc_array(C), columns, by_laws,
                     law_stiffness, law_damping)
