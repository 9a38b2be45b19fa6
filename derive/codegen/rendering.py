"""Files from programs, the last stage. Enters: families of programs. Leaves: text by file name.

Templates only lay out text that is decided here or earlier.
"""

from __future__ import annotations

import inspect
import json
import textwrap
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib import metadata
from typing import Any

import jinja2
import sympy as sp

from .c_printer import c_expression
from .described import described
from .family import Family, FamilyError
from .loops import sections
from .piecewise import PiecewiseCubicBase
from .program import Argument, Program
from .provenance import short_hash
from .sharing import Sections, header, share

TOOLS = ("sympy", "mpmath", "jinja2")
WIDTH = 120
HEADER, REGISTRY = "kernels.h", "registry.c"
COMMON = (HEADER, REGISTRY, "blocks.h", "blocks.c", "point_blocks.h", "point_blocks.c", "kernels.pyx", "__init__.py",
          "__main__.py")
"""Files of all families; a library has the first two."""
BLOCKS = ("elastic_force", "elastic_tangent", "damping_force", "dissipation")
"""Kernels of a law that are also compiled for several elements at once (blocks.c)."""
MAX_BLOCK_OPERATIONS = 3000
"""Largest kernels in blocks.c: the tangents of beam24 would take longer to compile than all others."""
MIN_OPERATIONS_PER_OUTPUT = 6
"""Smallest kernels in blocks.c, per output number: below, the sorting of numbers by element costs the gain."""
POINT_BLOCKS = {"drag": ("along_cable", "force_along_cable", "lift_along_cable", "on_section", "inertia_of_cable",
                         "inertia_of_cable_tangent", "morison_of_cable", "morison_of_cable_tangent",
                         "impulse_of_cable", "wave_phase", "wave_elevation", "wave_stretching", "wave_velocity")}
"""Kernels by role that are also compiled for several points of quadrature at once (point_blocks.c)."""


@dataclass(frozen=True)
class Recorded:
    """A kernel from the manifest: the data of a Program for the files common to all families."""

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
    """A family with its programs."""

    family: Family
    programs: list[Program] | list[Recorded]

    @property
    def source(self) -> str:
        """Return the source that most of its kernels have."""
        return Counter(program.source for program in self.programs).most_common(1)[0][0] if self.programs else ""


def derive(family: Family) -> Derived:
    """Run the derivation of one family."""
    return derived(family, family.build())


def derived(family: Family, programs: list[Program]) -> Derived:
    """Return a family with its programs, pruned."""
    return Derived(family, [p.prune() for p in programs])


@dataclass(frozen=True)
class Table:
    """The engine's table of a role: names of facts, kernels by suffix with C parameters."""

    members: list[Derived]
    facts: list[str]
    kernels: dict[str, str]


def tables(every: list[Derived], layout: dict[str, Any] | None = None) -> dict[str, Table]:
    """Return the engine's tables by role, with the layout of these families, or of a manifest's "tables".

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


def layout(of: dict[str, Table]) -> dict[str, dict[str, Any]]:
    """Return the layout of tables for the manifest; a user's library takes the same layout."""
    return {role: {"facts": table.facts, "kernels": table.kernels} for role, table in of.items()}


def interface(of: dict[str, dict[str, Any]]) -> str:
    """Return the hash of a layout: engine and library fit each other where it is the same."""
    return digest(json.dumps(of))


def render(every: list[Derived], wanted: Iterable[str], done: Callable[[str], None],
           layout_of: dict[str, Any] | None = None) -> dict[str, str]:
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
    laws = [derived for derived in every if derived.family.role == "law" and block_kernels(derived)]
    points = {role: of for role in POINT_BLOCKS
              if (of := [derived for derived in every if derived.family.role == role])}
    forms = {kernel: program for kernel in BLOCKS for derived in reversed(laws) for program in derived.programs
             if program.name in blocks and program.name == f"{derived.family.name}_{kernel}"}
    of_roles = tables(every, layout_of)
    common = {"every": every, "tables": of_roles, "declarations": _declarations(every, of_roles),
              "signature": signature, "form": _form, "calls": {_form(p): _call(p) for d in every for p in d.programs},
              "blocks": blocks,
              "entry": _entry, "laws": laws, "kernels": BLOCKS, "block_forms": forms,
              "points": points, "point_kernels": POINT_BLOCKS,
              "forms_at_points": {role: _forms_at_points(families, role) for role, families in points.items()},
              "described": inspect.getsource(described)}
    for name in COMMON if layout_of is None else (HEADER, REGISTRY):
        files[name] = environment.get_template(f"{name}.jinja").render(**common)
    return files


def _forms_at_points(families: list[Derived], role: str) -> dict[str, Program | Recorded]:
    """Return a program of each kernel of a role for several points, for the names of its arguments."""
    return {kernel: program for kernel in POINT_BLOCKS[role] for derived in families for program in derived.programs
            if program.name == derived.family.kernel(kernel)}


def _sections(derived: Derived) -> Sections:
    """Return the sections of a family's kernels, by kernel."""
    hot = block_kernels(derived)
    return {program.name: sections(program, _number if program.name in hot else c_expression)
            for program in derived.programs if isinstance(program, Program)}


def digest(text: str) -> str:
    """Return the hash of a file's text as the manifest keeps it."""
    return short_hash(text.encode())


def tools() -> dict[str, str]:
    """Return the versions of the tools that decide the generated text."""
    return {name: metadata.version(name) for name in TOOLS}


