"""The flexible slider-crank of the IVP test set (Simeon 1996) from the kernels of a planar modal body.

The crank rotates at a constant rate and carries the frame of the rod by its end; the far end slides along x and carries
the slider. The unknowns are the angle of the rod and four modal coordinates: two transverse sines, and the axial
displacements of a quadratic at the middle and at the end.

The published code has 8, 1, 2 for integrals of the axial modes whose values are 8/15, 1/15, 2/15: these modes are 15
times too heavy, and so are they here to meet its numbers. With the correct mass the angle differs by 7e-8 rad and the
slider by 6e-8 m at the end.
"""

from __future__ import annotations

import numpy as np
from funicular import Scene
from funicular.generated import kernels
from scipy.integrate import solve_ivp

CRANK, ROD, SLIDER, SPEED = 0.15, 0.30, 0.075552, 150.0
E, SIDE, DENSITY, J2, PI = 0.2e12, 0.008, 7870.0, 0.0045339259, 3.1415927  # PI as the published code has it
MASS = DENSITY * SIDE**2 * ROD

START = {"q": [0.0, 0.0, 0.0, 0.103339863e-4, 0.169327969e-4],
         "v": [-74.9957670, 0.444896105, 0.463434311e-2, -0.178591076e-5, -0.268938672e-5]}
"""Published: angle of the rod and modal coordinates, and their rates."""
ACCELERATIONS = [-1.344541576008661e-3, -6.833142732779555e-5, 1.449382650173157e-8, -4.268463211410861,
                 2.098334687947376e-1]
"""Published, consistent with them."""
END = {"angle": -0.3311734987910881, "slider": 0.1697373326718410,
       "modes": [1.893192460247178e-4, 2.375751865617931e-5, -5.323907988763734e-6, -8.363283141616840e-6]}
"""At t = 0.1 s."""


