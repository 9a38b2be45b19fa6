"""What no motion of the frame may change: invariances of an element's and a body's kernels in C.

Each is (text, error, ceiling), the error relative to the scale that the text's quantity has in the sample.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...algebra.gram import Gram
from ...spec import Element, Family, x, y, z
from ..motion import RIDERS
from ..numbers import EPS, Numbers, State
from ..states import reference, rotation

Invariance = tuple[str, float, float]
FAR = 2.0**13  # above 10^4 lengths of the sample element; a power of two, so that moving there rounds nothing


def invariances(family: Family, k: Numbers, states: list[State]) -> Iterator[Invariance]:
    """The invariances of a family; the worst of each over its states is up to the caller."""
    from ..relations.joint import frame_invariances, joint_invariances, resistance_invariances
    from ..relations.modal import invariances as modal
    from ..relations.spring import invariances as spring
    from .slide import slide

    table = {"element": element, "law": law, "slide": slide, "body": body, "modal": modal,
             "frame": frame_invariances, "joint": joint_invariances, "resistance": resistance_invariances,
             "spring": spring}
    for s in states:
        yield from table[family.role](family, k, s)


def quantised(values: np.ndarray) -> np.ndarray:
    """Rounded to 2^-20, so that adding FAR is exact."""
    return np.round(values * 2.0**20) / 2.0**20


def relative(value, scale) -> float:
    """Largest entry over the scale's largest."""
    return float(np.max(np.abs(value)) / np.max(np.abs(scale)))


def element(family: Family, k: Numbers, s: State) -> Iterator[Invariance]:
    """Partition of unity, totals, loads."""
    from ..relations.load import invariances

    yield from _shape_and_mass(family, k, s)
    yield from invariances(family.element, k, s)


def law(family: Family, k: Numbers, s: State) -> Iterator[Invariance]:
    """Rigid motion in every kernel."""
    yield from _rigid_motion(family, k, s)
    yield from _deformed(family, k, s)
    if "discrete_force" not in family.lacks:
        yield from _step(family, k, s)
    if not family.shared:
        yield from _damping(family, k, s)


def _shape_and_mass(family: Family, k: Numbers, s: State) -> Iterator[Invariance]:
    spec = family.element
    at_nodes = np.array(spec.is_position, dtype=float)
    e0 = reference(spec, float(s["l"]))
    held = np.array([c in spec.basis for c in (x, y, z)][: spec.dim], dtype=float)
    for part in (0.0, 0.31, 0.5, 1.0):
        at = np.array([part * s["l"], 0.1, -0.07])
        out = k("position", s, at=at, e=e0)
        yield "partition of unity", abs(out["N"].dot(at_nodes) - 1), 4 * EPS
        yield "the reference is reproduced", relative(out["r"] - held * at[: spec.dim], s["l"]), 4 * EPS
    total = s["density"] * s["section"][0] * s["l"]
    m = k("mass", s)["m"]
    yield "mass total is ρ A l", abs(at_nodes.dot(m).dot(at_nodes) / total - 1), 8 * EPS
    yield "mass symmetric", relative(m - m.T, m), 0.0
    least = float(np.linalg.eigvalsh(m)[0]) if np.isfinite(m).all() else -np.inf
    yield "mass positive definite (least eigenvalue below zero)", max(-least, 0.0), 0.0
    Q = k("gravity", s)["Q"]
    yield "gravity total is ρ A l g", relative(at_nodes.dot(Q) - total * s["g"], total * s["g"]), 8 * EPS


def _rigid_motion(family: Family, k: Numbers, s: State) -> Iterator[Invariance]:
    """Moved without strain: coordinates of size c hold chords, in lengths, to eps (1 + |c|/l)."""
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


