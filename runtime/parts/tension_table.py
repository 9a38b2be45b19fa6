"""Axial forces of cables by their strain, from tables: monotone cubic segments."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated

import numpy as np
from pydantic import model_validator

from .cubic_segments import TRANSITION_STRAIN, giving_way, numbers, value
from .part import Part
from .validation import check_function, list_of, show

MAX_POINTS = 20
STRAIN_ROUNDING = 4e-16


class TensionTable(Part):
    """Axial force of a cable by its engineering strain, as from a test machine, for membrane="tabulated".

    Between the points it is a cubic whose slopes keep it increasing (Fritsch & Butland, SIAM J. Sci. Stat. Comput. 5
    (1984) 300-304), beyond them straight. A table that begins at 0 is of a cable that only pulls: in compression it
    keeps 1e-4 of the stiffness.

    strain: increasing, one of them 0; at most 20
    force: N, increasing, 0 at the strain 0

    >>> import funicular as fu
    >>> fu.TensionTable(strain=[0, 0.01, 0.03], force=[0, 2e3, 1e4]).force
    (0.0, 2000.0, 10000.0)
    """

    strain: Annotated[tuple[float, ...], list_of("", least=2)]
    force: Annotated[tuple[float, ...], list_of("N", least=2)]

    @model_validator(mode="after")
    def _is_a_law(self) -> TensionTable:
        check_function(self.strain, "strain", "", self.force, "force")
        if len(self.strain) > MAX_POINTS:
            raise ValueError(f"has {len(self.strain)} points, at most {MAX_POINTS} are possible",
                             "give fewer points where the force is straight")
        if not np.diff(self.strain).min() > TRANSITION_STRAIN:
            raise ValueError(f"strain must increase by more than {TRANSITION_STRAIN:g} between points")
        if not self.strain[0] > -1:
            raise ValueError(f"strain must be above -1, got {self.strain[0]:g}")
        for before, after in pairwise(self.force):
            if not after > before:
                raise ValueError(f"force must increase with strain, got {show(after, 'N')} after {show(before, 'N')}",
                                 "a cable whose force falls has no stable length: leave out the points beyond the "
                                 "largest force")
        if 0.0 not in self.strain or not self.strain[-1] > 0:
            raise ValueError(f"strain must contain 0 and end above it, got {show(self.strain)}",
                             "add the point of strain 0 and force 0")
        if (at_rest := self.force[self.strain.index(0.0)]) != 0.0:
            raise ValueError(f"force must be 0 at the strain 0, got {show(at_rest, 'N')}",
                             "count strain from the length without force, and give that as rest_length")
        return self

    @property
    def only_pulls(self) -> bool:
        """Return whether the cable gives way in compression."""
        return self.strain[0] == 0.0

    @property
    def compressive_stiffness(self) -> float:
        """Return the axial stiffness in compression in N: the slope at the strain 0, or the residual stiffness."""
        strain, _, slopes = self._points()
        return float(slopes[0] if self.only_pulls else np.interp(0.0, strain, slopes))

    def _points(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return strain, force and slope where segments meet."""
        from scipy.interpolate import PchipInterpolator  # slow to import

        x, N = np.array(self.strain), np.array(self.force)
        slopes = PchipInterpolator(x, N).derivative()(x)
        return giving_way(x, N, slopes) if self.only_pulls else (x, N, slopes)

    def strain_at(self, force: float) -> float:
        """Return the strain at a force in N, 0 or above."""
        first, low, high = self.numbers(), 0.0, self.strain[-1]
        while float(value(first, np.array(high))) < force:
            low, high = high, 2 * high
        while high - low > STRAIN_ROUNDING * high:
            middle = (low + high) / 2
            low, high = (low, middle) if float(value(first, np.array(middle))) >= force else (middle, high)
        return high if force > 0 else 0.0

    def numbers(self) -> np.ndarray:
        """Return the numbers of its segments, as kernels take them."""
        return numbers(*self._points())
