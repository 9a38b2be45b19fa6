"""Cables with memory, against closed forms: viscosity along the axis, friction between wires."""

import numpy as np
import pytest
from expectations import refused
from funicular import Circle, Material, Ramp, Scene, TensionTable
from interrupted_runs import check_file_and_resume
from rope_memory import (
    BEGIN,
    BENT,
    EA,
    FORCE,
    INTEGRATORS,
    LENGTH,
    SLIP,
    TAU,
    VISCOUS,
    WIRES,
    K,
    L,
    creep,
    displacement,
    moved,
    of_friction,
    of_loss,
    of_viscosity,
    pulled,
    rope,
)
from shared_scenes import add_cable

quiet = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")


def hung(element: str = "cable12") -> Scene:
    """Return a viscous cable that hangs from one end, and swings; its weight is that of a rope of 1 kg/m."""
    scene = Scene()
    scene.cable("rope", start=(0, 0, 0), end=(2, 0, 0), elements=4, element=element, section=Circle(radius=0.01),
                material=Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1000))
    scene.pin("rope", s=0.0)
    scene.relaxation("rope", stiffness=2e3, time=0.1, name="viscosity")
    return scene


@pytest.mark.parametrize("case", VISCOUS)
@pytest.mark.parametrize("element", ["cable8p", "cable12"])
def test_viscosity_follows_closed_forms(case, element, validated):
    """Creep is compared after the rise of the force, in which the inertia of the rope is 6e-6 of it."""
    scene, result, closed_form, quantity = VISCOUS[case]
    run = scene(element).run(1.5, output_step=0.05, integrator="genalpha", tol=1e-6)
    exact = closed_form(run.time)
    after = run.time >= BEGIN
    name, unit = quantity.split(", ")
    validated("Ropes with memory", f"standard linear solid: {case}", name, exact[after], result(run)[after], unit=unit,
              scale=np.abs(exact).max(), bound=1e-6, source="creep compliance, relaxation modulus", variant=element)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_every_integrator_creeps_and_relaxes_alike(integrator):
    """Errors are those of the tolerance, 1e-5 of the motion in each step."""
    for case in VISCOUS:
        found = of_viscosity(case, integrator, tol=1e-5)
        assert found["error"] < 2e-4 and found["energy"] < 1e-3, found


@quiet
@pytest.mark.parametrize("integrator", ["genalpha", "radau"])
def test_a_shaken_rope_takes_the_energy_of_its_loss_modulus(integrator, validated):
    """The energies balance."""
    found = of_loss(integrator, tol=1e-5)
    validated("Ropes with memory", "standard linear solid: harmonic strain", "loss in a cycle", found["reference"],
              found["found"], unit="J", bound={"genalpha": 1e-6, "radau": 1e-3}[integrator], source="loss modulus",
              variant=integrator)
    assert found["energy"] < 3e-4


def test_finer_tolerances_converge_to_the_closed_form():
    """Radau's steps are chosen by the error of the history, too."""
    errors = [of_viscosity("relaxation", "radau", tol)["error"] for tol in (1e-5, 1e-7)]
    assert errors[1] < errors[0] / 10


def test_rest_and_modes_have_the_stiffness_for_long_times():
    """A cable under its weight hangs, and vibrates, as without the branch."""
    plain = hung().without("viscosity")
    rest, other = hung().equilibrium(), plain.equilibrium()
    assert np.array_equal(rest["rope.nodal_vectors"], other["rope.nodal_vectors"])
    assert not rest["viscosity.tension"].any()
    frequencies = [scene.modes(4, about=at).frequency for scene, at in ((hung(), rest), (plain, other))]
    assert np.array_equal(*frequencies)


def test_a_run_begins_relaxed_from_rest():
    """A cable at rest under a force stays there."""
    scene = rope()
    scene.force("rope", s=L, value=(FORCE, 0, 0))
    run = scene.run(0.5, output_step=0.1, tol=1e-6, initial=scene.equilibrium())
    assert np.abs(displacement(run) - FORCE * L / EA).max() < 1e-9
    assert np.abs(run["viscosity.tension"]).max() < 1e-5 * FORCE


