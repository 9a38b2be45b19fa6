"""Linear models about states of rest against closed forms, modes and motions; what they refuse."""

from __future__ import annotations

import funicular as fu
import numpy as np
import pytest
from linear_scenes import bead, cart_and_pendulum, crane, crane_reference, string, string_reference
from scipy.signal import StateSpace, lsim
from shared_scenes import cable_scene

PUSH = ["push.value.x"]


def step_error(make, path: str, outputs: list[str], **settings) -> np.ndarray:
    """Return the errors (outputs,) of the response to a step of 1e-6, over the largest response, against a run."""
    step, scene = 1e-6, make(0.0)
    rest = scene.equilibrium()
    linear = scene.linearise([path], outputs, rest)
    run = make(step).run(0.3, tol=1e-8, output_step=0.02, integrator="radau", initial=rest, progress=False, **settings)
    model = StateSpace(linear.A, linear.B, linear.C, linear.D)
    expected = lsim(model, np.full((len(run.time), 1), step), run.time)[1].reshape(len(run.time), -1)
    found = [run[name] if name in run else run[name[:-2]][:, "xyz".index(name[-1])] for name in outputs]
    moved = np.array(found).T - linear.output_values
    return np.abs(moved - expected).max(axis=0) / np.abs(expected).max(axis=0)


def test_a_cart_with_a_pendulum(validated):
    linear = cart_and_pendulum().linearise(PUSH, ["hinge.force.x", "hinge.angle", "rail.distance_rate"])
    assert linear.states == ["rail.distance", "hinge.angle", "rail.distance_rate", "hinge.angle_rate"]
    assert linear.state_units == ["m", "rad", "m/s", "rad/s"]
    assert (linear.input_units, linear.output_units) == (["N"], ["N", "rad", "m/s"])
    inertia, couple = 0.03 + 0.7 * 0.9**2, 0.7 * 0.9
    mass = np.array([[2.7, couple], [couple, inertia]])
    np.testing.assert_allclose(linear.mass, mass, rtol=1e-12)
    np.testing.assert_allclose(linear.stiffness, [[0, 0], [0, couple * 9.81]], rtol=1e-12, atol=1e-14)
    A21, B = linear.A[2:, 1], linear.B[2:, 0]
    force = np.array([linear.C[0, 1], linear.D[0, 0]])
    exact = np.concatenate([np.linalg.solve(mass, [0, -couple * 9.81]), np.linalg.solve(mass, [1, 0])])
    on_load = 0.7 * np.array([exact[0] + 0.9 * exact[1], exact[2] + 0.9 * exact[3]])
    np.testing.assert_allclose([3.2046, -13.734, 0.4913580247, -0.5185185185], exact, rtol=1e-9)
    validated("Linear models", "cart and pendulum", "A21, B, hinge force by angle and by push",
              np.concatenate([exact, on_load]), np.concatenate([A21, B, force]), bound=1e-10, source="closed form")
    poles = linear.poles
    assert np.all(poles[:2] == 0)
    np.testing.assert_allclose(poles[2:], [3.705941176j, -3.705941176j], rtol=1e-9)
    np.testing.assert_array_equal(linear.C[1:], [[0, 1, 0, 0], [0, 0, 1, 0]])


def test_an_upright_pendulum_has_real_poles():
    linear = cart_and_pendulum(upright=True).linearise()
    np.testing.assert_allclose(np.sort(linear.poles.real), [-np.sqrt(13.734), 0, 0, np.sqrt(13.734)], rtol=1e-10)
    assert not linear.poles.imag.any()


def test_a_crane(validated):
    linear = crane().linearise(PUSH, ["trolley.position.x"])
    roots, over = crane_reference(1.0)
    poles = linear.poles[np.argsort(linear.poles.imag)]
    expected = np.append(roots, 0.0)
    expected = expected[np.argsort(expected.imag)]
    expected[1:3] = np.sort(expected[1:3])
    poles[1:3] = np.sort(poles[1:3])
    response = linear.response(angular_frequency=1.0)[0, 0]
    validated("Linear models", "crane with a damper", "poles", np.abs(expected), np.abs(poles), unit="1/s", bound=1e-8,
              scale=1.0, source="roots of the characteristic polynomial")
    validated("Linear models", "crane with a damper", "x/u at 1 rad/s", abs(over), abs(response), unit="m/N",
              bound=1e-8, source="transfer function")
    assert abs(response - over) < 1e-8 * abs(over) and np.abs(poles - expected).max() < 1e-8
    np.testing.assert_allclose(linear.response([0.3, 1 / (2 * np.pi)])[1, 0, 0], response, rtol=1e-12)


