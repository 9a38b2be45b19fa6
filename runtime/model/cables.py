"""Models of cables: constants of their elements, weight, initial state."""

from __future__ import annotations

from functools import cached_property, lru_cache

import numpy as np

from ..base.rotations import unit
from ..errors import SceneError
from ..kernels.elements import gauge
from ..kernels.libraries import kernels_of
from ..parts.cable import Cable
from ..parts.locations import ends_of
from ..parts.scene_data import SceneData
from .constants import constants
from .model import CableModel, CablePiece
from .unknowns import Reduction, as_supports_leave

MAX_SLOPE_DIFFERENCE = 0.01
"""Relative difference of slopes that a rigid tie unites, above which one of the cables is drawn slack."""
KEPT_CABLES, MAX_KEPT_ELEMENTS = 32, 1000
"""Number of cables whose arrays are kept for equal ones, as those of variants of a scene, and the most elements of one.
"""


class CableArrays:
    """A cable, and the arrays of its model, each made once and read-only."""

    def __init__(self, cable: Cable):
        self.cable = cable
        self._gravity: tuple[bytes, np.ndarray] | None = None

    def model(self, first: int) -> CableModel:
        """Return its model, whose coordinates begin at ``first``, without its growth."""
        cable, mesh = self.cable, self.cable.mesh
        vectors = cable.kind_of_element.nodal_vectors
        pieces = tuple(CablePiece(piece.end, piece.material.damping_time, piece.material.mass_damping,
                                  int(mesh.first_node(piece.first)) - piece.first)
                       for piece in cable.uniform_pieces)
        return CableModel(cable.name, cable.element, cable.kernel_law, mesh, first, pieces, self._mass, self._constants,
                          (mesh.n_nodes, len(vectors), cable.dim), vectors, cable.library, gives_way=cable.gives_way)

    @cached_property
    def _mass(self) -> np.ndarray:
        """Return m of a `CableModel`."""
        cable = self.cable
        mass = getattr(kernels_of(cable.library), f"{cable.element}_mass")
        return _fixed(np.array([mass(length, piece.material.density, piece.section.mass_moments())
                                for piece, lengths in cable.lengths_by_piece() for length in lengths]))

    @cached_property
    def _constants(self) -> np.ndarray:
        """Return A of a `CableModel`."""
        return _fixed(constants(self.cable))

    @cached_property
    def vectors(self) -> np.ndarray:
        """Return (nodes, vectors, 3): its nodal vectors."""
        return _fixed(self.cable.nodal_vectors)

    @cached_property
    def weights(self) -> np.ndarray:
        """Return the displacement of a point by a unit of each nodal vector: 1 for positions, lengths for slopes, those
        of the longer element at the node.
        """
        cable, vectors = self.cable, self.cable.kind_of_element.nodal_vectors
        units = np.array([list(gauge(vectors, length, *np.sqrt(piece.section.moments()[1:3] / piece.section.area)))
                          for piece, lengths in cable.lengths_by_piece() for length in lengths])
        if len(units) == 1:
            return _fixed(np.repeat(np.tile(units[0], cable.mesh.n_nodes), cable.dim))
        longer, mesh = np.zeros((cable.mesh.n_nodes, len(vectors))), cable.mesh
        longer[mesh.first] = units
        longer[mesh.last] = np.maximum(longer[mesh.last], units)
        return _fixed(np.repeat(longer, cable.dim))

    def gravity(self, gravity: np.ndarray) -> np.ndarray:
        """Return (coordinates,): its generalised gravity."""
        along, kept = gravity.tobytes(), self._gravity
        if kept is None or kept[0] != along:
            kept = self._gravity = along, _fixed(cable_gravity(self.cable, gravity))
        return kept[1]


def _fixed(array: np.ndarray) -> np.ndarray:
    """Return an array, read-only."""
    array.flags.writeable = False
    return array


