"""The document as one HTML file: MathML, one stylesheet inlined, no script, nothing from the network."""

from __future__ import annotations

import re
from collections.abc import Iterator
from html import escape
from pathlib import Path

from .document import Document, Formula, Item
from .markdown import Block, inline
from .notation.latex import latex, width
from .notation.mathml import mathml
from .notation.parse import parse
from .notation.tree import Node
from .provenance import kernel, tagged

NARROW = 34
"""Width in letters up to which the formulas of a long run stand side by side."""
STYLE = Path(__file__).with_name("style.css")


def html(document: Document) -> str:
    """Return the page."""
    body = "\n".join(_Writer(document).items())
    contents = _contents(document)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8"/>
<meta name="viewport" content="width=device-width, initial-scale=1"/>
<meta name="color-scheme" content="light dark"/>
<title>{escape(document.title)}</title>
<style>
{STYLE.read_text(encoding="utf-8")}</style>
</head>
<body>
<nav aria-label="Contents"><p class="title"><a href="#top">{escape(document.title)}</a></p>
{contents}
</nav>
<main id="top">
<h1>{escape(document.title)}</h1>
<p class="lead">{text(document.lead)}</p>
{body}
{_index(document)}
</main>
</body>
</html>
"""


def narrow(tree: Node) -> bool:
    """Return whether a formula takes no more than half of a line."""
    return "begin{bmatrix}" not in latex(tree) and width(tree) < NARROW


def anchor(title: str) -> str:
    """Return the identifier of a heading."""
    return re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-")


def text(words: str) -> str:
    """Return a paragraph's inside."""
    parts = []
    for kind, part in inline(words):
        if kind == "code":
            parts.append(f"<code>{escape(part)}</code>")
        elif kind == "math":
            parts.append(mathml(parse(part), display=False))
        elif kind == "stress":
            parts.append(f"<em>{escape(part)}</em>")
        elif kind == "link":
            label, _, address = part.partition("](")
            parts.append(f'<a href="{escape(address)}">{escape(label)}</a>')
        else:
            parts.append(escape(part))
    return "".join(parts)


def _contents(document: Document) -> str:
    """Return the table of contents: chapters, sections, and the numbers of the paper's equations in each chapter."""
    lines, chapter = ["<ul>"], ""
    for item in document.items:
        block = item.block
        if block.kind == "heading" and block.level <= 2:
            if block.level == 1:
                chapter = block.text
                lines.append(f'<li class="chapter"><a href="#{anchor(chapter)}">{escape(chapter)}</a>'
                             f'{_equations(document, chapter)}</li>')
            else:
                name = anchor(f"{chapter} {block.text}")
                lines.append(f'<li><a href="#{name}">{escape(block.text)}</a></li>')
    if len(equations(document)) >= len(tagged()):
        lines.append('<li class="chapter"><a href="#index-of-equations">Index of equations</a></li>')
    return "\n".join([*lines, "</ul>"])


def _equations(document: Document, chapter: str) -> str:
    """Return the range of the paper's equations in a chapter."""
    numbers, here = [], False
    for item in document.items:
        if item.block.kind == "heading" and item.block.level == 1:
            here = item.block.text == chapter
        elif here and item.block.kind.startswith("formula") and item.block.about.isdigit():
            numbers.append(int(item.block.about))
    if not numbers:
        return ""
    first, last = min(numbers), max(numbers)
    return f' <span class="range">{first}</span>' if first == last else f' <span class="range">{first}–{last}</span>'


def equations(document: Document) -> dict[int, list[Item]]:
    """Return the blocks of formulas by the number of the paper's equation that they are, in order of the numbers."""
    found: dict[int, list[Item]] = {}
    for item in document.items:
        if item.block.kind.startswith("formula") and item.block.about.isdigit():
            found.setdefault(int(item.block.about), []).append(item)
    return dict(sorted(found.items()))


def _index(document: Document) -> str:
    """Return the table of the paper's equations: where each is in the sources, and the kernels that it went into."""
    rows = []
    for number, items in equations(document).items():
        kernels = {}
        for item in items:
            for f in item.formulas:
                if f.kernel and f.deviation is not None and item.scope is not None:
                    k = kernel(item.scope.family.name, *f.kernel)
                    kernels[k.name, k.output] = (f"<code>{k.name}</code> → <code>{k.output}</code> "
                                                 f'<span class="place">{k.file}:{k.line}</span>')
        place = tagged().get(number, "")
        by_hand = not place or place.startswith("runtime")  # the engine's sources are not part of a wheel
        without = "the engine, written by hand" if by_hand else "a step of the derivation"
        rows.append(f'<tr><td><a href="#eq-{number}">{number}</a></td><td><span class="place">{place}</span></td>'
                    f"<td>{'<br/>'.join(kernels.values()) or without}</td></tr>")
    if len(rows) < len(tagged()):
        return ""  # a page of one subject
    return ('<h2 id="index-of-equations"><a href="#index-of-equations">Index of equations</a></h2>\n<div class="wide">'
            "<table><thead><tr><th>eq</th><th>in the sources</th><th>generated functions</th></tr></thead><tbody>\n"
            + "\n".join(rows) + "\n</tbody></table></div>")


