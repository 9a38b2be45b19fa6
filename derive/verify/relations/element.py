"""What every output of every kernel is the derivative of: by role of the family, for any element and any rider."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...spec import Element, Family
from ..methods import Relation
from ..motion import RIDERS, cross, exponential, spin, turned
from ..references import curved as verify_curved
from ..references import element as reference
from ..references import laws as verify_laws
from ..references import sections as verify_sections


def relations(family: Family) -> list[Relation]:
    """The relations of a family's kernels."""
    from .joint import frame_relations, joint_relations, resistance_relations
    from .modal import modal
    from .slide import slide
    from .spring import relations as spring

    table: dict[str, Callable[[Family], list[Relation]]] = {
        "element": element, "law": law, "slide": slide, "body": body, "modal": modal,
        "frame": frame_relations, "joint": joint_relations, "resistance": resistance_relations, "spring": spring}
    return table[family.role](family)


def unit(like: np.ndarray, j: int) -> np.ndarray:
    """Zeros with a one at entry j."""
    zeros = np.zeros(like.size, dtype=int)
    zeros[j] = 1
    return zeros.reshape(like.shape)


def from_kernel(kernel: str, output: str, **directions: Callable) -> Callable:
    """A path: the output of a kernel with some inputs moved by t times directions[name](state, j)."""
    def path(k, s, t, j):
        return k(kernel, s, **{name: s[name] + t * d(s, j) for name, d in directions.items()})[output]
    return path


def entry(name: str) -> Callable:
    """Direction: entry j of an input."""
    return lambda s, j: unit(s[name], j)


def root(function: Callable, *about) -> Callable:
    """A path of order 0: function(*about, state), which shares nothing with the derivation."""
    return lambda k, s, t, j: function(*about, s)


def element(family: Family) -> list[Relation]:
    """eq 2-4, and loads."""
    from .load import loads

    spec: Element = family.element

    def shape(s):
        return reference.Shape(spec, s["l"].item())(s["at"])

    return [
        Relation("mass", "m", "∫ ρ N N' dV by quadrature", 0, root(reference.mass, spec)),
        Relation("gravity", "Q", "∫ ρ N g dV by quadrature", 0, root(reference.gravity, spec)),
        Relation("inertia_force", "f", "(m ⊗ I) a", 0, root(lambda s: np.asarray(s["m"]).dot(s["a"]))),
        Relation("position", "N", "nodal conditions solved at 50 digits", 0, root(shape)),
        Relation("position", "r", "Σ N d", 0, root(lambda s: shape(s).dot(s["e"]))),
        *loads(spec),
    ]


