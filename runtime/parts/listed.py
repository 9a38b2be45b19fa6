"""The kinds of parts of a scene, one line each, in an order in which they can be added: a slide needs its cable.

The package exports them. A further kind is one file beside this one and one line here.
"""
# ruff: noqa: I001  the order of the lines is that of the kinds

from .cable import Cable as Cable
from .point_mass import PointMass as PointMass
from .support import Pin as Pin
from .support import Clamp as Clamp
from .support import Motion as Motion
from .support import Tie as Tie
from .rigid_body import RigidBody as RigidBody
from .modal_body import ModalBody as ModalBody
from .rope import Rope as Rope
from .joint import Joint as Joint
from .slide import Slide as Slide
from .load import Force as Force
from .load import DistributedForce as DistributedForce
from .load import Moment as Moment
from .spring import Spring as Spring
from .fluid import Fluid as Fluid
from .drag import Drag as Drag
from .ice import Ice as Ice
from .working_curve import WorkingCurve as WorkingCurve
from .branch import Relaxation as Relaxation
from .branch import WireFriction as WireFriction
from .crossing import Crossing as Crossing
from .surface import Surface as Surface
from .contact import Contact as Contact
from .event import Event as Event
