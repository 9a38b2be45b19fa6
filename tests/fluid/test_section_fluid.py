"""Section forces by balance in fluids with added mass, and beside contacts without force results."""

from math import pi, sqrt

import funicular as fu
import numpy as np
import pytest
from funicular.results.section_forces.balance_limits import known_method
from numpy.testing import assert_allclose

WATER, RADIUS, STEEL, G = 1000.0, 0.01, 7800.0, 9.81
AREA = pi * RADIUS**2


def wire(scene, name="wire", start=(0, 0, 0), end=(2, 0, 0), elements=8, element="cable12", youngs_modulus=1e7,
         damping_time=0.0, **more):
    return scene.cable(name, start=start, end=end, elements=elements, element=element,
                       section=fu.Circle(radius=RADIUS),
                       material=fu.Material(youngs_modulus=youngs_modulus, poisson_ratio=0.0, density=STEEL,
                                            damping_time=damping_time), **more)


@pytest.mark.parametrize("element", ["cable12", "cable8p"])
def test_a_string_that_vibrates_in_water(element):
    """The transverse force is N y' of y = A sin(pi x/L) cos(omega t), with added mass in omega."""
    scene = fu.Scene(gravity=(0, 0, 0))
    string = wire(scene, element=element, elements=16, youngs_modulus=1e5, rest_length=2 / 1.5)
    scene.pin(string, s=0.0)
    scene.pin(string, s=string.length)
    scene.fluid(density=WATER)
    scene.drag(string, added_mass=1.3)
    state = scene.equilibrium()
    tension = float(state.section_forces(string, [0.5]).tension[0])
    omega = pi / 2 * sqrt(tension / (AREA * (STEEL / 1.5 + 1.3 * WATER / 1.5)))
    x, A = state["wire.nodal_vectors"][:, 0, 0], 1e-5
    start = state["wire.nodal_vectors"].copy()
    start[:, 0, 1] += A * np.sin(pi * x / 2)
    start[:, 1, 1] += 1.5 * A * pi / 2 * np.cos(pi * x / 2)
    run = scene.run(2 * pi / omega, initial={"wire.nodal_vectors": start}, tol=1e-6, output_step=pi / omega / 4)
    s = np.linspace(0.05, 0.95, 10) * string.length
    across = run.section_forces(string, s)["force"].values[..., 1]
    exact = tension * A * pi / 2 * np.cos(pi * 1.5 * s / 2) * np.cos(omega * run.time)[:, None]
    assert np.abs(across - exact).max() < 0.01 * np.abs(exact).max()


def test_a_rope_with_a_weight_that_falls_along_itself():
    """Rope, weight and added mass fall with one acceleration: N grows linearly from the top."""
    scene = fu.Scene(gravity=(0, -G, 0))
    rope = wire(scene, end=(0, -2, 0), damping_time=0.02)
    scene.rigid_body("weight", mass=5, inertia=(0.01,) * 3, position=(0, -2, 0))
    scene.joint("spherical", (rope, 2.0), "weight")
    scene.fluid(density=WATER)
    scene.drag(rope, added_mass=1.0, added_mass_tangential=0.5)
    run = scene.run(1.0, tol=1e-6, output_step=0.5)
    mass, weight = AREA * (STEEL + 0.5 * WATER), AREA * (STEEL - WATER) * G
    a = (2 * weight + 5 * G) / (2 * mass + 5)
    s = np.linspace(0.1, 1.9, 7)
    exact = s * (mass * a - weight)
    assert exact[-1] > 3
    assert_allclose(run.section_forces(rope, s).tension.values[-1], exact, atol=2e-3 * exact[-1])


def towed():
    """Return a rope that hangs obliquely in a cross stream."""
    scene = fu.Scene(gravity=(0, -G, 0))
    rope = wire(scene, end=(2, -1, 0), elements=24, youngs_modulus=1e6)
    scene.pin(rope, s=0.0)
    scene.pin(rope, s=rope.length)
    scene.fluid(density=WATER, velocity=(2.0, 0.0, 0.0))
    scene.drag(rope, normal=1.0, added_mass=4.0)
    return scene


def on_slope(state, end):
    """Return the derivative of the fluid's kinetic energy by the slope at an end of the rope: -m w_t (w - w_t i)/|r_x|.
    """
    slope = state["wire.nodal_vectors"][end, 1]
    size = np.linalg.norm(slope)
    i, w = slope / size, -np.array([2.0, 0.0, 0.0])
    return -4.0 * WATER * AREA * (w @ i) / size * (w - (w @ i) * i)


def test_at_rest_in_a_stream_the_force_is_that_of_the_law():
    """The rotating part of the fluid's momentum acts in the cable and not in the supports."""
    state = towed().equilibrium()
    s = np.linspace(0.2, 1.4, 7)
    balance, law = (state.section_forces("wire", s, method=method) for method in ("balance", "constitutive"))
    assert_allclose(balance.tension.values, law.tension.values, rtol=1e-4)
    assert_allclose(balance["force"].values, law["force"].values, atol=0.05)  # shear of the law is that of a mesh
    labels = [support.label for support in state.scene.supports]
    for end, sign, label in ((0, -1, labels[0]), (-1, 1, labels[1])):
        at_end = state.section_forces("wire", [0.0 if end == 0 else state.scene.cables["wire"].length])
        extra = on_slope(state, end)
        assert np.linalg.norm(extra) > 0.5
        assert_allclose(at_end["force"].values[0] - sign * state[f"{label}.force"], extra, atol=1e-3)


def two_ropes(tied=False):
    """Return one rope with friction on the ground, and one above it."""
    scene = fu.Scene(gravity=(0, -G, 0))
    wire(scene, start=(0, 0.0101, 0), end=(2, 0.0101, 0), elements=4)
    upper = wire(scene, "upper", start=(2, 0.0101, 0) if tied else (0, 1, 0), end=(4, 1, 0), elements=4)
    scene.pin(upper, s=upper.length)
    scene.surface("ground", fu.Plane())
    scene.contact("wire", "ground", stiffness=1e5, friction=0.3)
    if tied:
        scene.tie("wire", s=2.0, to=upper, at=0.0, rotation="free")
    else:
        scene.pin(upper, s=0.0)
    return scene


def test_a_contact_with_friction_keeps_its_own_cable_alone_from_the_balance():
    run = two_ropes().run(0.02, output_step=0.01, tol=1e-3)
    assert np.isfinite(run.section_forces("upper")["force"].values).all()
    with pytest.raises(fu.SceneError, match='"contact_1": has friction, which results do not record along "wire"'):
        run.section_forces("wire")
    methods = {name: known_method(run.scene, run.model, name, False) for name in run.scene.cables}
    assert methods == {"wire": "constitutive", "upper": "balance"}
    assert run.plot("forces-upper") is not None and run.plot("forces-wire") is not None
    notes = run.animation("ropes").notes
    assert [note for note in notes if "elastic law" in note] == [
        'tension of "wire" is that of the elastic law, not in balance with the loads: contact "contact_1" has '
        'friction, which results do not record along "wire"']


def test_a_cable_tied_to_one_with_friction_is_refused_as_well():
    run = two_ropes(tied=True).run(0.01, output_step=0.01, tol=1e-3)
    with pytest.raises(fu.SceneError, match="has friction, which results do not record along"):
        run.section_forces("upper")
