"""Hard cases (scenes on which integrators drift, stall or blow up), by subject, with the bounds of their figures."""

from . import cables, catenaries, crossings, moving_loads, orders, riders, steps
from .case import INTEGRATORS, Case, broken

CASES = [*crossings.HERE.cases, *cables.HERE.cases, *riders.HERE.cases, *steps.HERE.cases,
         *orders.HERE.cases, *moving_loads.HERE.cases, *catenaries.HERE.cases]

__all__ = ["CASES", "INTEGRATORS", "Case", "broken"]