@quiet
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_runs_resume_bit_for_bit(integrator, tmp_path):
    """The strain and the elastic part of each point are in the checkpoint."""
    check_file_and_resume(hung("cable8p"), tmp_path, 12, duration=0.4, output_step=0.02, tol=1e-4,
                          integrator=integrator)


def test_a_swinging_rope_loses_what_it_dissipates():
    """Energy is balanced in large motion in space, where the tangents turn."""
    run = hung().run(0.6, output_step=0.02, tol=1e-6)
    energies = sum(run[f"energy.{name}"] for name in ("kinetic", "elastic", "potential", "dissipated"))
    assert np.ptp(energies) < 1e-4 * np.ptp(run["energy.kinetic"])
    assert run["energy.dissipated"][-1] > 1e-3 * np.ptp(run["energy.kinetic"])


def test_section_forces_have_the_tension_of_the_branch():
    """The force through every section of the pulled rope is that of its end."""
    run = pulled().run(1.0, output_step=0.5, tol=1e-6, integrator="genalpha")
    found = run.section_forces("rope", method="constitutive")["tension"][1:]
    assert np.abs(found - FORCE).max() < 1e-5 * FORCE
    with refused('relaxation "viscosity": has forces within elements that a balance does not know, of cable "rope"; '
                 'take method="constitutive", which follows from the strains'):
        run.section_forces("rope")


def test_a_state_of_a_run_says_that_its_branches_begin_relaxed():
    """A run that starts from it has a message."""
    run = moved().run(0.5, output_step=0.1, tol=1e-4)
    later = rope().run(1e-3, output_step=1e-3, tol=1e-3, initial=run.at(0.1))
    assert any('the springs of "viscosity" begin unstretched' in note for note in later.report["messages"])


def test_several_relaxations_add_up():
    """Two halves are one."""
    scene = moved()
    scene = scene.replace("viscosity", stiffness=K / 2)
    scene.relaxation("rope", stiffness=K / 2, time=TAU, name="other")
    run = scene.run(0.5, output_step=0.1, tol=1e-5, integrator="genalpha")
    one = moved().run(0.5, output_step=0.1, tol=1e-5, integrator="genalpha")
    both = run["viscosity.tension"] + run["other.tension"]
    assert np.abs(both - one["viscosity.tension"]).max() < 1e-4 * np.abs(both).max()


def test_creep_is_slower_than_the_relaxation():
    """The retardation time is the relaxation time times (EA + K)/EA."""
    time = np.array([BEGIN + TAU * (EA + K) / EA * np.log(2), 1e3])
    half, whole = creep(time) / (FORCE * L / EA)
    assert whole == pytest.approx(1.0, abs=1e-12) and half > 1 - K / (EA + K) / 2


def test_cables_that_a_branch_does_not_suit_are_refused():
    """Each refusal names the place, the cause and a remedy."""
    scene = Scene()
    with refused('relaxation "a": there is no cable "rope"; the scene has none yet'):
        scene.relaxation("rope", stiffness=1.0, time=1.0, name="a")
    add_cable(scene, "beam", element="beam24")
    with refused('relaxation "a": acts on cable8p and cable12, but cable "beam" is of beam24; take one of these '
                 "elements"):
        scene.relaxation("beam", stiffness=1.0, time=1.0, name="a")
    with refused('relaxation "a": stiffness must be positive, got 0 N'):
        scene.relaxation("beam", stiffness=0.0, time=1.0, name="a")
    scene = Scene()
    given = {"start": (0, 0, 0), "end": (1, 0, 0), "elements": 2, "section": Circle(radius=0.01),
             "material": Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000, thermal_expansion=1e-5)}
    scene.cable("loose", **given, element="cable8p", membrane="tension_only")
    scene.cable("warm", **given, element="cable8p", temperature=20.0)
    scene.cable("changing", **given, element="cable8p", rest_length=Ramp(before=1.0, after=0.9, start=0, end=1))
    pulls = TensionTable(strain=[0, 0.01], force=[0, 1e3])
    scene.cable("by_table", **given | {"section": Circle(radius=0.01, tension_table=pulls)}, element="cable8p",
                membrane="tabulated")
    for name in ("loose", "by_table"):
        with refused(f'relaxation "a": cable "{name}" resists tension alone, and a branch would push; take the '
                     'membrane "full" or "assumed"'):
            scene.relaxation(name, stiffness=1.0, time=1.0, name="a")
    for name in ("warm", "changing"):
        with refused(f'relaxation "a": cable "{name}" has a temperature or a rest_length that changes, which the '
                     "branch would take for strain; leave it out"):
            scene.relaxation(name, stiffness=1.0, time=1.0, name="a")
    with refused('relaxation "viscosity": integrator "energy" has no discrete gradient of it; take another '
                 "integrator"):
        hung().run(0.1, integrator="energy")


