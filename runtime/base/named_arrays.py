"""The common interface of runs, equilibria and modes: mappings from names to arrays."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np


class NamedArrays:
    """Base of classes with arrays by name, which define `keys` and []."""

    def keys(self) -> list[str]:
        """Return the names of all arrays."""
        raise NotImplementedError

    def __getitem__(self, name: str) -> np.ndarray:
        """Return an array by its name. Raises UnknownResultError that names similar ones."""
        raise NotImplementedError

    def items(self) -> Iterator[tuple[str, np.ndarray]]:
        """Return all names with their arrays, in the order of `keys`."""
        return ((name, self[name]) for name in self)

    def __iter__(self) -> Iterator[str]:
        """Return the names of all arrays, in the order of `keys`."""
        return iter(self.keys())

    def __contains__(self, name: object) -> bool:
        """Return whether there is an array of a name."""
        return name in self.keys()

    def _ipython_key_completions_(self) -> list[str]:
        """Return the completions of IPython after ``["``."""
        return self.keys()
