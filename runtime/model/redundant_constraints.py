"""Redundant constraints: equations of joints that follow from others, found by the compliance H M^-1 H'."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..engine import Engine
from ..errors import SceneError
from .joints import JointFrictionModel, JointModel, JointStickingModel
from .model import Model

REDUNDANT, NEARLY_REDUNDANT = 1e-12, 1e-8
"""Pivots of the scaled compliance up to which an equation is redundant, or nearly so after a failed run."""
MAX_DENSE_EQUATIONS, SUSPECT_PIVOT = 100, 1e-6
"""Equations up to which a dense factorisation is faster; pivot below which rounding may matter."""
EPSILON = float(np.finfo(float).eps)
"""Rounding error of S; that of a pivot is this times the square of the sum of the coefficients."""
MIN_COEFFICIENT = 1e-6
"""Coefficient of an equation in another one, below which it is zero."""
PROBE_SIZE, PROBE_TOLERANCE = 1e-3, 1e-8
"""Displacement of a mechanism beside its start, and error of redundant equations there, as fractions of its size."""


def drop_redundant_rows(model: Model, engine: Engine) -> list[str]:
    """Remove redundant equations of joints, for an engine not yet started; return messages about them.

    Redundancy is checked in the drawn position and at a small displacement, since in a singular position a mechanism
    may move in two directions. The joint added last loses the equations; its force and moment are then those of a
    scene without them.

    Raises SceneError where slides or driven joints constrain the same motion, and for a start in a singular position.
    """
    _check_sticking(model)
    rows = _in_loops(model, two_riders=False)
    if not len(rows) or not engine.prepare():
        return []  # start reports a failure
    S, owner = _compliance(engine, rows), _owners(model)
    if S is None:
        return []  # likewise
    spare = _spare(model)
    if locked := [owner[k] for k, own in zip(rows, np.diag(S), strict=True) if own == 0 and k not in spare]:
        raise SceneError("scene", f"is over-constrained: {_listed(locked)} between points that supports fix already",
                         "leave that out, or the supports")
    follows = {int(rows[row]): [int(rows[k]) for k in others] for row, others in _following(S).items()}
    if not follows:
        return []
    _check_friction(model, follows, owner)
    dropped = [_left_out(model, row, others, owner) for row, others in follows.items()]
    for k, row in dropped:
        model.joints[k].redundant_rows.add(row)
    engine.redundant_rows(dropped)
    _check_that_they_follow(model, engine, dropped,
                            _listed([owner[k] for row in follows for k in (*follows[row], row)]))
    return [_message(model.joints[k], follows, owner) for k in dict.fromkeys(k for k, _ in dropped)]


def _check_friction(model: Model, follows: dict[int, list[int]], owner: list[str]) -> None:
    """Raise SceneError for friction by the force of a joint that others share, so that it is not determined."""
    shared = {owner[k] for row, others in follows.items() if _has_force(model, row) for k in (row, *others)}
    for friction in model.of(JointFrictionModel, JointStickingModel):
        if friction.needs_reactions and (name := f'joint "{friction.name}"') in shared:
            raise SceneError(name, "has friction by its force, which other joints share in a way that rigid bodies do "
                             "not determine", "give its normal_force, or leave out what over-constrains the scene")


def _check_sticking(model: Model) -> None:
    """Raise SceneError for friction of a joint that sticks in a loop of rigid bodies that something else holds, too."""
    sticking = model.of(JointStickingModel)
    if not sticking:
        return
    ends, n = [(joint, joint.attachments) for joint in model.joints], len(model.bodies) + 1
    edges = []
    for _, pair in ends:
        nodes = []
        for end in pair:
            nodes.append(n if end.cable >= 0 else end.body + 1)
            n += end.cable >= 0  # cables deform between their joints
        edges.append((nodes[0], nodes[1]))
    riders = [(0, slide.rider.body + 1) for slide in model.slides if slide.rider.cable < 0]
    in_loop = [not only for only in bridges(n, [*edges, *riders])]
    looped = {id(joint) for (joint, _), loops in zip(ends, in_loop, strict=False) if loops}
    held = [f'joint "{friction.name}"' for friction in sticking if id(friction.of) in looped]
    drives = [f'joint "{joint.name}"' for joint in model.joints if id(joint) in looped and joint.is_driven]
    drives += [f'slide "{slide.name}"' for slide, loops in zip(
        [each for each in model.slides if each.rider.cable < 0], in_loop[len(edges):], strict=True) if loops]
    if held and len(held) + len(drives) > 1:
        raise SceneError(held[0], f"has friction that sticks in a loop with {_listed([*held[1:], *drives])}: rigid "
                         "bodies do not determine what each of them holds at rest",
                         'take model="regularised" for all but one of them')


def _has_force(model: Model, multiplier: int) -> bool:
    """Return whether a multiplier is a force on points, of a slide or of a joint, and not a moment alone."""
    joint = next((each for each in model.joints if 0 <= multiplier - each.multiplier < each.rows), None)
    return joint is None or joint.moves_points(model.dim)[multiplier - joint.multiplier]


def _message(joint: JointModel, follows: dict[int, list[int]], owner: list[str]) -> str:
    """Return the message about a joint without some equations; follows: redundant rows, and those that imply them."""
    own = range(joint.multiplier, joint.multiplier + joint.rows)
    names = _listed([owner[other] for row in own for other in follows.get(row, ()) if other not in own])
    return (f"over-constrained: {len(joint.redundant_rows)} of the {joint.rows} equations of {owner[own[0]]} follow "
            f"from those of {names} and are left out, without force or moment of their own")


def _left_out(model: Model, row: int, others: list[int], owner: list[str]) -> tuple[int, int]:
    """Return the joint and its row that others imply. Raises SceneError for a row that cannot be removed."""
    names = _listed([owner[k] for k in (*others, row)])
    if _driven(model) & {row, *others}:
        raise SceneError("scene", f"is over-constrained: {names} drive or constrain the same motion",
                         "leave one of them out")
    for k, joint in enumerate(model.joints):
        if 0 <= row - joint.multiplier < joint.rows and joint.slide is None:
            return k, row - joint.multiplier
    raise SceneError("scene", f"is over-constrained: {names} constrain the same motion",
                     "leave one of them out, or attach the body at other points")


def _check_that_they_follow(model: Model, engine: Engine, dropped: list[tuple[int, int]], names: str) -> None:
    """Raise SceneError unless the other rows imply the dropped ones, at the start and beside it."""
    size = engine.extent
    unit = np.where(model.weight == 1, size, np.minimum(size / model.weight, 1.0))
    probe = PROBE_SIZE * unit * np.random.default_rng(0).uniform(-1, 1, model.n_dof)
    at_start, beside = (engine.probe_mechanism(along) for along in (np.zeros(model.n_dof), probe))
    gap, error = (np.inf if left is None else max(abs(left[at]) for at in dropped) for left in (at_start, beside))
    if gap > PROBE_TOLERANCE * min(size, 1.0):
        raise SceneError("scene", f"is over-constrained: {names} constrain the same motion, but do not fit together: "
                         f"{gap:.3g} (m or rad) are left between them",
                         "leave one of them out, or draw them without gaps")
    if error > PROBE_TOLERANCE * min(size, 1.0):
        raise SceneError("scene", f"starts in a singular position: {names} constrain the same motion there, but not "
                         "beside it",
                         "draw the scene a little away from it")


def redundant(model: Model, engine: Engine, ratio: float = NEARLY_REDUNDANT) -> str:
    """Return the names of slides and joints that nearly constrain the same motion at the time reached, "" for none."""
    rows = _in_loops(model, two_riders=True)
    if not len(rows):
        return ""
    S = _compliance(engine, rows)
    if S is None or not np.any(np.diag(S) > 0):
        return ""
    used = np.flatnonzero(np.diag(S) > 0)
    scale = 1 / np.sqrt(np.diag(S)[used])
    values, vectors = np.linalg.eigh(scale[:, None] * S[np.ix_(used, used)] * scale)
    nearly_free = values < ratio * values[-1]
    owner = _owners(model)
    shares = np.linalg.norm(vectors[:, nearly_free], axis=1)
    return _listed([owner[k] for k, part in zip(rows[used], shares, strict=True) if part > 1e-3])


def _in_loops(model: Model, *, two_riders: bool) -> np.ndarray:
    """Return the multipliers of constraints that may be redundant: of joints in loops, and of slides with them.

    Slides of different bodies alone are independent, as each acts on its own body, whose mass is not zero; they may be
    nearly dependent, and count with two_riders.
    """
    joints = [joint for joint, loops in zip(model.joints, joints_in_loops(model), strict=True) if loops]
    riders = [(slide.rider.body, slide.rider.cable) for slide in model.slides]
    alone = len(riders) < 2 if two_riders else len(set(riders)) == len(riders)
    slides = [] if alone and not joints else model.slides
    return np.array([k for part in (*slides, *joints)
                     for k in range(part.multiplier, part.multiplier + part.n_multipliers)], dtype=int)


def _compliance(engine: Engine, rows: np.ndarray) -> np.ndarray | None:
    """Return H M^-1 H' of these multipliers; None for a singular mass matrix or a state that is not finite."""
    try:
        S = engine.compliance(rows)
    except ArithmeticError:
        return None
    return S if np.isfinite(S).all() else None


