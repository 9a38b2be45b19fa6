"""Ropes as drawn: their route against closed forms, what is refused or noted, and scene files."""

import copy
import json
import pickle
import re
import tomllib
from math import asin, atan2, cos, hypot, pi, sin, sqrt, tau

import funicular as fu
import jsonschema
import numpy as np
import pytest
from expectations import refused
from funicular.parts.rope import ELEMENTS
from funicular.parts.rope_route import MAX_LAYER, MIN_SPAN_RATIO, MIN_WRAP
from funicular.scene.schema import scene_schema
from shared_scenes import changed

pytestmark = pytest.mark.filterwarnings("error::funicular.FunicularWarning")

WIRE = {"section": fu.Circle(radius=0.002), "material": fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1e3)}
"""EA is 4000 pi N, EI 4e-3 pi N m²: at 500 N a bending layer of 5 mm."""
THIN = {"section": fu.GeneralSection(area=1e-5, second_moment_about_z=1e-30)}
"""EI is 1e-21 N m²: at 500 N tangent points are 1e-24 m / R off the circle of radius R, below rounding."""
BODY = {"mass": 1.0, "inertia": (1, 1, 1)}


def at(x, y):
    return fu.Anchor(at=(x, y, 0))


def sheave(x, y, radius, side=None, name="top", **given):
    return fu.Sheave(name, at=(x, y, 0), radius=radius, side=side, **given)


def rope_of(*route, scene=None, **given) -> fu.Rope:
    scene = fu.Scene() if scene is None else scene
    length = {} if "length" in given else {"tension": 500.0}
    return scene.rope("hoist", route=list(route), **WIRE | length | given)


def drawn(*route, bodies=None, **given):
    """Return the route of a rope as drawn; by default it does not bend in effect, so that it lies on circles."""
    return rope_of(*route, **THIN | given).drawn({} if bodies is None else bodies)


def check_tangents(route):
    """Check that the spans end on their sheaves, along their tangents, in the sense of travel."""
    closed = len(route.spans) == len(route.sheaves)
    before_each = [route.spans[-1], *route.spans[:-1]] if closed else route.spans[:-1]
    for before, arc, after in zip(before_each, route.sheaves, route.spans[not closed:], strict=True):
        for angle, point, span, radius in ((arc.angle_on, before.end, before, arc.tangent_radius[0]),
                                           (arc.angle_off, after.start, after, arc.tangent_radius[1])):
            radial = np.array([cos(angle), sin(angle)])
            assert point == pytest.approx(arc.centre + radius * radial, abs=1e-13)
            assert span.direction == pytest.approx(arc.sense * np.array([-radial[1], radial[0]]), abs=1e-13)
        assert arc.wrap == arc.sense * (arc.angle_off - arc.angle_on) > 0
    for span in route.spans:
        assert span.length == pytest.approx(hypot(*(span.end - span.start)), rel=1e-13)


def test_over_one_sheave():
    """Both ends hang straight down: half a turn, clockwise."""
    route = drawn(at(-0.3, -2), sheave(0, 0, 0.3), at(0.3, -5))
    check_tangents(route)
    (arc,) = route.sheaves
    assert (arc.name, arc.sense, arc.radius, arc.centre.tolist()) == ("top", -1, 0.3, [0, 0])
    assert abs(arc.angle_on) == pytest.approx(pi, abs=1e-15) and arc.wrap == pytest.approx(pi, abs=1e-15)
    assert [span.length for span in route.spans] == pytest.approx([2, 5], rel=1e-15)
    assert route.length == pytest.approx(7 + 0.3 * pi, rel=1e-15)


def test_outer_tangent():
    """Over both sheaves, straight up before and straight down after: headings of pi/2, a, -pi/2."""
    C, R1, R2 = 2.0, 0.2, 0.5
    route = drawn(at(-R1, -3), sheave(0, 0, R1, name="one"), sheave(C, 0, R2, name="two"), at(C + R2, -4))
    check_tangents(route)
    a = asin((R2 - R1) / C)
    assert [arc.sense for arc in route.sheaves] == [-1, -1]
    assert [arc.wrap for arc in route.sheaves] == pytest.approx([pi / 2 - a, pi / 2 + a], rel=1e-14)
    assert [span.length for span in route.spans] == pytest.approx([3, sqrt(C**2 - (R2 - R1)**2), 4], rel=1e-14)


def test_inner_tangent():
    """Over one sheave and under the other: headings of pi/2, -b, pi/2."""
    C, R1, R2 = 2.0, 0.2, 0.5
    route = drawn(at(-R1, -3), sheave(0, 0, R1, name="one"), sheave(C, 0, R2, name="two"), at(C + R2, 4))
    check_tangents(route)
    b = asin((R1 + R2) / C)
    assert [arc.sense for arc in route.sheaves] == [-1, 1]
    assert [arc.wrap for arc in route.sheaves] == pytest.approx([pi / 2 + b, pi / 2 + b], rel=1e-14)
    assert [span.length for span in route.spans] == pytest.approx([3, sqrt(C**2 - (R1 + R2)**2), 4], rel=1e-14)


