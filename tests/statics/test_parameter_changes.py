"""Derivatives of equilibria by loads, weights and supports, against differences of whole scenes."""

import funicular as fu
import numpy as np
import pytest
from funicular.solve.statics import static_problem
from parameter_searches import apart, by_scenes, found_of, search_of

STEEL = fu.Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1500.0)


def strung(element, axes, joined=False):
    """Return a cable between motions, with loads, springs, a body on a joint and, optionally, a tied cable."""
    def at(x, y):
        return tuple(axes @ [x, y, 0.0])

    scene = fu.Scene(gravity=at(0.5, -9.81))
    given = {"element": element, "up": axes[:, 1], "section": fu.Circle(radius=0.01), "material": STEEL}
    scene.cable("wire", start=at(0, 0), end=at(4, 0.3), elements=8, rest_length=4.1, **given)
    scene.motion("wire", s=0, displacement=at(0.05, 0.02))
    if element.endswith("p"):
        wave = fu.Harmonic(amplitude=0.1, frequency=1.0)
        scene.motion("wire", s=4.1, displacement=[wave if k else 0 for k in at(1, 0)])
    else:
        scene.motion("wire", s=4.1, displacement=at(0.0, 0.03), rotation=(axes[:, 2], 0.1))
    scene.spring(at(1, 1), ("wire", 4.1 * 0.27), name="up", stiffness=300.0, length=0.8)
    scene.force("wire", s=1.5, value=at(3.0, -20.0), name="dead", scale=2.0)
    scene.force("wire", s=2.3, value=(1.0, 0 if element == "cable12" else 5.0, 0), follower=True, name="follower")
    scene.distributed_force("wire", start=0.7, stop=3.0, value=at(0.0, -4.0), name="snow")
    scene.rigid_body("A", mass=0.5, inertia=(0.1, 0.1, 0.1), position=at(2.95, -0.275))
    turning = ("spherical", {}) if element == "cable12" else ("revolute", {"axis": axes[:, 2]})
    scene.joint(turning[0], ("wire", 4.1 * 0.75), ("A", tuple(at(0.05, 0.5))), name="J", **turning[1])
    scene.force("A", value=at(0.5, 0.0), at=(0.1, 0, 0), name="push")
    scene.spring(at(3, -2), "A", name="down", stiffness=20.0, length=1.0)
    if joined:
        scene.cable("side", start=at(4, 0.3), end=at(6, 0.3), elements=4, rest_length=2.02, **given)
        scene.tie("side", s=0, to="wire", at=4.1, rotation="free", name="T")
        scene.pin("side", s=2.02)
    return scene


FLAT, UPRIGHT, SPATIAL = np.eye(3), np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]), np.eye(3)
PATHS = ["dead.value.{x}", "dead.value.{y}", "follower.value.x", "follower.value.y", "snow.value.{y}", "push.value.{x}",
         "A.mass", "wire.material.density", "gravity.{y}", "gravity.{x}", "wire@0.displacement.{y}",
         "wire@0.displacement.{x}", "up.a.{x}", "down.a.{y}", "up.b.1", "dead.s", "snow.start", "snow.stop",
         "wire.rest_length", "wire.section.radius", "wire.material.youngs_modulus"]
TO = ["wire@2.05.position.{y}", "wire@0.force.{x}", "wire@4.1.force.{y}", "A.position.{x}", "J.force.{y}"]


@pytest.mark.parametrize(("element", "axes", "joined"), [
    ("cable8p", FLAT, False), ("cable8p", UPRIGHT, False), ("cable12", SPATIAL, False), ("beam24", SPATIAL, False),
    ("cable8p", FLAT, True)])
