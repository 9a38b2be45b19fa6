"""Axial laws of the line types of MoorDyn-2: a number, a table in a file of its own, or with viscosity."""

from __future__ import annotations

from pathlib import Path

from ..base.bounded_files import MAX_SCENE_BYTES, TooLargeError, read_bytes
from ..base.deferred import dataclass
from ..errors import SceneError, shown_path
from ..parts.tension_table import TensionTable
from ..parts.validation import show, shown
from .moordyn_file import Row

EA_COLUMN, BA_COLUMN = 3, 4
HEAD_LINES = 3
"""Of a file of a curve, before its points."""


@dataclass(frozen=True)
class AxialLaw:
    """An axial law: stiffness EA in N, that at the strain 0 of a table; damping in N s, or -ratio; with viscosity a
    spring in N with a dashpot, s, beside them.
    """

    EA: float
    damping: float
    table: TensionTable | None = None
    spring: float = 0.0
    time: float = 0.0

    @classmethod
    def of(cls, row: Row, folder: Path) -> AxialLaw:
        """Return the law of a line of the table; folder: of the file. Raises SceneError."""
        EA, BA = (row.word(k, what).split("|") for k, what in ((EA_COLUMN, "EA"), (BA_COLUMN, "BA/-zeta")))
        if EA[0].upper().startswith("SYROPE:") or len(EA) > 2:
            raise row.refused(f"the axial law {shown(row.words[EA_COLUMN])} is not read",
                              "known: a number, a file of strain and tension, static|dynamic stiffness")
        if len(BA) > len(EA):
            raise row.refused(f"BA must have no more numbers than EA, got {shown(row.words[BA_COLUMN])}")
        damping = _number(row, BA[0], "BA")
        if len(EA) == 1:
            table = None if _is_number(EA[0]) else _table(row, folder / EA[0])
            stiffness = _number(row, EA[0], "EA") if table is None else float(table.force[1] / table.strain[1])
            if not stiffness > 0:
                raise row.refused(f"EA must be positive, got {show(stiffness)}")
            return cls(stiffness, damping, table)
        static, dynamic = (_number(row, each, "EA") for each in EA)
        if not dynamic > static > 0:
            raise row.refused(f"EA must be static|dynamic stiffness, the dynamic one larger, got "
                              f"{shown(row.words[EA_COLUMN])}")
        slow, fast = damping, _number(row, BA[1], "BA") if len(BA) > 1 else 0.0
        if not slow > 0 or fast < 0:
            raise row.refused("BA must be that of the static and of the dynamic stiffness, the first one positive, "
                              f"got {shown(row.words[BA_COLUMN])}")
        return cls._viscous(static, dynamic, slow, fast)

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


def _table(row: Row, path: Path) -> TensionTable:
    """Return the table of a file: three lines of heading, then strain and tension in N. Raises SceneError."""
    name = shown_path(path)
    try:
        lines = read_bytes(path, MAX_SCENE_BYTES, "give fewer points").decode("utf-8", "replace").splitlines()
    except TooLargeError as error:
        raise SceneError(name, *error.args) from None
    except (OSError, ValueError) as error:
        raise row.refused(f"EA is no number, and the file {name} cannot be read: "
                          f"{getattr(error, 'strerror', None) or error}") from None
    points = [Row(f"{name}, line {number}", tuple(line.split())) for number, line in enumerate(lines, start=1)
              if number > HEAD_LINES and line.strip()]
    strain, force = ([each.number(k, what) for each in points] for k, what in ((0, "strain"), (1, "tension")))
    at_zero = [k for k, each in enumerate(strain) if each == 0]
    if at_zero and force[at_zero[0]] == 0:  # a line of MoorDyn does not push
        strain, force = strain[at_zero[0] :], force[at_zero[0] :]
    try:
        return TensionTable(strain=strain, force=force)
    except SceneError as error:
        raise error.inside(name) from None
