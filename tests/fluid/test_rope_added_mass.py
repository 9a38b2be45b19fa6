"""Added mass of fluids along the spans of ropes, by the velocity of the material across the line."""

from functools import cache

import funicular as fu
import numpy as np
import pytest
from derivatives import error_by_drags
from interrupted_runs import killed_and_resumed
from ropes.scenes import rope_of
from scipy.integrate import solve_ivp
from test_grips import SETTINGS, spanned
from test_rope_drag import DRAG, WIND, blown
from test_rope_loads import on_a_cable_and_a_rope
from test_ropes import FORCES, carried, momenta

pytestmark = pytest.mark.filterwarnings("ignore:.*youngs_modulus|.*density:funicular.FunicularWarning")
ADDED = {"added_mass": 1.0, "added_mass_tangential": 0.3, "displaced_area": 4e-3}


STARTS = {"scale": fu.Ramp(start=0.0, end=0.3, before=0.0, after=1.0)}


def wet(dim: int = 2, **fluid) -> fu.Scene:
    scene = blown(dim, **fluid).without("past")
    scene.drag("line", **DRAG, **ADDED, name="past")
    return scene


def test_agrees_with_a_cable():
    """A rope of 10 m that bends in a current that starts; the difference is that of its end beside a sheave."""
    def load(scene):
        scene.fluid("air", **WIND | STARTS | {"density": 300.0})
        scene.drag("line", **DRAG, added_mass=1.0, displaced_area=1e-3, name="past")

    errors = []
    for end in (0.02, 0.01):
        runs = [scene.run(0.6, **SETTINGS) for scene in on_a_cable_and_a_rope(end, load)]
        assert runs[1]["line.nodal_vectors"][:, 2, 0, 1].min() < -0.2
        errors.append([np.abs(runs[0][name] - runs[1][name]).max() / np.abs(runs[1][name]).max()
                       for name in ("past.force", "energy.external", "energy.kinetic")])
    assert np.max(errors[0]) < 1e-3 and np.all(np.array(errors[1]) < 0.7 * np.array(errors[0]))


def test_transverse_frequencies_in_still_water():
    """Taut spans vibrate slower by the root of the mass over that with the water."""
    rho, found = spanned().ropes["line"].material.density * spanned().ropes["line"].section.area, []
    for coefficient in (None, 1.3):
        scene = spanned().without("load")
        scene.fluid("water", density=1000.0)
        scene.drag("line", added_mass=coefficient, displaced_area=1e-3)
        found.append(scene.modes(1, scene.equilibrium()).frequency[0])
    assert found[1] / found[0] == pytest.approx(np.sqrt(rho / (rho + 1.3)), rel=1e-3)


# --- a string that runs between two drums -----------------------------------------------------------------------------

LENGTH, TENSION, RHO, EA, SPEED, WATER = 10.0, 300.0, 0.5, 1e5, 6.0, 0.5
PULSE = {"time": [0, 0.3, 0.4, 0.5, 9], "value": [0, 0, 1.0, 0, 0]}


def between_drums(**fluid) -> fu.Scene:
    """Return a rope that runs at 6 m/s over 10 m, through as much water as its mass, and is pushed after .3 s."""
    scene = fu.Scene(gravity=(0, 0, 0))
    drums = [fu.Drum(name, at=(x, -0.1, 0), radius=0.1, side="right", length_in_store=store,
                     velocity=fu.Ramp(start=0.0, end=0.2, after=-SPEED / 0.1))
             for name, x, store in (("from", 0, 20), ("to", LENGTH, 1))]
    scene.rope("line", route=drums, tension=TENSION, elements=10, **rope_of(EA, RHO, 0, 1e-3))
    scene.fluid("water", density=1000.0, **fluid)
    scene.drag("line", displaced_area=WATER / 1000, added_mass=1.0, name="past")
    scene.distributed_force("line", value=(0, 1, 0), scale=fu.TableSignal(**PULSE, interpolation="linear"))
    return scene


