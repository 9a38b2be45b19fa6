"""What a scene is made of: data, checked by themselves, without kernels and without simulation."""

from .cable import EXACT, Cable
from .event import Event
from .joint import Joint
from .kinds import KINDS, PARTS
from .load import DistributedForce, Force, Moment
from .modal_body import ModalBody
from .rigid_body import RigidBody
from .scene_data import SceneData
from .slide import Slide
from .spring import Spring
from .support import Clamp, Motion, Pin, Tie

__all__ = [
    "EXACT",
    "KINDS",
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
    "SceneData",
    "Slide",
    "Spring",
    "Tie",
]
