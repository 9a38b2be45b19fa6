"""Ropes that leave a sheave without friction and touch it again: pendulums around a peg (ropes.scenes.over_a_peg)."""

import re

import funicular as fu
import numpy as np
import pytest
from interrupted_runs import killed_and_resumed
from ropes.scenes import over_a_peg, rope_of, weight
from test_ropes import momenta

LIGHT = (1e-2, 1e5, 5e-3)
"""Mass of a length in kg/m, EA in N, damping time in s."""
TWICE = ["touched the sheave", "left the sheave"] * 2
EVENTS = [0.862144, 1.773524, 3.497812, 4.408]
"""Instants of a massless rope, s (ropes.swings.peg)."""


def whats(run: fu.Run) -> list[str]:
    return [event["what"] for event in run.events]


@pytest.fixture(scope="module")
def swing() -> fu.Run:
    return over_a_peg(*LIGHT).run(4.5, output_step=0.05, tol=1e-5, integrator="radau", progress=False)


def test_a_pendulum_meets_a_peg(swing):
    """A rope of 2 % of the load's mass differs by as much from a massless one."""
    assert whats(swing) == TWICE
    assert [event["time"] for event in swing.events] == pytest.approx(EVENTS, abs=0.02)
    assert np.abs(swing.energy_balance().relative).max() < 1e-5
    assert swing["peg.residual"].max() < 1e-10


def test_contact_and_distance_exclude_each_other(swing):
    pressed = swing["peg.wrap_angle"] > 0
    assert pressed.any() and not pressed.all()
    assert (swing["peg.normal_force"][pressed] > 0).all()
    assert np.array_equal(swing["peg.gap"][pressed], np.zeros(pressed.sum()))
    assert (swing["peg.gap"][~pressed] > 0).all()
    assert np.array_equal(swing["peg.normal_force"][~pressed], np.zeros((~pressed).sum()))


def test_the_gap_is_the_distance_of_the_line(swing):
    """Until it touches the peg, a light rope is nearly straight from its anchor to the load."""
    free = swing.time < swing.events[0]["time"]
    x, y = swing["load.position"][free, :2].T
    away = (-0.3 * y - 1.0 * x) / np.hypot(x, y)  # of the peg's centre, to the left of the line
    assert swing["peg.gap"][free] == pytest.approx(away - 0.1, abs=6e-3)


def test_points_of_a_rope_that_has_left():
    """A rope that starts on its sheave has points for the wrap: without contact they are on the line, in a picture
    too.
    """
    scene = fu.Scene(gravity=(0, 0, 0))
    weight(scene, "load", 1.0, 1.5, -0.05)
    scene.rope("rope", route=[fu.Anchor(at=(-1, -0.2, 0)), fu.Sheave("top", at=(0, -0.2, 0), radius=0.2, side="right"),
                              fu.Anchor("load")], tension=30.0, **rope_of(1e5, 0.01, 0, 1e-3))
    scene.force("load", value=(30, 30, 0))
    run = scene.run(0.5, output_step=0.05, tol=1e-5, integrator="radau", progress=False)
    assert whats(run) == ["left the sheave"] and run["top.gap"][-1] > 0.05
    points = run["rope.position"][-1]
    along = points[-1] - points[0]
    line = run.animation("a run").clips[0].cables[0].position[-1]
    for found in (points, line):
        off = np.linalg.norm(np.cross(along, found - points[0]), axis=1) / np.linalg.norm(along)
        assert off.max() < 0.1 * run["top.gap"][-1]


@pytest.mark.parametrize("integrator", ["genalpha", "explicit"])
def test_integrators_agree(integrator):
    given = {"duration": 1.0, "output_step": 0.1, "progress": False}
    scene = over_a_peg(0.05, 2e4, 1e-4)
    one = scene.run(integrator="radau", tol=1e-6, **given)
    other = scene.run(integrator=integrator, tol=1e-5, **given)
    assert whats(one) == whats(other) == TWICE[:1]
    assert np.abs(one["load.position"] - other["load.position"]).max() < 1e-4


@pytest.mark.slow
def test_a_mirrored_scene_has_the_same_numbers(swing):
    """Within a third of Newton's tolerance, 1.5e-7: rounding may decide on one iteration more."""
    run = over_a_peg(*LIGHT, mirrored=True).run(4.5, output_step=0.05, tol=1e-5, integrator="radau", progress=False)
    assert run["load.position"] * [-1, 1, 1] == pytest.approx(swing["load.position"], abs=1e-9)
    assert run["peg.wrap_angle"] == pytest.approx(swing["peg.wrap_angle"], abs=5e-8)  # measured: 2.4e-8


