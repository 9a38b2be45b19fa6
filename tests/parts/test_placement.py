"""Supports, ties, loads and springs: fields that the scene completes, and refusals."""


import numpy as np
import pytest
from expectations import refused
from funicular import Circle, GeneralSection, Material, Ramp, Rectangle, Scene
from funicular.parts.attachment import Attachment
from funicular.parts.signal import Constant
from numpy.testing import assert_allclose

SOFT = Material(youngs_modulus=1e6, density=1000, poisson_ratio=0.3)
BODY = {"mass": 1.0, "inertia": (1, 1, 1), "position": (0, 1, 0)}
UP = (0.0, 1.0, 0.0)


@pytest.fixture
def scene():
    """Return a beam and a cable that meet at (2, 0, 0), and a body above."""
    made = Scene()
    common = {"elements": 2, "section": Circle(radius=0.1), "material": SOFT}
    made.cable("beam", start=(0, 0, 0), end=(2, 0, 0), element="beam24", **common)
    made.cable("rope", start=(2, 0, 0), end=(2, 0, 2), element="cable12", up=(1, 0, 0), **common)
    made.rigid_body("A", **BODY)
    return made


def test_supports_are_kept_with_their_labels(scene):
    clamp = scene.clamp("beam", s=0)
    motion = scene.motion(scene.cables["rope"], s=2, displacement=(0, Ramp(start=0, end=1), 0),
                          rotation=((0, 0, 2), Ramp(start=0, end=3)))
    assert (clamp.fix, clamp.label, motion.label) == ("section", "beam@0", "rope@2")
    assert motion.displacement == (Constant(constant=0.0), Ramp(start=0, end=1), Constant(constant=0.0))
    assert (motion.rotation.axis, motion.rotation.angle) == ((0, 0, 1), Ramp(start=0, end=3))
    assert scene.supports == [clamp, motion]


def test_names_are_given_where_they_are_left_out(scene):
    names = [scene.force("A", value=UP).name, scene.force("A", value=UP, name="lift").name,
             scene.force("beam", s=2, value=UP).name, scene.moment("A", value=UP).name,
             scene.distributed_force("rope", value=UP).name, scene.tie("beam", s=2, to="rope", at=0).name,
             scene.spring("A", (0, 3, 0), stiffness=1).name]
    assert names == ["force_1", "lift", "force_2", "moment_1", "distributed_force_1", "tie_1", "spring_1"]
    with refused('spring "lift": there is already a force of that name; give each part its own name'):
        scene.spring("A", (0, 3, 0), stiffness=1, name="lift")


def test_loads_know_their_place(scene):
    assert (scene.force("A", value=UP).at, scene.force("A", value=UP, at=(1, 2, 3)).at) == ((0, 0, 0), (1, 2, 3))
    assert scene.force("rope", s=1.3, value=(1, 0, 0), follower=True).s == 1.3
    load = scene.distributed_force("rope", value=UP, start=0.5)
    assert (load.start, load.stop, load.scale) == (0.5, 2.0, Constant(constant=1.0))
    assert scene.moment("rope", s=1, value=(3, 4, 0)).s == 1  # across the tangent, which is z
    assert list(scene.loads) == ["force_1", "force_2", "force_3", "distributed_force_1", "moment_1"]


def test_springs_know_their_ends_and_length(scene):
    spring = scene.spring(scene.bodies["A"], ("beam", 1), stiffness=5)
    assert (spring.a, spring.b) == (Attachment(on="A", at=(0, 0, 0)), Attachment(on="beam", s=1))
    assert_allclose(spring.length, np.sqrt(2), rtol=1e-15)
    assert scene.spring(("A", (0, 1, 0)), (0, 5, 0), stiffness=5, damping=1, length=0).length == 0
    assert scene.point_forces["spring_2"].b == Attachment(at=(0, 5, 0))


@pytest.mark.parametrize(("fixed", "complaint"), [
    (("pin", "beam", 0.0), "pin on \"beam\": the node at s = 0 m is already clamped"),
    (("clamp", "rope", 0.0),
     'clamp on "rope": the node at s = 0 m is joined to that at beam@2, which is already pinned'),
    (("clamp", "rope", 2.0), 'clamp on "rope": the node at s = 2 m is already moved as prescribed'),
])
def test_two_supports_on_one_node(scene, fixed, complaint):
    scene.clamp("beam", s=0)
    scene.tie("beam", s=2, to="rope", at=0)
    scene.pin("beam", s=2)
    scene.motion("rope", s=2, displacement=(0, 0, 0))
    kind, cable, s = fixed
    with refused(complaint):
        getattr(scene, kind)(cable, s=s)


