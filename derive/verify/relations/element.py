"""Relations of the kernels of elements: eq 2-4, and loads."""

from __future__ import annotations

import numpy as np

from ...codegen.family import ElementFamily
from ...spec import Element
from ..methods import Relation
from ..references import element as reference
from .load import loads
from .paths import root


def element(family: ElementFamily) -> list[Relation]:
    """Return the relations of an element's own kernels, eq 2-4, and of its loads."""
    spec: Element = family.element

    def shape(s):
        return reference.Shape(spec, s["l"].item())(s["at"])

    return [
        Relation("mass", "m", "∫ ρ N N' dV by quadrature", 0, root(reference.mass, spec)),
        Relation("gravity", "Q", "∫ ρ N g dV by quadrature", 0, root(reference.gravity, spec)),
        Relation("inertia_force", "f", "(m ⊗ I) a", 0, root(lambda s: np.asarray(s["m"]).dot(s["a"]))),
        Relation("position", "N", "nodal conditions solved at 50 digits", 0, root(shape)),
        Relation("position", "r", "Σ N d", 0, root(lambda s: shape(s).dot(s["e"]))),
        *loads(spec),
    ]
