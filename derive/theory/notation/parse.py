"""From the LaTeX of a formula back to its tree: a small recursive descent over what `latex` prints."""

from __future__ import annotations

import re

from .latex import FUNCTIONS, GREEK
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

TOKEN = re.compile(r"\\[a-zA-Z]+|\\\\|\\[,;!|]|\d+(?:\.\d+)?(?:e[+-]?\d+)?|[a-zA-Z]|[^\s]")
ACCENTS = ("dot", "ddot", "hat", "bar", "check")
SIGNS = ("cdot", "times", "otimes")
ENDS = {")", "]", "}", "=", "&", "\\\\", "\\end", "\\right", "\\rvert", "+", "-", "<", ",", "\\,", "\\to",
        *(f"\\{s}" for s in SIGNS)}


class FormulaError(ValueError):
    """Text that is no formula of this document."""


def parse(text: str) -> Node:
    """Return the tree of a formula; equations have sides.

    Raises FormulaError with the place for what the grammar does not have.
    """
    parser = _Parser(text)
    sides = [parser.sum()]
    while parser.skip("="):
        sides.append(parser.sum())
    parser.end()
    return Equation(tuple(sides)) if len(sides) > 1 else sides[0]


class _Parser:
    """Tokens of a formula, and the place in them."""

    def __init__(self, text: str):
        self.text = text
        plain = re.sub(r"\\(begin|end)\{aligned\}|\\wrap\b|\\;", " ", text)  # of long sums, see latex.display
        self.tokens = TOKEN.findall(re.sub(r"\\is\b", "=", plain))
        self.at = 0

    def peek(self, ahead: int = 0) -> str:
        return self.tokens[self.at + ahead] if self.at + ahead < len(self.tokens) else ""

    def take(self) -> str:
        token = self.peek()
        self.at += 1
        return token

    def skip(self, token: str) -> bool:
        if self.peek() == token:
            self.at += 1
            return True
        return False

    def expect(self, *tokens: str) -> None:
        for token in tokens:
            if not self.skip(token):
                raise FormulaError(f"{' '.join(self.tokens[max(self.at - 8, 0):self.at])} <- here should be {token}, "
                                   f"there is {self.peek() or 'the end'}, in {self.text}")

    def end(self) -> None:
        if self.at < len(self.tokens):
            raise FormulaError(f"what is {' '.join(self.tokens[self.at:self.at + 6])}, in {self.text}?")

    def braced(self) -> Node:
        self.expect("{")
        node = self.sum()
        self.expect("}")
        return node

    # --- sums and products ----------------------------------------------------------------------------------

    def sum(self) -> Node:
        terms = [(self._sign(), self.term())]
        while self.peek() in ("+", "-"):
            terms.append((self._sign(), self.term()))
        return terms[0][1] if len(terms) == 1 and terms[0][0] > 0 else Sum(tuple(terms))

    def _sign(self) -> int:
        if self.skip("-"):
            return -1
        self.skip("+")
        return 1

    def term(self) -> Node:
        left = self.product()
        while self.peek()[1:] in SIGNS:
            sign = self.take()[1:]
            left = Binary(sign, left, self.product())
        return left

    def product(self) -> Node:
        factors = [self.factor()]
        while self.peek() and self.peek() not in ENDS:
            factors.append(self.factor())
        return factors[0] if len(factors) == 1 else Product(tuple(factors))

    def factor(self) -> Node:
        node = self.atom()
        while self.skip("^"):
            self.expect("{")
            if self.skip("\\mathsf"):
                self.expect("{", "T", "}")
                node = Transpose(node)
            else:
                sign = -1 if self.skip("-") else 1
                node = Power(node, sign * int(self.take()))
            self.expect("}")
        return node

    # --- atoms --------------------------------------------------------------------------------------------------

    def atom(self) -> Node:
        token = self.peek()
        if token[:1].isdigit():
            return Number(self.take())
        of = {"\\frac": self._fraction, "\\sqrt": self._root, "\\lvert": self._size, "\\left": self._left,
              "\\begin": self._begin, "\\sum": self._series, "\\int": self._integral, "\\operatorname": self._call,
              "\\widetilde": self._skew, "(": self._round}.get(token)
        if of is None:
            return self.name()
        self.take()
        return of()

    def _round(self) -> Node:
        node = self.sum()
        self.expect(")")
        return node

    def _root(self) -> Node:
        return Root(self.braced())

    def _skew(self) -> Node:
        node = self.braced()
        if isinstance(node, Name) and not node.sub and self.skip("_"):
            node = Name(node.base, node.bold, node.accent, self._subscripts())
        return Skew(node)

    def _size(self) -> Node:
        node = self.sum()
        self.expect("\\rvert")
        return Size(node)

    def _left(self) -> Node:
        if self.skip("("):
            node = self.sum()
            self.expect("\\right", ")")
            return node
        self.expect(".")
        node = self.sum()
        self.expect("\\right", "|", "_", "{")
        changes = [self._change()]
        while self.skip(","):
            changes.append(self._change())
        self.expect("}")
        return At(node, tuple(changes))

    def _change(self) -> tuple[Name, Node]:
        name = self.name()
        self.expect("\\to")
        return name, self.sum()

    def _call(self) -> Node:
        self.expect("{")
        name = ""
        while not self.skip("}"):
            name += self.take()
        if name not in FUNCTIONS:
            raise FormulaError(f"no function {name}, in {self.text}")
        self.expect("\\left", "(")
        node = self.sum()
        self.expect("\\right", ")")
        return Call(name, node)

    def _begin(self) -> Node:
        self.expect("{")
        kind = ""
        while not self.skip("}"):
            kind += self.take()
        node = self._cases() if kind == "cases" else self._matrix()
        self.expect("\\end", "{", *kind, "}")
        return node

    def _matrix(self) -> Node:
        rows: list[list[Node]] = [[self.sum()]]
        while self.peek() in ("&", "\\\\"):
            if self.take() == "&":
                rows[-1].append(self.sum())
            else:
                rows.append([self.sum()])
        return Matrix(tuple(map(tuple, rows)))

    def _cases(self) -> Node:
        below = self.sum()
        self.expect("&")
        left = self.sum()
        self.expect("<")
        right = self.sum()
        self.expect("\\\\")
        other = self.sum()
        self.expect("&", "\\text", "{", *"else", "}")
        return Cases(below, left, right, other)

    def _series(self) -> Node:
        self.expect("_", "{")
        index = self.take()
        self.expect("=")
        first = self.sum()
        self.expect("}", "^")
        return Series(index, first, self.braced(), self.product())

    def _integral(self) -> Node:
        self.expect("_", "{")
        over = self.take()
        self.expect("}")
        if over == "0":
            self.expect("^", "{", "l", "}")
            over = "l"
        node = self.product()
        self.expect("\\,", "\\mathrm", "{", "d", "}", "x" if over == "l" else over)
        return Integral(node, over)

    def _fraction(self) -> Node:
        partial = self.peek(1) == "\\partial"
        if not partial and self.tokens[self.at + 1:self.at + 5] != ["\\mathrm", "{", "d", "}"]:
            return Fraction(self.braced(), self.braced())
        d = ["\\partial"] if partial else ["\\mathrm", "{", "d", "}"]
        self.expect("{", *d)
        order = self._order()
        of = self._round_or_name()
        self.expect("}", "{", *d)
        by = self.name()
        self._order()
        self.expect("}")
        return Derivative(of, by, order, partial)

    def _order(self) -> int:
        if not self.skip("^"):
            return 1
        self.expect("{")
        order = int(self.take())
        self.expect("}")
        return order

    def _round_or_name(self) -> Node:
        return self.atom() if self.peek() in ("\\left", "(") else self.name()

    # --- quantities ---------------------------------------------------------------------------------------------

    def name(self) -> Name:
        base, bold, accent = self._accented()
        sub: tuple[str, ...] = ()
        primes, above = 0, ""
        if self.skip("_"):
            sub = self._subscripts()
        while self.peek() == "^" and self.peek(2) in ("\\prime", "\\ast", "0"):
            self.expect("^", "{")
            while not self.skip("}"):
                mark = self.take()
                primes += mark == "\\prime"
                above += {"\\ast": "*", "0": "0"}.get(mark, "")
        return Name(base, bold, accent, sub, primes, above)

    def _accented(self) -> tuple[str, bool, str]:
        if self.peek()[1:] in ACCENTS and self.peek().startswith("\\"):
            accent = self.take()[1:]
            self.expect("{")
            base, bold, _ = self._accented()
            self.expect("}")
            return base, bold, accent
        if self.peek() in ("\\mathbf", "\\boldsymbol", "\\mathrm"):
            bold = self.take() != "\\mathrm"
            return self._word(), bold, ""
        return self._letter(self.take()), False, ""

    def _word(self) -> str:
        self.expect("{")
        word = ""
        while not self.skip("}"):
            token = self.take()
            word += self._letter(token) if token.startswith("\\") else token
        return word

    def _letter(self, token: str) -> str:
        if token.startswith("\\") and token[1:] in GREEK:
            return token[1:]
        if len(token) == 1 and token.isalpha():
            return token
        raise FormulaError(f"{token or 'the end'} is no quantity, in {self.text}")

    def _subscripts(self) -> tuple[str, ...]:
        self.expect("{")
        found = [""]
        while not self.skip("}"):
            token = self.take()
            if token == ",":
                found.append("")
            elif token == "\\mathrm":
                found[-1] += self._word()
            else:
                found[-1] += token.removeprefix("\\")
        return tuple(found)
