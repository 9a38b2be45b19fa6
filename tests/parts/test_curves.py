"""Cables that are not drawn straight: arc-length, tangents, axes of the section, rest and initial state."""


import numpy as np
import pytest
from expectations import refused
from funicular import Circle, Material, Rectangle, Scene
from funicular.parts.curves import points, sample, shape_through, transported
from numpy.testing import assert_allclose

RADIUS, PITCH = 2.0, 0.5
SOFT = Material(youngs_modulus=1e6, density=1000, poisson_ratio=0.3)


def arc(u):
    """An eighth of a circle in the plane of x and z, as B5."""
    return RADIUS * np.sin(u * np.pi / 4), 0, RADIUS * (1 - np.cos(u * np.pi / 4))


def helix(u):
    return RADIUS * np.cos(3 * u), RADIUS * np.sin(3 * u), PITCH * u


def drawn(**changes):
    given = {"elements": 4, "section": Circle(radius=0.01), "material": SOFT, "curve": arc} | changes
    return Scene().cable("wire", **given)


def wire_refused(complaint):
    return refused(f'cable "wire": {complaint}')


def test_arc_length_tangent_and_curvature_of_an_arc():
    shape = shape_through(points(sample(arc, 4)))
    assert_allclose(shape.length, RADIUS * np.pi / 4, rtol=1e-11)
    s = np.linspace(0, shape.length, 37)
    angle, zero = s / RADIUS, 0 * s
    assert_allclose(shape.point(s), np.stack([*arc(angle * 4 / np.pi)[:1], zero, arc(angle * 4 / np.pi)[2]], 1),
                    atol=1e-9)
    assert_allclose(shape.tangent(s), np.stack([np.cos(angle), zero, np.sin(angle)], 1), atol=1e-7)
    assert_allclose(shape.curvature(s), np.stack([-np.sin(angle), zero, np.cos(angle)], 1) / RADIUS, atol=5e-5)


def test_the_axes_turn_about_the_tangent_nowhere():
    """Seen from the principal normal of a helix they turn back at its torsion."""
    way = points(sample(helix, 4))
    shape = shape_through(way)
    s = np.linspace(0, shape.length, 9)
    axes = transported(way, (-1.0, 0.0, 0.0), tuple(s.tolist()))
    assert_allclose(axes @ axes.transpose(0, 2, 1), np.broadcast_to(np.eye(3), (9, 3, 3)), atol=1e-14)
    turn = 3 * s / np.hypot(3 * RADIUS, PITCH)
    normal = np.stack([-np.cos(turn), -np.sin(turn), 0 * s], 1)
    binormal = np.cross(axes[:, 0], normal)
    angle = np.unwrap(np.arctan2(np.sum(axes[:, 1] * binormal, 1), np.sum(axes[:, 1] * normal, 1)))
    torsion = 3 * PITCH / (9 * RADIUS**2 + PITCH**2)
    assert_allclose(angle, -torsion * s, atol=1e-5)


def test_nodal_vectors_as_drawn_and_at_rest_are_one():
    wire = drawn(element="beam24", section=Rectangle(height=0.01, width=0.02), up=(0, 1, 0))
    assert wire.is_curved and wire.kernel_law == "continuum_curved"
    assert_allclose(wire.nodal_vectors, wire.rest_nodal_vectors, atol=1e-15)
    r, r_x, r_y, r_z = wire.nodal_vectors.transpose(1, 0, 2)
    assert_allclose(r[-1], arc(1.0), atol=1e-15)
    assert_allclose(r_x[-1], [np.sqrt(0.5), 0, np.sqrt(0.5)], atol=1e-6)
    assert_allclose(r_y, np.tile([0.0, 1, 0], (5, 1)), atol=1e-15)
    assert_allclose(np.cross(r_x, r_y), r_z, atol=1e-15)


@pytest.mark.parametrize("element", ["cable12", "beam24", "beam12p"])
def test_a_point_is_where_the_elements_draw_it(element):
    flat = element == "beam12p"
    wire = drawn(element=element, curve=(lambda u: (arc(u)[0], arc(u)[2], 0)) if flat else arc)
    for s, node in zip(wire.node_s, wire.nodal_vectors, strict=True):
        assert_allclose(wire.point(s), node[0], atol=1e-15)
    (r0, t0), (r1, t1) = wire.nodal_vectors[1:3, :2]
    length = wire.length / 4
    middle = (r0 + r1) / 2 + length * (t0 - t1) / 8  # of the cubic
    assert_allclose(wire.point(1.5 * length), middle, atol=1e-14)
    assert 1e-7 < np.linalg.norm(middle - wire._shape.point(1.5 * length)) < 1e-4


