"""Limits of section forces by balance: the cables that a balance needs, and loads that results do not contain."""

from __future__ import annotations

from ...errors import SceneError
from ...model.branches import BranchModel
from ...model.contacts import ContactModel
from ...model.model import Model
from ...model.working_curves import WorkingCurveModel
from ...parts.scene_data import SceneData

REMEDY = 'take method="constitutive", which follows from the strains'


def tied_cables(scene: SceneData, model: Model, cable: int) -> list[int]:
    """Return the numbers of the cables that ties connect to one, itself included: their accelerations are coupled."""
    found, new = {model.cables[cable].name}, [model.cables[cable].name]
    while new:
        name = new.pop()
        for tie in scene.ties.values():
            pair = {tie.cable, tie.to}
            if name in pair:
                new += pair - found
                found |= pair
    return [k for k, each in enumerate(model.cables) if each.name in found]


def balanced_cables(scene: SceneData, model: Model, cable: int, is_rest: bool) -> list[int]:
    """Return the numbers of the cables whose loads the balance of one needs; without accelerations, its own."""
    return [cable] if is_rest else tied_cables(scene, model, cable)


def out_of_balance(scene: SceneData, model: Model, cable: int, is_rest: bool) -> SceneError | None:
    """Return why the section forces of a cable, by its number, cannot be computed by balance, or None.

    Forces of branches are not known, contact with friction is at rest only, and contact with a surface of a body never.
    Contacts of other cables count only if ties connect these to this one.
    """
    concerned = balanced_cables(scene, model, cable, is_rest)
    forces: list[BranchModel | WorkingCurveModel] = [*model.branches, *model.working_curves]
    for within in forces:
        if within.cable in concerned:
            part = scene.branches.get(within.name) or scene.working_curves[within.name]
            return SceneError(part.where, "has forces within elements that a balance does not "
                              f'know, of cable "{model.cables[within.cable].name}"', REMEDY)
    for contact in model.contacts:
        if contact.cable in concerned and (why := _unknown(contact, is_rest)):
            return SceneError(f'contact "{contact.name}"', f'{why} "{model.cables[contact.cable].name}"', REMEDY)
    return None


def known_method(scene: SceneData, model: Model, name: str, is_rest: bool) -> str:
    """Return the method for pictures of a cable: "balance" if all loads are known, else "constitutive".

    "constitutive" also for runs of cables that the surface of a fluid may cut: a balance takes 20 ms per instant.
    """
    number = list(scene.cables).index(name)
    is_slow = not is_rest and is_cut(model, balanced_cables(scene, model, number, is_rest))
    return "constitutive" if is_slow or out_of_balance(scene, model, number, is_rest) is not None else "balance"


def is_cut(model: Model, cables: list[int]) -> bool:
    """Return whether the surface of a fluid may cut one of these cables, by their numbers."""
    return any(drag.wet != "all" and drag.cable in cables for drag in model.drags)


def _unknown(contact: ContactModel, is_rest: bool) -> str:
    """Return why the forces of a contact are unknown, empty if they are known."""
    if contact.friction and not is_rest:
        return "has friction, which results do not record along"
    return "moves with a body along" if contact.on[0].body >= 0 else ""
