"""Parameters for given values of an equilibrium: closed forms, derivatives, limits, impossible targets."""

import re

import catenary
import funicular as fu
import numpy as np
import pytest
from funicular.solve.statics import static_problem
from shared_scenes import changed

STEEL = fu.Material(youngs_modulus=1e11, poisson_ratio=0.3, density=9000)
THIN = fu.Circle(radius=0.005)
WEIGHT, AXIAL = 9000 * THIN.area * 9.81, 1e11 * THIN.area


def wire(elements=40, length=50.3, **settings):
    scene = fu.Scene()
    scene.cable("wire", start=(0, 0, 0), end=(50, 0, 0), elements=elements, element="cable12", strain="engineering",
                section=THIN, material=STEEL, rest_length=length)
    for s in (0, length):
        scene.pin("wire", s=s)
    scene.equilibrium_settings = settings
    return scene


def hung():
    """Return a body that hangs on a spring."""
    scene = fu.Scene()
    scene.rigid_body("A", mass=2.0, inertia=(1, 1, 1), position=(0, -1, 0))
    scene.spring((0, 0, 0), "A", name="spring", stiffness=100.0, length=0.5)
    return scene


def unreached(scene, cause, **given):
    with pytest.raises((fu.EquilibriumError, fu.SceneError), match=re.escape(cause)) as error:
        scene.equilibrium(**given)
    return error.value


def test_a_body_on_a_spring_in_closed_form():
    rest = hung().equilibrium(adjust=["spring.length"], to={"A.position.y": -1.5})
    assert rest.adjusted == {"spring.length": pytest.approx(1.5 - 2 * 9.81 / 100, abs=1e-9)}
    assert rest.adjustment.jacobian == pytest.approx(np.array([[-1.0]]), rel=1e-9)
    assert rest.scene.point_forces["spring"].length == rest.adjusted["spring.length"]
    stiff = hung().equilibrium(adjust={"spring.stiffness": "free"}, to={"A.position.y": -0.6})
    assert stiff.adjusted["spring.stiffness"] == pytest.approx(2 * 9.81 / 0.1, rel=1e-9)
    heavy = hung().equilibrium(adjust=["A.mass"], to={"spring.tension": 30.0})
    assert heavy.adjusted["A.mass"] == pytest.approx(30 / 9.81, rel=1e-9)


@pytest.mark.filterwarnings("ignore:The iteration is not making good progress")  # of the closed form's solution
def test_tension_by_rest_length_is_that_of_the_elastic_catenary(validated):
    scene = wire(length=49.9)
    rest = scene.equilibrium(adjust=["wire.rest_length"], to={"wire@0.force.x": -20e3})
    length = rest.adjusted["wire.rest_length"]
    horizontal, _ = catenary.end_forces(50, 0, length, WEIGHT, AXIAL)
    assert rest["wire@0.force"][0] == pytest.approx(-20e3, rel=1e-9)
    validated("Statics", "wire whose length is adjusted to its tension", "horizontal tension", horizontal, 20e3,
              unit="N", bound=2e-5, source="elastic catenary", note="the wire resists bending: 49 N m²")
    assert rest.adjustment.iterations <= 5
    assert rest.residual < 1e-6
    assert rest.scene.pins[1].s == pytest.approx(length)  # places on the wire went with it


def test_sag_by_rest_length():
    rest = wire().equilibrium(adjust={"wire.rest_length": (50.0, 52.0)}, to={"wire@25.15.position.y": -3.0})
    H, V = catenary.end_forces(50, 0, rest.adjusted["wire.rest_length"], WEIGHT, AXIAL)
    sag = H / WEIGHT * (np.hypot(1, V / H) - 1) + V**2 / (2 * WEIGHT * AXIAL)
    assert sag == pytest.approx(3.0, abs=3e-4)
    assert rest["wire.position"][20, 1] == pytest.approx(-3.0, abs=1e-7)
    assert np.all(np.diff(rest.adjustment.misfits) < 0)


def test_a_hanging_cable_may_become_shorter_than_its_span():
    scene = wire()
    scene = scene.replace("wire", shape="hanging", rest="straight")
    rest = scene.equilibrium(adjust=["wire.rest_length"], to={"wire@0.force.x": -20e3})
    assert rest.adjusted["wire.rest_length"] < 50
    horizontal, _ = catenary.end_forces(50, 0, rest.adjusted["wire.rest_length"], WEIGHT, AXIAL)
    assert horizontal == pytest.approx(20e3, rel=2e-5)
    assert rest.scene.equilibrium()["wire@0.force"][0] == pytest.approx(-20e3, rel=1e-8)


