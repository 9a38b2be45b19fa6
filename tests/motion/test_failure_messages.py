"""Messages of failures, for any state that a failure leaves."""

from types import SimpleNamespace

import funicular as fu
import numpy as np
import pytest
from funicular.model.build import build
from funicular.model.redundant_constraints import drop_redundant_rows, redundant
from funicular.parts.settings import RunSettings
from funicular.solve.notes.diagnosis import damping, stopped, unexplained


def two_hinges() -> fu.Scene:
    """Return a body between two joints."""
    scene = fu.Scene()
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 0))
    scene.joint("spherical", "A", (0, 0, 0))
    scene.joint("distance", ("A", (1, 0, 0)), (2, 0, 0))
    return scene


def failed(model, S, cause=None, joint=None, integrator="genalpha", dof=0):
    """Return an engine after a failure, with this compliance or without one."""
    def compliance(multipliers):
        if S is None:
            raise ArithmeticError("the mass matrix is singular")
        return np.full((len(multipliers),) * 2, S)

    return SimpleNamespace(compliance=compliance, failure=(cause, dof, joint), time=0.5, integrator=integrator,
                           prepare=lambda: True, statistics={"steps": 3, "smallest_step_s": 1e-9},
                           now=lambda: (0.5, model.q, model.v, np.zeros(0)))


@pytest.mark.parametrize("S", [np.nan, np.inf, 0.0, None])
def test_a_state_without_a_compliance(S):
    """A state that contains NaN gives a message, and no LinAlgError."""
    model = build(two_hinges())
    engine = failed(model, S, "not_finite")
    assert redundant(model, engine) == ""
    said = stopped(model, engine, "no_convergence", RunSettings(duration=1))
    assert said.startswith('no step converged at t = 0.5 s of 1 s after 3 steps down to 1e-09 s: body "A" diverges')


@pytest.mark.parametrize("S", [np.nan, None])
def test_a_start_without_a_compliance(S):
    model = build(two_hinges())
    assert drop_redundant_rows(model, failed(model, S)) == []


def test_a_failure_without_a_cause():
    """The message needs no cause, and names no slide in a scene without one."""
    model = build(two_hinges())
    said = stopped(model, failed(model, 1.0), "no_convergence", RunSettings(duration=1))
    assert said == ("no step could be made at t = 0.5 s of 1 s: to pass an event there it would have to be shorter "
                    "than 1e-12 of the duration; results up to that time are kept. Look at slides, stops and "
                    "events that act at the same instant")


def hung(damping_time=0.0) -> fu.Scene:
    """Return a cable with a rider, a free rigid and a free modal body."""
    material = fu.Material(youngs_modulus=1e7, poisson_ratio=0, density=1000, damping_time=damping_time)
    scene = fu.Scene()
    scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=4, element="cable12", section=fu.Circle(radius=0.01),
                material=material)
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0.5, 0, 0))
    scene.slide("A", along="wire", s=0.5, name="trolley")
    scene.modal_body("arm", start=(0, 1, 0), end=(1, 1, 0), section=fu.Circle(radius=0.01), material=material, modes=2)
    return scene


def dof_of(model, body: str) -> int:
    return next(each.dof for each in model.bodies if each.name == body)


def test_damping_is_advised_by_the_name_that_the_part_has_for_it():
    """A rigid body has no material with damping."""
    for tau, larger in ((0.0, ""), (1e-3, "a larger ")):
        model = build(hung(tau))
        assert damping(model, 0) == damping(model, 0, 0) == f", or {larger}damping_time in the material"
        assert damping(model, dof_of(model, "A")) == ""
        assert damping(model, dof_of(model, "arm")) == ", or a larger damping_ratio of the body"


