"""Temperature of ropes over sheaves and on drums: closed forms, longer ropes of the same mass, refusals."""

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from interrupted_runs import check_file_and_resume

EXPANSION, STORE, EA = 2e-5, 3.0, 1e9 * np.pi * 1e-4


def two_spans(length=11.65, temperature=None, of_scene=None, drum=False, mass=True, density=1000.0):
    """Return a rope from an anchor over a sheave to an anchor or a drum with 3 m in store."""
    scene = fu.Scene(temperature=of_scene)
    at = {"at": (10, 0, 0)}
    end = fu.Drum("drum", radius=0.2, side="right", length_in_store=STORE, **at) if drum else fu.Anchor(**at)
    material = fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=density, thermal_expansion=EXPANSION)
    scene.rope("rope", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("sheave", at=(5, 3, 0), radius=0.25), end],
               section=fu.Circle(radius=0.01), material=material, length=length, temperature=temperature, mass=mass)
    return scene


def pull(scene):
    """Return the force on the first anchor (3,), N."""
    return scene.equilibrium()["rope.start_force"]


@pytest.mark.parametrize("temperature", [-20.0, 30.0])
@pytest.mark.parametrize("drum", [False, True])
def test_the_tension_of_a_rope_without_mass(drum, temperature):
    """The drawn route over the stress-free length at the temperature, without the metres that stay on the drum."""
    length = 11.65 + STORE * drum
    scene = two_spans(length, temperature, drum=drum, mass=False)
    free = (1 + EXPANSION * temperature) * length - STORE * drum
    tension = EA * (scene.route_of(scene.ropes["rope"]).length / free - 1)
    assert np.linalg.norm(pull(scene)) == pytest.approx(tension, rel=1e-10)


@pytest.mark.parametrize("drum", [False, True])
def test_a_warm_rope_is_a_longer_rope_of_the_same_mass(drum):
    length, growth = 11.65 + STORE * drum, 1 + 30 * EXPANSION
    scenes = [two_spans(length, 30.0, drum=drum), two_spans(length, of_scene=30.0, drum=drum),
              two_spans(growth * length, drum=drum, density=1000 / growth)]
    for scene in scenes[1:]:
        assert pull(scene) == pytest.approx(pull(scenes[0]), rel=1e-12)
    runs = [scene.run(duration=2e-3, output_step=2e-3, tol=1e-4) for scene in scenes[::2]]
    assert runs[0]["rope.position"] == pytest.approx(runs[1]["rope.position"], abs=1e-12)
    forces = [scene.equilibrium().section_forces("rope", method=method).tension.values
              for scene in scenes[::2] for method in ("balance", "constitutive")]
    assert forces[0] == pytest.approx(forces[2], rel=1e-12)
    assert forces[1] == pytest.approx(forces[3], rel=1e-12)
    assert forces[0] == pytest.approx(forces[1], rel=1e-4)


@pytest.mark.parametrize(("temperature", "force"), [(-40, 3624.711844), (0, 3456.022081), (40, 3302.255931)])
def test_the_span_of_a_line_by_its_pull(temperature, force, validated):
    """Two lines of 100 m, one above the other, over a wheel of 1 µm on a block that the pull of both draws to 100 m."""
    radius = 1e-6
    scene = fu.Scene(gravity=(0, -10, 0), temperature=temperature)
    scene.rigid_body("block", mass=1.0, inertia=(1, 1, 1), position=(100.3, 0, 0))
    scene.joint("prismatic", (0, 0, 0), "block", axis=(1, 0, 0))
    scene.force("block", value=(2 * force, 0, 0))
    scene.rope("line", route=[fu.Anchor(at=(0, radius, 0)), fu.Sheave("wheel", "block", radius=radius, side="right"),
                              fu.Anchor(at=(0, -radius, 0))], elements=8, length=200 + np.pi * radius,
               section=fu.GeneralSection(area=1e-3, second_moment_about_y=1e-24, second_moment_about_z=1e-24),
               material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000, thermal_expansion=1.2e-5))
    rest = scene.equilibrium()
    validated("Statics", f"rope over a wheel, EA 1e6 N, spans of 100 m, 10 N/m, at {temperature} K", "span", 100.0,
              float(rest["block.position"][0]), unit="m", bound=1e-10, mesh="8 elements in each span",
              source="elastic catenary, weight kept, 1.2e-5 1/K", note="3e-9 of the pull")
    assert rest["line.start_force"][0] == pytest.approx(force, rel=1e-8)


