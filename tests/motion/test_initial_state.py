"""Runs from a given state: of another run, of an equilibrium, of arrays."""

import funicular as fu
import numpy as np
import pytest
from shared_scenes import one_rider

WIRE = {"section": fu.Circle(radius=0.005),
        "material": fu.Material(youngs_modulus=1e8, poisson_ratio=0.0, density=1000.0)}


def pendulum(element="cable8p", elements=4):
    scene = fu.Scene()
    wire = scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=elements, element=element, **WIRE)
    scene.pin(wire, s=0.0)
    return scene


@pytest.mark.parametrize("integrator", ["explicit", "radau"])
@pytest.mark.slow_cases("radau")
def test_a_run_goes_on_from_the_state_of_another(integrator):
    whole = one_rider().run(duration=0.2, tol=1e-9, output_step=0.1, integrator=integrator)
    rest = one_rider().run(duration=0.1, tol=1e-9, output_step=0.1, integrator=integrator, initial=whole.at(0.1))
    for name in ("A.position", "A.orientation", "A.velocity", "trolley.s", "wire.nodal_vectors", "wire.nodal_velocity"):
        np.testing.assert_allclose(rest[name][0], whole[name][1], atol=1e-9 * np.abs(whole[name]).max())
        close = 1e-5 if name == "wire.nodal_velocity" else 1e-7  # tol bounds positions; fast vibrations move slopes
        np.testing.assert_allclose(rest[name][1], whole[name][2], atol=close * np.abs(whole[name]).max())
    assert any("from a state of another run, at its t = 0.1 s" in note for note in rest.report["messages"])


def test_a_modal_body_goes_on_too():
    scene = fu.load_scene("paper52_modal")
    whole = scene.run(duration=0.1, tol=1e-8, output_step=0.05)
    rest = scene.run(duration=0.05, tol=1e-8, output_step=0.05, initial=whole.at(0.05))
    body = next(name.removesuffix(".modal_coordinates") for name in whole.keys() if "modal_coordinates" in name)
    for name in ("position", "orientation", "velocity", "modal_coordinates", "modal_velocities"):
        values = whole[f"{body}.{name}"]
        np.testing.assert_allclose(rest[f"{body}.{name}"][0], values[1], atol=1e-9 * np.abs(values).max())
        np.testing.assert_allclose(rest[f"{body}.{name}"][1], values[2], atol=2e-5 * np.abs(values).max())


def test_a_time_between_rows_is_refused_with_the_nearest():
    run = pendulum().run(duration=0.1, tol=1e-4, output_step=0.05)
    with pytest.raises(fu.UnknownResultError, match=r"no row at t = 0.06 s; the nearest is 0.05 s"):
        run.at(0.06)


def test_unevenly_stretched_cable_from_nodal_positions():
    """r = (s + c s², 0): a taut half and a slack one; elastic energy EA/2 ∫ (ε of Green)² ds in closed form."""
    c, scene = 0.05, pendulum(elements=8)
    s = np.linspace(0, 1, 9)
    position = np.stack([s + c * s**2, 0 * s, 0 * s], axis=1)
    run = scene.run(duration=1e-3, tol=1e-4, output_step=1e-3, initial={"wire.position": position})
    vectors = run["wire.nodal_vectors"][0]
    np.testing.assert_allclose(vectors[:, 1, 0], 1 + 2 * c * s, rtol=1e-12)
    strain = np.polynomial.Polynomial([0, 2 * c, 2 * c**2])  # ((1 + 2 c s)² - 1) / 2
    area = np.pi * 0.005**2
    assert run["energy.elastic"][0] == pytest.approx(1e8 * area / 2 * (strain**2).integ()(1.0), rel=1e-9)


def test_velocities_as_arrays_and_from_an_equilibrium():
    scene = pendulum()
    rest = scene.equilibrium()
    s = np.linspace(0, 1, 5)
    velocity = np.stack([s, 0 * s, 0 * s], axis=1)
    run = scene.run(duration=1e-3, tol=1e-6, output_step=1e-3,
                    initial={"wire.nodal_vectors": rest["wire.nodal_vectors"], "wire.velocity": velocity})
    np.testing.assert_allclose(run["wire.nodal_vectors"][0], rest["wire.nodal_vectors"], atol=1e-12)
    np.testing.assert_allclose(run["wire.nodal_velocity"][0][:, 0], velocity, atol=1e-12)
    np.testing.assert_allclose(run["wire.nodal_velocity"][0][:, 1, 0], 1.0, atol=1e-12)


@pytest.mark.parametrize(("arrays", "message"), [
    ({"wire.place": [0]}, 'initial: "wire.place" is no part of a state of this scene; known: wire.nodal'),
    ({"wire.position": np.zeros((4, 3))}, r'initial: "wire.position" must have the shape \(5, 3\), got \(4, 3\)'),
    ({"wire.position": [[k / 4, 0, 1] for k in range(5)]}, "leaves the plane z = 0"),
    ({"wire.position": [[k / 4 + 1, 0, 0] for k in range(5)]}, 'the state places node 0 of cable "wire" by 1 m'),
    ({"wire.velocity": [[0, 1, 0]] * 5}, 'the state moves node 0 of cable "wire" by 1 m/s'),
    ({"wire.position": "here"}, "must be an array of numbers"),
    ({"wire.position": np.full((5, 3), np.nan)}, "must be finite"),
    (3, "the state to start from must be one that equilibrium\\(\\) returned"),
    ("state", 'initial = "state" needs a state'),
])
def test_what_does_not_fit_is_refused(arrays, message):
    with pytest.raises(fu.SceneError, match=message):
        pendulum().run(duration=0.1, initial=arrays)


