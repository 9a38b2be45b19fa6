"""External work: the time integral of force times rate, for every drive, frame, joint and integrator.

energy.external is compared with the balance of all other energies, with the integral of reported forces times rates
(Simpson's rule over a fine output), and between integrators.
"""

import warnings

import numpy as np
import pytest
from funicular import Friction, FunicularWarning, Harmonic, Material, Ramp, Rectangle, Scene, SceneError, TableSignal
from funicular.base.rotations import rotate
from funicular.scene.file import loads
from scipy.integrate import simpson
from shared_scenes import cable_scene

SECTION = Rectangle(height=0.02, width=0.02)
SOFT = Material(youngs_modulus=2e7, poisson_ratio=0.0, density=2000, damping_time=2e-3)
TIME = 0.1
OUTPUTS = 400
SWING = TableSignal(time=(0, 0.03, 0.06, 0.1, 0.2), value=(0, 0.05, 0.15, 0.2, 0.3))
RISE = Ramp(start=0.0, end=TIME, after=0.2)
WITHIN = Ramp(start=0.0, end=TIME, before=0.6, after=0.95)
OVER_A_NODE = Ramp(start=0.0, end=TIME, before=0.6, after=1.2)
INTEGRATORS = ("genalpha", "radau", "explicit")
AXIS = {"axis": (0, 0, 1)}


def hung(element="cable12", pinned=(0.0, 3.0)) -> Scene:
    return cable_scene("rope", length=3, pins=pinned, elements=6, element=element, section=SECTION, material=SOFT)


def driven_slide(frame="point", roll="free", element="cable12", friction=None, **drive) -> Scene:
    """Return a body below the rope, off its centre of mass, with a moment."""
    scene = hung(element)
    side = 0.0 if element.endswith("p") else 0.02
    scene.rigid_body("A", mass=2.0, inertia=(0.02, 0.03, 0.04), position=(0.6, -0.3, side))
    scene.slide("A", along="rope", s=0.6, at=(0, 0.3, -side), frame=frame, roll=roll, name="drive", friction=friction,
                **(drive or {"drive": WITHIN}))
    scene.moment("A", value=(0, 0, 15.0), name="load")
    return scene


def driven_cable() -> Scene:
    """Return a cable that hangs from the slide by its end."""
    scene = hung()
    scene.cable("link", start=(0.6, 0, 0), end=(0.6, -1, 0), elements=2, element="cable12", section=SECTION,
                material=SOFT, up=(1, 0, 0))
    scene.slide(("link", 0.0), along="rope", s=0.6, name="drive", drive=WITHIN)
    return scene


def driven_joint(kind: str, on="ground", planar=False, **given) -> Scene:
    scene = hung("cable8p" if planar else "beam24", (0.0,))
    scene.rigid_body("A", mass=2.0, inertia=(0.02, 0.03, 0.04), position=(1.5, -0.3, 0))
    a = {"ground": (1.5, 0, 0), "rope": ("rope", 1.5)}[on]
    if on == "ground":
        scene.pin("rope", s=3.0)
    scene.joint(kind, a, ("A", (0, 0.2 if kind == "distance" else 0.3, 0)), name="drive", **given)
    return scene


def moved(**given) -> Scene:
    scene = hung(pinned=(0.0,))
    scene.motion("rope", s=3.0, **given)
    return scene


