"""Relations of the kernels of spans: motions of the nodal vectors and of both ends, the law's own kernels."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from ...codegen.family import ElementFamily
from ...couplings.material_step import gauss
from ...couplings.span_step import POINTS
from ...laws.kernels import Kernels
from ...spec import Element
from ..exact import ExactProgram
from ..methods import Relation
from ..numbers import Numbers, State
from ..references import element as of_element
from ..references import law as of_law
from ..references import span as reference
from .paths import entry, from_kernel, half, root, unit

ENDS = 2


def span(family: ElementFamily) -> list[Relation]:
    """Return the relations of a span's kernels."""
    return [*_of_points(family.element), *_of_inertia(family.element), *_of_weight(family.element),
            *_of_elasticity(family), *_of_damping(family), *_of_line_force(family.element),
            *_of_stored_force(family.element), *_of_kinetic_force(family.element),
            *_of_momentum(family.element), *_of_elastic_step(family.element)]


def moved(s: State, t: Any) -> State:
    """Return the element at the time t of a motion with the state's rates and accelerations."""
    return {"e": s["e"] + t * s["v"], "l": s["l"] + t * (s["s_rate"][1] - s["s_rate"][0]),
            "v": s["v"] + t * s["a"], "s_rate": s["s_rate"] + t * s["s_acc"]}


def by_rate(path: Callable[..., Any], n: int) -> Callable[..., Any]:
    """Return the path of path(k, state) along the rates of e (n of them) and of the ends."""
    def along(k, s, t, j):
        name, at = ("v", j) if j < n else ("s_rate", j - n)
        return path(k, s | {name: s[name] + t * unit(s[name], at)})
    return along


def by_configuration(path: Callable[..., Any], n: int) -> Callable[..., Any]:
    """Return the path of path(k, state) along e (n entries) and l."""
    def along(k, s, t, j):
        return path(k, s | ({"e": s["e"] + t * unit(s["e"], j)} if j < n else {"l": s["l"] + t}))
    return along


def both(kernel: str) -> Callable[..., Any]:
    """Return the function of a state that is the forces of a kernel on e and the ends."""
    def forces(k, s):
        found = k(kernel, s)
        return np.concatenate([found["f"].ravel(), found["f_s"]])
    return forces


def _of_points(spec: Element) -> list[Relation]:
    def drifting(k, s, t, j):
        now = moved(s, t)
        return k("point", s, e=now["e"], l=now["l"], xi=(s["xi"] * s["l"] - t * s["s_rate"][0]) / now["l"])["r"]

    return [Relation("point", "r", "Σ N d at 50 digits", 0,
                     root(lambda s: reference.place(spec, s, s["xi"].item(), 0))),
            Relation("point", "r_S", "dr/dS", 1, lambda k, s, t, j: k("point", s, xi=s["xi"] + t / s["l"])["r"]),
            Relation("point", "velocity", "dr/dt of a point that stays in the material", 1, drifting)]


def _of_inertia(spec: Element) -> list[Relation]:
    n = spec.n_coordinates

    def energy(k, s, **changes):
        return k("kinetic_energy", s, **changes)["T"]

    def momentum(k: Numbers, s: State, j: int) -> Any:
        """Return dT by a rate: the difference over a unit is exact, as T is quadratic in the rates."""
        name, at = ("v", j) if j < n else ("s_rate", j - n)
        step = unit(s[name], at)
        return (energy(k, s, **{name: s[name] + step}) - energy(k, s, **{name: s[name] - step})) / 2

    def lagrange(k, s, t, j):
        if j < n:
            displaced = {"e": s["e"] + t * unit(s["e"], j)}
        else:
            displaced = {"l": s["l"] + t * (2 * (j - n) - 1)}
        return momentum(k, s | moved(s, t), j) - energy(k, s, **displaced)

    def on_ends(k, s, t, j):
        return lagrange(k, s, t, n + j)

    def power(k, s):
        found = k("inertia", s)
        return np.sum(found["f"] * s["v"]) + found["f_s"].dot(s["s_rate"])

    def of_material(value: Callable[[Any, Any], Any]) -> Callable[..., Any]:
        """Return the path along the motion of rho times the integral of value(r, velocity)."""
        def path(k, s, t, j):
            now = s | moved(s, t)
            total = 0
            for x, weight in of_element.gauss(spec.n_vectors + 1):
                xi, part = k.array(np.array([(1 + x) / 2, weight / 2], dtype=object))
                point = k("point", now, xi=xi)
                total = total + part * value(point["r"], point["velocity"])
            return s["rho"] * now["l"] * total
        return path

    def net_force(k, s):
        positions = np.array(spec.is_position, dtype=int)
        return positions.dot(k("inertia", s)["f"])

    def at_rest(k, s):
        return energy(k, s, s_rate=0 * s["s_rate"])

    def of_mass(s):
        return np.sum(s["v"] * of_element.mass(spec, s).dot(s["v"])) / 2

    return [
        Relation("kinetic_energy", "T", "rho/2 ∫ |dr/dt|² dS by quadrature over the material", 0,
                 root(reference.kinetic_energy, spec)),
        Relation("kinetic_energy", "T", "v' (m ⊗ I) v/2 where the ends are at rest", 0, root(of_mass), of=at_rest),
        Relation("inertia", "f", "d/dt dT/dv - dT/de", 1, lagrange, n),
        Relation("inertia", "f_s", "d/dt dT/ds' - dT/ds", 1, on_ends, ENDS),
        Relation("inertia", "f", "net force: rate of the momentum of the material", 1,
                 of_material(lambda r, velocity: velocity), of=net_force),
        Relation("inertia", "f", "power: dT/dt", 1, lambda k, s, t, j: energy(k, s, **moved(s, t)), of=power),
        *_of_inertia_tangent(spec)]


