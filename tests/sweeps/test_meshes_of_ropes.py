"""Meshes of ropes in choices of models, in error estimates and in benches."""

import funicular as fu
import numpy as np
import pytest
from funicular.bench.bench import Mesh, bench, grid

MADE = {"section": fu.Circle(radius=1e-3), "tension": 20.0,
        "material": fu.Material(youngs_modulus=6e8, poisson_ratio=0.3, density=7000, damping_time=1e-4)}


def hoist(elements=1, **sheave) -> fu.Scene:
    """Return a load that flies across its rope, with a counterweight."""
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, place, mass, speed in (("C", (-0.2, -3, 0), 2.2, 0.0), ("L", (0.2, -2.2, 0), 2.0, 0.5)):
        scene.rigid_body(name, mass=mass, inertia=(1, 1, 0.1), position=place, velocity=(speed, 0, 0))
        scene.force(name, value=(0, -20.0, 0))
    scene.rope("hoist", route=[fu.Anchor("C"), fu.Sheave("top", at=(0, 0, 0), radius=0.2, **sheave), fu.Anchor("L")],
               elements=elements, **MADE)
    return scene


def line() -> fu.Scene:
    """Return a rope alone, between two points of the ground."""
    scene = fu.Scene()
    scene.rope("line", route=[fu.Anchor(at=(-1, -1, 0)), fu.Sheave("top", at=(0, 0, 0), radius=0.2),
                              fu.Anchor(at=(1, -1.5, 0))], elements=2, **MADE | {"tension": 200.0})
    return scene


def test_a_choice_reports_the_meshes_of_ropes():
    """Finer ropes change the motion by 1e-5 where the load flies, and by 3 % where a heavy rope falls from straight."""
    fine, coarse = hoist().choose(tol=1e-3, duration=0.3), line().choose(tol=1e-3, duration=0.05)
    assert "elements of the spans of ropes as given (hoist: 1, 1): with elements of half" in str(fine)
    assert 0 < fine.mesh_error < 1e-4 and fine.kept
    assert coarse.error > coarse.mesh_error > 1e-2 and not coarse.kept
    assert "the meshes of ropes do not keep tol = 0.001: give their spans more elements" in coarse.reasons


def test_ropes_alone_are_compared_at_points_of_all_meshes():
    """A rope without bodies, and a belt whose sheaves turn: choosing for either ended in an exception."""
    assert line().choose(tol=1e-2, duration=0.05).mesh_error > 0
    driven, rough = fu.Scene(gravity=(0, 0, 0)), {"radius": 0.1, "side": "left", "inertia": 0.05, "friction": 0.3}
    driven.rope("belt", closed=True, route=[fu.Sheave("a", at=(0, 0, 0), **rough, torque=1.0),
                                            fu.Sheave("b", at=(0.4, 0, 0), **rough)], elements=1, **MADE)
    choice = driven.choose(tol=1e-2, duration=0.05)
    assert choice.unchanged == [] and choice.mesh_error < 1


@pytest.mark.parametrize("quantity", ["hoist.position", "hoist.s", "hoist.position.y", "top.tension_on"])
def test_quantities_of_ropes_that_count(quantity):
    assert hoist().choose(tol=1e-2, duration=0.1, quantities=[quantity]).mesh_error > 0


def test_coordinates_of_ropes_do_not_count():
    with pytest.raises(fu.SceneError, match=r'"hoist\.coordinates" depends on the mesh of the rope; take "hoist\.pos'):
        hoist().choose(tol=1e-2, duration=0.1, quantities=["hoist.coordinates"])


def test_a_bench_refines_ropes():
    scene = hoist((2, 4))
    assert Mesh.parse("x1.5").scene(scene).ropes["hoist"].elements_of_spans == (3, 6)
    assert Mesh.parse("5").scene(scene).ropes["hoist"].elements_of_spans == (5, 5)
    with pytest.raises(fu.SceneError, match=r'rope "hoist": x1.25 of its 2 elements is 2.5; take a factor that leaves'):
        Mesh.parse("x1.25").scene(scene)
    found = bench(hoist(), grid(hoist(), integrators=["radau"], tols=[1e-3], duration=0.3, output_step=0.1,
                                repetitions=1))
    assert [row.elements for row in found.rows] == [2, 4] and not any(row.failed for row in found.rows)
    one, two = found.references.values()
    assert one.mesh_error > 2 * two.mesh_error > 0
    assert np.isfinite([row.total_error for row in found.rows]).all()


@pytest.mark.parametrize(("zones", "expected"), [(8, 1.3e-4), (12, 2.5e-4), (16, 1.4e-4)])
def test_the_error_of_the_zones_is_in_the_estimate(zones, expected):
    """Of 12 and 16 zones, whose double has no room, it is that of 6 and 8; it was left out, without a message."""
    scene = hoist(2, friction=fu.Friction(coefficient=0.4, velocity=0.01), zones=zones)
    scene.force("L", value=(0, -8.0, 0))
    report = scene.run(0.2, output_step=0.1, tol=1e-5, estimate=True).report
    assert report["errors"]["mesh"] == pytest.approx(expected, rel=0.1)
    said = [each for each in report["messages"] if each.startswith('the error of the zones of sheave "top" is')]
    assert len(said) == (zones > 8)
