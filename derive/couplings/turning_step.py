"""A rope on a sheave in space over a step that conserves energy, see material_step.py and sheave_step.py.

The groove has the axes A, the columns a_1 and a_2 in its plane and a along the axis. Its body rotates over the step by
Cayley's map with the vector theta. With means ~ and changes d,

    dA = theta x A~,   d(A y) = A~ dy + theta x A~ y~,   (A y)~ = A~ y~ + theta x A~ dy/4.

The wrap has its places c + A y, where y = R n(phi) belongs to the plane of the groove. A force F there, and a force G
on the slope r_xi, whose mean is taken as t = A~ y_xi~, are

    F on c,   A~'(F - theta x (theta x F)/4) on y,   A~'G on y_xi,   and (A y)~ x F + t x G about c on the body:

their work is F.d(c + A y) + G.d(A y_xi), and their moment is that of F and G. Forces on y and y_xi are moments on
angles of the groove, which act between the body and the tangent points: as x = A y at these,

    dy_i = a_i~.dx + theta.(a_i~ x x~),

a force on y_i is a_i~ on the node, its opposite on c, and a_i~ x x~ on the body. These have no moment together.

The conditions of a tangent point depend on the products of the vectors x, d, a and w. A discrete gradient by these is a
force on each vector along the means of the others, by which the sum of their moments vanishes with the weight w. The
chord is d = N_i(L) D_i over the vectors from the node to the nodal places of the span, and over its slopes times the
length L. With the products of these vectors,

    d(N_i x.D_i) = N_i~ (x~.dD_i + D_i~.dx) + (x.D_i)~ dN_i.

The rope that is wound on a drum (drum.py) has the velocities w = R omega of its rim about the axis and t_i = R Omega_i
about both vectors of the groove, beside v of the centre: its angular momentum about the centre is

    H = rho R u (w a + t_i a_i/2),   d(u w a) = d(u w) a~ + (u w)~ theta x a~.

It is laid on with the energy V = L g . A n_phi, whose change is L g . (A~ dn_phi + theta x A~ n_phi~).
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..algebra.tangent_frame import cross
from ..codegen.program import Program, jacobian
from ..elements import ELEMENTS
from ..spec import x as along
from .material_step import SOURCE, Step, at_point
from .sheave_step import radial_and_along
from .span_inertia import FlowingElement

DIM, PLANE = 3, 2
PRODUCTS = ("x.x", "a.x", "d.x", "d.d", "a.d", "x.w", "a.w", "d.w")


def kernels() -> list[Program]:
    """Return the kernels of a step."""
    return [momentum(), momentum_energy(), momentum_step(), by_products(), chord_step(), store_step(), laid_step()]


def _program(kernel: str, doc: str, source: str = SOURCE) -> Program:
    return Program(f"tangent_point_{kernel}", doc, source)


def _axes(p: Program, doc: str) -> np.ndarray:
    return p.input("axes", (DIM, PLANE), "1", f"vectors of the plane of the groove by columns{doc}")


def momentum() -> Program:
    """Return the kernel of the momentum at a point, over the mass of a length."""
    p = _program("momentum", "momentum of the material at a point of a zone, over the mass of a length",
                 "material velocity of a rope on a circle that turns")
    R, length = p.input("R", (), "m", "radius to the axis of the rope"), p.input("l", (), "m", "length s_b - s_a")
    xi = p.input("xi", (), "1", "part of the zone")
    phi, angle = p.input("angle_at", (), "rad", "angle of the point"), p.input("alpha", (), "rad", "angle of the zone")
    axes = _axes(p, "")
    c_rate = p.input("c_rate", DIM, "m/s", "velocity of the centre")
    omega = p.input("omega", DIM, "rad/s", "angular velocity of the groove")
    turn = p.input("turn", (), "rad/s", "rate of the angle of the point, from the groove")
    s_rate = p.input("s_rate", 2, "m/s", "rates of s_a and s_b")
    p.stage("directions in space")
    n, across = (p.vector(name, axes.dot(v)) for name, v in zip(("n", "across"), radial_and_along(phi), strict=True))
    p.stage("momentum")
    flow = p.define("flow", R * (length * turn - angle * ((1 - xi) * s_rate[0] + xi * s_rate[1])))
    p.output("P", length * (c_rate + R * np.array(p.vector("swing", cross(omega, n)))) + flow * across, "m^2/s", "l u")
    return p


def momentum_energy() -> Program:
    """Return the kernel of the kinetic energy of the momentum at a point."""
    p = _program("momentum_energy", "kinetic energy of the momentum at a point of a zone")
    rho, length = p.input("rho", (), "kg/m", "mass of a length"), p.input("l", (), "m", "length s_b - s_a")
    P = p.input("P", DIM, "m^2/s", "momentum l u")
    p.stage("kinetic energy")
    p.output("T", [rho * P.dot(P) / (2 * length)], "J", "kinetic energy")
    return p


def momentum_step() -> Program:
    """Return the kernel of the inertial forces of a point over a step, and its momentum at the end."""
    p = _program("momentum_step", "inertial forces of a point of a zone over a step that conserves energy")
    step = Step.of(p)
    R, xi = p.input("R", (), "m", "radius to the axis of the rope"), p.input("xi", (), "1", "part of the zone")
    phi = p.input("angle_at", (), "rad", "angle of the point at the start of the step")
    phi_change = p.input("angle_change", (), "rad", "its change")
    alpha = p.input("alpha", (), "rad", "angle of the zone at the start of the step")
    alpha_change = p.input("alpha_change", (), "rad", "its change")
    c_change = p.input("c_change", DIM, "m", "change of the centre")
    axes = _axes(p, ", means over the step")
    theta = p.input("theta", DIM, "rad", "turn of the groove by its Cayley vector")
    P = p.input("P", DIM, "m^2/s", "momentum l u at the start of the step")
    p.stage("directions")
    half = p.define("half", phi_change / 2)
    cos, sin = p.define("cos_half", sp.cos(half)), p.define("sin_half", sp.sin(half))
    n, across = (p.vector(name, v) for name, v in zip(("n", "across"), radial_and_along(p.define("middle", phi + half)),
                                                      strict=True))
    size = p.define("mean_size", R * (alpha + alpha_change / 2))
    p.stage("place and slope in the groove")
    slope = p.vector("y_xi", size * cos * across - R * alpha_change * sin * n / 2)
    slope_change = p.vector("y_xi_change", R * alpha_change * cos * across - 2 * size * sin * n)
    p.stage("place and slope in space")
    moved = p.vector("moved", axes.dot(2 * R * sin * across))
    mean = p.vector("arm", axes.dot(R * cos * n))
    slope = p.vector("t", axes.dot(slope))
    change = p.vector("change", c_change + moved + cross(theta, mean))
    slope_change = p.vector("t_change", axes.dot(slope_change) + cross(theta, slope))
    p.stage("forces")
    forces = at_point(p, "", step, xi, change, slope, slope_change, P)
    on_place, on_slope = p.vector("on_place", forces.on_place), p.vector("on_slope", forces.on_slope)
    turned = p.vector("turned", cross(theta, cross(theta, on_place)) / 4)
    in_groove = p.vector("in_groove", axes.T.dot(on_place - turned))
    slope_in_groove = p.vector("slope_in_groove", axes.T.dot(on_slope))
    p.output("on_c", on_place, "N", "force on the centre")
    p.output("moment", cross(mean + cross(theta, moved) / 4, on_place) + cross(slope, on_slope), "N m",
             "moment on the body about the centre")
    p.output("on_turn", [cos * (R * across.dot(in_groove) - size * n.dot(slope_in_groove))], "N m",
             "moment on the angle of the point")
    p.output("on_alpha", [R * cos * across.dot(slope_in_groove)], "N m", "moment on the angle of the zone")
    p.output("on_s", forces.on_s, "N", "forces on s_a and s_b")
    p.output("P_next", forces.P, "m^2/s", "momentum l u at the end of the step")
    return p


def by_products() -> Program:
    """Return the kernel of the conditions of a tangent point across its chord, by products of its vectors."""
    p = _program("by_products", "conditions of a tangent point by products of its vectors",
                 "Clairaut's relation of geodesics")
    v = p.input("products", len(PRODUCTS) + 1, "m^2, m", f"{', '.join(PRODUCTS)}; b")
    xx, ax, dx, dd, ad, xw, aw, dw, b = v
    square = p.input("weight_square", (), "N^2/m^2", "w.w")
    EA, limit = p.input("EA", (), "N", "axial stiffness"), p.input("limit", (), "N/m", "as in the conditions")
    R = p.input("R", (), "m", "radius to the axis of the rope")
    p.stage("direction of the span")
    length = p.define("length", sp.sqrt(dd))
    inverse = p.define("inv_length", 1 / length)
    T, least = p.define("T", EA * (length / b - 1)), p.define("least", limit * b)
    pull = p.define("pull", sp.sqrt(T * T + least * least))
    bend = p.define("bend", b * p.define("inv_pull", 1 / pull))
    along_square = p.define("along_square", 1 + 2 * bend * dw * inverse + bend * bend * square)
    p.define("inv_along", 1 / along_square)
    rise = p.define("rise", ad * inverse + aw * bend)
    fleet = p.define("cos_fleet", sp.sqrt(1 - rise * rise * sp.Symbol("inv_along")))
    p.define("inv_fleet", 1 / fleet)
    p.stage("conditions")
    size = p.define("size", sp.sqrt(xx))
    p.define("inv_size", 1 / size)
    phi = np.array([ax, p.define("lean", dx * inverse + xw * bend), p.define("arm", size * fleet)])
    p.stage("derivatives")
    J = jacobian(p, phi, list(v))
    p.output("phi", phi - np.array([0, 0, R]), "m", "a . x, u . x, |x| cos f - R")
    p.output("J", J, "1/m, 1", "derivatives by the products and b")
    return p


def chord_step() -> Program:
    """Return the kernel of the shape functions of a chord's end over a step."""
    p = _program("chord_step", "shape functions at the end of a chord over a step",
                 "difference quotients of polynomials")
    xi = p.input("xis", 2, "1", "part of the element at both ends of the step")
    shapes = [sp.sympify(shape) for shape in FlowingElement(ELEMENTS["cable12"]).unit_shapes]
    p.stage("shape functions")
    N = [[sp.horner(shape.subs(along, at), at) for shape in shapes] for at in xi]
    quotient = [sp.horner(sp.cancel((shape.subs(along, xi[1]) - shape.subs(along, xi[0])) / (xi[1] - xi[0])), *xi)
                for shape in shapes]
    p.output("N", np.array(N), "1", "of an element of unit length, at both ends of the step")
    p.output("N_xi", quotient, "1", "their change over that of xi")
    return p