def test_a_rider_starts_on_the_elements():
    scene = Scene()
    wire = scene.cable("wire", curve=arc, elements=2, section=Circle(radius=0.01), material=SOFT)
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=wire.point(0.3))
    scene.slide("A", along=wire, s=0.3)
    assert scene.messages == []


def test_three_points_make_a_parabola():
    wire = drawn(curve=None, points=[(0, 0, 0), (1, 1, 0), (2, 0, 0)])
    x = np.linspace(0, 2, 200001)
    assert_allclose(wire.length, np.trapezoid(np.sqrt(1 + (2 - 2 * x) ** 2), x), rtol=1e-9)


def test_points_on_a_line_are_a_line():
    wire = drawn(curve=None, points=[(0, 0, 0), (1, 1, 0), (3, 3, 0)])
    assert not wire.is_curved
    assert_allclose(wire.nodal_vectors[2], [[1.5, 1.5, 0], *wire.axes], atol=1e-15)


def test_a_straight_rest_shape():
    wire = drawn(rest="straight", element="cable18")
    assert not wire.is_curved and wire.kernel_law == "green_exact"
    assert_allclose(wire.rest_nodal_vectors[:, 0], wire.node_s[:, None] * [1, 0, 0], atol=1e-7)
    assert_allclose(wire.rest_nodal_vectors[:, 1:], np.broadcast_to([[1, 0, 0], [0, 0, 0]], (5, 2, 3)), atol=1e-7)
    assert_allclose(np.linalg.norm(wire.nodal_vectors[:, 2], axis=1), 1 / RADIUS, rtol=1e-4)


@pytest.mark.parametrize("ratio", [0.9, 1.2])
def test_a_rest_length_makes_it_taut_or_slack(ratio):
    as_drawn = drawn(element="cable12")
    wire = drawn(element="cable12", rest_length=ratio * as_drawn.length)
    assert wire.length == ratio * as_drawn.length and wire.node_s[-1] == wire.length
    assert_allclose(wire.nodal_vectors[:, 0], as_drawn.nodal_vectors[:, 0], atol=1e-14)
    assert_allclose(wire.nodal_vectors[:, 1] * ratio, as_drawn.nodal_vectors[:, 1], atol=1e-14)
    assert_allclose(wire.rest_nodal_vectors[:, 1], as_drawn.nodal_vectors[:, 1], atol=1e-14)
    assert_allclose(wire.rest_nodal_vectors[-1, 0], ratio * np.array(arc(1.0)), atol=1e-14)
    assert_allclose(wire.point(wire.length), arc(1.0), atol=1e-14)
    assert_allclose(wire.nearest_s(arc(0.5))[0], wire.length / 2, rtol=1e-9)


def test_a_straight_cable_under_tension():
    wire = drawn(curve=None, start=(0, 0, 0), end=(1, 0, 0), rest_length=0.8, element="cable12")
    assert_allclose(wire.nodal_vectors[2], [[0.5, 0, 0], [1.25, 0, 0]], rtol=1e-15)
    assert_allclose(wire.rest_nodal_vectors[2], [[0.4, 0, 0], [1, 0, 0]], rtol=1e-15)
    assert [wire.node_at(s) for s in (0, 0.2, 0.8, 1.0)] == [0, 1, 4, None]


def test_planar_cables_have_their_height_in_the_plane():
    wire = drawn(curve=lambda u: (np.sin(u), 1 - np.cos(u), 0), element="beam12p")
    r_x, r_y = wire.nodal_vectors[:, 1], wire.nodal_vectors[:, 2]
    assert_allclose(r_y, np.cross([0, 0, 1], r_x), atol=1e-15)
    assert drawn(curve=None, start=(0, 0, 0), end=(0, 3, 0), element="cable8p").axes.tolist() == [
        [0, 1, 0], [-1, 0, 0], [0, 0, 1]]


def rounded_corner(u, radius, arc_from=None, arc_to=None):
    """Half a metre straight, a quarter of a circle, half a metre straight: at one speed, or with the arc of its own."""
    arc_length, straight = radius * np.pi / 2, 0.5
    if arc_from is None:
        arc_from, arc_to = straight / (1 + arc_length), (straight + arc_length) / (1 + arc_length)
    if u <= arc_from:
        return straight * u / arc_from, 0, 0
    if u <= arc_to:
        angle = np.pi / 2 * (u - arc_from) / (arc_to - arc_from)
        return straight + radius * np.sin(angle), radius * (1 - np.cos(angle)), 0
    return straight + radius, radius + straight * (u - arc_to) / (1 - arc_to), 0