@pytest.mark.slow_cases("beam24-axes3-False")
def test_loads_weights_and_supports_have_the_derivatives_of_differences_of_scenes(element, axes, joined, monkeypatch):
    scene = strung(element, axes, joined)
    x, y = ("xyz"[int(np.argmax(np.abs(axes[:, k])))] for k in range(2))
    paths = [path.format(x=x, y=y) for path in PATHS if element != "cable12" or path != "follower.value.y"]
    paths += ["side.rest_length"] * joined + ["wire.material.poisson_ratio"] * element.startswith("beam")
    to = [name.format(x=x, y=y) for name in TO] + [f"T.force.{y}"] * joined
    search, at = search_of(scene, paths, to)
    direct = search.linear(at)
    assert found_of(search, at) == paths
    for found, wanted in zip(direct, by_scenes(search, at, monkeypatch), strict=True):
        assert dict(zip(paths, apart(found, wanted) < 1e-6, strict=True)) == dict.fromkeys(paths, True)


def wire(element, place=((0, 0, 0), (4, 0.3, 0)), fix="clamp", **given):
    """Return a cable between its supports, under gravity that is oblique to it."""
    scene = fu.Scene(gravity=(0.3, -9.81, 0))
    shape = {"start": place[0], "end": place[1]} if len(place) == 2 else {"points": place}
    given = {"elements": 8, "rest_length": 4.1, "section": fu.Circle(radius=0.01), "material": STEEL, **given}
    cable = scene.cable("wire", element=element, **shape, **given)
    for s in (0, cable.length):
        getattr(scene, fix)("wire", s=s)
    return scene


def on_bed(**given):
    scene = wire("cable8p", rest_length=4.4, fix="pin")
    scene.surface("bed", fu.Plane(point=(0, -0.3, 0)))
    scene.contact("wire", "bed", **given)
    return scene


def on_hook():
    scene = wire("cable8p", shape="hanging", fix="pin")
    scene.spring((2, 0.5, 0), ("wire", 1.7), stiffness=30.0)
    return scene


ARC = (0, 0, 0), (1, 0.3, 0), (2, 0.5, 0), (3, 0.45, 0), (4, 0.2, 0)
STIFFER = fu.Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1500.0)
SHEARED = fu.Material(youngs_modulus=1e7, shear_modulus=9e6, density=1500.0)
WEIGHTY = ["wire.rest_length", "wire.material.density", "gravity.y"]
ALL = ["wire.rest_length", "wire.section.radius", "wire.material.youngs_modulus", "wire.material.density", "gravity.y"]
WARM = {"thermal_expansion": 1e-4}


def heated(temperature, *args, **given):
    """Return the cable in a scene with a temperature."""
    cold = wire(*args, **given, material=STIFFER.remade(WARM))
    scene = fu.Scene(gravity=cold.gravity, temperature=temperature)
    return scene.with_parts(cold.parts())


def of_two_materials():
    materials = [STEEL.remade(WARM), STIFFER.remade({"thermal_expansion": 5e-5})]
    scene = fu.Scene(gravity=(0.3, -9.81, 0), temperature=20.0)
    scene.cable("wire", start=(0, 0, 0), end=(4, 0.3, 0), element="cable8p", pieces=[
        fu.Piece(length=2.05, section=fu.Circle(radius=0.01), material=each, elements=4) for each in materials])
    for s in (0, 4.1):
        scene.pin("wire", s=s)
    return scene


