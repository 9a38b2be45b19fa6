"""Frames, drives, friction and ends of slides in a scene, and refusals."""


import numpy as np
import pytest
from expectations import refused
from funicular import Buffer, Circle, Friction, FunicularWarning, HardStop, Harmonic, Material, Ramp, Scene
from funicular.checks.frames import cable_frame, end_frame, slide_axes
from funicular.parts.attachment import Attachment
from funicular.scene.file import loads
from numpy.testing import assert_allclose

SOFT = Material(youngs_modulus=1e6, density=1000, poisson_ratio=0.3)
THIN = {"section": Circle(radius=0.01), "material": SOFT}
BODY = {"mass": 1.0, "inertia": (1, 1, 1)}


@pytest.fixture
def scene():
    """Return a beam and a cable along x, a beam that hangs from the first, and a rotated body on both."""
    made = Scene(gravity=(0, 0, -9.81))
    made.cable("beam", start=(0, 0, 0), end=(2, 0, 0), elements=2, **THIN)
    made.cable("rope", start=(0, 1, 0), end=(2, 1, 0), elements=2, element="cable12", **THIN)
    made.cable("link", start=(1, 0, 0), end=(1, 0, -1), elements=2, **THIN)
    made.rigid_body("A", position=(0.5, 0, 0), orientation=(0.6, 0.8, 0, 0), **BODY)
    return made


def test_what_a_slide_is_by_itself(scene):
    slide = scene.slide("A", along="beam", s=0.5)
    assert (slide.frame, slide.roll, slide.up, slide.prescribed, slide.friction) == ("point", "free", None, None, None)
    assert (slide.at_start, slide.at_end, slide.rider) == ("error", "error", Attachment(on="A", at=(0, 0, 0)))
    scene.check()  # nothing that the engine lacks


def test_a_cable_rides(scene):
    slide = scene.slide((scene.cables["link"], 1e-13), along="beam", s=1.0, frame="section")
    assert (slide.name, slide.body, slide.body_s, slide.rider) == ("link_on_beam", "link", 1e-13,
                                                                   Attachment(on="link", s=1e-13))
    with refused('slide "t": puts the same point of cable "link" on cable "beam" as slide "link_on_beam"; leave one '
                 "of them out, or give them different points body_s"):
        scene.slide(("link", 1e-13), along="beam", s=1.0, name="t")


def test_two_wheels_on_one_cable_and_one_body_between_two(scene):
    scene.rigid_body("car", position=(1, 0.5, 0), **BODY)
    for name, x in ("front", 0.3), ("back", -0.3):
        scene.slide("car", along="beam", s=1 + x, at=(x, -0.5, 0), name=name)
    scene.slide("car", along="rope", s=1, at=(0, 0.5, 0), name="above")
    scene.check()
    assert [slide.body for slide in scene.slides.values()] == ["car"] * 3 and scene.messages == []


@pytest.mark.parametrize(("given", "up"), [
    ({"frame": "tangent"}, None), ({"frame": "section"}, None), ({"frame": "tangent", "roll": "fixed"}, (0, 0, 1)),
    ({"frame": "tangent", "roll": "fixed", "up": (1, 2, 0)}, (1, 2, 0))])
def test_the_orientation_is_kept_as_it_starts(scene, given, up):
    for name, s in ("beam", 0.5), ("rope", 0.7):
        if name == "rope" and given["frame"] == "section":
            continue
        scene.rigid_body(f"on-{name}", position=scene.cables[name].point(s), orientation=(0, 0.6, 0, 0.8), **BODY)
        slide = scene.slide(f"on-{name}", along=name, s=s, **given)
        assert slide.up == up
        axes = slide_axes(scene, slide)
        together = [cable_frame(scene.cables[name], s, up) @ axes.a, end_frame(scene, slide.rider) @ axes.b]
        assert_allclose(together[0], together[1], atol=1e-15)
        assert_allclose(together[0][:, 2], (1, 0, 0), atol=1e-15)  # z along the tangent
        if up is not None:
            assert_allclose(together[0][:, 1] @ up, 0, atol=1e-15)  # x in the plane of tangent and up


