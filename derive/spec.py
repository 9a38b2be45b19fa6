"""What a spec is: an element's basis and nodal conditions, and what follows from them.

The shape functions are solved from the nodal conditions (eq 1-2), never typed in.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import sympy as sp

from .codegen.program import Program

x, y, z, l = sp.symbols("x y z l", positive=True)
COORDINATES = {"x": x, "y": y, "z": z}
CABLE_LAWS = ("green_exact", "green_linear", "engineering_exact", "engineering_linear")
ASSUMED_LAWS = tuple(f"{law}_assumed" for law in CABLE_LAWS)


class FamilyError(ValueError):
    """Families of one role whose kernels do not fit one table."""


@dataclass(frozen=True)
class Element:
    """r(x, y, z) = sum_k N_k d_k (eq 2): monomials, nodes, and which vectors the nodes carry.

    `director` names the nodal vector from which the tangent frame takes its normal (eq 16); empty where there is
    none. `laws` are the energies that it comes with: names in laws/, or classes of the same interface.
    """

    name: str
    dim: int
    basis: tuple[sp.Expr, ...]
    nodal_vectors: tuple[str, ...]
    director: str
    laws: tuple[str | type, ...]
    doc: str
    source: str
    nodes: tuple[sp.Expr, ...] = (sp.S.Zero, l)

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the nodal vectors over all nodes: r_1, r_x1, ... r_2, ..."""
        return tuple(f"{v}{'' if '_' in v else '_'}{i + 1}" for i in range(len(self.nodes))
                     for v in self.nodal_vectors)

    @property
    def is_position(self) -> list[bool]:
        """For each nodal vector over all nodes, whether it is a position (and not a slope)."""
        return [v == "r" for _ in self.nodes for v in self.nodal_vectors]

    @cached_property
    def node_ratios(self) -> tuple[sp.Rational, ...]:
        """Places of the nodes in lengths l."""
        return tuple(sp.sympify(node) / l for node in self.nodes)

    @property
    def n_vectors(self) -> int:
        """Nodal vectors of the element, over all nodes."""
        return len(self.nodes) * len(self.nodal_vectors)

    @property
    def n_coordinates(self) -> int:
        """Length of e (eq 1)."""
        return self.dim * self.n_vectors

    def nodal_conditions(self, functions) -> sp.Matrix:
        """Value of each nodal functional (row: r, r_x, ... at a node) on each function (column)."""
        rows = []
        for node in self.nodes:
            for vector in self.nodal_vectors:
                by = [COORDINATES[c] for c in vector.partition("_")[2]]
                rows.append([sp.diff(f, *by).subs({x: node, y: 0, z: 0}) if by
                             else f.subs({x: node, y: 0, z: 0}) for f in functions])
        return sp.Matrix(rows)

    @cached_property
    def shape_functions(self) -> tuple[sp.Expr, ...]:
        """N_k(x, y, z; l), from N_k(d_j) = delta_kj on the span of the basis.

        Raises ValueError where the nodal conditions do not fix the basis.
        """
        basis = [sp.sympify(b) for b in self.basis]
        conditions = self.nodal_conditions(basis)
        if conditions.shape[0] != conditions.shape[1] or conditions.det() == 0:
            raise ValueError(f"{self.name}: {conditions.shape[0]} nodal conditions do not fix "
                             f"{len(basis)} basis functions")
        return tuple((sp.Matrix([basis]) * conditions.inv()).applyfunc(sp.expand))


@dataclass(frozen=True)
class Family:
    """The kernels of one generated file.

    `modules` are its specs: their text, and all that they import here, is in the spec hash. Families of one `role` have
    kernels of the same signatures, but for those in `own`; the engine reaches them through a table, each with its
    `facts` (integers).
    `element`, `law`, `rider` (the name of a body) and `dim` are what the kernels are about: verification samples their
    states.
    `lacks` names kernels of the role that this one cannot have: the table holds a null pointer there.
    `shared` names, by kernel, the family of the role whose kernel this one takes instead of one of its own.
    `like` is the law in laws/ whose section stiffness and scale the law shares: itself, but for a law of the user's.
    `spec` is the user's file that the element stands in, None for those of this package.
    """

    name: str
    doc: str
    build: Callable[[], list[Program]]
    modules: tuple[str, ...]
    role: str = ""
    facts: dict[str, int] = field(default_factory=dict)
    own: tuple[str, ...] = ()
    shared: dict[str, str] = field(default_factory=dict)
    lacks: tuple[str, ...] = ()
    element: Element | None = None
    law: str | None = None
    like: str | None = None
    rider: str | None = None
    dim: int | None = None
    spec: Path | None = None

    @property
    def elsewhere(self) -> set[str]:
        """Kernels of the role that are not among this family's own."""
        return {*self.shared, *self.lacks}

    def kernel(self, suffix: str) -> str:
        """Name of a kernel that the engine's table has, 0 where the family lacks it."""
        if suffix in self.lacks:
            return "0"
        return f"{self.shared.get(suffix, self.name)}_{suffix}"
