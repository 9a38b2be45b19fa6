"""Load paths: states under p times all loads, limit and bifurcation points, stability, starts."""

import warnings

import numpy as np
import pytest
from funicular import Circle, FunicularWarning, GeneralSection, Material, Rectangle, Scene
from funicular.engine import Engine
from funicular.model.build import build
from funicular.model.redundant_constraints import drop_redundant_rows
from numpy.testing import assert_allclose
from shared_scenes import cable_scene, structural

SOFT = Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1000)
THIN = Rectangle(height=0.02, width=0.02)
LENGTH, MODULUS, RADIUS = 1.0, 1e9, 0.005
STIFFNESS = MODULUS * np.pi / 4 * RADIUS**4


def left_over(scene: Scene, state) -> float:
    """Return the largest residual of a state in another model of the scene, relative to the largest force."""
    model = build(scene)
    engine = Engine(model)
    drop_redundant_rows(model, engine)
    engine.set_state(0.0, **state.static_state)
    residual, n = engine.static_residual(), model.n_band + model.n_border_dof
    units = np.ones(len(residual))
    free = model.unknown_of_dof >= 0
    units[model.unknown_of_dof[free]] = model.weight[free]
    largest = np.abs(engine.reaction() / model.weight).max() + np.abs(model.gravity / model.weight).max()
    return max(np.abs(residual / units)[:n].max() / largest, np.abs(residual[n:]).max(initial=0.0))


def beam(kind: str, element: str, p: float) -> Scene:
    """Return a cantilever under p times a load of a kind, and gravity."""
    scene = cable_scene("rope", clamps=(0,), gravity=(0, -9.81 * p, 0), elements=4, element=element, section=THIN,
                        material=SOFT, **structural(element))
    follower = kind.endswith("follower")
    along = (1, 0, 0) if follower and element in ("cable12", "cable18") else (0, 1, 0)  # these know their tangent alone
    if kind.startswith("force"):
        scene.force("rope", s=1.0, value=3 * p * np.array(along), follower=follower)
    elif kind.startswith("distributed"):
        scene.distributed_force("rope", value=4 * p * np.array(along), follower=follower)
    else:
        scene.moment("rope", s=1.0, value=(0, 0, 0.5 * p))
    return scene


def bodies(kind: str, p: float) -> Scene:
    """Return a body at the end of a cantilever, by a joint or a slide, with a spring to the ground, under p times a
    load.
    """
    scene = Scene(gravity=(0, -9.81 * p, 0))
    scene.cable("rope", start=(0, 0, 0), end=(1, 0, 0), elements=3, element="beam24", law="structural", section=THIN,
                material=SOFT)
    scene.clamp("rope", s=0)
    if "modal" in kind:
        scene.modal_body("A", start=(1, 0, 0), end=(1.4, 0, 0), section=THIN, material=SOFT, modes=3)
        scene.joint("weld", ("rope", 1.0), ("A", (-0.2, 0, 0)))
    else:
        scene.rigid_body("A", mass=0.05, inertia=(1e-4, 2e-4, 2e-4), position=(1.1, 0, 0))
        if "slide" in kind:
            scene.slide("A", along="rope", s=1.0, at=(-0.1, 0, 0), frame="section", drive=1.0)
        else:
            scene.joint("revolute", ("rope", 1.0), ("A", (-0.1, 0, 0)), axis=(0, 0, 1))
    scene.spring("A", (1.1, 1, 0), stiffness=5.0, length=1.0)
    if kind.endswith("moment"):
        scene.moment("A", value=(0, 0, 0.1 * p))
    else:
        scene.force("A", value=(0.1 * p, 0.6 * p, 0.2 * p), at=(0.04, 0, 0), follower=kind.endswith("follower"))
    return scene


CABLES = [(kind, element) for element in ("cable8p", "cable12", "cable18", "beam12p", "beam24")
          for kind in ("force", "force follower", "distributed", "distributed follower", "moment")
          if kind != "moment" or element.startswith("beam")]
