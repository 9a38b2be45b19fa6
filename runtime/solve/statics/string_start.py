"""A start of the search for rest: slack cables in the shape of strings (`strings`), for any drawn shape.

From there Newton's method finds the state of rest of the cables, which resist compression, in a few iterations. Without
it forces of slack lines drawn straight were up to 280 times too large.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import reverse_cuthill_mckee

from ...base.quadrature import gauss
from ...model.contacts import ContactModel
from ...model.drag_forces import at_rest, densities
from ...model.drags import DragModel
from ...model.loads import GAUSS_POINTS, DeadLoadModel
from ...model.model import Model
from ...model.unknowns import as_supports_leave
from ...parts.piece import UniformPiece
from .single_string import rest_between
from .static_problem import StaticProblem
from .string_nodes import SmoothTie, StringNodes, rests
from .string_vectors import slopes, vectors_along
from .strings import Rest, Strings, rest_of

SHAPE_ITERATIONS = 3
"""Iterations of the shape where loads depend on it."""
MAX_ELEMENT_TURN = 0.3
"""Turn of a string between adjacent elements, in rad, above which elements have several links."""
MAX_ELEMENT_LINKS = 8
TANGENT_LENGTH = 1e-3
"""Length in m over which the tangent plane replaces a height field."""
MIN_LENGTH_RATIO = 0.95
"""Lower bound of the length of links without tension over their length at rest: bending alone then separates the nodes,
and the shape is a valid start."""
STRAIGHTNESS_TOLERANCE = 1e-9
"""Distance of nodes from a line, and slack of a cable, that count as zero, as a fraction of the length."""


def hang(problem: StaticProblem, every: bool, bending: bool = True) -> bool:
    """Put cables into the shape of strings at rest under the present load; return whether there are any.

    every: from any state, also cables that are drawn bent or taut, or that carry actions unknown to `StringNodes`;
    False: only where the search begins, so that load steps stay on their path, and without such cables, for which the
    drawn shape is as good a start. bending: False: cables alone on two supports as strings without bending stiffness,
    see `single_string`; without such cables none. Cables do not change where a part of their string would
    have no tension and, with every, would become much shorter.
    """
    model = problem.model
    if not model.cables:
        return False
    kept = problem.keep()
    q = kept["q"]
    if not (every or np.array_equal(q, problem.begin)):
        return False
    nodes = problem.string_nodes = problem.string_nodes or StringNodes(model)
    if not bending and not any(nodes.is_alone(group, q) for group in nodes.groups):
        return False
    groups = [group for group in nodes.groups if nodes.can_hang(group) and (every or (
        nodes.acted_on.isdisjoint(group.tolist()) and _is_straight_and_slack(nodes, group, problem.as_drawn)))]
    found = False
    uneven = any(rests(contact) and contact.shape == "terrain" for contact in model.contacts)
    for _ in range(SHAPE_ITERATIONS if groups and (uneven or _depend_on_shape(model)) else 1):
        force = _string_loads(problem, q) if groups else q
        for group in groups:
            line, rest = _known_at_rest(problem, nodes, group, q, force, bending or not nodes.is_alone(group, q))
            if rest is not None and (rest.taut.all() or (every and rest.shortest > MIN_LENGTH_RATIO)):
                q, found = line.set_in(q, rest), True
            elif rest is not None:
                problem.slack |= line.slack(rest)
    if found:
        problem.restore(kept | {"q": q})
    return found


def _known_at_rest(problem: StaticProblem, nodes: StringNodes, group: np.ndarray, q: np.ndarray, force: np.ndarray,
                   bending: bool) -> tuple[_Line, Rest | None]:
    """Return the same as `_at_rest`, which is not repeated for the last configuration and forces of a group."""
    given, key = (q, force), (group.tobytes(), bending)
    last = problem.last_strings.get(key)
    if last is None or not all(map(np.array_equal, last[0], given)):
        last = problem.last_strings[key] = given, _at_rest(problem, nodes, group, q, force,
                                                           rest_of if bending else rest_between)
    return last[1]


def _at_rest(problem: StaticProblem, nodes: StringNodes, group: np.ndarray, q: np.ndarray, force: np.ndarray,
             found: Callable[[Strings], Rest | None]) -> tuple[_Line, Rest | None]:
    """Return cables as strings with one link per element, or more where elements turn far, and their state of rest."""
    line = _Line(problem, nodes, group, q, 1)
    rest = found(line.strings(force))
    if rest is not None and (turn := line.turn(rest)) > MAX_ELEMENT_TURN:
        line = _Line(problem, nodes, group, q, min(int(np.ceil(turn / MAX_ELEMENT_TURN)) + 1, MAX_ELEMENT_LINKS))
        rest = found(line.strings(force))
    return line, rest


def _is_straight_and_slack(nodes: StringNodes, group: np.ndarray, q: np.ndarray) -> bool:
    """Return whether all cables of a group are straight at a configuration, and one of them is slack."""
    slack = False
    for c in group:
        r, length = q[nodes.r[nodes.of(np.array([c]))]], nodes.model.cables[c].mesh.total
        drawn, chord = np.linalg.norm(np.diff(r, axis=0), axis=1).sum(), np.linalg.norm(r[-1] - r[0])
        if drawn > (1 + STRAIGHTNESS_TOLERANCE) * chord:
            return False
        slack |= bool(drawn < (1 - STRAIGHTNESS_TOLERANCE) * length)
    return slack


def _string_loads(problem: StaticProblem, q: np.ndarray) -> np.ndarray:
    """Return (n_dof,): forces on the dofs of cables at a configuration under the present load, in N."""
    model, engine, p = problem.model, problem.engine, problem.fraction
    force = model.gravity * (p if problem.settings.scale_gravity else 1.0)
    for k, load in enumerate(model.loads):
        if isinstance(load, DeadLoadModel):
            scale = 1.0 if load.signal < 0 else float(model.signals[load.signal].value(np.zeros(1))[0])
            force[load.dofs] += p * scale * np.array(load.values)
        else:
            force -= engine.external_forces(k, k + 1)[0]
    for ice in model.ices:
        cable, mass = model.cables[ice.cable], p * float(ice.mass_at(np.zeros(1))[0])
        weights = np.broadcast_to(mass * ice.shares, (ice.n_elements, ice.shares.shape[1]))
        for k, own in enumerate(weights):
            force[cable.dofs_of(ice.first + k)] += np.outer(own, ice.gravity).ravel()
    for drag in model.drags:
        if drag.cable >= 0:
            _add_drag(model, drag, q, p, force)
        elif drag.on_cable:
            _add_drag_at_point(model, drag, q, p, force)
    return force


def _depend_on_shape(model: Model) -> bool:
    """Return whether loads on cables depend on their shape: those of flowing fluids."""
    return any((drag.cable >= 0 or drag.on_cable) and (drag.velocity.any() or drag.degree) for drag in model.drags)


def _add_drag(model: Model, drag: DragModel, q: np.ndarray, p: float, force: np.ndarray) -> None:
    """Add p times the forces of a fluid on a cable at rest, distributed linearly to the nodes of each element."""
    cable = model.cables[drag.cable]
    f = densities(model, drag, np.zeros(1), q[None], np.zeros((1, model.n_dof)))[0][0, ..., : model.dim]
    f = p * f * np.broadcast_to(drag.weights, f.shape[:2])[:, :, None]
    share, at = (1 + gauss(GAUSS_POINTS)[0]) / 2, cable.vectors.index("r")
    own, node = cable.nodal(force), cable.mesh.first_node(np.arange(drag.first, drag.first + drag.n_elements))
    own[node, at] += np.einsum("egd,g->ed", f, 1 - share)
    own[node + 1, at] += np.einsum("egd,g->ed", f, share)


def _add_drag_at_point(model: Model, drag: DragModel, q: np.ndarray, p: float, force: np.ndarray) -> None:
    """Add p times the force of a fluid on a point of a cable at rest."""
    end = drag.attachments[0]
    f = p * at_rest(model, drag, q)
    force[model.cables[end.cable].dofs_of(end.element)] += np.outer(end.N, f).ravel()


class _Line:
    """Cables that ties connect, as strings of `parts` links per element.

    along: of each cable the string nodes from its start to its end; lengths: of its links, in m.
    """

    def __init__(self, problem: StaticProblem, nodes: StringNodes, group: np.ndarray, q: np.ndarray, parts: int):
        self.model, self.nodes, self.group, self.q, self.parts = problem.model, nodes, group, q, parts
        self.surfaces = {part.name: problem.scene.surfaces[part.b].geometry
                         for part in problem.scene.contacts.values() if part.b in problem.scene.surfaces}
        self.drawn = [problem.scene.cables[self.model.cables[c].name] for c in group]
        own = nodes.of(group)
        number = np.full(len(nodes.cable), -1)
        _, number[own] = np.unique(nodes.string_node[own], return_inverse=True)
        self.own, self.at = own, number[own]
        self.n = int(number.max()) + 1
        self.along, self.lengths = [], []
        for c in group:
            elements = self.model.cables[c].n_elements
            along = np.empty(elements * parts + 1, dtype=int)
            inside = np.arange(elements * parts + 1) % parts != 0
            along[~inside] = number[nodes.first[c] + self.model.cables[c].mesh.nodes_of_boundaries]
            along[inside] = np.arange(self.n, self.n + inside.sum())
            self.n += int(inside.sum())
            self.along.append(along)
            self.lengths.append(np.repeat(np.broadcast_to(self.model.cables[c].mesh.lengths, elements) / parts, parts))
        self.ties, self.clamped = nodes.smooth_ties(group), nodes.clamped(group, q)
        self.order = np.arange(self.n)

    def _link(self, node: int) -> int:
        """Return the number of the link of its cable that begins at a cable's node."""
        c = int(self.nodes.cable[node])
        return int(self.model.cables[c].mesh.boundary_of_node[node - int(self.nodes.first[c])]) * self.parts

    def _beside(self, node: int, side: int) -> tuple[int, float] | None:
        """Return the string node next to a cable's node, towards its end (side 1) or start (-1), and the link length.
        """
        k, at = int(np.searchsorted(self.group, self.nodes.cable[node])), self._link(node)
        if not 0 <= at + side < len(self.along[k]):
            return None
        return int(self.along[k][at + side]), float(self.lengths[k][at if side == 1 else at - 1])

    def _number(self, node: int) -> int:
        """Return the number of a cable's node as string node."""
        return int(self.at[np.searchsorted(self.own, node)])

    def strings(self, force: np.ndarray) -> Strings:
        """Return the strings under forces (n_dof,), numbered by `order`."""
        dim = self.model.dim
        r, fixed = np.zeros((self.n, dim)), np.zeros((self.n, dim), dtype=bool)
        r[self.at], fixed[self.at] = self.q[self.nodes.r[self.own]], self.nodes.fixed[self.own]
        load = self._load(force)
        links = np.concatenate([np.stack([each[:-1], each[1:]], axis=1) for each in self.along])
        axial = np.concatenate([np.repeat(part.of_elements(lambda piece: piece.axial_stiffness), self.parts)
                                for part in self.drawn])
        made = Strings(r, fixed, load, links, np.concatenate(self.lengths), axial, *self._bends(),
                       *self._planes(fixed, load))
        if made.width > 2:
            beside = coo_array((np.ones(len(links)), tuple(links.T)), shape=(self.n, self.n)).tocsr()
            self.order = reverse_cuthill_mckee((beside + beside.T).tocsr(), symmetric_mode=True)
            made = made.renumbered(self.order)
        return made

    def _load(self, force: np.ndarray) -> np.ndarray:
        """Return (n, dim): forces on the cables' nodes, distributed over the links of the adjacent elements."""
        load, hat = np.zeros((self.n, self.model.dim)), 1 - np.abs(np.arange(1 - self.parts, self.parts)) / self.parts
        for c, along in zip(self.group, self.along, strict=True):
            mesh, own = self.model.cables[c].mesh, force[self.nodes.r[self.nodes.first[c] : self.nodes.first[c + 1]]]
            if mesh.doubled:
                own = np.stack([np.bincount(mesh.boundary_of_node, column) for column in own.T], axis=1)
            if self.parts > 1:
                given = np.zeros((len(along), own.shape[1]))
                share = np.convolve(np.ones(len(along)), hat, "same")[:: self.parts]
                given[:: self.parts] = own / share[:, None]
                own = np.stack([np.convolve(column, hat, "same") for column in given.T], axis=1)
            np.add.at(load, along, own)
        return load

    def _bends(self) -> tuple[np.ndarray, ...]:
        """Return bends, factors, natural and bending of `Strings`: at inner nodes, smooth ties and clamps."""
        stiffness = {int(c): np.repeat(part.of_elements(_bending_stiffness), self.parts)
                     * (not part.is_curved) for c, part in zip(self.group, self.drawn, strict=True)}
        nodes, sides, bends = [], [], []
        for c, along, length, part in zip(self.group, self.along, self.lengths, self.drawn, strict=True):
            nodes.append(np.stack([along[:-2], along[1:-1], along[2:]], axis=1))
            sides.append(np.stack([length[:-1], length[1:]], axis=1))
            bends.append(np.minimum(stiffness[int(c)][:-1], stiffness[int(c)][1:]))
            bends[-1][self.parts * np.array(part.hinges, dtype=int) - 1] = 0.0
        for tie in self.ties:
            (before, one), (after, other) = self._across(tie)
            nodes.append(np.array([[before, self._number(tie.first), after]]))
            sides.append(np.array([[one, other]]))
            bends.append(np.array([sum(stiffness[int(self.nodes.cable[k])].mean() for k in (tie.first, tie.second))
                                   / 2]))
        length = np.concatenate(sides)
        mean = length.mean(axis=1)
        first, last = 1 / (length[:, 0] * mean), 1 / (length[:, 1] * mean)
        found = [np.concatenate(nodes), np.stack([first, -first - last, last], axis=1),
                 np.zeros((len(mean), self.model.dim)), np.concatenate(bends) * mean]
        for node, tangent in self.clamped.items():
            for side in (1, -1):
                if (beside := self._beside(node, side)) is not None:
                    other, l = beside
                    bending = stiffness[int(self.nodes.cable[node])][self._link(node) - (side == -1)]
                    half = ([[self._number(node), other, other]], [[-2 / l**2, 2 / l**2, 0.0]],
                            [side * 2 / l * tangent], [bending * l / 2])
                    found = [np.concatenate([given, more]) for given, more in zip(found, half, strict=True)]
        return tuple(found)

    def _across(self, tie: SmoothTie) -> tuple[tuple[int, float], tuple[int, float]]:
        """Return the string nodes on both sides of a tie, and their distances from it."""
        found = [self._beside(node, side) for node in (tie.first, tie.second) for side in (1, -1)]
        first, second = (each for each in found if each is not None)
        return first, second

    def _planes(self, fixed: np.ndarray, load: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return resting, normals, heights and compliances of `Strings`."""
        dim = self.model.dim
        found = [(np.zeros(0, dtype=int), np.zeros((0, dim)), np.zeros(0), np.zeros(0))]
        for contact in self.model.contacts:
            if not (rests(contact) and contact.cable in self.group):
                continue
            k = int(np.searchsorted(self.group, contact.cable))
            own = slice(contact.first * self.parts, (contact.first + contact.n_elements) * self.parts)
            share = np.zeros(len(self.along[k]))
            share[own.start : own.stop + 1] = np.convolve(self.lengths[k][own], (0.5, 0.5), "full")
            free = np.logical_not(fixed[self.along[k]].all(axis=1)) & (share > 0)
            at, share = self.along[k][free], share[free]
            normals, heights = self._below(contact, k, free)
            found.append((at, normals, heights + contact.radius, 1 / (share * _stiffness(
                contact, np.abs((load[at] * normals).sum(axis=1)) / share))))
        return tuple(np.concatenate(each) for each in zip(*found, strict=True))

    def _below(self, contact: ContactModel, k: int, free: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return normals (n, dim) and heights (n,) of the planes below free nodes of the k-th cable; for a height field
        those of the tangent planes at the nodes.
        """
        dim, n = self.model.dim, int(np.count_nonzero(free))
        if contact.shape == "flat":
            normal = np.asarray(contact.direction, dtype=float)
            return np.tile(normal, (n, 1)), np.full(n, float(normal @ np.asarray(contact.on[0].u)[:dim]))
        c = self.group[k]
        r = self.q[self.nodes.r[self.nodes.first[c] + self.model.cables[c].mesh.nodes_of_boundaries]]
        steps, nodes = np.arange(len(free)) / self.parts, np.arange(len(r))
        points = np.zeros((n, 3))
        points[:, :dim] = np.stack([np.interp(steps, nodes, column) for column in r.T], axis=1)[free]
        off = TANGENT_LENGTH * np.eye(3)[:dim, None]
        above = self.surfaces[contact.name].distance
        gradient = ((above(points + off) - above(points - off)) / (2 * TANGENT_LENGTH)).T
        size = np.linalg.norm(gradient, axis=1)
        normals = gradient / size[:, None]
        return normals, (normals * points[:, :dim]).sum(axis=1) - above(points) / size

    def turn(self, rest: Rest) -> float:
        """Return about the largest angle in rad between adjacent links of strings at rest."""
        r = self._drawn_order(rest)
        tangents = (np.diff(r[along], axis=0) / length[:, None]
                    for along, length in zip(self.along, self.lengths, strict=True))
        return max((float(np.linalg.norm(np.diff(each, axis=0), axis=1).max(initial=0.0)) for each in tangents),
                   default=0.0)

    def slack(self, rest: Rest) -> dict[str, float]:
        """Return the slack fraction of the length of each cable whose string at rest is slack somewhere."""
        taut = np.split(rest.taut, np.cumsum([len(length) for length in self.lengths])[:-1])
        return {part.name: float(length[~own].sum() / length.sum())
                for part, length, own in zip(self.drawn, self.lengths, taut, strict=True) if not own.all()}

    def _drawn_order(self, rest: Rest) -> np.ndarray:
        r = np.empty_like(rest.r)
        r[self.order] = rest.r
        return r

    def set_in(self, q: np.ndarray, rest: Rest) -> np.ndarray:
        """Return a configuration with these cables along the strings at rest, within supports and ties."""
        r, known = self._drawn_order(rest), dict(self.clamped)
        for tie in self.ties:
            (before, one), (after, other) = self._across(tie)
            at = r[self._number(tie.first)]
            tangent = (at - r[before]) / one**2 + (r[after] - at) / other**2
            tangent = tangent if self._beside(tie.first, 1) is None else -tangent
            known |= {tie.first: tangent, tie.second: tie.sense * tangent}
        found = q.copy()
        for c, along, length in zip(self.group, self.along, self.lengths, strict=True):
            cable, first, last = self.model.cables[c], int(self.nodes.first[c]), int(self.nodes.first[c + 1]) - 1
            slope = slopes(r[along], length, (known.get(first), known.get(last)))[:: self.parts]
            was = cable.nodal(q)
            mesh = cable.mesh
            vectors = vectors_along(cable.vectors, was[mesh.nodes_of_boundaries], r[along[:: self.parts]], slope,
                                    mesh.boundaries, last in self.clamped)
            found[cable.coordinates] = vectors[mesh.boundary_of_node].ravel()
        own = slice(0, self.model.cables[-1].coordinates.stop)
        found[own] = q[own] + as_supports_leave(found[own] - q[own], self.model.unknown_of_dof[own],
                                                self.model.combinations)
        return found


def _bending_stiffness(piece: UniformPiece) -> float:
    """Return the smaller EI of a piece in N m²."""
    return piece.material.youngs_modulus * float(min(piece.section.moments()[1:3]))


def _stiffness(contact: ContactModel, pressure: np.ndarray) -> np.ndarray:
    """Return (n,): stiffness of a contact per length in N/m² under pressures (n,) in N/m; the secant for exponent 1.5.
    """
    if not contact.hertz:
        return np.full(len(pressure), contact.stiffness)
    return np.asarray(contact.stiffness ** (2 / 3) * np.maximum(pressure, np.finfo(float).tiny) ** (1 / 3))
