"""Ropes that stick to their sheaves at rest, with lengths given per span: closed forms, runs from there, refusals."""

import re
from math import asinh, cos, exp, hypot, log, pi, sin, sqrt

import funicular as fu
import numpy as np
import pytest
from ropes.scenes import GRAVITY, rope_of, weight
from scipy.optimize import fsolve

EA, RHO, R = 1e5, 1.0, 0.1
ENDS = ((-6.0, -0.5), (5.0, -1.0))
TENSIONS = (300.0, 350.0)
pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")


def friction(mu: float, model: str = "stick", velocity: float = 1e-3) -> fu.Friction:
    return fu.Friction(coefficient=mu, model=model, velocity=velocity)


def capstan(tensions, mu=0.3, model="stick", turns=0, gravity=0.0, scene=None, at=(0, 0, 0), **sheave) -> fu.Scene:
    """Return a light rope between two points of the ground over a sheave, as drawn with these tensions beside it."""
    scene = scene or fu.Scene(gravity=(0, -gravity, 0))
    top = fu.Sheave("top", at=at, radius=R, side="right", friction=friction(mu, model), turns=turns, **sheave)
    scene.rope("rope", route=[fu.Anchor(at=(-R, -2, 0)), top, fu.Anchor(at=(R, -2, 0))], elements=2,
               length=[2 / (1 + T / EA) for T in tensions], **rope_of(EA, 1e-3, 0))
    return scene


