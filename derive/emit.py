"""Programs to files: the last stage. Enters: families of programs. Leaves: text by file name.

Everything a template prints is decided here or earlier; the templates only lay it out.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib import metadata, resources

import jinja2
from funicular.derive.printer import c_expression
from funicular.derive.spec import Family
from funicular.derive.stages import Argument, Program

TOOLS = ("sympy", "mpmath", "jinja2")


@dataclass(frozen=True)
class Derived:
    """A family with its programs and the hash of the specs they came from."""

    family: Family
    programs: list[Program]
    spec_hash: str


def derive(family: Family) -> Derived:
    """Run the derivation of one family."""
    return Derived(family, [p.prune() for p in family.build()], spec_hash(family))


def spec_hash(family: Family) -> str:
    """SHA-256 over the text of the modules that decide a family."""
    digest = hashlib.sha256()
    root = resources.files("funicular.derive")
    for module in family.modules:
        digest.update((root / (module.replace(".", "/") + ".py")).read_bytes())
    return digest.hexdigest()[:16]


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
    common = {"every": every, "roles": roles, "signature": signature, "member": _member,
              "suffix": _suffix, "call": _call}
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
                                            "modules": list(d.family.modules)} for d in every},
               "files": {name: hashlib.sha256(text.encode()).hexdigest() for name, text in sorted(files.items())},
               "kernels": kernels}
    return json.dumps(content, indent=1) + "\n"




def signature(program: Program, name: str | None = None) -> str:
    """C parameters, or a pointer member's when a name is given."""
    inputs = [f"fu_real {a.name}" if a.shape == () else f"const fu_real *{a.name}" for a in program.inputs]
    return ", ".join([*inputs, *(f"fu_real *{a.name}" for a in program.outputs)])


def _operations_text(program: Program) -> str:
    return ", ".join(f"{n} {name}" for name, n in program.operations().items() if n)


def _suffix(derived: Derived, program: Program) -> str:
    return program.name.removeprefix(derived.family.name + "_")


def _member(derived: Derived, program: Program) -> str:
    return f"void (*{_suffix(derived, program)})({signature(program)});"


def _call(program: Program) -> str:
    inputs = [f"{a.name}_" if a.shape == () else f"&{a.name}_[0]" for a in program.inputs]
    return ", ".join([*inputs, *(f"&{a.name}__[0]" for a in program.outputs)])
