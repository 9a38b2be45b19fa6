"""Programs to files: the last stage. Enters: families of programs. Leaves: text by file name.

Everything a template prints is decided here or earlier; the templates only lay it out.
"""

from __future__ import annotations

import hashlib
import json
import textwrap
from collections.abc import Callable, Hashable, Iterable
from dataclasses import asdict, dataclass, replace
from importlib import metadata

import jinja2
import sympy as sp

from .c_printer import c_expression
from .family import Family, FamilyError, PointLawFamily
from .loops import sections
from .program import Argument, Program
from .provenance import deciding, spec_hash
from .sharing import Sections, header, share

TOOLS = ("sympy", "mpmath", "jinja2")
WIDTH = 120
HEADER, REGISTRY = "kernels.h", "registry.c"
COMMON = (HEADER, REGISTRY, "blocks.h", "blocks.c", "kernels.pyx", "__init__.py", "__main__.py")
"""Files of all families; a library has the first two."""
BLOCKS = ("elastic_force", "elastic_tangent", "damping_force", "dissipation")
"""Kernels of a law that are compiled for several elements at once as well (blocks.c), unless ..."""
MOST_OPERATIONS = 3000
"""... they have more operations: the tangents of beam24 would take longer to compile than all the others; or ..."""
LEAST_PER_OUTPUT = 6
"""... fewer operations a number: sorting the numbers by element then costs what it gains."""


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
        """Return the arithmetic operations of one call."""
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
    return derived(family, family.build())


def derived(family: Family, programs: list[Program]) -> Derived:
    """Return a family with its programs, pruned, and where they came from."""
    return Derived(family, [p.prune() for p in programs], *came_from(family))


def came_from(family: Family) -> tuple[list[str], str]:
    """Return the files that decide a family, and their hash."""
    files = list(deciding(family.modules))
    own = [family.spec.name] if family.spec else []
    return own + files, spec_hash(files, family.spec)


def recorded(family: Family, manifest: dict) -> Derived | None:
    """Return a family as the manifest has it, without a derivation; None where it has not."""
    if family.name not in manifest.get("families", {}):
        return None
    entry = manifest["families"][family.name]
    every = [Argument(a["name"], tuple(a["shape"]), a["unit"], a["doc"]) for a in manifest["arguments"]]
    kernels = [Recorded(name, k["doc"], k["source"], [every[a] for a in k["inputs"]], [every[a] for a in k["outputs"]],
                        k["operations"]) for name, k in manifest["kernels"].items() if k["family"] == family.name]
    sources = [manifest["sources"][k] for k in entry["sources"]]
    return Derived(replace(family, doc=entry["doc"]), kernels, sources, entry["spec_hash"])


@dataclass(frozen=True)
class Table:
    """What the engine needs of the families of a role: names of their facts, kernels by suffix with C parameters."""

    members: list[Derived]
    facts: list[str]
    kernels: dict[str, str]


def tables(every: list[Derived], layout: dict | None = None) -> dict[str, Table]:
    """Return the engine's tables by role: laid out as these families allow, or as a manifest's "tables" has them.

    Raises FamilyError for a family without a kernel that the layout asks for.
    """
    roles: dict[str, list[Derived]] = {} if layout is None else {role: [] for role in layout}
    for derived in every:
        if derived.family.role:
            roles.setdefault(derived.family.role, []).append(derived)
    if layout is None:
        return {role: Table(of, list(of[0].family.facts), _shared(of)) for role, of in roles.items()}
    for role, members in roles.items():
        for derived in members:
            has = _signatures(derived)
            for kernel, parameters in layout[role]["kernels"].items():
                if kernel not in derived.family.not_own and has.get(kernel) != parameters:
                    raise FamilyError(f"kernel {derived.family.name}_{kernel} must take ({parameters}), but "
                                      + (f"takes ({has[kernel]})" if kernel in has else "there is none"))
    return {role: Table(of, **layout[role]) for role, of in roles.items()}


def layout(of: dict[str, Table]) -> dict[str, dict]:
    """Return what a manifest keeps of tables, so that a library of the user's has the same layout."""
    return {role: {"facts": table.facts, "kernels": table.kernels} for role, table in of.items()}


def interface(of: dict[str, dict]) -> str:
    """Return the hash of a layout: engine and library fit each other where it is the same."""
    return hashlib.sha256(json.dumps(of).encode()).hexdigest()[:16]


