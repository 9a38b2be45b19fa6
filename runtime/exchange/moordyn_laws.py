"""Axial laws of the line types of MoorDyn-2: a number, a table in a file of its own, or with viscosity."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..base.bounded_files import MAX_SCENE_BYTES, TooLargeError, read_bytes
from ..base.deferred import dataclass
from ..errors import SceneError, shown_path
from ..parts.tension_table import MAX_POINTS, TensionTable
from ..parts.validation import show, shown
from .moordyn_file import Row
from .moordyn_syrope import SETTINGS, Loaded, Syrope

EA_COLUMN, BA_COLUMN = 3, 4
SYROPE = "SYROPE:"
"""Before the file of working curves."""
HEAD_LINES = 3
"""Of a file of a curve, before its points."""


@dataclass(frozen=True)
class AxialLaw:
    """An axial law: stiffness EA in N, that at the strain 0 of a table; damping in N s, or -ratio; with viscosity a
    spring in N with a dashpot, s, beside them; working curves, and the damping of slow and of fast changes, of which
    `under` makes the viscosity; notes on what it leaves out.
    """

    EA: float
    damping: float
    table: TensionTable | None = None
    spring: float = 0.0
    time: float = 0.0
    curves: Syrope | None = None
    dampings: tuple[float, float] = (0.0, 0.0)
    notes: tuple[str, ...] = ()

    @classmethod
    def of(cls, row: Row, folder: Path) -> AxialLaw:
        """Return the law of a line of the table; folder: of the file. Raises SceneError."""
        EA, BA = (row.word(k, what).split("|") for k, what in ((EA_COLUMN, "EA"), (BA_COLUMN, "BA/-zeta")))
        is_syrope = EA[0].upper().startswith(SYROPE) and len(EA) == 3
        if len(EA) > 2 and not is_syrope:
            raise row.refused(f"the axial law {shown(row.words[EA_COLUMN])} is not read", "known: a number, a file of "
                              "strain and tension, static|dynamic stiffness, SYROPE:file|stiffness|its growth")
        if len(BA) > len(EA):
            raise row.refused(f"BA must have no more numbers than EA, got {shown(row.words[BA_COLUMN])}")
        damping = _number(row, BA[0], "BA")
        if is_syrope:
            return cls._syrope(row, EA, (damping, _number(row, BA[1], "BA") if len(BA) > 1 else 0.0), folder)
        if len(EA) == 1:
            notes = list[str]()
            table = None if _is_number(EA[0]) else _table(row, folder / EA[0], notes)[0]
            stiffness = _number(row, EA[0], "EA") if table is None else float(table.force[1] / table.strain[1])
            if not stiffness > 0:
                raise row.refused(f"EA must be positive, got {show(stiffness)}")
            return cls(stiffness, damping, table, notes=tuple(notes))
        static, dynamic = (_number(row, each, "EA") for each in EA)
        if not dynamic > static > 0:
            raise row.refused(f"EA must be static|dynamic stiffness, the dynamic one larger, got "
                              f"{shown(row.words[EA_COLUMN])}")
        slow, fast = damping, _number(row, BA[1], "BA") if len(BA) > 1 else 0.0
        _check_dampings(row, slow, fast)
        return cls._viscous(static, dynamic, slow, fast)

    @classmethod
    def _syrope(cls, row: Row, EA: list[str], dampings: tuple[float, float], folder: Path) -> AxialLaw:
        """Return the law of a rope of fibres. Raises SceneError."""
        _check_dampings(row, *dampings)
        name, lines = _lines(row, folder / EA[0][len(SYROPE):])
        given = [Row(f"{name}, line {number}", tuple(line.split())) for number, line in enumerate(lines, start=1)]
        settings = {each.words[1].lower(): each for each in given if len(each.words) > 1}
        if missing := [setting for setting in SETTINGS if setting not in settings]:
            raise SceneError(name, f"has no {', no '.join(missing)}", "give a value and its name on each line: OWC, "
                             "WCType, k1, k2")
        notes = list[str]()
        table, begins = _table(row, folder / settings["owc"].words[0], notes)
        stiffness = _number(row, EA[1], "EA"), _number(row, EA[2], "EA")
        curves = Syrope.of(row, settings, begins, stiffness)
        return cls(float(table.force[1] / table.strain[1]), 0.0, table, curves=curves, dampings=dampings,
                   notes=tuple(notes))

    def under(self, row: Row, loaded: Loaded) -> AxialLaw:
        """Return the law of a line of a rope of fibres, with its viscosity at mean tensions. Raises SceneError."""
        if self.curves is None or self.table is None:
            return self
        viscous = self._viscous(*self.curves.static_and_dynamic(row, self.table, loaded), *self.dampings)
        return replace(self, damping=viscous.damping, spring=viscous.spring, time=viscous.time)

    @classmethod
    def _viscous(cls, static: float, dynamic: float, slow: float, fast: float) -> AxialLaw:
        """Return the law of two springs with dashpots beside them, in series, by partial fractions of its impedance.

        (E₁ + η₁ p)(E₂ + η₂ p)/(E₁ + E₂ + (η₁ + η₂) p) = EA + η p + k τ p/(1 + τ p)
        """
        first = dynamic * static / (dynamic - static)
        dashpots, springs = slow + fast, first + dynamic
        return cls(static, slow * fast / dashpots, spring=((first * fast - slow * dynamic) / dashpots) ** 2 / springs,
                   time=dashpots / springs)


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _number(row: Row, word: str, what: str) -> float:
    return Row(row.where, (word,)).number(0, what)


def _check_dampings(row: Row, slow: float, fast: float) -> None:
    if not slow > 0 or fast < 0:
        raise row.refused("BA must be that of the static and of the dynamic stiffness, the first one positive, "
                          f"got {shown(row.words[BA_COLUMN])}")


def _lines(row: Row, path: Path) -> tuple[str, list[str]]:
    """Return the name of a file in messages, and its lines. Raises SceneError."""
    name = shown_path(path)
    try:
        return name, read_bytes(path, MAX_SCENE_BYTES, "give fewer points").decode("utf-8", "replace").splitlines()
    except TooLargeError as error:
        raise SceneError(name, *error.args) from None
    except (OSError, ValueError) as error:
        raise row.refused(f"EA is no number, and the file {name} cannot be read: "
                          f"{getattr(error, 'strerror', None) or error}") from None


def _thinned(strain: list[float], force: list[float]) -> tuple[np.ndarray, float]:
    """Return the numbers of the points to keep, `MAX_POINTS` at most, and the largest change of the force of straight
    lines between them, N. The point that changes it least is left out first; ends and the strain 0 stay.
    """
    x, N = np.array(strain), np.array(force)
    kept = np.arange(len(x))
    while len(kept) > MAX_POINTS:
        changes = [math.inf if x[k] == 0 else np.abs(
            np.interp(x[kept[i - 1] : kept[i + 1]], x[kept[[i - 1, i + 1]]], N[kept[[i - 1, i + 1]]])
            - N[kept[i - 1] : kept[i + 1]]).max() for i, k in enumerate(kept[1:-1], start=1)]
        kept = np.delete(kept, 1 + int(np.argmin(changes)))
    return kept, float(np.abs(np.interp(x, x[kept], N[kept]) - N).max())


def _table(row: Row, path: Path, notes: list[str]) -> tuple[TensionTable, float]:
    """Return the table of a file, three lines of heading, then strain and tension in N, and the strain of its first
    point; notes: of what is changed. Raises SceneError.
    """
    name, lines = _lines(row, path)
    points = [Row(f"{name}, line {number}", tuple(line.split())) for number, line in enumerate(lines, start=1)
              if number > HEAD_LINES and line.strip()]
    strain, force = ([each.number(k, what) for each in points] for k, what in ((0, "strain"), (1, "tension")))
    at_zero = [k for k, each in enumerate(strain) if each == 0]
    if at_zero and force[at_zero[0]] == 0:  # a line of MoorDyn does not push
        strain, force = strain[at_zero[0] :], force[at_zero[0] :]
    begins = strain[0] if strain else 0.0
    if begins > 0:
        notes.append(f"{name}: begins at the strain {begins:.4g}, after three lines of heading; from there to 0 the "
                     "rope has a straight line to no force")
        strain, force = [0.0, *strain], [0.0, *force]
    if len(strain) > MAX_POINTS:
        kept, change = _thinned(strain, force)
        notes.append(f"{name}: {MAX_POINTS} of {len(strain)} points are taken; between them the force changes by up to "
                     f"{show(change, 'N')}")
        strain, force = [strain[k] for k in kept], [force[k] for k in kept]
    try:
        return TensionTable(strain=strain, force=force), begins
    except SceneError as error:
        raise error.inside(name) from None