def test_section_forces_and_points_between_nodes_are_targets():
    rest = wire().equilibrium(adjust=["wire.rest_length", "wire.section.radius"],
                              to={"wire@12.3.tension": 2000.0, "wire@31.7.position.y": -2.0})
    s = 12.3 / 50.3 * rest.adjusted["wire.rest_length"]
    assert rest.section_forces("wire", s=[s])["tension"].item() == pytest.approx(2000.0, rel=1e-7)


def test_the_adjusted_scene_rests_there_by_itself_and_runs_from_there():
    rest = wire().equilibrium(adjust=["wire.rest_length"], to={"wire@25.15.position.y": -3.0})
    plain = rest.scene.equilibrium()
    assert plain["wire.position"] == pytest.approx(rest["wire.position"], abs=1e-8)
    assert not plain.adjusted
    run = rest.scene.run(duration=0.05, initial=rest, tol=1e-6)
    assert np.ptp(run["wire.position"], axis=0).max() < 1e-6


def test_the_scene_that_was_not_adjusted_takes_no_start_from_there():
    scene = hung()
    rest = scene.equilibrium(adjust=["spring.length"], to={"A.position.y": -1.5})
    with pytest.raises(fu.SceneError, match=r"take the state's own scene: rest\.scene"):
        scene.run(duration=0.1, initial=rest)
    assert scene.equilibrium(start=rest)["A.position"][1] == pytest.approx(-0.5 - 2 * 9.81 / 100)


def test_the_jacobian_is_that_of_differences_of_equilibria():
    scene = wire()
    scene.force("wire", s=25.15, value=(0, -200.0, 30.0), name="load")
    names = ["wire.rest_length", "load.value.y", "wire.material.density"]
    to = {"wire@25.15.position.y": -3.5, "wire@10.06.tension": 2500.0}
    rest = scene.equilibrium(adjust=names, to=to)
    for k, name in enumerate(names[1:], 1):  # at the state found; of other lengths the supports would have to move
        ends = []
        for sign in (-1, 1):
            value = rest.adjusted[name] * (1 + sign * 1e-4)
            other = changed(rest.scene, {name: value}).equilibrium(tolerance=1e-12)
            ratio = rest.adjusted["wire.rest_length"] / 50.3
            ends.append([other["wire.position"][20, 1],
                         other.section_forces("wire", s=[10.06 * ratio])["tension"].item()])
        rate = (np.array(ends[1]) - ends[0]) / (2e-4 * rest.adjusted[name])
        assert rest.adjustment.jacobian[:, k] == pytest.approx(rate, rel=1e-5)


def test_more_parameters_than_targets_change_least():
    scene = hung()
    scene.spring((0, 0, 0), "A", name="other", stiffness=300.0, length=0.5)
    rest = scene.equilibrium(adjust=["spring.length", "other.length"], to={"A.position.y": -1.0})
    changes = [rest.adjusted[f"{name}.length"] - 0.5 for name in ("spring", "other")]
    assert changes[1] == pytest.approx(3 * changes[0], rel=1e-6)  # along the gradient, the stiffnesses


def test_positions_of_supports_and_prescribed_displacements_are_parameters():
    scene = hung()
    rest = scene.equilibrium(adjust=["spring.a.y"], to={"A.position.y": -1.5})
    assert rest.adjusted["spring.a.y"] == pytest.approx(-1.5 + 0.5 + 2 * 9.81 / 100, abs=1e-9)
    scene = fu.Scene()
    scene.cable("wire", start=(0, 0, 0), end=(50, 0, 0), elements=40, element="cable12",
                strain="engineering", section=THIN, material=STEEL)
    scene.pin("wire", s=0)
    scene.motion("wire", s=50, displacement=(0.01, 0.5, 0))
    rest = scene.equilibrium(adjust=["wire@50.displacement.x"], to={"wire@50.force.x": 10e3})
    end = rest["wire.position"][-1]
    assert end == pytest.approx([50 + rest.adjusted["wire@50.displacement.x"], 0.5, 0], abs=1e-12)
    assert catenary.end_forces(*end[:2], 50, WEIGHT, AXIAL)[0] == pytest.approx(10e3, rel=1e-4)


