"""Checked quantities and the base of the models that a scene is described with.

A quantity is ``Annotated[float, positive("m")]``; its checks raise ``ValueError(cause)`` or
``ValueError(cause, remedy)``, and `Part` turns the first of them into a `SceneError` that names its place.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from numbers import Integral, Real
from typing import Annotated, Any, ClassVar

import numpy as np
from funicular.errors import SceneError, near
from pydantic import BaseModel, BeforeValidator, ConfigDict, PlainValidator, ValidationError, model_validator

FARTHEST = 1e9
"""m: coordinates of points are not larger."""


def _real(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, Real):
        raise ValueError(f"must be a number, got {value!r}")
    try:
        return float(value)
    except OverflowError:  # an integer of more than 308 digits
        return math.inf


def number(value: Any, unit: str = "") -> float:
    """``value`` as a finite float; ValueError if it is none. Text and booleans are no numbers."""
    result = _real(value)
    if not math.isfinite(result):
        raise ValueError(f"must be finite, got {show(result, unit)}")
    return result


def vector(value: Any, unit: str = "", size: int = 3) -> tuple[float, ...]:
    """``value`` as ``size`` finite floats; ValueError if it is anything else."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if not isinstance(value, list | tuple) or len(value) != size:
        raise ValueError(f"must be {size} numbers, got {value!r}")
    numbers = tuple(map(_real, value))
    if not all(map(math.isfinite, numbers)):
        raise ValueError(f"must be finite, got {show(numbers, unit)}")
    if unit == "m" and max(map(abs, numbers), default=0.0) > FARTHEST:
        raise ValueError(f"must lie within {FARTHEST:g} m of the origin, beyond which positions are rounded to more "
                         f"than 1e-7 m, got {show(numbers, unit)}", "draw the scene nearer to the origin")
    return numbers


def show(value: float | tuple[float, ...] | np.ndarray, unit: str = "") -> str:
    """A number or vector for a message, with its unit."""
    text = f"{value:.9g}" if isinstance(value, float) else "(" + ", ".join(f"{v:.9g}" for v in value) + ")"
    return f"{text} {unit}".strip()


def one_of(known: Iterable[str], optional: bool = False) -> PlainValidator:
    """Check of a name among known ones, or of None where it may be left out; the refusal suggests the near one."""
    def check(value: Any) -> str | None:
        if value is None and optional:
            return None
        if not isinstance(value, str):
            raise ValueError(f"must be a name, got {value!r}", "known: " + ", ".join(known))
        if value not in known:
            raise ValueError(f'"{value}" is not known', near(value, known))
        return value

    return PlainValidator(check)


def finite(unit: str = "") -> PlainValidator:
    """Check of a finite number."""
    return PlainValidator(lambda value: number(value, unit))


def _bounded(unit: str, holds, rule: str) -> PlainValidator:
    def check(value: Any) -> float:
        result = number(value, unit)
        if not holds(result):
            raise ValueError(f"must {rule}, got {show(result, unit)}")
        return result

    return PlainValidator(check)


def positive(unit: str = "") -> PlainValidator:
    """Check of a finite number above 0."""
    return _bounded(unit, lambda x: x > 0, "be positive")


def not_negative(unit: str = "") -> PlainValidator:
    """Check of a finite number, 0 or above."""
    return _bounded(unit, lambda x: x >= 0, "not be negative")


def within(low: float, high: float, *, ends: bool) -> PlainValidator:
    """Check of a finite number between ``low`` and ``high``, the ends included or not."""
    if ends:
        return _bounded("", lambda x: low <= x <= high, f"lie in [{low:g}, {high:g}]")
    return _bounded("", lambda x: low < x < high, f"lie inside ({low:g}, {high:g})")


def xyz(unit: str = "") -> PlainValidator:
    """Check of three finite numbers."""
    return PlainValidator(lambda value: vector(value, unit))


