"""Ropes in space as drawn: tangent points, refusals, notes, and files."""

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from funicular.parts.rope_route import RoutePoint, drawn_route
from funicular.parts.rope_route_space import fleet_angles, groove_of, span_in_space
from ropes.swings import on_the_line

GIVEN = {"section": fu.Circle(radius=1e-3), "tension": 20.0, "element": "cable12",
         "material": fu.Material(youngs_modulus=6e8, poisson_ratio=0.3, density=7000)}
BODY = {"mass": 2.0, "inertia": (1, 1, 1)}
ENDS = fu.Anchor(at=(-0.3, -1, 0)), fu.Anchor(at=(0.8, -0.5, 0.05))
TOP = fu.Sheave("top", at=(0, 0, 0), radius=0.3, side="right")


def rope_of(*route, scene=None, **given):
    scene = scene or fu.Scene()
    scene.rope("hoist", route=list(route), **GIVEN | given)
    return scene


def sheave(centre, radius, sense, axis=(0, 0, 1)):
    return RoutePoint("sheave", np.array(centre, dtype=float), radius, sense, groove=groove_of(axis))


def end(place):
    return RoutePoint("end", np.array(place, dtype=float), groove=groove_of((0, 0, 1)))


def test_a_tangent_point_is_that_of_the_reference():
    place = np.array([0.809249, -0.495093, 0.126487])
    foot, along, length = on_the_line(0.3, place)
    found = span_in_space(sheave((0, 0, 0), 0.3, -1), end(place), 0.0)
    assert found.start == pytest.approx(foot, abs=1e-15)
    assert found.direction == pytest.approx(along, abs=1e-15)
    assert found.length == pytest.approx(length, abs=1e-15)


@pytest.mark.parametrize("axis", [(0, 0, 1), (0.3, -0.2, 1), (0, 1, 0), (1, 2, 3)])
def test_both_tangent_points_meet_the_conditions(axis):
    """Across the radius, and the arm of the tension about both axes is the radius."""
    ends = sheave((0, 0, 0), 0.3, -1, (0, 0, 1)), sheave((1.2, 0.3, 0.2), 0.25, 1, axis)
    try:
        span = span_in_space(*ends, 0.0)
    except ValueError as error:
        assert "steeply" in error.args[0]
        return
    for each, place in zip(ends, (span.start, span.end), strict=True):
        x, about = place - each.centre, np.cross(*each.groove.T)
        assert about @ x == pytest.approx(0, abs=1e-15)
        assert span.direction @ x == pytest.approx(0, abs=1e-14)
        arm = each.sense * about @ np.cross(x, span.direction)
        assert arm == pytest.approx(each.radius, abs=1e-14)


def test_in_a_plane_it_is_the_planar_route():
    """Bits may differ; angles and lengths do not by more than rounding."""
    points = [((-1, -1), 0.0, 0), ((0, 0), 0.3, -1), ((1, -0.7), 0.2, 1), ((2, 0.5), 0.0, 0)]
    plane = drawn_route([RoutePoint("", np.array(c, dtype=float), R, s) for c, R, s in points])
    space = drawn_route([sheave((*c, 0), R, s) if R else end((*c, 0)) for c, R, s in points], 0.0, False, span_in_space)
    for one, other in zip(plane.spans, space.spans, strict=True):
        assert other.start == pytest.approx([*one.start, 0], abs=1e-14)
        assert other.length == pytest.approx(one.length, abs=1e-14)
    for one, other in zip(plane.sheaves, space.sheaves, strict=True):
        assert (one.sense, one.radius) == (other.sense, other.radius)
        assert other.wrap == pytest.approx(one.wrap, abs=1e-14)
    assert np.abs(fleet_angles(space)).max() < 1e-15


def test_the_groove_of_an_axis():
    assert np.array_equal(groove_of((0, 0, 2)), np.eye(3)[:, :2])
    for axis in ((1, 0, 0), (0, -3, 0), (1, 2, -3)):
        groove = groove_of(axis)
        assert groove.T @ groove == pytest.approx(np.eye(2), abs=1e-15)
        assert np.cross(*groove.T) == pytest.approx(np.array(axis) / np.linalg.norm(axis), abs=1e-15)


