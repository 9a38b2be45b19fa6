"""Validators of parts without the plugins of pydantic.

For the first validator of a process pydantic loads `importlib.metadata` and searches all installed packages for
plugins, which takes a tenth of the time to the first result. Plugins observe the validation of other models as before.
"""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType

LOADER = "pydantic.plugin._loader"


@contextmanager
def no_plugins() -> Iterator[None]:
    """Let pydantic make validators without a search for plugins, unless other models have caused one already."""
    if LOADER in sys.modules:
        yield
        return
    found_none = ModuleType(LOADER)
    found_none.get_plugins = tuple  # type: ignore[attr-defined]  # an empty one: no plugins
    sys.modules[LOADER] = found_none
    try:
        yield
    finally:
        if sys.modules.get(LOADER) is found_none:
            del sys.modules[LOADER]
