"""Ropes that run over sheaves."""

from collections.abc import Iterable, Iterator, Mapping
from itertools import chain, pairwise
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from .material import Material
from .part import Part
from .piece import UniformPiece
from .quantity import Quantity, vector_of_time
from .rope_items import ROUTE_ITEMS, Anchor, Block, Drum, RouteItem, Sheave
from .schemas import POINT, checked, number_schema
from .section import AnySection, Rectangle, outer_radius_of
from .section_stiffness import law_of_measures, section_stiffness
from .validation import (
    MAX_COUNT,
    Flag,
    Name,
    finite,
    items,
    one_of,
    positive,
    positive_number,
    show,
    shown,
    whole_number,
)

if TYPE_CHECKING:
    from .rope_drawing import Holders
    from .rope_route import DrawnRoute

PLANAR, SPATIAL = "cable8p", "cable12"
ELEMENTS = {PLANAR: 2, SPATIAL: 3}
"""Elements of spans, whose material points move along them, with the dimension of space."""
LAW = law_of_measures("engineering", "exact", "full")
"""The law of the stiffness: tension is EA (stretch - 1)."""
MAX_HOLDING_SHEAVES = 127
"""Sheaves with friction of a rope without mass for which the engine has room."""
ORDER = "give an Anchor or a Drum, then the sheaves, then an Anchor or a Drum; or closed=True"


def _listed(value: Any) -> list[Any]:
    if (given := items(value, 2)) is None:
        raise ValueError(f"must be a list of 2 items or more, got {shown(value)}", ORDER)
    return given


def _without_blocks(route: tuple[RouteItem, ...]) -> tuple[RouteItem, ...]:
    """Return a route with the sheaves of its blocks in their place."""
    return tuple(chain.from_iterable(item.sheaves if isinstance(item, Block) else (item,) for item in route))


def _elements(value: Any) -> int | tuple[int, ...]:
    if (given := items(value, 1)) is not None:
        return tuple(map(whole_number, given))
    return whole_number(value)


def _length(value: Any) -> float | tuple[float, ...]:
    if (given := items(value, 1)) is not None:
        return tuple(positive_number(each, "m") for each in given)
    return positive_number(value, "m")


LengthOfSpans = Annotated[float | tuple[float, ...], checked(_length, {
    "anyOf": [number_schema("m", exclusiveMinimum=0),
              {"type": "array", "items": number_schema("m", exclusiveMinimum=0), "minItems": 1}]})]
COUNT = {"type": "integer", "minimum": 1, "maximum": MAX_COUNT}
Route = Annotated[tuple[Annotated[RouteItem, ROUTE_ITEMS.checked()], ...], Field(json_schema_extra={"minItems": 2}),
                  BeforeValidator(_listed), AfterValidator(_without_blocks)]
ElementsOfSpans = Annotated[int | tuple[int, ...], checked(_elements, {
    "anyOf": [COUNT, {"type": "array", "items": COUNT, "minItems": 1}]})]