# --- friction between wires --------------------------------------------------------------------------------------


def swinging(element: str = "cable12", **wires: float) -> Scene:
    """Return a cable that falls from a clamp, bends, and swings, with friction between its wires."""
    scene = Scene()
    scene.cable("rope", start=(0, 0, 0), end=(2, 0, 0), elements=8, element=element, section=Circle(radius=0.01),
                material=Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1000))
    scene.clamp("rope", s=0.0)
    scene.wire_friction("rope", **{"stiffness": 1.0, "moment": 0.05} | wires, name="wires")
    return scene


def energies(run) -> np.ndarray:
    """Return the sum of the energies (T,), J."""
    return sum(run[f"energy.{name}"] for name in ("kinetic", "elastic", "potential", "dissipated"))


def test_a_bent_rope_follows_the_bilinear_loop(validated):
    """The moment by the curvature, and the energy of a cycle, of a rope so light that it hardly vibrates."""
    for found in of_friction("genalpha", step=1e-3):
        quantity, unit = found["quantity"].rsplit(", ", 1)
        validated("Ropes with memory", "friction between wires: bending to and fro", quantity, found["reference"],
                  found["found"], unit=unit, scale=SLIP if unit == "N m" else None, bound=2e-4,
                  worst=unit == "N m", source="bilinear loop", variant="genalpha")
        assert found["energy"] < 3e-6, found


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit"])
def test_a_swinging_rope_loses_energy_between_its_wires(integrator):
    """All integrators agree; in space and in the plane alike."""
    run = swinging().run(0.6, output_step=0.02, tol=3e-5, integrator=integrator)
    assert np.ptp(energies(run)) < 1e-4 * np.ptp(run["energy.kinetic"])
    planar = swinging("cable8p").run(0.6, output_step=0.02, tol=3e-5, integrator=integrator)
    assert np.abs(run["wires.moment"] - planar["wires.moment"]).max() < 2e-3 * 0.05
    fine = swinging("cable8p").run(0.6, output_step=0.02, tol=1e-6, integrator="genalpha")
    assert run["energy.dissipated"][-1] == pytest.approx(fine["energy.dissipated"][-1], rel=2e-3)
    assert run["wires.sliding"].any() and not run["wires.sliding"].all()
    assert np.abs(run["wires.moment"]).max() <= 0.05 * (1 + 1e-12)


def test_wires_that_stick_are_as_stiff_as_a_rod():
    """A limit out of reach adds the stiffness to EI: the tip deflects as much under a small force."""
    scene, other = rod(BENT + WIRES), rod(WIRES)
    other.wire_friction("rope", stiffness=BENT, moment=1e3, name="wires")
    tips = [each.equilibrium()["rope.nodal_vectors"][-1, 0, 1] for each in (scene, other)]
    assert tips[1] == pytest.approx(tips[0], rel=1e-6)
    frequencies = [each.modes(2, about=each.equilibrium()).frequency for each in (scene, other)]
    np.testing.assert_allclose(frequencies[1], frequencies[0], rtol=1e-5)


