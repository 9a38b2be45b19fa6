"""Pictures of ropes over sheaves: lines, marks on the material, wheels, charts."""

import funicular as fu
import numpy as np
import pytest
from funicular import SceneError
from funicular.results.pictures import save_plots
from funicular.results.trajectories import check_output, default_outputs, known_outputs
from funicular.view.animation import CableShape, Clip, material_marks
from funicular.view.decimation import decimated
from funicular.view.page import described, is_exaggerable
from funicular.view.page_arrays import unpack
from funicular.view.plot import shape_figure
from funicular.view.surfaces import spoke, surface, wheel
from funicular.view.vtk import frame_arrays
from numpy.testing import assert_allclose
from viewed_scenes import belt, hoist, tackle

RADIUS = 0.25


@pytest.fixture(scope="module")
def run():
    return hoist().run(0.4, output_step=0.02, tol=1e-4, integrator="radau", progress=False)


@pytest.fixture(scope="module")
def clip(run):
    return run.animation("a run").clips[0]


def part(parts, name):
    return next(each for each in parts if each.name == name)


def quantity(cable, key):
    return next(each.values for each in cable.quantities if each.key == key)


def test_a_rope_as_drawn_is_straight_between_arcs():
    scene = hoist()
    rope = part(scene.animation().clips[0].cables, "rope")
    route = scene.route_of(scene.ropes["rope"])
    line, s = rope.position[0], rope.material_s[0]
    assert_allclose(line[[0, -1]], [(-0.25, -2.5, 0), (1.9, -2.3348, 0)], atol=1e-12)
    assert_allclose(s[[0, -1]], [0, route.free_length], rtol=1e-12, atol=1e-15)
    ends = [route.spans[0].length / route.stretch, (route.spans[0].length + route.sheaves[0].length) / route.stretch]
    on = (s > ends[0] + 1e-9) & (s < ends[1] - 1e-9)
    assert on.sum() > 20
    assert_allclose(np.linalg.norm(line[on], axis=1), RADIUS, rtol=1e-12)
    for span, inside in zip(route.spans, (s <= ends[0] + 1e-9, s >= ends[1] - 1e-9), strict=True):
        away = line[inside, :2] - span.start
        assert_allclose(away - np.multiply.outer(away @ span.direction, span.direction), 0, atol=1e-12)
    assert_allclose(quantity(rope, "tension"), 42, rtol=1e-9)
    assert rope.section == {"shape": "circle", "diameter": 4e-3} and rope.section_y is None


def test_a_run_begins_as_drawn(clip):
    first = part(clip.cables, "rope")
    assert_allclose(first.material_s[0], first.s, atol=1e-9)
    assert_allclose(first.position[0], first.reference, atol=1e-9)


def test_results_are_stations(run, clip):
    """Spans pass the points of the results; the arc is drawn anew."""
    rope, points = part(clip.cables, "rope"), run["rope.position"]
    span = points[:, :13]  # of three elements, four points each
    at = [np.argmin(np.linalg.norm(rope.position[0] - point, axis=1)) for point in span[0]]
    assert_allclose(rope.position[:, at], span, atol=1e-12)
    assert_allclose(rope.material_s[:, at], run["rope.s"][:, :13], atol=1e-12)


def test_wraps_stay_on_their_circle(run, clip):
    rope = part(clip.cables, "rope")
    s, ends = rope.material_s, run["rope.s"][:, [12, 27]]
    for frame in range(len(run.time)):
        on = (s[frame] > ends[frame, 0] + 1e-9) & (s[frame] < ends[frame, 1] - 1e-9)
        line = rope.position[frame, on]
        assert_allclose(np.linalg.norm(line, axis=1), RADIUS, rtol=1e-12)
        angles = np.unwrap(np.arctan2(line[:, 1], line[:, 0]))
        turn = -np.diff(angles)
        assert_allclose(turn, run["top.wrap_angle"][frame] / (len(turn) + 2), rtol=1e-9)  # equal, clockwise
        assert turn[0] <= np.pi / 36