def test_three_sheaves_in_a_row():
    """Over, under and over sheaves of one radius: headings of pi/2, -b, b, -pi/2."""
    C, R = 1.5, 0.25
    route = drawn(at(-R, -3), sheave(0, 0, R, name="a"), sheave(C, 0, R, "left", "b"), sheave(2 * C, 0, R, name="c"),
                  at(2 * C + R, -4))
    check_tangents(route)
    b = asin(2 * R / C)
    assert [arc.sense for arc in route.sheaves] == [-1, 1, -1]
    assert [arc.wrap for arc in route.sheaves] == pytest.approx([pi / 2 + b, 2 * b, pi / 2 + b], rel=1e-14)
    assert route.length == pytest.approx(7 + 2 * sqrt(C**2 - 4 * R**2) + R * (pi + 4 * b), rel=1e-14)


@pytest.mark.parametrize("side", [None, "right", "left"])
def test_turns_are_added_to_the_wrap_of_the_tangents(side):
    one, two = (drawn(at(-2, -3), sheave(0, 0, 0.3, side, turns=turns), at(1, -4)) for turns in (1, 2))
    check_tangents(one)
    without = -one.sheaves[0].sense * (1 - 2 * (side == "left"))
    assert without == 1 and two.sheaves[0].wrap - one.sheaves[0].wrap == pytest.approx(tau, rel=1e-14)
    assert two.length - one.length == pytest.approx(0.3 * tau, rel=1e-13)
    if side != "left":
        plain = drawn(at(-2, -3), sheave(0, 0, 0.3, side), at(1, -4)).sheaves[0]
        assert one.sheaves[0].wrap == pytest.approx(plain.wrap + tau, rel=1e-14)
        assert one.sheaves[0].angle_on == plain.angle_on


def test_a_whole_turn_without_a_bend():
    """The spans are on one line, so that rounding of the wrap angle must not add a turn."""
    for turned in np.linspace(0, tau, 41):
        u = np.array([cos(turned), sin(turned)])
        n = np.array([-u[1], u[0]])
        route = drawn(at(*(-2 * u)), sheave(*(0.3 * n), 0.3, "left", turns=1), at(*(3 * u)))
        assert route.sheaves[0].wrap == pytest.approx(tau, abs=1e-8)


@pytest.mark.parametrize("seed", range(20))
def test_random_routes_are_tangent_and_reversible(seed):
    """Backwards, each sheave lies on the other side, and the angles change places."""
    random = np.random.default_rng(seed)
    turn, n = random.uniform(0, tau), int(random.integers(1, 5))
    places = np.column_stack([4.0 * np.arange(n + 2), random.uniform(-1.5, 1.5, n + 2)])
    places = places @ np.array([[cos(turn), sin(turn)], [-sin(turn), cos(turn)]])
    senses = random.choice(["left", "right"], n)
    radii = random.uniform(0.1, 0.9, n)

    def route(backwards):
        other = {"left": "right", "right": "left"}
        items = [sheave(*places[k + 1], radii[k], other[senses[k]] if backwards else senses[k], f"s{k}", turns=1)
                 for k in range(n)]
        items = [at(*places[0]), *items, at(*places[-1])]
        return drawn(*(items[::-1] if backwards else items), length=1e-3)

    one, back = route(False), route(True)
    check_tangents(one)
    check_tangents(back)
    assert back.length == pytest.approx(one.length, rel=1e-13)
    for arc, same in zip(one.sheaves, reversed(back.sheaves), strict=True):
        assert (same.name, same.sense) == (arc.name, -arc.sense) and same.wrap == pytest.approx(arc.wrap, rel=1e-12)
        assert cos(same.angle_on - arc.angle_off) == pytest.approx(1, abs=1e-13)


def test_points_of_bodies():
    """A body turned by a right angle holds one end, another one the sheave, at a point and at the origin."""
    scene = fu.Scene()
    scene.rigid_body("load", position=(-1, -3, 0), orientation=(sqrt(0.5), 0, 0, sqrt(0.5)), **BODY)
    carrier = scene.rigid_body("carrier", position=(0, 1, 0), **BODY)
    rope = rope_of(fu.Anchor("load", at=(0, -0.7, 0)), fu.Sheave("top", at=carrier, radius=0.3), fu.Anchor("carrier", (
        0.3, -2, 0)), scene=scene, **THIN)
    assert rope.route[1].at.at == (0, 0, 0) and list(rope.refers_to()) == ["load", "carrier", "carrier"]
    route = scene.route_of(rope)
    check_tangents(route)
    assert route.spans[0].start == pytest.approx([-0.3, -3], abs=1e-15)
    assert route.length == pytest.approx(4 + 2 + 0.3 * pi, rel=1e-14)
    moved = scene.replace("load", position=(-1, -5, 0))
    assert moved.ropes["hoist"].drawn(moved.bodies).length == pytest.approx(route.length + 2, rel=1e-14)


def test_stretch():
    route = at(-0.3, -2), sheave(0, 0, 0.3), at(0.3, -5)
    EA = 1e9 * 1e-5
    by_tension = drawn(*route, tension=500.0)
    assert by_tension.stretch == pytest.approx(1 + 500 / EA, rel=1e-15)
    assert by_tension.free_length == pytest.approx((7 + 0.3 * pi) / (1 + 500 / EA), rel=1e-15)
    by_length = drawn(*route, length=by_tension.free_length)
    assert by_length.stretch == pytest.approx(by_tension.stretch, rel=1e-15)
    assert by_length.free_length == pytest.approx(by_tension.free_length, rel=1e-15)


