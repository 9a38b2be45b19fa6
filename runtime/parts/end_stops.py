"""The ends of cables for slides: stops, and what else happens there."""

from typing import Annotated, Any, ClassVar

from pydantic import model_validator

from ..errors import near
from .part import Family, Part
from .schemas import checked
from .validation import not_negative, positive, within

WORDS = ("error", "leave")
"""The run ends with an `EndOfCableError`; the rider leaves the cable."""


class Stop(Part):
    """Base of the stops at an end of a cable."""

    tag = "stop"
    stop: ClassVar[str]


class HardStop(Stop):
    """A stop at the end of a cable.

    restitution: speed of the rider after the impact over that before it, 0 to 1
    """

    stop = "hard"
    restitution: Annotated[float, within(0, 1, ends=True)]


class Buffer(Stop):
    """A spring with a damper before the end of a cable, without tension.

    A rider that compresses it completely reaches the end, with an `EndOfCableError`.

    length: of the buffer, before the end, m
    stiffness: N/m
    damping: N s/m
    """

    stop = "buffer"
    length: Annotated[float, positive("m")]
    stiffness: Annotated[float, not_negative("N/m")]
    damping: Annotated[float, not_negative("N s/m")] = 0.0

    @model_validator(mode="after")
    def _acts(self) -> "Buffer":
        if self.stiffness == 0 and self.damping == 0:
            raise ValueError("has neither stiffness nor damping", "give one of them, or both")
        return self


STOPS = Family("stop", "a word or a stop such as HardStop(restitution=0.5)", (HardStop, Buffer))


def _end(value: Any) -> Any:
    """Return a word, or the stop that a value describes. Raises ValueError."""
    if not isinstance(value, str):
        return STOPS.part(value, "words: " + ", ".join(WORDS))
    if value not in WORDS:
        raise ValueError(f'"{value}" is not known', near(value, WORDS))
    return value


CableEnd = Annotated[Any, checked(_end, {"anyOf": [{"enum": list(WORDS)}, STOPS.schema]})]
