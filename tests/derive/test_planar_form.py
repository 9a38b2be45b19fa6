"""A spatial scene that stays in the plane z = 0 has the motion of its planar form, or a message says why not."""

import numpy as np
import pytest
from funicular import Circle, Friction, GeneralSection, Harmonic, Material, Rectangle, Scene, load_scene
from funicular.choice.planar import planar_of

RUBBER = Material(youngs_modulus=2e6, poisson_ratio=0.3, density=1100)
FLAT = Rectangle(height=0.02, width=0.04)
WIRE = {"start": (0, 0, 0), "end": (1, 0, 0), "elements": 4, "section": FLAT, "material": RUBBER}


def beam(**changes):
    scene = Scene()
    scene.cable("wire", **WIRE | {"law": "structural"} | changes)
    scene.clamp("wire", s=0)
    return scene


def rider(**changes):
    scene = Scene()
    scene.cable("wire", **WIRE | {"element": "cable12", "section": Circle(radius=0.01)} | changes)
    wire = scene.cables["wire"]
    scene.pin("wire", s=0)
    scene.pin("wire", s=wire.length)
    scene.rigid_body("A", mass=0.2, inertia=(1e-4, 1e-4, 2e-4), position=(0.3, 0, 0), velocity=(0.5, 0, 0),
                     centre=(0, -0.01, 0))
    scene.slide("A", along="wire", s=0.3 * wire.length, name="trolley", frame="tangent",
                friction=Friction(coefficient=0.05))
    return scene


def linkage():
    scene = beam(up=(0, 0, 1))
    scene.rigid_body("B", mass=0.1, inertia=(1e-4, 1e-4, 1e-4), position=(1, 0, 0))
    scene.joint("weld", "B", ("wire", 1.0))
    scene.rigid_body("C", mass=0.1, inertia=(1e-4, 1e-4, 1e-4), position=(1, -0.2, 0))
    scene.joint("revolute", ("C", (0, 0.2, 0)), "B", axis=(0, 0, 1))
    scene.spring("C", (1, -1, 0), stiffness=20)
    scene.force("C", value=(1, 0, 0), scale=Harmonic(amplitude=1, frequency=2))
    return scene


def two_cables():
    scene = beam()
    scene.cable("tail", **WIRE | {"law": "structural", "start": (1, 0, 0), "end": (1.5, 0, 0), "elements": 2})
    scene.tie("wire", s=1.0, to="tail", at=0.0)
    scene.distributed_force("tail", value=(0, -1, 0))
    return scene


SCENES = {
    "rider": rider, "engineering strain": lambda: rider(strain="engineering"), "linkage": linkage,
    "in line": two_cables,
    "taut": lambda: rider(rest_length=0.98, membrane="reduced"),
    "arc": lambda: beam(start=None, end=None, points=[(0, 0, 0), (0.5, 0.2, 0), (1, 0, 0)]),
    "no Poisson ratio": lambda: beam(law="continuum", material=Material(youngs_modulus=2e6, poisson_ratio=0.0,
                                                                        density=1100)),
}


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_the_motion_is_that_of_the_spatial_scene(scene):
    spatial = scene()
    planar = planar_of(spatial)
    assert planar.scene is not None, planar
    assert planar.scene.dim == 2
    runs = [each.run(0.3, step=1e-3, output_step=0.01) for each in (spatial, planar.scene)]
    moved = 0.0
    for name in [*(f"{cable}.nodal_vectors" for cable in spatial.cables),
                 *(f"{body}.position" for body in spatial.bodies)]:
        one, other = (run[name] if "position" in name else run[name][:, :, 0] for run in runs)
        assert np.abs(one - other).max() < 1e-9
        moved = max(moved, np.abs(one - one[0]).max())
    assert moved > 0.01


def test_the_planar_scene_says_what_it_is():
    found = planar_of(rider())
    assert dict(found.elements) == {"wire": "cable8p"}
    assert str(found) == ("the scene stays in the plane z = 0: wire of cable8p; motion out of the plane, such as "
                          "lateral buckling, is not in it")


def test_a_scene_keeps_its_settings():
    scene = load_scene("cable_car")
    found = planar_of(scene)
    assert found.scene is None or found.scene.run_settings == scene.run_settings


def tilted_body():
    scene = rider()
    scene.rigid_body("T", mass=1, inertia=((2, 0, 0.1), (0, 2, 0), (0.1, 0, 2)), position=(0, -1, 0))
    return scene


def sideways():
    scene = rider()
    scene.force("A", value=(0, 0, 1))
    return scene


def corner():
    scene = beam()
    scene.cable("post", **WIRE | {"law": "structural", "start": (1, 0, 0), "end": (1, -1, 0), "up": (1, 0, 0)})
    with pytest.warns(Warning, match="too soft"):
        scene.tie("wire", s=1.0, to="post", at=0.0)
        scene.check()
    return scene


GENERAL = GeneralSection(area=1e-4, second_moment_about_y=1e-9, second_moment_about_z=2e-9, torsion_constant=1e-9,
                         shear_factors=(0.8, 0.8))


@pytest.mark.parametrize(("scene", "reason"), [
    (lambda: Scene(gravity=(0, 0, -9.81)), "no cables of spatial elements"),
    (lambda: beam(law="continuum"), "which differ with a Poisson ratio of 0.3"),
    (lambda: beam(up=(0, 1, 1)), "up is neither in the plane z = 0 nor across it"),
    (lambda: beam(up=(0, 0, 1), section=GENERAL), "up lies across the plane z = 0"),
    (lambda: beam(start=None, end=None, points=[(0, 0, 0), (0.4, 0.2, 0.1), (0.7, 0.3, 0), (1, 0.3, 0.5)]),
     "its line leaves the plane"),
    (lambda: beam(angular_velocity=(1, 0, 0)), "its velocity leaves the plane"),
    (lambda: rider(element="cable18"), "cable18 has no planar form"),
    (tilted_body, "products of inertia"),
    (sideways, "value (0, 0, 1) N leaves the plane z = 0"),
    (corner, "a rigid corner of spatial elements is softer"),
])
def test_what_is_spatial_is_said(scene, reason):
    found = planar_of(scene())
    assert found.scene is None
    assert reason in str(found)


def test_gravity_out_of_the_plane():
    scene = Scene(gravity=(0, 0, -9.81))
    scene.cable("wire", **WIRE | {"start": None, "end": None, "points": [(0, 0, 0), (0.5, 0.2, 0), (1, 0, 0)]})
    assert "gravity (0, 0, -9.81) m/s² leaves the plane z = 0" in str(planar_of(scene))
