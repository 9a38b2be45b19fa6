"""Scenes of whole catenaries, formed."""

from __future__ import annotations

import numpy as np

from ..scene.scene import Scene
from .form import LONGEST, Form, add_dropper, add_wire, form, hold_ends, mesh
from .line import Line

LEVER = 1.0
"""m: from where supports and steady arms are fixed to what they hold."""


def scene(line: Line | Form, longest: tuple[float, float] = LONGEST) -> Scene:
    """Return the scene of a catenary, formed, with x along the track and y up from the contact wire's height at the
    outer droppers.

    line: or its form, where that is known; longest: as in `form`. The contact wire is "contact", the messenger
    "messenger_1" from the first mast to the second, the droppers "dropper_1_1" and so on, supports and steady arms
    "support_1" and "arm_0" by their masts. Raises SceneError, EquilibriumError.
    """
    formed = form(line, longest) if isinstance(line, Line) else line
    made = Scene(gravity=(0, -formed.line.gravity, 0))
    _wires(made, formed)
    _droppers(made, formed)
    _masts(made, formed)
    return made


def _wires(made: Scene, formed: Form) -> None:
    line = formed.line
    place, of_messenger = (mesh(line, each) for each in formed.longest)
    nodes = np.concatenate([place[:-1] + k for k in range(line.spans)] + [[line.spans]]) * formed.contact_length
    of_contact, of_upper = (None if line.planar else _sides(line, side) for side in line.staggers)
    add_wire(made, "contact", line.contact, 0.0, line.length, formed.height, nodes, of_contact)
    hold_ends(made)
    for k in range(line.spans):
        add_wire(made, f"messenger_{k + 1}", line.messenger, k * line.span, (k + 1) * line.span, line.height,
                 of_messenger * formed.messenger_length, None if of_upper is None else of_upper[k:k + 2])


def _sides(line: Line, first: float) -> tuple[float, ...]:
    """Return where a wire is at the masts across the track, in m."""
    return tuple((-1) ** mast * first for mast in range(line.spans + 1))


def _droppers(made: Scene, formed: Form) -> None:
    line, droppers = formed.line, formed.line.droppers
    for span in range(line.spans):
        messenger = f"messenger_{span + 1}"
        for k, x in enumerate(droppers.at):
            places = x / line.span * formed.messenger_length, (span + x / line.span) * formed.contact_length
            add_dropper(made, f"dropper_{span + 1}_{k + 1}", messenger, places,
                        (line.hanging[k], droppers.contact_clamp), stiffness=float(formed.stiffnesses[k]),
                        length=float(formed.lengths[k]))


def _masts(made: Scene, formed: Form) -> None:
    line, arm = formed.line, formed.line.steady_arm
    of_contact, of_messenger = (_sides(line, side) for side in line.staggers)
    made.pin("messenger_1", s=0.0)
    made.pin(f"messenger_{line.spans}", s=made.cables[f"messenger_{line.spans}"].length)
    for mast in range(1, line.spans):
        x, z = mast * line.span, of_messenger[mast]
        before = made.cables[f"messenger_{mast}"]
        made.tie(before, s=before.length, to=f"messenger_{mast + 1}", at=0.0, rotation="free")
        made.spring((x, line.height + LEVER, z), (before, before.length), name=f"support_{mast}",
                    stiffness=line.support, length=LEVER - formed.mast_force / line.support)
        if not line.planar:
            made.motion(before, s=before.length, displacement=("free", "free", 0))
            _add_arm(made, formed, mast, of_contact[mast])
    for mast in range(line.spans + 1):
        if arm.stiffness:
            s = mast * formed.contact_length
            made.spring((mast * line.span, formed.height + LEVER, of_contact[mast]), ("contact", s), name=f"arm_{mast}",
                        stiffness=arm.stiffness, length=LEVER)


def _add_arm(made: Scene, formed: Form, mast: int, side: float) -> None:
    """Add the rod that holds the contact wire on a side of the track, at z = side (m), and pulls it there."""
    length = formed.line.steady_arm.length
    hinge = mast * formed.line.span, formed.height, side + float(np.copysign(length, side))
    made.joint("distance", hinge, ("contact", mast * formed.contact_length), length=length, name=f"steady_arm_{mast}")
