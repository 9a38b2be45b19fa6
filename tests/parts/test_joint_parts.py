"""Joints in a scene: completed fields, frames of their ends, refusals."""

import warnings

import numpy as np
import pytest
from expectations import refused
from funicular import Circle, FunicularWarning, Harmonic, Material, Ramp, Scene, SceneError, TableSignal, load_run
from funicular.checks.frames import cable_frame, end_frame, joint_axes
from funicular.checks.joint_placement import check_drive
from funicular.parts.attachment import Attachment
from funicular.parts.joint import JOINT_KINDS, Joint
from funicular.scene.file import loads
from numpy.testing import assert_allclose

SOFT = Material(youngs_modulus=1e6, density=1000, poisson_ratio=0.3)
THIN = {"section": Circle(radius=0.01), "material": SOFT}
BODY = {"mass": 1.0, "inertia": (1, 1, 1)}
TURNED = (0.6, 0.0, 0.8, 0.0)
RISE = Ramp(start=0, end=1)


@pytest.fixture
def scene():
    """Return a curved beam, a cable along x at height 1, and two bodies, one of them rotated."""
    made = Scene()
    made.cable("beam", points=[(0, 0, 0), (1, 0.3, 0.2), (2, 0, 0)], elements=3, **THIN)
    made.cable("rope", start=(0, 1, 0), end=(2, 1, 0), elements=2, element="cable12", **THIN)
    made.rigid_body("A", position=(0, 2, 0), orientation=TURNED, **BODY)
    made.rigid_body("B", position=(1, 2, 0), **BODY)
    return made


def planar():
    made = Scene()
    made.cable("wire", start=(0, 0, 0), end=(2, 0, 0), elements=2, element="cable8p", **THIN)
    made.rigid_body("A", position=(2, 0, 0), **BODY)
    return made


def test_ends_and_names_are_completed(scene):
    joint = scene.joint("spherical", "A", (0, 2, 0))
    assert (joint.joint_kind, joint.name, joint.a, joint.b) == (
        "spherical", "joint_1", Attachment(on="A", at=(0, 0, 0)), Attachment(at=(0, 2, 0)))
    assert scene.joint("spherical", ("rope", 2 + 1e-12), (2, 1, 0)).a.s == 2
    assert scene.joint("distance", scene.bodies["B"], (1, 5, 0), name="rod").length == 3
    assert list(scene.joints) == ["joint_1", "joint_2", "rod"]
    with refused('joint "A": there is already a rigid_body of that name; give each part its own name'):
        scene.joint("spherical", "B", (1, 2, 0), name="A")


@pytest.mark.parametrize("directions", [
    {"kind": "revolute", "axis": (0, 0, 3)}, {"kind": "cylindrical", "axis": (1, 2, 0)},
    {"kind": "universal", "axis": (1, 1, 0), "second_axis": (0, 0, -2)}, {"kind": "weld"}])
@pytest.mark.parametrize("end", [("A", (0, 0, 0)), ("beam", 0.7), ("beam", 0.0)])
def test_axes_are_equal_at_the_start(scene, directions, end):
    at = {"A": (0, 2, 0), "beam": scene.cables["beam"].point(end[1]) if end[0] == "beam" else None}[end[0]]
    joint = scene.joint(a=end, b=tuple(at), **directions)
    axes = joint_axes(scene, joint)
    for own, attachment in zip(axes, (joint.a, joint.b), strict=True):
        assert_allclose(own.T @ own, np.eye(3), atol=1e-15)
        assert_allclose(end_frame(scene, attachment) @ own, joint.axes, atol=1e-15)
    assert_allclose(np.linalg.det(joint.axes), 1)
    if "axis" in directions:
        assert_allclose(joint.axes[:, 2], np.array(joint.axis) / np.linalg.norm(joint.axis), atol=1e-15)
    if "second_axis" in directions:
        assert_allclose(joint.axes[:, 0], (0, 0, -1), atol=1e-15)


def test_axes_that_nobody_gave_are_the_grounds():
    def axes(**given):
        return Joint(a="A", b="B", **given).axes.tolist()

    assert axes(kind="weld") == axes(kind="revolute", axis=(0, 0, 5)) == np.eye(3).tolist()
    assert axes(kind="prismatic", axis=(0, 2, 0)) == [[-1, 0, 0], [0, 0, 1], [0, 1, 0]]  # y: the plane's normal


