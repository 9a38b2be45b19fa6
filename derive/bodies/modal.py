"""Modal body: a floating frame (bodies/rigid.py, planar_rigid.py) and small deformation by modes in its axes.

p = R + A u,  u = sum_k c_k phi_k,  c_0 = 1 with phi_0 = x the undeformed place, c_k = eta_k with the modes phi_k.
Coordinates: the frame's, and eta (n); velocities R', angular velocity (body axes), eta'. With a0 = A'(R'' - g) the
acceleration of a point, less gravity, in body axes is

    a0 + W u + 2 omega~ u' + u'',   W = omega'~ + omega~ omega~,

linear in the fields u, u', u''. All inertia is in integrals of two families,

    S_k = int rho phi_k,   X_kl = int rho phi_k phi_l',

summed over coefficients before a kernel sees them: into moments of the fields for the body's own six rows (three in the
plane), S, S1, S2 of u, u', u'' and X, X1, X2 = int rho u u^T, u u'^T, u u''^T; and for the row of a mode phi into
s = int rho phi and Y, Y1, Y2 = int rho phi u^T, phi u'^T, phi u''^T.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..algebra.tangent_frame import cross
from ..codegen.program import DirectionalDerivative, Program
from . import planar_rigid, rigid
from .body import Body

FRAMES: dict[str, Body] = {"modal": rigid, "planar_modal": planar_rigid}
SOURCE = "paper eq 12; Shabana, Dynamics of Multibody Systems, 2013, ch. 5"


def skew(omega: np.ndarray) -> np.ndarray:
    """Return omega~, with omega~ u = omega x u; omega has one component in the plane."""
    if len(omega) == 1:
        return np.array([[0, -omega[0]], [omega[0], 0]])
    return np.array([[0, -omega[2], omega[1]], [omega[2], 0, -omega[0]], [-omega[1], omega[0], 0]])


def vector_product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return a x b; in the plane this is its one component."""
    return cross(a, b) if len(a) == 3 else np.array([a[0] * b[1] - a[1] * b[0]])


def axial(M: np.ndarray) -> np.ndarray:
    """Return a x b of M = a b^T, or of a sum of such products."""
    pairs = [(0, 1)] if len(M) == 2 else [(1, 2), (2, 0), (0, 1)]
    return np.array([M[i, j] - M[j, i] for i, j in pairs])


def contraction(a: np.ndarray, b: np.ndarray) -> Any:
    """Return the sum over i, j of a_ij b_ij."""
    return a.ravel().dot(b.ravel())


@dataclass
class Moments:
    """Moments of the fields u, u', u'': first (3 vectors) and with u (3 matrices)."""

    mass: object
    first: list[np.ndarray]
    second: list[np.ndarray]

    @classmethod
    def given(cls, p: Program, dim: int, rates: int = 3) -> Moments:
        """Declare the moments of the fields and of their rates up to an order as inputs and return them."""
        fields = ("u", "u'", "u''")[:rates]
        mass = p.input("mass", (), "kg", "mass")
        first = [p.input(f"S{k or ''}", dim, "kg m", f"int rho {field}") for k, field in enumerate(fields)]
        return cls(mass, first, [p.input(f"X{k or ''}", (dim, dim), "kg m^2", f"int rho u {field}^T")
                                 for k, field in enumerate(fields)])


@dataclass
class ModeMoments:
    """Moments of a mode with the fields u, u', u''."""

    first: np.ndarray
    second: list[np.ndarray]

    @classmethod
    def given(cls, p: Program, dim: int) -> ModeMoments:
        """Declare the moments of a mode as inputs and return them."""
        first = p.input("s", dim, "kg m", "int rho phi of the mode")
        return cls(first, [p.input(f"Y{k or ''}", (dim, dim), "kg m^2", f"int rho phi {field}^T")
                           for k, field in enumerate(("u", "u'", "u''"))])

    def of_body(self, rate: int) -> Moments:
        """Return the change of the body's moments for eta (rate 0) or eta' (rate 1) of the mode larger by one."""
        none, with_u = np.zeros_like(self.first), self.second[0].T
        first, second = [none] * 3, [np.zeros_like(with_u)] * 3
        first[rate], second[rate] = self.first, with_u
        if rate == 0:
            second = [with_u + self.second[0], *self.second[1:]]
        return Moments(0, first, second)


class Motion:
    """Inputs b, w, a, g; stages: the axes, a0, omega~ and W."""

    def __init__(self, p: Program, frame: Body):
        dim = frame.DIM
        self.program, self.frame = p, frame
        self.b, self.w = frame.configuration(p), frame.velocity(p)
        self.a = p.input("a", frame.N_VELOCITY, "m/s^2, rad/s^2", "accelerations R'', omega'")
        g = p.input("g", dim, "m/s^2", "gravity")
        p.stage("acceleration of the frame, less gravity, in its axes")
        self.A = frame.axes(p, self.b)
        self.falling = self.a[:dim] - g
        self.origin = p.vector("a0", self.A.T.dot(self.falling))
        self.spin = skew(self.w[dim:])
        W = skew(self.a[dim:]) + self.spin.dot(self.spin)
        self.W = np.array([p.vector(f"W{i + 1}", row) for i, row in enumerate(W)])

    def by_velocity(self, values: np.ndarray) -> np.ndarray:
        """Return the derivatives of values by w, along a new last axis."""
        return np.stack([DirectionalDerivative(self.program, f"d_w{k}", {symbol: 1}).array(values)
                         for k, symbol in enumerate(self.w)], axis=-1)

    def by_configuration(self, values: np.ndarray) -> np.ndarray:
        """Return the derivatives of values by translation and rotation, along a new last axis."""
        return np.stack([d.array(values) for d in self.frame.tangents(self.program, self.b, self.A)], axis=-1)


def body_force(motion: Motion, of: Moments) -> np.ndarray:
    """Return the rows of the frame: force in global axes in N, moment about the origin in body axes in N m."""
    S, S1, S2 = of.first
    X, X1, X2 = of.second
    force = motion.W.dot(S) + 2 * motion.spin.dot(S1) + S2
    moment = vector_product(S, motion.origin) + axial(X.dot(motion.W.T) + 2 * X1.dot(motion.spin.T) + X2)
    return np.concatenate([of.mass * motion.falling + motion.A.dot(force), moment])


def mode_force(motion: Motion, of: ModeMoments) -> Any:
    """Return the row of a mode, N."""
    Y, Y1, Y2 = of.second
    return (of.first.dot(motion.origin) + contraction(motion.W, Y) + 2 * contraction(motion.spin, Y1) + Y2.trace())
