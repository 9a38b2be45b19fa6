"""Routes that must agree, over random scenes: every route leads to the same motion, or a note says so."""

import time
from dataclasses import dataclass

import funicular as fu
import numpy as np
import paired_scenes
import pytest
from funicular.integrators import OF_EQUATIONS
from funicular.results.trajectories import relative, trajectory
from notes import WARNS
from paired_scenes import TIME, random_row
from random_motions import MOTIONS, motion
from routes import ROUTES, Route, apart, points, simulate
from small_vibrations import displaced, free_to_vibrate, lowest_modes, undamped

pytestmark = pytest.mark.slow
TOL = 1e-6
ROUTE_TOLERANCE = 20.0
"""tol: two routes agree, as errors of either may be a few tol; or one of them has a note that errors may be larger."""
SAME_STEPS_TOLERANCE = 1.0
"""tol: of a scene written anew, whose steps are the same but for rounding; "turned" ones have other errors."""
SEEDS = [*range(6 * len(MOTIONS))]
ROWS = [*range(1000, 1040)]
"""Seeds of motions, and of scenes in which two or three features meet."""
NO_REST = 33,
"""Seeds of scenes whose state of rest is sought in vain, for 20 s."""
MAX_CPU_TIME = 1.0
"""CPU seconds: runs that take longer, such as explicit ones of stiff beams, are given up and not compared."""


def run(scene, duration, integrator="radau", until=np.inf, **settings):
    """Return a run, or None if the integrator refuses the scene or takes too long; until: time of an interruption."""
    begin = time.process_time()

    def give_up(reached):
        if time.process_time() - begin > MAX_CPU_TIME or reached >= until:
            raise KeyboardInterrupt

    try:
        found = simulate(scene, duration, tol=TOL, integrator=integrator, progress=give_up, **settings)
    except fu.SceneError as error:
        assert f'integrator "{integrator}"' in str(error) or "step is too" in str(error)
        return None
    return found if found.status == "completed" or until < duration else None


def check(subject, name, found, *runs, within=ROUTE_TOLERANCE):
    """Check a motion by another route against that of the drawn scene."""
    assert apart(subject.points, found) < within * TOL or is_noted(subject.run, *runs)


def is_noted(*runs):
    return any(WARNS.search(message) for each in runs for message in each.report["messages"])


@dataclass
class Subject:
    """A random scene as drawn, its run by radau, and the motion of its points."""

    seed: int
    scene: fu.Scene
    duration: float
    run: fu.Run
    points: dict[str, np.ndarray]


@pytest.fixture(scope="module", params=[*SEEDS, *ROWS])
def subject(request, tmp_path_factory):
    seed = request.param
    if seed in SEEDS:
        made = motion(seed)
        scene, duration = made.scene, made.duration
    else:
        try:
            scene, duration = paired_scenes.build(random_row(seed), tmp_path_factory.mktemp("files")), TIME
            scene.run_settings = {}
            scene.check()
        except fu.SceneError as error:
            pytest.skip(f"no such scene: {error}")
    drawn = run(scene, duration)
    return Subject(seed, scene, duration, drawn, points(drawn, Route(scene)))


@pytest.mark.parametrize("integrator", [name for name in OF_EQUATIONS if name != "radau"])
def test_integrators_agree(subject, integrator):
    if (other := run(subject.scene, subject.duration, integrator)) is not None:
        check(subject, integrator, points(other, Route(subject.scene)), other)


@pytest.mark.parametrize("name", ROUTES)
def test_scene_written_anew_has_the_same_motion(subject, name):
    if (route := ROUTES[name](subject.scene)) is not None:
        other = run(route.scene, subject.duration / route.frame.time)
        tolerance = ROUTE_TOLERANCE if name in ("turned", "moved") else SAME_STEPS_TOLERANCE
        check(subject, name, points(other, route), other, within=tolerance)


def test_resumed_run_is_the_same(subject, tmp_path):
    saved = {"save": tmp_path / "x.nc"}
    run(subject.scene, subject.duration, until=subject.duration / 3, **saved)
    resumed = run(subject.scene, subject.duration, resume=True, **saved)
    assert len(subject.run.time) == len(resumed.time)
    for name in subject.run.keys():
        np.testing.assert_array_equal(resumed[name], subject.run[name], err_msg=name)


def test_run_goes_on_from_a_state_of_another(subject):
    """For scenes without signals, which start anew."""
    if "form =" in subject.scene.to_toml():
        return
    half, step = len(subject.run.time) // 2, subject.duration / 20
    other = run(subject.scene, subject.duration / 2, initial=subject.run.at(subject.run.time[half]), output_step=step)
    later = points(other, Route(subject.scene))
    whole = {name: np.concatenate([each[:half], later[name]]) for name, each in subject.points.items()}
    check(subject, "later", whole, other)


def test_error_of_the_mesh_is_within_its_estimate(subject):
    """The reference has a quarter of the element length, the estimate half: up to a factor of two at order 1."""
    if not subject.scene.cables:
        return
    tol = 1e-3
    coarse = simulate(subject.scene, subject.duration, tol=tol, integrator="radau", estimate=True)
    scene = subject.scene.remeshed(lambda cable: 4 * cable.elements)
    fine = simulate(scene, subject.duration, tol=tol / 10, integrator="radau")
    errors = coarse.report["errors"]
    motions = [{name: trajectory(of, each, name) for name in errors["outputs"]}
               for of, each in ((subject.scene, coarse), (scene, fine))]
    assert relative(scene, *motions) <= 2 * errors["both"] + tol


def test_stiff_springs_hold_as_joints_do(subject):
    """The springs stretch by tol of the motion. Scenes whose joints project the drawn velocities are left out."""
    joints = [joint for joint in subject.scene.joints.values() if joint.joint_kind == "spherical"]
    if not joints or any("velocities broke" in note for note in subject.run.report["messages"]):
        return
    largest = max(np.linalg.norm(each - each[:1], axis=-1).max() for each in subject.points.values())
    force = max(np.linalg.norm(subject.run[f"{name}.force"], axis=-1).max() for name in subject.scene.joints)
    scene = subject.scene.with_parts(part.as_made() for part in subject.scene.parts() if part not in joints)
    for joint in joints:
        scene.spring(joint.a.as_given(), joint.b.as_given(), stiffness=force / (TOL * largest), length=0.0)
    other = run(scene, subject.duration)
    check(subject, "springs", points(other, Route(scene)), other)


def test_modes_are_small_free_vibrations(subject):
    """A scene started from the shape of a mode returns after a period, and is at the opposite side after half of it.
    Scenes without dampers and drives that have an equilibrium.
    """
    if not free_to_vibrate(subject.scene) or subject.seed in NO_REST:
        return
    scene = undamped(subject.scene)
    try:
        rest = scene.equilibrium()
    except fu.EquilibriumError:
        return
    modes = lowest_modes(scene, rest, 6)
    for mode in np.flatnonzero(modes.angular_frequency)[:3]:
        period = 2 * np.pi / modes.angular_frequency[mode]
        vibration = simulate(scene, period, tol=TOL, integrator="radau", output_step=period / 4,
                             initial=displaced(scene, rest, modes, mode, 1e-6))
        at = np.concatenate([each - each[:1] for each in points(vibration, Route(scene)).values()], axis=1)
        largest = np.linalg.norm(at[2], axis=-1).max()
        assert np.linalg.norm(at[4], axis=-1).max() < 1e-3 * largest
        assert np.linalg.norm(at[1] - at[2] / 2, axis=-1).max() < 1e-3 * largest
