"""Cables whose axial force is a table of the strain, as on a test machine: closed forms, every integrator."""

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from funicular.solve.notes.note import LineStiffness
from funicular.solve.notes.supersonic_loads import excess
from interrupted_runs import check_file_and_resume
from scipy.integrate import quad
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq, fsolve

STRAIN, FORCE = (0.0, 0.01, 0.02, 0.05, 0.08), (0.0, 1e3, 3e3, 2e4, 6e4)
ROPE = fu.TensionTable(strain=STRAIN, force=FORCE)
TWO_SLOPES = fu.TensionTable(strain=(0, 0.02, 0.04, 0.06), force=(0, 1e3, 2e3, 1e4))
BAR = fu.TensionTable(strain=(-0.05, -0.02, 0, 0.02, 0.05), force=(-4e3, -2e3, 0, 1e3, 5e3))
LAW = PchipInterpolator(STRAIN, FORCE)
AREA, DENSITY, LENGTH = 1e-3, 1000.0, 2.0
METHODS = {"genalpha": {"tol": 1e-7}, "radau": {"tol": 1e-8}, "explicit": {"tol": 1e-7}, "energy": {"step": 2e-4}}


def section(table=ROPE, second_moment=0.0):
    return fu.GeneralSection(area=AREA, second_moment_about_z=second_moment, tension_table=table)


def material(**given):
    return fu.Material(**{"youngs_modulus": 2e8, "poisson_ratio": 0.3, "density": DENSITY, **given})


def rope(table=ROPE, end=(LENGTH, 0, 0), element="cable8p", gravity=(0, 0, 0), **given):
    """Return a rope that a pin holds at its start."""
    scene = fu.Scene(gravity=gravity)
    whole = {} if "pieces" in given else {"section": section(table), "material": material(), "elements": 8}
    scene.cable("rope", start=(0, 0, 0), end=end, element=element, membrane="tabulated", rest="straight",
                **{**whole, **given})
    scene.pin("rope", s=0)
    return scene


def strain_of(force, law=LAW):
    """Return the strain at which a law has a force."""
    return brentq(lambda strain: law(strain) - force, 0, law.x[-1], xtol=1e-16, rtol=1e-15)


@pytest.mark.parametrize("element", ["cable8p", "cable12"])
@pytest.mark.parametrize("force", [300.0, 2e3, 4e4])
def test_a_pulled_rope_has_the_strain_of_its_table(element, force, validated):
    scene = rope(element=element)
    scene.force("rope", s=LENGTH, value=(force, 0, 0))
    rest = scene.equilibrium()
    for method in ("balance", "constitutive"):
        assert rest.section_forces("rope", method=method).tension.values == pytest.approx(force, rel=1e-9)
    validated("Statics", f"rope with a table of its force, {force:g} N", "strain", strain_of(force),
              rest["rope.position"][-1, 0] / LENGTH - 1, bound=1e-9, variant=element, unit="1", mesh="8 elements",
              source="monotone cubic interpolation (SciPy)")


def test_beyond_the_table_the_force_is_straight():
    slope, last = LAW.derivative()(STRAIN[-1]), 7e4
    scene = rope()
    scene.force("rope", s=LENGTH, value=(last, 0, 0))
    expected = STRAIN[-1] + (last - FORCE[-1]) / slope
    assert scene.equilibrium()["rope.position"][-1, 0] / LENGTH - 1 == pytest.approx(expected, rel=1e-9)


def test_a_table_from_zero_only_pulls():
    scene = rope(element="cable8p", end=(LENGTH * 0.9, 0, 0), rest_length=LENGTH, gravity=(0, -9.81, 0))
    scene.pin("rope", s=LENGTH)
    run = scene.run(duration=1e-9, step=1e-9, integrator="genalpha", output_step=1e-9)
    left, transition = 1e-4 * FORCE[1] / STRAIN[1], 1e-6
    expected = left * 0.1**2 / 2 + 0.1 * (float(LAW.derivative()(0)) - left) * transition / 2
    assert run["energy.elastic"][0] == pytest.approx(LENGTH * expected, rel=1e-4)
    assert scene.cables["rope"].gives_way
    assert not rope(BAR).cables["rope"].gives_way


def test_a_table_of_both_signs_pushes():
    scene = rope(end=(0.97 * LENGTH, 0, 0), rest_length=LENGTH, section=section(BAR, second_moment=1e-4))
    scene.pin("rope", s=LENGTH)
    law = PchipInterpolator(BAR.strain, BAR.force)
    assert scene.equilibrium()["rope@0.force"][0] == pytest.approx(-law(-0.03), rel=1e-9)