class Rope(Part):
    """A rope that runs over sheaves, in the plane z = 0 or in space: it stretches, bends, has mass and slides.

    It ends at anchors or drums, and is straight and tangent to the sheaves and drums as drawn. A span is what is
    between two tangent points, or a tangent point and an anchor; its elements are equal, and the material moves through
    them. Sheaves have no mass but that of the body they are on. On a sheave the rope bends to its radius; the layer
    sqrt(EI / T) in which the curvature begins is not resolved but moves the span away from the sheave by EI / (2 T R),
    with the tension T as drawn all through the run.

    Given is the ``tension``, the ``length``, or that of each span; gravity acts from the start. The rope starts with
    the velocities of the bodies that hold it, straight and evenly stretched; sheaves and drums start without rotation
    on what carries them, unless it is prescribed.

    A joint or a spring grips the rope by an end ("haul", s): s in m is stress-free, from the first end, with what is on
    a drum there. The grip, or the point of a force, moves with the material, past ends of elements, and a `Slide` along
    it; where it reaches a sheave, a drum or an anchor, the run ends with a RopeLeftError. A load that kinks the rope
    there has an error in proportion to the length of elements, which two ropes that end at the body do not have.

    route: an `Anchor` or a `Drum`, sheaves, and again an `Anchor` or a `Drum`, in the rope's order; of a closed rope
        two sheaves or more. A `Block` stands for its sheaves
    closed: whether the last sheave leads to the first one, as of a belt
    elements: number of elements of each span, or a list of one number for each span
    tension: at the route's first point, N: uniform as drawn; `equilibrium` finds the stress-free length of a rope with
        an anchor with which it is that tension at rest, without friction, loads and fluids, among the bodies as drawn
    length: stress-free length of the whole rope with what is wound on drums, m; without this at most the drawn length.
        The stretch is uniform as drawn. Or a list of the stress-free lengths of each span, from end to end at anchors
        and tangent points as drawn, of a rope with mass: each then has its tension. On a wrap between two spans the
        logarithm of the tension is linear in the angle as drawn, which gives the length there;
        ``equilibrium(wraps="stick")`` is the state of rest in which friction holds the differences
    element: "cable8p" in the plane z = 0; "cable12" in space, with axes of sheaves and drums in any direction, which
        turn with the bodies and cables that they are on
    mass: False for a rope without mass and bending stiffness: straight between the sheaves, with one tension from one
        end, drum or sheave with friction to the next, and slack where it would push. On a sheave with friction,
        whatever its model, the rope sticks up to the limit e^(mu theta) of the ratio of its elastic tensions, beyond
        which it slips with this ratio. There and on drums it does not creep, but leaves with the stretch that it has.
        The wrap of a sheave without friction may vanish and return; with side given it may be absent as drawn. In space
        the rope leaves the grooves at fleet angles, and returns to a groove at its place along the axis. Then the
        density, the bending stiffness, ``elements``, zones of sheaves and the velocity of their friction have no effect
    section: cross-section, whose height is in the plane
    material: material, with the damping of the rope
    temperature: above that at which ``length`` is given, K, also of what is on drums; by default that of the scene. By
        ``thermal_expansion`` of the material it lengthens the stress-free rope, whose mass, section and stiffness stay;
        ``tension``, s and lengths in store are those at the temperature
    """

    kind = "rope"
    group = "ropes"
    of_scene = ("temperature",)
    parts_within = (Sheave, Drum)
    results: ClassVar[dict[str, Quantity]] = {
        "position": Quantity(("time", "{part}.point", "xyz"), "m", "points along the rope: of a wrap as many as "
                             "for its angle as drawn, so that chords between them cut a wrap that grows", POINT),
        "s": Quantity(("time", "{part}.point"), "m", "stress-free arc-length of these points from the first end, what "
                      "is on a drum there included; of a closed rope from where it leaves its first sheave as drawn"),
        "start_force": vector_of_time("N", "force on what holds the first anchor"),
        "end_force": vector_of_time("N", "force on what holds the last anchor"),
        "coordinates": Quantity(("time", "{part}.coordinate"), "m or 1", "places and slopes of nodes, "
                                "stress-free arc-lengths of ends of spans and zones, rotations of sheaves"),
        "coordinate_rates": Quantity(("time", "{part}.coordinate"), "m/s or 1/s", "rates of the coordinates"),
    }
    name: Name
    route: Route
    closed: Flag = False
    section: AnySection
    material: Material
    elements: ElementsOfSpans = 4
    tension: Annotated[float, positive("N")] | None = None
    length: LengthOfSpans | None = None
    element: Annotated[str, one_of(ELEMENTS)] = PLANAR
    mass: Flag = True
    temperature: Annotated[float, finite("K")] | None = None

    @model_validator(mode="after")
    def _has_a_route(self) -> "Rope":
        if self.closed and len(self.sheaves) < max(2, len(self.route)):
            raise ValueError("is closed, and its route has an Anchor" if len(self.sheaves) < len(self.route) else
                             "is closed around one sheave", "give two sheaves or more, without anchors")
        for end, item in () if self.closed else (("first", self.route[0]), ("last", self.route[-1])):
            if not isinstance(item, Anchor | Drum):
                raise ValueError(f"route must begin and end with an Anchor or a Drum, its {end} item is the "
                                 f"{item.where}", ORDER)
        for item in self.route if self.closed else self.route[1:-1]:
            if not isinstance(item, Sheave):
                what = "an Anchor" if isinstance(item, Anchor) else f"the {item.where}"
                raise ValueError(f"route has {what} between its ends", "let two ropes end there")
        if not self.wheels:
            raise ValueError("route has no sheave and no drum", "take scene.cable() between two points")
        for sheave in self.sheaves:
            if not (sheave.contact or self.mass):
                raise ValueError(f"{sheave.where} is on a rope without mass, whose contact follows from its place, and "
                                 "has contact=False", "leave contact=False out")
        names = [wheel.name for wheel in self.wheels]
        if self.name in names:
            raise ValueError(f'route has a sheave "{self.name}", the name of the rope', "give each its own name")
        if twice := next((name for k, name in enumerate(names) if name in names[:k]), None):
            raise ValueError(f'route has two items named "{twice}"', "give each its own name")
        return self

    @model_validator(mode="after")
    def _is_of_one_length(self) -> "Rope":
        if (self.tension is None) == (self.length is None):
            have = "neither tension nor length" if self.tension is None else "tension and length"
            raise ValueError(f"has {have}", "give one of them")
        spans = self.n_spans
        if isinstance(self.length, tuple):
            if len(self.length) != spans:
                raise ValueError(f"length must be one number or {spans}, one for each span, got {len(self.length)}")
            if apart := next((sheave for sheave in self.sheaves if not sheave.contact), None):
                raise ValueError(f"has lengths of spans, and {apart.where} has contact=False: the spans beside it are "
                                 "one straight line", "leave contact=False out, or give the length of the whole rope")
            if not self.mass:
                raise ValueError("has no mass, and lengths of spans: its sheaves hold the tensions that loads give it",
                                 "give the length of the whole rope, or tension")
        if isinstance(self.elements, tuple) and len(self.elements) != spans:
            raise ValueError(f"elements must be one number or {spans}, one for each span, got {len(self.elements)}")
        return self

    @model_validator(mode="after")
    def _is_possible_without_mass(self) -> "Rope":
        if self.mass:
            return self
        if self.closed and not self.holding_sheaves:
            raise ValueError("has no mass, is closed, and no sheave holds it: how far it has run is then not known",
                             "give friction of a sheave")
        if len(self.holding_sheaves) > MAX_HOLDING_SHEAVES:
            raise ValueError(f"has no mass, and {len(self.holding_sheaves)} sheaves with friction, more than "
                             f"{MAX_HOLDING_SHEAVES}",
                             "let two ropes end at a body between them, or leave friction out")
        for drum in self.drums.values():
            if drum.at_end == "leave":
                raise ValueError(f'has no mass, and {drum.where} has at_end="leave": its free end would have no place',
                                 'give at_end="stop", or a small mass')
        return self

    @model_validator(mode="after")
    def _has_a_linear_law(self) -> "Rope":
        for name in ("torque_per_tension", "tension_table"):
            if getattr(self.section, name):
                raise ValueError(f"section.{name} is given, but ropes take EA and EI alone",
                                 "leave it out, or take a cable")
        return self

    @model_validator(mode="after")
    def _fits_its_sheaves(self) -> "Rope":
        for wheel in self.wheels:
            if wheel.radius <= self.radius:
                raise ValueError(f'radius of {wheel.where} must be above that of the rope, '
                                 f"{show(self.radius, 'm')}, got {show(wheel.radius, 'm')}",
                                 "radius is that of the groove plus that of the rope")
        return self

    @model_validator(mode="after")
    def _is_of_a_modelled_material(self) -> "Rope":
        if self.material.mass_damping:
            raise ValueError("its material has mass_damping, which ropes do not have",
                             "give damping_time, or the drag of the bodies on it")
        return self

    @model_validator(mode="after")
    def _can_grow(self) -> "Rope":
        self.check_growth()
        return self

    def check_growth(self) -> None:
        """Raise ValueError(cause, remedy) where its stress-free length cannot grow as given."""
        if self.temperature and self.material.thermal_expansion is None:
            raise ValueError("has a temperature, but its material has no thermal_expansion",
                             "give the material one, 0 for a rope that keeps its length")
        if not self.growth > 0:
            raise ValueError(f"the stress-free length must stay positive, got {self.growth:.6g} times the length at "
                             "0 K", "give temperature in K above the stress-free state, thermal_expansion in 1/K")

    @property
    def growth(self) -> float:
        """Return the factor of its stress-free length by its temperature."""
        return 1.0 + (self.temperature or 0.0) * (self.material.thermal_expansion or 0.0)

    @property
    def warm_length(self) -> float | tuple[float, ...] | None:
        """Return its stress-free length at its temperature, or those of its spans, m; None where it is not given."""
        if isinstance(self.length, tuple):
            return tuple(self.growth * each for each in self.length)
        return None if self.length is None else self.growth * self.length

    @property
    def warm_material(self) -> Material:
        """Return its material at its temperature: the stress-free rope has its mass, section and stiffness."""
        return self.material if self.growth == 1.0 else self.material.model_copy(
            update={"density": self.material.density / self.growth})

    @property
    def dim(self) -> int:
        """Return the dimension of space, 2 or 3."""
        return ELEMENTS[self.element]

    @property
    def sheaves(self) -> tuple[Sheave, ...]:
        """Return its sheaves in their order."""
        return tuple(item for item in self.route if isinstance(item, Sheave))

    @property
    def rough_sheaves(self) -> list[Sheave]:
        """Return its sheaves with friction on which it slides: none without mass."""
        return [sheave for sheave in self.sheaves if sheave.coefficient > 0 and self.mass]

    @property
    def holding_sheaves(self) -> list[Sheave]:
        """Return its sheaves whose friction holds it: those with friction, without mass."""
        return [sheave for sheave in self.sheaves if sheave.coefficient > 0 and not self.mass]

    @property
    def differing_sheaves(self) -> list[Sheave]:
        """Return its sheaves with friction that do not turn freely, so that the tension may differ beside them at rest.
        """
        return [sheave for sheave in self.rough_sheaves if not sheave.turns_freely]

    @property
    def drums(self) -> dict[int, Drum]:
        """Return the drums at its ends, by 0 for the first end and -1 for the last."""
        return {end: item for end in (0, -1) if isinstance(item := self.route[end], Drum)}

    @property
    def wheels(self) -> tuple[Sheave | Drum, ...]:
        """Return its sheaves and drums in their order."""
        return tuple(item for item in self.route if isinstance(item, Sheave | Drum))

    @property
    def length_in_store(self) -> float:
        """Return the stress-free length that is wound on its drums at the start, m."""
        return sum(drum.length_in_store for drum in self.drums.values())

    @property
    def first_arc_length(self) -> float:
        """Return the stress-free arc-length at the start of its first span, m: of a first drum what is wound on it."""
        return self.drums[0].length_in_store if 0 in self.drums else 0.0

    @property
    def n_spans(self) -> int:
        """Return the number of its spans."""
        return len(self.route) - (not self.closed)

    @property
    def ends_of_spans(self) -> list[tuple[RouteItem, RouteItem]]:
        """Return the items of the route at both ends of each span."""
        return [*pairwise(self.route), *([(self.route[-1], self.route[0])] if self.closed else [])]

    @property
    def elements_of_spans(self) -> tuple[int, ...]:
        """Return the number of elements of each span."""
        if not self.mass:
            return (1,) * self.n_spans
        return self.elements if isinstance(self.elements, tuple) else (self.elements,) * self.n_spans

    @property
    def uniform_pieces(self) -> tuple[UniformPiece, ...]:
        """Return its one piece, see `Cable.uniform_pieces`."""
        return UniformPiece(0, self.n_elements, self.section, self.warm_material),

    @property
    def n_elements(self) -> int:
        """Return the number of elements of all spans."""
        return sum(self.elements_of_spans)

    @property
    def radius(self) -> float:
        """Return half the height of its section in m, 0 where that is not told."""
        if isinstance(self.section, Rectangle):
            return self.section.height / 2
        return outer_radius_of(self.section) or 0.0

    @property
    def stiffness(self) -> tuple[float, float]:
        """Return EA in N and EI in N m², which is 0 without mass."""
        EA, EI = section_stiffness(LAW, self.section, self.material, self.dim).tolist()
        return EA, EI if self.mass else 0.0

    def named_within(self) -> Iterator[Part]:
        """Yield its sheaves and drums in their order."""
        return iter(self.wheels)

    def refers_to(self) -> Iterator[str]:
        """Yield the names of what holds its ends, sheaves and drums."""
        return chain.from_iterable(item.refers_to() for item in self.route)

    def off_plane(self) -> Iterator[str]:
        """Yield its quantities that leave the plane z = 0, see `Part.off_plane`."""
        for k, item in enumerate(self.route):
            yield from (f"route.{k} {quantity}" for quantity in item.off_plane())

    def entries_with(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        """Return the entries of a rope with changes; tension replaces length, and length tension."""
        other = {"tension": "length", "length": "tension"}
        left = {other[name]: None for name in other if changes.get(name) is not None}
        return super().entries_with(left | {**changes})

    def refined(self) -> "Rope":
        """Return the rope with elements of half the length, and twice the zones of wraps, see `Sheave.refined`."""
        route = [item.refined() if isinstance(item, Sheave) else item for item in self.route]
        return self.remade({"elements": tuple(2 * n for n in self.elements_of_spans), "route": route})

    @property
    def zones_halved(self) -> list[str]:
        """Return the sheaves with friction that `refined` gives half of their zones, as messages name them."""
        return [sheave.where for sheave in self.rough_sheaves if sheave.has_most_zones]

    def span_at(self, route: "DrawnRoute", s: float) -> int:
        """Return the number of the span that has the stress-free arc-length s, m, inside, along its route as drawn.

        Raises ValueError(cause, remedy) for one off the rope, at its ends, or on a sheave or a drum.
        """
        from .rope_drawing import span_at  # likewise

        return span_at(self, route, s)

    def point(self, holders: "Holders", s: float) -> np.ndarray:
        """Return (3,): the place as drawn of the stress-free arc-length s, m, in a span, in m. Raises ValueError."""
        route = self.drawn(holders)
        span = self.span_at(route, s)
        start, end = route.arc_lengths(self.first_arc_length)[span]
        drawn = route.spans[span]
        found = np.zeros(3)
        found[: self.dim] = drawn.start + (s - start) / (end - start) * (drawn.end - drawn.start)
        return found

    def drawn(self, holders: "Holders") -> "DrawnRoute":
        """Return its route as drawn among the bodies and cables of its scene.

        Its attachments must be complete, as in a scene. Raises ValueError(cause, remedy) for an impossible route and
        for a rope that is not taut.
        """
        from .rope_drawing import drawn  # where a rope is drawn: the import of the package stays quick

        return drawn(self, holders)


def driven_freely(ropes: Iterable[Rope]) -> list[str]:
    """Return the names in quotes of the sheaves that turn freely under a torque, at t = 0, without friction."""
    return [f'"{sheave.name}"' for rope in ropes for sheave in rope.sheaves
            if sheave.prescribed is None and sheave.torque is not None and sheave.torque.value(0.0)]


def running_round(ropes: Iterable[Rope]) -> list[str]:
    """Return the names in quotes of the closed ropes that only friction keeps from running round their sheaves."""
    return [f'"{rope.name}"' for rope in ropes if rope.closed and rope.rough_sheaves]


def rough_sheaves(ropes: Iterable[Rope]) -> list[str]:
    """Return the names in quotes of the sheaves on which ropes have friction."""
    return [f'"{sheave.name}"' for rope in ropes for sheave in rope.rough_sheaves]
