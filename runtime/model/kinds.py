"""The kinds of couplings of a model, in the order of the engine's sums: a new one has a line here.

What loops over couplings reads them here: the model, results of runs and of states of rest, the layout of these, and
what a change of a cable's length may leave alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from ..parts.contact import Contact
from ..parts.crossing import Crossing
from ..parts.drag import Drag
from ..parts.joint import Joint
from ..parts.load import Force
from ..parts.point_force import PointForce
from ..parts.scene_data import SceneData
from ..parts.slide import Slide
from .attachments import AttachmentBuilder
from .contacts import contact_model
from .coupling import CouplingModel
from .crossings import crossing_model
from .drags import drag_models
from .hard_contacts import hard_contact_models
from .joints import frame_joint_model, joint_model
from .loads import LoadBuilder
from .slides import slide_model


@dataclass(frozen=True)
class CouplingKind:
    """A kind of coupling: the name of the engine's type, the group of its parts, and what makes its models of a scene.

    has_state: a state of rest has unknowns of it, so that it fits scenes alone with the same parts of the group.
    """

    name: str
    group: str
    models: Callable[[SceneData, AttachmentBuilder, LoadBuilder], Iterable[CouplingModel]]
    has_state: bool = True


def _dead_loads(scene: SceneData, attachments: AttachmentBuilder, loads: LoadBuilder) -> Iterable[CouplingModel]:
    for load in scene.loads.values():
        loads.load(load)
    return loads.dead


def _turning_loads(scene: SceneData, attachments: AttachmentBuilder, loads: LoadBuilder) -> Iterable[CouplingModel]:
    return loads.turning


def _slides(scene: SceneData, attachments: AttachmentBuilder, loads: LoadBuilder) -> Iterator[CouplingModel]:
    return (slide_model(slide, scene, attachments, loads.signal) for slide in scene.slides.values())


def _joints(scene: SceneData, attachments: AttachmentBuilder, loads: LoadBuilder) -> Iterator[CouplingModel]:
    """Yield the joints: first those that keep a rider's axes to its cable, then those of the scene."""
    for k, slide in enumerate(scene.slides.values()):
        if slide.frame != "point":
            yield frame_joint_model(attachments, slide, k)
    for joint in scene.joints.values():
        yield joint_model(attachments, joint, loads.signal)


def _point_forces(scene: SceneData, attachments: AttachmentBuilder, loads: LoadBuilder) -> Iterator[CouplingModel]:
    return (loads.point_force(force) for force in scene.point_forces.values())


def _drags(scene: SceneData, attachments: AttachmentBuilder, loads: LoadBuilder) -> Iterator[CouplingModel]:
    return (model for drag in scene.drags.values() for model in drag_models(drag, scene, attachments, loads))


def _crossings(scene: SceneData, attachments: AttachmentBuilder, loads: LoadBuilder) -> Iterator[CouplingModel]:
    return (crossing_model(crossing, scene, attachments) for crossing in scene.crossings.values())


def _contacts(scene: SceneData, attachments: AttachmentBuilder, loads: LoadBuilder) -> Iterator[CouplingModel]:
    return (contact_model(contact, scene, attachments) for contact in scene.contacts.values() if not contact.is_hard)


def _hard_contacts(scene: SceneData, attachments: AttachmentBuilder, loads: LoadBuilder) -> Iterator[CouplingModel]:
    return (model for contact in scene.contacts.values() if contact.is_hard
            for model in hard_contact_models(contact, scene, attachments))


COUPLINGS = (
    CouplingKind("dead load", Force.group, _dead_loads, has_state=False),
    CouplingKind("load", Force.group, _turning_loads, has_state=False),
    CouplingKind("slide", Slide.group, _slides),
    CouplingKind("joint", Joint.group, _joints),
    CouplingKind("point_force", PointForce.group, _point_forces),
    CouplingKind("drag", Drag.group, _drags, has_state=False),
    CouplingKind("crossing", Crossing.group, _crossings),
    CouplingKind("contact", Contact.group, _contacts, has_state=False),
    CouplingKind("hard_contact", Contact.group, _hard_contacts, has_state=False),
)


def in_order(couplings: Iterable[CouplingModel]) -> list[CouplingModel]:
    """Return couplings in the order of their kinds, those of one kind in the order given."""
    order = {kind.name: k for k, kind in enumerate(COUPLINGS)}
    return sorted(couplings, key=lambda coupling: order[coupling.type])
