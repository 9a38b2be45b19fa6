"""Published cases of elements as scenes: benchmarks/cases.py prints the table, motion/test_cases.py asserts it.

Cases: S1 sliding mass; E1, E2 elements; B1 to B6, B8, B11 statics; D0, D1, D3 motions.
"""

from . import cantilevers, catenary, dynamics, element, spatial
from .case import Case, Kind, lookup

CASES = [*element.CASES, *cantilevers.CASES, *spatial.CASES, *catenary.CASES, *dynamics.CASES]

__all__ = ["CASES", "Case", "Kind", "lookup"]
