"""Detection of notebooks."""

from __future__ import annotations

import sys


def in_notebook() -> bool:
    """Return whether this is the kernel of a notebook, not IPython in a terminal."""
    ipython = sys.modules.get("IPython")  # a notebook has imported it
    shell = ipython.get_ipython() if ipython is not None else None
    return getattr(shell, "kernel", None) is not None