def arrays_of(cable: Cable) -> CableArrays:
    """Return the arrays of a cable, the same ones for equal cables.

    Elements of cables that are curved without stress have large arrays, each its own, which are not kept.
    """
    return (kept_arrays if cable.elements <= MAX_KEPT_ELEMENTS and not cable.is_curved else CableArrays)(cable)


kept_arrays = lru_cache(maxsize=KEPT_CABLES)(CableArrays)


def cable_gravity(cable: Cable, gravity: np.ndarray) -> np.ndarray:
    """Return (coordinates,): generalised gravity of a cable."""
    kernel = getattr(kernels_of(cable.library), f"{cable.element}_gravity")
    vectors = len(cable.kind_of_element.nodal_vectors)
    each = np.array([kernel(length, piece.material.density, piece.section.mass_moments(), gravity).reshape(
                     2, vectors, cable.dim) for piece, lengths in cable.lengths_by_piece() for length in lengths])
    weight = np.zeros((cable.mesh.n_nodes, vectors, cable.dim))
    weight[cable.mesh.first] += each[:, 0]
    weight[cable.mesh.last] += each[:, 1]
    return weight.ravel()


def level_tied_slopes(scene: SceneData, nodal: list[np.ndarray]) -> None:
    """Give slopes that a rigid tie unites the lesser of their lengths where these differ by more than a strain.

    nodal: (nodes, vectors, dim) of each cable as drawn, changed in place. Cables drawn slack by different fractions
    would keep the ratio of their slopes at the tie, and one of them a strain of that size.
    """
    numbers = {name: k for k, name in enumerate(scene.cables)}
    for tie in scene.ties.values():
        if tie.rotation != "rigid":
            continue
        slopes = [nodal[numbers[cable.name]][cable.node(s), cable.kind_of_element.nodal_vectors.index("r_x")]
                  for cable, s in ((scene.cables[tie.cable], tie.s), (scene.cables[tie.to], tie.at))]
        lengths = [float(np.linalg.norm(slope)) for slope in slopes]
        if abs(lengths[0] - lengths[1]) > MAX_SLOPE_DIFFERENCE * max(lengths):
            for slope, length in zip(slopes, lengths, strict=True):
                slope *= min(lengths) / length  # a longer one would turn a short element back on itself


def turn_to_clamps(scene: SceneData, nodal: list[np.ndarray]) -> None:
    """Turn the vectors of clamped nodes, but their positions, to the directions of clamps, the shortest way.

    nodal: (nodes, vectors, dim) of each cable as drawn, changed in place. Raises SceneError.
    """
    for clamp in scene.clamps:
        if clamp.direction is None:
            continue
        cable, along = scene.cables[clamp.cable], unit(np.array(clamp.direction)[: scene.dim])
        names, node = cable.kind_of_element.nodal_vectors, cable.node(clamp.s)
        if any(tie.rotation == "rigid" and (clamp.cable, node) in ends_of(scene, tie) for tie in scene.ties.values()):
            raise SceneError(clamp.where, "has a direction, and a rigid tie joins the node to another cable",
                             'give the tie rotation="free", or draw the cables along the direction')
        own = nodal[list(scene.cables).index(clamp.cable)]
        for each in cable.mesh.at_node(node):
            vectors = own[each]
            tangent, turned = unit(vectors[names.index("r_x")]), np.array([name != "r" for name in names])
            mean = tangent + along
            turn = np.outer(2 * along, tangent) - np.outer(mean, mean) / (1 + tangent @ along)
            vectors[turned] = vectors[turned] @ (np.eye(scene.dim) + turn).T


def cable_rates(scene: SceneData, reduction: Reduction) -> np.ndarray:
    """Return the rates of the cables' nodal vectors at the start, as the supports admit them."""
    asked = np.concatenate([*(cable.nodal_rates[..., : scene.dim].ravel() for cable in scene.cables.values()), []])
    return as_supports_leave(asked, reduction.unknown_of_dof, reduction.combinations)
