r"""The document as LaTeX, for pdflatex with amsmath and graphicx.

Formulas stand one to a line between \begin{formula} and \end{formula}, each behind a comment with its identifier: that
is what the check reads back. What is wider than the page is scaled to it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from .document import Document, Formula, Item
from .markdown import inline
from .notation.latex import display, latex
from .notation.mathml import LETTERS
from .notation.parse import parse
from .provenance import kernel, tagged

PREAMBLE = r"""\documentclass[11pt,a4paper]{article}
\usepackage[utf8]{inputenc}
\usepackage{amsmath,amssymb,graphicx}
\usepackage[margin=25mm]{geometry}
\usepackage{hyperref}
\setcounter{MaxMatrixCols}{99}
\setlength{\parindent}{0pt}\setlength{\parskip}{5pt plus 2pt}
\newcommand{\is}{&=}
\newcommand{\wrap}{\\&\quad}
\newsavebox{\formulabox}
% a displayed formula, scaled to the page where it is wider, with the number of the paper's equation
\newcommand{\shown}[2]{\par\smallskip\sbox{\formulabox}{$\displaystyle #1$}%
  \noindent\begin{minipage}{0.93\linewidth}\hspace*{1.5em}%
  \ifdim\wd\formulabox>0.94\linewidth\resizebox{0.94\linewidth}{!}{\usebox{\formulabox}}\else\usebox{\formulabox}\fi
  \end{minipage}\hfill #2\par}
\newcommand{\trace}[1]{{\footnotesize\raggedright\hspace*{1.5em}#1\par}}
\newenvironment{note}{\begin{quote}}{\end{quote}}
\allowdisplaybreaks
\emergencystretch=3em
"""
ESCAPES = {"\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_", "{": r"\{",
           "}": r"\}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "<": r"\textless{}",
           ">": r"\textgreater{}", "→": r"$\to$", "·": r"$\cdot$", "′": r"$'$", "−": "$-$", "–": "--",
           "½": r"$\frac12$", "²": r"\textsuperscript{2}", "³": r"\textsuperscript{3}", "°": r"$^\circ$",
           "×": r"$\times$",
           "µ": r"$\mu$", "…": r"\dots{}", "∫": r"$\int$", "≥": r"$\ge$", "≤": r"$\le$", "∂": r"$\partial$",
           "¼": r"$\frac14$", "¾": r"$\frac34$", "é": r"\'e", "ö": r"\"o", "ü": r"\"u", "√": r"$\surd$",
           "⊗": r"$\otimes$", "¹": r"\textsuperscript{1}", "⁻": r"\textsuperscript{-}", "±": r"$\pm$"}
ESCAPES |= {greek: f"$\\{name}$" for name, greek in LETTERS.items()}
FORMULA = re.compile(r"% (\S+)\n\\shown\{(.*)\}\{.*\}\n")


def tex(document: Document) -> str:
    """Return the text of the file."""
    body = "\n".join(_Writer().items(document))
    return (f"{PREAMBLE}\\title{{{plain(document.title)}}}\\author{{}}\\date{{}}\n\\begin{{document}}\n\\maketitle\n"
            f"{text(document.lead)}\n\\tableofcontents\n{body}\n\\end{{document}}\n")


def formulas(source: str) -> dict[str, str]:
    """Return the LaTeX of the displayed formulas of a file, by identifier."""
    return {name: formula for name, formula in FORMULA.findall(source)}


def plain(words: str) -> str:
    """Return words with what LaTeX takes for itself escaped. Raises ValueError for a letter that it does not have."""
    done = "".join(ESCAPES.get(c, c) for c in words)
    if not done.isascii():
        raise ValueError(f"no LaTeX for {next(c for c in done if not c.isascii())} in {words}")
    return done


def text(words: str) -> str:
    """Return a paragraph's inside."""
    parts = []
    for kind, part in inline(words):
        if kind == "code":
            parts.append(f"\\texttt{{{plain(part)}}}".replace(r"\_", r"\_\allowbreak{}"))
        elif kind == "math":
            parts.append(f"${latex(parse(part))}$")
        elif kind == "stress":
            parts.append(f"\\emph{{{plain(part)}}}")
        elif kind == "link":
            label, _, address = part.partition("](")
            parts.append(f"\\href{{{address}}}{{{plain(label)}}}")
        else:
            parts.append(plain(part))
    return "".join(parts)


class _Writer:
    """Writes the items of a document."""

    def items(self, document: Document) -> Iterator[str]:
        """Yield the text of each item."""
        for item in document.items:
            yield getattr(self, "_" + item.block.kind.replace("-", "_"))(item)

    def _heading(self, item: Item) -> str:
        command = {1: "section", 2: "subsection", 3: "subsubsection"}[min(item.block.level, 3)]
        return f"\\{command}{{{text(item.block.text)}}}"

    def _paragraph(self, item: Item) -> str:
        return f"{text(item.block.text)}\n"

    def _list(self, item: Item) -> str:
        items = "\n".join(f"\\item {text(words)}" for words in item.block.items)
        return f"\\begin{{itemize}}\n{items}\n\\end{{itemize}}"

    def _table(self, item: Item) -> str:
        head, *rows = item.block.rows
        return _table(head, rows)

    def _misprint(self, item: Item) -> str:
        number = item.block.about
        title = f"Eq {number} in print." if number.isdigit() else "In print."
        return f"\\begin{{note}}\\textbf{{{title}}} {text(item.block.text)}\\end{{note}}"

    def _proof(self, item: Item) -> str:
        proof = item.proof
        assert proof is not None
        return (f"\\begin{{note}}\\textbf{{In numbers.}} {text(proof.done)}\n\n{_table(proof.head, proof.rows)}\n\n"
                f"{text(proof.follows)}\\end{{note}}")

    def _scope(self, item: Item) -> str:
        assert item.scope is not None
        name = item.scope.family.name
        return f"Symbols, arguments of the kernels of {text(f'`{name}`')}:\n\n" + _table(
            ["symbol", "argument", "is", "unit"], item.scope.legend(), "llp{0.5\\linewidth}p{0.22\\linewidth}")

    def _stage(self, item: Item) -> str:
        return f"\\paragraph{{{plain(item.block.text)}}}\n{self._formula(item)}"

    def _formula_folded(self, item: Item) -> str:
        return self._formula(item)

    def _formula(self, item: Item) -> str:
        lines = [self._line(f, item.block.about if k == 0 else "") for k, f in enumerate(item.formulas)]
        return "".join(lines) + self._trace(item)

    def _line(self, formula: Formula, number: str) -> str:
        index = f"\\quad\\text{{for each }}{formula.line.index}" if formula.line.index else ""
        mark = f"({number})" if number else index and f"${index}$"
        return f"% {formula.identifier}\n\\shown{{{display(formula.tree)}}}{{{mark}}}\n"

    def _trace(self, item: Item) -> str:
        rows = []
        for formula in item.formulas:
            if formula.deviation is None or item.scope is None:
                continue
            if formula.kernel:
                k = kernel(item.scope.family.name, *formula.kernel)
                rows.append(f"{text(f'`{k.name}`')}, {plain(k.output)}: {plain(k.file)}:{k.line}, {k.operations} "
                            f"operations; verified as {plain(k.verified)}; {formula.deviation:.1e}")
            else:
                rows.append(f"both sides agree: {formula.deviation:.1e}")
        number = item.block.about
        if number.isdigit() and int(number) in tagged():
            rows.append(f"eq {number} is at {plain(tagged()[int(number)])}")
        return "".join(f"\\trace{{{row}}}\n" for row in rows)


def _table(head: list[str], rows: list[list[str]], columns: str = "") -> str:
    lines = [" & ".join(map(text, row)) + r" \\" for row in (head, *rows)]
    return (f"{{\\footnotesize\\begin{{tabular}}{{{columns or 'l' * len(head)}}}\n\\hline\n{lines[0]}\n\\hline\n"
            + "\n".join(lines[1:]) + "\n\\hline\n\\end{tabular}}")