def test_limits_stop_parameters_and_the_others_go_on():
    scene = hung()
    scene.spring((0, 0, 0), "A", name="other", stiffness=300.0, length=0.5)
    rest = scene.equilibrium(adjust={"spring.length": "free", "other.length": (0.4, 0.6)}, to={"A.position.y": -1.0})
    assert rest.adjusted["other.length"] == pytest.approx(0.6)
    assert rest["A.position"][1] == pytest.approx(-1.0)


def test_targets_that_cannot_be_reached_say_which_and_why():
    scene = hung()
    error = unreached(scene, '"A.position.y" is -0.69', adjust={"spring.length": (0.4, 0.5001)},
                      to={"A.position.y": -1.0})
    assert '"spring.length" is at its limit 0.5001' in str(error)
    assert error.state["A.position"][1] == pytest.approx(-0.5001 - 2 * 9.81 / 100)
    error = unreached(scene, '"spring.length" would have to be zero or below', adjust=["spring.length"],
                      to={"A.position.y": -0.1})
    scene.rigid_body("B", mass=1.0, inertia=(1, 1, 1), position=(5, -1, 0))
    scene.spring((5, 0, 0), "B", name="apart", stiffness=100.0, length=0.5)
    unreached(scene, 'no parameter changes "B.position.y"', adjust=["spring.length"], to={"B.position.y": -1.0})
    unreached(scene, 'the parameters change "A.position.y" and "spring.length" only together, so that these values '
              "contradict each other", adjust=["spring.length", "spring.stiffness"],
              to={"A.position.y": -1.0, "spring.length": 1.5})


def test_a_dropper_that_begins_slack_is_made_taut_and_none_pushes():
    scene = wire(length=49.9)
    scene.spring((25, 0.2, 0), ("wire", 24.95), name="dropper", stiffness=1e5, length=2.0, tension_only=True)
    free = scene.equilibrium()
    assert free["dropper.tension"] == 0.0
    name = "wire@24.95.position.y"
    rest = scene.equilibrium(adjust=["dropper.length"], to={name: -0.1})
    assert rest["wire.position"][20, 1] == pytest.approx(-0.1, abs=1e-7)
    ends = [rest[f"{pin.label}.force"][1] for pin in rest.scene.pins]
    assert sum(ends) + rest["dropper.tension"] == pytest.approx(WEIGHT * 49.9, rel=1e-6)
    assert rest["dropper.tension"] > 1.0
    unreached(scene, "a part that is slack changes nothing", adjust=["dropper.length"],
              to={name: free["wire.position"][20, 1] - 0.1})


@pytest.mark.parametrize(("given", "cause"), [
    ({"adjust": ["spring.length"]}, "but no values to adjust them for"),
    ({"to": {"A.position.y": 1.0}}, "but no parameters to adjust"),
    ({"adjust": ["spring.lenght"], "to": {"A.position.y": 1.0}}, 'spring has no "lenght"; did you mean "length"?'),
    ({"adjust": ["spring.a"], "to": {"A.position.y": 1.0}}, "not a number that can be adjusted"),
    ({"adjust": ["equilibrium.tolerance"], "to": {"A.position.y": 1.0}}, "settings cannot be adjusted"),
    ({"adjust": ["temperature.x"], "to": {"A.position.y": 1.0}}, "temperature has no entries"),
    ({"adjust": ["gravity.y.z"], "to": {"A.position.y": 1.0}}, "gravity.y has no entries"),
    ({"adjust": ["spring.length"], "to": {"A.position": 1.0}}, "has three components; add .x, .y or .z"),
    ({"adjust": ["spring.length"], "to": {"spring.tension.x": 1.0}}, "has no components"),
    ({"adjust": ["spring.length"], "to": {"A.place.y": 1.0}}, "is no value of the state of rest"),
    ({"adjust": ["spring.length"], "to": {"A.position.y": -1.0, "spring.tension": 20.0}},
     "2 targets cannot be reached with 1 parameters"),
    ({"adjust": {"spring.length": (1.0, 2.0)}, "to": {"A.position.y": -1.0}}, "is not within its limits 1 and 2"),
    ({"adjust": {"spring.length": (2.0, 1.0)}, "to": {"A.position.y": -1.0}}, "the second is above the first"),
    ({"adjust": ["spring.length"], "to": {"A.position.y": -1.0}, "method": "arc_length"}, 'take method="newton"')])
def test_wrong_input_says_what_is_wrong(given, cause):
    unreached(hung(), cause, **given)


