"""The READMEs and pages in parts: headings, code blocks, links, words of code."""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from markdown_it import MarkdownIt

ROOT = Path(__file__).parents[1]
SUBJECTS = tuple(sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "runtime/guides/pages").glob("*.md")))
"""A page a subject, by hand or printed."""
PAGES = ("README.md", "derive/README.md", "runtime/README.md", "tests/benchmarks/README.md",
         "tests/reference/README.md", "tests/benchmarks/validation.md", "tests/benchmarks/speed.md", *SUBJECTS)


@dataclass
class Block:
    """A code block under a heading of the second level; language "" for an indented block of commands."""

    section: str
    language: str
    text: str


@dataclass
class Page:
    """A page: its anchors as hosts make them, links, pictures and code."""

    path: str
    anchors: set[str] = field(default_factory=set)
    links: list[str] = field(default_factory=list)
    blocks: list[Block] = field(default_factory=list)
    words: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        """The whole page."""
        return (ROOT / self.path).read_text(encoding="utf-8")

    def of(self, section: str, language: str) -> list[str]:
        """Return the blocks of a section in one language."""
        return [block.text for block in self.blocks if (block.section, block.language) == (section, language)]

    def commands(self) -> list[tuple[str, list[str]]]:
        """Return sections and commands, as words, without comments."""
        return [(block.section, shlex.split(line, comments=True))
                for block in self.blocks if not block.language for line in block.text.splitlines() if line.strip()]

    def section(self, name: str) -> str:
        """Return the text under a heading of the second level."""
        return self.text.split(f"\n## {name}\n")[1].split("\n## ")[0]


@cache
def page(path: str) -> Page:
    """Return a page of the repository by its path from the top."""
    found, section, heading = Page(path), "", 0
    for token in MarkdownIt("commonmark").enable("table").parse(found.text):
        if token.type == "heading_open":
            heading = int(token.tag[1])
        elif token.type == "inline":
            if heading:
                title = "".join(child.content for child in token.children)
                found.anchors.add(re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-"))
                section, heading = (title if heading == 2 else section), 0
            for child in token.children:
                if child.type == "code_inline":
                    found.words.append(child.content)
                elif (target := child.attrGet("href") or child.attrGet("src")) is not None:
                    found.links.append(target)
        elif token.type in ("fence", "code_block"):
            found.blocks.append(Block(section, token.info.strip(), token.content))
    return found
