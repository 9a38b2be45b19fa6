"""Contact of two lines at their closest points: of a cable with a bar or with another cable."""

from collections.abc import Iterator
from typing import Annotated, cast

from pydantic import model_validator

from .cable import Cable
from .contact import Exponent
from .friction import AnyFriction
from .part import Part
from .quantity import all_of_engine
from .section import outer_radius_of
from .validation import Listed, Name, Vector, direction, not_negative, positive, xyz


class Crossing(Part):
    """Contact of a cable with a line that crosses it, at the closest points of both.

    The line is another cable or a straight bar; both are round. The lines cannot pass through each other. Beyond the
    ends of cables and bars there is no contact; a bar that enters over its end with penetration adds its energy. A
    crossing has one point of contact, of several possible ones the closest at the start.

    a: the cable; a list, or "all" of the scene: a crossing is added for each pair, and a name given gets a number
    b: the other cable, or the body or (None) the ground that carries a bar; or a list, or "all"
    at: middle of a bar in the body's axes, m
    axis: direction of a bar in the body's axes; a bar in a planar scene is square to the plane
    length: reach of a bar to each side, m
    radius: distance of the axes in contact, m; by default the sum of the radii of the cables' sections, 0 of
        a bar
    stiffness: k of the force ``k p^e (1 + damping p')`` at the penetration p, N/m or N/m^1.5
    exponent: e, 1, or 1.5 (Hertz)
    damping: s/m (Hunt and Crossley)
    friction: a coefficient, or a `Friction`, along both lines: smooth in the speed of slip, or with the model "stick"
    tangential_stiffness: of the spring of sticking friction, N/m; by default ``stiffness``. In statics friction acts
        against the displacement from the drawn position
    side: direction from b to a, along the ground's axes; by default as at the start
    """

    kind = "crossing"
    group = "crossings"
    positional = ("a", "b")
    takes_lists = True
    results = all_of_engine(
        "crossing",
        force="contact force on the cable a",
        friction_force="friction component of the force",
        sticking="1 while the lines are in contact and stick, else 0",
        normal_force="size of the contact force along the normal",
        penetration="penetration of both lines, negative for a gap",
        s="arc-length of the closest point on the cable a",
        s_b="arc-length of the closest point on b, of a bar from its middle",
        position="closest point on the axis of the cable a",
    )
    name: Name | None = None
    a: Listed
    b: Listed | None = None
    at: Annotated[Vector | None, xyz("m", of="b")] = None
    axis: Annotated[Vector | None, direction(of="b")] = None
    length: Annotated[float, positive("m")] | None = None
    radius: Annotated[float, not_negative("m")] | None = None
    stiffness: Annotated[float, positive("N/m")]
    exponent: Exponent = 1.0
    damping: Annotated[float, not_negative("s/m")] = 0.0
    friction: AnyFriction | None = None
    tangential_stiffness: Annotated[float, positive("N/m")] | None = None
    side: Annotated[Vector | None, direction()] = None

    @property
    def has_friction_spring(self) -> bool:
        """Return whether sticking friction has a spring."""
        return self.friction is not None and self.friction.sticks

    @model_validator(mode="after")
    def _is_of_two_lines(self) -> "Crossing":
        if self.a == self.b:
            raise ValueError(f'has the cable "{self.a}" on both sides', "name two cables, or a cable and a body")
        if self.friction is not None:
            self.friction.check_coulomb()
            if self.friction.sticks and self.exponent != 1.0 and self.tangential_stiffness is None:
                raise ValueError("tangential_stiffness is missing, which the stiffness of the exponent 1.5 is not",
                                 "give it, in N/m")
        return self

    def off_plane(self) -> Iterator[str]:
        """Yield its quantities that leave the plane z = 0, see `Part.off_plane`."""
        if self.axis is not None:
            yield "a bar of some length"
        yield from super().off_plane()


def radius_of(cable: Cable) -> float:
    """Return the radius of a cable's section, m. Raises ValueError where it is not round."""
    radii = {outer_radius_of(piece.section) for piece in cable.uniform_pieces}
    if len(radii) != 1 or None in radii:
        raise ValueError(f'radius is missing, which the section of cable "{cable.name}" does not tell')
    return cast(float, radii.pop())
