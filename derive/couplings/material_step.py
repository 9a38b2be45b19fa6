"""Material of a rope over a step that conserves energy.

r(xi, t) is the place at the part xi of the stress-free length l = s_b - s_a, between the material coordinates s_a and
s_b. A material point has the velocity u = r_t - s' r_xi/l with s' = (1 - xi) s_a' + xi s_b'. With the momentum P = l u
over rho, T = rho int |P|^2/(2 l) dxi and the angular momentum is rho int r x P dxi. P at quadrature points is the state
of the step. With changes d over the step h, and means ~ of both ends,

    w = dr/h - c t,   c = ((1 - xi) ds_a + xi ds_b)/(h l~),   P_1 = 2 l~ w - P_0,

with a mean t of r_xi, and the forces

    on r      rho dP/h
    on r_xi   rho c l~ w
    on s_a    -(1 - xi) X + Y + Z ds_b,   X = rho (t.dP/l~ + w.dr_xi)/h,
    on s_b    -xi X - Y - Z ds_a,         Y = rho (|w|^2/2 + |dP - w dl|^2/(8 l_0 l_1)),   Z = rho t.w/(h l~)

do the work dT on the changes; those of Z do none. Their moment, with the arms r~ and t, is the rate of the angular
momentum: dr = h w + h c t makes dr x P~ = h c l~ t x w.

A slope e of a node has the vector l e of unit length, on which a force f acts. With cross products x of the plane,

    l~ f + (dl/4) (de x f) k x e~/|e~|^2 on e,   f.e~ - (de x f) (e~ x de)/(4 |e~|^2) on l

do the work f.d(l e), and have the moment of f with the arm (l e)~. In space the terms with products are left out: the
forces have the moments of f with the arms l~ e^, where e^ = (l e)~/l~. These directions are those of all elements at a
node, as their lengths are parts of that of the span. So the moments of all forces of a step balance along e^, which is
the change of the angular momentum. Damping and chords have the slopes e^, too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp

from ..codegen.program import Program

SOURCE = "discrete derivatives; Gonzalez, J. Nonlinear Sci. 6 (1996) 449-467"


@dataclass(frozen=True)
class Step:
    """A length over a step: the mass of a unit of it, the step, the length at both ends, and changes of s_a, s_b."""

    rho: Any
    h: Any
    l: tuple[Any, Any]
    s_change: np.ndarray
    mean: Any
    product: Any

    @classmethod
    def of(cls, p: Program) -> Step:
        """Declare the inputs and open a stage of the length."""
        rho, h = p.input("rho", (), "kg/m", "mass of a length"), p.input("h", (), "s", "step")
        now = p.input("l", (), "m", "length s_b - s_a at the start of the step")
        change = p.input("s_change", 2, "m", "changes of s_a and s_b over the step")
        p.stage("length over the step")
        following = p.define("l_next", now + (change[1] - change[0]))
        return cls(rho, h, (now, following), change, p.define("l_mean", (now + following) / 2),
                   p.define("l_product", now * following))


@dataclass(frozen=True)
class Forces:
    """Forces on the place and the slope r_xi of a point, on s_a and s_b; its momentum after the step."""

    on_place: np.ndarray
    on_slope: np.ndarray
    on_s: np.ndarray
    P: np.ndarray


def at_point(p: Program, tag: str, step: Step, xi: Any, change: np.ndarray, slope: np.ndarray, slope_change: np.ndarray,
             P: np.ndarray) -> Forces:
    """Stage: the forces of a point with the change of its place, a mean and the change of r_xi, and its momentum."""
    flow = p.define(f"flow{tag}", ((1 - xi) * step.s_change[0] + xi * step.s_change[1]) / (step.h * step.mean))
    slope, slope_change = p.vector(f"slope{tag}", slope), p.vector(f"slope_change{tag}", slope_change)
    w = p.vector(f"w{tag}", change / step.h - flow * slope)
    gain = p.vector(f"gain{tag}", 2 * (step.mean * w - P))
    relative = p.vector(f"relative{tag}", gain - (step.l[1] - step.l[0]) * w)
    X = p.define(f"X{tag}", step.rho * (slope.dot(gain) / step.mean + slope_change.dot(w)) / step.h)
    Y = p.define(f"Y{tag}", step.rho * (w.dot(w) / 2 + relative.dot(relative) / (8 * step.product)))
    Z = p.define(f"Z{tag}", step.rho * slope.dot(w) / (step.h * step.mean))
    return Forces(step.rho * gain / step.h, step.rho * flow * step.mean * w,
                  np.array([-(1 - xi) * X + Y + Z * step.s_change[1], -xi * X - Y - Z * step.s_change[0]]), P + gain)


def on_slope(p: Program, tag: str, f: np.ndarray, e: np.ndarray, change: np.ndarray, l: Sequence[Any],
             mean: Any) -> tuple[np.ndarray, Any]:
    """Stage: the forces on a slope, with this mean and change, and on the length of a force on its unit vector l e."""
    if len(e) > 2:
        return mean * f, f.dot(e)
    turned = p.define(f"turned{tag}", (change[0] * f[1] - change[1] * f[0]) / (4 * e.dot(e)))
    return (mean * f + (l[1] - l[0]) * turned * np.array([-e[1], e[0]]),
            f.dot(e) - turned * (e[0] * change[1] - e[1] * change[0]))


def gauss(n: int) -> list[tuple[sp.Float, sp.Float]]:
    """Return n Gauss points on (0, 1) and their weights."""
    return [(sp.Float((1 + float(x)) / 2), sp.Float(float(w) / 2))
            for x, w in zip(*np.polynomial.legendre.leggauss(n), strict=True)]
