"""The explicit method, Radau's, and the choice between them."""

import funicular as fu
import numpy as np
import pytest
from expectations import energy_error
from funicular.engine import Engine
from funicular.integrators import INTEGRATORS, GeneralisedAlpha, Radau
from funicular.model.build import build
from funicular.parts.settings import RunSettings
from funicular.solve.motion.linear_model import take_linear_model
from shared_scenes import cable_scene


def soft(elements: int = 4, youngs_modulus: float = 2e6, damping_time: float = 0.0) -> fu.Scene:
    """Return a pendulum of cable12, fixed at one end."""
    return cable_scene("rope", pins=(0.0,), elements=elements, element="cable12",
                       section=fu.Rectangle(height=0.02, width=0.02),
                       material=fu.Material(youngs_modulus=youngs_modulus, poisson_ratio=0.0, density=1000,
                                            damping_time=damping_time))


def rider(planar: bool = False) -> fu.Scene:
    """Return a body that rotates and slides over nodes, loads, a damper, a moving support: all terms of the energy
    balance.
    """
    scene = fu.Scene()
    scene.cable("rope", start=(0, 0, 0), end=(10, 0, 0), elements=6, element="cable8p" if planar else "cable12",
                section=fu.Rectangle(height=0.05, width=0.05),
                material=fu.Material(youngs_modulus=2e6, poisson_ratio=0.0, density=1000, damping_time=1e-3,
                                     mass_damping=0.2))
    scene.pin("rope", s=0.0)
    scene.motion("rope", s=10.0, displacement=(0.0, fu.Harmonic(amplitude=0.1, frequency=1.5), 0.0))
    out = 0.0 if planar else -0.1
    scene.rigid_body("A", mass=5.0, inertia=(0.1, 0.2, 0.3), position=(2.0, -0.3, -out), velocity=(4.0, 0, 0),
                     angular_velocity=(0, 0, 3.0) if planar else (1.0, 2.0, 3.0))
    scene.slide("A", along="rope", s=2.0, at=(0, 0.3, out), name="trolley")
    scene.force("rope", s=5.0, value=(3.0, 0.0, 0.0), follower=True, scale=fu.Harmonic(amplitude=1.0, frequency=1.0))
    scene.spring(("rope", 5.0), (5.0, 1.0, 0.0), stiffness=20.0, damping=3.0, length=0.0)
    return scene


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize(("scene", "name", "duration", "steps"), [(soft, "rope.nodal_vectors", 0.02, (4, 8)),
                                                                  (rider, "A.position", 0.6, (40, 80))])
def test_explicit_keeps_order_8(scene, name, duration, steps):
    """Without slides, across an element boundary, where r_xx is discontinuous."""
    def last(**settings) -> np.ndarray:
        return scene().run(duration, integrator="explicit", output_step=duration, **settings)[name][-1]

    reference = last(tol=1e-12)
    errors = [np.abs(last(step=duration / n) - reference).max() for n in steps]
    assert errors[0] / errors[1] > 2**7, errors


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize(("scene", "duration", "steps"), [(soft, 0.02, (8, 16)), (rider, 0.6, (80, 160)),
                                                          (lambda: rider(planar=True), 0.6, (80, 160))])
def test_radau_keeps_order_5_in_everything(scene, duration, steps):
    """Positions, forces on the rider, energy; also where a slide crosses from one element into the next."""
    def last(**settings) -> dict[str, np.ndarray]:
        run = scene().run(duration, output_step=duration, **settings)
        return {name: run[name][-1] for name in ("rope.nodal_vectors", "trolley.force", "energy.kinetic",
                                                 "energy.external") if name in run}

    reference = last(integrator="explicit", tol=1e-12)
    coarse, fine = (last(integrator="radau", step=duration / n) for n in steps)
    for name, value in reference.items():
        if np.ptp(value) or np.any(value):
            assert np.abs(coarse[name] - value).max() / np.abs(fine[name] - value).max() > 2**4.5, name


def test_radau_is_the_method_of_order_5():
    method = Radau()
    for power in range(5):
        np.testing.assert_allclose(method.A[-1] @ method.c**power, 1 / (power + 1), rtol=1e-14)
    np.testing.assert_allclose(method.A.sum(axis=1), method.c, rtol=1e-14)
    block = np.array([[method.gamma, 0, 0], [0, method.alpha, -method.beta], [0, method.beta, method.alpha]])
    np.testing.assert_allclose(method.T @ block @ method.T_inverse, method.A_inverse, atol=1e-13)


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize(("integrator", "tol", "most"), [("explicit", 1e-9, 1e-11), ("radau", 1e-7, 1e-6)])
def test_integrators_agree_on_everything(planar, integrator, tol, most):
    found = rider(planar).run(1.0, integrator=integrator, tol=tol, output_step=0.1)
    implicit = rider(planar).run(1.0, integrator="genalpha", tol=1e-6, output_step=0.1)
    for name in ("A.position", "A.orientation", "trolley.s", "rope.nodal_vectors", "energy.dissipated",
                 "energy.external"):
        np.testing.assert_allclose(found[name], implicit[name], atol=2e-5 * np.ptp(found[name]) + 1e-12, err_msg=name)
    assert found.report["element_crossings"] == implicit.report["element_crossings"] > 0
    assert found["trolley.residual"].max() < 1e-12
    assert energy_error(found) < most, "energy is summed with the stages' weights"
    assert np.abs(np.linalg.norm(found["A.orientation"], axis=1) - 1).max() < 1e-15


