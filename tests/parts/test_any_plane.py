"""Planar scenes in any plane are recognised and run with planar elements; results are along the ground's axes."""

import warnings

import numpy as np
import pytest
from expectations import refused
from funicular import (
    Circle,
    FunicularWarning,
    Harmonic,
    Material,
    Ramp,
    Rectangle,
    Scene,
    SceneError,
    TableSignal,
    load_run,
    load_scene,
)
from funicular.choice.planar import planar_of
from funicular.parts.in_plane import in_plane
from funicular.parts.signal import Constant, combined
from test_planar_form import FLAT, RUBBER, SCENES, WIRE, beam
from turned_scenes import ASKEW, UPRIGHT, differences, turned_scene

SOFT = Material(youngs_modulus=2e6, poisson_ratio=0.0, density=1000, damping_time=1e-3)


def shaken():
    """Return a rope with a body at its lower end and a vibrating support."""
    scene = Scene()
    scene.cable("rope", start=(0, 0, 0), end=(0, -1, 0), elements=4, element="cable12", section=Circle(radius=0.01),
                material=SOFT, up=(1, 0, 0), velocity=(0.3, 0, 0), angular_velocity=(0, 0, 0.5))
    scene.motion("rope", s=0.0, displacement=(Harmonic(amplitude=0.05, frequency=3.0), Ramp(start=0, end=0.1), 0))
    scene.rigid_body("A", mass=0.3, inertia=((3e-4, 1e-4, 0), (1e-4, 2e-4, 0), (0, 0, 4e-4)), position=(0, -1, 0),
                     orientation=(0.8, 0, 0, 0.6), centre=(0.02, -0.03, 0), angular_velocity=(0, 0, 2))
    scene.joint("spherical", ("rope", 1.0), "A", name="hook")
    scene.force("A", value=(0.3, 0.1, 0), at=(0.1, 0, 0), follower=True)
    scene.moment("A", value=(0, 0, 0.01))
    scene.spring(("A", (0.05, 0, 0)), (0.5, -1, 0), stiffness=5, damping=0.1, name="tie")
    return scene


def turned_ends():
    """Return a beam with a rotated end, its height downward, and follower forces."""
    scene = beam(up=(0, -1, 0))
    list.clear(scene.clamps)
    scene.motion("wire", s=0.0, displacement=(0, 0, 0), rotation=((0, 0, 1), TableSignal(time=(0, 0.1, 0.3),
                                                                                       value=(0, 0.1, 0.3))))
    scene.force("wire", s=1.0, value=(0.1, 0.4, 0), follower=True)
    scene.distributed_force("wire", value=(0, 0.3, 0), follower=True)
    scene.moment("wire", s=0.5, value=(0, 0, 0.02))
    return scene


def across_the_height():
    """Return a beam that bends about its height, with a follower force along its width."""
    scene = beam(up=(0, 0, 1))
    scene.force("wire", s=1.0, value=(0, 0, 0.4), follower=True)
    return scene


def eyelet():
    """Return a rope through an eyelet, with a driven slide, a hinge, and a body on a guide at its end.

    No joint is redundant, since rounding decides how redundant joints of spatial runs share forces.
    """
    scene = Scene()
    scene.cable("rope", start=(0, 0, 0), end=(2, 0, 0), elements=4, element="cable12", section=Circle(radius=0.01),
                material=SOFT, rest_length=1.98)
    scene.pin("rope", s=0.0)
    scene.slide((1.0, 0, 0), along="rope", s=0.99, name="eye")
    scene.rigid_body("A", mass=0.2, inertia=(1e-3, 1e-3, 2e-3), position=(0.5, 0, 0))
    scene.slide("A", along="rope", s=0.495, frame="tangent", roll="fixed",
                velocity=Ramp(start=0, end=0.2, after=0.5), name="drive")
    scene.rigid_body("B", mass=0.1, inertia=(1e-3,) * 3, position=(0.5, -0.3, 0))
    scene.joint("revolute", "A", ("B", (0, 0.3, 0)), axis=(0, 0, 1), name="hinge")
    scene.rigid_body("C", mass=0.1, inertia=(1e-3,) * 3, position=(2.2, 0, 0), velocity=(0.1, 0, 0))
    scene.joint("prismatic", "C", (2.2, 0, 0), axis=(1, 0, 0), name="guide")
    scene.spring("C", ("rope", 1.98), stiffness=100, damping=1, length=0.15, name="draw")
    return scene


