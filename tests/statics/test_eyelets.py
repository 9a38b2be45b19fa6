"""An eyelet: a cable slides through a point of the ground."""

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from funicular.kernels.element_line import ElementLine


def cable_through(eyelet, element="cable8p", frame="point", **given):
    scene = fu.Scene()
    wire = scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=4, element=element,
                       section=fu.Rectangle(height=0.02, width=0.02),
                       material=fu.Material(youngs_modulus=1e6, poisson_ratio=0.0, density=1000), **given)
    if eyelet:
        scene.slide((0.5, 0, 0), along=wire, s=0.5, name="eye", frame=frame)
    else:
        body = scene.rigid_body("B", mass=1.0, inertia=(1, 1, 1), position=(0.5, 0, 0))
        scene.joint("weld", body, (0.5, 0, 0))
        scene.slide(body, along=wire, s=0.5, name="eye", frame=frame)
    return scene


@pytest.mark.parametrize("integrator", ["explicit", "radau", "genalpha"])
@pytest.mark.parametrize(("element", "frame"), [("cable8p", "point"), ("cable12", "tangent"), ("beam24", "tangent"),
                                                ("beam24", "section")])
def test_as_a_body_welded_to_the_ground(integrator, element, frame):
    """With tol genalpha leaves 1e-9 of the size of each scene to later steps; fixed steps of scenes with slides are
    solved to rounding.
    """
    steps = {"step": 1e-3} if integrator == "genalpha" else {"tol": 1e-6}
    runs = [cable_through(eyelet, element, frame, velocity=(0.3, 0, 0)).run(
        duration=0.1, output_step=0.02, integrator=integrator, **steps) for eyelet in (True, False)]
    for name in ("eye.s", "wire.position", "eye.force"):
        one, other = (run[name] for run in runs)
        np.testing.assert_allclose(one, other, atol=1e-10 * np.abs(other).max())
    assert np.ptp(runs[0]["eye.s"]) > 0.02


def test_equilibrium_over_an_eyelet():
    """A cable from a pin through an eyelet, pulled by a force at its other end: its forces balance."""
    scene = cable_through(True)
    scene.pin("wire", s=0.0)
    scene.force("wire", s=1.0, value=(20, -20, 0))
    rest = scene.equilibrium()
    force = rest["eye.force"]
    r = rest["wire.nodal_vectors"]
    weight = 1000 * 0.02**2 * 1.0 * 9.81
    np.testing.assert_allclose(rest["wire@0.force"] - force + [20, -20 - weight, 0], 0, atol=1e-6)
    assert 0.5 > float(rest["eye.s"]) > 0.4 and r[-1, 0, 1] < -0.2


def test_written_to_a_file_and_read_back():
    text = cable_through(True).to_toml()
    assert "body = [0.5, 0.0, 0.0]" in text
    assert fu.Scene.from_toml(text).to_toml() == text


@pytest.mark.parametrize(("given", "message"), [
    ({"body": (0.5, 0.3, 0)}, 'slide "ground_on_wire": the point of the ground at (0.5, 0.3, 0) m is 0.3 m away from '
     'cable "wire" at s = 0.5 m; slide from s = 0.5 m'),
    ({"body": (0.5, 0, 0), "at": (0, 1, 0)}, "slide: body is a point of the ground and takes no at; leave at out"),
    ({"body": None}, "slide: body is missing; give a body, (cable, s), or a point (x, y, z) of the ground"),
    ({"body": (0.5, 0, 0), "name": "twin"}, 'slide "twin": puts the same point of the ground on cable "wire" as slide '
     '"eye"; leave one of them out, or give them different points at'),
])
def test_refused(given, message):
    with refused(message):
        cable_through(True).slide(**{"along": "wire", "s": 0.5} | given)


ROPE = {"element": "cable8p", "rest": "straight", "section": fu.Circle(radius=0.01),
        "material": fu.Material(youngs_modulus=1e9, poisson_ratio=0, density=8000)}


