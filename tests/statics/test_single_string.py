"""Strings between two fixed points: their shape against the catenary, their balance, and the search that uses them."""

import funicular as fu
import numpy as np
import pytest
from funicular.parts.hanging import catenary
from funicular.solve.statics import string_start
from funicular.solve.statics.single_string import rest_between
from funicular.solve.statics.string_nodes import StringNodes
from funicular.solve.statics.strings import Strings


def string(links: int, length: float, chord: tuple[float, ...], axial: float, bending: float = 0.0) -> Strings:
    """Return a string of equal links under a weight of 10 N/m."""
    n, dim = links + 1, len(chord)
    r, fixed, load = np.zeros((n, dim)), np.zeros((n, dim), dtype=bool), np.zeros((n, dim))
    r[-1], fixed[[0, -1]] = chord, True
    load[:, 1] = -10 * length / links
    at = np.arange(n)
    none = np.zeros((0, dim))
    return Strings(r, fixed, load, np.stack([at[:-1], at[1:]], axis=1), np.full(links, length / links),
                   np.full(links, axial), np.stack([at[:-2], at[1:-1], at[2:]], axis=1), np.ones((n - 2, 3)),
                   np.zeros((n - 2, dim)), np.full(n - 2, bending * length / links), np.zeros(0, dtype=int), none,
                   np.zeros(0), np.zeros(0))


@pytest.mark.parametrize("chord", [(100.0, 20.0), (100.0, -60.0, 30.0), (1.0, 0.0)])
@pytest.mark.parametrize("slack", [1.001, 1.3, 4.0])
def test_many_links_hang_along_the_catenary(chord, slack):
    length = slack * float(np.linalg.norm(chord))
    rest = rest_between(string(400, length, chord, 1e12))
    in_space = (*chord, 0.0)[:3]
    curve = catenary((0, 0, 0), in_space, length, (0, -9.81, 0))
    between = np.array([curve(u) for u in np.linspace(0, 1, 20001)])[:, : len(chord)]
    off = [np.linalg.norm(between - r, axis=1).min() for r in rest.r[:: 20]]
    assert max(off) < 2e-4 * length


@pytest.mark.parametrize(("length", "axial"), [(110.0, 1e4), (130.0, 1e3), (90.0, 1e5)])
def test_nodes_of_an_elastic_string_balance(length, axial):
    given = string(20, length, (100.0, 20.0), axial)
    d = np.diff(rest_between(given).r, axis=0)
    size = np.linalg.norm(d, axis=1)
    tension = (axial * (size / given.length - 1) / size)[:, None] * d
    assert np.diff(tension, axis=0) + given.load[1:-1] == pytest.approx(0, abs=1e-6 * 10 * length)


def test_a_stiff_rod_is_no_string():
    assert rest_between(string(20, 110.0, (100.0, 20.0), 1e9, bending=1e6)) is not None
    assert rest_between(string(20, 110.0, (100.0, 20.0), 1e9, bending=1e8)) is None


def line(element: str) -> fu.Scene:
    """Return a slack line drawn straight."""
    made = fu.Scene()
    made.cable("line", start=(0, 0, 0), end=(50, 8, 0), rest_length=60, elements=20, element=element,
               section=fu.Circle(radius=0.01),
               material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=4000))
    made.pin("line", s=0)
    made.pin("line", s=60)
    return made


@pytest.mark.parametrize("element", ["cable8p", "cable12", "beam24"])
def test_the_state_is_that_from_interior_points(element, monkeypatch):
    with monkeypatch.context() as without:
        without.setattr(string_start, "rest_of", None)
        found = line(element).equilibrium()
    monkeypatch.setattr(StringNodes, "is_alone", lambda self, group, q: False)
    other = line(element).equilibrium()
    assert found["line.nodal_vectors"] == pytest.approx(other["line.nodal_vectors"], abs=1e-9 * 60)
    assert found["line@0.force"] == pytest.approx(other["line@0.force"], rel=1e-7)