def render(every: list[Derived], wanted: Iterable[str], done: Callable[[str], None],
           layout_of: dict | None = None) -> dict[str, str]:
    """Return the text of the wanted families' files, of the headers of their groups and of the common files, by name.

    Calls done(name) for each family. Of a group all families are wanted, or none.

    layout_of: the "tables" of the manifest whose layout a library of the user's must have; the Python face is left out.
    """
    environment = jinja2.Environment(loader=jinja2.PackageLoader("funicular.derive.codegen"), trim_blocks=True,
                                     lstrip_blocks=True, keep_trailing_newline=True,
                                     undefined=jinja2.StrictUndefined)
    files = {}
    stages = {derived.family.name: _sections(derived) for derived in every if derived.family.name in wanted}
    shared = share({derived.family.name: derived.family for derived in every if derived.family.name in stages}, stages)
    for derived in every:
        if derived.family.name in stages:
            text = environment.get_template("family.c.jinja").render(
                derived=derived, signature=signature, operations=_operations_text, blocks=block_kernels(derived),
                sections=stages[derived.family.name], stages=shared.get(derived.family.name, ()))
            files[f"{derived.family.name}.c"] = text
            done(derived.family.name)
    for group in dict.fromkeys(d.family.group for d in every if d.family.group and d.family.name in stages):
        files[header(group)] = environment.get_template("stages.h.jinja").render(group=group,
                                                                                 stages=shared[header(group)])
    blocks = {name for derived in every for name in block_kernels(derived)}
    common = {"every": every, "tables": tables(every, layout_of), "signature": signature, "call": _call,
              "blocks": blocks, "about": _about, "entry": _entry,
              "laws": [derived for derived in every if block_kernels(derived)], "kernels": BLOCKS}
    for name in COMMON if layout_of is None else (HEADER, REGISTRY):
        files[name] = environment.get_template(f"{name}.jinja").render(**common)
    return files


def _sections(derived: Derived) -> Sections:
    """Return the sections of a family's kernels, by kernel."""
    hot = block_kernels(derived)
    return {program.name: sections(program, _number if program.name in hot else c_expression)
            for program in derived.programs if isinstance(program, Program)}


def digest(text: str) -> str:
    """Return the hash of a file's text as the manifest keeps it."""
    return hashlib.sha256(text.encode()).hexdigest()


def tools() -> dict[str, str]:
    """Return the versions of what decides the generated text."""
    return {name: metadata.version(name) for name in TOOLS}


def manifest(every: list[Derived], files: dict[str, str], layout_of: dict | None = None,
             more: dict | None = None) -> str:
    """Return the manifest: what was generated, from what, with which tools; `layout_of` as in `render`, `more` is
    added.

    "arguments" and "sources" are listed once; kernels and families have their numbers in these lists.
    """
    arguments = _Numbered()
    sources = _Numbered()
    kernels = {p.name: {"doc": p.doc, "source": p.source, "family": d.family.name,
                        "inputs": [arguments.number(a) for a in p.inputs],
                        "outputs": [arguments.number(a) for a in p.outputs], "operations": p.operations()}
               for d in every for p in d.programs}
    laid_out = layout(tables(every, layout_of))
    content = {"tools": tools(),
               "interface": interface(laid_out),
               "tables": laid_out,
               "elements": {d.family.name: _element(d.family, every) for d in every if d.family.role == "element"},
               "point_laws": {d.family.name: _point_law(d.family) for d in every
                              if isinstance(d.family, PointLawFamily)},
               "families": {d.family.name: {"doc": d.family.doc, "spec_hash": d.spec_hash,
                                            "sources": [sources.number(s) for s in d.sources]} for d in every},
               "sources": list(sources.every),
               "files": {name: digest(text) for name, text in sorted(files.items())},
               "arguments": [{"name": a.name, "shape": list(a.shape), "unit": a.unit, "doc": a.doc}
                             for a in arguments.every],
               "kernels": kernels} | (more or {})
    return json_text(content)


class _Numbered:
    """Things in the order in which they came first."""

    def __init__(self) -> None:
        self.every: dict = {}

    def number(self, thing: Hashable) -> int:
        """Return the number of a thing among them."""
        return self.every.setdefault(thing, len(self.every))


def json_text(content: dict) -> str:
    """Return JSON text with a line for each entry of each part."""
    parts = []
    for name, part in content.items():
        rows = part if isinstance(part, list) else [part]
        lines = ([f"{json.dumps(key)}: {json.dumps(value)}" for key, value in part.items()] if isinstance(part, dict)
                 else [json.dumps(row) for row in rows])
        first, last = "{}" if isinstance(part, dict) else "[]" if isinstance(part, list) else ("", "")
        inner = ",\n  ".join(lines)
        parts.append(f' {json.dumps(name)}: ' + (f"{first}\n  {inner}\n {last}" if first else inner))
    return "{\n" + ",\n".join(parts) + "\n}\n"


