"""Prescribed angles beyond half a turn: the twist of a rod, and the curl of a cable, by closed forms."""

import numpy as np
import pytest
from funicular import Circle, EquilibriumError, Material, Ramp, Scene, SceneError
from numpy.testing import assert_allclose

GJ = 1e7 / 2.6 * np.pi * 0.01**4 / 2
"""Of the rod, N m²; it is 1 m long, so that this is its moment at 1 rad."""
EI = 1e7 * np.pi * 0.01**4 / 4


def rod(kind, angle, elements=16, damping_time=0.0):
    """Return a round rod along x, clamped at one end; the other end rotates about the axis."""
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("rod", start=(0, 0, 0), end=(1, 0, 0), elements=elements, element="beam24", law="structural",
                section=Circle(radius=0.01), material=Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1000,
                                                               damping_time=damping_time))
    scene.clamp("rod", s=0)
    if kind == "motion":
        scene.motion("rod", s=1.0, displacement=("free", 0, 0), rotation=((1, 0, 0), angle))
    else:
        scene.joint("cylindrical", (1, 0, 0), ("rod", 1.0), axis=(1, 0, 0), angle=angle, name="drive")
    return scene


KINDS = {"motion": "rod@1", "joint": "drive"}


@pytest.fixture(params=KINDS)
def kind(request):
    return request.param


def twist(kind, found):
    """Return the moment about the rod over GJ: the angle, rad."""
    return found[f"{KINDS[kind]}.moment"][..., 0] / GJ


@pytest.mark.parametrize("angle", [3.3, 5.2, -9.0])
@pytest.mark.parametrize("settings", [{}, {"load_steps": 3}, {"method": "arc_length"}], ids=["newton", "steps", "path"])
def test_moment_of_a_rod_twisted_beyond_half_a_turn(kind, angle, settings):
    rest = rod(kind, angle).equilibrium(**settings)
    assert_allclose(twist(kind, rest), angle, rtol=1e-6)  # -9 rad on 16 elements: 6e-8
    assert rest.stable and rest.messages == []
    assert rest.turned == {KINDS[kind]: angle}


def test_search_from_a_state_follows_the_angle_from_there(kind):
    rest = rod(kind, 6.5).equilibrium()
    assert_allclose(twist(kind, rod(kind, 8.0).equilibrium(start=rest)), 8.0, rtol=1e-6)
    assert_allclose(twist(kind, rod(kind, -1.0).equilibrium(start=rest)), -1.0, rtol=1e-6)


def test_relaxation_begins_with_the_angle_followed(kind):
    assert_allclose(twist(kind, rod(kind, 6.5).relax()), 6.5, rtol=1e-6)


def test_angle_is_adjusted_beyond_a_turn(kind):
    path = {"motion": "rod@1.rotation.1", "joint": "drive.angle"}[kind]
    rest = rod(kind, 1.0).equilibrium(adjust={path: "free"}, to={f"{KINDS[kind]}.moment.x": 8 * GJ})
    assert_allclose(rest.adjusted[path], 8.0, rtol=1e-6)


def test_run_keeps_the_turns_of_its_state_of_rest(kind):
    scene = rod(kind, 6.5)
    rest = scene.equilibrium()
    run = scene.run(duration=0.05, output_step=0.05, initial=rest)
    assert_allclose(twist(kind, run), 6.5, rtol=1e-6)
    for angle in (6.5 - 2 * np.pi, 0.0, 6.6):  # of the same axes; others
        with pytest.raises(SceneError, match=r"the angle of .* rad at t = 0, but the state to start from has 6.5 rad"):
            rod(kind, angle).run(duration=0.05, output_step=0.05, initial=rest)


def test_run_that_starts_at_another_place_than_its_state_of_rest_is_refused():
    def pulled(way):
        scene = rod("motion", 0.0)
        list.pop(scene.motions)
        scene.motion("rod", s=1.0, displacement=(way, 0, 0))
        return scene

    rest = pulled(0.01).equilibrium()
    pulled(0.01).run(duration=0.01, output_step=0.01, initial=rest)
    with pytest.raises(SceneError, match=r"a motion begins 0\.02 m from where the state to start from has it"):
        pulled(0.03).run(duration=0.01, output_step=0.01, initial=rest)


@pytest.mark.filterwarnings("ignore:.*no step of 0.05 s was possible")
@pytest.mark.parametrize("settings", [{"integrator": "radau"}, {"integrator": "genalpha", "step": 0.05}],
                         ids=["radau", "genalpha"])
@pytest.mark.slow_cases("joint-radau", "motion-genalpha")
def test_runs_follow_the_angle(kind, settings):
    twisted = rod(kind, Ramp(start=0, end=1, before=0, after=7.0), damping_time=0.05)
    run = twisted.run(duration=1.5, output_step=0.5, tol=1e-3, **settings)
    assert_allclose(twist(kind, run)[-1], 7.0, rtol=1e-4)


@pytest.mark.slow_cases("joint")
def test_resumed_run_follows_the_angle(tmp_path, kind):
    twisted, path = rod(kind, Ramp(start=0, end=1, before=0, after=7.0), damping_time=0.05), tmp_path / "run.nc"
    given = {"duration": 1.5, "output_step": 0.1, "tol": 1e-3, "save": path}

    def stop(time):
        if time > 0.9:
            raise KeyboardInterrupt

    with pytest.warns(UserWarning):
        assert twisted.run(**given, progress=stop).status == "interrupted"
    assert_allclose(twist(kind, twisted.run(**given, resume=True))[-1], 7.0, rtol=1e-4)


@pytest.mark.parametrize("element", ["cable8p", "beam12p"])
def test_planar_cable_curls_into_circles(element):
    scene = Scene(gravity=(0, 0, 0))
    law = {} if element == "beam12p" else {"strain": "engineering"}
    scene.cable("strip", start=(0, 0, 0), end=(1, 0, 0), elements=40, element=element, section=Circle(radius=0.01),
                material=Material(youngs_modulus=1e7, poisson_ratio=0.0, density=1000), **law)
    scene.clamp("strip", s=0)
    scene.motion("strip", s=1.0, rotation=((0, 0, 1), 4 * np.pi))
    rest = scene.equilibrium()
    assert_allclose(rest["strip@1.moment"][2], 4 * np.pi * EI, rtol=1e-2)
    assert_allclose(rest["strip.position"][-1], 0, atol=1e-2)


@pytest.mark.parametrize("elements", [1, 2])
def test_elements_too_long_for_the_turn_are_refused(kind, elements):
    with pytest.raises(EquilibriumError, match=r"would lose a turn: take elements of at most 0\.\d+ m there"):
        rod(kind, 6.5, elements).equilibrium()
