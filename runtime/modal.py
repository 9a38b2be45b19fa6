"""Small vibrations about a state: natural frequencies and their shapes, constraints included."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from funicular.equilibrium import Equilibrium
from funicular.errors import SceneError, UnknownResultError, near
from funicular.model import build
from funicular.recording import body_state, spatial
from funicular.redundancy import settle
from funicular.rotations import rotate
from funicular.scene import Scene
from scipy.linalg import eig, eigh, null_space
from scipy.sparse import csc_array
from scipy.sparse.linalg import ArpackNoConvergence, eigsh

DENSE = 600
"""Unknowns up to which all modes are computed at once, by LAPACK."""
ROUNDING = 1e-14
"""Of the highest frequency's square: what rounding leaves of that of a free motion."""
ASYMMETRY = 1e-9
"""Of the stiffness: what rounding leaves; more comes from follower loads and moments."""


@dataclass
class Modes:
    """Natural vibrations, by rising frequency; n modes.

    angular_frequency (n,) in rad/s, 0 where the state is not stable; frequency (n,) in Hz; growth_rate (n,) in 1/s, of
    what grows instead, 0 where it is stable. Shapes by name, largest displacement 1 m: ``modes["wire.nodal_vectors"]``
    (n, node, vector, 3), ``modes["A.displacement"]``, ``modes["A.rotation"]`` (n, 3), about body axes; of a modal body
    these are the frame's, and ``modes["link.nodes"]`` (n, node, 3) what its nodes move by.
    """

    angular_frequency: np.ndarray
    growth_rate: np.ndarray
    shapes: dict[str, np.ndarray]

    @property
    def frequency(self) -> np.ndarray:
        """(n,) in Hz."""
        return self.angular_frequency / (2 * np.pi)

    def __getitem__(self, name: str) -> np.ndarray:
        """A shape by its name. Raises UnknownResultError naming the near ones."""
        if name not in self.shapes:
            raise UnknownResultError(f'no shape "{name}"; {near(name, self.shapes)}')
        return self.shapes[name]

    def __len__(self) -> int:
        return len(self.angular_frequency)


def modes(scene: Scene, n: int, about: Equilibrium | None = None) -> Modes:
    """The n lowest modes about a state, as drawn if none is given; damping is left out. Raises SceneError."""
    from funicular.engine import Engine

    model = build(scene)
    engine = Engine(model)
    settle(model, engine)
    engine.place(0.0, **({} if about is None else about.placed))
    K, constraints = condensed(engine.matrix(0.0, 0.0, 1.0), model)
    size = K.shape[0]
    M = engine.matrix(1.0, 0.0, 0.0)[:size, :size]
    possible = size - constraints.shape[0]
    if n > possible:
        raise SceneError("modes", f"the scene has {possible} degrees of freedom, {n} modes were asked for",
                         "ask for fewer modes, or take more elements")
    squares, vectors = _solve(K, M, constraints, n)
    dofs = np.array([engine.spread(np.append(x, np.zeros(model.n_band + model.n_border_dof + model.n_extra - len(x))))
                     for x in vectors.T])
    return _named(model, np.where(np.abs(squares) < ROUNDING * fastest(K, M), 0.0, squares), dofs)


def fastest(K: csc_array, M: csc_array, unknowns=slice(None)) -> float:
    """rad²/s², about the square of the highest frequency of some unknowns; M may have more after those of K."""
    inertia, stiffness = M.diagonal()[: K.shape[0]][unknowns], K.diagonal()[unknowns]
    heavy = inertia > 0
    return float(np.max(np.abs(stiffness[heavy]) / inertia[heavy], initial=0.0))


def condensed(full: csc_array, model) -> tuple[csc_array, csc_array]:
    """Stiffness over coordinates and free arc-lengths, springs' forces eliminated; the constraints on them."""
    n = model.n_band + model.n_border_dof
    dim = model.dim
    arc = np.array([n + j.unknown for j in model.joints if j.drive < 0], dtype=int)
    held = [n + j.unknown + 1 + d for j in model.joints for d in range(dim)]
    held += [n + link.unknown + r for link in model.links for r in range(link.rows)
             if r not in link.idle]
    springs = np.array([n + s.unknown + d for s in model.springs for d in range(dim)], dtype=int)
    kept = np.concatenate([np.arange(n), arc])
    full = full.tocsr()
    K = full[kept][:, kept]
    if len(springs):  # their rows are F - law(q): F = -C q
        K = K - full[kept][:, springs] @ full[springs][:, kept]
    return K.tocsc(), full[np.array(held, dtype=int)][:, kept].tocsc()


