"""The force and moment of a fluid on a length of a beam, by the angle of attack of its section.

As for a wing in strips, or for the iced conductor of Den Hartog (Trans. AIEE 51 (1932) 1074-1076): with the part w_n of
the flow across the axis i, drag 1/2 rho b C_D |w_n| w_n, lift 1/2 rho b C_L |w_n| i x w_n and the moment
1/2 rho b^2 C_M |w_n|^2 a length as it is stretched. The coefficients are those at the angle of w_n from the chord about
i; C_M is positive where the moment makes that angle larger, as tables have it. The chord is fixed in the section, and
counts by its part across the axis.

The moment does work on the turn of tangent and chord about the axis: on the rate of the chord's part across it.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..algebra.tangent_frame import cross
from ..codegen.program import Program, jacobian

SOURCE = "strip theory; Den Hartog 1932"


def on_section(name: str, relative: str) -> Program:
    """Return the kernel of force and moment a length of the undeformed beam, with derivatives.

    name: of the family; relative: meaning of w.
    """
    p = Program(f"{name}_on_section", "drag, lift and moment a length of a beam by the angle of attack of its section",
                SOURCE)
    t, d = p.input("t", 3, "1", "slope r_x of the axis"), p.input("d", 3, "1", "director along the chord")
    w = p.input("w", 3, "m/s", relative)
    scale, width, least = p.input("c_section", 3, "N s^2/m^3, m, m/s",
                                  "rho b/2, b, and the least size of w across")
    values = p.input("polar", 6, "1, 1/rad", "C_D and its derivative by the angle of attack, C_L and its, C_M and its")
    p.stage("flow and chord across the axis")
    length = p.define("len_t", sp.sqrt(t.dot(t)))
    inverse = p.define("inv_len_t", 1 / length)
    i = p.vector("i", t * inverse)
    w_t, d_t = p.define("w_t", i.dot(w)), p.define("d_t", i.dot(d))
    n, chord = p.vector("w_n", w - w_t * i), p.vector("chord", d - d_t * i)
    lifted = p.vector("lifted", cross(i, w))
    size = p.define("size_n", sp.sqrt(p.define("square_n", n.dot(n)) + least * least))
    inv_size = p.define("inv_size_n", 1 / size)
    p.stage("turns of the chord and of the angle of attack about the axis")
    by_chord = p.vector("turn_d", p.define("inv_dd", 1 / p.define("dd", chord.dot(chord))) * cross(i, d))
    by_slope = p.vector("turn_t", p.define("lean", -inverse * d_t) * by_chord)
    of_flow = p.vector("angle_w", p.define("inv_nn", inv_size * inv_size) * lifted)
    angle = np.concatenate([p.define("swept", -inverse * w_t) * of_flow - by_slope, -by_chord, of_flow])
    p.stage("force and moment")
    per_size = p.define("c_len", length * scale)
    pressure = p.define("c_size", per_size * size)
    per_moment = p.define("c_moment", p.define("c_width", per_size * width) * sp.Symbol("square_n"))
    moment = p.define("M", values[4] * per_moment)
    force = p.vector("F", pressure * (values[0] * n + values[2] * lifted))
    on_slope, on_chord = p.vector("on_t", -moment * by_slope), p.vector("on_d", -moment * by_chord)
    acting = np.concatenate([force, on_slope, on_chord])
    p.stage("what they change by with the angle of attack")
    more = p.define("M_angle", values[5] * per_moment)
    with_angle = np.concatenate([p.vector("F_angle", pressure * (values[1] * n + values[3] * lifted)),
                                 p.vector("on_t_angle", -more * by_slope), p.vector("on_d_angle", -more * by_chord)])
    p.stage("derivatives")
    K = jacobian(p, acting, np.concatenate([t, d, w])) + np.outer(with_angle, angle)
    p.output("f", acting.reshape(3, 3), "N/m, N, N", "forces a length of the undeformed beam: on r, on t, on d")
    p.output("K", K, "SI", "derivatives of f by t, d and w")
    return p