class Rod:
    """Integrals of the rod; axial_mass: factor on those of the axial coordinates, 15 as published."""

    def __init__(self, axial_mass: float = 15.0):
        x, weight = np.polynomial.legendre.leggauss(24)
        x, weight = (x + 1) / 2, weight / 2
        zero = np.zeros_like(x)
        fields = np.array([[ROD * x, zero], [zero, np.sin(PI * x)], [zero, np.sin(2 * PI * x)],
                           [4 * x * (1 - x), zero], [x * (2 * x - 1), zero]])
        self.S = MASS * np.einsum("p,kip->ki", weight, fields)
        self.X = MASS * np.einsum("p,kip,ljp->klij", weight, fields, fields)
        self.X[0, 0, 1, 1] += J2 - self.X[0, 0].trace()  # rotary inertia of the section
        self.X[3:, 3:, 0, 0] *= axial_mass
        bending, axial = E * SIDE**2 / ROD * PI**4 * (SIDE / ROD) ** 2, E * SIDE**2 / ROD
        self.stiffness = np.zeros((4, 4))
        self.stiffness[:2, :2] = np.diag([bending / 24, bending * 2 / 3])
        self.stiffness[2:, 2:] = axial / 3 * np.array([[16, -8], [-8, 7]])

    def sums(self, q: np.ndarray, v: np.ndarray) -> dict[str, np.ndarray]:
        """Return moments of u, u' and of each mode with them."""
        c, c1 = np.append(1.0, q[1:]), np.append(0.0, v[1:])
        Y, Y1 = (sum(x * X for x, X in zip(of, self.X.swapaxes(0, 1), strict=True)) for of in (c, c1))
        return {"S": c @ self.S, "S1": c1 @ self.S, "Y": Y, "Y1": Y1,
                **{name: sum(x * y for x, y in zip(c, each, strict=True)) for name, each in (("X", Y), ("X1", Y1))}}

    def accelerations(self, t: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return accelerations of angle and modal coordinates, with the slider on the axis; angle and modes (5,) and
        their rates.
        """
        turn, cosine, sine = SPEED * t, np.cos(q[0]), np.sin(q[0])
        origin = CRANK * np.array([np.cos(turn), np.sin(turn)])
        b, none = np.array([*origin, cosine, sine]), np.zeros((2, 2))
        w = np.array([*SPEED * np.array([-origin[1], origin[0]]), v[0]])
        carried, g = np.array([*-SPEED**2 * origin, 0.0]), np.zeros(2)
        m = self.sums(q, v)
        rest = MASS, m["S"], m["S1"], g, m["X"], m["X1"], none
        force, M = np.empty(5), np.empty((5, 5))
        force[0] = kernels.planar_modal_inertia_force(b, w, carried, g, *rest)[2]
        M[0, 0] = kernels.planar_modal_mass_matrix(b, MASS, m["S"], m["X"])[2, 2]
        for k in range(1, 5):
            mode = b, w, carried, g, self.S[k], m["Y"][k], m["Y1"][k], none
            force[k] = kernels.planar_modal_mode_force(*mode)[0]
            M[0, k] = M[k, 0] = kernels.planar_modal_mode_mass(b, self.S[k], m["Y"][k])[2]
        M[1:, 1:] = np.einsum("klii->kl", self.X)[1:, 1:]
        force[1:] += self.stiffness @ q[1:]
        # the end, p = origin + A (ROD + q4, 0): slider's inertia along x, held along y
        reach, rate = ROD + q[4], v[4]
        P = np.zeros((2, 5))
        P[:, 0], P[:, 4] = reach * np.array([-sine, cosine]), [cosine, sine]
        bias = -SPEED**2 * origin - reach * v[0] ** 2 * P[:, 4] + 2 * v[0] * rate * np.array([-sine, cosine])
        M += SLIDER * np.outer(P[0], P[0])
        force += SLIDER * P[0] * bias[0]
        system = np.block([[M, P[1][:, None]], [P[1][None], np.zeros((1, 1))]])
        return np.linalg.solve(system, -np.append(force, bias[1]))[:5]

    def run(self, duration: float = 0.1, tol: float = 1e-11, start=START) -> dict[str, np.ndarray]:
        """Return angle, slider and modes at the end, from the published start; velocities are projected on the
        constraint.
        """
        q, v = np.array(start["q"]), np.array(start["v"])
        v[0] = -CRANK * SPEED / (ROD + q[4])
        found = solve_ivp(lambda t, y: np.concatenate([y[5:], self.accelerations(t, y[:5], y[5:])]), (0, duration),
                          np.concatenate([q, v]), method="DOP853", rtol=tol, atol=tol * 1e-4)
        end = found.y[:, -1]
        place = CRANK * np.exp(1j * SPEED * duration) + (ROD + end[4]) * np.exp(1j * end[0])
        return {"angle": end[0], "slider": place.real, "off": place.imag, "modes": end[1:5]}


def arrays(axial_mass: float = 15.0) -> dict[str, np.ndarray]:
    """Return the rod in a user's form: four points around each of several stations, massless start and end.

    The additional mass of the axial modes is in separate pairs of points at the start, which these modes alone move, so
    that only their own inertia has it. The crank carries the start.
    """
    rod, (x, weight) = Rod(axial_mass), np.polynomial.legendre.leggauss(24)
    x, weight = (x + 1) / 2, weight / 2
    r = SIDE / np.sqrt(12)
    off = r * np.array([(1, 1), (1, -1), (-1, 1), (-1, -1)])
    n = 4 * len(x)
    nodes, modes = np.zeros((n + 2, 3)), np.zeros((4, n + 2, 3))
    at = np.repeat(x, 4)
    nodes[:n] = np.column_stack([ROD * at, np.tile(off, (len(x), 1))])
    nodes[n + 1, 0] = ROD
    modes[0, :n, 1], modes[1, :n, 1] = np.sin(PI * at), np.sin(2 * PI * at)
    modes[2, :n, 0], modes[3, :n, 0] = 4 * at * (1 - at), at * (2 * at - 1)
    modes[3, n + 1, 0] = 1.0
    masses = np.append(np.repeat(MASS * weight / 4, 4), [0.0, 0.0])
    for sign in (1, -1) if axial_mass > 1 else ():
        apart = modes[:, :n] * (np.arange(4) > 1)[:, None, None] * sign
        nodes, modes = np.concatenate([nodes, np.zeros((n, 3))]), np.concatenate([modes, apart], axis=1)
        masses = np.append(masses, (axial_mass - 1) / 2 * masses[:n])
    return {"nodes": nodes, "modes": modes, "masses": masses, "stiffness": rod.stiffness}


def machine(folder, axial_mass: float = 15.0) -> Scene:
    """Return crank, rod and slider in space, held without redundant equations."""
    np.savez(folder / "rod.npz", **arrays(axial_mass))
    scene = Scene(gravity=(0, 0, 0))
    scene.rigid_body("crank", mass=0.36, inertia=(0.002727,) * 3, position=(0, 0, 0), angular_velocity=(0, 0, SPEED))
    scene.modal_body("rod", data=folder / "rod.npz", orthogonal=False, position=(CRANK, 0, 0),
                     velocity=(0, CRANK * SPEED, 0), angular_velocity=(0, 0, -CRANK * SPEED / ROD))
    scene.rigid_body("slider", mass=SLIDER, inertia=(1e-4,) * 3, position=(CRANK + ROD, 0, 0))
    scene.joint("revolute", (0, 0, 0), "crank", axis=(0, 0, 1), velocity=SPEED, name="shaft")
    scene.joint("spherical", ("crank", (CRANK, 0, 0)), ("rod", (0, 0, 0)), name="crank_pin")
    scene.joint("cylindrical", ("rod", (ROD, 0, 0)), "slider", axis=(0, 0, 1), name="piston_pin")
    scene.joint("prismatic", (CRANK + ROD, 0, 0), "slider", axis=(1, 0, 0), name="cylinder")
    return scene
