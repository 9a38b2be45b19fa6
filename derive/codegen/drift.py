"""`funicular derive`: write generated/, or check that it still is what the specs say."""

from __future__ import annotations

import difflib
import json
import re
from importlib import resources
from pathlib import Path

from rich.console import Console
from rich.progress import Progress

from ..algebra import section_points
from ..catalogue import families, named
from ..spec import FamilyError
from . import rendering as emit

MANIFEST = "manifest.json"
BYTECODE = "__pycache__"


def folder() -> Path:
    """Where the generated files of this installation are."""
    return Path(str(resources.files("funicular.generated")))


def generate(names: list[str] | None = None, show: bool = False) -> dict[str, str]:
    """Text of every generated file, or (names not None) of the named families' and the common ones, by file name.

    With names, the other families stand in the common files as the manifest records them: as their files are.
    Raises KeyError for an unknown family, naming the near ones.
    """
    every = families()
    wanted = every if names is None else named(names)
    record = {} if names is None else _record()
    with Progress(disable=not show, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("derive", total=2 * len(wanted))
        known = []
        for name, family in every.items():
            if name in wanted:
                progress.update(task, description=f"derive {name}")
                known.append(emit.derive(family))
                progress.advance(task)
            elif old := emit.recorded(family, record):
                known.append(old)
        progress.update(task, description="print")
        files = emit.render(known, wanted, lambda _: progress.advance(task))
    kept = {f"{d.family.name}.c": _current(f"{d.family.name}.c") for d in known if d.family.name not in wanted}
    files[MANIFEST] = emit.manifest(known, {n: text for n, text in kept.items() if text is not None} | files,
                                    more={"section_points": section_points.table()})
    return files


def changed() -> list[str]:
    """Names of the families whose specs, tools or files are not those that the manifest records."""
    record = _record()
    if record.get("tools") != emit.tools():
        return list(families())
    return [name for name, family in families().items()
            if record.get("families", {}).get(name, {}).get("spec_hash") != emit.came_from(family)[1]
            or record["files"].get(f"{name}.c") != emit.digest(_current(f"{name}.c") or "")]


def _current(name: str) -> str | None:
    """Text of a generated file with its own line ends, None where there is none."""
    path = folder() / name
    return path.read_bytes().decode("utf-8", errors="replace") if path.is_file() else None


def _record() -> dict:
    """The manifest, empty where it is missing or broken."""
    try:
        return json.loads(_current(MANIFEST) or "{}")
    except json.JSONDecodeError:
        return {}


def write(files: dict[str, str]) -> list[str]:
    """Write what differs; returns the names written."""
    changed = [name for name, text in files.items() if _current(name) != text]
    for name in changed:
        (folder() / name).write_text(files[name], encoding="utf-8", newline="\n")
    return changed


def differences(files: dict[str, str]) -> list[str]:
    """A paragraph for each generated file that is missing, stale or edited: kind, name, unified diff."""
    found = []
    recorded = _record().get("families", {})
    for name, text in sorted(files.items()):
        current = _current(name)
        if current is None:
            found.append(f"missing: generated/{name}")
        elif current != text:
            family = recorded.get(Path(name).stem)
            stale = name.endswith(".c") and family and family["spec_hash"] not in text
            diff = difflib.unified_diff(current.splitlines(), text.splitlines(), f"generated/{name}",
                                        f"derived/{name}", lineterm="", n=2)
            found.append("\n".join([f"{'stale (its spec has changed)' if stale else 'differs'}: generated/{name}",
                                    *(list(diff) or ["(in line ends only)"])]))
    return found


def extra() -> list[str]:
    """A line for each file in generated/, of whatever kind and however deep, that neither specs nor a build make."""
    known = {MANIFEST, *emit.COMMON, *(f"{name}.c" for name in families())}
    modules = [Path(name).stem for name in emit.COMMON if name.endswith(".pyx")]
    found = [path for path in sorted(folder().rglob("*"))
             if (path.is_symlink() or not path.is_dir() or not any(path.iterdir()))
             and not _is_made(path.relative_to(folder()), known, modules)]
    return [f"extra: generated/{path.relative_to(folder()).as_posix()} (no spec makes it: delete it)" for path in found]


def _is_made(path: Path, known: set[str], modules: list[str]) -> bool:
    """Whether specs make a file, seen from generated/, or a build in place or an import leave it.

    modules: what is compiled, of which Cython leaves C, and each Python its own extension module.
    """
    if path.parent == Path():
        compiled = "|".join(map(re.escape, modules))
        return path.name in known or path.name == BYTECODE or bool(
            re.fullmatch(rf"({compiled})\.(c|(cpython|cp|pypy)[\w-]*\.(so|pyd))", path.name))
    source, _, rest = path.name.partition(".")
    return path.parent == Path(BYTECODE) and f"{source}.py" in known and rest.endswith(".pyc")


def main(names: list[str], check: bool = False) -> int:
    """The command; returns its exit code."""
    out = Console(soft_wrap=True, highlight=False, markup=False)
    err = Console(stderr=True, soft_wrap=True, highlight=False, markup=False)
    try:
        # a check believes no hash: it derives everything
        files = generate(names or (None if check else changed()), show=err.is_terminal)
        if not check:
            written = write(files)
    except (KeyError, OSError, FamilyError) as problem:
        err.print(f"funicular derive: {problem.args[0] if isinstance(problem, KeyError) else problem}")
        return 1
    unknown = [] if names else extra()
    if not check:
        out.print("\n".join([f"{len(files)} files, {len(written)} written" + (": " if written else "")
                             + ", ".join(written), *unknown]))
        return 0
    found = differences(files)
    for paragraph in [*found, *unknown]:
        out.print(paragraph)
    if found:
        err.print(f"generated/ differs from the specs in {len(found)} files; `funicular derive"
                  f"{''.join(' ' + n for n in names)}` mends it")
    if unknown:
        err.print(f"generated/ has {len(unknown)} files that no spec makes: delete them")
    if not (found or unknown):
        out.print(f"generated/ agrees with the specs: {len(files)} files")
    return 1 if found or unknown else 0
