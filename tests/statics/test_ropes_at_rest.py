"""Ropes at rest against closed forms, their modes, adjustment, and what is refused."""

import funicular as fu
import numpy as np
import pytest

G, RADIUS, E, DENSITY = 9.81, 1e-3, 6e9, 7000.0
AREA = np.pi * RADIUS**2
MADE = {"section": fu.Circle(radius=RADIUS),
        "material": fu.Material(youngs_modulus=E, poisson_ratio=0.3, density=DENSITY)}


def line(tension=50.0, elements=2, **given) -> fu.Scene:
    """Return a rope over a sheave between two points of the ground."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.rope("rope", route=[fu.Anchor(at=(-3, -1, 0)), fu.Sheave("top", at=(0, 0, 0), radius=0.25, **given),
                              fu.Anchor(at=(2, -2, 0))], tension=tension, elements=elements, **MADE)
    return scene


def hung(mass=2.0, **given) -> fu.Scene:
    """Return a weight on a rope from the ground over a sheave."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.rigid_body("B", mass=mass, inertia=(1, 1, 1), position=(0.25, -2, 0))
    scene.rope("rope", route=[fu.Anchor(at=(-3, -1, 0)), fu.Sheave("top", at=(0, 0, 0), radius=0.25, **given),
                              fu.Anchor("B")], tension=19.0, elements=2, **MADE)
    return scene


def pair(density=1.0, **given) -> fu.Scene:
    """Return two equal weights on a light rope over a sheave."""
    scene = fu.Scene(gravity=(0, -G, 0))
    for name, x in (("A", -0.25), ("B", 0.25)):
        scene.rigid_body(name, mass=5.0, inertia=(1, 1, 1), position=(x, -2, 0))
    material = fu.Material(youngs_modulus=E, poisson_ratio=0.3, density=density)
    scene.rope("rope", route=[fu.Anchor("A"), fu.Sheave("top", at=(0, 0, 0), radius=0.25, **given), fu.Anchor("B")],
               tension=5 * G, elements=1, section=MADE["section"], material=material)
    return scene


@pytest.mark.parametrize(("tension", "elements"), [(50.0, 1), (50.0, 3), (5.0, 4)])
def test_tension_along_a_rope_at_rest(tension, elements):
    """W - T lambda + rho g y, with W = T²/2EA and lambda = 1 + T/EA, is the same at both ends to 2e-8 N without
    bending, 7e-7 N at the low tension; anchors and sheave bear the weight to rounding.
    """
    rest = line(tension, elements).equilibrium()
    ends = [np.linalg.norm(rest[f"rope.{end}_force"]) for end in ("start", "end")]
    along = [-T - T**2 / (2 * E * AREA) + DENSITY * AREA * G * y for T, y in zip(ends, (-1, -2), strict=True)]
    assert along[0] == pytest.approx(along[1], abs=2e-6)
    at_sheave = -rest["top.tension_on"] - rest["top.tension_on"]**2 / (2 * E * AREA)
    assert at_sheave == pytest.approx(along[0], abs=DENSITY * AREA * G * 0.25 + 1e-6)  # its height is within the radius
    total = rest["rope.start_force"] + rest["rope.end_force"] + rest["top.force"]
    assert total == pytest.approx(np.array([0, -DENSITY * AREA * G * rest["rope.s"][-1], 0]), abs=1e-9)
    assert rest.stable


def test_a_weight_hangs_from_a_rope():
    rest = hung().equilibrium()
    assert np.linalg.norm(rest["rope.end_force"]) == pytest.approx(2 * G, rel=1e-9)
    span = -2.0 * rest["B.position"][1] / 2 * DENSITY * AREA * G
    assert rest["top.tension_off"] == pytest.approx(2 * G + span, rel=1e-4)
    run = hung().run(0.2, output_step=0.1, initial=rest)
    assert np.abs(run["B.position"] - rest["B.position"]).max() < 1e-9
    assert hung().relax()["B.position"] == pytest.approx(rest["B.position"], abs=1e-9)


def test_equal_weights_are_in_an_unstable_equilibrium():
    with pytest.raises(fu.EquilibriumError, match="1 independent direction lowers its energy"):
        pair().equilibrium()
    assert pair().equilibrium(seek_stable=False).unstable_directions == 1


def test_unequal_weights_have_none():
    with pytest.raises(fu.EquilibriumError, match="no equilibrium was reached"):
        pair().replace("B", mass=4.0).equilibrium()