def _of_inertia_tangent(spec: Element) -> list[Relation]:
    n = spec.n_coordinates
    every = n + ENDS

    def by_acceleration(k, s, t, j):
        name, at = ("a", j) if j < n else ("s_acc", j - n)
        return both("inertia")(k, s | {name: s[name] + t * unit(s[name], at)})

    def mass_block(k, s):
        return k("mass_matrix", s)["M"][:n, :n]

    return [
        Relation("mass_matrix", "M", "df by accelerations", 1, by_acceleration, every),
        Relation("mass_matrix", "M", "m ⊗ I over e", 0,
                 root(lambda s: np.kron(of_element.mass(spec, s), np.eye(spec.dim, dtype=int))), of=mass_block),
        Relation("inertia_tangent", "D", "df by rates", 1, by_rate(both("inertia"), n), every),
        Relation("inertia_tangent", "K", "df by e and l", 1, by_configuration(both("inertia"), n), n + 1)]


def _of_weight(spec: Element) -> list[Relation]:
    return [Relation("weight", "V", "-rho ∫ g . r dS by quadrature over the material", 0,
                     root(reference.gravity, spec)),
            *_of_energy("weight", "V", "weight", spec.n_coordinates),
            Relation("weight", "K_l", "df/dl", 1, _by_length("weight", "f")),
            Relation("weight", "K_ll", "df_l/dl", 1, _by_length("weight", "f_l"))]


def _of_energy(kernel: str, output: str, force: str, n: int) -> list[Relation]:
    """Return the relations of the first derivatives of an energy."""
    return [Relation(force, "f", f"d{output}/de", 1, from_kernel(kernel, output, e=entry("e")), n),
            Relation(force, "f_l", f"d{output}/dl", 1, _by_length(kernel, output))]


def _by_length(kernel: str, output: str) -> Callable[..., Any]:
    return from_kernel(kernel, output, l=lambda s, j: 1)


def _of_elasticity(family: ElementFamily) -> list[Relation]:
    spec, law = family.element, family.law
    assert law is not None
    n = spec.n_coordinates

    def own(kernel: str, output: str) -> Callable[..., Any]:
        """Return the output of the kernel of the element's own law."""
        return root(lambda s: _law_kernel(spec, law, kernel)([s["l"], s["e"], s["A"]])[output])

    return [
        Relation("energy", "U", "the law's integral by quadrature", 0, root(of_law.energy, spec, law)),
        Relation("energy", "U", "the element's own law", 0, own("energy", "U")),
        *_of_energy("energy", "U", "elastic_force", n),
        Relation("elastic_force", "f", "the element's own law", 0, own("elastic_force", "f")),
        Relation("elastic_tangent", "K", "df/de", 1, from_kernel("elastic_force", "f", e=entry("e")), n),
        Relation("elastic_tangent", "K_l", "df/dl", 1, _by_length("elastic_force", "f")),
        Relation("elastic_tangent", "K_l", "df_l/de", 1, from_kernel("elastic_force", "f_l", e=entry("e")), n),
        Relation("elastic_tangent", "K_ll", "df_l/dl", 1, _by_length("elastic_force", "f_l"))]


