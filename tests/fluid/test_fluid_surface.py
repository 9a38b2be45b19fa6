"""Fluids with a surface: falling, floating and standing bodies and lines; closed forms, energy, derivatives."""

import warnings
from itertools import product
from math import asin, cbrt, pi, sqrt

import funicular as fu
import numpy as np
import pytest
from derivatives import error_by_drags
from expectations import unaccounted
from funicular.view.surfaces import placed_surface

INTEGRATORS = ("genalpha", "energy", "explicit", "radau")
G, WATER = 9.81, 1025.0
VOLUME, MASS = 0.3, 100.0
RADIUS = cbrt(3 * VOLUME / (4 * pi))


def buoy(above, gravity=(0, -G, 0), level=0.0, velocity=(0, 0, 0), **drag):
    """Return a buoy of 0.3 m³ and 100 kg with its centre at a height over a sea level."""
    scene = fu.Scene(gravity=gravity)
    scene.rigid_body("buoy", mass=MASS, inertia=(1, 1, 1), position=(0, level + above, 0), velocity=velocity)
    scene.fluid("sea", density=WATER, surface=level)
    scene.drag("buoy", **{"area": 1.0, "coefficient": 0.8, "volume": VOLUME} | drag)
    return scene


def segment(depth, radius):
    """Return the wet volume of a sphere at a depth, and the area of its waterplane."""
    return pi * depth**2 * (3 * radius - depth) / 3, pi * depth * (2 * radius - depth)


def draught_of_sphere(volume, radius):
    return next(float(r.real) for r in np.roots([-pi / 3, pi * radius, 0, -volume])
                if abs(r.imag) < 1e-12 and 0 < r.real < 2 * radius)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_buoy_above_the_sea_falls_freely_and_comes_to_float(integrator):
    run = buoy(5.0).run(12.0, tol=1e-5, integrator=integrator, output_step=0.25)
    entry = sqrt(2 * (5 - RADIUS) / G)
    free = run.time < entry
    assert run.time[free][-1] == 0.75
    assert run["buoy.position"][free, 1] == pytest.approx(5 - G * run.time[free] ** 2 / 2, abs=1e-9)
    assert np.abs(run["drag_1.force"][free]).max() == 0
    draught = draught_of_sphere(MASS / WATER, RADIUS)
    assert run["buoy.position"][-1, 1] == pytest.approx(RADIUS - draught, abs=0.02)  # it bobs
    assert unaccounted(run) < (1e-12 if integrator == "energy" else 1e-4) * run.energy_balance().exchanged


@pytest.mark.parametrize("shift", [0.0, 137.5])
def test_a_sphere_floats_where_it_displaces_its_mass_and_heaves_by_its_waterplane(shift, validated):
    scene = buoy(-0.05, level=shift, added_mass=0.5)
    rest = scene.equilibrium()
    draught = draught_of_sphere(MASS / WATER, RADIUS)
    given = {"source": "closed form, spherical cap"}
    validated("Fluid", "floating sphere", "position", [0, shift + RADIUS - draught, 0], rest["buoy.position"], unit="m",
              scale=1.0, bound=1e-9, **given)
    assert rest["drag_1.force"] == pytest.approx([0, MASS * G, 0])
    below, waterplane = segment(draught, RADIUS)
    heave = sqrt(WATER * G * waterplane / (MASS + 0.5 * WATER * below))
    validated("Fluid", "floating sphere", "angular frequency of heave", heave,
              float(scene.modes(6, about=rest).angular_frequency[-1]), unit="rad/s", bound=1e-8, **given)


@pytest.mark.parametrize("dim", [2, 3])
def test_a_box_floats_and_heaves_as_a_column(dim):
    """Draught m/(rho A), period 2 pi sqrt(m/(rho g A)), for a surface that cuts the sides."""
    scene = buoy(0.1, height=0.6, area=0.0)
    if dim == 2:
        scene.cable("line", start=(3, 0, 0), end=(4, 0, 0), elements=1, element="cable8p",
                    section=fu.Circle(radius=0.01),
                    material=fu.Material(youngs_modulus=1e7, poisson_ratio=0, density=1000))
        for s in (0.0, 1.0):
            scene.clamp("line", s=s)
    rest, waterplane = scene.equilibrium(), VOLUME / 0.6
    draught = MASS / (WATER * waterplane)
    assert rest["buoy.position"][1] == pytest.approx(0.3 - draught, abs=1e-9)
    period = 2 * pi / sqrt(WATER * G * waterplane / MASS)
    state = {"buoy.position": rest["buoy.position"] + [0, 0.05, 0], "buoy.orientation": (1, 0, 0, 0)}
    run = scene.run(period, initial=state, tol=1e-8, integrator="radau", output_step=period / 8)
    heave = run["buoy.position"][:, 1] - rest["buoy.position"][1]
    assert heave == pytest.approx(0.05 * np.cos(2 * pi * run.time / period), abs=1e-6)


