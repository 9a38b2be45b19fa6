"""The roots of verification for section forces: the stress over a section, and variations of the energy of a cable.

All at 50 digits from the shape functions of verify/references/element.py; derivatives are differences at that
precision.
"""

from __future__ import annotations

from collections.abc import Callable

import mpmath
import numpy as np

from ...spec import Element
from ..motion import cross, frame
from . import curved as verify_curved
from . import laws as verify_laws
from . import structural as verify_structural
from .element import Shape, section_points, spatial, stress

mp = mpmath.mp
TEXTS = {"force": "∫ P e_x dA; of a cable W_r' - (W_r'')'", "moment": "∫ arm x P e_x dA; of a cable r' x W_r''",
         "axes": "Gram-Schmidt on tangent and director", "strain": "from its definition"}
STEP = mpmath.mpf(10) ** -12  # of differences of second order: errors 1e-24, rounding 1e-26


def resultant(output: str) -> Callable:
    """Function of (element, law, state) for an output of the kernel."""
    def value(element: Element, law: str, s):
        if law == "structural":
            return verify_structural.section(element, law, s)[output]
        if output == "axes":
            return axes(element, s)
        roots = {"continuum": _continuum, "continuum_curved": verify_curved.section}
        return roots.get(law, _cable)(element, law, s)[output]
    return value


def axes(element: Element, s) -> np.ndarray:
    """Rows t, y, z."""
    shape, at = Shape(element, s["l"].item()), (s["x"].item(), 0, 0)
    r_x = spatial(shape(at, (1, 0, 0)).dot(s["e"]))
    if element.dim == 2:
        return frame(mp, r_x, np.array([-r_x[1], r_x[0], mp.mpf(0)])).T
    if element.director:
        return frame(mp, r_x, shape(at, (0, 1, 0)).dot(s["e"])).T
    return np.stack([r_x / mp.sqrt(r_x.dot(r_x)), *np.zeros((2, 3), dtype=object)])


def _continuum(element: Element, law: str, s) -> dict[str, np.ndarray]:
    shape, dim, x = Shape(element, s["l"].item()), element.dim, s["x"].item()
    force, moment = np.zeros(3, dtype=object), np.zeros(3, dtype=object)
    axis = shape((x, 0, 0)).dot(s["e"])
    for y, z, area, D in section_points(s):
        at = (x, y, z)
        F = s["e"].T.dot(shape.gradient(at))
        traction = area * spatial(F.dot(stress(D, green(F)))[:, 0])
        force = force + traction
        moment = moment + cross(spatial(shape(at).dot(s["e"]) - axis), traction)

    def strain(y, z):
        F = s["e"].T.dot(shape.gradient((x, y, z)))
        E = np.zeros((3, 3), dtype=object)
        E[:dim, :dim] = green(F)
        return E

    h = mp.mpf(1)  # polynomials of the second degree in y and z: central differences are exact
    here = strain(0, 0)
    by_y, by_z = ((strain(h * (k == 0), h * k) - strain(-h * (k == 0), -h * k)) / (2 * h) for k in (0, 1))
    measures = [here[0, 0], 2 * here[0, 1], 2 * here[0, 2], by_y[0, 2] - by_z[0, 1],
                by_z[0, 0], -by_y[0, 0]]
    return {"force": force, "moment": moment, "strain": np.array(measures)}


def green(F: np.ndarray) -> np.ndarray:
    """Green's strain."""
    return (F.T.dot(F) - np.eye(len(F), dtype=int)) / 2


def _cable(element: Element, law: str, s) -> dict[str, np.ndarray]:
    strain, curvature, *kind = law.split("_")
    curved, assumed = kind == ["curved"], kind == ["assumed"]
    shape, (EA, EI), x = Shape(element, s["l"].item()), s["S"][:2], s["x"].item()
    modes = [(mode * mp.legendre(m, 2 * x / shape.l - 1), stiffness)
             for m, (mode, stiffness) in enumerate(verify_laws.strain_modes(element, law, s))] if assumed else []
    N = sum(stiffness * mode for mode, stiffness in modes)

    def derivatives(at, of="e"):
        return [spatial(shape((at, 0, 0), (k, 0, 0)).dot(s[of])) for k in (1, 2)]

    def measures(r1, r2):
        length, normal = mp.sqrt(r1.dot(r1)), cross(r1, r2)
        eps = (length**2 - 1) / 2 if strain == "green" else length - 1
        kappa = mp.sqrt(r2.dot(r2)) if curvature == "linear" else (
            mp.sqrt(normal.dot(normal)) / length ** (3 if strain == "green" else 2))
        return eps, kappa

    def variation(at, by):
        """W_r' or W_r''."""
        def energy(t, axis):
            vectors = derivatives(at)
            vectors[by] = vectors[by] + t * np.eye(3, dtype=int)[axis]
            if curved:
                return verify_curved.cable_density(strain, vectors, derivatives(at, "e0"), EA, EI, s["l"].item())
            eps, kappa = measures(*vectors)
            return (N * eps if assumed else EA * eps**2 / 2) + EI * kappa**2 / 2

        return np.array([(energy(STEP, i) - energy(-STEP, i)) / (2 * STEP) for i in range(3)])

    h = mp.mpf(10) ** -8  # on differences good to 1e-24: 1e-16
    change = (8 * (variation(x + h, 1) - variation(x - h, 1))
              - (variation(x + 2 * h, 1) - variation(x - 2 * h, 1))) / (12 * h)
    r1, r2 = derivatives(x)
    eps, kappa = verify_curved.cable_measures(strain, [r1, r2], derivatives(x, "e0")) if curved else measures(r1, r2)
    eps = sum(mode for mode, _ in modes) if assumed else eps
    return {"force": variation(x, 0) - change, "moment": cross(r1, variation(x, 1)),
            "strain": np.array([eps, 0, 0, 0, 0, kappa])}
