"""Planar scenes stay in the plane z = 0, and parts that leave it are named."""


import pytest
from expectations import refused
from funicular import Circle, Material, Ramp, Scene, SceneError

SOFT = Material(youngs_modulus=1e6, density=1000, poisson_ratio=0.3)
WIRE = {"start": (0, 0, 0), "end": (2, 0, 0), "elements": 2, "section": Circle(radius=0.1), "material": SOFT}
BODY = {"mass": 1.0, "inertia": (1, 1, 1), "position": (1, 0, 0)}
REMEDY = '; let it stay in the plane, or take spatial elements: "beam24", "cable12", "cable18"'
PLANE = 'leaves the plane z = 0 of the cable8p cable "wire"' + REMEDY


def planar(gravity=(0, -9.81, 0)):
    scene = Scene(gravity=gravity)
    scene.cable("wire", element="cable8p", **WIRE)
    return scene


def test_what_stays_in_the_plane():
    scene = planar()
    scene.rigid_body("A", **BODY, orientation=(0.6, 0, 0, 0.8), velocity=(1, 2, 0), angular_velocity=(0, 0, 3))
    scene.slide("A", along="wire", s=1)
    scene.clamp("wire", s=0)
    scene.motion("wire", s=2, displacement=(0, Ramp(start=0, end=1), 0), rotation=((0, 0, -1), Ramp(start=0, end=1)))
    scene.force("wire", s=1, value=(1, 2, 0), follower=True)
    scene.distributed_force("wire", value=(0, 1, 0))
    scene.moment("A", value=(0, 0, 1))
    scene.moment("wire", s=1, value=(0, 0, 1))
    scene.spring("A", (1, 1, 0), stiffness=1)
    scene.check()
    assert scene.dim == 2


def test_a_scene_without_planar_cables_is_spatial():
    assert Scene().dim == 3


@pytest.mark.parametrize(("add", "complaint"), [
    (lambda s: s.rigid_body("B", **BODY | {"position": (0, 0, 0.1)}), 'rigid_body "B": position (0, 0, 0.1) m'),
    (lambda s: s.rigid_body("B", **BODY, orientation=(0.6, 0.8, 0, 0)), 'rigid_body "B": orientation (0.6, 0.8, 0, 0)'),
    (lambda s: s.rigid_body("B", **BODY, velocity=(0, 0, 2)), 'rigid_body "B": velocity (0, 0, 2) m/s'),
    (lambda s: s.rigid_body("B", **BODY, angular_velocity=(0, 1, 0)),
     'rigid_body "B": angular_velocity (0, 1, 0) rad/s'),
    (lambda s: s.slide("A", along="wire", s=1, at=(0, 0, 1), name="t"), 'slide "t": at (0, 0, 1) m'),
    (lambda s: s.force("A", value=(0, 0, 3)), 'force "force_1": value (0, 0, 3) N'),
    (lambda s: s.force("A", value=(0, 1, 0), at=(0, 0, 2)), 'force "force_1": at (0, 0, 2) m'),
    (lambda s: s.distributed_force("wire", value=(0, 0, 3)),
     'distributed_force "distributed_force_1": value (0, 0, 3) N/m'),
    (lambda s: s.moment("wire", s=0, value=(0, 3, 1)), 'moment "moment_1": value (0, 3, 1) N m'),
    (lambda s: s.motion("wire", s=0, displacement=(0, 0, 1)), 'motion on "wire": displacement z'),
    (lambda s: s.motion("wire", s=0, rotation=((0, 1, 0), 1)), 'motion on "wire": rotation axis (0, 1, 0)'),
    (lambda s: s.spring("A", (0, 0, 1), stiffness=1), 'spring "spring_1": b (0, 0, 1) m'),
])
def test_what_leaves_the_plane(add, complaint):
    scene = planar()
    scene.rigid_body("A", **BODY)
    before = list(scene.parts())
    with refused(f"{complaint} {PLANE}"):
        add(scene)
    assert list(scene.parts()) == before


def test_gravity_and_what_was_there_before():
    with refused(f"scene: gravity (0, 0, -9.81) m/s² {PLANE}"):
        planar(gravity=(0, 0, -9.81))
    scene = Scene()
    scene.rigid_body("B", **BODY | {"position": (0, 0, 0.1)})
    with refused(f'rigid_body "B": position (0, 0, 0.1) m {PLANE}'):
        scene.cable("wire", element="cable8p", **WIRE)
    assert scene.cables == {}


def test_cables_of_both_kinds():
    scene = planar()
    with refused('cable "b": beam24 is spatial, but the elements of cable "wire" (cable8p) are planar; '
                 "take planar elements for all cables, or for none"):
        scene.cable("b", **WIRE)


@pytest.mark.parametrize(("changes", "complaint"), [
    ({"start": None, "end": None, "points": [(0, 0, 0), (1, 0, 0.1), (2, 0.5, 0)]}, "cable8p is planar, but up "
     "(0, 1, 0) leaves the plane through "),
    ({"velocity": (0, 0, 1)}, "cable8p is planar, but it starts with velocity (0, 0, 1) m/s and angular_velocity "
     '(0, 0, 0) rad/s; let it move in the plane z = 0 and turn about z, or take element="beam24" or "cable12" or '
     '"cable18"'),
])
def test_a_planar_cable_itself(changes, complaint):
    with pytest.raises(SceneError) as error:
        Scene().cable("wire", element="cable8p", **WIRE | changes)
    assert str(error.value).startswith(f'cable "wire": {complaint}')
