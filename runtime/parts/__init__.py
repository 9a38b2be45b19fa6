"""What a scene is made of, in the order in which it can be added: a slide needs its cable and its body."""

from .cable import EXACT, Cable
from .event import Event
from .joint import Joint
from .load import DistributedForce, Force, Moment
from .modal_body import ModalBody
from .rigid_body import RigidBody
from .slide import Slide
from .spring import Spring
from .support import Clamp, Motion, Pin, Tie

KINDS = (Cable, Pin, Clamp, Motion, Tie, RigidBody, ModalBody, Joint, Slide, Force, DistributedForce,
         Moment, Spring, Event)

PARTS = {part.kind: part for part in KINDS}
"""The kinds of parts by their names in scene files and in messages."""

__all__ = [
         "EXACT",
         "PARTS",
         "Cable",
         "Clamp",
         "DistributedForce",
         "Event",
         "Force",
         "Joint",
         "ModalBody",
         "Moment",
         "Motion",
         "Pin",
         "RigidBody",
         "Slide",
         "Spring",
         "Tie",
]
