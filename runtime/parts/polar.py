"""Coefficients of drag and lift by the angle of attack."""

from math import pi
from typing import Annotated

import numpy as np
from pydantic import model_validator

from .part import Part
from .signal import TableSignal
from .validation import LENGTH_TOLERANCE, check_function, list_of, one_of, show

ANGLE_TOLERANCE = 1e-6
"""Of the ends of a full turn, rad."""


class Polar(Part):
    """Coefficients of a profile by its angle of attack, through a full turn from -π to π.

    The angle is that of the flow past a body from its chord, about its span; of a beam from the chord of its section,
    about the axis.

    angle: rad
    drag: one for each angle
    lift: one for each angle
    moment: of a beam alone, one for each angle, positive where it makes the angle larger: nose up, with a chord from
        the nose to the tail
    interpolation: "linear", or "cubic", a spline

    >>> import funicular as fu
    >>> plate = fu.Polar(angle=[-3.141593, -1.570796, 0, 1.570796, 3.141593], drag=[0, 2, 0, 2, 0], lift=[0] * 5)
    >>> plate.at(1.570796 / 2)
    (1.0, 0.0)
    """

    angle: Annotated[tuple[float, ...], list_of("rad", least=2)]
    drag: Annotated[tuple[float, ...], list_of("", least=2)]
    lift: Annotated[tuple[float, ...], list_of("", least=2)]
    moment: Annotated[tuple[float, ...], list_of("", least=2)] | None = None
    interpolation: Annotated[str, one_of(("linear", "cubic"))] = "linear"

    @model_validator(mode="after")
    def _is_a_turn(self) -> "Polar":
        for name in ("drag", "lift", "moment"):
            values = getattr(self, name)
            if values is None:
                continue
            check_function(self.angle, "angle", "rad", values, name)
            if abs(values[0] - values[-1]) > LENGTH_TOLERANCE * max(map(abs, values)):
                raise ValueError(f"{name} must be the same at both ends, -π and π, got {show(values[0])} and "
                                 f"{show(values[-1])}")
            self.__dict__[name] = (*values[:-1], values[0])  # exactly equal
        if abs(self.angle[0] + pi) > ANGLE_TOLERANCE or abs(self.angle[-1] - pi) > ANGLE_TOLERANCE:
            raise ValueError(f"angle must go from -π to π, got {show(self.angle[0], 'rad')} to "
                             f"{show(self.angle[-1], 'rad')}",
                             "give the coefficients for all directions of flow, beyond the stall those of a flat plate")
        if min(self.drag) < 0 or self._table(self.drag).value(np.linspace(-pi, pi, 721)).min() < -1e-9:
            raise ValueError("drag must not be negative at any angle",
                             'look at the values, or take interpolation="linear"')
        return self

    def _table(self, values: tuple[float, ...]) -> TableSignal:
        return TableSignal(time=self.angle, value=values, interpolation=self.interpolation)

    def pieces(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return breaks (n + 1,) in rad, and polynomials (n, 7) of drag, lift and moment, see `Signal.pieces`."""
        drag, lift, moment = (self._table(values).pieces() for values in self._columns)
        return drag[0], drag[1], lift[1], moment[1]

    @property
    def _columns(self) -> tuple[tuple[float, ...], ...]:
        """Return the values of drag, lift and moment."""
        return self.drag, self.lift, (0.0,) * len(self.angle) if self.moment is None else self.moment

    def at(self, angle: float) -> tuple[float, float]:
        """Return the coefficients of drag and lift at an angle in rad."""
        drag, lift, _ = self.coefficients(np.array(angle))
        return float(drag), float(lift)

    def coefficients(self, angle: np.ndarray) -> np.ndarray:
        """Return (3, ...): the coefficients of drag, lift and moment at angles (...) in rad."""
        return np.array([self._table(values).value(angle) for values in self._columns])
