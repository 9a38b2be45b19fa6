"""Redundant constraints of closed chains are found at any number of bodies, at linear cost."""

import numpy as np
import pytest
import scipy.linalg
from funicular import Scene
from funicular.engine import Engine
from funicular.model.build import build
from funicular.model.redundant_constraints import drop_redundant_rows

LENGTH = 0.1


def ring(n: int, kind: str, **axis: tuple) -> Scene:
    """Return rods in a horizontal circle, joined to one another by this kind of joint, the first one to the ground."""
    scene = Scene(gravity=(0, -9.81, 0))
    angles, radius = 2 * np.pi * np.arange(n + 1) / n, LENGTH * n / (2 * np.pi)
    corners = radius * np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    middles = (corners[1:] + corners[:-1]) / 2
    for k, middle in enumerate(middles):
        scene.rigid_body(f"rod{k}", mass=0.1, inertia=(1e-4, 1e-4, 1e-4), position=tuple(middle))
    for k in range(n):
        other = (k + 1) % n
        scene.joint(kind, (f"rod{k}", tuple(corners[k + 1] - middles[k])),
                    (f"rod{other}", tuple(corners[k + 1] - middles[other])), **axis)
    scene.joint(kind, tuple(corners[0]), ("rod0", tuple(corners[0] - middles[0])), **axis)
    return scene


@pytest.mark.parametrize("n", [4, 50, 200])
def test_a_plane_ring_of_revolute_joints_has_three_redundant_equations(n):
    model = build(ring(n, "revolute", axis=(0, 0, 1)))
    messages = drop_redundant_rows(model, Engine(model))
    assert sum(len(joint.redundant_rows) for joint in model.joints) == 3
    assert len(messages) == 1 and "3 of the 5 equations" in messages[0]


@pytest.mark.parametrize("n", [5, 200])
def test_a_ring_of_spherical_joints_has_none(n):
    model = build(ring(n, "spherical"))
    assert drop_redundant_rows(model, Engine(model)) == []


def test_the_search_takes_a_window_of_the_rows_before(monkeypatch):
    """Each row, except those that close the loop, is coupled to neighbouring joints alone: the cost is linear."""
    sizes = []
    solve = scipy.linalg.solve_triangular

    def counted(matrix, *arguments, **options):
        sizes.append(len(matrix))
        return solve(matrix, *arguments, **options)

    monkeypatch.setattr(scipy.linalg, "solve_triangular", counted)
    n = 120
    model = build(ring(n, "spherical"))
    drop_redundant_rows(model, Engine(model))
    assert len(sizes) > 300 and sum(size > 12 for size in sizes) <= 6
