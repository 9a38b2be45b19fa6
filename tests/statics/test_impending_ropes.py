"""Ropes at rest that are about to slide on their sheaves, against Eytelwein's equation, and what is refused."""

import re
from math import exp, pi

import funicular as fu
import numpy as np
import pytest
from ropes.capstans import held_cylinder
from ropes.scenes import GRAVITY, rope_of, weight

SIGNS = {"hoisting": 1, "lowering": -1}
HELD = list(zip((0.1, 0.3), held_cylinder(), strict=True))
pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")


def loaded(*sheaves: fu.Sheave, gravity=0.0, rho=1e-3, end=(-0.1, -2, 0), x=0.1, scene=None, **given) -> fu.Scene:
    """Return a load of 30 N on a rope from the ground over sheaves."""
    scene = scene or fu.Scene(gravity=(0, -gravity, 0))
    weight(scene, "load", 1.0, x, -2)
    scene.force("load", value=(0, -30.0, 0))
    scene.rope("rope", route=[fu.Anchor(at=end), *sheaves, fu.Anchor("load")], tension=30.0,
               **{"elements": 1} | rope_of(1e7, rho, 0) | given)
    return scene


def capstan(mu: float, turns: int = 0, **given) -> fu.Sheave:
    return fu.Sheave("held", turns=turns, side="right", **{"at": (0, 0, 0), "radius": 0.1, "friction": mu} | given)


@pytest.mark.parametrize("motion", SIGNS)
@pytest.mark.parametrize(("mu", "turns", "ratio"), [(0.1, 0, 1.369108), (0.3, 0, 2.566332), (0.3, 1, 16.90202)])
def test_capstans_at_rest(mu, turns, ratio, motion):
    rest = loaded(capstan(mu, turns)).equilibrium(impending=motion)
    ratio = ratio ** SIGNS[motion]
    assert rest["held.tension_off"] == pytest.approx(30.0, rel=1e-6)
    assert rest["held.tension_on"] / rest["held.tension_off"] == pytest.approx(ratio, rel=1e-5)
    assert rest["held.torque"] == pytest.approx(0.1 * 30.0 * (ratio - 1), rel=1e-4)
    assert rest["held.slip"] == 0.0 and rest.stable and not any("friction" in each for each in rest.messages)


@pytest.mark.parametrize("zones", [1, 2, 16])
def test_the_limit_is_exact_at_any_number_of_zones(zones):
    rest = loaded(capstan(0.3, zones=zones)).equilibrium(impending="hoisting")
    assert rest["held.tension_on"] / rest["held.tension_off"] == pytest.approx(exp(0.3 * pi), rel=1e-5)


def test_a_fleet_angle_leaves_the_ratio():
    sheave = capstan(0.3, axis=(0, 0, 1))
    scene = loaded(sheave, element="cable12", end=(-0.1, -2, 0.05), elements=4)
    rest = scene.equilibrium(impending="lowering")
    assert rest["held.fleet_angle_on"] > 0.02
    assert rest["held.tension_off"] / rest["held.tension_on"] == pytest.approx(
        exp(0.3 * rest["held.wrap_angle"]), rel=1e-3)


@pytest.mark.parametrize(("mu", "longest"), HELD)
def test_a_heavy_rope_over_a_held_cylinder(mu, longest):
    """A light side of .15 m holds a heavy one of .22929 and .48507 m, where the rope is about to run down there."""
    R, rho, light = 0.051, 0.5, 0.15
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "end", 1e-6, -R, -light)
    scene.rope("rope", route=[fu.Anchor("end"), capstan(mu, radius=R, zones=16), fu.Anchor(at=(R, -0.1, 0))],
               elements=1, tension=rho * GRAVITY * light, **rope_of(1e5, rho, 0))
    rest = scene.equilibrium(impending="lowering")
    assert -rest["end.position"][1] == pytest.approx(light, rel=2e-5)
    assert rest["held.tension_off"] / (rho * GRAVITY) == pytest.approx(longest, rel=1e-3)


@pytest.mark.parametrize("motion", SIGNS)
@pytest.mark.parametrize(("mu", "longest"), HELD)
def test_a_heavy_rope_with_free_ends_finds_its_place(mu, longest, motion):
    """Drawn with equal sides it slides to where it is about to run down, which a small disturbance lets it do."""
    R, rho, light = 0.051, 0.5, 0.15
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    side = (light + longest) / 2
    for name, x in (("a", -R), ("b", R)):
        weight(scene, name, 1e-6, x, -side)
    scene.rope("rope", route=[fu.Anchor("a"), capstan(mu, radius=R, zones=16), fu.Anchor("b")], elements=1,
               tension=rho * GRAVITY * side, **rope_of(1e5, rho, 0))
    rest = scene.equilibrium(impending=motion, seek_stable=False)
    sides = sorted(-rest[f"{name}.position"][1] for name in "ab")
    assert sides == pytest.approx([light, longest], rel=1e-3)
    assert (rest["a.position"][1] < rest["b.position"][1]) == (motion == "hoisting")
    assert rest.unstable_directions == 1


def test_a_sheave_that_turns_freely_has_no_friction():
    """Between two held ones: their ratios alone count."""
    sheaves = [capstan(0.2), fu.Sheave("free", at=(0.4, -1, 0), radius=0.1, side="left", friction=0.5, inertia=0.1),
               fu.Sheave("turned", at=(0.8, 0, 0), radius=0.1, side="right", friction=0.1, velocity=2.0)]
    rest = loaded(*sheaves, x=0.9).equilibrium(impending="hoisting")
    for name, mu in (("held", 0.2), ("free", 0.0), ("turned", 0.1)):
        assert rest[f"{name}.tension_on"] / rest[f"{name}.tension_off"] == pytest.approx(
            exp(mu * rest[f"{name}.wrap_angle"]), rel=1e-5), name
    assert rest["free.torque"] == 0.0