def test_without_gravity_up_is_the_cables():
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("rope", start=(0, 0, 0), end=(2, 0, 0), elements=2, element="cable12", up=(0, 1, 1), **THIN)
    scene.rigid_body("A", position=(1, 0, 0), **BODY)
    assert scene.slide("A", along="rope", s=1, frame="tangent", roll="fixed").up == (0, 1, 1)


def test_drives(scene):
    drive = Ramp(start=0, end=1, before=0.5, after=1.5)
    assert scene.slide("A", along="beam", s=0.5, drive=drive, name="winch").prescribed == drive
    dict.clear(scene.slides)
    moved = scene.slide("A", along="beam", s=0.5, velocity=Harmonic(amplitude=1, frequency=0.5), name="winch")
    assert_allclose(moved.prescribed.value([0.0, 1.0]), [0.5, 0.5 + 2 / np.pi], rtol=1e-14)


def test_a_body_is_driven_once_along_a_cable(scene):
    scene.slide("A", along="beam", s=0.5, velocity=1, name="front")
    scene.slide("A", along="beam", s=0.3, at=(-0.2, 0, 0), name="back")
    with refused('slide "t": drives body "A" along cable "beam", as slide "front" does; leave one of the drives out'):
        scene.slide("A", along="beam", s=0.7, at=(0.2, 0, 0), velocity=1, name="t")


def test_friction_and_ends_are_kept(scene):
    friction = Friction(coefficient=0.2, static_coefficient=0.3, viscous=1, rolling=0.01, model="stick")
    slide = scene.slide("A", along="beam", s=0.5, friction=friction, at_start=HardStop(restitution=1),
                        at_end={"stop": "buffer", "length": 2, "stiffness": 10})
    assert (slide.friction, slide.friction.static, slide.at_start, slide.at_end) == (
        friction, 0.3, HardStop(restitution=1), Buffer(length=2, stiffness=10))
    assert Friction(coefficient=0.2).static == 0.2


@pytest.mark.parametrize(("make", "complaint"), [
    (lambda: Friction(coefficient=-0.1), "Friction: coefficient must not be negative, got -0.1"),
    (lambda: Friction(viscous=-1), "Friction: viscous must not be negative, got -1 N s/m"),
    (lambda: Friction(rolling=-1), "Friction: rolling must not be negative, got -1"),
    (lambda: Friction(coefficient=0.3, velocity=0), "Friction: velocity must be positive, got 0 m/s"),
    (lambda: Friction(coefficient=0.3, static_coefficient=0.2), "Friction: static_coefficient must not be below the "
     "coefficient of sliding 0.3, got 0.2; leave it out where they are equal"),
    (lambda: Friction(coeficient=0.3), 'Friction: "coeficient" is not known here; did you mean "coefficient"?'),
    (lambda: Friction(model="stik"), 'Friction: model "stik" is not known; did you mean "stick"?'),
    (lambda: HardStop(restitution=1.1), "HardStop: restitution must lie in [0, 1], got 1.1"),
    (lambda: HardStop(restitution=-0.1), "HardStop: restitution must lie in [0, 1], got -0.1"),
    (lambda: HardStop(), "HardStop: restitution is missing"),
    (lambda: Buffer(length=0, stiffness=1), "Buffer: length must be positive, got 0 m"),
    (lambda: Buffer(length=1, stiffness=-1), "Buffer: stiffness must not be negative, got -1 N/m"),
    (lambda: Buffer(length=1, stiffness=1, damping=-1), "Buffer: damping must not be negative, got -1 N s/m"),
    (lambda: Buffer(length=1, stiffness=0),
     "Buffer: has neither stiffness nor damping; give one of them, or both"),
])
def test_parts_of_a_slide_refused(make, complaint):
    with refused(complaint):
        make()


VERTICAL = {"body": "B", "along": "link", "s": 0.5}


