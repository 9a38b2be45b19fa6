"""Relations of the kernels of lines in contact: derivatives of the force at closest points found anew."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...codegen.family import CouplingFamily
from ..methods import Relation
from ..numbers import Numbers, State
from .paths import entry, root

NEGLIGIBLE = 1e-16
"""Of the square of a line's size, as the kernel of a step has it."""
TRIALS = 12
"""Steps of Newton's method to the closest points: the conditions hold nearly, and digits double."""


class Lines:
    """Cubics with the slopes, curvatures and third derivatives of a state, one or two, and velocities along them."""

    def __init__(self, lines: int):
        self.lines, self.signs = lines, (1, -1)[:lines]

    def along(self, s: State, x: list[Any]) -> State:
        """Return the state at other points of the lines."""
        t, k, w = s["t"], s["k"], s["w"]
        third, k_rate = s["third"], s["k_rate"]
        d, u, slopes, curvatures, rates = s["d"], s["u"], [], [], []
        for i, sign in enumerate(self.signs):
            square = x[i] * x[i] / 2
            d = d + sign * (x[i] * t[i] + square * k[i] + x[i] * square / 3 * third[i])
            u = u + sign * (x[i] * w[i] + square * k_rate[i])
            slopes.append(t[i] + x[i] * k[i] + square * third[i])
            curvatures.append(k[i] + x[i] * third[i])
            rates.append(w[i] + x[i] * k_rate[i])
        return {**s, "d": d, "u": u, "t": np.array(slopes), "k": np.array(curvatures), "w": np.array(rates),
                "e": s["e"] + np.array(x)}

    def points(self, s: State) -> list[Any]:
        """Return the closest points, by their arc-lengths from those of the state."""
        x: list[Any] = [0 * s["d"][0]] * self.lines
        for _ in range(TRIALS):
            at = self.along(s, x)
            d, t, k = at["d"], at["t"], at["k"]
            h, a = t @ d, t[0].dot(t[0]) + k[0].dot(d)
            if self.lines == 1:
                x = [x[0] - h[0] / a]
                continue
            b, c, e = -t[0].dot(t[1]), t[1].dot(t[0]), -t[1].dot(t[1]) + k[1].dot(d)
            determinant = a * e - b * c
            x = [x[0] - (e * h[0] - b * h[1]) / determinant, x[1] - (a * h[1] - c * h[0]) / determinant]
        return x

    def closest(self, s: State) -> State:
        """Return the state at the closest points."""
        return self.along(s, self.points(s))


