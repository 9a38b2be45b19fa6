"""Section forces by balance against free bodies cut by hand, and reported forces."""

import warnings

import numpy as np
import pytest
from funicular import (
    Circle,
    FunicularWarning,
    Harmonic,
    Material,
    Plane,
    Rectangle,
    Scene,
    TableProfile,
    load_run,
    load_scene,
)
from funicular.generated import kernels
from funicular.results import recording
from funicular.results.section_forces.balance import Cuts, balanced
from funicular.results.section_forces.balance_limits import balanced_cables
from funicular.results.section_forces.cable_loads import CableLoads
from funicular.results.section_forces.forces import _instants, jumps, rest_instants
from funicular.results.section_forces.nodal_forces import element_forces
from numpy.testing import assert_allclose

SOFT = {"youngs_modulus": 1e8, "poisson_ratio": 0.3, "density": 2000}
G = np.array([0, -9.81, 0])
def cable(scene, name="rope", element="cable12", elements=6, start=(0, 0, 0), end=(6, 0, 0), damping=0.0, **given):
    beam = element.startswith("beam")
    given = ({"law": "structural"} if beam else {}) | given
    return scene.cable(name, start=start, end=end, elements=elements, element=element,
                       section=Rectangle(height=0.06, width=0.05 if beam else 0.06) if beam else Circle(radius=0.03),
                       material=Material(**SOFT, damping_time=damping, mass_damping=100 * damping), **given)


def scene_between_pins(element, **given):
    scene = Scene(gravity=G)
    rope = cable(scene, element=element, **given)
    scene.pin(rope, s=0)
    scene.pin(rope, s=6)
    return scene


def loads(element, **given):
    """Return a scene with every kind of load, and a rider with friction."""
    scene = scene_between_pins(element, damping=1e-3, **given)
    across = 0 if element in ("cable12", "cable18") else -50
    scene.force("rope", s=2.3, value=(10, -50, 0), scale=Harmonic(amplitude=2, frequency=3))
    scene.force("rope", s=3.3, value=(10, across, 0), follower=True)
    scene.moment("rope", s=4.1, value=(0, 0, 20))
    scene.distributed_force("rope", value=(0, -30, 0), start=1.2, stop=3.7)
    scene.distributed_force("rope", value=(5, across, 0), start=2.2, stop=4.7, follower=True)
    scene.rigid_body("A", mass=5, inertia=(0.1, 0.1, 0.1), position=(1.5, 0, 0), velocity=(1, 0, 0))
    scene.slide("A", along="rope", s=1.5, name="trolley")
    return scene


def tied(element, frame, **given):
    """Return a rider whose frame follows that of the cable, with an eccentric mass."""
    scene = scene_between_pins(element)
    z = 0.0 if element.endswith("p") else 0.1
    scene.rigid_body("A", mass=5, inertia=(0.1, 0.1, 0.1), position=(1.8, -0.4, z), velocity=(1, 0, 0))
    scene.slide("A", along="rope", s=1.5, at=(-0.3, 0.4, -z), name="trolley", frame=frame, **given)
    return scene


def driven():
    scene = scene_between_pins("cable12")
    scene.rigid_body("A", mass=5, inertia=(0.1, 0.1, 0.1), position=(1.8, -0.4, 0))
    scene.slide("A", along="rope", s=1.5, at=(-0.3, 0.4, 0), name="trolley", frame="tangent", velocity=1.0)
    return scene


def cable_on_cable(frame):
    scene = scene_between_pins("cable12")
    cable(scene, "link", "beam24", 3, (2.5, 0, 0), (2.7, -1, 0), up=(1, 0, 0))
    scene.slide(("link", 0.0), along="rope", s=2.5, name="trolley", frame=frame)
    return scene


def modal_rider():
    scene = scene_between_pins("cable12")
    scene.modal_body("A", start=(2.5, 0, 0), end=(2.5, -1, 0), section=Rectangle(height=0.02, width=0.02),
                     material=Material(**SOFT), up=(1, 0, 0), modes=4)
    scene.slide(("A", 0.0), along="rope", s=2.5, name="trolley", frame="tangent")
    return scene


