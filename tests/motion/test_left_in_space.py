"""Ropes in space that leave sheaves and touch them again, in the plane of the groove and beside it."""

import re

import funicular as fu
import numpy as np
import pytest
from interrupted_runs import killed_and_resumed
from ropes.scenes import GRAVITY, rope_of
from test_left_and_touched import TWICE, whats
from test_ropes import THIN
from test_turning_sheaves import momenta

TURN = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
TURN *= np.sign(np.linalg.det(TURN))


def pendulum(element: str = "cable12", aside: float = 0.0, axes: np.ndarray | None = None, elements: int = 1,
             rope: tuple[float, ...] = (1e5, 1e-2, 0, 5e-3), **sheave: object) -> fu.Scene:
    """Return the pendulum of ropes.scenes.over_a_peg, let go with a velocity along the axis of the peg, turned."""
    axes = np.eye(3) if axes is None else axes
    place = lambda *x: tuple(axes @ x)  # noqa: E731
    scene, start = fu.Scene(gravity=place(0, -GRAVITY, 0)), -0.7
    scene.rigid_body("load", mass=1.0, inertia=(1,) * 3, velocity=place(0, 0, aside),
                     position=place(2 * np.sin(start), -2 * np.cos(start), 0))
    peg = {"at": place(0.3, -1, 0), "radius": 0.1, "side": "left", "contact": False, **sheave}
    if element == "cable12":
        peg["axis"] = place(0, 0, 1)
    scene.rope("rope", element=element, elements=elements, length=2 / (1 + GRAVITY * np.cos(start) / rope[0]),
               route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("peg", **peg), fu.Anchor("load")], **rope_of(*rope))
    return scene


def run_of(scene: fu.Scene, duration: float = 2.0, integrator: str = "radau", **given: object) -> fu.Run:
    return scene.run(duration, output_step=0.05, integrator=integrator, progress=False, **{"tol": 1e-5} | given)


@pytest.fixture(scope="module")
def swing() -> fu.Run:
    return run_of(pendulum(aside=0.02))


@pytest.mark.parametrize("elements", [1, *(pytest.param(n, marks=pytest.mark.slow) for n in (2, 4))])
def test_motion_in_the_plane_of_the_groove_is_that_in_the_plane(elements):
    """Whatever the direction of the plane; the rope is on the peg from slopes on, whose chords differ by waves."""
    plane, space = (run_of(pendulum(**given, elements=elements), 1.8) for given in (
        {"element": "cable8p"}, {"axes": TURN}))
    assert whats(space) == whats(plane) == TWICE[:2]
    times = [[event["time"] for event in run.events] for run in (plane, space)]
    assert times[0] == pytest.approx(times[1], abs=1e-7)
    assert space["load.position"] @ TURN == pytest.approx(plane["load.position"], abs=1e-8)
    assert space["peg.wrap_angle"] == pytest.approx(plane["peg.wrap_angle"], abs=1e-6)
    assert space["peg.gap"] == pytest.approx(plane["peg.gap"], abs=1e-7)


