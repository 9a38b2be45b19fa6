"""Cables with nodes at given arc-lengths: correct, of the expected accuracy, and supported by all features."""

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from funicular.kernels.mesh import Mesh
from funicular.model.build import build
from funicular.parts import cable_mesh
from shared_scenes import add_rider, cable_scene, structural

NODES = (0.0, 0.05, 0.15, 0.3, 0.55, 0.8, 1.0)
SOFT = fu.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=1000)
ROUND = fu.Circle(radius=0.01)


def graded(elements: int, power: float = 2.0, length: float = 1.0) -> np.ndarray:
    """Return (elements + 1,) arc-lengths of nodes, dense at the start."""
    return length * (np.arange(elements + 1) / elements) ** power


def strip(element="cable12", **given) -> fu.Scene:
    mesh = {"elements": None} if "nodes" in given else {}
    return cable_scene(element=element, **{"section": ROUND, "material": SOFT} | structural(element) | mesh | given)


# --- equality with equal elements, and accuracy by theory --------------------------------------------------------

@pytest.mark.parametrize("element", ["cable12", "cable18", "beam24", "cable8p", "beam12p"])
@pytest.mark.parametrize("integrator", ["auto", "genalpha", "explicit"])
def test_equal_elements_given_as_nodes_are_the_same_bits(element, integrator, monkeypatch):
    """Equally spaced nodes give the mesh of equal elements; the code for unequal lengths gives the same bits."""
    even = strip(element, elements=8, pins=(0.0,))
    settings = {"duration": 0.05, "output_step": 0.01, "tol": 1e-3, "integrator": integrator}
    expected = even.run(**settings)
    given = even.replace("wire", nodes=np.arange(9) / 8)
    for tolerance, is_even in ((cable_mesh.EVEN_TOLERANCE, True), (-1.0, False)):
        monkeypatch.setattr(cable_mesh, "EVEN_TOLERANCE", tolerance)
        assert given.cables["wire"].mesh.is_even is is_even
        found = given.run(**settings)
        for name in expected:
            np.testing.assert_array_equal(found[name], expected[name], err_msg=name)
        for one, other in zip(*(run.section_forces("wire").data_vars.values() for run in (found, expected)),
                              strict=True):
            np.testing.assert_array_equal(one, other)


def test_a_cantilever_graded_to_its_clamp(validated):
    """A strong force bends the cable at its clamp: 16 elements that are dense there are 40 times as accurate.

    The reference has 400 equal elements; 200 differ from it by 2.6e-9 m.
    """
    def tip(**mesh) -> np.ndarray:
        scene = strip(gravity=(0, 0, 0), clamps=(0.0,), material=fu.Material(
            youngs_modulus=1e9, poisson_ratio=0.0, density=1000), **mesh)
        scene.force("wire", s=1.0, value=(0, -800.0, 0))
        return scene.equilibrium()["wire.position"][-1]

    exact = 0.1398593796547636, -0.9447721876221966, 0.0
    equal = np.linalg.norm(tip(elements=16) - exact)
    validated("Statics", "cantilever bent at its clamp alone, graded mesh", "place of the end", exact[:2],
              tip(nodes=graded(16))[:2], unit="m", scale=1.0, bound=1e-5, source="400 equal elements",
              mesh="16 elements")
    errors = [np.linalg.norm(tip(nodes=graded(n)) - exact) for n in (8, 16, 32)]
    assert errors[1] < equal / 40
    assert np.log2(errors[0] / errors[1]) > 4  # the order of cubic elements; 5.3 and 5.0
    assert np.log2(errors[1] / errors[2]) > 4


@pytest.mark.parametrize("integrator", ["genalpha", "explicit", "energy"])
@pytest.mark.slow_cases("energy")
def test_a_slide_crosses_elements_of_unequal_lengths(integrator):
    """The path of the rider is as accurate as on equal elements, and three times as accurate on half the lengths."""
    nodes = np.array((0, 0.1, 0.25, 0.45, 0.6, 0.85, 1.0))

    def path(**mesh) -> np.ndarray:
        scene = strip(gravity=(0, -9.81, 0), pins="ends", **mesh)
        add_rider(scene, 0.12, 2.0)
        run = scene.run(0.3, output_step=0.02, tol=1e-5, integrator=integrator)
        assert run.report["element_crossings"] >= 2
        return run["A.position"]

    exact, motion = path(elements=48), 0.6
    equal, error, of_halves = (np.abs(path(**mesh) - exact).max() / motion for mesh in (
        {"elements": 6}, {"nodes": nodes}, {"nodes": Mesh.of_nodes(nodes).divided(2)}))
    assert error < 1.1 * equal < 4e-3
    assert of_halves < error / 3


