"""A start for the search for rest where supports have moved from where they are drawn: cables go with them.

At the drawn state a motion moves nodes that it prescribes, and no others. A node that goes past its neighbour so turns
the element between them back on itself, where Newton's method may leave it.
"""

from __future__ import annotations

import numpy as np

from .static_problem import StaticState


def with_moved_supports(problem: StaticState, begin: dict) -> dict | None:
    """Return a state, drawn but for what motions prescribe, with each cable's nodes moved as its prescribed ones are,
    and between these by what lies on the line along the cable; None where nothing is moved, or it is another state.
    """
    model, q = problem.model, begin["q"].copy()
    end = model.cables[-1].coordinates.stop if model.cables else 0
    free = model.unknown_of_dof[:end] != -1
    if np.array_equal(q[:end], model.q[:end]) or not np.array_equal(q[:end][free], model.q[:end][free]):
        return None
    for cable in model.cables:
        place, s = cable.vectors.index("r"), cable.mesh.node_s
        fixed = ~free[cable.coordinates].reshape(cable.shape)[:, place]
        r = q[cable.coordinates].reshape(cable.shape)[:, place]
        moved = r - model.q[cable.coordinates].reshape(cable.shape)[:, place]
        for axis in range(cable.shape[2]):
            at = fixed[:, axis]
            if at.any():
                r[~at, axis] += np.interp(s, s[at], moved[at, axis])[~at]
    return begin | {"q": q}