def test_modes_of_two_weights():
    """The pair of weights m on a light rope (EA, free length L): sqrt(g/l) for both pendulums; sqrt(2 EA/(L m)) for the
    stretch; and it grows by sqrt(rho g/m), as what runs over is on the other side.
    """
    scene = pair()
    modes = scene.modes(6, about=scene.equilibrium(seek_stable=False))
    length = scene.route_of(scene.ropes["rope"]).free_length
    assert modes.growth_rate[0] == pytest.approx(np.sqrt(AREA * G / 5), rel=3e-3)
    assert modes.angular_frequency[:3] == pytest.approx(0, abs=1e-6)  # the antisymmetric one, and the bodies' rotations
    assert modes.angular_frequency[3:5] == pytest.approx(np.sqrt(G / 2), rel=1e-4)
    assert modes.angular_frequency[5] == pytest.approx(np.sqrt(2 * E * AREA / (length * 5)), rel=1e-4)
    antisymmetric = modes["A.displacement"][0, 1] / modes["B.displacement"][0, 1]
    assert antisymmetric == pytest.approx(-1, abs=1e-3)


def test_modes_of_the_spans_of_a_rope():
    """Strings of both spans, sqrt(T/rho)/2l, whose bending and sag are of .1 %."""
    scene = line(elements=6)
    rest = scene.equilibrium()
    found = scene.modes(2, about=rest).frequency
    speed = np.sqrt(50.0 / (DENSITY * AREA))
    lengths = [np.sqrt(10 - 0.25**2), np.sqrt(8 - 0.25**2)]
    assert found == pytest.approx([speed / (2 * each) for each in lengths], rel=5e-3)


def test_friction_is_left_out_and_said():
    scene = hung(friction=0.2, zones=3)
    rest = scene.equilibrium()
    assert rest["B.position"] == pytest.approx(hung().equilibrium()["B.position"], abs=1e-9)
    assert rest.messages[0] == 'friction of "top" is left out: at rest ropes move freely'
    assert 'modes leave out the friction of sheave "top"' in scene.modes(2, about=rest).messages
    with pytest.raises(fu.SceneError, match='sheave "top": its friction is regularised, so that the rope creeps'):
        scene.relax()


@pytest.mark.parametrize("settings", [{}, {"method": "arc_length"}])
def test_a_torque_that_turns_a_sheave_freely_is_the_cause(settings):
    driven = hung(friction=0.2, inertia=0.1, torque=2.0)
    with pytest.raises(fu.EquilibriumError, match="friction of ropes is left out at rest, so that sheave \"top\" turns "
                       "freely under its torque; take wraps=\"stick\", prescribe its angle, or leave the torque out"):
        driven.equilibrium(**settings)
    assert hung(friction=0.2, inertia=0.1, torque=0.0).equilibrium().neutral_directions > 0


@pytest.mark.parametrize(("path", "start", "target"), [
    ("rope.tension", {}, {"top.tension_on": 60.0}), ("rope.material.density", {}, {"top.tension_on": 50.5})])
def test_adjusted(path, start, target):
    rest = line().equilibrium(adjust=[path], to=target)
    assert rest["top.tension_on"] == pytest.approx(target["top.tension_on"], rel=1e-6)
    again = line().replace("rope", **({"tension": rest.adjusted[path]} if path == "rope.tension" else {
        "material": fu.Material(youngs_modulus=E, poisson_ratio=0.3, density=rest.adjusted[path])})).equilibrium()
    assert again["top.tension_on"] == pytest.approx(target["top.tension_on"], rel=1e-6)


def test_a_longer_rope_lowers_its_weight():
    scene = hung()
    length = scene.route_of(scene.ropes["rope"]).free_length
    rest = scene.replace("rope", length=length).equilibrium(adjust=["rope.length"], to={"B.position.y": -1.9})
    assert rest.adjusted["rope.length"] == pytest.approx(length - 0.1, abs=1e-3)


def test_states_of_other_ropes_do_not_fit():
    rest = hung().equilibrium()
    with pytest.raises(fu.SceneError, match="belongs to another scene: its ropes are"):
        hung().replace("rope", elements=3).run(0.01, initial=rest)
    with pytest.raises(fu.SceneError, match="the stress-free length there"):
        hung().replace("rope", tension=25.0).run(0.01, initial=rest)
    other = hung().replace("rope", tension=25.0)
    assert other.equilibrium(start=rest)["B.position"] == pytest.approx(other.equilibrium()["B.position"], abs=1e-9)


def test_a_rest_off_a_sheave_is_none():
    """A spring pulls the rope upward, off the sheave below it."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("L", mass=1.0, inertia=(1, 1, 1), position=(1.5, -0.05, 0))
    scene.rope("rope", route=[fu.Anchor(at=(-1, 0, 0)), fu.Sheave("top", at=(0, -0.2, 0), radius=0.2, side="right"),
                              fu.Anchor("L")], tension=30.0, **MADE)
    scene.spring("L", (3.0, 1.0, 0), stiffness=100.0, length=1.5)
    with pytest.raises(fu.EquilibriumError, match=r'the rope (leaves|lifts off) sheave "top"'):
        scene.equilibrium()


def test_results_of_cables_do_not_exist():
    rest = hung().equilibrium()
    for name in ("rope", hung().ropes["rope"]):
        with pytest.raises(fu.UnknownResultError, match='rope "rope" is no cable: its tension is a result'):
            rest.slack_elements(name)
