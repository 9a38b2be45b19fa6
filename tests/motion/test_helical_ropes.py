"""Ropes of helical wires, whose tension makes a torque and whose twist a tension: closed forms of beam24."""

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from interrupted_runs import check_file_and_resume

AREA, TURNING = 1e-4, 4e-10
EA, GJ = 1e11 * AREA, 4e10 * TURNING
PER_TENSION = 7e-4
COUPLING = EA * PER_TENSION
LENGTH = 2.0
AXIS = np.array([2, 3, 6]) / 7


def section(torque_per_tension=PER_TENSION):
    """Return a section of 16 N m² in torsion and 10 MN, whose torque is 0.7 mm times the tension."""
    return fu.GeneralSection(area=AREA, second_moment_about_z=2e-10, torsion_constant=TURNING, shear_factors=(0.9, 0.9),
                             torque_per_tension=torque_per_tension)


def material(density=8000.0, **given):
    """Return a material of these moduli."""
    return fu.Material(**{"youngs_modulus": 1e11, "shear_modulus": 4e10, "density": density, **given})


def rope(axis=(1, 0, 0), density=8000.0, **given):
    """Return a rope that a clamp holds at its start."""
    scene = fu.Scene(gravity=(0, 0, 0))
    whole = {} if "pieces" in given else {"section": section(), "material": material(density), "elements": 4}
    scene.cable("rope", start=(0, 0, 0), end=LENGTH * np.array(axis), element="beam24", law="structural",
                up=(-6, 0, 2) if axis is AXIS else (0, 1, 0), rest="straight", **{**whole, **given})
    scene.clamp("rope", s=0)
    return scene


def turn_of_end(rest, axis):
    """Return the angle by which the section at the end has turned about the axis, rad."""
    y, z = (rest["rope.nodal_vectors"][-1, k] for k in (2, 3))
    up = np.array((-6, 0, 2) if axis is AXIS else (0, 1, 0), dtype=float)
    up -= up.dot(axis) * np.array(axis)
    return np.arctan2(np.cross(up, y).dot(axis), up.dot(y)), abs(np.dot(y, z))


def test_held_ends_bear_the_torque_of_the_strain(validated):
    strain = 1e-3
    scene = rope(axis=AXIS, rest_length=LENGTH / (1 + strain))
    scene.clamp("rope", s=LENGTH / (1 + strain))
    rest = scene.equilibrium()
    for method in ("balance", "constitutive"):
        found = rest.section_forces("rope", method=method)
        assert found.tension.values == pytest.approx(EA * strain, rel=1e-9)
        assert found.torque.values == pytest.approx(COUPLING * strain, rel=1e-9)
    assert rest["rope@0.moment"] == pytest.approx(-COUPLING * strain * AXIS, rel=1e-9)
    validated("Statics", "rope of helical wires, ends held", "torque", COUPLING * strain, found.torque.values.mean(),
              unit="N m", bound=1e-9, source="EA strain × torque per tension", mesh="4 elements")


def test_a_free_end_turns_and_gives_way(validated):
    force = 2e3
    scene = rope(axis=AXIS)
    scene.force("rope", s=LENGTH, value=force * AXIS)
    rest = scene.equilibrium()
    strain = force / (EA - COUPLING**2 / GJ)
    turn = -COUPLING / GJ * strain * LENGTH
    found, skew = turn_of_end(rest, AXIS)
    assert skew < 1e-12
    validated("Statics", "rope of helical wires, end free to turn", "rotation of the end", turn, found, unit="rad",
              bound=1e-9, source="−K/GJ strain × length", mesh="4 elements")
    stretch = np.linalg.norm(rest["rope.position"][-1]) / LENGTH - 1
    validated("Statics", "rope of helical wires, end free to turn", "strain", strain, stretch, unit="1", bound=1e-9,
              source="force / (EA − K²/GJ)", mesh="4 elements")
    assert rest.section_forces("rope").torque.values == pytest.approx(0.0, abs=1e-9 * COUPLING)


def test_the_torque_per_tension_is_adjusted_to_a_torque():
    strain = 1e-3
    scene = rope(rest_length=LENGTH / (1 + strain))
    scene.clamp("rope", s=LENGTH / (1 + strain))
    rest = scene.equilibrium(adjust=["rope.section.torque_per_tension"], to={"rope@0.moment.x": -5.0})
    assert rest.adjusted["rope.section.torque_per_tension"] == pytest.approx(5.0 / (EA * strain), rel=1e-6)


def test_a_torque_alone_shortens_or_lengthens_the_rope():
    for couple in (0.2, -0.2):
        scene = rope()
        scene.moment("rope", s=LENGTH, value=(couple, 0, 0))
        rest = scene.equilibrium()
        twist = couple / (GJ - COUPLING**2 / EA)
        assert turn_of_end(rest, (1, 0, 0))[0] == pytest.approx(twist * LENGTH, rel=1e-9)
        assert rest["rope.position"][-1, 0] / LENGTH - 1 == pytest.approx(-PER_TENSION * twist, rel=1e-7)


def test_a_joint_of_a_right_and_a_left_lay_turns_as_a_swivel(validated):
    """The compliances of both pieces add; torques cancel."""
    pieces = [fu.Piece(length=LENGTH / 2, section=section(sign * PER_TENSION), material=material(), elements=3)
              for sign in (1, -1)]
    strain = 1e-4
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("rope", start=(0, 0, 0), end=(LENGTH * (1 + strain), 0, 0), element="beam24", law="structural",
                up=(0, 1, 0), rest="straight", pieces=pieces)
    for s in (0, LENGTH):
        scene.clamp("rope", s=s)
    rest = scene.equilibrium()
    forces = rest.section_forces("rope")
    assert forces.tension.values == pytest.approx(strain * (EA - COUPLING**2 / GJ), rel=1e-8)
    assert np.abs(forces.torque.values).max() < 1e-8 * COUPLING * strain
    y = rest["rope.nodal_vectors"][3, 2]
    validated("Statics", "rope of a right-hand and a left-hand lay", "rotation of the joint",
              -COUPLING / GJ * strain * LENGTH / 2, np.arctan2(y[2], y[1]), unit="rad", bound=1e-8,
              source="compliances in series", mesh="6 elements")


