"""Cables drawn as they hang: the catenary between two points, and points without one."""

import re

import funicular as fu
import numpy as np
import pytest

ROPE = {"element": "cable12", "elements": 24, "section": fu.Circle(radius=0.005),
        "material": fu.Material(youngs_modulus=1e11, poisson_ratio=0.3, density=7800)}


def hanging(gravity=(0, -9.81, 0), **given):
    scene = fu.Scene(gravity=gravity)
    values = ROPE | {"start": (0, 0, 0), "end": (40, 10, 5), "rest_length": 50.0, "shape": "hanging"} | given
    return scene, scene.cable("rope", **values)


@pytest.mark.parametrize("given", [{}, {"end": (40, -10, 0)}, {"rest_length": 41.6}, {"rest_length": 200.0},
                                   {"end": (1.0, 0, 0), "rest_length": 9.0}])
def test_a_hanging_cable_is_the_catenary_of_its_length(given):
    _, rope = hanging(**given)
    r, slope = rope.nodal_vectors[:, 0], rope.nodal_vectors[:, 1]
    assert np.abs(r[[0, -1]] - [rope.start, rope.end]).max() < 1e-13
    assert rope.stretch == pytest.approx(1, abs=1e-9)
    # the slope of a catenary grows by w / H with each metre
    along = np.array([rope.end[0], 0, rope.end[2]]) / np.hypot(rope.end[0], rope.end[2])
    tangent = slope[:, 1] / (slope @ along)
    assert np.ptp(np.diff(tangent)) < 2e-6 * np.diff(tangent).mean()
    assert np.abs(slope @ np.cross(along, [0, 1, 0])).max() < 1e-9


def test_sag_of_an_even_catenary():
    a = 20.0
    _, rope = hanging(end=(30, 0, 0), rest_length=2 * a * np.sinh(15 / a))
    assert rope.nodal_vectors[12, 0] == pytest.approx([15, -a * (np.cosh(15 / a) - 1), 0], abs=1e-8)


def test_it_hangs_along_the_scenes_gravity_and_is_free_of_stress_where_it_is_straight():
    scene, rope = hanging(gravity=(0, 0, -9.81), end=(40, 0, 0))
    assert rope.rest == "straight"
    assert rope.nodal_vectors[12, 0, 2] < -10
    other = scene.with_parts(scene.parts(), gravity=(0, -9.81, 0)).cables["rope"]
    assert other.nodal_vectors[12, 0, 1] == pytest.approx(rope.nodal_vectors[12, 0, 2])


def test_rest_is_near_and_needs_few_iterations():
    scene, rope = hanging()
    for s in (0, 50.0):
        scene.pin("rope", s=s)
    rest = scene.equilibrium()
    assert np.abs(rest["rope.position"] - rope.nodal_vectors[:, 0]).max() < 1e-2  # it resists bending beside its ends
    assert rest.iterations <= 8
    assert not rest.messages


def test_scene_files_keep_the_shape():
    scene, rope = hanging()
    again = fu.Scene.from_toml(scene.to_toml()).cables["rope"]
    assert 'shape = "hanging"' in scene.to_toml()
    assert np.array_equal(again.nodal_vectors, rope.nodal_vectors)


@pytest.mark.parametrize(("given", "cause"), [
    ({"gravity": (0, 0, 0)}, "cannot hang without gravity"),
    ({"end": (0, -30, 0)}, "its end is above or below its start"),
    ({"rest_length": 41.5}, "hangs only where rest_length is above the distance of its ends, 41.5"),
    ({"rest": "drawn"}, 'but rest="drawn"'),
    ({"rest_length": None}, "rest_length is missing"),
    ({"start": None, "end": None, "points": [(0, 0, 0), (20, 1, 0), (40, 0, 0)]}, 'has points and shape="hanging"'),
    ({"shape": "slack"}, "shape"),
    ({"element": "cable8p", "end": (40, 0, 0), "gravity": (0, 0, -9.81)}, "up (0, 1, 0) leaves the plane y = 0")])
def test_what_cannot_hang_is_refused(given, cause):
    with pytest.raises(fu.SceneError, match=re.escape(cause)):
        hanging(**given)
