"""Wind and water: closed forms, a boundary value problem, derivatives, energy balance, refusals."""

from math import acos, pi, sin, sqrt

import funicular as fu
import numpy as np
import pytest
from funicular.engine import Engine
from funicular.model.build import build
from scipy.integrate import solve_bvp

INTEGRATORS = ("genalpha", "energy", "explicit", "radau")
ELEMENTS = ("cable12", "cable8p", "cable18", "beam24", "beam12p")
G, WATER = 9.81, 1000.0
ROPE = {"section": fu.Circle(radius=0.01), "material": fu.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=2000)}
AREA = pi * 0.01**2


def rope(scene, element="cable12", end=(2, 0, 0), elements=4, **more):
    return scene.cable("wire", start=(0, 0, 0), end=end, elements=elements, element=element, **ROPE | more)


def balance(run):
    """Return the energy that is not accounted for, J."""
    stored = sum(run[f"energy.{part}"] for part in ("kinetic", "elastic", "potential", "dissipated"))
    found = stored - run["energy.external"]
    return np.abs(found - found[0]).max()


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_horizontal_cable_falls_as_the_closed_form(integrator, element):
    """v = v_t tanh(g' t/v_t), with the weight in water over the mass, g', and the terminal velocity v_t."""
    scene = fu.Scene()
    rope(scene, element)
    scene.fluid(density=WATER)
    scene.drag("wire", normal=1.2, tangential=0.01)
    run = scene.run(0.5, tol=1e-7, integrator=integrator, output_step=0.05)
    weight, drag = (2000 - WATER) * AREA * G, WATER / 2 * 0.02 * 1.2
    terminal = sqrt(weight / drag)
    exact = -terminal * np.tanh(run.time * weight / (2000 * AREA) / terminal)
    assert exact[-1] < -0.999 * terminal
    assert np.abs(run["wire.nodal_velocity"][:, :, 0, 1] - exact[:, None]).max() < 1e-7
    assert np.abs(run["drag_1.force"][-1] - [0, 2 * 2000 * AREA * G, 0]).max() < 1e-2
    assert balance(run) < (2e-14 if integrator == "energy" else 1e-6)
    assert run["energy.dissipated"][-1] > 1.0


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_towed_cable_is_straight_at_the_critical_angle(element):
    """Weight across it and drag across it balance, w cos(angle) = q sin^2(angle), whatever the drag along it."""
    speed, radius, density = 3.0, 0.005, 5000
    scene = fu.Scene()
    wire = rope(scene, element, (0, -20, 0), section=fu.Circle(radius=radius),
                material=fu.Material(youngs_modulus=1e12, poisson_ratio=0.0, density=density))
    scene.pin(wire, s=0.0)
    scene.fluid(density=1025, velocity=(speed, 0, 0))
    scene.drag(wire, normal=1.2, tangential=0.02)
    state = scene.equilibrium()
    weight, across = (density - 1025) * pi * radius**2 * G, 1025 / 2 * 2 * radius * 1.2 * speed**2
    cosine = (sqrt(weight**2 + 4 * across**2) - weight) / (2 * across)
    along = (state["wire.position"] - state["wire.position"][0])[1:]
    assert np.abs(along[:, 0] / np.linalg.norm(along, axis=1) - cosine).max() < 1e-7
    tension = 20 * (weight * sin(acos(cosine)) + 1025 / 2 * pi * 2 * radius * 0.02 * (speed * cosine) ** 2)
    assert np.linalg.norm(state["wire@0.force"]) == pytest.approx(tension, rel=1e-6)
    assert np.abs(state["wire@0.force"] + state["drag_1.force"] + [0, -density * pi * radius**2 * 20 * G, 0]).max() < 1e-6


def string_in_current(length, span, stiffness, weight, flow, normal, tangential):
    """Return a function of s (n,): r (3, n), n (3, n) of a string without bending between two points, in a current.

    weight in N/m, less buoyancy; flow(y): velocity along z at the height y; normal, tangential in N s²/m³.
    """
    def rates(s, x):
        n, T = x[3:], np.linalg.norm(x[3:], axis=0)
        slope = (1 + T / stiffness) * n / T
        i, U = n / T, np.zeros_like(n)
        U[2] = flow(x[1])
        w_t = np.sum(i * U, axis=0)
        w_n = U - w_t * i
        f = (1 + T / stiffness) * (normal * np.linalg.norm(w_n, axis=0) * w_n + tangential * np.abs(w_t) * w_t * i)
        f[1] -= weight
        return np.vstack([slope, -f])

    def ends(a, b):
        return np.concatenate([a[:3], b[:3] - [span, 0, 0]])

    s = np.linspace(0, length, 101)
    sag = sqrt(3 * span * (length - span) / 8)
    guess = np.zeros((6, len(s)))
    guess[0], guess[1] = span * s / length, -4 * sag * s / length * (1 - s / length)
    guess[3], guess[4] = weight * span**2 / 8 / sag, weight * (s - length / 2)
    found = solve_bvp(rates, ends, s, guess, tol=1e-9, max_nodes=100000)
    assert found.success
    return found.sol


def current_scene(elements, element="cable12", **more):
    """Return a rope of 12 m over a span of 10 m in a current that grows with height, drawn as a hanging line."""
    scene = fu.Scene()
    section = fu.GeneralSection(area=1e-4, second_moment_about_z=1e-14)
    s = np.linspace(0, 1, 81)
    line = np.column_stack([10 * s, 3.0 * 4 * s * (s - 1), 0 * s])
    wire = scene.cable("wire", points=line, length=12.0, elements=elements, element=element, section=section,
                       law="engineering_exact", material=fu.Material(youngs_modulus=1e9, poisson_ratio=0, density=3000))
    scene.pin(wire, s=0.0)
    scene.pin(wire, s=wire.length)
    profile = fu.TableProfile(height=[-8, -4, 0], factors=[0.2, 0.6, 1.0])
    scene.fluid("sea", density=1025, velocity=(0, 0, 1.5), profile=profile)
    scene.drag(wire, normal=1.2, tangential=0.05, diameter=0.02)
    return scene


def test_a_cable_in_a_cross_current_hangs_as_the_boundary_value_problem():
    state = current_scene(48).equilibrium()
    sol = string_in_current(12.0, 10.0, 1e9 * 1e-4, (3000 - 1025) * 1e-4 * G,
                            lambda y: 1.5 * (1 + 0.1 * y), 1025 / 2 * 0.02 * 1.2, 1025 / 2 * pi * 0.02 * 0.05)
    s = np.linspace(0, 12.0, 49)
    exact = sol(s)
    error = np.abs(state["wire.position"] - exact[:3].T).max()
    assert np.abs(exact[2]).max() > 1.0  # it is blown well out of its plane
    assert error < 2e-5 * 10
    assert np.abs(state["wire@0.force"] + exact[3:, 0]).max() < 1e-3 * np.linalg.norm(exact[3:, 0])
    cut = state.section_forces("wire", [3.0, 6.0])["force"]
    assert np.abs(cut - sol([3.0, 6.0])[3:].T).max() < 1e-3 * np.linalg.norm(exact[3:, 0])
