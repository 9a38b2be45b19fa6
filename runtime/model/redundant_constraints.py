"""Redundant constraints: equations of joints that follow from others, found by the compliance H M^-1 H'."""

from __future__ import annotations

import numpy as np
from scipy.linalg import solve_triangular

from ..engine import Engine
from ..errors import SceneError
from .joints import JointModel
from .loops import joints_in_loops
from .model import Model

SAME, NEARLY = 1e-12, 1e-8
"""Of the compliance of an equation: what is left of it where others constrain the same motion; or nearly, if a run
failed."""

FEW, SUSPECT = 100, 1e-6
"""Equations up to which a dense factorisation is quicker; what is left of a compliance where its rounding may count."""

EPSILON = float(np.finfo(float).eps)
"""Rounding of S. Of what is left of an equation it is as much, times the square of the sum of the shares of others."""

SHARE = 1e-6
"""Of another equation in one that follows: less is none."""

PROBE, RETURN = 1e-3, 1e-8
"""How far a mechanism is moved, as a part of its size, to see whether an equation follows there, too; and how well."""


def drop_redundant_rows(model: Model, engine: Engine) -> list[str]:
    """Leave out equations of joints that follow from those of others; for an engine not yet started.

    Redundancy is sought where the scene is drawn and at a small displacement from there, since a mechanism may pass a
    position in which it is free to move in two directions. The joint that was added last loses the equations; its force
    and moment are then those of a scene without them. Returns messages about them.

    Raises SceneError where slides, or what drives joints, constrain the same, and for a start in a singular position.
    """
    rows = _in_loops(model, two_riders=False)
    if not len(rows) or not engine.prepare():
        return []  # where there are rows start says why
    S, owner = _compliance(engine, rows), _owners(model)
    if S is None:
        return []  # here, too
    spare = _spare(model)
    if locked := [owner[k] for k, own in zip(rows, np.diag(S), strict=True) if own == 0 and k not in spare]:
        raise SceneError("scene", f"is over-constrained: {_listed(locked)} between points that supports fix already",
                         "leave that out, or the supports")
    follows = {int(rows[row]): [int(rows[k]) for k in others] for row, others in _following(S).items()}
    if not follows:
        return []
    dropped = [_left_out(model, row, others, owner) for row, others in follows.items()]
    for k, row in dropped:
        model.joints[k].redundant_rows.add(row)
    engine.redundant_rows(dropped)
    _check_that_they_follow(model, engine, dropped,
                            _listed([owner[k] for row in follows for k in (*follows[row], row)]))
    return [_message(model.joints[k], follows, owner) for k in dict.fromkeys(k for k, _ in dropped)]


def _message(joint: JointModel, follows: dict[int, list[int]], owner: list[str]) -> str:
    """Return the message about a joint that has lost equations; follows: rows that others imply, and these."""
    own = range(joint.multiplier, joint.multiplier + joint.rows)
    names = _listed([owner[other] for row in own for other in follows.get(row, ()) if other not in own])
    return (f"over-constrained: {len(joint.redundant_rows)} of the {joint.rows} equations of {owner[own[0]]} follow "
            f"from those of {names} and are left out, without force or moment of their own")


def _left_out(model: Model, row: int, others: list[int], owner: list[str]) -> tuple[int, int]:
    """Return the joint and the row of it that others imply; raises SceneError where it has to stay."""
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
    """Raise SceneError unless dropped rows are met where the others are, at the start and beside it."""
    size = engine.extent
    unit = np.where(model.weight == 1, size, np.minimum(size / model.weight, 1.0))
    probe = PROBE * unit * np.random.default_rng(0).uniform(-1, 1, model.n_dof)
    at_start, beside = (engine.probe_mechanism(along) for along in (np.zeros(model.n_dof), probe))
    gap, error = (np.inf if left is None else max(abs(left[at]) for at in dropped) for left in (at_start, beside))
    if gap > RETURN * min(size, 1.0):
        raise SceneError("scene", f"is over-constrained: {names} constrain the same motion, but do not fit together: "
                         f"{gap:.3g} (m or rad) are left between them",
                         "leave one of them out, or draw them without gaps")
    if error > RETURN * min(size, 1.0):
        raise SceneError("scene", f"starts in a singular position: {names} constrain the same motion there, but not "
                         "beside it",
                         "draw the scene a little away from it")


