"""Specs: of an element its basis and nodal conditions, of a law its traits, of a force between two points its energy.

The shape functions are solved from the nodal conditions (eq 1-2), never typed in.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np
import sympy as sp

x, y, z, l = sp.symbols("x y z l", positive=True)
COORDINATES = {"x": x, "y": y, "z": z}
CABLE_LAWS = ("green_exact", "green_linear", "engineering_exact", "engineering_linear")
ASSUMED_LAWS = tuple(f"{law}_assumed" for law in CABLE_LAWS)
TENSION_ONLY_LAWS = ("engineering_exact_tension_only",)
TABULATED_LAWS = ("engineering_exact_tabulated",)
MAX_SEGMENTS = 24
"""Of a tabulated axial force."""


@dataclass(frozen=True)
class LawTraits:
    """Traits of a law, for the manifest and for scenes.

    kind               "cable" (of the axis alone), "continuum" or "structural" (of the whole section)
    strain, curvature  the measures of a cable: "green" or "engineering", "exact" or "linear"
    membrane           how a cable represents its axial strain: "full", or "assumed", by its lowest Legendre
                       modes, or "tension_only": full, without resistance to compression, or "tabulated": full,
                       with a force by a table
    straight           where the law is for a curved stress-free shape: the law for a straight one; else empty
    takes_shape        whether its kernels take the stress-free shape e0
    damped_like        the law whose damping kernels it takes; empty where it has its own
    relaxed_like       the law whose algorithmic forces it takes; empty where that is damped_like
    """

    kind: str
    strain: str = ""
    curvature: str = ""
    membrane: str = ""
    straight: str = ""
    takes_shape: bool = False
    damped_like: str = ""
    relaxed_like: str = ""


@dataclass(frozen=True)
class Element:
    """r(x, y, z) = sum_k N_k d_k, eq 2: monomials, nodes, and which vectors the nodes carry.

    `director` names the nodal vector from which the tangent frame takes its normal, eq 16; empty where there is
    none. `laws` are its energies: names in laws/, or classes of the same interface.
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
        """Return the names of the nodal vectors over all nodes: r_1, r_x1, ... r_2, ..."""
        return tuple(f"{v}{'' if '_' in v else '_'}{i + 1}" for i in range(len(self.nodes))
                     for v in self.nodal_vectors)

    @property
    def is_position(self) -> list[bool]:
        """Return, for each nodal vector over all nodes, whether it is a position (and not a slope)."""
        return [v == "r" for _ in self.nodes for v in self.nodal_vectors]

    @cached_property
    def node_ratios(self) -> tuple[sp.Rational, ...]:
        """Return the places of the nodes in lengths l."""
        return tuple(sp.sympify(node) / l for node in self.nodes)

    @property
    def n_vectors(self) -> int:
        """Return the nodal vectors of the element, over all nodes."""
        return len(self.nodes) * len(self.nodal_vectors)

    @property
    def n_coordinates(self) -> int:
        """Return the length of the nodal coordinates e, the nodal vectors one after the other (eq 1)."""
        return self.dim * self.n_vectors

    def nodal_conditions(self, functions: Any) -> sp.Matrix:
        """Return the value of each nodal functional (row: r, r_x, ... at a node) on each function (column)."""
        rows = []
        for node in self.nodes:
            for vector in self.nodal_vectors:
                by = [COORDINATES[c] for c in vector.partition("_")[2]]
                rows.append([sp.diff(f, *by).subs({x: node, y: 0, z: 0}) if by
                             else f.subs({x: node, y: 0, z: 0}) for f in functions])
        return sp.Matrix(rows)

    @cached_property
    def shape_functions(self) -> tuple[sp.Expr, ...]:
        """Return N_k(x, y, z; l), from N_k(d_j) = delta_kj on the span of the basis.

        Raises ValueError where the nodal conditions do not fix the basis.
        """
        basis = [sp.sympify(b) for b in self.basis]
        conditions = self.nodal_conditions(basis)
        if conditions.shape[0] != conditions.shape[1] or conditions.det() == 0:
            raise ValueError(f"{self.name}: {conditions.shape[0]} nodal conditions do not fix "
                             f"{len(basis)} basis functions")
        return tuple((sp.Matrix([basis]) * conditions.inv()).applyfunc(sp.expand))


class Stages(Protocol):
    """The part of a kernel's program that names intermediate values of a spec."""

    def stage(self, title: str) -> None:
        """Open a stage of that title."""

    def define(self, name: str, expr: sp.Expr) -> sp.Expr:
        """Return the name of an expression. Roots and reciprocals need one: derivatives reuse their values."""


@dataclass(frozen=True)
class PointLaw:
    """The law of a force between two points, by the gap from the first to the second, in the plane and in space.

    doc, source  what it is, and where it is from
    parameters   unit and meaning by name; the part of the scene has a field of each name
    energy       energy(p, e, c): the stored energy U in J by the measures e, which makes the force dU/dgap on the first
                 point and its opposite on the second; c.<name> is a parameter, p: see `Stages`
    measures     measures(p, gap, c): arguments of the energy, such as a distance; the gap itself by default
    damping      the parameter c of a damper, whose power is c e'.e'; empty where there is none

    U and e.e must not change when the gap is rotated.
    """

    doc: str
    source: str
    parameters: dict[str, tuple[str, str]]
    energy: Callable[[Stages, np.ndarray, Any], sp.Expr]
    measures: Callable[[Stages, np.ndarray, Any], list[sp.Expr]] | None = None
    damping: str = ""

    def __post_init__(self) -> None:
        if self.damping and self.damping not in self.parameters:
            raise ValueError(f'{self.doc}: the damper\'s parameter "{self.damping}" is not among '
                             f"{', '.join(self.parameters)}")

    def measured(self, p: Stages, gap: np.ndarray, c: Any) -> np.ndarray:
        """Return the measures e, each a symbol."""
        if self.measures is None:
            return gap
        p.stage("measures of the gap")
        return np.array([p.define("e", value) for value in self.measures(p, gap, c)])