def test_a_string_with_a_damper_at_its_end(validated):
    poles = string(20).linearise().poles
    above = poles[poles.imag > 0][np.argsort(poles[poles.imag > 0].imag)][:2]
    exact = string_reference()
    validated("Linear models", "string with a damper at its free end", "real and imaginary parts of two poles",
              [exact.real, exact.imag], [above.real, above.imag], unit="1/s", bound=1e-3, source="travelling waves",
              mesh="20 elements")


def test_a_bead_on_a_string(validated):
    poles = bead().linearise().poles
    across = np.unique(np.round(np.abs(poles.imag[poles.imag > 0]), 9))[0]
    validated("Linear models", "bead on a taut string", "angular frequency", np.sqrt(200.0), across, unit="rad/s",
              bound=1e-6, source="closed form")


def wire_with_rider(push: object, friction: object = None) -> fu.Scene:
    scene = cable_scene(pins="ends", elements=4, element="cable12", rest_length=0.9975, strain="engineering",
                        section=fu.Circle(radius=0.005), gravity=(0, -9.81, 0),
                        material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=2000, damping_time=1e-3))
    middle = 0.45
    scene.rigid_body("A", mass=1.0, inertia=(0.01, 0.01, 0.01), position=(middle, 0, 0))
    scene.slide("A", along="wire", name="trolley", friction=friction)
    scene.rigid_body("B", mass=1.5, inertia=(0.01, 0.01, 0.01), position=(middle, -0.5, 0))
    scene.joint("spherical", ("A", (0, 0, 0)), ("B", (0, 0.5, 0)), name="hinge")
    scene.force(on="B", value=(push, 0, 0), name="push")
    return scene


def test_a_small_step_moves_a_scene_as_its_model():
    """Positions, s, and forces of joints; also with the damper of regularised friction, which a message reports."""
    outputs = ["A.position.x", "B.position.x", "trolley.s", "hinge.force.x", "B.acceleration.x"]
    assert np.all(step_error(wire_with_rider, PUSH[0], outputs) < 1e-6)
    rough = fu.Friction(coefficient=0.2, velocity=0.1)
    assert np.all(step_error(lambda push: wire_with_rider(push, rough), PUSH[0], outputs[1:2]) < 1e-6)
    with_it = wire_with_rider(0.0, rough)
    assert "regularised friction" in with_it.linearise(about=with_it.equilibrium()).messages[0]


def test_friction_that_sticks_holds():
    scene = wire_with_rider(0.0, fu.Friction(coefficient=0.3, model="stick"))
    rest = scene.equilibrium()
    held = scene.linearise(about=rest)
    assert len(held.states) == len(wire_with_rider(0.0).linearise().states) - 2
    assert 'friction holds "trolley.s"' in held.messages[0]


def flow(change: float) -> fu.Scene:
    scene = wire_with_rider(0.0)
    scene.fluid("air", density=20.0, velocity=(1.0, 0.0, 3.0 + change))
    scene.drag("wire", fluid="air", normal=1.2, name="drag")
    return scene


def test_the_velocity_of_a_fluid_acts_on_results_directly():
    assert np.all(step_error(flow, "air.velocity.z", ["A.position.z", "drag.force.z"]) < 1e-6)


