"""What a scene is made of, in the order in which it can be added: a slide needs its cable and its body."""

from funicular.bodies import RigidBody
from funicular.cables import EXACT, Cable
from funicular.events import Event
from funicular.joints import Joint
from funicular.loads import DistributedForce, Force, Moment
from funicular.modal_bodies import ModalBody
from funicular.slides import Slide
from funicular.springs import Spring
from funicular.supports import Clamp, Motion, Pin, Tie

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
