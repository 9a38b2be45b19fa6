"""Branches beside the elastic law of a cable, which give it memory: viscosity of a rope, friction between its wires."""

from typing import Annotated, ClassVar

from .part import Part
from .quantity import Quantity
from .validation import Name, Reference, positive


class Branch(Part):
    """Base of the branches: a spring along a cable, in series with a dashpot or with a slider."""

    group = "branches"
    positional = ("cable",)
    bends: ClassVar[bool] = False
    """Whether the spring acts on the curvature, and not on the strain."""
    name: Name | None = None
    cable: Reference

    @property
    def relaxation_time(self) -> float:
        """Return the relaxation time of a dashpot in s, 0 of a slider."""
        return 0.0

    @property
    def limit(self) -> float:
        """Return the size of the force in N or the moment in N m at which a slider slides, 0 of a dashpot."""
        return 0.0

    @property
    def spring(self) -> float:
        """Return the stiffness of the spring, N or N m²."""
        raise NotImplementedError


class Relaxation(Branch):
    """Viscosity of a rope along its axis: a spring in series with a dashpot, beside the stiffness EA of the cable.

    The cable is then a standard linear solid: EA is its stiffness for long times, EA + stiffness that for short ones. A
    spring E₁ in series with a spring E₂ beside a dashpot η (series Kelvin) is EA = E₁ E₂/(E₁ + E₂), stiffness =
    E₁²/(E₁ + E₂), time = η/(E₁ + E₂). Several relaxations of one cable make a Prony series.

    A run begins relaxed, at the strain of its start; statics, modes and frequency responses have the stiffness for long
    times. The strain is |r'| - 1 with any law.

    cable: of elements without sections, cable8p or cable12, with constant stress-free length
    stiffness: of the spring, N
    time: in which the force of the spring falls to 1/e at constant strain, s
    """

    kind = "relaxation"
    results: ClassVar = {"tension": Quantity(("time", "{part}.point"), "N", "tension of the spring beside that of EA, "
                                             "at two points of each element")}
    stiffness: Annotated[float, positive("N")]
    time: Annotated[float, positive("s")]

    @property
    def relaxation_time(self) -> float:
        """Return the relaxation time in s."""
        return self.time

    @property
    def spring(self) -> float:
        """Return the stiffness of the spring in N."""
        return self.stiffness
