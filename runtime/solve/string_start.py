"""A start for the search for rest: slack cables in the shape of strings (`strings`), whatever shape they are drawn in.

Newton's method finds the state of rest of the cables themselves, which resist compression, from there in a few
iterations.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import reverse_cuthill_mckee

from ..model.contacts import ContactModel
from ..model.unknowns import as_supports_leave
from .static_problem import StaticProblem
from .string_loads import depend_on_shape, string_loads
from .string_nodes import StringNodes, rests
from .string_vectors import laid_vectors, slopes
from .strings import Rest, Strings, rest_of

ROUNDS = 3
"""Shapes that follow from each other where loads depend on the shape."""
STRAIGHT = 1e-9
"""Of the length: what nodes on a line may be off it, and by what a cable is slack."""


def hang(problem: StaticProblem, every: bool) -> bool:
    """Put cables into the shape of strings at rest under the load that is on; returns whether there are any such.

    every: also cables that are drawn bent or taut, and those that others than supports, planes and loads act on; False:
    none of these, for which the shape as drawn is as good a start, or better. Cables stay as they are where a part of
    their string would have no tension.
    """
    model = problem.model
    if not model.cables:
        return False
    nodes, kept = StringNodes(model), problem.keep()
    q, others = kept["q"], nodes.touched_otherwise()
    groups = [group for group in nodes.groups() if nodes.can_hang(group) and (every or (
        others.isdisjoint(group.tolist()) and _is_straight_and_slack(nodes, group, q)))]
    found = False
    for _ in range(ROUNDS if groups and depend_on_shape(model) else 1):
        force = string_loads(problem, q) if groups else q
        for group in groups:
            line = _Line(problem, nodes, group, q)
            rest = rest_of(line.strings(force))
            if rest is not None and rest.taut.all():
                q, found = line.laid(q, rest), True
    if found:
        problem.restore(kept | {"q": q})
    return found


def _is_straight_and_slack(nodes: StringNodes, group: np.ndarray, q: np.ndarray) -> bool:
    """Return whether all cables of a group are straight at a configuration, and one is shorter than at rest."""
    slack = False
    for c in group:
        r, length = q[nodes.r[nodes.of(np.array([c]))]], nodes.model.cables[c].mesh.total
        drawn, chord = np.linalg.norm(np.diff(r, axis=0), axis=1).sum(), np.linalg.norm(r[-1] - r[0])
        if drawn > (1 + STRAIGHT) * chord:
            return False
        slack |= bool(drawn < (1 - STRAIGHT) * length)
    return slack


class _Line:
    """Cables that ties hold together, as strings: their nodes are numbered anew, tied ones have one number."""

    def __init__(self, problem: StaticProblem, nodes: StringNodes, group: np.ndarray, q: np.ndarray):
        self.model, self.nodes, self.group, self.q = problem.model, nodes, group, q
        self.parts = [problem.scene.cables[self.model.cables[c].name] for c in group]
        self.own = nodes.of(group)
        self.number = np.full(len(nodes.cable), -1)
        _, self.number[self.own] = np.unique(nodes.string_node[self.own], return_inverse=True)
        self.by_cable = [self.number[nodes.first[c] : nodes.first[c + 1]] for c in group]
        self.lengths = [np.broadcast_to(self.model.cables[c].mesh.lengths, self.model.cables[c].n_elements)
                        for c in group]
        self.ties, self.clamped = nodes.smooth_ties(group), nodes.clamped(group, q)
        self.order = np.arange(self.number.max() + 1)

    def strings(self, force: np.ndarray) -> Strings:
        """Return the strings under forces on the dofs, numbered by `order`."""
        n, dim, at = len(self.order), self.model.dim, self.number[self.own]
        r, fixed, load = np.empty((n, dim)), np.empty((n, dim), dtype=bool), np.zeros((n, dim))
        r[at], fixed[at] = self.q[self.nodes.r[self.own]], self.nodes.unknown[self.own] == -1
        np.add.at(load, at, force[self.nodes.r[self.own]])
        links = np.concatenate([np.stack([each[:-1], each[1:]], axis=1) for each in self.by_cable])
        axial = np.concatenate([np.full(len(length), part.material.youngs_modulus * part.section.moments()[0])
                                for part, length in zip(self.parts, self.lengths, strict=True)])
        made = Strings(r, fixed, load, links, np.concatenate(self.lengths), axial, *self._bends(),
                       *self._planes(fixed, load))
        if made.width > 2:
            beside = coo_array((np.ones(len(links)), tuple(links.T)), shape=(n, n)).tocsr()
            self.order = reverse_cuthill_mckee((beside + beside.T).tocsr(), symmetric_mode=True)
            made = made.renumbered(self.order)
        return made

    def _bends(self) -> tuple[np.ndarray, ...]:
        """Return bends, factors, natural and bending of `Strings`: of inner nodes, of smooth ties, and at clamps."""
        nodes, sides, bending = [], [], []
        stiffness = {int(c): part.material.youngs_modulus * min(part.section.moments()[1:3]) * (not part.is_curved)
                     for c, part in zip(self.group, self.parts, strict=True)}
        for c, at, length in zip(self.group, self.by_cable, self.lengths, strict=True):
            nodes.append(np.stack([at[:-2], at[1:-1], at[2:]], axis=1))
            sides.append(np.stack([length[:-1], length[1:]], axis=1))
            bending.append(np.full(len(at) - 2, stiffness[int(c)]))
        for tie in self.ties:
            nodes.append(self.number[[[tie.before, tie.first, tie.after]]])
            sides.append(np.array([tie.lengths]))
            bending.append(np.array([sum(stiffness[int(self.nodes.cable[k])] for k in (tie.first, tie.second)) / 2]))
        length = np.concatenate(sides)
        mean = length.mean(axis=1)
        first, last = 1 / (length[:, 0] * mean), 1 / (length[:, 1] * mean)
        at_clamps = list(self._at_clamps(stiffness))
        dim, k = self.model.dim, len(at_clamps)
        natural = np.concatenate([np.zeros((len(mean), dim)), np.reshape([of[1] for of in at_clamps], (k, dim))])
        of_clamps = [np.reshape([of[part] for of in at_clamps], shape) for part, shape in
                     ((0, (k, 3)), (2, (k, 3)), (3, (k,)))]
        return (np.concatenate([*nodes, of_clamps[0].astype(int)]),
                np.concatenate([np.stack([first, -first - last, last], axis=1), of_clamps[1]]), natural,
                np.concatenate([np.concatenate(bending) * mean, of_clamps[2]]))

    def _at_clamps(self, stiffness: dict[int, float]) -> list[tuple]:
        """Return nodes, natural curvature, factors and stiffness of the half elements beside clamped nodes."""
        found: list[tuple] = []
        for node, along in self.clamped.items():
            c = int(self.nodes.cable[node])
            lengths, k = self.lengths[int(np.searchsorted(self.group, c))], node - int(self.nodes.first[c])
            for side, has in ((1, k < len(lengths)), (-1, k > 0)):
                if has:
                    l = float(lengths[k if side == 1 else k - 1])
                    at, beside = self.number[node], self.number[node + side]
                    found.append(((at, beside, beside), side * 2 / l * along, (-2 / l**2, 2 / l**2, 0.0),
                                  stiffness[c] * l / 2))
        return found

    def _planes(self, fixed: np.ndarray, load: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return resting, normals, heights and compliances of `Strings`."""
        dim, found = self.model.dim, [(np.zeros(0, dtype=int), np.zeros((0, self.model.dim)), np.zeros(0), np.zeros(0))]
        for contact in self.model.contacts:
            if not (rests(contact) and contact.cable in self.group):
                continue
            k = int(np.searchsorted(self.group, contact.cable))
            share = np.convolve(self.lengths[k], (0.5, 0.5), "full")
            free = ~fixed[self.by_cable[k]].all(axis=1)
            at, share = self.by_cable[k][free], share[free]
            normal = np.asarray(contact.direction, dtype=float)
            height = float(normal @ np.asarray(contact.on[0].u)[:dim]) + contact.radius
            found.append((at, np.tile(normal, (len(at), 1)), np.full(len(at), height),
                          1 / (share * _stiffness(contact, np.abs(load[at] @ normal) / share))))
        return tuple(np.concatenate(each) for each in zip(*found, strict=True))

    def laid(self, q: np.ndarray, rest: Rest) -> np.ndarray:
        """Return a configuration with these cables along the strings at rest, as supports and ties leave it."""
        r = np.empty_like(rest.r)
        r[self.order] = rest.r
        known = self.clamped | {node: along for tie in self.ties for node, along in self._along(tie, r).items()}
        found = q.copy()
        for c, at, length in zip(self.group, self.by_cable, self.lengths, strict=True):
            cable, first, last = self.model.cables[c], int(self.nodes.first[c]), int(self.nodes.first[c + 1]) - 1
            slope = slopes(r[at], length, (known.get(first), known.get(last)))
            was = q[cable.coordinates].reshape(cable.shape)
            found[cable.coordinates] = laid_vectors(cable.vectors, was, r[at], slope, cable.mesh.node_s,
                                                    last in self.clamped).ravel()
        own = slice(0, self.model.cables[-1].coordinates.stop)
        found[own] = q[own] + as_supports_leave(found[own] - q[own], self.model.unknown_of_dof[own],
                                                self.model.combinations)
        return found

    def _along(self, tie: object, r: np.ndarray) -> dict[int, np.ndarray]:
        """Return the directions of both cables at a tie."""
        before, at, after = (r[self.number[node]] for node in (tie.before, tie.first, tie.after))
        along = (at - before) / tie.lengths[0] ** 2 + (after - at) / tie.lengths[1] ** 2
        first_runs_to_it = tie.before < tie.first
        along = along if first_runs_to_it else -along
        return {tie.first: along, tie.second: along * tie.sense}


def _stiffness(contact: ContactModel, pressure: np.ndarray) -> np.ndarray:
    """Return (n,): stiffness of a contact a length, N/m², under pressures (n,) in N/m: of exponent 1.5 the secant's."""
    if not contact.hertz:
        return np.full(len(pressure), contact.stiffness)
    return contact.stiffness ** (2 / 3) * np.maximum(pressure, np.finfo(float).tiny) ** (1 / 3)