def hill(eye=(5, 1, 0), points=((0, 0, 0), (5, 1, 0), (10, 0, 0)), **slide):
    """Return a rope over a hill, pinned at its ends, through an eyelet at its top."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    rope = scene.cable("rope", points=points, elements=10, **ROPE)
    scene.pin(rope, s=0)
    scene.pin(rope, s=rope.length)
    scene.slide(eye, along=rope, name="eye", **slide)
    return scene


def test_the_nearest_place_is_taken_where_s_is_left_out():
    """By symmetry half of the length; an eyelet elsewhere has its own nearest point."""
    scene = hill()
    assert abs(scene.slides["eye"].s - scene.cables["rope"].length / 2) < 1e-9
    assert fu.Scene.from_toml(scene.to_toml()).slides["eye"].s == scene.slides["eye"].s
    moved = scene.replace("eye", body=tuple(scene.cables["rope"].point(2.0)))
    assert moved.slides["eye"].s == pytest.approx(2.0, abs=1e-9)
    half, whole = hill(), hill(s=scene.cables["rope"].length / 2)
    assert half.equilibrium()["eye.force"] == pytest.approx(whole.equilibrium()["eye.force"], rel=1e-9)


def test_riders_find_their_place_too():
    scene = hill()
    scene.rigid_body("car", mass=1, inertia=(1, 1, 1), position=scene.cables["rope"].point(2.0) - (0.1, 0, 0))
    assert scene.slide("car", along="rope", at=(0.1, 0, 0)).s == pytest.approx(2.0, abs=1e-9)
    scene.rigid_body("drone", mass=1, inertia=(1, 1, 1), position=scene.cables["rope"].point(3.0))
    assert scene.slide("drone", along="rope", drive=fu.Ramp(start=0, end=1, before=3, after=4)).s == 3.0
    scene.rigid_body("crab", mass=1, inertia=(1, 1, 1), position=scene.cables["rope"].point(4.0))
    faster = fu.Ramp(start=0, end=1, before=0, after=0.1)
    assert scene.slide("crab", along="rope", velocity=faster).s == pytest.approx(4.0, abs=1e-9)
    assert scene.run(duration=0.5, output_step=0.1)["crab_on_rope.s"][-1] > 4.005


@pytest.mark.parametrize("off", [1e-6, 1e-5, 1e-3])
def test_an_eyelet_off_its_place_along_the_cable_is_placed(off):
    """The equilibrium is that of the eyelet on its cable; the note gives the initial distance."""
    length = hill().cables["rope"].length
    with pytest.warns(fu.FunicularWarning) as told:
        scene = hill(s=length / 2 + off)
    note, = (str(each.message) for each in told)
    assert note == (f'slide "eye": the point of the ground at (5, 1, 0) m is {off:g} m away from cable "rope" at '
                    f's = {length / 2 + off:.9g} m; it starts from the nearest place, s = {length / 2:.9g} m')
    assert scene.equilibrium()["eye.force"] == pytest.approx(hill().equilibrium()["eye.force"], rel=1e-9)
    run = scene.run(duration=0.01, output_step=0.01)
    assert run.status == "completed" and run["eye.residual"].max() < 1e-12


def test_an_eyelet_beside_its_cable_is_told_how_far():
    with pytest.warns(fu.FunicularWarning, match=r"nearest place, s = 5\.13\d* m, 0\.001 m away; they are brought"):
        scene = hill(eye=(5, 1.001, 0), s=hill().cables["rope"].length / 2 + 1e-4)
    run = scene.run(duration=0.01, output_step=0.01)
    assert run["eye.residual"].max() < 1e-9 and any("gaps of joints" in each for each in run.report["messages"])
    line = ElementLine(None, "cable8p", scene.cables["rope"].mesh, scene.equilibrium()["rope.nodal_vectors"][:, :, :2])
    assert line.point(float(scene.equilibrium()["eye.s"])) == pytest.approx([5, 1.001, 0], abs=1e-9)


def test_a_place_that_is_not_clear_is_refused():
    loop = [(0, 0, 0), (2, 0, 0), (3, 1, 0), (2, 2, 0), (1, 1, 0), (2, -0.1, 0), (4, 0, 0)]
    scene = fu.Scene()
    rope = scene.cable("rope", points=loop, elements=40, **ROPE)
    crossing = crossing_of(rope)
    with pytest.raises(fu.SceneError, match=r'"rope" passes the point of the ground .* at s = .* and .* m; give s'):
        scene.slide(tuple(crossing), along=rope)
    assert scene.slide(tuple(crossing), along=rope, s=rope.nearest_s(crossing).max()).s > 2
    with pytest.raises(fu.SceneError, match=r"at s = \d\.\d* m, the nearest place; draw the cable through that point"):
        scene.slide((2, 1, 0), along=rope, name="inside")


def crossing_of(rope):
    """Return the point at which a rope with one loop crosses itself: two arc-lengths with equal positions."""
    from scipy.optimize import fsolve

    s = np.linspace(0, rope.length, 400)
    points = rope.points_at(s)
    apart = np.linalg.norm(points[:, None] - points[None], axis=-1) + 10.0 * (np.abs(s[:, None] - s[None]) < 1.0)
    i, j = np.unravel_index(np.argmin(apart), apart.shape)
    one, other = fsolve(lambda x: (rope.point(x[0]) - rope.point(x[1]))[:2], [s[i], s[j]], xtol=1e-14)
    assert abs(one - other) > 1.0
    return rope.point(one)
