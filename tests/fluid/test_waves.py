"""Linear waves: dispersion, force on a pile, a buoy, energy, integrators, resume, files, refusals."""

import warnings
from math import pi, sqrt, tanh

import funicular as fu
import numpy as np
import pytest
import waves as cases
from expectations import refused, unaccounted

INTEGRATORS = ("genalpha", "explicit", "radau")
WATER, G = 1025.0, 9.81


@pytest.mark.parametrize("depth", [None, 400.0, 20.0, 3.0, 0.2])
def test_the_length_of_a_wave_satisfies_the_dispersion_relation(depth):
    wave = fu.Wave(0.1, period=7.0)
    k = wave.wave_number(G, depth)
    assert G * k * (1.0 if depth is None else tanh(k * depth)) == pytest.approx(wave.frequency**2, rel=1e-14)


@pytest.mark.parametrize("part", ["inertia", "drag"])
def test_small_waves_on_a_pile_give_morisons_force_in_closed_form(part, validated):
    small = 1e-3
    found, exact = {
        "inertia": (lambda: cases.force_on_pile(cases.pile(small, 0.0, phase=-pi / 2)), -cases.inertia_of_pile(small)),
        "drag": (lambda: cases.force_on_pile(cases.pile(small, cases.C_DRAG)), cases.drag_of_pile(small))}[part]
    validated("Fluid", "vertical pile in a regular wave of 2 mm, 20 m of water", f"{part} up to the surface", exact,
              found(), unit="N", bound=1e-4, source="Morison's equation in closed form", variant=part)


@pytest.mark.parametrize("phase", [0.0, -0.7])
def test_a_wave_of_two_metres_acts_up_to_its_elevation(phase, validated):
    exact = cases.to_the_surface(1.0, phase)
    found = cases.force_on_pile(cases.pile(1.0, cases.C_DRAG, phase=phase))
    validated("Fluid", f"vertical pile in a regular wave of 2 m, phase {phase}", "force to the surface", exact, found,
              unit="N", bound=1e-5, source="Morison's equation by quadrature, Wheeler's rule")


def test_a_buoy_heaves_as_the_linear_oscillator_with_an_error_of_the_second_order(validated):
    pairs = [cases.heave_of_buoy(amplitude) for amplitude in (0.04, 0.02, 0.01)]
    errors = [abs(found - linear) for found, linear in pairs]
    assert errors[0] / errors[1] > 3 and errors[1] / errors[2] > 3
    validated("Fluid", "buoy in regular waves of 10 mm", "amplitude of heave", pairs[2][1], pairs[2][0], unit="m",
              bound=1e-4, source="linear oscillator")


def test_a_heaving_lazy_wave_has_the_tension_of_another_program_with_morisons_added_mass(validated):
    for name, (found, other) in zip(("mean", "minimum", "maximum"), cases.heaving_cable(), strict=True):
        validated("Fluid", "lazy-wave cable, hang-off heaved by 3 m in 12 s, Morison's added mass",
                  f"{name} of the tension", other, found, unit="N", bound=1e-3, source="another program, converged",
                  variant=name)


def test_the_variance_of_a_sea_is_that_of_its_significant_height(validated):
    sea = fu.jonswap(significant_height=3.0, peak_period=9.0, components=200, seed=7)
    assert sea == fu.jonswap(significant_height=3.0, peak_period=9.0, components=200, seed=7)
    assert sea != fu.jonswap(significant_height=3.0, peak_period=9.0, components=200, seed=8)
    assert sum(wave.amplitude**2 / 2 for wave in sea) == pytest.approx(9 / 16, rel=1e-12)
    with refused("jonswap: significant_height must be positive, got -3 m"):
        fu.jonswap(significant_height=-3.0, peak_period=9.0)
    found, exact = cases.variance_of_sea(200)
    validated("Fluid", "sea of 200 waves by JONSWAP's spectrum, six hours", "variance of the elevation", exact, found,
              unit="m²", bound=2e-2, source="Hs²/16")
    # energy below the peak frequency, from the spectrum of Hasselmann et al., by quadrature
    f = np.linspace(0.3, 6, 100001)
    density = f**-5 * np.exp(-1.25 * f**-4) * 3.3 ** np.exp(-((f - 1) ** 2) / (2 * np.where(f < 1, 0.07, 0.09) ** 2))
    below = density[f < 1].sum() / density.sum()
    assert np.mean([wave.period > 9.0 for wave in sea]) == pytest.approx(below, abs=5e-3)


