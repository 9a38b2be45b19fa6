"""The linear model of motion about the configuration at the start of a run.

Unknowns x of the scene without those of couplings, dofs = T x. The constraints H x = g(t) of joints, linear there,
determine some unknowns by the others, the coordinates y: x = Z y + P g with H Z = 0 and H P = 1. Cables have matrices
over the dofs, joints the stiffness of their forces at the start. All else has exact forces, whose derivatives at the
start, with these matrices, make those over y, of which the steps have factors. Slides, whose constraints move, have no
part in them: each step has their forces as unknowns.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import qr
from scipy.sparse import csc_array, csr_array, dia_array
from scipy.sparse.csgraph import connected_components, reverse_cuthill_mckee
from scipy.sparse.linalg import splu

from ...engine import Engine
from ...errors import SceneError
from ...model.model import Model
from ...parts.end_stops import Stop
from ...parts.scene_data import SceneData
from ...parts.settings import EquilibriumSettings
from ..linear.condensation import condensed
from ..statics.balance import balance_forces
from ..statics.static_problem import StaticState

GROUP = 4
"""Columns that the engine eliminates at once: a band is at least this wide less one."""
CONSTRAINTS = ("joint", "slide")
"""Types of couplings with constraints that the linear model has."""
NEGLIGIBLE = 1e-14
"""Of the largest entry of a matrix: entries below are rounding."""


@dataclass(frozen=True, eq=False)
class LinearModel:
    """Matrices of the linear model, see the module; what the engine's fu_linear_model has.

    n coordinates y, in the order of their band. width: half the bandwidth of their matrices; stride: entries of a row
    of the bands over the dofs. dof (n,): the dof that is each coordinate, -1 for none; mixed (k,): dofs that combine
    several, with the rows combinations (k, n). closing (m, multipliers): unknowns that constraints determine, by these;
    held (m, n_dof): rows of T' of these unknowns; read (n, n_dof): y by the dofs. joints (n, n): stiffness by the
    forces of joints; exact, three of (n, n): derivatives of the exact forces by accelerations, rates and y; bands,
    three of (n, width + 1): columns of the lower triangles of mass, damping and stiffness. weight (n,): displacement of
    a point by a unit of each coordinate, m.
    """

    width: int
    stride: int
    dof: np.ndarray
    mixed: np.ndarray
    combinations: csr_array
    closing: csr_array
    held: csr_array
    read: csr_array
    joints: csr_array
    exact: tuple[csr_array, ...]
    bands: tuple[np.ndarray, ...]
    weight: np.ndarray

    @property
    def n(self) -> int:
        """Return the number of coordinates."""
        return len(self.dof)


def linear_model(scene: SceneData, model: Model) -> LinearModel:
    """Return the linear model about the present configuration of a model. Raises SceneError where there is none."""
    refuse_what_is_not_linear(scene, model)
    static = StaticState(scene, EquilibriumSettings(), model=model)
    balance_forces(static)
    engine, T = static.engine, _dofs_by_unknowns(model)
    stride = -(-(max((c.shape[1] * c.shape[2] * 2 for c in model.cables), default=1) - 1 + GROUP) // GROUP) * GROUP
    cables = [T.T @ _from_half(band) @ T for band in engine.cables_at_rest(stride)]
    total, joints = _matrices(static)
    determined, closing, Z = _basis(*engine.constraint_rows(), T, model.n_multipliers)
    free = np.setdiff1d(np.arange(T.shape[1]), determined)
    pattern = sum(abs(matrix) for matrix in _over(Z, total))
    order = reverse_cuthill_mckee(csr_array(pattern), symmetric_mode=True) if len(free) else np.zeros(0, dtype=int)
    free, Z = free[order], csc_array(Z[:, order])
    full = _over(Z, total)
    own = _over(Z, [total[0] - cables[0], total[1] - cables[1], total[2] - cables[2] - joints])
    width = -(-(1 + max(_bandwidth(matrix) for matrix in full)) // GROUP) * GROUP - 1
    return LinearModel(width, stride, *_split(csr_array(T @ Z)), closing, csr_array(T.T)[determined],
                       csr_array(_read(T)[free]), _over(Z, [joints])[0],
                       tuple(_without_rounding(matrix, like) for matrix, like in zip(own, full, strict=True)),
                       tuple(_lower(matrix, width) for matrix in full),
                       np.asarray((abs(T).T.multiply(model.weight[None, :])).max(axis=1).todense()).ravel()[free])


def _over(Z: csc_array, matrices: Sequence[csr_array]) -> list[csr_array]:
    """Return symmetric matrices over the coordinates."""
    return [_symmetric(Z.T @ matrix @ Z) for matrix in matrices]


def _split(S: csr_array) -> tuple[np.ndarray, np.ndarray, csr_array]:
    """Return the dof that is each coordinate alone, -1 for none, the other dofs that move, and their rows of S."""
    dof = np.full(S.shape[1], -1)
    single = np.flatnonzero((np.diff(S.indptr) == 1) & (np.asarray(S.sum(axis=1)).ravel() == 1.0))
    dof[S[single].indices[::-1]] = single[::-1]  # the first of several
    mixed = np.setdiff1d(np.flatnonzero(np.diff(S.indptr)), dof)
    return dof, mixed, S[mixed]


def refuse_what_is_not_linear(scene: SceneData, model: Model) -> None:
    """Raise SceneError for parts of a scene that the linear model does not have."""
    who, remedy = 'integrator "linear"', "take another integrator"
    for cable in scene.cables.values():
        if cable.grows:
            raise SceneError(cable.where, f"{who} does not support a stress-free length that changes", remedy)
    for fluid in scene.fluids.values():
        if fluid.waves is not None:
            raise SceneError(fluid.where, f"{who} does not support waves", remedy)
    for rope in scene.ropes.values():
        raise SceneError(rope.where, f"{who} does not support ropes that run over sheaves", remedy)
    for slide in scene.slides.values():
        if slide.frame != "point":
            raise SceneError(slide.where, f'{who} does not support the frame "{slide.frame}"',
                             f'take the frame "point", or {remedy}')
        if slide.friction is not None or any(isinstance(end, Stop) for end in (slide.at_start, slide.at_end)):
            raise SceneError(slide.where, f"{who} does not support friction of slides and stops",
                             f"leave them out, or {remedy}")
    for branch in scene.branches.values():
        if branch.limit:
            raise SceneError(branch.where, f"{who} does not support friction between wires",
                             f"leave it out, or {remedy}")
    for curve in scene.working_curves.values():
        raise SceneError(curve.where, f"{who} does not support working curves of ropes", f"leave it out, or {remedy}")
    for ice in scene.ices.values():
        raise SceneError(ice.where, f"{who} does not support ice", f"leave it out, or {remedy}")
    for joint in scene.joints.values():
        if joint.friction is not None:
            raise SceneError(joint.where, f"{who} does not support friction of joints", f"leave it out, or {remedy}")
    for coupling in model.couplings:
        what = f'{coupling.type} "{coupling.name}"'.replace("_", " ")
        if coupling.has_inertia:
            raise SceneError(what, f"{who} does not support added mass", f"leave it out, or {remedy}")
        if coupling.n_multipliers and coupling.type not in CONSTRAINTS:
            raise SceneError(what, f"{who} supports constraints of joints and slides alone", remedy)


def _matrices(static: StaticState) -> tuple[list[csr_array], csr_array]:
    """Return mass, damping and stiffness over the unknowns without slides, and the part by the forces of joints."""
    engine, model = static.engine, static.model
    n = model.n_band + model.n_border_dof
    kept = static.keep()
    without = {kind: np.zeros_like(kept[kind]) for kind in CONSTRAINTS if kind in kept}

    def over_dofs(*weights: float) -> csr_array:
        return csr_array(condensed(engine.matrix(*weights), model)[0])[:n][:, :n]

    static.restore(kept | {kind: forces for kind, forces in without.items() if kind == "slide"})
    stiffness = over_dofs(0.0, 0.0, 1.0)
    damping = over_dofs(0.0, 1.0, 1.0) - stiffness
    mass = csr_array(engine.matrix(1.0, 0.0, 0.0).tocsr()[:n][:, :n])
    static.restore(kept | without)
    joints = stiffness - over_dofs(0.0, 0.0, 1.0)
    static.restore(kept)
    return [mass, csr_array(damping), csr_array(stiffness)], _without_rounding(csr_array(joints), stiffness)


def _dofs_by_unknowns(model: Model) -> csr_array:
    """Return T (n_dof, n_unknowns), dofs = T x + prescribed values."""
    unknown = model.unknown_of_dof
    single, combined = np.flatnonzero(unknown >= 0), np.flatnonzero(unknown < -1)
    row, column, value = model.combinations.entries(-2 - unknown[combined])
    return csr_array((np.concatenate([np.ones(len(single)), value]),
                      (np.concatenate([single, combined[row]]), np.concatenate([unknown[single], column]))),
                     shape=(model.n_dof, model.n_band + model.n_border_dof))


def _read(T: csr_array) -> csr_array:
    """Return (n_unknowns, n_dof): unknowns by dofs, in the least squares where a dof combines several."""
    square = csc_array(T.T @ T)
    return csr_array(splu(square).solve(T.T.toarray())) if _bandwidth(square) else csr_array(
        T.T.multiply(1.0 / square.diagonal()[:, None]))


def _from_half(band: np.ndarray) -> csr_array:
    """Return the symmetric matrix (n, n) whose row i has the upper entries band[i]."""
    n, stride = band.shape
    upper = dia_array((np.stack([np.roll(band[:, k], k) for k in range(stride)]), np.arange(stride)), shape=(n, n))
    upper = upper.tocsr()
    return csr_array(upper + upper.T - dia_array((band[:, :1].T, [0]), shape=(n, n)))


def _basis(multipliers: np.ndarray, dofs: np.ndarray, values: np.ndarray, T: csr_array, n_multipliers: int
           ) -> tuple[np.ndarray, csr_array, csc_array]:
    """Return the unknowns that constraints determine (m,), their part of P (m, multipliers), and Z (unknowns, n).

    Constraints with unknowns in common are solved together, by the unknowns with the largest pivots.
    """
    n = T.shape[1]
    H = csr_array(csr_array((values, (multipliers, dofs)), shape=(n_multipliers, T.shape[0])) @ T)
    rows = np.flatnonzero(np.diff(H.indptr))
    groups, group = connected_components(H[rows] @ H[rows].T) if len(rows) else (0, np.zeros(0, dtype=int))
    determined: list[int] = []
    basis, closing = [], []
    for k in range(groups):
        own = rows[group == k]
        columns = np.unique(H[own].indices)
        block = H[own][:, columns].toarray()
        pivots, inverse = _pivots(block)
        others = np.setdiff1d(np.arange(len(columns)), pivots)
        at = columns[pivots]
        determined += at.tolist()
        basis.append((at, columns[others], -inverse @ block[:, others]))
        closing.append((np.arange(len(determined) - len(at), len(determined)), own, inverse))
    order = np.array(determined, dtype=int)
    free = np.setdiff1d(np.arange(n), order)
    place = np.full(n, -1)
    place[free] = np.arange(len(free))
    row, column, value = _triplets(basis)
    Z = csc_array((np.concatenate([np.ones(len(free)), value]),
                   (np.concatenate([free, row]), np.concatenate([np.arange(len(free)), place[column]]))),
                  shape=(n, len(free)))
    row, column, value = _triplets(closing)
    return order, csr_array((value, (row, column)), shape=(len(order), n_multipliers)), Z


def _pivots(block: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the columns of the largest pivots of a block (m, n), and the inverse of their square block; for redundant
    rows its pseudo-inverse.
    """
    _, upper, order = qr(block, mode="economic", pivoting=True)
    sizes = np.abs(np.diagonal(upper))
    pivots = order[:int(np.count_nonzero(sizes > 1e-10 * sizes.max(initial=0.0)))]
    return pivots, np.linalg.pinv(block[:, pivots])


