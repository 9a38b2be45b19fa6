"""A start for the search for rest where supports have moved from where they are drawn: cables go with them.

At the drawn state a motion moves nodes that it prescribes, and no others. A node that goes past its neighbour so turns
the element between them back on itself, where Newton's method may leave it.
"""

from __future__ import annotations

import numpy as np

from ...model.model import Model


def with_moved_supports(model: Model, begin: dict) -> dict:
    """Return a state, drawn but for what motions prescribe, with each cable's nodes moved as its prescribed ones are,
    and between these by what lies on the line along the cable.
    """
    if not model.motions:
        return begin
    q = begin["q"].copy()
    end = model.cables[-1].coordinates.stop
    free = model.unknown_of_dof[:end] != -1
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
