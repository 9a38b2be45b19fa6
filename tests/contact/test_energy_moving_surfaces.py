"""The energy integrator with contact on surfaces of bodies: balance, momenta, matrix, order."""

import funicular as fu
import numpy as np
import pytest
from derivatives import of_a_step
from expectations import unaccounted
from funicular.engine import Engine
from funicular.integrators import EnergyMomentum
from funicular.model.build import build
from scipy.spatial.transform import Rotation

ROPE = {"section": fu.Circle(radius=0.01), "material": fu.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=2000)}


INERTIA = {"A": (3e-4, 4e-4, 5e-4), "B": (1e-3, 2e-3, 3e-3)}
MASS = {"A": 0.3, "B": 0.4}
SHAPES = {"sphere": fu.Sphere(radius=0.06), "capsule": fu.Capsule(radius=0.05, length=0.1, axis=(1, 0, 0)),
          "plane": fu.Plane(normal=(0.1, 1, 0.05)), "box": fu.Box(size=(0.16, 0.1, 0.12)),
          "hills": fu.HeightField.of(lambda x, z: 0.05 + 0.003 * np.sin(9 * x) * np.cos(8 * z),
                                     np.linspace(-0.9, 0.9, 20), np.linspace(-0.9, 0.9, 20))}


def tumbling(scene: fu.Scene, shape, x: float = 0.0, spin=(5, 7, 20)) -> fu.Scene:
    scene.rigid_body("B", mass=MASS["B"], inertia=INERTIA["B"], position=(x, 0, 0), angular_velocity=spin)
    scene.surface("s", shape, on="B")
    return scene


def thrown(shape, element="cable12", height=0.1, speed=1.0, spin=(0.5, 0.7, 2.0), **law) -> fu.Scene:
    """Return a free cable that flies against a surface on a free rotating body."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(-0.5, height, 0), end=(0.5, height, 0), elements=4, element=element,
                velocity=(0, -speed, 0), **ROPE)
    tumbling(scene, shape, 0.2, spin)
    scene.contact("wire", "s", **({"stiffness": 1e5} | law))
    return scene


def colliding(shape, height=0.2, **law) -> fu.Scene:
    """Return a free body whose points fly against a surface on another; both rotate."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=MASS["A"], inertia=INERTIA["A"], position=(0.03, height, 0.01), velocity=(0.1, -1, 0),
                     angular_velocity=(3, 1, 5))
    tumbling(scene, shape)
    scene.contact("A", "s", points=[(0.02, 0, 0), (-0.02, -0.01, 0.01)], radius=0.05, **({"stiffness": 1e4} | law))
    return scene


def angular_momentum(run: fu.Run) -> np.ndarray:
    """Return the angular momentum of the two bodies about the origin, (time, 3), kg m²/s."""
    total = np.zeros((len(run.time), 3))
    for name, mass in MASS.items():
        turn = Rotation.from_quat(np.roll(run[f"{name}.orientation"], -1, axis=1))
        total += mass * np.cross(run[f"{name}.position"], run[f"{name}.velocity"])
        total += turn.apply(run[f"{name}.angular_velocity"] * INERTIA[name])
    return total


def exchanged(run: fu.Run) -> float:
    """Return the sum of rises and falls of the kinetic energy, J."""
    return float(np.abs(np.diff(run["energy.kinetic"])).sum())


LAWS = {"elastic": {}, "hertz": {"exponent": 1.5, "stiffness": 1e6}, "damped": {"damping": 0.5},
        "friction": {"damping": 0.5, "friction": 0.3, "tangential_stiffness": 1e4}}


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("make", [thrown, colliding])
def test_energy_balances_to_rounding(make, shape, law):
    run = make(SHAPES[shape], **LAWS[law]).run(0.2, output_step=0.005, step=1e-3, integrator="energy")
    taken = run["energy.dissipated"]
    assert run.report["events"] and exchanged(run) > 5e-3
    assert unaccounted(run) < 1e-11 * exchanged(run)
    if law in ("elastic", "hertz"):
        assert np.abs(taken).max() < 1e-13 * exchanged(run)
    else:
        assert taken[-1] > 0.01 * exchanged(run) and np.diff(taken).min() > -1e-13 * exchanged(run)


@pytest.mark.parametrize("law", LAWS)
def test_momenta_are_kept_to_rounding(law):
    run = colliding(SHAPES["capsule"], **LAWS[law]).run(0.2, output_step=0.005, step=1e-3, integrator="energy")
    linear = sum(mass * run[f"{name}.velocity"] for name, mass in MASS.items())
    angular = angular_momentum(run)
    assert np.ptp(run["B.velocity"], axis=0).max() > 0.05
    assert np.ptp(linear, axis=0).max() < 1e-13 and np.ptp(angular, axis=0).max() < 1e-13


def test_energy_balances_in_the_plane_with_chosen_steps():
    scene = thrown(SHAPES["capsule"], element="cable8p", spin=(0, 0, 2.0))
    run = scene.run(0.2, output_step=0.005, tol=1e-4, integrator="energy")
    assert run.report["events"] and unaccounted(run) < 1e-11 * exchanged(run)


@pytest.mark.parametrize("make", [thrown, colliding])
def test_the_motion_is_that_of_another_integrator_to_order_two(make):
    law = {"damping": 0.5}
    exact = make(SHAPES["capsule"], **law).run(0.2, output_step=0.01, tol=1e-8, integrator="radau")
    errors = []
    for step in (4e-4, 1e-4):
        run = make(SHAPES["capsule"], **law).run(0.2, output_step=0.01, step=step, integrator="energy")
        errors.append(np.abs(run["B.position"] - exact["B.position"]).max())
    assert np.ptp(exact["B.position"], axis=0).max() > 0.02
    assert errors[1] < 4e-6 and errors[1] < errors[0] / 8


TOUCHING = {thrown: {"sphere": 0.066, "capsule": 0.058, "plane": 0.077, "hills": 0.059,
                     "box": 0.058},
            colliding: {"sphere": 0.11, "capsule": 0.09, "plane": 0.053, "hills": 0.09,
                        "box": 0.105}}
"""Heights, in m, at which scenes are drawn that touch at the start."""


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("make", [thrown, colliding])
def test_the_matrix_is_the_derivative_of_the_residual(make, shape, law):
    """The error after an iteration decreases with the step, since the matrix rotates bodies half-way."""
    left = []
    for h in (1e-3, 1e-4):
        engine = Engine(build(make(SHAPES[shape], height=TOUCHING[make][shape], **LAWS[law])))
        engine.set_state(0.0)
        assert engine.static_outputs("contact")[0, 6] > 0
        engine.start(duration=1.0, output_step=0.1, tol=1e-4, step=0.0, method=EnergyMomentum(), first_step=1e-3)
        unmoved = np.zeros(engine.unknowns)
        _, matrix = engine.linearise(h, unmoved)
        derivative = of_a_step(engine, h, unmoved, 1e-7)
        rest = np.eye(engine.unknowns) - np.linalg.solve(matrix, derivative)
        left.append(np.abs(np.linalg.eigvals(rest)).max())
    assert left[0] < 5e-3  # measured: 3.4e-3 at most
    assert left[1] < left[0] / 50