@pytest.mark.parametrize("rows", [30, 60, 95], ids=["before", "in contact", "after"])
@pytest.mark.parametrize("integrator", ["radau", "genalpha"])
@pytest.mark.slow_cases("radau-before", "radau-after")
def test_resumed_bit_for_bit(tmp_path, integrator, rows):
    """The mode of the sheave is a part of the state: a run that is stopped at any time continues with its bits."""
    scene = over_a_peg(*LIGHT)
    settings = {"duration": 2.0, "output_step": 0.02, "tol": 1e-4, "integrator": integrator, "progress": False}
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", rows, **settings)
    whole = scene.run(**settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)
    assert whats(whole) == whats(resumed) == TWICE[:2]


@pytest.mark.parametrize("instant", [0.5, 1.3, 1.85])
def test_a_run_from_a_state_of_another(swing, instant):
    """The state says whether the rope lies on the peg."""
    later = over_a_peg(*LIGHT).run(0.2, output_step=0.05, tol=1e-6, integrator="radau", initial=swing.at(instant),
                                   progress=False)
    at = int(np.argmin(np.abs(swing.time - instant - 0.2)))
    assert later["load.position"][-1] == pytest.approx(swing["load.position"][at], abs=2e-5)
    assert later["peg.gap"][0] == pytest.approx(
        swing["peg.gap"][int(np.argmin(np.abs(swing.time - instant)))], abs=1e-9)


def test_files_have_the_contact(tmp_path, swing):
    scene = over_a_peg(*LIGHT)
    assert "contact = false" in scene.to_toml()
    assert fu.Scene.from_toml(scene.to_toml()).to_toml() == scene.to_toml()
    swing.save(tmp_path / "swing.nc")
    assert np.array_equal(fu.load_run(tmp_path / "swing.nc")["peg.gap"], swing["peg.gap"])


@pytest.mark.slow
def test_meshes_converge_where_waves_cross_the_peg():
    """A rope of 10 % of the load's mass: the kink of touching runs along it."""
    runs = [over_a_peg(0.05, 1e5, 1e-3, elements).run(1.2, output_step=0.1, tol=1e-6, integrator="radau",
                                                      progress=False)["load.position"] for elements in (2, 4, 6)]
    errors = [np.abs(run - runs[-1]).max() for run in runs[:-1]]
    assert errors[1] < min(2e-4, errors[0] / 2)  # 9e-5 m, and 3.6e-4 m of 2 elements


CHAIN = {0.75: (0.073550, -1.999333), 1.0: (0.745784, -1.809459)}
"""Load in m at times in s by 101 masses and springs that are tangent to the peg (ropes.chains.geodesic_force), with
.05 kg/m, EA 2e4 N and a damping time of 1e-5 s; 51 masses differ by 9e-5 m."""


@pytest.mark.slow
def test_a_heavy_rope_touches_as_a_chain_does():
    with pytest.raises(fu.RopeLeftError, match="lifts off"):  # its tension falls to zero as the load bounces on it
        over_a_peg(0.05, 2e4, 1e-5, 6).run(2.0, output_step=0.25, tol=1e-5, integrator="radau", progress=False)
    run = over_a_peg(0.05, 2e4, 1e-5, 6).run(1.0, output_step=0.25, tol=1e-5, integrator="radau", progress=False)
    for t, place in CHAIN.items():
        assert run["load.position"][round(4 * t), :2] == pytest.approx(place, abs=2e-4)


@pytest.mark.slow
def test_a_line_that_passes_beside_the_peg():
    """Swings too small to reach a peg are the same beside another: the rope is one, split where it is next to it."""
    given = {"duration": 2.0, "output_step": 0.1, "tol": 1e-6, "integrator": "radau", "progress": False}
    run = over_a_peg(*LIGHT, elements=2, start=-0.15).run(**given)
    assert whats(run) == []
    far = fu.Sheave("far", at=(1.0, -1, 0), radius=0.1, side="left", contact=False)
    other = over_a_peg(*LIGHT, elements=2, start=-0.15, pegs=(far,)).run(**given)
    assert run["load.position"] == pytest.approx(other["load.position"], abs=2e-6)


def struck(pull: float) -> fu.Scene:
    """Return a free body with a peg that strikes a rope between two free weights, which forces pull apart."""
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, x in (("one", -1.0), ("other", 1.0)):
        weight(scene, name, 1.0, x, 0.0)
        if pull:
            scene.force(name, value=(x * pull, 0, 0))
    scene.rigid_body("ram", mass=2.0, inertia=(0.3,) * 3, position=(0.02, -0.5, 0), velocity=(0, 2.0, 0))
    scene.rope("rope", route=[fu.Anchor("one"), fu.Sheave("peg", at=("ram", (0, 0.1, 0)), radius=0.1, side="right",
                                                          contact=False), fu.Anchor("other")],
               elements=2, tension=100.0, **rope_of(1e4, 0.01, 0, 5e-3))
    return scene


