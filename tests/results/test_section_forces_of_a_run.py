"""Section forces along a cable: element, position, components, labels; mostly with a mock kernel."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from expectations import refused
from fake_recording import fake_recording
from funicular import Circle, FunicularError, Material, Scene, UnknownResultError, load_scene
from funicular.generated import kernels
from funicular.model.build import build
from funicular.parts.section_stiffness import section_stiffness
from funicular.parts.settings import RunSettings
from funicular.results.pictures import save_plots
from funicular.results.run import Run
from funicular.results.section_forces.balance import Cuts
from funicular.results.section_forces.components import BEAM, CABLE, components
from funicular.results.section_forces.forces import constitutive
from numpy.testing import assert_allclose
from shared_scenes import cable_scene

SOFT = Material(youngs_modulus=1e6, density=1000, poisson_ratio=0.3)
AXES = np.array([[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]])


@pytest.fixture
def calls(monkeypatch):
    """Return kernels that give the position of the cut as a tension and record their calls."""
    kept = []

    def rows(n, l, x, e, S, *e0):
        kept.append(SimpleNamespace(l=l, x=x, e=e, S=S, e0=e0))
        along = np.stack([e[:, 0, 0] + x, np.full(n, 2.0), np.full(n, 3.0)], axis=1)
        return along @ AXES, np.tile(AXES.T @ [4, 5, 6], (n, 1)), np.tile(AXES, (n, 1, 1)), np.tile(np.arange(6) + 1.0,
                                                                                                  (n, 1))

    for name in ("beam24_continuum", "beam24_continuum_curved", "beam24_structural", "cable12_green_exact",
                 "beam12p_continuum"):
        monkeypatch.setattr(kernels, f"{name}_section_forces", SimpleNamespace(rows=rows), raising=False)
    return kept


@pytest.fixture
def run():
    scene = load_scene("paper51")
    return Run.from_recording(fake_recording(scene, times=3), scene, RunSettings(duration=1.0), Scene.from_toml)


def by_law(scene: Scene, *s: float) -> dict[str, np.ndarray]:
    """Return components by the elastic law of the only cable in its drawn shape."""
    (wire,) = scene.cables.values()
    cuts = Cuts(build(scene).cables[0], np.array([s]), after=True)
    force, moment, axes, strain = constitutive(wire, wire.nodal_vectors[None], cuts, np.zeros(1))
    return {"force": force, "moment": moment} | components(wire, force, moment, axes, strain)


def test_a_cut_lies_in_its_element(run, calls):
    s = [0, 0.2, 0.5, 1.2, 1.5]
    forces = run.section_forces("wire", s, method="constitutive")
    assert_allclose(forces["tension"], np.tile(s, (3, 1)), rtol=1e-12)  # r of the element's first node, and x
    call, _ = calls  # the second one is of how far the tension swings within elements
    assert_allclose(np.stack([call.e[:, 0, 0], call.x], axis=1)[:5],
                    [(0, 0), (0, 0.2), (0.5, 0), (1, 0.2), (1, 0.5)], atol=1e-12)
    assert call.l == 0.5 and call.e.shape == (15, 8, 3) and call.e0 == ()
    wire = run.scene.cables["wire"]
    assert_allclose(call.S, section_stiffness("continuum", wire.section, wire.material))


def test_a_node_has_two_sides(run, calls):
    run.section_forces("wire", [0, 0.5, 1.5], method="constitutive", side="before")
    assert_allclose(calls[0].x[:3], [0, 0.5, 0.5], atol=1e-12)
    assert_allclose(calls[0].e[:3, 0, 0], [0, 0, 1], atol=1e-12)


def test_components_and_labels_of_a_beam(run, calls):
    forces = run.section_forces(run.scene.cables["wire"], s=0.25, method="constitutive")
    assert dict(forces.sizes) == {"time": 3, "s": 1, "xyz": 3}
    assert_allclose(forces["force"].sel(s=0.25), np.tile(AXES.T @ [0.25, 2, 3], (3, 1)))
    values = {name: float(forces[name][0, 0]) for name in BEAM}
    assert_allclose(list(values.values()), [0.25, np.sqrt(13), 2, 3, 4, 5, 6, 1, 2, 3, 4, 5, 6])
    assert forces["moment_y"].units == "N m" and forces["twist"].units == "1/m"
    assert_allclose(forces["time"], run.time)
    assert forces.attrs == {"cable": "wire", "element": "beam24", "law": "continuum", "method": "constitutive",
                            "side": "after"}


def test_along_all_of_the_cable(run, calls):
    assert_allclose(run.section_forces("wire")["s"], np.linspace(0, 1.5, 25))


def test_where_a_slide_is(run):
    forces = run.section_forces("wire", run.scene.slides["trolley"])
    assert dict(forces.sizes) == {"time": 3, "xyz": 3}
    assert_allclose(forces["s"], run["trolley.s"])
    one = [run.section_forces("wire", s)["tension"][k, 0] for k, s in enumerate(run["trolley.s"])]
    assert_allclose(forces["tension"], one, rtol=1e-9)


def straight(element, **given):
    return cable_scene(length=2, elements=2, element=element, section=Circle(radius=0.1), material=SOFT, **given)


def test_components_of_a_cable(calls):
    forces = by_law(straight("cable12"), 0.5)
    assert set(forces) == {"force", "moment", *CABLE}
    assert_allclose([forces[name][0, 0] for name in CABLE], [0.5, np.sqrt(13), 1, 6])


def test_a_planar_cable_gives_its_two_components(calls):
    by_law(straight("beam12p"), 0.5)
    assert calls[0].e.shape == (1, 6, 2) and calls[0].S.shape == (4, 6)


def test_curved_and_structural_laws_take_the_rest_shape(calls):
    scene = straight("beam24", start=None, end=None, points=[(0, 0, 0), (1, 0.2, 0), (2, 0, 0)])
    by_law(scene, 1.9)
    assert_allclose(calls[0].e0[0][0], np.concatenate(scene.cables["wire"].rest_nodal_vectors[1:]))


@pytest.mark.parametrize("element", ["beam24", "cable12", "cable18", "beam12p", "cable8p"])
def test_a_taut_cable_by_its_own_kernel(element):
    """Green strain, second Piola-Kirchhoff stress: N = E A (stretch² - 1)/2 stretch, for a section of constant size."""
    steel = Material(youngs_modulus=1e6, density=1000, poisson_ratio=0)
    scene = Scene()
    wire = scene.cable("wire", start=(0, 0, 0), end=(2, 0, 0), elements=3, element=element, material=steel,
                       section=Circle(radius=0.1), rest_length=1.6)
    forces = by_law(scene, 0, 0.7, 1.6)
    expected = 1e6 * wire.section.area * (1.25**2 - 1) / 2 * 1.25
    assert_allclose(forces["tension"], np.full((1, 3), expected), rtol=1e-12)
    assert_allclose(forces["force"], [[[expected, 0, 0]] * 3], atol=1e-9 * expected)
    assert_allclose(forces["moment"], 0, atol=1e-9 * expected)
    assert_allclose(forces["strain"], (1.25**2 - 1) / 2, rtol=1e-12)


def test_what_is_not_there(run):
    with pytest.raises(UnknownResultError, match=r'^there is no cable "wir"; did you mean "wire"\?$'):
        run.section_forces("wir")
    for s, shown in ((1.6, "1.6 m"), ([0, -1], "-1 m"), ([[0]], "an array of shape (1, 1)"), (np.nan, "nan m")):
        message = f'section forces of "wire": s must lie on the cable, in [0, 1.5] m, got {shown}'
        with refused(message, FunicularError):
            run.section_forces("wire", s)
    for given, message in (({"method": "exact"}, 'method must be "balance" or "constitutive", got \'exact\''),
                           ({"side": 1}, 'side must be "after" or "before", got 1'),
                           ({"s": "trolly"}, "s must be arc-lengths in m, or a slide on it, got 'trolly'")):
        with pytest.raises(FunicularError, match=re.escape(message)):
            run.section_forces("wire", **given)


def test_pictures_when_asked_for(run, tmp_path):
    assert "forces-wire.png" not in [p.name for p in save_plots(run, tmp_path)]
    assert [p.name for p in save_plots(run, tmp_path, forces=True)][-1] == "forces-wire.png"
    tension, moment, _ = run.plot("forces-wire").axes
    assert (tension.get_ylabel(), moment.get_ylabel()) == ("tension / N", "moment / (N m)")
    # eight positions on each element and its end, and both sides of the rider
    assert_allclose(tension.lines[0].get_xdata(),
                    np.sort([*np.linspace(0, 1.5, 25), 0.25 - 6e-9, 0.25 + 6e-9]), atol=1e-12)
    assert len(moment.lines) == 3
