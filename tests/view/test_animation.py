"""Data of pictures: the numbers of runs, scenes, equilibria and modes at stations, marks and bodies."""

import struct

import funicular as fu
import numpy as np
import pytest
from funicular.base.rotations import product, rotate, turned_by
from funicular.results.animation.bodies import plausible_size
from funicular.results.animation.cables import line_order
from funicular.results.animation.clips import overlaid
from funicular.results.animation.curves import thinned
from funicular.results.animation.marks import arrow_length
from funicular.view.page import is_exaggerable
from numpy.testing import assert_allclose
from shared_scenes import SQUARE, TABLE_1, cable_scene
from viewed_scenes import spatial


@pytest.fixture(scope="module")
def run():
    return spatial().run(0.4, output_step=0.02, tol=1e-3, progress=False)


@pytest.fixture(scope="module")
def clip(run):
    return run.animation("a run").clips[0]


def part(parts, name):
    return next(each for each in parts if each.name == name)


def test_nodes_are_stations(run, clip):
    for name in ("rope", "boom"):
        cable = part(clip.cables, name)
        each = (len(cable.s) - 1) // run.scene.cables[name].elements
        assert_allclose(cable.position[:, ::each], run[f"{name}.position"], atol=1e-13)
        assert_allclose(cable.s[::each], run.scene.cables[name].node_s, atol=1e-13)
    assert_allclose(clip.time, run.time)


def test_stations_between_nodes_are_those_of_a_cubic(run, clip):
    """The first element of a cable12, by Hermite's functions."""
    nodal, length = run["rope.nodal_vectors"][:, :2], run.scene.cables["rope"].length / 8
    rope = part(clip.cables, "rope")
    inside = rope.s < length
    t = (rope.s[inside] / length)[:, None]
    points = ((1 + 2 * t) * (1 - t) ** 2 * nodal[:, None, 0, 0] + t * (1 - t) ** 2 * length * nodal[:, None, 0, 1]
              + t**2 * (3 - 2 * t) * nodal[:, None, 1, 0] - t**2 * (1 - t) * length * nodal[:, None, 1, 1])
    assert inside.sum() > 10
    assert_allclose(rope.position[:, inside], points, atol=1e-12)


def test_the_slide_is_where_its_rider_is(run, clip):
    slide = part(clip.marks, "trolley")
    assert slide.kind == "slide"
    assert_allclose(slide.position, run["car.position"], atol=1e-9)


def test_supports_joints_and_springs_are_where_they_act(run, clip):
    assert_allclose(part(clip.marks, "rope@0").position, run["rope.position"][:, 0], atol=1e-13)
    assert part(clip.marks, "boom@0").position.shape == (1, 3)  # it stands still
    assert {mark.kind for mark in clip.marks} == {"pin", "clamp", "joint", "slide", "ground"}
    hook = run["load.position"] + rotate(run["load.orientation"], (0, 0, 1.2))
    assert_allclose(part(clip.marks, "hook").position, hook, atol=1e-12)
    spring = part(clip.segments, "guy")
    assert_allclose(np.linalg.norm(spring.end - spring.start, axis=1), run["guy.length"], rtol=1e-12)
    lever = part(clip.segments, "load, hook")
    assert_allclose(np.linalg.norm(lever.end - lever.start, axis=1), 1.2, rtol=1e-12)


@pytest.mark.parametrize(("law", "kind"), [
    ({"stiffness": 1.0}, "spring"), ({"stiffness": 1.0, "free_play": 0.1}, "spring"), ({"damping": 1.0}, "spring"),
    ({"stiffness": 1.0, "tension_only": True}, "hanger"),
    ({"stiffness": 1.0, "tension_only": True, "length": 0}, "hanger"),
    ({"table": fu.ForceTable(extension=(0, 1), tension=(0, 1)), "tension_only": True}, "hanger"),
    ({"table": fu.ForceTable(extension=(-1, 0, 1), tension=(-1, 0, 1))}, "spring")])
def test_what_only_pulls_is_no_coil(law, kind):
    scene = fu.Scene()
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 0))
    scene.spring("A", (0, 1, 0), name="hanger", **law)
    assert part(scene.animation().clips[0].segments, "hanger").kind == kind