def test_scene_files_adjust():
    scene = wire(adjust={"wire.rest_length": (50.0, 52.0)}, to={"wire@25.15.position.y": -3.0})
    again = fu.Scene.from_toml(scene.to_toml())
    assert again.equilibrium_settings == scene.equilibrium_settings
    rest = again.equilibrium()
    assert rest["wire.position"][20, 1] == pytest.approx(-3.0, abs=1e-7)
    run = again.run(duration=0.02, initial="equilibrium", tol=1e-6)
    assert run.scene.cables["wire"].length == rest.adjusted["wire.rest_length"]
    assert np.ptp(run["wire.position"], axis=0).max() < 1e-6


@pytest.mark.parametrize("element", ["beam24", "cable12"])
def test_clamps_that_turn_and_move_with_the_drawing_have_the_right_derivatives(element):
    scene = fu.Scene()
    scene.cable("rod", start=(0, 0, 0), end=(2, 1, 0.5), elements=8, element=element, section=fu.Circle(radius=0.02),
                material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000), rest_length=2.25)
    scene.clamp("rod", s=0)
    scene.pin("rod", s=2.25)
    rest = scene.equilibrium(adjust=["rod.end.y", "rod.start.x"],
                             to={"rod@1.125.position.y": 0.5, "rod@2.25.force.x": 5e3})
    for k, name in enumerate(rest.adjusted):
        ends = []
        for change in (-1e-5, 1e-5):
            other = changed(rest.scene, {name: rest.adjusted[name] + change})
            state = other.equilibrium(tolerance=1e-13, start=rest)
            assert state["rod.position"][-1] == pytest.approx(other.cables["rod"].end, abs=1e-12)
            ends.append([state["rod.position"][4, 1], state["rod@2.25.force"][0]])
        assert rest.adjustment.jacobian[:, k] == pytest.approx((np.array(ends[1]) - ends[0]) / 2e-5, rel=1e-4)


def test_a_search_that_begins_at_a_state_takes_the_supports_as_they_are_now():
    scene = wire(length=49.9)
    rest = scene.equilibrium()
    moved = scene.replace("wire", end=(50, 1, 0))
    from_there = moved.equilibrium(start=rest)
    assert from_there["wire.position"][-1] == pytest.approx([50, 1, 0])
    assert from_there["wire.position"] == pytest.approx(moved.equilibrium()["wire.position"], abs=1e-8)


def test_runs_and_modes_take_no_state_whose_supports_are_elsewhere():
    scene = wire(length=49.9)
    rest = scene.equilibrium()
    moved = scene.replace("wire", end=(50, 1, 0))
    for start in (lambda: moved.run(duration=0.01, initial=rest), lambda: moved.modes(2, about=rest)):
        with pytest.raises(fu.SceneError, match="has a support 1 m from where it is here"):
            start()


@pytest.mark.parametrize(("given", "path"), [
    ({"stiffness": 300.0}, "stiffness"), ({"stiffness": 300.0}, "length"),
    ({"stiffness": 300.0, "free_play": 0.1}, "free_play"),
    ({"stiffness": 300.0, "free_play": 0.1, "tension_only": True}, "length"),
    ({"table": fu.ForceTable(extension=[0, 0.05, 0.2], tension=[0, 2, 30])}, "length"),
    ({"table": fu.ForceTable(extension=[0, 0.05, 0.2], tension=[0, 2, 30])}, "table.tension.2"),
    ({"stiffness": 300.0}, "a.y")])
def test_derivatives_by_what_a_spring_is_are_those_of_other_equilibria(given, path):
    scene = hung()
    scene.spring((0.2, 0.1, 0), "A", name="other", length=0.5, **given)
    first = scene.equilibrium()
    now = float(first["other.tension"])
    rest = scene.equilibrium(adjust=[f"other.{path}", "spring.length"], tolerance=1e-10,
                             to={"A.position.y": float(first["A.position"][1]), "other.tension": 1.001 * now})
    value = rest.adjusted[f"other.{path}"]
    ends = []
    for change in (-1e-5, 1e-5):
        other = changed(rest.scene, {f"other.{path}": value + change * max(1, abs(value))})
        state = other.equilibrium(tolerance=1e-13)
        ends.append([state["A.position"][1], float(state["other.tension"])])
    rate = (np.array(ends[1]) - ends[0]) / (2e-5 * max(1, abs(value)))
    assert rest.adjustment.jacobian[:, 0] == pytest.approx(rate, rel=1e-5)