@cache
def _law_kernel(spec: Element, law: str, kernel: str) -> ExactProgram:
    return ExactProgram(getattr(Kernels(spec, law), kernel)().prune())


def _of_damping(family: ElementFamily) -> list[Relation]:
    spec, n = family.element, family.element.n_coordinates

    def power(k, s):
        return k("dissipation", s)["P"]

    def work(k, s):
        found = k("damping_force", s)
        return np.sum(found["f"] * s["v"]) + found["f_s"].dot(s["s_rate"])

    along_rates = half(by_rate(power, n))
    return [
        Relation("dissipation", "P", "the law's integral by quadrature, rates at material points", 0,
                 root(reference.dissipation, spec, family.law)),
        Relation("damping_force", "f", "d(P/2)/dv", 1, along_rates, n),
        Relation("damping_force", "f_s", "d(P/2)/ds'", 1, lambda k, s, t, j: along_rates(k, s, t, n + j), ENDS),
        Relation("damping_force", "f", "power P", 0, lambda k, s, t, j: power(k, s), of=work),
        Relation("damping_tangent", "D", "df by rates", 1, by_rate(both("damping_force"), n), n + ENDS),
        Relation("damping_tangent", "K", "df by e and l", 1, by_configuration(both("damping_force"), n), n + 1)]


def _of_line_force(spec: Element) -> list[Relation]:
    n = spec.n_coordinates

    def work(k, s, t, j):
        """Return F times the displacement of a material point by a coordinate: the ends move past it."""
        weight = s["part"] * s["l"]
        if j < n:
            now = {"e": s["e"] + t * unit(s["e"], j)}
        else:
            sign = 2 * (j - n) - 1
            l = s["l"] + sign * t
            now = {"l": l, "xi": (s["xi"] * s["l"] - (t if j == n else 0)) / l}
        return weight * s["F"].dot(k("point", s, **now)["r"])

    def acting(k, s):
        """Return the force of the state at another one, by its derivatives."""
        now, then = k("point", s), k("point", s["first"])
        changes = [s[name].dot(now[output] - then[output])
                   for name, output in (("F_r", "r"), ("F_t", "r_S"), ("F_v", "velocity"))]
        return both("line_force")(k, s | {"F": s["F"] + sum(changes)})

    def of_point(output: str) -> Callable[..., Any]:
        return lambda k, s: k("point", s)[output]

    def moved_end(k, s, t, j):
        return k("share", s, ends=s["ends"] + t * unit(s["ends"], j))["share"]

    return [
        Relation("line_force", "f", "F . dr/de at a point that stays in the material", 1, work, n),
        Relation("line_force", "f_s", "F . dr/ds at a point that stays in the material", 1,
                 lambda k, s, t, j: work(k, s, t, n + j), ENDS),
        Relation("line_force_tangent", "D", "df by rates", 1, _from_state(by_rate(acting, n)), n + ENDS),
        Relation("line_force_tangent", "K", "df by e and l", 1, _from_state(by_configuration(acting, n)), n + 1),
        Relation("point_tangent", "r_q", "dr by e and l", 1, by_configuration(of_point("r"), n), n + 1),
        Relation("point_tangent", "v_q", "dv by e and l", 1, by_configuration(of_point("velocity"), n), n + 1),
        Relation("point_tangent", "v_v", "dv by rates", 1, by_rate(of_point("velocity"), n), n + ENDS),
        Relation("share", "share", "(S - s1)/(s2 - s1)", 0,
                 root(lambda s: np.array([(s["at"].item() - s["ends"][0]) / (s["ends"][1] - s["ends"][0])]))),
        Relation("share", "share_s", "d share/ds", 1, moved_end, ENDS)]


def _from_state(path: Callable[..., Any]) -> Callable[..., Any]:
    """Return a path whose state knows the one where it begins, as "first"."""
    return lambda k, s, t, j: path(k, s | {"first": s}, t, j)


