"""A pantograph as a chain of masses over a base that the train moves."""

from __future__ import annotations

from typing import Annotated

from pydantic import model_validator

from ..parts.part import Part
from ..parts.validation import list_of, not_negative, positive
from .head import Head


class Pantograph(Part):
    """A chain of masses, from the collector down to the base, which the train moves.

    masses in kg; stiffness in N/m and damping in N s/m: of the spring and the damper below each mass, the last of them
    on the base. They are free of force where the collector is at the contact wire's height at its outer droppers; each
    mass has a force against its weight. uplift in N: the static force on the lowest mass; aerodynamic in N s²/m²: times
    the square of the speed, added to it. contact_stiffness in N/m, between wire and collector; the contact of the scene
    has it in series with the dent in the wire that elements leave out, see `local_sag`. tilting_head: a `Head`
    on the first mass, with the contact strips.
    """

    masses: Annotated[tuple[float, ...], list_of("kg", least=1)]
    stiffness: Annotated[tuple[float, ...], list_of("N/m", least=1)]
    damping: Annotated[tuple[float, ...], list_of("N s/m", least=1)]
    uplift: Annotated[float, not_negative("N")]
    aerodynamic: Annotated[float, not_negative("N s²/m²")] = 0.0
    contact_stiffness: Annotated[float, positive("N/m")] = 50e3
    tilting_head: Head | None = None

    @model_validator(mode="after")
    def _is_a_chain(self) -> Pantograph:
        for name, unit in (("masses", "kg"), ("stiffness", "N/m"), ("damping", "N s/m")):
            values = getattr(self, name)
            if len(values) != len(self.masses):
                raise ValueError(f"has {len(self.masses)} masses, but {len(values)} values of {name}",
                                 "give one for each mass, for the spring and damper below it")
            if (least := min(values)) < 0 or (name == "masses" and least == 0):
                raise ValueError(f"{name} must {'be positive' if name == 'masses' else 'not be negative'}, got "
                                 f"{least:.9g} {unit}")
        for k, (stiffness, damping) in enumerate(zip(self.stiffness, self.damping, strict=True)):
            if not stiffness and not damping:
                raise ValueError(f"has nothing below mass {k + 1}", "give it stiffness or damping")
        return self

    def lift(self, speed: float) -> float:
        """Return the uplift force (N) at a speed (m/s), static and aerodynamic."""
        return self.uplift + self.aerodynamic * speed**2