def test_marks_are_fixed_to_the_material(run, clip):
    """A mark on the span of the counterweight follows it at its stretched distance: s (1 + T/EA), T within 60 N."""
    rope = part(clip.cables, "rope")
    assert rope.spacing == 0.1
    EA = run.scene.ropes["rope"].stiffness[0]
    for frame in range(len(run.time)):
        marks = material_marks(rope, frame)
        assert len(marks) == 62  # 6.13 m, the end at s = 0 included
        away = np.linalg.norm(marks[:20] - run["C.position"][frame], axis=1)
        assert_allclose(away, 0.1 * np.arange(20), rtol=60 / EA, atol=1e-9)
    assert np.ptp(rope.material_s[:, 60]) > 0.01  # stations let the material pass


def test_tension_along_a_rope_meets_that_at_its_sheave(run, clip):
    """Of the two lowest modes of the strain at the ends of the spans, with three elements each, and the multipliers.

    Measured without damping: 0.3 N of 42 N.
    """
    rope = part(clip.cables, "rope")
    for side, row in (("on", 12), ("off", 27)):
        s = run["rope.s"][:, row]
        at = np.argmin(np.abs(rope.material_s - s[:, None]), axis=1)
        found = quantity(rope, "tension")[np.arange(len(s)), at]
        assert_allclose(found[1:], run[f"top.tension_{side}"][1:], atol=0.5)
    assert_allclose(quantity(rope, "tension"), run.scene.ropes["rope"].stiffness[0] * quantity(rope, "strain"))


def test_a_sheave_is_a_wheel_that_turns(run, clip):
    top = part(clip.bodies, "top")
    assert_allclose(top.position, np.zeros((len(run.time), 3)), atol=1e-15)
    assert top.shape["kind"] == "wheel"
    assert top.shape["radius"] == pytest.approx(RADIUS - 2e-3)
    angle = run["top.angle"]
    assert np.ptp(angle) > 0.1
    for frame in range(len(run.time)):
        assert_allclose(spoke(top, frame)[1], top.shape["radius"] * np.array([np.cos(angle[frame]),
                                                                              np.sin(angle[frame]), 0]), atol=1e-12)
    assert_allclose(top.quantities["tension off"][1], run["top.tension_off"])
    assert top.quantities["wrap angle"][0] == "rad"


def test_a_sheave_on_a_body_goes_along():
    scene = tackle()
    clip = scene.animation().clips[0]
    assert_allclose(part(clip.bodies, "block").position, [scene.bodies["hook"].point((0, 0.1, 0))], atol=1e-12)
    kinds = {(mark.name, mark.kind) for mark in clip.marks}
    assert kinds == {("line", "ground"), ("block", "joint"), ("top", "ground"), ("line", "joint")}
    assert {segment.name for segment in clip.segments} == {"hook, block", "W, line"}


def test_the_surface_of_a_wheel_is_closed_and_looks_outward():
    """Its volume by the divergence theorem: rim, hub and five bars."""
    vertices, triangles = wheel(1.0, 0.2)
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    volume = np.einsum("fi,fi->f", a, np.cross(b, c)).sum() / 6
    rim = 72 / 2 * np.sin(2 * np.pi / 72) * (1 - 0.86**2) * 0.2
    hub = 24 / 2 * np.sin(2 * np.pi / 24) * 0.16**2 * (1 - 0.4**2) * 0.2
    bars = (0.86 - 0.8 * 0.16 + 0.3 * 0.14) * (0.2 + 4 * 0.07) * 0.6 * 0.2
    assert volume == pytest.approx(rim + hub + bars, rel=1e-12)
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    assert len(surface({"kind": "wheel", "radius": 1.0, "width": 0.2})[0]) == len(vertices)


def test_a_belt_is_closed_and_has_marks_without_a_seam():
    scene = belt()
    line = part(scene.animation().clips[0].cables, "belt")
    length = scene.route_of(scene.ropes["belt"]).free_length
    assert_allclose(line.position[0, -1], line.position[0, 0], atol=1e-15)
    assert np.ptp(line.material_s[0]) == pytest.approx(length, rel=1e-12)
    assert length / line.spacing == pytest.approx(round(length / line.spacing), rel=1e-12)
    x = line.position[0, :, 0]
    outward = line.section_y[0, :, 1] * np.sign(line.position[0, :, 1])
    assert (outward[(x > 0.01) & (x < 0.3)] < -0.99).all()  # counter-clockwise: the height points inward


