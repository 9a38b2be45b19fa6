"""Modal bodies: free flight, vibration, comparison with absolute nodal coordinates, points with axes."""

import numpy as np
import pytest
from expectations import energy_error
from funicular import Material, Rectangle, Scene
from funicular.base.rotations import rotate
from funicular.engine import Engine
from funicular.integrators import Radau
from funicular.model.build import build

RUBBER = Material(youngs_modulus=2e6, poisson_ratio=0.0, density=1100)
BAR = Rectangle(height=0.03, width=0.02)


def points(folder, seed: int = 3) -> dict:
    """Write a file of a few mass points with modes orthogonal neither to each other nor to rigid motions."""
    random = np.random.default_rng(seed)
    root = random.normal(size=(3, 3))
    arrays = {"nodes": random.normal(size=(7, 3)), "modes": random.normal(size=(3, 7, 3)) / 2,
              "masses": random.uniform(0.5, 1.5, 7), "stiffness": 400 * (root @ root.T + np.eye(3)),
              "rotations": random.normal(size=(3, 7, 3)) / 2}
    np.savez(folder / "points.npz", **arrays)
    return arrays


def tumbling(folder, gravity=(0, 0, 0), **more) -> Scene:
    scene = Scene(gravity=gravity)
    scene.modal_body("body", data=folder / "points.npz", orthogonal=False, position=(1, 2, 3),
                     velocity=(0.4, -0.3, 0.2), orientation=(0.5, 0.5, 0.5, 0.5), angular_velocity=(2, -3, 4), **more)
    return scene


def test_a_run_says_which_modes_a_body_has():
    scene = Scene()
    scene.modal_body("bar", start=(0, 0, 0), end=(0.5, 0, 0), section=BAR, material=RUBBER, modes=3)
    scene.modal_body("arm", start=(0, 1, 0), end=(0.5, 1, 0), section=BAR, material=RUBBER, boundary="attached")
    run = scene.run(duration=0.01)
    assert "3 modes, free-free on 10 elements beam24" in run.report["modes"]["bar"]
    assert "5 modes, of the beam attached at its start" in run.report["modes"]["arm"]
    assert "modes of bar: 3 modes" in run.summary()


def momenta(run, arrays) -> tuple[np.ndarray, np.ndarray]:
    """Return linear and angular momentum (time, 3), summed over the mass points."""
    turn, omega = run["body.orientation"][:, None], run["body.angular_velocity"][:, None]
    u = arrays["nodes"] + np.einsum("tk,kni->tni", run["body.modal_coordinates"], arrays["modes"])
    rate = np.einsum("tk,kni->tni", run["body.modal_velocities"], arrays["modes"])
    p = arrays["masses"][:, None] * (run["body.velocity"][:, None] + rotate(turn, np.cross(omega, u) + rate))
    return p.sum(axis=1), np.cross(run["body.nodes"], p).sum(axis=1)


# measured: radau 2e-8
@pytest.mark.parametrize(("integrator", "settings", "off"), [
    ("radau", {"tol": 1e-9}, 1e-7), ("explicit", {"tol": 1e-10}, 1e-11),
    ("genalpha", {"step": 1e-4, "spectral_radius": 1.0}, 1e-4)])
def test_a_tumbling_body_keeps_its_momenta_and_energy(tmp_path, integrator, settings, off):
    arrays = points(tmp_path)
    run = tumbling(tmp_path).run(duration=1.0, output_step=0.05, integrator=integrator, **settings)
    assert np.ptp(run["body.modal_coordinates"], axis=0).min() > 0.01, "it does deform"
    for momentum in momenta(run, arrays):
        assert np.abs(momentum - momentum[0]).max() < off * np.abs(momentum).max()
    assert np.abs(run.energy_balance().residual).max() < off * run["energy.kinetic"][0]


def test_in_gravity_its_mass_centre_falls_and_damping_is_booked(tmp_path):
    arrays = points(tmp_path)
    run = tumbling(tmp_path, gravity=(0, -9.81, 0), damping_ratio=0.05).run(duration=0.5, output_step=0.05, tol=1e-8,
                                                                            integrator="radau")
    centre = np.einsum("n,tni->ti", arrays["masses"], run["body.nodes"]) / arrays["masses"].sum()
    momentum, _ = momenta(run, arrays)
    straight = centre[0] + np.outer(run.time, momentum[0]) / arrays["masses"].sum()
    straight[:, 1] -= 9.81 * run.time**2 / 2
    np.testing.assert_allclose(centre, straight, atol=1e-7)
    assert run["energy.dissipated"][-1] > 0.1
    assert energy_error(run) < 1e-7


