"""Derivatives of the forces of a cable by length, section and material, against differences, for each law."""

import funicular as fu
import numpy as np
import pytest
from funicular.kernels.libraries import of_library
from funicular.model.cables import arrays_of
from funicular.parts.cable_laws import possible_laws
from funicular.parts.in_plane import in_plane
from funicular.solve.adjustment.cable_changes import Own, by_length, elastic_force, same_points
from shared_scenes import section_of

LAWS = [(element, law) for element, kind in of_library(None).items() for law in possible_laws(kind)]
MATERIAL = fu.Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1500.0)
BOW = (0, 0, 0), (1, 0.3, 0), (2, 0.4, 0), (3, 0.3, 0), (4, 0.0, 0)


def cable_of(element, law, stretch, shape=None):
    """Return a cable, stretched as it is drawn."""
    place = {"start": (0, 0, 0), "end": (4, 0.3, 0)} if shape is None else {"points": shape}
    given = {**place, "elements": 5, "element": element, "law": law,
             "section": section_of(law, fu.Circle(radius=0.01)), "material": MATERIAL}
    drawn = fu.Scene().cable("wire", **given).length
    scene = fu.Scene()
    scene.cable("wire", **given, rest_length=drawn / stretch)
    return in_plane(scene).cables["wire"]


def disturbed(cable, size):
    """Return the model of a cable, and its coordinates with perturbed vectors."""
    model, random = arrays_of(cable).model(0), np.random.default_rng(1)
    q = cable.nodal_vectors[..., : model.shape[2]]
    return model, (q + size * random.standard_normal(q.shape)).ravel()


def differenced(of, step):
    """Return the derivative of a function at 1 by fourth-order differences."""
    near, far = ((of(1 + h) - of(1 - h)) / (2 * h) for h in (step, 2 * step))
    return (4 * near - far) / 3


def with_length(cable, model, q, ratio):
    """Return the forces on positions, and on slopes times the length, of a longer cable with unchanged positions."""
    factors = {"r_x": 1 / ratio, "r_xx": 1 / ratio**2}
    each = np.broadcast_to(np.array([[factors.get(name, 1.0)] for name in model.vectors]), model.shape).ravel()
    longer = arrays_of(cable.remade({"rest_length": ratio * cable.length})).model(0)
    return each * elastic_force(longer, longer.A, each * q)


@pytest.mark.parametrize("stretch", [1.01, 0.99], ids=["stretched", "compressed"])
@pytest.mark.parametrize(("element", "law"), LAWS)
def test_forces_change_with_the_length_as_their_differences_do(element, law, stretch):
    cable = cable_of(element, law, stretch)
    model, q = disturbed(cable, 2e-3)
    step = 1e-5 if cable.traits.membrane == "tension_only" else 1e-4
    wanted = differenced(lambda ratio: with_length(cable, model, q, ratio), step)
    assert np.abs(by_length(model, cable, q) - wanted).max() < 2e-9 * np.abs(wanted).max()


@pytest.mark.parametrize(("element", "law"), [
    ("beam24", "continuum"), ("beam24", "structural"), ("beam12p", "poisson_split"), ("beam12p", "structural"),
    ("cable12", "green_exact"), ("cable12", "engineering_exact")])
def test_so_they_do_where_the_shape_without_stress_is_curved(element, law):
    cable = cable_of(element, law, 1.01, BOW)
    assert cable.is_curved
    model, q = disturbed(cable, 2e-3)
    wanted = differenced(lambda ratio: with_length(cable, model, q, ratio), 1e-4)
    assert np.abs(by_length(model, cable, q) - wanted).max() < 5e-9 * np.abs(wanted).max()


@pytest.mark.parametrize("strain", [5e-7, 0.0, -3e-7])
@pytest.mark.parametrize("element", ["cable12", "cable8p"])
def test_so_they_do_where_a_cable_just_becomes_slack(element, strain):
    cable = cable_of(element, "engineering_exact_tension_only", 1 + strain)
    model, q = disturbed(cable, 2e-8)
    found = by_length(model, cable, q)
    near, far = (differenced(lambda ratio: with_length(cable, model, q, ratio), step) for step in (1e-8, 1e-4))
    assert np.abs(found - near).max() < 1e-6 * np.abs(near).max()
    assert np.abs(found - far).max() > 0.01 * np.abs(far).max()  # of steps beyond the strain at which it becomes slack


@pytest.mark.parametrize(("element", "law"), [of for of in LAWS if not of[1].endswith("tabulated")])
def test_forces_are_linear_in_youngs_modulus(element, law):
    """At a given Poisson ratio this holds for every law, so that no short step is needed."""
    cable = cable_of(element, law, 1.01)
    model, q = disturbed(cable, 2e-3)
    own = Own(model, q, np.zeros(model.shape[2]))
    one, two = (own.of(cable.remade({"material": MATERIAL.remade({"youngs_modulus": E})})) for E in (1e7, 2e7))
    assert np.abs(two - 2 * one).max() < 1e-13 * np.abs(two).max()


def test_points_stay_where_they_are_as_slopes_follow_the_length():
    cable = cable_of("cable18", "green_exact", 1.01)
    model, q = disturbed(cable, 2e-3)
    vectors, changed = q.reshape(model.shape), same_points(model, q).reshape(model.shape)
    assert np.array_equal(changed, -vectors * np.array([[0], [1], [2]]))