@pytest.mark.parametrize(("cause", "on", "has", "has_not"), [
    ("error", "A", "try a smaller tol", "damping_time"),
    ("matrix", "A", "Look at its mass and inertia, and at its joints", "elements"),
    ("matrix", "wire", "at up, or take more elements there", "inertia"),
    ("self_locking", "trolley", "Take a smaller coefficient", "damping_time"),
    ("error", "trolley", "damping_time in the material", "coefficient"),
])
def test_the_remedy_is_one_for_the_part_that_fails(cause, on, has, has_not):
    model = build(hung())
    where = {"dof": dof_of(model, "A")} if on == "A" else {"joint": 0} if on == "trolley" else {}
    said = stopped(model, failed(model, np.nan, cause, **where), "no_convergence", RunSettings(duration=1))
    assert has in said and has_not not in said


@pytest.mark.parametrize(("integrator", "step", "other"), [
    ("explicit", None, "radau"), ("explicit", 1e-3, "genalpha"), ("radau", None, None), ("genalpha", 1e-3, None)])
def test_another_integrator_is_advised_where_the_explicit_one_needs_too_small_steps(integrator, step, other):
    """With tol the advice is radau, since genalpha controls the error of positions alone."""
    model = build(two_hinges())
    engine = failed(model, 1.0, integrator=integrator)
    engine.balance = (5.0, 0.0, 1.0, 1.0, 0.0)
    said = stopped(model, engine, "unstable", RunSettings(duration=1, step=step))
    assert [name for name in ("radau", "genalpha") if f'or integrator="{name}"' in said] == [other] * bool(other)


@pytest.mark.parametrize(("integrator", "radius", "advised"), [
    ("genalpha", 0.9, True), ("genalpha", 1.0, False), ("radau", 0.9, False), ("explicit", 0.9, False),
    ("energy", 0.9, False)])  # the last counts what it damps as dissipated
def test_the_spectral_radius_is_advised_where_it_is_what_takes_energy(integrator, radius, advised):
    engine = SimpleNamespace(balance=(0.0, 0.5, 1.0, 1.0, 0.0), integrator=integrator)
    (said,) = unexplained(engine, RunSettings(duration=1, spectral_radius=radius))
    assert ("spectral_radius nearer to 1" in said) == advised and "take a smaller tol" in said


def test_the_engine_names_no_slide_before_anything_failed():
    from funicular.engine import Engine

    assert Engine(build(two_hinges())).failure == (None, 0, None)


def test_a_shape_of_modes_that_there_is_not():
    scene = fu.Scene()
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 0))
    scene.spring("A", (0, 5, 0), stiffness=1)
    with pytest.raises(fu.UnknownResultError, match=r'no shape "A.position"; did you mean "A.rotation"\?'):
        scene.modes(1, as_drawn=True)["A.position"]


def test_energy_that_grows_without_damping_is_told_to_take_some():
    """genalpha with spectral radius 1 may diverge after 100,000 steps; the advice includes damping."""
    model = build(two_hinges())
    engine = failed(model, 1.0)
    engine.balance = (2.0, 0.0, 1.0, 1.0, 0.0)
    said = {radius: stopped(model, engine, "unstable", RunSettings(duration=1, step=1e-3, spectral_radius=radius))
            for radius in (1, 0.9)}
    assert "or a spectral_radius below 1" in said[1]
    assert "spectral_radius" not in said[0.9]


def test_an_absolute_tol_that_is_too_large_is_named():
    """A smaller tol would change nothing."""
    scene = fu.Scene()
    scene.cable("c", start=(0, 0, 0), end=(1, 0, 0), elements=4, element="cable12", section=fu.Circle(radius=0.005),
                material=fu.Material(youngs_modulus=1e6, density=1000, poisson_ratio=0.3))
    scene.pin("c", s=0.0)
    with pytest.raises(fu.ConvergenceError, match="The absolute_tol 1e\\+03 m is too large for integrator"):
        scene.run(0.5, output_step=0.05, tol=1e-4, absolute_tol=1e3, progress=False)
