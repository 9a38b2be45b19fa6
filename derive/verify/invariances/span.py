"""Spans in cases known without derivation, and under motions of the frame."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import ElementFamily
from ..numbers import EPS, Numbers, State
from ..samples.shapes import reference, rotation
from .law import spun
from .measures import ORIGIN_SHIFT, Invariance, quantised, relative, spins

KERNELS = ("kinetic_energy", "inertia", "mass_matrix", "inertia_tangent", "energy", "elastic_force", "elastic_tangent",
           "dissipation", "damping_force", "damping_tangent", "line_force", "line_force_tangent")
"""Kernels that do not depend on the origin."""


def span(family: ElementFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield signs, symmetries, rigid motions, and a rope that flows along its own straight line."""
    yield from _signs(k, s)
    yield from _frame(family, k, s)
    yield from _deformed(family, k, s)
    yield from _straight_flow(family, k, s)
    yield from _line_force(family, k, s)


def _signs(k: Numbers, s: State) -> Iterator[Invariance]:
    rates = np.concatenate([s["v"].ravel(), s["s_rate"]])
    T, P, M = (k(kernel, s)[output] for kernel, output in (("kinetic_energy", "T"), ("dissipation", "P"),
                                                           ("mass_matrix", "M")))
    yield "T > 0 and P > 0", float(not (T[0] > 0 and P[0] > 0)), 0.0
    yield "M symmetric", relative(M - M.T, M), 8 * EPS
    yield "v . M v = 2 T", relative(rates @ M @ rates - 2 * T, 2 * T), 64 * EPS
    least = np.linalg.eigvalsh(M)[0]
    yield "M has no negative eigenvalue", max(0.0, -least / relative(M, 1)), 64 * EPS
    D = k("damping_tangent", s)["D"]
    yield "damping: D symmetric", relative(D - D.T, D), 64 * EPS
    yield "damping: v . D v = P", relative(rates @ D @ rates - P, P), 128 * EPS


