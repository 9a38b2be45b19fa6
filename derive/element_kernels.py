"""The kernels of an element (eq 3-9): mass, elastic constants, energy, forces, tangents."""

from __future__ import annotations

import numpy as np
import sympy as sp
from funicular.derive import moments
from funicular.derive.gram import Gram
from funicular.derive.gram_tangent import tangent
from funicular.derive.spec import Element, l, x, y, z
from funicular.derive.stages import Program


def _ring(expr: sp.Expr):
    """A polynomial in x, y, z, 1/l of the spec, in the ring of `moments`."""
    w = sp.Symbol("w", positive=True)
    poly = sp.Poly(sp.expand(expr.subs(l, 1 / w)), x, y, z, w, 1 / w)
    xi = moments.L * (1 + moments.X) / 2
    return sum((moments.RING(c) * xi**a * moments.Y**b * moments.Z**d * moments.W**n * moments.L**m
                for (a, b, d, n, m), c in poly.terms()), moments.RING(0))


def _integral(p, length, section) -> sp.Expr:
    """Integral of a ring polynomial over the element, in kernel symbols."""
    return sum((sp.Rational(int(c.numerator), int(c.denominator)) * length**power * section[m]
                for (m, power), c in sorted(moments.over_element(p).items())), sp.S.Zero)


def build(element: Element) -> list[Program]:
    """Every kernel of an element."""
    gram = Gram(element)
    shape = [_ring(n) for n in element.shape_functions]
    return [mass(element, shape), gravity(element, shape), inertia_force(element, shape), stiffness(element, gram),
            energy(element, gram), elastic_force(element, gram), elastic_tangent(element, gram),
            damping_force(element, gram), damping_tangent(element, gram), dissipation(element, gram),
            position(element)]


def _program(element: Element, kernel: str, doc: str, source: str) -> Program:
    return Program(f"{element.name}_{kernel}", doc, source)


def _length(program: Program) -> sp.Symbol:
    return program.input("l", (), "m", "length of the element")


def _section(program: Program) -> np.ndarray:
    return program.input("section", len(moments.SECTION), moments.SECTION_UNITS, moments.SECTION_DOC)


def _coordinates(program: Program, element: Element, name="e", unit="m, 1", doc="nodal vectors (eq 1)"):
    return program.input(name, (element.n_vectors, element.dim), unit, doc)


def _constants(program: Program, gram: Gram) -> np.ndarray:
    return program.input("A", len(gram.constants), "N m", f"elastic constants from {gram.element.name}_stiffness")


def mass(element: Element, shape) -> Program:
    """eq 4: M = m (x) I."""
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


def gravity(element: Element, shape) -> Program:
    """Generalised force of a constant gravity field."""
    p = _program(element, "gravity", "generalised force of constant gravity", "Q_e of eq 9")
    length, density, section = _length(p), p.input("density", (), "kg/m^3", "density"), _section(p)
    g = p.input("g", element.dim, "m/s^2", "gravity")
    p.stage("integrals of N_k")
    weight = [p.define(f"w_{name}", density * _integral(n, length, section))
              for name, n in zip(element.names, shape, strict=True)]
    p.output("Q", np.outer(weight, g), "N, N m", "generalised force on the nodal vectors")
    return p


def inertia_force(element: Element, shape) -> Program:
    """M a with M = m (x) I, zeros of m left out."""
    p = _program(element, "inertia_force", "M a", "M e'' of eq 9")
    n = element.n_vectors
    m = p.input("m", (n, n), "kg, kg m, kg m^2", f"mass matrix from {element.name}_mass")
    a = _coordinates(p, element, "a", "m/s^2, 1/s^2", "accelerations of the nodal vectors")
    filled = [[bool(moments.over_element(shape[j] * shape[k])) for k in range(n)] for j in range(n)]
    p.output("f", [sum(m[j, k] * a[k] for k in range(n) if filled[j][k]) for j in range(n)], "N, N m", "M a")
    return p


def stiffness(element: Element, gram: Gram) -> Program:
    """The constant form A of gram.py, for any section and any orthotropic law."""
    p = _program(element, "stiffness", "elastic constants A of U = 1/2 (G - G0)' A (G - G0)", "eq 5-7; gram.py")
    length, section = _length(p), _section(p)
    normal = "D11 D22 D33 D12 D13 D23" if element.dim == 3 else "D11 D22 D12"
    shear = "G12 G13 G23" if element.dim == 3 else "G12"
    D = p.input("D", len(set(gram.elasticity.values())), "Pa", f"orthotropic law, axes x, y, z: {normal} {shear}")
    A = [sum(sp.Rational(int(c.numerator), int(c.denominator)) * D[k] * section[m] * length**power
             for (k, m, power), c in entry) for entry in gram.constants]
    p.stage("integrals of strain products")
    p.output("A", [p.define(f"A_{i}", a) for i, a in enumerate(A)], "N m", "different non-zero entries of A")
    return p


