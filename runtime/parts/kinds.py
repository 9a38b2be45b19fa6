"""The kinds of parts that a scene is made of; a further kind is one file beside this one and one entry here."""

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
from .rigid_body import RigidBody
from .slide import Slide
from .spring import Spring
from .support import Clamp, Motion, Pin, Tie
from .surface import Surface

KINDS: tuple[type[Part], ...] = (Cable, Pin, Clamp, Motion, Tie, RigidBody, ModalBody, Joint, Slide, Force,
                                 DistributedForce, Moment, Spring, Fluid, Drag, Crossing, Surface, Contact, Event)
"""In the order in which they can be added: a slide needs its cable and its body."""


def plural_of(name: str) -> str:
    """Return the plural of a kind's name."""
    return name[:-1] + "ies" if name.endswith("y") else name + "s"


PARTS = {part.kind: part for part in KINDS}
"""The kinds by their names in scene files and in messages."""
