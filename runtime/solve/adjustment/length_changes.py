"""The change of the residual by the length of a cable at a state of rest: by all forces per unit length."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...model.contacts import ContactModel
from ...model.kinds import COUPLINGS, in_order
from ...parts.cable import Cable
from ...parts.load import DistributedForce
from .cable_changes import by_length as of_elements
from .cable_changes import same_points
from .change import Change, Rest, altered, named
from .load_changes import by_values

SCALING_GROUPS = "loads", "joints", "point_forces", "contacts"
"""Groups of couplings whose positions on a cable are fractions of its length."""
NOT_SCALING_GROUPS = tuple({kind.group for kind in COUPLINGS} - {*SCALING_GROUPS})
"""The other groups: their positions on a cable are no fractions of its length, or their forces depend on its length and
size."""


def lengthens_plainly(rest: Rest, cable: Cable) -> bool:
    """Return whether all parts on a cable keep their relative arc-length, and nothing else depends on its length.

    Exceptions: a slide has its arc-length as a coordinate, a rigid tie shares the slopes of the cable, and a longer
    hanging cable is drawn in another shape.
    """
    scene, name = rest.scene, cable.name
    rigid = any(tie.rotation == "rigid" and name in (tie.cable, tie.to) for tie in scene.ties.values())
    contacts = [contact for contact in scene.contacts.values() if contact.a == name]
    if rigid or rest.names(name, NOT_SCALING_GROUPS) or any(contact.name in rest.reader.parts for contact in contacts):
        return False
    return cable.shape != "hanging" or hangs_plainly(rest, cable)


def hangs_plainly(rest: Rest, cable: Cable) -> bool:
    """Return whether nothing on a cable depends on its hanging shape as drawn."""
    scene, model, name = rest.scene, rest.model_of(cable.name), cable.name
    held = model.nodal(rest.model.unknown_of_dof) < 0
    held[[0, -1], model.vectors.index("r")] = False
    rough = any(contact.a == name and contact.friction is not None for contact in scene.contacts.values())
    as_drawn = any(name in named(force) and force.as_made() is not force for force in scene.point_forces.values())
    tied = any(name in (tie.cable, tie.to) for tie in scene.ties.values())
    return not (held.any() or rough or as_drawn or tied or rest.names(name, ("joints",)))


def by_length(rest: Rest, cable: Cable) -> Change:
    """Return the change by the length of a cable: of all forces per unit length."""
    model, q = rest.model_of(cable.name), rest.problem.keep()["q"]
    at, change = model.coordinates, Change(rest.model)
    change.f[at] = of_elements(model, cable, q) - rest.model.gravity[at]
    spread = {k: load for k, load in enumerate(rest.scene.loads.values())
              if isinstance(load, DistributedForce) and load.cable == cable.name}
    for load in by_values(rest, spread).values():
        change.f += load.f
    change.f += _of_contacts(rest, rest.model.cables.index(model))
    unknown = rest.model.unknown_of_dof[at]
    free = unknown >= 0
    change.same[unknown[free]] = same_points(model, q)[free]
    change.f /= cable.length
    change.same /= cable.length
    return change


def _of_contacts(rest: Rest, cable: int) -> np.ndarray:
    """Return (n_dof,): the part of the residual by the contacts of a cable with surfaces."""
    model = rest.model
    if not any(contact.cable == cable for contact in model.contacts):
        return np.zeros(model.n_dof)
    doubled = [replace(contact, stiffness=2 * contact.stiffness, tangential=2 * contact.tangential)
               if contact.cable == cable else contact for contact in model.contacts]
    others = [coupling for coupling in model.couplings if type(coupling) is not ContactModel]
    found = []
    for contacts in (model.contacts, doubled):
        engine = rest.engine(altered(model, couplings=in_order([*others, *contacts])))
        engine.static_residual()
        found.append(engine.reaction())
    return np.asarray(found[1] - found[0])
