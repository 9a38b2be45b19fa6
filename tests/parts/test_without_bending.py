"""Cables without bending stiffness: chains and slack ropes."""

import warnings

import funicular as fu
import numpy as np
import pytest

ELEMENTS = "cable12", "cable8p", "cable18"


def chain(element: str, EI: float = 0.0, elements: int = 20) -> fu.Scene:
    """Return a chain of 21 m between two pins 20 m apart."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.cable("w", start=(0, 0, 0), end=(20, -2, 0), rest_length=21, rest="straight", element=element,
                strain="engineering", elements=elements, up=(0, 1, 0) if element == "cable8p" else (0, 0, 1),
                section=fu.GeneralSection(area=1e-4, second_moment_about_z=EI / 1e9),
                material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=3000))
    scene.pin("w", s=0)
    scene.pin("w", s=21)
    return scene


@pytest.mark.parametrize("element", ELEMENTS)
def test_it_is_the_limit_of_cables_that_bend(element):
    """Forces, moments and frequencies at rest, without a division by zero."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        none, little = (chain(element, EI).equilibrium() for EI in (0.0, 1e-7))
        assert np.asarray(none["w@0.force"]) == pytest.approx(np.asarray(little["w@0.force"]), rel=1e-9)
        forces = none.section_forces("w", s=np.linspace(0, 21, 9))
        frequencies = [np.asarray(rest.scene.modes(4, about=rest).frequency) for rest in (none, little)]
    assert not np.any(forces["moment"])
    assert np.asarray(forces["shear"]) == pytest.approx(0, abs=1e-9)
    assert frequencies[0] == pytest.approx(frequencies[1], rel=1e-8)


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit", "energy"])
@pytest.mark.parametrize("element", ELEMENTS)
def test_a_chain_swings_with_its_energy(element, integrator):
    scene = chain(element, elements=8)
    scene.rigid_body("A", mass=0.5, inertia=(1e-2, 1e-2, 1e-2), position=(10, -1.4, 0))
    scene.joint("spherical", ("w", 21 / 2), ("A", (0, 0.4, 0)))
    rest = scene.equilibrium()
    pulled = rest.scene.replace("A", velocity=(1, 0, 0))
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        settings = {"step": 1e-3} if integrator == "energy" else {"tol": 1e-5}
        run = pulled.run(duration=0.2, output_step=0.02, integrator=integrator, initial="equilibrium", **settings)
    energy = sum(np.asarray(run[f"energy.{name}"]) for name in ("kinetic", "elastic", "potential"))
    assert np.ptp(energy) < 1e-3 * 0.25


def test_a_slide_runs_along_a_chain():
    scene, s = chain("cable12"), 6.0
    at = tuple(scene.cables["w"].point(s).tolist())
    scene.rigid_body("A", mass=0.1, inertia=(1e-4, 1e-4, 1e-4), position=at)
    scene.slide("A", along="w", s=s, name="trolley")
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        warnings.simplefilter("ignore", fu.FunicularWarning)
        run = scene.run(duration=0.1, tol=1e-3, output_step=0.02)
    assert run["trolley.s"][-1] != s


def test_beams_need_second_moments():
    with pytest.raises(fu.SceneError, match="has a section without second moments, which beams need"):
        fu.Scene().cable("w", start=(0, 0, 0), end=(1, 0, 0), element="beam24", law="structural", elements=2,
                         section=fu.GeneralSection(area=1e-4, second_moment_about_z=0.0),
                         material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=3000))