def _strain(p: Program, element: Element, gram: Gram):
    """Inputs l, e, A and the stages up to G - G0."""
    length, e, A = _length(p), _coordinates(p, element), _constants(p, gram)
    p.stage("strain vectors")
    w = p.define("w", 1 / length)
    c = gram.differences(p, e, w)
    p.stage("Gram products G - G0")
    return w, A, c, gram.gram(p, c)


def _stress(p: Program, gram: Gram, A, G):
    p.stage("u = A (G - G0)")
    return gram.stress(p, A, G)


def energy(element: Element, gram: Gram) -> Program:
    """eq 7."""
    p = _program(element, "energy", "elastic energy", "eq 7")
    _, A, _, G = _strain(p, element, gram)
    u = _stress(p, gram, A, G)
    p.output("U", [sum(a * b for a, b in zip(u, G, strict=True)) / 2], "J", "elastic energy")
    return p


def _forces(p: Program, gram: Gram, c, u, w) -> np.ndarray:
    p.stage("forces on strain vectors")
    f = gram.vector_forces(p, c, u)
    p.stage("forces on nodal vectors")
    return gram.nodal_forces(p, f, w)


def elastic_force(element: Element, gram: Gram) -> Program:
    """eq 8, as dU/de = -Q_k."""
    p = _program(element, "elastic_force", "dU/de, minus the elastic force Q_k", "eq 8")
    w, A, c, G = _strain(p, element, gram)
    p.output("f", _forces(p, gram, c, _stress(p, gram, A, G), w), "N, N m", "dU/de")
    return p


def elastic_tangent(element: Element, gram: Gram) -> Program:
    """Second derivative of the energy."""
    p = _program(element, "elastic_tangent", "d2U/de2", "derivative of eq 8")
    w, A, c, G = _strain(p, element, gram)
    u = _stress(p, gram, A, G)
    p.output("K", tangent(gram, p, c, c, A, u, w), "N/m, N, N m", "d2U/de2, symmetric")
    return p


def _damping(p: Program, element: Element, gram: Gram):
    """Inputs l, e, v, A, tau and the stages up to dG/dt."""
    length, e = _length(p), _coordinates(p, element)
    v = _coordinates(p, element, "v", "m/s, 1/s", "rates of the nodal vectors")
    A, tau = _constants(p, gram), p.input("tau", (), "s", "retardation time of the Kelvin-Voigt law")
    p.stage("strain vectors and their rates")
    w = p.define("w", 1 / length)
    c, rate = gram.differences(p, e, w), gram.differences(p, v, w, "d")
    p.stage("rates of the Gram products")
    return w, A, tau, c, rate, gram.gram_rate(p, c, rate)


def damping_force(element: Element, gram: Gram) -> Program:
    """Kelvin-Voigt: stress follows G - G0 + tau dG/dt; this is the tau part."""
    p = _program(element, "damping_force", "minus the Kelvin-Voigt damping force Q_d", "Q_d of eq 9")
    w, A, tau, c, _, dG = _damping(p, element, gram)
    p.stage("u = tau A dG/dt")
    u = gram.stress(p, A, dG, tau)
    p.output("f", _forces(p, gram, c, u, w), "N, N m", "-Q_d")
    return p


def damping_tangent(element: Element, gram: Gram) -> Program:
    """df/de + rate df/dv of the damping force f."""
    p = _program(element, "damping_tangent", "df/de + rate df/dv of the damping force f = -Q_d",
                 "derivative of Q_d of eq 9")
    w, A, tau, c, dc, dG = _damping(p, element, gram)
    rate = p.input("rate", (), "1/s", "dv/de of the integrator")
    p.stage("u = tau A dG/dt")
    u = gram.stress(p, A, dG, tau)
    p.stage("b = tau (dc/dt + rate c)")
    b = np.array([p.vector(f"b_{name}", tau * (dc[m] + rate * c[m])) for m, name in enumerate(gram.names)])
    p.output("K", tangent(gram, p, c, b, A, u, w), "N/m, N, N m", "df/de + rate df/dv")
    return p


def dissipation(element: Element, gram: Gram) -> Program:
    """Power that the damping force takes out."""
    p = _program(element, "dissipation", "power dissipated by the damping force", "v . Q_d of eq 9")
    _, A, tau, _, _, dG = _damping(p, element, gram)
    p.stage("u = tau A dG/dt")
    u = gram.stress(p, A, dG, tau)
    p.output("P", [sum(a * b for a, b in zip(u, dG, strict=True))], "W", "dissipated power, never negative")
    return p


def position(element: Element) -> Program:
    """eq 2."""
    p = _program(element, "position", "shape functions and position of a point", "eq 2")
    length = _length(p)
    at = p.input("at", 3, "m", "local coordinates x, y, z")
    e = _coordinates(p, element)
    p.stage("shape functions")
    N = [p.define(f"N_{name}", n.subs({x: at[0], y: at[1], z: at[2], l: length}))
         for name, n in zip(element.names, element.shape_functions, strict=True)]
    p.output("N", N, "1, m", "shape functions")
    p.output("r", sum(N[k] * e[k] for k in range(len(N))), "m", "position")
    return p
