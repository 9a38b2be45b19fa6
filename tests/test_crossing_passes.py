"""Cables that fly through each other: no touch is missed, however long the steps are beside it."""

import funicular as fu
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

RADIUS, MATERIAL = 0.005, fu.Material(youngs_modulus=1e6, poisson_ratio=0.3, density=1000)
part, angle = st.floats(-0.9, 0.9), st.floats(0, 2 * np.pi)


def direction(azimuth: float, height: float) -> np.ndarray:
    """Return a unit vector (3,)."""
    return np.array([*(np.sqrt(1 - height**2) * np.array([np.cos(azimuth), np.sin(azimuth)])), height])


def flying(curves: tuple, velocities: tuple) -> fu.Scene:
    """Return a scene with two cables through points, which fly; contact is too soft to change how."""
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, points, velocity in zip("ab", curves, velocities, strict=True):
        up = np.eye(3)[np.argmin(np.abs(points[-1] - points[0]))]
        scene.cable(name, points=points.tolist(), elements=4, element="cable12", section=fu.Circle(radius=RADIUS),
                    up=tuple(up), material=MATERIAL, velocity=tuple(velocity))
    scene.crossing("a", "b", name="contact", stiffness=1e-9)
    return scene


def check(second, length, bows, at, azimuth, approach, log_speed, when, share, steps, integrator, off):
    """Lines that bend away from each other touch first where they are placed to, at a part `when` of the duration.

    Tangents there are `second` rad apart. The lines come nearer by the part `approach` of the speed, and may be past
    the ends of each other at the end of the same step. off: of the drawn lines from their elements, m.
    """
    normal, halves = np.array([0, 0, 1.0]), (np.array([1.0, 0, 0]), length * direction(second, 0))
    speed = 10**log_speed
    duration, velocity = 1 / speed, -speed * direction(azimuth, approach)
    from_touch = np.linspace(-1, 1, 41)[:, None] - np.array(at)
    bends = [(1 - 2 * k) * bows[k] * np.linalg.norm(halves[k]) * normal for k in (0, 1)]
    first, other = (from_touch[:, [k]] * halves[k] + from_touch[:, [k]]**2 * bends[k] for k in (0, 1))
    first = first + 2 * RADIUS * normal - when * duration * velocity
    # fixed steps as long as these are too long for the explicit method
    given = {"tol": 1e-3} if steps is None or integrator == "explicit" else {"step": duration / steps}
    run = flying((first, other), (velocity * share, velocity * (share - 1))).run(
        duration, output_step=duration, integrator=integrator, progress=False, **given)
    touches = [event["time"] for event in run.report["events"] if event["what"] == "came into contact"]
    assert touches, "missed"
    assert abs(touches[0] - when * duration) < off / (speed * approach)


GIVEN = {"second": st.floats(0.3, 2.8), "length": st.floats(0.2, 1), "at": st.tuples(part, part), "azimuth": angle,
         "log_speed": st.floats(0, 2), "when": st.floats(0.1, 0.9), "share": st.floats(0, 1),
         "steps": st.sampled_from([1, 7, None]),
         "integrator": st.sampled_from(["genalpha", "radau", "explicit", "energy"])}


@settings(max_examples=60, deadline=None, derandomize=True)
@given(approach=st.floats(0.2, 1), **GIVEN)
def test_straight_cables_do_not_fly_through_each_other(**case):
    check(bows=(0, 0), off=1e-9, **case)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(approach=st.floats(0.7, 1), bows=st.tuples(st.floats(0, 0.2), st.floats(0, 0.2)), **GIVEN)
def test_bent_cables_do_not_fly_through_each_other(**case):
    """They come head on; test_crossing_grazes.py has those that graze."""
    check(off=3e-4, **case)