@pytest.mark.parametrize("radius", [0.2, 0.002])
@pytest.mark.parametrize("arc_at", [(), (1 / 3, 2 / 3), (0.41, 0.43)])
def test_straight_arc_straight(radius, arc_at):
    """Curvature jumps, and the speed of the function may, too: the tangent is what must not."""
    way = points(sample(lambda u: rounded_corner(u, radius, *arc_at), 4))
    shape = shape_through(way)
    assert_allclose(shape.length, 1 + radius * np.pi / 2, rtol=1e-9)
    assert_allclose(shape.point(0.25), [0.25, 0, 0], atol=1e-9)
    angle = np.linspace(0, np.pi / 2, 9)
    on_arc = np.stack([0.5 + radius * np.sin(angle), radius * (1 - np.cos(angle)), 0 * angle], 1)
    assert_allclose(shape.point(0.5 + radius * angle), on_arc, atol=2e-9)
    assert_allclose(np.linalg.norm(shape.curvature(0.5 + radius * angle[1:-1]), axis=1), 1 / radius, rtol=1e-2)
    assert np.linalg.norm(shape.curvature(0.25)) < 1e-4
    assert len(way) < 400


@pytest.mark.parametrize("radius", [0.2, 0.01])
@pytest.mark.parametrize(("pieces", "error"), [(4, 7e-4), (16, 5e-5), (64, 3e-6)])
def test_points_of_straight_arc_straight(radius, pieces, error):
    """Two points for each straight metre. The spline with a continuous curvature was refused as folded, or swung out:
    21 % too long at a radius of 0.2 m, 14 times as long with 64 pieces of an arc of 1 cm.
    """
    angle = np.linspace(0, np.pi / 2, pieces + 1)
    arc = [(1 + radius * np.sin(a), radius * (1 - np.cos(a)), 0.0) for a in angle]
    shape = shape_through(points([(0, 0, 0), *arc, (1 + radius, 1 + radius, 0)]))
    assert_allclose(shape.length, 2 + radius * np.pi / 2, rtol=error)
    s = np.linspace(0, shape.length, 1001)
    away = np.minimum(np.abs(shape.point(s)[:, 1]), np.abs(shape.point(s)[:, 0] - 1 - radius))
    assert away.max() < max(0.02, 0.3 * radius)
    tangent = shape.tangent(s)
    steps = np.arccos(np.clip(np.sum(tangent[1:] * tangent[:-1], axis=1), -1, 1))
    assert steps.sum() < np.pi / 2 + 8 * np.pi / 2 / pieces, "it turns little more than by the right angle"


@pytest.mark.parametrize("count", [4, 7, 30])
@pytest.mark.parametrize("curve", [helix, arc])
def test_smooth_points_keep_a_continuous_curvature(count, curve):
    shape = shape_through(points([curve(u) for u in np.linspace(0, 1, count) ** 1.5]))
    s = np.linspace(0, shape.length, 2001)
    jumps = np.linalg.norm(np.diff(shape.curvature(s), axis=0), axis=1)
    assert jumps.max() < 0.02


def test_a_cable_with_a_rounded_corner_is_free_of_stress_there():
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("wire", curve=lambda u: rounded_corner(u, 0.2), elements=24, element="beam24", law="structural",
                section=Circle(radius=0.01), material=SOFT)
    scene.clamp("wire", s=0.0)
    rest = scene.equilibrium()
    assert_allclose(rest["wire.position"], scene.cables["wire"].nodal_vectors[:, 0], atol=1e-12)
    assert_allclose(rest["wire.position"][-1], [0.7, 0.7, 0], atol=1e-9)


def test_a_function_may_stand_still():
    shape = shape_through(points(sample(lambda u: rounded_corner(min(2 * u, 1), 0.1), 4)))
    assert_allclose(shape.length, 1 + 0.1 * np.pi / 2, rtol=1e-9)


def test_a_ring_may_close():
    wire = drawn(curve=lambda u: (np.cos(2 * np.pi * u), np.sin(2 * np.pi * u), 0), elements=8, up=(0, 0, 1))
    assert_allclose(wire.length, 2 * np.pi, rtol=1e-9)


