"""Prescribed motions that begin slowly: the permitted error of first steps, with hardly any motion yet."""

import funicular as fu
import numpy as np


def heaved() -> fu.Scene:
    """Return a hanging line in water whose end heaves with an amplitude that grows for 6 s."""
    scene = fu.Scene()
    scene.cable("line", start=(0, 0, 0), end=(8, -2, 0), shape="hanging", rest_length=10, elements=6,
                element="cable8p", strain="engineering", section=fu.Circle(radius=0.01),
                material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=2000))
    scene.pin("line", s=10)
    t = np.linspace(0, 9, 181)
    x = np.clip(t / 6, 0, 1)
    heave = 0.3 * x**3 * (10 - 15 * x + 6 * x**2) * np.sin(2 * np.pi * t / 3)
    scene.motion("line", s=0, displacement=[0.0, fu.TableSignal(time=t, value=heave), 0.0])
    scene.fluid("sea", density=1000.0)
    scene.drag("line", normal=1.2, tangential=0.0, diameter=0.02)
    return scene


def test_the_first_instants_do_not_take_most_steps():
    scene, tol = heaved(), 1e-4
    rest = scene.equilibrium()
    precise, run = (scene.run(9, output_step=0.1, initial=rest, integrator="radau", tol=each)
                    for each in (tol / 100, tol))
    r, expected = run["line.position"], precise["line.position"]
    error = np.linalg.norm(r - expected, axis=2).max(axis=1) / np.linalg.norm(expected - expected[0], axis=2).max()
    assert error.max() < tol
    assert error[:10].max() < 0.1 * tol
    assert run.report["steps"] < 400