ALL = SCENES | {"shaken": shaken, "turned ends": turned_ends, "across the height": across_the_height}


def run(scene, **changes):
    return scene.run(**{"duration": 0.1, "step": 2.5e-4, "output_step": 0.01, "integrator": "explicit"} | changes)


@pytest.mark.parametrize("move", [UPRIGHT, ASKEW], ids=["upright", "askew"])
@pytest.mark.parametrize("scene", ALL.values(), ids=ALL)
def test_all_results_are_those_of_the_spatial_scene(scene, move):
    drawn = scene()
    spatial = turned_scene(drawn, *move)
    planar = planar_of(spatial)
    assert planar.scene is not None, planar
    assert planar.scene.dim == 2 and planar.scene.plane is not None
    runs = [run(each) for each in (planar.scene, spatial, drawn)]
    apart = differences(*runs[:2], scenes=(planar.scene, spatial))
    assert max(apart.values()) < 1e-9, {name: value for name, value in apart.items() if value >= 1e-9}
    for energy in ("kinetic", "elastic", "dissipated", "external"):  # and the turned scene is the one that was drawn
        assert runs[0][f"energy.{energy}"] == pytest.approx(runs[2][f"energy.{energy}"], abs=1e-10)
    assert np.ptp(runs[1][f"energy.{'kinetic'}"]) > 1e-4


@pytest.mark.parametrize("scene", [turned_ends, across_the_height, eyelet])
def test_scenes_drawn_in_z_0(scene):
    """Also with a height of planar elements in another direction than ``up``."""
    spatial = scene()
    planar = planar_of(spatial)
    assert planar.scene is not None and planar.scene.plane is None, planar
    apart = differences(run(planar.scene), run(spatial))
    assert max(apart.values()) < 1e-9, apart


def test_slides_and_joints():
    """All results except second rates of s, in which planar and spatial kernels differ by 1e-8 of rounding, also in z =
    0.
    """
    spatial = turned_scene(eyelet(), *ASKEW)
    planar = planar_of(spatial)
    assert planar.scene is not None, planar
    apart = differences(run(planar.scene), run(spatial))
    assert max(value for name, value in apart.items() if not name.endswith("acceleration")) < 1e-9, apart


def test_the_planar_scene_says_its_plane():
    assert str(planar_of(turned_scene(shaken(), *UPRIGHT))).startswith("the scene stays in the plane y = 0: rope of "
                                                                     "cable8p; motion out of the plane")
    found = planar_of(turned_scene(shaken(), (np.pi / 2, 0, 0), (0, 0.25, 0)))
    assert "the plane y = 0.25: " in str(found)
    assert "the plane through (" in str(planar_of(turned_scene(shaken(), *ASKEW)))


def sideways(scene):
    scene.force("A", value=(0.5, 0.1, 0.2))


def free_in_part(scene):
    list.clear(scene.motions)
    scene.motion("rope", s=0.0, displacement=(0, None, 0))


@pytest.mark.parametrize(("change", "move", "reason"), [
    (sideways, UPRIGHT, "in whose axes it is"), (sideways, ASKEW, "in whose axes it is"),
    (free_in_part, ASKEW, "leaves a direction free that is neither an axis of the plane nor its normal")])
def test_what_keeps_a_scene_spatial(change, move, reason):
    scene = turned_scene(shaken(), *move)
    change(scene)
    found = planar_of(scene)
    assert found.scene is None and reason in str(found)


def test_a_free_direction_along_the_axes_of_the_plane():
    spatial = turned_scene(shaken(), *UPRIGHT)
    list.clear(spatial.motions)
    spatial.motion("rope", s=0.0, displacement=(0, None, None))
    planar = planar_of(spatial)
    assert planar.scene is not None, planar
    assert max(differences(run(planar.scene), run(spatial)).values()) < 1e-9