@pytest.mark.parametrize("parameter", ["rope.length", "rope.temperature"])
def test_the_force_on_an_anchor_is_a_target(parameter):
    scene = two_spans(11.8, 0.0)
    rest = scene.equilibrium(adjust=[parameter], to={"rope.start_force.x": 4e3})
    assert rest["rope.start_force"][0] == pytest.approx(4e3, rel=1e-9)
    assert rest.scene.equilibrium()["rope.start_force"] == pytest.approx(rest["rope.start_force"], rel=1e-9)


@pytest.mark.parametrize("path", ["temperature", "rope.temperature"])
def test_a_temperature_lowers_a_body_to_its_place(path):
    own = path != "temperature"
    scene = fu.Scene(temperature=None if own else 10.0)
    scene.rigid_body("A", mass=20.0, inertia=(1, 1, 1), position=(0, -4, 0))
    route = [fu.Anchor("A"), fu.Sheave("sheave", at=(0.25, 3, 0), radius=0.25, side="right"), fu.Anchor(at=(5, 0, 0))]
    material = fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000.0, thermal_expansion=EXPANSION)
    scene.rope("rope", route=route, section=fu.Circle(radius=2e-3), material=material, length=13.1, mass=False,
               temperature=10.0 if own else None)
    height, stretch = scene.equilibrium()["A.position"][1], 1 + 20 * fu.Scene().gravity[1] / -(EA / 25)
    rest = scene.equilibrium(adjust=[path], to={"A.position.y": height - 0.01})
    assert rest.adjusted[path] - 10 == pytest.approx(0.01 / (13.1 * EXPANSION * stretch), rel=1e-3)
    assert rest.scene.equilibrium()["A.position"] == pytest.approx(rest["A.position"], abs=1e-9)


def test_files_and_resuming_keep_every_bit(tmp_path):
    check_file_and_resume(two_spans(14.65, 30.0, drum=True, mass=False), tmp_path, 20, duration=0.1, output_step=0.005,
                          tol=1e-3)
    scene = two_spans(of_scene=20.0)
    assert "temperature" not in scene.to_toml().partition("[[rope]]")[2]
    assert fu.Scene.from_toml(scene.to_toml()).to_toml() == scene.to_toml()


def test_refusals():
    with refused('rope "rope": the stress-free length must stay positive, got -19 times the length at 0 K; give '
                 "temperature in K above the stress-free state, thermal_expansion in 1/K"):
        two_spans(temperature=-1e6)
    with refused('rope "rope": is never taut: its length 13.98 m at its temperature exceeds that of its route as '
                 "drawn, 11.9428338 m, by 2.03716616 m; give a smaller length, or tension"):
        two_spans(temperature=1e4)
    with refused('rope "rope": the temperature of the scene is a signal, but a rope takes a number alone: its material '
                 "runs through the spans by its stress-free length, which must not change; give the rope its own "
                 "temperature in K, or let a drum pay out what it lengthens by"):
        two_spans(of_scene=fu.Ramp(start=0, end=1))
    with pytest.raises(fu.SceneError, match="its material has no thermal_expansion"):
        two_spans().replace("rope", temperature=5.0, material=fu.Material(
            youngs_modulus=1e9, poisson_ratio=0.3, density=1e3))
