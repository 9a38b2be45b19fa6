"""Invariances of the kernels of a law under motions of the frame."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...algebra.gram import Gram
from ...codegen.family import LawFamily
from ...spec import Element
from ..numbers import EPS, Numbers, State
from ..references.element import Shape
from ..samples.shapes import reference, rotation
from .measures import ORIGIN_SHIFT, Invariance, quantised, relative, spins


def law(family: LawFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield the invariances of the kernels of a law under rigid motion."""
    yield from _rigid_motion(family, k, s)
    yield from _deformed(family, k, s)
    if "discrete_force" not in family.missing:
        yield from _step(family, k, s)
    if "damping_force" not in family.shared:
        yield from _damping(family, k, s)


def _rigid_motion(family: LawFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that rigid motion makes no strain: coordinates of size c keep chords, in lengths, to eps (1 + |c|/l)."""
    spec, random = family.element, np.random.default_rng(1)
    stiff = _stiffness(family, s)
    for far, where in ((0.0, ""), (1e4, " at 10⁴ lengths")):
        chord = EPS * (1 + far)
        for _ in range(3):
            at_rest = s.get("e0", reference(spec, float(s["l"])))
            e = at_rest @ rotation(random, spec.dim).T
            direction = random.normal(size=spec.dim)
            e[spec.is_position] += far * s["l"] * direction / np.linalg.norm(direction)
            U, f = k("energy", s, e=e)["U"], k("elastic_force", s, e=e)["f"]
            yield f"rigid motion stores no energy{where}", relative(U, stiff), 50 * chord**2
            yield f"rigid motion makes no force{where}", relative(f, stiff / s["l"]), 20 * chord


def _stiffness(family: LawFamily, s: State) -> float:
    """Return the energy of a strain of order one."""
    if family.traits.kind == "continuum" and not family.traits.straight:
        return float(np.max(np.abs(s["A"])))
    if family.traits.kind == "continuum":
        n = len(Gram(family.element).pairs)
        return float(np.max(np.abs(s["A"][-n * (n + 3) // 2 : -n])))
    if family.traits.kind == "structural":
        return float(np.max(s["S"]) * max(s["l"], 1 / s["l"]))
    EA, EI = s["A"][:2]
    return float(max(EA * s["l"], EI / s["l"]))


def _moment(e: np.ndarray, f: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """Return the moment of generalised forces about the first node: skew part of sum d (x) f."""
    d = e - np.outer(positions, e[0])
    product = d.T @ f
    return np.asarray(product - product.T)


def _deformed(family: LawFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    spec = family.element
    positions = np.array(spec.is_position, dtype=float)
    e = quantised(s["e"])
    away = e + np.outer(positions, np.full(spec.dim, ORIGIN_SHIFT))
    f, K = k("elastic_force", s, e=e)["f"], k("elastic_tangent", s, e=e)["K"]
    for at, where in ((e, ""), (away, " at 10⁴ lengths")):
        force = k("elastic_force", s, e=at)["f"]
        scale = max(np.max(np.abs(f)), _stiffness(family, s) / s["l"])
        yield f"no net force{where}", relative(positions @ force, scale), 8 * EPS
        yield f"no net moment{where}", relative(_moment(at, force, positions), scale * s["l"]), 64 * EPS
    yield "force, tangent: same digits at 10⁴ lengths", max(
        relative(k("elastic_force", s, e=away)["f"] - f, K), relative(k("elastic_tangent", s, e=away)["K"] - K, K)), 0.0
    yield "tangent symmetric", relative(K - K.T, K), 0.0
    for spin in spins(spec.dim):
        turn = (e - np.outer(positions, e[0])) @ spin.T
        yield "tangent turns the force", relative(K @ turn.ravel() - (f @ spin.T).ravel(), K), 32 * EPS
    for i in range(spec.dim):
        shift = np.outer(positions, np.eye(spec.dim)[i]).ravel()
        yield "tangent null on translation", relative(K @ shift, K), 8 * EPS


def _step(family: LawFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield the balances of forces and moments over a step."""
    spec = family.element
    positions = np.array(spec.is_position, dtype=float)
    e, e_next = quantised(s["e"]), quantised(s["e_next"])
    away = np.outer(positions, np.full(spec.dim, ORIGIN_SHIFT))
    f, back = k("discrete_force", s, e=e, e_next=e_next)["f"], k("discrete_force", s, e=e_next, e_next=e)["f"]
    scale = max(np.max(np.abs(f)), _stiffness(family, s) / s["l"])
    yield "step: no net force", relative(positions @ f, scale), 8 * EPS
    yield "step: no net moment about its middle", relative(
        _moment((e + e_next) / 2, f, positions), scale * s["l"]), 64 * EPS
    yield "step: the same force backwards", relative(back - f, scale), 16 * EPS
    far = k("discrete_force", s, e=e + away, e_next=e_next + away)["f"]
    yield "step: same digits at 10⁴ lengths", relative(far - f, scale), 0.0


def _damping(family: LawFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    spec = family.element
    positions = np.array(spec.is_position, dtype=float)
    scale = s["tau"] * _stiffness(family, s) / s["l"]
    relative_e = s["e"] - np.outer(positions, s["e"][0])
    f = k("damping_force", s)["f"]
    scale_f = max(scale, np.max(np.abs(f)))
    yield "damping: no net force", relative(positions @ f, scale_f), 64 * EPS
    twisted = spec.dim == 3 and family.traits.kind == "cable"
    for spin in spins(spec.dim):
        v = relative_e @ spin.T + np.outer(positions, s["g"])
        f_rigid, P = k("damping_force", s, v=v)["f"], k("dissipation", s, v=v)["P"]
        if twisted:
            left = float(P[0]) - spun(spec, s, spin)
            yield "rigid velocity is damped by the spin about the tangent alone", relative(left, scale), 64 * EPS
        else:
            yield "rigid velocity is not damped", max(relative(f_rigid, scale), relative(P, scale)), 64 * EPS
    if not twisted:
        yield "damping: no net moment", relative(_moment(s["e"], f, positions), scale_f), 64 * EPS
    if "algorithmic_force" not in family.not_own:
        pull = k("algorithmic_force", s)["f"]
        scale = max(_stiffness(family, s) / s["l"], np.max(np.abs(pull)))
        yield "algorithmic dissipation: no net force", relative(positions @ pull, scale), 64 * EPS
        if not twisted:
            yield "algorithmic dissipation: no net moment", relative(_moment(s["e"], pull, positions), scale), 64 * EPS
    power = float(k("dissipation", s)["P"][0])
    mismatch = abs(power - float(np.sum(s["v"] * f))) / power if power > 0 else np.inf
    yield "damping takes energy out: P = v . f > 0", mismatch, 32 * EPS


def spun(spec: Element, s: State, spin: np.ndarray) -> float:
    """Return the power on a bent cable whose sections do not follow its turn about the tangent i: EI tau (w.i)^2 |i x
    r''|^2.
    """
    omega = np.array([spin[2, 1], spin[0, 2], spin[1, 0]])
    shape, half, total = Shape(spec, s["l"].item()), float(s["l"]) / 2, 0.0
    for t, weight in zip(*np.polynomial.legendre.leggauss(max(p[0] for p in shape.powers) - 1), strict=True):
        r_x, r_xx = (shape((half * (1 + t), 0, 0), by).astype(float) @ s["e"] for by in ((1, 0, 0), (2, 0, 0)))
        i = r_x / np.linalg.norm(r_x)
        total += weight * half * (omega @ i) ** 2 * np.sum(np.cross(i, r_xx) ** 2)
    return float(s["tau"] * s["A"][1]) * total