def test_a_drive_by_a_velocity_has_its_position_as_a_state():
    linear = cart_and_pendulum(velocity=0.0).linearise(["rail.velocity"], ["load.position.x", "load.velocity.x"])
    assert linear.states == ["hinge.angle", "hinge.angle_rate", "rail.position"]
    assert linear.state_units == ["rad", "rad/s", "m"] and linear.input_units == ["m/s"]
    inertia, couple = 0.03 + 0.7 * 0.81, 0.63
    np.testing.assert_allclose(linear.A, [[0, 1, 0], [-couple * 9.81 / inertia, 0, 0], [0, 0, 0]], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(linear.B[:, 0], [-couple / inertia, 0, 1], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(linear.C, [[0.9, 0, 1], [0, 0.9, 0]], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(linear.D[:, 0], [0, 1 - 0.9 * couple / inertia], rtol=1e-9, atol=1e-9)


def test_poles_are_those_of_modes():
    scene = fu.load_scene("tower_crane")
    rest = scene.equilibrium()
    linear, modes = scene.linearise(about=rest), scene.modes(6, about=rest)
    np.testing.assert_allclose(np.sqrt(np.diag(linear.stiffness)[:6]), modes.angular_frequency, rtol=1e-9)
    reduced = scene.linearise(["gravity.y"], [f"{next(iter(scene.bodies))}.position.y"], rest, reduce=8)
    full = scene.linearise(["gravity.y"], reduced.outputs, rest)
    assert len(reduced.states) == 16
    np.testing.assert_allclose(reduced.response(0.0), full.response(0.0), rtol=1e-6)


def test_unsymmetric_and_unstable_as_they_are():
    """Beck's column below and above the load of flutter, 20.05 EI / L²."""
    for factor, flutters in ((10.0, False), (25.0, True)):
        scene = fu.Scene(gravity=(0, 0, 0))
        wire = scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=4, element="beam12p", up=(0, 1, 0),
                           section=fu.Rectangle(height=0.01, width=0.01),
                           material=fu.Material(youngs_modulus=1e9, poisson_ratio=0, density=1000))
        scene.clamp(wire, s=0.0)
        scene.force(on="wire", s=1.0, value=(-factor * 1e9 * 0.01**4 / 12, 0, 0), follower=True, name="P")
        rest = scene.equilibrium(seek_stable=False)
        linear, modes = scene.linearise(about=rest), scene.modes(2, about=rest)
        assert (linear.poles.real.max() > 1) == flutters
        lowest = linear.poles[np.argsort(np.abs(linear.poles))[:4]]
        np.testing.assert_allclose(lowest.real.max(), modes.growth_rate.max(), rtol=1e-6, atol=1e-6)


def taut(length: float) -> fu.Scene:
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(1, 0, 0))
    scene.joint("prismatic", (0, 0, 0), "A", axis=(1, 0, 0), name="rail")
    scene.spring((0, 0, 0), "A", stiffness=100, length=length, tension_only=True, name="rope")
    return scene


@pytest.mark.parametrize(("given", "message"), [
    ({"inputs": ["load.mass"]}, "mass of a rigid_body is no input"),
    ({"inputs": ["run.tol"]}, "is a setting"),
    ({"inputs": ["psh.value.x"]}, 'did you mean "push"'),
    ({"inputs": ["push.value"]}, "name a component"),
    ({"inputs": ["rail.velocity"]}, "has no value; give it a value"),
    ({"inputs": "push.value.x"}, "must be a list of names"),
    ({"outputs": ["cart.postion.x"]}, 'did you mean "cart.position"'),
    ({"outputs": ["cart.position.7"]}, "without"),
    ({"reduce": 9}, "2 degrees of freedom"),
    ({"reduce": 0}, "reduce"),
    ({"about": 3}, "must be one that equilibrium() returned"),
])
def test_bad_input_is_refused(given, message):
    with pytest.raises(fu.FunicularError) as error:
        cart_and_pendulum().linearise(**given)
    assert message in str(error.value)


def test_outputs_by_the_mesh_are_named_one_by_one():
    scene = string(2)
    assert scene.linearise(outputs=["wire.position.1.y"]).outputs == ["wire.position.1.y"]
    with pytest.raises(fu.UnknownResultError, match="3 x 3 numbers"):
        scene.linearise(outputs=["wire.position"])


def test_states_that_are_not_at_rest_and_kinks_are_refused():
    with pytest.raises(fu.SceneError, match='kink at this state, largest on point force "rope"'):
        taut(1.0).linearise()
    assert not taut(1.1).linearise().poles.any()
    with pytest.raises(fu.SceneError, match='not at rest: residual forces are up to 2 N, largest on body "B"'):
        wire_with_rider(2.0).linearise(about=wire_with_rider(0.0).equilibrium())
    with pytest.raises(fu.SceneError, match="depends on the rate of input"):
        cart_and_pendulum(velocity=0.0).linearise(["rail.velocity"], ["load.acceleration.x"])


def test_the_state_space_is_that_of_scipy():
    linear = cart_and_pendulum().linearise(PUSH, ["hinge.force"])
    space = linear.state_space()
    np.testing.assert_array_equal(space.A, linear.A)
    assert np.shape(space.D) == (3, 1)
    assert repr(linear) == "<funicular.LinearModel: 4 states, 1 inputs, 3 outputs>"
