"""Numbers that a reader can check, where the print is wrong or the formulation has an edge; computed at each build."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .scopes import State, compiled, samples_of


@dataclass(frozen=True)
class Proof:
    """What was done, a table of what came out, and what follows. Cells are text; $...$ in them are formulas.

    `numbers` are the values of the table by name, for the tests.
    """

    done: str
    head: list[str]
    rows: list[list[str]]
    follows: str
    numbers: dict[str, float]


def sign_of_34() -> Proof:
    """Return the acceleration of a slide by differences of its motion, and by both signs of eq 34."""
    family = "slide_beam24_point"
    state = samples_of(family)[0]
    at = {k: _place(family, state, k * STEP) for k in range(-2, 3)}
    second = sum(c * at[k] for k, c in zip(range(-2, 3), (-1, 16, -30, 16, -1), strict=True)) / (12 * STEP**2)
    terms = compiled(family, "terms", state)
    bias, swept = terms["s_bias"].item(), terms["G"] @ _accelerations(state)
    numbers = {"differences": second, "right": bias + swept, "print": bias - swept}
    return Proof(
        "A point slides along a bent element while all nodal vectors and the point have velocities and accelerations "
        f"drawn at random. At five times, {STEP:g} s apart, the place $s$ is found by Newton's method from "
        "$C_{L} = 0$ alone. Its second difference is $\\ddot{s}$.",
        ["$\\ddot{s}$ from", "value, m/s²"],
        [["differences of the motion", f"{second:.8f}"],
         ["eq 34 with plus $\\mathbf{G} \\ddot{\\mathbf{q}}$", f"{bias + swept:.8f}"],
         ["eq 34 as printed, minus $\\mathbf{G} \\ddot{\\mathbf{q}}$", f"{bias - swept:.8f}"]],
        f"The motion decides for the plus: it differs by {abs(second - bias - swept):.0e}, the print by "
        f"{abs(second - bias + swept):.2g}.", numbers)


STEP = 1e-3


def _accelerations(state: State) -> np.ndarray:
    return np.concatenate([state["vdot"].ravel(), state["wdot"]])


def _place(family: str, state: State, t: float) -> float:
    """Return s at a time, from C_L alone, which keeps the value of time 0: the sample is off the joint."""
    moved = dict(state, e=state["e"] + t * state["v"] + t * t / 2 * state["vdot"],
                 b=state["b"] + t * state["w"] + t * t / 2 * state["wdot"])
    level = compiled(family, "constraint", state)["C"][0]
    for _ in range(20):
        now = compiled(family, "constraint", moved)
        step = (now["C"][0] - level) / now["C_s"][0]
        moved["x"] = moved["x"] - step
        if abs(step) < 1e-15:
            break
    return float(moved["x"])


def length_of_16() -> Proof:
    """Return the length of k as printed, and as computed, at the samples of a sheared element."""
    rows: list[list[str]] = []
    numbers: dict[str, float] = {}
    for n, state in enumerate(samples_of("slide_beam24_rigid")[:2], 1):
        frame = compiled("slide_beam24_rigid", "constraint", state)["A_t"]
        slopes = compiled("beam24", "slopes", state)["S"]
        r_y = slopes[1, 0] @ state["e"]
        printed = float(np.linalg.norm(np.cross(frame[:, 0], r_y / np.linalg.norm(r_y))))
        here = float(np.linalg.norm(frame[:, 2]))
        angle = float(np.degrees(np.arcsin(min(printed, 1.0))))
        rows.append([str(n), f"{angle:.2f}°", f"{printed:.12f}", f"{here:.12f}"])
        numbers |= {f"printed {n}": printed, f"here {n}": here}
    return Proof("Two bent and sheared elements drawn at random, at a point of the centreline.",
                 ["sample", "angle of $\\mathbf{i}$ and $\\mathbf{r}_{y}$", "length as printed", "length here"], rows,
                 "As printed, the frame would scale the constraint, and with it the force, by the sine of that angle.",
                 numbers)


def axial_mass() -> Proof:
    """Return the integrals of the axial modes of the slider-crank, and what its code has for them."""
    x, w = np.polynomial.legendre.leggauss(8)
    x, w = (x + 1) / 2, w / 2
    modes = {"middle": 4 * x * (1 - x), "end": x * (2 * x - 1)}
    pairs = [("middle", "middle", 8, "8/15"), ("middle", "end", 1, "1/15"), ("end", "end", 2, "2/15")]
    rows: list[list[str]] = []
    numbers: dict[str, float] = {}
    for a, b, published, exact in pairs:
        value = float(w @ (modes[a] * modes[b]))
        rows.append([f"{a}, {b}", f"{value:.12f}", exact, str(published), f"{published / value:.6f}"])
        numbers[f"{a} {b}"] = published / value
    return Proof("The rod's axial displacement is quadratic, with the shapes $4 \\xi \\left( 1 - \\xi \\right)$ "
                 "(middle) and $\\xi \\left( 2 \\xi - 1 \\right)$ (end). Their products are integrated over the "
                 "length by Gauss quadrature, exact for these degrees.",
                 ["shapes", "integral", "is", "published code", "ratio"], rows,
                 "The published axial masses are 15 times too large. With the right ones, the rod's angle after 0.1 s "
                 "is 7e-8 rad off the published one, the slider 6e-8 m.", numbers)


def jump_at_node() -> Proof:
    """Return how H and W differ on both sides of a node, for a cubic cable and for a quintic one."""
    rows: list[list[str]] = []
    numbers: dict[str, float] = {}
    for element in ("cable12", "cable18"):
        family = f"slide_{element}_point"
        left, right, vectors = _sides(family)
        of_left, of_right = (compiled(family, "terms", s) for s in (left, right))
        half = vectors // 2 * 3
        shared = [of_left["H"][:, half: 2 * half], of_right["H"][:, :half]]
        rider = [of["H"][:, 2 * half:] for of in (of_left, of_right)]
        jump_H = max(_apart(*shared), _apart(*rider))
        jump_W = _apart(of_left["W"], of_right["W"])
        rows.append([f"`{element}`", f"{jump_H:.1e}", f"{jump_W:.2g}"])
        numbers |= {f"{element} H": jump_H, f"{element} W": jump_W}
    return Proof("Two elements share a node and have random nodal vectors and velocities. The slide is at the "
                 "node, once as the end of the first element, once as the start of the second.",
                 ["element", "change of $\\mathbf{H}$", "change of $\\mathbf{W}$"], rows,
                 "On a cubic cable the curvature jumps at a node, and with it the acceleration of the rider. On a "
                 "quintic one it does not. Changes are relative to the largest entry.", numbers)


def _apart(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.abs(a - b).max() / np.abs(a).max())


def _sides(family: str) -> tuple[State, State, int]:
    """Return a slide at the end of an element and at the start of the next, and the nodal vectors of an element."""
    first, second = (dict(s) for s in samples_of(family)[:2])
    vectors = len(first["e"])
    for name in "ev":
        second[name] = np.concatenate([first[name][vectors // 2:], second[name][vectors // 2:]])
    first["b"] = first["e"][vectors // 2] - first["u"]  # on the joint
    for name in "bwu":
        second[name] = first[name]
    second["director"] = first["director"]
    return first | {"x": first["l"]}, second | {"x": np.float64(0.0)}, vectors


PROOFS: dict[str, Callable[[], Proof]] = {"sign_of_34": sign_of_34, "length_of_16": length_of_16,
                                          "axial_mass": axial_mass, "jump_at_node": jump_at_node}
