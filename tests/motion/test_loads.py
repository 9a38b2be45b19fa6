"""Loads, springs, damping and prescribed motions in runs, against closed forms; their energy balance."""

import numpy as np
import pytest
from expectations import energy_error, largest
from funicular import Harmonic, Material, Ramp, Rectangle, Scene
from funicular import TableSignal as TimeTable
from scipy.special import fresnel
from shared_scenes import SQUARE, TABLE_1, add_cable, add_rider


def ball(scene: Scene, position=(0, 0, 0), mass=2.0, **given):
    return scene.rigid_body("ball", mass=mass, inertia=(0.01, 0.02, 0.03), position=position, **given)


def test_spring_and_damper_on_a_body():
    """x'' + 2 d x' + w0² x = 0 from a stretched spring, with its tension and length."""
    m, k, c, rest = 2.0, 300.0, 4.0, 0.5
    scene = Scene(gravity=(0, 0, 0))
    ball(scene, (0.7, 0, 0), m)
    scene.spring((0, 0, 0), "ball", stiffness=k, damping=c, length=rest, name="tie")
    run = scene.run(1.0, tol=1e-7, output_step=0.01)
    d, w0 = c / (2 * m), np.sqrt(k / m)
    w, t = np.sqrt(w0**2 - d**2), run.time
    x = 0.2 * np.exp(-d * t) * (np.cos(w * t) + d / w * np.sin(w * t))
    np.testing.assert_allclose(run["ball.position"][:, 0], rest + x, atol=1e-6)
    np.testing.assert_allclose(run["tie.length"], rest + x, atol=1e-6)
    np.testing.assert_allclose(run["tie.force"][:, 0], run["tie.tension"], atol=1e-9)
    np.testing.assert_allclose(-run["tie.force"], m * run["ball.acceleration"], atol=1e-8 * k)
    assert run["energy.dissipated"][-1] > 0.5 * (0.5 * k * 0.2**2)
    assert energy_error(run) < 1e-5


def test_a_planar_spring_off_the_centre_of_mass():
    """Planar bodies give the numbers of the spatial scene."""
    def end(element):
        scene = Scene()
        scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=2, element=element, section=SQUARE,
                    material=TABLE_1)
        scene.pin("wire", s=0.0)
        ball(scene, (1.0, -0.5, 0), angular_velocity=(0, 0, 2.0))
        scene.spring(("wire", 0.8), ("ball", (0.1, 0.05, 0)), stiffness=500.0, damping=1.0, name="tie")
        run = scene.run(0.1, step=5e-4)
        return [run[name][-1] for name in ("ball.position", "ball.orientation", "tie.force", "tie.length")]

    for planar, spatial in zip(end("cable8p"), end("cable12"), strict=True):
        np.testing.assert_allclose(planar, spatial, atol=1e-9)


def test_mass_damping_slows_what_is_free():
    """v = v0 exp(-a t) of a cable in translation."""
    scene = Scene(gravity=(0, 0, 0))
    rubber = Material(youngs_modulus=1e6, poisson_ratio=0, density=1000, mass_damping=1.5)
    scene.cable("rope", start=(0, 0, 0), end=(1, 0, 0), elements=2, element="cable12", section=SQUARE, material=rubber)
    scene.distributed_force("rope", value=(0, 0, 1000 * SQUARE.area * 3.0),
                            scale=Ramp(start=0, end=0.1, before=1, after=0))
    run = scene.run(1.0, tol=1e-7, output_step=0.05)
    v = run["rope.nodal_velocity"][:, :, 0, 2]
    late = run.time > 0.1
    np.testing.assert_allclose(v[late] / v[late][0], np.exp(-1.5 * (run.time[late] - run.time[late][0]))[:, None]
                               * np.ones(v.shape[1]), rtol=1e-5)
    assert energy_error(run) < 1e-5