def frame_of_beams():
    """Return a frame with a corner, a hinge, springs between cables and from the ground, and joints of all kinds on
    cables.
    """
    scene = Scene(gravity=G)
    cable(scene, element="beam24")
    scene.clamp("rope", s=0)
    cable(scene, "leg", "beam24", 3, (3, 0, 0), (3, 0, 2))
    scene.tie("rope", s=3.0, to="leg", at=0.0, name="corner")
    arm = cable(scene, "arm", "cable12", 3, (6, 0, 0), (8, -0.5, 0))
    scene.tie("rope", s=6.0, to="arm", at=0.0, rotation="free", name="hinge")
    scene.spring(("rope", 2.2), ("leg", 1.3), stiffness=500, damping=5, length=0.3)
    scene.spring(("arm", 0.7), (8, 3, 0), stiffness=300, length=2)
    for name, x in (("A", 4.5), ("B", 1.5), ("C", 5.2), ("E", 2.4)):
        scene.rigid_body(name, mass=3, inertia=(0.1, 0.1, 0.1), position=(x, -0.4, 0))
    scene.rigid_body("D", mass=2, inertia=(0.1, 0.1, 0.1), position=arm.point(1.1))
    scene.joint("revolute", ("rope", 4.5), ("A", (0, 0.4, 0)), axis=(0, 0, 1))
    scene.joint("distance", "B", ("rope", 1.7))
    scene.joint("prismatic", ("rope", 5.2), "C", axis=(0, 1, 0))
    scene.joint("universal", ("E", (0, 0.4, 0)), ("rope", 2.4), axis=(0, 1, 0), second_axis=(0, 0, 1))
    scene.joint("weld", ("arm", 1.1), "D", up=(0, 1, 0))
    return scene


def moved():
    scene = Scene(gravity=G)
    cable(scene, element="beam24")
    scene.motion("rope", s=0.0, displacement=(0, Harmonic(amplitude=0.1, frequency=2), 0),
                 rotation=((0, 0, 1), Harmonic(amplitude=0.1, frequency=3)))
    scene.pin("rope", s=4.0)
    return scene


def turned_round():
    """Return a planar joint driven about -z: the reversed pair driven about z."""
    scene = Scene(gravity=G)
    cable(scene, element="beam12p", elements=3, end=(1, 0, 0))
    scene.clamp("rope", s=0)
    scene.rigid_body("A", mass=2, inertia=(0.1, 0.1, 0.1), position=(1, -0.5, 0))
    scene.joint("revolute", ("rope", 1.0), ("A", (0, 0.5, 0)), axis=(0, 0, -1), name="hinge",
                angle=Harmonic(amplitude=0.3, frequency=1))
    return scene


def in_a_stream(element, **given):
    """Return joined cables in a stream that varies with height and time, with added mass across and along them."""
    scene = scene_between_pins(element, damping=1e-3, **given)
    cable(scene, "arm", element, 3, (6, 0, 0), (7, -0.6, 0), damping=1e-3)
    scene.tie("rope", s=6.0, to="arm", at=0.0, rotation="free", name="hinge")
    scene.rigid_body("A", mass=5, inertia=(0.1, 0.1, 0.1), position=(1.5, 0, 0), velocity=(1, 0, 0))
    scene.slide("A", along="rope", s=1.5, name="trolley")
    scene.fluid("sea", density=1000, velocity=(2, 1, 0), scale=Harmonic(amplitude=2, frequency=1, phase=0.3),
                profile=TableProfile(height=[-5, 0, 5], factors=[0.5, 1.0, 1.8]))
    scene.drag("rope", diameter=0.06, normal=1.2, tangential=0.1, fluid="sea",
               added_mass=1.4, added_mass_tangential=0.2)
    scene.drag("arm", diameter=0.06, normal=1.2, added_mass=0.8, fluid="sea")
    return scene


def pulled_over_the_ground():
    scene = Scene(gravity=G)
    cable(scene, element="cable12", damping=1e-3)
    scene.motion("rope", s=0.0, displacement=(0, Harmonic(amplitude=0.3, frequency=1), 0))
    scene.surface("ground", Plane(point=(0, -0.031, 0)))
    scene.contact("rope", "ground", stiffness=1e4)
    return scene


