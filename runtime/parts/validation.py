"""Checks of the values of parts.

A quantity is ``Annotated[float, positive("m")]``. Its check raises ``ValueError(cause)`` or
``ValueError(cause, remedy)``, which `Part` turns into a `SceneError` that names the place.

Bounds (`LIMITS`) keep all powers and products in the equations within the range of double precision: a moment of a
section, for instance, is the sixth power of a radius.
"""

from __future__ import annotations

import itertools
import math
import reprlib
from collections.abc import Callable, Iterable
from numbers import Integral, Real
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator

from ..errors import near
from .schemas import AXIS, DIRECTION, POINT, Check, Place, Turning, checked, list_schema, number_schema

LIMITS = {"m": (1e-12, 1e9), "s": (1e-12, 1e12), "m²": (1e-24, 1e24), "m⁴": (1e-48, 1e48)}
"""Smallest positive and largest absolute value by unit; `OTHER_LIMITS` for other units."""

OTHER_LIMITS = (1e-30, 1e30)

MAX_COUNT = 1_000_000
"""Of elements of a cable, modes, iterations."""

LENGTH_TOLERANCE = 1e-9
"""Difference of equal lengths over the length of a cable or the size of a body."""

MAX_NAME_LENGTH = 100
"""Characters: a name and the name of a quantity together are a name in a netCDF file."""


class _Short(reprlib.Repr):
    """Text of values in messages, of bounded length."""

    def __init__(self) -> None:
        super().__init__()
        self.maxlevel, self.maxstring, self.maxother = 4, 80, 120
        self.maxlist = self.maxtuple = self.maxdict = 12

    def repr_int(self, value: int, level: int) -> str:
        """Return the text of an integer; Python refuses to write thousands of digits."""
        return repr(value) if value.bit_length() < 256 else f"an integer of {value.bit_length()} bits"

    def repr_ndarray(self, value: np.ndarray, level: int) -> str:
        """Return an array as lists."""
        return str(self.repr1(value.tolist(), level))


shown = _Short().repr
"""Return a value as messages quote it, shortened where it is long or deeply nested."""


def items(value: Any, least: int, most: float = math.inf) -> list[Any] | None:
    """Return the items of a list, tuple or array; None for anything else, and where their number is out of range."""
    value = value.tolist() if isinstance(value, np.ndarray) else value
    return [*value] if isinstance(value, list | tuple) and least <= len(value) <= most else None


_FLOATS = frozenset({float})


def _real(value: Any) -> float:
    if type(value) is float:  # a tenth of the time of the check below
        return value
    if type(value) is not int and (isinstance(value, bool) or not isinstance(value, Real)):
        raise ValueError(f"must be a number, got {shown(value)}")
    try:
        return float(value)
    except OverflowError:  # an integer of more than 308 digits
        return math.inf


def _in_range(value: float | tuple[float, ...], numbers: tuple[float, ...], unit: str) -> None:
    """Raise ValueError unless all numbers of a value are finite and within the limits of their unit."""
    if not all(map(math.isfinite, numbers)):
        raise ValueError(f"must be finite, got {show(value, unit)}")
    largest = LIMITS.get(unit, OTHER_LIMITS)[1]
    if max(map(abs, numbers), default=0.0) > largest:
        raise ValueError(f"must not exceed {show(largest, unit)} in size, got {show(value, unit)}")


def number(value: Any, unit: str = "") -> float:
    """Return ``value`` as a finite float within `LIMITS`. Raises ValueError, also for text and booleans."""
    result, largest = _real(value), LIMITS.get(unit, OTHER_LIMITS)[1]
    if not -largest <= result <= largest:
        _in_range(result, (result,), unit)
    return result


def vector(value: Any, unit: str = "", size: int = 3) -> tuple[float, ...]:
    """Return ``value`` as ``size`` finite floats within `LIMITS`. Raises ValueError."""
    if (given := items(value, size, size)) is None:
        raise ValueError(f"must be {size} numbers, got {shown(value)}")
    numbers = tuple(given if _FLOATS.issuperset(map(type, given)) else map(_real, given))
    largest = LIMITS.get(unit, OTHER_LIMITS)[1]
    for each in numbers:
        if not -largest <= each <= largest:
            if unit == "m" and largest < max(map(abs, numbers)) < math.inf:
                raise ValueError(f"must lie within {largest:g} m of the origin, beyond which positions are rounded to "
                                 f"more than 1e-7 m, got {show(numbers, unit)}", "draw the scene nearer to the origin")
            _in_range(numbers, numbers, unit)
    return numbers


def vector3(value: Any, unit: str = "") -> Vector:
    """Return ``value`` as three finite floats within `LIMITS`. Raises ValueError."""
    x, y, z = vector(value, unit)
    return x, y, z