def test_stiffness_is_that_of_a_planar_cable():
    rope = rope_of(at(-1, 0), sheave(0, 3, 0.3), at(1, 0), section=fu.Rectangle(height=0.004, width=0.01))
    assert rope.stiffness == pytest.approx((1e9 * 4e-5, 1e9 * 0.01 * 0.004**3 / 12), rel=1e-14)
    assert rope.radius == 0.002 and rope.dim == 2


def test_elements():
    route = at(-1, 0), sheave(0, 3, 0.3), at(1, 0)
    assert rope_of(*route).elements_of_spans == (4, 4)
    assert rope_of(*route, elements=2).elements_of_spans == (2, 2)
    assert rope_of(*route, elements=[2, 3]).elements_of_spans == (2, 3)
    for bad, complaint in ((0, "must be a whole number, 1 or more, got 0"), ([1, 2.5],
                           "must be a whole number, 1 or more, got 2.5"), ([1, 2, 3],
                           "must be one number or 2, one for each span, got 3")):
        with refused(f'rope "hoist": elements {complaint}'):
            rope_of(*route, elements=bad)


ENDS = at(-1, 0), at(1, 0)
TOP = sheave(0, 3, 0.3)


ORDER = "give an Anchor or a Drum, then the sheaves, then an Anchor or a Drum; or closed=True"


@pytest.mark.parametrize(("route", "complaint"), [
    ([], f"must be a list of 2 items or more, got []; {ORDER}"),
    ([at(0, 0)], f"must be a list of 2 items or more, got [Anchor(on=None, at=(0.0, 0.0, 0.0), s=None)]; {ORDER}"),
    ([TOP, ENDS[1]], f'must begin and end with an Anchor or a Drum, its first item is the sheave "top"; {ORDER}'),
    ([ENDS[0], TOP], f'must begin and end with an Anchor or a Drum, its last item is the sheave "top"; {ORDER}'),
    ([ENDS[0], at(0, 1), TOP, ENDS[1]], "has an Anchor between its ends; let two ropes end there"),
    ([*ENDS], "has no sheave and no drum; take scene.cable() between two points"),
    ([ENDS[0], TOP, TOP, ENDS[1]], 'has two items named "top"; give each its own name'),
    ([ENDS[0], sheave(0, 3, 0.3, name="hoist"), ENDS[1]],
     'has a sheave "hoist", the name of the rope; give each its own name'),
])
def test_order_of_items(route, complaint):
    with refused(f'rope "hoist": route {complaint}'):
        rope_of(*route)


@pytest.mark.parametrize(("route", "complaint"), [
    ([at(0.1, 3), TOP, ENDS[1]], 'sheave "top" contains the first anchor: 0.1 m from its centre, and its radius is 0.3 '
                                 "m; move them apart, or take smaller radii"),
    ([ENDS[0], TOP, at(0.3, 3)], 'sheave "top" contains the last anchor: 0.3 m from its centre, and its radius is 0.3 '
                                 "m; move them apart, or take smaller radii"),
    ([ENDS[0], TOP, sheave(0.1, 3, 0.1, "right", "low"), ENDS[1]],
     'sheave "top" contains sheave "low": their centres are 0.1 m apart, and their radii 0.3 m and 0.1 m; move them '
     "apart, or take smaller radii"),
    ([ENDS[0], TOP, sheave(0.3, 3, 0.1, "left", "low"), at(1, 5)],
     'sheave "top" and sheave "low" overlap, so that the rope cannot pass between them: their centres are 0.3 m apart, '
     "and their radii 0.3 m and 0.1 m; move them apart, or take smaller radii, or lead the rope along one side of "
     "both"),
    ([ENDS[0], sheave(0, 3, 0.3, "right"), sheave(0, 3, 0.3, "right", "low"), ENDS[1]],
     'sheave "top" contains sheave "low": their centres are 0 m apart, and their radii 0.3 m and 0.3 m; move them '
     "apart, or take smaller radii"),
    ([at(-0.3, 2.99), TOP, ENDS[1]],
     'the span from the first anchor to sheave "top" must be 0.015 m or longer, 0.05 of a sheave\'s radius and the '
     "rope's radius, got 0.01 m; move them apart"),
    ([at(-2, -1), sheave(0, 0, 0.4), sheave(4, 0, 0.3, name="back"), at(-2, 0.3)],
     'the span from sheave "back" to the last anchor crosses sheave "top": it passes its centre at 0.3 m, within its '
     "radius 0.4 m; move the sheave, or give side= of the sheaves"),
    ([at(-1, 3.3), sheave(0, 3, 0.3, "right"), at(1, 3.3)],
     'the rope does not touch sheave "top": its wrap angle must be 0.001 rad or more, got 0 rad; leave it out, move '
     "it into the way of the rope, or give contact=False"),
    ([at(0, 0), TOP, at(0, -1)], 'the route runs straight through the centre of sheave "top", which does not tell its '
                                 'side; give side="left" or "right"'),
])
def test_impossible_routes(route, complaint):
    with refused(f'rope "hoist": {complaint}'):
        rope_of(*route)


def test_spans_may_touch_other_sheaves():
    """As of several falls between sheaves side by side on one axle."""
    check_tangents(drawn(at(-2, -1), sheave(0, 0, 0.3), sheave(4, 0, 0.3, name="back"), at(-2, 0.3)))
    blocks = [sheave(0, 6 * (k % 2), 0.3, "right", f"s{k}") for k in range(4)]
    falls = drawn(at(0.3, 3), *blocks, at(0.3, 3))
    check_tangents(falls)
    assert falls.length == pytest.approx(3 + 3 * 6 + 3 + 4 * 0.3 * pi, rel=1e-14)


