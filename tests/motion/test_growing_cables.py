"""Temperature of cables and stress-free lengths that are signals: closed forms, every law, the balance of energy."""

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from interrupted_runs import check_file_and_resume

WARM, EXPANSION = 200.0, 1e-4
GROWTH = 1 + WARM * EXPANSION
MATERIAL = {"youngs_modulus": 1e9, "poisson_ratio": 0.3, "density": 1000.0, "thermal_expansion": EXPANSION}
SHORTER = fu.Ramp(start=0.02, end=0.12, before=1.0, after=0.9)
COOLER = fu.Ramp(start=0.02, end=0.12, before=0.0, after=-100.0)
COOLING = {"temperature": fu.Ramp(start=0.0, end=0.04, before=0.0, after=-50.0)}
METHODS = {"genalpha": {"tol": 1e-6}, "radau": {"tol": 1e-7}, "explicit": {"tol": 1e-7}, "energy": {"step": 2e-4},
           "dissipating": {"step": 2e-4, "integrator": "energy", "spectral_radius": 0.8}}


def string(temperature: object, elements: int = 32, length: float = 100.0, shape: str | None = None,
           **given) -> fu.Scene:
    """Return a line of EA 1e6 N, 10 N/m, a span and by default a length of 100 m; its bending length is 0.1 mm."""
    scene = fu.Scene(gravity=(0, -10, 0))
    scene.cable("line", start=(0, 0, 0), end=(100, 0, 0), elements=elements, element="cable12", strain="engineering",
                membrane="assumed", temperature=temperature, rest_length=length, shape=shape,
                section=fu.GeneralSection(area=1e-3, second_moment_about_y=1e-14, second_moment_about_z=1e-14),
                material=fu.Material(**{**MATERIAL, "thermal_expansion": 1.2e-5, **given}))
    scene.pin("line", s=0)
    scene.pin("line", s=length)
    return scene


def pull(state: fu.Equilibrium) -> float:
    """Return the horizontal force on the first support, N."""
    return float(abs(state["line@0.force"][0]))


@pytest.mark.parametrize(("temperature", "force"), [(-40, 3624.711844), (0, 3456.022081), (40, 3302.255931)])
def test_horizontal_force_of_a_line(temperature, force, validated):
    """The elastic catenary of the grown stress-free length, whose weight stays."""
    rest = string(temperature).equilibrium()
    validated("Statics", f"line of EA 1e6 N, 100 m, 10 N/m, at {temperature} K", "horizontal force", force, pull(rest),
              unit="N", bound=1e-8, source="elastic catenary, weight kept, 1.2e-5 1/K", mesh="32 elements")
    tension = rest.section_forces("line").tension.values
    constitutive = rest.section_forces("line", method="constitutive").tension.values
    assert tension.min() == pytest.approx(force, rel=1e-6)  # within an element the slope is not exact
    assert np.abs(tension - constitutive).max() < 1e-5 * force


def test_a_warm_line_is_a_longer_line_of_the_same_weight():
    growth = 1 + 40 * 1.2e-5
    warm_line = string(40.0, length=101.0, shape="hanging")
    longer = string(0.0, length=101 * growth, shape="hanging", density=MATERIAL["density"] / growth)
    rest, same = warm_line.equilibrium(), longer.equilibrium()
    assert np.abs(rest["line.position"] - same["line.position"]).max() < 1e-10
    assert pull(rest) == pytest.approx(pull(same), rel=1e-12)
    found, expected = (state.section_forces("line", s=np.array([2.0, 33.0, 70.0]) * scale)
                       for state, scale in ((rest, 1.0), (same, growth)))
    for name in ("tension", "moment"):  # this one below the resolution of the mesh
        assert np.abs(found[name] - expected[name].values).max() < 1e-8 * np.abs(expected[name]).max(), name
    frequencies = [scene.modes(4, about=state).frequency for scene, state in ((warm_line, rest), (longer, same))]
    assert frequencies[0] == pytest.approx(frequencies[1], rel=1e-9)


def test_forces_converge_with_elements():
    errors = [abs(pull(string(40, elements=n).equilibrium()) / 3302.255931 - 1) for n in (2, 4, 8)]
    assert errors[0] > 10 * errors[1] and errors[1] > 10 * errors[2]


