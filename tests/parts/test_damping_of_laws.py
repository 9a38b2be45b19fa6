"""Kelvin-Voigt damping of every law in the results of a run: section forces, pages, plots, loaded files."""

import numpy as np
import pytest
from funicular import Circle, Material, Scene, load_run
from funicular.derive.catalogue import families
from funicular.kernels.elements import built_in
from funicular.parts.cable_laws import possible_laws
from numpy.testing import assert_allclose
from shared_scenes import section_of

DAMPED = Material(youngs_modulus=1e7, poisson_ratio=0.0, density=1000, damping_time=5e-3)
EVERY = [(element, law, drawn) for element, kind in built_in().items() for law in possible_laws(kind)
         for drawn in ("straight", "curved") if drawn == "straight" or kind.law_for_curved_shape(law)]


def swinging(element: str, law: str, drawn: str) -> Scene:
    scene = Scene(gravity=(0, -9.81, 0))
    shape = {"start": (0, 0, 0), "end": (1, 0, 0)} if drawn == "straight" else {
        "points": [(0, 0, 0), (0.5, 0.1, 0), (1, 0, 0)]}
    wire = scene.cable("wire", **shape, elements=3, element=element, law=law,
                       section=section_of(law, Circle(radius=0.01)), material=DAMPED)
    scene.pin(wire, s=0)
    scene.force(wire, s=wire.length, value=(20, 0, 0))
    return scene


@pytest.mark.parametrize(("element", "law", "drawn"), EVERY)
def test_section_forces_at_a_support_are_its_reaction(element, law, drawn):
    """The engine computes the reaction; the results compute the section force by the kernels of the law."""
    run = swinging(element, law, drawn).run(duration=0.02, tol=1e-3, output_step=0.01)
    forces = run.section_forces("wire", [0.0])
    reaction = run["wire@0.force"][1:]
    assert_allclose(forces["force"].values[1:, 0], -reaction, atol=1e-7 * np.abs(reaction).max())


def test_results_take_the_kernels_that_the_engine_takes():
    """The tables of the engine come from the families of `derive`, the names of results from the manifest."""
    laws = [family for family in families().values() if family.role == "law"]
    assert len(laws) == sum(len(kind.laws) for kind in built_in().values())
    for family in laws:
        kind = built_in()[family.element.name]
        for kernel in {"elastic_force", "damping_force", "damping_tangent", "dissipation", *family.shared}:
            assert kind.law_kernel(family.element.name, family.law, kernel) == family.kernel(kernel)


def test_pages_and_files_of_a_law_without_a_damping_kernel_of_its_own(tmp_path):
    run = swinging("cable12", "green_linear", "straight").run(duration=0.02, tol=1e-3, output_step=0.01)
    run.save_html(tmp_path / "page.html")
    run.plot("forces-wire")
    run.save(tmp_path / "run.nc")
    assert_allclose(load_run(tmp_path / "run.nc").section_forces("wire")["tension"],
                    run.section_forces("wire")["tension"])
