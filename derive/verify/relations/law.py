"""Relations of the kernels of laws: eq 5-9."""

from __future__ import annotations

import numpy as np

from ...codegen.family import LawFamily
from ...spec import Element
from ..methods import Relation
from ..references import cable, curved_continuum, section
from ..references import law as reference
from .paths import entry, from_kernel, half, root, unit


def law(family: LawFamily) -> list[Relation]:
    """Return the relations of the kernels of a law, eq 5-9."""
    spec: Element = family.element
    n = spec.n_coordinates

    def energy_of_constants(k, s):
        return k("energy", s, A=k("stiffness", s)["A"])["U"]

    if family.law == family.stiffness_of:
        energy, power = (root(f, spec, family.law) for f in (reference.energy, reference.dissipation))
        sections = [(output, text, root(section.resultant(output), spec, family.law))
                   for output, text in section.TEXTS.items()]
    else:  # the energy and the dissipated power of a user's law define it
        energy, power = from_kernel("energy", "U"), from_kernel("dissipation", "P")
        sections = [(output, "as derived, at 50 digits", from_kernel("section_forces", output))
                   for output in section.TEXTS]
    force_by_both = from_kernel("damping_force", "f", e=entry("e"), v=lambda s, j: s["rate"] * unit(s["v"], j))

    def weighted(k, s, t, j):
        return k("dissipation", s, v=s["v"] + t * unit(s["v"], j), tau=s["weight"])["P"] / 2

    def damped(k, s, t, j):
        return k("damping_force", s, v=s["v"] - s["vdot"], tau=s["weight"])["f"]

    def relaxed_by_vdot(k, s):
        dE = k("algorithmic_force", s, v=s["vdot"])["dE"]
        return k("algorithmic_force", s, relaxed_strain=s["weight"] * dE)["f"]

    stiffness = [
        Relation("stiffness", "A", "the law's constants at 50 digits", 0, from_kernel("stiffness", "A")),
        Relation("stiffness", "A", "energy from A against its integral by quadrature", 0, energy,
                 of=energy_of_constants),
    ]
    every = [
        *(_stiffness_at(spec) if family.traits.kind == "continuum" and family.traits.straight else stiffness),
        Relation("energy", "U", "the law's integral by quadrature", 0, energy),
        Relation("elastic_force", "f", "dU/de", 1, from_kernel("energy", "U", e=entry("e")), n),
        Relation("discrete_force", "f", "U + f . (e_next - e) is U at e_next", 0,
                 lambda k, s, t, j: energy(k, s | {"e": s["e_next"]}, t, j),
                 of=lambda k, s: k("energy", s)["U"] + np.sum(k("discrete_force", s)["f"] * (s["e_next"] - s["e"]))),
        Relation("discrete_force", "f", "dU/de where e_next is e", 1, from_kernel("energy", "U", e=entry("e")), n,
                 of=lambda k, s: k("discrete_force", s, e_next=s["e"])["f"]),
        _step_stiffness(family),
        Relation("elastic_tangent", "K", "df/de", 1, from_kernel("elastic_force", "f", e=entry("e")), n),
        Relation("damping_force", "f", "d(P/2)/dv", 1, half(from_kernel("dissipation", "P", v=entry("v"))), n),
        Relation("damping_tangent", "K", "df/de + rate df/dv", 1, force_by_both, n),
        Relation("dissipation", "P", "the law's integral by quadrature", 0, power),
        Relation("algorithmic_force", "f", "d(weight P/2)/dv where no strain is relaxed", 1, weighted, n,
                 of=lambda k, s: k("algorithmic_force", s, relaxed_strain=0 * s["relaxed_strain"])["f"]),
        Relation("algorithmic_force", "f", "damping force at v - vdot where vdot's strain is relaxed", 0, damped,
                 of=relaxed_by_vdot),
        Relation("algorithmic_force", "dE", "as derived, at 50 digits", 0, from_kernel("algorithmic_force", "dE")),
        *(Relation("section_forces", output, text, 0, path) for output, text, path in sections),
    ]
    return [relation for relation in every if relation.kernel not in family.not_own]


def _step_stiffness(family: LawFamily) -> Relation:
    """Return the relation of step_stiffness: of a quadratic form the derivative of the discrete force with both ends
    moved alike is the tangent half-way with the mean stress; cables take its axial part alone, at unit stretch.
    """
    spec = family.element
    eye = np.eye(spec.dim, dtype=int)

    def tangent(k, s):
        half_way = k("elastic_tangent", s, e=(s["e"] + s["e_next"]) / 2)["K"]
        return half_way + np.kron(k("step_stiffness", s)["k"], eye)

    def force(k, s, t, j):
        motion = t * unit(s["e"], j)
        return k("discrete_force", s, e=s["e"] + motion, e_next=s["e_next"] + motion)["f"]

    if family.traits.kind == "continuum":
        return Relation("step_stiffness", "k", "df/d(both ends), less the tangent half-way", 1, force,
                        spec.n_coordinates, of=tangent)
    return Relation("step_stiffness", "k", "EA/8 of the change's square, by quadrature", 0,
                    root(cable.turning, spec, family.stiffness_of))


def _stiffness_at(spec: Element) -> list[Relation]:
    """Return the relations of a point of the volume, tried by the energy that it adds in many states."""
    def shares(k, s):
        point = k("stiffness_at", s)
        A = s["A"].copy()
        A[-point["A"].size - point["G0"].size :] = [*point["A"], *point["G0"]]
        return [k("energy", s, A=A, e=e)["U"][0] for e in near(s)]

    def densities(k, s, t, j):
        return [curved_continuum.density_at(spec, s | {"e": e}) for e in near(s)]

    def near(s):
        """Return enough states for one quadratic form in their Gram products alone to give these energies."""
        moves = np.random.default_rng(1).normal(size=(450, *s["e"].shape))
        return [s["e"] + move for move in moves]

    return [
        Relation("stiffness_at", "A", "a point's share at 50 digits", 0, from_kernel("stiffness_at", "A")),
        Relation("stiffness_at", "A", "energy that a point adds in 450 states", 0, densities, of=shares),
        Relation("stiffness_at", "G0", "at 50 digits; the energies need it", 0,
                 from_kernel("stiffness_at", "G0")),
    ]
