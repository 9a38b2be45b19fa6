"""Beams so thin that their sections spin in an equilibrium of a coarse mesh: refused, with a sufficient mesh."""

import re

import funicular as fu
import numpy as np
import pytest


def rope(elements: int) -> fu.Scene:
    """Return a rope of 10 mm and 120 m over 100 m, 10 N/m."""
    area = np.pi * 0.01**2 / 4
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.cable("rope", start=(0, 0, 0), end=(100, 0, 0), shape="hanging", rest="straight", rest_length=120,
                elements=elements, element="beam24", law="structural", section=fu.Circle(radius=0.005),
                material=fu.Material(youngs_modulus=1e6 / area, poisson_ratio=0, density=10 / 9.81 / area))
    scene.pin("rope", s=0)
    scene.pin("rope", s=120)
    return scene


def test_the_error_names_the_elements_to_take():
    told = 'sections of cable "rope" spin in it while its axis rests: elements of 15 m are too long'
    with pytest.raises(fu.EquilibriumError, match=told) as refused:
        rope(8).equilibrium()
    longest = float(re.search(r"at most ([\d.]+) m", str(refused.value))[1])
    state = rope(int(np.ceil(120 / longest))).equilibrium()
    assert state.stable
    assert abs(state["rope@0.force"][0]) == pytest.approx(468.53, rel=1e-4)  # elastic catenary, closed form
