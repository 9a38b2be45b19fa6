"""Section forces in balance: against free bodies cut out by hand, reported forces, and closed forms."""

import warnings

import numpy as np
import pytest
from funicular import (
    Circle,
    FunicularWarning,
    GeneralSection,
    Harmonic,
    Material,
    Rectangle,
    Scene,
    load_run,
    load_scene,
)
from funicular.generated import kernels
from funicular.results import (
    recording,
)
from funicular.results.nodal_forces import element_forces
from funicular.results.section_balance import Cuts, balanced
from funicular.results.section_forces import CableLoads, _instants, jumps, rest_instants
from numpy.testing import assert_allclose

SOFT = {"youngs_modulus": 1e8, "poisson_ratio": 0.3, "density": 2000}
G = np.array([0, -9.81, 0])
LOAD, LENGTH, DEPTH = 10.0, 2.0, 0.1


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
    """Every kind of load, and a rider with friction."""
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
    """A rider whose frame goes with the cable's, its mass off to the side."""
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
    """A corner, a hinge, springs between cables and from the ground, joints of all sorts on points of cables."""
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
    """A planar joint that is driven about -z: what a sees of b is what b sees of a about z."""
    scene = Scene(gravity=G)
    cable(scene, element="beam12p", elements=3, end=(1, 0, 0))
    scene.clamp("rope", s=0)
    scene.rigid_body("A", mass=2, inertia=(0.1, 0.1, 0.1), position=(1, -0.5, 0))
    scene.joint("revolute", ("rope", 1.0), ("A", (0, 0.5, 0)), axis=(0, 0, -1), name="hinge",
                angle=Harmonic(amplitude=0.3, frequency=1))
    return scene


