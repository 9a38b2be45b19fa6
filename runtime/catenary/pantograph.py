"""A pantograph as a chain of masses over a base that the train moves."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from pydantic import model_validator

from ..parts.part import Part
from ..parts.schemas import checked
from ..parts.validation import not_negative, positive, shown, vector


def _each(unit: str, above: bool) -> Any:
    """Return the check of a list of one or more numbers, which are not negative, or positive (above)."""
    def check(value: Any) -> tuple[float, ...]:
        value = value.tolist() if isinstance(value, np.ndarray) else value
        if not isinstance(value, list | tuple) or not value:
            raise ValueError(f"must be a list of numbers, one at least, got {shown(value)}")
        numbers = vector(value, unit, len(value))
        for number in numbers:
            if number < 0 or (above and number == 0):
                raise ValueError(f"must {'be above nil' if above else 'not be negative'}, got {number:.9g} {unit}")
        return numbers

    return checked(check, {"type": "array", "items": {"type": "number"}})


class Pantograph(Part):
    """A chain of masses, from the collector down to the base, which the train moves.

    masses in kg; stiffness in N/m and damping in N s/m: of the spring and the damper below each mass, the last of them
    on the base. They are free of force where the collector is at the contact wire's height at its outer droppers; each
    mass has a force against its weight. uplift in N: the static force on the lowest mass; aerodynamic in N s²/m²: times
    the square of the speed, added to it. contact_stiffness in N/m, between wire and collector; the contact of the scene
    has it in series with the dent in the wire that elements leave out, see `local_sag`.
    """

    masses: Annotated[tuple[float, ...], _each("kg", above=True)]
    stiffness: Annotated[tuple[float, ...], _each("N/m", above=False)]
    damping: Annotated[tuple[float, ...], _each("N s/m", above=False)]
    uplift: Annotated[float, not_negative("N")]
    aerodynamic: Annotated[float, not_negative("N s²/m²")] = 0.0
    contact_stiffness: Annotated[float, positive("N/m")] = 50e3

    @model_validator(mode="after")
    def _is_a_chain(self) -> Pantograph:
        for name in ("stiffness", "damping"):
            if len(getattr(self, name)) != len(self.masses):
                raise ValueError(f"has {len(self.masses)} masses, but {len(getattr(self, name))} values of {name}",
                                 "give one for each mass, of what is below it")
        for k, (stiffness, damping) in enumerate(zip(self.stiffness, self.damping, strict=True)):
            if not stiffness and not damping:
                raise ValueError(f"has nothing below mass {k + 1}", "give it stiffness or damping")
        return self

    def lift(self, speed: float) -> float:
        """Return the uplift force (N) at a speed (m/s), static and aerodynamic."""
        return self.uplift + self.aerodynamic * speed**2
