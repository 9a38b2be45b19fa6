"""Which cables go together in a balance of forces, and what acts on them that results do not tell."""

from __future__ import annotations

from ...errors import SceneError
from ...model.contacts import ContactModel
from ...model.model import Model
from ...parts.scene_data import SceneData

REMEDY = 'take method="constitutive", which follows from the strains'


def tied_cables(scene: SceneData, model: Model, cable: int) -> list[int]:
    """Return the numbers of the cables that joins tie to one, itself included: their accelerations go together."""
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
    """Return the numbers of the cables whose loads the balance of one needs: at rest there are no accelerations."""
    return [cable] if is_rest else tied_cables(scene, model, cable)


def out_of_balance(scene: SceneData, model: Model, cable: int, is_rest: bool) -> SceneError | None:
    """Return why the forces in sections of a cable, by its number, cannot be had by balance; None: they can.

    A contact with friction is known at rest alone, one with a surface of a body not at all. Other cables' contacts do
    not count, unless joins tie them to this one.
    """
    concerned = balanced_cables(scene, model, cable, is_rest)
    for contact in model.contacts:
        if contact.cable in concerned and (why := _unknown(contact, is_rest)):
            return SceneError(f'contact "{contact.name}"', f'{why} "{model.cables[contact.cable].name}"', REMEDY)
    return None


def known_method(scene: SceneData, model: Model, name: str, is_rest: bool) -> str:
    """Return the method for pictures of a cable: "balance" where that knows all that acts, else "constitutive".

    The latter also of runs of cables that a surface of a fluid may cut: their balance takes 20 ms an instant.
    """
    number = list(scene.cables).index(name)
    is_slow = not is_rest and is_cut(model, balanced_cables(scene, model, number, is_rest))
    return "constitutive" if is_slow or out_of_balance(scene, model, number, is_rest) is not None else "balance"


def is_cut(model: Model, cables: list[int]) -> bool:
    """Return whether the surface of a fluid may cut one of these cables, by their numbers."""
    return any(drag.wet != "all" and drag.cable in cables for drag in model.drags)


def _unknown(contact: ContactModel, is_rest: bool) -> str:
    """Return what is not known of a contact, empty: nothing."""
    if contact.friction and not is_rest:
        return "has friction, which results do not tell along"
    return "moves with a body along" if contact.on[0].body >= 0 else ""