def line(mu=0.8, lengths=None, element="cable8p", elements=4, friction_of=None) -> fu.Scene:
    """Return a heavy rope between two points of the ground over a sheave with a small wrap."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    top = fu.Sheave("top", at=(0, 0, 0), radius=R, side="right", friction=friction_of or friction(mu))
    given = {"tension": 100.0} if lengths is None else {"length": lengths}
    scene.rope("rope", route=[fu.Anchor(at=(*ENDS[0], 0)), top, fu.Anchor(at=(*ENDS[1], 0))], element=element,
               elements=elements, **given, **rope_of(EA, RHO, 0, 1e-3))
    return scene


DRAWN = line().route_of(line().ropes["rope"])
LENGTHS = [span.length / (1 + T / EA) for span, T in zip(DRAWN.spans, TENSIONS, strict=True)]


def catenary(k: int) -> tuple[float, float]:
    """Return the tension at the tangent point of a span of the line, and the angle of this point, by the equations of
    the elastic catenary: the material of the span is that as drawn but for what is rolled on with its stretch as drawn.
    """
    away, w, phi0 = (-1, 1)[k], RHO * GRAVITY, (DRAWN.sheaves[0].angle_on, DRAWN.sheaves[0].angle_off)[k]

    def left(unknown: np.ndarray) -> list[float]:
        H, V, phi = unknown
        L = LENGTHS[k] + away * R * (phi - phi0) / (1 + TENSIONS[k] / EA)
        top = V + w * L
        x = R * cos(phi) + away * (H * L / EA + H / w * (asinh(top / H) - asinh(V / H)))
        y = R * sin(phi) + V * L / EA + w * L * L / (2 * EA) + (hypot(H, top) - hypot(H, V)) / w
        return [x - ENDS[k][0], y - ENDS[k][1], (H * cos(phi) + away * V * sin(phi)) / TENSIONS[k]]

    H, V, phi = fsolve(left, [TENSIONS[k], -5.0, phi0], xtol=1e-13)
    return hypot(H, V), phi


# ---- closed forms

@pytest.mark.parametrize("element", ["cable8p", "cable12"])
def test_two_elastic_catenaries_over_a_held_sheave(element):
    (on, angle_on), (off, angle_off) = catenary(0), catenary(1)
    rest = line(20.0, LENGTHS, element, 16).equilibrium(wraps="stick")
    assert rest["top.tension_on"] == pytest.approx(on, rel=3e-9)
    assert rest["top.tension_off"] == pytest.approx(off, rel=3e-9)
    assert rest["top.wrap_angle"] == pytest.approx(angle_on - angle_off, abs=1e-6)
    assert rest["top.slip_angle"] == 0 and rest.stable and rest.wraps == "stick"


@pytest.mark.parametrize("model", ["stick", "regularised"])
@pytest.mark.parametrize(("mu", "turns", "sign"), [(0.1, 0, 1), (0.3, 1, 1), (0.3, 1, -1)])
def test_a_capstan_holds_below_its_limit_and_is_refused_above(mu, turns, sign, model):
    theta = pi * (1 + 2 * turns)
    scene = capstan((100.0, 100.0 * exp(mu * theta) * (1 - 1e-5))[::sign], mu, model, turns)
    rest = scene.equilibrium(wraps="stick")
    ratio = log(rest["top.tension_off"] / rest["top.tension_on"]) / theta
    assert sign * ratio == pytest.approx(mu, rel=2e-4) and rest["top.slip_angle"] == 0.0
    assert rest["top.torque"] == pytest.approx(R * (rest["top.tension_on"] - rest["top.tension_off"]), rel=1e-5)
    with pytest.raises(fu.EquilibriumError, match=r'the rope slides on sheave "top" by [0-9.e-]+ m: its coefficient of '
                       r"friction 0\.[13] is below 0\.[13]0000[0-9]+, with which it sticks") as error:
        capstan((100.0, 100.0 * exp(mu * theta) * (1 + 1e-5))[::sign], mu, model, turns).equilibrium(wraps="stick")
    at_limit = error.value.state
    assert at_limit["top.slip_angle"] == pytest.approx(theta, rel=1e-6)
    assert sign * log(at_limit["top.tension_off"] / at_limit["top.tension_on"]) == pytest.approx(mu * theta, rel=1e-8)


# ---- what holds and what slides

def test_ends_of_wraps_slide_where_the_tension_beside_them_changes():
    """Gravity adds 97 and 65 N to the tensions as drawn; all runs from there stay, the point at the limit, too."""
    scene = line(0.8, LENGTHS)
    rest = scene.equilibrium(wraps="stick")
    assert 0 < rest["top.slip_angle"] < rest["top.wrap_angle"]
    for integrator in ("radau", "genalpha"):
        run = scene.run(10.0, output_step=1.0, tol=1e-6, integrator=integrator, initial=rest)
        assert np.abs(run["rope.position"] - rest["rope.position"]).max() < 1e-12
        assert np.abs(run["top.tension_on"] - rest["top.tension_on"]).max() < 1e-8
        assert np.abs(run["top.slip"]).max() < 1e-15


def hung(light: float, heavy: float, mu=0.3, **given) -> fu.Scene:
    """Return two weights on a rope over a sheave, as drawn with their tensions."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "A", light, -R, -2)
    weight(scene, "B", heavy, R, -2)
    top = fu.Sheave("top", at=(0, 0, 0), radius=R, side="right", **{"friction": friction(mu)} | given)
    scene.rope("rope", route=[fu.Anchor("A"), top, fu.Anchor("B")], elements=2,
               length=[2 / (1 + mass * GRAVITY / EA) for mass in (light, heavy)], **rope_of(EA, 1e-3, 0))
    return scene


def test_weights_hang_where_friction_holds_them_and_slide_without_end_above():
    rest = hung(5.0, 5.0 * exp(0.3 * pi) * (1 - 1e-3)).equilibrium(wraps="stick")
    assert rest["B.position"][1] == pytest.approx(-2.0, abs=1e-6) and rest.stable
    needed = log((13.0 + 1e-3) / (5.0 + 1e-3)) / pi
    with pytest.raises(fu.EquilibriumError, match="no state of rest was found with friction at its limit") as error:
        hung(5.0, 13.0).equilibrium(wraps="stick")
    found = float(re.search(r"is below ([0-9.]+), with which it sticks", str(error.value))[1])
    assert found == pytest.approx(needed, rel=1e-3)