@pytest.mark.parametrize("wrap", [0.5, 2.0])
def test_the_least_wrap(wrap):
    """Spans of 3 m with headings of half the wrap up and down."""
    R, half = 0.3, wrap * MIN_WRAP / 2
    run = R * sin(half) + 3 * cos(half)
    height = 3 * sin(half) - R * cos(half)
    route = at(-run, -height), sheave(0, 0, R, "right"), at(run, -height)
    if wrap > 1:
        assert drawn(*route).sheaves[0].wrap == pytest.approx(wrap * MIN_WRAP, rel=1e-10)
    else:
        with refused('rope "hoist": the rope does not touch sheave "top": its wrap angle must be 0.001 rad or more, '
                     "got 0.0005 rad; leave it out, move it into the way of the rope, or give contact=False"):
            rope_of(*route)


@pytest.mark.parametrize("length", [0.99, 1.01])
def test_the_least_span(length):
    """Of a large sheave, and of a thick rope."""
    for section, radius, least in ((WIRE["section"], 1.0, MIN_SPAN_RATIO), (fu.Circle(radius=0.02), 0.3, 0.02)):
        route = at(-radius, -length * least), sheave(0, 0, radius), at(radius, -3)
        given = {"section": section, "tension": 1e7}
        if length > 1:
            EI = 1e9 * pi / 4 * section.radius**4
            offset = EI / (2 * 1e7 * radius)
            route = at(-radius - offset, -length * least), *route[1:]
            rope = fu.Rope("hoist", route=route, **WIRE | given)  # in a scene the thick one gets a note on its stress
            assert rope.drawn({}).spans[0].length == pytest.approx(length * least, rel=1e-14)
        else:
            with refused(f'rope "hoist": the span from the first anchor to sheave "top" must be {least:g} m or longer, '
                         f"0.05 of a sheave's radius and the rope's radius, got {length * least:.9g} m; move them "
                         "apart"):
                rope_of(*route, **given)


def test_one_of_tension_and_length():
    route = at(-0.3, -2), sheave(0, 0, 0.3), at(0.3, -5)
    taut = 7 + 0.3 * pi
    for given, have in (({"tension": None}, "neither tension nor length"), ({"length": 7.0, "tension": 1.0},
                        "tension and length")):
        with refused(f'rope "hoist": has {have}; give one of them'):
            rope_of(*route, **given)
    for tension in (0, -1):
        with refused(f'rope "hoist": tension must be positive, got {tension} N'):
            rope_of(*route, tension=tension)
    with refused('rope "hoist": length must be positive, got 0 m'):
        rope_of(*route, length=0)
    with refused(f'rope "hoist": is never taut: its length 8 m exceeds that of its route as drawn, {taut:.9g} m, by '
                 f"{8 - taut:.9g} m; give a smaller length, or tension"):
        rope_of(*route, length=8)
    with pytest.warns(fu.FunicularWarning, match=re.escape("sqrt(EI / T) is infinite")):
        assert drawn(*route, length=taut).stretch == 1
    scene = fu.Scene()
    rope_of(*route, scene=scene)
    assert scene.replace("hoist", length=7.5).ropes["hoist"].tension is None
    with refused('rope "hoist": has neither tension nor length; give one of them'):
        scene.replace("hoist", tension=None)


def test_radius_of_a_sheave():
    with refused('rope "hoist": radius of sheave "top" must be above that of the rope, 0.002 m, got 0.002 m; radius is '
                 "that of the groove plus that of the rope"):
        rope_of(ENDS[0], sheave(0, 3, 0.002), ENDS[1])
    section = fu.GeneralSection(area=1e-5, second_moment_about_z=1e-12)
    assert rope_of(ENDS[0], sheave(0, 3, 0.002), ENDS[1], section=section, tension=1e5).radius == 0  # it is not told


def test_bending_moves_tangent_points():
    """They are EI / (2 T R) beyond the circle, while the length on it is that of the radius.

    The offset is that of a beam under tension T whose curvature decays from 1 / R as exp(-x sqrt(T / EI)).
    """
    T, R, EI = 500.0, 0.3, 4e-3 * pi
    offset = EI / (2 * T * R)
    ends = at(-R - offset, -2), at(R + offset, -5)
    route = drawn(ends[0], sheave(0, 0, R), ends[1], section=WIRE["section"], tension=T)
    check_tangents(route)
    (arc,) = route.sheaves
    assert arc.radius == R and arc.tangent_radius[0] - R == pytest.approx(offset, rel=1e-10)
    assert arc.wrap == pytest.approx(pi, rel=1e-14) and arc.length == pytest.approx(R * pi, rel=1e-14)
    assert [span.length for span in route.spans] == pytest.approx([2, 5], rel=1e-14)
    length = route.length / (1 + T / (4e3 * pi))
    by_length = drawn(ends[0], sheave(0, 0, R), ends[1], section=WIRE["section"], length=length)
    # the tension of a given length is that of the route on circles, longer or shorter by far less than its stretch
    assert by_length.sheaves[0].tangent_radius[1] - R == pytest.approx(offset, rel=1e-3)
    limit = EI / (MAX_LAYER * R)**2
    loose = fu.Rope("hoist", route=[ends[0], sheave(0, 0, R), ends[1]], **WIRE, tension=limit / 4).drawn({})
    assert loose.sheaves[0].tangent_radius[1] - R == pytest.approx(MAX_LAYER**2 * R / 2, rel=1e-10)  # not 4 times that