BODIES = [f"{carrier} {load}" for carrier in ("joint", "slide", "modal") for load in ("force", "follower", "moment")
          if (carrier, load) != ("modal", "moment")]


@pytest.mark.parametrize("settings", [{"load_steps": 3}, {"method": "arc_length", "largest_step": 0.3}])
@pytest.mark.parametrize("make", [*((lambda p, case=case: beam(*case, p)) for case in CABLES),
                                  *((lambda p, kind=kind: bodies(kind, p)) for kind in BODIES)],
                         ids=[*map("-".join, CABLES), *BODIES])
@pytest.mark.slow_cases("joint moment-settings1", "joint follower-settings1", "modal follower-settings1")
def test_every_state_is_in_equilibrium_under_its_part_of_all_loads(make, settings):
    state = make(1.0).equilibrium(**settings)
    assert len(state.path) >= 3
    assert state.load_fraction == 1
    for each in state.path:
        assert left_over(make(each.load_fraction), each) < 1e-8


def test_gravity_may_stay_whole():
    with pytest.warns(FunicularWarning, match="without loads, under its weight"):
        state = beam("force", "cable8p", 1.0).equilibrium(load_steps=2, scale_gravity=False)
    half = beam("force", "cable8p", 0.5)
    half.gravity = (0, -9.81, 0)
    assert left_over(half, state.path[0]) < 1e-8
    assert left_over(beam("force", "cable8p", 0.5), state.path[0]) > 1e-2


@pytest.mark.parametrize("settings", [{"load_steps": 10}, {"method": "arc_length"}])
def test_a_moment_bends_to_an_arc_at_every_part_of_it(settings, validated):
    """The tip is at (sin a, 1 - cos a)/a with a = p M L/EI."""
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("beam", start=(0, 0, 0), end=(1, 0, 0), elements=16, element="beam24", law="structural",
                section=THIN, material=Material(youngs_modulus=1e7, poisson_ratio=0, density=1000))
    scene.clamp("beam", s=0)
    scene.moment("beam", s=1.0, value=(0, 0, 4.0 * 1e7 * 0.02**4 / 12))
    state = scene.equilibrium(**settings)
    assert len(state.path) >= 10
    a = 4.0 * np.array([each.load_fraction for each in state.path])
    validated("Statics", "beam rolled up by parts of an end moment", "place of the end",
              np.transpose([np.sin(a) / a, (1 - np.cos(a)) / a]),
              [each["beam.position"][-1, :2] for each in state.path], unit="m", scale=1.0, bound=2e-4,
              source="closed form, arc of a circle", variant="beam24, structural", mesh="16 elements")


def lees_frame(load: float, follower: bool, elements: int, beam: bool = False) -> Scene:
    scene = Scene(gravity=(0, 0, 0))
    kind = ({"element": "beam12p", "law": "structural", "section": Rectangle(height=2, width=3)} if beam else
            {"element": "cable8p", "section": GeneralSection(area=6, second_moment_about_z=2, second_moment_about_y=2)})
    legs = {"elements": elements, **kind,
            "material": Material(youngs_modulus=7.2e6, poisson_ratio=0.3, density=1)}
    scene.cable("column", start=(0, 0, 0), end=(0, 120, 0), up=(-1, 0, 0), **legs)
    scene.cable("beam", start=(0, 120, 0), end=(120, 120, 0), **legs)
    scene.pin("column", s=0)
    scene.pin("beam", s=120)
    scene.tie("column", s=120, to="beam", at=0, rotation="rigid")
    scene.force("beam", s=24.0, value=(0, -load, 0), follower=follower)
    return scene


@pytest.mark.parametrize(("follower", "load", "nominal"), [
    (False, 18532, 2e4), (False, 18532, 1e6), (True, 35447, 4e4), (True, 35447, 1e6)])
