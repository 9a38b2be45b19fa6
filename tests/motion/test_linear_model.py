"""Small motion about the start by the linear model: order of its error, forces, energy, resuming, refusals."""

import funicular as fu
import numpy as np
import pytest
from expectations import energy_error, refused
from footbridge import ELEMENTS, bridge, modal
from funicular import load_run
from interrupted_runs import check_file_and_resume
from shared_scenes import add_cable, cable_scene, structural

THIN = fu.Rectangle(height=0.01, width=0.01)
SOFT = fu.Material(youngs_modulus=2e8, poisson_ratio=0.0, density=1100, damping_time=1e-3, mass_damping=0.3)
WIRE = {"end": (4, 0, 0), "rest_length": 3.99, "elements": 8, "material": SOFT, "section": THIN}
SETTINGS = {"duration": 0.2, "output_step": 0.01, "step": 2e-4, "initial": "equilibrium"}
"""Of runs that are compared: the error in time of both methods is the same."""


def pushed(size, element="cable12"):
    """Return a stretched cable between two pins under a force in N, zero at the start."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    add_cable(scene, pins="ends", element=element, **WIRE, **structural(element))
    scene.force("wire", s=1.4, value=(0, size, 0), scale=fu.Harmonic(amplitude=1.0, frequency=3.0))
    return scene


def with_body(size):
    """Return the same with springs, of which one is slack at the start, and a body on a spherical joint."""
    scene = pushed(size)
    middle = scene.cables["wire"].length / 2
    scene.rigid_body("load", mass=0.3, inertia=(0.01, 0.02, 0.03), position=(2, -0.3, 0.0))
    scene.joint("spherical", ("wire", middle), ("load", (0, 0.3, 0)), name="eye")
    scene.spring(("wire", 3.0), (3, -1, 0.2), stiffness=200.0, damping=0.5, length=1.0, name="stay")
    scene.spring(("wire", 1.0), (1, 1, 0.2), stiffness=300.0, tension_only=True, length=1.3, name="loose")
    scene.force("load", value=(0, 0, size), scale=fu.Harmonic(amplitude=1.0, frequency=2.0))
    return scene


def on_moving_support(size):
    """Return a stretched cable whose end moves, size times 20 mm."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    wire = add_cable(scene, pins=(0.0,), **WIRE)
    scene.motion("wire", s=wire.length, displacement=(0, fu.Harmonic(amplitude=0.02 * size, frequency=2.0), 0))
    return scene


