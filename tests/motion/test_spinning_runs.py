"""Beams so thin that their sections spin on a coarse mesh: noted, with a sufficient mesh."""

import re

import funicular as fu
import numpy as np
import pytest

AWAY = 1e-9
"""rad/s: how fast the rope turns out of its plane at the start, about the line of its ends."""


def leaves_its_plane(elements: int) -> tuple[float, list[str]]:
    """Return the displacement out of the plane of a rope of 12 mm with a mass at its end, and the notes on it."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.cable("rope", start=(0, 0, 0), end=(1.5, -0.5, 0), elements=elements, element="beam24", law="structural",
                section=fu.Circle(radius=0.006), material=fu.Material(youngs_modulus=6.7e6, poisson_ratio=0.3,
                                                                     density=5650, damping_time=0.002),
                angular_velocity=AWAY * np.array([1.5, -0.5, 0]) / np.hypot(1.5, 0.5))
    scene.pin("rope", s=0.0)
    scene.rigid_body("A", mass=0.3, inertia=(3e-3, 3e-3, 3e-3), position=(1.5, -0.5, 0))
    scene.joint("spherical", ("rope", np.hypot(1.5, 0.5)), "A")
    run = scene.run(0.95, tol=1e-6, output_step=0.05, integrator="radau", progress=False)
    return float(np.abs(run["rope.nodal_vectors"][..., 0, 2]).max()), run.report["messages"]


def test_sections_that_spin_are_noted_with_the_elements_to_take():
    coarse, messages = leaves_its_plane(2)
    told = [message for message in messages if "sections may spin, and errors may grow" in message]
    assert len(told) == 1 and 'cable "rope"' in told[0]
    longest = float(re.search(r"elements of at most ([\d.]+) m", told[0])[1])
    fine, messages = leaves_its_plane(int(np.ceil(np.hypot(1.5, 0.5) / longest)))
    assert not any("spin" in message for message in messages)
    assert fine < 1e-3 * coarse and fine == pytest.approx(0.0, abs=1e-6)
