"""Relations of the kernels of added mass: derivatives of the kinetic energy of the fluid, and of its impulse in time.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...codegen.family import CouplingFamily
from ..methods import Relation
from ..motion import swung_axes
from ..numbers import State
from .paths import entry, from_kernel, unit


def _along_cable(s: State, t: Any = 0, j: int = 0, name: str = "") -> Any:
    """Return T = (m_n |w_n|^2 + m_t |w_t|^2)/2 with entry j of an input moved by t."""
    s = {**s, name: s[name] + t * unit(s[name], j)} if name else s
    slope, w = s["t"], s["w"]
    along = slope * (slope.dot(w) / slope.dot(slope))
    normal, tangential = s["m"]
    return (normal * (w - along).dot(w - along) + tangential * along.dot(along)) / 2


def added_mass(family: CouplingFamily) -> list[Relation]:
    """Return the relations of impulses, of forces and moments with their derivatives, and of those over a step."""
    return [*_impulses(family.dim), *_forces("inertia_of_cable", family.dim), *_on_slope(family.dim),
            *_forces("inertia_of_point", family.dim), *_on_body("inertia_of_point", family.dim),
            *_along_span(family.dim), *_cable_over_step(), *_body_over_step(),
            *_morison("morison_of_cable", family.dim), *_morison("morison_of_point", family.dim),
            *_on_body("morison_of_point", family.dim)]


def _impulses(dim: int) -> list[Relation]:
    cable, point = "impulse_of_cable", "impulse_of_point"

    def of_point(k, s, t, j):
        at_rest = s["A"].T.dot(s["w"] + t * unit(s["w"], j))
        return at_rest.dot(s["C"].dot(at_rest)) / 2

    return [
        Relation(cable, "p", "derivative of T by w", 1, lambda k, s, t, j: _along_cable(s, t, j, "w"), dim),
        Relation(point, "p", "derivative of w . A C A' w/2 by w", 1, of_point, dim),
        *(Relation(kernel, "M", "d p by w", 1, from_kernel(kernel, "p", w=entry("w")), dim)
          for kernel in (cable, point)),
    ]


def _impulse(kernel: str, k: Any, s: State) -> Any:
    """Return the impulse of what is all wet, at the velocity past the fluid."""
    return k(_impulse_kernel(kernel), {**s, "w": s["v"] - s["U"]})["p"]


def _impulse_kernel(kernel: str) -> str:
    return "impulse_of_" + kernel.split("_of_")[1]


def _material(s: State) -> Any:
    """Return the acceleration of the fluid, DU/Dt."""
    return s["U_rate"] + s["G"].dot(s["U"])


def _carried(s: State) -> Any:
    """Return the force on the mass of the displaced fluid."""
    return s["displaced"] * s["wet"][0] * _material(s)


def _energy(kernel: str, k: Any, s: State) -> Any:
    """Return the kinetic energy of the fluid, w . M w/2 times the wet part."""
    return s["wet"][0] * _impulse(kernel, k, s).dot(s["v"] - s["U"]) / 2


def _swung(s: State, turn: Any, t: Any) -> State:
    """Return the state with the axes turned by t times a turn, to first order."""
    return {**s, "A": s["A"] + t * swung_axes(turn, s["A"])}


def _displaced(s: State, place: Any, t: Any) -> State:
    """Return the state at a place t times `place` away, where second derivatives of the flow are nil."""
    height = s["up"].dot(place)
    return {**s, "U": s["U"] + t * s["G"].dot(place),
            "wet": s["wet"] + t * height * np.array([s["wet"][1], s["wet"][2], *2 * [0 * s["wet"][2]]])}


def _wet_later(s: State, t: Any) -> Any:
    """Return the wet part and its derivatives after the time t at a fixed place."""
    return s["wet"] + t * np.array([s["wet"][3], *3 * [0 * s["wet"][3]]])


def _later(kernel: str, s: State, t: Any) -> State:
    """Return the state at the time t: the point moves on, and the flow changes with its place and by its own rate."""
    moved = _displaced(s, s["v"], t)
    moved |= {"U": moved["U"] + t * s["U_rate"], "v": s["v"] + t * s["a"], "wet": _wet_later(moved, t)}
    return _swung(moved, s["omega"], t) if kernel.endswith("point") else {**moved, "t": s["t"] + t * s["t_rate"]}


def _forces(kernel: str, dim: int) -> list[Relation]:
    """Return the relations of the force on a particle: Lagrange's equations of the energy that `_energy` returns."""
    def impulse(k, s, t, j):
        later = _later(kernel, s, t)
        return later["wet"][0] * _impulse(kernel, k, later)

    def by_place(k, s, t, j):
        return _energy(kernel, k, _displaced(s, unit(s["v"], j), t))

    def rest(k, s):
        """Return the force and that of the displaced fluid, less the rate of the impulse."""
        wet = s["wet"][0] * _impulse(kernel, k, s)
        pull = _energy(kernel, k, {**s, "wet": s["wet"] * 0 + 1}) * s["wet"][1] * s["up"]
        return s["G"].T.dot(wet) - pull

    def power(k, s, t, j):
        force, strained = k(kernel, s)["f"], s["G"].T.dot(s["wet"][0] * _impulse(kernel, k, s))
        rate = force + _carried(s) - rest(k, s)
        return (_carried(s).dot(s["v"]) - rate.dot(s["U"]) - strained.dot(s["v"])
                - _energy(kernel, k, {**s, "wet": s["wet"] * 0 + 1}) * s["wet"][3])

    return [
        Relation(kernel, "f", "rate of c p, where T does not depend on the place", 1, impulse,
                 of=lambda k, s: k(kernel, s)["f"] + _carried(s) - rest(k, s)),
        Relation(kernel, "f", "minus the derivative of c T by the place", 1, by_place, dim,
                 of=lambda k, s: -rest(k, s)),
        Relation(kernel, "power", "of the displaced fluid, and of U", 0, power),
        *(_derivatives(kernel, dim) if kernel.endswith("cable") else []),
    ]


