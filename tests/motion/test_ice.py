"""Ice on cables: closed forms of its mass, weight and diameter, the energy that comes and goes with it, refusals."""

from math import asinh, pi, sqrt

import funicular as fu
import numpy as np
import pytest
from expectations import energy_error, refused
from interrupted_runs import check_file_and_resume
from scipy.optimize import brentq

G, D, E, RHO = 9.81, 0.02, 1e10, 3000.0
MASS = RHO * pi * D**2 / 4
WIRE = {"section": fu.Circle(radius=D / 2), "material": fu.Material(youngs_modulus=E, poisson_ratio=0, density=RHO)}
ELEMENTS = "cable8p", "cable12", "cable18", "beam24", "beam12p"
INTEGRATORS = "genalpha", "radau", "explicit"
T = 0.02


def ice_mass(t: float, density: float = 900.0, d: float = D) -> float:
    """Return the mass of a length."""
    return density * pi * t * (d + t)


def taut(element="cable8p", elements=20, gravity=(0.0, 0.0, 0.0)) -> fu.Scene:
    """Return a string of 10 m between two pins, 10 kN in it."""
    scene = fu.Scene(gravity=gravity)
    up = {"up": (0, 1, 0)} if element.startswith("beam") else {"up": (0, 0, 1)} if not element.endswith("p") else {}
    strain = 1e4 / (E * pi * D**2 / 4)
    scene.cable("w", start=(0, 0, 0), end=(10 * (1 + strain), 0, 0), rest="straight", rest_length=10, element=element,
                elements=elements, **up, **WIRE)
    scene.pin("w", s=0)
    scene.pin("w", s=10)
    return scene


@pytest.mark.parametrize("element", ELEMENTS)
def test_frequencies_of_a_taut_string(element):
    """They fall by the root of the ratio of the masses, but for the rotary inertia of beams, which stays."""
    scene = taut(element, 10)
    bare = np.asarray(scene.modes(5).frequency)
    scene.ice("w", thickness=T)
    iced = np.asarray(scene.modes(5).frequency)
    ratios = iced[bare > 1] / bare[bare > 1]  # beams turn freely about the axis
    assert ratios == pytest.approx(sqrt(MASS / (MASS + ice_mass(T))), rel=1e-4 if "beam" in element else 1e-7)


