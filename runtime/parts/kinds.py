"""The kinds of parts of a scene by name, and how their results turn."""

from collections.abc import Iterable, Mapping

from . import listed
from .part import Part
from .quantity import IN_BODY_AXES, NODAL_VECTORS, UNCHANGED, Quantity
from .schemas import DIRECTION, POINT

KINDS: tuple[type[Part], ...] = tuple(each for each in vars(listed).values() if isinstance(each, type))
"""In the order of `parts/listed.py`."""


def plural_of(name: str) -> str:
    """Return the plural of a kind's name."""
    return name[:-1] + "ies" if name.endswith("y") else name + "s"


PARTS = {part.kind: part for part in KINDS}
"""The kinds by name in scene files and messages."""

BESIDE_PARTS = {"nodal_vectors": NODAL_VECTORS, "nodal_velocity": DIRECTION, "nodes": POINT,
                "modal_coordinates": UNCHANGED, "modal_velocities": UNCHANGED, "displacement": DIRECTION,
                "rotation": IN_BODY_AXES}
"""Quantities beside the results of parts: nodal vectors of cables, nodes of modal bodies, shapes of modes."""


def turning_by_name(results: Iterable[Mapping[str, Quantity]]) -> dict[str, str]:
    """Return how each quantity turns, by name. Raises ValueError where two of one name turn differently."""
    found = dict(BESIDE_PARTS)
    for each in results:
        for name, quantity in each.items():
            if found.setdefault(name, quantity.turns) != quantity.turns:
                raise ValueError(f'results "{name}" turn as "{found[name]}" and as "{quantity.turns}"; rename one')
    return found


TURNING = turning_by_name(part.results for kind in KINDS for part in (kind, *kind.parts_within))
"""How other axes change each quantity of results, by name."""