def test_buoyancy_gives_back_what_it_took():
    """The work into the water is rho g times the wet volume integrated over the depth, on any path."""
    run = buoy(2.0, area=0.0).run(1.6, tol=1e-9, integrator="radau", output_step=0.05)
    u = -run["buoy.position"][:, 1] / RADIUS
    depth = np.where(u < -1, 0, np.where(u > 1, u, -(u**4) / 16 + 3 * u**2 / 8 + u / 2 + 3 / 16))
    assert u.max() > 1.5
    assert run["energy.external"] == pytest.approx(-WATER * G * VOLUME * RADIUS * depth, abs=1e-3)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_added_mass_grows_with_the_wet_part_and_gives_its_energy_back(integrator):
    """Without weight (m + C rho V c) v² is constant through an entry and an exit."""
    scene = buoy(1.0, gravity=(0, 0, 0), velocity=(0.2, -2, 0), area=0.0, added_mass=0.5)
    run = scene.run(1.0, tol=1e-7 if integrator in ("explicit", "radau") else 1e-5, integrator=integrator,
                    output_step=0.05)
    u = np.clip(-run["buoy.position"][:, 1] / RADIUS, -1, 1)
    mass = MASS + 0.5 * WATER * VOLUME * (1 + u) ** 2 * (2 - u) / 4
    speed = np.linalg.norm(run["buoy.velocity"], axis=1)
    assert u[-1] == 1 and speed[-1] < 0.7 * speed[0]
    assert mass * speed**2 == pytest.approx(MASS * speed[0] ** 2, rel=2e-4)
    assert run["buoy.velocity"][:, 0] * mass == pytest.approx(0.2 * MASS, rel=2e-4)
    kinetic = run["energy.kinetic"]
    assert np.ptp(kinetic) < (1e-12 if integrator == "energy" else 2e-4) * kinetic[0]


def wetted(dim, added_mass=None, at=(-0.1, 0.05, 0), wet_wire=True):
    """Return a body with its centre of buoyancy in the surface and apart from its mass centre, and a cable cut by the
    surface.
    """
    scene = fu.Scene()
    wire = scene.cable("wire", start=(0, 0.3, 0), end=(1, -0.4, 0), elements=3,
                       element="beam24" if dim == 3 else "beam12p", section=fu.Circle(radius=0.03),
                       material=fu.Material(youngs_modulus=1e6, poisson_ratio=0, density=1500))
    scene.pin(wire, s=0.0)
    spin = (0.5, 1.0, 2.0) if dim == 3 else (0, 0, 2.0)
    body = scene.rigid_body("buoy", mass=3.0, inertia=(0.02, 0.03, 0.04), position=(1.2, 0.1 - at[1], 0),
                            velocity=(1, -0.5, 0), angular_velocity=spin)
    scene.fluid("sea", density=WATER, velocity=(0.8, 0.2, -0.5 if dim == 3 else 0), surface=0.1,
                profile=fu.TableProfile(height=[-3, 3], factors=[0.4, 1.5]))
    if wet_wire:
        scene.drag(wire, normal=1.1, tangential=0.05, added_mass=added_mass)
    scene.drag(body, area=0.02, coefficient=0.8, at=at, volume=4e-3, added_mass=added_mass)
    return scene


@pytest.mark.parametrize("dim", [2, 3])
def test_newtons_matrix_has_the_waterplane(dim):
    assert error_by_drags(wetted(dim)) < 1e-6


@pytest.mark.parametrize("dim", [2, 3])
def test_newtons_matrix_has_the_added_mass_of_the_wet_part(dim):
    """The point is the mass centre, since the matrix omits the change of a point's acceleration with rotation."""
    assert error_by_drags(wetted(dim, added_mass=0.6, at=(0, 0, 0), wet_wire=False)) < 1e-6


