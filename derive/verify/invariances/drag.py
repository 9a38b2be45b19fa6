"""Drag in cases known without derivation."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import EPS, Numbers, State
from .measures import Invariance, relative, spins


def drag(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that drag turns with the scene, has the flow's sense, and vanishes with its derivatives at rest."""
    out = k("along_cable", s)
    f, w = out["f"], s["w"]
    for spin in spins(family.dim):
        turned = out["f_t"] @ (spin @ s["t"]) + out["f_w"] @ (spin @ w)
        yield "drag turns with the scene", relative(turned - spin @ f, f), 64 * EPS
    yield "drag is of degree 2 in the velocity", relative(out["f_w"] @ w - 2 * f, f), 64 * EPS
    yield "drag is of degree 1 in the slope", relative(out["f_t"] @ s["t"] - f, f), 64 * EPS
    yield "drag does not change its size with the sense of the flow", relative(
        k("along_cable", {**s, "w": -w})["f"] + f, f), 64 * EPS
    i = s["t"] / np.linalg.norm(s["t"])
    across = k("along_cable", {**s, "c": np.array([0.8, 0.0, 1e-30])})["f"]
    yield "drag across has no part along the cable", relative(i @ across, across), 64 * EPS
    at_rest = k("along_cable", {**s, "w": 0 * w})
    yield "drag and its derivatives vanish without flow", max(
        float(np.max(np.abs(at_rest[name]))) for name in ("f", "f_t", "f_w")), 64 * EPS
    on_point = k("on_point", {**s, "w": 0 * w})
    yield "so do those on a point", max(float(np.max(np.abs(on_point[name]))) for name in ("f", "f_w")), 64 * EPS
    if family.dim == 3:
        yield from _on_section(k, s)
    yield from _added_mass(family, k, s)
    yield from _wetness(k, s)


def _on_section(k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that forces on a section turn with the scene, have the moment C_M, and take power from the flow."""
    out = k("on_section", s)
    f, vectors = out["f"], [s[name] for name in "tdw"]
    for spin in spins(3):
        turned = out["K"] @ np.concatenate([spin @ v for v in vectors])
        yield "a section's forces turn with the scene", relative(turned - (f @ spin.T).ravel(), f), 64 * EPS
    t, d, w = vectors
    i = t / np.linalg.norm(t)
    n, (scale, width, _) = w - (i @ w) * i, s["c_section"]
    moment = s["polar"][4] * scale * width * np.linalg.norm(t) * (n @ n)
    yield "a section's moment is about its axis", relative(
        np.cross(t, f[1]) + np.cross(d, f[2]) + moment * i, moment), 64 * EPS
    power = s["polar"][0] * scale * np.linalg.norm(t) * np.linalg.norm(n) ** 3
    yield "lift of a section takes no power from the flow", relative(f[0] @ w - power, power), 64 * EPS
    by_chord, by_slope = (out["K"][:, a : a + 3] @ v for a, v in ((3, d), (3, t)))
    yield "length and shear of the chord do not matter to the force", max(
        relative(each[:3], f[0]) for each in (by_chord, by_slope)), 64 * EPS
    at_rest = k("on_section", {**s, "w": 0 * w})
    yield "a section's forces vanish without flow", max(
        float(np.max(np.abs(at_rest[name]))) for name in ("f", "K")), 64 * EPS


def _wetness(k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that wet parts go from nil to all, and the mean depth from nil to that of the middle."""
    delta = float(s["delta"][0])
    ends = {"wet_sphere": ("u", -1.0, 1.0), "wet_section": ("phi", -np.pi / 2, np.pi / 2)}
    for kernel, (name, dry, wet) in ends.items():
        for at, e, c in ((dry, 0.0, 0.0), (wet, 1.0, 1.0)):
            out = k(kernel, {**s, name: np.array([at])})
            yield f"{kernel[4:]}: depth and wet part at the ends", max(
                abs(float(out[key][0]) - value) for key, value in (("e", e), ("c", c), ("c_u", 0.0))), 64 * EPS
    out = k("wet_column", {**s, "u": np.array([delta - 1.0])})
    yield "the rounded end of a column joins its side", max(
        abs(float(out[key][0]) - value) for key, value in (
            ("e", delta**2 / 4 + delta**2 / 12), ("c", delta / 2), ("c_u", 0.5))), 64 * EPS


def _added_mass(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that impulses turn with the scene, and that over a step the force gives the change of the energy of the
    fluid.
    """
    out, one = k("inertia_of_cable", s), np.eye(family.dim)
    for spin in spins(family.dim):
        turn = np.linalg.solve(one - spin, one + spin)
        moved = {name: turn @ s[name] for name in ("t", "t_rate", "v", "a", "U", "U_rate", "up")}
        turned = k("inertia_of_cable", s | moved | {"G": turn @ s["G"] @ turn.T})
        yield "the fluid's inertia turns with the scene", relative(turned["f"] - turn @ out["f"], out["f"]), 64 * EPS
    yield "the force on the slope is across it", relative(s["t"] @ out["g"], out["g"]), 64 * EPS
    step, ends = k("inertia_step", s), [(s["t"], s["w"]), (s["t_next"], s["w_next"])]
    impulses = [k("impulse_of_cable", {**s, "t": t, "w": w})["p"] for t, w in ends]
    yield "change of impulse over a step", relative(step["dp"] - impulses[1] + impulses[0], step["dp"]), 64 * EPS
    energies = [p @ w / 2 for p, (_, w) in zip(impulses, ends, strict=True)]
    given = step["dp"] @ (s["w"] + s["w_next"]) / 2 - step["g"] @ (s["t_next"] - s["t"])
    yield "energy over a step", relative(energies[1] - energies[0] - given, energies), 64 * EPS
    sphere = k("inertia_of_point_step", {**s, "C": np.eye(family.dim), "turning": 0 * s["w"]})
    yield "a sphere gets no moment over a step", relative(sphere["moment"], sphere["p"] @ sphere["p"]), 64 * EPS