@pytest.mark.parametrize("torque", [0.0, 1.0])
def test_a_sheave_that_turns_freely_takes_no_moment_but_that_of_its_drive(torque):
    scene = capstan((100.0, 120.0), gravity=GRAVITY, inertia=0.1, torque=torque)
    rest = scene.equilibrium(wraps="stick")
    assert rest["top.tension_off"] - rest["top.tension_on"] == pytest.approx(torque / R, abs=1e-3)
    assert rest["top.torque"] == pytest.approx(-torque, abs=1e-9)
    run = scene.run(0.2, output_step=0.1, tol=1e-6, integrator="radau", initial=rest)
    assert np.abs(run["top.angle"] - rest["top.angle"]).max() < 1e-9


@pytest.mark.parametrize(("EA_of", "torque"), [(EA, 1.0), (200.0, 2.0)])
def test_the_material_turns_with_what_carries_the_sheave(EA_of, torque):
    """R (T_off - T_on) is the torque on the carrier, and its rotation psi, up to .7 rad, moves R psi over it."""
    scene = fu.Scene(gravity=(0, 0, 0))
    weight(scene, "carrier", 1.0, 0, 0)
    capstan((100.0, 100.0), 0.8, scene=scene, at=("carrier", (0, 0, 0)))
    scene = scene.replace("rope", length=[2 / (1 + 100.0 / EA_of)] * 2, **rope_of(EA_of, 1e-3, 0))
    scene.joint("revolute", (0, 0, 0), "carrier", name="bearing")
    scene.moment("carrier", value=(0, 0, torque))
    rest = scene.equilibrium(wraps="stick")
    w, _, _, z = rest["carrier.orientation"]
    rolled = R * 2 * np.arctan2(z, w) / (1 + 100.0 / EA_of)
    drawn = 2 / (1 + 100.0 / EA_of)
    assert rest["top.tension_off"] - rest["top.tension_on"] == pytest.approx(torque / R, rel=1e-3)
    for name, sign in (("tension_on", 1), ("tension_off", -1)):
        assert rest[f"top.{name}"] == pytest.approx(EA_of * (2 / (drawn + sign * rolled) - 1), rel=3e-3)


def test_a_belt_that_is_tighter_on_one_side_over_two_held_pulleys():
    scene = fu.Scene(gravity=(0, 0, 0))
    rough = {"radius": R, "side": "left", "friction": 0.5}
    scene.rope("belt", closed=True, length=[0.5 / (1 + T / EA) for T in TENSIONS], **rope_of(EA, 0.1, 0), route=[
        fu.Sheave("one", at=(0, 0, 0), **rough), fu.Sheave("other", at=(0.5, 0, 0), **rough)])
    rest = scene.equilibrium(wraps="stick")
    assert [rest[f"{name}.tension_on"] for name in ("other", "one")] == pytest.approx(TENSIONS, rel=1e-9)
    assert rest["one.torque"] == pytest.approx(-rest["other.torque"], rel=1e-9) and rest["one.slip_angle"] == 0


