"""The part of a body or of a cable's section below the surface of a fluid.

Buoyancy has a potential. Below its surface at the height z_s a fluid at rest has the pressure rho g (z_s - z), and a
volume V that it displaces has the energy of that pressure, rho g V R e(u): R is half of the vertical extent of V, u the
depth of its middle over R, and e the mean over V of the depth over R, above the surface nil; where all is below, e = u.
The wet part of V is c = de/du, the force rho g V c, and rho g V c'/R = rho g A_wp the stiffness of the waterplane.

A sphere has the segment pi h^2 (3R - h)/3, h = R (1 + u). A section of a cable is a circle of the radius R, and the
integral along the cable is that of drag. A column has the same section at all heights, so c = (1 + u)/2; at both ends c
is rounded over the part delta of R to either side, as if the surface had waves of that height, and c' is continuous.
Between two surfaces, the fluid's own and that of the fluid below, the wet part is the difference of two.
"""

from __future__ import annotations

import sympy as sp

from ..codegen.program import Program

SOURCE = "Archimedes; potential of the hydrostatic pressure"
DEPTH = "depth of the middle over half of the extent"


def build(name: str, dim: int) -> list[Program]:
    """Return the kernels in space or in the plane, of the family `name`."""
    return [of_sphere(name), of_section(name), of_column(name)]


def _output(p: Program, values: tuple[sp.Expr, ...]) -> Program:
    e, c, c_u, c_uu = values
    p.output("e", e, "1", "mean depth of the wet part, over half of the extent")
    p.output("c", c, "1", "wet part, the derivative of e by u")
    p.output("c_u", c_u, "1", "derivative of c by u")
    p.output("c_uu", c_uu, "1", "derivative of c_u by u")
    return p


def of_sphere(name: str) -> Program:
    """Return the kernel of the wet part of a sphere that the surface cuts, |u| <= 1."""
    p = Program(f"{name}_wet_sphere", "wet part of a sphere", SOURCE)
    u = p.input("u", 1, "1", DEPTH)[0]
    p.stage("segment")
    h = p.define("h", 1 + u)
    c = h**2 * (3 - h) / 4  # pi h^2 (3R - h)/3 over 4 pi R^3/3
    e = sp.integrate(sp.expand(c), h)
    return _output(p, tuple(sp.factor(each) for each in (e, c, sp.diff(c, h), sp.diff(c, h, 2))))


def of_section(name: str) -> Program:
    """Return the kernel of the wet part of a circle that the surface cuts, by the angle phi = asin(u)."""
    p = Program(f"{name}_wet_section", "wet part of a circle", SOURCE)
    phi = p.input("phi", 1, "rad", "angle from the horizontal to the end of the waterline, of the sine u")[0]
    u, root, angle = sp.symbols("u root angle")  # root = cos(phi)
    inverse_pi = sp.Float(sp.N(1 / sp.pi, 17), 17)
    e = angle * u + root * (2 + u**2) / 3

    def by_u(value: sp.Expr) -> sp.Expr:
        """Return the derivative, with d phi = du/root and d root = -u/root du, as a polynomial."""
        over = sp.diff(value, u) * root + sp.diff(value, angle) - sp.diff(value, root) * u
        reduced = sp.expand(over).subs(u**3, u * (1 - root**2)).expand().subs(u**2, 1 - root**2)
        return sp.expand(sp.cancel(reduced / root))

    c = by_u(e)
    p.stage("segment")
    at = {u: p.define("sin_phi", sp.sin(phi)), root: p.define("cos_phi", sp.cos(phi)), angle: phi}
    whole = u / 2, sp.Rational(1, 2), sp.S.Zero, sp.S.Zero
    values = (inverse_pi * each + more for each, more in zip((e, c, by_u(c), by_u(by_u(c))), whole, strict=True))
    return _output(p, tuple(value.subs(at) for value in values))


def of_column(name: str) -> Program:
    """Return the kernel of the wet part of a column at its rounded lower end, |u + 1| <= delta."""
    p = Program(f"{name}_wet_column", "wet part of a column at its lower end", SOURCE)
    u, delta = p.input("u", 1, "1", DEPTH)[0], p.input("delta", 1, "1", "part of half the extent that is rounded")[0]
    e = (1 + u + delta) ** 3 / (24 * delta)
    p.stage("rounded end")
    return _output(p, tuple(sp.diff(e, u, k) for k in range(4)))
