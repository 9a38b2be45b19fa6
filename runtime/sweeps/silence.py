"""Silence: no warnings, in all threads at once.

`warnings.catch_warnings` in several threads at once restores the filters that another one set.
"""

from __future__ import annotations

import threading
import warnings


class _Silence:
    """Context in which Python shows no warnings; the filters of before return when the last context ends."""

    def __init__(self) -> None:
        self._lock, self._inside, self._caught = threading.Lock(), 0, warnings.catch_warnings()

    def __enter__(self) -> None:
        with self._lock:
            if self._inside == 0:
                self._caught = warnings.catch_warnings()
                self._caught.__enter__()
                warnings.simplefilter("ignore")
            self._inside += 1

    def __exit__(self, *exception: object) -> None:
        with self._lock:
            self._inside -= 1
            if self._inside == 0:
                self._caught.__exit__(None, None, None)


silence = _Silence()
"""For ``with``."""