def beam(scene: Scene, **more):
    return scene.modal_body("bar", **({"start": (0, 0, 0), "end": (0, 0.5, 0), "up": (0, 0, 1), "section": BAR,
                                       "material": RUBBER} | more))


@pytest.mark.parametrize("element", ["beam24", "cable12"])
def test_its_small_vibrations_are_those_of_the_mesh(element):
    square = Rectangle(height=0.02, width=0.02)
    mesh, body = Scene(gravity=(0, 0, 0)), Scene(gravity=(0, 0, 0))
    mesh.cable("bar", start=(0, 0, 0), end=(0, 0.5, 0), up=(0, 0, 1), elements=10, element=element, section=square,
               material=RUBBER)
    made = beam(body, element=element, section=square)
    still = 6 if element == "beam24" else 5
    expected = mesh.modes(5 + still).angular_frequency[still:]
    found = body.modes(11)
    np.testing.assert_allclose(found.angular_frequency[6:], expected, rtol=1e-8)
    moved, by_mesh = found["bar.nodes"], mesh.modes(5 + still)["bar.displacement"]
    np.testing.assert_allclose(np.abs(moved[6:]).max(axis=(1, 2)), 1.0)
    lowest = [np.linalg.norm(shape, axis=1) for shape in (moved[6], by_mesh[still])]  # in any plane through the axis
    np.testing.assert_allclose(lowest[0] / lowest[0][0], lowest[1] / lowest[1][0], rtol=1e-6)
    np.testing.assert_allclose(np.sqrt(made.shape.vibrations[0]), expected, rtol=1e-8)
    assert made.shape.mass == pytest.approx(1100 * 0.02**2 * 0.5)
    assert np.abs(made.shape.S).max() < 1e-9, "free-free modes about the mass centre"
    J = made.inertia
    assert J[0, 0] == pytest.approx(made.mass * 2 * 0.02**2 / 12)
    assert J[2, 2] == pytest.approx(made.mass * (0.5**2 + 0.02**2) / 12)


def test_attachment_modes_are_those_of_the_cantilever():
    mesh = Scene(gravity=(0, 0, 0))
    mesh.cable("bar", start=(0, 0, 0), end=(0.5, 0, 0), elements=10, section=BAR, material=RUBBER)
    mesh.clamp("bar", s=0.0)
    shape = beam(Scene(), boundary="attached").shape
    np.testing.assert_allclose(np.sqrt(shape.vibrations[0]), mesh.modes(5).angular_frequency, rtol=1e-8)
    assert np.abs(shape.modes[:, 0]).max() == 0, "the frame is at the start"
    tip = shape.modes[0, -1]
    slope = np.cross(shape.rotations[0, -1], (1, 0, 0))
    assert np.argmax(np.abs(tip)) == np.argmax(np.abs(slope)) and tip @ slope > 0


def test_bodies_of_one_description_share_their_modes():
    """Each entry that the modes depend on makes them anew; nothing can change those that are shared."""
    shape = beam(Scene()).shape
    assert beam(Scene()).shape is shape
    assert beam(Scene(), start=(1, 0, 0), end=(1, 0.5, 0)).shape is shape, "in the axes of the body"
    for changes in ({"elements": 9}, {"modes": 4}, {"boundary": "attached"}, {"end": (0, 0.6, 0)},
                    {"section": Rectangle(height=0.02, width=0.03)},
                    {"material": Material(youngs_modulus=3e6, poisson_ratio=0.0, density=1100)}):
        other = beam(Scene(), **changes).shape
        assert other is not shape
        assert not np.array_equal(other.vibrations[0], shape.vibrations[0])
    with pytest.raises(ValueError, match="read-only"):
        shape.modes[0] = 0.0