def middle_of_string(times: np.ndarray, tension: float, fluid_speed: float) -> np.ndarray:
    """Return the motion of the middle by m (d/dt + v d/dx)^2 y + m_a (d/dt + u d/dx)^2 y = T y'' + f, with sines."""
    i, stretch = np.arange(1, 15), 1 + TENSION / EA
    k, m, added = i * np.pi / LENGTH, RHO / stretch, WATER / stretch
    slopes = np.array([[4 / LENGTH * a * b / (a * a - b * b) if (a + b) % 2 else 0 for b in i] for a in i])
    push = 2 * (1 - np.cos(i * np.pi)) / (i * np.pi) / stretch
    through, stiffness = m * SPEED + added * fluid_speed, tension - m * SPEED**2 - added * fluid_speed**2

    def rates(t, state):
        q, p = np.split(state, 2)
        force = push * np.interp(t, PULSE["time"], PULSE["value"]) - 2 * through * slopes @ p - stiffness * k**2 * q
        return np.concatenate([p, force / (m + added)])

    found = solve_ivp(rates, (times[0], times[-1]), np.zeros(2 * len(i)), t_eval=times, rtol=1e-8, atol=1e-10,
                      max_step=0.02)
    return np.sin(k * LENGTH / 2) @ found.y[: len(i)]


