"""Ropes at rest in hard cases: without tension as drawn, far lighter and heavier than their loads, over 40 sheaves."""

from math import exp

import funicular as fu
import numpy as np
import pytest
from ropes.scenes import GRAVITY, rope_of, weight

EA = 1e6
pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")


def hung(mass: float, rho: float, below: float = 3.0, side: float = -1.0, **given) -> fu.Scene:
    """Return a load on a rope from the ground over a sheave."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "load", mass, 0.3, -below)
    scene.rope("rope", elements=4, **rope_of(EA, rho, 0), route=[
        fu.Anchor(at=(side, -below, 0)), fu.Sheave("top", at=(0, 0, 0), radius=0.3, side="right"), fu.Anchor("load")],
        **given)
    return scene


@pytest.mark.parametrize("mass", [10.0, 1000.0])
def test_no_tension_as_drawn(mass):
    """The length is that of the route but for 2e-7 of it, a tension of .2 N: Newton's method stretches the rope."""
    scene = hung(mass, 0.1, side=-5.0, tension=50.0)
    length = scene.route_of(scene.ropes["rope"]).length * (1 - 2e-7)
    rest = scene.replace("rope", length=length).equilibrium()
    assert rest.stable and rest.iterations < 30
    assert np.linalg.norm(rest["rope.end_force"]) == pytest.approx(mass * GRAVITY, rel=1e-6)


@pytest.mark.parametrize("ratio", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("guess", [0.3, 1.0, 5.0])
def test_ropes_far_lighter_and_far_heavier_than_their_load(ratio, guess):
    """Between points of one height the first tension is the weight; a rope drawn with another one moves the load."""
    mass = 2.0
    rho = ratio * mass / 7.0
    rest = hung(mass, rho, side=-0.3, tension=guess * mass * GRAVITY).equilibrium()
    assert np.linalg.norm(rest["rope.start_force"]) == pytest.approx(mass * GRAVITY, rel=2e-3 * max(1.0, ratio))
    assert np.linalg.norm(rest["rope.end_force"]) == pytest.approx(mass * GRAVITY, rel=1e-7 * max(1.0, ratio))
    along = rest["top.tension_on"] - rest["top.tension_off"]
    assert along == pytest.approx(0.0, abs=1e-6 * rest["top.tension_on"])


def row(rho: float, mu: float = 0.0) -> fu.Scene:
    """Return a load on a rope over and under 40 sheaves, alternately."""
    n, scene = 40, fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "load", 200.0, n - 0.8, -3)
    friction = {"friction": mu, "zones": 4} if mu else {}
    sheaves = [fu.Sheave(f"on_{k}", at=(k + 0.0, 0, 0), radius=0.2, side=("right", "left")[k % 2], **friction)
               for k in range(n - 1)]
    last = fu.Sheave("last", at=(n - 1.0, 0.0, 0), radius=0.2, side="right", **friction)
    scene.rope("rope", elements=1, tension=1900.0, **rope_of(EA, rho, 0),
               route=[fu.Anchor(at=(-1, -0.5, 0)), *sheaves, last, fu.Anchor("load")])
    return scene


@pytest.mark.parametrize("rho", [1e-3, 0.5, 20.0])
def test_forty_sheaves_in_a_row_at_rest(rho):
    """The sum of W and weight along the rope is that of the load at every sheave, to the height within its radius."""
    rest = row(rho).equilibrium()
    assert rest.stable and rest.iterations < 10
    at_load, y = 200 * GRAVITY, rest["load.position"][1]
    constant = -at_load - at_load**2 / (2 * EA) + rho * GRAVITY * y
    for sheave in row(rho).ropes["rope"].sheaves:
        for name in ("tension_on", "tension_off"):
            T = rest[f"{sheave.name}.{name}"]
            assert -T - T**2 / (2 * EA) == pytest.approx(constant, abs=rho * GRAVITY * 0.21 + 1e-4)


@pytest.mark.parametrize(("motion", "sign"), [("hoisting", 1), ("lowering", -1)])
def test_forty_sheaves_multiply_their_friction(motion, sign):
    rest = row(1e-3, 0.05).equilibrium(impending=motion)
    wrap = sum(rest[f"{sheave.name}.wrap_angle"] for sheave in row(1e-3).ropes["rope"].sheaves)
    ratio = np.linalg.norm(rest["rope.start_force"]) / (200 * GRAVITY)
    assert wrap > 20 and ratio == pytest.approx(exp(sign * 0.05 * wrap), rel=2e-4)
    assert rest.iterations < 20