def test_the_frame_of_a_cable_is_that_of_its_elements(scene):
    beam = scene.cables["beam"]
    assert_allclose(cable_frame(beam, beam.node_s[1]), beam.axes_at(beam.node_s[1]).T, atol=1e-14)
    h = 1e-6
    slope = (beam.point(0.7 + h) - beam.point(0.7 - h)) / (2 * h)
    frame = cable_frame(beam, 0.7)
    assert_allclose(beam.slope(0.7), slope, rtol=1e-8)
    assert_allclose(frame[:, 0], slope / np.linalg.norm(slope), atol=1e-9)
    assert_allclose(frame, beam.axes_at(0.7).T, atol=3e-3)  # the curve's own, which the elements nearly follow
    upright = cable_frame(scene.cables["rope"], 0.5, up=(1, 0, 7))
    assert_allclose(upright, [[1, 0, 0], [0, 0, -1], [0, 1, 0]], atol=1e-15)


@pytest.mark.parametrize(("drive", "expected", "rate"), [
    ({"kind": "revolute", "axis": (0, 0, 1), "angle": RISE}, 1.0, 0.0),
    ({"kind": "cylindrical", "axis": (0, 0, 1), "velocity": 3}, 6.0, 3.0),
    ({"kind": "prismatic", "axis": (0, 0, 1), "velocity": TableSignal(time=[0, 2], value=[0, 2])}, 2.0, 2.0),
    ({"kind": "prismatic", "axis": (0, 0, 1), "distance": TableSignal(time=[0, 2], value=[0, 7])}, 7.0, 3.5)])
def test_what_drives_is_a_signal_from_zero_on(scene, drive, expected, rate):
    joint = scene.joint(a="A", b=(0, 2, 0), **drive)
    check_drive(scene, joint)
    assert joint.is_driven and float(joint.prescribed.value(0.0)) == 0
    assert_allclose([joint.prescribed.value(2.0), joint.prescribed.value(2.0, 1)], [expected, rate], atol=1e-13)


def test_a_driven_distance_counts_from_where_it_starts(scene):
    moved = scene.joint("distance", "A", (0, 5, 0), velocity=Harmonic(amplitude=2, frequency=0.5))
    check_drive(scene, moved)
    assert_allclose(moved.prescribed.value([0.0, 1.0]), [3, 3 + 4 / np.pi], rtol=1e-14)
    whole = scene.joint("distance", "B", (1, 5, 0), distance=Ramp(start=0, end=1, before=3, after=4))
    check_drive(scene, whole)
    assert (whole.length, float(whole.prescribed.value(9.0))) == (None, 4)
    jump = scene.joint("distance", "B", (1, 6, 0), distance=RISE)
    with refused('joint "joint_3": distance is 0 m at t = 0, but the joint starts at 4 m; let it start there, or start '
                 'with initial="equilibrium"'):
        check_drive(scene, jump)
    turn = scene.joint("revolute", "A", (0, 2, 0), axis=(0, 0, 1), angle=0.1)
    with pytest.raises(SceneError, match=r"angle is 0.1 rad at t = 0, but the joint starts at 0 rad"):
        check_drive(scene, turn)


def test_a_small_gap_is_closed_and_reported():
    scene = Scene()
    scene.rigid_body("A", position=(1, 0, 0), **BODY)
    with pytest.warns(FunicularWarning, match="its ends are 0.0005 m apart"):
        scene.joint("spherical", ("A", (-1, 0, 0)), (0, 5e-4, 0), name="foot")
    assert scene.messages == ['joint "foot": its ends are 0.0005 m apart at the start, a at (0, 0, 0) and b at '
                              "(0, 0.0005, 0) m; they are brought together"]
    with refused('joint "rail": its ends are 0.1 m apart across the axis at the start, a at (1, 0, 0) and b at '
                 "(5, 0.1, 0) m; let them start as the joint needs them; only a gap of less than 0.004 m is closed"):
        scene.joint("prismatic", "A", (5, 0.1, 0), axis=(1, 0, 0), name="rail")
    assert scene.joint("prismatic", "A", (5, 0, 0), axis=(-1, 0, 0)).name == "joint_1"


def test_a_body_that_a_slide_moves_away(scene):
    scene.rigid_body("C", position=(1, 1.001, 0), **BODY)
    scene.joint("spherical", "C", (1, 1.001, 0))
    with pytest.warns(FunicularWarning, match=r"moved by 0.001 m"):
        scene.slide("C", along="rope", s=1)
    scene.put(scene.joints["joint_1"].model_copy(update={"b": Attachment(at=(1, 1.1, 0))}))
    with pytest.raises(SceneError, match=r"its ends are 0.1 m apart at the start"):
        scene.check()


