"""The kernels of a law on an element (eq 5-9): constants, energy, forces, tangents, Kelvin-Voigt damping.

Signatures are the same for every law; A holds its constants.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from ..algebra.discrete_gradient import STATES
from ..algebra.gram import DIRECTIONS, Gram
from ..algebra.gram_point import axis, expansion
from ..algebra.gram_tangent import nodal_tangent
from ..algebra.tangent_frame import spatial, tangent_frame, unit
from ..codegen.program import Program
from ..spec import Element
from . import LAWS, law_class, law_name, law_traits, stress_free

DAMPING = ("damping_force", "damping_tangent", "dissipation")
DISCRETE = ("discrete_force", "step_stiffness")
ALGORITHMIC = ("algorithmic_force",)
RETARDATION = ("tau", (), "s", "retardation time of the Kelvin-Voigt law")


def missing(law: str | type) -> tuple[str, ...]:
    """Return the kernels that a law lacks: a discrete gradient of its energy, a measure of strain for a step.
    """
    return tuple(kernel for kernels, method in ((DISCRETE, "discrete_forces"), (ALGORITHMIC, "algorithmic_forces"))
                 for kernel in kernels if not hasattr(_class(law), method))


def facts(element: Element, law: str | type) -> dict[str, int]:
    """Return the engine's facts of a law's rates of strain: their number, and whether a spin is one."""
    return {"rates": 0, "spins": 0} if missing(law) else _class(law).rates(element)


def _class(law: str | type) -> Any:
    found: Any = LAWS.get(law) if isinstance(law, str) else law
    return getattr(found, "func", found)


def taken(element: Element, law: str | type) -> dict[str, str]:
    """Return by kernel the law of the element whose kernel a law takes: damping from the law that it is damped like, a
    step's stiffness from the first cable whose strain is assumed, or is not, for that is all that it knows.
    """
    if not isinstance(law, str):  # a law of the user's has its own
        return {}
    traits = law_traits(law)
    found: dict[str, str] = {}
    for kernels, like in (DAMPING, traits.damped_like), (ALGORITHMIC, traits.relaxed_like or traits.damped_like):
        if like in element.laws:
            found |= dict.fromkeys(kernels, like)
    if traits.kind == "cable":
        alike = (other for other in element.laws if isinstance(other, str)
                 and law_traits(other).kind == "cable"
                 and (law_traits(other).membrane == "assumed") == (traits.membrane == "assumed"))
        first = next(alike)
        found |= {} if first == law else {"step_stiffness": first}
    return found


def build(element: Element, law: str | type) -> list[Program]:
    """Return every kernel of a law on an element, without those from another law."""
    left_out = {*missing(law), *taken(element, law)}
    more = [kernel for kernel in (*DISCRETE, *DAMPING, *ALGORITHMIC) if kernel not in left_out]
    kernels = Kernels(element, law)
    return [kernels.set_up(), kernels.energy(), kernels.elastic_force(), kernels.elastic_tangent(),
            *(getattr(kernels, kernel)() for kernel in more), kernels.section_forces()]


class Kernels:
    """An element's Gram products with a law over them."""

    def __init__(self, element: Element, law: str | type):
        self.element, self.gram = element, Gram(element)
        self.law, self.name = law_class(law)(self.gram), f"{element.name}_{law_name(law)}"
        self.traits = law_traits(law)

    def _program(self, kernel: str, doc: str, source: str) -> Program:
        return Program(f"{self.name}_{kernel}", doc, f"{source}; {self.law.source}")

    def _coordinates(self, program: Program, name: str = "e", unit: str = "m, 1",
                     doc: str = "nodal vectors e, eq 1") -> np.ndarray:
        return program.input(name, (self.element.n_vectors, self.element.dim), unit, doc)

    def _strain(self, program: Program) -> tuple[Any, ...]:
        """Declare the inputs l, e, A, open the stage of the strain vectors, and return these."""
        length = program.input("l", (), "m", "length of the element")
        e, A = self._coordinates(program), self.law.constants(program)
        program.stage("strain vectors")
        w = program.define("w", 1 / length)
        return w, A, self.gram.differences(program, e, w)

    def _ends(self, program: Program) -> tuple[Any, ...]:
        """Declare the inputs l, e, e_next, A, open the stage of the strain vectors at both ends of a step, and return
        what they make.
        """
        length = program.input("l", (), "m", "length of the element")
        e = self._coordinates(program)
        e_next = self._coordinates(program, "e_next", doc="nodal vectors at the end of the step")
        A = self.law.constants(program)
        program.stage("strain vectors at both ends of the step")
        w = program.define("w", 1 / length)
        c = [self.gram.differences(program, vectors, w, f"{state}_")
             for vectors, state in zip((e, e_next), STATES, strict=True)]
        return w, A, *c

    def _rates(self, program: Program, *factors: tuple[str, tuple[Any, ...], str, str]) -> tuple[Any, ...]:
        """Declare the inputs l, e, v, A, factors, open the stages up to the rates of the strain vectors, and return
        what they make.
        """
        length = program.input("l", (), "m", "length of the element")
        e = self._coordinates(program)
        v = self._coordinates(program, "v", "m/s, 1/s", "rates of the nodal vectors")
        A = self.law.constants(program)
        given = [program.input(*factor) for factor in factors or [RETARDATION]]
        program.stage("strain vectors and their rates")
        w = program.define("w", 1 / length)
        return w, A, *given, self.gram.differences(program, e, w), self.gram.differences(program, v, w, "d")

    def set_up(self) -> Program:
        """Return the kernel of the law's constants A."""
        p = self._program(self.law.set_up_kernel, "constants of the law from the stiffness of the section", "eq 7")
        self.law.set_up(p)
        return p

    def energy(self) -> Program:
        """Return the kernel of the elastic energy U of eq 7, J."""
        p = self._program("energy", "elastic energy", "eq 7")
        w, A, c = self._strain(p)
        p.output("U", [self.law.energy(p, A, c, w)], "J", "elastic energy")
        return p

    def elastic_force(self) -> Program:
        """Return the kernel of the force dU/de, which is -Q_k of eq 8."""
        p = self._program("elastic_force", "dU/de, minus the elastic force Q_k", "eq 8")
        w, A, c = self._strain(p)
        p.output("f", self._nodal(p, self.law.forces(p, A, c, w), w), "N, N m", "dU/de")
        return p

    def discrete_force(self) -> Program:
        """Return the kernel of the force between two configurations that conserves energy and momenta in a step from
        one to the other.
        """
        p = self._program("discrete_force", "discrete gradient of the energy, f . (e_next - e) = U_next - U", "eq 8")
        w, A, *c = self._ends(p)
        f = self.law.discrete_forces(p, A, *c, w)
        p.output("f", self._nodal(p, f, w), "N, N m", "dU/de where e_next is e")
        return p

    def step_stiffness(self) -> Program:
        """Return the kernel of the Newton matrix of discrete_force beyond the tangent half-way."""
        p = self._program("step_stiffness", "k: elastic_tangent half-way + k (x) I has the mean stress", "eq 8")
        w, A, *c = self._ends(p)
        change = [p.vector(f"change_{name}", b - a) for name, a, b in zip(self.gram.names, *c, strict=True)]
        block = self.law.stress_of_turning(p, A, np.array(change), w)
        p.output("k", nodal_tangent(self.gram, p, block, w, symmetric=True), "N/m, N, N m", "over nodal vectors")
        return p

    def elastic_tangent(self) -> Program:
        """Return the kernel of the second derivative of the energy, d2U/de2."""
        p = self._program("elastic_tangent", "d2U/de2", "derivative of eq 8")
        w, A, c = self._strain(p)
        K = nodal_tangent(self.gram, p, self.law.tangent(p, A, c, w), w, symmetric=True)
        p.output("K", K, "N/m, N, N m", "d2U/de2, symmetric")
        return p

    def damping_force(self) -> Program:
        """Return the kernel of -Q_d of eq 9."""
        p = self._program("damping_force", "minus the Kelvin-Voigt damping force Q_d", "Q_d of eq 9")
        w, A, tau, c, dc = self._rates(p)
        p.output("f", self._nodal(p, self.law.damping_forces(p, A, tau, c, dc, w), w), "N, N m", "-Q_d")
        return p

    def damping_tangent(self) -> Program:
        """Return the kernel of df/de + rate df/dv of the damping force f."""
        p = self._program("damping_tangent", "df/de + rate df/dv of the damping force f = -Q_d",
                          "derivative of Q_d of eq 9")
        w, A, tau, c, dc = self._rates(p)
        rate = p.input("rate", (), "1/s", "dv/de of the integrator")
        block = self.law.damping_blocks(p, A, tau, c, dc, rate, w)
        p.output("K", nodal_tangent(self.gram, p, block, w, symmetric=False), "N/m, N, N m", "df/de + rate df/dv")
        return p

    def dissipation(self) -> Program:
        """Return the kernel of the power of the damping force."""
        p = self._program("dissipation", "power dissipated by the damping force", "v . Q_d of eq 9")
        w, A, tau, c, dc = self._rates(p)
        p.output("P", [sp.sympify(self.law.dissipation(p, A, tau, c, dc, w))], "W", "dissipated power, never negative")
        return p

    def algorithmic_force(self) -> Program:
        """Return the kernel of the forces of a step with algorithmic dissipation: stresses from changes of
        strain by the integrator.
        """
        p = self._program("algorithmic_force",
                          "force of the stress D (weight dE - relaxed_strain), dE the strain that v makes",
                          "D of Q_d of eq 9")
        w, A, weight, relaxed_strain, c, dc = self._rates(
            p, ("weight", (), "1", "of the strains that v makes"),
            ("relaxed_strain", (self.law.rates(self.element)["rates"],), "1, 1/m", "strains, taken off"))
        f, dE = self.law.algorithmic_forces(p, A, weight, relaxed_strain, c, dc, w)
        p.output("f", self._nodal(p, f, w), "N, N m", "force; its power with v is that of the stress with dE")
        p.output("dE", dE, "1, 1/m", "strains: one a point and component, or over Gram pairs")
        return p

    def section_forces(self) -> Program:
        """Return the kernel of force and moment through the section at x from the side of greater x."""
        p = self._program("section_forces", "force and moment resultants of a section", "eq 6-8 at a section")
        length, x = p.input("l", (), "m", "length of the element"), p.input("x", (), "m", "arc-length from its start")
        e, S = self._coordinates(p), self.law.section_stiffness(p)
        e0 = [stress_free.shape(p, self.element)] if self.traits.takes_shape else []
        p.stage("strain vectors")
        w = p.define("w", 1 / length)
        X = p.define("X", 2 * w * x - 1)
        c = self.gram.differences(p, e, w)
        c0 = [self.gram.differences(p, vectors, w, "r0_") for vectors in e0]
        force, moment, strain = self.law.section_forces(p, S, c, X, w, *c0)
        p.stage("axes of the section")
        axes = self._axes(p, c, X, w)
        p.output("force", force, "N", "resultant of the stress, global axes")
        p.output("moment", moment, "N m", "its moment about the axis, global axes")
        p.output("axes", axes, "1", "rows: tangent t, y along the director's part across t, z = t x y; zero without")
        p.output("strain", strain, "1, 1/m", "axial, shear along y and z, twist, curvature about y and z (cable: size)")
        return p

    def _axes(self, program: Program, c: np.ndarray, X: sp.Expr, w: sp.Expr) -> np.ndarray:
        """Return the rows t, y, z in space; z is out of the plane of a planar element."""
        tangent = program.vector("t", axis(self.gram, c, X, w, 1))
        if self.element.dim == 2:
            i = unit(program, "i", tangent)
            return np.array([spatial(i), [-i[1], i[0], 0], [0, 0, 1]])
        if self.element.director:
            column = DIRECTIONS.index(self.element.director[-1])
            normal = expansion([g[column] for g in self.gram.gradient], c, X, w)[0, 0]
            return tangent_frame(program, tangent, program.vector("director", normal)).T
        return np.array([unit(program, "i", tangent), [0, 0, 0], [0, 0, 0]])

    def _nodal(self, program: Program, f: np.ndarray, w: sp.Expr) -> np.ndarray:
        program.stage("forces on nodal vectors")
        return self.gram.nodal_forces(program, f, w)
