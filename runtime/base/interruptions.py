"""Ctrl-C (SIGINT) at instants where work can be left.

Python raises KeyboardInterrupt between any two instructions: between the opening of a file and the note that it is
open, say. Whoever has files, locks or settings of the process to put back works inside ``with uninterrupted():``, which
notes Ctrl-C, and lets what takes long be interrupted inside ``with interruptible():``.

Signals reach the main thread alone, and only what replaces Python's own handler or another one in Python: elsewhere
both do nothing.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from types import FrameType
from typing import Any

Handler = Callable[[int, FrameType | None], Any]


class _Now:
    """Whether and how Ctrl-C is taken at present; changed by the main thread alone."""

    depth = 0
    """Blocks of `uninterrupted` around."""
    is_open = False
    """Whether Ctrl-C is passed on at once."""
    is_noted = False
    """Whether there was one that was not passed on."""
    handler: Handler
    """What it is passed on to: the handler before the outermost block."""


def _take(number: int, frame: FrameType | None) -> None:
    """Pass Ctrl-C on, or note it."""
    if not _Now.is_open:
        _Now.is_noted = True
        return
    _Now.is_open = False  # a second one does not interrupt what puts things back after the first one
    _Now.handler(number, frame)
    _Now.is_open = True  # the handler was another one, which has raised nothing


def _pass_on() -> None:
    """Let the handler have what was noted."""
    import signal  # here and below: 1,600 calls, which the import of the package does without

    _Now.is_noted = False
    _Now.handler(signal.SIGINT, None)


def _is_here() -> bool:
    """Return whether this is the thread that signals reach."""
    return threading.current_thread() is threading.main_thread()


class uninterrupted:  # noqa: N801  for ``with``
    """Notes Ctrl-C inside and passes it on at the end; blocks may be nested."""

    _entered = _was_open = False

    def __enter__(self) -> None:
        """Begin to note Ctrl-C."""
        if not _is_here():
            return
        if _Now.depth == 0:
            import signal  # see _pass_on

            handler = signal.getsignal(signal.SIGINT)
            if not callable(handler):  # SIGINT is ignored, ends the process, or is for a program around Python
                return
            _Now.handler, _Now.is_open, _Now.is_noted = handler, False, False
            signal.signal(signal.SIGINT, _take)
        self._was_open, _Now.is_open = _Now.is_open, False
        _Now.depth += 1
        self._entered = True

    def __exit__(self, kind: type[BaseException] | None, *exception: object) -> None:
        """Pass Ctrl-C on, unless it has been already, as KeyboardInterrupt."""
        import signal  # see _pass_on

        if not self._entered:
            return
        self._entered = False
        _Now.depth -= 1
        if _Now.depth:
            _Now.is_open = self._was_open
        elif signal.getsignal(signal.SIGINT) is _take:  # and no handler that was set inside
            signal.signal(signal.SIGINT, _Now.handler)
        if _Now.is_noted and (self._was_open or not _Now.depth):
            if kind is not None and issubclass(kind, KeyboardInterrupt):
                _Now.is_noted = False
            else:
                _pass_on()


class interruptible:  # noqa: N801
    """Passes Ctrl-C on inside, what was noted before too, within a block of `uninterrupted`."""

    _was_open = False

    def __enter__(self) -> None:
        """Begin to pass Ctrl-C on."""
        if _Now.depth == 0 or not _is_here():
            return
        self._was_open = _Now.is_open
        if _Now.is_noted:
            _pass_on()
        _Now.is_open = True

    def __exit__(self, *exception: object) -> None:
        """Go back to what was before."""
        if _Now.depth and _is_here():
            _Now.is_open = self._was_open and _Now.is_open


def check_interrupted() -> None:
    """Pass on what was noted: raises KeyboardInterrupt after Ctrl-C."""
    if _Now.is_noted and _is_here():
        _pass_on()


def was_interrupted() -> bool:
    """Return whether Ctrl-C was noted, which then is passed on no more: for work that is done."""
    try:
        check_interrupted()
    except KeyboardInterrupt:
        return True
    return False