@pytest.mark.parametrize(("integrator", "dim"), [("explicit", 3), ("radau", 2), ("energy", 3), ("genalpha", 2)])
def test_what_is_half_in_water_balances_its_energy(integrator, dim):
    scene = wetted(dim, added_mass=0.8)
    run = scene.run(0.3, tol=1e-6 if integrator in ("explicit", "radau") else 1e-4, integrator=integrator,
                    output_step=0.05)
    assert run["energy.dissipated"][-1] > 0.1
    assert unaccounted(run) < (1e-6 if integrator == "energy" else 1e-4)


def spar(elements, start):
    """Return a slender upright float of 4 m with its top at a height."""
    scene = fu.Scene()
    wire = scene.cable("spar", start=(0, start, 0), end=(0, start - 4, 0), elements=elements, element="cable8p",
                       section=fu.Circle(radius=0.05), strain="engineering",
                       material=fu.Material(youngs_modulus=1e10, poisson_ratio=0.0, density=700))
    scene.fluid("sea", density=WATER, surface=0.0)
    scene.drag(wire, normal=1.2)
    return scene


@pytest.mark.parametrize(("elements", "element"), [(1, "cable12"), (3, "cable8p"), (7, "beam12p"), (4, "cable18")])
def test_a_line_that_hangs_into_water_bears_its_weight_less_what_it_displaces(elements, element):
    """T(top) = g A (rho 4 - rho_w (3 + stretch)), with the consistent stretch."""
    scene = fu.Scene()
    wire = scene.cable("spar", start=(0, 1, 0), end=(0, -3, 0), elements=elements, element=element,
                       section=fu.Circle(radius=0.05), material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.0,
                                                                           density=1700),
                       **({} if "beam" in element else {"strain": "engineering"}))
    scene.pin(wire, s=0.0)
    scene.fluid("sea", density=WATER, surface=0.0)
    scene.drag(wire, normal=1.2)
    force = scene.equilibrium()["spar@0.force"]
    area = pi * 0.05**2
    assert force[1] == pytest.approx(G * area * (1700 * 4 - WATER * 3), rel=2e-5)  # but for the stretch, 5e-5 m


def test_a_spar_floats_upright_at_archimedes_draught_in_every_mesh():
    for elements, start in product((1, 4, 5), (0.9, 1.27)):
        state = spar(elements, start).equilibrium(seek_stable=False)  # it would fall over
        assert state["spar.position"][0, 1] == pytest.approx(4 * (1 - 700 / WATER), abs=1e-6)


def test_a_floating_line_lies_in_the_water_as_its_section_does():
    """A circular section of the density rho_l sinks until its segment is rho_l/rho of its area."""
    scene = fu.Scene()
    wire = scene.cable("line", start=(0, 0.01, 0), end=(5, 0.01, 0), elements=4, element="cable12",
                       section=fu.Circle(radius=0.05), material=fu.Material(youngs_modulus=1e7, poisson_ratio=0.0,
                                                                           density=600))
    scene.fluid("sea", density=WATER, surface=0.0)
    scene.drag(wire, normal=1.2, added_mass=1.0)
    rest = scene.equilibrium()
    u = -rest["line.position"][:, 1] / 0.05
    assert np.ptp(u) < 1e-8
    assert (asin(u[0]) + u[0] * sqrt(1 - u[0] ** 2)) / pi + 0.5 == pytest.approx(600 / WATER, abs=1e-9)
    mass = 600 + 600.0  # with that of the water: of the wet part, which displaces as much
    stiffness = WATER * G * 2 * 0.05 * sqrt(1 - u[0] ** 2)
    assert np.abs(scene.modes(30, about=rest).angular_frequency - sqrt(stiffness / (mass * pi * 0.05**2))).min() < 1e-6


def mast(**more):
    """Return a stiff upright mast of 8 m, half of it in water flowing along z, the other half in wind along x."""
    scene = fu.Scene()
    wire = scene.cable("mast", start=(0, -4, 0), end=(0, 4, 0), elements=3, element="cable12",
                       section=fu.Circle(radius=0.05), material=fu.Material(youngs_modulus=2e11, poisson_ratio=0.3,
                                                                           density=7850))
    scene.clamp(wire, s=0.0)
    scene.clamp(wire, s=wire.length)
    scene.fluid("sea", density=WATER, velocity=(0, 0, 0.5), surface=0.5)
    scene.fluid("wind", density=1.25, velocity=(15, 0, 0), **more)
    return scene


