"""References of the kernels `section_forces`, for any law."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np

from ...laws import TRAITS
from ...spec import Element
from ..motion import frame
from . import law as roots
from .element import Shape, spatial

mp = mpmath.mp
TEXTS = {"force": "∫ P e_x dA; of a cable W_r' - (W_r'')'", "moment": "∫ arm x P e_x dA; of a cable r' x W_r''",
         "axes": "Gram-Schmidt on tangent and director", "strain": "from its definition"}


def resultant(output: str) -> Callable[..., Any]:
    """Return the function of (element, law, state) that an output of the kernel is."""
    def value(element: Element, law: str, s):
        if output == "axes" and TRAITS[law].kind != "structural":
            return axes(element, s)
        return roots.section(element, law, s)[output]
    return value


def axes(element: Element, s: Any) -> np.ndarray:
    """Return the axes of the section by rows t, y, z."""
    shape, at = Shape(element, s["l"].item()), (s["x"].item(), 0, 0)
    r_x = spatial(shape(at, (1, 0, 0)).dot(s["e"]))
    if element.dim == 2:
        return frame(mp, r_x, np.array([-r_x[1], r_x[0], mp.mpf(0)])).T
    if element.director:
        return frame(mp, r_x, shape(at, (0, 1, 0)).dot(s["e"])).T
    return np.stack([r_x / mp.sqrt(r_x.dot(r_x)), *np.zeros((2, 3), dtype=object)])