C, R = 2.0, 0.3
BELT = sheave(0, 0, R, "left", "one"), sheave(C, 0, R, "left", "two")


def test_closed_belt():
    """Around two equal pulleys, open: half a turn on each."""
    route = drawn(*BELT, closed=True)
    check_tangents(route)
    assert [arc.sense for arc in route.sheaves] == [1, 1]
    assert [arc.wrap for arc in route.sheaves] == pytest.approx([pi, pi], rel=1e-14)
    assert [span.length for span in route.spans] == pytest.approx([C, C], rel=1e-14)
    assert route.length == pytest.approx(2 * C + tau * R, rel=1e-14)
    assert route.spans[0].start == pytest.approx([0, -R], abs=1e-15)  # from the first sheave to the second
    assert route.spans[1].end == pytest.approx([0, R], abs=1e-15)


def test_closed_belt_of_two_radii():
    """The wraps are pi - 2 a and pi + 2 a, with sin a = (R2 - R1) / C."""
    R2 = 0.5
    route = drawn(BELT[0], sheave(C, 0, R2, "left", "two"), closed=True)
    check_tangents(route)
    a = asin((R2 - R) / C)
    assert [arc.wrap for arc in route.sheaves] == pytest.approx([pi - 2 * a, pi + 2 * a], rel=1e-14)
    assert [span.length for span in route.spans] == pytest.approx(2 * [sqrt(C**2 - (R2 - R)**2)], rel=1e-14)


def test_crossed_belt():
    """Around two equal pulleys that turn in opposite senses: wraps of pi + 2 b, with sin b = 2 R / C."""
    route = drawn(BELT[0], sheave(C, 0, R, "right", "two"), closed=True)
    check_tangents(route)
    b = asin(2 * R / C)
    assert [arc.sense for arc in route.sheaves] == [1, -1]
    assert [arc.wrap for arc in route.sheaves] == pytest.approx([pi + 2 * b, pi + 2 * b], rel=1e-14)
    assert route.length == pytest.approx(2 * sqrt(C**2 - 4 * R**2) + 2 * R * (pi + 2 * b), rel=1e-14)


def test_closed_triangle():
    """Sides by default are those to which the polygon turns; the wraps are one turn in all, spans those of centres."""
    corners = np.array([[0, 0], [3, 0], [0, 4.0]])
    for order, sense in (([0, 1, 2], 1), ([0, 2, 1], -1)):
        items = [sheave(*corners[k], R, name=f"s{k}") for k in order]
        route = drawn(*items, closed=True)
        check_tangents(route)
        assert [arc.sense for arc in route.sheaves] == 3 * [sense]
        assert sum(arc.wrap for arc in route.sheaves) == pytest.approx(tau, rel=1e-14)
        assert route.length == pytest.approx(12 + tau * R, rel=1e-14)
        assert rope_of(*items, closed=True).elements_of_spans == (4, 4, 4)


def test_closed_ropes_that_are_none():
    for route, complaint in (
            ((ENDS[0], TOP, ENDS[1]), "is closed, and its route has an Anchor; give two sheaves or more, without "
                                      "anchors"),
            ((*BELT, ENDS[1]), "is closed, and its route has an Anchor; give two sheaves or more, without anchors")):
        with refused(f'rope "hoist": {complaint}'):
            rope_of(*route, closed=True)
    with refused('rope "hoist": route must begin and end with an Anchor or a Drum, its first item is the '
                 f'sheave "one"; {ORDER}'):
        rope_of(*BELT)
    with refused('rope "hoist": elements must be one number or 2, one for each span, got 3'):
        rope_of(*BELT, closed=True, elements=[1, 2, 3])
    with refused('rope "hoist": the route runs straight through the centre of sheave "one", which does not tell its '
                 'side; give side="left" or "right"'):
        rope_of(sheave(0, 0, R, name="one"), sheave(C, 0, R, name="two"), closed=True)


GRIP = {"friction": 0.3, "inertia": 0.1}


@pytest.mark.parametrize(("given", "complaint"), [
    (GRIP | {"torque": 1.0, "angle": 2.0}, "has two drives, torque and angle; give one of them"),
    (GRIP | {"torque": 1.0, "velocity": 2.0}, "has two drives, torque and velocity; give one of them"),
    (GRIP | {"angle": 1.0, "velocity": 2.0}, "has two drives, angle and velocity; give one of them"),
    ({"torque": 1.0, "friction": 0.3}, "has torque, but no inertia; give its inertia in kg m²"),
    ({"damping": 1.0, "friction": 0.3}, "has damping, but no inertia; give its inertia in kg m²"),
    ({"inertia": 0.1}, "has inertia, but no friction with the rope, which then never turns it; give its friction, or "
                       "leave the inertia out"),
    ({"inertia": -0.1}, "inertia must not be negative, got -0.1 kg m²"),
    (GRIP | {"damping": -1}, "damping must not be negative, got -1 N m s"),
    (GRIP | {"zones": 0}, "zones must be a whole number from 1 to 16, got 0"),
    (GRIP | {"zones": 17}, "zones must be a whole number from 1 to 16, got 17"),
    (GRIP | {"zones": 2.5}, "zones must be a whole number from 1 to 16, got 2.5"),
])
def test_drives_are_checked(given, complaint):
    with refused(f'sheave "top": {complaint}'):
        fu.Sheave("top", **{"at": (0, 3, 0), "radius": 0.3} | given)