def test_a_sheave_on_a_body_takes_its_moment_along():
    scene = fu.Scene(gravity=(0, 0, 0))
    weight(scene, "carrier", 1.0, 0, 0)
    loaded(capstan(0.3, at="carrier"), scene=scene)
    scene.joint("weld", (0, 0, 0), "carrier", name="held_by")
    rest = scene.equilibrium(impending="hoisting")
    assert abs(rest["held_by.moment"][2]) == pytest.approx(0.1 * 30 * (exp(0.3 * pi) - 1), rel=1e-4)


def test_a_moving_load_differs_by_the_limits():
    """A load on a pulley between a held and a rough sheave hangs where both tensions balance it: the difference of the
    limits grows with friction, and the state without friction is between them.
    """
    scene = loaded(capstan(0.2), gravity=GRAVITY, rho=0.1)
    rest = scene.equilibrium()
    places = {motion: scene.equilibrium(impending=motion)["load.position"][1] for motion in SIGNS}
    assert places["lowering"] > rest["load.position"][1] > places["hoisting"]
    assert rest.messages[0] == 'friction of "held" is left out: at rest ropes move freely'


def test_the_range_of_the_tensions_of_spans():
    sheaves = [capstan(0.2), fu.Sheave("next", at=(0.4, 0.1, 0), radius=0.1, side="right", friction=0.1)]
    rest = loaded(*sheaves, x=0.5, end=(-0.1, -2, 0)).equilibrium()
    found = rest.rope_tensions("rope")
    assert found.dims == ("span", "end", "limit") and found.attrs["units"] == "N"
    assert found.span.values.tolist() == ["ground to held", "held to next", "next to load"]
    angles = [rest[f"{name}.wrap_angle"] for name in ("held", "next")]
    for motion, sign in SIGNS.items():
        of_spans = 30.0 * np.exp(sign * np.array([0.2 * angles[0] + 0.1 * angles[1], 0.1 * angles[1], 0.0]))
        for end in ("start", "end"):
            assert found.sel(limit=motion, end=end).values == pytest.approx(of_spans, rel=1e-5)
    with pytest.raises(fu.UnknownResultError, match='there is no rope "load"'):
        rest.rope_tensions("load")


def test_an_adjusted_state_is_one_at_the_limit():
    """The friction with which a load is held by 20 N."""
    scene = loaded(capstan(0.1))
    path = "rope.route.1.friction.coefficient"
    rest = scene.equilibrium(impending="lowering", adjust=[path], to={"held.tension_on": 20.0})
    assert rest.adjusted[path] == pytest.approx(np.log(1.5) / pi, rel=1e-4)


@pytest.mark.parametrize(("scene", "settings", "words"), [
    (loaded(capstan(0.0, friction=None)), {"impending": "hoisting"},
     'impending="hoisting" needs a rope with friction on a sheave that is held or whose rotation is prescribed'),
    (loaded(capstan(0.2, inertia=0.1)), {"impending": "lowering"}, "needs a rope with friction on a sheave that is"),
    (loaded(capstan(0.2)), {"impending": "raising"}, '"raising" is not known'),
    (loaded(capstan(0.2)), {"impending": "hoisting", "method": "arc_length"}, 'take method="newton"'),
])
def test_refused(scene, settings, words):
    with pytest.raises(fu.SceneError, match=re.escape(words)):
        scene.equilibrium(**settings)


def test_no_state_at_the_limit_is_said():
    """Two weights on a held sheave balance without friction alone: at its limit their ratio is another one."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    for name, x in (("a", -0.1), ("b", 0.1)):
        weight(scene, name, 3.0, x, -2)
    scene.rope("rope", route=[fu.Anchor("a"), capstan(0.3), fu.Anchor("b")], elements=1, tension=3 * GRAVITY,
               **rope_of(1e5, 1e-3, 0))
    with pytest.raises(fu.EquilibriumError, match=r'no equilibrium was reached with ropes at the limit of friction, '
                       r'"hoisting": .*; from the state without friction this was raised to [0-9.]+ % of its limit'):
        scene.equilibrium(impending="hoisting", seek_stable=False)


def test_modes_about_a_limit_are_refused():
    scene = loaded(capstan(0.1))
    rest = scene.equilibrium(impending="hoisting")
    assert rest.impending == "hoisting" and scene.equilibrium().impending is None
    with pytest.raises(fu.SceneError, match="has ropes at the limit of friction"):
        scene.modes(1, about=rest, wraps="stick")


def test_a_closed_rope_has_no_limit():
    scene = fu.Scene(gravity=(0, 0, 0))
    rough = {"radius": 0.1, "side": "left", "friction": 0.3}
    scene.rope("belt", closed=True, tension=50.0, **rope_of(1e5, 0.1, 0), route=[
        fu.Sheave("one", at=(0, 0, 0), **rough), fu.Sheave("other", at=(0.5, 0, 0), **rough)])
    with pytest.raises(fu.SceneError, match=r'rope "belt": sheave "one": .* in one sense all around a closed rope'):
        scene.equilibrium(impending="hoisting")


def test_a_file_has_the_motion():
    scene = loaded(capstan(0.1))
    scene.equilibrium_settings = {"impending": "lowering"}
    rest = fu.Scene.from_toml(scene.to_toml()).equilibrium()
    assert rest["held.tension_on"] / rest["held.tension_off"] == pytest.approx(exp(-0.1 * pi), rel=1e-5)
