"""Ropes that leave sheaves with friction and touch them again, and closed ropes that do."""

from collections.abc import Callable

import funicular as fu
import numpy as np
import pytest
from interrupted_runs import killed_and_resumed
from ropes.scenes import over_a_peg, rope_of, weight
from test_left_and_touched import LIGHT, TWICE, whats
from test_ropes import momenta, pulled_off

MU = 0.3


def rough(mu: float = MU, zones: int = 4, velocity: float = 1e-3) -> dict[str, object]:
    return {"friction": fu.Friction(coefficient=mu, velocity=velocity), "zones": zones}


def sticky(mu: float = MU, zones: int = 4) -> dict[str, object]:
    return {"friction": fu.Friction(coefficient=mu, model="stick"), "zones": zones}


def pendulum(mu: float = MU, zones: int = 4, mirrored: bool = False, friction: Callable[..., dict[str, object]] = rough
             ) -> fu.Scene:
    peg = fu.Sheave("peg", at=(-0.3 if mirrored else 0.3, -1, 0), radius=0.1, side="right" if mirrored else "left",
                    contact=False, **friction(mu, zones))
    return over_a_peg(*LIGHT, pegs=(peg,), mirrored=mirrored)


def run_of(scene: fu.Scene, duration: float = 2.0, tol: float = 1e-5, integrator: str = "radau", **given: object
           ) -> fu.Run:
    return scene.run(duration, output_step=0.05, tol=tol, integrator=integrator, progress=False, **given)


@pytest.fixture(scope="module")
def swing() -> fu.Run:
    return run_of(pendulum())


# ---- a pendulum around a peg

@pytest.mark.slow
def test_friction_vanishes_with_its_coefficient():
    smooth, nearly = run_of(over_a_peg(*LIGHT)), run_of(pendulum(1e-7))
    assert whats(smooth) == whats(nearly) == TWICE[:2]
    assert nearly["load.position"] == pytest.approx(smooth["load.position"], abs=2e-7)


@pytest.mark.parametrize("mu", [0.1, *(pytest.param(mu, marks=pytest.mark.slow) for mu in (1.0, 3.0))])
def test_a_held_rope_swings_as_without_friction(mu):
    """A rope without mass and stretch does not slide on the peg: friction does not change its motion."""
    rough_peg, smooth = run_of(pendulum(mu)), run_of(over_a_peg(*LIGHT))
    assert whats(rough_peg) == TWICE[:2]
    assert rough_peg["load.position"] == pytest.approx(smooth["load.position"], abs=1e-3)  # 2 % of its mass
    assert np.abs(rough_peg.energy_balance().relative).max() < 1e-6


@pytest.mark.slow
def test_zones_converge(swing):
    errors = [np.abs(run_of(pendulum(zones=zones))["load.position"] - swing["load.position"]).max() for zones in (1, 8)]
    assert errors[1] < errors[0] < 2e-4


@pytest.mark.slow
def test_a_mirrored_pendulum(swing):
    run = run_of(pendulum(mirrored=True))
    assert run["load.position"] * [-1, 1, 1] == pytest.approx(swing["load.position"], abs=1e-9)


def test_results_beside_and_on_the_peg(swing):
    """Without contact there is no friction, and the points of zones stay at their shares of a wrap of no length."""
    pressed = swing["peg.wrap_angle"] > 0
    assert (swing["peg.gap"][~pressed] > 0).all() and np.array_equal(swing["peg.gap"][pressed], np.zeros(pressed.sum()))
    for name in ("torque", "slip", "slip_angle"):
        assert np.array_equal(swing[f"peg.{name}"][~pressed], np.zeros((~pressed).sum()))
    limit = np.exp(MU * swing["peg.wrap_angle"][pressed])
    ratio = swing["peg.tension_off"][pressed] / swing["peg.tension_on"][pressed]
    assert (ratio < 1.02 * limit).all() and (ratio > 0.98 / limit).all()
    s = swing["rope.s"]
    assert (np.diff(s, axis=1) > -1e-10).all()
    assert swing["peg.residual"].max() < 1e-10


@pytest.mark.parametrize("rows", [30, 60, 95], ids=["before", "in contact", "after"])
@pytest.mark.parametrize("integrator", ["radau", "genalpha"])
@pytest.mark.slow_cases("radau-before", "radau-after", "genalpha-in contact")
def test_resumed_bit_for_bit(tmp_path, integrator, rows):
    scene = pendulum(zones=2)
    settings = {"duration": 2.0, "output_step": 0.02, "tol": 1e-4, "integrator": integrator, "progress": False}
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", rows, **settings)
    whole = scene.run(**settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)
    assert whats(whole) == whats(resumed) == TWICE[:2]


def test_files_have_the_contact(tmp_path, swing):
    scene = pendulum()
    assert fu.Scene.from_toml(scene.to_toml()).to_toml() == scene.to_toml()
    swing.save(tmp_path / "swing.nc")
    assert np.array_equal(fu.load_run(tmp_path / "swing.nc")["rope.s"], swing["rope.s"])


