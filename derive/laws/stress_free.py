"""The stress-free shape of an element, as kernels take it."""

from __future__ import annotations

import numpy as np

from ..codegen.program import Program
from ..spec import Element


def shape(program: Program, element: Element) -> np.ndarray:
    """Input e0 (vectors, dim)."""
    return program.input("e0", (element.n_vectors, element.dim), "m, 1", "nodal vectors of the stress-free shape")
