"""The time loop flushes subnormal numbers to zero in all its threads; other code does not."""

import platform

import funicular as fu
import numpy as np
import pytest
from shared_scenes import cable_scene

SUBNORMAL_VELOCITY = 1e-310
FLUSHED = pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="others take them as they are")


def drifting() -> fu.Scene:
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=1.0, inertia=(1.0, 1.0, 1.0), position=(0, 0, 0), velocity=(SUBNORMAL_VELOCITY, 1.0, 0))
    return scene


@FLUSHED
@pytest.mark.parametrize("integrator", ["genalpha", "explicit"])
def test_they_are_zero_in_a_run(integrator):
    run = drifting().run(0.1, step=0.01, integrator=integrator, progress=False)
    velocity = np.asarray(run["A.velocity"])
    assert velocity[-1].tolist() == pytest.approx([0.0, 1.0, 0.0], abs=1e-12)
    assert velocity[-1][0] == 0.0


def test_they_stay_in_functions_of_events_and_after_a_run():
    seen = []

    def watch(time, state):
        seen.append(np.float64(SUBNORMAL_VELOCITY) * 0.5)
        return 1.0

    scene = drifting()
    scene.event("none", function=watch)
    scene.run(0.1, step=0.01, integrator="genalpha", progress=False)
    assert len(seen) > 10
    assert set(seen) == {np.float64(SUBNORMAL_VELOCITY) * 0.5}
    assert min(seen) > 0.0


@FLUSHED
def test_they_are_zero_in_all_threads(monkeypatch):
    """A long rope is pushed at its end; the motion decays along it."""
    monkeypatch.setattr("funicular.solve.linear.threads.available", lambda: 2)
    soft = fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000)
    scene = cable_scene("rope", elements=1000, element="cable12", gravity=(0, 0, 0), length=100.0,
                        section=fu.Circle(radius=0.01), material=soft)
    scene.force("rope", s=0.0, value=(0, 1.0, 0))
    runs = [scene.run(3e-5, step=1e-5, output_step=1e-5, integrator="genalpha", threads=threads, progress=False)
            for threads in (1, 2)]
    assert runs[0]["rope.nodal_velocity"].tobytes() == runs[1]["rope.nodal_velocity"].tobytes()
    sizes = np.abs(runs[1]["rope.nodal_velocity"])
    assert np.all((sizes == 0.0) | (sizes >= np.finfo(float).tiny))
