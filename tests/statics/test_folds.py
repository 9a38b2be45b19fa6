"""Elements folded onto themselves: the search for equilibrium avoids them, and results report them."""

import warnings

import numpy as np
import pytest
from funicular import Circle, FunicularWarning, Material, Scene
from funicular.model.build import build
from funicular.parts.in_plane import in_plane
from funicular.solve.notes.folds import Folds
from scipy.optimize import brentq
from shared_scenes import cable_scene

SOFT = Material(youngs_modulus=1e6, poisson_ratio=0.5, density=1000)


def crossing_ropes(elements: int) -> Scene:
    """Return two hanging ropes that cross, the supports of the upper one 70 mm below their drawn places."""
    scene = Scene(gravity=(0, 0, -9.81))
    for name, (x, y), z, down in (("lower", (0.4, 0), 0.0, 0.0), ("upper", (0, 0.4), 0.02, 0.07)):
        scene.cable(name, start=(-x, -y, z), end=(x, y, z), rest_length=1.0, shape="hanging", elements=elements,
                    element="cable12", law="engineering_exact", rest="straight", section=Circle(radius=0.005),
                    material=SOFT)
        for s in (0.0, 1.0):
            scene.motion(name, s=s, displacement=(0, 0, -down))
    scene.crossing("upper", "lower", stiffness=1e5, name="crossing")
    return scene


@pytest.mark.parametrize("seek_stable", [True, False])
@pytest.mark.parametrize("elements", [10, 16, 20, 22, 28])
def test_a_rope_whose_supports_are_moved_past_its_nodes_is_not_folded(elements, seek_stable):
    """The force between the ropes converges with the mesh; folded elements gave 0 or 0.077 N."""
    rest = crossing_ropes(elements).equilibrium(seek_stable=seek_stable)
    assert rest["crossing.normal_force"] == pytest.approx(0.188161, rel=0.012)
    assert rest["crossing.s"] == pytest.approx(0.5, abs=1e-6)
    assert rest.stable and not any("folded" in message for message in rest.messages)


def pushed_back(way) -> Scene:
    """Return a weightless wire whose last element is compressed along its axis to nearly zero by its support."""
    scene = cable_scene(pins=(0, 0.75), gravity=(0, 0, 0), elements=4, element="cable12", material=SOFT,
                        section=Circle(radius=0.005))
    scene.motion("wire", s=1.0, displacement=(way, 0, 0))
    return scene


def test_rows_of_a_run_tell_of_the_element_that_is_folded_most_and_when():
    scene = in_plane(cable_scene(elements=4, element="cable12"))
    model = build(scene)
    q = np.repeat(model.q[None], 3, axis=0)
    last = q[:, model.cables[0].coordinates].reshape(3, *model.cables[0].shape)
    last[1:, -1, 0, 0] = 0.8, 0.76
    q[:, model.cables[0].coordinates] = last.reshape(3, -1)
    found = Folds(scene, model)
    found.see({"q": q[:2], "time": np.array([0.0, 0.1])})
    found.see({"q": q[2:], "time": np.array([0.2])})
    [told] = found.notes()
    assert told.startswith('cable "wire" is folded onto itself in element 3, from s = 0.75 m to 1 m')
    assert "at t = 0.2 s" in told and "Take more elements there" in told


def with_last_node_at(scene: Scene, x: float, slope: float) -> list[str]:
    """Return the notes on the drawn wire of four elements after a change of its last node and all slopes."""
    model = build(in_plane(scene))
    cable = model.cables[0]
    vectors = model.q[cable.coordinates].reshape(cable.shape)
    vectors[-1, 0, 0] = x
    vectors[-2:, 1, 0] = slope
    found = Folds(in_plane(scene), model)
    found.see_rest({"q": model.q[None], "time": np.zeros(1)}, engine=None)
    return found.notes_at_rest()


def test_an_element_that_is_compressed_evenly_or_drawn_bent_is_not_folded():
    scene = cable_scene(elements=4, element="cable12")
    assert not with_last_node_at(scene, 1.0, 1.0)
    assert not with_last_node_at(scene, 0.9, 0.6)
    [told] = with_last_node_at(scene, 0.8, 1.0)
    assert "begin from another state" in told and "in element 3" in told
    assert not with_last_node_at(cable_scene(elements=4, element="cable12", membrane="tension_only"), 0.76, 1.0)


def test_a_ring_of_few_elements_is_not_folded():
    scene = Scene(gravity=(0, 0, 0))
    u = np.linspace(0, 4, 33)
    points = np.stack([np.cos(u), np.sin(u), np.zeros(33)], axis=1)
    scene.cable("arc", points=points, elements=1, element="cable12", section=Circle(radius=0.005), material=SOFT)
    model = build(in_plane(scene))
    found = Folds(in_plane(scene), model)
    found.see({"q": model.q[None], "time": np.zeros(1)})
    assert not found.notes()


def test_a_state_of_rest_with_a_folded_element_tells_of_it():
    with pytest.warns(FunicularWarning, match="folded onto itself in element 3"):
        rest = pushed_back(-0.24).equilibrium()
    assert any("folded" in message for message in rest.messages)


@pytest.mark.parametrize(("elements", "told"), [(4, 1), (5, 1), (6, 1), (8, 0), (20, 0)])
def test_elements_that_turn_far_at_rest_are_told(elements, told):
    """A rope of 30 m over a span of 10 m: with the note, the error of the horizontal force exceeds 7 %."""
    scene = Scene()
    rope = scene.cable("rope", start=(0, 0, 0), end=(10, 0, 0), rest_length=30, shape="hanging", elements=elements,
                       element="cable12", section=Circle(radius=0.01),
                       material=Material(youngs_modulus=1e7, poisson_ratio=0, density=2000))
    for s in (0.0, 30.0):
        scene.pin(rope, s=s)
    a = brentq(lambda a: 2 * a * np.sinh(5 / a) - 30, 1, 5)
    exact = -2000 * np.pi * 1e-4 * 9.81 * a
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FunicularWarning)
        rest = scene.equilibrium()
    assert sum("degrees within element" in message for message in rest.messages) == told
    assert (abs(rest["rope@0.force"][0] / exact - 1) > 0.07) == told


def test_a_length_that_only_few_elements_find_is_told():
    """A hanging rope pulls at its pins; a shape that pushes with 50 N exists for few elements only."""
    scene = Scene()
    rope = scene.cable("rope", start=(0, 0, 0), end=(10, 0, 0), rest_length=10.2, elements=10, element="cable12",
                       section=Circle(radius=0.01),
                       material=Material(youngs_modulus=1e7, poisson_ratio=0, density=2000))
    for s in (0.0, 10.2):
        scene.pin(rope, s=s)
    with pytest.warns(FunicularWarning, match="turns by 102 degrees within element [45]"):
        scene.equilibrium(adjust=["rope.rest_length"], to={"rope@0.force.x": 50.0})
