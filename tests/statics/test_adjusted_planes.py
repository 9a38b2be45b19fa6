"""Adjusted scenes with uneven meshes, and with planar cables in planes other than z = 0."""

import re

import funicular as fu
import numpy as np
import pytest

NODES = [0, 1, 3, 6, 10, 15, 20.5, 26, 31, 35, 38, 40, 41]
TURNS = {
    "z": np.eye(3),
    "y": np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]),
    "oblique": np.array([[0.8, 0, 0.6], [0, 1, 0], [-0.6, 0, 0.8]]),
}
"""Axes of planes, as columns: x and y in the plane, and its normal; y is up."""


def hung(turn, nodes=NODES, **given):
    """Return a rope between two points in a plane, with a body on a spring at its middle."""
    axes = TURNS[turn]
    scene = fu.Scene(gravity=axes @ [0, -9.81, 0])
    mesh = {"elements": 12} if nodes is None else {"nodes": nodes}
    scene.cable("rope", start=axes @ [0, 2, 0], end=axes @ [40, 4, 0], rest_length=41.0, up=axes[:, 1],
                section=fu.Circle(radius=0.005), **mesh, **{"element": "cable8p"} | given,
                material=fu.Material(youngs_modulus=1e11, poisson_ratio=0.3, density=7800))
    for s in (0, 41.0):
        scene.pin("rope", s=s)
    scene.rigid_body("A", position=axes @ [20, -1, 0], mass=3.0, inertia=(0.1, 0.1, 0.1))
    scene.spring(("rope", 20.5), "A", name="drop", stiffness=1e5, length=2.0)
    return scene


def adjusted(scene, up):
    return scene.equilibrium(adjust=["drop.length", "rope.rest_length"],
                             to={f"A.position.{up}": -4.0, f"rope@20.5.position.{up}": -1.0})


@pytest.mark.parametrize("given", [{}, {"shape": "hanging"}, {"element": "beam12p"}])
@pytest.mark.parametrize("nodes", [NODES, None])
def test_an_adjusted_scene_is_the_same_in_every_plane(nodes, given):
    flat = adjusted(hung("z", nodes, **given), "y")
    assert flat["A.position"][1] == pytest.approx(-4, abs=1e-6)
    for turn, up in (("y", "z"), ("oblique", "y")):
        rest = adjusted(hung(turn, nodes, **given), up)
        assert rest.adjusted == pytest.approx(flat.adjusted, rel=1e-10)
        # one entry is zero; values are differenced over 1e-6 of the scene: rounding is 2e-10
        assert rest.adjustment.jacobian == pytest.approx(flat.adjustment.jacobian, rel=1e-6, abs=1e-9)
        assert rest["A.position"] == pytest.approx(TURNS[turn] @ flat["A.position"], abs=1e-9)


def test_nodes_keep_their_part_of_an_adjusted_length():
    rest = adjusted(hung("y"), "z")
    rope = rest.scene.cables["rope"]
    assert rope.length == rest.adjusted["rope.rest_length"] != 41.0
    assert rope.nodes == pytest.approx(np.array(NODES) * rope.length / 41.0)
    assert rest["rope.position"][6] == pytest.approx([rest["rope.position"][6, 0], 0, -1], abs=1e-6)
    run = rest.scene.run(duration=0.1, initial=rest, progress=False)
    assert np.ptp(run["A.position"], axis=0).max() < 1e-9


def test_derivatives_by_a_length_in_another_plane_are_those_of_other_equilibria():
    def value(length):
        scene = hung("oblique")
        nodes = np.array(NODES) * length / 41.0
        scene = scene.changed([(scene.cables["rope"], {"rest_length": length, "nodes": nodes.tolist()}),
                               (scene.pins[1], {"s": length}),
                               (scene.point_forces["drop"], {"a": ("rope", length / 2)})])
        return scene.equilibrium()["A.position"][1]

    scene = hung("oblique")
    rest = scene.equilibrium(adjust=["rope.rest_length"], to={"A.position.y": value(41.0)})
    slope = (value(41.001) - value(40.999)) / 0.002
    assert rest.adjustment.jacobian[0, 0] == pytest.approx(slope, rel=1e-5)


@pytest.mark.parametrize("turn, name", [("y", "rope.end.y"), ("z", "rope.end.z")])
def test_what_would_turn_the_plane_is_not_adjusted(turn, name):
    scene = hung(turn)
    with pytest.raises(fu.SceneError, match=re.escape("plane")):
        scene.equilibrium(adjust=[name], to={"A.position.x": 20.0})