@pytest.mark.parametrize("element", ["cable8p", "cable12"])
def test_the_sag_of_a_catenary(element):
    scene = fu.Scene(gravity=(0, -G, 0))
    span, length = 100.0, 101.0
    up = {"up": (0, 0, 1)} if element == "cable12" else {}
    soft = fu.Material(youngs_modulus=1e9, poisson_ratio=0, density=RHO)
    scene.cable("w", start=(0, 0, 0), end=(span, 0, 0), rest_length=length, element=element, elements=40,
                section=fu.Circle(radius=D / 2), material=soft, shape="hanging", strain="engineering", **up)
    scene.pin("w", s=0)
    scene.pin("w", s=length)
    scene.ice("w", thickness=fu.Ramp(start=0, end=1, before=T, after=0.5 * T), density=700)
    state = scene.equilibrium()
    w = (MASS + ice_mass(T, 700)) * G
    EA = 1e9 * pi * D**2 / 4

    def apart(H):
        """Return the error of the span of the elastic catenary of a horizontal force."""
        return H * length / EA + 2 * H / w * asinh(w * length / (2 * H)) - span

    H = brentq(apart, 10.0, 1e5)
    sag = w * length**2 / (8 * EA) + H / w * (sqrt(1 + (w * length / (2 * H)) ** 2) - 1)
    assert float(-state["w@0.force"][0]) == pytest.approx(H, rel=1e-4)
    assert -state["w.position"][20, 1] == pytest.approx(sag, rel=1e-4)
    assert float(state["w@0.force"][1]) == pytest.approx(w * length / 2, rel=1e-9)
    assert float(state["ice_1.mass"]) == pytest.approx(ice_mass(T, 700) * length, rel=1e-12)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_an_iced_cable_falls_freely(integrator):
    """Whether the ice grows or not: no thrust acts, and the energy that comes and goes is external."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.cable("w", start=(0, 0, 0), end=(2, 1, 0), velocity=(1, 2, 0), element="cable8p", elements=3, **WIRE)
    scene.ice("w", thickness=fu.Ramp(start=0.05, end=0.25, before=0, after=T), name="glaze")
    run = scene.run(duration=0.3, tol=1e-6, output_step=0.01, integrator=integrator)
    fallen = run["w.position"][:, 0] - run["w.position"][0, 0]
    assert fallen == pytest.approx(np.outer(run.time, (1, 2, 0)) - np.outer(run.time**2 / 2, (0, G, 0)), abs=1e-8)
    assert run["glaze.mass"][-1] == pytest.approx(ice_mass(T) * sqrt(5), rel=1e-12)
    gained = sum(run[f"energy.{name}"][-1] - run[f"energy.{name}"][0] for name in ("kinetic", "potential"))
    assert run["energy.external"][-1] == pytest.approx(gained, rel=1e-3), "by the trapezoidal rule"


@pytest.mark.parametrize("element", ["cable8p", "cable12"])
def test_wind_on_the_larger_diameter(element):
    """Of the part of the span under ice, which drag of all of it knows; air lifts the ring, too."""
    axis = 2 if element == "cable12" else 1

    def force(**ice):
        scene = taut(element, 8, (0, -G, 0))
        scene.fluid("wind", density=1.25, velocity=30 * np.eye(3)[axis])
        scene.drag("w", normal=1.2, name="drag")
        if ice:
            scene.ice("w", thickness=T, **ice)
        return np.asarray(scene.equilibrium()["drag.force"])[axis]
    lift, ring = (1.25 * area * 10 * G * (axis == 1) for area in (pi * D**2 / 4, pi * T * (D + T)))
    bare, half, whole = force() - lift, force(start=5.0) - lift - ring / 2, force(start=0.0) - lift - ring
    assert whole / bare == pytest.approx((D + 2 * T) / D, rel=2e-3)
    assert half == pytest.approx((whole + bare) / 2, rel=2e-3)


@pytest.mark.parametrize(("area", "share"), [(None, 1), (1e-4, 0)])
def test_air_lifts_the_ring(area, share):
    """Unless the displaced area is given."""
    scene = taut("cable12", 8, (0, -G, 0))
    scene.fluid("air", density=1.25)
    scene.drag("w", displaced_area=area, name="lift")
    scene.ice("w", thickness=T, stop=5)
    area = (area or pi * D**2 / 4) * 10 + share * pi * T * (D + T) * 5
    assert float(scene.equilibrium()["lift.force"][1]) == pytest.approx(1.25 * area * G, rel=1e-12)


def test_wind_that_grows_with_the_ice_and_section_forces():
    scene = taut("cable12", 8, (0, -G, 0))
    scene.fluid("wind", density=1.25, velocity=(0, 0, 30))
    scene.drag("w", normal=1.2, name="drag")
    scene.ice("w", thickness=fu.Ramp(start=0, end=0.1, before=0, after=T), start=2.5, name="rime")
    run = scene.run(duration=0.1, tol=1e-5, output_step=0.02)
    places = np.array([2.0, 4.0, 9.0])
    balance, own = (np.asarray(run.section_forces("w", s=places, method=method)["force"])[-1]
                    for method in ("balance", "constitutive"))
    assert balance[:, 0] == pytest.approx(own[:, 0], rel=2e-4)
    last = np.asarray(run["w@0.force"])[-1]
    assert np.abs(np.asarray(run.section_forces("w", s=[0.0])["force"])[-1].ravel()) == pytest.approx(
        np.abs(last), rel=1e-3, abs=2.0)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_ice_that_falls_off_half_of_a_span(integrator):
    """The energy before and after balances; the span jumps up, at most twice the way to its new place of rest."""
    def span(**ice):
        scene = fu.Scene(gravity=(0, -G, 0))
        scene.cable("w", start=(0, 0, 0), end=(50, 0, 0), rest_length=50.2, element="cable8p", elements=8,
                    shape="hanging", **WIRE)
        scene.pin("w", s=0)
        scene.pin("w", s=50.2)
        scene.ice("w", stop=25.1, name="stays", thickness=T)
        scene.ice("w", start=25.1, name="falls", **ice)
        return scene
    drop = span(thickness=fu.Ramp(start=0.01, end=0.02, before=T, after=0))
    run = drop.run(duration=2.0, tol=1e-4, output_step=0.02, initial="equilibrium", integrator=integrator)
    rest = [float(span(thickness=t).equilibrium()["w.position"][6, 1]) for t in (T, 0)]
    y = np.asarray(run["w.position"])[:, 6, 1]
    assert y[0] == pytest.approx(rest[0], abs=1e-6)
    rise = (y.max() - rest[0]) / (rest[1] - rest[0])
    assert 1.5 < rise < 2.3
    assert energy_error(run) < 1e-3
    assert float(run["falls.mass"][-1]) == 0


def test_runs_resume_and_files_keep_ice(tmp_path):
    scene = taut(elements=4, gravity=(0, -G, 0))
    scene.ice("w", thickness=fu.Ramp(start=0, end=0.02, before=0, after=T), start=2.5, stop=7.5, density=600)
    check_file_and_resume(scene, tmp_path, 6, duration=0.02, tol=1e-3, output_step=0.002)


@pytest.mark.parametrize(("path", "between"), [("gravity.y", (-15, -5)), ("w.material.density", (2000, 6000)),
                                               ("glaze.thickness", (0.01, 0.04)), ("w.section.radius", (0.008, 0.015))])
def test_numbers_beside_ice_are_adjusted(path, between):
    """From a slack line drawn straight, whose string knows the ice, too; derivatives contain it: few iterations."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.cable("w", start=(0, 0, 0), end=(50, 0, 0), rest_length=50.2, rest="straight", element="cable8p", elements=8,
                **WIRE)
    scene.pin("w", s=0)
    scene.pin("w", s=50.2)
    scene.ice("w", stop=25.1, thickness=T, name="glaze")
    found = scene.equilibrium(adjust={path: between}, to={"w@0.force.x": -3100.0})
    again = np.asarray(found.scene.equilibrium()["w@0.force"])
    assert again[0] == pytest.approx(-3100.0, rel=1e-7)
    assert found.adjustment.iterations <= 4


