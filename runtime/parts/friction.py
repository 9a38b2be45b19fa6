"""Friction of slides, joints, contacts, crossings and ropes: Coulomb's, of slides also viscous and rolling friction."""

from numbers import Real
from typing import Annotated, Any, Self

from pydantic import BeforeValidator, model_validator

from .part import Part
from .schemas import GivenAs, number_schema
from .signal import ONE, AnySignal, check_switched
from .validation import Name, not_negative, one_of, positive, show, shown


class Friction(Part):
    """Friction of a slide, joint, contact, crossing or rope on a sheave, from normal force N and speed of sliding.

    A number in its place is the coefficient. Slides, joints and ropes find the instants at which they stick and break
    loose as events. In contacts and crossings a spring holds sticking points, and slides where its force exceeds
    friction. Friction of a driven slide acts against the drive, is part of the slide's traction, and is zero while the
    drive stands.

    coefficient: of sliding, Coulomb's
    static_coefficient: of sticking, of slides and joints; by default that of sliding
    viscous: of slides and joints, N s/m
    rolling: coefficient of rolling resistance, of slides alone, a force of rolling N against the motion (for wheels:
        the arm of the resistance over the radius)
    model: "regularised": the force rises smoothly with the speed and permits creep at rest; "stick": it holds at rest.
        By default contacts of cables and bodies with surfaces stick, others are regularised
    velocity: of "regularised", at which the force is 0.7 of its limit, m/s
    scale: factor of all coefficients over time, a signal, of slides and joints: a brake
    when, until: of slides and joints, names of the events that friction begins and ends with; ``scale`` counts its
        time from the first one
    """

    coefficient: Annotated[float, not_negative()] = 0.0
    static_coefficient: Annotated[float, not_negative()] | None = None
    viscous: Annotated[float, not_negative("N s/m")] = 0.0
    rolling: Annotated[float, not_negative()] = 0.0
    model: Annotated[str, one_of(("regularised", "stick"))] | None = None
    velocity: Annotated[float, positive("m/s")] = 1e-3
    scale: AnySignal = ONE
    when: Name | None = None
    until: Name | None = None

    @model_validator(mode="after")
    def _can_be_switched(self) -> Self:
        check_switched(self.scale, self.when, self.until)
        if min(self.scale.pieces()[1][:, 0].min() - abs(self.scale.sine.amplitude), 0.0) < 0:
            raise ValueError("scale must not be negative", "friction opposes the motion")
        return self

    @model_validator(mode="after")
    def _sticks_at_least_as_it_slides(self) -> "Friction":
        if self.static < self.coefficient:
            raise ValueError(f"static_coefficient must not be below the coefficient of sliding "
                             f"{show(self.coefficient)}, got {show(self.static)}", "leave it out where they are equal")
        return self

    @property
    def sticks(self) -> bool:
        """Return whether it sticks by its model."""
        return self.model == "stick"

    @property
    def creeps(self) -> bool:
        """Return whether it is regularised, and slides under any load."""
        return not self.sticks and self.sliding > 0

    @property
    def sliding(self) -> float:
        """Return the sum of the coefficients of sliding and rolling."""
        return self.coefficient + self.rolling

    @property
    def static_friction(self) -> float:
        """Return the sum of the coefficients of sticking and rolling; 0 where it does not stick."""
        return self.static + self.rolling if self.sticks else 0.0

    @property
    def static(self) -> float:
        """Return the coefficient of sticking."""
        return self.coefficient if self.static_coefficient is None else self.static_coefficient

    def check_of_joint(self) -> None:
        """Raise ValueError unless it is friction that joints have."""
        for name, given in (("rolling", self.rolling > 0),
                            ("static_coefficient", self.static != self.coefficient and not self.sticks)):
            if given:
                remedy = f"leave {name} out" + ', or take model="stick"' * (name == "static_coefficient")
                raise ValueError(f"friction has {name}, which joints have not"
                                 + " without sticking" * (name == "static_coefficient"), remedy)

    def check_coulomb(self) -> None:
        """Raise ValueError unless it is Coulomb friction, the friction of contacts and crossings."""
        if self.scale != ONE or self.when is not None or self.until is not None:
            raise ValueError("changes with time, which only the friction of slides and joints does",
                             "leave scale, when and until out")
        for name in ("viscous", "rolling"):
            if getattr(self, name):
                raise ValueError(f"has {name} friction, which only slides {'and joints ' * (name == 'viscous')}have",
                                 f"leave {name} out")
        if self.static != self.coefficient:
            raise ValueError("has a static_coefficient, which only slides and joints have",
                             "leave static_coefficient out")


def _friction(value: Any) -> Any:
    """Return a number as a table with that coefficient, other values as they are."""
    if isinstance(value, Real) and not isinstance(value, bool):
        return {"coefficient": value}
    if not isinstance(value, Friction | dict):
        raise ValueError(f"must be a coefficient, a Friction or a table of its values, got {shown(value)}")
    return value


AnyFriction = Annotated[Friction, BeforeValidator(
    _friction, json_schema_input_type=Annotated[float, GivenAs(number_schema(minimum=0))] | Friction)]
"""A `Friction`, a table of its values, or its coefficient."""
