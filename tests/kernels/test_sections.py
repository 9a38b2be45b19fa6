"""Sections: moments, torsion constants, shear factors, and refusals."""

import math

import numpy as np
import pytest
from expectations import refused
from funicular import Circle, GeneralSection, Rectangle, SceneError, Tube
from numpy.testing import assert_allclose
from scipy.integrate import dblquad

SECTIONS = [
    (Rectangle(height=0.03, width=0.07), lambda y: 0.035, 0.015),
    (Circle(radius=0.02), lambda y: np.sqrt(0.02**2 - y**2), 0.02),
]


def quadrature(half_width, half_height):
    powers = [(0, 0), (2, 0), (0, 2), (4, 0), (2, 2), (0, 4)]
    return [
        4 * dblquad(lambda z, y, p=p, q=q: y**p * z**q, 0, half_height, 0, half_width, epsabs=0, epsrel=1e-8)[0]
        for p, q in powers
    ]


@pytest.mark.parametrize(("section", "half_width", "half_height"), SECTIONS, ids=lambda x: getattr(x, "shape", ""))
def test_moments_agree_with_quadrature(section, half_width, half_height):
    assert_allclose(section.moments(), quadrature(half_width, half_height), rtol=1e-7)
    assert_allclose(
        [section.area, section.second_moment_about_z, section.second_moment_about_y], section.moments()[:3], rtol=1e-15
    )


def test_a_tube_is_a_disc_less_a_disc():
    tube = Tube(outer_radius=0.02, inner_radius=0.015)
    radius, area = (0.02 + 0.015) / 2, np.pi * (0.02**2 - 0.015**2)
    assert_allclose(tube.moments(), Circle(radius=0.02).moments() - Circle(radius=0.015).moments(), rtol=1e-14)
    assert_allclose(tube.second_moment_about_z, area * (0.02**2 + 0.015**2) / 4, rtol=1e-14)
    assert radius**2 * area / 2 < tube.second_moment_about_z < 1.03 * radius**2 * area / 2  # a thin ring's, nearly


def test_torsion_constant_of_a_square():
    """The series to 30 digits with mpmath; 0.1406 in Timoshenko & Goodier, art. 109."""
    assert_allclose(Rectangle(height=2, width=2).torsion_constant, 0.140577014955153715588 * 16, rtol=1e-15)


def prandtl(short, long, terms):
    """Return 4 ∫ φ dA of Prandtl's function, a double series without hyperbolic functions."""
    n, m = np.meshgrid(*[np.arange(1, 2 * terms, 2.0)] * 2)
    return 256 * short * long / np.pi**6 * np.sum(1 / (n**2 * m**2 * ((n / short) ** 2 + (m / long) ** 2)))


@pytest.mark.parametrize("ratio", [1, 1.7, 10])
def test_torsion_constant_by_another_series(ratio):
    rectangle = Rectangle(height=0.01, width=0.01 * ratio)
    assert_allclose(rectangle.torsion_constant, prandtl(0.01, 0.01 * ratio, 1500), rtol=1e-6)
    assert rectangle.torsion_constant == Rectangle(height=0.01 * ratio, width=0.01).torsion_constant


def test_torsion_constant_of_a_strip():
    """long short³/3 (1 - 0.630 short/long)."""
    assert_allclose(Rectangle(height=1e-6, width=1).torsion_constant, 1e-18 / 3, rtol=1e-6)
    assert_allclose(1 - 3 * Rectangle(height=0.01, width=1).torsion_constant / 1e-6, 0.0063025, rtol=1e-5)


def test_torsion_constant_of_discs_and_rings():
    assert_allclose(Circle(radius=2).torsion_constant, np.pi * 16 / 2, rtol=1e-15)
    assert_allclose(Tube(outer_radius=2, inner_radius=1).torsion_constant, np.pi * (16 - 1) / 2, rtol=1e-15)


def test_shear_factors():
    """Cowper 1966: rectangle 10(1+ν)/(12+11ν), circle 6(1+ν)/(7+6ν), thin ring 2(1+ν)/(4+3ν)."""
    assert Rectangle(height=1, width=2).shear_factors(0.3) == (13 / 15.3, 13 / 15.3)
    assert_allclose(Circle(radius=1).shear_factors(0.3), 7.8 / 8.8, rtol=1e-15)
    assert_allclose(Tube(outer_radius=1, inner_radius=1e-9).shear_factors(0.25), Circle(radius=2).shear_factors(0.25))
    assert_allclose(Tube(outer_radius=1, inner_radius=1 - 1e-9).shear_factors(0.3), 2.6 / 4.9, rtol=1e-8)


def test_data_replaces_what_a_shape_has():
    section = Rectangle(height=1, width=2, torsion_constant=0.3, shear_factors=(0.8, 0.9))
    assert (section.torsion_constant, section.shear_factors(0.3)) == (0.3, (0.8, 0.9))


def test_a_section_by_its_constants():
    section = GeneralSection(area=2, second_moment_about_z=3, torsion_constant=4, shear_factors=(1, 0.5))
    assert (section.area, section.second_moment_about_z, section.second_moment_about_y) == (2, 3, 3)
    assert (section.torsion_constant, section.shear_factors(0.1)) == (4, (1, 0.5))
    assert section.moments()[:3].tolist() == [2, 3, 3] and np.isnan(section.moments()[3:]).all()
    assert GeneralSection(area=2, second_moment_about_z=3, second_moment_about_y=5).second_moment_about_y == 5


@pytest.mark.parametrize(("changes", "complaint"), [
    ({"area": 0}, "area must be positive, got 0 m²"),
    ({"second_moment_about_z": -1}, "second_moment_about_z must not be negative, got -1 m⁴"),
    ({"second_moment_about_y": math.nan}, "second_moment_about_y must be finite, got nan m⁴"),
    ({"torsion_constant": 0}, "torsion_constant must be positive, got 0 m⁴"),
    ({"torsion_constant": 7},
     "torsion_constant must not exceed second_moment_about_z + second_moment_about_y = 6 m⁴, got 7 m⁴"),
    ({"shear_factors": (1, 0)}, "shear_factors must be positive, got (1, 0); give (ky, kz), 1 for no correction"),
    ({"shear_factors": 0.8}, "shear_factors must be 2 numbers, got 0.8"),
    ({"second_moment": 1}, '"second_moment" is not known here; did you mean "second_moment_about_z"?'),
])
def test_general_is_refused(changes, complaint):
    with refused(f"GeneralSection: {complaint}"):
        GeneralSection(**{"area": 2, "second_moment_about_z": 3, "second_moment_about_y": 3} | changes)


def test_what_a_general_section_does_not_know():
    with pytest.raises(SceneError, match=r"^GeneralSection: has no torsion_constant; give it, in m⁴$"):
        _ = GeneralSection(area=2, second_moment_about_z=3).torsion_constant
    with pytest.raises(SceneError, match=r"^GeneralSection: has no shear_factors; give \(ky, kz\)$"):
        GeneralSection(area=2, second_moment_about_z=3).shear_factors(0.3)
