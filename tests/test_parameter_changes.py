"""Derivatives of states of rest by loads, weights and supports, against differences of whole scenes."""

import funicular as fu
import numpy as np
import pytest
from funicular.parts.laid import laid
from funicular.parts.settings import EquilibriumSettings
from funicular.results.equilibrium import Equilibrium
from funicular.results.targets import reader
from funicular.solve import parameter_search, static_problem
from funicular.solve.parameter_changes import Changes
from funicular.solve.parameter_search import ParameterSearch
from funicular.solve.parameters import Parameters
from funicular.solve.static import equilibrium

STEEL = fu.Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1500.0)


def strung(element, axes, joined=False):
    """Return a scene of a cable between motions, with loads, springs, a body on a joint and, joined, a tied cable."""
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


def search_of(scene, paths, to):
    """Return a search for these values, at the state of rest of the scene."""
    settings = EquilibriumSettings(adjust=dict.fromkeys(paths, "free"), to=dict.fromkeys(to, 0.0))
    rest = equilibrium(laid(scene), settings, None, Equilibrium)
    search = ParameterSearch(Parameters(scene, settings.adjust), settings, Equilibrium, reader(rest, to))
    return search, search.begin(rest)


@pytest.mark.parametrize(("element", "axes", "joined"), [
    ("cable8p", FLAT, False), ("cable8p", UPRIGHT, False), ("cable12", SPATIAL, False), ("beam24", SPATIAL, False),
    ("cable8p", FLAT, True)])
def test_loads_weights_and_supports_have_the_derivatives_of_differences_of_scenes(element, axes, joined, monkeypatch):
    scene = strung(element, axes, joined)
    x, y = ("xyz"[int(np.argmax(np.abs(axes[:, k])))] for k in range(2))
    paths = [path.format(x=x, y=y) for path in PATHS if element != "cable12" or path != "follower.value.y"]
    paths += ["side.rest_length"] * joined + ["wire.material.poisson_ratio"] * element.startswith("beam")
    to = [name.format(x=x, y=y) for name in TO] + [f"T.force.{y}"] * joined
    search, at = search_of(scene, paths, to)
    direct = search.linear(at)
    assert len(Changes(at.problem, dict(enumerate(search.parameters.paths)), search.reader).found) == len(paths)
    monkeypatch.setattr(parameter_search, "Changes", NoChanges)
    ends = []
    for step in (1e-4, 2e-4):  # of less, reactions are but rounding
        monkeypatch.setattr(parameter_search, "STEP", step)
        ends.append(search.linear(at))
    for found, near, far in zip(direct, *ends, strict=True):
        wanted = (4 * near - far) / 3
        for k, path in enumerate(paths):
            scale = np.max(np.abs(wanted[:, k]))
            assert scale > 0, path
            assert np.max(np.abs(found[:, k] - wanted[:, k])) < 1e-6 * scale, path


class NoChanges(Changes):
    """Changes that leaves all parameters to differences of scenes."""

    def __init__(self, problem, paths, reader):
        super().__init__(problem, {}, reader)


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