def _frame(family: ElementFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield the changes by a turn of the whole scene, and by a shift far away."""
    spec = family.element
    Q = rotation(np.random.default_rng(3), spec.dim)
    turned = s | {name: s[name] @ Q.T for name in ("e", "v", "a", "g")}
    elastic = _stiffness(s)  # the size of forces and energies of strains of order one
    for kernel, output in (("kinetic_energy", "T"), ("energy", "U"), ("weight", "V"), ("dissipation", "P"),
                           ("inertia", "f_s"), ("elastic_force", "f_l"), ("damping_force", "f_s")):
        value = k(kernel, s)[output]
        scale = max(relative(value, 1), elastic if "elastic" in kernel or kernel == "energy" else 0.0)
        yield f"turned scene: same {output} of {kernel}", relative(k(kernel, turned)[output] - value, scale), 512 * EPS
    for kernel in ("inertia", "elastic_force", "damping_force"):
        value = k(kernel, s)["f"]
        scale = max(relative(value, 1), elastic if kernel == "elastic_force" else 0.0)
        yield f"turned scene: {kernel} turns", relative(k(kernel, turned)["f"] - value @ Q.T, scale), 512 * EPS
    near = s | {"e": quantised(s["e"])}
    positions = np.array(spec.is_position, dtype=float)
    away = near | {"e": near["e"] + np.outer(positions, np.full(spec.dim, ORIGIN_SHIFT))}
    for kernel in KERNELS:
        here, there = k(kernel, near), k(kernel, away)
        yield "same digits at 10⁴ lengths", max(float(np.max(np.abs(here[n] - there[n]))) for n in here), 0.0


def _stiffness(s: State) -> float:
    return float(max(s["A"][0], s["A"][1] / s["l"] ** 2))


def _deformed(family: ElementFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield the balance of forces, and what tangents make of rigid motions."""
    spec = family.element
    positions = np.array(spec.is_position, dtype=float)
    f, out = k("elastic_force", s), k("elastic_tangent", s)
    scale = max(relative(f["f"], 1), _stiffness(s))
    K, K_l = out["K"], out["K_l"]
    yield "no net elastic force", relative(positions @ f["f"], scale), 16 * EPS
    yield "tangent symmetric", relative(K - K.T, K), 0.0
    for i in range(spec.dim):
        shift = np.outer(positions, np.eye(spec.dim)[i]).ravel()
        yield "tangent null on translation", max(relative(K @ shift, K), relative(K_l.ravel() @ shift, K)), 16 * EPS
    arms = s["e"] - np.outer(positions, s["e"][0])
    for spin in spins(spec.dim):
        turn = (arms @ spin.T).ravel()
        yield "tangent turns the force", relative(K @ turn - (f["f"] @ spin.T).ravel(), K), 64 * EPS
        yield "dU/dl is the same in a turn", relative(K_l.ravel() @ turn, K), 64 * EPS
    damped = k("damping_force", s)["f"]
    yield "no net damping force", relative(positions @ damped, damped), 64 * EPS
    for spin in spins(spec.dim):
        rigid = s | {"v": arms @ spin.T + np.outer(positions, s["g"]), "s_rate": 0 * s["s_rate"]}
        P, f_s = k("dissipation", rigid)["P"], k("damping_force", rigid)["f_s"]
        if spec.dim == 3:
            left = P - spun(spec, s, spin)
            yield "rigid velocity is damped by the spin about the tangent alone", relative(left, scale * s["tau"]), \
                64 * EPS
        else:
            yield "rigid velocity is not damped", max(relative(P, scale * s["tau"]),
                                                      relative(f_s, scale * s["tau"])), 64 * EPS


def _straight_flow(family: ElementFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that both ends may flow along a straight, evenly stretched rope whose material is at rest: e' = r_S s'."""
    spec = family.element
    stretch = 1.1
    ends = np.array([float(ratio) for ratio in spec.node_ratios for _ in spec.nodal_vectors])
    positions = np.array(spec.is_position, dtype=float)
    Q = rotation(np.random.default_rng(5), spec.dim)
    e = reference(spec, float(s["l"])) @ Q.T * stretch + np.outer(positions, s["g"])
    slope = stretch * Q[:, 0]

    def flowing(of_ends: np.ndarray) -> np.ndarray:
        return np.outer(positions * (of_ends[0] + ends * (of_ends[1] - of_ends[0])), slope)

    flow = s | {"e": e, "v": flowing(s["s_rate"]), "a": flowing(s["s_acc"])}
    point, speed = k("point", flow), relative(s["s_rate"], 1)
    size = float(s["rho"] * s["l"]) * speed**2
    yield "rope at rest, ends flow: no velocity", relative(point["velocity"], speed), 32 * EPS
    yield "rope at rest, ends flow: no T", relative(k("kinetic_energy", flow)["T"], size), (64 * EPS) ** 2
    force = k("inertia", flow)
    yield "rope at rest, ends flow: no inertial force", max(
        relative(force["f"], size), relative(force["f_s"], size)), 512 * EPS
    power = float(s["tau"] * _stiffness(s)) * speed**2
    yield "rope at rest, ends flow: no damping", relative(k("dissipation", flow)["P"], power), (64 * EPS) ** 2
    elastic = k("elastic_force", flow)
    strain = stretch - 1
    closed = s["A"][0] * (strain**2 / 2 - strain * stretch)  # U = l EA (L/l - 1)^2/2 at a fixed distance L of the ends
    on_slopes = elastic["f"][[not p for p in spec.is_position]]
    yield "even stretch: dU/dl of a straight bar", relative(elastic["f_l"] - closed, closed), 256 * EPS
    yield "even stretch: no force on the slopes", relative(on_slopes, closed * s["l"]), 256 * EPS


def _line_force(family: ElementFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield the power of a force on the material, its balance, and a turned scene."""
    out, velocity = k("line_force", s), k("point", s)["velocity"]
    power = np.sum(out["f"] * s["v"]) + out["f_s"] @ s["s_rate"]
    expected = s["part"] * s["l"] * (s["F"] @ velocity)
    yield "line force: its power is F . velocity", relative(power - expected, out["f"]), 256 * EPS
    positions = np.array(family.element.is_position, dtype=float)
    yield "line force: on the positions F", relative(
        positions @ out["f"] - s["part"] * s["l"] * s["F"], out["f"]), 16 * EPS
    Q = rotation(np.random.default_rng(3), family.element.dim)
    turned = k("line_force", s | {"e": s["e"] @ Q.T, "F": Q @ s["F"]})
    yield "turned scene: line force turns", relative(turned["f"] - out["f"] @ Q.T, out["f"]), 256 * EPS
    yield "turned scene: same line force on the ends", relative(turned["f_s"] - out["f_s"], out["f_s"]), 512 * EPS