def test_joins_that_hold_what_is_held(scene):
    tie = scene.tie("beam", s=2, to="rope", at=0)
    assert (tie.cable, tie.s, tie.to, tie.at, tie.rotation) == ("beam", 2, "rope", 0, "rigid")
    with refused('tie "tie_2": the nodes are already joined'):
        scene.tie("rope", s=0, to="beam", at=2)
    with refused('tie "tie_2": the nodes are one and the same'):
        scene.tie("rope", s=0, to="rope", at=0)
    with refused('tie "corner": the nodes are 2 m apart, at (0, 0, 0) and (2, 0, 0) m; '
                 "draw both cables through the same point"):
        scene.tie("beam", s=0, to="rope", at=0, name="corner")
    scene.cable("third", start=(2, 0, 0), end=(2, 2, 0), elements=1, section=Circle(radius=0.1), material=SOFT,
                up=(1, 0, 0))
    scene.pin("rope", s=0)
    scene.pin("third", s=0)
    with refused('tie "tie_2": both nodes are fixed already, by the pin on "rope" and the pin on "third"; '
                 "leave one of them out"):
        scene.tie("beam", s=2, to="third", at=0)


@pytest.mark.parametrize(("make", "complaint"), [
    (lambda s: s.clamp("beam", s=0.3),
     'clamp on "beam": s must be a node of the cable, got 0.3 m; nodes are at 0, 1, 2 m'),
    (lambda s: s.clamp("beam", s=0, fix="sektion"),
     'clamp on "beam": fix "sektion" is not known; did you mean "section"?'),
    (lambda s: s.motion("beam", s=0),
     'motion on "beam": has neither displacement nor rotation; give one of them, or both'),
    (lambda s: s.motion("beam", s=0, displacement=(0, 1)),
     'motion on "beam": displacement must be 3 signals or numbers, '
     "got (0, 1); give 0 for a direction without motion, \"free\" for one that is not prescribed"),
    (lambda s: s.motion("beam", s=0, displacement=(0,
     "t", 0)), 'motion on "beam": displacement y must be a number or a '
     "signal such as Ramp(start=0, end=1), got 't'"),
    (lambda s: s.motion("beam", s=0, displacement=({"form": "ramp", "start": 1, "end": 0}, 0, 0)),
     'motion on "beam": displacement x: end must be after start 1 s, got 0 s'),
    (lambda s: s.motion("beam", s=0, displacement=({"form": "rmap", "start": 1, "end": 0}, 0, 0)),
     'motion on "beam": displacement x has the unknown form "rmap"; did you mean "ramp"?'),
    (lambda s: s.motion("beam", s=0, rotation=((0, 0, 0), 1)), 'motion on "beam": rotation axis must not be zero'),
    (lambda s: s.motion("beam", s=0, rotation=3), 'motion on "beam": rotation must be an axis and a signal, got 3; '
     "such as ((0, 0, 1), Ramp(start=0, end=1))"),
    (lambda s: s.tie("beam", s=2, to="rop", at=0), 'tie "tie_1": there is no cable "rop"; did you mean "rope"?'),
    (lambda s: s.tie("beam", s=2, to="rope", at=0.1),
     'tie "tie_1": at must be a node of the cable, got 0.1 m; nodes are at 0, 1, 2 m'),
    (lambda s: s.tie("beam", s=2, to="rope", at=0, rotation="hinge"),
     'tie of "beam" and "rope": rotation "hinge" is not known; known: rigid, free'),
    (lambda s: s.force("beem", s=0, value=UP),
     'force "force_1": there is no cable or body "beem"; did you mean "beam"?'),
    (lambda s: s.force("beam", s=2.1, value=UP), 'force "force_1": s must lie on the cable, in [0, 2] m, got 2.1 m'),
    (lambda s: s.force("beam", value=UP), 'force "force_1": acts on cable "beam" and needs the arc-length s there'),
    (lambda s: s.force("beam", s=1, at=(0, 1, 0), value=UP),
     'force "force_1": acts on cable "beam" and needs the arc-length s there, not a point at'),
    (lambda s: s.force("A", s=1, value=UP), 'force "force_1": acts on body "A" and takes no arc-length s; '
     "give a point in body axes, or nothing for its origin"),
    (lambda s: s.force("A", value=(0, np.nan, 0)), "force: value must be finite, got (0, nan, 0) N"),
    (lambda s: s.force("A", value=UP, scale="sin(t)"),
     "force: scale must be a number or a signal such as Ramp(start=0, end=1), got 'sin(t)'"),
    (lambda s: s.force("A", value=UP, follower="yes"), "force: follower must be true or false, got 'yes'"),
    (lambda s: s.force("rope", s=1, value=(1, 2, 0), follower=True),
     'force "force_1": follower force across cable "rope", but cable12 has no section axes that it could follow, got '
     '(1, 2, 0) N; possible is one along the tangent, (F, 0, 0), or take element="beam24"'),
    (lambda s: s.distributed_force("rope", value=UP, follower=True),
     'distributed_force "distributed_force_1": follower force across cable "rope", but cable12 has no section axes '
     'that it could follow, got (0, 1, 0) N/m; possible is one along the tangent, (F, 0, 0), or take element="beam24"'),
    (lambda s: s.distributed_force("rope", value=UP, start=1, stop=1),
     "distributed_force: stop must be beyond start 1 m, got 1 m"),
    (lambda s: s.distributed_force("rope", value=UP, start=2),
     'distributed_force "distributed_force_1": stop must be beyond start 2 m, got 2 m'),
    (lambda s: s.distributed_force("rope", value=UP, stop=3),
     'distributed_force "distributed_force_1": stop must lie on the cable, in [0, 2] m, got 3 m'),
    (lambda s: s.moment("rope", s=1, value=(3, 0, -4)), 'moment "moment_1": twists cable "rope" by -4 N m about its '
     "tangent (0, 0, 1), but cable12 has no torsion; give a moment across the tangent, or take element=\"beam24\""),
    (lambda s: s.spring("A", (0, 1, 0), stiffness=1),
     'spring "spring_1": both ends are at (0, 1, 0) m: its direction is lost; '
     "join the points, draw them apart, or give a spring length=0"),
    (lambda s: s.spring((0, 0, 0), (0, 1, 0), stiffness=1),
     "spring: has both ends on the ground; put one of them on a cable or a body"),
    (lambda s: s.spring("A", (0, 0, 0), stiffness=-1), "spring: stiffness must not be negative, got -1 N/m"),
    (lambda s: s.spring("A", (0, 0, 0), stiffness=1, damping=-2), "spring: damping must not be negative, got -2 N s/m"),
    (lambda s: s.spring("A", (0, 0, 0), stiffness=0),
     "spring: has neither stiffness nor damping; give one of them, or both"),
    (lambda s: s.spring("A", (0, 0, 0), stiffness=1, length=-1), "spring: length must not be negative, got -1 m"),
    (lambda s: s.spring("B", (0, 0, 0), stiffness=1),
     'spring "spring_1": a: there is no cable or body "B"; known: beam, rope, A'),
    (lambda s: s.spring("A", "beam", stiffness=1),
     'spring "spring_1": b: acts on cable "beam" and needs the arc-length s there'),
    (lambda s: s.spring("A", 7, stiffness=1),
     'spring: b must be an end, got 7; give a point (x, y, z), a body, ("body", (x, y, z)) or ("cable", s)'),
])
def test_refused(scene, make, complaint):
    before = list(scene.parts())
    with refused(complaint):
        make(scene)
    assert list(scene.parts()) == before


