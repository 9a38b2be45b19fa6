"""Friction of slides: Coulomb's, viscous and rolling, regularised or with sticking."""

from __future__ import annotations

from typing import Annotated

from pydantic import model_validator

from .part import Part
from .validation import not_negative, one_of, positive, show


class Friction(Part):
    """Friction along the tangent of a slide, from its normal force N (the two multipliers) and its speed.

    coefficient: of sliding, Coulomb's; static_coefficient: of sticking, that of sliding if not given; viscous in N s/m;
    rolling: the coefficient of rolling resistance, a force of rolling N against the motion (for wheels: the arm of the
    resistance over the radius). model: "regularised", where the force rises smoothly with the speed to its full value
    at about ``velocity`` (m/s), so that a rider at rest creeps; or "stick", where it is held at rest, and the instants
    of sticking and breaking loose are found as events. On a driven slide friction acts against the drive, which gives
    so much more: it is part of the slide's traction. While the drive stands it takes none.
    """

    coefficient: Annotated[float, not_negative()] = 0.0
    static_coefficient: Annotated[float, not_negative()] | None = None
    viscous: Annotated[float, not_negative("N s/m")] = 0.0
    rolling: Annotated[float, not_negative()] = 0.0
    model: Annotated[str, one_of(("regularised", "stick"))] = "regularised"
    velocity: Annotated[float, positive("m/s")] = 1e-3

    @model_validator(mode="after")
    def _sticks_at_least_as_it_slides(self) -> Friction:
        if self.static < self.coefficient:
            raise ValueError(f"static_coefficient must not be below the coefficient of sliding "
                             f"{show(self.coefficient)}, got {show(self.static)}", "leave it out where they are equal")
        return self

    @property
    def sticks(self) -> bool:
        """Return whether it keeps a rider at rest."""
        return self.model == "stick"

    @property
    def sliding(self) -> float:
        """Return what the normal force is multiplied by: sliding and rolling."""
        return self.coefficient + self.rolling

    @property
    def static_friction(self) -> float:
        """Return what the normal force is multiplied by at rest; 0 where it does not stick."""
        return self.static + self.rolling if self.sticks else 0.0

    @property
    def static(self) -> float:
        """Return the coefficient of sticking."""
        return self.coefficient if self.static_coefficient is None else self.static_coefficient