@pytest.mark.slow
def test_a_peg_on_a_body_keeps_momentum():
    """All of it, with that of the rope; the forces on the weights are opposite."""
    scene = struck(100.0)
    run = scene.run(0.5, output_step=0.02, tol=1e-6, integrator="radau", progress=False)
    assert whats(run) == TWICE[:2]
    assert np.abs(run.energy_balance().relative).max() < 1e-5
    rows = [0, *(int(np.searchsorted(run.time, t)) for t in (0.2, 0.35, 0.5))]  # before, in contact, after
    found = np.array([momenta(scene, run, k) for k in rows])
    assert np.abs(found[:, :2] - found[0, :2]).max() < 2e-7  # of 4 kg m/s; 4e-8 at this tolerance
    assert run["ram.velocity"][-1, 1] < 0.1  # it stops, as of two equal masses in line


def test_a_rope_without_contact_that_is_slack_is_noted():
    """Its weights fly together."""
    with pytest.warns(fu.FunicularWarning, match='sheave "peg": the rope that has left it is slack there, with '):
        struck(0.0).run(0.1, output_step=0.01, tol=1e-4, progress=False)


def test_equilibrium_beside_a_peg_and_on_it():
    rest = over_a_peg(*LIGHT, start=-0.15).equilibrium()
    assert rest["load.position"][:2] == pytest.approx([0, -2.0], abs=1e-3)
    assert rest["peg.gap"] == pytest.approx(0.2, abs=1e-6)
    near = fu.Sheave("peg", at=(0.05, -1, 0), radius=0.1, side="left", contact=False)
    with pytest.raises(fu.FunicularError, match=r"touches sheave .peg."):
        over_a_peg(*LIGHT, start=-0.3, pegs=(near,)).equilibrium()


@pytest.mark.parametrize(("sheave", "message"), [
    ({"turns": 1}, "has turns and contact=False"),
    ({"side": None}, "has contact=False, but no side"),
])
def test_refused_sheaves(sheave, message):
    with pytest.raises(fu.SceneError, match=re.escape(message)):
        fu.Sheave("peg", **{"at": (0, -1, 0), "radius": 0.1, "side": "left", "contact": False} | sheave)


@pytest.mark.parametrize(("centre", "side", "message"), [
    ((0.05, -1, 0), "left", 'the rope touches sheave "peg", which has contact=False'),
    ((0.3, -1, 0), "right", 'the rope touches sheave "peg", which has contact=False'),
    ((0.3, -2.5, 0), "left", "the span from"),
])
def test_refused_places(centre, side, message):
    scene = fu.Scene()
    weight(scene, "load", 1.0, 0.0, -2.0)
    with pytest.raises(fu.SceneError, match=re.escape(message)):
        scene.rope("rope", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("peg", at=centre, radius=0.1, side=side,
                                                                     contact=False), fu.Anchor("load")],
                   tension=10.0, **rope_of(1e5, 0.01, 0))


def test_refused_ropes():
    peg = fu.Sheave("peg", at=(0.3, -1, 0), radius=0.1, side="left", contact=False)
    ends = fu.Anchor(at=(0, 0, 0)), fu.Anchor(at=(0, -2, 0))
    with pytest.raises(fu.SceneError, match=re.escape('sheave "peg" is on a rope without mass, whose contact')):
        fu.Scene().rope("rope", route=[ends[0], peg, ends[1]], tension=10.0, mass=False, **rope_of(1e5, 0.01, 0))


@pytest.mark.slow
def test_two_pegs_in_a_row():
    """The line meets one of two pegs after the other, and leaves both."""
    pegs = tuple(fu.Sheave(name, at=at, radius=radius, side="left", contact=False)
                 for name, at, radius in (("peg", (0.3, -1, 0), 0.1), ("low", (0.45, -1.4, 0), 0.05)))
    run = over_a_peg(*LIGHT, pegs=pegs).run(2.5, output_step=0.05, tol=1e-5, integrator="radau", progress=False)
    assert sorted(event["name"] for event in run.events) == ["low", "low", "peg", "peg"]
    assert whats(run) == ["touched the sheave"] * 2 + ["left the sheave"] * 2
    assert np.abs(run.energy_balance().relative).max() < 1e-5
    x, y = run["load.position"][run.time > run.events[-1]["time"], :2].T
    assert np.hypot(x, y) == pytest.approx(2.0, abs=2e-3)