def test_arrows_of_loads_follow_their_signals(run, clip):
    wind = part(clip.segments, "wind")
    along = wind.end - wind.start
    assert_allclose(wind.end, run["boom.position"][:, -1], atol=1e-12)
    shares = np.sin(2 * np.pi * run.time) / np.sin(2 * np.pi * run.time).max()
    assert_allclose(along[:, 1] / along[:, 1].max(), shares, atol=1e-12)
    assert not along[:, [0, 2]].any()
    assert sum(each.name == "side" for each in clip.segments) == 9


def test_a_follower_force_turns_with_the_section():
    scene = cable_scene(clamps=(0,), gravity=(0, 0, 0), law="structural", element="beam12p")
    scene.force("wire", s=1.0, value=(0, 4000, 0), follower=True)
    rest = scene.equilibrium()
    arrow = rest.animation().clips[0].segments[0]
    direction = (arrow.end - arrow.start)[0]
    tangent = rest["wire.nodal_vectors"][-1, 1]
    assert abs(tangent[1]) > 0.1  # it has turned
    assert abs(direction @ tangent) < 1e-12 * np.linalg.norm(direction)


def test_sections_have_directions_where_elements_have_them(run, clip):
    assert part(clip.cables, "rope").section_y is None
    boom = part(clip.cables, "boom")
    assert_allclose(np.linalg.norm(boom.section_y, axis=-1), 1, rtol=1e-13)
    tangent = np.gradient(boom.position, boom.s, axis=1)
    sheared = np.sum(boom.section_y * tangent, axis=-1) / np.linalg.norm(tangent, axis=-1)
    assert np.abs(sheared).max() < 2e-2
    assert_allclose(boom.section_y[0, 0], (1, 0, 0), atol=1e-12)
    assert boom.section == {"shape": "tube", "diameter": 0.16, "thickness": pytest.approx(0.01)}


def test_planar_cables_have_their_height_in_the_plane():
    cable = cable_scene(element="cable8p", end=(1, 1, 0)).animation().clips[0].cables[0]
    assert_allclose(cable.section_y[0], np.broadcast_to(np.array([-1, 1, 0]) / np.sqrt(2), (len(cable.s), 3)),
                    atol=1e-14)
    assert cable.section == {"shape": "rectangle", "height": 0.05, "width": 0.05}