BODIES = [("cable8p", None, False), ("cable12", None, False), ("cable18", None, False), ("cable12", None, True),
          *((element, law, curved) for element in ("beam24", "beam12p") for law in ("continuum", "structural")
            for curved in (False, True)), ("beam24", "poisson_split", False)]


def warm(element: str, law: str | None, curved: bool, **given) -> fu.Scene:
    """Return a clamped cable, straight or an arc, in a warm scene."""
    scene = fu.Scene(gravity=(0, 0, 0), temperature=WARM)
    arc = [(np.cos(angle), np.sin(angle), 0) for angle in np.linspace(0, 1, 21)]
    shape = {"points": arc} if curved else {"start": (0, 0, 0), "end": (1, 0, 0)}
    planar = element.endswith("p")
    scene.cable("body", elements=5, element=element, law=law, up=(0, 1, 0) if planar else (0, 0, 1), **shape, **given,
                section=fu.Rectangle(height=0.03, width=0.03), material=fu.Material(**MATERIAL))
    scene.clamp("body", s=0)
    return scene


@pytest.mark.parametrize(("element", "law", "curved"), BODIES)
def test_free_expansion_is_free_of_stress(element, law, curved):
    """The stress-free shape grows, its angles stay; bending frequencies fall by g^(-3/2), for mass and EI stay."""
    scene = warm(element, law, curved)
    rest, cable = scene.equilibrium(), scene.cables["body"]
    drawn, found = cable.nodal_vectors[:, 0], rest["body.nodal_vectors"]
    if element != "cable12" or not curved:  # across its plane a curved cable has no stiffness
        assert np.abs(found[:, 0] - drawn[0] - GROWTH * (drawn - drawn[0])).max() < 1e-12
        slope = cable.kind_of_element.nodal_vectors.index("r_x")
        assert np.abs(np.linalg.norm(found[:, slope], axis=1) - GROWTH).max() < 1e-12
        cold = scene.replace("body", temperature=0.0)
        ratio = scene.modes(1, about=rest).frequency[0] / cold.modes(1).frequency[0]
        assert ratio == pytest.approx(GROWTH**-1.5, rel=5e-3)  # a thick arc has stretch and shear, too
    for method in ("balance", "constitutive"):
        forces = rest.section_forces("body", method=method)
        assert np.abs(forces.force).max() < 1e-8  # of EA = 9e5 N
        assert np.abs(forces.moment).max() < 1e-9
    run = scene.run(duration=1e-3, output_step=1e-3, step=1e-4, integrator="genalpha", initial=rest)
    assert run["energy.elastic"].max() < 1e-20


STIFF, EXPANSIONS = (2e9, 1e9), (1.2e-5, 2.4e-5)


def two_materials(element: str, law: str | None, temperature: object, held: bool = True, **given) -> fu.Scene:
    """Return a bar of 1 m and 0.5 m of two materials, clamped at its start, and at its end if held."""
    scene = fu.Scene(gravity=(0, 0, 0))
    pieces = [fu.Piece(length=length, section=fu.Circle(radius=0.01), elements=2, material=fu.Material(
        youngs_modulus=E, poisson_ratio=0.0, density=1000.0, thermal_expansion=expansion, **given))
        for length, E, expansion in zip((1.0, 0.5), STIFF, EXPANSIONS, strict=True)]
    scene.cable("bar", start=(0, 0, 0), end=(1.5, 0, 0), element=element, law=law, temperature=temperature,
                pieces=pieces, strain=None if law else "engineering")
    for s in (0, 1.5)[: 1 + held]:
        scene.clamp("bar", s=s)
    return scene


@pytest.mark.parametrize("warm", [-50.0, 0.5])
@pytest.mark.parametrize(("element", "law"), [("cable12", None), ("cable8p", None), ("cable18", None),
                                              ("beam24", "structural"), ("beam12p", "structural")])
def test_a_bar_of_two_materials(element, law, warm):
    """N = -dT (a1 L1 + a2 L2) / (L1/EA1 + L2/EA2), where the lengths below are those at the temperature."""
    grown = [length * (1 + warm * each) for length, each in zip((1.0, 0.5), EXPANSIONS, strict=True)]
    soft = [length / (E * np.pi * 1e-4) for length, E in zip(grown, STIFF, strict=True)]
    rest = two_materials(element, law, warm).equilibrium(seek_stable=False)
    for method in ("balance", "constitutive"):
        tension = rest.section_forces("bar", s=[0.2, 0.9, 1.3], method=method).tension.values
        assert tension == pytest.approx((1.5 - sum(grown)) / sum(soft), rel=1e-10)
    free = two_materials(element, law, warm, held=False).equilibrium()
    assert free["bar.position"][-1, 0] == pytest.approx(sum(grown), abs=1e-14)
    assert np.abs(free.section_forces("bar").force).max() < 1e-8  # of EA = 6e5 N


