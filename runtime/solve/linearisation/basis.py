"""The basis of the free motions, x = Z y: joint angles and s of slides where they are minimal, else modes.

Modes are those of the symmetric part of the stiffness, with a modal mass of one. Coordinates without inertia follow the
others without delay.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cholesky, null_space, solve_triangular
from scipy.sparse import csc_array

from ...errors import SceneError
from ...parts.scene_data import SceneData
from ..modes.modes import is_symmetric, solve_modes
from .equations import Equations
from .names import Coordinate, of_parts

MAX_CONDITION = 1e7
"""Condition of the named coordinates, scaled, above which they do not determine the motion."""
ROUNDING = 1e-13
"""Of the sum of the absolute terms of an entry below which it is zero."""
MAX_COORDINATES = 1500
"""Coordinates up to which all are states."""
MODE_UNIT = "kg^0.5 m"


@dataclass(frozen=True, eq=False)
class Basis:
    """The basis and the reduced matrices.

    Z (coordinates, n); mass, damping, stiffness (n, n); names, units of coordinates and of their rates; squares: those
    of the frequencies of undamped modes, where these are the coordinates and the stiffness is symmetric, else None;
    rows (n, coordinates): y = rows x, of coordinates with names, else None; said: what the coordinates are.
    """

    Z: np.ndarray
    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    names: list[str]
    units: list[str]
    rates: list[str]
    rate_units: list[str]
    squares: np.ndarray | None
    said: str
    rows: np.ndarray | None = None


def basis_of(equations: Equations, scene: SceneData, sticking: Sequence[str], reduce: int | None, fewer: str) -> Basis:
    """Return the basis of the free motions; sticking: coordinates that are none; reduce: number of modes, None for all.
    Raises SceneError.
    """
    possible = equations.K.shape[0] - equations.C.shape[0]
    if reduce is not None and not 0 < reduce <= possible:
        raise SceneError("linearise", f"the scene has {possible} degrees of freedom, reduce={reduce} were asked for",
                         f"take a number from 1 to {possible}, or leave it out")
    if reduce is None:
        free = [each for each in of_parts(equations, scene) if each.name not in sticking]
        named = _minimal(equations, free, possible)
        if named is not None:
            return named
        if possible > MAX_COORDINATES:
            raise SceneError("linearise", f"the scene has {possible} degrees of freedom; all are states up to "
                             f"{MAX_COORDINATES}", "give reduce, the number of modes, such as reduce=20")
    return _modal(equations, possible if reduce is None else reduce, fewer)


def _minimal(equations: Equations, found: list[Coordinate], possible: int) -> Basis | None:
    """Return the basis of the named coordinates, None unless they are independent and as many as the motions."""
    if len(found) != possible or not possible:
        return None
    free = null_space(equations.C.toarray()) if equations.C.shape[0] else np.eye(equations.K.shape[0])
    J = np.array([each.row for each in found])
    over = J @ free
    sizes = np.linalg.norm(over, axis=1)
    if free.shape[1] != possible or not sizes.all() or np.linalg.cond(over / sizes[:, None]) > MAX_CONDITION:
        return None
    Z = free @ np.linalg.inv(over)
    Z[np.abs(Z) < ROUNDING * np.abs(Z).max(axis=0)] = 0.0
    mass = reduced(Z, equations.M)
    if np.linalg.cond(mass / np.sqrt(np.outer(np.diag(mass), np.diag(mass)))) > 1 / ROUNDING:
        return None
    return Basis(Z, mass, reduced(Z, equations.D), reduced(Z, equations.K), [each.name for each in found],
                 [each.unit for each in found], [each.rate for each in found], [each.rate_unit for each in found], None,
                 "coordinates are those of joints and slides", J)


def reduced(Z: np.ndarray, matrix: csc_array) -> np.ndarray:
    """Return Z' matrix Z without entries that are rounding."""
    found = Z.T @ (matrix @ Z)
    terms = np.abs(Z).T @ (abs(matrix) @ np.abs(Z))
    return np.asarray(np.where(np.abs(found) <= ROUNDING * terms, 0.0, found))


def _modal(equations: Equations, n: int, fewer: str) -> Basis:
    """Return the basis of the n lowest modes."""
    symmetric = is_symmetric(equations.K)
    K = equations.K if symmetric else csc_array((equations.K + equations.K.T) / 2)
    if n:
        squares, vectors, error, _ = solve_modes(K, equations.M, equations.C, n, fewer)
    else:
        squares, vectors, error = np.zeros(0), np.zeros((K.shape[0], 0)), np.zeros(0)
    squares, Z, error = squares[:n], vectors[:, :n], error[:n]
    Z = Z / np.sqrt(np.sum(Z * (equations.M @ Z), axis=0))
    L = cholesky(Z.T @ (equations.M @ Z), lower=True) if n else np.zeros((0, 0))
    Z = solve_triangular(L, Z.T, lower=True).T if n else Z
    squares = np.where(np.abs(squares) <= error, 0.0, squares)
    stiffness = np.diag(squares) if symmetric else reduced(Z, equations.K)
    numbers = range(1, n + 1)
    return Basis(Z, np.eye(n), reduced(Z, equations.D), stiffness, [f"mode_{k}" for k in numbers], [MODE_UNIT] * n,
                 [f"mode_{k}_rate" for k in numbers], [f"{MODE_UNIT}/s"] * n, squares if symmetric else None,
                 "coordinates are modal, with a modal mass of 1 kg and 1 m")
