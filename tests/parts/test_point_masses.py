"""Point masses on cables: against bodies on joints and closed forms, with everything that sums masses."""

import funicular as fu
import numpy as np
import pytest
from expectations import refused, unaccounted
from funicular.parts.scene_text import read
from funicular.results.animation.clips import of_scene
from interrupted_runs import check_file_and_resume
from pieces import bead

ELEMENTS = "cable12", "cable18", "cable8p", "beam24", "beam12p"
INTEGRATORS = "genalpha", "radau", "explicit", "energy"
S = 0.4
IN_WATER = {"area": 0.02, "coefficient": 0.8, "volume": 2e-4, "added_mass": 0.5}


def line(element: str, as_body: bool = False, fluid: dict | None = None, drag: dict | None = None, mass: float = 0.3,
         **entries) -> fu.Scene:
    """Return a taut cable between pins with a mass at s = 0.4 m, a point mass or a rigid body on a spherical joint."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    material = fu.Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1000, damping_time=1e-4)
    wire = scene.cable("w", **{"start": (0, 0, 0), "end": (1.002, 0, 0), "elements": 6, "element": element, "material":
                               material, "section": fu.Circle(radius=0.01), "rest_length": 1.0} | entries)
    scene.pin("w", s=0)
    scene.pin("w", s=1)
    if as_body:
        scene.rigid_body("clump", mass=mass, inertia=(1e-3,) * 3, position=tuple(wire.point(S)))
        scene.joint("spherical", ("w", S), "clump", name="joint")
    else:
        scene.point_mass("w", s=S, mass=mass, name="clump")
    if drag is not None:
        scene.fluid("water", density=1000, **{"velocity": (0.5, 0.2, 0)} | (fluid or {}))
        scene.drag("clump", name="drag", **drag)
    return scene


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("drag", [None, IN_WATER], ids=["alone", "in water"])
def test_a_point_mass_moves_as_a_body_on_a_joint(element, integrator, drag):
    step = {"step": 2e-4} if integrator == "energy" else {"tol": 1e-4 if integrator == "genalpha" else 1e-7}
    one, other = (line(element, as_body, drag=drag).run(duration=0.02, output_step=0.01, integrator=integrator, **step)
                  for as_body in (False, True))
    for name in ("w.nodal_vectors", "energy.kinetic", "energy.potential", "w@0.force"):
        scale = np.abs(other[name]).max()
        bound = 1e-4 if integrator == "genalpha" else 3e-8 if name == "w@0.force" else 1e-8  # tol chooses other steps
        assert np.abs(one[name] - other[name]).max() < bound * scale, name
    if integrator == "energy":
        assert unaccounted(one) < 1e-12
    at = [np.asarray(run.section_forces("w", s=[S - 1e-6, S + 1e-6])["force"]) for run in (one, other)]
    assert np.abs(at[0] - at[1]).max() < (1e-4 if integrator == "genalpha" else 3e-8) * np.abs(at[1]).max()


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("fluid", [None, {}, {"surface": 0.01}], ids=["alone", "in water", "at a surface"])
def test_rest_and_modes_are_those_with_a_body(element, fluid):
    drag = None if fluid is None else IN_WATER
    scenes = [line(element, as_body, fluid, drag) for as_body in (False, True)]
    one, other = (scene.equilibrium() for scene in scenes)
    assert np.abs(one["w.nodal_vectors"] - other["w.nodal_vectors"]).max() < 1e-9
    frequencies = [np.asarray(scene.modes(n, about=rest).frequency)
                   for scene, n, rest in zip(scenes, (4, 8), (one, other), strict=True)]
    turning = np.abs(frequencies[1]) < 1e-3  # the body turns freely on its joint
    assert frequencies[1][~turning][:3] == pytest.approx(frequencies[0][frequencies[0] > 1e-3][:3], rel=1e-7)
    at = [np.asarray(rest.section_forces("w", s=[S - 1e-6, S + 1e-6])["force"]) for rest in (one, other)]
    assert at[0] == pytest.approx(at[1], abs=1e-6 * np.abs(at[1]).max())
    weight = 0.3 * 9.81 + (0.0 if drag is None else float(-one["drag.force"][1]))
    assert at[0][0, 1] - at[0][1, 1] == pytest.approx(-weight, abs=1e-5)


@pytest.mark.parametrize("element", ["cable12", "cable8p"])
def test_a_bead_on_a_string(element, validated):
    found, closed = bead(element, 20)
    validated("Modes", "string with a bead in its middle", "frequencies 1 to 3", closed, found, bound=1e-6,
              source="closed form", variant=element)


def test_the_linear_model_has_the_mass():
    runs = [line("cable8p", as_body).equilibrium() for as_body in (False, True)]
    ends = [rest.scene.run(duration=0.02, initial=rest, integrator="linear", output_step=0.01) for rest in runs]
    assert ends[0]["w.nodal_vectors"] == pytest.approx(ends[1]["w.nodal_vectors"], abs=1e-9)


@pytest.mark.parametrize("shape", ["hanging", None])
def test_a_float_lifts_a_hanging_line(shape):
    """The sum of forces is zero: supports carry the weight less the buoyancy."""
    scene = line("cable12", shape=shape, rest="straight", end=(0.8, 0, 0), fluid={"velocity": (0, 0, 0)},
                 drag={"volume": 2e-3}, mass=0.5)
    rest = scene.equilibrium()
    assert float(rest["w.position"][:, 1].max()) > 0.1
    carried = sum(float(rest[f"w@{s}.force"][1]) for s in (0, 1))
    assert carried == pytest.approx((0.5 + scene.cables["w"].mass - 2.0) * 9.81, rel=1e-6)


def test_masses_anywhere_in_a_cable_of_pieces():
    """At a joint of pieces, inside an element and at an end: weight and momentum are theirs."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.cable("w", start=(0, 0, 0), end=(2, 0, 0), element="cable12", rest="straight", pieces=[
        fu.Piece(length=1.0, section=fu.Circle(radius=0.01), elements=3, material=fu.Material(
            youngs_modulus=modulus, poisson_ratio=0.3, density=1000)) for modulus in (1e8, 3e8)])
    for s, mass in ((0.0, 1.0), (1.0, 2.0), (1.3, 3.0), (2.0, 4.0)):
        scene.point_mass("w", s=s, mass=mass)
    for s in (0, 1, 2):
        scene.pin("w", s=s)
    rest = scene.equilibrium()
    total = sum(float(rest[f"w@{s}.force"][1]) for s in (0, 1, 2))
    assert total == pytest.approx((10 + scene.cables["w"].mass) * 9.81, rel=1e-9)


