"""Nodal vectors of a cable along a string: slopes, and sections without twist."""

from __future__ import annotations

import numpy as np


def slopes(r: np.ndarray, length: np.ndarray, ends: tuple[np.ndarray | None, np.ndarray | None]) -> np.ndarray:
    """Return (n, dim): r_x at nodes r (n, dim) of links of these lengths (n - 1,), by parabolas through neighbours.

    ends: unit vectors at the ends, None where these are unknown.
    """
    stretch = np.linalg.norm(np.diff(r, axis=0), axis=1) / length
    along = np.diff(r, axis=0) / (length * stretch)[:, None]
    found = np.empty_like(r)
    found[1:-1] = along[:-1] * length[1:, None] + along[1:] * length[:-1, None]
    for end, first, second in ((0, 0, 1), (-1, -1, -2)):
        known = ends[end]
        if known is None:
            known = along[first] if len(along) == 1 else 1.5 * along[first] - 0.5 * along[second]
        found[end] = known
    size = np.concatenate([stretch[:1], (stretch[:-1] + stretch[1:]) / 2, stretch[-1:]])
    return np.asarray(found * (size / np.maximum(np.linalg.norm(found, axis=1), np.finfo(float).tiny))[:, None])


def vectors_along(names: tuple[str, ...], was: np.ndarray, r: np.ndarray, slope: np.ndarray, s: np.ndarray,
                 end_is_held: bool) -> np.ndarray:
    """Return (n, vectors, dim): nodal vectors of a cable along r (n, dim) with slopes (n, dim); was: the previous ones.

    s (n,): arc-lengths in m. end_is_held: whether the section at the end is fixed: the twist is then uniform.
    """
    found, given = was.copy(), {name: was[:, k] for k, name in enumerate(names)}
    vectors = {"r": r, "r_x": slope}
    if "r_xx" in names:
        vectors["r_xx"] = np.gradient(slope, s, axis=0)
    if "r_z" in names:
        vectors |= dict(zip(("r_y", "r_z"), _sections(given, slope, s, end_is_held), strict=True))
    elif "r_y" in names:
        height = given["r_y"]
        side = np.sign(given["r_x"][:, 0] * height[:, 1] - given["r_x"][:, 1] * height[:, 0])
        vectors["r_y"] = _of_length(np.stack([-slope[:, 1], slope[:, 0]], axis=1) * side[:, None], height)
    for k, name in enumerate(names):
        found[:, k] = vectors[name]
    return found


def _of_length(directions: np.ndarray, like: np.ndarray) -> np.ndarray:
    lengths = [np.linalg.norm(of, axis=-1, keepdims=True) for of in (like, directions)]
    return np.asarray(directions * lengths[0] / lengths[1])


def _sections(given: dict[str, np.ndarray], slope: np.ndarray, s: np.ndarray,
              end_is_held: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return r_y and r_z (n, 3) orthogonal to the slopes, transported from node to node without twist."""
    along = slope / np.linalg.norm(slope, axis=1, keepdims=True)
    before = given["r_x"][0] / np.linalg.norm(given["r_x"][0])
    height, heights = given["r_y"][0], np.empty_like(slope)
    for k, after in enumerate(along):
        height = _turned(height, before, after)
        heights[k], before = height, after
    widths = np.cross(along, heights)
    if end_is_held:
        held = given["r_y"][-1]
        angle = np.arctan2(held @ widths[-1], held @ heights[-1]) * (s / s[-1])[:, None]
        heights, widths = (np.cos(angle) * heights + np.sin(angle) * widths,
                           np.cos(angle) * widths - np.sin(angle) * heights)
    return _of_length(heights, given["r_y"]), _of_length(widths, given["r_z"])


def _turned(vector: np.ndarray, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Return a vector after the smallest rotation of one unit vector to another."""
    axis, cosine = np.cross(before, after), float(before @ after)
    if cosine < -1 + 1e-12:
        return vector
    return vector + np.cross(axis, vector) + np.cross(axis, np.cross(axis, vector)) / (1 + cosine)
