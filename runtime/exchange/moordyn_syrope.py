"""Ropes of fibres of MoorDyn-2 (Syrope): first loading by a table, working curves below it, and fast changes."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ..base.deferred import dataclass
from ..parts.cubic_segments import value
from ..parts.tension_table import TensionTable
from ..parts.validation import show, shown
from .moordyn_file import Row

FORMS = {"linear": "linear", "quadratic": "quadratic", "exp": "exponential"}
"""Of working curves: the words of MoorDyn in small letters, and those of a `WorkingCurve`."""
SETTINGS = ("owc", "wctype", "k1", "k2")
"""Names of the settings in a file of working curves, in small letters."""
DIFFERENCE = 1e-4
"""Of strains, for a slope of first loading, over the last strain of its table."""


class Loaded(NamedTuple):
    """Mean tensions of a line before the start, N: the highest one, and that at the start."""

    highest: float = 0.0
    mean: float = 0.0


@dataclass(frozen=True)
class Syrope:
    """Working curves: form and bend as of a `WorkingCurve`; k1, which sets the strain without force; the strain at
    which the file of first loading begins; the stiffness of fast changes in N, constant and over the mean tension.
    """

    form: str
    k1: float
    bend: float
    begins: float
    stiffness: tuple[float, float]

    @classmethod
    def of(cls, row: Row, settings: dict[str, Row], begins: float, stiffness: tuple[float, float]) -> Syrope:
        """Return the curves by the settings of a file. Raises SceneError."""
        word = settings["wctype"].words[0]
        if (form := FORMS.get(word.lower())) is None:
            raise settings["wctype"].refused(f"WCType {shown(word)} is not known", "known: LINEAR, QUADRATIC, EXP")
        k1, k2 = (settings[name].number(0, name) for name in ("k1", "k2"))
        if k1 < 0 or (k1 >= 1 and form != "linear"):
            raise settings["k1"].refused(f"k1 must be from 0 to below 1 with {word}, got {show(k1)}")
        if not all(each >= 0 for each in stiffness) or not stiffness[0] > 0:
            raise row.refused("the stiffness of fast changes must be positive, and not fall with the mean tension, got "
                              f"{show(stiffness[0], 'N')} and {show(stiffness[1])}")
        return cls(form, k1, 0.0 if form == "linear" else k2, begins, stiffness)

    def permanent(self, row: Row, table: TensionTable, highest: float) -> float:
        """Return the permanent strain as a share of the highest one, that of a tension in N. Raises SceneError."""
        if not self.depends_on_tension:
            return self.k1
        if not highest > 0:
            raise row.refused("the permanent strain depends on the highest tension, which is missing",
                              "give Tmax0 of the line in the table SYROPE IC")
        top = table.strain_at(highest)
        low = top - highest / self.k1 if self.k1 >= 1 else self.begins + self.k1 * (top - self.begins)
        if not 0 <= low < top:
            raise row.refused(f"the working curve from {show(highest, 'N')} begins at the strain {low:.3g}, not "
                              f"between 0 and {top:.3g}")
        return low / top

    @property
    def depends_on_tension(self) -> bool:
        """Return whether the permanent strain is no constant share of the highest one."""
        return self.k1 >= 1 or self.begins > 0

    def curve(self, row: Row, table: TensionTable, loaded: Loaded) -> dict[str, Any]:
        """Return the arguments of the `WorkingCurve` of a line. Raises SceneError."""
        return {"permanent": self.permanent(row, table, loaded.highest), "form": self.form, "bend": self.bend,
                "highest_tension": loaded.highest}

    def static_and_dynamic(self, row: Row, table: TensionTable, loaded: Loaded) -> tuple[float, float]:
        """Return the slope of the working curve at the mean tension, and the stiffness of fast changes there, N.

        On first loading the slope is that of its table. Raises SceneError.
        """
        dynamic = self.stiffness[0] + self.stiffness[1] * loaded.mean
        if loaded.highest > loaded.mean:
            top = table.strain_at(loaded.highest)
            slope = self._slope(loaded.mean / loaded.highest) * loaded.highest / (
                top * (1 - self.permanent(row, table, loaded.highest)))
        else:
            step = DIFFERENCE * table.strain[-1]
            forces = value(table.numbers(), table.strain_at(loaded.mean) + step * np.array([1.0, 2.0]))
            slope = float(forces[1] - forces[0]) / step
        if not dynamic > slope:
            raise row.refused(f"the stiffness of fast changes, {show(dynamic, 'N')} at the mean tension "
                              f"{show(loaded.mean, 'N')}, must be above that of slow ones there, {show(slope, 'N')}")
        return slope, dynamic

    def _slope(self, share: float) -> float:
        """Return the slope of the shape from 0 to 1 where it has this value."""
        b = self.bend
        if self.form == "quadratic" and b > 0:
            return math.sqrt((1 - b) ** 2 + 4 * b * share)
        if self.form == "exponential" and b > 0:
            return b * (share + 1 / math.expm1(b))
        return 1.0