def test_quantities_are_those_of_the_section_forces(run, clip):
    boom = part(clip.cables, "boom")
    found = {quantity.key: quantity for quantity in boom.quantities}
    assert list(found) == ["tension", "strain", "curvature", "moment", "speed"]
    forces = run.section_forces("boom", boom.s)
    assert_allclose(found["tension"].values, forces.tension, rtol=1e-12, atol=1e-9)
    assert_allclose(found["curvature"].values, np.hypot(forces.curvature_y, forces.curvature_z), rtol=1e-12, atol=1e-12)
    speed = np.linalg.norm(run["boom.nodal_velocity"][:, :, 0], axis=-1)
    assert_allclose(found["speed"].values[:, :: (len(boom.s) - 1) // 4], speed, rtol=1e-9, atol=1e-12)


def test_curves(run, clip):
    curves = {curve.key: curve for curve in clip.curves}
    assert_allclose(curves["car.position"].values, run["car.position"])
    assert (curves["car.position"].unit, curves["car.position"].columns) == ("m", ("x", "y", "z"))
    assert curves["energy"].columns == ("kinetic", "elastic", "potential", "dissipated", "external")
    assert_allclose(curves["energy.balance"].values, run.energy_balance().residual)
    at = curves["rope.tension@trolley"]
    assert_allclose(at.values[:, 1], run.section_forces("rope", "trolley").tension, rtol=1e-12)
    assert "rope.nodal_vectors" not in curves


def test_what_is_thinned_keeps_both_ends():
    assert thinned(1, 5).tolist() == [0]
    assert thinned(11, 11).tolist() == list(range(11))
    assert thinned(100, 10).tolist() == [*range(0, 99, 11), 99]
    assert all(len(thinned(n, 7)) <= 7 for n in range(1, 60))


def test_a_long_run_says_what_is_left_out(run):
    from funicular.results.animation.clips import of_run

    short = of_run(run, "short", frames=6)
    assert len(short.clips[0].time) <= 6 and short.clips[0].time[-1] == run.time[-1]
    assert "6 of the run's 21 output times are drawn" in short.notes
    assert_allclose(part(short.clips[0].marks, "trolley").position, run["car.position"][::4], atol=1e-9)


def test_events_and_their_words():
    scene = fu.load_scene("zip_line")
    found = scene.run(20, tol=1e-3, output_step=0.5, progress=False).animation().clips[0].events
    assert [event.label.partition(" at")[0] for event in found] == ["wheels: entered the buffer",
                                                                    "wheels: left the buffer"]


def test_overlaid_runs_keep_their_names(run):
    both = overlaid([run.animation("one"), run.animation("other")])
    assert [clip.label for clip in both.clips] == ["one", "other"] and both.arrangement == "overlay"
    same = overlaid([run.animation("one"), run.animation("one")])
    assert [clip.label for clip in same.clips] == ["1: one", "2: one"]


# ---- bodies


@pytest.mark.parametrize(("mass", "size"), [(3.0, (0.1, 0.2, 0.3)), (500.0, (1.0, 2.0, 0.5))])
def test_a_plausible_size_is_that_of_a_homogeneous_box(mass, size):
    squares = np.square(size)
    assert_allclose(plausible_size(mass, mass / 12 * (squares.sum() - squares)), size, rtol=1e-9)


def test_a_plausible_size_is_neither_denser_than_steel_nor_lighter_than_what_is_hollow():
    rod = plausible_size(1.89, np.array([1e-5, 0.039375, 0.039375]))
    assert rod[0] == pytest.approx(0.5, rel=1e-3) and 1.89 / np.prod(rod) == pytest.approx(7850)
    assert rod[1] == pytest.approx(rod[2])
    assert 1 / np.prod(plausible_size(1.0, np.full(3, 1e-12))) == pytest.approx(7850)
    assert 1 / np.prod(plausible_size(1.0, np.ones(3))) == pytest.approx(50)


def test_principal_axes_turn_the_box():
    turn = np.array([[0.8, -0.6, 0], [0.6, 0.8, 0], [0, 0, 1]])
    squares = np.square([0.4, 0.2, 0.1])
    scene = fu.Scene()
    scene.rigid_body("A", mass=2, inertia=turn @ np.diag(2 / 12 * (squares.sum() - squares)) @ turn.T,
                     position=(0, 0, 0), centre=(1, 0, 0))
    shape = scene.animation().clips[0].bodies[0].shape
    assert_allclose(np.ptp(shape["vertices"] @ turn, axis=0), (0.4, 0.2, 0.1), rtol=1e-6)
    assert shape["offset"] == [1, 0, 0]


def test_shapes_of_the_user(clip):
    assert part(clip.bodies, "car").shape == {"kind": "box", "size": [0.5, 0.3, 0.2], "offset": [0, 0, 0]}
    assert part(clip.bodies, "load").shape == {"kind": "sphere", "radius": 0.3, "offset": [0, 0, 0]}


def tetrahedron(path):
    """Write a text STL file of a tetrahedron of edges 1 along the axes; return its path."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    lines = ["solid t"]
    for face in faces:
        lines += ["facet normal 0 0 0", "outer loop", *("vertex {} {} {}".format(*corners[k]) for k in face),
                  "endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid t"]), encoding="utf-8")
    return path


def binary(path):
    """Write the same tetrahedron as a binary STL file; return its path."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype="<f4")
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    path.write_bytes(bytes(80) + struct.pack("<I", 4)
                     + b"".join(bytes(12) + corners[list(face)].tobytes() + bytes(2) for face in faces))
    return path


def gltf(path):
    """Write the same tetrahedron as a glTF file by the library that reads it; return its path."""
    trimesh = pytest.importorskip("trimesh")
    trimesh.load_mesh(tetrahedron(path.with_suffix(".stl"))).export(path)
    return path


@pytest.mark.parametrize(("name", "write"), [("t.stl", tetrahedron), ("b.STL", binary), ("t.glb", gltf)])
def test_meshes_from_files(tmp_path, name, write):
    pytest.importorskip("trimesh")
    write(tmp_path / name)
    (tmp_path / "scene.toml").write_text(
        '[[rigid_body]]\nname = "A"\nmass = 1\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\n'
        f'shape = {{ kind = "mesh", file = "{name}", scale = 0.001, at = [0, 0, 1] }}', encoding="utf-8")
    animation = fu.load_scene(tmp_path / "scene.toml").animation()
    shape = animation.clips[0].bodies[0].shape
    points = np.asarray(shape["vertices"])[np.asarray(shape["triangles"])]
    volume = np.einsum("fi,fi->f", points[:, 0], np.cross(points[:, 1], points[:, 2])).sum() / 6
    assert volume == pytest.approx(1e-9 / 6, rel=1e-6) and shape["offset"] == [0, 0, 1] and not animation.notes


def test_a_mesh_that_is_not_there_is_said():
    scene = fu.Scene()
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 0), shape=fu.MeshShape(file="nowhere.stl"))
    animation = scene.animation()
    assert animation.notes == ('body "A" is drawn as a box of its inertia: nowhere.stl: there is no such file',)
    assert animation.clips[0].bodies[0].shape["kind"] == "box"


