"""Branches beside the elastic law of a cable, which give it memory: viscosity of a rope, friction between its wires."""

from typing import TYPE_CHECKING, Annotated, ClassVar

from .part import Part
from .quantity import Quantity
from .schemas import DIRECTION
from .validation import Name, Reference, positive


class Branch(Part):
    """Base of the branches: a spring along a cable, in series with a dashpot or with a slider."""

    group = "branches"
    positional = ("cable",)
    bends: ClassVar[bool] = False
    """Whether the spring acts on the curvature, and not on the strain."""
    name: Name | None = None
    cable: Reference
    if TYPE_CHECKING:  # each has its own unit
        stiffness: float

    @property
    def relaxation_time(self) -> float:
        """Return the relaxation time of a dashpot in s, 0 of a slider."""
        return 0.0

    @property
    def limit(self) -> float:
        """Return the size of the force in N or the moment in N m at which a slider slides, 0 of a dashpot."""
        return 0.0

    @property
    def stress(self) -> str:
        """Return the name of the result that is the force or the moment of the spring."""
        return f"{self.name}.{next(iter(self.results))}"


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


class WireFriction(Branch):
    """Friction between the wires of a rope in bending: a spring in series with a slider, beside the stiffness EI.

    EI of the cable is then the bending stiffness of loose wires, that of each wire by itself. While the wires stick
    together the stiffness is EI + stiffness, up to that of a solid rod; where the moment of friction reaches its limit
    they slide. Bent to and fro by the curvature κ, a length takes 4 moment (κ - moment/stiffness) of energy in a cycle,
    which is in ``energy.dissipated``. Several of them with other limits make a curved loop.

    The wires are without friction's moment where the cable is straight: at rest the moment is that of bending from
    there. Modes have the stiffness of wires that stick, where these do not slide at rest. In space a section does not
    turn about the tangent: the plane of the moment follows the tangent alone.

    cable: of elements without sections, cable8p or cable12, straight where it is free of stress
    stiffness: of the spring, N m²
    moment: limit of friction, N m
    """

    kind = "wire_friction"
    bends = True
    results: ClassVar = {
        "moment": Quantity(("time", "{part}.point", "xyz"), "N m", "moment of friction beside that of EI, at two "
                           "points of each element", DIRECTION),
        "sliding": Quantity(("time", "{part}.point"), "1", "1 where the wires slide, else 0"),
    }
    stiffness: Annotated[float, positive("N m²")]
    moment: Annotated[float, positive("N m")]

    @property
    def limit(self) -> float:
        """Return the moment in N m at which the wires slide."""
        return self.moment
