"""Temperatures, as differences from that of the stress-free state."""

from typing import Any

from .signal import Signal, varying
from .validation import finite

TEMPERATURE = varying(finite("K"))
"""The check of a temperature, a number or a signal."""


def as_temperature(value: Any) -> float | Signal:
    """Return a temperature in K, a number or a signal. Raises ValueError."""
    return TEMPERATURE.func(value)  # type: ignore[call-arg]  # a function of the value alone
