"""The kinds of parts of a scene. A further kind is one file beside this one and one entry here."""

from collections.abc import Iterable, Mapping

from .cable import Cable
from .contact import Contact
from .crossing import Crossing
from .drag import Drag
from .event import Event
from .fluid import Fluid
from .joint import Joint
from .load import DistributedForce, Force, Moment
from .modal_body import ModalBody
from .part import Part
from .quantity import IN_BODY_AXES, NODAL_VECTORS, UNCHANGED, Quantity
from .rigid_body import RigidBody
from .schemas import DIRECTION, POINT
from .slide import Slide
from .spring import Spring
from .support import Clamp, Motion, Pin, Tie
from .surface import Surface

KINDS: tuple[type[Part], ...] = (Cable, Pin, Clamp, Motion, Tie, RigidBody, ModalBody, Joint, Slide, Force,
                                 DistributedForce, Moment, Spring, Fluid, Drag, Crossing, Surface, Contact, Event)
"""In an order in which they can be added: a slide needs its cable and its body."""


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


TURNING = turning_by_name(kind.results for kind in KINDS)
"""How other axes change each quantity of results, by name."""