def _derivatives(kernel: str, dim: int) -> list[Relation]:
    """Return the relations of the derivatives of the force on a length of cable."""
    tangent = f"{kernel}_tangent"

    def moved(k, s, t, j):
        return k(kernel, _displaced(s, unit(s["v"], j), t))["f"]

    return [Relation(tangent, "f_r", "df by the place", 1, moved, dim),
            *(Relation(tangent, f"f_{name}", f"df by {name}", 1, from_kernel(kernel, "f", **{name: entry(name)}), dim)
              for name in ("v", "t", "t_rate"))]


def _morison(kernel: str, dim: int) -> list[Relation]:
    """Return the relations of the force of Morison's equation, which is all of it, and of its external power."""
    def force(k, s, t, j):
        past = {**s, "w": s["a"] - _material(s)}
        return s["wet"][0] * k(_impulse_kernel(kernel), past)["p"] - _carried(s)

    def power(k, s):
        found = k(kernel, s)
        return found["power"] + found["f"].dot(s["v"])

    def nothing(name: str, output: str) -> Relation:
        return Relation(name, output, "nil", 0, lambda k, s, t, j: 0 * k(name, s)[output])

    beside, tangents = ("g", ("g_t", "g_v", "g_r")) if kernel.endswith("cable") else ("moment", ())
    return [Relation(kernel, "f", "c (M (a - DU/Dt) - m_d DU/Dt)", 0, force),
            Relation(kernel, "power", "rate of c T less the power on the particle", 1,
                     lambda k, s, t, j: _energy(kernel, k, _later(kernel, s, t)), of=power),
            nothing(kernel, beside), *(nothing(f"{kernel}_tangent", each) for each in tangents),
            *(_derivatives(kernel, dim) if tangents else [])]


def _on_slope(dim: int) -> list[Relation]:
    kernel, tangent = "inertia_of_cable", "inertia_of_cable_tangent"

    def energy(k, s, t, j):
        return s["wet"][0] * _along_cable({**s, "w": s["v"] - s["U"]}, t, j, "t")

    return [
        Relation(kernel, "g", "derivative of c T by t", 1, energy, dim),
        *(Relation(tangent, f"g_{name}", f"dg by {name}", 1, from_kernel(kernel, "g", **{name: entry(name)}), dim)
          for name in ("t", "v")),
        Relation(tangent, "g_r", "dg by the place", 1,
                 lambda k, s, t, j: k(kernel, _displaced(s, unit(s["v"], j), t))["g"], dim),
    ]


def _on_body(kernel: str, dim: int) -> list[Relation]:
    """Return the relations of the moment, and of the derivatives by place, velocity, a turn, angular velocity."""
    turns = 3 if dim == 3 else 1
    axes = np.eye(turns, dtype=int)

    def minus_energy(k, s, t, j):
        return -_energy(kernel, k, _swung(s, axes[j], t))

    def moved(output):
        def path(k, s, t, j):
            if j < dim:
                s = _displaced(s, unit(s["v"], j), t)
            elif j < 2 * dim:
                s = {**s, "v": s["v"] + t * unit(s["v"], j - dim)}
            elif j < 2 * dim + turns:
                s = _swung(s, axes[j - 2 * dim], t)
            else:
                s = {**s, "omega": s["omega"] + t * unit(s["omega"], j - 2 * dim - turns)}
            return k(kernel, s)[output]
        return path

    return [*([Relation(kernel, "moment", "minus the derivative of c T by a turn", 1, minus_energy, turns)]
              if kernel == "inertia_of_point" else []),
            *(Relation(f"{kernel}_tangent", f"{output}_by", f"d{output} by place, velocity, turn, angular velocity", 1,
                       moved(output), 2 * (dim + turns)) for output in ("f", "moment"))]


