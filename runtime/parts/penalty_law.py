"""The exponent of the penetration in the laws of contact by penalty."""

from __future__ import annotations

from typing import Annotated, Any

from .schemas import checked
from .validation import number, shown

EXPONENTS = (1.0, 1.5)
"""A linear spring, and Hertz's law of round bodies."""


def _exponent(value: Any) -> float:
    if (given := number(value)) not in EXPONENTS:
        raise ValueError(f"must be 1 or 1.5, got {shown(value)}")
    return given


Exponent = Annotated[float, checked(_exponent, {"enum": [1, 1.0, 1.5]})]