def direction() -> PlainValidator:
    """Check of three finite numbers that are not all zero; their length is free."""
    def check(value: Any) -> tuple[float, ...]:
        result = vector(value)
        if not any(result):
            raise ValueError("must not be zero")
        return result

    return PlainValidator(check)


def list_of(unit: str = "", *, least: int) -> PlainValidator:
    """Check of a list of at least ``least`` finite numbers."""
    def check(value: Any) -> tuple[float, ...]:
        value = value.tolist() if isinstance(value, np.ndarray) else value
        if not isinstance(value, list | tuple) or len(value) < least:
            raise ValueError(f"must be a list of {least} numbers or more, got {value!r}")
        return vector(value, unit, len(value))

    return PlainValidator(check)


def _count(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, Integral) or value < 1:
        raise ValueError(f"must be a whole number, 1 or more, got {value!r}")
    return int(value)


def _flag(value: Any) -> bool:
    if not isinstance(value, bool | np.bool_):
        raise ValueError(f"must be true or false, got {value!r}")
    return bool(value)


def _name(value: Any) -> str:
    # Results are addressed as "name.quantity" and "cable@s": a name must leave these signs alone.
    if not isinstance(value, str) or not value.replace("-", "_").isidentifier():
        raise ValueError(f"must be made of letters, digits, _ and -, and begin with no digit, got {value!r}")
    return value


Count = Annotated[int, PlainValidator(_count)]
Flag = Annotated[bool, PlainValidator(_flag)]
Name = Annotated[str, PlainValidator(_name)]
Reference = Annotated[str, BeforeValidator(lambda value: getattr(value, "name", value))]
"""The name of a part of the scene, given as that or as the part itself."""
Vector = tuple[float, float, float]


class _TranslatingType(type(BaseModel)):
    """Makes a constructor call raise `SceneError`.

    In the metaclass and not in ``__init__``, so that a model inside another one still reports to pydantic,
    which knows the path to it.
    """

    def __call__(cls, /, **data):
        try:
            return super().__call__(**data)
        except ValidationError as error:
            raise _scene_error(cls.place(data), error) from None


class Part(BaseModel, metaclass=_TranslatingType):
    """Base of what a scene is described with: frozen, and strict about names."""

    model_config = ConfigDict(frozen=True, defer_build=True)  # built when first used: the import stays quick

    kind: ClassVar[str] = ""
    """What messages call it; the class name when empty."""

    @classmethod
    def place(cls, data: dict) -> str:
        """How messages name the part made of ``data``."""
        kind = cls.kind or cls.__name__
        return f'{kind} "{data["name"]}"' if isinstance(data.get("name"), str) else kind

    @classmethod
    def keywords(cls) -> dict[str, str]:
        """What a part is made with: the keywords, and the names of the fields that hold them."""
        return {field.alias or name: name for name, field in cls.model_fields.items()}

    @property
    def where(self) -> str:
        """How messages name this part."""
        return self.place(dict(self))

    @model_validator(mode="before")
    @classmethod
    def _knows_all_names(cls, data: Any) -> Any:
        if isinstance(data, dict):
            known = cls.keywords()
            for key in data:
                if key not in known:
                    raise ValueError(f'"{key}" is not known here', near(key, known))
        return data


def _scene_error(place: str, error: ValidationError) -> SceneError:
    """The first of pydantic's complaints in our words."""
    first = error.errors(include_url=False)[0]
    path = ".".join(map(str, first["loc"]))
    match first["type"]:
        case "value_error":
            cause, *remedy = first["ctx"]["error"].args
        case "missing":
            cause, remedy = "is missing", []
        case "model_type":
            name = first["ctx"]["class_name"]
            cause, remedy = f"must be a {name} or a table of its values, got {first['input']!r}", []
        case _:
            cause, remedy = f"{first['msg'][:1].lower() + first['msg'][1:]}, got {first['input']!r}", []
    return SceneError(place, f"{path} {cause}".strip(), *remedy)