def _of_stored_force(spec: Element) -> list[Relation]:
    n = spec.n_coordinates

    def stored(k, s):
        """Return the energy at a state, from that of the first one by its derivatives."""
        change = k("point", s)["r"] - k("point", s["first"])["r"]
        return s["part"] * s["l"] * (s["u"] - s["F"].dot(change) - change.dot(s["H"].dot(change)) / 2)

    def released(k, s):
        change = k("point", s)["r"] - k("point", s["first"])["r"]
        u = s["u"] - s["F"].dot(change) - change.dot(s["H"].dot(change)) / 2
        return k("stored_force", s, F=s["F"] + s["H"].dot(change), u=u)

    def negative(path):
        return lambda k, s, t, j: -path(k, s, t, j)

    by_stored = negative(_from_state(by_configuration(stored, n)))
    of_stored = {output: _from_state(by_configuration(lambda k, s, output=output: released(k, s)[output], n))
                 for output in ("f", "f_l")}

    def by_last(path):
        return lambda k, s, t, j: path(k, s, t, n)

    return [
        Relation("stored_force", "f", "-dU/de", 1, by_stored, n),
        Relation("stored_force", "f_l", "-dU/dl", 1, by_last(by_stored)),
        Relation("stored_force_tangent", "K", "df/de", 1, of_stored["f"], n),
        Relation("stored_force_tangent", "K_l", "df/dl", 1, by_last(of_stored["f"])),
        Relation("stored_force_tangent", "K_l", "df_l/de", 1, of_stored["f_l"], n),
        Relation("stored_force_tangent", "K_ll", "df_l/dl", 1, by_last(of_stored["f_l"]))]


def _of_kinetic_force(spec: Element) -> list[Relation]:
    n, dim = spec.n_coordinates, spec.dim
    of_motion = ("r", "r_S", "velocity"), ("slope_rate", "place_rate", "velocity_rate")

    def along(output: str) -> Callable[..., Any]:
        return lambda k, s, t, j: k("point", s | moved(s, t))[output]

    def at_point(output: str) -> Callable[..., Any]:
        return lambda k, s, t, j: k("point", s)[output]

    def changes(k, s):
        """Return the changes of place, slope and velocity since the first state, and of their rates."""
        now, then = k("motion", s), k("motion", s["first"])
        return [np.concatenate([now[name] - then[name] for name in names]) for names in of_motion]

    def energy(k, s):
        """Return the energy of the length, quadratic about the first state."""
        gradient, (z, _) = np.concatenate([s[f"T_{key}"] for key in "rtv"]), changes(k, s)
        return s["part"] * s["l"] * (s["T"] + gradient.dot(z) + z.dot(s["second"].dot(z)) / 2)

    def by_coordinate(k, s, t, j):
        """Return minus the energy, displaced by a coordinate."""
        step = {"e": s["e"] + t * unit(s["e"], j)} if j < n else {"l": s["l"] + t * (2 * (j - n) - 1)}
        return -energy(k, s | step | {"first": s})

    def by_rate_of(k, s, j):
        """Return the derivative of the velocity by a rate: the difference over a unit, as it is linear."""
        name, at = ("v", j) if j < n else ("s_rate", j - n)
        return k("point", s, **{name: s[name] + unit(s[name], at)})["velocity"] - k("point", s)["velocity"]

    def lagrange(k, s, t, j):
        """Return d/dt of that derivative times l T_v, whose rate is l `rate`, plus minus the energy."""
        now = s | moved(s, t)
        momentum = s["part"] * (s["l"] * s["T_v"] + t * s["l"] * s["rate"])
        return by_rate_of(k, now, j).dot(momentum) + by_coordinate(k, s, t, j)

    def acting(k, s):
        """Return the forces at a state by the derivatives at the first one."""
        z, rates = changes(k, s)
        growth = [each["s_rate"].dot(np.array([-1, 1])) / each["l"] for each in (s, s["first"])]
        gradient = np.concatenate([s[f"T_{key}"] for key in "rtv"]) + s["second"].dot(z)
        rate = s["rate"] + s["rate_by"].dot(np.concatenate([z, rates])) + s["T_v"] * (growth[0] - growth[1])
        energy_of_length = energy(k, s) / (s["part"] * s["l"])
        parts = {f"T_{key}": gradient[i * dim : (i + 1) * dim] for i, key in enumerate("rtv")}
        return both("kinetic_force")(k, s | parts | {"rate": rate, "T": energy_of_length})

    return [
        *(Relation("motion", name, "of the material point", 0, at_point(name)) for name in of_motion[0]),
        *(Relation("motion", name, f"rate of {of} at a constant share", 1, along(of))
          for name, of in zip(of_motion[1], ("r_S", "r", "velocity"), strict=True)),
        Relation("motion", "growth", "l'/l", 0, lambda k, s, t, j: s["s_rate"].dot(np.array([-1, 1])) / s["l"]),
        Relation("kinetic_force", "f", "d/dt dT/dv - dT/de", 1, lagrange, n),
        Relation("kinetic_force", "f_s", "d/dt dT/ds' - dT/ds", 1, lambda k, s, t, j: lagrange(k, s, t, n + j), ENDS),
        Relation("kinetic_force_tangent", "D", "df by rates", 1, _from_state(by_rate(acting, n)), n + ENDS),
        Relation("kinetic_force_tangent", "K", "df by e and l", 1, _from_state(by_configuration(acting, n)), n + 1)]