@pytest.mark.parametrize("element", ["cable12", "beam24", "cable8p", "beam12p"])
def test_modes_and_mass(element):
    """Frequencies of a cantilever, 3.516 and 22.03 times sqrt(EI/m)/l², and its mass."""
    scene = strip(element, clamps=(0.0,), nodes=graded(12, 1.5), gravity=(0, 0, 0))
    unit = np.sqrt(1e7 * np.pi * 0.01**4 / 4 / (1000 * np.pi * 0.01**2)) / (2 * np.pi)
    found = scene.modes(4 if scene.dim == 3 else 2).frequency
    expected = np.repeat([3.5160, 22.0345], 2 if scene.dim == 3 else 1) * unit
    np.testing.assert_allclose(found, expected, rtol=5e-3)  # of the rotary inertia
    cable = build(scene).cables[0]
    assert sum(m[0, 0] + m[0, len(m) // 2] for m in cable.m) * 2 == pytest.approx(1000 * np.pi * 0.01**2)


def test_loads_a_length_and_section_forces():
    """A taut wire with its weight, a partial load and a point force: section forces balance the loads."""
    scene = strip(clamps=(0.0,), nodes=NODES)
    scene.distributed_force("wire", value=(0, -3.0, 0), start=0.1, stop=0.7)
    scene.force("wire", s=0.62, value=(0, -0.4, 0))
    rest = scene.equilibrium()
    s = np.array([0.02, 0.1, 0.15, 0.4, 0.55, 0.61, 0.63, 0.9])
    force = rest.section_forces("wire", s)["force"].to_numpy()
    weight = 9.81 * 1000 * np.pi * 0.01**2
    expected = -weight * (1 - s) - 3.0 * (0.7 - np.clip(s, 0.1, 0.7)) - 0.4 * (s < 0.62)
    np.testing.assert_allclose(force[:, 1], expected, atol=1e-9)
    np.testing.assert_allclose(force[:, [0, 2]], 0, atol=1e-9)
    assert len(rest.section_forces("wire").s) > 8 * 6


def test_section_forces_of_a_motion_are_in_balance():
    scene = strip(pins=(0.0,), nodes=strip(nodes=NODES).cables["wire"].mesh_entries(12)["nodes"])
    run = scene.run(0.3, output_step=0.1, tol=1e-6)
    s = np.array([0.0, 0.04, 0.1, 0.3, 0.5, 0.7, 0.95, 1.0])
    found = run.section_forces("wire", s)["force"].to_numpy()
    fine = scene.replace("wire", elements=40).run(0.3, output_step=0.1, tol=1e-6).section_forces("wire", s)["force"]
    assert np.abs(found - fine.to_numpy()).max() < 0.02 * np.abs(fine.to_numpy()).max()
    np.testing.assert_allclose(found[:, -1], 0, atol=1e-9)


@pytest.mark.parametrize("integrator", ["genalpha", "energy"])
def test_energy_and_damping(integrator):
    """The dissipated energy equals the loss on elements of any length; the energy integrator keeps the rest."""
    damped = {"damping_time": 1e-2, "mass_damping": 0.5} if integrator == "genalpha" else {}
    material = fu.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=1000, **damped)
    scene = strip(pins=(0.0,), nodes=NODES, material=material)
    run = scene.run(0.5, output_step=0.05, tol=1e-5, integrator=integrator)
    assert np.abs(run.energy_balance().residual).max() < 2e-4 * np.ptp(run["energy.kinetic"])
    if damped:
        even = scene.replace("wire", elements=24).run(0.5, output_step=0.05, tol=1e-5, integrator=integrator)
        assert run["energy.dissipated"][-1] == pytest.approx(even["energy.dissipated"][-1], rel=0.02)


def test_algorithmic_dissipation():
    run = strip(pins=(0.0,), nodes=NODES).run(0.2, output_step=0.05, tol=1e-4, integrator="energy",
                                              spectral_radius=0.5)
    total = run["energy.kinetic"] + run["energy.elastic"] + run["energy.potential"]
    assert total.max() <= total[0] + 1e-9


@pytest.mark.parametrize("element", ["cable12", "beam24"])
def test_a_curved_cable_is_free_of_stress(element):
    def arc(u: float) -> tuple[float, float, float]:
        return np.sin(u), 1 - np.cos(u), 0.0

    scene = fu.Scene(gravity=(0, 0, 0))
    rope = scene.cable("wire", curve=arc, elements=8, element=element, section=ROUND, material=SOFT, up=(0, 0, 1),
                       **structural(element))
    scene = scene.replace("wire", nodes=graded(8, 1.7, rope.length))
    run = scene.run(0.01, output_step=0.005, tol=1e-6, absolute_tol=0)
    np.testing.assert_allclose(run["energy.elastic"], 0, atol=1e-12)
    nodes = scene.cables["wire"].node_s
    np.testing.assert_allclose(run["wire.nodal_vectors"][-1, :, 0], [arc(s) for s in nodes], atol=1e-8)


# --- description, files and pictures -----------------------------------------------------------------------------

def test_supports_attachments_and_riders_find_their_nodes(tmp_path):
    scene = strip(pins=(0.0, 0.55), nodes=NODES)
    cable = scene.cables["wire"]
    assert cable.elements == 6
    assert [cable.node_at(s) for s in (0.0, 0.05, 0.3, 1.0, 0.31)] == [0, 1, 3, 6, None]
    with refused('pin on "wire": s must be a node of the cable, got 0.5 m; nodes are at 0, 0.05, 0.15, 0.3, 0.55, '
                 "0.8, 1 m"):
        scene.pin(cable, s=0.5)
    scene.tie(scene.cable("other", start=(0.8, 0, 0), end=(0.8, -1, 0), nodes=(0, 0.4, 1), element="cable12",
                          section=ROUND, material=SOFT), s=0.0, to=cable, at=0.8, rotation="free")
    run = scene.run(0.05, output_step=0.01, tol=1e-3)
    np.testing.assert_array_equal(run["other.nodal_vectors"][:, 0, 0], run["wire.nodal_vectors"][:, 5, 0])
    np.testing.assert_array_equal(run.coords["wire.node"].values, NODES)
    run.save(tmp_path / "x.nc")
    kept = fu.load_run(tmp_path / "x.nc")
    assert kept.scene.cables["wire"].nodes == NODES
    np.testing.assert_array_equal(kept.section_forces("wire").force, run.section_forces("wire").force)


def test_scene_files_and_replace():
    scene = strip(pins=(0.0,), nodes=NODES)
    read = fu.Scene.from_toml(scene.to_toml())
    assert read.cables["wire"].nodes == NODES
    assert read.to_toml() == scene.to_toml()
    assert "elements" not in scene.to_toml()
    equal = scene.replace("wire", elements=5)
    assert (equal.cables["wire"].nodes, equal.cables["wire"].elements) == (None, 5)
    assert equal.replace("wire", nodes=NODES).cables["wire"].uneven_nodes == NODES
    assert scene.replace("wire", material=SOFT).cables["wire"].nodes == NODES


def test_meshes_are_divided_and_joined():
    scene = strip(nodes=NODES)
    halves, thirds, others = (scene.remeshed(lambda cable, n=n: n).cables["wire"] for n in (12, 3, 7))
    np.testing.assert_array_equal(halves.nodes[::2], NODES)
    np.testing.assert_allclose(np.diff(halves.nodes)[::2], np.diff(NODES) / 2)
    assert thirds.nodes == NODES[::2]
    assert others.mesh.is_even
    assert scene.remeshed(lambda cable: cable.elements).to_toml() == scene.to_toml()


def test_the_error_of_the_mesh_is_estimated_on_elements_of_half_the_length():
    scene = strip(pins=(0.0, 0.05), nodes=NODES)  # no equal elements have a node at 0.05 m but twenty
    run = scene.run(0.1, output_step=0.02, tol=1e-3, estimate=True)
    assert 0 < run.report["errors"]["mesh"] < 0.1


def test_pictures():
    """The points of a straight wire at rest are drawn at their arc-lengths, nodes included."""
    run = strip(pins="ends", nodes=NODES, gravity=(0, 0, 0)).run(0.01, output_step=0.01, tol=1e-3)
    shape = run.animation().clips[0].cables[0]
    np.testing.assert_allclose(shape.position[-1], np.outer(shape.s, [1, 0, 0]), atol=1e-12)
    assert np.isin(NODES, shape.s).all()


# --- refusals ----------------------------------------------------------------------------------------------------

@pytest.mark.parametrize(("nodes", "complaint"), [
    ([0, 0.5, 0.4, 1], "nodes must increase, but 0.4 m follows on 0.5 m; give each node once, from start to end"),
    ([0, 0.5, 0.5, 1], "nodes must increase, but 0.5 m follows on 0.5 m; give each node once, from start to end"),
    ([0.1, 0.5, 1], "nodes must begin at 0, the start of the cable, got 0.1 m"),
    ([0, 0.5, 1.1], "nodes must end at the cable's undeformed length, 1.0 m, got 1.1 m; give arc-lengths of the "
                    "undeformed cable, from 0 to its length"),
    ([0, 1e-7, 1], "nodes are too close at 0 m and 1e-07 m: the longest element is 1e+07 times as long, at most 1e+06 "
                   "times is allowed; leave one of them out, or put more nodes elsewhere"),
    ([0], "nodes must be a list of 2 arc-lengths or more, got [0]"),
    (3, "nodes must be a list of 2 arc-lengths or more, got 3"),
    ([0, "a", 1], "nodes must be a number, got 'a'"),
    ([0, np.nan, 1], "nodes must be finite, got (0, nan, 1) m"),
])
def test_nodes_that_make_no_mesh(nodes, complaint):
    with refused(f'cable "wire": {complaint}'):
        strip(nodes=nodes)


def test_elements_and_nodes():
    with refused('cable "wire": has 3 elements and 7 nodes; give elements of equal lengths, or the nodes'):
        strip(nodes=NODES, elements=3)