def test_what_runs_is_not_exaggerated(clip):
    assert not is_exaggerable(clip)


def test_the_page_has_the_material_of_the_run(run):
    header, text = described(run.animation())
    rope, arrays = header["clips"][0]["cables"][0], unpack(text, header["arrays"])
    assert rope["spacing"] == 0.1
    position, s = arrays[rope["position"]] + header["origin"], arrays[rope["material_s"]]
    counterweight = np.linalg.norm(position - run["C.position"][:, None], axis=-1)
    near = s < 2.0
    assert near.any()
    assert_allclose(counterweight[near], s[near], rtol=60 / run.scene.ropes["rope"].stiffness[0], atol=1e-4)
    top = next(body for body in header["clips"][0]["bodies"] if body["name"] == "top")
    assert top["shape"]["kind"] == "mesh"


def test_stations_stay_where_the_material_has_a_corner():
    """On a straight line at rest whose material stretches from the middle on, the middle is drawn."""
    x = np.linspace(0, 1, 101)
    position = np.stack([x, 0 * x, 0 * x], axis=1)[None]
    s = np.where(x < 0.5, x, 0.5 + 0.2 * (x - 0.5))[None]
    cable = CableShape("rope", x, position, None, {"shape": "circle", "diameter": 0.1}, position[0], (), s, 0.1)
    few, _ = decimated(Clip("c", np.zeros(1), (cable,)), 1.0)
    assert_allclose(few.cables[0].s, [0, 0.5, 1], atol=0.011)
    assert_allclose(material_marks(cable, 0)[:, 0], [0, 0.1, 0.2, 0.3, 0.4, 0.5, 1], atol=1e-12)


def test_files_have_the_arc_length_at_each_time(run, clip):
    _, cells, data = frame_arrays(clip, 10)
    rope = part(clip.cables, "rope")
    assert_allclose(data["s"][: len(rope.s)], rope.material_s[10])
    assert {kind for kind, _ in cells} == {"line", "triangle"}


def test_charts(run, clip, tmp_path):
    curves = {curve.key: curve for curve in clip.curves}
    keys = list(curves)
    assert keys.index("rope.tension") < keys.index("C.position")
    assert curves["rope.tension"].columns == ("top on", "top off")
    assert_allclose(curves["rope.tension"].values[:, 0], run["top.tension_on"])
    assert_allclose(curves["rope.wraps"].values[:, 0], run["top.wrap_angle"])
    assert "top.tension_on" not in curves and {"top.slip", "top.slip_angle"} <= curves.keys()
    tension, wrap = run.plot("rope").axes
    assert (tension.get_ylabel(), wrap.get_ylabel()) == ("tension / N", "wrap angle / rad")
    assert [text.get_text() for text in tension.get_legend().get_texts()] == ["top, on", "top, off"]
    assert [path.name for path in save_plots(run, tmp_path)] == ["shape.png", "rope.png", "energy.png"]
    shape = shape_figure(run.animation())
    assert [text.get_text() for each in shape.legends for text in each.get_texts()] == ["path of C", "path of L",
                                                                                        "joint", "ground"]


def test_a_scene_without_a_rope_has_no_chart_of_one():
    run = fu.load_scene("paper51").run(0.02, output_step=0.01, tol=1e-2, progress=False)
    with pytest.raises(fu.FunicularError, match='the run has nothing that the picture "rope" shows'):
        run.plot("rope")


def test_a_film_shows_the_marks(run, tmp_path):
    from funicular.view.film import Film

    animation = run.animation()
    film = Film(animation, animation.clips, "tension", 1.0)
    first, second = film.pictures(run.time[[0, -1]])
    assert (first != second).any(axis=-1).sum() > 100
    without = type(animation)(**{**vars(animation), "clips": (Clip(**{**vars(animation.clips[0]), "cables": tuple(
        type(cable)(**{**vars(cable), "spacing": 0.0}) for cable in animation.clips[0].cables)}),)})
    plain = next(Film(without, without.clips, "tension", 1.0).pictures(run.time[:1]))
    assert (first != plain).any(axis=-1).sum() > 300  # 62 dots