def _stiffness(family: Family, s: State) -> float:
    """Energy of a strain of order one."""
    if family.like == "continuum":
        return float(np.max(np.abs(s["A"])))
    if family.law == "continuum_curved":
        n = len(Gram(family.element).pairs)
        return float(np.max(np.abs(s["A"][-n * (n + 3) // 2 : -n])))
    if family.law == "structural":
        return float(np.max(s["S"]) * max(s["l"], 1 / s["l"]))
    EA, EI = s["A"][:2]
    return float(max(EA * s["l"], EI / s["l"]))


def _moment(e: np.ndarray, f: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """Moment of generalised forces about the first node: skew part of sum d (x) f."""
    d = e - np.outer(positions, e[0])
    product = d.T @ f
    return product - product.T


def _deformed(family: Family, k: Numbers, s: State) -> Iterator[Invariance]:
    spec = family.element
    positions = np.array(spec.is_position, dtype=float)
    e = quantised(s["e"])
    away = e + np.outer(positions, np.full(spec.dim, FAR))
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


def _step(family: Family, k: Numbers, s: State) -> Iterator[Invariance]:
    """Momenta over a step."""
    spec = family.element
    positions = np.array(spec.is_position, dtype=float)
    e, e_next = quantised(s["e"]), quantised(s["e_next"])
    away = np.outer(positions, np.full(spec.dim, FAR))
    f, back = k("discrete_force", s, e=e, e_next=e_next)["f"], k("discrete_force", s, e=e_next, e_next=e)["f"]
    scale = max(np.max(np.abs(f)), _stiffness(family, s) / s["l"])
    yield "step: no net force", relative(positions @ f, scale), 8 * EPS
    yield "step: no net moment about its middle", relative(
        _moment((e + e_next) / 2, f, positions), scale * s["l"]), 64 * EPS
    yield "step: the same force backwards", relative(back - f, scale), 16 * EPS
    far = k("discrete_force", s, e=e + away, e_next=e_next + away)["f"]
    yield "step: same digits at 10⁴ lengths", relative(far - f, scale), 0.0


def spins(dim: int) -> list[np.ndarray]:
    """Infinitesimal rotations in every coordinate plane."""
    found = []
    for i in range(dim):
        for j in range(i):
            spin = np.zeros((dim, dim))
            spin[i, j], spin[j, i] = 1.0, -1.0
            found.append(spin)
    return found


def _damping(family: Family, k: Numbers, s: State) -> Iterator[Invariance]:
    spec = family.element
    positions = np.array(spec.is_position, dtype=float)
    scale = s["tau"] * _stiffness(family, s) / s["l"]
    relative_e = s["e"] - np.outer(positions, s["e"][0])
    f = k("damping_force", s)["f"]
    scale_f = max(scale, np.max(np.abs(f)))
    yield "damping: no net force", relative(positions @ f, scale_f), 64 * EPS
    twisted = spec.dim == 3 and family.like not in ("continuum", "continuum_curved", "structural")
    for spin in spins(spec.dim):
        v = relative_e @ spin.T + np.outer(positions, s["g"])
        f_rigid, P = k("damping_force", s, v=v)["f"], k("dissipation", s, v=v)["P"]
        if twisted:
            left = float(P[0]) - _spun(spec, s, spin)
            yield "rigid velocity is damped by the spin about the tangent alone", relative(left, scale), 64 * EPS
        else:
            yield "rigid velocity is not damped", max(relative(f_rigid, scale), relative(P, scale)), 64 * EPS
    if not twisted:
        yield "damping: no net moment", relative(_moment(s["e"], f, positions), scale_f), 64 * EPS
    if "algorithmic_force" not in family.lacks:
        pull = k("algorithmic_force", s)["f"]
        scale = max(_stiffness(family, s) / s["l"], np.max(np.abs(pull)))
        yield "algorithmic dissipation: no net force", relative(positions @ pull, scale), 64 * EPS
        if not twisted:
            yield "algorithmic dissipation: no net moment", relative(_moment(s["e"], pull, positions), scale), 64 * EPS
    P = float(k("dissipation", s)["P"][0])
    mismatch = abs(P - np.sum(s["v"] * f)) / P if P > 0 else np.inf
    yield "damping takes energy out: P = v . f > 0", mismatch, 32 * EPS


def _spun(spec: Element, s: State, spin: np.ndarray) -> float:
    """Power on a bent cable whose sections do not follow its turn about the tangent i: EI tau (w.i)^2 |i x r''|^2."""
    from ..references.element import Shape

    omega = np.array([spin[2, 1], spin[0, 2], spin[1, 0]])
    shape, half, total = Shape(spec, s["l"].item()), float(s["l"]) / 2, 0.0
    for t, weight in zip(*np.polynomial.legendre.leggauss(max(p[0] for p in shape.powers) - 1), strict=True):
        r_x, r_xx = (shape((half * (1 + t), 0, 0), by).astype(float) @ s["e"] for by in ((1, 0, 0), (2, 0, 0)))
        i = r_x / np.linalg.norm(r_x)
        total += weight * half * (omega @ i) ** 2 * np.sum(np.cross(i, r_xx) ** 2)
    return float(s["tau"] * s["A"][1]) * total


def body(family: Family, k: Numbers, s: State) -> Iterator[Invariance]:
    """Lengths, power, digits far away."""
    rider = RIDERS[family.rider]
    dim, n = rider.dim, rider.n_velocity
    out, force = k("point", s), k("point_force", s)
    distance = np.linalg.norm(out["p"] - s["b"][:dim])
    yield "the point keeps its distance", abs(distance / np.linalg.norm(s["u"]) - 1), 8 * EPS
    yield "velocity is p_q w", relative(out["v"] - out["p_q"] @ s["w"], out["v"]), 8 * EPS
    b = np.concatenate([quantised(s["b"][:dim]) + FAR, s["b"][dim:]])
    away = k("point", s, b=b)
    arm = rider.point(np.concatenate([np.zeros(dim), s["b"][dim:]]), s["u"])
    yield "position at 10⁴ lengths", relative(away["p"] - b[:dim] - arm, b[:dim]), 2 * EPS
    yield "derivatives: same digits at 10⁴ lengths", max(
        *(relative(away[name] - out[name], out[name]) for name in ("p_q", "v", "bias")),
        relative(k("point_force", s, b=b)["K"] - force["K"], force["K"])), 0.0
    turning = force["K"][dim:, dim:]
    bracket = rider.bracket((force["p_q"].T @ s["f"])[dim:])
    yield "K symmetric, but for the bracket of rotations", relative(turning - turning.T - bracket, turning), 16 * EPS
    f = k("inertia_force", s)["f"]
    still = k("inertia_force", s, a=np.zeros(n))["f"]
    M = k("inertia_tangent", s)["M"]
    yield "the gyroscopic moment does no work", abs(still @ s["w"]) / relative(f, 1), 32 * EPS
    yield "f . w is the rate of the kinetic energy", abs(f @ s["w"] - s["w"] @ M @ s["a"]) / relative(f, 1), 64 * EPS
    from ..relations.moves import invariances as moves

    yield from moves(rider, k, s)
    T = k("kinetic_energy", s)["T"][0]
    yield "kinetic energy is w . M w / 2", abs(s["w"] @ M @ s["w"] / 2 / T - 1), 8 * EPS
