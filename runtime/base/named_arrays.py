"""What runs, equilibria and modes have in common: they are read as mappings from names to arrays."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np


class NamedArrays:
    """Base of what has arrays by name; `keys` and [] are its own."""

    def keys(self) -> list[str]:
        """Return the names of all arrays."""
        raise NotImplementedError

    def __getitem__(self, name: str) -> np.ndarray:
        """Return an array by its name. Raises UnknownResultError naming the near ones."""
        raise NotImplementedError

    def items(self) -> Iterator[tuple[str, np.ndarray]]:
        """Yield all arrays with their names, in the order of `keys`."""
        return ((name, self[name]) for name in self)

    def __iter__(self) -> Iterator[str]:
        """Yield the names of all arrays, as `keys` has them."""
        return iter(self.keys())

    def __contains__(self, name: object) -> bool:
        """Return whether there is an array of that name."""
        return name in self.keys()

    def _ipython_key_completions_(self) -> list[str]:
        """Return what IPython offers after ``["``."""
        return self.keys()