def _along_span(dim: int) -> list[Relation]:
    """Return the relations of the derivatives of c T, of the rate of l c p at a point that moves, and of their own."""
    kernel, tangent = "inertia_of_span", "inertia_of_span_tangent"

    def energy(k, s):
        return k(kernel, s)["energy"]

    def moved(path, name):
        return lambda k, s, t, j: path(k, {**s, name: s[name] + t * unit(s[name], j)})

    def displaced(path):
        return lambda k, s, t, j: path(k, _displaced(s, unit(s["v"], j), t))

    def impulse(k, s, t, j):
        later = _displaced(s, s["y"], t)
        later |= {"U": later["U"] + t * s["U_rate"], "v": s["v"] + t * s["a"], "t": s["t"] + t * s["t_rate"],
                  "wet": _wet_later(later, t)}
        return (1 + t * s["growth"]) * k(kernel, later)["T_v"]

    def power(k, s, t, j):
        found = k(kernel, s)
        rate = found["rate"] + _carried(s)
        return (_carried(s).dot(s["v"]) - rate.dot(s["U"]) - found["T_v"].dot(s["G"].dot(s["y"]))
                - found["energy"][0] / s["wet"][0] * s["wet"][3])

    def gradient(k, s):
        return np.concatenate([k(kernel, s)[f"T_{key}"] for key in "rtv"])

    def rate(k, s):
        return k(kernel, s)["rate"]

    def along(path, names):
        """Return the path along the entries of the place and then of inputs."""
        def by_entry(k, s, t, j):
            return (displaced(path) if j < dim else moved(path, names[j // dim - 1]))(k, s, t, j % dim)
        return by_entry

    return [
        Relation(kernel, "energy", "c w . M w/2", 0, lambda k, s, t, j: s["wet"][0] * _along_cable(
            {**s, "w": s["v"] - s["U"]})),
        Relation(kernel, "T_r", "d c T by the place", 1, displaced(energy), dim),
        *(Relation(kernel, f"T_{key}", f"d c T by {key}", 1, moved(energy, key), dim) for key in "tv"),
        Relation(kernel, "rate", "rate of l c p over l, with the force on the displaced mass", 1, impulse,
                 of=lambda k, s: k(kernel, s)["rate"] + _carried(s)),
        Relation(kernel, "power", "of the displaced fluid, and of U", 0, power),
        Relation(tangent, "second", "d (T_r, T_t, T_v) by place, slope, velocity", 1, along(gradient, "tv"), 3 * dim),
        Relation(tangent, "rate_by", "d rate by place, slope, velocity, and their rates", 1,
                 along(rate, ("t", "v", "t_rate", "y", "a")), 6 * dim),
    ]


def _cable_over_step() -> list[Relation]:
    def difference(s):
        """Return D = (a . M a - b . M b)/2 at t_next less that at t, for half sum and half difference of w."""
        a, b = (s["w"] + s["w_next"]) / 2, (s["w_next"] - s["w"]) / 2
        ends = [[_along_cable({**s, "t": s[t], "w": w}) for w in (a, b)] for t in ("t", "t_next")]
        return (ends[1][0] - ends[1][1]) - (ends[0][0] - ends[0][1])

    return [
        Relation("inertia_step", "dp", "p at the end of the step less that before", 0, lambda k, s, t, j: k(
            "impulse_of_cable", s, t=s["t_next"], w=s["w_next"])["p"] - k("impulse_of_cable", s)["p"]),
        Relation("inertia_step", "g", "g . (t_next - t) = D_next - D", 0, lambda k, s, t, j: difference(s),
                 of=lambda k, s: k("inertia_step", s)["g"].dot(s["t_next"] - s["t"])),
    ]


def _body_over_step() -> list[Relation]:
    """Return the relations of a body's impulse over a step, of axes whose mean is the sample's A."""
    kernel = "inertia_of_point_step"

    def ends(s):
        half = swung_axes(s["theta"], s["A"]) / 2
        return s["A"] - half, s["A"] + half

    def step(k, s):
        before, after = ends(s)
        return k(kernel, {**s, "A": before, "A_next": after, "turning": s["A"].dot(s["turning"])})

    def impulses(k, s):
        return [k("impulse_of_point", s, A=A, w=s[w])["p"] for A, w in zip(ends(s), ("w", "w_next"), strict=True)]

    def work(k, s):
        """Return the change of the kinetic energy less the work of dp on the displacement of the point."""
        before, after = impulses(k, s)
        energy = (after.dot(s["w_next"]) - before.dot(s["w"])) / 2
        return energy - (after - before).dot((s["w"] + s["w_next"]) / 2 - more(k, s, 0, 0))

    def more(k, s, t, j):
        before, after = ends(s)
        return (after - before).dot(s["turning"]) / 4

    return [
        Relation(kernel, "dp", "p at the end of the step less that before", 0,
                 lambda k, s, t, j: impulses(k, s)[1] - impulses(k, s)[0], of=lambda k, s: step(k, s)["dp"]),
        Relation(kernel, "p", "its mean", 0, lambda k, s, t, j: sum(impulses(k, s)) / 2,
                 of=lambda k, s: step(k, s)["p"]),
        Relation(kernel, "moment", "moment . theta = change of T less dp . displacement/h", 0,
                 lambda k, s, t, j: work(k, s), of=lambda k, s: step(k, s)["moment"].dot(s["theta"])),
        Relation(kernel, "more", "mean of A y over both ends less A y of the means", 0, more,
                 of=lambda k, s: step(k, s)["more"]),
    ]