def rod(stiffness: float) -> Scene:
    """Return a cantilever of this EI, N m², under a force at its tip that bends it by 1e-3 of its length."""
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("rope", start=(0, 0, 0), end=(LENGTH, 0, 0), elements=4, element="cable8p",
                section=Circle(radius=0.01), strain="engineering",
                material=Material(youngs_modulus=stiffness / (np.pi * 0.01**4 / 4), poisson_ratio=0.3, density=1000))
    scene.clamp("rope", s=0.0)
    scene.force("rope", s=LENGTH, value=(0, 3e-3 * (BENT + WIRES) / LENGTH**2, 0))
    return scene


def test_section_forces_have_the_moment_between_wires():
    """Moment and shear force of a cantilever at rest, whose wires slide at its clamp and stick at its tip."""
    scene = rod(WIRES)
    force = 3e-3 * (BENT + WIRES) / LENGTH**2
    scene.wire_friction("rope", stiffness=BENT, moment=1e3, name="wires")
    at = scene.equilibrium().section_forces("rope", method="constitutive", s=[0.3, 1.1, 1.7])
    np.testing.assert_allclose(at["moment"].values[:, 2], force * (LENGTH - np.array([0.3, 1.1, 1.7])), rtol=1e-3)
    np.testing.assert_allclose(at["force"].values[:, 1], force, rtol=1e-3)


def test_rest_from_a_run_remembers_nothing_and_a_run_from_rest_does():
    """The moment at the start of a run is that of rest."""
    scene = swinging("cable8p")
    rest = scene.equilibrium()
    run = scene.run(0.1, output_step=0.05, tol=1e-5, initial=rest)
    np.testing.assert_allclose(run["wires.moment"][0], rest["wires.moment"], atol=1e-12)
    assert np.abs(run["rope.nodal_vectors"] - rest["rope.nodal_vectors"]).max() < 1e-5


@quiet
@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit"])
def test_runs_with_friction_resume_bit_for_bit(integrator, tmp_path):
    """Curvature, its elastic part and the tangent of each point are in the checkpoint."""
    check_file_and_resume(swinging(), tmp_path, 12, duration=0.4, output_step=0.02, tol=1e-3, integrator=integrator)


def test_the_linear_model_has_no_slider():
    with refused('wire_friction "wires": integrator "linear" does not support friction between wires; '
                 "leave it out, or take another integrator"):
        swinging("cable8p").run(0.1, output_step=0.05, integrator="linear")


def test_a_turned_rope_has_turned_moments():
    """A scene that is turned about y by a quarter: the elastic part of the curvature turns with the tangent."""
    how = {"output_step": 0.1, "step": 1e-3, "integrator": "genalpha"}
    run, scene = swinging().run(0.4, **how), Scene()
    scene.cable("rope", start=(0, 0, 0), end=(0, 0, -2), elements=8, element="cable12", section=Circle(radius=0.01),
                material=Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1000))
    scene.clamp("rope", s=0.0)
    scene.wire_friction("rope", stiffness=1.0, moment=0.05, name="wires")
    found = scene.run(0.4, **how)["wires.moment"]
    turned = np.stack([-found[..., 2], found[..., 1], found[..., 0]], axis=-1)
    assert np.abs(turned - run["wires.moment"]).max() < 1e-6 * 0.05


def test_cables_whose_wires_are_not_straight_are_refused():
    """The moment counts from the straight cable."""
    scene = Scene()
    scene.cable("arch", points=[(0, 0, 0), (0.5, 0.1, 0), (1, 0, 0)], elements=4, element="cable12",
                section=Circle(radius=0.01), material=Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000))
    with refused('wire_friction "a": cable "arch" is curved where it is free of stress; draw it straight, or give it '
                 'rest="straight"'):
        scene.wire_friction("arch", stiffness=1.0, moment=0.1, name="a")