def driven(size):
    """Return a stretched cable whose end is on a body that a joint drives, size times 0.5 m/s."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    wire = add_cable(scene, pins=(0.0,), **WIRE)
    scene.rigid_body("carriage", mass=0.5, inertia=(0.01, 0.01, 0.01), position=(4, 0, 0))
    scene.joint("prismatic", (4, 0, 0), "carriage", axis=(0, 1, 0), name="drive",
                velocity=fu.Harmonic(amplitude=0.5 * size, frequency=2.0))
    scene.joint("spherical", "carriage", ("wire", wire.length), name="end")
    return scene


def with_riders(size):
    """Return a stretched cable under three riders: one driven, one free, which carries a body, and an eyelet."""
    scene = fu.Scene(gravity=(0, 0, 0))
    add_cable(scene, pins="ends", **WIRE)
    scene.rigid_body("walker", mass=0.1, inertia=(1e-3, 1e-3, 1e-3), position=(0.8, 0, 0), velocity=(3, 0, 0))
    scene.slide("walker", along="wire", velocity=3.0 / (4 / 3.99), name="walk")
    scene.force("walker", value=(0, -2 * size, 0.5 * size), scale=fu.Harmonic(amplitude=1.0, frequency=4.0))
    scene.rigid_body("trolley", mass=0.2, inertia=(1e-3, 1e-3, 1e-3), position=(2.8, 0, 0), velocity=(-2, 0, 0))
    scene.slide("trolley", along="wire", name="back")
    scene.rigid_body("load", mass=0.1, inertia=(1e-3, 1e-3, 1e-3), position=(2.8, -0.2, 0), velocity=(-2, 0, 0))
    scene.joint("spherical", ("trolley", (0, -0.1, 0)), ("load", (0, 0.1, 0)), name="eye")
    scene.force("load", value=(0, -size, 0), scale=fu.Harmonic(amplitude=1.0, frequency=2.0))
    scene.slide((3.2, 0, 0), along="wire", name="eyelet")
    return scene


def differences(make, size, names):
    """Return the largest difference of results by the linear model and by the equations of the scene."""
    one, other = (make(size).run(integrator=name, **SETTINGS) for name in ("linear", "genalpha"))
    found = [np.abs(one[name] - other[name]).max() for name in names]
    for method in ("balance", "constitutive"):
        a, b = (run.section_forces("wire", s=[0.7, 2.3, 3.6], method=method) for run in (one, other))
        found.append(float(np.abs(a["force"] - b["force"]).max()))
    assert energy_error(one) < max(2 * energy_error(other), 2e-2 * size**2)
    return np.array(found)


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize(("make", "names"), [
    *((lambda size, element=element: pushed(size, element), ()) for element in ("cable8p", "cable12", "beam12p",
                                                                                "beam24")),
    (with_body, ("load.position", "load.acceleration", "eye.force", "stay.force")),
    (on_moving_support, ()), (driven, ("drive.force", "end.force")),
    (with_riders, ("walker.position", "walk.force", "walk.traction", "back.s", "back.force", "load.acceleration",
                   "eye.force", "eyelet.force"))])
def test_the_error_of_the_linear_model_is_of_second_order(make, names):
    """Positions, forces of joints and springs, accelerations, and section forces: half the load, a fourth of the error.
    """
    names = ("wire.nodal_vectors", *names)
    errors = [differences(make, size, names) for size in (0.5, 0.25, 0.125)]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert np.all(orders > 1.7), dict(zip((*names, "balance", "law"), orders.T, strict=True))
    assert errors[-1][0] < 1e-4


def test_the_estimate_is_near_the_error_and_a_large_motion_is_noted():
    with pytest.warns(fu.FunicularWarning, match="the linear model of motion about the start is off"):
        run = pushed(2.0).run(integrator="linear", tol=1e-4, **SETTINGS | {"step": None})
    other = pushed(2.0).run(integrator="genalpha", tol=1e-4, **SETTINGS | {"step": None})
    error, estimate = np.abs(run["wire.position"] - other["wire.position"]).max(), run.report["linear_model_error_m"]
    assert 0.3 < estimate / error < 3
    assert any(message.startswith("the linear model of motion about the start is off by up to")
               for message in run.report["messages"])
    small = pushed(1e-3).run(integrator="linear", tol=1e-2, **SETTINGS | {"step": None})
    assert small.report["linear_model_error_m"] < 1e-8
    assert small.report["messages"] == []


@pytest.mark.parametrize("make", [with_body, with_riders])
def test_a_killed_run_continues_with_the_same_numbers(make, tmp_path):
    settings = SETTINGS | {"integrator": "linear"}
    whole = check_file_and_resume(make(0.3), tmp_path, 40, **settings)
    resumed = load_run(tmp_path / "run.nc")
    assert resumed.report["resumed_at_s"]
    assert resumed.report["linear_model_error_m"] == whole.report["linear_model_error_m"]


def slack():
    """Return a mass on a tension-only spring, thrown up."""
    scene = fu.Scene(gravity=(0, 0, -9.81))
    scene.rigid_body("m", mass=2.0, inertia=(1, 1, 1), position=(0, 0, -1.0), velocity=(0, 0, -0.5))
    scene.spring((0, 0, 0), "m", length=1.0, stiffness=400.0, tension_only=True)
    return scene


def test_springs_that_go_slack_are_exact():
    """Without cables the linear model is the scene itself, at any motion."""
    one, other = (slack().run(2.0, integrator=name, tol=1e-6) for name in ("linear", "radau"))
    assert np.abs(one["m.position"] - other["m.position"]).max() < 1e-5
    assert [event["what"] for event in one.report["events"]] == [event["what"] for event in other.report["events"]]
    assert one.report["linear_model_error_m"] == 0


def test_steps_of_a_fixed_size_go_over_kinks_of_forces():
    """Their number is the same as without; the error of the motion falls by four, of instants within a step."""
    exact = slack().run(0.5, integrator="radau", tol=1e-8)
    errors = []
    for step in (5e-3, 2.5e-3, 1.25e-3):
        run = slack().run(0.5, integrator="linear", step=step, output_step=0.01)
        assert run.report["steps"] == round(0.5 / step)
        assert [event["what"] for event in run.report["events"]] == [event["what"] for event in exact.report["events"]]
        assert max(abs(one["time"] - other["time"]) for one, other in zip(
            run.report["events"], exact.report["events"], strict=True)) < 0.1 * step
        errors.append(abs(run["m.position"][-1, 2] - exact["m.position"][-1, 2]))
    assert errors[0] > 3 * errors[1] > 9 * errors[2]


def walked(end="error", speed=2.0):
    """Return a cable at rest under a rider that leaves it at its end."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    add_cable(scene, pins="ends", **WIRE)
    scene.rigid_body("walker", mass=0.02, inertia=(1e-3, 1e-3, 1e-3), position=(3.5, 0, 0), velocity=(speed, 0, 0))
    scene.slide("walker", along="wire", at_end=end, velocity=speed / (4 / 3.99), name="walk")
    return scene