def symmetric(value: Any, unit: str, check: Callable[[np.ndarray], None]) -> Matrix:
    """Return the rows of a symmetric matrix (3, 3) of finite floats from its rows or its diagonal. Raises ValueError.

    check: raises ValueError for a matrix with other faults.
    """
    rows = items(value, 3, 3)
    if rows is not None and all(isinstance(row, list | tuple) for row in rows):
        matrix = np.array([vector(row, unit) for row in rows])
        if not (np.abs(matrix - matrix.T) <= 1e-12 * np.abs(matrix).max()).all():
            raise ValueError(f"must be symmetric, got {matrix.tolist()}")
    else:
        xx, yy, zz = vector(value, unit)
        matrix = np.array([[xx, 0.0, 0.0], [0.0, yy, 0.0], [0.0, 0.0, zz]])
    check(matrix)
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = matrix.tolist()
    return (xx, xy, xz), (yx, yy, yz), (zx, zy, zz)


def show(value: float | tuple[float, ...] | np.ndarray, unit: str = "") -> str:
    """Return the text of a number or vector in messages, with its unit."""
    if isinstance(value, float):
        return f"{value:z.9g} {unit}".strip()
    numbers = [f"{v:z.9g}" for v in value]
    if len(numbers) > 12:
        numbers[6:-3] = ["..."]
    return f"({', '.join(numbers)}) {unit}".strip()


def one_of(known: Iterable[str], optional: bool = False) -> Check:
    """Return the check of a known name, or None if optional; its message suggests the nearest name."""
    known = tuple(known)

    def check(value: Any) -> str | None:
        if value is None and optional:
            return None
        if not isinstance(value, str):
            raise ValueError(f"must be a name, got {shown(value)}", "known: " + ", ".join(known))
        if value not in known:
            raise ValueError(f'"{value}" is not known', near(value, known))
        return value

    return checked(check, {"enum": list(known)})


def bounded(unit: str, allowed: Callable[[float], bool], rule: str, **bounds: float) -> Check:
    """Return the check of a finite, allowed number; rule: in words, as "be positive"; bounds: of JSON Schema."""
    def check(value: Any) -> float:
        result = number(value, unit)
        if not allowed(result):
            raise ValueError(f"must {rule}, got {show(result, unit)}")
        return result

    return checked(check, number_schema(unit, **bounds))


def finite(unit: str = "") -> Check:
    """Return the check of a finite number."""
    return checked(_floats_within(-LIMITS.get(unit, OTHER_LIMITS)[1], number, unit), number_schema(unit))


def _floats_within(least: float, otherwise: Callable[[Any, str], float], unit: str) -> Callable[[Any], float]:
    """Return the check that passes floats from ``least`` to the limit of their unit, and leaves all other values to
    another one.
    """
    largest = LIMITS.get(unit, OTHER_LIMITS)[1]

    def check(value: Any) -> float:
        return value if type(value) is float and least <= value <= largest else otherwise(value, unit)

    return check


def positive_number(value: Any, unit: str = "") -> float:
    """Return ``value`` as a finite float above 0 and within `LIMITS`. Raises ValueError."""
    result, least = number(value, unit), LIMITS.get(unit, OTHER_LIMITS)[0]
    if result < least:
        rule = "be positive" if result <= 0 else f"not be below {show(least, unit)}"
        raise ValueError(f"must {rule}, got {show(result, unit)}")
    return result


def positive(unit: str = "") -> Check:
    """Return the check of a finite number above 0 and within `LIMITS`."""
    least = LIMITS.get(unit, OTHER_LIMITS)[0]
    return checked(_floats_within(least, positive_number, unit), number_schema(unit, exclusiveMinimum=0))


def not_negative(unit: str = "") -> Check:
    """Return the check of a finite number, 0 or above."""
    return bounded(unit, lambda x: x >= 0, "not be negative", minimum=0)


def within(low: float, high: float, *, ends: bool) -> Check:
    """Return the check of a finite number between ``low`` and ``high``; ends: whether these are allowed."""
    if ends:
        return bounded("", lambda x: low <= x <= high, f"lie in [{low:g}, {high:g}]", minimum=low, maximum=high)
    return bounded("", lambda x: low < x < high, f"lie inside ({low:g}, {high:g})", exclusiveMinimum=low,
                   exclusiveMaximum=high)


def xyz(unit: str = "", turns: str | None = None, of: str | None = None) -> Check:
    """Return the check of three finite numbers: by their unit a point, an axis of rotation or a direction.

    turns: of another `Turning`; of: the attribute that names the body whose axes they are along, see `Turning`.
    """
    by_unit = {"m": POINT, "rad/s": AXIS, "N m": AXIS}
    turning = Turning(turns or by_unit.get(unit, DIRECTION), of, unit)
    return checked(lambda value: vector(value, unit), list_schema(unit), turning)


