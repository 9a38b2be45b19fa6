"""manifest.json: the contents of the generated files, their sources and the tools.

Each source and each file of a family has one row with a hash. The files of all families have none: they are rendered
anew each time. A kernel has a row below its family, and names the source where it is not the family's. It lists its
arguments by name and shape, so that a new argument leaves the rows of others as they are.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Collection, Iterable
from dataclasses import asdict, dataclass, replace
from typing import Any

from .described import described
from .family import Family, PointLawFamily
from .program import Argument, Program
from .provenance import hashes
from .rendering import Derived, Recorded, digest, interface, layout, tables, tools


def recorded(family: Family, manifest: dict[str, Any]) -> Derived | None:
    """Return a family from the manifest, without a derivation; None where the manifest lacks it."""
    if family.name not in manifest.get("families", {}):
        return None

    def arguments(rows: list[dict[str, Any]]) -> list[Argument]:
        return [Argument(a["name"], tuple(a["shape"]), a["unit"], a["doc"]) for a in rows]

    kernels = [Recorded(name, k["doc"], k["source"], arguments(k["inputs"]), arguments(k["outputs"]), k["operations"])
               for name, k in described(manifest, [family.name]).items()]
    return Derived(replace(family, doc=manifest["families"][family.name]["doc"]), kernels)


@dataclass(frozen=True)
class Origin:
    """Versions of tools and hashes of sources, which decide the generated text."""

    tools: dict[str, str]
    sources: dict[str, str]


def origin(families: Collection[Family]) -> Origin:
    """Return the present tools and sources of these families."""
    return Origin(tools(), hashes(families))


def text(every: list[Derived], made_from: Origin, files: dict[str, str], layout_of: dict[str, Any] | None = None,
         more: dict[str, Any] | None = None) -> str:
    """Return the text of the manifest of these families.

    files: texts of generated files, whose hashes it keeps; layout_of: as in `rendering.render`; more: further parts.
    """
    arguments = _keys(a for d in every for p in d.programs for a in (*p.inputs, *p.outputs))

    def row(program: Program | Recorded, source: str) -> dict[str, Any]:
        listed = " -> ".join(", ".join(arguments[a] for a in of) for of in (program.inputs, program.outputs))
        return {"doc": program.doc, **({} if program.source == source else {"source": program.source}),
                "arguments": listed, "operations": {kind: n for kind, n in program.operations().items() if n}}

    kernels = {d.family.name: {p.name.removeprefix(d.family.name + "_"): row(p, d.source) for p in d.programs}
               for d in every}
    laid_out = layout(tables(every, layout_of))
    content = {"tools": made_from.tools,
               "interface": interface(laid_out),
               "tables": laid_out,
               "elements": {d.family.name: _element(d.family, every) for d in every if d.family.role == "element"},
               "point_laws": {d.family.name: _point_law(d.family) for d in every
                              if isinstance(d.family, PointLawFamily)},
               "families": {d.family.name: {"doc": d.family.doc, "source": d.source} for d in every},
               "sources": made_from.sources,
               "files": {name: digest(content) for name, content in sorted(files.items())},
               "arguments": {key: {"unit": a.unit, "doc": a.doc} for a, key in arguments.items()},
               "kernels": kernels} | (more or {})
    return json_text(content)


def _keys(arguments: Iterable[Argument]) -> dict[Argument, str]:
    """Return a key for each argument: name and shape, with a number where units or meanings differ."""
    keys: dict[Argument, str] = {}
    alike: Counter[str] = Counter()
    for argument in arguments:
        if argument not in keys:
            key = f"{argument.name}[{'x'.join(map(str, argument.shape))}]" if argument.shape else argument.name
            alike[key] += 1
            keys[argument] = key if alike[key] == 1 else f"{key} {alike[key]}"
    return keys


def json_text(content: dict[str, Any]) -> str:
    """Return JSON text with a line for each entry of each part, of the kernels for each kernel."""
    parts = [f" {json.dumps(name)}: {_rows(part, 2 if name == 'kernels' else 1, ' ')}"
             for name, part in content.items()]
    return "{\n" + ",\n".join(parts) + "\n}\n"


def _rows(value: Any, depth: int, indent: str) -> str:
    """Return JSON text with a line for each entry down to a depth."""
    if depth == 0 or not isinstance(value, (dict, list)):
        return json.dumps(value)
    rows = ([f"{json.dumps(key)}: {_rows(entry, depth - 1, indent + ' ')}" for key, entry in value.items()]
            if isinstance(value, dict) else [json.dumps(entry) for entry in value])
    first, last = "{}" if isinstance(value, dict) else "[]"
    inner = f",\n{indent} ".join(rows)
    return f"{first}\n{indent} {inner}\n{indent}{last}"


def _element(family: Family, every: list[Derived]) -> dict[str, Any]:
    """Return the row of an element for scenes; `laws`: the traits of each law, see `LawTraits`."""
    element = family.element
    assert element is not None
    laws = {d.family.law: _law(d.family) for d in every if d.family.role == "law" and d.family.element is element}
    return {"nodal_vectors": list(element.nodal_vectors), "dim": element.dim, "director": element.director,
            "laws": laws}


def _law(family: Family) -> dict[str, Any]:
    """Return the row of a law for scenes: its traits, and the laws whose section stiffness and kernels it takes."""
    assert family.traits is not None
    traits = {name: value for name, value in asdict(family.traits).items()
              if name not in ("damped_like", "relaxed_like")}
    return {"stiffness_of": family.stiffness_of, **traits, "shared": family.shared,
            "discrete_gradient": "discrete_force" not in family.missing}


def _point_law(family: PointLawFamily) -> dict[str, Any]:
    """Return the row of the law of a force between two points for scenes; `parameters`: units by name."""
    law = family.point_law
    return {"parameters": {name: unit for name, (unit, _) in law.parameters.items()}, "damping": law.damping}