def test_files_replace_adjust_and_resume(tmp_path):
    scene = line("cable12", drag=IN_WATER)
    assert read(scene.to_toml(), "scene", fu.Scene).to_toml() == scene.to_toml()
    assert scene.replace("clump", mass=2.0).point_masses["clump"].mass == 2.0
    assert not scene.without("w").drags
    points = {mark.name: mark.detail for mark in of_scene(scene, "masses").clips[0].marks}
    assert points["clump"] == '0.3 kg on "w"'
    check_file_and_resume(scene, tmp_path, 8, duration=0.02, tol=1e-4, output_step=0.001)


def test_a_mass_is_adjusted_and_swept():
    scene = line("cable8p")
    wanted = float(scene.replace("clump", mass=0.5).equilibrium()["w@1.force"][1])
    rest = scene.equilibrium(adjust={"clump.mass": "free"}, to={"w@1.force.y": wanted})
    assert rest.scene.point_masses["clump"].mass == pytest.approx(0.5, rel=1e-6)
    swept = fu.sweep(scene, {"clump.mass": [0.3, 0.5]}, keep=["w@0.force"], duration=1e-3, output_step=1e-3, workers=0,)
    assert swept.sizes["clump.mass"] == 2


def test_refusals():
    scene = line("cable12")
    scene.rigid_body("B", mass=1, inertia=(1, 1, 1), position=(0, 1, 0))
    with refused('point_mass "x": is on rigid_body "B", and no cable; count it in the mass of the body'):
        scene.point_mass("B", s=0.0, mass=1.0, name="x")
    with refused('point_mass "x": there is no cable "v"; known: w'):
        scene.point_mass("v", s=0.0, mass=1.0, name="x")
    with refused('point_mass "x": s must lie on the cable, in [0, 1] m, got 1.5 m'):
        scene.point_mass("w", s=1.5, mass=1.0, name="x")
    with refused('point_mass "x": mass must not be negative, got -1 kg'):
        scene.point_mass("w", s=0.5, mass=-1.0, name="x")
    scene.fluid("water", density=1000)
    with refused('drag "x": acts on point_mass "clump" and takes no at; takes area, coefficient, volume, height, '
                 "added_mass"):
        scene.drag("clump", at=(0, 0, 0), volume=1e-3, name="x")
    with refused('drag "x": acts on point_mass "clump", whose added_mass is one number; give that of a sphere, 0.5, or '
                 "take a rigid body on a joint"):
        scene.drag("clump", volume=1e-3, added_mass=(0.5, 0.5, 0.1), name="x")
    with refused('drag "x": has neither drag nor buoyancy; give an area with a coefficient, or a volume'):
        scene.drag("clump", name="x")
