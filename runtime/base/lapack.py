"""SciPy's table of the functions of LAPACK for C, loaded without the rest of SciPy."""

from __future__ import annotations

import importlib
import os
import sys
from collections.abc import Callable
from importlib.machinery import PathFinder
from importlib.util import module_from_spec
from types import ModuleType

NAME = "scipy.linalg.cython_lapack"

WHEN_LOADED: list[Callable[[], None]] = []
"""Called when SciPy's BLAS is there."""


def cython_lapack() -> ModuleType:
    """Return the module `scipy.linalg.cython_lapack`.

    `import scipy.linalg` takes ten times as long and 50 MB, and a run needs nothing else of it. A later import finds
    this module.
    """
    module = sys.modules.get(NAME) or _loaded()
    for call in WHEN_LOADED:
        call()
    return module


def _loaded() -> ModuleType:
    import scipy  # prepares the search for its libraries

    spec = PathFinder.find_spec(NAME, [os.path.join(folder, "linalg") for folder in scipy.__path__])
    if spec is None or spec.loader is None:
        return importlib.import_module(NAME)
    module = sys.modules[NAME] = module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[NAME]
        raise
    return module
