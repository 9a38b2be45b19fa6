"""Packages that only some pictures need."""

from __future__ import annotations

import importlib
from typing import Any

from ..errors import FunicularError


def extra(module: str, name: str) -> Any:
    """Return a module of an extra of this package. Raises FunicularError that says how to install it."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        raise FunicularError(f"this needs {error.name}, which is not installed; "
                             f"pip install 'funicular[{name}]'") from error
