"""Paths along which relations differentiate: inputs of a kernel moved, or a root that shares nothing with it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np


def unit(like: np.ndarray, j: int) -> np.ndarray:
    """Return zeros with a one at entry j."""
    zeros = np.zeros(like.size, dtype=int)
    zeros[j] = 1
    return zeros.reshape(like.shape)


def from_kernel(kernel: str, output: str, **directions: Callable[..., Any]) -> Callable[..., Any]:
    """Return a path: the output of a kernel with some inputs moved by t times directions[name](state, j)."""
    def path(k, s, t, j):
        return k(kernel, s, **{name: s[name] + t * d(s, j) for name, d in directions.items()})[output]
    return path


def entry(name: str) -> Callable[..., Any]:
    """Return the direction of entry j of an input."""
    return lambda s, j: unit(s[name], j)


def along(path: Callable[..., Any], names: tuple[tuple[str, int], ...]) -> Callable[..., Any]:
    """Return the path of path(k, state) along entry j of several inputs side by side."""
    places = [(name, k) for name, size in names for k in range(size)]

    def moved(k, s, t, j):
        name, at = places[j]
        return path(k, s | {name: s[name] + (t * unit(s[name], at) if s[name].ndim else t)})

    return moved


def of(kernel: str, output: str) -> Callable[..., Any]:
    """Return the function of a state that is an output of a kernel."""
    return lambda k, s: k(kernel, s)[output]


def root(function: Callable[..., Any], *about) -> Callable[..., Any]:
    """Return a path of order 0: function(*about, state), which shares nothing with the derivation."""
    return lambda k, s, t, j: function(*about, s)


def half(path: Callable[..., Any]) -> Callable[..., Any]:
    """Return the path of half the value."""
    return lambda k, s, t, j: path(k, s, t, j) / 2