@pytest.mark.parametrize(("shape", "complaint"), [
    ({"kind": "bx"}, 'shape has the unknown kind "bx"; did you mean "box"?'),
    (3, "shape must be a shape such as Box(size=(1, 2, 3)), got 3"),
    ({"kind": "sphere", "radius": -1}, "shape.radius must be positive, got -1 m"),
    ({"kind": "mesh", "file": "a.obj"}, "shape.file must end in .stl, .glb or .gltf, got 'a.obj'"),
    ({"kind": "box", "size": (1, 0, 2)}, "shape.size must be three positive lengths, got (1, 0, 2)"),
])
def test_wrong_shapes_are_refused(shape, complaint):
    with pytest.raises(fu.SceneError) as error:
        fu.Scene().rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 0), shape=shape)
    assert str(error.value) == f'rigid_body "A": {complaint}'


def test_shapes_go_through_files():
    scene = spatial()
    read = fu.Scene.from_toml(scene.to_toml())
    assert [body.shape for body in read.bodies.values()] == [body.shape for body in scene.bodies.values()]


def test_quaternions_follow_one_another():
    first, second = turned_by([0.3, -0.2, 0.9]), turned_by([[1.0, 0.5, -0.4], [0, 0, 0]])
    vector = np.array([0.2, 0.7, -1.1])
    assert_allclose(rotate(product(first, second), vector), rotate(first, rotate(second, vector)), atol=1e-14)
    assert_allclose(rotate(turned_by([0, 0, np.pi / 2]), (1, 0, 0)), (0, 1, 0), atol=1e-15)


# ---- modal bodies


def hinged() -> fu.Scene:
    """Return a scene with a horizontal modal beam on a hinge."""
    scene = fu.Scene()
    scene.modal_body("link", start=(0, 0, 0), end=(1, 0, 0), section=SQUARE, boundary="attached", modes=3,
                     material=TABLE_1)
    scene.joint("revolute", "link", (0, 0, 0), axis=(0, 0, 1), name="hinge")
    scene.rigid_body("ball", mass=1, inertia=(1e-3, 1e-3, 1e-3), position=(1, 0.1, 0))
    scene.joint("spherical", ("link", (1, 0.1, 0)), "ball", name="eye")
    return scene


def test_a_modal_body_is_a_line_through_its_nodes():
    run = hinged().run(0.3, output_step=0.05, tol=1e-4, progress=False)
    clip = run.animation().clips[0]
    link = part(clip.cables, "link")
    assert_allclose(link.position, run["link.nodes"], atol=1e-14)
    assert_allclose(link.s, np.linspace(0, 1, 11), atol=1e-12)
    assert_allclose(part(clip.marks, "eye").position, run["ball.position"], atol=1e-12)
    assert link.section["shape"] == "rectangle"


def test_nodes_in_any_order_make_a_line_or_none():
    x = np.array([0.3, 0.0, 1.0, 0.6])
    line = np.stack([x, 0.02 * x, 0 * x], axis=1)
    assert line_order(line).tolist() in ([1, 0, 3, 2], [2, 3, 0, 1])
    assert line_order(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])) is None


# ---- modes, states of rest and load paths


