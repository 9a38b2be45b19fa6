"""The part of a wrap over which a rope slides, against Eytelwein's equation and the belt of the reference."""

from math import degrees, log, pi

import funicular as fu
import numpy as np
import pytest
from ropes.belts import steady
from ropes.scenes import GRAVITY, over_one, rope_of, weight

pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")


def weights(ratio: float, mu: float = 0.3, **sheave) -> fu.Scene:
    """Return two weights on a light rope over a held sheave, the second one heavier."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    for name, x, mass in (("one", -0.2, 1.0), ("other", 0.2, ratio)):
        weight(scene, name, mass, x, -2)
    over_one(scene, 0.2, ("one", "other"), elements=1, tension=GRAVITY, given=rope_of(1e5, 1e-3, 0, 1e-3),
             friction=fu.Friction(coefficient=mu, velocity=1e-4), **sheave)
    return scene


@pytest.mark.parametrize("zones", [1, 8])
@pytest.mark.parametrize("ratio", [1.2, 1 / 1.2, 2.0])
@pytest.mark.slow_cases("2.0-8", "1.2-8")
def test_weights_that_creep(ratio, zones):
    """Friction holds them: over ln(T2/T1)/mu it is at its limit."""
    run = weights(ratio, zones=zones).run(1.0, output_step=0.5, tol=1e-5, integrator="radau")
    measured = np.abs(np.log(run["top.tension_off"] / run["top.tension_on"])) / 0.3
    assert run["top.slip_angle"][-1] == pytest.approx(measured[-1], rel=2e-3)
    assert run["top.slip_angle"][-1] == pytest.approx(abs(log(ratio)) / 0.3, rel=5e-3)
    assert run["top.slip_angle"][-1] < run["top.wrap_angle"][-1]


def test_weights_that_slide():
    """The limit is exceeded: the whole wrap slides."""
    run = weights(4.0).run(0.2, output_step=0.1, tol=1e-5, integrator="radau")
    assert run["top.slip_angle"][-1] == pytest.approx(run["top.wrap_angle"][-1], rel=1e-6)
    assert run["top.slip_angle"][0] == 0.0


def test_without_friction_nothing_and_at_the_limit_all():
    scene = weights(1.0)
    assert scene.equilibrium(seek_stable=False)["top.slip_angle"] == 0.0
    held = fu.Scene(gravity=(0, 0, 0))
    weight(held, "one", 1.0, -0.2, -2)
    held.force("one", value=(0, -50.0, 0))
    held.rope("rope", route=[fu.Anchor("one"), fu.Sheave("top", at=(0, 0, 0), radius=0.2, side="right", friction=0.2),
                             fu.Anchor(at=(0.2, -2, 0))], elements=1, tension=50.0, **rope_of(1e5, 1e-3, 0))
    rest = held.equilibrium(impending="lowering")
    assert rest["top.slip_angle"] == pytest.approx(rest["top.wrap_angle"], rel=1e-12)


@pytest.mark.slow
def test_a_belt_slides_over_a_part_of_its_pulleys(tmp_path):
    """The reference slides over 145.573 degrees of both pulleys; the file has the same."""
    x = np.clip((np.linspace(0, 2.5, 501) - 1) / 0.5, 0, 1)
    load = fu.TableSignal(time=np.linspace(0, 2.5, 501), value=-25 * x * x * (3 - 2 * x))
    pulley = {"radius": 0.1, "side": "left", "inertia": 0.25, "zones": 16,
              "friction": fu.Friction(coefficient=0.5, velocity=1e-4)}
    scene = fu.Scene(gravity=(0, 0, 0))
    turning = fu.TableSignal(time=[0, 0.05, 0.6, 3], value=[0, 0, 12, 12], interpolation="linear")
    scene.rope("belt", closed=True, length=1.1938052, elements=1, **rope_of(7600.0, 0.872421, 0, 1e-3), route=[
        fu.Sheave("driver", at=(0, 0, 0), velocity=turning, **pulley),
        fu.Sheave("driven", at=(0.1 * pi, 0, 0), damping=2.0, torque=load, **pulley)])
    run = scene.run(2.45, output_step=0.05, tol=1e-3, integrator="radau", save=tmp_path / "belt.nc")
    assert degrees(run["driven.slip_angle"][-1]) == pytest.approx(steady()[3], rel=1e-3)
    assert degrees(run["driver.slip_angle"][-1]) == pytest.approx(steady()[3], rel=1e-2)
    assert fu.load_run(tmp_path / "belt.nc")["driver.slip_angle"].tolist() == run["driver.slip_angle"].tolist()
    assert run.variables["driver.slip_angle"].units == "rad"
