"""The velocity of a fluid over height: a power of it, or a table."""

from typing import Annotated, ClassVar

import numpy as np
from pydantic import model_validator

from .part import Family, Part
from .signal import TableSignal
from .validation import check_function, list_of, not_negative, one_of, positive


class Profile(Part):
    """Base of factors of a velocity over height."""

    tag = "form"
    form: ClassVar[str]

    def factor(self, height: np.ndarray) -> np.ndarray:
        """Return the factors at heights in m, of any shape."""
        raise NotImplementedError


class PowerProfile(Profile):
    """The factor (height/reference_height)^exponent of a velocity.

    exponent: of the heights
    reference_height: where the factor is 1, m
    least_height: below it the factor stays, m

    >>> import funicular as fu
    >>> fu.PowerProfile(exponent=0.5, reference_height=10.0, least_height=2.5).factor([1.0, 10.0, 40.0]).tolist()
    [0.5, 1.0, 2.0]
    """

    form = "power"
    exponent: Annotated[float, not_negative()]
    reference_height: Annotated[float, positive("m")]
    least_height: Annotated[float, positive("m")] = 1.0

    def factor(self, height: np.ndarray) -> np.ndarray:
        """Return the factors at heights in m, of any shape."""
        return (np.maximum(height, self.least_height) / self.reference_height) ** self.exponent


class TableProfile(Profile):
    """Factors of a velocity at given heights; beyond the ends they stay.

    height: m
    factors: one for each height
    interpolation: "linear", or "cubic", a spline
    """

    form = "table"
    height: Annotated[tuple[float, ...], list_of("m", least=2)]
    factors: Annotated[tuple[float, ...], list_of("", least=2)]
    interpolation: Annotated[str, one_of(("linear", "cubic"))] = "linear"

    @model_validator(mode="after")
    def _is_a_function(self) -> "TableProfile":
        check_function(self.height, "height", "m", self.factors, "factors")
        return self

    def _table(self) -> TableSignal:
        return TableSignal(time=self.height, value=self.factors, interpolation=self.interpolation)

    def pieces(self) -> tuple[np.ndarray, np.ndarray]:
        """Return its polynomials of the height between breaks, as `Signal.pieces` does of time."""
        return self._table().pieces()

    def factor(self, height: np.ndarray) -> np.ndarray:
        """Return the factors at heights in m, of any shape."""
        return self._table().value(height)


PROFILES = Family("profile", "a profile such as PowerProfile(exponent=0.16, reference_height=10)",
                  (PowerProfile, TableProfile), Profile)
AnyProfile = Annotated[Profile, PROFILES.checked()]