def direction(of: str | None = None, turns: str = DIRECTION, *, lies: bool = True) -> Check:
    """Return the check of three finite numbers, not all zero, of any length; arguments as in `Turning`."""
    def check(value: Any) -> tuple[float, ...]:
        result = vector(value)
        if not any(result):
            raise ValueError("must not be zero")
        if math.hypot(*result) < OTHER_LIMITS[0]:
            raise ValueError(f"must not be shorter than {show(OTHER_LIMITS[0])}, got {show(result)}")
        return result

    return checked(check, list_schema(), Turning(turns, of, lies=lies))


def place_on(of: str, *, moves: bool = False) -> Check:
    """Return the check of an arc-length in m along the cable that the attribute ``of`` names, see `Place`."""
    return checked(_floats_within(-LIMITS["m"][1], number, "m"), number_schema("m"), Place(of, moves))


def list_of(unit: str = "", *, least: int) -> Check:
    """Return the check of a list of at least ``least`` finite numbers."""
    def check(value: Any) -> tuple[float, ...]:
        if (given := items(value, least)) is None:
            raise ValueError(f"must be a list of {least} numbers or more, got {shown(value)}")
        return vector(given, unit, len(given))

    return checked(check, list_schema(unit, least, None))


def check_function(arguments: tuple[float, ...], of: str, unit: str, values: tuple[float, ...], name: str) -> None:
    """Raise ValueError unless the arguments of a table increase and each has a value.

    of, name: of arguments and values in messages; unit: of the arguments.
    """
    if len(arguments) != len(values):
        raise ValueError(f"{of} and {name} must be of equal length, got {len(arguments)} and {len(values)}")
    for before, after in itertools.pairwise(arguments):
        if not after > before:
            raise ValueError(f"{of} must increase, got {show(after, unit)} after {show(before, unit)}")


def check_square(name: str, one: Vector, of: str, other: Vector) -> None:
    """Raise ValueError unless two directions are perpendicular to rounding."""
    if abs(float(np.dot(one, other))) > 1e-9 * np.linalg.norm(one) * np.linalg.norm(other):
        raise ValueError(f"{name} must be square to {of}, got {one} and {other}")


def _names(value: Any) -> tuple[str, ...]:
    if not (given := items(value, 1)) or not all(isinstance(one, str) for one in given):
        raise ValueError(f"must be a list of names, got {shown(value)}")
    return tuple(dict.fromkeys(given))


def whole_number(value: Any) -> int:
    """Return ``value`` as an integer from 1 to `MAX_COUNT`. Raises ValueError."""
    if isinstance(value, bool) or not isinstance(value, Integral) or value < 1:
        raise ValueError(f"must be a whole number, 1 or more, got {shown(value)}")
    count = int(value)
    if count > MAX_COUNT:
        raise ValueError(f"must not exceed {MAX_COUNT}, got {shown(count)}")
    return count


def _flag(value: Any) -> bool:
    if not isinstance(value, bool | np.bool_):
        raise ValueError(f"must be true or false, got {shown(value)}")
    return bool(value)


def _name(value: Any) -> str:
    # Results are addressed as "name.quantity" and "cable@s", so that names contain neither sign.
    if not isinstance(value, str) or not value.replace("-", "_").isidentifier():
        raise ValueError(f"must be made of letters, digits, _ and -, and begin with no digit, got {shown(value)}")
    if len(value) > MAX_NAME_LENGTH:
        raise ValueError(f"must not be longer than {MAX_NAME_LENGTH} characters, got {len(value)}")
    return value


def _listed(value: Any) -> str:
    name = getattr(value, "name", value)
    if not isinstance(name, str):
        raise ValueError(f"must be the name of a part, got {shown(value)}")
    return name


Count = Annotated[int, checked(whole_number, {"type": "integer", "minimum": 1, "maximum": MAX_COUNT})]
Names = Annotated[tuple[str, ...], checked(_names, {"type": "array", "items": {"type": "string"}, "minItems": 1})]
"""One or more texts, each once."""
Flag = Annotated[bool, checked(_flag, {"type": "boolean"})]
Name = Annotated[str, checked(_name, {"type": "string", "maxLength": MAX_NAME_LENGTH})]
NAMES_A_PART = object()
"""Marks the type of a field that holds the name of another part."""
Reference = Annotated[str, BeforeValidator(lambda value: getattr(value, "name", value)), NAMES_A_PART]
"""The name of a part of the scene, or the part itself."""
Listed = Annotated[str, checked(_listed, {"anyOf": [
    {"type": "string"}, {"type": "array", "items": {"type": "string"}, "minItems": 1}]}), NAMES_A_PART]
"""The name of a part, or the part itself; on adding also a list of them, or "all"."""
Vector = tuple[float, float, float]
Points = tuple[tuple[float, ...], ...]
Matrix = tuple[Vector, Vector, Vector]