@pytest.mark.slow_cases("True-35447-1000000.0")
def test_lees_frame(follower, load, nominal, validated):
    """Lee, Manuel & Rossow, J. Eng. Mech. Div. 94 (1968) 417-442; both limit loads agree with other codes."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", FunicularWarning)
        warnings.filterwarnings("ignore", "cable \"beam\": elements of 12 m are too long")  # at 1e6: off by 0.7 %
        state = lees_frame(nominal, follower, 10).equilibrium(method="arc_length")
    high, low = state.critical_points
    assert (high.kind, low.kind, high.directions, low.directions) == ("limit", "limit", 1, -1)
    validated("Statics", f"Lee's frame, {'follower' if follower else 'fixed'} force", "limit load", load,
              high.load_fraction * nominal, bound=3e-3, source="Lee, Manuel & Rossow 1968, as others compute it",
              variant="cable8p", mesh="10 elements a leg")
    assert high.state.load_fraction == high.load_fraction
    fractions = np.array([each.load_fraction for each in state.path])
    unstable = np.array([each.unstable_directions for each in state.path])
    falling = np.append(False, np.diff(fractions) < 0)
    assert unstable.max() == 1
    assert np.count_nonzero(unstable != falling) <= 2, "unstable where the load falls, but next to a limit point"


@pytest.mark.parametrize("elements", [10, pytest.param(40, marks=pytest.mark.slow)])
@pytest.mark.parametrize(("follower", "load"), [(False, 18544.8), (True, 35393.0)])
@pytest.mark.slow_cases("True-35393.0-10")
def test_lees_frame_that_shears(follower, load, elements, validated):
    """Against Reissner's frame with the shear factor 10 (1 + nu)/(12 + 11 nu); the follower force rotates with the
    section.

    The reference is from two-node elements with one point of integration, 40 and 80 per leg (18560.01, 18548.57;
    35454.7, 35408.42), extrapolated by the square of their length. Tangents tied to sections at the corner would give
    18464 and 34620 with 40 beams per leg, and less with more.
    """
    nominal = 4e4 if follower else 2e4
    high = lees_frame(nominal, follower, elements, beam=True).equilibrium(method="arc_length").critical_points[0]
    assert high.kind == "limit"
    validated("Statics", f"Lee's frame with shear, {'follower' if follower else 'fixed'} force", "limit load", load,
              high.load_fraction * nominal, bound=1e-4, source="Reissner's frame of two-node elements, extrapolated",
              variant="beam12p, structural", mesh=f"{elements} elements a leg")


def test_critical_loads_do_not_depend_on_the_nominal_one_or_the_density_of_the_path():
    found = [[point.load_fraction * nominal for point in lees_frame(nominal, False, 6).equilibrium(
        method="arc_length", largest_step=step).critical_points] for nominal, step in ((2e4, 0.2), (2e5, 0.05))]
    assert_allclose(found[0], found[1], rtol=1e-5)


def strut(load: float, element="cable8p") -> Scene:
    scene = cable_scene("strut", length=LENGTH, clamps=(0,), gravity=(0, 0, 0), elements=8, element=element,
                        section=Circle(radius=RADIUS),
                        material=Material(youngs_modulus=MODULUS, poisson_ratio=0, density=1000), **structural(element))
    scene.force("strut", s=LENGTH, value=(-load, 0, 0))
    return scene


EULER = np.pi**2 * STIFFNESS / (4 * LENGTH**2)


def test_eulers_loads_are_bifurcations(validated):
    with pytest.warns(FunicularWarning, match="the state is unstable: 4 independent directions lower its energy"):
        state = strut(10 * EULER, "cable12").equilibrium(method="arc_length")
    assert [(point.kind, point.directions) for point in state.critical_points] == [("bifurcation", 2)] * 2
    validated("Statics", "cantilever that buckles", "loads over Euler's first", [1, 9],
              [10 * point.load_fraction for point in state.critical_points], bound=2e-3, source="closed form",
              variant="cable12")
    for each in state.path:
        assert each.unstable_directions == 2 * (each.load_fraction > 0.1) + 2 * (each.load_fraction > 0.9)
    assert not state.stable
    assert_allclose(state["strut.position"][:, 1:], 0, atol=1e-12)


@pytest.mark.parametrize("element", ["cable8p", "cable12", "beam12p", "beam24"])
def test_a_strut_beyond_eulers_load_buckles(element, validated):
    """Load over Euler's 1/cos-like: tip of the elastica at P/Pe = 1.1517, turned by 60 degrees (Timoshenko & Gere,
    Theory of Elastic Stability, table 2-4: x 0.741, y 0.593)."""
    with pytest.warns(FunicularWarning, match="the search went on to a stable one; the branch that the search"):
        state = strut(1.1517 * EULER, element).equilibrium()
    x, y, z = state["strut.position"][-1]
    assert state.stable
    validated("Statics", "strut beyond Euler's load, P/P_E 1.152", "place of the end", (0.741, 0.593),
              (x, np.hypot(y, z)), unit="m", scale=1.0, bound=2e-3, variant=element,
              source="Timoshenko & Gere, Theory of Elastic Stability, table 2-4")
    assert state.neutral_directions == (1 if element in ("cable12", "beam24") else 0), "it may turn about its axis"
    below = strut(0.9 * EULER, element).equilibrium()
    assert below.stable
    assert not below.messages


def test_an_upright_pendulum_falls_and_says_so():
    scene = Scene()
    scene.rigid_body("A", mass=2, inertia=(0.1, 0.15, 0.2), position=(0, 0.5, 0))
    scene.joint("revolute", (0, 0, 0), ("A", (0, -0.5, 0)), axis=(0, 0, 1), name="hinge")
    with pytest.warns(FunicularWarning, match="1 independent direction lowers its energy; the search went on"):
        state = scene.equilibrium()
    assert_allclose(state["A.position"], [0, -0.5, 0], atol=1e-9)


def test_a_state_to_start_from():
    """Either of the two equilibria of a buckled strut, and a path that continues from the end of another."""
    up, down = strut(1.5 * EULER), strut(1.5 * EULER)
    up.force("strut", s=LENGTH, value=(0, 0.05, 0))
    down.force("strut", s=LENGTH, value=(0, -0.05, 0))
    for pushed, sign in ((up, 1), (down, -1)):
        again = strut(1.5 * EULER)
        again.force("strut", s=LENGTH, value=(0, 0, 0))
        state = again.equilibrium(start=pushed.equilibrium())
        assert sign * state["strut.position"][-1, 1] > 0.5
        assert not state.messages
    frame = lees_frame(2e4, False, 6)
    whole = frame.equilibrium(method="arc_length")
    falling = next(each for each in whole.path if each.unstable_directions)
    rest = frame.equilibrium(method="arc_length", start=falling)
    assert [point.directions for point in rest.critical_points] == [-1], "on from there, and not back"
    assert_allclose(rest["beam.position"], whole["beam.position"], atol=1e-6)


def test_friction_is_left_out_and_that_is_said():
    from funicular import Friction

    scene = Scene()
    scene.cable("rope", start=(0, 0, 0), end=(1, 0, 0), elements=3, element="cable12", section=THIN, material=SOFT)
    for s in (0, 1):
        scene.pin("rope", s=s)
    scene.rigid_body("A", mass=0.1, inertia=(1e-4, 1e-4, 1e-4), position=(0.3, 0, 0))
    scene.slide("A", along="rope", s=0.3, name="trolley", friction=Friction(coefficient=0.5))
    with pytest.warns(FunicularWarning, match='friction of "trolley" is left out: at rest slides move freely'):
        state = scene.equilibrium()
    assert state["trolley.s"] == pytest.approx(0.5)
