"""The command `funicular derive`: from specs to files, in one direction.

specs      elements, laws, bodies and couplings, as `catalogue.families` lists them
           -> families: a builder each, with the modules that decide its text
programs   `codegen.rendering.derive` runs the builder of a family: SymPy expressions, staged, without what no output
           needs -> programs, one a kernel
text       `codegen.rendering.render` fills the templates with programs printed as C -> text by file name
manifest   `codegen.manifest.text` says what was made, from what, with which tools
files      `codegen.drift` compares the texts with generated/, or writes those that differ

A family whose specs, tools and file are those that the manifest records is not derived again. Comments and docstrings
of a spec do not count.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from funicular.errors import ResultFileError
from rich.console import Console
from rich.progress import Progress

from .algebra import section_points
from .catalogue import families, named, whole_groups
from .codegen import drift, manifest, provenance
from .codegen import rendering as emit
from .codegen.family import Family, FamilyError
from .spec import MAX_SEGMENTS


def generate(names: list[str] | None = None, show: bool = False) -> dict[str, str]:
    """Return the text of every generated file, or (names not None) of those of the named families and their groups, and
    of the common ones, by name.

    With names, the other families stand in the common files as the manifest records them: as their files are.
    Raises KeyError for an unknown family, naming the near ones.
    """
    every = families()
    wanted = every if names is None else whole_groups(named(names))
    record = {} if names is None else drift.record()
    with Progress(disable=not show, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("derive", total=2 * len(wanted))
        known = []
        for name, family in every.items():
            if name in wanted:
                progress.update(task, description=f"derive {name}")
                known.append(emit.derive(family))
                progress.advance(task)
            elif old := manifest.recorded(family, record):
                known.append(old)
        progress.update(task, description="print")
        files = emit.render(known, wanted, lambda _: progress.advance(task))
    own = {name: files.get(name, drift.current(name)) for d in known for name in drift.of(d.family)}
    files[drift.MANIFEST] = manifest.text(known, _origin(record, None if names is None else wanted.keys()),
                                          {name: text for name, text in own.items() if text is not None},
                                          more={"section_points": section_points.table(),
                                                "max_segments": MAX_SEGMENTS})
    return files


def _origin(record: dict[str, Any], wanted: Collection[str] | None) -> manifest.Origin:
    """Return the origin of all files after the derivation of the wanted families (None: of all).

    While another family is stale, its record must stay that of the sources that it was made from.
    """
    if wanted is not None and stale(record).keys() - wanted:
        return manifest.Origin(record.get("tools", {}), record.get("sources", {}))
    return manifest.origin(families().values())


def stale(record: dict[str, Any]) -> dict[str, Family]:
    """Return the families by name whose specs or tools are not those that a manifest records."""
    every = families()
    if record.get("tools") != emit.tools():
        return every
    now = provenance.hashes(every.values())
    changed = {file for file, hash_now in now.items() if record["sources"].get(file) != hash_now}
    return {name: family for name, family in every.items()
            if record["families"].get(name, {}).get("doc") != family.doc
            or not changed.isdisjoint(provenance.deciding(family.modules))}


def changed() -> list[str]:
    """Return the names of the families whose specs, tools or files are not those that the manifest records."""
    record = drift.record()
    outdated = stale(record)
    return [name for name, family in families().items() if name in outdated
            or any(record["files"].get(file) != emit.digest(drift.current(file) or "") for file in drift.of(family))]


def main(names: list[str], check: bool = False) -> int:
    """Write generated/, or compare it with the specs, and return the exit code of the command."""
    out = Console(soft_wrap=True, highlight=False, markup=False)
    err = Console(stderr=True, soft_wrap=True, highlight=False, markup=False)
    try:
        # a check derives everything, whatever the hashes
        files = generate(names or (None if check else changed()), show=err.is_terminal)
        written = [] if check else drift.write(files)
    except (KeyError, OSError, FamilyError, ResultFileError) as problem:
        err.print(f"funicular derive: {problem.args[0] if isinstance(problem, KeyError) else problem}")
        return 1
    unknown = [] if names else drift.extra(families())
    if not check:
        out.print("\n".join([f"{len(files)} files, {len(written)} written" + (": " if written else "")
                             + ", ".join(written), *unknown]))
        return 0
    found = drift.differences(files, stale(drift.record()).values())
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
