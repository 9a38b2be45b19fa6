"""The identity of a function, for a resumed sweep: its source and the values that it uses.

A file must not mix results of two functions. The identity covers defaults, variables of enclosing functions, global
names that the function uses, and the functions among these in the same way. It does not cover files, variables of other
modules, and objects that cannot be pickled. A hash of the source alone would miss a changed constant or helper.
"""

from __future__ import annotations

import functools
import hashlib
import inspect
import pickle
from collections.abc import Callable, Mapping
from types import CodeType, FunctionType, MethodType, ModuleType
from typing import Any

from ..parts.event import Event
from ..parts.scene_data import SceneData
from ..parts.scene_text import dumps


def identity_of(function: Callable[..., Any]) -> str:
    """Return a text that differs for functions that differ, and is the same in each process."""
    return _described(function, set())


def identity_of_scene(scene: SceneData) -> str:
    """Return a text that differs for scenes that differ: the scene's file, and the functions of its events."""
    watched = [_described(event.function, set()) for event in scene.events.values()
               if isinstance(event, Event) and event.function is not None]
    return "\n".join([dumps(scene), *watched])


def _described(value: Any, seen: set[int]) -> str:
    """Return the text of a value; seen: ids of the enclosing functions, which may call each other."""
    match value:
        case FunctionType():
            return _of_function(value, seen)
        case MethodType():
            return f"{_described(value.__func__, seen)} of {_described(value.__self__, seen)}"
        case functools.partial():
            return f"{_described(value.func, seen)} at {_described([value.args, value.keywords], seen)}"
        case SceneData():
            return identity_of_scene(value)
        case ModuleType():
            return value.__name__
        case type():
            return f"{value.__qualname__} {'' if _is_library(value) else _text(value)}"
        case list() | tuple():
            return f"({', '.join(_described(each, seen) for each in value)})"
        case Mapping():
            return "{" + ", ".join(f"{name!r}: {_described(each, seen)}" for name, each in value.items()) + "}"
        case CodeType():
            return f"{value.co_code!r} {value.co_names} {[_described(each, seen) for each in value.co_consts]}"
        case None | bool() | int() | float() | complex() | str() | bytes():
            return repr(value)
    what = type(value)
    own = "" if _is_library(what) else _text(what)
    try:
        return f"{what.__qualname__} {own} {hashlib.sha256(pickle.dumps(value)).hexdigest()}"
    except Exception:  # an object that cannot be pickled may raise any error
        return f"{what.__qualname__} {own}"


def _of_function(function: FunctionType, seen: set[int]) -> str:
    if id(function) in seen or _is_library(function):
        return f"{function.__module__}.{function.__qualname__}"
    seen = seen | {id(function)}
    around = inspect.getclosurevars(function)
    parts = [_text(function), _described([function.__defaults__, function.__kwdefaults__], seen)]
    for names in (around.nonlocals, around.globals):
        parts += [f"{name} = {_described(each, seen)}" for name, each in sorted(names.items())]
    return "\n".join(parts)


def _is_library(what: Any) -> bool:
    """Return whether a function or class is of a library whose version a sweep records."""
    return (getattr(what, "__module__", None) or "").partition(".")[0] in ("funicular", "builtins", "numpy", "scipy")


def _text(what: Any) -> str:
    """Return the source of a function or class, else its code, else its name."""
    try:
        return inspect.getsource(what)
    except (OSError, TypeError, SyntaxError):
        code = getattr(what, "__code__", None)
        return _described(code, set()) if code is not None else getattr(what, "__qualname__", type(what).__qualname__)
