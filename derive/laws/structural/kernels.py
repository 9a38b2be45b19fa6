"""The kernels of the structural law: signatures as in laws/kernels.py but for the reference e0 that it takes:
stiffness(l, e0, S), section_forces(l, x, e, S, e0).

Energy, forces and tangents go through the parts of a configuration (laws/structural/structural.py): r_x at three
places, moved
along x, y, z, and the two frames, turned about their own axes.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import sympy as sp

from ... import spec
from ...algebra.tangent_frame import cross, spatial
from ...codegen.program import Program
from ...spec import Element
from .. import stress_free
from .forces import Forces, Velocity
from .section_frame import SectionFrame
from .structural import Configuration, Structural
from .tangent import Tangent


def build(element: Element) -> list[Program]:
    """Return every kernel of the law on an element."""
    kernels = Kernels(element)
    return [kernels.stiffness(), kernels.energy(), kernels.elastic_force(), kernels.elastic_tangent(),
            kernels.damping_force(), kernels.damping_tangent(), kernels.dissipation(), kernels.section_forces()]


class Kernels:
    """Programs of the law on an element."""

    def __init__(self, element: Element):
        self.element, self.law = element, Structural(element)

    def _program(self, kernel: str, doc: str) -> Program:
        return Program(f"{self.element.name}_{self.law.name}_{kernel}", doc, self.law.source)

    def _inputs(self, program: Program, *names: str) -> tuple[Any, ...]:
        """Declare the inputs l, e, A, or l, e, v, A, tau; return the configuration from them."""
        shape = (self.element.n_vectors, self.element.dim)
        about = {"e": ("m, 1", "nodal vectors e, eq 1"), "v": ("m/s, 1/s", "rates of the nodal vectors")}
        length = program.input("l", (), "m", "length of the element")
        vectors = [program.input(name, shape, *about[name]) for name in names]
        return (length, *vectors, self.law.constants(program))

    def _tau(self, program: Program) -> sp.Symbol:
        return program.input("tau", (), "s", "retardation time of the Kelvin-Voigt law")

    def _configuration(self, program: Program, e: np.ndarray, length: sp.Symbol,
                       shares: Sequence[sp.Expr] | np.ndarray) -> Configuration:
        program.stage("frames, strains")
        return Configuration(self.law, program, e, program.define("w", 1 / length), shares)

    def _shares(self, A: np.ndarray) -> np.ndarray:
        return A[self.law.n_stiffness:self.law.n_constants]

    def stiffness(self) -> Program:
        """Return the kernel of the law's constants A."""
        p = self._program("stiffness", "constants of the law from the stiffness of the section and the reference")
        self.law.set_up(p)
        return p

    def energy(self) -> Program:
        """Return the kernel of the elastic energy, half of strains times resultants, J."""
        p = self._program("energy", "elastic energy")
        length, e, A = self._inputs(p, "e")
        strains = self.law.from_reference(p, A, self._configuration(p, e, length, self._shares(A)).strains)
        resultants = self.law.resultants(self._stiffness(p, A, length), strains)
        p.output("U", [sum(s * r for s, r in zip(strains, resultants, strict=True)) / 2], "J", "elastic energy")
        return p

    def elastic_force(self) -> Program:
        """Return the kernel of the force dU/de, N and N m."""
        p = self._program("elastic_force", "dU/de, minus the elastic force Q_k")
        length, e, A = self._inputs(p, "e")
        configuration = self._configuration(p, e, length, self._shares(A))
        forces = Forces(configuration, self._elastic(p, A, self._stiffness(p, A, length), configuration))
        p.output("f", forces.nodal(), "N, N m", "dU/de")
        return p

    def elastic_tangent(self) -> Program:
        """Return the kernel of the tangent d2U/de2."""
        p = self._program("elastic_tangent", "d2U/de2")
        length, e, A = self._inputs(p, "e")
        configuration = self._configuration(p, e, length, self._shares(A))
        stiffness = self._stiffness(p, A, length)
        tangent = Tangent(configuration, self._elastic(p, A, stiffness, configuration))
        tangent.add_material(stiffness)
        p.output("K", tangent.nodal(), "N/m, N, N m", "d2U/de2, symmetric")
        return p

    def damping_force(self) -> Program:
        """Return the kernel of tau times the elastic law on the rates of strain."""
        p = self._program("damping_force", "minus the Kelvin-Voigt damping force Q_d")
        length, e, v, A = self._inputs(p, "e", "v")
        configuration = self._configuration(p, e, length, self._shares(A))
        rates = Velocity(configuration, v).strains()
        resultants = self._resultants(p, self._stiffness(p, A, self._tau(p) * length), rates)
        p.output("f", Forces(configuration, resultants).nodal(), "N, N m", "-Q_d")
        return p

    def damping_tangent(self) -> Program:
        """Return the kernel of df/de + rate df/dv of the damping force f."""
        p = self._program("damping_tangent", "df/de + rate df/dv of the damping force f = -Q_d")
        length, e, v, A = self._inputs(p, "e", "v")
        tau = self._tau(p)
        rate = p.input("rate", (), "1/s", "dv/de of the integrator")
        configuration = self._configuration(p, e, length, self._shares(A))
        velocity = Velocity(configuration, v)
        stiffness = self._stiffness(p, A, tau * length)
        tangent = Tangent(configuration, self._resultants(p, stiffness, velocity.strains()))
        tangent.add_material(stiffness, velocity, rate)
        p.output("K", tangent.nodal(), "N/m, N, N m", "df/de + rate df/dv")
        return p

    def dissipation(self) -> Program:
        """Return the kernel of the dissipated power: rates of strain times viscous resultants."""
        p = self._program("dissipation", "power dissipated by the damping force")
        length, e, v, A = self._inputs(p, "e", "v")
        rates = Velocity(self._configuration(p, e, length, self._shares(A)), v).strains()
        power = self._resultants(p, self._stiffness(p, A, self._tau(p) * length), rates)
        p.output("P", [sum(a * b for a, b in zip(rates, power, strict=True))], "W", "dissipated power, never negative")
        return p

    def section_forces(self) -> Program:
        """Return the kernel of force and moment through the section at x from the side of greater x."""
        p = self._program("section_forces", "force and moment resultants of a section")
        length, x = p.input("l", (), "m", "length of the element"), p.input("x", (), "m", "arc-length from its start")
        shape = (self.element.n_vectors, self.element.dim)
        e, S = p.input("e", shape, "m, 1", "nodal vectors e, eq 1"), self.law.section_stiffness(p)
        e0 = stress_free.shape(p, self.element)
        shares = self.law.shares(p, S, length)
        now, before = (self._configuration(p, vectors, length, shares).strains for vectors in (e, e0))
        p.stage("strains from the reference")
        strains = [p.define(f"d_{name}", a - b) for name, a, b in zip(self.law.names, now, before, strict=True)]
        p.stage("strains at x")
        strain, turn = self.law.at(p, S, length, p.define("X", 2 * x / length - 1), strains)
        p.stage("axes of the section")
        shapes = [N.subs({spec.x: x, spec.l: length}) for N in self.law.director_shapes]
        nodal = {name.partition("_")[2]: spatial(e[k]) for k, name in enumerate(self.element.names)}
        directors = [sum((N * nodal.get(f"{d}{n + 1}", spatial([0, 0, 1])) for n, N in enumerate(shapes)), spatial([]))
                     for d in "yz"]
        frame = SectionFrame(p, "", *(p.vector(f"r_{d}", v) for d, v in zip("yz", directors, strict=True))).t
        twice = p.define("twice", 2 / (1 + turn.dot(turn)))
        across = [p.vector(f"across{i + 1}", cross(turn, unit)) for i, unit in enumerate(np.eye(3, dtype=int))]
        axes = np.array([p.vector(f"t{i + 1}", frame[i] + (twice * (c + cross(turn, c))).dot(frame))
                         for i, c in enumerate(across)])
        resultant = [p.define(f"N{i + 1}", r) for i, r in enumerate(self.law.at_section(S, strain))]
        p.output("force", np.array(resultant[:3]).dot(axes), "N", "resultant of the stress, global axes")
        p.output("moment", np.array(resultant[3:]).dot(axes), "N m", "its moment about the axis, global axes")
        p.output("axes", axes, "1", "rows: normal of the section t1, t2 along r_y, t3 = t1 x t2, turned by the bubble")
        p.output("strain", strain, "1, 1/m", "axial, shear along y and z, twist, curvature about y and z")
        return p

    def _stiffness(self, program: Program, A: np.ndarray, scale: sp.Expr) -> list[sp.Expr]:
        """Return section stiffness, and what the bubbles take off, times l, or another scale."""
        program.stage("stiffness of the element")
        return [program.define(f"S_{i}", scale * A[i]) for i in range(self.law.n_stiffness)]

    def _elastic(self, program: Program, A: np.ndarray, stiffness: Sequence[sp.Expr],
                 configuration: Configuration) -> list[sp.Expr]:
        return self._resultants(program, stiffness, self.law.from_reference(program, A, configuration.strains))

    def _resultants(self, program: Program, stiffness: Sequence[sp.Expr], strains: Sequence[sp.Expr]) -> list[sp.Expr]:
        program.stage("resultants")
        return [program.define(f"n_{name}", r)
                for name, r in zip(self.law.names, self.law.resultants(stiffness, strains), strict=True)]