def law(family: Family) -> list[Relation]:
    """eq 5-9."""
    spec: Element = family.element
    n = spec.n_coordinates

    def energy_of_constants(k, s):
        return k("energy", s, A=k("stiffness", s)["A"])["U"]

    if family.law == family.like:
        energy, power = (root(f, spec, family.law) for f in (verify_laws.energy, verify_laws.dissipation))
        section = [(output, text, root(verify_sections.resultant(output), spec, family.law))
                   for output, text in verify_sections.TEXTS.items()]
    else:  # a law of the user's is what its energy and its dissipated power say
        energy, power = from_kernel("energy", "U"), from_kernel("dissipation", "P")
        section = [(output, "as derived, at 50 digits", from_kernel("section_forces", output))
                   for output in verify_sections.TEXTS]
    force_by_both = from_kernel("damping_force", "f", e=entry("e"), v=lambda s, j: s["rate"] * unit(s["v"], j))

    def weighted(k, s, t, j):
        return k("dissipation", s, v=s["v"] + t * unit(s["v"], j), tau=s["weight"])["P"] / 2

    def damped(k, s, t, j):
        return k("damping_force", s, v=s["v"] - s["vdot"], tau=s["weight"])["f"]

    def known_of_vdot(k, s):
        dE = k("algorithmic_force", s, v=s["vdot"])["dE"]
        return k("algorithmic_force", s, known=s["weight"] * dE)["f"]

    stiffness = [
        Relation("stiffness", "A", "the law's constants at 50 digits", 0, from_kernel("stiffness", "A")),
        Relation("stiffness", "A", "energy from A against its integral by quadrature", 0, energy,
                 of=energy_of_constants),
    ]
    every = [
        *(_stiffness_at(spec) if family.law == "continuum_curved" else stiffness),
        Relation("energy", "U", "the law's integral by quadrature", 0, energy),
        Relation("elastic_force", "f", "dU/de", 1, from_kernel("energy", "U", e=entry("e")), n),
        Relation("discrete_force", "f", "U + f . (e_next - e) is U at e_next", 0,
                 lambda k, s, t, j: energy(k, s | {"e": s["e_next"]}, t, j),
                 of=lambda k, s: k("energy", s)["U"] + np.sum(k("discrete_force", s)["f"] * (s["e_next"] - s["e"]))),
        Relation("discrete_force", "f", "dU/de where e_next is e", 1, from_kernel("energy", "U", e=entry("e")), n,
                 of=lambda k, s: k("discrete_force", s, e_next=s["e"])["f"]),
        _step_stiffness(family),
        Relation("elastic_tangent", "K", "df/de", 1, from_kernel("elastic_force", "f", e=entry("e")), n),
        Relation("damping_force", "f", "d(P/2)/dv", 1, _half(from_kernel("dissipation", "P", v=entry("v"))), n),
        Relation("damping_tangent", "K", "df/de + rate df/dv", 1, force_by_both, n),
        Relation("dissipation", "P", "the law's integral by quadrature", 0, power),
        Relation("algorithmic_force", "f", "d(weight P/2)/dv where nothing is known", 1, weighted, n,
                 of=lambda k, s: k("algorithmic_force", s, known=0 * s["known"])["f"]),
        Relation("algorithmic_force", "f", "damping force at v - vdot where vdot's strain is known", 0, damped,
                 of=known_of_vdot),
        Relation("algorithmic_force", "dE", "as derived, at 50 digits", 0, from_kernel("algorithmic_force", "dE")),
        *(Relation("section_forces", output, text, 0, path) for output, text, path in section),
    ]
    return [relation for relation in every if relation.kernel not in family.elsewhere]


def _step_stiffness(family: Family) -> Relation:
    """Of a quadratic form the derivative of the discrete force with both ends moved alike is the tangent half-way with
    the mean stress; cables take its axial part alone, at unit stretch.
    """
    spec = family.element
    eye = np.eye(spec.dim, dtype=int)

    def tangent(k, s):
        half_way = k("elastic_tangent", s, e=(s["e"] + s["e_next"]) / 2)["K"]
        return half_way + np.kron(k("step_stiffness", s)["k"], eye)

    def force(k, s, t, j):
        motion = t * unit(s["e"], j)
        return k("discrete_force", s, e=s["e"] + motion, e_next=s["e_next"] + motion)["f"]

    if family.law.startswith("continuum"):
        return Relation("step_stiffness", "k", "df/d(both ends), less the tangent half-way", 1, force,
                        spec.n_coordinates, of=tangent)
    return Relation("step_stiffness", "k", "EA/8 of the change's square, by quadrature", 0,
                    root(verify_laws.cable_turning, spec, family.like))


def _stiffness_at(spec: Element) -> list[Relation]:
    """A point of the volume, tried by the energy that it adds in many states."""
    def shares(k, s):
        point = k("stiffness_at", s)
        A = s["A"].copy()
        A[-point["A"].size - point["G0"].size :] = [*point["A"], *point["G0"]]
        return [k("energy", s, A=A, e=e)["U"][0] for e in near(s)]

    def densities(k, s, t, j):
        return [verify_curved.density_at(spec, s | {"e": e}) for e in near(s)]

    def near(s):
        """So many that no other quadratic form in their Gram products gives these energies."""
        moves = np.random.default_rng(1).normal(size=(450, *s["e"].shape))
        return [s["e"] + move for move in moves]

    return [
        Relation("stiffness_at", "A", "a point's share at 50 digits", 0, from_kernel("stiffness_at", "A")),
        Relation("stiffness_at", "A", "energy that a point adds in 450 states", 0, densities, of=shares),
        Relation("stiffness_at", "G0", "at 50 digits; the energies need it", 0,
                 from_kernel("stiffness_at", "G0")),
    ]