@pytest.mark.parametrize(("element", "law"), [("cable12", None), ("cable8p", None), ("beam24", "structural"),
                                              ("beam24", "continuum"), ("beam12p", "poisson_split")])
def test_a_held_bar_is_compressed(element, law):
    """Between clamps, which hold the section across: without a Poisson ratio."""
    scene = warm(element, law, False)
    scene.pin("body", s=1)
    scene = scene.replace("body", material=fu.Material(**{**MATERIAL, "poisson_ratio": 0.0}))
    forces = scene.equilibrium(seek_stable=False).section_forces("body", method="constitutive")
    strain = (1 / GROWTH - 1) if law == "structural" else (1 / GROWTH**2 - 1) / 2
    stress = MATERIAL["youngs_modulus"] * 9e-4 * strain * (1.0 if law == "structural" else 1 / GROWTH)
    assert forces.tension.values == pytest.approx(stress, rel=1e-6)


LAWS = {
    "green": {},
    "engineering": {"strain": "engineering"},
    "linear": {"strain": "engineering", "curvature": "linear"},
    "assumed": {"membrane": "assumed"},
    "reduced": {"strain": "engineering", "membrane": "reduced"},
    "tension only": {"strain": "engineering", "membrane": "tension_only"},
    "planar": {"element": "cable8p"},
    "cable18": {"element": "cable18"},
    "damped": {"damping_time": 1e-3},
    "damped cable18": {"element": "cable18", "damping_time": 1e-3},
    "cooled": {"rest_length": 1.0, "temperature": COOLER, "damping_time": 1e-3},
    "warm tendon": {"temperature": -20.0, "damping_time": 1e-3},
    "curved": {"points": [(np.sin(a) / 0.9, np.cos(a) / 0.9, 0) for a in np.linspace(-0.45, 0.45, 21)]},
}


def tendon(damping_time: float = 0.0, **given) -> fu.Scene:
    """Return a soft tendon of 1 m that is shortened, with a mass hung from it."""
    scene = fu.Scene()
    drawn = {} if "points" in given else {"start": (0, 0, 0), "end": (1, 0, 0)}
    soft = {**MATERIAL, "youngs_modulus": 2e6, "thermal_expansion": 1e-3, "damping_time": damping_time}
    uniform = {} if "pieces" in given else {"elements": 6, "section": fu.Circle(radius=5e-3), "rest_length": SHORTER,
                                            "material": fu.Material(**soft)}
    scene.cable("tendon", **{"element": "cable12", **uniform, **drawn, **given})
    scene.pin("tendon", s=0)
    scene.pin("tendon", s=1)
    middle = scene.cables["tendon"].point(0.5) - (0, 0.2, 0)
    scene.rigid_body("mass", mass=0.05, inertia=(1e-4, 1e-4, 1e-4), position=tuple(middle))
    scene.spring(("tendon", 0.5), "mass", stiffness=200, length=0.2, name="rope")
    return scene


def imbalance(run: fu.Run) -> float:
    """Return the largest change of the sum of all energies less the external work, J."""
    stored = sum(run[f"energy.{part}"] for part in ("kinetic", "elastic", "potential", "dissipated"))
    return float(np.ptp(stored - run["energy.external"]))


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("law", LAWS)
def test_the_work_of_growth_is_external(law):
    """Beside each other, the force on the growth factor and the change of energy are those of one law."""
    scene, places = tendon(**LAWS[law]), []
    for method, settings in METHODS.items():
        run = scene.run(duration=0.2, output_step=0.01, **{"integrator": method, **settings})
        work = np.ptp(run["energy.external"])
        assert work > 0.01
        assert imbalance(run) < {"energy": 1e-13, "dissipating": 1e-13, "explicit": 1e-7}.get(method, 1e-5) * work
        places.append(run["mass.position"])
    assert max(np.abs(each - places[2]).max() for each in places) < 3e-6


TWO = [fu.Piece(length=0.5, section=fu.Circle(radius=5e-3), elements=3, material=fu.Material(
    youngs_modulus=2e6, poisson_ratio=0.3, density=1000.0, damping_time=1e-3, thermal_expansion=expansion))
    for expansion in (1e-3, 5e-4)]