def test_sections_need_nodal_vectors():
    with pytest.raises(fu.SceneError, match=r'does not determine the rotations.*give "wire.nodal_vectors"'):
        pendulum("beam12p").run(duration=0.1, initial={"wire.position": np.zeros((5, 3))})


@pytest.mark.parametrize(("keyword", "remedy"), [("dt", "step"), ("t_end", "duration"), ("tolerance", "tol"),
                                                 ("solver", "integrator"), ("outputstep", "output_step")])
def test_other_programs_words_are_answered(keyword, remedy):
    with pytest.raises(fu.SceneError, match=rf'run: "{keyword}" is not known here; did you mean "{remedy}"\?'):
        pendulum().run(duration=0.1, **{keyword: 1.0})


def test_cables_that_are_tied_move_together():
    scene = pendulum()
    scene.cable("rest", start=(1, 0, 0), end=(2, 0, 0), elements=4, element="cable8p", **WIRE)
    scene.tie("wire", s=1.0, to="rest", at=0.0)
    s = np.linspace(0, 1, 5)
    stretched = np.stack([1.01 * s, 0 * s, 0 * s], axis=1)
    with pytest.raises(fu.SceneError, match="where a support or tie keeps it"):
        scene.run(duration=1e-3, initial={"wire.position": stretched})
    moved = {"wire.position": stretched, "rest.position": stretched + np.array([1.01, 0, 0])}
    run = scene.run(duration=1e-3, tol=1e-4, output_step=1e-3, initial=moved)
    np.testing.assert_allclose(run["rest.position"][0], moved["rest.position"], atol=1e-12)


def test_a_state_of_radau_fits_its_ties():
    """The iteration of radau leaves a difference of tied slopes of 1.3e-8 of the largest rate."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    damped = fu.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=1000, damping_time=1e-4)
    given = {"section": fu.Circle(radius=0.01), "material": damped}
    scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), nodes=[0, 0.2, 0.5, 1.0], law="poisson_split", **given)
    scene.cable("rope", start=(1, 0, 0), end=(1.5, 0, 0), rest_length=0.4975, elements=2, **given)
    scene.pin("wire", s=0)
    scene.pin("rope", s=0.4975)
    scene.tie("wire", s=1.0, to="rope", at=0.0)
    scene.spring(("wire", 1.0), (1, 0.3, 0), stiffness=1e4)
    settings = {"duration": 0.02, "tol": 1e-2, "output_step": 0.01, "integrator": "radau"}
    run = scene.run(**settings)
    later = scene.run(**settings, initial=run.at(0.02))
    assert later["wire.position"][0] == pytest.approx(run["wire.position"][-1], abs=1e-9)


@pytest.mark.parametrize("integrator", ["explicit", "genalpha", "radau"])
def test_closing_a_gap_does_not_stretch_friction(integrator):
    """A driven rod pulls a sledge on a rough floor: a start 5 mm off its length gives the motion of an exact start."""
    y = 0.1 - 2 * 9.81 / 4e4  # on two springs of contact
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.surface("floor", fu.Plane(point=(0, 0, 0), normal=(0, 1, 0)))
    scene.rigid_body("sledge", mass=2.0, inertia=(1, 1, 1), position=(1, y, 0))
    scene.contact("sledge", "floor", points=[(-0.2, -0.1, 0), (0.2, -0.1, 0)], stiffness=2e4, friction=0.3)
    scene.joint("distance", (0, y, 0), "sledge", distance=fu.Ramp(start=0, end=1, before=1.0, after=1.5), name="rod")
    near, there, far = (scene.run(0.04, output_step=0.01, tol=1e-4, integrator=integrator,
                                  initial={"sledge.position": (x, y, 0)}) for x in (0.995, 1.0, 1.005))
    for run in (near, far):
        assert run.report["messages"] == ["gaps of joints were closed at the start: things moved by up to 0.005 m"]
        np.testing.assert_allclose(run["rod.force"], there["rod.force"], atol=1e-9)
    assert there["rod.force"][0, 0] == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize(("friction", "noted"), [(0.3, True), (None, False)])
def test_friction_springs_of_a_state_begin_unstretched_and_a_message_says_so(friction, noted):
    scene = fu.Scene()
    scene.surface("ground", fu.Plane())
    scene.rigid_body("A", mass=1.0, inertia=(0.01, 0.01, 0.01), position=(0, 0, 0), velocity=(1, 0, 0))
    scene.contact("A", "ground", stiffness=1e4, friction=friction, name="sole")
    settings = {"duration": 0.02, "tol": 1e-4, "output_step": 0.01}
    later = scene.run(**settings, initial=scene.run(**settings).at(0.01))
    assert any('springs of "sole" begin unstretched' in note for note in later.report["messages"]) == noted
