"""Programs to files: the last stage. Enters: families of programs. Leaves: text by file name.

Everything a template prints is decided here or earlier; the templates only lay it out.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from importlib import metadata

import jinja2
from funicular.derive.printer import c_expression
from funicular.derive.sources import deciding, spec_hash
from funicular.derive.spec import Family
from funicular.derive.stages import Argument, Program

TOOLS = ("sympy", "mpmath", "jinja2")


@dataclass(frozen=True)
class Recorded:
    """What the manifest knows of a kernel: all that the files common to every family need of a Program."""

    name: str
    doc: str
    source: str
    inputs: list[Argument]
    outputs: list[Argument]
    count: dict[str, int]

    def operations(self) -> dict[str, int]:
        """Arithmetic operations of one call."""
        return self.count


@dataclass(frozen=True)
class Derived:
    """A family with its programs, and the files that it came from with their hash."""

    family: Family
    programs: list[Program] | list[Recorded]
    sources: list[str]
    spec_hash: str


def derive(family: Family) -> Derived:
    """Run the derivation of one family."""
    sources = list(deciding(family.modules))
    return Derived(family, [p.prune() for p in family.build()], sources, spec_hash(sources))


def recorded(family: Family, manifest: dict) -> Derived | None:
    """A family as the manifest has it, without a derivation; None where it has not."""
    if family.name not in manifest.get("families", {}):
        return None
    entry = manifest["families"][family.name]
    kernels = [Recorded(name, k["doc"], k["source"], _arguments(k["inputs"]), _arguments(k["outputs"]), k["operations"])
               for name, k in manifest["kernels"].items() if k["family"] == family.name]
    return Derived(replace(family, doc=entry["doc"]), kernels, entry["sources"], entry["spec_hash"])


def _arguments(entries: list[dict]) -> list[Argument]:
    return [Argument(e["name"], tuple(e["shape"]), e["unit"], e["doc"]) for e in entries]


def render(every: list[Derived], wanted: Iterable[str], done: Callable[[str], None]) -> dict[str, str]:
    """Text of the wanted families' files and of the files common to all, by name; calls done(name) for each."""
    environment = jinja2.Environment(loader=jinja2.PackageLoader("funicular.derive"), trim_blocks=True,
                                     lstrip_blocks=True, keep_trailing_newline=True,
                                     undefined=jinja2.StrictUndefined)
    environment.filters["c"] = c_expression
    files = {}
    for derived in every:
        if derived.family.name in wanted:
            text = environment.get_template("family.c.jinja").render(derived=derived, signature=signature,
                                                                     operations=_operations_text)
            files[f"{derived.family.name}.c"] = text
            done(derived.family.name)
    roles: dict[str, list[Derived]] = {}
    for derived in every:
        if derived.family.role:
            roles.setdefault(derived.family.role, []).append(derived)
    tables = {role: (members, _shared(members)) for role, members in roles.items()}
    common = {"every": every, "tables": tables, "signature": signature, "call": _call}
    for name in ("kernels.h", "registry.c", "kernels.pyx"):
        files[name] = environment.get_template(f"{name}.jinja").render(**common)
    files["__init__.py"] = environment.get_template("__init__.py.jinja").render(**common)
    return files


def manifest(every: list[Derived], files: dict[str, str]) -> str:
    """What was generated, from what, with which tools."""
    def arguments(of: list[Argument]) -> list[dict]:
        return [{"name": a.name, "shape": list(a.shape), "unit": a.unit, "doc": a.doc} for a in of]

    kernels = {p.name: {"doc": p.doc, "source": p.source, "family": d.family.name, "inputs": arguments(p.inputs),
                        "outputs": arguments(p.outputs), "operations": p.operations()}
               for d in every for p in d.programs}
    content = {"tools": {t: metadata.version(t) for t in TOOLS},
               "families": {d.family.name: {"doc": d.family.doc, "spec_hash": d.spec_hash,
                                            "sources": d.sources} for d in every},
               "files": {name: hashlib.sha256(text.encode()).hexdigest() for name, text in sorted(files.items())},
               "kernels": kernels}
    return json.dumps(content, indent=1) + "\n"


def signature(program: Program | Recorded) -> str:
    """C parameters."""
    inputs = [f"fu_real {a.name}" if a.shape == () else f"const fu_real *{a.name}" for a in program.inputs]
    return ", ".join([*inputs, *(f"fu_real *{a.name}" for a in program.outputs)])


def _operations_text(program: Program) -> str:
    return ", ".join(f"{n} {name}" for name, n in program.operations().items() if n)


def _shared(members: list[Derived]) -> dict[str, str]:
    """Kernels by suffix, with their parameters, that all families of a role have with the same parameters."""
    each = [{p.name.removeprefix(d.family.name + "_"): signature(p) for p in d.programs} for d in members]
    return {name: text for name, text in each[0].items() if all(other.get(name) == text for other in each)}


def _call(program: Program | Recorded) -> str:
    """The arguments of a C call, from arrays of pointers `a` and `out`."""
    inputs = [f"*a[{i}]" if a.shape == () else f"a[{i}]" for i, a in enumerate(program.inputs)]
    return ", ".join([*inputs, *(f"out[{i}]" for i in range(len(program.outputs)))])