def cable(element, section, **law):
    return Scene().cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=1, element=element, section=section,
                         material=SOFT, **law)


CONSTANTS = {"area": 1, "second_moment_about_z": 1}


@pytest.mark.parametrize(("element", "section", "law", "complaint"), [
    ("beam24", GeneralSection(**CONSTANTS), {},
     'law "continuum" integrates over the shape of the section, which a general '
     'section does not tell; take law="structural", a rectangle, circle or tube, or element="cable12" or "cable18"'),
    ("beam12p", GeneralSection(**CONSTANTS), {"law": "poisson_split"},
     'law "poisson_split" integrates over the shape of the section, which a general section does not tell; '
     'take law="structural", a rectangle, circle or tube, or element="cable8p"'),
    ("beam24", GeneralSection(**CONSTANTS), {"law": "structural"},
     'law "structural" needs section.shear_factors, which a general section does not tell; give it to the section'),
    ("beam24", GeneralSection(**CONSTANTS, shear_factors=(1, 1)), {"law": "structural"},
     'law "structural" needs section.torsion_constant, which a general section does not tell; give it to the section'),
    ("cable12", GeneralSection(**CONSTANTS, torsion_constant=1), {},
     "section.torsion_constant is given, but cable12 has neither "
     'shear nor torsion; leave it out, or take element="beam24"'),
    ("cable8p", Circle(radius=1, shear_factors=(1, 1)), {}, "section.shear_factors is given, but cable8p has neither "
     'shear nor torsion; leave it out, or take element="beam12p"'),
    ("beam24", Circle(radius=1, torsion_constant=1), {},
     'section.torsion_constant is given, but law "continuum" computes '
     'its own from the shape; leave it out, or take law="poisson_split" or "structural"'),
    ("cable12", GeneralSection(**CONSTANTS, second_moment_about_y=2), {},
     "cable12 has one bending stiffness: its section needs equal "
     'second moments, got (1, 2) m⁴; take a square, a circle or a tube, or element="beam24"'),
    ("cable12", Circle(radius=1), {"law": "structural"}, 'law "structural" is not possible for cable12; possible: '
     "green_exact, green_linear, engineering_exact, engineering_linear, green_exact_assumed, green_linear_assumed, "
     "engineering_exact_assumed, engineering_linear_assumed, engineering_exact_tension_only, "
     "engineering_exact_tabulated, green_exact_reduced, green_linear_reduced, engineering_exact_reduced, "
     "engineering_linear_reduced"),
    ("beam24", Circle(radius=1), {"law": "green_exact"},
     'law "green_exact" is not possible for beam24; possible: continuum, structural, poisson_split'),
    ("beam24", Circle(radius=1), {"strain": "green"},
     "strain, curvature and membrane are for cable elements, beam24 is a beam; "
     'leave them out, or take element="cable12" or "cable18"'),
    ("cable12", Circle(radius=1), {"law": "green_exact", "strain": "engineering"},
     'law "green_exact" disagrees with strain, curvature and membrane; give the one or the others'),
])
def test_elements_laws_and_sections_that_do_not_suit(element, section, law, complaint):
    with refused(f'cable "wire": {complaint}'):
        cable(element, section, **law)


