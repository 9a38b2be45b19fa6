"""The stress-free shape of an element, as kernels take it."""

from __future__ import annotations

import numpy as np

from ..codegen.program import Program
from ..spec import Element


def shape(program: Program, element: Element) -> np.ndarray:
    """Declare the input e0 (vectors, dim), the stress-free nodal vectors, and return it."""
    return program.input("e0", (element.n_vectors, element.dim), "m, 1", "nodal vectors of the stress-free shape")