def test_wind_above_water_each_acts_where_it_is():
    scene = mast()
    scene.drag("mast", normal=1.2, displaced_area=0.0, diameter=0.1)
    force = scene.equilibrium()["drag_1.force"]
    wind, current = 1.25 / 2 * 0.1 * 1.2 * 15**2 * 3.5, WATER / 2 * 0.1 * 1.2 * 0.5**2 * 4.5
    assert force == pytest.approx([wind, 0, current], rel=1e-5, abs=0.01)  # it gives way by micrometres


def test_a_drag_in_each_fluid_has_its_own_coefficient():
    scene = mast()
    scene.drag("mast", normal=1.2, displaced_area=0.0, fluid="sea")
    scene.drag("mast", normal=0.7, displaced_area=0.0, fluid="wind")
    rest = scene.equilibrium()
    assert rest["drag_1.force"] == pytest.approx([0, 0, WATER / 2 * 0.1 * 1.2 * 0.5**2 * 4.5], rel=1e-5, abs=0.01)
    assert rest["drag_2.force"] == pytest.approx([1.25 / 2 * 0.1 * 0.7 * 15**2 * 3.5, 0, 0], rel=1e-5, abs=0.01)


def test_a_layer_between_two_fluids_bears_what_both_bear():
    """Oil on water: m = rho_w V_w + rho_o V_o, for a column."""
    scene = buoy(-0.1, height=0.6, area=0.0)
    scene.fluid("oil", density=800, surface=0.15)
    scene.drag("buoy", fluid="oil", volume=VOLUME, height=0.6)
    scene.fluid("air", density=1.2, velocity=(5, 0, 0))
    rest = scene.equilibrium()
    in_water = (MASS / (VOLUME / 0.6) - 800 * 0.15) / WATER
    assert rest["buoy.position"][1] == pytest.approx(0.3 - in_water, abs=1e-9)


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit"])
def test_the_order_stays_through_the_surface(integrator):
    """Errors of a body that falls into water decrease with the order of its smooth motion, at least 2."""
    def after(step):
        scene = buoy(0.5, added_mass=0.5)
        return scene.run(0.6, step=step, integrator=integrator, output_step=0.6)["buoy.position"][-1, 1]

    best = buoy(0.5, added_mass=0.5).run(0.6, tol=1e-11, integrator="radau", output_step=0.6)["buoy.position"][-1, 1]
    errors = [abs(after(step) - best) for step in (0.04, 0.02, 0.01)]
    assert errors[0] / errors[2] > 10


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_resumed_run_goes_on_within_an_entry(integrator, tmp_path):
    """The surface cuts the buoy at the checkpoint; flags of the state hold its sides."""
    def stop(time):
        if time > 0.26:
            raise KeyboardInterrupt

    def run(**more):
        return buoy(0.5, added_mass=0.5).run(0.6, tol=1e-4, integrator=integrator, output_step=0.05, **more)

    whole = run()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        assert run(save=tmp_path / "x.nc", progress=stop).status == "interrupted"
    rest = run(save=tmp_path / "x.nc", resume=True)
    assert np.abs(whole["buoy.position"][4:6, 1]).max() < RADIUS
    assert np.array_equal(rest["buoy.position"], whole["buoy.position"])


def test_scene_files_say_the_same():
    scene = mast(surface=20.0)
    scene.drag("mast", normal=1.2)
    scene.rigid_body("buoy", mass=MASS, inertia=(1, 1, 1), position=(9, 0, 0))
    scene.drag("buoy", volume=VOLUME, height=0.6)
    text = scene.to_toml()
    assert "surface = 20.0" in text and "height = 0.6" in text
    again = fu.Scene.from_toml(text)
    assert again.to_toml() == text
    higher = again.replace("sea", surface=1.0)
    forces = [each.equilibrium()["drag_1.force"] for each in (scene, again, higher)]
    assert np.array_equal(forces[0], forces[1]) and forces[2][1] > forces[0][1] + 1


