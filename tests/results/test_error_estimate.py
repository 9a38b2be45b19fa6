"""Error estimates of a run with estimate=True, of steps and mesh, against much finer runs."""

import math

import numpy as np
import pytest
from funicular import Circle, Material, Piece, Ramp, Scene, load_run, load_scene
from funicular.results.trajectories import default_outputs, relative, trajectory

RUBBER = Material(youngs_modulus=5e6, poisson_ratio=0.0, density=1100)


def pendulum(elements=3, support=Scene.pin):
    scene = Scene()
    scene.cable("rod", start=(0, 0, 0), end=(1, 0, 0), elements=elements, element="cable8p",
                section=Circle(radius=0.02), material=RUBBER)
    support(scene, "rod", s=0)
    return scene


def motion(scene, run):
    return {name: trajectory(scene, run, name) for name in default_outputs(scene)}


def test_the_errors_of_steps_and_mesh_are_the_true_ones():
    """The reference has a sixteenth of the error of the steps, and a fraction of that of the mesh."""
    scene, settings = pendulum(), {"output_step": 0.02}
    run = scene.run(0.4, step=4e-3, estimate=True, **settings)
    fine, finer = pendulum(3), pendulum(24)
    exact = motion(fine, fine.run(0.4, tol=1e-8, **settings))
    true = motion(finer, finer.run(0.4, tol=1e-6, **settings))
    errors = run.report["errors"]
    assert errors["outputs"] == ["rod.tip"]
    assert errors["time"] == pytest.approx(relative(scene, motion(scene, run), exact), rel=0.15)
    assert errors["mesh"] == pytest.approx(relative(scene, exact, true), rel=0.5)
    assert errors["both"] == pytest.approx(relative(scene, motion(scene, run), true), rel=0.5)
    assert errors["cpu_s"] > 0
    assert "estimated error: " in run.summary()


def test_the_run_itself_is_the_same():
    plain, estimated = (pendulum().run(0.1, estimate=estimate) for estimate in (False, True))
    assert "errors" not in plain.report
    assert np.array_equal(plain["rod.nodal_vectors"], estimated["rod.nodal_vectors"])


def test_the_output_of_pieces_between_two_pins_is_their_middle():
    """A joint of unlike pieces has two nodes, so that the last node has another number than the last element ends."""
    scene = Scene()
    scene.cable("rod", start=(0, 0, 0), end=(1, 0, 0), element="cable8p", pieces=[
        Piece(length=0.5, section=Circle(radius=radius), material=RUBBER, elements=2) for radius in (0.02, 0.03)])
    for s in (0, 1):
        scene.pin("rod", s=s)
    assert default_outputs(scene) == ["rod.middle"]


def test_a_file_keeps_the_errors(tmp_path):
    scene = pendulum()
    scene.run_settings = {"save": str(tmp_path / "run.nc"), "tol": 1e-3}
    run = scene.run(0.1, estimate=True)
    again = load_run(tmp_path / "run.nc")
    assert again.report["errors"] == run.report["errors"]
    assert again.status == "completed"
    assert again.report["settings"]["estimate"] is True


def test_a_scene_without_cables_has_no_mesh():
    scene = Scene()
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 0), velocity=(1, 0, 0))
    errors = scene.run(0.1, estimate=True).report["errors"]
    assert errors["mesh"] == 0.0
    assert errors["time"] == errors["both"] < 1e-9


def test_a_state_that_is_given_is_of_one_mesh(tmp_path):
    scene = pendulum(support=Scene.clamp)
    run = scene.run(0.1, initial=scene.equilibrium(), estimate=True, save=tmp_path / "run.nc")
    for each in (run, load_run(tmp_path / "run.nc")):
        assert math.isnan(each.report["errors"]["mesh"])
        assert each.report["errors"]["time"] < 1e-3
        assert any("the error of the mesh is not estimated" in message for message in each.report["messages"])


def test_an_equilibrium_of_the_settings_is_found_on_both_meshes():
    scene = pendulum(support=Scene.clamp)
    scene.force("rod", s=1, value=(0, -1, 0), scale=Ramp(start=0, end=0.1, before=1, after=2))
    scene.motion("rod", s=1, displacement=("free", "free", 0))
    errors = scene.run(0.1, initial="equilibrium", estimate=True).report["errors"]
    assert 0 < errors["mesh"] < math.inf


def test_a_run_that_stops_early_is_not_estimated():
    scene = pendulum()
    scene.event("stop", quantity="rod.position.y", s=1.0, value=-0.01, action="stop")
    run = scene.run(0.1, estimate=True)
    assert "errors" not in run.report
    assert "the run's errors are not estimated: it ended with status \"event\"" in run.report["messages"]


def test_the_mesh_of_what_stays_at_rest_is_not_estimated():
    """A buoy rests in its current at (100, 40) m for a tenth of a second and moves by 7e-15 m."""
    run = load_scene("mooring").run(0.1, step=0.05, output_step=0.05, estimate=True)
    errors = run.report["errors"]
    assert errors["time"] == 0 and math.isnan(errors["mesh"]) and math.isnan(errors["both"])
    assert any('the error "mesh" is not estimated: nothing moves' in message for message in run.report["messages"])


def test_an_error_beside_no_motion_is_infinite():
    scene = pendulum()
    still, moved = np.ones((3, 3)), np.array([[1.0, 1, 1], [1, 1, 1], [1, 1, 3]])
    assert relative(scene, {"rod.tip": still + 1e-15}, {"rod.tip": still}) == 0
    assert relative(scene, {"rod.tip": still}, {"rod.tip": moved}) == 1
    assert relative(scene, {"rod.tip": still + 1}, {"rod.tip": still}) == math.inf
