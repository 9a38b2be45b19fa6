"""Stages that several kernels share are printed once, as macros.

A stage defines many numbers that later stages use: a macro costs no more than the text written out, a function would.
Stages of one file stand at its head. Stages of several files of a group (the laws of an element, the slides) stand in
the header of the group. Where stages of one title agree in a part, the part is a macro.

Enters: sections by kernel by family. Leaves: the same with names for what is shared, and the shared stages.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from .family import Family
from .loops import Section, lines_of
from .repeats import Item

MIN_SHARED_CHARACTERS = 300
"""Shortest stage, or part of one, that becomes a macro: shorter ones read better in place."""
Sections = dict[str, list[Section]]
"""The sections of a family's kernels, by kernel."""


@dataclass
class SharedStage:
    """A stage of several kernels, or a part of one: name of its macro, title, names of the kernels, contents."""

    name: str
    title: str
    kernels: tuple[str, ...]
    section: Section

    @property
    def text(self) -> str:
        """Return the definition of the macro, below a comment with its title and its kernels."""
        users = f"{self.kernels[0]} and {len(self.kernels) - 1} more"
        return " \\\n".join([f"/* {self.title}: of {users} */\n#define {self.name}",
                              *(f"    {line}" for line in self.section.lines)])


def header(group: str) -> str:
    """Return the name of the header with the stages of a group's files."""
    return f"{group}_stages.h"


def share(families: Mapping[str, Family], sections: Mapping[str, Sections]) -> dict[str, list[SharedStage]]:
    """Replace shared stages by the names of macros; return the shared stages by file.

    families: all of each group that is among them, by name; sections: by family. The stages stand in a family's own
    file, by its name, or in a header, by the name of that.
    """
    uses: dict[str, list[_Use]] = {}
    for family, of_family in sections.items():
        every = uses.setdefault(families[family].group or family, [])
        every += [_Use({kernel: family}, section.title, section)
                  for kernel, of_kernel in of_family.items() for section in of_kernel]
    found: dict[str, list[SharedStage]] = {header(f.group): [] for f in families.values() if f.group}
    for group, of_group in uses.items():
        for where, stage in _Group(group, of_group).shared():
            found.setdefault(where, []).append(stage)
    return found


@dataclass
class _Use:
    """A section with its title, and the kernels in which it stands with their families."""

    kernels: dict[str, str]
    title: str
    section: Section


Key = tuple[str, str]
"""Title of the stage, text of an assignment."""


@dataclass
class _Run:
    """Assignments that follow each other wherever one of them stands, in stages of one title."""

    items: list[Item]
    places: list[tuple[_Use, int]] = field(default_factory=list)


class _Group:
    """The sections of families that share a header."""

    def __init__(self, name: str, uses: list[_Use]):
        self.name, self.uses = name, uses
        self._taken: Counter[str] = Counter()

    def shared(self) -> list[tuple[str, SharedStage]]:
        """Return shared stages and parts with where they stand; names of macros take their place in the sections."""
        whole = self._stages()
        return [*self._parts(), *whole]

    def _stages(self) -> list[tuple[str, SharedStage]]:
        alike: dict[tuple[Any, ...], list[_Use]] = {}
        for use in self.uses:
            if sum(map(len, use.section.lines)) >= MIN_SHARED_CHARACTERS:
                alike.setdefault((use.title, tuple(use.section.lines)), []).append(use)
        found = []
        for (title, _), users in alike.items():
            if len(users) > 1:
                section = Section("", users[0].section.declared, users[0].section.items)
                kernels = {kernel: family for use in users for kernel, family in use.kernels.items()}
                where, name = self._place(title, kernels)
                found.append((where, SharedStage(name, title, tuple(kernels), section)))
                for use in users:
                    use.section.title, use.section.declared = "", []
                    use.section.items = [Item(name, macro=True)]
                self.uses = [use for use in self.uses if use not in users] + [_Use(kernels, title, section)]
        return found

    def _parts(self) -> list[tuple[str, SharedStage]]:
        found = []
        for (title, _), run in self._runs().items():
            if len(run.places) > 1 and sum(map(len, lines_of(run.items))) >= MIN_SHARED_CHARACTERS:
                kernels = {kernel: family for use, _ in run.places for kernel, family in use.kernels.items()}
                where, name = self._place(f"part of {title}", kernels)
                found.append((where, SharedStage(name, f"part of {title}", tuple(kernels),
                                                 Section("", [], run.items))))
                for use, start in run.places:  # as many items as before: places of other runs stay
                    use.section.items[start:start + len(run.items)] = [Item(name, macro=True),
                                                                       *[_REMOVED] * (len(run.items) - 1)]
        for use in self.uses:
            use.section.items = [item for item in use.section.items if item is not _REMOVED]
        return found

    def _runs(self) -> dict[Key, _Run]:
        """Return the longest runs by the first assignment."""
        before: dict[Key, set[Key | None]] = {}
        after: dict[Key, set[Key | None]] = {}
        keys = [[(use.title, "\n".join(lines_of([item]))) for item in use.section.items] for use in self.uses]
        for of_use in keys:
            for one, other in zip([None, *of_use], [*of_use, None], strict=True):
                if one:
                    after.setdefault(one, set()).add(other)
                if other:
                    before.setdefault(other, set()).add(one)
        found: dict[Key, _Run] = {}
        for use, of_use in zip(self.uses, keys, strict=True):
            first = 0
            for k in range(1, len(of_use) + 1):
                if k == len(of_use) or after[of_use[k - 1]] != {of_use[k]} or before[of_use[k]] != {of_use[k - 1]}:
                    run = found.setdefault(of_use[first], _Run(use.section.items[first:k]))
                    run.places.append((use, first))
                    first = k
        return found

    def _place(self, title: str, kernels: Mapping[str, str]) -> tuple[str, str]:
        """Return the file of a macro that these kernels of families use, and its name."""
        files = set(kernels.values())
        where, prefix = (header(self.name), self.name) if len(files) > 1 else (next(iter(files)),) * 2
        name = re.sub(r"\W+", "_", f"{prefix} {title}").strip("_").upper()
        self._taken[name] += 1
        return where, name if self._taken[name] == 1 else f"{name}_{self._taken[name]}"


_REMOVED = Item("")
"""Placeholder of items that a macro replaces."""