def test_a_state_of_rest_and_its_modes():
    """A rope held at both ends. In a mode its ends rest, and its wrap stays on the sheave."""
    scene = hoist(held=True)
    rest = scene.equilibrium()
    line = part(rest.animation().clips[0].cables, "rope")
    assert_allclose(line.position[0, [0, -1]], [(-0.25, -2.5, 0), (1.9, -2.3348, 0)], atol=1e-12)
    modes = scene.modes(3, about=rest)
    assert np.abs(modes["rope.displacement"][:, [0, -1]]).max() < 1e-9
    assert_allclose(modes["rope.s"][:, [0, -1]], 0, atol=1e-9)
    clips = modes.animation().clips
    assert len(clips) == 3 and not any(clip.cables[0].quantities for clip in clips)
    for clip in clips:
        rope = clip.cables[0]
        assert_allclose(rope.reference, line.position[0], atol=1e-12)
        assert np.ptp(rope.position, axis=0).max() > 0.05
        assert is_exaggerable(clip)


def test_a_mode_moves_bodies_and_material_together():
    """Hoisting by a block of two falls: the load moves by half of the counterweight's way, which passes the top."""
    scene = tackle()
    with pytest.warns(fu.FunicularWarning):
        modes = scene.modes(1, as_drawn=True)
    hook, weight = modes["hook.displacement"][0, 1], modes["W.displacement"][0, 1]
    assert hook / weight == pytest.approx(-0.5, abs=2e-3)
    ends, EA = modes["line.displacement"][0, [0, -1], :2], scene.ropes["line"].stiffness[0]
    assert_allclose(ends[0], 0, atol=1e-9)
    assert ends[1, 1] == pytest.approx(weight, abs=1e-3)
    assert np.abs(modes["line.s"][0]).max() == pytest.approx(abs(weight) / (1 + 200 / EA), rel=1e-4)


def test_outputs_of_ropes_do_not_depend_on_the_mesh():
    scene = hoist()
    assert {"top.tension_on", "top.wrap_angle", "rope.end_force"} <= set(known_outputs(scene))
    assert default_outputs(scene) == ["C.position", "L.position"]
    assert default_outputs(belt()) == ["driver.material_speed", "driven.material_speed"]
    check_output(scene, "top.angle")
    with pytest.raises(SceneError, match=r'there is no output "rope\.position"'):
        check_output(scene, "rope.position")


def test_a_rope_in_space_and_its_wheels():
    """Wraps stay in the planes of the grooves, and wheels have the axes of the sheaves."""
    scene = fu.Scene()
    scene.rigid_body("load", mass=2.0, inertia=(1, 1, 1), position=(-0.2, -1.5, 0.02))
    axes = {"a": (0, 0, 1), "b": (0, 1, 0), "c": (1, 0, 0)}
    scene.rope("rope", element="cable12", elements=2, tension=20.0, route=[
        fu.Anchor("load"), fu.Sheave("a", at=(0, 0, 0), axis=axes["a"], radius=0.2, side="right"),
        fu.Sheave("b", at=(2, 0.2, 0.2), axis=axes["b"], radius=0.15),
        fu.Sheave("c", at=(2.15, 0, 1.5), axis=axes["c"], radius=0.2), fu.Anchor(at=(2.15, -1.2, 1.7))],
        section=fu.Circle(radius=1e-3), material=fu.Material(youngs_modulus=6e8, poisson_ratio=0.3, density=7000))
    clip = scene.animation().clips[0]
    rope, route = part(clip.cables, "rope"), scene.route_of(scene.ropes["rope"])
    line, s, at = rope.position[0], rope.material_s[0], 0.0
    for span, arc in zip(route.spans, route.sheaves, strict=False):
        at += span.length / route.stretch
        on = (s > at + 1e-9) & (s < at + arc.length / route.stretch - 1e-9)
        at += arc.length / route.stretch
        assert on.sum() > 5
        away = line[on] - arc.centre
        assert_allclose(np.linalg.norm(away, axis=1), arc.radius, rtol=1e-12)
        assert_allclose(away @ np.array(axes[arc.name]), 0, atol=1e-12)
        w, x, y, z = part(clip.bodies, arc.name).orientation[0]
        turned = (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))  # of the z axis
        assert_allclose(turned, axes[arc.name], atol=1e-12)