def _element(family: Family, every: list[Derived]) -> dict:
    """Return what a scene needs to know of an element; `laws`: each with what it is, see `LawTraits`."""
    element = family.element
    assert element is not None
    laws = {d.family.law: _law(d.family) for d in every if d.family.role == "law" and d.family.element is element}
    return {"nodal_vectors": list(element.nodal_vectors), "dim": element.dim, "director": element.director,
            "laws": laws}


def _law(family: Family) -> dict:
    """Return what a scene needs to know of a law: its traits, and whose section stiffness and kernels it takes."""
    assert family.traits is not None
    traits = {name: value for name, value in asdict(family.traits).items()
              if name not in ("damped_like", "relaxed_like")}
    return {"stiffness_of": family.stiffness_of, **traits, "shared": family.shared,
            "discrete_gradient": "discrete_force" not in family.missing}


def _point_law(family: PointLawFamily) -> dict:
    """Return what a scene needs to know of the law of a force between two points; `parameters`: units by name."""
    law = family.point_law
    return {"parameters": {name: unit for name, (unit, _) in law.parameters.items()}, "damping": law.damping}


def signature(program: Program | Recorded) -> str:
    """Return the C parameters of a kernel, inputs before outputs."""
    inputs = [f"fu_real {a.name}" if a.shape == () else f"const fu_real *{a.name}" for a in program.inputs]
    return ", ".join([*inputs, *(f"fu_real *{a.name}" for a in program.outputs)])


def _about(program: Program | Recorded) -> list[str]:
    """Return the comment on a kernel: what it gives, shapes and units of its arguments."""
    def shown(arguments: list[Argument]) -> str:
        return "; ".join(f"{a.name} {'x'.join(map(str, a.shape))}[{a.unit}]" if a.shape else f"{a.name} [{a.unit}]"
                         for a in arguments)

    text = f"{program.doc}: {shown(program.inputs)} -> {shown(program.outputs)}"
    lines = textwrap.wrap(text, WIDTH - 6, break_long_words=False, break_on_hyphens=False)
    return [f"{' *' if k else '/*'} {line}{' */' if k == len(lines) - 1 else ''}" for k, line in enumerate(lines)]


def _entry(derived: Derived, table: Table) -> list[str]:
    """Return a family's entry in the table of its role."""
    values = [f'"{derived.family.name}"', *map(str, derived.family.facts.values()),
              *(derived.family.kernel(suffix) for suffix in table.kernels)]
    return textwrap.wrap(f"{{{', '.join(values)}}},", WIDTH - 4, subsequent_indent=" ", break_long_words=False)


def block_kernels(derived: Derived) -> list[str]:
    """Return the names of a law's kernels that are compiled for several elements at once as well."""
    if derived.family.role != "law":
        return []
    hot = {f"{derived.family.name}_{kernel}" for kernel in BLOCKS}
    return [p.name for p in derived.programs if p.name in hot
            and LEAST_PER_OUTPUT * p.outputs[0].size <= sum(p.operations().values()) <= MOST_OPERATIONS]


def _number(expr: sp.Expr) -> str:
    """Return an expression where a fu_real is assigned: a constant is not one where that is several numbers."""
    return f"FU_NUMBER({c_expression(expr)})" if expr.is_number else c_expression(expr)


def _operations_text(program: Program) -> str:
    return ", ".join(f"{n} {name}" for name, n in program.operations().items() if n)


def _shared(members: list[Derived]) -> dict[str, str]:
    """Return the kernels of a role by suffix, with their parameters, but for each family's own.

    Raises FamilyError where two families do not agree on them.
    """
    first = min(members, key=lambda member: len(member.family.not_own))
    kernels = _signatures(first)
    for other in members:
        theirs = _signatures(other)
        for suffix in {**kernels, **theirs}.keys() - other.family.not_own:
            here, there = kernels.get(suffix, "none"), theirs.get(suffix, "none")
            if here != there:
                raise FamilyError(f'role "{first.family.role}": the engine\'s table needs the kernel {suffix} of every '
                                f"family with the same parameters; {first.family.name} has ({here}), "
                                f"{other.family.name} has ({there}): derive all families where it is new, or list it "
                                "in Family.outside_table to keep it out of the table")
    return kernels


def _signatures(derived: Derived) -> dict[str, str]:
    """Return the C parameters by kernel, of those that belong in the table."""
    every = {p.name.removeprefix(derived.family.name + "_"): signature(p) for p in derived.programs}
    return {suffix: text for suffix, text in every.items() if suffix not in derived.family.outside_table}


def _call(program: Program | Recorded) -> str:
    """Return the arguments of a C call, from arrays of pointers `a` and `out`."""
    inputs = [f"*a[{i}]" if a.shape == () else f"a[{i}]" for i, a in enumerate(program.inputs)]
    return ", ".join([*inputs, *(f"out[{i}]" for i in range(len(program.outputs)))])