def upright(element="cable8p"):
    """Return a clamped wire with z up and a body at its end."""
    scene = Scene(gravity=(0, 0, -9.81))
    scene.cable("wire", start=(0, 0.2, 0.5), end=(1, 0.2, 0.5), up=(0, 0, 1), elements=4, element=element,
                section=Rectangle(height=0.02, width=0.02), material=RUBBER, strain="engineering")
    scene.clamp("wire", s=0.0)
    scene.rigid_body("A", mass=0.05, inertia=(1e-4,) * 3, position=(1, 0.2, 0.5), velocity=(0, 0, -1))
    scene.joint("spherical", ("wire", 1.0), "A", name="hook")
    return scene


@pytest.fixture(scope="module")
def pair():
    with pytest.warns(Warning, match="broke a joint"):
        return [run(upright(element)) for element in ("cable8p", "cable12")]


def test_a_planar_cable_written_by_hand(pair):
    assert max(differences(*pair).values()) < 1e-9
    assert np.ptp(pair[0]["A.position"][:, 1]) == 0.0 and pair[0]["A.position"][0, 1] == 0.2


@pytest.mark.parametrize("given", [{}, {"method": "constitutive"}])
def test_section_forces(pair, given):
    planar, spatial = (each.section_forces("wire", [0.0, 0.3, 0.5, 1.0], **given) for each in pair)
    for name in spatial:
        assert np.abs(planar[name] - spatial[name]).max() < 1e-9 * max(1.0, np.abs(spatial[name]).max()), name


def test_a_state_of_a_run_and_a_run_on_from_it(pair):
    states = [each.at(0.05) for each in pair]
    runs = [run(upright(element), initial=state) for element, state in zip(("cable8p", "cable12"), states, strict=True)]
    assert max(differences(*runs).values()) < 1e-9
    assert np.array_equal(runs[0]["A.position"][0], pair[0]["A.position"][5])
    state = {"A.position": (1, 0.3, 0.5), "A.velocity": (0, 0, 0)}
    with pytest.raises(SceneError, match=r"A: position .* the scene lies in"):
        run(upright(), initial=state)
    with pytest.raises(SceneError, match=r"leaves the plane y = 0\.2"):
        vectors = np.array(states[0]["wire.nodal_vectors"])
        vectors[-1, 0, 1] += 0.01
        run(upright(), initial={"wire.nodal_vectors": vectors})


def test_equilibrium_relaxation_and_modes():
    scenes = [upright(element) for element in ("cable8p", "cable12")]
    for method in ("equilibrium", "relax"):
        planar, spatial = (getattr(scene, method)() for scene in scenes)
        apart = differences(planar, spatial)
        assert max(apart.values()) < (1e-9 if method == "equilibrium" else 1e-6), apart
        assert planar.scene is scenes[0]
    rests = [scene.equilibrium() for scene in scenes]
    forces = [rest.section_forces("wire", [0.2, 0.7]) for rest in rests]
    for name in forces[1]:
        assert np.abs(forces[0][name] - forces[1][name]).max() < 1e-8
    runs = [run(scene, initial=rest) for scene, rest in zip(scenes, rests, strict=True)]
    assert max(differences(*runs).values()) < 1e-8
    modes = [scene.modes(n, about=rest) for scene, rest, n in zip(scenes, rests, (2, 5), strict=True)]
    across = [k for k in range(5) if np.ptp(modes[1]["wire.displacement"][k, :, 1]) > 1e-6]
    inside = [k for k in range(5) if k not in across and modes[1].frequency[k] > 1e-3][:2]
    found = [k for k in range(2) if modes[0].frequency[k] > 1e-3]
    assert found and inside
    assert modes[0].frequency[found[0]] == pytest.approx(modes[1].frequency[inside[0]], rel=1e-6)
    shapes = modes[0]["wire.displacement"][found[0]], modes[1]["wire.displacement"][inside[0]]
    sign = np.sign(np.sum(shapes[0] * shapes[1]))
    assert np.abs(sign * shapes[0] - shapes[1]).max() < 1e-5


