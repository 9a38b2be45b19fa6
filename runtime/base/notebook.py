"""Whether a notebook is watching."""

from __future__ import annotations

import sys


def in_notebook() -> bool:
    """Return whether this is the kernel of a notebook; a terminal's IPython is none."""
    ipython = sys.modules.get("IPython")  # where a notebook runs it is there
    shell = ipython.get_ipython() if ipython is not None else None
    return getattr(shell, "kernel", None) is not None
