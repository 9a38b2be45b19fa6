"""The search for near pairs skips far ones only: runs with and without it agree in all bits."""

import warnings

import funicular as fu
import numpy as np
import pytest
from funicular.model import contacts, hulls

SOFT = {"element": "cable12", "section": fu.Circle(radius=0.02),
        "material": fu.Material(youngs_modulus=2e7, poisson_ratio=0, density=1000)}
INTEGRATORS = {"genalpha": {"tol": 1e-3}, "radau": {"tol": 1e-3}, "explicit": {"tol": 1e-3}, "energy": {"step": 1e-3}}


def crowd(seed: int, speed: float) -> fu.Scene:
    """Return bodies in flight, spinning, with cables that fall and cross, over surfaces at rest and on two bodies."""
    rng, scene = np.random.default_rng(seed), fu.Scene(gravity=(0, -9.81, 0))
    for k in range(6):
        scene.rigid_body(f"body{k}", mass=1 + rng.random(), inertia=(1e-2, 2e-2, 1.5e-2),
                         position=(1.2 * k, 1.2 + rng.random(), 1 + rng.random() / 2),
                         velocity=tuple(speed * rng.normal(size=3)), angular_velocity=tuple(8 * rng.normal(size=3)))
    for name, start, end in (("upper", (0, 2.5, -2), (6, 2.5, -2)), ("middle", (0, 1.5, -1), (6, 1.5, -1)),
                             ("lower", (3, 0.4, -3), (3, 0.4, 2))):
        scene.cable(name, start=start, end=end, elements=4, **SOFT)
        scene.pin(name, s=0)
    scene.surface("ground", fu.Plane(point=(0, 0, 0)))
    scene.surface("ball", fu.Sphere(radius=0.3, at=(4.1, 0.3, 0)))
    scene.surface("flying", fu.Sphere(radius=0.15, at=(0.2, 0, 0)), on="body0")
    scene.surface("turning", fu.Box(size=(0.4, 0.1, 0.2), at=(0.1, 0, 0)), on="body3")
    scene.contact("all", "all", stiffness=3e4, radius=0.05, friction=0.3 if seed % 2 else None)
    scene.crossing("upper", "lower", stiffness=1e4)
    scene.crossing("middle", "lower", stiffness=1e4)
    return scene


def rows(scene: fu.Scene, integrator: str) -> dict[str, bytes]:
    """Return the bytes of all results and events of a run."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        run = scene.run(0.5, output_step=0.05, integrator=integrator, **INTEGRATORS[integrator])
    found = {name: run[name].tobytes() for name in ["time", *run.keys()]}
    return found | {"steps": str(run.report["steps"]).encode(), "events": str(run.events).encode()}


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize(("seed", "speed"), [(0, 3.0), (1, 3.0), (2, 30.0), (3, 0.1)])
def test_search_keeps_every_bit(monkeypatch, integrator, seed, speed):
    """Without bounds of their motion, no pair counts as far."""
    found = rows(crowd(seed, speed), integrator)
    on_body = contacts._on_body
    monkeypatch.setattr(hulls.Hull, "share", None)
    monkeypatch.setattr(contacts, "_on_body",
                        lambda *given: (on_body(*given)[0], np.array([np.inf]), on_body(*given)[2]))
    assert rows(crowd(seed, speed), integrator) == found