class _Writer:
    """Writes the items of a document; knows the chapter, and which equation numbers have an anchor already."""

    def __init__(self, document: Document):
        self.document, self.chapter, self.section = document, "", ""
        self._numbered: set[str] = set()

    def items(self) -> Iterator[str]:
        """Yield the text of each item."""
        staged = False
        for item in self.document.items:
            inside = item.block.kind == "stage"
            if inside and not staged:
                yield '<details class="staged"><summary>Every stage of the kernel</summary>'
            elif staged and not inside:
                yield "</details>"
            staged = inside
            yield getattr(self, "_" + item.block.kind.replace("-", "_"))(item)
        if staged:
            yield "</details>"

    def _heading(self, item: Item) -> str:
        title, level = item.block.text, item.block.level
        if level == 1:
            self.chapter, self.section = title, ""
        elif level == 2:
            self.section = title
        above = "" if level == 1 else self.chapter if level == 2 else f"{self.chapter} {self.section}"
        name = anchor(f"{above} {title}")
        return f'<h{level + 1} id="{name}"><a href="#{name}">{escape(title)}</a></h{level + 1}>'

    def _paragraph(self, item: Item) -> str:
        return f"<p>{text(item.block.text)}</p>"

    def _list(self, item: Item) -> str:
        return "<ul>" + "".join(f"<li>{text(words)}</li>" for words in item.block.items) + "</ul>"

    def _table(self, item: Item) -> str:
        head, *rows = item.block.rows
        return _table(head, rows)

    def _misprint(self, item: Item) -> str:
        number = item.block.about
        title = f"Eq {number} in print" if number.isdigit() else "In print"
        return f'<aside class="misprint"><p><strong>{title}.</strong> {text(item.block.text)}</p></aside>'

    def _proof(self, item: Item) -> str:
        proof = item.proof
        assert proof is not None
        return (f'<aside class="proof"><p><strong>In numbers.</strong> {text(proof.done)}</p>'
                f"{_table(proof.head, proof.rows)}<p>{text(proof.follows)}</p></aside>")

    def _scope(self, item: Item) -> str:
        assert item.scope is not None
        if item.scope.family.role == "joint" and "joint" in self._numbered:
            return ""  # the same for every kind
        self._numbered.add(item.scope.family.role)
        name = item.scope.family.name
        table = _table(["symbol", "argument", "is", "unit"], item.scope.legend())
        return (f'<details class="symbols"><summary>Symbols of this chapter, arguments of the kernels '
                f"<code>{escape(name)}_…</code></summary>{table}</details>")

    def _stage(self, item: Item) -> str:
        return f"<h5>{escape(item.block.text)}</h5>\n{self._formula(Item(Block('formula'), item.scope, item.formulas))}"

    def _formula_folded(self, item: Item) -> str:
        title = item.block.text or f"{len(item.formulas)} formulas"
        return (f'<details class="folded"><summary>{escape(title)}</summary>'
                f"{self._formula(item)}</details>")

    def _formula(self, item: Item) -> str:
        number = item.block.about
        label, name = "", ""
        if number:
            if number not in self._numbered:
                self._numbered.add(number)
                name = f' id="eq-{number}"'
            label = f'<span class="number">({number})</span>'
        lines = "\n".join(self._line(f) for f in item.formulas)
        many = " many" if sum(narrow(f.tree) for f in item.formulas) > 5 else ""
        return (f'<div class="equation"{name}><div class="lines{many}">\n{lines}\n</div>{label}</div>\n'
                f"{self._trace(item)}")

    def _line(self, formula: Formula) -> str:
        index = (f' <span class="for">for each {mathml(parse(formula.line.index), display=False)}</span>'
                 if formula.line.index else "")
        wide = "" if narrow(formula.tree) else " wide"
        return f'<div class="line{wide}">{mathml(formula.tree, identifier=formula.identifier)}{index}</div>'

    def _trace(self, item: Item) -> str:
        """Return where the formulas of a block went, and where their equation stands in the sources."""
        rows = []
        for formula in item.formulas:
            if formula.kernel and formula.deviation is not None:
                assert item.scope is not None
                k = kernel(item.scope.family.name, *formula.kernel)
                verified = f'; verified as <q>{escape(k.verified)}</q>' if k.verified else ""
                minus = "minus " if formula.sign < 0 else ""
                rows.append(f"{minus}<code>{k.name}</code> → <code>{k.output}</code> [{escape(k.unit)}], "
                            f'<span class="place">{k.file}:{k.line}</span>, {k.operations} operations{verified}; '
                            f'<strong class="deviation">{_power(formula.deviation)}</strong>')
            elif formula.deviation is not None:
                rows.append(f'both sides agree: <strong class="deviation">{_power(formula.deviation)}</strong>')
        number = item.block.about
        if item.block.kind.startswith("formula") and number.isdigit() and int(number) in tagged():
            rows.append(f'eq {number} is at <span class="place">{tagged()[int(number)]}</span>')
        return "".join(f'<p class="trace">{row}</p>' for row in rows)


def _power(value: float) -> str:
    if value == 0:
        return "0"
    digits, _, power = f"{value:.1e}".partition("e")
    return f"{digits} · 10<sup>{int(power)}</sup>".replace("<sup>-", "<sup>−")


def _table(head: list[str], rows: list[list[str]]) -> str:
    top = "".join(f"<th>{text(cell)}</th>" for cell in head)
    body = "\n".join("<tr>" + "".join(f"<td>{text(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f'<div class="wide"><table><thead><tr>{top}</tr></thead><tbody>\n{body}\n</tbody></table></div>'