def test_a_tangent_is_enough_for_some(scene):
    rope = ("rope", 1.0), (1, 1, 0)
    for number, given in enumerate([
            {"kind": "spherical"}, {"kind": "revolute", "axis": (1, 0, 0)}, {"kind": "cylindrical", "axis": (-1, 0, 0)},
            {"kind": "universal", "axis": (1, 0, 0), "second_axis": (0, 0, 1)}, {"kind": "weld", "up": (0, 1, 1)}]):
        scene.joint(a=rope[0], b=rope[1], name=f"j{number}", **given)
        dict.clear(scene.joints)
    joint = scene.joint("weld", *rope, up=(0, 1, 0))
    assert_allclose(joint_axes(scene, joint).a, np.eye(3), atol=1e-15)
    dict.clear(scene.joints)
    scene.joint("distance", ("rope", 1.0), "B")
    scene.joint("universal", (2, 1, 0), ("rope", 2.0), axis=(0, 0, 1), second_axis=(1, 0, 0))


ROPE = {"a": ("rope", 1.0), "b": (1, 1, 0)}
BARE = ('section axes of cable "rope", but cable12 has a tangent only, (1, 0, 0) there; give up, a direction off the '
        'tangent, or take element="beam24"')


@pytest.mark.parametrize(("given", "complaint"), [
    ({"kind": "revolut"}, 'joint: kind "revolut" is not known; did you mean "revolute"?'),
    ({"kind": 7}, "joint: kind must be a name, got 7; known: " + ", ".join(JOINT_KINDS)),
    ({"kind": "weld", "a": (0, 0, 0)}, "joint: has both ends on the ground; put one of them on a cable or a body"),
    ({"kind": "weld", "a": 3}, 'joint: a must be an end, got 3; give a point (x, y, z), a body, ("body", (x, y, z)) or '
     '("cable", s)'),
    ({"kind": "weld", "a": "C"}, 'joint "joint_1": a: there is no cable or body "C"; known: beam, rope, A, B'),
    ({"kind": "weld", "a": ("rope", 3)}, 'joint "joint_1": a: s must lie on the cable, in [0, 2] m, got 3 m'),
    ({"kind": "prismatic"}, "joint: axis is missing: a prismatic joint needs it"),
    ({"kind": "revolute"}, 'joint "joint_1": axis is missing: a revolute joint needs it'),
    ({"kind": "universal", "axis": (0, 0, 1)}, "joint: second_axis is missing: a universal joint needs it"),
    ({"kind": "universal", "axis": (0, 0, 1), "second_axis": (0, 1, 1)},
     "joint: axis and second_axis must be perpendicular, got 45 degrees between them"),
    ({"kind": "revolute", "axis": (0, 0, 0)}, "joint: axis must not be zero"),
    ({"kind": "spherical", "axis": (0, 0, 1)},
     "joint: axis is given, but a spherical joint has none; leave it out"),
    ({"kind": "weld", "length": 1}, "joint: length is given, but a weld joint has none; leave it out"),
    ({"kind": "distance", "length": 0}, "joint: length must be positive, got 0 m"),
    ({"kind": "weld", "angle": RISE}, "joint: angle is given, but a weld joint is driven by nothing; leave it out"),
    ({"kind": "revolute", "distance": 1},
     "joint: distance is given, but a revolute joint is driven by angle or velocity; leave it out"),
    ({"kind": "revolute", "angle": 1, "velocity": 1}, "joint: angle and velocity are given; give one of them"),
    ({"kind": "distance", "distance": 1, "length": 1},
     "joint: distance and length are given; give one of the two"),
    ({"kind": "revolute", "angle": "t"},
     "joint: angle must be a number or a signal such as Ramp(start=0, end=1), got 't'"),
    ({"kind": "weld", "b": "A"}, 'joint "joint_1": joins body "A" to itself; give it two ends'),
    ({"kind": "weld", "b": ("A", (1, 0, 0))}, 'joint "joint_1": joins body "A" to itself; give it two ends'),
    ({"kind": "weld", "a": ("beam", 1), "b": ("beam", 1)},
     'joint "joint_1": joins cable "beam" at s = 1 m to itself; give it two ends'),
    ({"kind": "spherical", "b": "B"}, 'joint "joint_1": its ends are 1 m apart at the start, a at (0, 2, 0) and b at '
     "(1, 2, 0) m; let them start as the joint needs them; only a gap of less than 0.00216 m is closed"),
    ({"kind": "distance", "b": "B", "length": 0.8}, 'joint "joint_1": its ends are 1 m apart at the start, and not '
     "0.8 m, a at (0, 2, 0) and b at (1, 2, 0) m; let them start as the joint needs them; only a gap of less than "
     "0.00216 m is closed"),
    ({"kind": "distance"}, 'joint "joint_1": both ends are at (0, 2, 0) m: its direction is lost; take '
     'kind="spherical", or draw them apart'),
    (ROPE | {"kind": "weld"}, f'joint "joint_1": a: a weld joint needs {BARE}'),
    (ROPE | {"kind": "prismatic", "axis": (1, 0, 0)}, f'joint "joint_1": a: a prismatic joint needs {BARE}'),
    (ROPE | {"kind": "revolute", "axis": (0, 0, 1)},
     f'joint "joint_1": a: a revolute joint about an axis that is not its tangent needs {BARE}'),
    (ROPE | {"kind": "universal", "axis": (0, 0, 1), "second_axis": (1, 0, 0)},
     f'joint "joint_1": a: a universal joint about an axis that is not its tangent needs {BARE}'),
    (ROPE | {"kind": "revolute", "axis": (1, 0, 0), "angle": RISE},
     f'joint "joint_1": a: a driven revolute joint needs {BARE}'),
    (ROPE | {"kind": "weld", "up": (-1, 0, 0)}, 'joint "joint_1": up (-1, 0, 0) is along the tangent of cable "rope", '
     "(1, 0, 0): the frame is lost; give a direction across it"),
    ({"kind": "weld", "up": (0, 1, 0)},
     'joint "joint_1": up is given, but no end is on a cable without section axes; leave it out'),
])
def test_refused(scene, given, complaint):
    before = list(scene.parts())
    with refused(complaint):
        scene.joint(**{"a": "A", "b": (0, 2, 0)} | given)
    assert list(scene.parts()) == before and scene.messages == []