THICK = fu.Circle(radius=0.1, torque_per_tension=0.02)
"""Of a rope so thick that its frequencies lie near those of a body on it."""
MASS, MOMENT, SPAN = 1e5, 200.0, 0.3


def body_on_a_rope(gravity=0.0):
    """Return a rope that stretches and twists, with a body on its end beside which its mass is nothing, and the 2 x 2
    stiffness.
    """
    scene, soft = fu.Scene(gravity=(gravity, 0, 0)), fu.Material(youngs_modulus=1e9, shear_modulus=4e8, density=1000.0)
    scene.cable("rope", start=(0, 0, 0), end=(SPAN, 0, 0), elements=1, element="beam24", law="structural",
                section=THICK, material=soft)
    scene.clamp("rope", s=0)
    scene.rigid_body("B", mass=MASS, inertia=(MOMENT,) * 3, position=(SPAN, 0, 0))
    scene.joint("weld", ("rope", SPAN), "B", name="end")
    EA, GJ = 1e9 * THICK.area, 4e8 * THICK.torsion_constant
    return scene, np.array([[EA, EA * 0.02], [EA * 0.02, GJ]]) / SPAN


def modes_of(K, added=(0.0, 0.0)):
    """Return angular frequencies and shapes of both masses on the stiffness; added: masses of the rope."""
    scale = np.diag(1 / np.sqrt(np.add([MASS, MOMENT], added)))
    squares, shapes = np.linalg.eigh(scale @ K @ scale)
    return np.sqrt(squares), scale @ shapes


def test_frequencies_of_stretch_and_twist(validated):
    scene, K = body_on_a_rope()
    third = 1000.0 * SPAN / 3  # of the rope, as Rayleigh adds it
    expected = modes_of(K, (third * THICK.area, third * THICK.torsion_constant))[0] / (2 * np.pi)
    found = np.asarray(scene.modes(6).frequency)
    for name, value in zip(("lower", "higher"), expected, strict=True):
        validated("Modes", "body on a rope of helical wires", f"{name} frequency", value,
                  found[np.argmin(np.abs(found - value))], unit="Hz", bound=1e-9,
                  source="mass and moment of inertia on [[EA, K], [K, GJ]]/L", mesh="1 element")


def test_coupled_waves_have_frequencies_that_converge():
    """Speeds are the square roots of the eigenvalues of stiffness by mass and moment of inertia a length."""
    rho, polar = 8000.0, 4e-10
    scale = np.diag(1 / np.sqrt([rho * AREA, rho * polar]))
    speeds = np.sqrt(np.linalg.eigvalsh(scale @ np.array([[EA, COUPLING], [COUPLING, GJ]]) @ scale))
    expected = speeds[0] / (4 * LENGTH)
    errors = []
    for elements in (8, 16):
        found = np.asarray(rope(elements=elements).modes(40).frequency)
        errors.append(np.abs(found / expected - 1).min())
    assert errors[1] < 6e-4
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.1)


@pytest.mark.parametrize(("integrator", "given"), [("genalpha", {"tol": 1e-7}), ("radau", {"tol": 1e-8}),
                                                   ("explicit", {"tol": 1e-8})])
def test_a_falling_body_turns(integrator, given, tmp_path):
    """Both modes under a weight from t = 0."""
    g = 0.1
    scene, K = body_on_a_rope(gravity=g)
    omega, shapes = modes_of(K)
    period = 2 * np.pi / omega[0]
    run = check_file_and_resume(scene, tmp_path, 20, integrator=integrator, **given, duration=period,
                                output_step=period / 40)
    push = shapes.T @ [MASS * g, 0.0]
    moved = (push / omega**2 * (1 - np.cos(np.outer(run.time, omega)))) @ shapes.T
    turned = 2 * run["B.orientation"][:, 1]
    assert run["B.position"][:, 0] - SPAN == pytest.approx(moved[:, 0], abs=1e-3 * np.abs(moved[:, 0]).max())
    assert turned == pytest.approx(moved[:, 1], abs=1e-3 * np.abs(moved[:, 1]).max())
    energy = run["energy.kinetic"] + run["energy.elastic"] + run["energy.potential"]
    assert np.ptp(energy) < 1e-4 * np.max(run["energy.elastic"])


def test_refusals():
    with refused('cable "rope": section.torque_per_tension must be smaller than √(GJ/EA) = 0.00126491 m, so that '
                 "strain and twist store energy, got 0.0013 m"):
        rope(section=section(0.0013))
    for entries, law in (({"element": "cable12"}, "green_exact"), ({"element": "beam12p"}, "structural"),
                         ({"element": "beam24"}, "poisson_split"), ({"element": "beam24"}, "continuum")):
        with refused(f'cable "rope": section.torque_per_tension is given, but the law "{law}" of {entries["element"]} '
                     'has no torque by tension; leave it out, or take element="beam24" with law="structural"'):
            fu.Scene().cable("rope", start=(0, 0, 0), end=(1, 0, 0), elements=1, law=law, material=material(),
                             section=fu.Circle(radius=0.01, torque_per_tension=1e-4), **entries)