REFUSED = {
    "one level": (lambda s: s.fluid("oil", density=800, surface=0.0),
                  'fluid "oil": has its surface at 0 m, as the fluid "sea" has'),
    "no number": (lambda s: s.fluid("oil", density=800, surface=float("inf")), "surface must be finite"),
    "height": (lambda s: s.drag("buoy", volume=1.0, height=-1.0), "height must be positive, got -1 m"),
    "height of a cable": (lambda s: s.drag("line", height=1.0), "takes no height"),
    "polar": (lambda s: s.drag("line", chord=(0, 1, 0), diameter=0.1, polar=fu.Polar(
        angle=[-pi, 0, pi], drag=[1, 1, 1], lift=[0, 0, 0])), "the wet part of a section that turns is not known"),
    "twice": (lambda s: (s.drag("line", normal=1.0), s.fluid("air", density=1.2), s.drag("line", normal=1.0)),
              'has the drag "drag_1" already'),
    "two without": (lambda s: (s.fluid("air", density=1.2), s.drag("line", normal=1), s.fluid("gas", density=0.8)),
                    'fills the same place as the fluid "air"'),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refusals(case):
    change, message = REFUSED[case]
    scene = fu.Scene()
    scene.cable("line", start=(0, 0, 0), end=(1, 0, 0), elements=1, element="beam24", section=fu.Circle(radius=0.05),
                material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.0, density=1000))
    scene.rigid_body("buoy", mass=1, inertia=(1, 1, 1), position=(0, 0, 0))
    scene.fluid("sea", density=WATER, surface=0.0)
    with pytest.raises(fu.SceneError) as error:
        change(scene)
    assert message in str(error.value)


def test_pictures_show_the_surface_where_it_is_in_sight(tmp_path):
    scene = buoy(2.0, level=30.0)
    scene.fluid("deep", density=1100, surface=-5000.0)
    run = scene.run(1.0, tol=1e-4, output_step=0.1)
    sea = {body.name: body for body in run.animation("falls").clips[0].bodies}["sea"]
    corners, _ = placed_surface(sea, 0, 0.0)
    assert np.ptp(corners[:, 1]) < 1e-12 and corners[0, 1] == pytest.approx(30)
    assert {body.name for body in run.animation("falls").clips[0].bodies} == {"buoy", "sea"}
    run.save_html(tmp_path / "page.html")
    assert (tmp_path / "page.html").stat().st_size > 10000


def table(low, high, slow=1.0):
    return fu.VelocityTable(y=[low, high], velocity=[[slow, 0, 0], [1, 0, 0]], interpolation="linear")


def test_a_table_of_the_water_reaches_up_to_its_surface():
    """A part above the surface, or floating in it, does not leave the table."""
    scene = buoy(1.0)
    scene.fluid("deep", density=1100, surface=-50.0, table=table(-100, -50))
    scene.drag("buoy", fluid="deep", area=1.0)
    scene = scene.replace("sea", table=table(-50, 0, slow=0.0))
    run = scene.run(3.0, tol=1e-4, output_step=0.5)
    assert run["buoy.velocity"][-1, 0] > 0.2 and not run.report["messages"]
    scene.fluid("oil", density=800, surface=2.0, table=table(5, 9))
    with pytest.raises(fu.SceneError, match="outside of the table"):
        scene.drag("buoy", fluid="oil", area=1.0)


def test_a_barge_of_columns_heels_as_its_waterplane_and_the_middles_of_the_columns_have_it():
    """K = rho g sum(A x²) + m g h, with the height h of the middles of the columns over the mass centre."""
    scene = fu.Scene()
    mass, inertia, arm, height, up = 400.0, 150.0, 0.8, 1.0, 0.1
    scene.rigid_body("barge", mass=mass, inertia=(inertia, inertia, inertia), position=(0, 0.05, 0))
    scene.fluid("sea", density=WATER, surface=0.0)
    for x in (-arm, arm):
        scene.drag("barge", at=(x, up, 0), volume=0.4, height=height)
    rest = scene.equilibrium()
    waterplane = 2 * 0.4 / height
    assert rest["barge.position"][1] + up == pytest.approx(height / 2 - mass / WATER / waterplane, abs=1e-9)
    heel = sqrt((WATER * G * waterplane * arm**2 + mass * G * up) / inertia)
    heave = sqrt(WATER * G * waterplane / mass)
    found = scene.modes(6, about=rest).angular_frequency
    for expected in (heel, heave):
        assert np.abs(found - expected).min() < 1e-6 * expected
