"""Ctrl-C (SIGINT) at instants where work can stop.

Python raises KeyboardInterrupt between any two instructions, such as the opening of a file and the assignment of its
descriptor. Code with files, locks or settings of the process to restore runs inside ``with uninterrupted():``, which
notes Ctrl-C; its long parts run inside ``with interruptible():``, where Ctrl-C acts at once.

Signals reach the main thread alone, and both replace only a handler in Python: elsewhere they do nothing.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from types import FrameType
from typing import Any

Handler = Callable[[int, FrameType | None], Any]


class _Now:
    """The present treatment of Ctrl-C, changed by the main thread alone.

    depth: number of enclosing blocks of `uninterrupted`; is_open: whether Ctrl-C is passed on at once; is_noted:
    whether one was not passed on; handler: the handler before the outermost block, which gets it.
    """

    depth = 0
    is_open = is_noted = False
    handler: Handler


def _take(number: int, frame: FrameType | None) -> None:
    """Pass Ctrl-C on, or note it."""
    if not _Now.is_open:
        _Now.is_noted = True
        return
    _Now.is_open = False  # a second one does not interrupt the restoring after the first one
    _Now.handler(number, frame)
    _Now.is_open = True  # the handler raised nothing


def _pass_on() -> None:
    """Pass a noted Ctrl-C on to the handler."""
    import signal  # here and below: 1,600 calls, which the import of the package avoids

    _Now.is_noted = False
    _Now.handler(signal.SIGINT, None)


def _is_here() -> bool:
    """Return whether this is the main thread, which signals reach."""
    return threading.get_ident() == threading.main_thread().ident


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
            if not callable(handler):  # SIGINT is ignored, ends the process, or belongs to an embedding program
                return
            _Now.handler, _Now.is_open, _Now.is_noted = handler, False, False
            signal.signal(signal.SIGINT, _take)
        self._was_open, _Now.is_open = _Now.is_open, False
        _Now.depth += 1
        self._entered = True

    def __exit__(self, kind: type[BaseException] | None, *exception: object) -> None:
        """Pass Ctrl-C on, unless this was done as KeyboardInterrupt."""
        import signal  # see _pass_on

        if not self._entered:
            return
        self._entered = False
        _Now.depth -= 1
        if _Now.depth:
            _Now.is_open = self._was_open
        elif signal.getsignal(signal.SIGINT) is _take:  # not a handler that was set inside
            signal.signal(signal.SIGINT, _Now.handler)
        if _Now.is_noted and (self._was_open or not _Now.depth):
            if kind is not None and issubclass(kind, KeyboardInterrupt):
                _Now.is_noted = False
            else:
                _pass_on()


class interruptible:  # noqa: N801
    """Passes Ctrl-C on inside, also one noted before, within a block of `uninterrupted`."""

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
        """Restore the previous treatment."""
        if _Now.depth and _is_here():
            _Now.is_open = self._was_open and _Now.is_open


def check_interrupted() -> None:
    """Pass on a noted Ctrl-C: raises KeyboardInterrupt."""
    if _Now.is_noted and _is_here():
        _pass_on()


def was_interrupted() -> bool:
    """Return whether Ctrl-C was noted, and clear the note, after finished work."""
    try:
        check_interrupted()
    except KeyboardInterrupt:
        return True
    return False