def test_gravity_as_a_distributed_force():
    """A fixed weight per length equals gravity."""
    def end(scene, force):
        add_cable(scene, elements=4)
        if force:
            scene.distributed_force("wire", value=(0, -9.81 * 4200 * SQUARE.area, 0))
        return scene.run(0.05, step=1e-4)

    heavy, loaded = end(Scene(), False), end(Scene(gravity=(0, 0, 0)), True)
    assert largest(heavy["wire.nodal_vectors"] - loaded["wire.nodal_vectors"]) < 1e-12
    np.testing.assert_allclose(loaded["energy.external"], -(heavy["energy.potential"] - heavy["energy.potential"][0]),
                               atol=1e-8)


def test_a_force_on_a_body_with_a_time_table():
    """m x'' = F(t), a cubic spline through samples of a sine: its double integral."""
    scene = Scene(gravity=(0, 0, 0))
    ball(scene)
    t = np.linspace(0, 1, 41)
    scene.force("ball", value=(5.0, 0, 0), scale=TimeTable(time=t, value=np.sin(2 * np.pi * t)))
    run = scene.run(1.0, tol=1e-7, output_step=0.1)
    w = 2 * np.pi
    expected = 2.5 * (run.time / w - np.sin(w * run.time) / w**2)
    np.testing.assert_allclose(run["ball.position"][:, 0], expected, atol=1e-6)
    assert energy_error(run) < 1e-6


def test_a_moment_spins_a_body_and_a_follower_force_turns_with_it():
    """About a principal axis: w = M t / J; the thrust rotates with the body, and its impulse is Fresnel's integral."""
    scene = Scene(gravity=(0, 0, 0))
    ball(scene)
    scene.moment("ball", value=(0, 0, 0.06))
    scene.force("ball", value=(4.0, 0, 0), follower=True)
    run = scene.run(2.0, tol=1e-7, output_step=0.1)
    t = run.time
    np.testing.assert_allclose(run["ball.angular_velocity"][:, 2], 2 * t, atol=1e-6)
    S, C = fresnel(t * np.sqrt(2 / np.pi))  # of cos(t²), sin(t²)
    np.testing.assert_allclose(run["ball.velocity"][:, :2], np.sqrt(2 * np.pi) * np.stack([C, S], axis=1), atol=1e-5)
    assert energy_error(run) < 1e-5


def test_a_follower_force_at_the_end_of_a_cable_has_no_potential():
    """Its work round a loop is not zero; the energy balances nevertheless."""
    scene = Scene()
    add_cable(scene, pins=(0,), elements=4)
    scene.force("wire", s=1.5, value=(0, 60, 0), follower=True)
    run = scene.run(0.5, tol=1e-5)
    assert np.ptp(run["energy.external"]) > 10
    assert energy_error(run) < 1e-4


@pytest.mark.parametrize("element", ["cable12", "beam24", "cable8p", "beam12p"])
def test_the_energy_balances_with_everything_on(element):
    scene = Scene()
    planar = element in ("cable8p", "beam12p")
    scene.cable("wire", start=(0, 0, 0), end=(1.5, 0, 0), elements=3, element=element, section=SQUARE,
                material=Material(youngs_modulus=2e7, poisson_ratio=0.0, density=4200, damping_time=1e-3,
                                  mass_damping=0.3))
    wave = Harmonic(amplitude=0.1, frequency=1.0, phase=np.pi / 2, offset=-0.1)  # from rest
    scene.motion("wire", s=0.0, displacement=(0, wave, 0))
    scene.pin("wire", s=1.5)
    add_rider(scene, s=0.4, speed=1.0)
    scene.force("wire", s=1.0, value=(20, 0, 0) if element == "cable12" else (0, 20, 0 if planar else 10),
                follower=True, scale=Ramp(start=0, end=0.3))
    scene.moment("wire", s=0.75, value=(0, 0, 2.0))
    scene.spring(("wire", 1.25), (1.25, 0.5, 0), stiffness=300, damping=3)
    run = scene.run(0.5, tol=1e-5)
    assert energy_error(run) < 2e-4
    assert run["trolley.residual"].max() < 1e-9
    assert abs(run["energy.external"][-1]) > 0.1


