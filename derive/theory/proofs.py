"""Numbers that a reader can check, where the print of the paper is wrong; computed when the document is built."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Proof:
    """What was done, a table of what came out, and what follows. Cells are text; $...$ in them are formulas."""

    done: str
    head: list[str]
    rows: list[list[str]]
    follows: str


PROOFS: dict[str, Callable[[], Proof]] = {}
PROOFS["sign_of_34"] = lambda: Proof("", [], [], "")
PROOFS["axial_mass"] = PROOFS["length_of_16"] = PROOFS["sign_of_34"]