# ---- integrators

@pytest.mark.parametrize(("integrator", "zones"), [("genalpha", 8), ("explicit", 1)])
def test_integrators_agree(integrator, zones):
    """Explicit steps resolve the damping of zones, whose rates grow with the square of their number over the wrap: one
    zone has no point within the wrap.
    """
    given = {"duration": 0.2, "output_step": 0.02, "progress": False}
    one, other = (pulled_off(**rough(0.1, zones)).run(integrator=each, tol=1e-6, **given)
                  for each in ("radau", integrator))
    assert whats(one) == whats(other) == ["left the sheave"]
    assert np.abs(one["L.position"] - other["L.position"]).max() < 1e-5


# ---- sheaves that turn

def lowered(friction: Callable[..., dict[str, object]] = rough, **drive: object) -> fu.Scene:
    """Return a wheel that is lowered on a rope between two points of the ground for a time, and lifted."""
    scene = fu.Scene(gravity=(0, 0, 0))
    weight(scene, "arm", 1.0, 0.0, 0.31)
    time = np.linspace(0, 1, 101)
    scene.joint("prismatic", (0.0, 0.31, 0), "arm", axis=(0, 1, 0),
                velocity=fu.TableSignal(time=time, value=-0.1 * np.pi * np.sin(2 * np.pi * time)))
    scene.rope("rope", route=[fu.Anchor(at=(-1, 0, 0)),
                              fu.Sheave("wheel", at="arm", radius=0.3, side="left", contact=False, **friction(),
                                        **drive),
                              fu.Anchor(at=(1, 0, 0))], elements=1, tension=100.0, **rope_of(1e5, 1e-3, 0, 1e-3))
    return scene


@pytest.mark.parametrize("friction", [rough, sticky])
def test_a_wheel_slides_where_it_touches(friction):
    """Its rim is faster than the rope: the tensions have the ratio exp(mu theta) at any angle, from the first on."""
    run = run_of(lowered(friction, velocity=5.0), 0.5, 1e-4)
    on = run["wheel.wrap_angle"] > 0
    assert on.any() and not on.all()
    ratio = np.log(run["wheel.tension_off"] / run["wheel.tension_on"])[on]
    assert ratio == pytest.approx(-MU * run["wheel.wrap_angle"][on], rel=0.01)
    assert np.abs(run.energy_balance().relative).max() < 1e-6


@pytest.mark.slow
def test_a_wheel_turns_while_the_rope_is_away():
    """Its inertia, bearing and motor go on: I w' = M - c w."""
    inertia, damping, torque = 0.01, 0.05, 0.3
    run = run_of(lowered(inertia=inertia, damping=damping, torque=torque), 0.5, 1e-5)
    away = run.time < run.events[0]["time"]
    rate, last = damping / inertia, torque / damping
    angle = last * (run.time - (1 - np.exp(-rate * run.time)) / rate)
    assert run["wheel.angle"][away] == pytest.approx(angle[away], abs=1e-6)
    assert run["wheel.angle"][-1] < angle[-1] - 0.1
    assert run["energy.dissipated"][-1] > 0
    assert np.abs(run.energy_balance().relative).max() < 1e-6


@pytest.mark.parametrize(("integrator", "friction"), [
    ("radau", rough), pytest.param("radau", sticky, marks=pytest.mark.slow),
    pytest.param("genalpha", rough, marks=pytest.mark.slow)])
def test_a_rough_peg_on_a_body_keeps_momentum(integrator, friction):
    """A free body with a rough peg strikes a rope between two free weights beside its middle, and leaves it."""
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, x in (("one", -1.0), ("other", 1.0)):
        weight(scene, name, 1.0, x, 0.0)
        scene.force(name, value=(100.0 * x, 0, 0))
    scene.rigid_body("ram", mass=2.0, inertia=(0.3,) * 3, position=(0.02, -0.5, 0), velocity=(0.3, 2.0, 0))
    scene.rope("rope", route=[fu.Anchor("one"), fu.Sheave("peg", at=("ram", (0, 0.1, 0)), radius=0.1, side="right",
                                                          contact=False, **friction()), fu.Anchor("other")],
               elements=2, tension=100.0, **rope_of(1e4, 0.01, 0, 5e-3))
    run = run_of(scene, 0.45, 1e-6, integrator)
    assert whats(run) == TWICE[:2]
    assert np.abs(run.energy_balance().relative).max() < 1e-5
    found = np.array([momenta(scene, run, k) for k in (0, 4, 7, len(run.time) - 1)])
    assert np.abs(found[:, :2] - found[0, :2]).max() < 1e-6  # of 4 kg m/s
    assert np.abs(run["peg.torque"]).max() > 0.1


# ---- rest

