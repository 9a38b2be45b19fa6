"""The methods of a scene that add parts, one for each kind, from the fields of the kind.

Signatures and docstrings are for `help` and notebooks. Editors and type checkers read scene_methods.pyi, which
`python tests/scene_stub.py` writes and a test compares. The module stands in parts/ and not in scene/, since the layer
of choice, which is below scene/, is generic in these scenes.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from .kinds import KINDS
from .pairs import are_lists
from .part import Part, parameters_of
from .scene_data import SceneData


class SceneMethods(SceneData):
    """A scene with a method for each kind of part, such as `cable` and `rigid_body`."""


def signature(kind: type[Part]) -> inspect.Signature:
    """Return the signature of the method that adds such parts; None stands for an omitted entry."""
    parameters = [inspect.Parameter("self", inspect.Parameter.POSITIONAL_OR_KEYWORD)]
    for parameter in parameters_of(kind):
        positional = parameter.name in kind.positional
        parameters.append(parameter.replace(kind=inspect.Parameter.POSITIONAL_OR_KEYWORD) if positional else parameter)
    return inspect.Signature(parameters)


def _method(kind: type[Part]) -> Callable[..., Part | list[Part]]:
    """Return the method that makes a part of such a kind and adds it."""
    positional, made = kind.positional, signature(kind)
    optional = {parameter.name for parameter in made.parameters.values() if parameter.default is None}

    def method(self: SceneMethods, *given: Any, **keywords: Any) -> Part | list[Part]:
        if len(given) > len(positional):
            arguments = f"{len(positional)} argument{'s' * (len(positional) > 1)}"
            raise TypeError(f"Scene.{kind.kind}() takes {arguments} without keyword ({', '.join(positional)}), "
                            f"{len(given)} were given")
        for name, value in zip(positional, given, strict=False):
            if name in keywords:
                raise TypeError(f"Scene.{kind.kind}() got {name} twice")
            keywords[name] = value
        entries = {name: value for name, value in keywords.items() if value is not None or name not in optional}
        return self.add_pairs(kind, entries) if are_lists(self, kind, entries) else self.add(kind(**entries))

    method.__signature__ = made
    method.__name__, method.__qualname__ = kind.kind, f"Scene.{kind.kind}"
    about = (kind.__doc__ or "").replace("\n    ", "\n").strip()  # as inspect.cleandoc would, at each import
    method.__doc__ = (f"Add a {kind.__name__}: {about}\n\n"
                      f"Returns the part as it stands in the scene{', or a list of them' * kind.takes_lists}. "
                      "Raises SceneError.")
    return method


for _kind in KINDS:
    setattr(SceneMethods, _kind.kind, _method(_kind))
