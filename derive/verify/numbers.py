"""Evaluation of kernels in three kinds of number, so that a relation is written once.

Relations get a `Numbers` and a state (values by the kernels' argument names, in that kind of number) and use plain
array arithmetic, `dot`, and the functions here.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import mpmath
import numpy as np

from ..codegen.program import Program
from .exact import ExactProgram

EPS = float(np.finfo(float).eps)
State = dict[str, Any]
"""Values by the kernels' argument names: arrays of floats, of complex numbers, or of mpmath numbers."""


class Numbers:
    """Kernels of one family in one kind of number; kernels go by their name without the family's."""

    def __init__(self, family: str, programs: Sequence[Any], call: Callable[..., Any], functions: Any,
                 convert: Callable[..., Any], eps: float = EPS):
        self.programs = {p.name.removeprefix(f"{family}_"): p for p in programs}
        self._call, self._convert = call, convert
        self.eps = eps
        self.sqrt, self.exp = functions.sqrt, functions.exp
        self.sin, self.cos = functions.sin, functions.cos

    def state(self, values: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        """Return a state of floats in this kind of number."""
        return {name: self.array(v) for name, v in values.items()}

    def array(self, values: np.ndarray) -> np.ndarray:
        """Return an array of floats in this kind of number, exactly."""
        return np.asarray(self._convert(np.asarray(values)))

    def __call__(self, kernel: str, state: State, **changes: Any) -> dict[str, np.ndarray]:
        """Return the outputs of a kernel at a state, some of its values changed."""
        program = self.programs[kernel]
        found: dict[str, np.ndarray] = self._call(program.name,
                                                  [changes.get(a.name, state.get(a.name)) for a in program.inputs])
        return found


def real(family: str, programs: Sequence[Any], library: Any) -> Numbers:
    """Return the kernels in doubles, from compiled C."""
    return Numbers(family, programs, library, math, lambda v: v.astype(float))


def complex_(family: str, programs: list[Program], library: Any) -> Numbers:
    """Return the kernels in complex doubles, from compiled C."""
    return Numbers(family, programs, library, cmath, lambda v: v.astype(complex))


def exact(family: str, programs: list[Program]) -> Numbers:
    """Return the kernels at 50 digits, from the SymPy expressions."""
    kernels = {p.name: ExactProgram(p) for p in programs}
    convert = np.vectorize(mpmath.mpf, otypes=[object])
    return Numbers(family, programs, lambda name, inputs: kernels[name](inputs), mpmath.mp, convert,
                   eps=float(mpmath.mp.eps))