SCENES = {
    **{f"loads on {e}": lambda e=e: loads(e) for e in ("cable12", "cable18", "cable8p", "beam12p", "beam24")},
    "loads on beam24 continuum": lambda: loads("beam24", law="continuum"),
    **{f"tangent of {e}": lambda e=e: tied(e, "tangent") for e in ("cable12", "cable8p", "beam12p")},
    "tangent of beam24": lambda: tied("beam24", "tangent", roll="held"),
    "tangent and up": lambda: tied("cable12", "tangent", roll="held", up=(0, 1, 0.2)),
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
    """What the engine recorded, beside what a run keeps of it."""
    kept, named = {}, recording.named

    def spy(model, scene, engine):
        kept.update(engine.rows())
        return named(model, scene, engine)

    monkeypatch.setattr(recording, "named", spy)
    return kept


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("name", SCENES)
def test_accelerations_are_the_engines(name, engine_rows):
    """They follow from recorded forces: any that is missing, or on the wrong place or side, shows here."""
    run = SCENES[name]().run(duration=0.2, output_step=0.1, tol=1e-4)
    model, at = run.model, _instants(run, np.arange(len(run.time)))
    loads = CableLoads(run.scene, model, at)
    for k, cable in enumerate(model.cables):
        found = element_forces(run.scene, model, at, loads, k, at_rest=False)
        a = found.inertia + np.where((np.array(cable.vectors * 2) == "r")[:, None], run.scene.gravity[: model.dim], 0)
        a = a - cable.mass_damping * _of_elements(cable, at.v)
        expected = _of_elements(cable, engine_rows["acceleration"])
        assert_allclose(a, expected, atol=1e-9 * np.abs(engine_rows["acceleration"][:, : len(model.place)]).max())


def gaps_at_nodes(scene, model, at, at_rest):
    """Jumps of force and moment over inner nodes that nothing acts on, relative to the largest."""
    loads = CableLoads(scene, model, at)
    for k, (name, cable) in enumerate(scene.cables.items()):
        s = np.setdiff1d(np.round(cable.node_s, 9)[1:-1], np.round(jumps(scene, name), 9))[None]
        elements = element_forces(scene, model, at, loads, k, at_rest)
        places = (s, False), (s, True), (np.linspace(0, cable.length, 50)[None], True)
        before, after, every = (
            balanced(cable, model.cables[k], elements, loads, k, Cuts(model.cables[k], where, side))[:2]
            for where, side in places)
        yield from (np.abs(b - a).max(initial=0) / np.abs(e).max()
                    for b, a, e in zip(before, after, every, strict=True))


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("name", [name for name in SCENES if name != "motion"])
def test_nothing_is_left_over_at_nodes(name):
    """What an element passes on over its length, by integrals, is what its other node takes."""
    scene = SCENES[name]()
    run = scene.run(duration=0.1, output_step=0.1, tol=1e-4)
    for gap in gaps_at_nodes(run.scene, run.model, _instants(run, np.arange(2)), at_rest=False):
        assert gap < (1e-4 if name == "loads on cable18" else 1e-9)  # a turning load of the fifth degree, by 4 points


RESTS = ["loads on cable12", "loads on beam24", "section of beam24", "cable tied to cable"]


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("name", RESTS)
def test_at_rest(name):
    """A state of rest: riders are driven or their slides would go on to the lowest point."""
    scene = SCENES[name]()
    rest = scene.equilibrium()
    for slide in scene.slides.values():
        before, after = (rest.section_forces(slide.along, slide, side=side)["force"] for side in ("before", "after"))
        assert_allclose(before - after, -rest[f"{slide.name}.force"], atol=1e-6)
        s = rest.section_forces(slide.along)["s"].values
        assert np.sum(np.abs(s - rest[f"{slide.name}.s"]) < 1e-7) >= 2
    for gap in gaps_at_nodes(scene, rest.model, rest_instants(rest), at_rest=True):
        assert gap < 1e-6


def _of_elements(cable, values):
    nodal = values[:, cable.coordinates].reshape(len(values), *cable.shape)
    return np.concatenate([nodal[:, :-1], nodal[:, 1:]], axis=2)


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("name", SCENES)
def test_forces_between_cuts(name):
    """Jumps are the forces that results report; ends without anything are free; supports give what they report."""
    run = SCENES[name]().run(duration=0.2, output_step=0.1, tol=1e-4)
    scale = max(np.abs(run.section_forces(cable)["force"]).max().item() for cable in run.scene.cables)
    for slide in run.scene.slides.values():
        before, after = (run.section_forces(slide.along, slide, side=side)["force"].values
                         for side in ("before", "after"))
        assert_allclose(before - after, -run[f"{slide.name}.force"], atol=1e-9 * scale)
    for name, cable in run.scene.cables.items():
        held = {(support.cable, support.s): run[f"{support.label}.force"] for support in run.scene.supports}
        tied = {(on, s) for join in run.scene.ties.values() for on, s in ((join.cable, join.s), (join.to, join.at))}
        riding = {(slide.rider.on, slide.rider.s) for slide in run.scene.slides.values()}
        riding |= {(end.on, end.s) for joint in run.scene.joints.values() for end in (joint.a, joint.b)}
        for s, sign in ((0.0, -1), (cable.length, 1)):
            if (name, s) in tied | riding:
                continue
            given = held.get((name, s), np.zeros((len(run.time), 3)))
            at_end = run.section_forces(name, [s])
            assert_allclose(at_end["force"].values[:, 0], sign * given, atol=1e-9 * scale)
            if (name, s) not in held:
                assert_allclose(at_end["moment"].values, 0, atol=1e-7 * scale)
        for (on, s), given in held.items():
            if on == name and 0 < s < cable.length:
                before, after = (run.section_forces(name, [s], side=side)["force"].values[:, 0]
                                 for side in ("before", "after"))
                assert_allclose(before - after, given, atol=1e-9 * scale)


def test_riders_force_is_that_of_its_motion():
    """A moment on a frame that turns along the cable is a force along it, too."""
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
    """84 kg on 120 m of rope: 19 kN, a kink of 4 degrees, which a cubic draws as an arc of an element's length."""

    @pytest.fixture(scope="class", params=[24, 48, 96])
    @staticmethod
    def run(request):
        scene = load_scene("zip_line")
        scene.cables["rope"] = scene.cables["rope"].model_copy(update={"elements": request.param})
        return scene.run(duration=10.05)

    def test_tension_beside_the_rider_is_that_of_the_pieces(self, run):
        """At 10 s; each piece from its support on: weight, and inertia by differences of velocities in time."""
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
    """The scene is made again from its text: what its placement had to say was said when it was drawn."""
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
    monkeypatch.setattr("funicular.results.section_forces.AT_ONCE", 200)
    for before, after in zip(whole, (run.section_forces("rope"), run.section_forces("rope", "trolley")), strict=True):
        assert_allclose(after["tension"], before["tension"], rtol=1e-9)


def kinked_rope(elements):
    """1000 N on a slack rope without weight, at rest."""
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("rope", points=[(0, 0, 0), (5, -3.3, 0), (10, 0, 0)], rest="straight", rest_length=12,
                elements=elements, element="cable8p", section=GeneralSection(area=1e-4, second_moment_about_z=1e-9),
                material=Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000))
    scene.pin("rope", s=0)
    scene.pin("rope", s=12)
    scene.force("rope", s=6.21, value=(0, -1000, 0))
    return scene.equilibrium()


