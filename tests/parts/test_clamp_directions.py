"""Clamps in a direction other than that drawn: the rest does not depend on the drawing."""

import funicular as fu
import numpy as np
import pytest
from expectations import energy_error, refused
from funicular.parts.scene_text import read
from interrupted_runs import check_file_and_resume

ELEMENTS = "cable12", "cable18", "cable8p", "beam24", "beam12p"
UP = {"beam24": (0, 0, 1), "cable12": (0, 0, 1), "cable18": (0, 0, 1)}
ANGLE = np.radians(40)
ALONG = np.array((np.cos(ANGLE), np.sin(ANGLE), 0.0))


def rod(element: str, end=(1.0, 0, 0), turn=None, **clamp) -> fu.Scene:
    """Return a thin rod clamped at its start; turn: of all vectors."""
    turned = (lambda vector: tuple(np.asarray(turn) @ vector)) if turn is not None else tuple
    scene = fu.Scene(gravity=turned((0, -9.81, 0)))
    law = {"law": "structural"} if element.startswith("beam") else {}
    scene.cable("w", start=(0, 0, 0), end=turned(end), element=element, elements=6,
                up=turned(UP.get(element, (0, 1, 0))), section=fu.Circle(radius=0.005), **law,
                material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.0, density=1000, damping_time=1e-3))
    scene.clamp("w", s=0, **{name: turned(value) if name == "direction" else value for name, value in clamp.items()})
    return scene


@pytest.mark.parametrize("fix", ["section", "all"])
@pytest.mark.parametrize("element", ELEMENTS)
def test_the_rest_is_that_of_a_rod_drawn_along_it(element, fix):
    drawn = rod(element, tuple(ALONG), fix=fix).equilibrium()
    given = rod(element, fix=fix, direction=tuple(3 * ALONG)).equilibrium()
    for name in ("w.position", "w@0.force", "w@0.moment"):
        assert given[name] == pytest.approx(np.asarray(drawn[name]), abs=1e-10), name
    frequencies = [np.asarray(rest.scene.modes(3, about=rest).frequency) for rest in (drawn, given)]
    assert frequencies[0] == pytest.approx(frequencies[1], rel=1e-8, abs=1e-4)


def test_a_section_turns_the_shortest_way_in_space():
    """Out of the plane of the drawing, and of a rectangular section."""
    scene = rod("beam24", direction=(1, 0.5, 0.7)).replace("w", section=fu.Rectangle(height=0.004, width=0.01))
    axes = scene.equilibrium()["w.nodal_vectors"][0, 1:]
    axes = axes / np.linalg.norm(axes, axis=1, keepdims=True)
    along, drawn = np.array((1, 0.5, 0.7)) / np.linalg.norm((1, 0.5, 0.7)), np.eye(3)[[0, 2, 1]] * [[1], [1], [-1]]
    axis = np.cross(drawn[0], along)
    assert np.cross(axes[1], axes[2]) == pytest.approx(along, abs=1e-12)
    for was, now in zip(drawn[1:], axes[1:], strict=True):
        assert axis @ was == pytest.approx(axis @ now, abs=1e-12)


def test_a_plane_in_space():
    """A planar rod in another plane."""
    turn = np.array(((1, 0, 0), (0, 0, -1), (0, 1, 0)))
    one, other = (rod("cable8p", turn=each, direction=tuple(ALONG)).equilibrium() for each in (None, turn))
    assert other["w.position"] == pytest.approx(np.asarray(one["w.position"]) @ turn.T, abs=1e-12)
    with refused('clamp on "w": direction (1, 0, 0.5) leaves the plane z = 0 of the cable8p cable '
                 '"w"; let it stay in the plane, or take spatial elements: "beam24", "cable12", "cable18"'):
        rod("cable8p", direction=(1, 0, 0.5))


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit", "energy"])
def test_motion_from_the_drawn_state(integrator):
    """It begins bent beside the clamp; the energy of this bend is in the balance."""
    step = {"step": 1e-4} if integrator == "energy" else {"tol": 1e-5}
    run = rod("cable8p", direction=(1, 0.2, 0)).run(duration=0.02, output_step=0.01, integrator=integrator, **step)
    assert run["energy.elastic"][0] > 0
    assert energy_error(run) < 1e-4
    r_x = run["w.nodal_vectors"][:, 0, 1]
    bound = 1e-4 if integrator == "radau" else 1e-12  # whose dependent dofs have the errors of its stages
    assert r_x[:, 1] / r_x[:, 0] == pytest.approx(np.full(len(r_x), 0.2), abs=bound)


def test_files_and_resume(tmp_path):
    scene = rod("cable12", direction=(1, 0.2, 0))
    assert read(scene.to_toml(), "scene", fu.Scene).to_toml() == scene.to_toml()
    check_file_and_resume(scene, tmp_path, 8, duration=0.01, tol=1e-4, output_step=0.0005)


def test_refusals():
    with refused('clamp on "w": direction (-1, 0, 0) is opposite to the tangent as drawn, (1, 0, 0), towards larger s; '
                 "draw the cable to leave the clamp in this direction"):
        rod("cable12", direction=(-1, 0, 0))
    with refused('clamp on "w": direction must not be zero'):
        rod("cable12", direction=(0, 0, 0))
    scene = rod("cable12", direction=(1, 0.2, 0))
    scene.cable("v", start=(-1, 0, 0), end=(0, 0, 0), element="cable12", elements=2, section=fu.Circle(radius=0.005),
                material=scene.cables["w"].material)
    scene.tie("v", s=1, to="w", at=0)
    with refused('clamp on "w": has a direction, and a rigid tie joins the node to another cable; give the tie '
                 'rotation="free", or draw the cables along the direction'):
        scene.run(duration=0.01)
