"""State space of a linear model, and the motion of all coordinates by states and inputs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import block_array, csc_array, csr_array
from scipy.sparse.linalg import splu

from .basis import Basis
from .equations import Equations
from .inputs import Input
from .outputs import Directions

RATE_STEP = 1e-6
"""Share of the velocities of what is prescribed of differences of forces by them."""
NEGLIGIBLE = 1e-12
"""Of the largest force by inputs, below which one by a rate is rounding."""


class Columns:
    """Matrices A and B, and directions of motion.

    With p the input of what is prescribed, or its integral: x = Z y + P p. Of an input that is a position, P has no
    force of inertia on y, Z' M P = 0; forces by p' are taken up by the state w = y' - E p. Of an input that is a
    velocity p' = u, p is a state; where y has names, it keeps their meaning, P has no part in them, and forces of
    inertia by p'' = u' are taken up by w = y' - E u.
    """

    def __init__(self, own: Equations, held: csr_array, basis: Basis, inputs: Sequence[Input], static_part: bool):
        """held: rows that friction holds; static_part: whether to add the static response beyond the modes."""
        self.own, self.held, self.basis, self.inputs = own, held, basis, inputs
        self.messages: list[str] = []
        Z, n, m = basis.Z, len(basis.names), len(inputs)
        self.rates = [k for k, each in enumerate(inputs) if each.is_rate]
        self.residual = np.array([each.residual for each in inputs]).reshape(m, own.static.engine.unknowns).T
        self.c = np.array([each.c for each in inputs]).reshape(m, own.model.n_dof).T
        self.r = own.over_coordinates(self.residual)
        self.inertia, self.drag = self._prescribed()
        self.P = self._particular()
        inverse = np.linalg.inv(basis.mass) if n else np.zeros((0, 0))
        jumps = np.zeros((n, m))
        if basis.rows is None:
            jumps = inverse @ (Z.T @ (own.M @ self.P + self.inertia))
            self.P -= Z @ jumps
            jumps[:] = 0.0
        else:
            self._keep_names(inverse)
            jumps[:, self.rates] = -(inverse @ (Z.T @ (own.M @ self.P + self.inertia)))[:, self.rates]
        k = self.r + own.K @ self.P
        self.f0 = -Z.T @ k
        self.f1 = -Z.T @ (own.D @ self.P + self.drag)
        self.f1[np.abs(self.f1) < NEGLIGIBLE * np.max(np.abs(self.f0), initial=0.0)] = 0.0
        if static_part and m:
            self.P = self.P + self._static_response(k)
        self.E = inverse @ self.f1
        self.E[:, self.rates] = jumps[:, self.rates]
        self._assemble(inverse)

    def _keep_names(self, inverse: np.ndarray) -> None:
        """Let coordinates of joints and slides be those of the whole motion where inputs are velocities, whose jumps
        E takes up; of positions, which would cause a force by their second rate, P has no force of inertia.
        """
        own, Z, rows = self.own, self.basis.Z, self.basis.rows
        assert rows is not None, "of coordinates with names"
        named = rows @ self.P
        by_inertia = inverse @ (Z.T @ (own.M @ self.P + self.inertia))
        by_inertia[:, self.rates] = named[:, self.rates]
        self.P -= Z @ by_inertia

    def _prescribed(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the forces on coordinates by accelerations and by velocities of what is prescribed, (coordinates, m).
        """
        engine, T = self.own.static.engine, self.own.dofs
        inertia, drag = (np.zeros((len(self.own.kept), len(self.inputs))) for _ in range(2))
        kept, still = self.own.static.keep(), np.zeros(self.own.model.n_dof)
        for k in np.flatnonzero(self.c.any(axis=0)):
            forces = []
            c = self.c[:, k]
            for v, a in ((still, c), (still, still), (RATE_STEP * c, still), (-RATE_STEP * c, still)):
                engine.set_rates(v, a)
                forces.append(engine.forces_in_motion())
            inertia[:, k] = T.T @ (forces[0] - forces[1])
            drag[:, k] = T.T @ (forces[2] - forces[3]) / (2 * RATE_STEP)
        self.own.static.restore(kept, prescribe=False)
        return inertia, drag

    def _particular(self) -> np.ndarray:
        """Return P (coordinates, m) with C P = -g of the constraints."""
        own = self.own
        P = np.zeros((len(own.kept), len(self.inputs)))
        moving = [k for k, each in enumerate(self.inputs) if each.moves]
        if not moving:
            return P
        n = own.model.n_band + own.model.n_border_dof
        driven = np.array([n + c.unknown + j for c in own.model.couplings if c.is_driven
                           for j in range(c.n_coordinates)], dtype=int)
        full = own.static.tangent().tocsr()
        rows = np.concatenate([own.forces, driven])
        constraints = full[rows][:, own.kept].toarray()
        g = self.residual[rows][:, moving]
        if self.held.shape[0]:
            constraints = np.concatenate([constraints, self.held.toarray()])
            g = np.concatenate([g, np.zeros((self.held.shape[0], len(moving)))])
        sizes = np.linalg.norm(constraints, axis=1)
        used = sizes > 0
        constraints, g = (each[used] / sizes[used, None] for each in (constraints, g))
        P[:, moving] = np.linalg.lstsq(constraints, -g, rcond=None)[0]
        P[np.abs(P) < 1e-14] = 0.0
        return P

    def _static_response(self, k: np.ndarray) -> np.ndarray:
        """Return the static response (coordinates, m) to the inputs across all modes that are kept."""
        own, Z = self.own, self.basis.Z
        across = csc_array(own.M @ Z)
        whole = block_array([[own.K, own.C.T, across], [own.C, None, None], [across.T, None, None]], format="csc")
        right = np.zeros((whole.shape[0], k.shape[1]))
        right[: k.shape[0]] = -(k - across @ (Z.T @ k))
        try:
            return np.asarray(splu(whole).solve(right)[: k.shape[0]])
        except RuntimeError:
            self.messages.append("the static response beyond the modes is left out: the stiffness has directions "
                                 "without any, beyond the modes that are kept")
            return np.zeros_like(k)

    def _assemble(self, inverse: np.ndarray) -> None:
        """Compute A and B; maps of y, y', y'' by states and inputs, and by the first and second rates of inputs."""
        n, m, basis = len(self.basis.names), len(self.inputs), self.basis
        q = len(self.rates)
        N = 2 * n + q
        f0, f1 = self.f0, self.f1
        A, B = np.zeros((N, N)), np.zeros((N, m))
        A[:n, n : 2 * n] = np.eye(n)
        A[n : 2 * n, :n], A[n : 2 * n, n : 2 * n] = -inverse @ basis.stiffness, -inverse @ basis.damping
        A[n : 2 * n, 2 * n :] = inverse @ f0[:, self.rates]
        direct = f0.copy()
        direct[:, self.rates] = f1[:, self.rates]
        direct -= basis.damping @ self.E
        B[:n], B[n : 2 * n] = self.E, inverse @ direct
        for row, k in enumerate(self.rates):
            B[2 * n + row, k] = 1.0
        self.A, self.B = A + 0.0, B + 0.0

    def directions(self, rates: int) -> Directions:
        """Return the motions by states and inputs (rates 0), or by the first or second rates of inputs."""
        n, m, N = len(self.basis.names), len(self.inputs), self.A.shape[0]
        is_rate = np.array([each.is_rate for each in self.inputs], dtype=bool)
        position = ~is_rate
        y, yd, ydd = (np.zeros((n, N + m)) for _ in range(3))
        p, pd, pdd = (np.zeros((m, N + m)) for _ in range(3))
        if rates == 0:
            y[:, :n] = np.eye(n)
            yd[:, n : 2 * n], yd[:, N:] = np.eye(n), self.E
            ydd[:, :N], ydd[:, N:] = self.A[n : 2 * n], self.B[n : 2 * n]
            for row, k in enumerate(self.rates):
                p[k, 2 * n + row], pd[k, N + k] = 1.0, 1.0
            p[position, N + np.flatnonzero(position)] = 1.0
        elif rates == 1:
            ydd[:, N:] = self.E
            pd[position, N + np.flatnonzero(position)] = 1.0
            pdd[is_rate, N + np.flatnonzero(is_rate)] = 1.0
        else:
            pdd[position, N + np.flatnonzero(position)] = 1.0
        if rates:
            y, yd, ydd, p, pd, pdd = (each[:, N:] for each in (y, yd, ydd, p, pd, pdd))
        return self._directions((y, yd, ydd), (p, pd, pdd))

    def _directions(self, y: tuple[np.ndarray, ...], p: tuple[np.ndarray, ...]) -> Directions:
        own, Z = self.own, self.basis.Z
        x, xd, xdd = (Z @ each + self.P @ of for each, of in zip(y, p, strict=True))
        unknowns = np.zeros((own.static.engine.unknowns, x.shape[1]))
        unknowns[own.kept] = x
        force = own.M @ xdd + self.inertia @ p[2] + own.D @ xd + self.drag @ p[1] + own.K @ x + self.r @ p[0]
        if own.columns.shape[1]:
            columns = own.columns.toarray()
            if self.held.shape[0]:
                columns = np.concatenate([columns, self.held.T.toarray()], axis=1)
            unknowns[own.forces] = _least_squares(columns, -force)[: len(own.forces)]
        laws = self.residual[own.laws] @ p[0] + own.law_stiffness @ x + own.law_damping @ xd
        unknowns[own.laws] = -laws
        moved, rates, accelerations = (own.dofs @ each + self.c @ of for each, of in zip((x, xd, xdd), p, strict=True))
        return Directions(unknowns, self.c @ p[0], moved, rates, accelerations,
                          np.array([x, xd, xdd]))


def _least_squares(columns: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Return the least forces by their columns, each scaled to one."""
    size = np.linalg.norm(columns, axis=0)
    size[size == 0] = 1.0
    return np.asarray(np.linalg.lstsq(columns / size, right, rcond=None)[0] / size[:, None])
