"""The kernels of an element without its law (eq 2-4): position, mass, gravity, loads."""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp
from sympy.polys.rings import PolyElement

from ..algebra import section_integrals as integrals
from ..codegen.program import Program
from ..spec import Element, l, x, y, z
from . import load_kernels


def _ring(expr: sp.Expr) -> PolyElement:
    """Return a polynomial in x, y, z, 1/l of the spec, in the ring of polynomials of `section_integrals`."""
    w = sp.Symbol("w", positive=True)
    poly = sp.Poly(sp.expand(expr.subs(l, 1 / w)), x, y, z, w, 1 / w)
    xi = integrals.L * (1 + integrals.X) / 2
    return sum((integrals.RING(c) * xi**a * integrals.Y**b * integrals.Z**d * integrals.W**n * integrals.L**m
                for (a, b, d, n, m), c in poly.terms()), integrals.RING(0))


def _integral(p: PolyElement, length: sp.Symbol, section: np.ndarray) -> sp.Expr:
    """Return the integral of a ring polynomial over the element, in the kernel's symbols."""
    return sum((sp.Rational(int(c.numerator), int(c.denominator)) * length**power * section[m]
                for (m, power), c in sorted(integrals.over_element(p).items())), sp.S.Zero)


def build(element: Element) -> list[Program]:
    """Return the programs of every kernel of an element without its law."""
    shape = [_ring(n) for n in element.shape_functions]
    return [mass(element, shape), gravity(element, shape), inertia_force(element, shape), position(element),
            *load_kernels.build(element)]


def _program(element: Element, kernel: str, doc: str, source: str) -> Program:
    return Program(f"{element.name}_{kernel}", doc, source)


def _length(program: Program) -> sp.Symbol:
    return program.input("l", (), "m", "length of the element")


def _section(program: Program) -> np.ndarray:
    return program.input("section", len(integrals.SECTION), integrals.SECTION_UNITS, integrals.SECTION_DOC)


def _coordinates(program: Program, element: Element, name: str = "e", unit: str = "m, 1",
                 doc: str = "nodal vectors e, eq 1") -> np.ndarray:
    return program.input(name, (element.n_vectors, element.dim), unit, doc)


def mass(element: Element, shape: Any) -> Program:
    """Return the kernel of m (vectors, vectors) in kg, kg m, kg m^2: the mass matrix is M = m (x) I (eq 4)."""
    p = _program(element, "mass", "mass matrix m of M = m (x) I", "eq 4")
    length, density, section = _length(p), p.input("density", (), "kg/m^3", "density"), _section(p)
    p.stage("integrals of N_j N_k")
    n = element.n_vectors
    m = np.zeros((n, n), dtype=object)
    for j in range(n):
        for k in range(j, n):
            m[j, k] = m[k, j] = p.define(f"m_{element.names[j]}_{element.names[k]}",
                                         density * _integral(shape[j] * shape[k], length, section))
    p.output("m", m, "kg, kg m, kg m^2", "mass matrix over nodal vectors, symmetric")
    return p


def gravity(element: Element, shape: Any) -> Program:
    """Return the kernel of the generalised force of constant gravity, (vectors, dim), N and N m."""
    p = _program(element, "gravity", "generalised force of constant gravity", "Q_e of eq 9")
    length, density, section = _length(p), p.input("density", (), "kg/m^3", "density"), _section(p)
    g = p.input("g", element.dim, "m/s^2", "gravity")
    p.stage("integrals of N_k")
    weight = [p.define(f"w_{name}", density * _integral(n, length, section))
              for name, n in zip(element.names, shape, strict=True)]
    p.output("Q", np.outer(weight, g), "N, N m", "generalised force on the nodal vectors")
    return p


def inertia_force(element: Element, shape: Any) -> Program:
    """Return the kernel of M a with M = m (x) I; it leaves out the zeros of m."""
    p = _program(element, "inertia_force", "M a", "M e'' of eq 9")
    n = element.n_vectors
    m = p.input("m", (n, n), "kg, kg m, kg m^2", "mass matrix of the kernel mass")
    a = _coordinates(p, element, "a", "m/s^2, 1/s^2", "accelerations of the nodal vectors")
    filled = [[bool(integrals.over_element(shape[j] * shape[k])) for k in range(n)] for j in range(n)]
    p.output("f", [sum(m[j, k] * a[k] for k in range(n) if filled[j][k]) for j in range(n)], "N, N m", "M a")
    return p


def _horner(n: sp.Expr, power: int, xi: sp.Symbol) -> sp.Expr:
    """Return a shape function as l^power times a polynomial in xi with integer coefficients: powers of l cancel."""
    return l**power * sp.horner(sp.expand(n.subs(x, xi * l) / l**power), xi)


def position(element: Element) -> Program:
    """Return the kernel of the shape functions N (vectors,) and of the position r = S e (eq 2), m."""
    p = _program(element, "position", "shape functions and position of a point", "eq 2")
    length = _length(p)
    at = p.input("at", 3, "m", "local coordinates x, y, z")
    e = _coordinates(p, element)
    p.stage("shape functions")
    xi = p.define("xi", at[0] / length)
    N = [p.define(f"N_{name}", _horner(n, name.count("x"), xi).subs({y: at[1], z: at[2], l: length}))
         for name, n in zip(element.names, element.shape_functions, strict=True)]
    p.output("N", N, "1, m", "shape functions")
    p.output("r", sum(N[k] * e[k] for k in range(len(N))), "m", "position")
    return p
