"""Properties of every scene: a result or a `FunicularError`, finite rows, closed joints, a complete text.

Examples are the same every time. Each scene that failed is a test of its own, in the file of its subject.
"""

import time as clock
import warnings

import funicular as fu
import numpy as np
import pytest
from funicular.errors import FunicularError
from funicular.scene.file import loads
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from random_scenes import scenes, texts

INTEGRATORS = st.sampled_from(["auto", "genalpha", "explicit", "radau", "energy"])
STEPS = st.sampled_from([{"tol": 1e-4}, {"tol": 1e-2}, {"step": 5e-3}, {"step": 2e-4}])
"""Of the scene's time."""


def examples(number: int):
    return settings(max_examples=number, deadline=None, derandomize=True, database=None,
                    suppress_health_check=list(HealthCheck))


class TooLongError(Exception):
    pass


def within(seconds: float):
    """Return a progress function that ends a run after a processor time; the rest of the run is not judged."""
    end = clock.process_time() + seconds

    def progress(time: float) -> None:
        if clock.process_time() > end:
            raise TooLongError

    return progress


def computed(time: float, scene: fu.Scene, integrator: str, steps: dict, initial: str = "drawn",
             seconds: float = 0.3) -> fu.Run | None:
    """Return a run over 0.05 of the scene's time, as far as it goes; None if it is refused or takes too long."""
    steps = {name: value * time if name == "step" else value for name, value in steps.items()}
    try:
        return scene.run(0.05 * time, output_step=0.01 * time, integrator=integrator, initial=initial, **steps,
                         progress=within(seconds))
    except (fu.ConvergenceError, fu.EndOfCableError) as error:
        return error.run
    except (FunicularError, TooLongError):
        return None


def check_run(time: float, scene: fu.Scene, integrator: str, steps: dict, initial: str = "drawn") -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        run = computed(time, scene, integrator, steps, initial)
    if run is None:
        return
    sizes = [cable.length for cable in scene.cables.values()]
    for name in run.keys():
        assert np.isfinite(run[name]).all(), name
        if name.endswith((".position", ".nodal_vectors")):
            sizes.append(float(np.abs(run[name]).max()))
    for name in run.keys():
        if name.endswith(".residual") and run.status != "no_convergence":
            assert np.abs(run[name]).max() <= 1e-6 * max(sizes), name


def check_energy(time: float, scene: fu.Scene, integrator: str, steps: dict) -> None:
    """Check that a run reports an unexplained tenth of the exchanged energy.

    A millionth of the stored energy passes as truncation: a rod that spins freely exchanges none, yet genalpha's steps
    change its kinetic energy by 1.4e-4 to 2e-4 of tol.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        run = computed(time, scene, integrator, steps)
    if run is None or run.status != "completed":
        return
    balance = run.energy_balance()
    beams = [*scene.cables.values(), *(body.mesh for body in scene.bodies.values() if body.kind == "modal_body")]
    truncation = 1e-6 * max(float(np.abs(run[name]).max()) for name in run.keys() if name.startswith("energy."))
    rounding = sum(1e-24 * beam.material.youngs_modulus * beam.section.area * beam.length for beam in beams)
    off = float(np.abs(balance.residual).max())
    assert off <= max(0.1 * balance.exchanged, truncation + rounding) or run.report["messages"]


def check_text(scene: fu.Scene) -> None:
    text = scene.to_toml()
    with warnings.catch_warnings():
        warnings.simplefilter("error", fu.FunicularWarning)  # nothing is left to adjust
        for known in ("rounding of the stiffness", "the corner is too soft"):
            warnings.filterwarnings("ignore", f".*{known}", fu.FunicularWarning)
        assert loads(text, "copy").to_toml() == text


def check_file(text: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        try:
            scene = loads(text, "x.toml")
        except FunicularError as error:
            assert str(error).startswith(("x.toml: ", "x.toml, line "))
            return
    check_text(scene)


def check_statics(scene: fu.Scene) -> None:
    """Check statics with few iterations, and modes: finite results, or an error."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        try:
            assert np.isfinite(scene.modes(2, as_drawn=True).angular_frequency).all()
        except FunicularError:
            pass
        try:
            rest = scene.equilibrium(max_iterations=20)
        except FunicularError:
            return
    for name in rest.keys():
        assert np.isfinite(rest[name]).all(), name


@examples(25)
@given(scenes(), INTEGRATORS, STEPS)
def test_runs(scene, integrator, steps):
    check_run(*scene, integrator, steps)


@examples(30)
@given(scenes())
def test_texts(scene):
    check_text(scene[1])


@examples(50)
@given(texts())
def test_files(text):
    check_file(text)


@pytest.mark.slow
@examples(125)
@given(scenes(), INTEGRATORS, STEPS, st.sampled_from(["drawn", "drawn", "drawn", "drawn", "equilibrium"]))
def test_many_runs(scene, integrator, steps, initial):
    check_run(*scene, integrator, steps, initial)


@pytest.mark.slow
@examples(150)
@given(scenes(spoilt=False), INTEGRATORS, STEPS)
def test_energy(scene, integrator, steps):
    check_energy(*scene, integrator, steps)


@pytest.mark.slow
@examples(300)
@given(scenes())
def test_many_texts(scene):
    check_text(scene[1])


@pytest.mark.slow
@examples(400)
@given(texts())
def test_many_files(text):
    check_file(text)


@pytest.mark.slow
@examples(8)
@given(scenes())
def test_statics(scene):
    check_statics(scene[1])
