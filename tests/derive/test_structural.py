"""The structural law of one element. tests/parts/test_cases.py has published cases of beams."""

import funicular as fu
import numpy as np
import pytest
from funicular.derive.elements import ELEMENTS
from funicular.derive.verify.samples.shapes import reference, rotation
from funicular.generated import kernels


def rectangle(E, nu, height, width, dim, torsion=None):
    """Return S of a rectangle with Cowper's shear factor."""
    area, EIz, EIy = height * width, E * width * height**3 / 12, E * height * width**3 / 12
    G = E / (2 * (1 + nu))
    GA = G * area * 10 * (1 + nu) / (12 + 11 * nu)
    if dim == 2:
        return np.array([E * area, GA, EIz, E * area])
    return np.array([E * area, GA, GA, G * (EIy + EIz) / E if torsion is None else G * torsion, EIy, EIz,
                     E * area, E * area, G * area, 0])


def arc(radius, angle, n):
    turn = np.linspace(0, angle, n + 1)
    s, c, zero = np.sin(turn), np.cos(turn), 0 * turn
    return np.stack([np.stack([radius * s, radius * (1 - c), zero], 1), np.stack([c, s, zero], 1),
                     np.stack([-s, c, zero], 1), np.stack([zero, zero, zero + 1], 1)], axis=1)