def _solve(K: csc_array, M: csc_array, constraints: csc_array, n: int) -> tuple[np.ndarray, np.ndarray]:
    """The n smallest squares of frequencies of K x = w² M x on constraints x = 0 -> (n,), (coordinates, n)."""
    size = K.shape[0]
    scale = abs(K).max() or 1.0
    symmetric = abs(K - K.T).max() <= ASYMMETRY * scale
    if size <= DENSE or not symmetric:
        free = null_space(constraints.toarray()) if constraints.shape[0] else np.eye(size)
        k, m = free.T @ (K @ free), free.T @ (M @ free)
        if symmetric:
            squares, found = eigh((k + k.T) / 2, (m + m.T) / 2, subset_by_index=(0, n - 1))
        else:
            squares, found = eig(k, m)
            order = np.argsort(squares.real)[:n]
            squares, found = squares[order], found[:, order].real
        return squares, free @ found
    from scipy.sparse import block_array

    rows = constraints.shape[0]
    if rows:
        K = block_array([[K, scale * constraints.T], [scale * constraints, None]], format="csc")
        M = block_array([[M, None], [None, csc_array((rows, rows))]], format="csc")
    heavy = M.diagonal() > 0
    # just below zero: free bodies and slack cables have frequencies of zero, at which K cannot be factored
    shift = -1e-8 * float(np.median(np.abs(K.diagonal())[heavy] / M.diagonal()[heavy]))
    try:
        squares, vectors = eigsh(K, n, M, sigma=shift, v0=M @ np.ones(K.shape[0]))
    except ArpackNoConvergence as error:
        raise SceneError("modes", f"only {len(error.eigenvalues)} of {n} modes converged", "ask for fewer") from None
    order = np.argsort(squares)
    return squares[order], vectors[:size, order]


def _named(model, squares: np.ndarray, dofs: np.ndarray) -> Modes:
    roots = np.sqrt(squares.astype(complex))
    shapes = {}
    modal = [body for body in model.rigids if body.modes]
    for k, mode in enumerate(dofs):
        largest = max([np.abs(mode[list(node.dofs("r"))]).max() for nodes in model.nodes.values() for node in nodes]
                      + [np.abs(mode[b.dof : b.dof + model.dim]).max() for b in model.rigids]
                      + [np.abs(_nodes(model, body, mode[None])).max() for body in modal])
        dofs[k] = mode / (largest or np.abs(mode).max() or 1.0)
    for cable in model.cables:
        vectors = spatial(dofs[:, cable.coordinates].reshape(len(dofs), *cable.shape))
        shapes[f"{cable.name}.nodal_vectors"] = vectors
        shapes[f"{cable.name}.displacement"] = vectors[:, :, cable.vectors.index("r")]
    for body in model.rigids:
        turn = dofs[:, body.dof + model.dim : body.dof + (6 if model.dim == 3 else 3)]
        shapes[f"{body.name}.displacement"] = spatial(dofs[:, body.dof : body.dof + model.dim])
        shapes[f"{body.name}.rotation"] = turn if model.dim == 3 else np.pad(turn, ((0, 0), (2, 0)))
    for body in modal:
        shapes[f"{body.name}.nodes"] = _nodes(model, body, dofs)
    return Modes(np.abs(roots.real), np.abs(roots.imag), shapes)


def _nodes(model, body, dofs: np.ndarray) -> np.ndarray:
    """(n, node, 3): what the nodes of a modal body are moved by."""
    at = body.dof + model.dim
    turn = dofs[:, at : at + 3] if model.dim == 3 else np.pad(dofs[:, at : at + 1], ((0, 0), (2, 0)))
    at += 3 if model.dim == 3 else 1
    fields, orientation = body.shape.fields, body_state(model, body, model.q[None])["orientation"][0]
    strained = np.einsum("tk,kni->tni", dofs[:, at : at + body.modes], fields.modes)
    frame = spatial(dofs[:, None, body.dof : body.dof + model.dim])
    return frame + rotate(orientation, np.cross(turn[:, None], fields.nodes) + strained)