# --- over a step that conserves energy --------------------------------------------------------------------------


def _of_momentum(spec: Element) -> list[Relation]:
    positions = np.array(spec.is_position, dtype=int)

    def at_points(k: Numbers, s: State) -> Any:
        return np.array([s["l"] * k("point", s, xi=k.array(np.asarray(float(xi))))["velocity"]
                         for xi, _ in gauss(POINTS)])

    def change(k: Numbers, s: State, of: Callable[[Any, Any], Any]) -> Any:
        """Return the change over the step of a number of the momentum and the length."""
        return of(k("momentum_step", s)["P_next"], s["l"] + s["s_change"][1] - s["s_change"][0]) - of(s["P"], s["l"])

    def energy(k: Numbers, s: State) -> Callable[[Any, Any], Any]:
        return lambda P, length: k("momentum_energy", s, P=P, l=length)["T"]

    def momentum(k: Numbers, s: State) -> Callable[[Any, Any], Any]:
        weights = k.array(np.array([float(weight) for _, weight in gauss(POINTS)]))
        return lambda P, length: s["rho"] * weights.dot(P) / s["h"]

    def work(k: Numbers, s: State) -> Any:
        found = k("momentum_step", s)
        return np.sum(found["f"] * s["e_change"]) + found["f_s"].dot(s["s_change"])

    def along_rest(k: Numbers, s: State) -> Any:
        """Return 2 l dr/h of a step without flow, less the momentum at its start."""
        still = s | {"s_rate": 0 * s["s_rate"], "v": s["e_change"] / s["h"]}
        return 2 * k("momentum", still)["P"] - s["P"]

    return [
        Relation("momentum", "P", "l times the velocity of a material point", 0, lambda k, s, t, j: at_points(k, s)),
        Relation("momentum_energy", "T", "the kinetic energy", 0, lambda k, s, t, j: k("kinetic_energy", s)["T"],
                 of=lambda k, s: k("momentum_energy", s, P=k("momentum", s)["P"])["T"]),
        Relation("momentum_step", "f", "net force: the change of the momentum", 0,
                 lambda k, s, t, j: change(k, s, momentum(k, s)),
                 of=lambda k, s: positions.dot(k("momentum_step", s)["f"])),
        Relation("momentum_step", "f_s", "with f, work: the change of the kinetic energy", 0,
                 lambda k, s, t, j: change(k, s, energy(k, s)), of=work),
        Relation("momentum_step", "P_next", "2 l dr/h - P where the ends are at rest", 0,
                 lambda k, s, t, j: along_rest(k, s),
                 of=lambda k, s: k("momentum_step", s, s_change=0 * s["s_change"])["P_next"])]


def _of_elastic_step(spec: Element) -> list[Relation]:
    n = spec.n_coordinates

    def parts(k: Numbers, s: State) -> dict[str, Any]:
        """Return the energies of stretching and of bending at both ends of a step."""
        bends = np.array([0, 1, 0])
        ends = [s, s | {"e": s["e_next"], "l": s["l_next"]}]
        return {name: np.array([k("energy", end, A=s["A"] * factor)["U"][0] for end in ends])
                for name, factor in (("U_m", 1 - bends), ("U_b", bends))}

    def step(k: Numbers, s: State) -> dict[str, np.ndarray]:
        return k("elastic_step", s, **parts(k, s))

    def end(k: Numbers, s: State) -> Any:
        found = step(k, s)
        return k("energy", s)["U"] + np.sum(found["f"] * (s["e_next"] - s["e"])) + found["f_l"] * (s["l_next"] - s["l"])

    def still(output: str) -> Callable[[Numbers, State], Any]:
        return lambda k, s: step(k, s | {"e_next": s["e"], "l_next": s["l"]})[output]

    return [
        Relation("elastic_step", "f", "U + f . de + f_l dl is U at the end", 0,
                 lambda k, s, t, j: k("energy", s, e=s["e_next"], l=s["l_next"])["U"], of=end),
        Relation("elastic_step", "f", "dU/de where the ends agree", 1, from_kernel("energy", "U", e=entry("e")), n,
                 of=still("f")),
        Relation("elastic_step", "f_l", "dU/dl where the ends agree", 1, _by_length("energy", "U"), of=still("f_l"))]