def crossing(family: CouplingFamily) -> list[Relation]:
    """Return the relations of force, energy and closest points.

    Along a path the lines are moved, their closest points are found anew by a matrix that is solved by numbers, and the
    force is that of the kernel there.
    """
    dim, lines = family.dim, Lines(family.dim - 1)
    numbers = {"d": dim, "t": lines.lines * dim}
    rates = {"u": dim, "w": lines.lines * dim, "k": lines.lines * dim}

    def moved(s: State, name: str, t: Any, j: int) -> State:
        return {**s, name: s[name] + t * entry(name)(s, j)}

    def off(s: State) -> State:
        """Return a state of straight lines off their closest points."""
        return {**s, "d": s["d"] + s["t"][0] / 3, "k": 0 * s["k"], "third": 0 * s["third"]}

    def force_by(name: str, kernel: str = "force") -> Callable[..., Any]:
        return lambda k, s, t, j: k(kernel, lines.closest(moved(s, name, t, j)))["F"]

    def force_by_both(name: str, kernel: str) -> Callable[..., Any]:
        return lambda k, s, t, j: force_by("d" if j < dim else name, kernel)(k, s, t, j if j < dim else j - dim)

    def side_by_side(name: str, kernel: str) -> Callable[..., Any]:
        return lambda k, s: np.concatenate([k(kernel, s)[each] for each in ("F_d", f"F_{name}")], axis=1)

    def points_by(name: str) -> Callable[..., Any]:
        return lambda k, s, t, j: np.array(lines.points(moved(s, name, t, j)))

    def energy(k: Numbers, s: State, t: Any, j: int) -> Any:
        return -k("contact", lines.closest(moved(s, "d", t, j)))["U"]

    return [*(Relation("force", f"F_{name}", f"dF by {name}, closest points found anew", 1, force_by(name), n)
              for name, n in (*numbers.items(), ("u", dim))),
            *(Relation(kernel, f"F_{name}", f"dF by {name}, closest points found anew", 1, force_by(name, kernel), n)
              for kernel in ("sticking", "sliding") for name, n in numbers.items()),
            *(Relation(kernel, f"F_{name}", f"dF by d and {name} side by side, as the last are small", 1,
                       force_by_both(name, kernel), dim + n, of=side_by_side(name, kernel))
              for kernel in ("sticking", "sliding") for name, n in rates.items()),
            *_motion(lines), *_friction(lines),
            *(Relation("force", f"s_{name}", f"closest points by {name}, found anew", 1, points_by(name), n)
              for name, n in numbers.items()),
            Relation("force", "F", "-dU by d without damping", 1, energy, dim,
                     of=lambda k, s: k("force", {**s, "u": 0 * s["u"]})["F"]),
            *_contact(), *_step(),
            Relation("closest", "step", "closest points of lines without curvature", 0,
                     root(lambda s: np.array(lines.points(off(s)))), of=lambda k, s: k("closest", off(s))["step"])]


def across(s: State) -> Any:
    """Return the normal of both lines."""
    t = s["t"]
    square = np.array([t[0][1], -t[0][0]]) if len(t) == 1 else np.cross(t[0], t[1])
    return s["c"][1] / square.dot(square) ** 0.5 * square


def _size(s: State) -> Any:
    """Return the force along the normal."""
    n, c = across(s), s["c"]
    p = c[0] - n.dot(s["d"])
    return (c[2] * p + c[3] * p * p**0.5) * (1 - c[4] * n.dot(s["u"]))


def _moving(lines: Lines, s: State) -> State:
    """Return the rates of arc-lengths, slopes and d at the closest points, by the conditions of closeness."""
    t, k, d, u, w = (s[name] for name in ("t", "k", "d", "u", "w"))
    right = [-(t[i].dot(u) + w[i].dot(d)) for i in range(lines.lines)]
    a = t[0].dot(t[0]) + k[0].dot(d)
    if lines.lines == 1:
        speeds = np.array([right[0] / a])
    else:
        b, e = t[0].dot(t[1]), k[1].dot(d) - t[1].dot(t[1])
        speeds = np.array([right[0] * e + b * right[1], a * right[1] - b * right[0]]) / (a * e + b * b)
    d_dot = u
    for sign, speed, slope in zip(lines.signs, speeds, t, strict=True):
        d_dot = d_dot + sign * speed * slope
    return {"s_dot": speeds, "t_dot": np.array([w[i] + speed * k[i] for i, speed in enumerate(speeds)]), "d_dot": d_dot}


def _motion(lines: Lines) -> list[Relation]:
    """Return the relations of motion of the closest points."""
    def later(s: State, t: Any) -> State:
        return {**s, "d": s["d"] + t * s["u"], "t": s["t"] + t * s["w"], "e": 0 * s["e"]}

    def at(name: str) -> Callable[..., Any]:
        return lambda k, s, t, j: lines.closest(later(s, t))[name]

    return [Relation("motion", output, f"{text} as the points move", 1, at(name)) for output, name, text in (
        ("s_dot", "e", "arc-lengths"), ("t_dot", "t", "slopes"), ("d_dot", "d", "d"))]


def _unit(x: Any) -> Any:
    return x / x.dot(x) ** 0.5