@pytest.mark.parametrize(("element", "section", "law", "expected"), [
    ("beam24", Circle(radius=1), {}, "continuum"),
    ("beam24", Circle(radius=1, torsion_constant=1), {"law": "poisson_split"}, "poisson_split"),
    ("beam24", GeneralSection(**CONSTANTS, torsion_constant=1, shear_factors=(1, 1)), {"law": "structural"},
     "structural"),
    ("beam12p", GeneralSection(**CONSTANTS, shear_factors=(1, 1)), {"law": "structural"}, "structural"),
    ("cable12", GeneralSection(**CONSTANTS), {"strain": "engineering"}, "engineering_exact"),
    ("cable18", GeneralSection(**CONSTANTS), {"law": "engineering_exact"}, "engineering_exact"),
    ("cable8p", Rectangle(height=1, width=2), {"curvature": "linear"}, "green_linear"),
])
def test_elements_laws_and_sections_that_suit(element, section, law, expected):
    assert cable(element, section, **law).law == expected


def test_motions_that_would_begin_with_a_jump(scene):
    scene.motion("beam", s=0, displacement=(0, 0.1, 0))
    remedy = 'let it start from 0, or start with initial="equilibrium"'
    with refused(f'motion on "beam": displacement y is 0.1 m at t = 0, but counts from the place drawn; {remedy}'):
        scene.run(1.0)
    list.clear(scene.motions)
    scene.motion("beam", s=0, rotation=((0, 0, 1), 0.2))
    with refused(f'motion on "beam": rotation is 0.2 rad at t = 0, but counts from the place drawn; {remedy}'):
        scene.run(1.0)