def test_a_state_of_rest_of_another_plane_is_refused():
    rest = upright().equilibrium()
    other = turned_scene(upright("cable12"), (0, 0, np.pi / 2), (0, 0, 0))
    other = planar_of(other).scene
    with pytest.raises(SceneError, match=r"its plane are .*the plane y = 0\.2.*the plane x = "):
        other.equilibrium(start=rest)


def test_events_of_components_and_functions():
    found = []
    for element in ("cable8p", "cable12"):
        scene = turned_scene(upright("cable12"), *ASKEW)
        scene = planar_of(scene).scene if element == "cable8p" else scene
        scene.event(name="down", quantity="A.position.z", value=scene.bodies["A"].position[2] - 0.02)
        scene.event(name="fast", quantity="wire.velocity.y", s=0.5, value=0.23)
        scene.event(name="mine", function=lambda time, state: state["A.velocity"][0] - 0.39)
        with pytest.warns(Warning, match="broke a joint"):
            found.append(run(scene).events)
    assert {event["name"] for event in found[0]} == {"down", "fast", "mine"}
    for one, other in zip(*found, strict=True):
        assert one["name"] == other["name"] and one["time"] == pytest.approx(other["time"], abs=1e-9)
        assert one["state"]["A.position"] == pytest.approx(other["state"]["A.position"], abs=1e-9)


def test_files_and_resumed_runs(tmp_path):
    scene = upright()
    again = Scene.from_toml(scene.to_toml())
    assert again.cables["wire"] == scene.cables["wire"] and again.plane.normal.tolist() == [0, -1, 0]
    with pytest.warns(Warning, match="broke a joint"):
        kept, saved = run(scene), run(scene, save=tmp_path / "out.nc")
    read = load_run(tmp_path / "out.nc")
    for name in kept:
        assert np.array_equal(kept[name], saved[name]) and np.array_equal(kept[name], read[name]), name
    assert np.array_equal(read.section_forces("wire", 0.5)["force"], kept.section_forces("wire", 0.5)["force"])
    assert read.animation().clips[0].cables[0].position.shape == kept.animation().clips[0].cables[0].position.shape


def test_a_resumed_run_is_the_same_bit_for_bit(tmp_path):
    """A resumed run rotates its rows in other blocks."""
    scene = planar_of(turned_scene(upright("cable12"), *ASKEW)).scene

    def stop(time):
        if time > 0.15:
            raise KeyboardInterrupt

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FunicularWarning)
        whole = run(scene, duration=0.5)
        assert run(scene, duration=0.5, save=tmp_path / "out.nc", progress=stop).status == "interrupted"
        resumed = run(scene, duration=0.5, save=tmp_path / "out.nc", resume=True)
    assert len(resumed.time) == len(whole.time)
    for name in whole:
        assert np.array_equal(resumed[name], whole[name]), name


def test_pictures_show_the_height_in_the_plane(pair):
    planar, spatial = (each.animation().clips[0].cables[0] for each in pair)
    assert np.abs(planar.position - spatial.position).max() < 1e-9
    assert np.allclose(planar.section_y[:, :, 1], 0.0) and np.all(planar.section_y[0, :, 2] > 0.5)
    for one, other in zip(planar.quantities, spatial.quantities, strict=True):
        assert np.abs(one.values - other.values).max() < 1e-8 * max(1.0, np.abs(other.values).max())


def test_quantities_that_steps_follow():
    runs = [upright().run(0.1, tol=1e-4, quantities=[f"A.position.{axis}"]) for axis in "xz"]
    assert all("chosen by the error of A.position" in " ".join(each.report["messages"]) for each in runs)
    with refused('run: quantities: "A.position.y" is always the same: the scene lies in a plane across y; '
                 "take another component"):
        upright().run(0.1, tol=1e-4, quantities=["A.position.y"])
    with refused('event "event_1": "A.position.y" is always the same: the scene is planar; watch x or z'):
        upright().event(quantity="A.position.y", value=0.2)


def test_a_scene_is_chosen_planar_where_z_is_up():
    scene = Scene(gravity=(0, 0, -9.81))
    scene.cable("strip", start=(0, 0, 1), end=(1, 0, 1), up=(0, 0, 1), section=FLAT, material=RUBBER)
    scene.clamp("strip", s=0.0)
    choice = scene.choose(1e-2, duration=0.1)
    assert choice.scene.dim == 2 and choice.reasons[0].startswith("the scene stays in the plane y = 0")
    found = choice.scene.run(0.1, tol=1e-3)
    assert np.all(found["strip.position"][..., 1] == 0) and found["strip.position"][-1, -1, 2] < 0.99


