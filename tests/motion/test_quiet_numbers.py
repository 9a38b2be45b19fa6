"""Rounding, rows of zeros and extreme sizes give messages instead of RuntimeWarnings of NumPy."""

from types import MappingProxyType

import funicular as fu
import pytest
from funicular.solve.notes.sensitivity import Sensitivity, sensitive
from numpy.testing import assert_allclose

pytestmark = [pytest.mark.filterwarnings("error::RuntimeWarning"),
              pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")]


def two_lines(elements: int, with_slide: bool) -> fu.Scene:
    """Return two cables, each fixed at both ends; a slide joins the fixed end of one to the end of the other."""
    scene, steel = fu.Scene(gravity=(0, 0, 0)), fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000)
    for name, end in (("wire", (4, 0, 0)), ("rope", (0, 3, 0))):
        scene.cable(name, start=(0, 0, 0), end=end, elements=elements, element="cable8p", material=steel,
                    section=fu.Circle(radius=0.02))
    for name, length in (("wire", 4.0), ("rope", 3.0)):
        scene.pin(name, s=0.0)
        scene.pin(name, s=length)
    if with_slide:
        scene.slide(("rope", 0.0), along="wire", s=0.0, name="end")
    return scene


@pytest.mark.parametrize("elements", [3, 30])
def test_a_slide_between_two_supports_takes_no_mode_away(elements):
    """Its rows are zero and do not count as constraints."""
    with_it, without = (two_lines(elements, each).modes(8).angular_frequency for each in (True, False))
    assert_allclose(with_it, without, rtol=1e-6)


def test_a_cable_that_is_held_everywhere_has_no_modes():
    scene = fu.Scene()
    scene.cable("rope", start=(0, 0, 0), end=(1, 0, 0), elements=1, element="cable18", up=(0, 1, 0),
                section=fu.Rectangle(height=0.01, width=0.01), strain="engineering",
                material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000))
    for s in (0.0, 1.0):
        scene.clamp("rope", s=s, fix="all")
    with pytest.raises(fu.SceneError, match="has 0 degrees of freedom, 2 modes were asked for"):
        scene.modes(2, as_drawn=True)


def test_a_rope_with_hardly_any_bending_is_watched_quietly():
    scene, section = fu.Scene(), fu.GeneralSection(area=1e-4, second_moment_about_z=1e-30)
    scene.cable("rope", start=(0, 0, 0), end=(0, 1, 0), elements=4, element="cable8p", section=section,
                material=fu.Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1000))
    scene.pin("rope", s=0.0)
    assert scene.run(0.01, step=1e-4, output_step=5e-4, progress=False).status == "completed"


def test_errors_that_grow_beyond_all_numbers_are_noted():
    class Engine:
        controlled_motion, absolute_tol, moves = 1.0, 0.0, True
        statistics = MappingProxyType({"sum_of_local_error_estimates_m": 1e-6})

    class Found(Sensitivity):
        worst, cables = (1e4, "rope", 0.5), ()

        def __init__(self):
            pass

    (note,) = sensitive(Engine(), fu.RunSettings(duration=1.0), Found())
    assert "small differences grow" in note
