"""Cables that give way in compression: membrane="tension_only"."""

import funicular as fu
import numpy as np
import pytest

EA, LEFT, TRANSITION = 1e9 * np.pi * 1e-6, 1e-4, 1e-6


def wire(membrane, element="cable12", elements=8, stretch=1.0):
    """Return a wire of 1 m, pinned at both ends, that is drawn with this stretch."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    rope = scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=elements, element=element, membrane=membrane,
                       strain="engineering", section=fu.Circle(radius=1e-3), rest_length=1.0 / stretch,
                       material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1100))
    scene.pin(rope, s=0)
    scene.pin(rope, s=1.0 / stretch)
    return scene


def energy_as_drawn(scene):
    """Return the elastic energy at the start."""
    run = scene.run(duration=1e-9, step=1e-9, integrator="genalpha", output_step=1e-9)
    return run["energy.elastic"][0]


@pytest.mark.parametrize("element", ["cable8p", "cable12"])
@pytest.mark.parametrize("strain", [1e-3, 1e-2, -1e-3, -1e-2])
def test_energy_of_a_strain(element, strain):
    stored = energy_as_drawn(wire("tension_only", element, stretch=1 + strain))
    ideal = EA / 2 * strain**2 * (1.0 if strain > 0 else LEFT) / (1 + strain)
    transition = 1.001 * EA * TRANSITION * abs(strain) / 4 / (1 + strain)  # of both branches
    assert abs(stored - ideal) <= transition


def test_a_taut_wire_hangs_as_with_the_full_law():
    states = [wire(membrane, stretch=1.01).equilibrium()["wire.nodal_vectors"] for membrane in ("full", "tension_only")]
    sag = np.ptp(states[0][:, 0, 1])
    assert np.abs(states[0] - states[1])[:, 0].max() < 2e-4 * sag  # 2.5e-7/1e-2 of the tension, and bending


def test_a_longer_wire_takes_fewer_steps():
    """Drawn with a compression of 0.5 %: a full wire snaps back axially, one without resistance to it falls."""
    steps = {membrane: wire(membrane, stretch=1 / 1.005).run(
        duration=0.1, output_step=0.01, tol=1e-3, integrator="radau").report["steps"]
        for membrane in ("full", "tension_only")}
    assert steps["tension_only"] < steps["full"] / 1.5


def test_the_energy_integrator_balances_it_to_rounding():
    scene = wire("tension_only", stretch=1 / 1.005)
    run = scene.run(duration=0.05, output_step=0.01, step=1e-4, integrator="energy")
    total = sum(run[f"energy.{part}"] for part in ("kinetic", "elastic", "potential", "dissipated"))
    assert np.ptp(total) < 1e-9 * np.ptp(run["energy.potential"])


def test_it_is_a_law_of_straight_cables_with_engineering_strain():
    assert wire("tension_only").cables["wire"].law == "engineering_exact_tension_only"
    common = {"start": (0, 0, 0), "end": (1, 0, 0), "elements": 4, "section": fu.Circle(radius=1e-3),
              "material": fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1100)}
    scene = fu.Scene()
    scene.cable("a", element="cable12", membrane="tension_only", **common)
    assert scene.cables["a"].law == "engineering_exact_tension_only"
    for given in ({"element": "cable12", "strain": "green"}, {"element": "cable18"}, {"element": "beam24"},
                  {"element": "cable12", "curvature": "linear"}):
        with pytest.raises(fu.SceneError, match=r"is not possible|are for cable elements"):
            scene.cable("b", membrane="tension_only", **given, **common)