@pytest.mark.parametrize(("changes", "complaint"), [
    ({"curve": None}, "start and end, or points, are missing"),
    ({"curve": None, "start": (0, 0, 0)}, "end is missing"),
    ({"points": [(0, 0, 0), (1, 0, 0)]}, "has points and a curve; give one of them"),
    ({"curve": None, "points": [(0, 0, 0), (1, 0, 0)], "end": (1, 0, 0)},
     "has points and start or end; give the points alone, the first is the start"),
    ({"curve": "sin"}, "curve must be a function of u from 0 to 1, got 'sin'; or give points"),
    ({"curve": lambda u: (u, 0)},
     "curve(0) must be 3 numbers, got (0.0, 0); it takes a number from 0 to 1 and gives x, y, z in m"),
    ({"curve": lambda u: (u, 0, np.inf if u > 0.5 else 0)},
     "curve(0.5625) must be finite, got (0.5625, 0, inf) m; it takes a number from 0 to 1 and gives x, y, z in m"),
    ({"curve": None, "points": [(0, 0, 0)]}, "points must be a list of 2 points or more, got [(0, 0, 0)]"),
    ({"curve": None, "points": [(0, 0, 0), (1, 0)]}, "points 2 must be 3 numbers, got (1, 0)"),
    ({"curve": None, "points": [(0, 0, 0), (1, 0, 0), (1, 0, 0)]},
     "points 2 and 3 are the same point, (1, 0, 0) m; leave one of them out"),
    ({"curve": None, "points": [(0, 0, 0), (1, 0, 0), (0.9, 0.01, 0), (2, 0, 0)]},
     "the curve folds on itself between point 3 at (0.9, 0.01, 0) and point 4 at (2, 0, 0) m: near (0.9, 0.01, 0) m it "
     "turns 175 degrees off the line between them; give more points there, or look at their order"),
    ({"curve": None, "points": [(0, 0, 0), (1, 0, 0), (0.5, 0, 0)]},
     "the curve folds on itself between point 1 at (0, 0, 0) and point 2 at (1, 0, 0) m: near (1.01953125, 0, 0) m it "
     "turns 180 degrees off the line between them; give more points there, or look at their order"),
    ({"curve": lambda u: (abs(u - 0.3), 0, 0)},
     "curve has a kink near u = 0.300003, at (3.05175781e-06, 0, 0) m: it turns by 180 degrees there; "
     "round it off, or join two cables there"),
    ({"curve": lambda u: (u, 0.01 * max(u - 0.3, 0), 0)},
     "curve has a kink near u = 0.299999, at (0.299999237, 0, 0) m: it turns by 0.573 degrees there; "
     "round it off, or join two cables there"),
    ({"curve": lambda u: (u, 0.1 * (u > 0.3), 0)},
     "curve jumps by 0.1 m at u = 0.3, from (0.3, 0, 0) m; draw two cables where it has to be broken"),
    ({"curve": lambda u: (np.cos(6 * u), np.sin(6 * u), 0), "elements": 1, "up": (0, 0, 1)},
     "element 1 of 1 cannot follow the curve from (1, 0, 0) to (0.960170287, -0.279415498, 0) m: it bends too much "
     "there; take more elements"),
    ({"curve": None, "points": [(0, 0, 0), (1, 1, 0), (2, 0, 0)], "up": (1, 2, 0),
      "section": Rectangle(height=0.01, width=0.02)},
     "up must not be zero or parallel to the axis (0.447213595, 0.894427191, 0), got (1, 2, 0); "
     "give the direction of the section's height"),
    ({"rest_length": 0}, "rest_length must be positive, got 0 m"),
    ({"rest": "bent"}, 'rest "bent" is not known; known: drawn, straight'),
    ({"element": "cable18"},
     'cable18 with law "green_exact" is stress-free only where it is straight, but it is drawn curved; take '
     'rest="straight", or one of beam24 (continuum, structural, poisson_split), cable12 (green_exact, '
     "engineering_exact), beam12p (continuum, structural, poisson_split)"),
    ({"element": "cable8p"},
     "cable8p is planar, but up (0, 1, 0) leaves the plane y = 0, in which it is drawn; "
     'draw it in one plane, give up in that, or take element="beam24" or "cable12" or "cable18"'),
])
def test_what_cannot_be_drawn(changes, complaint):
    with wire_refused(complaint):
        drawn(**changes)