def _direction(s: State) -> Any:
    """Return the direction of a stretch that slides, from the stretch and the slip at both ends of the step."""
    r, change = (s["r_1"] + s["r_0"]) / 2, s["x_now"] - s["x_old"]
    A = change.dot(change) ** 0.5 / r
    return r * (s["x_old"] / s["r_0"] + (A + A**2 / 2 + A**3 / 4) * _unit(change)
                - (A + A**2) / 12 * s["h"] / r * s["slip_old"] + (A**2 / 12 + A**4 / 24) * _unit(s["slip"]))


def _friction(lines: Lines) -> list[Relation]:
    """Return the relations of friction in stick, or slides by its spring, in closed form."""
    def along(s: State) -> Any:
        return s["t"][-1] / s["t"][-1].dot(s["t"][-1]) ** 0.5

    def old(s: State) -> Any:
        i = along(s)
        return s["x"][0] * i + (s["x"][1] * np.cross(across(s), i) if lines.lines == 2 else 0)

    def slip(s: State) -> Any:
        """Return the components of the slip, along the last line and square to it."""
        i = along(s)
        return np.array([axis.dot(s["u"]) for axis in (i, *([np.cross(across(s), i)] if lines.lines == 2 else []))])

    def half(s: State) -> State:
        """Return slopes and slip half-way along cubics through values and rates at both ends."""
        h, end = s["h"], _moving(lines, s)
        def value(a: Any, a_rate: Any, b: Any, b_rate: Any) -> Any:
            return (a + b) / 2 + h / 8 * (a_rate - b_rate)
        def rate(a: Any, a_rate: Any, b: Any, b_rate: Any) -> Any:
            return 3 * (b - a) / (2 * h) - (a_rate + b_rate) / 4
        t = value(s["t_0"], s["t_rate"], s["t"], end["t_dot"])
        speeds = rate(0 * s["e"], s["s_rate"], s["e"], end["s_dot"])
        u = rate(s["d_0"], s["d_rate"], s["d"], end["d_dot"])
        for sign, speed, slope in zip(lines.signs, speeds, t, strict=True):
            u = u - sign * speed * slope
        return {**s, "t": t, "u": u}

    def now(s: State) -> Any:
        """Return the stretch and the integral of the slip, by Simpson's rule."""
        x = s["x"] + s["h"] / 6 * (s["v"] + 4 * slip(half(s)) + slip(s))
        return old({**s, "x": x})

    def turned(s: State) -> Any:
        """Return the direction of a sliding stretch as a sum of unit vectors, those of the slip at both ends among
        them.
        """
        r, change = (s["mu"] * _size(s) / s["k_t"] + s["r_0"]) / 2, now(s) - old(s)
        A = change.dot(change) ** 0.5 / r
        first = old({**s, "x": s["v"]})
        last = s["u"] - across(s) * across(s).dot(s["u"])
        return old(s) / s["r_0"] - (A + A**2) / 12 * s["h"] / r * first + (
            A + A**2 / 2 + A**3 / 4) * _unit(change) + (A**2 / 12 + A**4 / 24) * _unit(last)

    def sliding(s: State) -> Any:
        x = turned(s) if lines.lines == 2 else now(s)
        return -s["mu"] * _size(s) / x.dot(x) ** 0.5 * x

    return [Relation(kernel, name, text, 0, root(function)) for kernel, name, text, function in (
        ("turned", "direction", "r times a sum of unit vectors, those of the slip among them", _direction),
        ("stretch", "along", "b/|b|, in the plane a/|a|", along), ("stretch", "old", "x_1 i + x_2 n x i", old),
        ("stretch", "now", "old and the integral of the slip", now),
        ("sticking", "F", "-k_t now", lambda s: -s["k_t"] * now(s)), ("sliding", "F", "-mu N now/|now|", sliding))]


