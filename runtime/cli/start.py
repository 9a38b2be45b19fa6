"""Ctrl-C (SIGINT) while the command line starts: the same message and exit code as later, and no traceback.

The package imports this first; it acts in a process of the command line alone. The process ends at once, since nothing
needs to be restored yet, and KeyboardInterrupt within an import may appear as another error.
"""

from __future__ import annotations

import os
import sys
from itertools import pairwise
from types import FrameType

EXIT_INTERRUPTED = 130
INTERRUPTED = "interrupted"
"""The message of a command at Ctrl-C."""


def is_command() -> bool:
    """Return whether this process was started as ``funicular`` or ``python -m funicular``."""
    program = sys.argv[0] if getattr(sys, "argv", None) else ""  # an embedded Python may have no arguments
    if program == "-m":  # until the module is found
        return ("-m", "funicular") in pairwise(sys.orig_argv)
    return os.path.basename(program).removesuffix(".exe").removesuffix("-script.py") == "funicular"


def end_at_ctrl_c() -> None:
    """Let Ctrl-C end the process from now on, unless it is ignored or handled otherwise."""
    import signal  # see base/interruptions.py

    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _end)


def raise_at_ctrl_c() -> None:
    """Let Ctrl-C raise KeyboardInterrupt again, once the command catches it."""
    import signal  # see base/interruptions.py

    if signal.getsignal(signal.SIGINT) is _end:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _end(number: int, frame: FrameType | None) -> None:
    """End the process with the message and the code of an interruption."""
    os.write(2, f"{INTERRUPTED}\n".encode())
    os._exit(EXIT_INTERRUPTED)


if is_command():
    end_at_ctrl_c()