def _following(S: np.ndarray) -> dict[int, list[int]]:
    """Return rows that are combinations of preceding rows, with these, by a row-wise Cholesky factorisation of S.

    A row of L begins where that of S does, so that the cost of rows of chains is constant; rows that close a loop
    involve all rows of the loop.
    """
    used = np.flatnonzero(np.diag(S) > 0)
    scale = 1 / np.sqrt(np.diag(S)[used])
    S = scale[:, None] * S[np.ix_(used, used)] * scale
    if len(S) <= MAX_DENSE_EQUATIONS and _is_definite(S):
        return {}
    from scipy.linalg import solve_triangular  # slow to import, and most runs do without

    L = np.zeros_like(S)
    kept = np.zeros(len(S), dtype=int)
    before = np.zeros(len(S) + 1, dtype=int)  # number of rows kept before each
    begins = (S != 0).argmax(axis=1)
    found: dict[int, list[int]] = {}
    n = 0
    for row, begin in enumerate(begins):
        before[row] = n
        first = before[begin]
        window, near = L[first:n, first:n], S[kept[first:n], row]
        factor = solve_triangular(window, near, lower=True, check_finite=False) if n > first else np.zeros(0)
        left = 1 - factor @ factor
        if left < SUSPECT_PIVOT:  # rows before the window contribute through those in it
            share = np.abs(solve_triangular(L[:n, :n].T, np.pad(factor, (first, 0)), check_finite=False))
            if left <= max(REDUNDANT, EPSILON * (1 + share.sum()) ** 2):
                found[int(used[row])] = used[kept[:n][share > MIN_COEFFICIENT]].tolist()
                continue
        L[n, first:n], L[n, n], kept[n] = factor, np.sqrt(left), row
        n += 1
    return found


