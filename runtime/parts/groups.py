"""The parts of a scene by group, for reading: a scene checks what is added, and makes another scene of what changes."""

from __future__ import annotations

from typing import Any, Never, Self

from ..errors import SceneError


def _refuse(*given: Any, **named: Any) -> Never:
    """Refuse a change. Raises SceneError."""
    raise SceneError("scene", "its parts are for reading", "add one with the scene's method for its kind, or take "
                     'another scene: scene.replace("wire", ...), scene.without("wire")')


class PartsByName(dict):
    """Parts by name."""

    __setitem__ = __delitem__ = __ior__ = clear = pop = popitem = setdefault = update = _refuse

    def put(self, name: str, part: Any) -> None:
        """Add a part, or put it in the place of the one of that name; for the scene."""
        super().__setitem__(name, part)

    def copy(self) -> Self:
        """Return the same parts, to which others may be added."""
        return type(self)(self)

    def __reduce__(self) -> tuple[type[Self], tuple[dict]]:
        """Return what it is made of again, for copies and other processes."""
        return type(self), (dict(self),)


class PartsInOrder(list):
    """Parts without names."""

    __setitem__ = __delitem__ = __iadd__ = __imul__ = append = extend = insert = _refuse
    remove = pop = clear = sort = reverse = _refuse

    def put(self, part: Any) -> None:
        """Add a part; for the scene."""
        super().append(part)

    def copy(self) -> Self:
        """Return the same parts, to which others may be added."""
        return type(self)(self)

    def __reduce__(self) -> tuple[type[Self], tuple[list]]:
        """Return what it is made of again, for copies and other processes."""
        return type(self), (list(self),)
