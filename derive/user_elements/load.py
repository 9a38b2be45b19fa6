"""A spec file of the user's: run, and the elements that it defines."""

from __future__ import annotations

import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from funicular.errors import FunicularError

from ..catalogue import families, of_element
from ..codegen.family import Family
from ..spec import Element


class SpecError(FunicularError):
    """A spec that no element can be made of."""

    def __init__(self, place: str, cause: str, remedy: str = ""):
        """place: file, and element or line; cause: which property failed, and where; remedy: what to do."""
        super().__init__(f"{place}: {cause}" + (f"; {remedy}" if remedy else ""))


def elements(file: Path) -> list[Element]:
    """Return the elements that a file defines, in order. Raises SpecError with the line of what stops it."""
    try:
        code = compile(file.read_text(encoding="utf-8"), str(file), "exec")
    except (OSError, UnicodeDecodeError) as error:
        raise SpecError(str(file), f"cannot be read: {getattr(error, 'strerror', None) or error}") from None
    except SyntaxError as error:
        raise SpecError(f"{file}:{error.lineno}", f"is not Python: {error.msg}") from None
    except ValueError as error:  # null bytes
        raise SpecError(str(file), f"is not Python: {error}") from None
    space = {"__name__": f"funicular_spec_{file.stem}", "__file__": str(file)}
    with blaming(file, str(file)):
        exec(code, space)
    found: list[Element] = list({id(value): value for value in space.values() if isinstance(value, Element)}.values())
    if not found:
        raise SpecError(str(file), "defines no element",
                        "write NAME = Element(...) in it, with Element of funicular.derive.spec")
    return found


def own_families(file: Path) -> dict[str, Family]:
    """Return the families of a file's elements by name: those that an element of this package has."""
    found = {}
    for element in elements(file):
        for family in of_element(element):
            modules = tuple(m for m in family.modules if m != f"elements.{element.name}")
            found[family.name] = replace(family, modules=("spec", *modules), spec=file)
    return found


def taken() -> set[str]:
    """Return the names that the families of this package have."""
    return set(families())


@contextmanager
def blaming(file: Path, place: str) -> Iterator[None]:
    """Turn an exception of the file's own code into a SpecError with its line there."""
    try:
        yield
    except SpecError:
        raise
    except Exception as error:
        lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(file)]
        where = f"{place}, line {lines[-1]}" if lines else place
        raise SpecError(where, f"{type(error).__name__}: {error}") from error
