"""A perfectly straight strut that a run compresses beyond its buckling load is noted; other scenes are not."""

import warnings

import numpy as np
import pytest
from funicular import Circle, FunicularWarning, Material, Pulse, Ramp, Scene
from shared_scenes import cable_scene, structural

RADIUS, MODULUS = 1e-3, 1e8
EULER = np.pi**2 * MODULUS * np.pi / 4 * RADIUS**4


def strut(load, element="cable12", *, across=0.0) -> Scene:
    """Return a strut of 1 m between a pin and an axially free pin with a load."""
    scene = cable_scene("strut", pins=(0,), gravity=(0, 0, 0), elements=6, element=element,
                        section=Circle(radius=RADIUS), **structural(element),
                        material=Material(youngs_modulus=MODULUS, poisson_ratio=0, density=1000, damping_time=1e-3))
    scene.rigid_body("head", mass=0.01, inertia=(1e-5, 1e-5, 1e-5), position=(1, 0, 0))
    scene.joint("spherical", ("strut", 1.0), "head")
    scene.joint("prismatic", (1, 0, 0), "head", axis=(1, 0, 0))
    scene.force("head", value=(-1, 0, 0), scale=load)
    if across:
        scene.force("strut", s=0.5, value=(0, across, 0))
    return scene


@pytest.mark.parametrize("element", ["cable12", "cable8p", "beam24"])
def test_noted_with_the_remedy(element):
    with pytest.warns(FunicularWarning, match='cable "strut" is perfectly straight at t = .* s under a compression of '
                                              ".* N, beyond its buckling load .*Draw it slightly bent, or add"):
        run = strut(Ramp(start=0, end=0.02, after=40 * EULER), element).run(0.03, tol=1e-3)
    assert any("perfectly straight" in note for note in run.report["messages"])
    assert np.ptp(run["strut.position"][..., 1]) == 0


@pytest.mark.parametrize("scene", [strut(Ramp(start=0, end=0.02, after=0.5 * EULER)),
                                   strut(Ramp(start=0, end=0.02, after=40 * EULER), across=1e-6),
                                   strut(Ramp(start=0, end=0.02, after=-40 * EULER))], ids=["below", "bent", "pulled"])
def test_not_noted(scene):
    with warnings.catch_warnings():
        warnings.simplefilter("error", FunicularWarning)
        scene.run(0.03, tol=1e-3)


def test_a_load_that_is_gone_at_the_end_is_noted_too():
    with pytest.warns(FunicularWarning, match="perfectly straight"):
        strut(Pulse(start=0, end=0.02, height=40 * EULER)).run(0.04, tol=1e-3)


def test_a_bar_that_heat_compresses_is_noted():
    scene = cable_scene("strut", pins=(0, 1), gravity=(0, 0, 0), elements=6, section=Circle(radius=RADIUS),
                        temperature=Ramp(start=0, end=0.02, before=0.0, after=100.0), material=Material(
                            youngs_modulus=MODULUS, poisson_ratio=0, density=1000, thermal_expansion=1e-4))
    with pytest.warns(FunicularWarning, match=f"compression of {MODULUS * np.pi * RADIUS**2 * 1e-2 / 1.01:.2g}"):
        scene.run(0.03, tol=1e-3)


def test_positions_of_nodes_by_name(tmp_path):
    """The same name in an equilibrium, in a run, and in a file."""
    from funicular import load_run

    scene = strut(0.1 * EULER)
    rest, run = scene.equilibrium(), scene.run(0.01, tol=1e-3)
    assert rest["strut.position"].shape == (7, 3)
    np.testing.assert_array_equal(run["strut.position"], run["strut.nodal_vectors"][:, :, 0])
    assert "strut.position" in run
    run.save(tmp_path / "run.nc")
    np.testing.assert_array_equal(load_run(tmp_path / "run.nc")["strut.position"], run["strut.position"])


def test_a_slack_cable_that_its_weight_bends_is_not_noted():
    """Drawn straight, it is compressed beyond its buckling load at the start, and bent from the next output on."""
    scene = Scene()
    scene.cable("rope", start=(0, 0, 0), end=(10, 0, 0), elements=8, element="cable12", rest_length=10.2,
                section=Circle(radius=0.01), material=Material(youngs_modulus=1e8, poisson_ratio=0, density=7850))
    scene.pin("rope", s=0)
    scene.pin("rope", s=10.2)
    run = scene.run(0.05, tol=1e-3)
    assert not any("straight" in note for note in run.report["messages"])
