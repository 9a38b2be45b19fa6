"""Redundant constraints: named at the start, or harmless."""

import numpy as np
import pytest
from expectations import energy_error
from funicular import Circle, ConvergenceError, Material, Scene, SceneError
from hard_cases.case import HELD, INTEGRATORS

STRIP = {"element": "cable12", "elements": 3, "section": Circle(radius=0.02),
         "material": Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1000)}


def strip(scene: Scene, name="wire", *, fixed: bool, start=(0, 0, 0), end=(1.5, 0, 0)):
    """Pinned at its ends, or fixed at every node: then it cannot give way to a rider."""
    cable = scene.cable(name, start=start, end=end, **STRIP)
    for s in cable.node_s if fixed else (0, cable.length):
        scene.clamp(cable, s=s, fix="all") if fixed else scene.pin(cable, s=s)


def riding(points, *, fixed: bool) -> Scene:
    """A body on the strip by points of it, at x from its centre."""
    scene = Scene()
    strip(scene, fixed=fixed)
    scene.rigid_body("A", mass=1.0, inertia=(1e-2,) * 3, position=(0.7, 0, 0), velocity=(1, 0, 0))
    for name, x in zip("abcd", points, strict=False):
        scene.slide("A", along="wire", s=0.7 + x, at=(x, 0, 0), name=name)
    return scene


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_three_points_on_a_line_that_cannot_give_way_are_named(integrator):
    with pytest.raises(SceneError, match='scene: is over-constrained: slides "a", "b" and "c" constrain the same mo'):
        riding((0, 0.1, -0.1), fixed=True).run(0.1, integrator=integrator)


@pytest.mark.parametrize("end", [(1.5, 0, 0), (0.7, 0, 0.8)])
def test_one_point_on_two_cables_that_cannot_give_way_is_named(end):
    """Along each other, and across."""
    scene = riding((0,), fixed=True)
    strip(scene, "other", fixed=True, start=(0, 0, 0) if end[1:] == (0, 0) else (0.7, 0, -0.7), end=end)
    scene.slide("A", along="other", s=0.7, name="b")
    with pytest.raises(SceneError, match='slides "a" and "b" constrain the same motion'):
        scene.run(0.1)


def test_only_those_that_hold_the_same_are_named():
    scene = riding((0, 1e-8), fixed=False)
    scene.rigid_body("B", mass=1.0, inertia=(1e-2,) * 3, position=(0.3, 0, 0), velocity=(1, 0, 0))
    scene.slide("B", along="wire", s=0.3, name="other")
    with pytest.raises(SceneError, match='slides "a" and "b" constrain the same motion'):
        scene.run(0.1)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize(("points", "fixed"), [((0, 0.1), True), ((0, 0.1, -0.1), False), ((0, 1e-3), False)])
def test_what_is_not_redundant_runs(points, fixed, integrator):
    """Two points on a rail; three that straighten the cable; two 1 mm apart, which clamp the body to the tangent."""
    run = riding(points, fixed=fixed).run(0.2, integrator=integrator, progress=False)
    print({name: run[f"{name}.residual"].max() for name, _ in zip("abc", points, strict=False)})
    assert all(run[f"{name}.residual"].max() < HELD[integrator] for name, _ in zip("abc", points, strict=False))
    if fixed:
        np.testing.assert_allclose(run["A.position"], [[0.7 + t, 0, 0] for t in run.time], atol=1e-12)


def test_points_that_rounding_cannot_tell_apart_are_named_when_the_run_fails():
    """1 µm apart: the explicit method gets through (2e-16 m off the cable), one that solves for both forces not."""
    with pytest.raises(ConvergenceError, match='slides "a" and "b" constrain nearly the same motion') as failed:
        riding((0, 1e-6), fixed=False).run(0.2, integrator="genalpha", progress=False)
    assert len(failed.value.run.time) > 0
    run = riding((0, 1e-6), fixed=False).run(0.2, integrator="explicit", progress=False)
    assert run["a.residual"].max() < 1e-14


def test_a_closed_frame_is_resolved():
    """A triangle of beams, each corner rigid: the three ties of a loop constrain what two constrain already; nothing
    moves where nothing pushes, and under weight the corners stay."""
    scene = Scene()
    corners = [(0, 0, 0), (1, 0, 0), (0.5, 0.8, 0)]
    for k in range(3):
        scene.cable(f"c{k}", start=corners[k], end=corners[(k + 1) % 3],
                    **STRIP | {"elements": 2, "element": "beam24", "law": "structural"}, up=(0, 0, 1))
    for k in range(3):
        scene.tie(f"c{k}", s=scene.cables[f"c{k}"].length, to=f"c{(k + 1) % 3}", at=0)
    scene.pin("c0", s=0)
    scene.pin("c0", s=1.0)
    run = scene.run(0.02, progress=False)
    for k in range(3):
        end, start = run[f"c{k}.nodal_vectors"][:, -1, 0], run[f"c{(k + 1) % 3}.nodal_vectors"][:, 0, 0]
        np.testing.assert_allclose(end, start, atol=1e-12)
    assert energy_error(run) < 1e-3
