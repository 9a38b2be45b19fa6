"""Writes parts/scene_methods.pyi, the signatures of a scene's methods for editors and type checkers, from parts'
fields.

    python tests/scene_stub.py
"""

from __future__ import annotations

import ast
import functools
import inspect
import textwrap
from pathlib import Path

from funicular.parts.end_stops import Stop
from funicular.parts.flow_profile import Profile
from funicular.parts.force_segments import ForceTable
from funicular.parts.friction import Friction
from funicular.parts.kinds import KINDS
from funicular.parts.material import Material
from funicular.parts.part import Part
from funicular.parts.piece import Piece
from funicular.parts.polar import Polar
from funicular.parts.rope_items import Anchor, Block, Drum, Sheave
from funicular.parts.scene_data import SceneData
from funicular.parts.scene_methods import signature
from funicular.parts.section import Section
from funicular.parts.signal import Signal
from funicular.parts.solids import Solid
from funicular.parts.velocity_table import VelocityTable
from funicular.parts.wave import Wave

FILE = Path(__file__).parents[1] / "runtime" / "parts" / "scene_methods.pyi"

HEAD = '''"""Written by `python tests/scene_stub.py` from the fields of the parts: change those, and run it again."""

import os
from collections.abc import Callable, Sequence
from inspect import Signature
from typing import Any, TypeAlias

import numpy as np

'''

TYPE_ALIASES = '''
Numbers: TypeAlias = Sequence[float] | np.ndarray
Points: TypeAlias = Sequence[Numbers] | np.ndarray
Named: TypeAlias = Part | str
Place: TypeAlias = Named | Numbers | tuple[Named, float] | tuple[Named, Numbers]
Scale: TypeAlias = Signal | float

def signature(kind: type[Part]) -> Signature: ...

class SceneMethods(SceneData):
'''

OTHERS = (Anchor, Block, Drum, Sheave, Stop, ForceTable, Friction, Material, Piece, SceneData, Section, Signal, Solid,
          Polar, Profile, VelocityTable, Part, Wave)
"""What signatures need beside the kinds of parts."""

TYPES = {
    "Vector": "Numbers", "Orientation": "Numbers", "inertia": "Numbers | Points", "points": "Points",
    "nodes": "Numbers", "AnySection": "Section", "AnySolid": "Solid", "Reference": "Named", "AnyAttachment": "Place",
    "AnySignal": "Scale", "AnyProfile": "Profile", "AnySurfaceShape": "Part | dict[str, Any]", "CableEnd": "str | Stop",
    "VelocityTable": "VelocityTable | dict[str, Any]", "Polar": "Polar | dict[str, Any]",
    "added_mass": "float | Numbers | Points",
    "PlaceOrSignal": "Scale", "Offsets": "Numbers", "Shares": "Numbers",
    "ForceTable": "ForceTable | dict[str, Numbers]",
    "Displacement": "Sequence[Scale | str | None]", "Rotation": "tuple[Numbers, Scale]",
    "Listed": "Named | Sequence[Named]", "Route": "Sequence[Anchor | Block | Drum | Sheave | dict[str, Any]]",
    "Pieces": "Sequence[Piece | dict[str, Any]]",
    "Waves": "Sequence[Wave | dict[str, Any]]",
    "ElementsOfSpans": "int | Sequence[int]", "LengthOfSpans": "float | Sequence[float]",
    "Name": "str", "Count": "int", "Flag": "bool", "Exponent": "float",
    "Material": "Material", "AnyFriction": "Friction | float",
    "float": "float", "str": "str", "Callable": "Callable[..., Any]",
    "Any": "Callable[..., Any]", "tuple": "Numbers",
}
"""What may be given for fields that are annotated so; ``inertia``, ``points`` and ``nodes`` are fields of their own."""

BY_NAME = {"inertia": "inertia", "added_mass": "added_mass",
           "points": "points", "nodes": "nodes", "library": "path", "data": "path",
           "body": "rider"}
PATHS = {"path": "str | os.PathLike[str]", "rider": "Named | tuple[Named, float] | Numbers"}


@functools.cache
def annotations(kind: type) -> dict[str, str]:
    """Return the annotations of a class's own fields as they are written."""
    if not issubclass(kind, Part):
        return {}
    (written,) = ast.parse(textwrap.dedent(inspect.getsource(kind))).body
    return {line.target.id: ast.unparse(line.annotation) for line in written.body if isinstance(line, ast.AnnAssign)}


def given_type(kind: type[Part], keyword: str, optional: bool) -> str:
    """Return the type of a keyword's values in the stub."""
    field = kind.keywords()[keyword]
    written = next(of_class[field] for of_class in map(annotations, kind.__mro__) if field in of_class)
    if (special := BY_NAME.get(keyword)) is not None:
        found = PATHS.get(special) or TYPES[special]
    else:
        bare = written.removeprefix("Annotated[")
        word = bare.replace("|", " ").replace(",", " ").replace("[", " ").replace("]", " ").split()[0]
        found = TYPES["AnySignal" if bare.startswith("float | Signal") else word]
    return f"{found} | None" if optional else found


def method(kind: type[Part]) -> str:
    """Return the method that adds a part."""
    arguments, keyword_only = ["self"], False
    for name, parameter in list(signature(kind).parameters.items())[1:]:
        if parameter.kind is inspect.Parameter.KEYWORD_ONLY and not keyword_only:
            arguments.append("*")
            keyword_only = True
        needed = parameter.default is inspect.Parameter.empty
        default = "" if needed else f" = {parameter.default!r}"
        arguments.append(f"{name}: {given_type(kind, name, not needed and parameter.default is None)}{default}")
    listed = "".join(f"        {each.replace(chr(39), chr(34))},\n" for each in arguments)
    made = f"{kind.__name__} | list[{kind.__name__}]" if kind.takes_lists else kind.__name__
    documented = f'"""Add a {kind.__name__}, which see."""'
    return f"    def {kind.kind}(\n{listed}    ) -> {made}:\n        {documented}\n\n"


def imports() -> str:
    """Return the import lines of the kinds of parts and of their signatures."""
    of_module: dict[str, set[str]] = {}
    for each in (*KINDS, *OTHERS):
        of_module.setdefault(each.__module__.removeprefix("funicular.parts"), set()).add(each.__name__)
    return "".join(f"from {module} import {', '.join(sorted(of_module[module]))}\n" for module in sorted(of_module))


def stub() -> str:
    """Return the text of the file."""
    return HEAD + imports() + TYPE_ALIASES + "".join(method(kind) for kind in KINDS).rstrip() + "\n"


if __name__ == "__main__":
    FILE.write_text(stub(), encoding="utf-8")
    print(FILE)
