"""Events: instants at which a quantity passes a value, or a function changes sign."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Annotated, Any

from pydantic import model_validator

from .part import Part
from .schemas import ONLY_PYTHON, checked
from .validation import Name, finite, one_of, place_on, shown


def _function(value: Any) -> Any:
    if value is not None and not callable(value):
        raise ValueError(f"must be a function of (time, state), got {shown(value)}")
    return value


def _text(value: Any) -> str | None:
    if value is not None and not isinstance(value, str):
        raise ValueError(f'must be text such as "A.position.y", got {shown(value)}')
    return value


def first_times(happened: Iterable[Mapping[str, Any]]) -> dict[str, float]:
    """Return the first times of a scene's events in s by name; happened: the events of a run's report."""
    found: dict[str, float] = {}
    for each in happened:
        if "what" not in each:  # of a part
            found.setdefault(each["name"], each["time"])
    return found


class Event(Part):
    """The instants at which a quantity passes a value; steps end there.

    quantity: "A.position.y" or "A.velocity.x" of a body, "wire.position.z" or "wire.velocity.z" of the node of a cable
        at ``s``, "wire.least_strain", the least axial strain in the middles of a cable's elements, "trolley.s",
        "trolley.s_rate" or "trolley.traction" of a slide
    s: arc-length of the node of a cable, m
    value: m, m/s, N, or a strain
    function: f(time, state) that passes zero, in the place of a quantity, with state["A.position"] and the like as in
        `State`
    direction: "rising", "falling" or "both"
    action: "record", or "stop", which ends the run
    """

    kind = "event"
    group = "events"
    name: Name | None = None
    quantity: Annotated[str | None, checked(_text, {"type": "string"})] = None
    s: Annotated[float, place_on("watched")] | None = None
    value: Annotated[float, finite()] = 0.0
    function: Annotated[Any, checked(_function, ONLY_PYTHON)] = None
    direction: Annotated[str, one_of(("rising", "falling", "both"))] = "both"
    action: Annotated[str, one_of(("record", "stop"))] = "record"

    @property
    def watched(self) -> str | None:
        """Return the name of the part of its quantity, None for a function."""
        return None if self.quantity is None else self.quantity.partition(".")[0]

    def refers_to(self) -> Iterator[str]:
        """Yield the name of the part of its quantity."""
        if self.watched is not None:
            yield self.watched

    @model_validator(mode="after")
    def _watches_one_thing(self) -> "Event":
        if (self.quantity is None) == (self.function is None):
            raise ValueError("must have either a quantity or a function", 'give quantity="A.position.y" or function=f')
        if self.function is not None and (self.value or self.s is not None):
            raise ValueError("has a function, which takes neither value nor s",
                             "subtract the value in the function")
        return self
