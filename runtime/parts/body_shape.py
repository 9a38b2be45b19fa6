"""Modes of a body and its inertia integrals, from arrays or a file; body_modes.py computes them of a mesh."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ..base.deferred import dataclass
from ..errors import near
from .data_files import arrays_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms, and for type checkers

ARRAYS = ("nodes", "modes", "masses", "stiffness")
SYMMETRY_TOLERANCE, ORTHOGONALITY_TOLERANCE, DEFINITENESS_TOLERANCE = 1e-9, 1e-6, 1e-10
"""Tolerances of a symmetric, an orthogonal and a positive definite matrix, relative or as a cosine."""


@dataclass(eq=False)  # bodies are compared by their entries
class Shape:
    """n modes of a body in its own axes, on N nodes.

    nodes (N, 3) in m; modes, rotations (n, N, 3): displacement in m and turn in rad of a node by a unit of a mode;
    stiffness (n, n) in N/m; S (n + 1, 3) in kg m, X (n + 1, n + 1, 3, 3) in kg m²: int rho phi_k and
    int rho phi_k phi_l^T, phi_0 the undeformed place (derive/bodies/modal.py); mass in kg.
    """

    nodes: np.ndarray
    modes: np.ndarray
    rotations: np.ndarray
    stiffness: np.ndarray
    mass: float
    S: np.ndarray
    X: np.ndarray

    @property
    def n(self) -> int:
        """Return the number of modes."""
        return len(self.modes)

    @cached_property
    def modal_mass(self) -> np.ndarray:
        """Return (n, n) in kg: M_ff of eq 12."""
        return np.einsum("klii->kl", self.X)[1:, 1:]

    @cached_property
    def vibrations(self) -> tuple[np.ndarray, np.ndarray]:
        """Return squares of angular frequencies (n,) with the frame held, in rad²/s², and shapes by columns (n, n)."""
        from scipy.linalg import eigh  # slow to import

        return eigh(self.stiffness, self.modal_mass)

    def damping(self, ratio: float) -> np.ndarray:
        """Return (n, n) in N s/m: a ratio of critical damping of each vibration with the frame held."""
        squares, V = self.vibrations
        MV = self.modal_mass @ V
        return MV @ np.diag(2 * ratio * np.sqrt(np.maximum(squares, 0))) @ MV.T

    def mass_matrix(self, dim: int) -> np.ndarray:
        """Return (6 + n, 6 + n), in the plane (3 + n, 3 + n): M of eq 12 undeformed, in body axes."""
        S, X = self.S[:, :dim], self.X[:, :, :dim, :dim]
        pairs = [(0, 1)] if dim == 2 else [(1, 2), (2, 0), (0, 1)]
        turns = np.array([_turn(i, j, dim) for i, j in pairs])  # each a matrix B: x moves by B x
        moved = (turns @ S[0]).T
        rigid = np.block([[self.mass * np.eye(dim), moved],
                          [moved.T, np.einsum("tij,uik,jk->tu", turns, turns, X[0, 0])]])
        coupling = np.concatenate([S[1:].T, np.einsum("tij,kij->tk", turns, X[1:, 0])])
        return np.block([[rigid, coupling], [coupling.T, np.einsum("klii->kl", X)[1:, 1:]]])

    def indefinite(self, dim: int) -> str:
        """Return the motions without mass, in words; empty where the mass matrix is positive definite."""
        M = self.mass_matrix(dim)
        names = [*"xyz"[:dim], *(f"the turn about {axis}" for axis in ("z" if dim == 2 else "xyz")),
                 *(f"mode {k + 1}" for k in range(self.n))]
        scale = np.diag(M)
        for name, value in zip(names, scale, strict=True):
            if not value > DEFINITENESS_TOLERANCE**2 * scale.max():
                return f"{name} moves no mass"
        values, vectors = np.linalg.eigh(M / np.sqrt(np.outer(scale, scale)))
        if values[0] > DEFINITENESS_TOLERANCE:
            return ""
        mixed = [name for name, part in zip(names, np.abs(vectors[:, 0]), strict=True) if part > 1e-3]
        return f"{', '.join(mixed)} together move no mass: one follows from the others"


def _turn(i: int, j: int, dim: int) -> np.ndarray:
    spin = np.zeros((dim, dim))
    spin[j, i], spin[i, j] = 1.0, -1.0
    return spin


def of_points(nodes: ArrayLike, modes: ArrayLike, masses: ArrayLike, stiffness: ArrayLike,
              rotations: ArrayLike | None = None, orthogonal: bool = True) -> Shape:
    """Return the shape of mass points: nodes (N, 3), modes (n, N, 3), masses (N,), stiffness (n, n), and rotations
    (n, N, 3) or None.

    Raises ValueError(cause, remedy).
    """
    nodes, modes, masses, stiffness = (np.asarray(a, dtype=float) for a in (nodes, modes, masses, stiffness))
    _has_shape("nodes", nodes, (None, 3))
    _has_shape("modes", modes, (None, len(nodes), 3), "are not from that mesh: ")
    _has_shape("masses", masses, (len(nodes),))
    _has_shape("stiffness", stiffness, (len(modes), len(modes)))
    rotations = np.zeros_like(modes) if rotations is None else np.asarray(rotations, dtype=float)
    _has_shape("rotations", rotations, modes.shape, "are not from that mesh: ")
    for name, array in zip((*ARRAYS, "rotations"), (nodes, modes, masses, stiffness, rotations), strict=True):
        if not np.isfinite(array).all():
            raise ValueError(f"array {name} must be finite")
    if not (len(masses) and masses.min() >= 0 and masses.sum() > 0):
        raise ValueError("array masses must not be negative, and not all zero, got "
                         f"{masses.min(initial=0):.6g} kg at least")
    if np.abs(stiffness - stiffness.T).max(initial=0) > SYMMETRY_TOLERANCE * np.abs(stiffness).max(initial=0):
        i, j = np.unravel_index(np.argmax(np.abs(stiffness - stiffness.T)), stiffness.shape)
        raise ValueError(f"array stiffness must be symmetric, got {stiffness[i, j]:.9g} and {stiffness[j, i]:.9g} N/m "
                         f"for modes {i + 1} and {j + 1}")
    lowest = np.linalg.eigvalsh(stiffness).min(initial=0)
    if lowest < -SYMMETRY_TOLERANCE * np.abs(stiffness).max(initial=0):
        raise ValueError(f"array stiffness must not be negative, got the eigenvalue {lowest:.6g} N/m")
    fields = np.concatenate([nodes[None], modes])
    shape = Shape(nodes, modes, rotations, (stiffness + stiffness.T) / 2, float(masses.sum()),
                  np.einsum("a,kai->ki", masses, fields), np.einsum("a,kai,laj->klij", masses, fields, fields))
    if orthogonal:
        _is_orthogonal(shape.modal_mass)
    return shape


def _has_shape(name: str, array: np.ndarray, expected: tuple[int | None, ...], cause: str = "") -> None:
    if array.ndim != len(expected) or any(e not in (None, n) for e, n in zip(expected, array.shape, strict=False)):
        wanted = ", ".join("any" if e is None else str(e) for e in expected)
        raise ValueError(f"array {name} {cause}must be of shape ({wanted}), got {array.shape}")


def _is_orthogonal(M: np.ndarray) -> None:
    scale = np.sqrt(np.maximum(np.diag(M), np.finfo(float).tiny))
    cosine = np.abs(M / np.outer(scale, scale)) - np.eye(len(M))
    if len(M) > 1 and cosine.max() > ORTHOGONALITY_TOLERANCE:
        i, j = np.unravel_index(np.argmax(cosine), cosine.shape)
        raise ValueError(f"modes {i + 1} and {j + 1} are not orthogonal in the mass: the cosine between them is "
                         f"{cosine[i, j]:.3g}", "mend them, or take orthogonal=False: their full mass matrix is used")


def of_file(path: str, orthogonal: bool) -> Shape:
    """Return the shape in an .npz or a netCDF file, see `ModalBody`. Raises ValueError(cause, remedy)."""
    arrays = arrays_of(path).arrays
    for name in ARRAYS:
        if name not in arrays:
            raise ValueError(f'"{path}" has no array {name}', near(name, arrays) if arrays else "")
    nodes, modes, masses, stiffness = (arrays[name] for name in ARRAYS)
    return of_points(nodes, modes, masses, stiffness, arrays.get("rotations"), orthogonal)
