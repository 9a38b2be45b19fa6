"""Nodal forces of the elements of cables: elastic, damping and inertia forces less the loads on the element."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import block_array, block_diag, coo_array, csc_array, csr_array, kron, lil_array
from scipy.sparse.linalg import splu

from ...model.joints import JointModel
from ...model.model import CableModel, Model, orders_of, per_grown
from ...model.states import element_coordinates, positions
from ...model.unknowns import by_unknowns
from .about_start import about
from .cable_loads import CableLoads, Instants, PointLoad
from .spreads import Spread


@dataclass
class ElementForces:
    """Forces on the elements of one cable at T instants, each array (T, elements, vectors, dim).

    given: generalised forces of the nodes on each element; inertia: nodal accelerations plus mass damping less gravity,
    so that mass times inertia is the resultant on a length of cable; e: nodal vectors. spreads: inertia of the added
    mass of fluids; masses: that of point masses, as forces on the cable. growth (T, elements): the stress-free length
    over that as drawn.
    """

    given: np.ndarray
    inertia: np.ndarray
    e: np.ndarray
    spreads: list[Spread]
    masses: list[PointLoad]
    growth: np.ndarray


def element_forces(model: Model, at: Instants, loads: CableLoads, cable: int) -> ElementForces:
    """Return the forces of one of the cables of the loads, by its number; at rest without accelerations."""
    forces = {k: internal(model.cables[k], at) - _external(model, k, at, loads) for k in loads.cables}
    accelerations = np.zeros_like(at.v) if at.is_rest else _accelerations(model, at, forces, loads)
    of = model.cables[cable]
    a = element_coordinates(of, accelerations)
    given = forces[cable] + mass_times(of, a)
    spreads: list[Spread] = []
    if cable in loads.added and not at.is_rest:
        spreads = list(loads.added[cable].spreads(a))
    for spread in spreads:
        given[:, spread.element] -= spread.f
    mass_damping = of.of_elements(lambda piece: piece.mass_damping)[:, None, None]
    inertia = a + mass_damping * element_coordinates(of, at.v) - _uniform(of, loads.gravity)
    return ElementForces(given, inertia, element_coordinates(of, at.q), spreads,
                         [loads.of_mass(cable, mass, inertia) for mass in loads.scene.masses_on(of.name)],
                         of.growth_in(at.q))


def internal(cable: CableModel, at: Instants) -> np.ndarray:
    """Return the forces (T, elements, vectors, dim) of elasticity, of Kelvin-Voigt and of mass damping."""
    e, v = element_coordinates(cable, at.q), element_coordinates(cable, at.v)
    moving = cable.tau > 0 and np.any(v)
    start = None
    if at.start is not None:
        vectors = at.start(f"{cable.name}.nodal_vectors")[..., : cable.shape[2]]
        ends = [vectors[:, cable.mesh.first], vectors[:, cable.mesh.last]]
        start = np.broadcast_to(np.concatenate(ends, axis=2), e.shape)

    def forces(length: float | np.ndarray, e: np.ndarray, v: np.ndarray, A: np.ndarray, start: np.ndarray | None,
               tau: float) -> np.ndarray:
        found, = about(lambda e: (cable.law_kernel("elastic_force").rows(len(e), length, e, A),), start, e)
        if moving:
            e = e if start is None else np.ascontiguousarray(start)
            damping = cable.law_kernel("damping_force")
            # its law has the first of these constants only
            of_damping = np.ascontiguousarray(A[..., : damping.shapes["A"][0]])
            found = found + damping.rows(len(e), length, e, v, of_damping, tau)
        return found

    taus = cable.of_elements(lambda piece: piece.tau)
    if cable.growth >= 0:
        g, (taken, rates, begun) = cable.growth_in(at.q), _as_taken(cable, at, e, v, start)
        f = np.stack([forces(g[:, k] * cable.mesh.length(k), taken[:, k], rates[:, k],
                             cable.constants_with(g[:, k], k), None if begun is None else begun[:, k], taus[k])
                      for k in range(cable.n_elements)], axis=1)
        f *= per_grown(cable.vectors, g)
    elif len(cable.A) == 1:
        shape = e.shape
        flat = (-1, *shape[2:])
        f = forces(cable.mesh.mean, e.reshape(flat), v.reshape(flat), cable.A[0],
                   None if start is None else start.reshape(flat), cable.tau).reshape(shape)
    else:  # constants of each element: a curved stress-free shape, or unequal lengths
        f = np.stack([forces(cable.mesh.length(k), e[:, k], v[:, k], A, None if start is None else start[:, k], taus[k])
                      for k, A in enumerate(cable.A)], axis=1)
    if cable.mass_damping > 0:
        f = f + cable.of_elements(lambda piece: piece.mass_damping)[:, None, None] * mass_times(cable, v)
    return f


def mass_times(cable: CableModel, a: np.ndarray) -> np.ndarray:
    """Return (T, elements, vectors, dim): the mass matrices of the elements times vectors of that shape."""
    found: np.ndarray = np.einsum("ekl,teld->tekd", np.broadcast_to(cable.m, (cable.n_elements, *cable.m.shape[1:])), a)
    return found


def _uniform(cable: CableModel, acceleration: np.ndarray) -> np.ndarray:
    """Return the nodal accelerations (vectors, dim) of a uniform field."""
    found: np.ndarray = positions(cable)[:, None] * acceleration
    return found


def _external(model: Model, number: int, at: Instants, loads: CableLoads) -> np.ndarray:
    """Return the forces (T, elements, vectors, dim) of gravity and of all loads between nodes."""
    cable = model.cables[number]
    f = np.zeros((len(at.time), cable.n_elements, 2 * cable.shape[1], cable.shape[2]))
    weight = np.einsum("ekl,ld->ekd", cable.m, _uniform(cable, loads.gravity))
    f += weight[0] if len(weight) == 1 else weight
    instants = np.arange(len(at.time))
    for load in loads.points.get(number, []):
        f[instants, load.element] += load.f
    for spread in loads.spreads.get(number, []):
        f[:, spread.element] += spread.f
    return f


def _accelerations(model: Model, at: Instants, forces: dict[int, np.ndarray], loads: CableLoads) -> np.ndarray:
    """Return the nodal accelerations (T, n_dof) of cables; forces (T, elements, vectors, dim): internal less external.

    M a = -forces on the free coordinates, subject to supports, ties and prescribed motions. Eq 38 gives the same
    accelerations, so that a run need not record them. The added mass of a fluid turns with the cable.
    """
    chosen = np.concatenate([np.arange(model.n_dof)[model.cables[k].coordinates] for k in forces])
    masses, assembled = [], np.zeros((len(at.time), model.n_dof))
    for k, f in forces.items():
        cable = model.cables[k]
        nodal = np.zeros((len(f), *cable.shape))
        nodal[:, cable.mesh.first] += f[:, :, : cable.shape[1]]
        nodal[:, cable.mesh.last] += f[:, :, cable.shape[1] :]
        assembled[:, cable.coordinates] = nodal.reshape(len(f), -1)
        masses.append(_mass(cable))
    M = block_diag(masses, format="csr")
    T = _reduction(model, chosen)
    prescribed = _prescribed(model, at.time)[:, chosen]
    found = np.zeros_like(assembled)
    of_fluid = {k: loads.added[k].matrices() for k in forces if k in loads.added}
    joints = [joint for joint in model.joints if joint.joins_pieces and joint.attachments[0].cable in forces]
    blocks = [slice(t, t + 1) for t in range(len(at.time))] if of_fluid or joints else [slice(None)]
    for block in blocks:
        whole = M if not of_fluid else M + block_diag([_fluid_mass(model.cables[k], of_fluid.get(k), block.start)
                                                       for k in forces], format="csr")
        right = -(assembled[block, chosen] + (whole @ prescribed[block].T).T)
        if joints:
            C, bias = _parallel_tangents(model, joints, at.q[block.start], at.v[block.start])
            C = C[:, chosen]
            left = block_array([[T.T @ whole @ T, (C @ T).T], [C @ T, None]], format="csc")
            given = np.concatenate([T.T @ right[0], bias - C @ prescribed[block.start]])
            found[block.start, chosen] = T @ splu(left).solve(given)[: T.shape[1]]
        elif T.shape[1]:
            solve = splu(csc_array(T.T @ whole @ T)).solve
            found[block, chosen] = (T @ solve(np.ascontiguousarray(T.T @ right.T))).T
    found[:, chosen] += prescribed
    return found


def _parallel_tangents(model: Model, joints: list[JointModel], q: np.ndarray, v: np.ndarray
                       ) -> tuple[csr_array, np.ndarray]:
    """Return C (rows, n_dof), sparse, and b (rows,): joints of pieces give accelerations with C a = b.

    With the tangent i of a slope e, an acceleration of i across the tangent is n . e" / |e| - 2 (i . e')(n . e') / |e|²
    for each unit vector n across it, and equal on both sides.
    """
    C, b = lil_array((len(joints) * (model.dim - 1), model.n_dof)), np.zeros(len(joints) * (model.dim - 1))
    row = 0
    for joint in joints:
        cable = model.cables[joint.attachments[0].cable]
        node = int(cable.mesh.first_node(joint.attachments[1].element))
        at = [model.nodes[cable.name][k].dofs("r_x") for k in (node - 1, node)]
        tangent = q[at[0]] / np.linalg.norm(q[at[0]])
        for normal in np.linalg.svd(tangent[None])[2][1:]:
            for sign, dofs in zip((1.0, -1.0), at, strict=True):
                size = float(np.linalg.norm(q[dofs]))
                C[row, dofs] = sign * normal / size
                b[row] += sign * 2 * float(tangent @ v[dofs]) * float(normal @ v[dofs]) / size**2
            row += 1
    return csr_array(C), b


def _mass(cable: CableModel) -> csr_array:
    """Return the mass matrix of a cable, (coordinates, coordinates), sparse."""
    return kron(_assembled(cable, cable.m, cable.shape[1]), np.eye(cable.shape[2]), format="csr")


def _fluid_mass(cable: CableModel, matrices: np.ndarray | None, instant: int) -> csr_array:
    """Return the added mass of a cable at an instant, from matrices (T, elements, n, n), or None."""
    per_node = cable.shape[1] * cable.shape[2]
    if matrices is None:
        return csr_array((cable.shape[0] * per_node,) * 2)
    return _assembled(cable, matrices[instant], per_node)


def _as_taken(cable: CableModel, at: Instants, e: np.ndarray, v: np.ndarray, start: np.ndarray | None
              ) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """Return vectors e, their rates v, and those at the start, all (T, elements, 2 vectors, dim), of a cable that grows
    as its law takes them, see engine/bodies/growth.c.
    """
    growth = cable.growth_in(at.q)
    factors = per_grown(cable.vectors, growth)
    taken = factors * e
    relative = (np.tile(orders_of(cable.vectors), 2)[:, None] > 0) * taken
    place = cable.vectors.index("r")
    after = place + len(cable.vectors)
    relative[:, :, after] = taken[:, :, after] - taken[:, :, place]
    rates = factors * v - (cable.growth_in(at.v) / growth)[..., None, None] * relative
    return taken, rates, None if start is None else factors * start


def _assembled(cable: CableModel, matrices: np.ndarray, per_node: int) -> csr_array:
    """Return the sum of matrices (1 or elements, 2 per_node, 2 per_node) of the elements, sparse."""
    n = cable.shape[0] * per_node
    index = cable.mesh.first_node(np.arange(cable.n_elements))[:, None, None] * per_node
    local = np.arange(2 * per_node)
    at_row = np.broadcast_to(index + local[:, None], (cable.n_elements, 2 * per_node, 2 * per_node))
    at_column = np.broadcast_to(index + local, at_row.shape)
    found = coo_array((np.broadcast_to(matrices, at_row.shape).ravel(), (at_row.ravel(), at_column.ravel())),
                      shape=(n, n))
    return found.tocsr()


def _reduction(model: Model, dofs: np.ndarray) -> csr_array:
    """Return T (dofs, their unknowns), sparse: dofs = T unknowns + prescribed motion."""
    T = by_unknowns(model.unknown_of_dof[dofs], model.combinations, model.n_band + model.n_border_dof).tocsc()
    return T[:, np.flatnonzero(np.diff(T.indptr))].tocsr()


def _prescribed(model: Model, time: np.ndarray) -> np.ndarray:
    """Return the prescribed accelerations (T, n_dof)."""
    found = np.zeros((len(time), model.n_dof))
    for motion in model.motions:
        f, rate, second = (model.signals[motion.signal].value(time, order) for order in range(3))
        c, s = np.cos(f), np.sin(f)
        slope = motion.linear - motion.cosine * s + motion.sine * c
        found[:, motion.dof] += slope * second - (motion.cosine * c + motion.sine * s) * rate**2
    return found