def signature(program: Program | Recorded) -> str:
    """Return the C parameters of a kernel, inputs before outputs."""
    inputs = [f"fu_real {a.name}" if a.shape == () else f"const fu_real *{a.name}" for a in program.inputs]
    return ", ".join([*inputs, *(f"fu_real *{a.name}" for a in program.outputs)])


def _about(program: Program | Recorded) -> str:
    """Return what a kernel gives, with the units of its arguments."""
    inputs, outputs = ("; ".join(f"{a.name} [{a.unit}]" for a in of) for of in (program.inputs, program.outputs))
    return f"{program.doc}: {inputs} -> {outputs}"


def _sizes(program: Program | Recorded) -> str:
    """Return the shapes of a kernel's arrays."""
    return ", ".join(f"{a.name} {'x'.join(map(str, a.shape))}" for a in (*program.inputs, *program.outputs) if a.shape)


def _declarations(every: list[Derived], of: dict[str, Table]) -> list[str]:
    """Return the lines that declare all kernels: those of a table by type, kernels alike below one comment."""
    lines = []
    others = {p.name: p for d in every for p in d.programs}
    for role, table in of.items():
        for suffix, parameters in table.kernels.items():
            kind = f"fu_{role}_{suffix}_kernel"
            names = [f"{d.family.name}_{suffix}" for d in table.members]
            lines += ["", f"typedef void {kind}({parameters});",
                      *_commented((others.pop(name) for name in names if name in others), kind)]
    return [*lines, "", *_commented(others.values())]


def _commented(programs: Iterable[Program | Recorded], kind: str = "") -> list[str]:
    """Return declarations of kernels, of a type if it has a name, below comments: what they give and units, then sizes.
    """
    lines = []
    for about, of_text in _by(_about, programs).items():
        lines += _comment(about)
        for sizes, alike in _by(_sizes, of_text).items():
            declared = ([f"{kind} {', '.join(p.name for p in alike)};"] if kind
                        else [f"void {p.name}({signature(p)});" for p in alike])
            lines += [*_comment(sizes), *(line for text in declared for line in textwrap.wrap(
                text, WIDTH, subsequent_indent="    ", break_long_words=False))]
    return lines


def _by(key: Callable[[Program | Recorded], str],
        programs: Iterable[Program | Recorded]) -> dict[str, list[Program | Recorded]]:
    """Return programs by what a key says of them, in order of first mention."""
    found: dict[str, list[Program | Recorded]] = {}
    for program in programs:
        found.setdefault(key(program), []).append(program)
    return found


def _comment(text: str) -> list[str]:
    """Return the lines of a comment in C."""
    lines = textwrap.wrap(text, WIDTH - 6, break_long_words=False, break_on_hyphens=False)
    return [f"{' *' if k else '/*'} {line}{' */' if k == len(lines) - 1 else ''}" for k, line in enumerate(lines)]


def _entry(derived: Derived, table: Table) -> list[str]:
    """Return a family's entry in the table of its role."""
    values = [f'"{derived.family.name}"', *map(str, derived.family.facts.values()),
              *(derived.family.kernel(suffix) for suffix in table.kernels)]
    return textwrap.wrap(f"{{{', '.join(values)}}},", WIDTH - 4, subsequent_indent=" ", break_long_words=False)


LOOKUPS = {function.__name__ for function in PiecewiseCubicBase.__subclasses__()}
"""Functions that find a segment, another one for each of several elements."""


def block_kernels(derived: Derived) -> list[str]:
    """Return the names of a family's kernels that are also compiled for several elements or points at once."""
    if derived.family.role in POINT_BLOCKS:
        hot = {derived.family.kernel(kernel) for kernel in POINT_BLOCKS[derived.family.role]}
        return [p.name for p in derived.programs if p.name in hot]
    if derived.family.role != "law":
        return []
    hot = {f"{derived.family.name}_{kernel}" for kernel in BLOCKS}
    return [p.name for p in derived.programs if p.name in hot and not LOOKUPS & p.operations().keys()
            and MIN_OPERATIONS_PER_OUTPUT * p.outputs[0].size <= sum(p.operations().values()) <= MAX_BLOCK_OPERATIONS]


def _number(expr: sp.Expr) -> str:
    """Return the C text of an expression that is assigned to a fu_real, which may be a vector of numbers."""
    return f"FU_NUMBER({c_expression(expr)})" if expr.is_number else c_expression(expr)


def _operations_text(program: Program) -> str:
    return ", ".join(f"{n} {name}" for name, n in program.operations().items() if n) or "no operations"


def _shared(members: list[Derived]) -> dict[str, str]:
    """Return the kernels of a role by suffix, with their parameters, but for each family's own.

    Raises FamilyError where two families do not agree on them.
    """
    first = min(members, key=lambda member: len(member.family.not_own))
    kernels = _signatures(first)
    for other in members:  # what the first one has not got
        for suffix, parameters in _signatures(other).items():
            if suffix in first.family.not_own:
                kernels.setdefault(suffix, parameters)
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


def _form(program: Program | Recorded) -> str:
    """Return the form of a kernel's arguments: s for each number, v for each array, then how many outputs."""
    return "".join("v" if a.shape else "s" for a in program.inputs) + f"_{len(program.outputs)}"


def _call(program: Program | Recorded) -> str:
    """Return the arguments of a C call, from arrays of pointers `a` and `out`."""
    inputs = [f"*a[{i}]" if a.shape == () else f"a[{i}]" for i, a in enumerate(program.inputs)]
    return ", ".join([*inputs, *(f"out[{i}]" for i in range(len(program.outputs)))])