def belt_under_gravity(element: str, tension: float = 300.0, stiffness: float = EA, rho: float = RHO) -> fu.Scene:
    """Return a belt over a held pulley and one that turns."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    route = [fu.Sheave("one", at=(0, 0, 0), radius=0.2, side="left", friction=0.5),
             fu.Sheave("other", at=(1.0, 0, 0), radius=R, side="left", friction=0.5, inertia=1e-3)]
    scene.rope("belt", closed=True, tension=tension, element=element, elements=2, route=route,
               **rope_of(stiffness, rho, 0))
    return scene


def test_a_belt_under_gravity_is_the_same_in_space():
    planar, spatial = (belt_under_gravity(element).equilibrium(wraps="stick") for element in ("cable8p", "cable12"))
    for name in ("one.tension_on", "one.tension_off", "other.tension_on", "one.wrap_angle"):
        assert spatial[name] == pytest.approx(planar[name], rel=1e-6)


def test_a_belt_in_space_runs_round_where_its_friction_is_left_out():
    with pytest.raises(fu.EquilibriumError, match='so that rope "belt" runs round freely; take wraps="stick"'):
        belt_under_gravity("cable12", tension=5.0, stiffness=126.0, rho=0.0126).equilibrium()


def test_a_rope_off_a_drum():
    def scene(**given):
        made = fu.Scene(gravity=(0, -GRAVITY, 0))
        made.rope("rope", elements=2, **rope_of(EA, 0.1, 0), **given, route=[
            fu.Drum("winch", at=(-3, -2, 0), radius=0.2, side="right", length_in_store=5.0), fu.Sheave(
                "top", at=(0, 0, 0), radius=R, side="right", friction=friction(0.5)), fu.Anchor(at=(R, -2, 0))])
        return made

    spans = scene(tension=1.0).route_of(scene(tension=1.0).ropes["rope"]).spans
    lengths = [span.length / (1 + T / EA) for span, T in zip(spans, TENSIONS, strict=True)]
    rest = scene(length=lengths).equilibrium(wraps="stick")
    assert [rest["winch.tension"], rest["top.tension_off"]] == pytest.approx(TENSIONS, abs=3.0)
    run = scene(length=lengths).run(0.5, output_step=0.1, tol=1e-6, initial=rest)
    assert np.abs(run["rope.position"] - rest["rope.position"]).max() < 1e-12


def loaded(scale: fu.TableSignal | None = None, **given) -> fu.Scene:
    """Return equal weights of which one is pulled down, by 40 N or a part of that over time."""
    scene = hung(5.0, 5.0, **given).replace("rope", **rope_of(EA, 0.05, 0, 2e-3))
    if scale is not None:
        scene.force("B", value=(0, -40.0, 0), scale=scale)
    return scene


def test_a_load_is_added_to_a_rope_that_stands():
    """The load that a span gets is held by the wrap, zone by zone from its end on; so it is in a run, which damping
    brings to rest, and with regularised friction, but for its creep.
    """
    before = loaded().equilibrium(seek_stable=False)
    rest = loaded(1.0).equilibrium(wraps="stick", start=before)
    assert rest["A.position"] == pytest.approx(before["A.position"], abs=1e-9)
    ratio = rest["top.tension_off"] / rest["top.tension_on"]
    assert ratio == pytest.approx(1 + 40.0 / (5.0 * GRAVITY), rel=1e-2)
    assert rest["top.slip_angle"] == pytest.approx(log(ratio) / 0.3, abs=pi / 16)
    assert loaded(1.0).equilibrium(wraps="stick", start=rest).iterations <= 3
    sunk, times = before["B.position"][1] - rest["B.position"][1], np.linspace(0, 0.5, 101)
    ramp = fu.TableSignal(time=[*times, 9.0], value=[*(2 * times)**3 * (10 - 30 * times + 24 * times**2), 1.0],
                          interpolation="linear")
    for given, apart in ((friction(0.3), 1e-7), (friction(0.3, "regularised", 1e-6), 3e-6)):
        scene = loaded(ramp, friction=given)
        run = scene.run(1.0, output_step=0.5, tol=1e-5, integrator="radau", initial=before)
        assert before["B.position"][1] - run["B.position"][-1, 1] == pytest.approx(sunk, abs=apart)


def test_runs_with_regularised_friction_begin_with_the_creep_that_holds_the_rope():
    """Tensions jump by 1e-6 of themselves, and friction by as little: it relaxes by 1e-3 m/s."""
    scene = capstan((100.0, 120.0), model="regularised")
    rest = scene.equilibrium(wraps="stick")
    assert rest.held["top"] == pytest.approx(np.full(9, log(1.2) / (0.3 * pi)), rel=2e-2)
    run = scene.run(1e-4, output_step=1e-4, tol=1e-6, integrator="radau", initial=rest)
    for k, tolerance in ((0, 1e-5), (1, 1e-4)):
        for name in ("tension_on", "tension_off", "torque"):
            assert run[f"top.{name}"][k] == pytest.approx(rest[f"top.{name}"], rel=tolerance)
    creep = 1e-3 * log(1.2) / (0.3 * pi)
    assert run["top.slip"][0] == pytest.approx(creep, rel=0.05)


@pytest.mark.parametrize("side", [(0.0, -0.1, 0.0), (0.5, 0.0, 0.0)])
def test_a_rope_with_lengths_starts_without_sliding(side):
    """A body that moves down stretches its span; one that moves to the side rolls it off, as R times its angle."""
    scene = hung(5.0, 10.0).replace("B", velocity=side)
    run = scene.run(1e-3, output_step=1e-3, tol=1e-8, integrator="radau")
    assert abs(run["top.slip"][0]) < 1e-12
    assert run["top.tension_on"] == pytest.approx(5 * GRAVITY, abs=0.03)
    assert run["top.tension_off"] == pytest.approx(10 * GRAVITY - EA * side[1] / 2 * run.time, rel=2e-3)


# ---- beside other things

def test_modes_of_two_weights_that_stick():
    """k = EA/l of each side with its stress-free length; without sticking the state is not at rest."""
    for model in ("stick", "regularised"):
        scene = hung(5.0, 10.0, friction=friction(0.3, model))
        rest = scene.equilibrium(wraps="stick")
        modes = scene.modes(8, about=rest, wraps="stick")
        expected = [sqrt(EA * (1 + m * GRAVITY / EA) / (2 * m)) for m in (10.0, 5.0)]
        assert modes.angular_frequency[4:6] == pytest.approx(expected, rel=1e-4)
    with pytest.raises(fu.SceneError, match=r'has ropes that stick to their sheaves, .* take wraps="stick"'):
        scene.modes(1, about=rest)


def test_the_range_of_tensions_about_a_state_that_sticks():
    """With ends that are held the whole length stays: the mean of the tensions is about that as drawn."""
    scene = capstan((100.0, 120.0), model="regularised")
    found = scene.equilibrium(wraps="stick").rope_tensions("rope").sel(end="start")
    for limit, sign in (("hoisting", -1), ("lowering", 1)):
        one, other = found.sel(limit=limit).values
        assert other / one == pytest.approx(exp(sign * 0.3 * pi), rel=1e-5)
        assert one + other == pytest.approx(220, rel=0.01)


def test_a_file_has_the_lengths_and_the_word():
    scene = capstan((100.0, 120.0))
    scene.equilibrium_settings = {"wraps": "stick"}
    again = fu.Scene.from_toml(scene.to_toml())
    assert again.ropes["rope"].length == scene.ropes["rope"].length
    run = again.run(0.01, output_step=0.01, initial="equilibrium")
    assert [run[f"top.{name}"][-1] for name in ("tension_on", "tension_off")] == pytest.approx([100.0, 120.0], rel=1e-6)


def test_a_sheave_without_friction_is_named_with_what_holds():
    low = fu.Sheave("low", at=(-R, 0.5, 0), radius=R, side="right")
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rope("rope", route=[fu.Anchor(at=(-1, -2, 0)), low, fu.Sheave("top", at=(1, 0, 0), radius=R, side="right",
                              friction=0.3), fu.Anchor(at=(1 + R, -2, 0))], tension=100.0, **rope_of(EA, 1e-3, 0))
    spans = scene.route_of(scene.ropes["rope"])
    lengths = [span.length / (1 + T / EA) for span, T in zip(spans.spans, (100.0, 110.0, 120.0), strict=True)]
    rest = scene.replace("rope", length=lengths).equilibrium(wraps="stick")
    needed = log(1.1) / spans.sheaves[0].wrap
    assert rest.messages[0].startswith('rope "rope" slides on sheave "low", which has no friction, to lengths of ')
    assert rest.messages[0].endswith(f"a coefficient of {needed:.4g} holds it")
    assert rest["low.tension_on"] == pytest.approx(rest["low.tension_off"], rel=1e-9)


# ---- refusals

def test_a_span_that_becomes_slack_is_refused():
    """The beam that carries the sheave sinks by far more than the stretch of the spans."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    scene.cable("beam", start=(-1, 0, 0), end=(1, 0, 0), elements=4, element="cable8p", material=fu.Material(
        youngs_modulus=2e11, poisson_ratio=0.3, density=7800), section=fu.Rectangle(height=0.02, width=0.02))
    scene.clamp("beam", s=0.0)
    scene.rope("rope", elements=2, length=[1.998, 1.998], **rope_of(EA, 0.05, 0), route=[
        fu.Anchor(at=(0.5, -2, 0)), fu.Sheave("top", at=("beam", 1.6), radius=R, side="right", friction=0.5),
        fu.Anchor(at=(0.8, -2, 0))])
    with pytest.raises(fu.EquilibriumError, match=r'a span beside sheave "top" is slack|it has no tension there'):
        scene.equilibrium(wraps="stick")