CASES = {
    "slide-point": lambda: driven_slide(),
    "slide-over-a-node": lambda: driven_slide(drive=OVER_A_NODE),
    "slide-tangent-over-a-node": lambda: driven_slide("tangent", drive=OVER_A_NODE),
    "slide-velocity": lambda: driven_slide(velocity=Ramp(start=0.0, end=TIME, after=3.0)),
    "slide-tangent": lambda: driven_slide("tangent"),
    "slide-tangent-fixed": lambda: driven_slide("tangent", "fixed"),
    "slide-tangent-beam24": lambda: driven_slide("tangent", element="beam24"),
    "slide-section": lambda: driven_slide("section", element="beam24"),
    "slide-tangent-planar": lambda: driven_slide("tangent", element="cable8p"),
    "slide-section-planar": lambda: driven_slide("section", element="beam12p"),
    "slide-tangent-quintic": lambda: driven_slide("tangent", element="cable18"),
    "slide-friction": lambda: driven_slide(friction=Friction(coefficient=0.3, viscous=2.0)),
    "slide-tangent-sticking": lambda: driven_slide("tangent", friction=Friction(coefficient=0.3, model="stick")),
    "slide-of-a-cable": driven_cable,
    "revolute": lambda: driven_joint("revolute", angle=SWING, **AXIS),
    "revolute-velocity": lambda: driven_joint("revolute", velocity=Harmonic(amplitude=3.0, frequency=5.0), **AXIS),
    "revolute-rope": lambda: driven_joint("revolute", "rope", angle=RISE, **AXIS),
    "prismatic": lambda: driven_joint("prismatic", distance=RISE, axis=(1, 0.5, 0)),
    "prismatic-rope": lambda: driven_joint("prismatic", "rope", distance=RISE, axis=(1, 0.5, 0)),
    "cylindrical-angle": lambda: driven_joint("cylindrical", angle=RISE, axis=(1, 0, 0)),
    "distance": lambda: driven_joint("distance", distance=Ramp(start=0, end=TIME, before=0.1, after=0.3)),
    "distance-rope": lambda: driven_joint("distance", "rope", distance=Ramp(start=0, end=TIME, before=0.1, after=0.3)),
    "revolute-planar": lambda: driven_joint("revolute", planar=True, angle=RISE, **AXIS),
    "prismatic-planar": lambda: driven_joint("prismatic", planar=True, distance=RISE, axis=(1, 0.5, 0)),
    "motion": lambda: moved(displacement=(0, RISE, Ramp(start=0.03, end=0.07, after=0.1))),
    "motion-one-direction": lambda: moved(displacement=(None, RISE, "free")),
    "motion-rotation": lambda: moved(rotation=((0, 0, 1), RISE)),
    "motion-both": lambda: moved(displacement=(0, RISE, 0), rotation=((0, 0, 1), RISE)),
}
WORK, BALANCE = 1e-5, {"genalpha": 2e-5, "radau": 1e-5, "explicit": 1e-5}
QUICK = ("slide-tangent", "slide-section", "slide-tangent-sticking", "revolute-rope", "motion-one-direction")
"""The others are slow."""


def work_of_outputs(case: str, run) -> float | None:
    """Return J by the reported forces and rates; None if they are impulsive or not all reported."""
    t = run.time
    if case.endswith("over-a-node"):  # forces jump; where a frame turns otherwise, an impulse
        return None
    if case.startswith("slide"):
        power = run["drive.traction"] * run["drive.s_rate"]
        if "A.position" in run:
            power += 15.0 * rotate(run["A.orientation"], run["A.angular_velocity"])[:, 2]
    elif case in ("motion", "motion-one-direction"):
        power = np.sum(run["rope@3.force"] * run["rope.nodal_velocity"][:, -1, 0], axis=1)
    elif "rope" not in case and not case.startswith("motion"):  # of a joint to the ground, at the body's end
        end = rotate(run["A.orientation"], (0, 0.2 if case.startswith("distance") else 0.3, 0))
        turn = rotate(run["A.orientation"], run["A.angular_velocity"])
        power = np.sum(run["drive.force"] * (run["A.velocity"] + np.cross(turn, end)), axis=1)
        power += np.sum(run["drive.moment"] * turn, axis=1)
    else:
        return None
    return float(simpson(power, x=t))


@pytest.mark.filterwarnings("ignore:initial velocities broke a joint", "ignore:motion on")
@pytest.mark.parametrize("case", [pytest.param(name, marks=() if name in QUICK else pytest.mark.slow)
                                  for name in CASES])
