"""Slack lines drawn straight reach equilibrium from no other shape: in parts, in water, on a bed, by any mesh and
membrane.

References are those of tests/benchmarks/slack_lines.py, which prints them with their cost.
"""

import warnings

import funicular as fu
import numpy as np
import pytest
from catenary import end_forces
from scipy.optimize import fsolve
from slack_lines import LAZY_WAVES, MESHES, G, LazyWave, largest_curvature, lazy_wave, rope, tied_ropes, wire_on_bed

pytestmark = pytest.mark.filterwarnings("ignore:contact .* below its surface:funicular.FunicularWarning",
                                         "ignore:the state is unstable:funicular.FunicularWarning")


def pull(rest: fu.Equilibrium, cable: str) -> float:
    """Return the force at the start of a cable in a state that must be stable."""
    assert rest.stable
    return float(np.linalg.norm(rest[f"{cable}@0.force"]))


@pytest.mark.parametrize("mesh", [100, 200, *(pytest.param(n, marks=pytest.mark.slow) for n in (450, 600, 1000))])
@pytest.mark.parametrize("name", LAZY_WAVES)
@pytest.mark.slow_cases("80 m-200", "200 m-100", "200 m-200")
def test_lazy_waves(name, mesh, validated):
    """Forces and curvatures of another program; 450 and 600 elements once ended at unstable states."""
    data = LAZY_WAVES[name]
    rest = lazy_wave(data, MESHES[mesh]).equilibrium()
    given = {"source": "another program, converged", "variant": "cable12", "mesh": f"{mesh} elements"}
    validated("Statics", f"lazy-wave cable, {name}", "force at the top", data.force, pull(rest, "upper"), unit="N",
              bound=1e-3, **given)
    validated("Statics", f"lazy-wave cable, {name}", "largest curvature", data.curvature, largest_curvature(rest),
              unit="1/m", bound=5e-3, **given)


@pytest.mark.parametrize("fractions", [(0.4, 0.5), (0.3, 0.7)])
def test_parts_may_be_drawn_of_any_length(fractions):
    """The slopes at ties must not keep the ratio of slack of the drawn parts, which gave 9,326 N, 2.5 1/m, or no state.
    """
    data = LAZY_WAVES["80 m"]
    rest = lazy_wave(data, MESHES[100], fractions).equilibrium()
    assert pull(rest, "upper") == pytest.approx(data.force, rel=1e-3)
    assert largest_curvature(rest) == pytest.approx(data.curvature, rel=5e-3)


def test_elements_that_are_long_for_their_bends():
    """Elements of 5 m at a radius of 12 m: strings of several links per element; reference: 1,000 elements."""
    deep = LazyWave((560.0, 200.0, 560.0), 0.3, 60.85, (600.0, -800.0), 85584.78, 0.0852)
    rest = lazy_wave(deep, (120, 40, 80)).equilibrium()
    assert pull(rest, "upper") == pytest.approx(deep.force, rel=1e-4)
    assert largest_curvature(rest) == pytest.approx(deep.curvature, rel=2e-2)


def in_space(flow: float) -> fu.Scene:
    """Return a line of three parts above and on a sloping bed, in a cross stream, clamped at its top."""
    scene = fu.Scene(gravity=(0, 0, -G))
    scene.fluid("sea", density=1025, velocity=(0.2 * flow, flow, 0))
    scene.surface("bed", fu.Plane(point=(60, 20, -40), normal=(0.1, -0.05, 1)))
    points = np.array([0, 0, -2]) + np.array([0, 4, 6, 9])[:, None] / 9 * np.array([60, 20, -38])
    for k, (density, length) in enumerate(((3000, 40), (700, 20), (3000, 30))):
        scene.cable(f"c{k}", start=points[k], end=points[k + 1], rest_length=length, elements=12, element="cable12",
                    section=fu.Circle(radius=0.04), strain="engineering",
                    material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=density))
        scene.drag(f"c{k}", normal=1.2, diameter=0.08, displaced_area=np.pi * 0.04**2)
        scene.contact(f"c{k}", "bed", stiffness=1e4)
    scene.clamp("c0", s=0)
    scene.pin("c2", s=30)
    scene.tie("c0", s=40, to="c1", at=0)
    scene.tie("c1", s=20, to="c2", at=0)
    return scene