@pytest.mark.parametrize("elements", [12, 24, 25])
def test_a_sharp_kink(elements):
    """The tension in each half is the side of the triangle of forces."""
    rest = kinked_rope(elements)
    for side, support in (("before", "rope@0"), ("after", "rope@12")):
        pull = np.linalg.norm(rest[f"{support}.force"])
        tension = rest.section_forces("rope", [5.2, 6.21, 7.2], side=side)["tension"].values
        assert tension[1] == pytest.approx(pull, rel=1e-4)
        assert tension[0 if side == "before" else 2] == pytest.approx(pull, rel=1e-5)
        law = rest.section_forces("rope", [6.21], method="constitutive", side=side)
        assert abs(law["tension"].values[0] - pull) > 0.07 * pull


class TestTautBending:
    """Where elements of a taut cable are far longer than it bends, against so many that the mesh shows it."""

    S = np.array([0, 0.02, 0.05, 2.0, 4.0, 4.19, 4.21, 7.03, 7.05, 7.07, 9.5])
    CONVERGED = np.array([-3.751, -1.785, -0.586, 0.0146, 0.0153, 0.666, 1.381, 0.729, -1.485, -0.700, 0])
    """Moments in N m, sides of larger s, of 990 elements cable8p by both methods, which are 1 % apart there."""

    @staticmethod
    def moments(elements, element, method="balance"):
        """A clamp, a force, a moment, a load along some of it; E I 1 N m^2, 1.32 kN: bends over 27 mm."""
        scene = Scene(gravity=(0, 0, 0))
        scene.cable("rope", start=(0, 0, 0), end=(10, 0, 0), rest_length=9.9, elements=elements, element=element,
                    section=GeneralSection(area=1e-4, second_moment_about_z=1e-9),
                    material=Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000))
        scene.clamp("rope", s=0)
        scene.pin("rope", s=9.9)
        scene.force("rope", s=4.21, value=(0, -100, 0))
        scene.moment("rope", s=7.05, value=(0, 0, 3))
        scene.distributed_force("rope", value=(0, -20, 0), start=1, stop=9)
        return scene.equilibrium().section_forces("rope", TestTautBending.S, method=method)["moment"].values[:, 2]

    @pytest.mark.parametrize(("elements", "element"),
                             [(9, "cable8p"), (24, "cable8p"), (18, "cable12"), (9, "cable18")])
    def test_moments_of_a_coarse_mesh(self, elements, element):
        assert_allclose(self.moments(elements, element), self.CONVERGED, atol=0.08)
        assert np.abs(self.moments(elements, element, "constitutive") - self.CONVERGED).max() > 1.5

    def test_moments_of_a_fine_mesh(self):
        assert_allclose(self.moments(990, "cable8p"), self.CONVERGED, atol=0.005)
        assert_allclose(self.moments(990, "cable8p", "constitutive"), self.CONVERGED, atol=0.05)

    @pytest.mark.parametrize("elements", [24, 48])
    def test_moment_of_a_kink(self, elements):
        """2 sqrt(N E I) sin(theta/4) under a force that turns the rope's by theta, 69 degrees: 17.6 N m."""
        rest = kinked_rope(elements)
        before, after = (rest.section_forces("rope", [6.21], side=side) for side in ("before", "after"))
        one, other = before["force"].values[0], after["force"].values[0]
        theta = np.arccos(one @ other / np.linalg.norm(one) / np.linalg.norm(other))
        exact = 2 * np.sqrt(np.sqrt(np.linalg.norm(one) * np.linalg.norm(other))) * np.sin(theta / 4)
        assert 17 < exact < 18
        for side in (before, after):
            assert side["moment"].values[0, 2] == pytest.approx(exact, rel=0.05)