@pytest.mark.parametrize("friction", [rough, sticky])
def test_friction_of_a_short_wrap_at_rest(friction):
    """A wrap of 4e-3 rad: both limits are exp(mu theta)."""
    scene = fu.Scene(gravity=(0, 0, 0))
    low = -np.sin(2e-3)
    weight(scene, "load", 1.0, 1.0, low)
    scene.joint("prismatic", (1.0, low, 0), "load", axis=(1, 0, 0))
    scene.force("load", value=(100.0, 0, 0))
    scene.rope("rope", route=[fu.Anchor(at=(-1, low, 0)), fu.Sheave("top", at=(0, -0.2, 0), radius=0.2, side="right",
                                                                    **friction(zones=8)), fu.Anchor("load")],
               elements=1, tension=100.0, **rope_of(1e5, 0.1, 0, 1e-3))
    for impending, sign in (("hoisting", -1), ("lowering", 1)):
        rest = scene.equilibrium(impending=impending)
        assert np.log(rest["top.tension_off"] / rest["top.tension_on"]) / rest["top.wrap_angle"] == pytest.approx(
            sign * MU, rel=1e-8)
    about = scene.equilibrium()
    stuck, slips = (scene.modes(5, about=about, wraps=wraps).frequency for wraps in ("stick", "slip"))
    assert stuck[4] == pytest.approx(np.sqrt(2) * slips[4], rel=0.03)  # half the length of the rope holds the load


@pytest.mark.parametrize("friction", [rough, sticky])
def test_modes_beside_a_rough_peg(friction):
    """A rope does not stick to a peg that it does not touch."""
    pegs = [fu.Sheave("peg", at=(0.3, -1, 0), radius=0.1, side="left", contact=False, **given)
            for given in ({}, friction())]
    smooth, rough_one = (over_a_peg(*LIGHT, start=-0.15, pegs=(peg,)) for peg in pegs)
    rest = smooth.equilibrium(), rough_one.equilibrium()
    assert rest[1]["peg.gap"] == pytest.approx(0.2, abs=1e-6)
    assert rough_one.modes(5, about=rest[1]).frequency == pytest.approx(smooth.modes(5, about=rest[0]).frequency,
                                                                       rel=1e-6, abs=1e-6)


# ---- closed ropes

def loop(height: float, contact: bool, first: int = 0, moving: bool = True, **given: object) -> fu.Scene:
    """Return a belt around two wheels, and a third one that is lowered on it."""
    scene = fu.Scene(gravity=(0, 0, 0))
    weight(scene, "arm", 1.0, 0.5, height)
    if moving:
        time = np.linspace(0, 0.4, 81)
        scene.joint("prismatic", (0.5, height, 0), "arm", axis=(0, 1, 0),
                    velocity=fu.TableSignal(time=time, value=-0.5 * np.sin(np.pi * time / 0.2)))
    route = [fu.Sheave("a", at=(0, 0, 0), radius=0.1, side="right"),
             fu.Sheave("idler", at="arm", radius=0.05, side="left", contact=contact),
             fu.Sheave("b", at=(1, 0, 0), radius=0.1, side="right")]
    scene.rope("loop", closed=True, elements=1, route=route[first:] + route[:first],
               **rope_of(2e4, 4e-4, 0, 3e-4), **given)
    return scene


@pytest.mark.parametrize("first", [pytest.param(0, marks=pytest.mark.slow), 1, pytest.param(2, marks=pytest.mark.slow)])
def test_a_closed_rope_leaves_a_sheave_and_touches_it(first):
    """Its tension follows from its length as drawn at the same height."""
    scene = loop(0.17, False, first, tension=100.0)
    length = scene.ropes["loop"].drawn(scene.bodies).free_length
    run = run_of(scene, 0.38, 1e-4)
    assert whats(run) == TWICE[:2]
    for row, height in enumerate(run["arm.position"][:, 1]):
        drawn = loop(height, bool(run["idler.wrap_angle"][row] > 0), first, False, length=length)
        tension = 2e4 * (drawn.ropes["loop"].drawn(drawn.bodies).stretch - 1)
        assert run["a.tension_on"][row] == pytest.approx(tension, abs=0.5)
    assert np.ptp(run["a.tension_on"]) > 5.0


def test_a_state_of_a_closed_rope_that_has_left():
    """Rates that are not given follow from those of the bodies."""
    run = run_of(loop(0.17, False, 1, tension=100.0), 0.05, 1e-5)
    assert run["idler.gap"][-1] > 0
    assert np.abs(run.energy_balance().relative).max() < 1e-5


def test_refused_closed_ropes():
    with pytest.raises(fu.SceneError, match="needs two sheaves or more that it touches as drawn"):
        fu.Scene().rope("loop", closed=True, tension=10.0, route=[
            fu.Sheave("a", at=(0, 0, 0), radius=0.1, side="right"),
            fu.Sheave("b", at=(1, 0, 0), radius=0.1, side="right", contact=False)], **rope_of(1e4, 0.01, 0))
