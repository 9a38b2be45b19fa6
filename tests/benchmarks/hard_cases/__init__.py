"""Hard cases (scenes on which integrators drift, stall or diverge), by subject, with the bounds of their figures."""

from . import (
    cables,
    catenaries,
    contacts,
    crossings,
    flows,
    moving_loads,
    one_sided,
    orders,
    riders,
    steps,
    touching_lines,
)
from .case import INTEGRATORS, Case, broken

CASES = [*crossings.HERE.cases, *cables.HERE.cases, *riders.HERE.cases, *steps.HERE.cases,
         *orders.HERE.cases, *moving_loads.HERE.cases, *contacts.HERE.cases, *one_sided.HERE.cases, *flows.HERE.cases,
         *touching_lines.HERE.cases, *catenaries.HERE.cases]

__all__ = ["CASES", "INTEGRATORS", "Case", "broken"]
