"""Equilibrium: closed forms, limit points, non-existence, and runs from equilibrium."""

import numpy as np
import pytest
from funicular import Circle, GeneralSection, Material, Scene
from funicular.errors import EquilibriumError, FunicularWarning, SceneError, UnknownResultError
from scipy.optimize import brentq
from shared_scenes import add_cable, add_rider, cable_scene

RISE, STIFFNESS = 0.2, 1e6


def truss(load: float) -> Scene:
    """Return two hinged bars, 1 m to each side and RISE high, too stout to buckle; engineering strain."""
    scene = Scene(gravity=(0, 0, 0))
    bar = {"elements": 1, "element": "cable8p", "strain": "engineering",
           "section": GeneralSection(area=1e-2, second_moment_about_z=1e-4, second_moment_about_y=1e-4),
           "material": Material(youngs_modulus=STIFFNESS / 1e-2, poisson_ratio=0, density=1000)}
    left = scene.cable("left", start=(-1, 0, 0), end=(0, RISE, 0), **bar)
    right = scene.cable("right", start=(0, RISE, 0), end=(1, 0, 0), **bar)
    length = np.hypot(1, RISE)
    scene.pin(left, s=0)
    scene.pin(right, s=length)
    scene.tie(left, s=length, to=right, at=0, rotation="free")
    scene.force(left, s=length, value=(0, -load, 0))
    return scene


def load_at(height):
    """Return the load that holds the apex of the truss at a height (m)."""
    long, now = np.hypot(1, RISE), np.hypot(1, height)
    return 2 * STIFFNESS * (long - now) / long * height / now


def apex(state) -> float:
    return state["left.position"][-1, 1]


def test_arc_length_passes_both_limit_points():
    """Every state on the path is on the closed curve, also where the load decreases and changes its sign."""
    state = truss(4000.0).equilibrium(method="arc_length", load_steps=10)
    heights = np.array([apex(s) for s in state.path])
    fractions = np.array([s.load_fraction for s in state.path])
    np.testing.assert_allclose(4000 * fractions, load_at(heights), atol=1e-5)
    limit = load_at(np.linspace(0, RISE, 1001)).max() / 4000
    rising = np.sign(np.diff(fractions))
    assert np.count_nonzero(np.diff(rising)) == 2
    assert fractions[: np.argmin(rising) + 1].max() == pytest.approx(limit, rel=1e-3)
    assert fractions.min() == pytest.approx(-limit, rel=1e-2)
    assert state.load_fraction == fractions[-1] == 1
    assert load_at(apex(state)) == pytest.approx(4000, rel=1e-9)
    assert apex(state) < -RISE


def test_load_steps_snap_through_where_the_path_turns():
    state = truss(4000.0).equilibrium(load_steps=10)
    heights = np.array([apex(s) for s in state.path])
    np.testing.assert_allclose([s.load_fraction for s in state.path], np.linspace(0.1, 1, 10))
    np.testing.assert_allclose(load_at(heights), np.linspace(400, 4000, 10), rtol=1e-9)
    assert np.all(heights[:7] > 0.1)
    assert np.all(heights[7:] < -RISE)


def test_a_run_from_equilibrium_stays():
    """Pretension, a spring, a load, a rider at the lowest point: all accelerations are zero."""
    scene = Scene()
    add_cable(scene, pins=(0, 1.49), rest_length=1.49, elements=6)
    add_rider(scene, s=0.6, speed=0.0)
    scene.spring(a=("wire", 0.745), b=(0.5, 0.5, 0.1), stiffness=200.0, length=0.2)
    scene.force("wire", s=1.2, value=(0, 0, 3))
    state = scene.equilibrium()
    assert abs(state["trolley.force"] @ [1, 0, 0]) < 1e-6, "a frictionless rider rests where the cable is level"
    run = scene.run(0.2, step=1e-3, initial=state)
    assert np.ptp(run["A.position"], axis=0).max() < 1e-9
    assert np.ptp(run["wire.nodal_vectors"], axis=0).max() < 1e-9
    np.testing.assert_allclose(run["A.acceleration"], 0, atol=1e-5)
    np.testing.assert_allclose(run["trolley.force"][0], state["trolley.force"], atol=1e-5)


def test_a_state_is_read_as_a_mapping():
    """`for name in state` iterates over names."""
    scene = Scene()
    add_cable(scene, elements=2)
    state = scene.equilibrium()
    assert list(state) == state.keys()
    assert len(state) == len(state.keys())
    assert {"wire.nodal_vectors", "wire.position", "wire@0.force"} <= set(state)
    assert {name: values.shape for name, values in state.items()} == {name: state[name].shape for name in state.keys()}
    assert "wire.position" in state and "wire.positon" not in state and 0 not in state
    assert state._ipython_key_completions_() == state.keys()