def moored(waves=None, dim=2, **fluid):
    """Return a line from the bed to a buoy at the surface, both with drag and added mass."""
    scene = fu.Scene(gravity=(0, -G, 0))
    z = 0.0 if dim == 2 else 1.0
    wire = scene.cable("line", points=[(0, -10, 0), (3, -4, z), (4, -0.5, 0)], elements=4, rest="straight",
                       element="cable8p" if dim == 2 else "cable12", section=fu.Circle(radius=0.03),
                       material=fu.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=1500))
    scene.pin(wire, s=0.0)
    scene.fluid("air", density=1.2, velocity=(8, 0, 0))
    scene.fluid("sea", density=WATER, surface=0.0, velocity=(0.4, 0, 0), depth=10.0,
                waves=waves or [fu.Wave(0.4, period=3.5), fu.Wave(0.1, period=2.0, phase=1.0)], **fluid)
    scene.rigid_body("buoy", mass=60, inertia=(4, 4, 4), position=(4.2, -0.3, 0))
    scene.joint("spherical", (wire, wire.length), ("buoy", (-0.2, -0.2, 0)))
    scene.drag(wire, normal=1.2, tangential=0.02, added_mass=1.0, fluid="sea")
    scene.drag("buoy", area=0.3, coefficient=0.6, volume=0.15, added_mass=0.5)
    return scene


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("form", ["lagrange", "morison"])
def test_the_work_of_waves_is_in_the_balance(integrator, form):
    scene = moored()
    for name in list(scene.drags):
        scene = scene.replace(name, added_mass_form=form)
    run = scene.run(1.0, tol=1e-6, integrator=integrator, output_step=0.25)
    assert np.ptp(run["energy.external"]) > 10
    assert unaccounted(run) < 2e-3 * np.ptp(run["energy.external"])


def test_integrators_agree_in_waves():
    found = [moored().run(1.5, tol=1e-6, integrator=one, output_step=0.5)["buoy.position"] for one in INTEGRATORS]
    assert max(np.abs(each - found[2]).max() for each in found) < 1e-4


def test_a_buoy_without_mass_follows_long_waves():
    """Its period is short beside that of the wave: the buoy keeps its draught."""
    wave = fu.Wave(0.2, period=30.0)
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.fluid("sea", density=WATER, surface=0.0, waves=[wave])
    scene.rigid_body("buoy", mass=WATER * 0.1, inertia=(1, 1, 1), position=(0, 0.2, 0), velocity=(0, 0, 0))
    scene.joint("prismatic", (0, 0, 0), "buoy", axis=(0, 1, 0))
    scene.drag("buoy", volume=0.2, height=0.4, area=0.3, added_mass=0.0)
    run = scene.run(30.0, tol=1e-6, output_step=1.0)
    sea = scene.fluids["sea"].elevation(run.time, run["buoy.position"])
    assert np.abs(run["buoy.position"][:, 1] - sea).max() < 5e-3


def test_long_steps_do_not_skip_waves():
    """Far above the bed at rest, a buoy of no motion at first: steps end four times a period all the same."""
    run = moored(waves=[fu.Wave(1e-4, period=0.5)]).run(1.0, tol=1e-2, output_step=1.0)
    assert run.report["steps"] >= 8
    with pytest.raises(fu.SceneError, match=r"has waves that a step of 0.6 s goes over; take a step of at most 0.5 s"):
        moored().run(1.2, step=0.6, output_step=1.2)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_resumed_run_goes_on_in_waves(integrator, tmp_path):
    def stop(time):
        if time > 0.3:
            raise KeyboardInterrupt

    def run(**more):
        return moored().run(0.6, tol=1e-4, integrator=integrator, output_step=0.1, **more)

    whole = run()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        assert run(save=tmp_path / "x.nc", progress=stop).status == "interrupted"
    rest = run(save=tmp_path / "x.nc", resume=True)
    assert np.array_equal(rest["buoy.position"], whole["buoy.position"])


def test_statics_and_modes_are_those_of_the_still_surface():
    scenes = moored(), moored(waves=[fu.Wave(0.01, period=2.0)])
    rests = [scene.equilibrium() for scene in scenes]
    assert np.array_equal(rests[0]["line.position"], rests[1]["line.position"])
    assert np.array_equal(*(scene.modes(3, about=rest).frequency for scene, rest in zip(scenes, rests, strict=True)))