def test_planar_parts_that_do_not_fit():
    scene = upright()
    with refused('cable "tail": lies in the plane y = 0.2, with the height at (0, 1, 0) x tangent, but cable "wire" in '
                 'the plane y = 0.2, with that at (0, -1, 0) x tangent; draw both in one plane, and give up, on the '
                 "same side of it"):
        scene.cable("tail", **WIRE | {"element": "cable8p", "start": (1, 0.2, 0.5), "end": (2, 0.2, 0.5),
                                      "up": (0, 0, -1)})
    with pytest.raises(SceneError, match=r"velocity .* leaves the plane y = 0\.2 of the cable8p cable"):
        scene.rigid_body("B", mass=1, inertia=(1, 1, 1), position=(1, 0.2, 0), velocity=(0, 1, 0))
    with pytest.raises(SceneError, match="up must not be zero or parallel to the axis"):
        Scene().cable("wire", **WIRE | {"element": "cable8p", "end": (0, 0, 1), "up": (0, 0, 1)})


def test_modal_bodies_in_a_plane():
    """The modes of beam12p are in the plane by definition. The same scene in z = 0 has the same motion."""
    def made(x, y, normal):
        scene = Scene(gravity=tuple(-9.81 * np.array(y)))
        x, y = np.array(x, dtype=float), np.array(y, dtype=float)
        scene.cable("rope", start=tuple(x), end=tuple(1.5 * x), elements=2, element="cable8p", up=tuple(y),
                    section=Circle(radius=0.01), material=SOFT)
        scene.modal_body("bar", start=(0, 0, 0), end=tuple(x), up=tuple(y), section=FLAT, material=RUBBER,
                         element="beam12p", modes=3, boundary="attached")
        scene.joint("revolute", ("bar", (0, 0, 0)), (0, 0, 0), axis=normal, name="hinge")
        scene.joint("spherical", ("bar", (1, 0, 0)), ("rope", 0.0), name="hook")
        return run(scene, integrator="genalpha", step=1e-3)

    flat, up = made((1, 0, 0), (0, 1, 0), (0, 0, 1)), made((1, 0, 0), (0, 0, 1), (0, -1, 0))
    assert np.array_equal(flat["bar.modal_coordinates"], up["bar.modal_coordinates"])
    assert np.array_equal(flat["bar.nodes"][..., 1], up["bar.nodes"][..., 2])
    assert np.array_equal(flat["hook.force"][..., 1], up["hook.force"][..., 2])
    assert np.allclose(up["bar.orientation"][0], (np.sqrt(0.5), np.sqrt(0.5), 0, 0))


def test_sums_of_signals():
    time = np.linspace(-1, 4, 101)
    one, other = Ramp(start=0.5, end=2, after=3), TableSignal(time=(0, 1, 3), value=(0, 2, 1))
    waves = Harmonic(amplitude=2, frequency=0.5, phase=0.3), Harmonic(amplitude=1, frequency=0.5, offset=1)
    signals, factors = (one, other, *waves, Constant(constant=2.0)), (0.6, -0.8, 1.5, 2.0, 3.0)
    total = combined(factors, signals)
    for derivative in range(3):
        expected = sum(f * s.value(time, derivative) for f, s in zip(factors, signals, strict=True))
        assert total.value(time, derivative) == pytest.approx(expected, abs=1e-10)
    assert combined((0.6, -0.3), (one, Ramp(start=0.5, end=2, after=6))) == Constant(constant=0.0)
    with pytest.raises(ValueError, match="several frequencies"):
        combined((1.0, 1.0), (Harmonic(amplitude=1, frequency=1), Harmonic(amplitude=1, frequency=2)))


def test_spatial_scenes_and_those_in_z_0_are_not_turned():
    for name in ("paper51", "cable_car"):
        scene = load_scene(name)
        assert in_plane(scene) is scene