def store_step() -> Program:
    """Return the kernel of the forces of the rope on a drum over a step, but the elastic one; see drum.py, too."""
    p = _program("store_step", "inertial forces and weight of a wound rope in space over a step that conserves energy")
    rho, h = p.input("rho", (), "kg/m", "mass of a length"), p.input("h", (), "s", "step")
    R = p.input("R", (), "m", "radius to the axis of the rope")
    g = p.input("gravity", DIM, "m/s^2", "gravity")
    u = p.input("u", (), "m", "wound length at the start of the step")
    u_change = p.input("u_change", (), "m", "its change")
    own = p.input("own_change", (), "rad", "rotation of the drum on its carrier over the step")
    c = p.input("c", DIM, "m", "centre of the drum at the start of the step")
    c_change = p.input("c_change", DIM, "m", "its change")
    axes = _axes(p, ", means over the step")
    axis = p.input("axis", DIM, "1", "axis, mean over the step")
    theta = p.input("theta", DIM, "rad", "turn of the groove by its Cayley vector")
    V = p.input("V", DIM + DIM, "m/s", "w, t_1, t_2 and the velocity of the centre at the start")
    frame = [axis, axes[:, 0], axes[:, 1]]
    p.stage("velocities at the end")
    u_next, u_mean = p.define("u_next", u + u_change), p.define("u_mean", u + u_change / 2)
    turns = np.array([R * (axis.dot(theta) + own), *(R * unit.dot(theta) for unit in frame[1:])])
    w, v = V[:DIM], V[DIM:]
    w_next = np.array(p.vector("w_next", turns * 2 / h - w))
    v_next = np.array(p.vector("v_next", c_change * 2 / h - v))
    p.stage("forces")
    couple = np.array(p.vector("couple", rho * cross(v, v_next) / 4))
    gain = np.array(p.vector("gain", rho * R * (u_next * w_next - u * w) / h))
    held = p.vector("held", rho * R * (u_next * w_next + u * w) / (2 * h))
    parts = (1, sp.Rational(1, 2), sp.Rational(1, 2))
    gained = sum(part * gain[k] * frame[k] for k, part in enumerate(parts))
    kept = np.array(p.vector("kept", sum(part * held[k] * frame[k] for k, part in enumerate(parts))))
    on_u = -rho * (w[0] * w_next[0] / 2 + w[1:].dot(w_next[1:]) / 4 + v.dot(v_next) / 2
                   + g.dot(c + c_change / 2)) - couple.dot(theta)
    p.output("on_c", rho * (u_next * v_next - u * v) / h - rho * u_mean * g, "N", "force on the centre")
    p.output("moment", gained + cross(theta, kept) + u_change * couple, "N m", "moment on the body about the centre")
    p.output("on_turn", [gain[0]], "N m", "moment on the rotation of the drum on its carrier")
    p.output("on_u", [on_u], "N", "force on the wound length")
    p.output("V_next", [*w_next, *v_next], "m/s", "these velocities at the end")
    return p


def laid_step() -> Program:
    """Return the kernel of the forces of the height at which a rope is laid on a drum over a step."""
    p = _program("laid_step", "weight of a rope as it is laid on a drum in space over a step that conserves energy")
    weight = p.input("laid", (), "kg m", "rho sigma R^2 over the stretch of the wound rope")
    g = p.input("gravity", DIM, "m/s^2", "gravity")
    axes = _axes(p, ", means over the step")
    phi = p.input("angle_at", (), "rad", "angle of the tangent point at the start of the step")
    phi_change = p.input("angle_change", (), "rad", "its change")
    p.stage("directions")
    half = p.define("half", phi_change / 2)
    cos = p.define("cos_half", sp.cos(half))
    n, across = (p.vector(name, axes.dot(v)) for name, v in zip(("n", "across"), radial_and_along(
        p.define("middle", phi + half)), strict=True))
    p.stage("forces")
    p.output("on_turn", [-weight * cos * g.dot(np.array(n))], "N m", "moment on the angle of the tangent point")
    p.output("moment", weight * cos * cross(np.array(across), g), "N m", "moment on the body")
    return p
