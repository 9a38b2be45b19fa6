"""Relations of the kernels of friction and buffers."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ..methods import Relation
from .paths import from_kernel


def resistance(family: CouplingFamily) -> list[Relation]:
    """Return the relations of the derivatives of R."""
    dim = family.dim

    def moved(name, at=0):
        return from_kernel("force", "R", **{name: lambda s, j: np.eye(len(s[name]), dtype=int)[j + at]})

    return [Relation("force", "R", "at 50 digits; see friction and buffer below", 0, from_kernel("force", "R")),
            *(Relation("force", f"R_{name}", f"dR by {name}", 1, moved(name), dim) for name in "tuf"),
            Relation("force", "R_x", "dR by x", 1, moved("buffer", 2), 1)]