def test_a_plane_in_space_has_the_same_waves():
    runs = []
    for element in ("cable8p", "cable12"):
        scene = fu.Scene(gravity=(0, 0, -G))
        wire = scene.cable("line", start=(2, 1, -3), end=(2, 5, 0.4), elements=4, element=element, up=(0, 0, 1),
                           strain="engineering", section=fu.Circle(radius=0.05),
                           material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.0, density=1300))
        scene.pin(wire, s=0.0)
        scene.fluid(density=WATER, surface=0.0, waves=[fu.Wave(0.3, period=3.0, direction=(0, 2, 0), phase=0.3)])
        scene.drag(wire, normal=1.2, added_mass=1.0)
        runs.append(scene.run(0.5, tol=1e-7, integrator="radau", output_step=0.25)["line.nodal_vectors"][-1, :, 0])
    assert np.abs(runs[0] - runs[1]).max() < 1e-6


def test_scene_files_say_the_same():
    scene = moored(waves=fu.jonswap(significant_height=0.5, peak_period=4.0, components=5))
    text = scene.to_toml()
    again = fu.Scene.from_toml(text)
    assert again.to_toml() == text and again.fluids["sea"] == scene.fluids["sea"]


def sea(**more):
    return lambda s: s.fluid("sea", **{"density": WATER, "surface": 0.0, "waves": [fu.Wave(0.1, period=4)]} | more)


REFUSED = {
    "surface": (sea(surface=None), "has waves without a surface"),
    "depth": (sea(waves=None, depth=3.0), "has a depth without waves"),
    "table": (sea(table=fu.VelocityTable(y=[-9, 9], velocity=[[1, 0, 0], [1, 0, 0]], interpolation="linear")),
              "has waves with a table"),
    "period": (lambda s: fu.Wave(0.1, period=-4), "period must be positive"),
    "steep": (sea(waves=[fu.Wave(2.0, period=4)]), "it breaks, at 0.143 of the length"),
    "shallow": (sea(waves=[fu.Wave(0.4, period=12)], depth=1.5), "too long for the linear theory in a depth of 1.5 m"),
    "not level": (sea(waves=[fu.Wave(0.1, period=4, direction=(1, 1, 0))]), "which is not level"),
    "two surfaces": (lambda s: (s.fluid("oil", density=800, surface=2.0), sea()(s)), "one of them has waves"),
    "none": (sea(waves=[]), "must be a list of 1 to 1000 waves"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refusals(case):
    change, message = REFUSED[case]
    with pytest.raises(fu.SceneError) as error:
        change(fu.Scene(gravity=(0, -G, 0)))
    assert message in str(error.value)


@pytest.mark.parametrize("first", ["drag", "waves"])
def test_ropes_in_waves_are_refused(first):
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.rope("rope", route=[fu.Anchor(at=(0, -2, 0)), fu.Sheave("wheel", at=(1.5, 0, 0), radius=0.2, side="right"),
                              fu.Anchor(at=(3, -2, 0))], tension=10.0, element="cable8p", elements=2,
               section=fu.Circle(radius=0.01),
               material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.0, density=3000))
    scene.fluid("air", density=1.2)
    steps = [lambda: scene.drag("rope", normal=1.0, fluid="air"), lambda: sea()(scene)]
    steps = steps if first == "drag" else steps[::-1]
    steps[0]()
    with pytest.raises(fu.SceneError, match='is on rope "rope", whose equations have a surface at rest'):
        steps[1]()


def test_waves_need_gravity():
    with pytest.raises(fu.SceneError, match="has waves, in a scene without gravity"):
        sea()(fu.Scene(gravity=(0, 0, 0)))


@pytest.mark.parametrize(("integrator", "message"), [
    ("energy", "has no discrete gradient of it"), ("linear", "does not support")])
def test_integrators_without_waves_refuse_them(integrator, message):
    with pytest.raises(fu.SceneError, match=message):
        moored().run(0.1, step=0.01, integrator=integrator, output_step=0.1)


def test_length_in_deep_water_is_that_of_the_period():
    assert fu.Wave(1.0, period=10.0).wave_number(G, None) == pytest.approx((2 * pi / 10) ** 2 / G)
    assert fu.Wave(1.0, period=500.0).wave_number(G, 1.0) == pytest.approx(2 * pi / 500 / sqrt(G), rel=1e-4)