@pytest.mark.parametrize("fluid_speed", [0.0, SPEED])
def test_a_string_that_runs_through_water(fluid_speed):
    """The water is moved by the line's displacement across itself alone, in still water with d²y/dt², not with the
    acceleration of the material.
    """
    run = between_drums(velocity=(fluid_speed, 0, 0)).run(1.8, **SETTINGS | {"tol": 1e-5})
    later = run.time > 0.24
    tension = (run["to.tension"] + run["from.tension"])[run.time > 0.5].mean() / 2  # falls by .7 % as it starts to run
    middle = run["line.position"][later, run["line.position"].shape[1] // 2, 1]
    error, other = (np.abs(middle - middle_of_string(run.time[later], tension, speed)).max() / np.abs(middle).max()
                    for speed in (fluid_speed, SPEED - fluid_speed))
    assert error < 5e-3 and other > 0.3
    assert np.abs(run.energy_balance().relative).max() < 1e-5


def test_a_rope_that_is_hauled_along_itself():
    """Fluid along the line leaves a span with the material: the rope is relieved of m_t v² at a constant speed, and
    tension grows by the weight alone.
    """
    mass, rho, length, radius, speed, along = 40.0, 0.5, 20.0, 0.3, 2.0, 0.7
    scene = fu.Scene()
    scene.rigid_body("load", mass=mass, inertia=(1, 1, 1), position=(-radius, -length, 0))
    scene.rope("hoist", route=[fu.Drum("winch", at=(0, 0, 0), radius=radius, side="left", length_in_store=25,
                                       velocity=fu.Ramp(start=0.0, end=1.0, after=-speed / radius)),
                               fu.Anchor("load")], tension=mass * 9.81, elements=3, **rope_of(1e6, rho, 0, 5e-2))
    scene.fluid("water", density=1000.0)
    scene.drag("hoist", added_mass=0.0, added_mass_tangential=along, displaced_area=1e-3, name="past")
    run = scene.run(2.5, **SETTINGS | {"output_step": 0.5})
    below, rises = -run["load.position"][-1, 1], run["load.velocity"][-1, 1]
    stretch = 1 + mass * 9.81 / 1e6
    assert run["past.force"][-1, 1] == pytest.approx((9.81 * below + along * rises**2) / stretch, rel=2e-3)
    tension = run.section_forces("hoist", method="constitutive").tension.values[-1]
    assert tension[0] - tension[-1] == pytest.approx((rho - 1) * 9.81 * below / stretch, rel=5e-3)
    assert np.abs(run.energy_balance().relative).max() < 1e-4


def test_momentum_of_a_rope_and_its_fluid():
    """A rope over a body that moves and turns in still fluid keeps its momentum with the impulse of the fluid; the
    moment of both changes by that of the loads.
    """
    scene = carried()
    scene.fluid("water", density=1000.0)
    scene.drag("hoist", added_mass=1.0, added_mass_tangential=0.3, displaced_area=2e-4)
    run = scene.run(duration=0.1, output_step=0.002, tol=1e-6, integrator="explicit")
    change = momenta(scene, run, -1) - momenta(scene, run, 0)
    moment = sum(run[f"{name}.position"][:, 0] * force for name, force in FORCES.items())
    assert np.abs(change[:2]).max() < 1e-12
    assert change[2] == pytest.approx(np.sum(moment[1:] + moment[:-1]) * 0.001, abs=2e-6)  # of the trapezoidal rule
    assert np.abs(run.energy_balance().relative).max() < 1e-9


@cache
def in_a_stream(integrator: str) -> fu.Run:
    return wet(**STARTS).run(0.02, **SETTINGS | {"integrator": integrator, "tol": 1e-6, "output_step": 0.01})


@pytest.mark.parametrize("integrator", ["radau", "genalpha", "explicit"])
def test_integrators_agree(integrator):
    """The kinetic energy contains that of the fluid; the power of the stream is external."""
    run, other = in_a_stream(integrator), in_a_stream("radau")
    for name in ("line.position", "past.force", "energy.kinetic", "energy.external"):
        moved = np.ptp(other[name], axis=0).max()
        assert moved > 0 and np.abs(run[name] - other[name]).max() < 1e-3 * moved
    assert np.abs(run.energy_balance().relative).max() < 5e-6


def test_refused_by_the_energy_method():
    with pytest.raises(fu.SceneError, match='drag "past": integrator "energy" has no discrete gradient of it'):
        wet().run(0.1, **SETTINGS | {"integrator": "energy"})


@pytest.mark.parametrize("scene", [
    wet(), wet(surface=0.004), wet(3, velocity=(3, -6, 2)),
    wet(profile=fu.PowerProfile(exponent=0.2, reference_height=10.0))], ids=["all", "section", "space", "profile"])
def test_tangent(scene):
    assert error_by_drags(scene) < 1e-7


def test_a_planar_scene_and_its_twin_in_space():
    runs = [wet(dim, **STARTS).run(0.4, **SETTINGS) for dim in (2, 3)]
    assert np.abs(runs[0]["line.position"] - runs[0]["line.position"][0]).max() > 0.05
    assert np.abs(runs[0]["past.force"] - runs[1]["past.force"]).max() < 2e-3 * np.abs(runs[0]["past.force"]).max()


def test_at_rest_in_a_sheared_current():
    """The inertia of a flowing fluid acts at rest, too: a run from there stays."""
    scene = wet(profile=fu.PowerProfile(exponent=0.2, reference_height=10.0), velocity=(1, 0, 0))
    rest, without = scene.equilibrium(), blown(profile=fu.PowerProfile(exponent=0.2, reference_height=10.0),
                                               velocity=(1, 0, 0)).equilibrium()
    run = scene.run(0.3, initial=rest, **SETTINGS)
    assert np.abs(run["line.position"] - rest["line.position"]).max() < 1e-8
    assert np.abs(rest["line.position"] - without["line.position"]).max() > 1e-4


def test_resumed_bit_for_bit(tmp_path):
    scene, settings = wet(**STARTS), SETTINGS | {"duration": 0.4}
    whole = scene.run(**settings)
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 5, **settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_from_a_file():
    scene = wet()
    assert fu.Scene.from_toml(scene.to_toml()).drags["past"] == scene.drags["past"]


@pytest.mark.parametrize(("given", "words"), [
    ({"added_mass": (1, 1, 1)}, 'acts on rope "line", whose added_mass is one number'),
    ({"added_mass": 1.0, "displaced_area": 0.0}, "give displaced_area"),
    ({"added_mass_tangential": 1.0}, "without added_mass"),
])
def test_refused(given, words):
    scene = spanned().without("load")
    scene.fluid("air", density=1.0)
    with pytest.raises(fu.SceneError, match=words):
        scene.drag("line", **{"normal": 1.0, **given})
