"""Contact of cables and bodies with surfaces."""

from typing import TYPE_CHECKING, Annotated, Any

from pydantic import model_validator

from .friction import AnyFriction
from .part import Part
from .piece import UniformPiece
from .quantity import all_of_engine
from .schemas import POINT, Turning, checked, list_schema
from .section import Section, outer_radius_of
from .stretches import stretches
from .validation import (
    Listed,
    Name,
    Vector,
    items,
    not_negative,
    number,
    place_on,
    positive,
    shown,
    vector3,
    within,
)

if TYPE_CHECKING:
    from .cable import Cable
    from .rope import Rope

MAX_POINTS = 16
"""Of a body, as in engine/couplings/contact/contact.h."""
GAUSS_POINTS = 6
"""Of an element of a cable, also in partial contact; see tests/benchmarks/contact.py."""


EXPONENTS = (1.0, 1.5)
"""A linear spring, and Hertz's law of round bodies."""


def _exponent(value: Any) -> float:
    if (given := number(value)) not in EXPONENTS:
        raise ValueError(f"must be 1 or 1.5, got {shown(value)}")
    return given


Exponent = Annotated[float, checked(_exponent, {"enum": [1, 1.0, 1.5]})]


def _points(value: Any) -> tuple[Vector, ...]:
    """Return a list of points, in m."""
    if (given := items(value, 1, MAX_POINTS)) is None:
        raise ValueError(f"must be a list of 1 to {MAX_POINTS} points, got {shown(value)}")
    return tuple(vector3(point, "m") for point in given)


class Contact(Part):
    """Unilateral contact of a cable or a rope along its length, or of points of a body, with a `Surface`.

    It acts by penalty, with ``stiffness``, or is hard, with ``restitution``: points of a body then do not penetrate.
    The penalty force is ``stiffness d^exponent (1 + damping d')`` at the depth d, a length of a cable or on each
    point of a body. With the damping c, a ball rebounds from the speed v with e v, where v - ln(1 + c v)/c is equal for
    v and -e v. In statics friction acts against the displacement from the drawn position. On spheres about a body's
    points it acts at the point of contact, with its moment; along cables it acts on the axis.

    The spans of a rope have contact by penalty; what lies on sheaves and drums has none. Friction of a rope is
    regularised by default: a rope at rest creeps, at a part of ``friction.velocity``. With the model "stick" springs
    hold its material, which takes their stretch along as it flows, and comes from sheaves and drums without stretch. In
    statics and modes ropes have no friction on surfaces. Where `equilibrium` finds no rest of a rope on a surface,
    `relax` does.

    a: the cable, the rope or the body; a list, or "all" cables and bodies of the scene: a contact is added for each
        pair, and a name given gets a number
    b: the surface; or a list, or "all"
    stiffness: N/m a length in m, or N/m; by default the weight penetrates by 1 % of the radius, of pieces at most
    exponent: 1, or 1.5 (Hertz)
    damping: s/m (Hunt and Crossley)
    friction: Coulomb's coefficient, or a `Friction`, of cables and bodies with the model "stick", of ropes with either
    tangential_stiffness: of the spring of sticking friction, N/m; by default that of the normal force. Along a sticking
        cable or rope, tension decays over the length √(EA/tangential_stiffness)
    radius: of the cable, m, by default that of its section, of each piece its own, 0 for its centreline; of spheres
        about a body's points
    start, stop: of a cable, arc-lengths of the nodes between which it has contact, m; by default all of it
    restitution: normal velocity after an impact over that before it, 0 to 1 (Newton)
    rest_velocity: normal velocity below which points stay in contact after an impact, m/s
    points: of a body, in its axes, m; by default its origin
    """

    kind = "contact"
    group = "contacts"
    positional = ("a", "b")
    takes_lists = True
    results = all_of_engine(
        "contact",
        force="force of the surface on the cable, rope or body",
        friction_force="friction component of the force",
        penetration="largest depth below the surface",
        touching="length of the cable or rope in contact, m, or number of points in contact",
        first="first arc-length of the cable or rope in contact, NaN without contact",
        last="last arc-length of the cable or rope in contact, NaN without contact",
    ) | all_of_engine("hard_contact", gap="of a hard contact: least distance of its points from the surface, else NaN")
    name: Name | None = None
    a: Listed
    b: Listed
    stiffness: Annotated[float, positive("N/m")] | None = None
    exponent: Exponent = 1.0
    damping: Annotated[float, not_negative("s/m")] = 0.0
    friction: AnyFriction | None = None
    tangential_stiffness: Annotated[float, positive("N/m")] | None = None
    radius: Annotated[float, not_negative("m")] | None = None
    start: Annotated[float, place_on("a")] | None = None
    stop: Annotated[float, place_on("a")] | None = None
    restitution: Annotated[float, within(0, 1, ends=True)] | None = None
    rest_velocity: Annotated[float, positive("m/s")] = 1e-3
    points: Annotated[tuple[Vector, ...], checked(_points, {
        "type": "array", "items": list_schema("m"), "minItems": 1, "maxItems": MAX_POINTS},
        Turning(POINT, "a", "m"))] | None = None

    @property
    def is_hard(self) -> bool:
        """Return whether it is a constraint in place of a stiffness."""
        return self.restitution is not None

    def radius_of(self, section: Section) -> float | None:
        """Return the radius of contact of a section, m; None where neither tells it."""
        return outer_radius_of(section) if self.radius is None else self.radius

    def stretches(self, line: "Cable | Rope") -> list[UniformPiece]:
        """Return the elements of a cable or a rope in contact, by pieces with equal radii, see `UniformPiece`."""
        return stretches(line, self.start, self.stop, self.radius_of)

    @property
    def friction_coefficient(self) -> float:
        """Return Coulomb's coefficient, 0 without friction."""
        return 0.0 if self.friction is None else self.friction.coefficient

    @property
    def has_friction_spring(self) -> bool:
        """Return whether sticking friction has a spring."""
        return (not self.is_hard and self.friction is not None and self.friction.model != "regularised"
                and self.friction.coefficient > 0)

    @model_validator(mode="after")
    def _has_coulomb_friction(self) -> "Contact":
        if self.friction is not None:
            self.friction.check_coulomb()
        return self

    @model_validator(mode="after")
    def _has_one_law(self) -> "Contact":
        given = [name for name in ("stiffness", "exponent", "damping", "tangential_stiffness")
                 if getattr(self, name) != type(self).model_fields[name].default]
        if self.is_hard and given:
            raise ValueError(f"is hard by its restitution, and {given[0]} is of a contact by penalty",
                             f"leave restitution out, or {given[0]}")
        return self
