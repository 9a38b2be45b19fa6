"""Hard cases (scenes on which integrators drift, stall or blow up), by subject, with the bounds of their figures."""

from . import cables, crossings, orders, riders
from .case import INTEGRATORS, Case, broken

CASES = [*crossings.HERE.cases, *cables.HERE.cases, *riders.HERE.cases, *orders.HERE.cases]

__all__ = ["CASES", "INTEGRATORS", "Case", "broken"]