def test_external_work_is_force_times_rate_with_every_integrator(case):
    """To 1e-5 of the exchanged energy at tol = 1e-6; with explicit steps where no cross-section vibrates.

    The balance of energies also contains the error of the motion: genalpha's velocities are of order 2.
    """
    scene, works = CASES[case](), []
    stiff = any(cable.element.startswith("beam") for cable in scene.cables.values())
    for integrator in INTEGRATORS[:2] if stiff else INTEGRATORS:
        run = scene.run(TIME, integrator=integrator, tol=1e-6, output_step=TIME / OUTPUTS, progress=False)
        balance, works = run.energy_balance(), [*works, run["energy.external"][-1]]
        by_outputs = work_of_outputs(case, run)
        print(case, integrator, works[-1], np.abs(balance.relative).max(), by_outputs, run.report["steps"])
        assert np.abs(balance.relative).max() < BALANCE[integrator]
        if by_outputs is not None:
            assert works[-1] == pytest.approx(by_outputs, abs=WORK * balance.exchanged)
    assert works == pytest.approx([works[-1]] * len(works), abs=WORK * balance.exchanged)
    assert abs(works[0]) > 1e-3 * balance.exchanged


def test_a_rider_tied_to_the_tangent_feels_force_equal_to_mass_times_acceleration():
    """The moment of the frame adds a force along the cable."""
    run = CASES["slide-tangent"]().run(TIME, integrator="radau", tol=1e-6, progress=False)
    force = 2.0 * (run["A.acceleration"] + np.array([0, 9.81, 0]))
    np.testing.assert_allclose(run["drive.force"], force, atol=1e-9 * np.abs(force).max())


@pytest.mark.parametrize("model", ["stick", "regularised"])
def test_friction_of_a_driven_slide_is_its_drives_to_overcome(model):
    """The motion is unchanged; the drive gives N mu more, which is dissipated."""
    drive, mu = {"drive": Ramp(start=0.02, end=TIME, before=0.6, after=0.95)}, 0.3
    bare, rubbed = (driven_slide(friction=friction, **drive).run(TIME, integrator="radau", tol=1e-7,
                                                                output_step=TIME / OUTPUTS, progress=False)
                    for friction in (None, Friction(coefficient=mu, model=model, velocity=1e-6)))
    np.testing.assert_allclose(rubbed["A.position"], bare["A.position"], atol=1e-7)
    lost = rubbed["energy.dissipated"] - bare["energy.dissipated"]
    normal = np.linalg.norm(bare["drive.multiplier"], axis=1)
    assert lost[-1] == pytest.approx(simpson(mu * normal * bare["drive.s_rate"], x=bare.time), rel=2e-3)  # and stretch
    np.testing.assert_allclose(rubbed["energy.external"] - bare["energy.external"], lost, atol=1e-5 * lost[-1])
    moving = bare["drive.s_rate"] > 0.1
    more = rubbed["drive.traction"] - bare["drive.traction"]
    np.testing.assert_allclose(more[moving], (mu * normal)[moving], rtol=0.05)  # per s: the cable is stretched


def test_a_direction_that_a_motion_leaves_free_bears_no_force():
    scene = CASES["motion-one-direction"]()
    run = scene.run(TIME, tol=1e-5, progress=False)
    np.testing.assert_allclose(run["rope@3.force"][:, [0, 2]], 0, atol=1e-12)
    np.testing.assert_allclose(run["rope.nodal_vectors"][:, -1, 0, 1], RISE.value(run.time), atol=1e-12)
    assert np.ptp(run["rope.nodal_vectors"][:, -1, 0, 0]) > 1e-4
    text = scene.to_toml()
    assert '"free"' in text and loads(text, "text").to_toml() == text
    with pytest.raises(SceneError, match="displacement leaves all directions free"):
        moved(displacement=(None, "free", None))