@pytest.mark.parametrize(("change", "words"), [
    ({"length": [2.0]}, "length must be one number or 2, one for each span, got 1"),
    ({"length": [1.9, 0.0]}, "length must be positive, got 0 m"),
    ({"length": [1.9, -1.0]}, "length must be positive, got -1 m"),
    ({"length": [1.9, 2.1]}, "is never taut: the length of its span 1, 2.1 m, exceeds that as drawn, 2 m, by 0.1 m"),
    ({"length": [1.9, 1.9], "tension": 10.0}, "has tension and length; give one of them"),
    ({"mass": False}, "has no mass, and lengths of spans"),
    ({"route": [fu.Anchor(at=(-1, -2, 0)), fu.Sheave("top", at=(0, 0, 0), radius=R, side="left", contact=False),
                fu.Anchor(at=(1, -2, 0))]}, 'has lengths of spans, and sheave "top" has contact=False'),
])
def test_refused_lengths(change, words):
    with pytest.raises(fu.SceneError, match=re.escape(words)):
        capstan((100.0, 120.0)).replace("rope", **change)


@pytest.mark.parametrize(("scene", "settings", "words"), [
    (capstan((100.0, 100.0), mu=0.0), {}, 'wraps="stick" needs a rope with mass and with friction on a sheave'),
    (capstan((100.0, 120.0)), {"impending": "hoisting"}, 'has wraps="stick" and impending="hoisting"'),
    (capstan((100.0, 120.0)), {"method": "arc_length"}, 'has ropes that stick along no path'),
    (capstan((100.0, 120.0)), {"adjust": ["rope.length.0"], "to": {"top.torque": 0.0}},
     "adjusts no parameters of scenes with ropes that stick"),
    (capstan((100.0, 120.0)), {"wraps": "glue"}, "wraps"),
])
def test_refused_settings(scene, settings, words):
    with pytest.raises(fu.SceneError, match=re.escape(words)):
        scene.equilibrium(**{"wraps": "stick"} | settings)


def test_lengths_of_spans_start_at_rest_in_space():
    def moving(element):
        scene = hung(5.0, 10.0).replace("A", velocity=(0, 1.0, 0))
        return scene.replace("rope", element=element)

    assert moving("cable8p").run(1e-4, output_step=1e-4)["A.velocity"][0, 1] == 1.0
    with pytest.raises(fu.SceneError, match="is in space and has lengths of spans, and what holds it moves as drawn"):
        moving("cable12").run(0.01)
