"""Dataclasses whose methods are made with the first object of a class.

`dataclasses.dataclass` compiles up to six methods a class. Of these one is compiled, and the first run of a process has
objects of a third of the classes that it imports.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from functools import partial
from operator import attrgetter
from reprlib import recursive_repr
from threading import RLock
from typing import TYPE_CHECKING, Any

_LOCK = RLock()
_WAITING: dict[type, Mapping[str, Any]] = {}
"""Options of the classes without an object yet."""

if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass
else:

    def dataclass(kind: type | None = None, /, **options: Any) -> Any:
        """Return the class as `dataclasses.dataclass` would, once it has an object or is asked for its fields."""
        if kind is None:
            return partial(dataclass, **options)

        def __init__(self: Any, *given: Any, **named: Any) -> None:  # noqa: N807  it is set below
            _complete(kind)
            kind.__init__(self, *given, **named)

        def __setstate__(self: Any, state: dict[str, Any]) -> None:  # noqa: N807  of copies from another process
            _complete(kind)
            self.__dict__.update(state)

        kind.__init__, kind.__setstate__, kind.__dataclass_fields__ = __init__, __setstate__, _Fields(kind)
        _WAITING[kind] = options
        return kind


class _Fields:
    """Stands for the fields of a class until they are asked for, as by a dataclass that extends it."""

    def __init__(self, kind: type):
        self.kind = kind

    def __get__(self, instance: object, owner: type | None = None) -> dict[str, Any]:
        _complete(self.kind)
        return dict(self.kind.__dataclass_fields__)  # type: ignore[attr-defined]


def _complete(kind: type) -> None:
    """Make the methods of a class and of the classes that it extends.

    `__init__` of before is replaced and not deleted: other threads that make objects wait in it.
    """
    with _LOCK:
        for base in reversed(kind.__mro__):
            options = _WAITING.get(base)
            if options is not None:
                _make_methods(base, **options)
                del base.__setstate__, _WAITING[base]  # type: ignore[attr-defined]


def _make_methods(kind: Any, frozen: bool = False, eq: bool = True, repr: bool = True, kw_only: bool = False) -> None:
    """Find the fields and set the methods that the class does not define; only `__init__` is compiled."""
    own = {*vars(kind)}
    dataclasses.dataclass(init=False, repr=False, eq=False, kw_only=kw_only)(kind)
    every = dataclasses.fields(kind)
    compared, shown = [each.name for each in every if each.compare], [each.name for each in every if each.repr]
    values: Callable[[Any], Any] = attrgetter(*compared) if len(compared) > 1 else (
        lambda self: tuple(getattr(self, name) for name in compared))

    def __eq__(self: Any, other: Any) -> Any:  # noqa: N807
        return values(self) == values(other) if type(other) is type(self) else NotImplemented

    def __hash__(self: Any) -> int:  # noqa: N807
        return hash(values(self))

    @recursive_repr()
    def __repr__(self: Any) -> str:  # noqa: N807
        return f"{type(self).__qualname__}({', '.join(f'{name}={getattr(self, name)!r}' for name in shown)})"

    made: dict[str, Any] = {"__eq__": __eq__, "__hash__": __hash__ if frozen else None} if eq else {}
    if repr:
        made["__repr__"] = __repr__
    if frozen:
        made["__setattr__"] = made["__delattr__"] = _refuse
    for name in made.keys() - own:
        setattr(kind, name, made[name])
    kind.__init__ = _initialiser(kind, frozen)


def _refuse(self: Any, name: str, *value: Any) -> None:
    """Refuse a change of a frozen object."""
    raise dataclasses.FrozenInstanceError(f"{type(self).__qualname__}.{name} cannot be changed")


def _initialiser(kind: type, is_frozen: bool) -> Callable[..., None]:
    """Return the method that sets the fields of a new object."""
    names: dict[str, Any] = {"_put": object.__setattr__}
    positional, by_keyword, lines = ["self"], ["*"], []
    for field in dataclasses.fields(kind):
        name = value = field.name
        default = field.default
        if field.default_factory is not dataclasses.MISSING:
            default, value = field.default_factory, f"_{name}() if {name} is _{name} else {name}"
        if field.init:
            names[f"_{name}"] = default
            (by_keyword if field.kw_only else positional).append(
                name if default is dataclasses.MISSING else f"{name}=_{name}")
            lines.append(f"_put(self, {name!r}, {value})" if is_frozen else f"self.{name} = {value}")
    if hasattr(kind, "__post_init__"):
        lines.append("self.__post_init__()")
    given = ", ".join(positional + by_keyword * (len(by_keyword) > 1))
    exec(f"def __init__({given}):\n " + "\n ".join(lines or ["pass"]), names)  # as dataclasses do
    made: Callable[..., None] = names["__init__"]
    return made