def test_a_motion_that_starts_with_a_jump_of_velocity_is_noted():
    with pytest.warns(FunicularWarning, match=r'motion on "rope" at s = 3 m: displacement y starts at 1 m/s, but its '
                                              r"node at 0 m/s; this jump"):
        run = moved(displacement=(0, TableSignal(time=(0, 1), value=(0, 1), interpolation="linear"), 0)).run(0.01)
    assert any("this jump" in message for message in run.report["messages"])
    run = moved(displacement=(0, RISE, 0)).run(0.01)
    assert run.report["messages"] == []


def jumps(scene: Scene, duration=0.01) -> list[str]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FunicularWarning)
        return scene.run(duration, progress=False).report["messages"]


def test_a_rotation_that_starts_with_a_jump_is_noted():
    turn = TableSignal(time=(0, 1), value=(0, 2), interpolation="linear")
    (message,) = jumps(moved(rotation=((0, 0, 1), turn)))
    assert "rotation starts at 2 rad/s, but its node at 0 rad/s; this jump" in message


def test_a_start_that_is_small_beside_the_motion_is_no_jump():
    """A millionth of the largest rate in the run is no jump; a hundredth is noted."""
    for small, noted in ((1e-6, False), (1e-2, True)):
        signal = TableSignal(time=(0, 0.005, 0.01), value=(0, 0.005 * small, 0.005), interpolation="linear")
        assert any("starts at" in message for message in jumps(moved(displacement=(0, signal, 0)))) == noted


def test_a_motion_at_the_velocity_of_its_cable_is_no_jump():
    signal = TableSignal(time=(0, 1), value=(0, 3), interpolation="linear")
    for speed, noted in ((3.0, False), (2.0, True)):
        scene = Scene(gravity=(0, 0, 0))
        scene.cable("rope", start=(0, 0, 0), end=(3, 0, 0), elements=2, element="cable12", section=SECTION,
                    material=SOFT, velocity=(0, speed, 0))
        scene.motion("rope", s=3.0, displacement=(0, signal, 0))
        assert any("starts at 3 m/s, but its node" in message for message in jumps(scene)) == noted


def test_later_jumps_of_a_motions_rate_are_noted():
    """A piecewise linear motion sends a shock at each sample: the note names the first, and their number."""
    lines = TableSignal(time=(0, 0.002, 0.004, 0.008), value=(0, 0, 0.002, 0.001), interpolation="linear")
    (message,) = jumps(moved(displacement=(0, lines, 0)))
    assert message.startswith('motion on "rope" at s = 3 m: the rate of displacement y jumps by 1 m/s at t = 0.002 s, '
                              "and at 2 later times; each jump sends a shock along the cable")
    assert jumps(moved(displacement=(0, Ramp(start=0.002, end=0.008, after=0.002), 0))) == []
    assert jumps(moved(displacement=(0, lines, 0)), 0.001) == []


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("late", [0.0, 1e-17, 1e-10])
def test_an_event_just_after_a_step_adds_no_work(integrator, late):
    """A body is lifted against gravity and a spring: the work of both, to the error of the rule.

    At the start and the end of a ramp the body is at rest.
    """
    height, reach, time = 0.01, 0.3, 0.02
    scene = Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("A", mass=0.1, inertia=(1e-4, 1e-4, 1e-4), position=(0, 0, 0))
    scene.joint("prismatic", (0, 0, 0), "A", axis=(0, 1, 0), distance=Ramp(start=0, end=time, after=height))
    scene.spring("A", (reach, 0, 0), stiffness=300.0, length=0.1)
    at = time / 3 + late  # at the end of the hundredth of 300 steps, but for rounding
    scene.event(function=lambda now, _: now - at, name="later")
    run = scene.run(time, output_step=time, step=time / 300, integrator=integrator)
    extensions = np.array([reach, np.hypot(reach, height)]) - 0.1
    work = 0.1 * 9.81 * height + 150.0 * (extensions[1]**2 - extensions[0]**2)
    assert run.report["messages"] == []
    assert run["energy.external"][-1] == pytest.approx(work, rel=1e-6)
