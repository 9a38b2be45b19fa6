"""Springs with dampers between two points: the force along the gap from the first point to the second.

With the extension e the spring stores U = k e.e/2 and the damper takes the power P = c e'.e'. e is |gap| less the
rest length; where that is zero e is the gap itself, so that nothing is singular where the points meet. The force on the
first point is dU/dgap + d(P/2)/dgap' = (k e + c e') . de/dgap, its opposite acts on the second.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import sympy as sp

from ..algebra.discrete_gradient import DiscreteGradient
from ..codegen.program import AXES, DirectionalDerivative, Program


@dataclass(frozen=True)
class Spring:
    """One kind of spring: its dimension, and whether its rest length is above zero."""

    dim: int
    has_length: bool

    def extension(self, p: Program, gap: np.ndarray, rest_length: sp.Expr) -> np.ndarray:
        """Stage: e, of one component or as many as the gap."""
        if not self.has_length:
            return gap
        p.stage("extension")
        length = p.define("length", sp.sqrt(gap.dot(gap)))
        p.define("inv_length", 1 / length)
        return np.array([p.define("extension", length - rest_length)])


SPRINGS = {"spring": Spring(3, True), "zero_length_spring": Spring(3, False),
           "planar_spring": Spring(2, True), "planar_zero_length_spring": Spring(2, False)}
INPUTS = {"stiffness": ("N/m", "stiffness"),
          "damping": ("N s/m", "damping along the gap"),
          "rest_length": ("m", "length without force; not used where that is zero")}


def build(name: str) -> list[Program]:
    """Return the kernels of one kind of spring."""
    return [make(name, SPRINGS[name]) for make in (energy, dissipation, force, tangent, discrete_force)]


class _Law:
    """Inputs of a spring's kernel, of its constants those that it names, and its extension."""

    stiffness: sp.Expr
    damping: sp.Expr
    rest_length: sp.Expr

    def __init__(self, name: str, spring: Spring, doc: str, constants: str, rate: bool = True):
        self.program = p = Program(name, doc, "linear spring and damper along the gap")
        self.spring = spring
        for constant in constants.split():
            setattr(self, constant, p.input(constant, (), *INPUTS[constant]))
        self.gap = p.input("gap", spring.dim, "m", "second point less the first")
        self.rate = p.input("gap_rate", spring.dim, "m/s", "rate of the gap") if rate else None
        self.extension = spring.extension(p, self.gap, self.rest_length)

    def by_gap(self) -> list[DirectionalDerivative]:
        """Derivations along the axes."""
        eye = np.eye(self.spring.dim, dtype=int)
        return [DirectionalDerivative(self.program, f"d_{axis}", dict(zip(self.gap, unit, strict=True)))
                for axis, unit in zip(AXES, eye, strict=False)]

    def direction(self, by: list[DirectionalDerivative]) -> np.ndarray:
        """Stage: de/dgap, a row for each component of e."""
        self.program.stage("direction")
        return np.stack([d.array(self.extension) for d in by], axis=1)

    def extension_rate(self, direction: np.ndarray) -> np.ndarray:
        """Stage: e'."""
        self.program.stage("rate of the extension")
        return np.array([self.program.define("extension_rate", row.dot(self.rate)) for row in direction])

    def force(self, by: list[DirectionalDerivative]) -> tuple[np.ndarray, np.ndarray]:
        """Stage: force on the first point, and de/dgap."""
        direction = self.direction(by)
        rate = self.extension_rate(direction)
        self.program.stage("force")
        tension = [self.program.define("tension", self.stiffness * e + self.damping * r)
                   for e, r in zip(self.extension, rate, strict=True)]
        return self.program.vector("F", direction.T.dot(tension)), direction


def energy(name: str, spring: Spring) -> Program:
    """Return the kernel of U."""
    law = _Law(f"{name}_energy", spring, "stored energy", "stiffness rest_length", rate=False)
    law.program.output("U", law.stiffness * law.extension.dot(law.extension) / 2, "J", "stored energy k e.e/2")
    return law.program


def dissipation(name: str, spring: Spring) -> Program:
    """Return the kernel of P."""
    law = _Law(f"{name}_dissipation", spring, "power that the damper takes", "damping rest_length")
    rate = law.extension_rate(law.direction(law.by_gap()))
    law.program.output("P", law.damping * rate.dot(rate), "W", "dissipated power c e'.e'")
    return law.program


def force(name: str, spring: Spring) -> Program:
    """Return the kernel of the force alone."""
    law = _Law(f"{name}_force", spring, "force along the gap", "stiffness damping rest_length")
    f, _ = law.force(law.by_gap())
    law.program.output("f", f, "N", "force on the first point")
    return law.program


def tangent(name: str, spring: Spring) -> Program:
    """Return the kernel of the force with its derivatives."""
    law = _Law(f"{name}_tangent", spring, "force along the gap, and its derivatives", "stiffness damping rest_length")
    by = law.by_gap()
    f, direction = law.force(by)
    law.program.stage("derivatives of the force")
    K = np.stack([d.array(f) for d in by], axis=1)
    law.program.output("f", f, "N", "force on the first point")
    law.program.output("K", K, "N/m", "derivatives of f by the gap")
    law.program.output("D", law.damping * direction.T.dot(direction), "N s/m", "derivatives of f by the gap's rate")
    return law.program


def discrete_force(name: str, spring: Spring) -> Program:
    """Return the kernel of the force over a step whose work is what the spring stores and the damper takes."""
    p = Program(f"{name}_discrete_force", "force over a step, which takes the work that is stored and dissipated",
                "discrete gradient of the energy; Gonzalez, J. Nonlinear Sci. 6 (1996) 449-467")
    stiffness, damping, rest_length = (p.input(constant, (), *INPUTS[constant]) for constant in INPUTS)
    h = p.input("h", (), "s", "step")
    gap = p.input("gap", spring.dim, "m", "second point less the first, at the start of the step")
    gap_next = p.input("gap_next", spring.dim, "m", "gap at the end of the step")
    law = Program("law", "extension at one state", "")
    at = np.array([law.input(f"gap_{axis}", (), "m", "gap") for axis in AXES[: spring.dim]])
    extension = spring.extension(law, at, rest_length)
    discrete = DiscreteGradient(p, law, dict(zip(at, zip(gap, gap_next, strict=True), strict=True)))
    p.stage("discrete derivatives of the extension")
    gradients = [discrete.gradient(e, list(at)) for e in extension]
    direction = np.array([p.vector("D_e", row) for row in gradients])
    p.stage("rate of the extension over the step")
    change = p.vector("change", gap_next - gap)
    inverse = p.define("inv_h", 1 / h)
    rate = np.array([p.define("extension_rate", inverse * row.dot(change)) for row in direction])
    p.stage("force")
    tension = [p.define("tension", stiffness * discrete.mean(e) + damping * r)
               for e, r in zip(extension, rate, strict=True)]
    p.output("f", direction.T.dot(tension), "N", "force on the first point")
    p.output("P", damping * rate.dot(rate), "W", "dissipated power")
    return p
