"""The root of verification for the structural law: energy and dissipated power from its definitions, at 50 digits.

Frames by Gram-Schmidt from the directors, the rotation between the nodes by its angle and axis, the frame half way by
turning the first through half of it, the energy by quadrature along the axis with the bubble's amplitude from the least
energy, rates of strain by differences. Nothing goes through Gibbs vectors, condensed stiffness or parts of a motion.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import mpmath
import numpy as np

from ...spec import Element
from ..motion import cross
from .element import Shape, gauss

mp = mpmath.mp
STEP = mpmath.mpf(10) ** -16


def energy(element: Element, law: str, s: Any) -> Any:
    """Return the elastic energy from the strains, J."""
    now, before = (_strains(element, s["S"], s["l"].item(), s[name]) for name in ("e", "e0"))
    return _form(s["S"], s["l"].item(), {name: now[name] - before[name] for name in now}) / 2


def dissipation(element: Element, law: str, s: Any) -> Any:
    """Return the power: the law on the rates of strain, times tau."""
    strains = partial(_strains, element, s["S"], s["l"].item())
    after, before = strains(s["e"] + STEP * s["v"]), strains(s["e"] - STEP * s["v"])
    rates = {name: (after[name] - before[name]) / (2 * STEP) for name in after}
    return s["tau"].item() * _form(s["S"], s["l"].item(), rates)


def section(element: Element, law: str, s: Any) -> dict[str, np.ndarray]:
    """Return the resultants, axes and strains of the section at x."""
    l, at = s["l"].item(), 2 * s["x"].item() / s["l"].item() - 1
    now, before = (_strains(element, s["S"], l, s[name]) for name in ("e", "e0"))
    strains = {name: now[name] - before[name] for name in now}
    EA, GAy, GAz, GJ, EIyy, EIzz, *_, coupling = _spatial_stiffness(s["S"])
    here = [_interpolated(strains["along"][:, axis])(at) for axis in range(3)] + list(strains["curvature"])
    gibbs = np.array([mp.mpf(0)] * 3)
    for axis, shear, bending, sign in ((1, GAy, EIzz, 1), (2, GAz, EIyy, -1)):
        if shear:
            gamma = _interpolated(strains["along"][:, axis])
            beta = _least(_with_bubble(gamma, here[6 - axis], shear, bending, sign, l))
            here[axis] -= sign * beta * (1 - at**2)
            here[6 - axis] -= beta * 2 * at * 2 / l
            gibbs[3 - axis] = beta * (1 - at**2) / 2
    F = _spatial(s["e"].T.dot(Shape(element, l).gradient((s["x"].item(), 0, 0))))
    size = mp.sqrt(gibbs.dot(gibbs))
    turn = gibbs if size == 0 else gibbs * 2 * mp.atan(size) / size
    axes = _frame(F[:, 1], F[:, 2]).dot(_rotation(turn)).T
    local = np.array([k * strain for k, strain in zip((EA, GAy, GAz, GJ, EIyy, EIzz), here, strict=True)])
    local[0] += coupling * here[3]
    local[3] += coupling * here[0]
    return {"force": axes.T.dot(local[:3]), "moment": axes.T.dot(local[3:]), "axes": axes, "strain": np.array(here)}


def _strains(element: Element, S: np.ndarray, l, e: np.ndarray) -> dict[str, np.ndarray]:
    """Return stretch and shears at nodes and half way (3, 3), curvatures (3,), strains of the section at nodes (2, 3).
    """
    shape = Shape(element, l)
    gradients = [_spatial(e.T.dot(shape.gradient((x, 0, 0)))) for x in (0, l / 2, l)]
    frames = [_frame(gradients[k][:, 1], gradients[k][:, 2]) for k in (0, 2)]
    turn = _rotation_vector(frames[0].T.dot(frames[1]))
    middle = frames[0].dot(_rotation(turn / 2))
    along = [frame.T.dot(F[:, 0]) for frame, F in zip((frames[0], middle, frames[1]), gradients, strict=True)]
    along[1] = _half_way(along[1], S, l)
    half = mp.sqrt(turn.dot(turn)) / 2
    measured = 1 if half == 0 else _arc(mp.tan(half) ** 2) * mp.tan(half) / half
    products = [F.T.dot(F) for F in (gradients[0], gradients[2])]
    return {"along": np.array(along), "curvature": measured * turn / l,
            "across": np.array([[G[1, 1] / 2, G[2, 2] / 2, G[1, 2]] for G in products])}


def _half_way(r: np.ndarray, S: np.ndarray, l) -> np.ndarray:
    """Return stretch and shears of r_x half way, its components in a frame that the bubble does not turn.

    What the bubble leaves of each shear, the others zero, is not stretch; the rest is that of a parabola with the
    bubble's zeros and the mean of the bubble's square. Shears go with twice the tangent of half an angle for its sine.
    """
    _, GAy, GAz, _, EIyy, EIzz, *_ = _spatial_stiffness(S)
    found, ratio = r[0] ** 2, _square(lambda t: 1 - t * t) / (mp.mpf(2) / 3)
    for value, shear, bending in ((r[1], GAy, EIzz), (r[2], GAz, EIyy)):
        if shear:
            beta = _least(_with_bubble(lambda t, value=value: value * (1 - t * t), 0, shear, bending, 1, l))
            found += ratio * (value**2 - (value - beta) ** 2)
    stretch = mp.sqrt(found)
    angle = mp.acos(r[0] / stretch)
    larger = 1 if angle == 0 else 2 * mp.tan(angle / 2) / mp.sin(angle)
    return np.array([stretch, larger * r[1], larger * r[2]])


def _spatial_stiffness(S: np.ndarray):
    """Return the stiffness in space; a planar section leaves the third direction at rest."""
    if len(S) == 10:
        return S
    EA, GAy, EIzz, thickness = S
    zero = mp.mpf(0)
    return EA, GAy, zero, zero, zero, EIzz, thickness, zero, zero, zero


def _form(S: np.ndarray, l, strains: dict[str, np.ndarray]):
    """Return twice the energy of these strains."""
    EA, GAy, GAz, GJ, EIyy, EIzz, *across, coupling = _spatial_stiffness(S)
    along, kappa = strains["along"], strains["curvature"]
    total = EA * _square(_interpolated(along[:, 0])) + GJ * kappa[0] ** 2
    total += 2 * coupling * _mean(_interpolated(along[:, 0])) * kappa[0]
    for k, at in zip(across, strains["across"].T, strict=True):
        total += k * _square(lambda t, at=at: ((1 - t) * at[0] + (1 + t) * at[1]) / 2)
    for axis, shear, bending, sign in ((1, GAy, EIzz, 1), (2, GAz, EIyy, -1)):
        value = _with_bubble(_interpolated(along[:, axis]), kappa[3 - axis], shear, bending, sign, l)
        total += value(_least(value))
    return l * total


def _with_bubble(gamma: Callable[..., Any], kappa, shear, bending, sign: int, l) -> Callable[..., Any]:
    """Return shear (gamma - sign theta)^2 + bending (kappa + theta')^2 with theta = beta (1 - t^2), a parabola in beta.
    """
    return lambda beta: (shear * _square(lambda t: gamma(t) - sign * beta * (1 - t * t))
                         + bending * _square(lambda t: kappa - beta * 2 * t * 2 / l))


def _least(parabola: Callable[..., Any]):
    """Return the place of the minimum of a parabola; 0 where it is flat."""
    below, here, above = (parabola(mp.mpf(beta)) for beta in (-1, 0, 1))
    curvature = above - 2 * here + below
    return mp.mpf(0) if curvature == 0 else (below - above) / (2 * curvature)


def _interpolated(at: np.ndarray) -> Callable[..., Any]:
    """Return the parabola through values at -1, 0, 1."""
    return lambda t: at[0] * t * (t - 1) / 2 + at[1] * (1 - t * t) + at[2] * t * (t + 1) / 2


def _square(f: Callable[..., Any]):
    """Return the mean of f^2 over [-1, 1]."""
    return _mean(lambda t: f(t) ** 2)


def _mean(f: Callable[..., Any]):
    """Return the mean of f over [-1, 1]."""
    return sum(weight * f(t) for t, weight in gauss(5)) / 2


def _spatial(F: np.ndarray) -> np.ndarray:
    """Return a planar gradient with the third axis at rest."""
    full = np.array([[mp.mpf(int(i == j)) for j in range(3)] for i in range(3)])
    full[: len(F), : len(F)] = F
    return full


def _frame(y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Return the columns t1, t2, t3: t2 along y, t3 in the plane of y and z."""
    t2 = y / mp.sqrt(y.dot(y))
    t3 = z - t2.dot(z) * t2
    t3 = t3 / mp.sqrt(t3.dot(t3))
    return np.stack([cross(t2, t3), t2, t3], axis=1)


def _rotation_vector(Q: np.ndarray) -> np.ndarray:
    skew = np.array([Q[2, 1] - Q[1, 2], Q[0, 2] - Q[2, 0], Q[1, 0] - Q[0, 1]]) / 2
    sine = mp.sqrt(skew.dot(skew))
    return skew if sine == 0 else skew * mp.atan2(sine, (Q.trace() - 1) / 2) / sine


def _rotation(vector: np.ndarray) -> np.ndarray:
    """Return the rotation matrix of a vector by Rodrigues' formula."""
    angle = mp.sqrt(vector.dot(vector))
    if angle == 0:
        return _spatial(np.zeros((0, 0)))
    n = vector / angle
    tilde = np.stack([cross(n, unit) for unit in np.eye(3, dtype=int)], axis=1)
    return np.eye(3, dtype=int) + mp.sin(angle) * tilde + (1 - mp.cos(angle)) * tilde.dot(tilde)


def _arc(square):
    """Return the law's arctan(t)/t: Gauss's continued fraction, cut after four steps."""
    return 1 / (1 + square / (3 + 4 * square / (5 + 9 * square / (7 + 16 * square / 9))))