@pytest.mark.parametrize("flow", [0.0, 0.5])
@pytest.mark.slow_cases("0.0")
def test_in_space_it_is_the_state_of_relax(flow):
    rest, other = in_space(flow).equilibrium(), in_space(flow).relax()
    assert rest.stable
    assert rest.iterations <= 30
    for name in ("c0", "c1", "c2"):
        np.testing.assert_allclose(rest[f"{name}.position"], other[f"{name}.position"], atol=1e-6)


def test_the_state_depends_on_no_added_mass():
    of = [lazy_wave(LAZY_WAVES["80 m"], MESHES[100], added_mass=added).equilibrium() for added in (None, 0.3, 1.0)]
    for name in ("upper", "buoyant", "lower"):
        for other in of[1:]:
            assert np.array_equal(other[f"{name}.nodal_vectors"], of[0][f"{name}.nodal_vectors"])
    assert len({rest.iterations for rest in of}) == 1


@pytest.mark.parametrize("elements", [30, pytest.param(150, marks=pytest.mark.slow)])
def test_two_tied_ropes(elements, validated):
    """As one rope of 140 m: Irvine's catenary, with a change of 1e-4 of the force by bending."""
    weight = 9.81 * 5000 * np.pi * 0.05**2
    expected = np.hypot(*end_forces(100, 0, 140, weight, 1e9 * np.pi * 0.05**2))
    found = pull(tied_ropes(elements).equilibrium(), "a")
    assert found == pytest.approx(expected, rel=5e-3)
    validated("Statics", "two tied ropes, slack, drawn straight", "force on the end", 29953.453, found, unit="N",
              bound=1e-4 if elements == 30 else 1e-7, source="elastic catenary that bends, converged",
              variant="cable12", mesh=f"{2 * elements} elements")


def catenary_to_bed(H: float, hanging: float, weight: float, axial: float) -> tuple[float, float]:
    """Return the distances (aside, down), m, at which an elastic line of a hanging length (m) meets a bed, by H in N.
    """
    slope = weight * hanging / H
    return (H / weight * np.arcsinh(slope) + H * hanging / axial,
            H / weight * (np.hypot(1, slope) - 1) + weight * hanging**2 / (2 * axial))


def on_bed(density: float) -> float:
    """Return the force at the top of the wire of `wire_on_bed` by the elastic catenary that ends on a rigid bed, N."""
    weight, axial, span, drop, length = 0.08 * density * G, 0.08e10, 300.0, 80.0, 330.0

    def gaps(unknown):
        H, hanging = np.exp(unknown[0]), unknown[1]
        along, down = catenary_to_bed(H, hanging, weight, axial)
        return along + (length - hanging) * (1 + H / axial) - span, down - drop

    logarithm, hanging = fsolve(gaps, [np.log(weight * drop), 200.0], xtol=1e-12)
    return float(np.hypot(np.exp(logarithm), weight * hanging))


@pytest.mark.parametrize("changed", [{}, {"bending": 2400.0}, {"density": 888.0}, {"density": 1100.0}, {"elements": 20},
                                     {"elements": 60}, {"elements": 100}, {"anchor": -79.999}, {"membrane": "full"}],
                         ids=str)
def test_a_wire_on_a_bed(changed):
    """Small changes once made the state unstable, with 280 times the force. The rigid bed changes it by 1e-4."""
    rest = wire_on_bed(**{"elements": 45} | changed).equilibrium()
    assert pull(rest, "wire") == pytest.approx(on_bed(changed.get("density", 900.0)), rel=1e-3)
    assert not any("compressed" in message for message in rest.messages)


