"""The tree of a formula: what both printers print, what the parser returns, and what is evaluated."""

from __future__ import annotations

from dataclasses import dataclass


class Node:
    """Any part of a formula."""


@dataclass(frozen=True)
class Number(Node):
    """A decimal number, as it is printed."""

    text: str


@dataclass(frozen=True)
class Name(Node):
    """A quantity: letter or word, upright bold for vectors and matrices, accent, subscripts, primes, a mark above.

    Subscripts that are the index of a sum, or of a family of equations, stand for its value. The mark `above` is one
    of * and 0: a superscript that is no power.
    """

    base: str
    bold: bool = False
    accent: str = ""
    sub: tuple[str, ...] = ()
    primes: int = 0
    above: str = ""

    @property
    def key(self) -> str:
        """Return what identifies the quantity: a bold letter is another one than a plain one."""
        mark, primes = "!" if self.bold else "", "'" * self.primes
        return f"{mark}{self.accent}{self.base}{primes}{self.above}" + (f"_{','.join(self.sub)}" if self.sub else "")


@dataclass(frozen=True)
class Sum(Node):
    """Terms, each with its sign."""

    terms: tuple[tuple[int, Node], ...]


@dataclass(frozen=True)
class Product(Node):
    """Factors side by side: of numbers, of matrices, of both."""

    factors: tuple[Node, ...]


@dataclass(frozen=True)
class Binary(Node):
    """One of the products with a sign of their own: "cdot" (scalar), "times" (vector), "otimes" (Kronecker)."""

    sign: str
    left: Node
    right: Node


@dataclass(frozen=True)
class Fraction(Node):
    """A quotient of numbers, or a matrix over a number."""

    above: Node
    below: Node


@dataclass(frozen=True)
class Power(Node):
    """A whole power of a number; -1 of a matrix is its inverse."""

    base: Node
    exponent: int


@dataclass(frozen=True)
class Transpose(Node):
    """The transpose of a matrix."""

    of: Node


@dataclass(frozen=True)
class Root(Node):
    """A square root."""

    of: Node


@dataclass(frozen=True)
class Size(Node):
    """The length of a vector or the size of a number."""

    of: Node


@dataclass(frozen=True)
class Skew(Node):
    """v~, the matrix with v~ u = v x u."""

    of: Node


@dataclass(frozen=True)
class Call(Node):
    """A function: sin, cos, axial, tr."""

    name: str
    of: Node


@dataclass(frozen=True)
class Matrix(Node):
    """Rows of blocks."""

    rows: tuple[tuple[Node, ...], ...]


@dataclass(frozen=True)
class Cases(Node):
    """`below` where left < right, else `other`."""

    below: Node
    left: Node
    right: Node
    other: Node


@dataclass(frozen=True)
class Derivative(Node):
    """A derivative of the first or second order by a quantity; partial and total ones are written differently."""

    of: Node
    by: Name
    order: int = 1
    partial: bool = True


@dataclass(frozen=True)
class At(Node):
    """A value where quantities are replaced by others."""

    of: Node
    changes: tuple[tuple[Name, Node], ...]


@dataclass(frozen=True)
class Series(Node):
    """A sum over an index."""

    index: str
    first: Node
    last: Node
    of: Node


@dataclass(frozen=True)
class Integral(Node):
    """An integral over the volume ("V"), the length ("l") or the section ("A") of an element."""

    of: Node
    over: str


@dataclass(frozen=True)
class Equation(Node):
    """Sides that are equal."""

    sides: tuple[Node, ...]