Z = {"axis": (0, 0, 1)}


@pytest.mark.parametrize(("one", "other", "complaint"), [
    ({"kind": "weld"}, {"kind": "distance", "a": ("A", (1, 0, 0)), "b": (3, 3, 3)},
     'is a distance joint between body "A" and the ground, but joint "first" welds them, too'),
    ({"kind": "spherical"}, {"kind": "weld", "a": (0, 2, 0), "b": "A"},
     'welds the ground and body "A", but joint "first" is a spherical joint between them, too'),
    ({"kind": "revolute", **Z}, {"kind": "spherical"},
     'constrains the same motion of body "A" and the ground as joint "first"'),
    ({"kind": "revolute", **Z, "angle": RISE}, {"kind": "revolute", "axis": (0, 0, -1), "velocity": 1},
     'drives the angle of body "A" and the ground, as joint "first" does'),
    ({"kind": "distance", "b": (5, 2, 0), "velocity": 1}, {"kind": "distance", "a": (5, 2, 0), "b": "A", "velocity": 2},
     'drives the distance of the ground and body "A", as joint "first" does'),
    ({"kind": "revolute", **Z, "angle": RISE},
     {"kind": "cylindrical", **Z, "a": ("A", (1, 0, 0)), "b": (-0.28, 2, 9), "velocity": 1},
     'drives the angle of body "A" and the ground, as joint "first" does'),
    ({"kind": "distance", "b": (5, 2, 0)}, {"kind": "distance", "b": (5, 2, 0), "velocity": 2},
     'constrains the same motion of body "A" and the ground as joint "first"'),
    ({"kind": "cylindrical", **Z}, {"kind": "prismatic", **Z},
     'constrains the same motion of body "A" and the ground as joint "first"'),
])
def test_contradictory_joints_are_named(scene, one, other, complaint):
    common = {"a": "A", "b": (0, 2, 0)}
    scene.joint(**common | one, name="first")
    with refused(f'joint "second": {complaint}; leave one of them out'):
        scene.joint(**common | other, name="second")


def test_joints_that_get_along(scene):
    """Compatible joints: the legs of a hexapod, two joints at different points of a body or a cable."""
    for k in range(3):
        scene.joint("distance", ("A", (k, 0, 0)), (k, 5, 0), velocity=1)
    scene.joint("spherical", ("A", (0, 1, 0)), (0, 3, 0))
    scene.joint("weld", ("beam", 0), (0, 0, 0))
    scene.joint("spherical", ("beam", 2.0), tuple(scene.cables["beam"].point(2.0)))
    assert len(scene.joints) == 5 + 1