def test_drives():
    """A sheave rotates where it has inertia or a prescribed motion; its wrap has zones where there is friction."""
    held, idle = sheave(0, 3, 0.3, friction=0.3, zones=5), sheave(0, 3, 0.3, zones=5)
    assert (held.turns_round, held.n_zones, held.coefficient) == (False, 5, 0.3)
    assert (idle.turns_round, idle.n_zones, idle.coefficient) == (False, 1, 0)
    assert sheave(0, 3, 0.3, **GRIP).turns_round and sheave(0, 3, 0.3, friction=0.3, velocity=2.0).turns_round
    assert sheave(0, 3, 0.3, **GRIP, torque=1.0).prescribed is None
    assert [sheave(0, 3, 0.3, friction=0.3, zones=n).refined().zones for n in (1, 8, 9, 16)] == [2, 16, 4, 8]
    assert fu.Sheave("top", at="load", radius=0.3, **GRIP).turns_round  # on a body it turns freely


@pytest.mark.parametrize(("make", "complaint"), [
    (lambda: fu.Anchor(), "anchor: has neither on nor at; name a body, or give a point at=(x, y, z) of the ground"),
    (lambda: fu.Anchor((0, 3, 0)),
     "anchor: on must be a body, a cable or the name of one, got (0, 3, 0); give a point of the ground as at=(x, y, z)"
     ),
    (lambda: sheave(0, 0, -0.3), 'sheave "top": radius must be positive, got -0.3 m'),
    (lambda: sheave(0, 0, 0.3, "above"), 'sheave "top": side "above" is not known; known: left, right'),
    (lambda: sheave(0, 0, 0.3, turns=-1), 'sheave "top": turns must be a whole number from 0 to 1000, got -1'),
    (lambda: sheave(0, 0, 0.3, turns=0.5), 'sheave "top": turns must be a whole number from 0 to 1000, got 0.5'),
    (lambda: sheave(0, 0, 0.3, name="a.b"), 'sheave "a.b": name must be made of letters, digits, _ and -, and begin '
                                            "with no digit, got 'a.b'"),
    (lambda: fu.Sheave("top", radius=0.3), 'sheave "top": at is missing'),
])
def test_items_are_checked(make, complaint):
    with refused(complaint):
        make()


@pytest.mark.parametrize(("item", "complaint"), [
    (3, 'route.1 must be an item such as Anchor("A") or Sheave("top", at=(0, 9, 0), radius=0.3), got 3'),
    ({"name": "top"}, "route.1 has no kind; known: anchor, sheave, drum, block"),
    ({"kind": "pulley"}, 'route.1 has the unknown kind "pulley"; known: anchor, sheave, drum, block'),
    ({"kind": "sheave", "name": "top", "at": (0, 3, 0), "radius": 0}, "route.1.radius must be positive, got 0 m"),
    ({"kind": "sheave", "name": "top", "at": (0, 3, 0)}, "route.1.radius is missing"),
    ({"kind": "sheave", "name": "top", "at": (0, 3, 0), "radius": 1, "mass": 1},
     'route.1 "mass" is not known here; known: name, at, radius, side, inertia, torque, angle, velocity, damping, '
     "axis, max_fleet_angle, friction, zones, turns, contact, groove_width"),
    ({"kind": "sheave", "name": "top", "at": (0, 3, 0), "radius": 1, "inertia": 1},
     "route.1 has inertia, but no friction with the rope, which then never turns it; give its friction, or leave the "
     "inertia out"),
])
def test_items_of_a_route_are_checked(item, complaint):
    with refused(f'rope "hoist": {complaint}'):
        rope_of(ENDS[0], item, ENDS[1])


def test_what_holds_it():
    scene = fu.Scene()
    scene.rigid_body("load", position=(1, 0, 0), **BODY)
    with refused('rope "hoist": route.2: there is no body or cable "lod"; did you mean "load"?'):
        rope_of(ENDS[0], TOP, fu.Anchor("lod"), scene=scene)
    with refused('rope "hoist": route.2: acts on body "load" and takes no arc-length s; give a point in body axes, or '
                 "nothing for its origin"):
        rope_of(ENDS[0], TOP, fu.Sheave("low", at=("load", 0.5), radius=0.1), ENDS[1], scene=scene)
    scene.cable("track", start=(0, 0, 0), end=(1, 0, 0), elements=2, element="cable8p", **WIRE)
    for item, rest in ((fu.Anchor("track"), ""), (fu.Anchor("track", at=(0, 0, 0)), ", not a point at")):
        with refused(f'rope "hoist": route.2: acts on cable "track" and needs the arc-length s there{rest}'):
            rope_of(ENDS[0], TOP, item, scene=scene)
    with refused("anchor: has s, but not the cable on which it is; give on, the name of the cable"):
        fu.Anchor(at=(0, 0, 0), s=1.0)
    with refused('rope "hoist": route.1: s must lie on the cable, in [0, 1] m, got 2 m'):
        rope_of(ENDS[0], fu.Sheave("top", at=("track", 2.0), radius=0.1), ENDS[1], scene=scene)
    assert not scene.ropes


