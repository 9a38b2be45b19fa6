"""Formulas as presentation MathML, and from there back to LaTeX, so that one parser reads both texts."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree
from xml.sax.saxutils import escape

from .latex import GREEK, TRANSPOSE, bracket, joined, wrapped
from .tree import (
    At,
    Binary,
    Call,
    Cases,
    Derivative,
    Equation,
    Fraction,
    Integral,
    Matrix,
    Name,
    Node,
    Number,
    Power,
    Product,
    Root,
    Series,
    Size,
    Skew,
    Sum,
    Transpose,
)

LETTERS = dict(zip(GREEK, "αβγδεζηθκλμνξπρστϕφχψωΓΔΘΛΞΠΣΦΨΩ", strict=True))
SIGNS = {"cdot": "·", "times": "×", "otimes": "⊗"}
ACCENTS = {"dot": "˙", "ddot": "¨", "hat": "^", "bar": "¯", "check": "ˇ"}
TIMES, APPLY, MINUS = "\u2062", "\u2061", "\u2212"


def mathml(node: Node, display: bool = True, identifier: str = "") -> str:
    """Return a formula as a <math> element."""
    block = ' display="block"' if display else ""
    name = f' id="{identifier}"' if identifier else ""
    rows = wrapped(node) if display else None
    if rows is not None:
        assert isinstance(node, Equation)
        lines = [_terms(row, begins=k == 0) for k, row in enumerate(rows)]
        lines[0] = f"{_of(node.sides[0])}{_operator('=')}{lines[0]}"
        table = "".join(f"<mtr><mtd>{_row(line)}</mtd></mtr>" for line in lines)
        return f'<math{name}{block}><mtable class="lines" columnalign="left">{table}</mtable></math>'
    return f"<math{name}{block}><mrow>{_of(node)}</mrow></math>"


def _row(text: str) -> str:
    return f"<mrow>{text}</mrow>"


def _operator(text: str, attributes: str = "") -> str:
    return f"<mo{attributes}>{escape(text)}</mo>"


def _brackets(text: str) -> str:
    return _row(f"{_operator('(')}{text}{_operator(')')}")


def _of(node: Node) -> str:
    match node:
        case Number():
            return f"<mn>{node.text}</mn>"
        case Name():
            return _name(node)
        case Equation():
            return _operator("=").join(_of(side) for side in node.sides)
        case Sum():
            return _sum(node)
        case Product():
            return joined(node.factors, [_factor(f, first=k == 0, last=k == len(node.factors) - 1)
                                         for k, f in enumerate(node.factors)], _operator(TIMES),
                          _operator(TIMES, ' lspace="0.14em" rspace="0.14em"'))
        case Binary():
            return f"{_side(node.left)}{_operator(SIGNS[node.sign])}{_side(node.right)}"
        case Fraction():
            return f"<mfrac>{_row(_of(node.above))}{_row(_of(node.below))}</mfrac>"
        case Power():
            return _raised(node.base, f"<mn>{node.exponent}</mn>" if node.exponent > 0 else
                           _row(f"{_operator(MINUS)}<mn>{-node.exponent}</mn>"))
        case Transpose():
            return _raised(node.of, '<mi mathvariant="normal" class="t">T</mi>')
        case Root():
            return f"<msqrt>{_of(node.of)}</msqrt>"
        case Size():
            return _row("".join([_operator("|", ' form="prefix"'), _of(node.of), _operator("|", ' form="postfix"')]))
        case Skew():
            return _skew(node)
        case Call():
            return f'<mi class="fn">{node.name}</mi>{_operator(APPLY)}{_brackets(_of(node.of))}'
        case _:
            return _large(node)


def _skew(node: Skew) -> str:
    """Return a tilde above; a subscript stays outside of it."""
    of = node.of
    if isinstance(of, Name) and of.sub and not (of.primes or of.above):
        letter = _name(Name(of.base, of.bold, of.accent))
        sub = _row(_operator(",").join(_subscript(s) for s in of.sub))
        return f'<msub><mover accent="true">{_row(letter)}{_operator("~")}</mover>{sub}</msub>'
    return f'<mover accent="true">{_row(_of(of))}{_operator("~")}</mover>'


def _large(node: Node) -> str:
    match node:
        case Matrix():
            rows = "".join(f"<mtr>{''.join(f'<mtd>{_of(entry)}</mtd>' for entry in row)}</mtr>" for row in node.rows)
            large = ' displaystyle="true"' if any(isinstance(e, Derivative) for row in node.rows for e in row) else ""
            return _row(f"{_operator('[')}<mtable{large}>{rows}</mtable>{_operator(']')}")
        case Cases():
            where = f"{_of(node.left)}{_operator('<')}{_of(node.right)}"
            return (f'<mrow class="cases">{_operator("{")}<mtable><mtr><mtd>{_of(node.below)}</mtd><mtd>{where}</mtd>'
                    f"</mtr><mtr><mtd>{_of(node.other)}</mtd><mtd><mtext>else</mtext></mtd></mtr></mtable></mrow>")
        case Derivative():
            return _derivative(node)
        case At():
            at = _operator(",").join(f"{_name(name)}{_operator('→')}{_of(value)}" for name, value in node.changes)
            return f'<msub class="at"><mrow>{_of(node.of)}{_operator("|")}</mrow>{_row(at)}</msub>'
        case Series():
            first = _row(f"<mi>{node.index}</mi>{_operator('=')}{_of(node.first)}")
            return (f"<munderover>{_operator('∑')}{first}{_row(_of(node.last))}</munderover>"
                    f"{_factor(node.of, last=True)}")
        case Integral():
            sign = _operator("∫")
            sign = (f"<msubsup>{sign}<mn>0</mn><mi>l</mi></msubsup>" if node.over == "l" else
                    f"<msub>{sign}<mi>{node.over}</mi></msub>")
            last = "x" if node.over == "l" else node.over
            return f'{sign}{_factor(node.of)}<mspace width="0.17em"/>{_d()}<mi>{last}</mi>'
    raise TypeError(f"no MathML of {node!r}")


def _d(partial: bool = False) -> str:
    return "<mi>∂</mi>" if partial else '<mi mathvariant="normal">d</mi>'


def _derivative(node: Derivative) -> str:
    d, by = _d(node.partial), _name(node.by)
    of = _of(node.of) if isinstance(node.of, Name) else _brackets(_of(node.of))
    if node.order > 1:
        order = f"<mn>{node.order}</mn>"
        return f"<mfrac>{_row(f'<msup>{d}{order}</msup>{of}')}{_row(f'{d}<msup>{by}{order}</msup>')}</mfrac>"
    return f"<mfrac>{_row(d + of)}{_row(d + by)}</mfrac>"


def _bold(text: str) -> str:
    """Return the bold form of a letter that mathematical fonts have; of a word, the word."""
    if len(text) == 1 and text.isascii() and text.isalpha():
        return chr((0x1D400 if text.isupper() else 0x1D41A - 32) + ord(text) - ord("A"))
    if text in _GREEK_BOLD:
        return _GREEK_BOLD[text]
    return text


_GREEK_BOLD = {letter: chr(0x1D6A8 + ord(letter) - ord("Α")) for letter in "ΓΔΘΛΞΠΣΦΨΩ"}
_GREEK_BOLD |= {letter: chr(0x1D6C2 + ord(letter) - ord("α")) for letter in "αβγδεζηθκλμνξπρστφχψω"}
_GREEK_BOLD["ϕ"] = chr(0x1D6DF)
_PLAIN = {_bold(letter): letter for letter in (*"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz",
                                               *LETTERS.values())}


def _letter(base: str, bold: bool) -> str:
    text = LETTERS.get(base, base)
    if bold and _bold(text) != text:
        return f"<mi>{_bold(text)}</mi>"
    if bold:
        return f'<mi mathvariant="normal" class="b">{text}</mi>'
    return f"<mi>{text}</mi>"


def _name(node: Name) -> str:
    text = _letter(node.base, node.bold)
    if node.accent:
        text = f'<mover accent="true">{text}{_operator(ACCENTS[node.accent])}</mover>'
    sub = _row(_operator(",").join(_subscript(s) for s in node.sub)) if node.sub else ""
    sup = "".join([_operator("′")] * node.primes + [{"*": _operator("∗"), "0": "<mn>0</mn>"}[c] for c in node.above])
    if sub and sup:
        return f"<msubsup>{text}{sub}{_row(sup)}</msubsup>"
    if sub or sup:
        tag = "msub" if sub else "msup"
        return f"<{tag}>{text}{sub or _row(sup)}</{tag}>"
    return text


def _subscript(text: str) -> str:
    if text.isdigit():
        return f"<mn>{text}</mn>"
    if len(text) == 1 or text in GREEK:
        return f"<mi>{LETTERS.get(text, text)}</mi>"
    return f'<mi class="sub">{text}</mi>'


def _raised(base: Node, exponent: str) -> str:
    """Return base and exponent; a subscript of the base stands below the exponent."""
    if isinstance(base, Name) and not (base.primes or base.above):
        if not base.sub:
            return f"<msup>{_name(base)}{exponent}</msup>"
        plain = Name(base.base, base.bold, base.accent)
        sub = _row(_operator(",").join(_subscript(s) for s in base.sub))
        return f"<msubsup>{_name(plain)}{sub}{exponent}</msubsup>"
    simple = isinstance(base, (Matrix, Size, Skew)) or (isinstance(base, Number) and not base.text.startswith("-"))
    return f"<msup>{_of(base) if simple else _brackets(_of(base))}{exponent}</msup>"


def _sum(node: Sum) -> str:
    return _terms(node.terms)


def _terms(terms: Sequence[tuple[int, Node]], begins: bool = True) -> str:
    text = ""
    for k, (sign, term) in enumerate(terms):
        inner = _brackets(_of(term)) if isinstance(term, Sum) else _of(term)
        first = begins and k == 0
        attributes = ' form="prefix"' if first else ' form="infix"'
        operator = _operator(MINUS if sign < 0 else "+", attributes) if not first or sign < 0 else ""
        text += operator + inner
    return text


def _factor(node: Node, first: bool = False, last: bool = False) -> str:
    if isinstance(node, (Sum, Binary)) or (isinstance(node, (Series, Integral)) and not last):
        return _brackets(_of(node))
    return _brackets(_of(node)) if isinstance(node, Number) and not first else _of(node)


def _side(node: Node) -> str:
    return _brackets(_of(node)) if isinstance(node, (Sum, Binary, Series, Integral)) else _of(node)


# --- and back ---------------------------------------------------------------------------------------------------

_FROM = {v: f"\\{k}" for k, v in LETTERS.items()} | {"∂": r"\partial"}
_OPERATORS = ({v: f" \\{k} " for k, v in SIGNS.items()}
              | {TIMES: " ", APPLY: "", MINUS: " - ", "=": " = ", "+": " + ", "<": " < ", "→": r" \to ",
                 "∑": r"\sum", "∫": r"\int", "′": r"\prime ", "∗": r"\ast ", ",": ","})
_ARRANGED = {"mfrac": r"\frac{{{0}}}{{{1}}}", "msub": "{0}_{{{1}}}", "msup": "{0}^{{{1}}}",
             "msubsup": "{0}_{{{1}}}^{{{2}}}", "munderover": "{0}_{{{1}}}^{{{2}}}"}
"""The LaTeX of elements whose children have one place each, by tag."""
_ACCENT = {v: k for k, v in ACCENTS.items()} | {"~": "widetilde"}


def to_latex(text: str) -> str:
    """Return the LaTeX of what a <math> element shows. Raises ValueError for an element that is not of `mathml`."""
    return _back(ElementTree.fromstring(text))


def _children(element: ElementTree.Element) -> str:
    return "".join(_back(child) for child in element)


def _back(element: ElementTree.Element) -> str:
    parts, text = list(element), element.text or ""
    match element.tag:
        case "math":
            return _children(element)
        case "mtable":  # a long sum: its lines
            return "".join(_children(cell) for row in element for cell in row)
        case "mrow":
            return _back_row(element)
        case "mn":
            return text
        case "mi":
            return _back_letter(element, text)
        case "mo":
            return _back_operator(text)
        case "msqrt":
            return f"\\sqrt{{{_children(element)}}}"
        case "mspace":
            return r" \, "
        case "mover":
            return f"\\{_ACCENT[parts[1].text or '']}{{{_back(parts[0])}}}"
        case "msub" if element.get("class") == "at":
            inner = "".join(_back(child) for child in list(parts[0])[:-1])
            return f"\\left. {inner} \\right|_{{{_back(parts[1])}}}"
        case tag if tag in _ARRANGED:
            return _ARRANGED[tag].format(*map(_back, parts))
    raise ValueError(f"no formula of this document has <{element.tag}>")


def _back_operator(text: str) -> str:
    if text not in _OPERATORS:
        raise ValueError(f"no formula of this document has the sign {text}")
    return _OPERATORS[text]


def _back_letter(element: ElementTree.Element, text: str) -> str:
    if text in _PLAIN:
        letter = _PLAIN[text]
        return f"\\boldsymbol{{{_FROM[letter]}}}" if letter in _FROM else f"\\mathbf{{{letter}}}"
    match element.get("class"):
        case "b":
            return f"\\boldsymbol{{{_FROM[text]}}}" if text in _FROM else f"\\mathbf{{{text}}}"
        case "t":
            return TRANSPOSE
        case "fn":
            return f"\\operatorname{{{text}}}"
        case "sub":
            return text
    if element.get("mathvariant"):
        return f"\\mathrm{{{text}}}"
    return f"{_FROM[text]} " if text in _FROM else text if len(text) == 1 else f"\\mathrm{{{text}}}"


def _back_row(element: ElementTree.Element) -> str:
    parts = list(element)
    opening = parts[0].text if parts and parts[0].tag == "mo" else ""
    if element.get("class") == "cases":
        return _back_cases(parts[1])
    if opening == "[":
        rows = r" \\ ".join(" & ".join(_children(cell) for cell in row) for row in parts[1])
        return f"\\begin{{bmatrix}} {rows} \\end{{bmatrix}}"
    inner = "".join(_back(child) for child in parts[1:-1])
    if opening == "(":
        return bracket(inner)
    if opening == "|":
        return f"\\lvert {inner} \\rvert "
    return _children(element)


def _back_cases(table: ElementTree.Element) -> str:
    (below, where), (other, _) = (list(row) for row in table)
    return (f"\\begin{{cases}} {_children(below)} & {_children(where)} \\\\ {_children(other)} & "
            r"\text{else} \end{cases}")
