"""funicular as a solver of cosseratbench, found and scored by that package."""

import json

import numpy as np
import pytest
from funicular.errors import ConvergenceError

pytest.importorskip("cosseratbench")  # of the extra test

from cosseratbench import Capability, registry
from cosseratbench.experiment import COMPLETED, DIVERGED, UNSUPPORTED, run
from cosseratbench.solver import Solver
from funicular.cosserat_bench import solver as module


def scored(name, elements, values=None, **options):
    """Return the score of an experiment for a run with its metrics."""
    return run(registry.load_experiment(name), registry.load_solver("funicular", **options), n_elements=elements,
               values=values)


def test_it_is_found():
    assert "funicular" in registry.names(registry.SOLVERS)
    solver = registry.load_solver("funicular")
    assert isinstance(solver, Solver)
    assert solver.name == "funicular"
    assert solver.capabilities == {Capability.STRETCH, Capability.ROD_CONTACT, Capability.CYLINDER_CONTACT,
                                   Capability.PLANE_CONTACT}


@pytest.mark.parametrize(("name", "elements", "options", "limits"), [
    ("catenary", 20, {}, {"shape_error": 5e-4, "settling_residual": 1e-6}),  # bending, which the reference has not
    ("catenary", 20, {"bending": False}, {"shape_error": 1e-6, "sag_error": 1e-5}),
    ("cantilever", 4, {}, {"tip_deflection_error": 4.2e-4}),  # geometry: 4.1e-4
    ("pendulum", 10, {}, {"period_error": 2.05e-5, "amplitude_change": 1e-5}),  # amplitude: 2e-5
])
def test_errors(name, elements, options, limits):
    result = scored(name, elements, **options)
    assert result.outcome == COMPLETED
    for metric, limit in limits.items():
        assert abs(result.metrics[metric]) < limit, metric
    frames = result.trajectory
    assert np.abs(np.linalg.norm(frames.directors[0], axis=-1) - 1).max() < 1e-9
    assert np.abs(frames.directors[0] - frames.directors[0][0]).max() < 1e-9 or name == "cantilever"
    assert json.loads(json.dumps(result.summary()))["settings"]["integrator"] == "radau"


@pytest.mark.parametrize(("drop", "elements", "error"), [(0.05, 20, 1e-4), (0.1, 40, 1e-5)])
@pytest.mark.slow_cases("0.1-40-1e-05")
def test_crossing(drop, elements, error):
    """With nodes at the points of the reference and at the contact, only the error of the mesh remains."""
    result = scored("crossing", elements, values={"drop": drop})
    assert result.outcome == COMPLETED
    assert result.metrics["shape_error"] < error
    assert result.metrics["lift_error"] < 10 * error
    assert result.metrics["settling_residual"] < 1e-6
    assert result.observations["max_rod_overlap"] < 0.2  # radii, of polylines


@pytest.mark.parametrize(("overhang", "holds"), [(0.95, True), (1.05, False)])
def test_capstan(overhang, holds):
    """The closed form gives the load at which friction no longer holds the rope."""
    result = scored("capstan", 50, values={"overhang": overhang})
    assert result.outcome == COMPLETED
    assert (result.metrics["slide"] < 1e-3) == holds
    assert holds or result.metrics["slide"] > 0.1
    assert result.observations["max_penetration"] < 0.05


@pytest.mark.slow
def test_twist():
    """The experiment gives 0.5 % as the uncertainty of its measurement."""
    result = scored("twist", 50)
    assert result.outcome == COMPLETED
    assert result.metrics["critical_twist_error"] < 2.5e-3


def test_steps_of_another_scale():
    """A sweep of the time step doubles the step and changes the motion by less than the tolerance."""
    scenario = registry.load_experiment("pendulum").scenario
    usual, longer = (registry.load_solver("funicular", time_step_scale=scale).run(scenario, n_elements=5, n_frames=11)
                     for scale in (1.0, 2.0))
    apart = np.abs(usual.positions[0] - longer.positions[0]).max()
    assert 0 < apart < 1e-4


def test_contact_of_a_rope_with_itself_is_unsupported():
    result = scored("pile", 10)
    assert (result.outcome, result.missing) == (UNSUPPORTED, ("contact of a rod with itself",))


def test_a_run_that_stops_early_has_diverged(monkeypatch):
    def stops(*_):
        raise ConvergenceError("no step is acceptable", {"time": np.array([0.0, 0.25])})

    monkeypatch.setattr(module, "moved", stops)
    result = scored("cantilever", 2)
    assert (result.outcome, result.failure, result.diverged_at) == (DIVERGED, "no step is acceptable", 0.25)


def test_a_scenario_outside_the_model_is_unsupported(monkeypatch):
    def refuses(*_):
        raise NotImplementedError("an end that turns about more than one axis")

    monkeypatch.setattr(module, "moved", refuses)
    assert scored("cantilever", 2).missing == ("an end that turns about more than one axis",)