LAWS_AND_SHAPES = {
    "warm": (lambda: heated(20.0, "cable8p"), ["temperature"], ["temperature"]),
    "a warm cable": (lambda: wire("cable12", material=STEEL.remade(WARM), temperature=20.0), ["wire.temperature"],
               ["wire.temperature"]),
    "warm, curved": (lambda: heated(20.0, "beam12p", ARC), ["temperature"], ["temperature"]),
    "warm, structural": (lambda: heated(-20.0, "beam24", law="structural"), ["temperature"], ["temperature"]),
    "warm, of two materials": (of_two_materials, ["temperature"], ["temperature"]),
    "curved cable": (lambda: wire("cable12", ARC), ALL, ALL),
    "curved beam": (lambda: wire("beam24", ARC, material=STIFFER), ALL, ALL),
    "curved structural beam": (lambda: wire("beam24", ARC, law="structural", material=STIFFER), ALL, ALL),
    "drawn along an arc, straight where free of stress": (lambda: wire("beam12p", ARC, rest="straight"), ALL, ALL),
    "of E and G": (lambda: wire("beam24", material=SHEARED), ["wire.material.youngs_modulus"],
                   ["wire.material.youngs_modulus"]),
    "of a contact as stiff as it is heavy": (on_bed, WEIGHTY, WEIGHTY[:1]),
    "of a contact": (lambda: on_bed(stiffness=2000.0), WEIGHTY, WEIGHTY),
    "clamped as it hangs": (lambda: wire("cable8p", shape="hanging"), [*ALL, "gravity.x"], ALL[1:4]),
    "on a spring free of force as it hangs": (on_hook, [*ALL, "gravity.x"], ALL[1:4]),
    "hanging from pins": (lambda: wire("cable8p", shape="hanging", fix="pin"), [*ALL, "gravity.x"],
                          [*ALL, "gravity.x"]),
}


@pytest.mark.parametrize(("made", "paths", "known"), LAWS_AND_SHAPES.values(), ids=LAWS_AND_SHAPES)
def test_columns_that_are_known_are_those_of_scenes_and_others_are_left_to_scenes(made, paths, known, monkeypatch):
    scene = made()
    middle = scene.cables["wire"].length / 2
    search, at = search_of(scene, paths, [f"wire@{middle:.12g}.position.y"])
    assert found_of(search, at) == known
    search, at = search_of(scene, known, [f"wire@{middle:.12g}.position.y"])
    found, wanted = search.linear(at)[0], by_scenes(search, at, monkeypatch, step=1e-5)[0]
    assert dict(zip(known, apart(found, wanted) < 1e-5, strict=True)) == dict.fromkeys(known, True)


@pytest.mark.parametrize("path", ["load.value.y", "wire.material.density", "gravity.y"])
def test_forces_in_sections_take_what_loads_do_there(path):
    scene = fu.Scene()
    scene.cable("wire", start=(0, 0, 0), end=(4, 0, 0), elements=8, element="cable8p", rest_length=4.1,
                section=fu.Circle(radius=0.01), material=STEEL)
    scene.pin("wire", s=0)
    scene.pin("wire", s=4.1)
    scene.force("wire", s=1.3, value=(0, -20.0, 0), name="load")
    search, at = search_of(scene, [path], ["wire@1.28.force.y"])
    _, G = search.linear(at)
    ends = []
    for change in (-1e-5, 1e-5):
        p = at.p * (1 + change)
        ends.append(search.moved(at, p - at.p, np.zeros((len(at.problem.weight), 1))).g[0])
    assert G[0, 0] == pytest.approx((ends[1] - ends[0]) / (2e-5 * at.p[0]), rel=1e-5)


def test_loads_and_supports_take_no_scene_each(monkeypatch):
    built = []
    plain = static_problem.build
    monkeypatch.setattr(static_problem, "build", lambda scene: built.append(scene) or plain(scene))

    def scenes(n):
        scene = fu.Scene()
        scene.cable("wire", start=(0, 0, 0), end=(4, 0, 0), elements=8, element="cable8p", rest_length=4.01,
                    section=fu.Circle(radius=0.01), material=STEEL)
        for s in (0, 4.01):
            scene.motion("wire", s=s, displacement=(0, 0, 0))
        paths, to = ["wire@0.displacement.y"], {"wire@0.position.y": 0.01}
        for k in range(n):
            s = 4.01 * (k + 1) / (n + 1)
            scene.force("wire", s=s, value=(0, -1.0, 0), name=f"load_{k}")
            paths.append(f"load_{k}.value.y")
            to[f"wire@{s:.12g}.position.y"] = -0.1 - 0.02 * k * (n - k - 1)
        built.clear()
        rest = scene.equilibrium(adjust=paths, to=to)
        assert rest.adjustment.misfits[-1] < 1e-9
        return len(built) - rest.adjustment.iterations

    assert scenes(7) <= scenes(3) + 1 < 8