def test_names_are_unique():
    def scene():
        made = fu.Scene()
        made.rigid_body("top", position=(1, 0, 0), **BODY)
        return made

    with refused('rope "hoist": sheave "top": there is already a rigid_body of that name; give each part its own name'):
        rope_of(*ENDS[:1], TOP, ENDS[1], scene=scene())
    with refused('rope "hoist": sheave "time": its name is a name of results; give another one'):
        rope_of(ENDS[0], sheave(0, 3, 0.3, name="time"), ENDS[1])
    made = scene()
    rope_of(ENDS[0], sheave(0, 3, 0.3, name="spring_1"), ENDS[1], scene=made)
    with refused('rigid_body "spring_1": there is already a sheave of that name; give each part its own name'):
        made.rigid_body("spring_1", position=(1, 0, 0), **BODY)
    with refused('rope "other": sheave "spring_1": there is already a sheave of that name; give each part its own '
                 "name"):
        made.rope("other", route=[ENDS[0], sheave(0, 3, 0.3, name="spring_1"), ENDS[1]], tension=1.0, **WIRE)
    assert made.spring("top", (0, 0, 0), stiffness=1.0).name == "spring_2"
    assert made.event("spring_1", quantity="top.position.y").name == "spring_1"  # events have names of their own


SPATIAL = {"start": (0, 0, 0), "end": (1, 0, 0), "elements": 2, "element": "cable12", **WIRE}
IN_XZ = SPATIAL | {"element": "cable8p", "up": (0, 0, 1)}


def test_it_is_planar():
    route = ENDS[0], TOP, ENDS[1]
    spatial = ('rope "hoist" is planar, but the elements of cable "wire" (cable12) are spatial; take planar elements '
               'for all of them, or spatial ones: element="cable12" for ropes')
    across = ('rope "hoist" lies in the plane z = 0, but cable "wire" in the plane y = 0; draw the scene in the plane '
              "z = 0")
    for cable, complaint, gravity in ((SPATIAL, spatial, (0, -9.81, 0)), (IN_XZ, across, (0, 0, -9.81))):
        scene = fu.Scene(gravity=gravity)
        scene.cable("wire", **cable)
        with refused(f'rope "hoist": {complaint}'):
            rope_of(*route, scene=scene)
        scene = fu.Scene(gravity=(0, 0, 0))
        rope_of(*route, scene=scene)
        with refused(f'cable "wire": {complaint}'):
            scene.cable("wire", **cable)
    scene.cable("wire", **SPATIAL | {"element": "cable8p"})
    assert scene.dim == 2 and scene.plane is None


def test_all_parts_stay_in_its_plane():
    leaves = ('leaves the plane z = 0 of the cable8p rope "hoist"; let it stay in the plane, or take '
              'element="cable12" for the rope')
    with refused(f'rope "hoist": route.2 (1, 0, 0.5) m {leaves}'):
        rope_of(ENDS[0], TOP, fu.Anchor(at=(1, 0, 0.5)))
    with refused(f'rope "hoist": route.1 (0, 3, 1) m {leaves}'):
        rope_of(ENDS[0], fu.Sheave("top", at=(0, 3, 1), radius=0.3), ENDS[1])
    scene = fu.Scene()
    scene.rigid_body("load", position=(1, 0, 2), **BODY)
    with refused(f'rigid_body "load": position (1, 0, 2) m {leaves}'):
        rope_of(ENDS[0], TOP, ENDS[1], scene=scene)
    scene = fu.Scene()
    rope_of(ENDS[0], TOP, ENDS[1], scene=scene)
    with refused(f'rigid_body "load": position (1, 0, 2) m {leaves}'):
        scene.rigid_body("load", position=(1, 0, 2), **BODY)
    with refused(f"scene: gravity (0, 0, -9.81) m/s² {leaves}"):
        rope_of(ENDS[0], TOP, ENDS[1], scene=fu.Scene(gravity=(0, 0, -9.81)))


def noted(*route, **given):
    """Return the messages of a scene with a rope; each is a warning, too."""
    scene = fu.Scene()
    with pytest.warns(fu.FunicularWarning) as caught:
        rope_of(*route, scene=scene, **given)
    assert [str(each.message) for each in caught] == scene.messages
    assert {each.filename for each in caught} == {__file__}
    return scene.messages


def test_notes_on_bending():
    EI = 4e-3 * pi
    limit = EI / (0.2 * 0.3)**2
    (note,) = noted(ENDS[0], TOP, ENDS[1], tension=0.999 * limit)
    assert note == ('rope "hoist": sheave "top": at a tension of ' f"{0.999 * limit:.9g} N the rope's bending reaches "
                    "further than 0.2 of the radius 0.3 m along the span: sqrt(EI / T) is "
                    f"{0.06 / sqrt(0.999):.9g} m, so that its tangent points are inaccurate; take a thinner rope, a "
                    "larger radius, or more tension")
    (note,) = noted(ENDS[0], sheave(0, 3, 0.0399), ENDS[1])
    assert note == ('rope "hoist": sheave "top": its radius 0.0399 m is below 10 diameters of the rope, 0.004 m: a '
                    "bending stress of 5.01e+07 Pa, E d / (2 R)")
    rope_of(ENDS[0], TOP, ENDS[1], tension=1.001 * limit)
    rope_of(ENDS[0], sheave(0, 3, 0.0401), ENDS[1])


