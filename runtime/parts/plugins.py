"""Validators of parts without the plugins of pydantic.

For the first validator of a process pydantic loads `importlib.metadata` and searches all installed packages for
plugins, which takes a tenth of the time to the first result. Plugins observe the validation of other models as before.
"""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from types import ModuleType
from typing import Any

LOADER = "pydantic.plugin._loader"


def _loaded(name: str) -> Any:
    """Return what another version of pydantic takes from its module, which is then loaded."""
    if name.startswith("__"):  # the import system asks for these
        raise AttributeError(name)
    del sys.modules[LOADER]
    return getattr(import_module(LOADER), name)


@contextmanager
def no_plugins() -> Iterator[None]:
    """Let pydantic make validators without a search for plugins, unless other models have caused one already."""
    if LOADER in sys.modules:
        yield
        return
    found_none = ModuleType(LOADER)
    vars(found_none).update(get_plugins=tuple, __getattr__=_loaded)  # an empty tuple: no plugins
    sys.modules[LOADER] = found_none
    try:
        yield
    finally:
        if sys.modules.get(LOADER) is found_none:
            del sys.modules[LOADER]