def test_a_node_moves_as_prescribed():
    """The node follows the signal, and its work closes the energy balance."""
    scene = Scene()
    add_cable(scene, pins=(1.5,), elements=4)
    wave = Harmonic(amplitude=0.05, frequency=3.0)
    scene.motion("wire", s=0.0, displacement=(0, wave, 0), rotation=((0, 0, 1), Ramp(start=0, end=0.2, after=0.3)))
    run = scene.run(0.3, tol=1e-5, output_step=0.01)
    at = run["wire.nodal_vectors"][:, 0]
    np.testing.assert_allclose(at[:, 0, 1], wave.value(run.time), atol=1e-12)
    angle = Ramp(start=0, end=0.2, after=0.3).value(run.time)
    np.testing.assert_allclose(at[:, 2], np.stack([-np.sin(angle), np.cos(angle), 0 * angle], axis=1), atol=1e-12)
    assert energy_error(run) < 1e-3


def test_a_prescribed_motion_is_that_of_the_frame():
    """A rope whose pins accelerate together equals one at rest under the opposite gravity."""
    def scene(gravity):
        made = Scene(gravity=gravity)
        made.cable("rope", start=(0, 0, 0), end=(1, 0, 0), elements=4, element="cable12", section=SQUARE,
                   material=Material(youngs_modulus=2e6, poisson_ratio=0, density=1000))
        return made

    moved, still = scene((0, 0, 0)), scene((0, -8.0, 0))
    t = np.linspace(0, 0.4, 5)
    for s in (0.0, 1.0):
        moved.motion("rope", s=s, displacement=(0, TimeTable(time=t, value=4 * t**2), 0))
        still.pin("rope", s=s)
    velocity = np.zeros((5, 2, 3))
    velocity[:, 0, 1] = -8.0
    run, expected = moved.run(0.4, step=2e-4), still.run(0.4, step=2e-4)
    lift = 4 * run.time**2
    difference = run["rope.nodal_vectors"][:, :, 0, 1] - lift[:, None] - expected["rope.nodal_vectors"][:, :, 0, 1]
    assert largest(difference) < 1e-6


def corner(rotation) -> dict[str, np.ndarray]:
    """Return nodal vectors (time, vector, 3) at the corner of a swinging right angle."""
    scene = Scene()
    square = {"section": Rectangle(height=0.05, width=0.05), "elements": 3,
              "material": Material(youngs_modulus=2e7, poisson_ratio=0, density=4200)}
    scene.cable("leg", start=(0, 0, 0), end=(0, -1, 0), up=(1, 0, 0), **square)
    scene.cable("arm", start=(0, -1, 0), end=(1, -1, 0), **square)
    scene.clamp("leg", s=0.0)
    scene.tie("leg", s=1.0, to="arm", at=0.0, rotation=rotation, name="corner")
    run = scene.run(0.3, tol=1e-4)
    assert energy_error(run) < 1e-3
    found = {name: run[f"{name}.nodal_vectors"][:, node] for name, node in (("leg", -1), ("arm", 0))}
    assert largest(found["leg"][:, 0] - found["arm"][:, 0]) < 1e-12
    return found


def test_a_rigid_corner_shares_the_gradient_and_a_hinge_does_not():
    """leg: r_x, r_y along -y, x; arm: along x, y."""
    tied, free = corner("rigid"), corner("free")
    for arm, sign, leg in ((1, 1, 2), (2, -1, 1), (3, 1, 3)):
        assert largest(tied["arm"][:, arm] - sign * tied["leg"][:, leg]) < 1e-12
    assert largest(free["arm"][:, 1] - free["leg"][:, 2]) > 0.1