def test_supports_carry_the_weight():
    scene = Scene()
    cable = add_cable(scene, elements=4)
    add_rider(scene, s=0.6, speed=0.0)
    state = scene.equilibrium()
    weight = 9.81 * (cable.section.area * 4200 * 1.5 + 1.0)
    total = state["wire@0.force"] + state["wire@1.5.force"]
    np.testing.assert_allclose(total, [0, weight, 0], atol=1e-7 * weight)


def test_a_slack_cable_hangs():
    """A cable 20 % longer than its span, as flexible as a chain: a catenary, its sag by the closed form."""
    scene = Scene()
    u = np.linspace(0, 1, 41)[:, None]
    drawn = np.hstack([u, -1.2 * u * (1 - u), 0 * u])
    cable = scene.cable("chain", points=drawn, elements=40, element="cable12", rest="straight", rest_length=1.2,
                        section=GeneralSection(area=1e-4, second_moment_about_z=1e-15, second_moment_about_y=1e-15),
                        material=Material(youngs_modulus=1e11, poisson_ratio=0, density=1e4))
    scene.pin(cable, s=0)
    scene.pin(cable, s=1.2)
    state = scene.equilibrium()
    a = brentq(lambda a: 2 * a * np.sinh(0.5 / a) - 1.2, 0.1, 10)
    sag = a * (np.cosh(0.5 / a) - 1)
    assert -state["chain.position"][:, 1].min() == pytest.approx(sag, rel=1e-4)


def test_none_exists():
    """A falling body."""
    scene = Scene()
    add_cable(scene, elements=1)
    scene.rigid_body("stone", mass=1.0, inertia=(1e-3, 1e-3, 1e-3), position=(0, 1, 0))
    with pytest.raises(EquilibriumError, match="no equilibrium was reached: the path from the drawn state ends at "
                                               r"[0-9.]+ % of the load") as refused:
        scene.equilibrium()
    assert 0 <= refused.value.load_fraction < 1
    assert refused.value.state["stone.position"] == pytest.approx([0, 1, 0], abs=10)
    assert refused.value.state.load_fraction == refused.value.load_fraction


def test_a_rider_on_a_slope_has_none():
    """The rider would slide off the end; the error keeps the last state."""
    scene = Scene()
    wire = add_cable(scene, end=(1.5, -0.5, 0), pins=())
    for s in (0.0, wire.length):
        scene.pin(wire, s=s)
    add_rider(scene, s=0.5, speed=0.0)
    with pytest.raises(EquilibriumError) as refused:
        scene.equilibrium(load_steps=500)  # which are halved once, where one step is halved ten times
    assert refused.value.load_fraction < 1
    assert 0 <= refused.value.state["trolley.s"] <= wire.length
    assert "load_steps or max_iterations" in str(refused.value)


def test_tolerance_is_met():
    scene = Scene()
    add_cable(scene)
    loose, tight = (scene.equilibrium(tolerance=t) for t in (1e-3, 1e-12))
    assert tight.iterations > loose.iterations
    assert tight.residual < 1e-6


def test_section_forces_at_rest():
    """A weight at the end of a rope: its tension everywhere, plus the weight of the rope below."""
    scene = Scene()
    rope = scene.cable("rope", start=(0, 0, 0), end=(0, -2, 0), up=(1, 0, 0), elements=4, element="cable12",
                       section=GeneralSection(area=1e-4, second_moment_about_z=1e-9, second_moment_about_y=1e-9),
                       material=Material(youngs_modulus=1e9, poisson_ratio=0, density=1e4))
    scene.pin(rope, s=0)
    scene.force(rope, s=2.0, value=(0, -50, 0))
    forces = scene.equilibrium().section_forces("rope", s=[0.25, 1.25])
    assert forces["tension"].dims == ("s",)
    assert forces["force"].dims == ("s", "xyz")
    np.testing.assert_allclose(forces["tension"], 50 + 9.81 * (2 - forces["s"]), rtol=1e-4)


def spring_mid_span(element: str, **given) -> Scene:
    scene = cable_scene("w", clamps=(0, 1), elements=4, element=element, section=Circle(radius=0.01),
                        material=Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1000), **given)
    scene.spring(("w", 0.5), (0.5, -1, 0), stiffness=100, length=0.9, name="tie")
    return scene


