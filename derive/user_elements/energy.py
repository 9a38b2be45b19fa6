"""Checks of an elastic law on an element at 50 digits, before it is compiled.

Its energy is zero where the element is straight, unchanged by rigid motion, smooth and finite. The samples are those of
verification (two bent elements and the straight reference), the latter also turned.
"""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ..codegen.family import LawFamily
from ..codegen.program import Program
from ..verify import numbers as verify_numbers
from ..verify.exact import DIGITS
from ..verify.samples import states
from ..verify.samples.shapes import reference, rotation
from .load import SpecError

SAMPLES = ("bent element 1", "bent element 2", "the straight reference", "the straight reference, turned")
NODE_KINDS = (sp.Symbol, sp.Rational, sp.Float, sp.Add, sp.Mul, sp.Pow)
STEP = mpmath.mpf(10) ** -14
TOLERANCE = 1e-8  # differences at 50 digits keep ten more of a smooth energy, and none of a kinked one


def check_arithmetic(programs: list[Program], place: str) -> None:
    """Raise SpecError for a kernel that has more than sums, products, quotients and square roots."""
    for program in programs:
        exprs = [e for stage in program.stages for _, e in stage.definitions]
        exprs += [e for value in program.values.values() for e in value.ravel()]
        for expr in exprs:
            for node in sp.preorder_traversal(expr):
                name = type(node).__name__
                if isinstance(node, (sp.Abs, sp.Max, sp.Min, sp.sign, sp.Piecewise, sp.Heaviside)):
                    raise SpecError(place, f"the energy has a kink: kernel {program.name} has {name} in {expr}",
                                    "write it smooth, with products and square roots of what stays positive")
                if not isinstance(node, NODE_KINDS) or (isinstance(node, sp.Pow) and not (2 * node.exp).is_Integer):
                    raise SpecError(place, f"kernel {program.name} is not plain arithmetic: {node}",
                                    "kernels have +, -, *, / and square roots")


def check_law(family: LawFamily, programs: list[Program], place: str) -> None:
    """Raise SpecError for the first property that the law's kernels lack, with kernel and sample."""
    with mpmath.workdps(DIGITS):
        _Trial(family, programs, place).run()