SCENES = {
    "pulled over the ground": pulled_over_the_ground,
    **{f"stream of {e}": lambda e=e: in_a_stream(e) for e in ("cable12", "cable8p", "beam24")},
    **{f"loads on {e}": lambda e=e: loads(e) for e in ("cable12", "cable18", "cable8p", "beam12p", "beam24")},
    "loads on beam24 continuum": lambda: loads("beam24", law="continuum"),
    **{f"tangent of {e}": lambda e=e: tied(e, "tangent") for e in ("cable12", "cable8p", "beam12p")},
    "tangent of beam24": lambda: tied("beam24", "tangent", roll="fixed"),
    "tangent and up": lambda: tied("cable12", "tangent", roll="fixed", up=(0, 1, 0.2)),
    **{f"section of {e}": lambda e=e: tied(e, "section") for e in ("beam24", "beam12p")},
    "driven": driven,
    "cable on cable": lambda: cable_on_cable("point"),
    "cable tied to cable": lambda: cable_on_cable("tangent"),
    "modal rider": modal_rider,
    "frame": frame_of_beams,
    "motion": moved,
    "turned round": turned_round,
}


@pytest.fixture
def engine_rows(monkeypatch):
    """Return the recorded rows of the engine with the results of the run."""
    kept, named = {}, recording.named

    def spy(model, scene, rows, alone=None):
        kept.update(rows)
        return named(model, scene, rows, alone)

    monkeypatch.setattr(recording, "named", spy)
    return kept


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("name", SCENES)
def test_accelerations_are_the_engines(name, engine_rows):
    """They follow from recorded forces, so that a missing or misplaced force shows here."""
    run = SCENES[name]().run(duration=0.2, output_step=0.1, tol=1e-4)
    model, at = run.model, _instants(run, np.arange(len(run.time)))
    for k, cable in enumerate(model.cables):
        found = element_forces(model, at, loads_of(run.scene, model, at, k), k)
        a = found.inertia + np.where((np.array(cable.vectors * 2) == "r")[:, None], run.scene.gravity[: model.dim], 0)
        a = a - cable.mass_damping * _of_elements(cable, at.v)
        expected = _of_elements(cable, engine_rows["acceleration"])
        largest = np.abs(engine_rows["acceleration"][:, : len(model.unknown_of_dof)]).max()
        assert_allclose(a, expected, atol=1e-9 * largest)


def loads_of(scene, model, at, k):
    return CableLoads(scene, model, at, balanced_cables(scene, model, k, at.is_rest))


def gaps_at_nodes(scene, model, at):
    """Return the jumps of force and moment at inner nodes without loads, relative to the largest value."""
    for k, (name, cable) in enumerate(scene.cables.items()):
        s = np.setdiff1d(np.round(cable.node_s, 9)[1:-1], np.round(jumps(scene, name), 9))[None]
        loads = loads_of(scene, model, at, k)
        elements = element_forces(model, at, loads, k)
        places = (s, False), (s, True), (np.linspace(0, cable.length, 50)[None], True)
        before, after, every = (
            balanced(cable, model.cables[k], elements, loads, k, Cuts(model.cables[k], where, side))[:2]
            for where, side in places)
        yield from (np.abs(b - a).max(initial=0) / np.abs(e).max()
                    for b, a, e in zip(before, after, every, strict=True))


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("name", [name for name in SCENES if name != "motion"])
def test_nothing_is_left_over_at_nodes(name):
    """The force transmitted by an element, by integrals, equals the one received at its other node."""
    scene = SCENES[name]()
    run = scene.run(duration=0.1, output_step=0.1, tol=1e-4)
    for gap in gaps_at_nodes(run.scene, run.model, _instants(run, np.arange(2))):
        # a turning load of the fifth degree, by 4 points; the fluid's force on the slope, a polynomial through as many
        assert gap < (1e-4 if name == "loads on cable18" or "stream" in name else 1e-9)