BEAMS = {
    "continuum": ({"element": "beam12p"}, ["genalpha", "radau", "explicit", "energy", "dissipating"]),
    "structural": ({"element": "beam12p", "law": "structural"}, ["genalpha", "radau", "explicit"]),
    "curved structural": ({**LAWS["curved"], "element": "beam24", "law": "structural"}, ["radau"]),
    "curved continuum": ({**LAWS["curved"], "element": "beam12p", "damping_time": 1e-3}, ["radau", "energy"]),
    "in space": ({"element": "beam24", "damping_time": 1e-3, "rest_length": 1.0, **COOLING}, ["radau", "energy"]),
    "pieces": ({"pieces": TWO, **COOLING}, ["genalpha", "radau", "explicit"]),
    "pieces of a beam": ({"pieces": TWO, **COOLING, "element": "beam12p", "law": "structural"}, ["radau"]),
}


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("law", BEAMS)
def test_the_work_of_growth_of_beams_and_pieces_is_external(law):
    given, methods = BEAMS[law]
    scene = tendon(**given)
    for method in methods:
        run = scene.run(duration=0.04, output_step=0.01, **{"integrator": method, **METHODS[method]})
        work = np.ptp(run["energy.external"])
        assert work > 1e-4
        assert imbalance(run) < {"energy": 3e-12, "dissipating": 3e-12, "explicit": 1e-9}.get(method, 1e-5) * work


@pytest.mark.parametrize(("element", "law"), [("beam12p", "structural"), ("beam12p", "continuum"),
                                              ("beam24", "continuum"), ("cable12", None)])
def test_a_signal_ends_at_the_state_of_its_last_number(element, law):
    """Beams and pieces that a signal has cooled rest as those that are cold: constants of the laws at each instant."""
    scene = two_materials(element, law, fu.Ramp(start=0.0, end=0.01, before=0.0, after=-40.0), damping_time=5e-4)
    run = scene.run(duration=0.05, output_step=0.05, tol=1e-6, integrator="radau", absolute_tol=1e-10)
    rest = two_materials(element, law, -40.0).equilibrium()
    for method in ("balance", "constitutive"):
        found, cold = (each.section_forces("bar", s=[0.2, 1.3], method=method).tension.values for each in (run, rest))
        assert found[-1] == pytest.approx(cold, rel=1e-5)
    assert run["bar.position"][-1] == pytest.approx(rest["bar.position"], abs=1e-8)


def test_a_turnbuckle_pulls_its_line_taut():
    """The state after a slow change is that of rest with the length at its end."""
    scene = string(0.0, damping_time=0.05)
    slow = scene.replace("line", rest_length=fu.Ramp(start=0, end=40, before=100.0, after=99.95))
    run = slow.run(duration=60.0, output_step=1.0, tol=1e-4, initial=slow.equilibrium())
    after = string(0.0).replace("line", temperature=-0.05 / 100 / 1.2e-5).equilibrium()
    tension = run.section_forces("line", s=[50.0]).tension.values[-1, 0]
    assert tension == pytest.approx(float(after.section_forces("line", s=[50.0]).tension[0]), rel=2e-3)
    assert after.section_forces("line", s=[50.0]).tension[0] > 1.05 * 3456


def test_files_and_resuming_keep_every_bit(tmp_path):
    scene = tendon(temperature=-20.0)
    run = check_file_and_resume(scene, tmp_path, 20, duration=0.2, output_step=0.01, tol=1e-4)
    assert run["energy.external"][-1] != 0
    for law in ("structural", "pieces of a beam"):
        beam = tendon(**BEAMS[law][0])
        check_file_and_resume(beam, tmp_path, 20, duration=0.02, output_step=1e-3, tol=1e-3)
    warm = fu.Scene(temperature=fu.Harmonic(amplitude=20, frequency=0.1))
    warm.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=2, element="cable12", section=fu.Circle(radius=0.01),
               material=fu.Material(**MATERIAL))
    again = fu.Scene.from_toml(warm.to_toml())
    assert again.temperature == warm.temperature == again.cables["wire"].temperature
    assert warm.to_toml().count("temperature") == 1  # of the scene: a sweep of it changes what is read from the file
    assert again.to_toml() == warm.to_toml()


