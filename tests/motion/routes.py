"""Other scenes and runs with the motion of a given one: moved, reordered, in other units..."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import funicular as fu
import numpy as np
from funicular.base.rotations import rotate, turned_by
from funicular.choice.planar import planar_of
from funicular.parts.attachment import Attachment
from funicular.parts.cable import Cable
from funicular.parts.crossing import Crossing
from funicular.parts.drag import Drag
from funicular.parts.event import Event
from funicular.parts.joint import Joint
from funicular.parts.part import Part
from funicular.parts.signal import Signal
from rewritten import in_units
from turned_scenes import turned_scene

Vectors = np.ndarray
Triple = tuple[float, float, float]


@dataclass(frozen=True)
class Frame:
    """Position and units of another scene relative to the axes and origin of the given one.

    rotation: vector in rad. shift: in m of the given scene. length, time: units of the other scene in those of the
    given one.
    """

    rotation: Triple = (0.0, 0.0, 0.0)
    shift: Triple = (0.0, 0.0, 0.0)
    length: float = 1.0
    time: float = 1.0

    def moved(self, scene: fu.Scene) -> fu.Scene:
        """Return the scene, rotated and shifted."""
        return turned_scene(scene, self.rotation, self.shift)

    def back(self, points: Vectors) -> Vectors:
        """Return points (..., 3) of the other scene in the given one, m."""
        return rotate(turned_by(-np.array(self.rotation)), points * self.length - np.array(self.shift))

    def axes(self) -> Vectors:
        """Return (3, 3): the axes of the given scene's ground along those of the other one, as rows."""
        return rotate(turned_by(np.array(self.rotation)), np.eye(3))


@dataclass(frozen=True)
class Route:
    """A scene with the motion of a given one, in a frame; reversed: names of cables with reversed node numbers."""

    scene: fu.Scene
    frame: Frame = Frame()
    reversed: tuple[str, ...] = ()


Maker = Callable[[fu.Scene], Route | None]
"""Makes the route of a scene, None of one that has no such."""


def points(run: fu.Run, route: Route) -> dict[str, Vectors]:
    """Return by name of cables and bodies (time, points, 3): nodes, and of bodies the origin and three points along the
    axes of the given ground as drawn, at the radius of gyration.
    """
    found = {}
    for name in route.scene.cables:
        nodes = run[f"{name}.nodal_vectors"][:, :, 0]
        found[name] = nodes[:, ::-1] if name in route.reversed else nodes
    for name, body in route.scene.bodies.items():
        lever = np.sqrt(np.trace(body.inertia) / body.mass) if isinstance(body, fu.RigidBody) else 1.0
        turned, at = run[f"{name}.orientation"], run[f"{name}.position"]
        in_body = rotate(np.multiply(body.frame[1], (1, -1, -1, -1)), route.frame.axes())
        arms = np.stack([rotate(turned, arm) for arm in in_body], axis=1)
        found[name] = at[:, None] + lever * np.concatenate([0 * arms[:, :1], arms], axis=1)
    return {name: route.frame.back(each) for name, each in found.items()}


def apart(one: dict[str, Vectors], other: dict[str, Vectors]) -> float:
    """Return the largest distance of two motions relative to the largest motion."""
    assert one.keys() == other.keys()
    largest = max(np.linalg.norm(each - each[:1], axis=-1).max() for each in one.values())
    return max(np.linalg.norm(each - other[name], axis=-1).max() for name, each in one.items()) / largest