def redundant(model: Model, engine: Engine, ratio: float = NEARLY) -> str:
    """Return names of slides and joints that constrain nearly the same motion at the time reached; "" without any."""
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
    """Return the multipliers whose constraints may follow from others: of joints in loops, and of slides with them.

    Slides of different bodies alone never do, as each acts on its own body, whose mass is not zero; they may nearly,
    and count with two_riders.
    """
    joints = [joint for joint, loops in zip(model.joints, joints_in_loops(model), strict=True) if loops]
    riders = [(slide.rider.body, slide.rider.cable) for slide in model.slides]
    alone = len(riders) < 2 if two_riders else len(set(riders)) == len(riders)
    slides = [] if alone and not joints else model.slides
    return np.array([k for part in (*slides, *joints)
                     for k in range(part.multiplier, part.multiplier + part.n_multipliers)], dtype=int)


def _compliance(engine: Engine, rows: np.ndarray) -> np.ndarray | None:
    """Return H M^-1 H' of these multipliers; None where the state is not finite, or the mass matrix singular."""
    try:
        S = engine.compliance(rows)
    except ArithmeticError:
        return None
    return S if np.isfinite(S).all() else None


def _following(S: np.ndarray) -> dict[int, list[int]]:
    """Return rows that are combinations of rows before them, and of which: by Cholesky's factors of S, row by row.

    A row of L begins where that of S does, so that the rows of chains and of what hangs from them cost no more the more
    there are; those that close loops take all rows of the loop.
    """
    used = np.flatnonzero(np.diag(S) > 0)
    scale = 1 / np.sqrt(np.diag(S)[used])
    S = scale[:, None] * S[np.ix_(used, used)] * scale
    if len(S) <= FEW and _is_definite(S):
        return {}
    L = np.zeros_like(S)
    kept, before = np.zeros(len(S), dtype=int), np.zeros(len(S) + 1, dtype=int)  # before: each row, how many are kept
    begins = (S != 0).argmax(axis=1)
    found: dict[int, list[int]] = {}
    n = 0
    for row, begin in enumerate(begins):
        before[row] = n
        first = before[begin]
        window, near = L[first:n, first:n], S[kept[first:n], row]
        factor = solve_triangular(window, near, lower=True, check_finite=False) if n > first else np.zeros(0)
        left = 1 - factor @ factor
        if left < SUSPECT:  # rows before the window have shares, too: through those in it
            share = np.abs(solve_triangular(L[:n, :n].T, np.pad(factor, (first, 0)), check_finite=False))
            if left <= max(SAME, EPSILON * (1 + share.sum()) ** 2):
                found[int(used[row])] = [int(used[k]) for k, part in zip(kept[:n], share, strict=True) if part > SHARE]
                continue
        L[n, first:n], L[n, n], kept[n] = factor, np.sqrt(left), row
        n += 1
    return found


def _is_definite(S: np.ndarray) -> bool:
    """Return whether no row of a matrix with a unit diagonal is a combination of others."""
    try:
        return bool(np.min(np.diag(np.linalg.cholesky(S)), initial=1.0) ** 2 > SUSPECT)
    except np.linalg.LinAlgError:
        return False


def _owners(model: Model) -> list[str]:
    """Return what each multiplier is of, as messages call it."""
    names = [""] * model.n_multipliers
    for slide in model.slides:
        count = slide.n_multipliers
        names[slide.multiplier : slide.multiplier + count] = [f'slide "{slide.name}"'] * count
    for joint in model.joints:
        kind = "joint" if joint.slide is None else "slide"
        names[joint.multiplier : joint.multiplier + joint.rows] = [f'{kind} "{joint.name}"'] * joint.rows
    return names


def _spare(model: Model) -> set[int]:
    """Return the multipliers that slides have for when they stick or rest at an end: nothing stands there yet."""
    return {k for slide in model.slides if slide.drive < 0
            for k in range(slide.multiplier + model.dim - 1, slide.multiplier + slide.n_multipliers)}


def _driven(model: Model) -> set[int]:
    """Return the multipliers of what signals drive: the last of each joint's."""
    return ({slide.multiplier + slide.n_multipliers - 1 for slide in model.slides if slide.drive >= 0}
            | {joint.multiplier + joint.rows - 1 for joint in model.joints if joint.is_driven})


def _listed(names: list[str]) -> str:
    """Return the names in words, slides first, each once: slides "a" and "b", or joint "c", or both."""
    parts = []
    for kind in ("slide", "joint"):
        own = [name.split(" ", 1)[1] for name in dict.fromkeys(names) if name.startswith(kind)]
        if own:
            parts.append(f"{kind}{'s' * (len(own) > 1)} " + " and ".join(filter(None, [", ".join(own[:-1]), own[-1]])))
    return " and ".join(parts)