BEAMS = [("cable12", None), ("cable18", None), ("cable8p", None), ("beam24", "structural"), ("beam24", "continuum"),
         ("beam12p", "structural"), ("beam12p", "continuum")]


def beam(element, law, elements, **given):
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("beam", start=(0, 0, 0), end=(LENGTH, 0, 0), elements=elements, element=element, law=law,
                section=Rectangle(height=DEPTH, width=DEPTH),
                material=Material(youngs_modulus=1e9, poisson_ratio=0, density=1000, **given))
    return scene


@pytest.mark.parametrize("elements", [3, 8])
@pytest.mark.parametrize(("element", "law"), BEAMS)
def test_a_cantilever_with_a_load_inside_an_element(element, law, elements):
    scene, at = beam(element, law, elements), 1.3
    scene.clamp("beam", s=0)
    scene.force("beam", s=at, value=(0, -LOAD, 0))
    s = np.array([0, 0.3, 0.7, at, 1.7, LENGTH])
    rest = scene.equilibrium()
    forces = rest.section_forces("beam", s, side="before")
    assert_allclose(forces["force"][:, 1], np.where(s <= at, -LOAD, 0), atol=1e-9 * LOAD)
    assert_allclose(forces["moment"][:, 2], np.where(s <= at, -LOAD * (at - s), 0), atol=1e-5 * LOAD * at)
    assert_allclose(forces["shear"], np.where(s <= at, LOAD, 0), atol=1e-4 * LOAD)
    assert_allclose(forces["moment"][0], -rest["beam@0.moment"], atol=1e-6 * LOAD)


@pytest.mark.parametrize(("element", "law"), BEAMS)
def test_a_beam_on_two_supports(element, law):
    """The far one a long spring: it gives along the beam. Both sides of the load are among the places."""
    scene, at = beam(element, law, 3), 1.3
    scene.pin("beam", s=0)
    scene.spring(("beam", LENGTH), (LENGTH, 100, 0), stiffness=1e9, length=100)
    if scene.cables["beam"].dim == 3:
        scene.spring(("beam", LENGTH), (LENGTH, 0, 100), stiffness=1e9, length=100)
    scene.force("beam", s=at, value=(0, -LOAD, 0))
    forces = scene.equilibrium().section_forces("beam")
    s = forces["s"].values
    assert np.sum(np.abs(s - at) < 1e-7) == 2
    part = (LENGTH - at) / LENGTH
    assert_allclose(forces["force"][:, 1], -LOAD * np.where(s < at, part, part - 1), atol=1e-6 * LOAD)
    assert_allclose(forces["moment"][:, 2], LOAD * np.where(s < at, part * s, (1 - part) * (LENGTH - s)),
                    atol=1e-5 * LOAD)