@pytest.mark.parametrize("begin", [40.0, 0.0])
def test_the_temperature_of_a_scene_is_adjusted(begin):
    """From 0 K, too, where nothing grows; the adjusted scene is that of the line at its own temperature."""
    scene = fu.Scene(gravity=(0, -10, 0), temperature=begin).with_parts(string(None).parts())
    rest = scene.equilibrium(adjust=["temperature"], to={"line@0.force.x": -3624.711844})
    assert rest.adjusted["temperature"] == pytest.approx(-40.0, abs=1e-6)
    assert rest.scene.temperature == rest.adjusted["temperature"]
    assert pull(rest.scene.equilibrium()) == pytest.approx(3624.711844, rel=1e-9)
    with refused('adjust of "temperature": has no value yet; give a value to begin with'):
        string(None).equilibrium(adjust=["temperature"], to={"line@0.force.x": -3500.0})


@pytest.mark.parametrize("parameter", ["temperature", "rest_length", "material.thermal_expansion",
                                       "material.youngs_modulus"])
def test_adjusting_and_derivatives(parameter):
    """A warm line is brought to another pull by one parameter, whose derivative is that of two states beside it."""
    scene = string(40.0)
    target = "line@0.force.x"
    begin = scene.equilibrium()[target.rpartition(".")[0]][0]
    rest = scene.equilibrium(adjust={f"line.{parameter}": "free"}, to={target: 1.01 * begin})
    assert rest["line@0.force"][0] == pytest.approx(1.01 * begin, rel=1e-7)
    if parameter == "temperature":
        assert 0 < rest.adjusted["line.temperature"] < 40
    assert rest.scene.equilibrium()["line@0.force"][0] == pytest.approx(1.01 * begin, rel=1e-7)


def test_a_state_at_another_temperature_is_refused():
    scene = string(fu.Ramp(start=1, end=2, before=0, after=10))
    colder = string(fu.Ramp(start=1, end=2, before=-10, after=10))
    with pytest.raises(fu.SceneError, match="is at t = 0 another than in the state to start from"):
        colder.run(duration=0.1, initial=scene.equilibrium())
    plain = string(None)
    for here, other in ((plain, scene), (scene, plain)):
        with pytest.raises(fu.SceneError, match="its lengths, stiffnesses and temperatures are"):
            here.run(duration=0.1, initial=other.equilibrium())
        assert pull(here.equilibrium(start=other.equilibrium())) == pytest.approx(pull(plain.equilibrium()), rel=1e-9)
    assert pull(colder.equilibrium(start=scene.equilibrium())) == pytest.approx(pull(string(-10).equilibrium()),
                                                                                rel=1e-9)


def test_refusals():
    with refused('cable "line": has a temperature, but its material has no thermal_expansion; give the material one, 0 '
                 "for a cable that keeps its length"):
        string(20.0, thermal_expansion=None)
    with refused('cable "line": the stress-free length must stay positive, got -0.2 times the length at 0 K; give '
                 "temperature in K above the stress-free state, thermal_expansion in 1/K"):
        string(-1e5)
    with refused('cable "body": the largest stress-free length by the signal of rest_length is more than 4 times the '
                 'smallest, too much for the constants of the law of beam24; give less, or take element="cable12" or '
                 '"cable18"'):
        warm("beam24", "structural", False, temperature=0.0, rest_length=fu.Ramp(start=0, end=1, before=1, after=0.2))
    with refused('cable "line": has signals for rest_length and temperature; give one of them as a number'):
        string(0.0).replace("line", temperature=COOLER, rest_length=SHORTER)
    with refused('cable "line": rest_length must be positive, got 0 m, the least value of the signal'):
        string(0.0).replace("line", rest_length=fu.Ramp(start=0, end=1, before=1.0, after=0.0))
    with refused("scene: temperature must be a number or a signal such as Ramp(start=0, end=1), got 'warm'"):
        fu.Scene(temperature="warm")
    cold = fu.Scene(temperature=-10)
    with refused('cable "wire": has a temperature, but its material has no thermal_expansion; give the material one, 0 '
                 "for a cable that keeps its length"):
        cold.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=2, element="cable12", section=fu.Circle(radius=0.1),
                   material=fu.Material(**{**MATERIAL, "thermal_expansion": None}))
    with pytest.raises(fu.SceneError, match='integrator "linear" does not support a stress-free length that changes'):
        tendon().run(duration=0.1, integrator="linear")
