"""A library on disk: rendered and compiled in a folder of its own, then moved to where the user wants it."""

from __future__ import annotations

import hashlib
import json
import os
from pathlib import Path
from typing import Any

from funicular.kernels.elements import manifest
from funicular.kernels.libraries import LibraryError, manifest_digest, read_manifest

from ..codegen import provenance
from ..codegen import rendering as emit
from ..codegen.drift import MANIFEST
from ..codegen.family import Family
from ..codegen.manifest import json_text, origin
from ..codegen.manifest import text as manifest_text
from ..codegen.rendering import Derived
from ..verify.compiled import SHARED_FLAGS, compiler
from .load import SpecError


def check_destination(out: Path) -> None:
    """Raise SpecError where a library cannot be written: no such place, no right to, or something else is there."""
    nearest = next(p for p in (out, *out.parents) if p.exists())
    if not nearest.is_dir() or not os.access(nearest, os.W_OK):
        raise SpecError(str(out), f"cannot be written: {nearest} is "
                        + ("not writable" if nearest.is_dir() else "not a directory"), "give another --out DIR")
    if out.is_dir() and any(out.iterdir()) and recorded(out) is None:
        raise SpecError(str(out), "is not empty and holds no library, so that nothing is written there",
                        "give a new or an empty directory to --out")


def recorded(out: Path) -> dict[str, Any] | None:
    """Return the manifest of the library in a directory, None where there is none."""
    try:
        return read_manifest(out)[1]
    except LibraryError:
        return None


def is_current(out: Path, families: list[Family]) -> bool:
    """Return whether a directory's library is what these families make with the tools at hand."""
    content = recorded(out)
    if (content is None or content["library"].get("digest") != manifest_digest(content)
            or content["tools"] != emit.tools() or content["interface"] != manifest()["interface"]):
        return False
    file = out / content["library"]["file"]
    return (content["sources"] == provenance.hashes(families)
            and all(emit.digest(_text(out / name)) == digest for name, digest in content["files"].items())
            and file.is_file() and _digest(file) == content["library"]["sha256"])


def render(every: list[Derived]) -> dict[str, str]:
    """Return the text of a library's C files and header by name."""
    return emit.render(every, [d.family.name for d in every], lambda _: None, layout_of=manifest()["tables"])


def write_manifest(every: list[Derived], files: dict[str, str], spec: Path, shared: Path) -> dict[str, Any]:
    """Write the manifest next to the shared library; returns it."""
    more = {"library": {"spec": str(spec), "file": shared.name, "sha256": _digest(shared),
                        "compiler": " ".join([*compiler(), *SHARED_FLAGS])}}
    made_from = origin([d.family for d in every])
    content: dict[str, Any] = json.loads(manifest_text(every, made_from, files, layout_of=manifest()["tables"],
                                                       more=more))
    content["library"]["digest"] = manifest_digest(content)
    (shared.parent / MANIFEST).write_text(json_text(content), encoding="utf-8", newline="\n")
    return content


def move(folder: Path, out: Path) -> None:
    """Put a finished library where it is wanted, its manifest last; files of an older one that are gone go."""
    out.mkdir(parents=True, exist_ok=True)
    old = recorded(out)
    names = sorted((p.name for p in folder.iterdir()), key=lambda name: name == MANIFEST)
    for name in names:
        os.replace(folder / name, out / name)
    if old is not None:
        for name in {*old["files"], old["library"]["file"]} - set(names):
            if Path(name).name == name:  # nothing elsewhere, whatever the old manifest says
                (out / name).unlink(missing_ok=True)


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8") if path.is_file() else ""


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
