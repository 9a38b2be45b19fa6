"""How other axes change each quantity of results: read from the results of all kinds of parts, by name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from .kinds import KINDS
from .quantity import DIRECTION, IN_BODY_AXES, NODAL_VECTORS, POINT, UNCHANGED, Quantity

BESIDE_PARTS = {"nodal_vectors": NODAL_VECTORS, "nodal_velocity": DIRECTION, "nodes": POINT,
                "modal_coordinates": UNCHANGED, "modal_velocities": UNCHANGED, "displacement": DIRECTION,
                "rotation": IN_BODY_AXES}
"""Quantities that no part lists among its results: nodal vectors of cables, nodes of modal bodies, shapes of modes."""


def turning_by_name(results: Iterable[Mapping[str, Quantity]]) -> dict[str, str]:
    """Return of each quantity how other axes change it. Raises ValueError for one name of two that turn differently."""
    found = dict(BESIDE_PARTS)
    for each in results:
        for name, quantity in each.items():
            if found.setdefault(name, quantity.turns) != quantity.turns:
                raise ValueError(f'results "{name}" turn as "{found[name]}" and as "{quantity.turns}"; rename one')
    return found


TURNING = turning_by_name(kind.results for kind in KINDS)
