"""`funicular derive`: write generated/, or check that it still is what the specs say."""

from __future__ import annotations

import difflib
import json
from importlib import resources
from pathlib import Path

from funicular.derive import emit
from funicular.derive.families import families
from rich.console import Console
from rich.progress import Progress

MANIFEST = "manifest.json"
GENERATED_SUFFIXES = {".c", ".h", ".pyx", ".py", ".json"}


def folder() -> Path:
    """Where the generated files of this installation are."""
    return Path(str(resources.files("funicular.generated")))


def generate(names: list[str] | None = None, show: bool = False) -> dict[str, str]:
    """Text of every generated file, or of the named families' and the common ones, by file name.

    Raises KeyError for an unknown family, naming the near ones.
    """
    every = families()
    for name in names or []:
        if name not in every:
            near = difflib.get_close_matches(name, every, n=3) or sorted(every)
            raise KeyError(f'no spec "{name}"; did you mean {", ".join(near)}?')
    wanted = set(names or every)
    with Progress(disable=not show, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("derive", total=len(every) + len(wanted))
        derived = []
        for family in every.values():
            progress.update(task, description=f"derive {family.name}")
            derived.append(emit.derive(family))
            progress.advance(task)
        progress.update(task, description="print")
        files = emit.render(derived, wanted, lambda _: progress.advance(task))
    texts = {f"{n}.c": _current(f"{n}.c") for n in every if n not in wanted} | files
    files[MANIFEST] = emit.manifest(derived, {k: v for k, v in texts.items() if v is not None})
    return files


def _current(name: str) -> str | None:
    path = folder() / name
    return path.read_text(encoding="utf-8") if path.is_file() else None


def write(files: dict[str, str]) -> list[str]:
    """Write what differs; returns the names written."""
    changed = [name for name, text in files.items() if _current(name) != text]
    for name in changed:
        (folder() / name).write_text(files[name], encoding="utf-8", newline="\n")
    return changed


def differences(files: dict[str, str], whole: bool) -> list[str]:
    """What is wrong with generated/: a paragraph for each missing, stale, edited or (when whole) extra file."""
    found = []
    recorded = json.loads(_current(MANIFEST) or "{}").get("families", {})
    for name, text in sorted(files.items()):
        current = _current(name)
        if current is None:
            found.append(f"missing: generated/{name}")
            continue
        if current != text:
            kind = "differs"
            family = recorded.get(Path(name).stem)
            if family and family["spec_hash"] not in text:
                kind = "stale (its spec has changed)"
            diff = difflib.unified_diff(current.splitlines(), text.splitlines(), f"generated/{name}",
                                        f"derived/{name}", lineterm="", n=2)
            found.append(f"{kind}: generated/{name}\n" + "\n".join(diff))
    if whole:
        found += [f"extra: generated/{p.name} (no spec makes it; delete it)" for p in sorted(folder().iterdir())
                  if p.suffix in GENERATED_SUFFIXES and p.name not in files and not _is_built(p)]
    return found


def _is_built(path: Path) -> bool:
    """Cython's output of a generated .pyx, left by a build in place."""
    return path.suffix == ".c" and path.with_suffix(".pyx").is_file()


def main(names: list[str], check: bool = False) -> int:
    """The command; returns its exit code."""
    out = Console(soft_wrap=True, highlight=False, markup=False)
    err = Console(stderr=True, soft_wrap=True, highlight=False, markup=False)
    try:
        files = generate(names, show=err.is_terminal)
    except KeyError as unknown:
        err.print(f"funicular derive: {unknown.args[0]}")
        return 1
    if not check:
        changed = write(files)
        out.print(f"{len(files)} files, {len(changed)} written" + (": " + ", ".join(changed) if changed else ""))
        return 0
    found = differences(files, whole=not names)
    for paragraph in found:
        out.print(paragraph)
    if found:
        err.print(f"generated/ differs from the specs in {len(found)} files; `funicular derive"
                  f"{''.join(' ' + n for n in names)}` mends it")
        return 1
    out.print(f"generated/ agrees with the specs: {len(files)} files")
    return 0