def _contact() -> list[Relation]:
    """Return the relations of contact at the closest points, in closed form."""
    def depth(s: State) -> Any:
        n = across(s)
        return np.array([s["c"][0] - n.dot(s["d"]), -n.dot(s["u"])])

    def size(s: State) -> Any:
        return np.array([_size(s)])

    def stored(s: State) -> Any:
        p = depth(s)[0]
        return np.array([s["c"][2] * p * p / 2 + s["c"][3] * p * p * p**0.5 * 2 / 5])

    def friction(s: State) -> tuple[Any, Any]:
        """Return the force of friction, and the slip."""
        n = across(s)
        slip = s["u"] - n * n.dot(s["u"])
        return -s["c"][6] * size(s)[0] / (slip.dot(slip) + s["c"][7] ** 2) ** 0.5 * slip, slip

    def dissipated(s: State) -> Any:
        p, rate = depth(s)
        force, slip = friction(s)
        return np.array([(s["c"][2] * p + s["c"][3] * p * p**0.5) * s["c"][4] * rate * rate - force.dot(slip)])

    def whole(s: State) -> Any:
        return size(s)[0] * across(s) + friction(s)[0]

    told = {"n": ("side * t_a x t_b/|t_a x t_b|", across), "p": ("radii - n.d, and -n.u", depth),
            "N": ("k p^e (1 + damping p')", size), "U": ("k p^(e+1)/(e+1)", stored),
            "f": ("N n - mu N v/sqrt(v.v + v0^2)", whole),
            "P": ("k p^e damping p'^2 + mu N v.v/sqrt(v.v + v0^2)", dissipated)}
    return [Relation("contact", name, text, 0, root(function)) for name, (text, function) in told.items()]


def _step() -> list[Relation]:
    """Return the relations over a step: energy, and friction along the slip."""
    def stored(k: Numbers, s: State, depth: str) -> Any:
        return k("contact", {**s, "d": (s["c"][0] - s[depth]) * across(s)})["U"][0]

    def slip(s: State) -> Any:
        return s["displacement"] - s["n"] * s["n"].dot(s["displacement"])

    def law(k: Numbers, s: State) -> tuple[Any, Any]:
        """Return the mean force without damping, and with it."""
        penetration = s["p_next"] - s["p"]
        elastic = (stored(k, s, "p_next") - stored(k, s, "p")) / penetration
        return elastic, elastic * (1 + s["c"][4] * penetration / s["h"])

    def friction(k: Numbers, s: State) -> Any:
        rate = slip(s) / s["h"]
        return -s["c"][6] * law(k, s)[1] / (rate.dot(rate) + s["c"][7] ** 2) ** 0.5 * rate

    def lost(k: Numbers, s: State) -> Any:
        elastic, normal = law(k, s)
        return np.array([(normal - elastic) * (s["p_next"] - s["p"]) - friction(k, s).dot(slip(s))])

    def makes_up(s: State) -> Any:
        """Return the change of the gap less that of its gradient half-way, over the square of all changes."""
        displacement, gap = s["displacement"], s["p"] - s["p_next"]
        turns = sum(size * size * (turn.dot(turn) + NEGLIGIBLE)
                    for turn, size in zip(s["turn"], s["size"], strict=True))
        return (gap - s["n"].dot(displacement)) / (displacement.dot(displacement) + turns)

    def force(k: Numbers, s: State) -> Any:
        return law(k, s)[1] * (s["n"] + makes_up(s) * s["displacement"]) + friction(k, s)

    def on_slopes(k: Numbers, s: State) -> Any:
        factor = law(k, s)[1] * makes_up(s)
        return np.array([factor * size * size * turn for turn, size in zip(s["turn"], s["size"], strict=True)])

    def equal(of: Callable[..., Any]) -> Callable[..., Any]:
        return lambda k, s, t, j: of(k, s)

    return [Relation("step", name, text, 0, equal(of)) for name, text, of in (
        ("F", "N (n + its correction along the displacement) and friction", force),
        ("M", "N times the correction along the turns", on_slopes), ("lost", "damping and friction", lost))]