def test_riders_leave_their_cable():
    settings = {"duration": 0.4, "initial": "equilibrium", "tol": 1e-4, "output_step": 0.01}
    one, other = (walked("leave").run(integrator=name, **settings) for name in ("linear", "genalpha"))
    (left,), (also,) = one.report["events"], other.report["events"]
    assert left["what"] == also["what"] == "left"
    assert left["time"] == pytest.approx(also["time"], abs=1e-4)
    assert np.abs(one["walker.position"] - other["walker.position"]).max() < 1e-3
    with pytest.raises(fu.EndOfCableError, match="ran off the end"):
        walked().run(integrator="linear", **settings)


def test_steps_of_a_fixed_size_go_over_nodes():
    """The rider passes three nodes."""
    run = with_riders(0.1).run(integrator="linear", **SETTINGS)
    assert run.report["element_crossings"] >= 2
    assert run.report["steps"] == round(SETTINGS["duration"] / SETTINGS["step"])
    assert run.report["factorisations"] == 1
    assert max(np.abs(run[f"{name}.residual"]).max() for name in ("walk", "back", "eyelet")) < 1e-13


def test_what_it_does_not_support_is_refused():
    for given, what in (({"friction": 0.1}, "friction of slides and stops; leave them out"),
                        ({"at_end": fu.HardStop(restitution=0.5)}, "friction of slides and stops; leave them out"),
                        ({"frame": "tangent"}, 'the frame "tangent"; take the frame "point"')):
        scene = cable_scene(pins="ends")
        scene.rigid_body("A", mass=1.0, inertia=(1e-3, 1e-3, 1e-3), position=(0.2, 0, 0))
        scene.slide("A", along="wire", name="trolley", **given)
        with refused(f'slide "trolley": integrator "linear" does not support {what}, or take another integrator'):
            scene.run(0.1, integrator="linear")
    scene = fu.Scene()
    scene.modal_body("bar", start=(0, 0, 0), end=(0.5, 0, 0), modes=2, elements=4, section=THIN, material=SOFT)
    with refused('modal_body "bar": integrator "linear" does not support modal bodies; take another integrator: '
                 "genalpha, explicit or radau, with a small tol"):
        scene.run(0.1, integrator="linear")


def test_walkers_on_a_footbridge():
    """Against modes of the beam with the moving masses: half the step, about a fourth of the error."""
    errors = []
    deflection = modal(3, 70.0, np.arange(0, 2.51, 0.05), modes=5)
    for step in (1e-2, 5e-3):
        run = bridge(3, 70.0).run(2.5, output_step=0.05, integrator="linear", step=step)
        errors.append(np.abs(run["deck.nodal_vectors"][:, ELEMENTS // 2, 0, 1] + deflection).max() / deflection.max())
        assert run.report["factorisations"] <= 2
    assert errors[0] > 3 * errors[1]
    assert errors[1] < 5e-3
