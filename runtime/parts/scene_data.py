"""The data of a scene: its gravity, its parts by kind and name, and the settings that its file gives."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from itertools import count, islice
from typing import TYPE_CHECKING, Any, Never, Self

import numpy as np

from ..errors import SceneError
from .attachment import Attachment
from .branch import Relaxation, WireFriction
from .cable import Cable
from .contact import Contact
from .crossing import Crossing
from .drag import Drag
from .event import Event
from .fluid import Fluid
from .ice import Ice
from .joint import Joint
from .kinds import KINDS, plural_of
from .load import DistributedForce, Force, Moment
from .modal_body import ModalBody
from .part import Part
from .plane import Plane
from .plane_axes import PlaneAxes
from .point_force import PointForce
from .point_mass import PointMass
from .rigid_body import RigidBody
from .rope import Rope
from .signal import Signal
from .slide import Slide
from .support import Clamp, Motion, Pin, Support, Tie
from .surface import Surface
from .thermal import as_temperature
from .validation import vector
from .working_curve import WorkingCurve

if TYPE_CHECKING:
    from .rope_route import DrawnRoute

RESERVED = ("energy", "time")
"""Names of results that belong to no part."""


class OfDrawing(str):
    """A message on the drawn state, which does not hold for runs from another state."""


HOLDERS = dict, list
"""Classes of what a scene holds that its copies hold anew."""


def _refuse(*given: Any, **named: Any) -> Never:
    """Raise SceneError: parts are for reading."""
    raise SceneError("scene", "its parts are for reading", "add one with the scene's method for its kind, or take "
                     'another scene: scene.replace("wire", ...), scene.without("wire")')


class PartsByName(dict[str, Any]):
    """Parts by name, for reading: only the scene adds parts."""

    __setitem__ = __delitem__ = __ior__ = clear = pop = popitem = setdefault = update = _refuse

    def put(self, name: str, part: Any) -> None:
        """Store a part under a name; for the scene."""
        super().__setitem__(name, part)

    def copy(self) -> Self:
        """Return a copy with the same parts."""
        return type(self)(self)

    def __reduce__(self) -> tuple[type[Self], tuple[dict[str, Any]]]:
        """Return class and content, for copies and other processes."""
        return type(self), (dict(self),)


class PartsInOrder(list[Any]):
    """Parts without names, for reading."""

    __setitem__ = __delitem__ = __iadd__ = __imul__ = append = extend = insert = _refuse
    remove = pop = clear = sort = reverse = _refuse

    def put(self, part: Any) -> None:
        """Add a part; for the scene."""
        super().append(part)

    def copy(self) -> Self:
        """Return a copy with the same parts."""
        return type(self)(self)

    def __reduce__(self) -> tuple[type[Self], tuple[list[Any]]]:
        """Return class and content, for copies and other processes."""
        return type(self), (list(self),)


class SceneData:
    """The data of a scene for checks, model, solvers and results; `funicular.Scene` adds methods.

    ``gravity`` in m/s², ``temperature`` of cables in K, or None. Each kind of part has a group for reading, ``group``
    of its class: a dict by name, or a list where parts have no names. Kinds that share a group also have their own:
    ``springs``, ``rigid_bodies``, ``forces``. ``messages`` lists adjustments; ``run_settings``,
    ``equilibrium_settings`` and ``relax_settings`` are the settings of its file; ``title`` is the title of pictures,
    the name of its file without the ending.
    """

    cables: dict[str, Cable]
    point_masses: dict[str, PointMass]
    pins: list[Pin]
    clamps: list[Clamp]
    motions: list[Motion]
    ties: dict[str, Tie]
    bodies: dict[str, RigidBody | ModalBody]
    ropes: dict[str, Rope]
    joints: dict[str, Joint]
    slides: dict[str, Slide]
    loads: dict[str, Force | DistributedForce | Moment]
    point_forces: dict[str, PointForce]
    fluids: dict[str, Fluid]
    drags: dict[str, Drag]
    ices: dict[str, Ice]
    working_curves: dict[str, WorkingCurve]
    branches: dict[str, Relaxation | WireFriction]
    crossings: dict[str, Crossing]
    surfaces: dict[str, Surface]
    contacts: dict[str, Contact]
    events: dict[str, Event]
    plane_axes: PlaneAxes | None = None
    """The axes of a scene that `in_plane` made, which turn its results into the ground's axes."""
    drawn: SceneData | None = None
    """The original of a scene that `in_plane` made."""

    def __init__(self, gravity: Any = (0, -9.81, 0), temperature: Any = None):
        """Make an empty scene; gravity: 3 numbers in m/s²; temperature: of cables without their own, above that of the
        stress-free state, a number or a signal, K. Raises SceneError.
        """
        try:
            self.gravity = vector(gravity, "m/s²")
        except ValueError as error:
            raise SceneError("scene", f"gravity {error}") from None
        try:
            self.temperature: float | Signal | None = None if temperature is None else as_temperature(temperature)
        except ValueError as error:
            raise SceneError("scene", f"temperature {error.args[0]}", *error.args[1:]) from None
        held = vars(self)
        for group, holder in _holders().items():
            held[group] = holder()
        self._contact_of_pair: dict[tuple[str, str], str] = {}
        self.messages: list[str] = []
        self.title = ""
        self.run_settings: dict[str, Any] = {}
        self.equilibrium_settings: dict[str, Any] = {}
        self.relax_settings: dict[str, Any] = {}

    def __getattr__(self, name: str) -> Any:
        """Return the parts of one kind in a group of several: ``scene.springs`` of ``point_forces``."""
        if (kind := _views().get(name)) is not None:
            return PartsByName((label, part) for label, part in getattr(self, kind.group).items()
                               if type(part) is kind)
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    def __dir__(self) -> list[str]:
        """Return the names of its attributes, kinds that share a group included."""
        return [*super().__dir__(), *_views()]

    def __setattr__(self, name: str, value: Any) -> None:
        """Raise SceneError for an assignment to a group."""
        if name in _views() or (name in _groups() and not isinstance(value, PartsByName | PartsInOrder)):
            raise SceneError("scene", f"{name} cannot be set", "add parts with the scene's methods for their kinds")
        super().__setattr__(name, value)

    @property
    def contact_of_pair(self) -> Mapping[tuple[str, str], str]:
        """Return the names of contacts by the names of both sides; added contacts are entered on the next access."""
        known = self._contact_of_pair
        added = [*islice(reversed(self.contacts.values()), len(self.contacts) - len(known))]
        known.update(((part.a, part.b), part.given_name or "") for part in reversed(added))
        return known

    def line(self, name: str) -> Cable | Rope | None:
        """Return the cable or the rope of a name, None without one."""
        return self.cables.get(name) or self.ropes.get(name)

    def masses_on(self, cable: str) -> list[PointMass]:
        """Return the point masses on a cable, by its name."""
        return [mass for mass in self.point_masses.values() if mass.on == cable]

    @property
    def rubbing(self) -> list[Slide | Joint]:
        """Return the slides and the joints that have friction."""
        every: list[Slide | Joint] = [*self.slides.values(), *self.joints.values()]
        return [part for part in every if part.friction is not None]

    @property
    def dim(self) -> int:
        """Return 2 if its cables or its ropes are planar, else 3."""
        planar = [cable for cable in self.cables.values() if cable.dim == 2]
        return 2 if planar or (self.ropes and any(rope.dim == 2 for rope in self.ropes.values())) else 3

    @property
    def plane(self) -> Plane | None:
        """Return the plane of its planar cables; None for z = 0 and for spatial scenes."""
        return next((cable.plane for cable in self.cables.values() if cable.dim == 2), None)

    @property
    def as_drawn(self) -> SceneData:
        """Return the scene as drawn by the user, the original of one in the axes of its plane."""
        return self.drawn or self

    @property
    def libraries(self) -> tuple[str, ...]:
        """Return the directories of the libraries of its elements."""
        return tuple(sorted({cable.library for cable in self.cables.values() if cable.library is not None}))

    @property
    def supports(self) -> list[Support]:
        """Return all supports of nodes: pins, clamps and motions."""
        return [*self.pins, *self.clamps, *self.motions]

    @property
    def up(self) -> np.ndarray:
        """Return (3,): the upward direction, against gravity, along y without gravity."""
        size = float(np.linalg.norm(self.gravity))
        return -np.array(self.gravity) / size if size else np.array([0.0, 1.0, 0.0])

    def fluids_of(self, drag: Drag) -> list[Fluid]:
        """Return the fluids of a drag: the one that it names, else all."""
        return list(self.fluids.values()) if drag.fluid is None else [self.fluids[drag.fluid]]

    def parts(self) -> Iterator[Part]:
        """Yield all parts, in an order in which they can be added."""
        held = vars(self)
        for name in _groups():
            if group := held[name]:  # most are empty
                yield from group.values() if isinstance(group, dict) else group

    def attachments(self) -> Iterator[Attachment]:
        """Yield the attachments of parts, such as those of springs, joints and the items of ropes."""
        for part in self.parts():
            yield from (value for _, value in part if isinstance(value, Attachment))
        for rope in self.ropes.values():
            yield from (item.end for item in rope.route)

    def route_of(self, rope: Rope) -> DrawnRoute:
        """Return the route of a rope as drawn among the bodies and cables of the scene, see `Rope.drawn`."""
        return rope.drawn(self.holders)

    @property
    def holders(self) -> Mapping[str, RigidBody | ModalBody | Cable]:
        """Return the bodies and cables by name, on which ropes are held."""
        return {**self.bodies, **self.cables}

    def group(self, name: str) -> Iterable[Part]:
        """Return the parts of a group, in the order in which they were added."""
        parts = getattr(self, name)
        return parts.values() if isinstance(parts, dict) else parts

    def put(self, part: Part) -> None:
        """Store a part in its group without checks."""
        group = getattr(self, part.group)
        if isinstance(group, PartsByName):
            group.put(part.given_name or "", part)
        else:
            group.put(part)

    def part_named(self, name: str, group: str) -> Part | None:
        """Return the part of a name, None if the name is free for a part of a group.

        All parts but events, and the sheaves of ropes, share one space of names, by which results are addressed.
        """
        return next((parts[name] for parts in self._names_beside(group) if name in parts), None)

    def _names_beside(self, group: str) -> list[dict[str, Part]]:
        """Return the groups that share the space of names of a group."""
        held: dict[str, Any] = vars(self)
        if group == "events":
            return [held[group]] if held[group] else []
        found = [parts for each in _named_groups() if (parts := held[each])]
        if self.ropes:
            found.append({each.given_name or "": each for rope in self.ropes.values() for each in rope.named_within()})
        return found

    def add(self, part: Part) -> Part:
        """Add a part, see `funicular.Scene`."""
        raise NotImplementedError

    def add_pairs(self, kind: type[Part], entries: Mapping[str, Any]) -> list[Part]:
        """Add the parts of many pairs, see `pairs` and `funicular.Scene`."""
        raise NotImplementedError

    def with_parts(self, parts: Iterable[Part], gravity: Any = None, begun: Self | None = None,
                   temperature: Any = None) -> Self:
        """Return a checked scene of other parts, with the settings and the title of this one.

        parts: in the order of `parts`; gravity: in m/s², by default unchanged; begun: a scene that such a call made of
        the parts before these, which stays; temperature: in K, by default unchanged. Raises SceneError.
        """
        if begun is not None:
            scene = begun.copied()
        else:
            scene = type(self)(gravity=self.gravity if gravity is None else gravity,
                                temperature=self.temperature if temperature is None else temperature)
            scene.title = self.title
            scene.run_settings, scene.equilibrium_settings = dict(self.run_settings), dict(self.equilibrium_settings)
            scene.relax_settings = dict(self.relax_settings)
        for part in parts:
            scene.add(part.as_made())
        return scene

    def changed(self, changes: Iterable[tuple[Part, Mapping[str, Any]]], gravity: Any = None,
                temperature: Any = None) -> Self:
        """Return a checked scene with other values of several parts at once.

        changes: parts of this scene, each once, with values by keyword; gravity: in m/s², temperature: in K, by default
        unchanged. Raises SceneError.
        """
        values = {id(part): each for part, each in changes}
        return self.with_parts((each.remade(values[id(each)]) if id(each) in values else each
                                for each in self.parts()), gravity, temperature=temperature)

    def remeshed(self, elements: Callable[[Cable], int],
                 of_spans: Callable[[Rope], tuple[int, ...]] | None = None) -> Self:
        """Return a checked scene with other numbers of elements of cables, see `Cable.mesh_entries`, and of spans of
        ropes, by default as they are. Raises SceneError.
        """
        def made(part: Part) -> Part:
            if isinstance(part, Cable):
                return part.remade(part.mesh_entries(elements(part)))
            return part.remade({"elements": of_spans(part)}) if of_spans and isinstance(part, Rope) else part

        return self.with_parts(map(made, self.parts()))

    def copied(self) -> Self:
        """Return a scene of the same parts, to which parts can be added independently."""
        made = object.__new__(type(self))
        vars(made).update({name: value.copy() if isinstance(value, HOLDERS) else value
                           for name, value in vars(self).items()})
        return made

    def replaced(self, made: Callable[[Part], Part]) -> Self:
        """Return a scene with each part replaced by one of the same kind and name, without checks."""
        scene = self.copied()
        for name in _groups():
            group = getattr(scene, name)
            setattr(scene, name, PartsByName({key: made(part) for key, part in group.items()})
                    if isinstance(group, PartsByName) else PartsInOrder(map(made, group)))
        return scene

    def check_name(self, part: Part) -> None:
        """Raise SceneError where the name of a part, or of a part in it, is taken."""
        for each in (part, *part.named_within()):
            name = each.given_name
            assert name is not None, f"{part.where} has no name yet"
            if (other := self.part_named(name, part.group)) is not None:
                article = "an" if part.kind == "event" else "a"
                raise SceneError(_place(part, each), f"there is already {article} {other.kind} of that name",
                                 "give each part its own name")
            if name in RESERVED:
                raise SceneError(_place(part, each), "its name is a name of results", "give another one")

    def free_name(self, part: type[Part]) -> str:
        """Return the least free name with a number, where all below it are taken."""
        return self.free_names(part, part.kind, 1)[0]

    def free_names(self, part: type[Part], stem: str, n: int) -> list[str]:
        """Return n free names of a stem with numbers.

        Doubling and bisection find the first one with few look-ups among many unnamed parts.
        """
        groups = self._names_beside(part.group)

        def is_taken(number: int) -> bool:
            name = f"{stem}_{number}"
            return any(name in parts for parts in groups)

        taken, free = 0, 1
        while is_taken(free):
            taken, free = free, 2 * free
        while free - taken > 1:
            middle = (taken + free) // 2
            if is_taken(middle):
                taken = middle
            else:
                free = middle
        numbers = (number for number in count(free) if not is_taken(number))
        return [f"{stem}_{number}" for number in islice(numbers, n)]


def _place(part: Part, within: Part) -> str:
    """Return the name in messages of a part or of one within it."""
    return part.where if within is part else f"{part.where}: {within.where}"


@cache
def _views() -> dict[str, type[Part]]:
    """Return the kinds of parts without a group of their own, by the plurals of their names."""
    named = {plural_of(kind.kind): kind for kind in KINDS}
    return {name: kind for name, kind in named.items() if name not in _groups()}


@cache
def _groups() -> tuple[str, ...]:
    """Return the groups in an order in which their parts can be added."""
    return tuple(dict.fromkeys(kind.group for kind in KINDS))


@cache
def _holders() -> dict[str, type[PartsByName | PartsInOrder]]:
    """Return the class that holds the parts of each group."""
    return {kind.group: PartsByName if kind.is_named() else PartsInOrder for kind in KINDS}


@cache
def _named_groups() -> tuple[str, ...]:
    """Return the groups of parts with names, without events, which have a space of names of their own."""
    return tuple(group for group, holder in _holders().items() if holder is PartsByName and group != "events")
