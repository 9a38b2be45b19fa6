"""Cables fly through each other: no contact is missed, at any step."""

import funicular as fu
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

RADIUS, MATERIAL = 0.005, fu.Material(youngs_modulus=1e6, poisson_ratio=0.3, density=1000)
pytestmark = pytest.mark.filterwarnings("ignore:contact:funicular.FunicularWarning")  # so soft a contact is deep
part, angle = st.floats(-0.9, 0.9), st.floats(0, 2 * np.pi)


def direction(azimuth: float, height: float) -> np.ndarray:
    """Return a unit vector (3,)."""
    return np.array([*(np.sqrt(1 - height**2) * np.array([np.cos(azimuth), np.sin(azimuth)])), height])


def flying(curves: tuple, velocities: tuple) -> fu.Scene:
    """Return a scene with two flying cables through points; the contact is too soft to change their motion."""
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, points, velocity in zip("ab", curves, velocities, strict=True):
        up = np.eye(3)[np.argmin(np.abs(points[-1] - points[0]))]
        scene.cable(name, points=points.tolist(), elements=4, element="cable12", section=fu.Circle(radius=RADIUS),
                    up=tuple(up), material=MATERIAL, velocity=tuple(velocity))
    scene.crossing("a", "b", name="contact", stiffness=1e-9)
    return scene


def check(second, length, bows, at, azimuth, approach, log_speed, when, share, steps, integrator, off):
    """Check that lines which curve away from each other first touch where placed, at a part `when` of the duration.

    The tangents there are `second` rad apart. The lines approach by the part `approach` of the speed, and may be past
    the ends of each other at the end of the same step. off: distance of the drawn lines from their elements, m.
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
@pytest.mark.slow
def test_bent_cables_do_not_fly_through_each_other(**case):
    """They approach head on; test_crossing_grazes.py covers grazing."""
    check(off=3e-4, **case)


TURNING = {"axis": st.tuples(angle, st.floats(-0.8, 0.8)), "turn": st.tuples(angle, st.floats(-1, 1), st.floats(0, 1)),
           "way": st.tuples(angle, st.floats(-1, 1), st.floats(0.2, 1)), "at": st.tuples(part, part, part),
           "steps": st.sampled_from([10, 25, None]), "integrator": GIVEN["integrator"]}


@settings(max_examples=60, deadline=None, derandomize=True)
@given(**TURNING)
def test_no_touch_of_a_turning_bar_is_missed(axis, turn, way, at, steps, integrator):
    """A bar rotates by up to a radian as it passes; the distance of two straight lines gives the first contact."""
    radius, half, times = 0.01, 0.4, np.linspace(0, 1, 4001)
    start, move, spin, along = 0.2 * np.array(at), way[2] * direction(*way[:2]), direction(*turn[:2]), direction(*axis)
    apart, ends = _distances(start, move, along, spin, turn[2] * times, times, half)
    touching = (np.abs(apart) < radius) & ends
    assume(abs(apart[0]) > 1.5 * radius and ends[0])  # it begins within the ends of both lines, and apart
    first = np.argmax(touching) if touching.any() else None
    assume((np.sign(apart[:first]) == np.sign(apart[0])).all())  # and does not come round an end
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(-1, 0, 0), end=(1, 0, 0), elements=4, element="cable12",
                section=fu.Circle(radius=RADIUS), material=MATERIAL)
    scene.rigid_body("body", mass=1, inertia=(1, 1, 1), position=tuple(start), velocity=tuple(move),
                     angular_velocity=tuple(turn[2] * spin))
    scene.crossing("wire", "body", name="contact", axis=tuple(along), length=half, radius=radius, stiffness=1e-9)
    given = {"tol": 1e-3} if steps is None or integrator == "explicit" else {"step": 1 / steps}
    try:
        run = scene.run(1.0, output_step=1.0, integrator=integrator, progress=False, **given)
    except fu.ConvergenceError as error:  # where it comes round an end after it has touched
        run = error.run
    found = [event["time"] for event in run.report["events"] if event["what"] == "came into contact"]
    if touching.mean() > 0.02:
        assert found, "missed"
        assert found[0] == pytest.approx(times[first], abs=2e-3)
    elif not ((np.abs(apart) < 1.2 * radius) & ends).any():
        assert not found


def test_a_bar_that_comes_round_an_end_is_refused():
    """The bar is then under the wire, and contact would pull it to the side of its start."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(-1, 0, 0), end=(1, 0, 0), elements=4, element="cable12",
                section=fu.Circle(radius=RADIUS), material=MATERIAL)
    scene.rigid_body("body", mass=1, inertia=(1, 1, 1), position=(0, 0.1, 0), velocity=(1, 0, 0),
                     angular_velocity=tuple(direction(1.0, 0)))
    scene.crossing("wire", "body", axis=tuple(direction(0.25, 0.25)), length=0.4, radius=0.01, stiffness=1e-9)
    with pytest.raises(fu.ConvergenceError, match="moves around an end"):
        scene.run(1.0, tol=1e-4, progress=False)


def _distances(start, move, along, spin, angles, times, half) -> tuple[np.ndarray, np.ndarray]:
    """Return distances (times,) of a rotating bar's line from the x axis, m, signed, and whether the closest
    points are within the ends of both.

    start, move: of its middle, m and m/s. along: its initial direction. spin: the axis of its rotation by angles.
    """
    middle = start + times[:, None] * move
    c, s = np.cos(angles)[:, None], np.sin(angles)[:, None]
    axis = c * along + s * np.cross(spin, along) + (1 - c) * (spin @ along) * spin
    normal = np.cross([1.0, 0, 0], axis)
    assume(np.linalg.norm(normal, axis=1).min() > 0.2)  # the lines are not parallel
    apart = np.einsum("td,td->t", middle, normal) / np.linalg.norm(normal, axis=1)
    across = np.einsum("td,td->t", axis[:, 1:], axis[:, 1:])
    on_bar = -np.einsum("td,td->t", middle[:, 1:], axis[:, 1:]) / across
    on_wire = middle[:, 0] + on_bar * axis[:, 0]
    return apart, (np.abs(on_bar) < half) & (np.abs(on_wire) < 1)
