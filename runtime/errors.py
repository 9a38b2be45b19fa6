"""Errors and warnings: their messages name place, cause and remedy."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

MAX_SHOWN_LENGTH = 150
"""Characters of the start and of the end of a path in a message."""


class FunicularError(Exception):
    """Base of all errors that funicular raises on purpose."""

    __str__ = Exception.__str__  # KeyError, a base of a subclass, quotes its message


class FunicularWarning(UserWarning):
    """A note on an adjustment or an incomplete result; also in ``run.report["messages"]``."""


class SceneError(FunicularError, ValueError):
    """The scene cannot be simulated as described.

    ``errors``: all errors of a scene file or of the values of a part. The message is that of the first one, of a file
    that of all.
    """

    def __init__(self, place: str, cause: str, remedy: str | None = None, entry: str | None = None):
        """place: such as ``cable "wire"``; entry: keyword of the wrong value, None for several."""
        super().__init__(f"{place}: {cause}" + (f"; {remedy}" if remedy else ""))
        self.place, self.cause, self.remedy, self.entry = place, cause, remedy, entry
        self.errors: tuple[SceneError, ...] = (self,)

    def inside(self, outer: str) -> SceneError:
        """Return the same error with a place, such as a file, in front."""
        return SceneError(f"{outer}: {self.place}", self.cause, self.remedy)


class SceneFileError(SceneError):
    """All errors of a scene file, a line each."""

    def __init__(self, origin: str, found: Sequence[tuple[int | None, SceneError]], more: bool = False):
        """origin: name of the file in messages; found: errors with line numbers; more: whether to expect others."""
        found = sorted(found, key=lambda each: (each[0] is None, each[0] or 0))
        first = found[0][1]
        lines = [(f"line {number}: " if number else "") + str(error) for number, error in found]
        one = f"{origin}, {lines[0]}" if found[0][0] else f"{origin}: {lines[0]}"
        number = f"{len(found)} errors, and perhaps more" if more else f"{len(found)} errors"
        super().__init__(origin, first.cause, first.remedy)
        self.args = (one if len(found) == 1 else f"{origin}: {number}" + "".join(f"\n  {x}" for x in lines),)
        self.errors = tuple(error for _, error in found)


class _StoppedError(FunicularError):
    """A run that stopped early."""

    def __init__(self, message: str, run: Any):
        """run: the results up to the stop, a `funicular.Run`."""
        super().__init__(message)
        self.run = run


class RopeLeftError(_StoppedError):
    """A rope left a sheave, or a span between two sheaves vanished; ``run`` holds the results up to then."""


class EndOfCableError(_StoppedError):
    """A slide reached an end of its cable; ``run`` holds the results up to then."""


class ConvergenceError(_StoppedError):
    """The integrator found no acceptable step; ``run`` holds the results up to then."""


class EquilibriumError(FunicularError):
    """No static equilibrium was reached; ``state`` is the last one, at ``load_fraction`` of the loads."""

    def __init__(self, message: str, state: Any, load_fraction: float):
        """state: the last `Scene.equilibrium`; load_fraction: of the loads in it, 0 to 1."""
        super().__init__(message)
        self.state, self.load_fraction = state, load_fraction


class ResultFileError(FunicularError):
    """A file of results cannot be written or read."""


class UnknownResultError(FunicularError, KeyError):
    """A run holds no result of that name."""


@contextmanager
def enough_memory() -> Iterator[None]:
    """Turn a MemoryError into a SceneError."""
    try:
        yield
    except MemoryError:
        raise SceneError("scene", "takes more memory than this machine has",
                         "take fewer elements, fewer bodies and slides, or a larger output_step") from None


def shown_path(path: str | os.PathLike[str]) -> str:
    """Return a path for messages, with escapes for unprintable characters and without the middle of a long one."""
    text = os.fspath(path)
    text = text if text.isprintable() else ascii(text)[1:-1]
    return text if len(text) <= 2 * MAX_SHOWN_LENGTH else f"{text[:MAX_SHOWN_LENGTH]}...{text[-MAX_SHOWN_LENGTH:]}"


def near(name: str, known: Iterable[str]) -> str:
    """Return the remedy for an unknown name: the nearest known name, or all known names."""
    from difflib import get_close_matches  # errors alone need it, and each import would compile its expressions

    known = list(known)
    if len(str(name)) <= MAX_SHOWN_LENGTH and (matches := get_close_matches(str(name), known, n=1)):
        return f'did you mean "{matches[0]}"?'
    return "known: " + ", ".join(known) if known else "the scene has none yet"