def test_supports_and_joins_hold_already(scene):
    scene.pin("beam", s=0)
    scene.joint("spherical", ("rope", 0), (0, 1, 0))
    with refused('joint "joint_2": fixes cable "beam" at s = 0 m to the ground, but it is pinned already; leave one of '
                 "them out"):
        scene.joint("weld", ("beam", 0), (0, 0, 0))
    scene.pin("rope", s=0)
    with pytest.raises(SceneError, match=r'joint "joint_1": fixes cable "rope" at s = 0 m to the ground, but'):
        scene.check()
    scene.cable("tail", start=(2, 1, 0), end=(4, 1, 0), elements=2, element="cable12", **THIN)
    scene.tie("rope", s=2, to="tail", at=0)
    with refused('joint "joint_2": joins cable "rope" at s = 2 m to cable "tail" at s = 0 m, but their nodes are '
                 "joined already; leave one of them out"):
        scene.joint("spherical", ("rope", 2), ("tail", 0))


def test_in_the_plane():
    scene = planar()
    hinge = scene.joint("revolute", "A", ("wire", 2))
    assert hinge.axis == (0, 0, 1)
    scene.joint("weld", ("wire", 0), (0, 0, 0))
    scene.joint("prismatic", "A", (5, 0, 0), axis=(1, 0, 0))
    scene.joint("distance", "A", (5, 1, 0), velocity=1)
    assert scene.dim == 2
    remedy = ('leaves the plane z = 0 of the cable8p cable "wire"; let it stay in the plane, or take spatial elements: '
              '"beam24", "cable12", "cable18"')
    for complaint, given in {
        "axis (0, 1, 1)": {"kind": "revolute", "axis": (0, 1, 1)},
        "axis (0, 0, 1)": {"kind": "cylindrical", "axis": (0, 0, 1)},
        "a turn about the axis": {"kind": "cylindrical", "axis": (0, 1, 0), "velocity": 1},
        "a universal joint": {"kind": "universal", "axis": (1, 0, 0), "second_axis": (0, 0, 1)},
        "b (2, 0, 1) m": {"kind": "weld", "b": (2, 0, 1)},
    }.items():
        with refused(f'joint "j": {complaint} {remedy}'):
            scene.joint(**{"a": "A", "b": (2, 0, 0), "name": "j"} | given)


def test_round_trip(scene):
    scene.joint("universal", ("A", (1 / 3, 0, 0)), (-7 / 75, 2, -0.32), axis=(0, 1, 0),
                second_axis=(1, 0, 1), name="cross")
    scene.joint("revolute", ("beam", 0), (0, 0, 0), axis=(0, 1, 0), angle=Harmonic(amplitude=1, frequency=2))
    scene.joint("distance", "A", "B", velocity=TableSignal(time=[0, 1], value=[0, 1]))
    scene.joint("weld", ("rope", 2), (2, 1, 0), up=(0, 0, 1))
    copy = loads(scene.to_toml(), "copy")
    assert vars(copy) == vars(scene) and copy.to_toml() == scene.to_toml()


def test_in_a_file():
    text = '[[rigid_body]]\nname="A"\nmass=1\ninertia=[1,1,1]\nposition=[0,0,0]\n[[joint]]\na="A"\nb=[0,0,0]\n'
    with refused("x.toml, line 6: [[joint]] 1: kind is missing"):
        loads(text, "x.toml")
    with refused('x.toml, line 11: joint "j": "axes" is not known here; did you mean "axis"?'):
        loads(text + 'kind="revolute"\nname="j"\naxes=[0,0,1]\n', "x.toml")
    scene = loads(text + 'kind="revolute"\naxis=[0,0,1]\nangle={form="ramp", start=0, end=2}\n', "x.toml")
    assert scene.joints["joint_1"].angle == Ramp(start=0, end=2)


def test_a_saved_run_does_not_repeat_what_was_adjusted(tmp_path):
    """The scene warns when it is made; the report keeps the message, and reading the scene back does not warn."""
    scene = Scene(gravity=(0, 0, 0))
    for name, y in (("A", 0.0), ("B", 1.0005)):
        scene.rigid_body(name, mass=1, inertia=(1, 1, 1), position=(0, y, 0))
    with pytest.warns(FunicularWarning, match="they are brought together"):
        scene.joint("spherical", "A", ("B", (0, -1, 0)))
    scene.run(0.01, save=tmp_path / "run.nc")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = load_run(tmp_path / "run.nc")
        assert list(run.scene.bodies) == ["A", "B"]
        run.summary()
    assert any("they are brought together" in message for message in run.report["messages"])


def test_a_distance_that_follows_a_signal_needs_no_length():
    scene = Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(1, 0, 0))
    scene.joint("distance", (0, 0, 0), "A", distance=Ramp(start=0.0, end=0.1, before=1.0, after=1.1), name="rod")
    assert scene.run(0.1, progress=False)["A.position"][-1, 0] == pytest.approx(1.1, abs=1e-6)