def test_modes_swing_about_their_state_and_bodies_stay_whole():
    scene = hinged()
    rest = scene.equilibrium()
    modes = scene.modes(6, about=rest)
    animation = modes.animation()
    assert animation.arrangement == "menu" and len(animation.clips) == 6
    swings = np.flatnonzero(modes.frequency)
    assert len(swings) >= 2  # the ball spins freely in the others
    for clip in (animation.clips[k] for k in swings):
        assert clip.periodic and len(clip.time) == 48
        link, ball = part(clip.cables, "link"), part(clip.bodies, "ball")
        assert_allclose(link.reference, rest["link.nodes"], atol=1e-12)
        assert_allclose(link.position[12], rest["link.nodes"], atol=1e-9)  # a quarter of the period after the largest
        assert_allclose(np.linalg.norm(ball.orientation, axis=-1), 1, rtol=1e-13)
        moved = np.linalg.norm(link.position[0] - link.reference, axis=-1).max()
        assert 1e-3 < moved < 0.13
    first, frequency = animation.clips[swings[0]], modes.frequency[swings[0]]
    assert first.label == f"mode {swings[0] + 1}: {frequency:.4g} Hz"
    assert first.time[1] * 48 == pytest.approx(1 / frequency)


def test_a_body_that_turns_in_place_turns_by_no_more_than_can_be_seen():
    """The largest displacement of such a mode is rounding; scaled to 1 m it would rotate the body by thousands of rad.
    """
    scene = fu.load_scene("zip_line")
    rest = scene.equilibrium()
    clip = scene.modes(1, about=rest).animation().clips[0]
    trolley = part(clip.bodies, "trolley")
    turned = 2 * np.arccos(np.clip(np.abs(trolley.orientation @ rest["trolley.orientation"]), 0, 1))
    assert turned.max() == pytest.approx(0.6, rel=1e-6)
    assert np.linalg.norm(trolley.position - rest["trolley.position"], axis=-1).max() < 1e-3


def test_a_state_of_rest_has_the_tension_of_its_section_forces():
    scene = fu.load_scene("cable_car")
    rest = scene.equilibrium()
    animation = rest.animation()
    track = animation.clips[0].cables[0]
    assert len(animation.clips[0].time) == 1 and animation.planar
    assert_allclose(track.quantities[0].values[0], rest.section_forces("track", track.s).tension, rtol=1e-12)
    assert_allclose(track.reference[:: (len(track.s) - 1) // 24], scene.cables["track"].nodal_vectors[:, 0], atol=1e-9)


def test_a_load_path_has_the_load_for_its_time():
    rest = fu.load_scene("cable_car").equilibrium(load_steps=4)
    path = rest.load_path.animation()
    assert (path.time_label, path.time_unit) == ("load factor", "")
    assert_allclose(path.clips[0].time, [state.load_fraction for state in rest.path])
    assert_allclose(path.clips[0].cables[0].position[-1], rest.animation().clips[0].cables[0].position[0], atol=1e-12)
    with pytest.raises(fu.FunicularError, match="the equilibrium has one state on its path; find it with load_steps"):
        fu.load_scene("cable_car").equilibrium().load_path.animation()


def test_a_path_through_a_limit_point_is_counted_by_its_states():
    """A shallow arch of two struts under a load at its top snaps through."""
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, start in (("left", (-1, 0, 0)), ("right", (1, 0, 0))):
        scene.cable(name, start=start, end=(0, 0.2, 0), elements=1, element="cable8p", section=SQUARE, material=TABLE_1)
        scene.pin(name, s=0)
    scene.tie("left", s=scene.cables["left"].length, to="right", at=scene.cables["right"].length, rotation="free")
    scene.force("left", s=scene.cables["left"].length, value=(0, -12000, 0))
    rest = scene.equilibrium(method="arc_length")
    loads = [state.load_fraction for state in rest.path]
    assert np.any(np.diff(loads) < 0)
    path = rest.load_path.animation()
    assert path.time_label == "state on the path" and path.clips[0].time.tolist() == list(range(len(loads)))
    assert_allclose(next(curve for curve in path.clips[0].curves if curve.key == "load_factor").values, loads)


# ---- short forms


def test_short_forms():
    scene = spatial()
    assert repr(scene) == ("<funicular.Scene: 2 cables, 1 clamp, 1 motion, 2 rigid bodies, 2 joints, 1 slide, 1 force, "
                           "1 distributed force, 1 spring>")
    assert repr(fu.Scene()) == "<funicular.Scene: empty>"
    small = fu.load_scene("paper51")
    rest, modes = small.equilibrium(), small.modes(2, as_drawn=True)
    assert repr(rest) == "<funicular.Equilibrium: stable, under all loads, 18 results>"
    assert repr(modes) == "<funicular.Modes: 2, 0 to 0 Hz, 4 shapes>"
    assert repr(small.equilibrium(load_steps=2).load_path) == "<funicular.LoadPath: 2 states, 0.5 to 1 times the loads>"
    for each in (scene, rest, modes):
        shown = each._repr_html_()
        assert shown.startswith("<table>") and 'src="data:image/png;base64,' in shown and len(shown) < 200_000


def test_what_slides_stays_on_its_cable_when_displacements_are_enlarged():
    """Coincident points are drawn at one place: a rider on its cable, and a load on the rider."""
    clip = fu.load_scene("zip_line").run(1.0, progress=False).animation("a run").clips[0]

    def drawn(position, reference):
        return reference + 7 * (position - reference)

    rope, wheels, swivel = clip.cables[0], part(clip.marks, "wheels"), part(clip.marks, "swivel")
    slide = drawn(wheels.position, wheels.reference)
    for k, shape in enumerate(drawn(rope.position, rope.reference)):
        lengths = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(shape, axis=0), axis=1))])
        where = np.interp(np.interp(slide[k, 0], shape[:, 0], lengths), lengths, shape[:, 1])
        assert slide[k, 1] == pytest.approx(where, abs=0.02 * np.abs(rope.position - rope.reference).max())
    scene, bodies = fu.load_scene("zip_line"), {body.name: body for body in clip.bodies}
    for end, mark in ((scene.slides["wheels"].rider, wheels), (scene.joints["swivel"].a, swivel),
                      (scene.joints["swivel"].b, swivel)):
        body = bodies[end.on]
        point = drawn(body.position, body.reference) + rotate(body.orientation, end.point)
        assert_allclose(point, drawn(mark.position, mark.reference), atol=1e-6)
    lever = clip.segments[0]
    assert_allclose(drawn(lever.end, lever.reference[:, 1]) - drawn(lever.start, lever.reference[:, 0]),
                    lever.end - lever.start, atol=1e-12)