def test_what_ice_does_not_suit_is_refused():
    scene = taut(elements=4, gravity=(0, -G, 0))
    with refused('ice "a": start must be a node of the cable, got 1 m; nodes are at 0, 2.5, 5, 7.5, 10 m'):
        scene.ice("w", thickness=T, start=1, name="a")
    with pytest.raises(fu.SceneError, match="thickness must not be negative"):
        scene.ice("w", thickness=-T)
    with pytest.raises(fu.SceneError, match="the least value of the signal"):
        scene.ice("w", thickness=fu.Ramp(start=0, end=1, before=T, after=-T))
    with refused('ice "a": there is no cable "v"; known: w'):
        scene.ice("v", thickness=T, name="a")
    scene.ice("w", thickness=T, stop=5, name="a")
    with refused('ice "b": there is the ice "a" already; leave one of them out, or give them start and stop'):
        scene.ice("w", thickness=T, start=2.5, name="b")
    for integrator in ("energy", "linear"):
        with pytest.raises(fu.SceneError, match='ice "a": integrator'):
            scene.run(duration=0.01, step=1e-3, output_step=0.01, integrator=integrator)
    scene.surface("ground", fu.Plane(), at=(0, -5, 0))
    with refused('ice "a": is on a cable with the contact "c", whose radius does not grow with it; leave one of them '
                 "out"):
        scene.contact("w", "ground", name="c")
    scene.fluid("sea", density=1000)
    scene.drag("w", start=5, normal=1.0, added_mass=1.0)
    with refused('drag "d": acts where the ice "a" does, but added_mass of a drag does not know the ice; leave it out, '
                 "or give them other parts of the cable by start and stop"):
        scene.drag("w", stop=5, normal=1.0, added_mass=1.0, name="d")
