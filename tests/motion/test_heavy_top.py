"""A rigid body whose centre of mass is off its origin: a fast heavy top in steady precession, and other origins.

A stiff spring of zero length ties the foot of the top to the origin. In steady precession it is at rest, with the foot
at -F/k, so that the motion has a closed form.
"""

import numpy as np
import pytest
from funicular import Scene, SceneError
from funicular.base.rotations import rotate
from scipy.optimize import fsolve

MASS, ARM, AXIAL, ACROSS, GRAVITY, STIFFNESS = 1.0, 0.1, 1e-3, 2e-3, 9.81, 1e5
TILT, SPIN = 0.6, 1e3


def precession() -> tuple[float, float]:
    """Return the rate of precession in rad/s, and the distance of the centre of mass from the vertical in m."""
    s, c = np.sin(TILT), np.cos(TILT)

    def off(x):
        rate, radius = x
        inward = -STIFFNESS * (radius - ARM * s)
        torque = -ARM * c * inward + ARM * s * MASS * GRAVITY
        return rate * (AXIAL * SPIN * s - ACROSS * rate * s * c) - torque, MASS * rate**2 * radius + inward

    return tuple(fsolve(off, [MASS * GRAVITY * ARM / AXIAL / SPIN, ARM * s], xtol=1e-13))


def top(rate: float, radius: float) -> Scene:
    s = np.sin(TILT)
    foot = np.array([radius - ARM * s, 0, -MASS * GRAVITY / STIFFNESS])
    scene = Scene(gravity=(0, 0, -GRAVITY))
    scene.rigid_body("top", mass=MASS, inertia=(ACROSS, ACROSS, AXIAL), position=tuple(foot), centre=(0, 0, ARM),
                     orientation=(np.cos(TILT / 2), 0, np.sin(TILT / 2), 0), velocity=(0, rate * foot[0], 0),
                     angular_velocity=(-rate * s, 0, SPIN))
    scene.spring("top", (0, 0, 0), stiffness=STIFFNESS, length=0.0)
    return scene


# measured: radau 1e-7, 8e-11, 5e-8; genalpha 2e-4, 2e-9, 1e-6; energy 1e-6, 4e-13, 2e-12; explicit 1e-11, 2e-15, 1e-12
@pytest.mark.parametrize(("integrator", "settings", "axis_off", "energy_off", "momentum_off"), [
    ("radau", {"tol": 1e-8}, 5e-7, 5e-10, 2e-7),
    ("genalpha", {"step": 5e-5, "spectral_radius": 1.0}, 5e-4, 1e-8, 5e-6),
    ("energy", {"step": 5e-5}, 5e-6, 2e-12, 1e-11),
    ("explicit", {"tol": 1e-9}, 1e-10, 1e-13, 1e-11),
])
def test_a_fast_heavy_top_precesses_steadily(integrator, settings, axis_off, energy_off, momentum_off, validated):
    """80 turns about its axis at 1000 rad/s; errors of the axis in rad, relative errors of energy and angular momentum.
    """
    rate, radius = precession()
    run = top(rate, radius).run(duration=0.5, output_step=0.05, integrator=integrator, **settings)
    angle, orientation, omega = rate * run.time, run["top.orientation"], run["top.angular_velocity"]
    s, c = np.sin(TILT), np.cos(TILT)
    along = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    axis = rotate(orientation, (0, 0, 1.0))
    validated("Bodies and mechanisms", "fast heavy top, 80 turns", "direction of its axis", s * along + [0, 0, c], axis,
              scale=1.0, bound=axis_off, source="closed form, steady precession", variant=integrator)
    foot = (radius - ARM * s) * along - [0, 0, MASS * GRAVITY / STIFFNESS]
    assert np.abs(run["top.position"] - foot).max() < 1e-6 * ARM
    assert np.abs(run.energy_balance().residual).max() < energy_off * run["energy.kinetic"][0]
    centre = run["top.position"] + ARM * axis
    velocity = run["top.velocity"] + rotate(orientation, np.cross(omega, (0, 0, ARM)))
    moment = np.cross(centre, MASS * velocity) + rotate(orientation, omega * [ACROSS, ACROSS, AXIAL])
    assert np.ptp(moment[:, 2]) < momentum_off * moment[0, 2]
    if integrator == "explicit":
        assert np.abs(run["top.acceleration"] + rate**2 * (radius - ARM * s) * along).max() < 1e-6


def test_the_origin_of_a_body_is_a_choice():
    """The body described from its centre and from another origin has the same motion of every point."""
    ends = []
    for origin in (np.zeros(3), np.array([0.1, -0.2, 0.3])):
        scene = Scene()
        turn = np.array([0.8, 0.0, 0.6, 0.0])
        spin = np.array([3.0, -2.0, 5.0])
        scene.rigid_body("A", mass=2.0, inertia=(0.1, 0.2, 0.25), orientation=tuple(turn), centre=tuple(-origin),
                         position=tuple(rotate(turn, origin)), angular_velocity=tuple(spin),
                         velocity=tuple(np.array([1, 0, 0]) + rotate(turn, np.cross(spin, origin))))
        scene.spring(("A", tuple(np.array([0.3, 0, 0]) - origin)), (1.0, 1.0, 0.0), stiffness=50.0, damping=0.1)
        scene.force("A", at=tuple(-origin), value=(1, 2, 3), follower=True)
        scene.event("passes", quantity="A.position.x", value=0.35)
        run = scene.run(duration=0.4, tol=1e-9, output_step=0.1)
        ends.append((run["A.position"] - rotate(run["A.orientation"], origin), run["A.orientation"]))
        if origin.any():
            assert [abs(e["state"]["A.position"][0] - 0.35) < 1e-8 for e in run.events if e["name"] == "passes"]
    for one, other in zip(*ends, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-7)


def test_centre_is_checked():
    with pytest.raises(SceneError, match=r'rigid_body "A": centre must be 3 numbers'):
        Scene().rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 0), centre=(0, 0))