@pytest.mark.parametrize("method", ["newton", "arc_length"])
@pytest.mark.parametrize(("element", "given"), [("beam24", {"law": "structural"}), ("cable12", {}), ("cable8p", {})])
def test_springs_pull_by_their_law(element, given, method):
    state = spring_mid_span(element, **given).equilibrium(method=method)
    assert state["tie.tension"] == pytest.approx(100 * (state["tie.length"] - 0.9), rel=1e-9)
    assert state.residual < 1e-8


@pytest.mark.parametrize("at", [(0, 0, 0), (0.1, 0, 0)])
def test_a_body_hangs_on_its_spring(at):
    """The body hangs below the attachment by the stretched length, with the attached point above its centre."""
    scene = Scene()
    scene.rigid_body("B", mass=1, inertia=(1e-3, 1e-3, 1e-3), position=(0, -1, 0))
    scene.spring(("B", at), (0, 0, 0), stiffness=100, length=1.0, name="tie")
    state = scene.equilibrium()
    np.testing.assert_allclose(state["B.position"], [0, -1 - 9.81 / 100 - np.linalg.norm(at), 0], atol=1e-9)
    assert state["tie.tension"] == pytest.approx(9.81)


def test_a_trolley_rolls_to_the_lowest_point():
    scene = Scene()
    add_cable(scene, elements=4)
    add_rider(scene, s=0.6, speed=0.0)
    assert scene.equilibrium()["trolley.s"] == pytest.approx(0.75, abs=1e-9)


def test_a_state_of_another_scene_is_refused():
    state = spring_mid_span("cable12").equilibrium()
    other = Scene()
    add_cable(other)
    for use in (lambda: other.run(0.1, initial=state), lambda: other.modes(1, about=state)):
        with pytest.raises(SceneError, match="the state to start from belongs to another scene: its cables are"):
            use()
    with pytest.raises(UnknownResultError, match=r'no result "tie\.tensoin"; did you mean "tie\.tension"'):
        state["tie.tensoin"]
    assert "tie.tension" in state.keys()


def test_a_stability_that_cannot_be_counted_is_no_stability(monkeypatch):
    def no_count(*_):
        raise ArithmeticError

    monkeypatch.setattr("funicular.solve.statics.stability.inertia", no_count)
    with pytest.warns(FunicularWarning, match="^the state is of unknown stability: no factorisation of its stiffness"):
        rest = truss(1.0).equilibrium()
    assert not rest.stable and rest.unstable_directions == 0


def hanging(element: str, elements: int, rider: bool = True) -> Scene:
    """Return a rope drawn as an arc, 10 % longer than its span, with a trolley under a horizontal force."""
    u = np.linspace(0, 1, 41)[:, None]
    scene = Scene()
    rope = scene.cable("rope", points=np.hstack([4 * u, -2.0 * u * (1 - u), 0 * u]), elements=elements,
                       element=element, rest="straight", section=Circle(radius=5e-3),
                       material=Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1100))
    scene.pin(rope, s=0)
    scene.pin(rope, s=rope.length)
    if not rider:
        return scene
    scene.rigid_body("A", mass=2.0, inertia=(1, 1, 1), position=(2.0, -0.5, 0))
    scene.slide("A", along="rope", s=rope.length / 2, name="trolley")
    scene.force("A", value=(2.0, 0, 0))
    return scene


@pytest.mark.parametrize(("element", "elements"), [("cable8p", 16), ("cable12", 14), ("cable18", 12), ("beam12p", 10)])
def test_a_search_begins_at_the_state_of_another_mesh(element, elements):
    coarse, scene = hanging(element, 6).equilibrium(), hanging(element, elements)
    begun, drawn = scene.equilibrium(start=coarse), scene.equilibrium()
    for name in ("rope.position", "A.position", "trolley.s", "trolley.force", "rope@0.force"):
        np.testing.assert_allclose(begun[name], drawn[name], rtol=1e-7, atol=1e-8)
    alone = hanging(element, 2 * elements, rider=False)
    begun = alone.equilibrium(start=hanging(element, elements, rider=False).equilibrium())
    assert begun.iterations < alone.equilibrium().iterations


def test_a_state_of_another_mesh_starts_no_run_and_no_load_path():
    state, finer = hanging("cable8p", 6).equilibrium(), hanging("cable8p", 12)
    for use in (lambda: finer.run(0.1, initial=state), lambda: finer.equilibrium(start=state, method="arc_length"),
                lambda: hanging("cable12", 6).equilibrium(start=state)):
        with pytest.raises(SceneError, match="the state to start from belongs to another scene: its cables are"):
            use()
