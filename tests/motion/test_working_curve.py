"""Working curves of ropes of fibres, against closed forms."""

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from interrupted_runs import check_file_and_resume
from rope_memory import (
    BEND,
    CURVES,
    EA,
    FIBRES,
    PERMANENT,
    RADIUS,
    ROPE,
    TAU,
    K,
    L,
    fibres,
    of_working_curve,
    stretched,
    working_loss,
)

quiet = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
METHODS = {"genalpha": {"tol": 1e-5}, "radau": {"tol": 1e-6}, "explicit": {"tol": 1e-6}}
MASS, G = 50.0, 10.0
TOP = MASS * G / EA
"""Strain of the rope under the weight of the body."""


def with_body(element="cable8p", **given):
    """Return a rope of fibres that hangs, with a body at its end."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.cable("rope", start=(0, 0, 0), end=(0, -L, 0), elements=2, element=element, membrane="tabulated",
                section=fu.Circle(radius=RADIUS, tension_table=FIBRES), material=ROPE.remade({"density": 20.0}))
    scene.pin("rope", s=0.0)
    scene.rigid_body("B", mass=MASS, inertia=(1, 1, 1), position=(0, -L, 0))
    scene.joint("spherical" if element == "cable12" else "revolute", ("rope", L), "B", name="J",
                **({} if element == "cable12" else {"axis": (0, 0, 1)}))
    scene.working_curve("rope", **{"permanent": PERMANENT, "name": "worked"} | given)
    return scene


@quiet
@pytest.mark.parametrize(("integrator", "curve", "how"), [
    ("radau", "linear", {}), ("radau", "quadratic", {}), ("radau", "exponential", {}),
    ("genalpha", "linear", {"step": 1e-3}), ("explicit", "linear", {"tol": 1e-4})])
def test_a_rope_of_fibres_follows_its_working_curves(integrator, curve, how, validated):
    """Loaded, let go, loaded further and let go: tension, and the energy that both first loadings have cost."""
    for found in of_working_curve(integrator, curve, **how):
        quantity, unit = found["quantity"].rsplit(", ", 1)
        validated("Ropes with memory", f"{curve} working curve", quantity, found["reference"], found["found"],
                  unit=unit, scale=EA * 0.06 if unit == "N" else None, bound=1e-5, source="working curve, and its area",
                  variant=integrator)
        assert found["energy"] < 1e-4, found


def test_a_cycle_below_the_highest_strain_costs_nothing():
    """Energy is lost while the highest strain rises alone: from 0.4 to 0.44 s the rope reloads below it."""
    run = stretched().run(0.5, output_step=0.02, integrator="radau", tol=1e-6)
    lost, highest = run["energy.dissipated"], run["worked.highest_strain"].mean(axis=1)
    still = np.diff(highest) == 0
    assert still.sum() > 8 and np.all(np.diff(lost)[still] == 0) and np.all(np.diff(lost)[~still] > 0)
    np.testing.assert_allclose(lost, working_loss("linear", highest), rtol=1e-3, atol=1e-3)


def test_an_unloaded_rope_keeps_its_permanent_elongation():
    """By the highest tension before: without force, below it, and beyond it."""
    top = 3000.0
    for share in (1e-4, 0.5, 1.0, 1.2):
        scene = fibres().replace("worked", highest_tension=top)
        scene.force("rope", s=L, value=(share * top, 0, 0))
        rest = scene.equilibrium()
        strain = top / EA * (PERMANENT + (1 - PERMANENT) * share if share < 1 else share)
        assert rest["rope.position"][-1, 0] / L - 1 == pytest.approx(strain, rel=1e-9)
        np.testing.assert_allclose(rest["worked.tension"], share * top, rtol=1e-9)
        np.testing.assert_allclose(rest["worked.highest_strain"], top / EA * max(share, 1), rtol=1e-9)
        found = rest.section_forces("rope", method="constitutive", s=[0.0, 2.2, L]).tension
        np.testing.assert_allclose(found, share * top, rtol=1e-6)


def test_a_measured_unloading_is_scaled_to_other_turning_points():
    """The curve from 0.06 on holds in proportion from 0.03 on."""
    strain, force = (0.02, 0.03, 0.045, 0.06), (0.0, 800.0, 2200.0, 0.06 * EA)
    whole = fibres().without("worked")
    whole.working_curve("rope", strain=strain, force=force, name="worked", highest_tension=force[-1])
    for scale in (1.0, 0.5):
        part = whole.replace("worked", highest_tension=scale * force[-1])
        for at, expected in zip(strain[1:], force[1:], strict=True):
            scene = part.replace("worked")
            scene.force("rope", s=L, value=(scale * expected, 0, 0))
            found = scene.equilibrium()["rope.position"][-1, 0] / L - 1
            assert found == pytest.approx(scale * at, rel=1e-9)


@pytest.mark.parametrize("curve", CURVES)
def test_a_body_vibrates_by_the_working_curve(curve, validated):
    """Modes about first loading have the slope of the working curve from there; table and highest tension alike."""
    slope = {"linear": 1.0, "quadratic": 1 + BEND, "exponential": BEND * np.exp(BEND) / np.expm1(BEND)}[curve]
    scene = with_body(form=curve, **CURVES[curve])
    found = scene.modes(3, about=scene.equilibrium()).frequency
    rope = 20.0 * np.pi * RADIUS**2 * L
    expected = np.sqrt(slope * EA / (1 - PERMANENT) / L / (MASS + rope / 3)) / (2 * np.pi)
    validated("Modes", f"body on a rope of fibres, {curve} working curve", "frequency", expected,
              found[np.argmin(np.abs(found - expected))], bound=1e-4, unit="Hz", mesh="2 elements",
              source="slope of the working curve at the state")


def test_a_vibration_below_the_highest_tension_is_harmonic():
    """A body that moves by less than to the highest strain: the period of a straight working curve."""
    scene = with_body(highest_tension=2 * MASS * G)
    rest = scene.equilibrium()
    speed = np.zeros((3, 2, 3))
    speed[:, 0, 1], speed[:, 1, 1] = (0, 0.1, 0.2), 0.2 / L
    state = {name: rest[name] for name in ("rope.nodal_vectors", "B.position")}
    run = scene.run(1.0, output_step=0.02, integrator="radau", tol=1e-7, initial=fu.InitialState(
        state | {"B.velocity": [0, 0.2, 0], "rope.nodal_velocity": speed}))
    rope = 20.0 * np.pi * RADIUS**2 * L
    rate = np.sqrt(EA / (1 - PERMANENT) / L / (MASS + rope / 3))
    moved = run["B.position"][:, 1] - rest["B.position"][1]
    assert np.abs(moved - 0.2 / rate * np.sin(rate * run.time)).max() < 2e-4 * 0.2 / rate
    assert run["energy.dissipated"][-1] == 0


@quiet
@pytest.mark.parametrize(("integrator", "element"), [("genalpha", "cable8p"), ("radau", "cable12"),
                                                     ("explicit", "cable8p")])
def test_a_body_falls_into_its_rope_with_every_integrator(integrator, element, tmp_path):
    """It bounces, the rope becomes slack; runs resume bit for bit, and the energies balance."""
    scene = with_body(element)
    run = check_file_and_resume(scene, tmp_path, 30, duration=0.6, output_step=0.04, integrator=integrator,
                                **METHODS[integrator])
    total = sum(run[f"energy.{name}"] for name in ("kinetic", "elastic", "potential", "dissipated"))
    assert np.ptp(total) < 2e-4 * np.ptp(run["energy.potential"])
    assert run["worked.highest_strain"].max() == pytest.approx(2 * TOP, rel=1e-3)  # of a rope without mass
    assert run["energy.dissipated"][-1] == pytest.approx(working_loss("linear", 2 * TOP), rel=2e-3)


def test_a_state_of_a_run_remembers_the_highest_strain():
    """A run from it is on the working curve, and not on first loading."""
    moved = fibres()
    moved.motion("rope", s=L, displacement=(fu.Pulse(start=0, end=0.4, height=0.4), 0, 0))
    run = moved.run(0.3, output_step=0.1, integrator="radau", tol=1e-6)
    again = fibres().run(1e-3, output_step=1e-3, integrator="radau", tol=1e-4, initial=run.at(0.3))
    np.testing.assert_allclose(again["worked.highest_strain"][0], run["worked.highest_strain"][3], rtol=1e-12)
    np.testing.assert_allclose(again["worked.tension"][0], run["worked.tension"][3], rtol=1e-9)


@quiet
def test_fast_changes_are_stiffer_with_a_relaxation():
    """A rope of fibres that has been loaded higher, shaken about a mean: the working curve beside a Maxwell element."""
    amplitude, mean, frequency, cycles = 0.02, 0.3, 1.5, 4
    scene = fibres().replace("rope", end=(L + mean, 0, 0), rest_length=L, rest="straight")
    scene = scene.replace("worked", highest_tension=EA * 0.06)
    scene.relaxation("rope", stiffness=K, time=TAU, name="fast")
    assert fu.Scene.from_toml(scene.to_toml()).to_toml() == scene.to_toml()
    wave = fu.Harmonic(amplitude=-amplitude, frequency=frequency, phase=np.pi / 2, offset=amplitude)
    scene.motion("rope", s=L, displacement=(wave, 0, 0))
    run = scene.run(cycles / frequency, output_step=1 / (40 * frequency), integrator="genalpha",
                    step=1 / (400 * frequency))
    x = 2 * np.pi * frequency * TAU
    force = (run["worked.tension"].mean(axis=1) + run["fast.tension"].mean(axis=1))[-40:]
    lost = np.diff(run["energy.dissipated"][[-41, -1]])
    assert lost == pytest.approx(np.pi * amplitude**2 / L * K * x / (1 + x**2), rel=1e-3)
    dynamic = abs(EA / (1 - PERMANENT) + K * 1j * x / (1 + 1j * x))
    found = abs(np.mean(force * np.exp(2j * np.pi * np.arange(40) / 40))) * 2
    assert found == pytest.approx(dynamic * amplitude / L, rel=1e-4)


def test_a_damped_motion_to_rest_remembers_nothing():
    """It overshoots, and ends on first loading as `equilibrium` does, or on the working curve from a tension."""
    for top in (0.0, 3 * MASS * G):
        scene = with_body("cable12", highest_tension=top)
        rest, other = scene.equilibrium(), scene.relax()
        np.testing.assert_allclose(other["worked.strain"], rest["worked.strain"], rtol=1e-8)


def test_pieces_have_their_own_first_loading():
    """Two tables in one rope: the same working curve from each."""
    soft = fu.TensionTable(strain=[0, 0.1], force=[0, 0.05 * EA])
    pieces = [fu.Piece(length=length, section=fu.Circle(radius=RADIUS, tension_table=table), material=ROPE, elements=2)
              for length, table in ((4.0, FIBRES), (6.0, soft))]
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("rope", start=(0, 0, 0), end=(L, 0, 0), element="cable12", membrane="tabulated", pieces=pieces)
    scene.pin("rope", s=0.0)
    scene.working_curve("rope", permanent=PERMANENT, highest_tension=2000.0, name="worked")
    scene.force("rope", s=L, value=(1000.0, 0, 0))
    rest, tops = scene.equilibrium(), np.array([2000 / EA, 4000 / EA])
    assert rest["rope.position"][-1, 0] - L == pytest.approx(
        (PERMANENT + 0.5 * (1 - PERMANENT)) * tops @ [4, 6], rel=1e-9)
    np.testing.assert_allclose(rest.section_forces("rope", method="constitutive", s=[1.0, 9.0]).tension, 1000.0,
                               rtol=1e-9)


@pytest.mark.parametrize(("given", "message"), [
    ({}, "needs permanent, or strain and force; give the permanent strain as a share of the highest one, or a measured "
     "curve"),
    ({"permanent": 1.0}, "permanent must be from 0 to below 1, got 1"),
    ({"permanent": 0.2, "bend": 0.5}, 'bend needs form="quadratic" or "exponential", got 0.5 with "linear"'),
    ({"permanent": 0.2, "form": "quadratic", "bend": 1.5}, 'bend must be from 0 to 1 with form="quadratic", got 1.5'),
    ({"strain": (0, 0.1)}, "strain and force belong together, got one of them; give both"),
    ({"strain": (0, 0.1), "force": (0, 1e3), "permanent": 0.1}, "permanent, form and bend are given beside strain and "
     "force, which say the same; leave out the ones or the others"),
    ({"strain": (0.01, 0.1), "force": (5, 1e3)}, "force must begin at 0, got 5 N; add the point of the permanent "
     "strain, at which the rope becomes slack"),
    ({"strain": (0.01, 0.05, 0.1), "force": (0, 2e3, 1e3)}, "force must increase with strain, got 1000 N after 2000 N"),
    ({"strain": (0.05, 0.01, 0.1), "force": (0, 2e3, 3e3)}, "strain must increase, got 0.01 after 0.05"),
    ({"strain": (0.01, 0.05), "force": (0, 2e3)}, "the last force is 2000 N at the strain 0.05, where the table of the "
     "cable has 4000 N; let the curve end on the table"),
    ({"strain": (0.01, 0.02, 0.05), "force": (0, 3e3, 4e3)}, "the working curve from the strain"),
])
def test_what_is_no_working_curve_is_refused(given, message):
    scene = fibres().without("worked")
    with pytest.raises(fu.SceneError, match=r'^working_curve "w": ') as error:
        scene.working_curve("rope", **given, name="w")
    assert message in str(error.value)


def test_what_has_no_working_curves_is_refused():
    scene = fibres()
    with refused('working_curve "w": cable "rope" has working_curve "worked" already; leave one of them out'):
        scene.working_curve("rope", permanent=0.1, name="w")
    with refused('working_curve "worked": integrator "energy" has no discrete gradient of it; take another integrator'):
        scene.run(0.1, integrator="energy")
    with refused('working_curve "worked": integrator "linear" does not support working curves of ropes; leave it out, '
                 "or take another integrator"):
        scene.run(0.1, output_step=0.05, integrator="linear")
    scene = fu.Scene()
    scene.cable("plain", start=(0, 0, 0), end=(1, 0, 0), elements=2, element="cable8p", section=fu.Circle(radius=0.01),
                material=ROPE)
    with refused('working_curve "w": needs the force of first loading, but cable "plain" has no table that begins at '
                 'strain 0; give its section a tension_table from strain 0 on, and the cable membrane="tabulated"'):
        scene.working_curve("plain", permanent=0.1, name="w")
    with refused('working_curve "w": there is no cable "other"; known: plain'):
        scene.working_curve("other", permanent=0.1, name="w")
