"""The kinds of parts that a scene is made of; a further kind is one file beside this one and one entry here."""

from .cable import Cable
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

KINDS: tuple[type[Part], ...] = (Cable, Pin, Clamp, Motion, Tie, RigidBody, ModalBody, Joint, Slide, Force,
                                 DistributedForce, Moment, Spring, Fluid, Drag, Crossing, Event)
"""In the order in which they can be added: a slide needs its cable and its body."""

PARTS = {part.kind: part for part in KINDS}
"""The kinds by their names in scene files and in messages."""