def _is_definite(S: np.ndarray) -> bool:
    """Return whether the rows of a matrix with a unit diagonal are independent."""
    try:
        return bool(np.min(np.diag(np.linalg.cholesky(S)), initial=1.0) ** 2 > SUSPECT_PIVOT)
    except np.linalg.LinAlgError:
        return False


def _owners(model: Model) -> list[str]:
    """Return the part of each multiplier, as messages name it."""
    names = [""] * model.n_multipliers
    for slide in model.slides:
        count = slide.n_multipliers
        names[slide.multiplier : slide.multiplier + count] = [f'slide "{slide.name}"'] * count
    for joint in model.joints:
        kind = "joint" if joint.slide is None else "slide"
        names[joint.multiplier : joint.multiplier + joint.rows] = [f'{kind} "{joint.name}"'] * joint.rows
    return names


def _spare(model: Model) -> set[int]:
    """Return the multipliers of slides for sticking and for resting at an end, unused at the start."""
    return {k for slide in model.slides if slide.drive < 0
            for k in range(slide.multiplier + model.dim - 1, slide.multiplier + slide.n_multipliers)}


def _driven(model: Model) -> set[int]:
    """Return the multipliers of driven slides and joints: the last of each."""
    return ({slide.multiplier + slide.n_multipliers - 1 for slide in model.slides if slide.drive >= 0}
            | {joint.multiplier + joint.rows - 1 for joint in model.joints if joint.is_driven})


def _listed(names: list[str]) -> str:
    """Return the names as text, slides first, each once: slides "a" and "b" and joint "c"."""
    parts = []
    for kind in ("slide", "joint"):
        own = [name.split(" ", 1)[1] for name in dict.fromkeys(names) if name.startswith(kind)]
        if own:
            parts.append(f"{kind}{'s' * (len(own) > 1)} " + " and ".join(filter(None, [", ".join(own[:-1]), own[-1]])))
    return " and ".join(parts)


def joints_in_loops(model: Model) -> list[bool]:
    """Return for each joint whether it is part of a loop; the ground and all cables count as one node.

    Equations of a joint in no loop are independent of all others.
    """
    if not model.joints:
        return []
    edges = [(joint.attachments[0].body + 1, joint.attachments[1].body + 1) for joint in model.joints]
    riders = [(0, slide.rider.body + 1) for slide in model.slides]
    cut = bridges(len(model.bodies) + 1, [*edges, *riders])
    return [not cut[k] for k in range(len(edges))]


def bridges(n: int, edges: Sequence[tuple[int, int]]) -> list[bool]:
    """Return for each edge of a graph of n nodes whether it is the only connection of its ends (Tarjan 1974)."""
    beside: list[list[tuple[int, int]]] = [[] for _ in range(n)]
    for edge, (a, b) in enumerate(edges):
        beside[a].append((b, edge))
        beside[b].append((a, edge))
    found, lowest, cut = [-1] * n, [0] * n, [False] * len(edges)
    count = 0
    for root in range(n):
        path = [(root, -1, iter(beside[root]))] if found[root] < 0 else []
        while path:
            at, by, rest = path[-1]
            if found[at] < 0:
                found[at] = lowest[at] = count
                count += 1
            for other, edge in rest:
                if edge == by:
                    continue
                if found[other] < 0:
                    path.append((other, edge, iter(beside[other])))
                    break
                lowest[at] = min(lowest[at], found[other])
            else:
                path.pop()
                if path:
                    above = path[-1][0]
                    lowest[above] = min(lowest[above], lowest[at])
                    cut[by] = lowest[at] > found[above]
    return cut