@pytest.mark.parametrize(("given", "complaint"), [
    ({"body": "link"}, 'cable "link" rides and needs the arc-length of its point; give body=("link", s)'),
    ({"body": ("link", 2)}, "body: s must lie on the cable, in [0, 1] m, got 2 m"),
    ({"body": ("lnk", 0)}, 'body: there is no cable or body "lnk"; did you mean "link"?'),
    ({"body": ("A", 0)}, 'body: acts on body "A" and takes no arc-length s; give a point in body axes, or nothing for '
     "its origin"),
    ({"body": ("link", 0), "at": (0, 0, 1)}, "at is a point in body axes, but body_s one on a cable; give one of the "
     "two"),
    ({"body": ("link", 0)}, 'the point of cable "link" at (1, 0, 0) m is 0.5 m away from cable "beam" at s = 0.5 m; '
     "slide from s = 1 m"),
    ({"body": ("beam", 0.5)}, 'cable "beam" rides itself; let another cable ride, or a body'),
    ({"body": ("rope", 0), "frame": "tangent"}, 'frame "tangent" needs section axes of the rider, cable "rope", but '
     'cable12 has a tangent only; take frame="point", or element="beam24"'),
    ({"frame": "tangnt"}, 'frame "tangnt" is not known; did you mean "tangent"?'),
    ({"along": "rope", "frame": "section"}, 'frame "section" needs section axes (r_y) of cable "rope", but cable12 has '
     'a tangent only; take frame="tangent", or element="beam24"'),
    ({"frame": "tangent", "roll": "fixd"}, 'roll "fixd" is not known; did you mean "fixed"?'),
    ({"roll": "fixed"},
     'roll "fixed" is for frame "tangent", got frame "point"; leave it out, or take frame="tangent"'),
    ({"roll": "fixed", "frame": "section"}, 'roll "fixed" is for frame "tangent", got frame "section"; section axes '
     "fix the roll already"),
    ({"frame": "tangent", "up": (0, 0, 1)}, 'up is given, but roll is free; leave it out, or take roll="fixed"'),
    ({"frame": "tangent", "roll": "fixed", "up": (0, 0, 0)}, "up must not be zero"),
    ({"frame": "tangent", "roll": "fixed", "up": (2, 0, 0)}, 'up (2, 0, 0) is along the tangent of cable "beam", '
     "(1, 0, 0): the frame is lost; give a direction across it"),
    (VERTICAL | {"frame": "tangent", "roll": "fixed"}, 'up (0, 0, 1) is along the tangent of cable "link", (0, 0, -1): '
     "the frame is lost; give a direction across it"),
    ({"drive": 0.5, "velocity": 1}, "drive and velocity are given; give one of the two"),
    ({"drive": 3}, "drive is 3 m at t = 0, off the cable, [0, 2] m; let it start at s = 0.5 m"),
    ({"drive": Ramp(start=0, end=1)}, "drive is 0 m at t = 0, but the slide starts at s = 0.5 m; let both start at one "
     "place"),
    ({"velocity": 1, "at_end": HardStop(restitution=0)}, "is driven, and a stop at_end would act against that; leave "
     "one of them out"),
    ({"velocity": "t"}, "velocity must be a number or a signal such as Ramp(start=0, end=1), got 't'"),
    ({"friction": "rough"}, "friction must be a coefficient, a Friction or a table of its values, got 'rough'"),
    ({"friction": {"coefficient": -0.3}}, "friction.coefficient must not be negative, got -0.3"),
    ({"friction": {"mu": 0.3}}, 'friction "mu" is not known here; known: coefficient, static_coefficient, viscous, '
     "rolling, model, velocity, scale, when, until"),
    ({"at_end": "leav"}, 'at_end "leav" is not known; did you mean "leave"?'),
    ({"at_end": 3}, "at_end must be a word or a stop such as HardStop(restitution=0.5), got 3; words: error, leave"),
    ({"at_end": {"stop": "bufer"}}, 'at_end has the unknown stop "bufer"; did you mean "buffer"?'),
    ({"at_end": {"length": 1}}, "at_end has no stop; known: hard, buffer"),
    ({"at_start": {"stop": "hard", "restitution": 2}}, "at_start.restitution must lie in [0, 1], got 2"),
    ({"at_start": Buffer(length=2.1, stiffness=1)}, "at_start: the buffer's length must not exceed that of cable "
     '"beam", 2 m, got 2.1 m'),
])
def test_refused(scene, given, complaint):
    scene.rigid_body("B", position=(1, 0, -0.5), **BODY)
    before = list(scene.parts())
    with refused(f'slide "t": {complaint}'):
        scene.slide(**{"body": "A", "along": "beam", "s": 0.5, "name": "t"} | given)
    assert list(scene.parts()) == before and scene.messages == []