@pytest.mark.parametrize("angle", [1.0, 2.0, 3.0, 5.0, 8.0, 15.0, 50.0])
def test_radaus_estimate_is_true_for_vibrations_that_a_step_does_not_resolve(angle):
    """One step of several radians of a mass on a spring, from four phases: twice the estimate for vibrations counts,
    1.1 to 4.7 errors. The embedded estimate alone is 32 errors at 1 rad and 0.7 at 8.
    """
    estimates, errors = [], []
    for phase in 0.1 + np.arange(4) * np.pi / 4:
        scene = fu.Scene(gravity=(0, 0, 0))
        scene.rigid_body("A", mass=2.0, inertia=(1, 1, 1), position=(np.cos(phase), 0, 0),
                         velocity=(-angle * np.sin(phase), 0, 0))
        scene.spring("A", (0, 0, 0), stiffness=2.0 * angle**2, length=0.0)
        run = scene.run(1.0, step=1.0, output_step=1.0, integrator="radau")
        estimates.append(run.report["sum_of_local_error_estimates_m"])
        errors.append(abs(run["A.position"][-1, 0] - np.cos(phase + angle)))
    assert 1.0 < max(estimates) / max(errors) < 6.0


@pytest.mark.parametrize("youngs_modulus", [2e6, 7e8, 2e11])
def test_radau_reaches_tol_however_stiff(youngs_modulus):
    stiff = soft(youngs_modulus=youngs_modulus)
    fine = stiff.run(0.05, integrator="radau", tol=1e-8, output_step=0.01)
    for tol in (1e-3, 1e-5):
        run = stiff.run(0.05, integrator="radau", tol=tol, output_step=0.01)
        apart = np.abs(run["rope.nodal_vectors"] - fine["rope.nodal_vectors"])[:, :, 0].max()
        assert apart < 3 * tol * fine.report["largest_motion_m"]
        assert run.report["steps"] < 1000  # explicit: 9000 with the stiffest


def test_explicit_is_right_about_a_stiff_scene_too():
    """Where stability limits the step, the error stays at tol."""
    stiff = soft(youngs_modulus=7e8)
    explicit, fine = (stiff.run(0.02, integrator="explicit", tol=tol, output_step=0.01) for tol in (1e-3, 1e-10))
    assert explicit.report["rejected_steps"] > 0
    apart = np.abs(explicit["rope.nodal_vectors"] - fine["rope.nodal_vectors"])[:, :, 0].max()
    assert apart < 1e-3 * fine.report["largest_motion_m"]


def test_auto_takes_the_cheaper_and_says_why():
    assert RunSettings(duration=1.0).integrator == "auto"
    loose = soft(16, 2e8).run(0.1, tol=1e-3, output_step=0.1).report
    middle = soft(16, 2e8).run(0.1, tol=1e-4, output_step=0.1).report
    tight = soft(4, 2e5).run(0.01, tol=1e-8, output_step=0.01).report
    assert [report["integrator"] for report in (loose, middle, tight)] == ["genalpha", "radau", "explicit"]
    assert "highest frequency" in tight["integrator_reason"] and "evaluations a second" in loose["integrator_reason"]


@pytest.mark.parametrize(("settings", "reason"), [
    ({"step": 1e-4}, "the step is fixed"),
    ({"spectral_radius": 0.5}, "spectral_radius is given"),
    ({"integrator": "genalpha"}, "as asked for"),
])
def test_auto_leaves_to_genalpha_what_only_it_can(settings, reason):
    report = soft(2, 1e4).run(0.01, output_step=0.01, tol=1e-8, **settings).report
    assert report["integrator"] == "genalpha"
    assert reason in report["integrator_reason"]


def test_damping_counts_in_the_choice():
    """A decay faster than the fastest vibration limits the explicit step."""
    assert soft(4, 2e5).run(0.01, tol=1e-6, output_step=0.01).report["integrator"] == "explicit"
    report = soft(4, 2e5, damping_time=100.0).run(0.01, tol=1e-6, output_step=0.01).report
    assert report["integrator"] == "radau"
    assert "fastest decay" in report["integrator_reason"]


@pytest.mark.parametrize("integrator", ["genalpha", "explicit", "radau"])
def test_threads_change_no_bit(integrator, monkeypatch):
    """Groups of elements at separate places: 37 elements end in an incomplete group."""
    monkeypatch.setattr("funicular.solve.linear.threads.available", lambda: 3)
    runs = [soft(37, 2e4, damping_time=1e-4).run(1e-3, integrator=integrator, output_step=5e-4, threads=threads)
            for threads in (1, 2, 3)]
    assert runs[0].report["messages"] == []
    for run in runs[1:]:
        assert run["rope.nodal_vectors"].tobytes() == runs[0]["rope.nodal_vectors"].tobytes()
        assert run.report["messages"] == []


@pytest.mark.parametrize("name", INTEGRATORS)
def test_the_engine_takes_the_parameters_of_each_integrator(name):
    """Name and number of parameters agree with those of the engine."""
    scene = soft()
    engine = Engine(model := build(scene))
    if INTEGRATORS[name].is_linear:
        take_linear_model(engine, scene, model)
    status, _ = engine.start(duration=1.0, output_step=0.1, tol=1e-4, step=0.0, method=INTEGRATORS[name].of(0.9),
                             first_step=1e-3)
    assert (status, engine.integrator) == (None, name)


def test_the_engine_refuses_other_integrators_and_parameters():
    class Other(GeneralisedAlpha):
        name = "other"

    class Short(GeneralisedAlpha):
        parameters = np.zeros(3)

    for method, what in ((Other(), "no integrator other"), (Short(), "genalpha: 4 parameters, not 3")):
        with pytest.raises(ValueError, match=what):
            Engine(build(soft())).start(duration=1.0, output_step=0.1, tol=1e-4, step=0.0, method=method,
                                        first_step=1e-3)
