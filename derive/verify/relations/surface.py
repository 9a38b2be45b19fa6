"""Relations of the kernels of surfaces and contact: distances, stored energy, forces along a normal."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...algebra.tangent_frame import cross, moment_of
from ...codegen.family import CouplingFamily
from ...couplings.surface import HEIGHTS
from ..methods import Relation
from ..motion import turned_axes
from .paths import entry, from_kernel, unit


def surface(family: CouplingFamily) -> list[Relation]:
    """Return the relations of distances, laws and forces."""
    return [*_distances(family.dim), *_laws(), *_forces(family.dim), *_reactions(family.dim),
            *_motions(family.dim)]


def _distances(dim: int) -> list[Relation]:
    """Return those of distances. Of a terrain the heights are those of their Taylor series at the place."""
    horizontal = {1: 0} if dim == 2 else {1: 0, 2: 2}

    def height(s: Any, move: Any) -> list[Any]:
        """Return the heights and derivatives of the series of third order, this far from the place."""
        value = dict(zip(HEIGHTS[dim], s["h"], strict=True))

        def at(name: str) -> Any:
            total = value[name]
            axes = list(horizontal)
            for a in axes:
                total = total + _get(value, name, a) * move[horizontal[a]]
                for b in axes:
                    total = total + _get(value, name, a, b) * move[horizontal[a]] * move[horizontal[b]] / 2
                    for c in axes:
                        total = total + (_get(value, name, a, b, c) * move[horizontal[a]] * move[horizontal[b]]
                                         * move[horizontal[c]] / 6)
            return total

        return [at(name) for name in HEIGHTS[dim]]

    def on_terrain(output: str) -> Any:
        def path(k: Any, s: Any, t: Any, j: int) -> Any:
            move = t * unit(s["y"], j)
            h = s["h"] * 0 + height(s, move)
            return k("terrain", s, y=s["y"] + move, h=h)[output]
        return path

    found = []
    for kernel in ("flat", "rounded"):
        found.append(Relation(kernel, "g_y", "dg by y", 1, from_kernel(kernel, "g", y=entry("y")), dim))
        found.append(Relation(kernel, "g", "at 50 digits; see distances below", 0, from_kernel(kernel, "g")))
    found.append(Relation("rounded", "g_yy", "d2g by y", 1, from_kernel("rounded", "g_y", y=entry("y")), dim))
    found.append(Relation("terrain", "g", "at 50 digits; see distances below", 0, from_kernel("terrain", "g")))
    found.append(Relation("terrain", "g_y", "dg by y, heights by their series", 1, on_terrain("g"), dim))
    found.append(Relation("terrain", "g_yy", "d2g by y, heights by their series", 1, on_terrain("g_y"), dim))
    return found


def _get(value: dict[str, Any], name: str, *axes: int) -> Any:
    """Return a further derivative of a height, zero beyond the third."""
    return value.get("h_" + "".join(sorted(name[2:] + "".join(map(str, axes)))), 0)


def _laws() -> list[Relation]:
    """Return those of the laws by the depth and its rate."""
    def by_depth(s: Any, j: int) -> int:
        return 1

    found = []
    for kernel in ("push", "push_hertz"):
        found += [Relation(kernel, "p_d", "dp by the depth", 1, from_kernel(kernel, "p", depth=by_depth)),
                  Relation(kernel, "p_rate", "dp by the rate", 1, from_kernel(kernel, "p", depth_rate=by_depth)),
                  Relation(kernel, "p_e", "dU by the depth", 1, from_kernel(kernel, "U", depth=by_depth)),
                  Relation(kernel, "p", "at 50 digits; see laws below", 0, from_kernel(kernel, "p")),
                  Relation(kernel, "U", "at 50 digits; see laws below", 0, from_kernel(kernel, "U")),
                  Relation(kernel, "mean", "at 50 digits; see laws below", 0, from_kernel(kernel, "mean"))]
    return found


def _forces(dim: int) -> list[Relation]:
    """Return the relations of forces: along a place the normal turns by H, its force changes with depth and rate."""
    def by_place(kernel: str, with_x: bool, with_force: bool) -> Any:
        def path(k: Any, s: Any, t: Any, j: int) -> Any:
            move = t * unit(s["n"], j)
            changed: dict[str, Any] = {"n": s["n"] + s["H"] @ move}
            if with_force:
                p, by_d, by_rate = s["normal_force"]
                depth, rate = -(s["n"] @ move), -((s["H"] @ s["w"]) @ move)
                changed["normal_force"] = s["normal_force"] * 0 + [p + by_d * depth + by_rate * rate, by_d, by_rate]
            if with_x:
                changed["x"] = s["x"] + move
            return k(kernel, s, **changed)["f"]
        return path

    def by_rate(kernel: str) -> Any:
        def path(k: Any, s: Any, t: Any, j: int) -> Any:
            p, by_d, by_rate = s["normal_force"]
            change = t * unit(s["n"], j)
            normal_force = s["normal_force"] * 0 + [p - by_rate * (s["n"] @ change), by_d, by_rate]
            return k(kernel, s, normal_force=normal_force, w=s["w"] + change)["f"]
        return path

    def by_stretch(kernel: str) -> Any:
        return lambda k, s, t, j: k(kernel, s, x=s["x"] + t * unit(s["x"], j))["f"]

    return [Relation("frictionless", "f", "at 50 digits", 0, from_kernel("frictionless", "f")),
            Relation("frictionless", "f_y", "df by the place", 1, by_place("frictionless", False, True), dim),
            Relation("frictionless", "f_w", "df by the velocity", 1, by_rate("frictionless"), dim),
            Relation("sticking", "f", "at 50 digits", 0, from_kernel("sticking", "f")),
            Relation("sticking", "t", "at 50 digits", 0, from_kernel("sticking", "t")),
            Relation("sticking", "f_y", "df by the place", 1, by_place("sticking", True, False), dim),
            Relation("sticking", "f_x", "df by the stretch", 1, by_stretch("sticking"), dim),
            Relation("sliding", "f", "at 50 digits", 0, from_kernel("sliding", "f")),
            Relation("sliding", "f_y", "df by the place", 1, by_place("sliding", True, True), dim),
            Relation("sliding", "f_x", "df by the stretch", 1, by_stretch("sliding"), dim),
            Relation("sliding", "f_w", "df by the velocity", 1, by_rate("sliding"), dim),
            Relation("slipping", "f", "at 50 digits", 0, from_kernel("slipping", "f")),
            Relation("slipping", "f_y", "df by the place", 1, by_place("slipping", False, True), dim),
            Relation("slipping", "f_w", "df by the velocity", 1, by_rate("slipping"), dim)]


def _reactions(dim: int) -> list[Relation]:
    """Return those of contact on a body: a force that follows a surface, along axes turned by quaternions."""
    def moved(k: Any, s: Any, t: Any) -> dict[str, Any]:
        """Return the force and its moments after a part t of the motion."""
        axes = turned_axes(k, t * s["dtheta_o"], np.eye(dim, dtype=int))
        x = s["x"] + t * s["dr"]
        past = s["w"] + cross(s["omega_o"], s["x"]) + t * s["dv"] - cross(s["omega_o"] + t * s["domega_o"], x)
        y, w = axes.T.dot(x) - s["x"], axes.T.dot(past) - s["w"]
        arm_y = -s["radius"] * s["H"].dot(y)
        relative = t * (s["dtheta"] - s["dtheta_o"])
        turn = s["turn"] + relative - (cross(s["turn"], relative) / 2 if dim == 3 else 0)
        stretch = cross(turn, s["mean_arm"] + s["share"] * arm_y) - cross(s["turn"], s["mean_arm"])
        f = axes.dot(s["f"] + s["f_y"].dot(y) + s["f_w"].dot(w) + s["f_x"].dot(stretch))
        arm = axes.dot(s["arm"] + arm_y)
        return {"f_t": f, "m_t": moment_of(arm, f), "m_o_t": moment_of(x + arm, f)}

    def path(output: str) -> Any:
        return lambda k, s, t, j: moved(k, s, t)[output]

    return [Relation("reaction", output, "along a finite motion", 1, path(output))
            for output in ("f_t", "m_t", "m_o_t")]


def _motions(dim: int) -> list[Relation]:
    """Return those of rates: the distance is that of its series of second order, along axes turned by quaternions."""
    def place(k: Any, s: Any, t: Any) -> tuple[Any, Any]:
        """Return the surface's axes and how far the point has moved along them."""
        axes = turned_axes(k, t * s["omega_o"] + t * t / 2 * s["alpha_o"], np.eye(dim, dtype=int))
        x = s["r"] - s["r_o"]
        return axes, axes.T.dot(x + t * (s["v"] - s["v_o"]) + t * t / 2 * (s["a"] - s["a_o"])) - x

    def distance(k: Any, s: Any, t: Any, j: int) -> Any:
        _, move = place(k, s, t)
        return s["n"].dot(move) + move.dot(s["H"].dot(move)) / 2

    def slips(k: Any, s: Any, t: Any, j: int) -> Any:
        """Return the slip of the moved point. The normal is that of the series and turns with the surface."""
        axes, move = place(k, s, t)
        moved = {f"{x}{tag}": s[f"{x}{tag}"] + t * s[f"{rate}{tag}"] for tag in ("", "_o")
                 for x, rate in (("r", "v"), ("v", "a"), ("omega", "alpha"))}
        return k("slip", s, n=axes.dot(s["n"] + s["H"].dot(move)), **moved)["w"]

    def slip_of_particles(k: Any, s: Any, t: Any, j: int) -> Any:
        """Return the displacement of the sphere's particle less that of the surface's, both at the point of contact."""
        arm = -s["radius"] * s["n"]
        place_o = s["r"] - s["r_o"] + arm
        axes, axes_o = (turned_axes(k, t * s[name], np.eye(dim, dtype=int)) for name in ("omega", "omega_o"))
        return t * (s["v"] - s["v_o"]) + axes.dot(arm) - axes_o.dot(place_o)

    return [Relation("slip", "w", "d/dt of both particles' displacements", 1, slip_of_particles),
            Relation("slip", "w_t", "dw/dt at zero accelerations", 1, slips),
            Relation("motion", "g_t", "dg/dt of the series", 1, distance),
            Relation("motion", "g_tt", "d²g/dt² of the series at zero accelerations", 2, distance)]