def test_notes_on_bending_at_a_drum():
    """They are those of sheaves, with the tension of the span at the drum."""
    limit = 4e-3 * pi / (0.2 * 0.3)**2

    def drum(radius: float) -> fu.Drum:
        return fu.Drum("winch", at=(0, 3, 0), radius=radius, side="right", length_in_store=5.0)

    for route in ((drum(0.3), at(3, 0)), (at(-3, 0), drum(0.3))):
        (note,) = noted(*route, tension=0.999 * limit)
        assert note.startswith(f'rope "hoist": drum "winch": at a tension of {0.999 * limit:.9g} N the rope\'s bending')
        rope_of(*route, tension=1.001 * limit)
    (note,) = noted(drum(0.0399), at(3, 0))
    assert note.startswith('rope "hoist": drum "winch": its radius 0.0399 m is below 10 diameters of the rope, 0.004 m')
    (note,) = noted(drum(0.3), at(3, 0), elements=300, **THIN)
    assert note.startswith('rope "hoist": drum "winch": its radius 0.3 m is above 20 lengths of the elements beside it')


def test_note_on_elements_far_shorter_than_a_sheave():
    """Spans of sqrt(10 - 0.3²) = 3.148 m."""
    (note,) = noted(ENDS[0], TOP, ENDS[1], elements=(3, 210), **THIN)
    assert note == ('rope "hoist": sheave "top": its radius 0.3 m is above 20 lengths of the elements beside it, '
                    f"{sqrt(10 - 0.09) / 210:.9g} m: steps may be very short or not converge; take fewer elements")
    rope_of(ENDS[0], TOP, ENDS[1], elements=(209, 3), **THIN)


def test_note_on_a_wrong_side():
    """The line between both ends passes below the sheave, on whose left the rope was to run over it."""
    (note,) = noted(at(-3, 2.5), sheave(0, 3, 0.3, "left"), at(3, 2.5), **THIN)
    heading = atan2(0.5, 3) - asin(0.3 / hypot(3, 0.5))
    assert note == (f'rope "hoist": sheave "top": the rope runs around it by {tau - 2 * heading:.9g} rad and crosses '
                    "itself; give the other side if that is not meant")


FILE = """
gravity = [0, -9.81, 0]

[[rigid_body]]
name = "load"
mass = 1
inertia = [1, 1, 1]
position = [1, 0, 0]

[[rope]]
name = "hoist"
section = { shape = "circle", radius = 0.002 }
material = { youngs_modulus = 1e9, poisson_ratio = 0.3, density = 1e3 }
elements = [3, 2]
length = 6
route = [
    { kind = "anchor", at = [-1, 0, 0] },
    { kind = "sheave", name = "top", at = ["load", [-1, 3, 0]], radius = 0.3, side = "right", turns = 1 },
    { kind = "anchor", on = "load" },
]
"""


def from_python() -> fu.Scene:
    scene = fu.Scene()
    scene.rigid_body("load", position=(1, 0, 0), **BODY)
    rope_of(ENDS[0], fu.Sheave("top", at=("load", (-1, 3, 0)), radius=0.3, side="right", turns=1), fu.Anchor("load"),
            scene=scene, elements=(3, 2), length=6)
    return scene


def test_scene_files():
    scene = fu.Scene.from_toml(FILE)
    assert scene.to_toml() == from_python().to_toml() and scene.ropes == from_python().ropes
    assert fu.Scene.from_toml(scene.to_toml()).ropes == scene.ropes
    for other in (copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        assert other.ropes == scene.ropes
    tables = FILE.replace("route = [", "").replace("\n]\n", "\n")
    tables = re.sub(r"    \{ (.*) \},", lambda found: "[[rope.route]]\n" + re.sub(r", (?=\w+ =)", "\n", found[1]),
                    tables)
    assert fu.Scene.from_toml(tables).ropes == scene.ropes


def test_mistakes_in_files():
    with refused('scene, line 16: rope "hoist": route.1.radius must be positive, got -0.3 m'):
        fu.Scene.from_toml(FILE.replace("radius = 0.3", "radius = -0.3"))
    with refused('scene, line 10: rope "hoist": sheave "load": there is already a rigid_body of that name; give each '
                 "part its own name"):
        fu.Scene.from_toml(FILE.replace('"top"', '"load"'))


def test_schema():
    validator = jsonschema.Draft7Validator(json.loads(json.dumps(scene_schema())))
    for text in (FILE, from_python().to_toml()):
        validator.validate(tomllib.loads(text))
    for old, new in (('"sheave"', '"pulley"'), ("radius = 0.3", "radius = 0"), ('"right"', '"above"'), ("turns = 1",
                     "turns = -1"), ("length = 6", "lenght = 6"), ("[3, 2]", "[3, 0]"), ('on = "load"', 'of = "load"')):
        assert not validator.is_valid(tomllib.loads(FILE.replace(old, new))), new
    rope = scene_schema()["properties"]["rope"]["items"]
    assert set(rope["required"]) == {"name", "route", "section", "material"}
    assert rope["properties"]["element"]["enum"] == [*ELEMENTS]


def test_paths_into_it():
    scene = from_python()
    made = changed(scene, {"hoist.route.1.radius": 0.4, "hoist.length": 5.0})
    assert made.ropes["hoist"].route[1].radius == 0.4 and made.ropes["hoist"].length == 5.0


def test_without_and_connections():
    scene = from_python()
    assert not scene.without("load").ropes
    assert scene.without("hoist").dim == 3
    assert repr(scene) == "<funicular.Scene: 1 rigid body, 1 rope>"