def simulate(scene: fu.Scene, duration: float, **settings) -> fu.Run:
    """Return a run with 20 output times; its notes are in the report."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        return scene.run(duration, **{"output_step": duration / 20, "progress": False} | settings)


def in_other_order(parts: Iterable[Part]) -> list[Part]:
    """Return the parts of a scene in another valid order: each kind backwards."""
    kinds: dict[str, list[Part]] = {}
    for part in parts:
        kinds.setdefault(part.group, []).insert(0, part.as_made())
    return [part for kind in kinds.values() for part in kind]


def reordered(scene: fu.Scene) -> Route | None:
    """The same parts in another order."""
    parts = in_other_order(scene.parts())
    return Route(scene.with_parts(parts)) if any(len(scene.group(part.group)) > 1 for part in parts) else None


def moving(rotation: Triple = (0.0, 0.0, 0.0), up: float = 0.0, aside: float = 0.0) -> Maker:
    """Return the route of a scene rotated by a vector in rad and moved in m, up and across the plane of x and gravity.
    A fluid that changes with height is not moved up, one with waves, which have a phase at the origin, not at all.
    """
    def moved(scene: fu.Scene) -> Route | None:
        if any(fluid.waves is not None for fluid in scene.fluids.values()):
            return None
        if any(fluid.profile is not None or fluid.surface is not None for fluid in scene.fluids.values()) and up:
            return None
        shift = rotate(turned_by(np.array(rotation)), up * scene.up + aside * np.array([0.0, 0.0, 1.0]) + (1.0, 0, 0))
        frame = Frame(rotation, tuple(shift))
        try:
            return Route(frame.moved(scene), frame)
        except fu.SceneError:  # of motions that are free along one of the ground's axes
            return None

    return moved


def in_other_units(length: float, mass: float, time: float) -> Maker:
    """Return the route of a scene in other units, given by their number per metre, kilogram and second."""
    def made(scene: fu.Scene) -> Route:
        return Route(in_units(scene, length, mass, time), Frame(length=1 / length, time=1 / time))

    return made


def reversed_cables(scene: fu.Scene) -> Route | None:
    """Return the route with reversed cables; none for a scene with parts that have a direction along them: motors,
    forces that move, polars.
    """
    driven = (any(slide.drive is not None or slide.velocity is not None for slide in scene.slides.values())
              or any(isinstance(getattr(load, "s", None), Signal) for load in scene.loads.values()))
    if not scene.cables or driven or any(drag.polar is not None for drag in scene.drags.values()):
        return None
    return Route(scene.with_parts(_from_the_end(part.as_made(), scene) for part in scene.parts()),
                 reversed=tuple(scene.cables))


def _from_the_end(part: Part, scene: fu.Scene) -> Part:
    """Return a part of a scene whose cables are reversed."""
    if isinstance(part, Cable):
        return _reversed(part)
    changes: dict[str, object] = {
        name: value.model_copy(update={"s": scene.cables[value.on].length - value.s})
        for name, value in part if isinstance(value, Attachment) and value.s is not None}
    for place, on in ALONG:
        of = scene.cables.get(getattr(part, on, None) or "")
        if of is not None and isinstance(s := getattr(part, place, None), float):
            changes[place] = of.length - s
    if isinstance(part, Event) and part.s is not None:
        changes["s"] = scene.cables[part.quantity.partition(".")[0]].length - part.s
    for one, other in EXCHANGED.items():
        if hasattr(part, one) and hasattr(part, other):
            changes |= {one: changes.get(other, getattr(part, other)), other: changes.get(one, getattr(part, one))}
    if isinstance(part, Drag) and part.on in scene.cables:
        changes["lift"] = -part.lift
    if getattr(part, "follower", False) and (getattr(part, "on", None) or getattr(part, "cable", None)) in scene.cables:
        tangential, across, aside = part.value  # the height stays in space, in the plane it turns
        changes["value"] = (-tangential, across, -aside) if scene.dim == 3 else (-tangential, -across, aside)
    return part.model_copy(update=changes)


def _reversed(cable: Cable) -> Cable:
    """Return the reversed cable."""
    assert not any(cable.angular_velocity), "its velocity is of its first point"
    changes = {"points": cable.points[::-1]} if cable.points else {"start": cable.end, "end": cable.start}
    if cable.pieces is not None:  # hinges are at their starts
        assert cable.pieces[0].hinge is False
        hinges = [False, *(piece.hinge for piece in cable.pieces[:0:-1])]
        changes["pieces"] = [piece.remade({"hinge": hinge})
                             for piece, hinge in zip(cable.pieces[::-1], hinges, strict=True)]
    if cable.nodes is not None:
        changes["nodes"] = (cable.length - np.array(cable.nodes[::-1])).tolist()
    return cable.remade(changes)


def planes_as_boxes(scene: fu.Scene) -> Route | None:
    """Return the route with the upper face of a large box in place of a plane."""
    planes = [part for part in scene.surfaces.values() if isinstance(part.shape, fu.Plane)]
    for part in planes:
        up = np.array(part.shape.normal) / np.linalg.norm(part.shape.normal)
        along = np.cross(up, np.eye(3)[np.argmin(np.abs(up))])
        box = fu.Box(size=(WIDE, WIDE, WIDE), at=np.array(part.shape.point) - 0.5 * WIDE * up, up=up, along=along)
        scene = scene.replace(part.name, shape=box)
    return Route(scene) if planes else None


def in_space_or_plane(scene: fu.Scene) -> Route | None:
    """Return the route with spatial elements in place of planar ones, or the reverse for a planar motion. None for
    ropes, which are planar, and for rigidly tied planar cables, whose sections have no spatial form.
    """
    if scene.dim == 3:
        planar = planar_of(scene).scene
        return None if planar is None else Route(planar)
    if scene.ropes or any(tie.rotation == "rigid" for tie in scene.ties.values()):
        return None
    return Route(scene.with_parts(_in_space(part.as_made(), scene) for part in scene.parts()))


def _in_space(part: Part, scene: fu.Scene) -> Part:
    if isinstance(part, Cable):
        return part.remade({"element": IN_SPACE[part.element], "law": part.law})
    if isinstance(part, Crossing) and part.b not in scene.cables:
        return part.remade({"axis": (0, 0, 1), "length": 0.5})
    elements = [scene.cables[end.on].element for _, end in part if isinstance(end, Attachment) and end.s is not None]
    if isinstance(part, Joint) and part.joint_kind not in ("spherical", "distance") and "cable8p" in elements:
        return part.remade({"up": (0, 0, 1)})  # its sections have no axes
    return part


ALONG = {("s", "cable"), ("s", "along"), ("s", "on"), ("at", "to"), ("start", "cable"), ("stop", "cable"),
         ("body_s", "body")}
"""Fields that are arc-lengths, and those that name the cable of them."""
EXCHANGED = {"at_start": "at_end", "start": "stop"}
"""Fields that are of either end of a cable."""
WIDE = 20.0
"""m: size of a box in place of a plane."""
IN_SPACE = {"cable8p": "cable12", "beam12p": "beam24"}
ROUTES: dict[str, Maker] = {
    "reordered": reordered,
    "shifted": moving(),
    "raised": moving(up=2.0),
    "turned": moving((0.0, 0.0, 0.7)),
    "moved": moving((0.3, -0.7, 1.1), aside=-3.0),
    "mm, t, s": in_other_units(1e3, 1e-3, 1.0),
    "km, kg, min": in_other_units(1e-3, 1.0, 1 / 60),
    "reversed": reversed_cables,
    "on boxes": planes_as_boxes,
    "in space or plane": in_space_or_plane,
}
"""Ways to write a scene anew; None of a scene that has no such."""
