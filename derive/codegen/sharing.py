"""Stages that several kernels have alike are printed once: as macros, which a kernel names where the stage stands.

A macro and not a function: a stage makes many numbers that later stages take, and as a macro it costs what it costs
written out. Stages of one file stand at its head, those of several files of a group (the laws of an element, the
slides) in the header of the group.

Enters: sections by kernel by family. Leaves: the same with names for what is shared, and the shared stages.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

from .family import Family
from .loops import Section

LEAST = 300
"""Characters of a stage that are worth a macro: below, a reader finds more where it stands."""
Sections = dict[str, list[Section]]
"""The sections of a family's kernels, by kernel."""


@dataclass(frozen=True)
class SharedStage:
    """A stage of several kernels: name of its macro, title, names of the kernels, lines of C."""

    name: str
    title: str
    kernels: tuple[str, ...]
    lines: tuple[str, ...]

    @property
    def text(self) -> str:
        """Return the definition of the macro, with a comment on what it is and whose."""
        users = f"{self.kernels[0]} and {len(self.kernels) - 1} more"
        return " \\\n".join([f"/* {self.title}: of {users} */\n#define {self.name}", *(f"    {s}" for s in self.lines)])


def header(group: str) -> str:
    """Return the name of the header with the stages of a group's files."""
    return f"{group}_stages.h"


def share(families: Mapping[str, Family], sections: Mapping[str, Sections]) -> dict[str, list[SharedStage]]:
    """Put names in place of the stages that kernels share; return the shared stages by where they stand.

    families: all of each group that is among them, by name; sections: by family. The stages stand in a family's own
    file, by its name, or in a header, by the name of that.
    """
    users: dict[tuple, list[tuple[str, str, Section]]] = {}
    for family, of_family in sections.items():
        for kernel, of_kernel in of_family.items():
            for section in of_kernel:
                if sum(map(len, section.lines)) >= LEAST:
                    key = (families[family].group or family, section.title, tuple(section.lines))
                    users.setdefault(key, []).append((family, kernel, section))
    found: dict[str, list[SharedStage]] = {header(f.group): [] for f in families.values() if f.group}
    taken: Counter[str] = Counter()
    for (group, title, lines), of_stage in users.items():
        if len(of_stage) == 1:
            continue
        files = {family for family, _, _ in of_stage}
        where, prefix = (header(group), group) if len(files) > 1 else (of_stage[0][0],) * 2
        name = re.sub(r"\W+", "_", f"{prefix} {title}").strip("_").upper()
        taken[name] += 1
        stage = SharedStage(name if taken[name] == 1 else f"{name}_{taken[name]}", title,
                            tuple(kernel for _, kernel, _ in of_stage), lines)
        found.setdefault(where, []).append(stage)
        for _, _, section in of_stage:
            section.title, section.lines = "", [stage.name]
    return found