def test_the_side_follows_from_the_route():
    """A sheave without a side has that of the other scene with one."""
    found = [rope_of(ENDS[0], fu.Sheave("top", at=(0, 0, 0), radius=0.3, axis=(0, 0, sign), side=side), ENDS[1]
                     ).ropes["hoist"].drawn({}) for sign, side in ((1, "right"), (1, None), (-1, None), (-1, "left"))]
    assert [route.sheaves[0].sense for route in found] == [-1, -1, 1, 1]
    for route in found[1:]:
        assert route.length == pytest.approx(found[0].length, abs=1e-14)


def test_what_is_refused():
    with refused('rope "hoist": the span between sheave "top" and the last anchor leaves the groove of sheave "top" '
                 "too steeply: 1.6 m along its axis and 1 m from it; turn its axis across the span, or move them "
                 "apart"):
        rope_of(ENDS[0], TOP, fu.Anchor(at=(0.8, -0.6, 1.6)))
    with refused('rope "hoist": sheave "top" contains the last anchor: 0.206155281 m from its centre, and its '
                 "radius is 0.3 m; move them apart, or take smaller radii"):
        rope_of(ENDS[0], TOP, fu.Anchor(at=(0.2, 0, 0.05)))
    with refused('rope "hoist": a span of 0.258066902 m is too short for its fleet angle 0.397914276 rad at sheave '
                 '"top", from which it would slide: its length must be above 3 R tan f; turn the axis of the sheave '
                 "across the span, or move it away"):
        rope_of(ENDS[0], TOP, fu.Anchor(at=(0.35, -0.2, 0.1)))
    scene = rope_of(ENDS[0], TOP, ENDS[1])
    with refused('rope "other": its element is "cable8p", but that of rope "hoist" is "cable12"; take the same element '
                 "for all ropes"):
        scene.rope("other", route=[fu.Anchor(at=(-1, 0, 0)), fu.Sheave("low", at=(0, -1, 0), radius=0.3),
                                   fu.Anchor(at=(1, 0, 0))], **GIVEN | {"element": "cable8p"})
    with refused('rope "hoist": route.1 axis (0, 1, 0) leaves the plane z = 0 of the cable8p rope "hoist"; let it stay '
                 'in the plane, or take element="cable12" for the rope'):
        rope_of(ENDS[0], fu.Sheave("top", at=(0, 0, 0), radius=0.3, axis=(0, 1, 0)), fu.Anchor(at=(0.8, -0.5, 0)),
                element="cable8p")


def test_a_large_fleet_angle_of_a_drum_is_reported():
    winch = fu.Drum("winch", at=(-0.3, -1, 0), radius=0.2, side="right", axis=(0, 0.2, 1), length_in_store=3.0)
    with pytest.warns(fu.FunicularWarning, match='drum "winch": the fleet angle .* rad exceeds max_fleet_angle, 0.07'):
        rope_of(winch, TOP, ENDS[1])


def test_a_large_fleet_angle_is_reported():
    with pytest.warns(fu.FunicularWarning, match='sheave "top": the fleet angle .* rad exceeds max_fleet_angle, 0.07'):
        rope_of(ENDS[0], TOP, fu.Anchor(at=(0.8, -0.5, 0.13)))
    rope_of(ENDS[0], fu.Sheave("top", at=(0, 0, 0), radius=0.3, side="right", max_fleet_angle=0.2),
            fu.Anchor(at=(0.8, -0.5, 0.13)))


def test_bodies_and_cables_beside_it_are_spatial():
    scene = rope_of(ENDS[0], TOP, ENDS[1])
    assert scene.dim == 3
    scene.rigid_body("load", position=(1, 2, 3), **BODY)
    with refused('cable "other": rope "hoist" is spatial, but the elements of cable "other" (cable8p) are planar; take '
                 'planar elements for all of them, or spatial ones: element="cable12" for ropes'):
        scene.cable("other", start=(0, 1, 0), end=(1, 1, 0), elements=2, element="cable8p", section=GIVEN["section"],
                    material=GIVEN["material"])
    scene.cable("wire", start=(0, 1, 1), end=(1, 1, 0), elements=2, element="cable12", section=GIVEN["section"],
                material=GIVEN["material"])
    scene.pin("wire", s=0.0)


def test_a_scene_file_has_the_axis():
    scene = rope_of(ENDS[0], fu.Sheave("top", at=(0, 0, 0), radius=0.3, side="right", axis=(0, 0.1, 1)), ENDS[1])
    again = fu.Scene.from_toml(scene.to_toml())
    assert again.ropes == scene.ropes and again.dim == 3
    assert again.ropes["hoist"].sheaves[0].axis == (0, 0.1, 1)