def test_moorings_of_a_buoy():
    """Joined to a body that an upward load moves by 17 m, each line is a catenary to the bed by the force at its end.
    """
    area, modulus, length, lift = np.pi * 0.04**2, 2e10, 225.0, 9e4
    scene = fu.Scene(gravity=(0, 0, -G))
    scene.fluid("sea", density=1025)
    scene.surface("bed", fu.Plane(point=(0, 0, -80), normal=(0, 0, 1)))
    scene.rigid_body("buoy", mass=2e4, inertia=(1e5, 1e5, 1e5), position=(0, 0, 0))
    scene.force("buoy", value=(0, 0, 2e4 * G + lift))
    for k in range(3):
        out = np.array([np.cos(2 * np.pi * k / 3), np.sin(2 * np.pi * k / 3), 0])
        line = scene.cable(f"line{k}", start=3 * out, end=200 * out + [0, 0, -80], rest_length=length, elements=40,
                           element="cable12", up=(0, 0, 1), strain="engineering", section=fu.Circle(radius=0.04),
                           material=fu.Material(youngs_modulus=modulus, poisson_ratio=0.3, density=7000))
        scene.drag(line, normal=1.2, diameter=0.08, displaced_area=area)
        scene.contact(line, "bed", stiffness=1e5, radius=1e-6)
        scene.pin(line, s=length)
        scene.joint("spherical", (line.name, 0.0), ("buoy", tuple(3 * out)))
    rest = scene.equilibrium()
    assert rest.stable and rest.iterations <= 25
    weight, axial = area * (7000 - 1025) * G, modulus * area
    H, hanging = float(np.linalg.norm(rest["line0@225.force"][:2])), lift / 3 / weight
    along, down = catenary_to_bed(H, hanging, weight, axial)
    assert along + (length - hanging) * (1 + H / axial) == pytest.approx(197, rel=3e-4)
    assert down - 80 == pytest.approx(float(rest["buoy.position"][2]), abs=2e-2)


def drawn_with_sag(sag: float) -> fu.Scene:
    """Return the wire of `wire_on_bed` through points on a parabola with a sag in m."""
    u = np.linspace(0, 1, 15)[:, None]
    scene = wire_on_bed(45)
    return scene.replace("wire", points=np.hstack([300 * u, 0 * u, -80 * u - 4 * sag * u * (1 - u)]), rest="straight")


@pytest.mark.parametrize("sag", [4.0, 16.0])
def test_a_wire_drawn_with_another_sag(sag):
    """Newton's method finds an unstable state from there; strings hang as before."""
    with pytest.warns(fu.FunicularWarning, match="the search went on to a stable one"):
        rest = drawn_with_sag(sag).equilibrium()
    assert pull(rest, "wire") == pytest.approx(on_bed(900.0), rel=1e-3)


@pytest.mark.parametrize("elements", [10, 20, 40])
def test_a_rope_needs_few_iterations(elements):
    """Through states of softer ropes the search took 71, 79 and 89 iterations."""
    rest = rope(elements).equilibrium()
    assert rest.iterations <= 7
    assert not rest.messages
    assert pull(rest, "rope") == pytest.approx(np.hypot(*end_forces(50, 0, 60, 7850 * np.pi * 1e-4 * 9.81,
                                                                    np.pi * 1e-4 * 1e11)), rel=3e-3)


@pytest.mark.parametrize(("element", "law"), [("cable8p", {}), ("beam12p", {"law": "structural"}),
                                              ("beam24", {"law": "structural"}), ("cable18", {})])
def test_other_elements(element, law):
    """Clamped horizontally at one end: the state of cable12, which Newton's method finds from the same start."""
    def state(element, law):
        scene = fu.Scene()
        scene.cable("rope", start=(0, 0, 0), end=(8, 0, 0), rest_length=10, elements=24, element=element, **law,
                    section=fu.Rectangle(height=0.04, width=0.04),
                    material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1500))
        scene.clamp("rope", s=0)
        scene.pin("rope", s=10)
        return scene.equilibrium()

    rest, other = state(element, law), state("cable12", {})
    assert rest.stable
    assert rest.iterations <= 12
    np.testing.assert_allclose(rest["rope.position"], other["rope.position"], atol=2e-2)


def bead_on_an_arch() -> fu.Scene:
    """Return a body on top of a stiff arch, its only equilibrium: it would run off either end."""
    scene = fu.Scene()
    u = np.linspace(-1, 1, 21)[:, None]
    scene.cable("arch", points=np.hstack([u, 0.2 * (1 - u**2), 0 * u]), elements=8, element="beam12p",
                law="structural", section=fu.Rectangle(height=0.1, width=0.1),
                material=fu.Material(youngs_modulus=1e11, poisson_ratio=0.3, density=1000))
    length = scene.cables["arch"].length
    for s in (0.0, length):
        scene.clamp("arch", s=s)
    scene.rigid_body("bead", mass=1, inertia=(1e-3, 1e-3, 1e-3), position=scene.cables["arch"].point(length / 2))
    scene.slide("bead", along="arch", s=length / 2)
    return scene