def test_a_beam_that_spins():
    """N = rho A W^2 (L^2 - s^2)/2 while it is stretched by little, once damping has stopped its ringing."""
    speed, L = 10.0, LENGTH
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("beam", start=(0, 0, 0), end=(L, 0, 0), elements=4, element="beam24", law="structural",
                section=Rectangle(height=DEPTH, width=DEPTH), angular_velocity=(0, 0, speed),
                material=Material(youngs_modulus=1e9, poisson_ratio=0, density=1000, damping_time=5e-4))
    scene.pin("beam", s=0)
    run = scene.run(duration=0.2, output_step=0.05, tol=1e-6)
    s = np.array([0, 0.4, 1.1, 1.9, L])
    tension = run.section_forces("beam", s)["tension"].values[-1]
    assert_allclose(tension, 1000 * DEPTH**2 * speed**2 * (L**2 - s**2) / 2, atol=2e-3 * 2000)


def test_a_force_that_crosses_a_beam():
    """Case M1 at half the critical speed: moments at three sections and under the force, against Fourier's series."""
    F, EI, line = 1.0, 1e9 * DEPTH**4 / 12, 1000 * DEPTH**2
    v = 0.5 * np.pi / LENGTH * np.sqrt(EI / line)
    scene = beam("cable8p", None, 8)
    scene.pin("beam", s=0)
    scene.pin("beam", s=LENGTH)
    scene.rigid_body("A", mass=1e-4, inertia=(1, 1, 1), position=(0, 0, 0), velocity=(v, 0, 0))
    scene.force("A", value=(0, -F, 0))
    scene.slide("A", along="beam", s=0.0, velocity=v, name="slide")
    run = scene.run(duration=0.95 * LENGTH / v, output_step=0.05 * LENGTH / v, integrator="radau")
    t, s = run.time[1:], np.array([0.25, 0.5, 0.75]) * LENGTH
    n = np.pi / LENGTH * np.arange(1, 1001)[:, None, None]
    x = np.concatenate([np.broadcast_to(s, (len(t), 3)), v * t[:, None]], axis=1)
    w, W = n**2 * np.sqrt(EI / line), n * v
    wave = 2 * F / (line * LENGTH) / (w**2 - W**2) * (np.sin(W * t[:, None]) - W / w * np.sin(w * t[:, None]))
    exact = (EI * n**2 * wave * np.sin(n * x)).sum(axis=0)

    def error(method):
        there, under = (run.section_forces("beam", place, method=method)["moment"].values[1:, ..., 2]
                        for place in (s, "slide"))
        return np.abs(np.column_stack([there, under]) - exact).max() / (F * LENGTH / 4)

    assert error("balance") < 0.012
    assert error("constitutive") > 0.05


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


@pytest.mark.parametrize("fraction", [0.25, 0.5, 1.0])
def test_states_on_the_way_carry_a_part_of_the_load(fraction):
    scene = beam("beam12p", "structural", 4)
    scene.gravity = (0, -9.81, 0)
    scene.clamp("beam", s=0)
    scene.force("beam", s=LENGTH, value=(0, -100, 0))
    (state,) = [state for state in scene.equilibrium(load_steps=4).path if state.load_fraction == fraction]
    s = np.array([0, 1, LENGTH])
    below = 100 + 9.81 * 1000 * DEPTH**2 * (LENGTH - s)
    assert_allclose(state.section_forces("beam", s)["force"][:, 1], -fraction * below, rtol=1e-6)


def test_a_bent_wire_drawn_straight():
    """A taut cable that is stress-free as an arc has the moment of unbending, by its law alone."""
    scene = Scene(gravity=(0, 0, 0))
    u = np.linspace(0, 1, 41)
    scene.cable("wire", points=[(10 * np.sin(a), 10 - 10 * np.cos(a), 0) for a in u], elements=12, element="cable12",
                section=Circle(radius=0.01), material=Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000))
    scene.pin("wire", s=0)
    scene.force("wire", s=scene.cables["wire"].length, value=(4000, 0, 0))
    rest = scene.equilibrium()
    EI = 1e9 * np.pi * 0.01**4 / 4
    moment = rest.section_forces("wire", [4.0, 5.0, 6.0])["moment"].values
    by_law = rest.section_forces("wire", [4.0, 5.0, 6.0], method="constitutive")["moment"].values
    assert np.linalg.norm(moment, axis=1).min() > 0.6 * EI / 10
    assert_allclose(moment, by_law, atol=0.02 * EI / 10)