RESTS = ["loads on cable12", "loads on beam24", "section of beam24", "cable tied to cable"]


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("name", RESTS)
@pytest.mark.slow_cases("loads on beam24")
def test_at_rest(name):
    """In equilibrium, riders are driven; otherwise their slides would move to the lowest point."""
    scene = SCENES[name]()
    rest = scene.equilibrium()
    for slide in scene.slides.values():
        before, after = (rest.section_forces(slide.along, slide, side=side)["force"] for side in ("before", "after"))
        assert_allclose(before - after, -rest[f"{slide.name}.force"], atol=1e-6)
        s = rest.section_forces(slide.along)["s"].values
        assert np.sum(np.abs(s - rest[f"{slide.name}.s"]) < 1e-7) >= 2
    for gap in gaps_at_nodes(scene, rest.model, rest_instants(rest)):
        assert gap < 1e-6


def _of_elements(cable, values):
    nodal = values[:, cable.coordinates].reshape(len(values), *cable.shape)
    return np.concatenate([nodal[:, :-1], nodal[:, 1:]], axis=2)


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("name", [name for name in SCENES if "stream" not in name])
def test_forces_between_cuts(name):
    """Jumps equal the reported forces; free ends have no force; supports have their reported force.

    In a stream the fluid acts on ends as well, see test_section_fluid.py.
    """
    run = SCENES[name]().run(duration=0.2, output_step=0.1, tol=1e-4)
    scale = max(np.abs(run.section_forces(cable)["force"]).max().item() for cable in run.scene.cables)
    for slide in run.scene.slides.values():
        before, after = (run.section_forces(slide.along, slide, side=side)["force"].values
                         for side in ("before", "after"))
        assert_allclose(before - after, -run[f"{slide.name}.force"], atol=1e-9 * scale)
    for name, cable in run.scene.cables.items():
        supported = {(support.cable, support.s): run[f"{support.label}.force"] for support in run.scene.supports}
        tied = {(on, s) for tie in run.scene.ties.values() for on, s in ((tie.cable, tie.s), (tie.to, tie.at))}
        riding = {(slide.rider.on, slide.rider.s) for slide in run.scene.slides.values()}
        riding |= {(end.on, end.s) for joint in run.scene.joints.values() for end in (joint.a, joint.b)}
        for s, sign in ((0.0, -1), (cable.length, 1)):
            if (name, s) in tied | riding:
                continue
            given = supported.get((name, s), np.zeros((len(run.time), 3)))
            at_end = run.section_forces(name, [s])
            assert_allclose(at_end["force"].values[:, 0], sign * given, atol=1e-9 * scale)
            if (name, s) not in supported:
                assert_allclose(at_end["moment"].values, 0, atol=1e-7 * scale)
        for (on, s), given in supported.items():
            if on == name and 0 < s < cable.length:
                before, after = (run.section_forces(name, [s], side=side)["force"].values[:, 0]
                                 for side in ("before", "after"))
                assert_allclose(before - after, given, atol=1e-9 * scale)


def test_riders_force_is_that_of_its_motion():
    """A moment on a frame that rotates along the cable is also a force along it."""
    run = tied("cable12", "tangent").run(duration=0.4, output_step=0.1, tol=1e-4)
    assert np.abs(run["trolley.moment"]).max() > 0.5
    assert_allclose(run["trolley.force"], 5 * (run["A.acceleration"] - G), atol=1e-9)


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
def test_joint_about_the_other_axis_reports_its_second_end():
    run = turned_round().run(duration=0.2, output_step=0.1)
    assert_allclose(run["hinge.force"], 2 * (run["A.acceleration"] - G), atol=1e-7)


def test_spring_on_a_modal_body_ends_on_its_node():
    scene = Scene(gravity=G)
    scene.modal_body("A", start=(2, 0, 0), end=(4, 0, 0), section=Rectangle(height=0.02, width=0.02),
                     material=Material(**SOFT), modes=3)
    scene.spring(("A", 2.0), (4, 3, 0), stiffness=300, length=2.5, name="spring")
    run = scene.run(duration=0.2, output_step=0.1)
    assert_allclose(run["spring.length"], np.linalg.norm(run["A.nodes"][:, -1] - [4, 3, 0], axis=1), rtol=1e-12)
    assert_allclose(np.abs(run["spring.tension"]), np.linalg.norm(run["spring.force"], axis=1), rtol=1e-9)