def test_a_cable_that_rides_has_no_reference_that_goes_along():
    """A cable that rides another has no drawn reference at each instant, so that the page draws true displacements."""
    scene = fu.load_scene("paper52_ancf")
    clip = scene.run(0.05, progress=False).animation("a run").clips[0]
    assert part(clip.marks, "trolley").reference is None
    assert not is_exaggerable(clip)
    rest = scene.animation("as drawn").clips[0]
    assert is_exaggerable(rest)


def test_pictures_are_called_by_the_file_of_their_scene(tmp_path):
    path = tmp_path / "small.toml"
    path.write_text(fu.load_scene("paper51").to_toml(), encoding="utf-8")
    scene = fu.load_scene(path)
    rest = scene.equilibrium(load_steps=2)
    shown = (scene, scene.replace("wire", elements=4), rest, rest.load_path, scene.modes(1, as_drawn=True),
             scene.modes(1, about=rest))
    assert [each.animation().title for each in shown] == [
        "small", "small", "small, at rest", "small, load path", "small, modes as drawn", "small, modes about rest"]
    scene.title = ""
    assert scene.animation().title == "scene"
    assert rest.animation("mine").title == "mine"


def test_modes_as_drawn_say_that_weight_does_not_act_yet():
    """The cabin of a cable car is a pendulum only about its equilibrium."""
    scene = fu.load_scene("cable_car")
    note = "what swings by its weight has 0 Hz"
    assert any(note in each for each in scene.modes(1, as_drawn=True).animation().notes)
    assert not any(note in each for each in scene.modes(1, about=scene.equilibrium()).animation().notes)


@pytest.mark.parametrize(("extents", "length"), [((4, 3, 0), 0.15 * 5), ((120, 0, 5), 5), ((600, 4, 0), 18),
                                                 ((10, 0, 0), 1.5), ((0, 0, 0), 0.15)])
def test_arrows_are_no_longer_than_a_slender_scene_is_high(extents, length):
    size = float(np.linalg.norm(extents)) or 1.0
    assert arrow_length(np.array(extents, float), size) == pytest.approx(length, rel=1e-3)