def test_in_the_plane():
    scene = Scene()
    for name, element in ("thin", "cable8p"), ("thick", "beam12p"):
        scene.cable(name, start=(0, 0, 0), end=(2, 0, 0), elements=2, element=element, **THIN)
    scene.rigid_body("A", position=(1, 0, 0), **BODY)
    assert scene.slide("A", along="thin", s=1, frame="tangent", roll="fixed").up is None  # the plane holds it
    scene.slide("A", along="thick", s=1, frame="section")
    with refused('slide "t": frame "section" needs section axes (r_y) of cable "thin", but cable8p has a tangent only; '
                 'take frame="tangent", or element="beam12p"'):
        scene.slide("A", along="thin", s=1, at=(0, 1, 0), frame="section", name="t")


def test_a_flexible_rider_with_a_small_gap(scene):
    scene.cable("tail", start=(1, 1.001, 0), end=(1, 2, 0), elements=1, up=(1, 0, 0), **THIN)
    with pytest.warns(FunicularWarning, match=r'cable "tail" .* is 0.001 m away .*; they are brought together'):
        scene.slide(("tail", 0), along="rope", s=1)
    scene.clamp("rope", s=0)
    run = scene.run(1e-3)
    assert run["tail_on_rope.residual"].max() < 1e-9
    assert any(note.startswith("gaps of joints were closed at the start: things moved by up to 0.00")
               for note in run.report["messages"])


def test_round_trip(scene):
    scene.slide("A", along="beam", s=0.5, frame="tangent", roll="fixed", velocity=Ramp(start=0, end=1 / 3),
                friction=Friction(coefficient=0.1, model="stick"), at_end="leave")
    scene.slide(("link", 0), along="beam", s=1, frame="section", friction={"viscous": 1 / 7},
                at_start=HardStop(restitution=0.5), at_end=Buffer(length=0.1, stiffness=1e3, damping=1 / 3))
    copy = loads(scene.to_toml(), "copy")
    assert vars(copy) == vars(scene) and copy.to_toml() == scene.to_toml()


FILE = """
[[cable]]
name = "wire"
start = [0, 0, 0]
end = [2, 0, 0]
elements = 2
section = { shape = "circle", radius = 0.01 }
material = { youngs_modulus = 1e6, poisson_ratio = 0.3, density = 1000 }
[[rigid_body]]
name = "A"
mass = 1
inertia = [1, 1, 1]
position = [0.5, 0, 0]
[[slide]]
body = "A"
along = "wire"
s = 0.5
frame = "tangent"
at_start = "leave"
at_end = { stop = "buffer", length = 0.2, stiffness = 100 }
[slide.friction]
coefficient = 0.2
static_coefficient = 0.3
"""


def test_in_a_file():
    slide = loads(FILE, "x.toml").slides["A_on_wire"]
    assert slide.friction == Friction(coefficient=0.2, static_coefficient=0.3)
    assert (slide.frame, slide.at_start, slide.at_end) == ("tangent", "leave", Buffer(length=0.2, stiffness=100))
    with refused('x.toml, line 21: [[slide]] 1: "fricton" is not known here; did you mean "friction"?'):
        loads(FILE.replace("[slide.friction]", "[slide.fricton]"), "x.toml")
    nearest = 'did you mean "static_coefficient"?'
    with refused(f'x.toml, line 21: [[slide]] 1: friction "static_coeficient" is not known here; {nearest}'):
        loads(FILE.replace("static_coefficient", "static_coeficient"), "x.toml")
    with refused("x.toml, line 14: [[slide]] 1: along is missing"):
        loads(FILE.replace('along = "wire"\n', ""), "x.toml")
