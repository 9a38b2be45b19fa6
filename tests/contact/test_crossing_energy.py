"""Lines in contact in runs that conserve energy: balance, order, momenta, Newton's matrix, refusals."""

from itertools import pairwise

import funicular as fu
import numpy as np
import pytest
from derivatives import of_a_step
from expectations import unaccounted
from funicular.engine import Engine
from funicular.integrators import EnergyMomentum
from funicular.model.build import build
from test_crossing import own_unknowns_eliminated, touching

RUBBER = fu.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=1000)
PAIRS = [(3, "cable"), (3, "bar"), (2, "bar")]
LAWS = {"linear": {}, "hertz": {"exponent": 1.5},
        "losses": {"damping": 0.3, "friction": fu.Friction(coefficient=0.3, velocity=0.1)}}


def rope(scene: fu.Scene, name: str, start, end, elements: int, element: str = "cable12", **more) -> fu.Cable:
    return scene.cable(name, start=start, end=end, elements=elements, element=element, material=RUBBER,
                       section=fu.Circle(radius=0.01), **more)


def thrown(dim: int, other: str, speed: float = 1.0, **law) -> fu.Scene:
    """Return a rope between two pins, and a rope or a body's bar that is thrown at it with spin and slides along it."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    wire = rope(scene, "wire", (0, 0, 0), (2, 0, 0), 6, "cable12" if dim == 3 else "cable8p")
    scene.pin(wire, s=0.0)
    scene.pin(wire, s=wire.length)
    law = {"stiffness": 2e4, "name": "contact"} | law
    if other == "cable":
        rope(scene, "other", (0.9, 0.05, -1), (1.2, 0.08, 1), 5, velocity=(speed, -2, 0))
        scene.crossing("wire", "other", **law)
        return scene
    scene.rigid_body("head", mass=0.5, inertia=(0.01, 0.02, 0.015), position=(0.9, -0.1, 0), velocity=(speed, 2, 0),
                     angular_velocity=(0.3, 0.5, 1.0) if dim == 3 else (0, 0, 1.0))
    bar = {"axis": (0.2, 0.05, 1), "length": 0.8} if dim == 3 else {}
    scene.crossing("wire", "head", at=(0.02, 0.05, 0), **bar, **law)
    return scene


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("dim", "other"), PAIRS)
def test_what_is_thrown_keeps_its_energy_to_rounding(dim, other, law):
    run = thrown(dim, other, **LAWS[law]).run(duration=0.15, step=4e-4, output_step=0.01, integrator="energy")
    whats = {event["what"] for event in run.report["events"]}
    assert whats == {"came into contact", "lost contact"} or (law == "hertz" and "came into contact" in whats)
    assert run["contact.normal_force"].max() > 5.0
    scale = max(run["energy.kinetic"].max(), run["energy.elastic"].max())
    assert unaccounted(run) < 1e-12 * scale  # measured: 1e-13
    lost = run["energy.dissipated"]
    assert (lost[-1] > 0.1) == (law == "losses") and np.diff(lost).min() > -1e-13 * scale
    assert lost[-1] > 0.1 or lost[-1] < 1e-13


@pytest.mark.parametrize("exponent", [1.0, 1.5])
def test_a_bar_that_slides_over_nodes_costs_no_energy(exponent):
    """The closest points cross three or more elements during contact, where genalpha loses energy."""
    scene = thrown(3, "bar", speed=12.0, stiffness=2e3, exponent=exponent)
    run, other = (scene.run(duration=0.1, step=4e-4, output_step=0.002, integrator=name)
                  for name in ("energy", "genalpha"))
    touches = run["contact.normal_force"] > 0
    assert np.ptp(run["contact.s"][touches]) > 2 / 6
    assert unaccounted(run) < 1e-12 * run["energy.kinetic"].max()
    assert unaccounted(other) > 1e-8 * run["energy.kinetic"].max()


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")  # the lines overlap, and touch all the time
@pytest.mark.parametrize(("dim", "other"), PAIRS)
@pytest.mark.parametrize("law", LAWS)
def test_order_in_time_is_two(dim, other, law):
    scene = thrown(dim, other, radius=0.2, **{"stiffness": 300.0, "exponent": 1.0} | LAWS[law])

    def end(run):
        assert not run.report["events"]
        return run["wire.nodal_vectors"][-1, :, 0]

    exact = end(scene.run(duration=0.02, tol=1e-10, output_step=0.02, integrator="radau"))
    errors = [np.abs(end(scene.run(duration=0.02, step=h, output_step=0.02, integrator="energy")) - exact).max()
              for h in (2e-4, 1e-4, 5e-5)]
    for coarse, fine in pairwise(errors):
        assert 3.6 < coarse / fine < 4.4


def test_momentum_of_two_ropes_is_kept():
    """Linear momentum to rounding; angular momentum, by the discrete gradient's base point, to third order in a step.
    """
    scene = fu.Scene(gravity=(0, 0, 0))
    rope(scene, "wire", (0, 0, 0), (2, 0, 0), 6)
    rope(scene, "other", (0.9, 0.05, -1), (1.2, 0.08, 1), 5, velocity=(1.0, -2, 0.5))
    scene.crossing("wire", "other", stiffness=2e4, name="contact")
    model = build(scene)
    turned = []
    for h in (4e-4, 2e-4):
        run = scene.run(duration=0.1, step=h, output_step=0.005, integrator="energy")
        assert run["contact.normal_force"].max() > 5.0
        linear, angular = np.zeros((2, len(run.time), 3))
        for cable in model.cables:
            for i in range(len(run.time)):
                for k in range(cable.n_elements):
                    e, v = (run[f"{cable.name}.{name}"][i, k:k + 2].reshape(-1, 3)
                            for name in ("nodal_vectors", "nodal_velocity"))
                    p = cable.m[0] @ v
                    linear[i] += p[:: len(cable.vectors)].sum(axis=0)
                    angular[i] += np.cross(e, p).sum(axis=0)
        assert np.abs(linear - linear[0]).max() < 1e-12 * np.abs(linear).max()
        turned.append(np.abs(angular - angular[0]).max() / np.abs(angular).max())
    assert turned[1] < 1e-6 and turned[1] < turned[0] / 3


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")  # the lines overlap
@pytest.mark.parametrize(("dim", "other"), [(2, "bar"), (3, "bar"), (3, "cable")])
@pytest.mark.parametrize("exponent", [1.0, 1.5])
def test_newton_contracts_faster_with_smaller_steps(dim, other, exponent):
    """The matrix approximates the derivative of the residual; the test measures the error after one iteration."""
    engine = Engine(build(touching(dim, other, exponent)))
    status, _ = engine.start(duration=1.0, output_step=0.1, tol=1e-4, step=0.0, method=EnergyMomentum(),
                             first_step=1e-3)
    assert status is None
    own, left = 2 * dim - 1, []
    at = np.zeros(engine.unknowns)
    for h in (1e-3, 1e-4):
        matrix = own_unknowns_eliminated(engine.linearise(h, at)[1], own)
        derivative = of_a_step(engine, h, at, 1e-7)[:-own, :-own]
        left.append(np.abs(np.linalg.eigvals(np.eye(len(matrix)) - np.linalg.solve(matrix, derivative))).max())
    assert left[0] < 0.05  # measured: 0.025 and 2.8e-5 at most
    assert left[1] < left[0] / 50


def test_friction_that_sticks_is_refused():
    scene = thrown(3, "bar", friction=fu.Friction(coefficient=0.3, model="stick"))
    with pytest.raises(fu.SceneError, match='"energy" does not support friction of crossings that sticks'):
        scene.run(duration=0.01, output_step=0.01, integrator="energy")