def _triplets(blocks: list[tuple[np.ndarray, np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return rows, columns and values of dense blocks with the rows and columns given for each."""
    row = [np.repeat(rows, len(columns)) for rows, columns, _ in blocks]
    column = [np.tile(columns, len(rows)) for rows, columns, _ in blocks]
    value = [values.ravel() for *_, values in blocks]
    return (np.concatenate([np.zeros(0, dtype=int), *row]), np.concatenate([np.zeros(0, dtype=int), *column]),
            np.concatenate([np.zeros(0), *value]))


def _symmetric(matrix: csr_array) -> csr_array:
    return csr_array((matrix + matrix.T) / 2)


def _without_rounding(matrix: csr_array, like: csr_array) -> csr_array:
    """Return a matrix without entries that are rounding beside the largest one of another."""
    entries = csr_array(matrix).tocoo()
    kept = np.abs(entries.data) > NEGLIGIBLE * np.max(np.abs(like.data), initial=0.0)
    return csr_array((entries.data[kept], (entries.row[kept], entries.col[kept])), shape=matrix.shape)


def _bandwidth(matrix: csr_array | csc_array) -> int:
    entries = matrix.tocoo()
    return int(np.max(np.abs(entries.row - entries.col), initial=0))


def _lower(matrix: csr_array, width: int) -> np.ndarray:
    """Return (n, width + 1): columns of the lower triangle from the diagonal down."""
    entries = matrix.tocoo()
    band = np.zeros((matrix.shape[0], width + 1))
    below = entries.row >= entries.col
    band[entries.col[below], (entries.row - entries.col)[below]] = entries.data[below]
    return band


def take_linear_model(engine: Engine, scene: SceneData, model: Model) -> None:
    """Give an engine the linear model about the start of its model. Raises SceneError."""
    engine.take_linear_model(linear_model(scene, model))