@pytest.mark.parametrize("name", ["beam12p", "beam24"])
def test_only_rigid_motions_cost_nothing(name):
    """Straight or bent, the element has six zero eigenvalues, its rigid motions: no hourglass modes."""
    element = ELEMENTS[name]
    dim, random = element.dim, np.random.default_rng(5)
    rigid = dim * (dim + 1) // 2
    for bend in (0.0, 0.3):
        e = reference(element, 0.8)
        e[element.n_vectors // 2 :] @= rotation(random, dim, bend).T
        e[element.n_vectors // 2 :][0] = reference(element, 0.8)[element.n_vectors // 2]
        S = rectangle(1.0, 0.3, 1.0, 1.0, dim)
        A = getattr(kernels, f"{name}_structural_stiffness")(0.8, e, S)
        K = getattr(kernels, f"{name}_structural_elastic_tangent")(0.8, e, A)
        values = np.linalg.eigvalsh(K)
        assert np.abs(values[:rigid]).max() < 1e-14
        assert values[rigid] > 1e-3


def test_a_curved_rest_shape_turns_without_force():
    nodes = arc(1.0, 0.9, 2)[:2].reshape(8, 3)
    S = rectangle(1.0, 0.3, 0.5, 0.3, 3)
    A = kernels.beam24_structural_stiffness(0.45, nodes, S)
    e = nodes @ rotation(np.random.default_rng(2), 3).T
    assert np.abs(kernels.beam24_structural_elastic_force(0.45, e, A)).max() < 1e-15


def test_twist_meets_the_torsion_constant():
    """The moment of an end turned by an angle is G J angle / l, up to the rational approximation of the arctangent."""
    S, angle = rectangle(1.0, 0.25, 0.5, 0.3, 3, torsion=0.02), 0.3
    e = reference(ELEMENTS["beam24"], 0.8)
    A = kernels.beam24_structural_stiffness(0.8, e, S)
    e[6:8, 1:] = [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]
    U = kernels.beam24_structural_energy(0.8, e, A)[0]
    assert U == pytest.approx(0.4 * 0.02 * angle**2 / 2 / 0.8, rel=1e-7)


def test_the_planar_beam_is_the_spatial_one_in_a_plane():
    flat, space = (reference(ELEMENTS[name], 0.7) for name in ("beam12p", "beam24"))
    bent = flat + np.random.default_rng(4).normal(size=flat.shape) * 0.1
    space[[0, 1, 2, 4, 5, 6], :2] = bent
    f = kernels.beam12p_structural_elastic_force(
        0.7, bent, kernels.beam12p_structural_stiffness(0.7, flat, rectangle(1.0, 0.3, 0.5, 0.4, 2)))
    spatial = kernels.beam24_structural_elastic_force(0.7, space, kernels.beam24_structural_stiffness(
        0.7, reference(ELEMENTS["beam24"], 0.7), rectangle(1.0, 0.3, 0.5, 0.4, 3)))
    np.testing.assert_allclose(spatial[[0, 1, 2, 4, 5, 6], :2], f, rtol=1e-13, atol=1e-15)
    np.testing.assert_allclose(spatial[:, 2], 0, atol=1e-16)
    np.testing.assert_allclose(spatial[[3, 7]], 0, atol=1e-16)


@pytest.mark.parametrize("slenderness", [1, 1e1, 1e2, 1e4, 1e6])
@pytest.mark.parametrize("name", ["beam12p", "beam24"])
def test_a_taut_element_is_stable(name, slenderness):
    """slenderness: T l^2/EI. Translations and rotation about the axis alone have no stiffness."""
    element, length, strain = ELEMENTS[name], 0.7, 1e-3
    S = rectangle(1.0, 0.3, 1.0, 1.0, element.dim)
    S[slice(2, 3) if element.dim == 2 else slice(3, 6)] = bending = strain * length**2 / slenderness
    rest = reference(element, length)
    A = getattr(kernels, f"{name}_structural_stiffness")(length, rest, S)
    taut = rest * np.array([1 + strain, *np.ones(element.dim - 1)])
    values = np.linalg.eigvalsh(getattr(kernels, f"{name}_structural_elastic_tangent")(length, taut, A))
    free = 2 * element.dim - 2
    assert np.abs(values[:free]).max() < 1e-14
    assert values[free] > 0.1 * bending


@pytest.mark.parametrize("name", ["beam12p", "beam24"])
def test_frequencies_of_a_taut_beam_are_those_of_a_string(name):
    """T l^2/EI 1e5 with 4 elements."""
    strain, k, each = 1e-2, np.pi * np.arange(1, 4), 2 if name == "beam24" else 1
    height = np.sqrt(12 * strain / 16e5)
    string = k * np.sqrt(strain / (1 + strain) + height**2 / 12 * (k / (1 + strain)) ** 2)  # its bending is 1e-5 of it
    error = []
    for elements in (4, 8):
        scene = fu.Scene(gravity=(0, 0, 0))
        scene.cable("string", start=(0, 0, 0), end=(1 + strain, 0, 0), rest_length=1.0, elements=elements, element=name,
                    law="structural", section=fu.Rectangle(height=height, width=height),
                    material=fu.Material(youngs_modulus=1 / height**2, poisson_ratio=0, density=1 / height**2))
        scene.pin("string", s=0)
        scene.pin("string", s=1.0)
        modes = scene.modes(3 * each + (name == "beam24"))  # it is free to turn about its axis
        assert modes.growth_rate.max() < 1e-6
        error.append(np.abs(modes.angular_frequency[-3 * each :: each] / string - 1))
    assert error[0].max() < 2e-3
    assert error[1].max() < 3e-5


@pytest.mark.parametrize("name", ["beam12p", "beam24"])
def test_a_chord_does_not_turn_back(name):
    """A slender element that is turned against its ends bends further; it has no equilibrium with the chord reversed.
    """
    element, half = ELEMENTS[name], ELEMENTS[name].n_vectors // 2
    S = rectangle(1.0, 0.3, 1.0, 1.0, element.dim)
    S[slice(2, 3) if element.dim == 2 else slice(3, 6)] = 1e-6
    bent = reference(element, 1.0)
    A = getattr(kernels, f"{name}_structural_stiffness")(1.0, bent, S)
    energies = []
    for angle in np.radians([10, 50, 90, 130, 170, 179]):
        half_way = np.cos(angle), np.sqrt(5 / 4) * np.sin(angle)  # r_x, as long as before on the mean of the element
        bent[half, :2] = (half_way + 0.5 * bent[1, :2]) / 1.5
        energies.append(getattr(kernels, f"{name}_structural_energy")(1.0, bent, A)[0])
    assert (np.diff(energies) > 0).all()