class _Trial:
    """The law's kernels at 50 digits over the samples."""

    def __init__(self, family: LawFamily, programs: list[Program], place: str):
        self.family, self.place = family, place
        self.k = verify_numbers.exact(family.name, programs)
        self.states = self._samples()
        self.scale = self._scale()

    def _samples(self) -> list[dict[str, Any]]:
        try:
            found = states(self.family, self.k)
        except ZeroDivisionError:
            self._fail("stiffness", SAMPLES[0], "is not finite")
        turned = rotation(np.random.default_rng(1), self.family.element.dim)
        return [self.k.state(s) for s in (*found, found[-1] | {"e": found[-1]["e"] @ turned.T})]

    def _fail(self, kernel: str, sample: str, cause: str, remedy: str = "") -> None:
        raise SpecError(self.place, f"{cause}: kernel {self.family.name}_{kernel}, at {sample}", remedy)

    def value(self, kernel: str, output: str, s: Any, **changes: Any) -> Any:
        """Return an output, None where it is no finite real number."""
        try:
            value = self.k(kernel, s, **changes)[output]
        except (ZeroDivisionError, ValueError):
            return None
        flat = value.ravel()
        if any(isinstance(v, mpmath.mpc) and v.imag != 0 for v in flat) or not all(map(mpmath.isfinite, flat)):
            return None
        return value

    def _scale(self) -> float:
        """Return the energy of a strain of order one."""
        bent = [self.value("energy", "U", s) for s in self.states[:2]]
        for sample, U in zip(SAMPLES, bent, strict=False):
            if U is None:
                self._fail("energy", sample, "the energy is not a finite number")
        return max(float(abs(U[0])) for U in bent) or 1.0

    def run(self) -> None:
        """Check every property in turn."""
        self._objective()
        self._stress_free()
        self._smooth()
        self._finite()

    def _objective(self) -> None:
        spec, random = self.family.element, np.random.default_rng(3)
        positions = np.array(spec.is_position, dtype=float)
        shift, turn = random.normal(size=spec.dim), rotation(random, spec.dim)
        for sample, s in zip(SAMPLES, self.states, strict=True):
            U = self.value("energy", "U", s)
            if U is None:
                self._fail("energy", sample, "the energy is not a finite number")
            for motion, e in (("translation", s["e"] + np.outer(positions, shift)), ("rotation", s["e"].dot(turn.T))):
                moved = self.value("energy", "U", s, e=e)
                # the matrix of the rotation is orthogonal to 1e-16
                if moved is None or abs(moved[0] - U[0]) > 1e-12 * self.scale:
                    after = "not a number" if moved is None else f"{float(moved[0]):.6g} J"
                    self._fail("energy", sample, f"the energy is not objective: a rigid {motion} changes it from "
                               f"{float(U[0]):.6g} J to {after}", "make it of the Gram products that a law is given")

    def _stress_free(self) -> None:
        e = self.k.array(reference(self.family.element, float(self.states[0]["l"].item())))
        U = self.value("energy", "U", self.states[2], e=e)
        if abs(U[0]) > 1e-20 * self.scale:
            self._fail("energy", SAMPLES[2], f"the undeformed element is not at rest: it stores {float(U[0]):.6g} J")

    def _finite(self) -> None:
        for kernel, program in self.k.programs.items():
            for sample, s in zip(SAMPLES, self.states, strict=True):
                for output in program.outputs:
                    if self.value(kernel, output.name, s) is None:
                        self._fail(kernel, sample, f"{output.name} is not a finite number where the energy is",
                                   "a root or a quotient vanishes there: write the energy without it")
        f = self.value("elastic_force", "f", self.states[2])
        if max(map(abs, f.ravel())) > 1e-15 * self.scale:
            self._fail("elastic_force", SAMPLES[2], "the undeformed element is not at rest: it has forces of "
                       f"{float(max(map(abs, f.ravel()))):.6g} N")

    def _smooth(self) -> None:
        """Raise SpecError unless slope and curvature of the energy are the same to either side, along every coordinate.
        """
        names = [f"{name}[{axis}]" for name in self.family.element.names for axis in "xyz"[: self.family.element.dim]]
        for sample, s in zip(SAMPLES, self.states, strict=True):
            for j, name in enumerate(names):
                for order, (before, after) in enumerate(self._one_sided(sample, s, j, name), start=1):
                    if abs(after - before) > TOLERANCE * max(self.scale, abs(after)):
                        self._fail("energy", sample, f"the energy has a kink{' in its slope' if order == 2 else ''}: "
                                   f"along {name} its {'slope' if order == 1 else 'second derivative'} is "
                                   f"{float(before):.6g} on one side and {float(after):.6g} on the other",
                                   "make it of squares, or round the corner off")

    def _one_sided(self, sample: str, s: Any, j: int, name: str) -> list[tuple[Any, ...]]:
        """Return the first and second differences of the energy by coordinate j, before and after the sample."""
        direction = np.zeros(s["e"].size, dtype=int)
        direction[j] = 1
        U = {}
        for k in (-2, -1, 0, 1, 2):
            found = self.value("energy", "U", s, e=s["e"] + k * STEP * direction.reshape(s["e"].shape))
            if found is None:
                self._fail("energy", sample, f"the energy is not a finite number next to it, {name} moved by 1e-14")
            U[k] = found[0]
        return [((U[0] - U[-1]) / STEP, (U[1] - U[0]) / STEP),
                ((U[0] - 2 * U[-1] + U[-2]) / STEP**2, (U[2] - 2 * U[1] + U[0]) / STEP**2)]
