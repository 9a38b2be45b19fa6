"""What is said of a failure, whatever state it left."""

from types import SimpleNamespace

import funicular as fu
import numpy as np
import pytest
from funicular.model.build import build
from funicular.model.redundant_constraints import redundant, settle
from funicular.parts.settings import RunSettings
from funicular.solve.diagnosis import stopped


def two_hinges() -> fu.Scene:
    """A body between two joints."""
    scene = fu.Scene()
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 0))
    scene.joint("spherical", "A", (0, 0, 0))
    scene.joint("distance", ("A", (1, 0, 0)), (2, 0, 0))
    return scene


def failed(model, S, cause=None, joint=None):
    """An engine after a failure: with this compliance, or none if it is None."""
    def compliance():
        if S is None:
            raise ArithmeticError("the mass matrix is singular")
        return np.full((model.n_multipliers,) * 2, S)

    return SimpleNamespace(compliance=compliance, failure=(cause, 0, joint), time=0.5, integrator="genalpha",
                           prepare=lambda: True, statistics={"steps": 3, "smallest_step_s": 1e-9},
                           now=lambda: (0.5, model.q, model.v, np.zeros(0)))


@pytest.mark.parametrize("S", [np.nan, np.inf, 0.0, None])
def test_a_state_without_a_compliance(S):
    """A state that had become NaN ended in a LinAlgError."""
    model = build(two_hinges())
    engine = failed(model, S, "not_finite")
    assert redundant(model, engine) == ""
    said = stopped(model, engine, "no_convergence", RunSettings(duration=1))
    assert said.startswith('no step converged at t = 0.5 s of 1 s after 3 steps down to 1e-09 s: body "A" runs away')


@pytest.mark.parametrize("S", [np.nan, None])
def test_a_start_without_a_compliance(S):
    model = build(two_hinges())
    assert settle(model, failed(model, S)) == []


def test_a_failure_without_a_cause():
    """It ended in a KeyError, or named a slide that there was not."""
    model = build(two_hinges())
    said = stopped(model, failed(model, 1.0), "no_convergence", RunSettings(duration=1))
    assert said == ("no step could be made at t = 0.5 s of 1 s: to pass an event there it would have to be shorter "
                    "than 1e-12 of the duration; what was computed up to there is kept. Look at slides, stops and "
                    "events that act at the same instant")


def test_the_engine_names_no_slide_before_anything_failed():
    from funicular.engine import Engine

    assert Engine(build(two_hinges())).failure == (None, 0, None)


def test_a_shape_of_modes_that_there_is_not():
    scene = fu.Scene()
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 0))
    scene.spring("A", (0, 5, 0), stiffness=1)
    with pytest.raises(fu.UnknownResultError, match=r'no shape "A.position"; did you mean "A.rotation"\?'):
        scene.modes(1)["A.position"]