def test_a_rope_of_two_slopes_hangs_as_by_quadrature(validated):
    """A vertical rope under its weight and a load, and a line between two points."""
    law = PchipInterpolator(TWO_SLOPES.strain, TWO_SLOPES.force)
    g, length, load = 10.0, 100.0, 1.8e3
    weight = AREA * DENSITY * g
    scene = rope(TWO_SLOPES, end=(0, -length, 0), gravity=(0, -g, 0), elements=40)
    scene.force("rope", s=length, value=(0, -load, 0))
    found = -scene.equilibrium()["rope.position"][-1, 1] / length - 1
    kinks = [(force - load) / weight for force in TWO_SLOPES.force if 0 < force - load < weight * length]
    expected = quad(lambda s: strain_of(load + weight * s, law), 0, length, points=kinks, epsabs=1e-13)[0] / length
    validated("Statics", "vertical rope whose force has two slopes", "strain of the whole", expected, found,
              bound=1e-8, unit="1", source="quadrature of the table", mesh="40 elements")


def test_a_line_of_two_slopes_spans_as_by_quadrature(validated):
    law = PchipInterpolator(TWO_SLOPES.strain, TWO_SLOPES.force)
    g, span = 10.0, 100.0
    weight = AREA * DENSITY * g
    scene = rope(TWO_SLOPES, end=(span, 0, 0), gravity=(0, -g, 0), elements=64, rest_length=99.0)
    scene.pin("rope", s=99.0)
    found = abs(scene.equilibrium()["rope@0.force"][0])

    def reach(H):
        def along(s):
            T = np.hypot(H, weight * s)
            return H / T * (1 + strain_of(T, law))
        kinks = [np.sqrt(force**2 - H**2) / weight for force in TWO_SLOPES.force
                 if 0 < force**2 - H**2 < (weight * 49.5) ** 2]
        return 2 * quad(along, 0, 49.5, points=kinks or None, epsabs=1e-11)[0] - span

    validated("Statics", "line whose force has two slopes, 99 m over 100 m", "horizontal force",
              float(fsolve(lambda H: reach(H[0]), [2e3], xtol=1e-13)[0]), found, bound=1e-8, unit="N",
              source="elastic catenary by quadrature of the table", mesh="64 elements")


def test_frequencies_about_a_stretched_state(validated):
    """Along: the slope of the force; across: the force itself."""
    strain, tension = 0.03, float(LAW(0.03))
    scene = rope(end=(LENGTH * (1 + strain), 0, 0), rest_length=LENGTH, elements=24)
    scene.pin("rope", s=LENGTH)
    found = np.asarray(scene.modes(30, about=scene.equilibrium()).frequency)
    mass = AREA * DENSITY
    for name, square in (("along", float(LAW.derivative()(strain)) / mass), ("across", tension / mass / (1 + strain))):
        expected = np.sqrt(square) / (2 * LENGTH)
        validated("Modes", "rope with a table of its force, stretched by 3 %", f"frequency {name}", expected,
                  found[np.argmin(np.abs(found - expected))], bound=1e-6, unit="Hz", mesh="24 elements",
                  source="waves of the speed √(N'/ρA), √(N/ρA(1 + strain))")


def swinging(**given):
    """Return a rope that swings from the horizontal with a weight at its end, becomes taut and slack."""
    scene = rope(gravity=(0, -9.81, 0), elements=4, **given)
    scene.rigid_body("B", mass=200.0, inertia=(1, 1, 1), position=(LENGTH, 0, 0))
    scene.joint("spherical" if given.get("element") == "cable12" else "revolute", ("rope", LENGTH), "B", name="J",
                **({} if given.get("element") == "cable12" else {"axis": (0, 0, 1)}))
    return scene


@pytest.mark.parametrize("method", METHODS)
def test_every_integrator_and_resume(method, tmp_path):
    settings = {"integrator": method, "duration": 0.3, "output_step": 0.02, **METHODS[method]}
    run = check_file_and_resume(swinging(), tmp_path, 40, **settings)
    total = run["energy.kinetic"] + run["energy.elastic"] + run["energy.potential"]
    assert run["energy.elastic"].max() > 10
    assert np.ptp(total) < (1e-9 if method == "energy" else 1e-3) * np.ptp(run["energy.potential"])
    reference = swinging().run(integrator="radau", duration=0.3, output_step=0.02, tol=1e-9)
    assert np.abs(run["B.position"] - reference["B.position"]).max() < 1e-3


