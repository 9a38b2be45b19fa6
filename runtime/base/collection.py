"""Garbage collection during the import of the package.

Classes and functions of modules stay. Python nevertheless searches them for garbage ninety times while they are made,
and all of them once more in the first run.
"""

from __future__ import annotations

import gc


class straight_to_oldest:  # noqa: N801  for ``with``
    """Pauses garbage collection inside, and leaves what was made there to the rare collections of the oldest objects.

    A process that has frozen objects, or does without collection, keeps its own ways.
    """

    def __enter__(self) -> None:
        """Pause collection."""
        self._acts = gc.isenabled()
        gc.disable()

    def __exit__(self, *exception: object) -> None:
        """Resume it, with all objects among the oldest."""
        if self._acts:
            if gc.get_freeze_count() == 0:
                gc.freeze()
                gc.unfreeze()
            gc.enable()