@pytest.mark.parametrize("boundary", ["free", "attached"])
def test_stiffened_it_flies_like_the_mesh_in_absolute_coordinates(boundary):
    """A bar is thrown with a spin that stretches it, at increasing stiffness: the motions differ by the square of the
    strain.
    """
    spin, duration, distance = np.array([0, 3.0, 40.0]), 0.05, []
    for stiffer in (10, 1000):  # softer, without the stiffness that tension gives, the cantilever's modes run away
        material = Material(youngs_modulus=2e7 * stiffer, poisson_ratio=0.0, density=1100)
        modal, nodal = Scene(gravity=(0, 0, 0)), Scene(gravity=(0, 0, 0))
        for scene, draw in ((modal, modal.modal_body), (nodal, nodal.cable)):
            more = {"modes": 12, "boundary": boundary, "angular_velocity": tuple(spin)} if scene is modal else {}
            draw("bar", start=(0, 0, 0), end=(0.5, 0, 0), section=BAR, material=material, elements=3, **more)
        if boundary == "free":  # its origin is in the middle: with the start at rest
            moving = {"velocity": tuple(np.cross(spin, (0.25, 0, 0)))}
            modal.put(modal.bodies["bar"].model_copy(update=moving))
        run = modal.run(duration=duration, output_step=duration, tol=1e-7, integrator="radau")
        model = build(nodal)
        model.v[:] = np.cross(spin, model.q.reshape(-1, 3)).ravel()
        engine = Engine(model)
        engine.start(duration=duration, output_step=duration, tol=1e-7, step=0.0, method=Radau(), first_step=1e-4)
        assert engine.advance(lambda _: None) == "completed"
        places = engine.rows()["q"][-1][model.cables[0].coordinates].reshape(model.cables[0].shape)[:, 0]
        distance.append(np.abs(run["bar.nodes"][-1] - places).max())
    # measured: free 1.8e-6, 5e-8 m (of tol), attached 2.1e-5, 2.1e-7 m
    assert distance[1] < distance[0] / 20 and distance[1] < 1e-6, distance


def test_attachments_are_derivatives_of_points_and_axes(tmp_path):
    """The functions of modal.c: position, axes, P, T, velocities, biases, K against differences."""
    arrays = points(tmp_path)
    model = build(tumbling(tmp_path))
    engine = Engine(model)
    node = 2
    place = arrays["nodes"][node], arrays["modes"][:, node], arrays["rotations"][:, node]
    random = np.random.default_rng(1)
    b, w = model.q.copy(), random.normal(size=9)
    b[7:] = 0.3 * random.normal(size=3)
    f, m, h = random.normal(size=3), random.normal(size=3), 1e-5

    def at(motion, rates=w):
        q = b.copy()
        half = motion[3:6] / 2
        turn = np.append(np.sqrt(1 - half @ half), half)
        q[:3] += motion[:3]
        q[3:7] = _product(b[3:7], turn)
        q[7:] += motion[6:]
        return engine.modal_attachment(0, *place, q, rates, f, m)

    here = at(np.zeros(9))
    for k, unit in enumerate(np.eye(9)):
        after, before = at(h * unit), at(-h * unit)
        np.testing.assert_allclose((after["p"] - before["p"]) / (2 * h), here["P"][:, k], atol=1e-8)
        turned = np.cross(here["T"][:, k], here["axes"], axisb=0, axisc=0)
        np.testing.assert_allclose((after["axes"] - before["axes"]) / (2 * h), turned, atol=1e-8)
        pulled = [out["P"].T @ f + out["T"].T @ m for out in (after, before)]
        np.testing.assert_allclose((pulled[0] - pulled[1]) / (2 * h), here["K"][:, k], atol=1e-7)
        for name, value in (("v_q", "velocity"), ("omega_q", "omega")):
            np.testing.assert_allclose((after[value] - before[value]) / (2 * h), here[name][:, k], atol=1e-7)
    np.testing.assert_allclose(here["velocity"], here["P"] @ w, atol=1e-13)
    np.testing.assert_allclose(here["omega"], here["T"] @ w, atol=1e-13)
    for name, value in (("bias", "velocity"), ("omega_bias", "omega")):
        np.testing.assert_allclose((at(h * w)[value] - at(-h * w)[value]) / (2 * h), here[name], atol=1e-7)
    np.testing.assert_allclose(here["axes"].T @ here["axes"], np.eye(3), atol=1e-14)


def _product(p, q):
    return np.concatenate([[p[0] * q[0] - p[1:] @ q[1:]], p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:])])