def test_pieces_in_series():
    pieces = [fu.Piece(length=length, section=section(table), material=material(), elements=4)
              for length, table in ((1.0, ROPE), (2.0, TWO_SLOPES))]
    scene = rope(end=(3, 0, 0), pieces=pieces)
    scene.force("rope", s=3.0, value=(2.5e3, 0, 0))
    strains = strain_of(2.5e3), strain_of(2.5e3, PchipInterpolator(TWO_SLOPES.strain, TWO_SLOPES.force))
    assert scene.equilibrium()["rope.position"][-1, 0] - 3 == pytest.approx(strains[0] + 2 * strains[1], rel=1e-9)


def test_warm_ropes_and_signals_of_the_length():
    warm = rope(temperature=100.0, material=material(thermal_expansion=1e-4))
    warm.force("rope", s=LENGTH, value=(2e3, 0, 0))
    assert warm.equilibrium()["rope.position"][-1, 0] == pytest.approx(LENGTH * 1.01 * (1 + strain_of(2e3)), rel=1e-10)
    taken_in = fu.Ramp(start=0.0, end=0.1, before=LENGTH, after=0.97 * LENGTH)
    scene = rope(end=(LENGTH, 0, 0), rest_length=taken_in, material=material(mass_damping=50.0))
    scene.pin("rope", s=LENGTH)
    run = scene.run(duration=0.5, output_step=0.05, integrator="energy", step=1e-3)
    energy = run["energy.kinetic"] + run["energy.elastic"]
    work = run["energy.external"] - run["energy.dissipated"]
    assert energy - energy[0] == pytest.approx(work - work[0], abs=1e-8 * energy.max())
    assert run.section_forces("rope").tension.values[-1] == pytest.approx(float(LAW(1 / 0.97 - 1)), rel=1e-3)


def test_the_length_is_adjusted_to_a_tension():
    scene = rope(end=(LENGTH, 0, 0), rest_length=0.99 * LENGTH)
    scene.pin("rope", s=0.99 * LENGTH)
    rest = scene.equilibrium(adjust=["rope.rest_length"], to={"rope@0.force.x": -5e3})
    assert rest.adjusted["rope.rest_length"] == pytest.approx(LENGTH / (1 + strain_of(5e3)), rel=1e-8)


@pytest.mark.parametrize(("strain", "force", "complaint"), [
    ([0, 0.1, 0.2], [0, 1, 1], "force must increase with strain, got 1 N after 1 N"),
    ([0, 0.1, 0.1], [0, 1, 2], "strain must increase, got 0.1 after 0.1"),
    ([0.1, 0.2], [0, 1], r"strain must contain 0 and end above it, got \(0.1, 0.2\)"),
    ([-0.2, 0], [-1, 0], r"strain must contain 0 and end above it, got \(-0.2, 0\)"),
    ([0, 0.1], [1, 2], "force must be 0 at the strain 0, got 1 N; count strain from the length without force"),
    ([0, 0.1], [0], "must be a list of 2 numbers or more"),
    (np.linspace(0, 1, 21), np.linspace(0, 1, 21), "has 21 points, at most 20 are possible"),
])
def test_tables_that_are_no_law(strain, force, complaint):
    with pytest.raises(fu.SceneError, match=complaint):
        fu.TensionTable(strain=strain, force=force)


def test_laws_and_sections_that_do_not_suit():
    with refused('cable "rope": law "engineering_exact_tabulated" needs section.tension_table; give the section a '
                 "fu.TensionTable(strain=..., force=...)"):
        rope(section=fu.Circle(radius=0.01))
    given = {"start": (0, 0, 0), "end": (1, 0, 0), "elements": 2, "section": section(), "material": material()}
    with refused('cable "rope": section.tension_table is given, but the law "green_exact" of cable12 takes none; leave '
                 'it out, or take element="cable12" or "cable8p" with membrane="tabulated"'):
        fu.Scene().cable("rope", element="cable12", **given)
    with pytest.raises(fu.SceneError, match='law "engineering_exact_tabulated" is not possible for cable18'):
        fu.Scene().cable("rope", element="cable18", membrane="tabulated", **given)


def test_wave_speeds_are_those_of_the_table():
    """A point outruns the transverse waves, √(N/ρA(1 + strain)), whatever Young's modulus is."""
    scene = rope(end=(LENGTH * 1.03, 0, 0), rest_length=LENGTH, material=material(youngs_modulus=1e9))
    at_rest = np.sqrt(float(LAW(0.03)) / 1.03 / (AREA * DENSITY))
    for speed in (0.999 * at_rest, 1.001 * at_rest):
        assert (excess(scene.cables["rope"], 1.03, speed) > 0) == (speed > at_rest)
    assert LineStiffness.of(scene.cables["rope"], 3).EA == pytest.approx(FORCE[-1] / STRAIN[-1])