def _half(path: Callable) -> Callable:
    return lambda k, s, t, j: path(k, s, t, j) / 2


def body(family: Family) -> list[Relation]:
    """A body: points along finite motions, and Newton-Euler from momentum."""
    rider = RIDERS[family.rider]
    n, dim = rider.n_velocity, rider.dim

    def point(k, s, motion):
        return rider.point(rider.moved(k, s["b"], motion), s["u"])

    def by_coordinate(k, s, t, j):
        return point(k, s, t * unit(s["w"], j))

    def force_of_point(k, s, t, j):
        out = k("point_force", s, b=rider.moved(k, s["b"], t * unit(s["w"], j)))
        return out["p_q"].T.dot(s["f"])

    def momentum(k, s, t, j):
        """In the axes of t = 0: mass velocity, A J omega about the axes of rotation."""
        velocity = s["w"] + t * s["a"]
        turn = exponential(k, t * spin(s["w"], dim))
        return np.concatenate([s["mass"] * velocity[:dim],
                               turned(turn, s["J"].dot(spin(velocity, dim)))[dim - n:]])

    def kinetic_energy(k, s, t, j):
        """Of point masses with the same inertia: J = sum m (p.p I - p p')."""
        spread = (s["J"].trace() / 2) * np.eye(3, dtype=int) - s["J"]
        return sum(s["mass"] * s["w"][i] ** 2 for i in range(dim)) / 2 + _spinning(spread, spin(s["w"], dim))

    from .joint import body_frame_relations
    from .moves import loads, moves

    at = Relation("point", "p", "R + A u by quaternions or complex numbers", 0,
                  lambda k, s, t, j: rider.point(s["b"], s["u"]))
    p_q = Relation("point", "p_q", "dp by translation and rotation about body axes", 1, by_coordinate, n)
    return [
        at,
        p_q,
        Relation("point", "v", "dp/dt", 1, lambda k, s, t, j: point(k, s, t * s["w"])),
        Relation("point", "bias", "d²p/dt² at constant velocities", 2, lambda k, s, t, j: point(k, s, t * s["w"])),
        replace(at, kernel="point_force"),
        replace(p_q, kernel="point_force"),
        *body_frame_relations(rider),
        Relation("point_force", "K", "d(p_q' f) by translation and rotation", 1, force_of_point, n),
        Relation("discrete_point", "P", "P step is p_next - p", 0,
                 lambda k, s, t, j: rider.point(s["b_next"], s["u"]) - rider.point(s["b"], s["u"]),
                 of=lambda k, s: k("discrete_point", s)["P"].dot(rider.step(s["b"], s["b_next"]))),
        Relation("discrete_point", "P", "dp by translation and rotation where b_next is b", 1, by_coordinate, n,
                 of=lambda k, s: k("discrete_point", s, b_next=s["b"])["P"]),
        Relation("inertia_force", "f", "rate of momentum", 1, momentum),
        Relation("inertia_tangent", "M", "df/da", 1, from_kernel("inertia_force", "f", a=entry("a")), n),
        Relation("inertia_tangent", "D", "df/dw", 1, from_kernel("inertia_force", "f", w=entry("w")), n),
        Relation("kinetic_energy", "T", "Σ ½ m v² of point masses", 0, kinetic_energy),
        *loads(rider),
        *moves(rider),
    ]


def _spinning(spread: np.ndarray, omega: np.ndarray):
    """Kinetic energy of rotation, from S = sum m p p': each column p of a root of S moves with omega x p."""
    columns = np.stack([cross(omega, c) for c in spread.T], axis=1)  # omega~ S, and T = -1/2 tr(omega~ omega~ S)
    return -sum(cross(omega, columns[:, i])[i] for i in range(3)) / 2