def test_a_pendulum_beside_the_plane_of_the_groove(swing):
    """The rope lies in the groove where it has touched it, until it leaves."""
    assert whats(swing) == TWICE[:2]
    assert np.abs(swing.energy_balance().relative).max() < 1e-6
    on = swing["peg.wrap_angle"] > 0
    assert (swing["peg.gap"][~on] > 0).all() and not swing["peg.gap"][on].any()
    assert (swing["peg.normal_force"][on] > 0).all()
    assert np.abs(swing["peg.fleet_angle_off"][on]).max() > 5e-3 and not swing["peg.fleet_angle_off"][~on].any()
    assert swing["peg.residual"].max() < 1e-12
    aside = swing["rope.position"][:, swing["rope.position"].shape[1] // 2, 2]
    assert np.ptp(aside[on]) < 1e-12 < 3e-3 < aside[on][0]
    assert np.ptp(aside[~on]) > 4e-3


@pytest.mark.slow
def test_meshes_converge():
    """With waves along the axis from the kink with which the rope leaves: 3e-4 and 6e-5 m in the plane at 4.5 s."""
    runs = [run_of(pendulum(aside=0.02, elements=n), 4.5) for n in (1, 2, 4)]
    assert all(whats(run) == TWICE for run in runs)
    one, two = (np.abs(run["load.position"] - runs[-1]["load.position"])[:, :2].max() for run in runs[:-1])
    assert two < min(1e-4, one / 2) and one < 5e-4


def thrown(friction: float | None = None, aside: float = 0.0, **sheave: object) -> fu.Scene:
    """Return a load that a velocity lifts off a sheave against which a rope is drawn."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("load", mass=1.5, inertia=(1.5,) * 3, position=(1.0, -0.05, aside), velocity=(0, 1.0, 0.05))
    scene.rope("hoist", element="cable12", tension=30.0, route=[
        fu.Anchor(at=(-1, 0, aside)), fu.Sheave("top", at=(0, -0.2, 0), radius=0.2, side="right", friction=friction,
                                                zones=1, **sheave), fu.Anchor("load")], **THIN)
    scene.force("load", value=(30, 0, 0))
    return scene


@pytest.mark.parametrize("integrator", ["genalpha", "explicit"])
@pytest.mark.parametrize("friction", [None, pytest.param(0.1, marks=pytest.mark.slow)])
def test_integrators_agree_where_a_rope_leaves(integrator, friction):
    one, other = (run_of(thrown(friction), 0.1, each) for each in ("radau", integrator))
    assert whats(one) == whats(other) == TWICE[1:2]
    assert other["load.position"] == pytest.approx(one["load.position"], abs=1e-6)


@pytest.mark.parametrize("integrator", ["genalpha", pytest.param("explicit", marks=pytest.mark.slow)])
def test_integrators_agree_where_a_rope_touches(integrator):
    scene = pendulum(aside=0.02, rope=(2e4, 0.05, 0, 1e-4))
    one, other = (run_of(scene, 1.0, each) for each in ("radau", integrator))
    assert whats(one) == whats(other) == TWICE[:1]
    assert other["load.position"] == pytest.approx(one["load.position"], abs=1e-5)


@pytest.mark.parametrize("rows", [60, *(pytest.param(n, marks=pytest.mark.slow) for n in (30, 95))],
                         ids=["in contact", "before", "after"])
def test_resumed_bit_for_bit(tmp_path, rows):
    """The place in the groove is a part of the state, too."""
    scene = pendulum(aside=0.02, friction=0.2, zones=2)
    settings = {"duration": 2.0, "output_step": 0.02, "tol": 1e-4, "integrator": "genalpha", "progress": False}
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", rows, **settings)
    whole = scene.run(**settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)
    assert whats(whole) == whats(resumed) == TWICE[:2]


@pytest.mark.parametrize("instant", [0.5, 1.3, 1.85])
def test_a_run_from_a_state_of_another(swing, instant):
    """The state says whether the rope lies on the peg, and where in the groove."""
    later = run_of(pendulum(aside=0.02), 0.1, initial=swing.at(instant))
    at = int(np.argmin(np.abs(swing.time - instant - 0.1)))
    assert later["load.position"][-1] == pytest.approx(swing["load.position"][at], abs=2e-5)
    middle = later["rope.position"].shape[1] // 2
    assert later["rope.position"][0, middle, 2] == pytest.approx(swing["rope.position"][at - 2, middle, 2], abs=1e-9)


def struck(**sheave: object) -> fu.Scene:
    """Return a free body that spins, with a peg that strikes a rope between two free weights, which a spring pushes
    apart.
    """
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, x in (("one", -1.0), ("other", 1.0)):
        scene.rigid_body(name, mass=1.0, inertia=(1,) * 3, position=(x, 0, 0), velocity=(0, 0, 0.05 * x))
    scene.spring("one", "other", stiffness=20, length=7.0)
    scene.rigid_body("ram", mass=2.0, inertia=(0.3, 0.4, 0.35), position=(0.02, -0.5, 0.003), velocity=(0, 2.0, 0),
                     angular_velocity=(0.1, 0.15, 0.2))
    scene.rope("rope", element="cable12", elements=1, tension=100.0, **rope_of(1e4, 0.01, 0, 5e-3), route=[
        fu.Anchor("one"), fu.Sheave("peg", at=("ram", (0, 0.1, 0)), radius=0.1, side="right", contact=False, **sheave),
        fu.Anchor("other")])
    return scene


@pytest.mark.parametrize("sheave", [{}, pytest.param({"friction": 0.2, "zones": 2}, marks=pytest.mark.slow)])
def test_a_peg_on_a_body_that_spins_keeps_momenta(sheave):
    """Of 4 kg m/s, to 1e-8 between events. There nodes move by R f²/2 at a fleet angle f, or slopes turn."""
    scene = struck(**sheave)
    run = run_of(scene, 0.45, tol=1e-6)
    assert whats(run) == TWICE[:2]
    assert np.abs(run["peg.fleet_angle_off"]).max() > 0.02
    assert np.abs(run.energy_balance().relative).max() < 5e-5
    before, inside, after = (momenta(scene, run, k) for k in (0, 5, 9))
    assert run["peg.wrap_angle"][5] > 0 == run["peg.wrap_angle"][9]
    assert np.abs(inside - before).max() < 3e-6
    assert np.abs(after - before).max() < 2e-5


# ---- beside the groove

def test_a_rope_that_returns_beside_the_groove():
    """At 24 mm from the plane it passes beside a groove of 20 mm, and falls into one of 60 mm."""
    message = 'a rope returns to sheave "peg" and passes beside its groove, by more than half of groove_width'
    with pytest.raises(fu.RopeLeftError, match=re.escape(message)) as caught:
        run_of(pendulum(aside=0.1), 1.0)
    assert caught.value.run.time[-1] == pytest.approx(0.86, abs=5e-3)
    run = run_of(pendulum(aside=0.1, groove_width=0.06), 0.9)
    assert whats(run) == TWICE[:1]


def test_a_rope_that_leaves_with_a_kink_along_the_axis():
    """The groove holds it along the axis up to the end: what it does there is not modelled."""
    with pytest.raises(fu.RopeLeftError, match='leaves the groove of sheave "top" along its axis, with a kink'):
        run_of(thrown(aside=0.1, max_fleet_angle=0.12), 0.2)
    assert whats(run_of(thrown(aside=0.1, max_fleet_angle=0.3), 0.1)) == TWICE[1:2]


def test_a_run_that_conserves_energy_ends_where_the_rope_leaves():
    with pytest.raises(fu.RopeLeftError, match='leaves sheave "top", as its wrap angle'):
        run_of(thrown(), 0.2, "energy", step=1e-3, tol=None)


def test_a_wrap_that_is_small_conserves_energy():
    """Its tangent points lie across their slopes."""
    run, other = (thrown().run(0.04, output_step=0.01, integrator=integrator, tol=1e-6, progress=False)
                  for integrator in ("energy", "radau"))
    assert run["top.wrap_angle"].max() < 0.1
    assert np.abs(run.energy_balance().relative).max() < 1e-11
    assert run["load.position"] == pytest.approx(other["load.position"], abs=2e-6)


# ---- at rest, in files and pictures

def test_rest_and_modes_beside_a_peg():
    """As in the plane, and swings out of it."""
    def hung(element: str) -> fu.Scene:
        scene = fu.Scene(gravity=(0, -GRAVITY, 0))
        scene.rigid_body("load", mass=1.0, inertia=(1,) * 3, position=(0, -2, 0))
        scene.rope("rope", element=element, elements=1, tension=GRAVITY, **rope_of(1e5, 1e-2, 0, 5e-3), route=[
            fu.Anchor(at=(0, 0, 0)), fu.Sheave("peg", at=(0.3, -1, 0), radius=0.1, side="left", contact=False),
            fu.Anchor("load")])
        return scene

    plane, space = (hung(element).equilibrium() for element in ("cable8p", "cable12"))
    assert space["load.position"] == pytest.approx(plane["load.position"], abs=1e-9)
    assert space["peg.gap"] == pytest.approx(plane["peg.gap"], abs=1e-9)
    swings = hung("cable8p").modes(4, about=plane).frequency
    found = hung("cable12").modes(9, about=space).frequency
    assert all(np.abs(found / each - 1).min() < 1e-6 for each in swings if each > 0.1)


def test_rest_on_a_wrap_with_slopes():
    """Of .05 rad with a fleet angle of .05 rad: a minimum of the energy also with 24 elements."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rope("rope", element="cable12", elements=24, tension=100.0, route=[
        fu.Anchor(at=(-1, -0.05, 0)), fu.Sheave("top", at=(0, -0.2, 0), radius=0.2, side="right"),
        fu.Anchor(at=(1, 0, 0.05))], **rope_of(1e5, 1e-3, 0))
    rest = scene.equilibrium()
    assert rest.stable
    assert rest["top.wrap_angle"] == pytest.approx(0.05, abs=5e-3)
    assert rest["top.fleet_angle_off"] == pytest.approx(0.05, abs=1e-3)


def test_files_have_the_groove():
    scene = pendulum(groove_width=0.03)
    assert "groove_width = 0.03" in scene.to_toml()
    assert fu.Scene.from_toml(scene.to_toml()).to_toml() == scene.to_toml()


def test_points_of_a_rope_that_has_left():
    """Between both spans they are on the line, off the plane of the groove, too; in a picture as well."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("load", mass=1.0, inertia=(1,) * 3, position=(1, 0, 0.05))
    scene.force("load", value=(50, 0, 0))
    scene.rope("rope", element="cable12", elements=1, tension=50.0, **rope_of(1e5, 1e-2, 0, 5e-3), route=[
        fu.Anchor(at=(-1, 0, 0.05)), fu.Sheave("peg", at=(0, -0.5, 0), radius=0.2, side="right", contact=False),
        fu.Anchor("load")])
    run = run_of(scene, 0.05)
    for found in (run["rope.position"][-1], run.animation("a run").clips[0].cables[0].position[-1]):
        assert found[:, 1:] == pytest.approx(np.tile([0, 0.05], (len(found), 1)), abs=1e-9)
    assert run["peg.gap"] == pytest.approx(0.3, abs=1e-6)
    assert whats(run) == []
