"""The C files of a scene's program: the engine, the kernels that the scene uses, and the registry of these."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import NamedTuple

from .. import generated

ENGINE = Path(__file__).parents[1] / "engine"
GENERATED = Path(next(iter(generated.__path__)))
HEADERS = ("kernels.h", "blocks.h", "point_blocks.h")
NO_LAW_BLOCKS = """/* No law of this scene has kernels for several elements at once. */
#include "blocks.h"

const fu_law_blocks *fu_blocks_of(const char *law)
{
    (void)law;
    return 0;
}
"""
NO_POINT_BLOCKS = """/* This scene has no drag. */
#include "point_blocks.h"

const fu_drag_blocks *fu_drag_blocks_of(const char *family)
{
    (void)family;
    return 0;
}
"""


class Kernels(NamedTuple):
    """The kernels of a scene: texts of files by name, the files to compile, and the tables of the registry in C."""

    files: dict[str, str]
    compiled: list[str]
    tables: str


def engine_files() -> dict[str, str]:
    """Return the C files and headers of the engine by their paths below it."""
    return {path.relative_to(ENGINE).as_posix(): path.read_text(encoding="utf-8")
            for pattern in ("**/*.c", "**/*.h") for path in sorted(ENGINE.glob(pattern))}


def kernels_of(wanted: Iterable[tuple[str, str]]) -> Kernels:
    """Return the kernels of tables by role and name."""
    entries = {(role, name): _entries()[role][name] for role, name in wanted}
    functions = {word for entry in entries.values() for word in re.findall(r"\w+", entry) if word in _homes()}
    laws = sorted(name for role, name in entries if role == "law")
    has_drag = any(role == "drag" for role, _ in entries)
    blocks = _law_blocks(laws)
    sources = {_homes()[function] for function in functions}
    included = set(re.findall(r'#include "(\w+\.c)"', blocks)) | ({"drag.c", "planar_drag.c"} if has_drag else set())
    files = {name: _text(name) for name in sorted(sources | included)}
    headers = {*HEADERS, *(name for text in files.values() for name in re.findall(r'#include "(\w+\.h)"', text))}
    files |= {name: _text(name) for name in sorted(headers)}
    files |= {"blocks.c": blocks, "point_blocks.c": _text("point_blocks.c") if has_drag else NO_POINT_BLOCKS}
    return Kernels(files, sorted({*sources, "blocks.c", "point_blocks.c"}), _tables(entries))


@cache
def _text(name: str) -> str:
    return (GENERATED / name).read_text(encoding="utf-8")


@cache
def _homes() -> dict[str, str]:
    """Return the file of each kernel by its name."""
    return {name: path.name for path in sorted(GENERATED.glob("*.c"))
            if path.name not in ("kernels.c", "registry.c", "blocks.c", "point_blocks.c")
            for name in re.findall(r"^(?:FU_KERNEL )?void (\w+)\(", _text(path.name), re.MULTILINE)}


@cache
def _entries() -> dict[str, dict[str, str]]:
    """Return the entries of the tables of kernels in C, by role and name."""
    tables = re.findall(r"^static const fu_(\w+)_kernels \w+\[\] = \{\n(.*?)^\};", _text("registry.c"),
                        re.MULTILINE | re.DOTALL)
    return {role: {re.findall(r'^\{"(\w+)"', entry)[0]: entry
                   for entry in re.findall(r"^    (\{.*?\}),\n", text, re.MULTILINE | re.DOTALL)}
            for role, text in tables}


def _tables(entries: dict[tuple[str, str], str]) -> str:
    """Return the tables of these kernels, and the list of them."""
    lines = []
    for k, ((role, _), entry) in enumerate(entries.items()):
        lines.append(f"static const fu_{role}_kernels table_{k} = {entry};\n")
    lines.append("static const fu_linked kernels[] = {\n")
    lines += [f'    {{"{role}", "{name}", &table_{k}}},\n' for k, (role, name) in enumerate(entries)]
    return "".join(lines) + "    {0, 0, 0}};\n"


def _law_blocks(laws: list[str]) -> str:
    """Return blocks.c with these laws alone."""
    text = _text("blocks.c")
    rows = {law: found[0] for law in laws if (found := re.findall(rf'^    \{{"{law}",.*\}}', text, re.MULTILINE))}
    used = {word.removeprefix("block_") for row in rows.values() for word in re.findall(r"\bblock_\w+", row)}
    if not used:
        return NO_LAW_BLOCKS
    homes = {_homes()[name] for name in used}
    kept = []
    for line in text.splitlines(keepends=True):
        included = re.match(r'#include "(\w+\.c)"', line)
        made = re.match(r"FU_BLOCK_OF_\w+\((\w+)", line)
        row = re.match(r'    \{"(\w+)",', line)
        if (included and included[1] not in homes) or (made and made[1] not in used) or (row and row[1] not in rows):
            continue
        kept.append(line.rstrip().rstrip(",") + ",\n" if row else line)
    return "".join(kept)