def test_parameters_of_springs_take_no_scene_each(monkeypatch):
    built = []
    plain = static_problem.build
    monkeypatch.setattr(static_problem, "build", lambda scene: built.append(scene) or plain(scene))

    def scenes(n):
        built.clear()
        scene = wire(length=49.9)
        places = [50 * (k + 1) / (n + 1) for k in range(n)]
        for k, x in enumerate(places):
            scene.spring((x, 0.5, 0), ("wire", x / 50 * 49.9), name=f"d{k}", stiffness=1e4, length=0.5,
                         tension_only=True)
        rest = scene.equilibrium(adjust=[f"d{k}.length" for k in range(n)],
                                 to={f"wire@{x / 50 * 49.9:.12g}.position.y": -0.48 * x / 50 * (1 - x / 50)
                                     for x in places})
        assert rest.adjustment.misfits[-1] < 1e-9
        return len(built)

    assert scenes(9) == scenes(3) < 12


def test_values_that_springs_would_have_to_push_for_say_which():
    scene = wire(length=49.9)
    scene.spring((25, 0.2, 0), ("wire", 24.95), name="dropper", stiffness=1e5, length=1.0, tension_only=True)
    unreached(scene, '"dropper", which pulls alone, would push with 50 N', adjust=["dropper.length"],
              to={"dropper.tension": -50.0})
    for above in (0.2, 0.5):  # a dropper of no length, and of less
        unreached(scene, 'with all springs taut, "dropper.length" would have to be zero or below',
                  adjust=["dropper.length"], to={"wire@24.95.position.y": above})
    slack = scene.equilibrium(adjust=["dropper.length"], to={"dropper.tension": 0.0})
    assert slack.adjusted == {"dropper.length": 1.0}  # it has none already


def test_one_quantity_under_two_names():
    scene = wire()
    names = ["wire.rest_length", "wire.section.radius"]
    unreached(scene, 'change "wire@25.15.position.y" and "wire@25.150.position.y" only together', adjust=names,
              to={"wire@25.15.position.y": -3.0, "wire@25.150.position.y": -3.5})
    rest = scene.equilibrium(adjust=names, to={"wire@25.15.position.y": -3.0, "wire@25.150.position.y": -3.0})
    assert rest["wire.position"][20, 1] == pytest.approx(-3.0, abs=1e-7)
    unreached(hung(), 'is the same number as "spring.a.y"', adjust=["spring.a.y", "spring.a.1"],
              to={"A.position.y": -1.0})


def hinged(kind, x=0.0, spring=(1, 0, 0), **given):
    """Return a body on a joint to the ground at x, with a spring to a point of the ground."""
    scene = fu.Scene()
    scene.rigid_body("A", mass=2.0, inertia=(1, 1, 1), position=(x, -1, 0))
    scene.joint(kind, (x, 0, 0), "A" if kind == "distance" else ("A", (0, 1, 0)), name="J", **given)
    scene.spring(spring, "A", name="S", stiffness=50.0, length=0.5)
    return scene


@pytest.mark.parametrize(("kind", "given"), [
    ("spherical", {}), ("revolute", {"axis": (0, 0, 1)}), ("weld", {}), ("prismatic", {"axis": (1, 0, 0)}),
    ("distance", {}), ("distance", {"length": 1.0})])
def test_a_search_that_begins_at_a_state_takes_ground_points_as_they_are_now(kind, given):
    rest = hinged(kind, **given).equilibrium()
    for moved in (hinged(kind, spring=(1.5, 0.5, 0), **given), hinged(kind, x=0.3, **given)):
        begun, drawn = moved.equilibrium(start=rest), moved.equilibrium()
        for name in drawn.keys():
            assert begun[name] == pytest.approx(drawn[name], abs=1e-9)
        assert begun.residual < 1e-9


def test_runs_and_modes_take_no_state_whose_joints_are_elsewhere():
    rest = hinged("spherical").equilibrium()
    moved = hinged("spherical", x=0.3)
    longer = hinged("distance").replace("A", position=(0, -1.1, 0))
    begun = hinged("distance").equilibrium()
    for start in (lambda: moved.run(duration=0.01, initial=rest), lambda: moved.modes(2, about=rest)):
        with pytest.raises(fu.SceneError, match=r'an end of the joint "J" 0\.3 m from where it is here'):
            start()
    with pytest.raises(fu.SceneError, match=r"0\.1 m from where it is here"):
        longer.modes(2, about=begun)
    drawn = hinged("spherical", spring=(1.5, 0.5, 0)).run(duration=0.01, initial=rest, progress=False)
    assert drawn["A.position"][0] == pytest.approx(rest["A.position"])