def test_no_unstable_state_is_returned_unless_asked_for():
    with pytest.raises(fu.EquilibriumError, match=r"no stable equilibrium .* unstable: 1 .*=False") as error:
        bead_on_an_arch().equilibrium()
    assert error.value.state.unstable_directions == 1
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        assert bead_on_an_arch().equilibrium(seek_stable=False).unstable_directions == 1


@pytest.mark.parametrize(("waves", "force"), [(0.0, on_bed(900.0)), (0.5, 130119.0), (2.0, 135707.0)])
def test_a_wire_on_an_uneven_bed(waves, force):
    """A height field, flat or with waves of 126 m; 45 elements against 100, or the catenary."""
    scene, x = wire_on_bed(45, anchor=-79.9), np.linspace(-50, 400, 91)
    heights = tuple(-80 + waves * np.sin((x - 300) / 20))
    scene = scene.replace("bed", shape=fu.HeightField(x=tuple(x), heights=heights, along=(1, 0, 0), up=(0, 0, 1)))
    rest = scene.equilibrium()
    assert pull(rest, "wire") == pytest.approx(force, rel=1e-3)
    assert rest.iterations <= 10


def thick_parts(elements: int) -> fu.Scene:
    """Return a line with a thick, stiff and buoyant middle; some of its parts have no tension."""
    scene, end, lengths = fu.Scene(gravity=(0, 0, -G)), np.array([1.4, 10, -7]), (4.5, 1.8, 6.3)
    scene.fluid("sea", density=1025)
    at = np.cumsum([0, *lengths])[:, None] / sum(lengths) * end
    for k, (length, radius, density) in enumerate(zip(lengths, (0.03, 0.1, 0.05), (3000, 870, 3000), strict=True)):
        scene.cable(f"c{k}", start=at[k], end=at[k + 1], rest_length=length, element="cable12",
                    elements=elements, up=(1, 0, 0), section=fu.Circle(radius=radius), strain="engineering",
                    material=fu.Material(youngs_modulus=1e10, poisson_ratio=0.3, density=density))
        scene.drag(f"c{k}", normal=1.2, diameter=2 * radius, displaced_area=np.pi * radius**2)
    for k in (0, 1):
        scene.tie(f"c{k}", s=lengths[k], to=f"c{k + 1}", at=0)
    scene.pin("c0", s=0)
    scene.pin("c2", s=lengths[2])
    return scene


def test_a_line_that_bending_shapes():
    """Strings without tension start the search where bending keeps their length.

    With 36 elements a part the state is the same.
    """
    rest, finer = thick_parts(18).equilibrium(), thick_parts(36).equilibrium()
    assert rest.stable
    assert rest.iterations <= 40
    for name in ("c0", "c1", "c2"):
        np.testing.assert_allclose(rest[f"{name}.position"], finer[f"{name}.position"][::2], atol=1e-3)


def test_a_line_without_tension_on_its_bed_is_refused_with_the_cause():
    """330 m, of which 80 m hang and 240 m reach the anchor: no force tensions the rest."""
    scene = wire_on_bed(20).replace("wire", end=(240, 0, -80))
    with pytest.raises(fu.EquilibriumError, match=r'"wire" is so long that .* % of it would have no tension'):
        scene.equilibrium()


def test_no_run_goes_on_from_an_unstable_state():
    """Even if the settings of the scene ask `equilibrium` for such a state."""
    scene = bead_on_an_arch()
    for settings in ({}, {"seek_stable": False}):
        scene.equilibrium_settings = settings
        with pytest.raises(fu.EquilibriumError, match="no stable equilibrium was found"):
            scene.run(0.01, step=1e-3, initial="equilibrium")


def test_a_reduced_strain_that_is_compressed_at_rest_is_told():
    scene = wire_on_bed(20)
    with pytest.warns(fu.FunicularWarning, match='cable "wire" is compressed by .* take membrane="assumed" or "full"'):
        scene.equilibrium(seek_stable=False)
