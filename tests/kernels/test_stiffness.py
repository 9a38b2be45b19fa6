"""Laws with a modified stiffness of the section, against published cases."""

import numpy as np
import pytest
from funicular import GeneralSection, Material, Rectangle
from funicular.generated import kernels
from funicular.parts.section_stiffness import section_stiffness

TORSION = 0.1406e-4  # m^4
STEEL = Material(youngs_modulus=210e9, poisson_ratio=0.3, density=7850)
SQUARE = Rectangle(height=0.1, width=0.1, torsion_constant=TORSION)


def straight(length=1.0):
    e = np.zeros((8, 3))
    e[4, 0] = length
    e[1:4] = e[5:8] = np.eye(3)
    return e


def poisson_split():
    return kernels.beam24_continuum_stiffness(
        1.0, section_stiffness("poisson_split", SQUARE, STEEL))


def test_poisson_split_as_published():
    """Case E1 of tests/benchmarks/published: node 2 moved by 1 mm in z; force on node 1 in x and z, and none in y."""
    e = straight()
    e[4, 2] = 0.001
    f = kernels.beam24_continuum_elastic_force(1.0, e, poisson_split())
    rounding = 4 * np.finfo(float).eps * 210e9 * 0.01  # of E A
    np.testing.assert_allclose(-f[0], [2180.76923076923, 0, 823532.319457014], rtol=1e-14, atol=rounding)


def test_poisson_split_stretches_with_free_sides_as_youngs_modulus_says():
    """F = diag(1 + a, 1 - nu a, 1 - nu a): to second order 1/2 E A a^2 l."""
    a = 1e-6
    e = straight() @ np.diag([1 + a, 1 - 0.3 * a, 1 - 0.3 * a])
    U = kernels.beam24_continuum_energy(1.0, e, poisson_split())[0]
    assert U == pytest.approx(210e9 * 0.01 * a**2 / 2, rel=1e-5)


@pytest.mark.parametrize(("rate", "stiffness"), [
    # r_y, r_z rotate about the axis; r_z or r_y tilts with the rigid section: pure bending, no Poisson effect
    ("twist", 210e9 / 2.6 * TORSION), ("bend", 210e9 * 0.1**4 / 12)])
def test_poisson_split_twists_and_bends_as_a_beam(rate, stiffness):
    """A rate of rotation k: 1/2 S k^2 l to second order, with torsion G J, and bending EI of a plane section."""
    k, e = 1e-5, straight()
    if rate == "twist":
        e[6:8] += k * np.array([[0, 0, 1], [0, -1, 0]])
    else:  # a parabola, y = k x^2/2: r_x and r_y turn by k x
        e[4, 1], e[5, 1], e[6, 0] = k / 2, k, -k
    U = kernels.beam24_continuum_energy(1.0, e, poisson_split())[0]
    assert U == pytest.approx(stiffness * k**2 / 2, rel=1e-4)


def test_planar_continuum_is_of_plane_stress():
    """The lateral strain is free: E A a^2/2 l."""
    a, section = 1e-6, SQUARE
    for law in ("continuum", "poisson_split"):
        A = kernels.beam12p_continuum_stiffness(1.0, section_stiffness(law, section, STEEL, dim=2))
        e = np.array([[0, 0], [1, 0], [0, 1], [1, 0], [1, 0], [0, 1]]) @ np.diag([1 + a, 1 - 0.3 * a])
        U = kernels.beam12p_continuum_energy(1.0, e, A)[0]
        assert U == pytest.approx(210e9 * section.area * a**2 / 2, rel=1e-5)


def test_cables_take_axial_and_bending_stiffness():
    S = section_stiffness("green_exact", Rectangle(height=0.1, width=0.2), STEEL)
    np.testing.assert_allclose(S, [210e9 * 0.02, 210e9 * 0.2 * 0.1**3 / 12], rtol=1e-15)


def test_structural_beams_take_what_the_section_says():
    """∫z²dA is the second moment of bending about y, ∫y²dA of bending about z."""
    section = GeneralSection(area=2, second_moment_about_z=3, second_moment_about_y=4, torsion_constant=5,
                             shear_factors=(0.5, 0.6), torque_per_tension=0.1)
    material = Material(youngs_modulus=26, poisson_ratio=0.3, density=1)  # G = 10
    S = section_stiffness("structural", section, material)
    np.testing.assert_allclose(S, [52, 10, 12, 50, 104, 78, 52, 52, 20, 5.2], rtol=1e-14)
    np.testing.assert_allclose(section_stiffness("structural", section, material, dim=2), [52, 10, 78, 52], rtol=1e-14)
