"""The folder of generated files: its contents, its differences from the specs, and writing to it."""

from __future__ import annotations

import difflib
import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from funicular.base.written_files import write_text

from . import rendering as emit
from . import sharing
from .family import Family

MANIFEST = "manifest.json"
PARTS = ("tools", "families", "sources", "files", "arguments", "kernels")
"""Parts of a manifest that decide which files are up to date."""

BYTECODE = "__pycache__"


def folder() -> Path:
    """Return the folder of this installation's generated files, without an import of funicular.generated.

    It stands beside the folder of this package, in the repository as in an installation.
    """
    return Path(__file__).resolve().parents[2] / "generated"


def current(name: str) -> str | None:
    """Return the text of a generated file with its own line ends, None where there is no such file."""
    path = folder() / name
    return path.read_bytes().decode("utf-8", errors="replace") if path.is_file() else None


def record() -> dict[str, Any]:
    """Return the manifest, empty where it is missing or broken."""
    try:
        found = json.loads(current(MANIFEST) or "{}")
    except json.JSONDecodeError:
        return {}
    whole = isinstance(found, dict) and all(isinstance(found.get(part), dict) for part in PARTS)
    return found if whole else {}


def write(files: dict[str, str]) -> list[str]:
    """Write the files that differ from what stands in the folder, and return their names."""
    folder().mkdir(exist_ok=True)
    changed = [name for name, text in files.items() if current(name) != text]
    for name in changed:
        write_text(folder() / name, files[name])
    return changed


def differences(files: dict[str, str], stale: Iterable[Family]) -> list[str]:
    """Return a paragraph for each generated file that is missing, stale or edited: kind, name, unified diff.

    stale: the families whose specs have changed since their files were made.
    """
    found = []
    made_before = {name for family in stale for name in of(family)}
    for name, text in sorted(files.items()):
        here = current(name)
        if here is None:
            found.append(f"missing: generated/{name}")
        elif here != text:
            diff = difflib.unified_diff(here.splitlines(), text.splitlines(), f"generated/{name}",
                                        f"derived/{name}", lineterm="", n=2)
            kind = "stale (its spec has changed)" if name in made_before else "differs"
            found.append("\n".join([f"{kind}: generated/{name}", *(list(diff) or ["(in line ends only)"])]))
    return found


def of(family: Family) -> list[str]:
    """Return the names of the files of a family: its own, and the header of its group."""
    return [f"{family.name}.c", *([sharing.header(family.group)] if family.group else [])]


def extra(families: Mapping[str, Family]) -> list[str]:
    """Return a line for each file in the folder and below that neither these families nor a build make.
    """
    known = {MANIFEST, *emit.COMMON, *(name for family in families.values() for name in of(family))}
    modules = [Path(name).stem for name in emit.COMMON if name.endswith(".pyx")]
    found = [path for path in sorted(folder().rglob("*"))
             if (path.is_symlink() or not path.is_dir() or not any(path.iterdir()))
             and not _is_made(path.relative_to(folder()), known, modules)]
    return [f"extra: generated/{path.relative_to(folder()).as_posix()} (no spec makes it: delete it)" for path in found]


def _is_made(path: Path, known: set[str], modules: list[str]) -> bool:
    """Return whether a file in generated/ comes from a spec, a build in place, or an import.

    modules: what is compiled, of which Cython leaves C, and each Python its own extension module.
    """
    if path.parent == Path():
        compiled = "|".join(map(re.escape, modules))
        return path.name in known or path.name == BYTECODE or bool(
            re.fullmatch(rf"({compiled})\.(c|(cpython|cp|pypy)[\w-]*\.(so|pyd))", path.name))
    source, _, rest = path.name.partition(".")
    return path.parent == Path(BYTECODE) and f"{source}.py" in known and rest.endswith(".pyc")