class TestZipLine:
    """84 kg on 120 m of rope: 19 kN, a kink of 4 degrees, which a cubic spreads over the length of an element."""

    @pytest.fixture(scope="class", params=[24, 48, 96])
    @staticmethod
    def run(request):
        scene = load_scene("zip_line")
        scene.put(scene.cables["rope"].model_copy(update={"elements": request.param}))
        return scene.run(duration=10.05)

    def test_tension_beside_the_rider_is_that_of_the_pieces(self, run):
        """At 10 s, each part from its support: weight, and inertia by differences of velocities in time."""
        k, rope = len(run.time) - 2, run.scene.cables["rope"]
        rate = (run["rope.nodal_velocity"][k + 1] - run["rope.nodal_velocity"][k - 1])[:, 0] / 0.1
        s, rider = run.coords["rope.node"].values, run["wheels.s"][k]
        for side, support, piece in (("before", "rope@0", s < rider), ("after", "rope@120.4", s > rider)):
            mass = rope.material.density * rope.section.area * abs(rider - (0 if side == "before" else 120.4))
            pull = np.linalg.norm(mass * (rate[piece].mean(axis=0) - G) - run[f"{support}.force"][k])
            forces = run.section_forces("rope", "wheels", side=side)
            assert forces["tension"].values[k] == pytest.approx(pull, rel=5e-3)
        by_law = run.section_forces("rope", "wheels", method="constitutive")["tension"].values[k]
        assert abs(by_law - pull) > 0.03 * pull  # what it is all for

    def test_it_is_smooth_along_each_piece(self, run):
        k, rider = len(run.time) - 2, run["wheels.s"][-2]
        for s in (np.linspace(rider - 12, rider - 0.01, 80), np.linspace(rider + 0.01, rider + 12, 80)):
            tension = run.section_forces("rope", s)["tension"].values[k]
            assert np.ptp(tension) < 2e-3 * tension.mean()
            assert tension.mean() == pytest.approx(19090, rel=5e-3)  # of the three meshes


def test_read_back(tmp_path):
    run = loads("cable12").run(duration=0.2, output_step=0.05)
    run.save(tmp_path / "run.nc")
    again = load_run(tmp_path / "run.nc")
    for s in (None, "trolley", [0.3, 6.0]):
        assert again.section_forces("rope", s).identical(run.section_forces("rope", s))


def test_reading_back_says_nothing_anew(tmp_path):
    """The scene is made again from its text without repeating the messages of its placement."""
    scene = scene_between_pins("cable12")
    cable(scene, "link", "beam24", 3, (2.5, -1e-4, 0), (2.7, -1, 0), up=(1, 0, 0))
    with pytest.warns(FunicularWarning, match="are brought together"):
        scene.slide(("link", 0.0), along="rope", s=2.5, name="trolley")
    scene.run(duration=0.05, output_step=0.05).save(tmp_path / "run.nc")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert load_run(tmp_path / "run.nc").section_forces("rope", "trolley")["tension"].shape == (2,)


def test_many_times_go_in_pieces(monkeypatch):
    run = loads("cable12").run(duration=0.2, output_step=0.02)
    whole = run.section_forces("rope"), run.section_forces("rope", "trolley")
    monkeypatch.setattr("funicular.results.section_forces.forces.MAX_BLOCK", 200)
    for before, after in zip(whole, (run.section_forces("rope"), run.section_forces("rope", "trolley")), strict=True):
        assert_allclose(after["tension"], before["tension"], rtol=1e-9)


@pytest.mark.parametrize("name", ["cable12_green_exact_section_forces", "beam24_mass", "frame_moment"])
def test_kernels_many_times(name):
    rng = np.random.default_rng(1)
    kernel = getattr(kernels, name)
    shapes = list(kernel.shapes.items())[: len(kernel.__signature__.parameters)]
    given = [0.5 + rng.random((5, *shape)) for _, shape in shapes]
    given[-1] = given[-1][0]
    many, single = kernel.rows(5, *given), [kernel(*(a[k] for a in given[:-1]), given[-1]) for k in range(5)]
    for k, one in enumerate(single):
        for all_of, value in zip(many if isinstance(many, tuple) else (many,),
                                 one if isinstance(one, tuple) else (one,), strict=True):
            np.testing.assert_array_equal(all_of[k], value)
    with pytest.raises(ValueError, match="must have shape"):
        kernel.rows(4, *given)
    with pytest.raises(TypeError, match=r"takes \("):
        kernel.rows(5, *given[1:])
