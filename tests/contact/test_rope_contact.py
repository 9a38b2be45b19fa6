"""Contact of the spans of ropes with surfaces, without friction."""

import funicular as fu
import numpy as np
import pytest
from derivatives import of_a_step
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build
from interrupted_runs import check_file_and_resume
from ropes.scenes import rope_of
from test_grips import SETTINGS

pytestmark = pytest.mark.filterwarnings("ignore:.*youngs_modulus|.*density|contact:funicular.FunicularWarning")
BED = {"radius": 0.02, "stiffness": 2e4, "name": "bed"}


def laid(dim: int = 2, *, side: float = 1.0, height: float = -0.06, elements: int = 12, weight: float = 8.0,
         **bed) -> fu.Scene:
    """Return a rope that falls on the ground before a sheave at it, and that a weight hauls up over another sheave."""
    scene, sides = fu.Scene(), ("left", "right") if side > 0 else ("right", "left")
    scene.rigid_body("weight", mass=weight, inertia=(1, 1, 1), position=(side * 6.6, 2, 0))
    scene.rope("line", route=[fu.Anchor(at=(0, 0, 0)),
                              fu.Sheave("foot", at=(side * 6, 0.2, 0), radius=0.2, side=sides[0]),
                              fu.Sheave("top", at=(side * 6.4, 3, 0), radius=0.2, side=sides[1]),
                              fu.Anchor("weight")], tension=60.0, elements=[elements, 3, 2],
               element="cable8p" if dim == 2 else "cable12", **rope_of(2e4, 0.5, 0, 1e-3))
    scene.surface("ground", fu.Plane(point=(0, height, 0)))
    scene.contact("line", "ground", **BED | bed)
    return scene


@pytest.mark.parametrize("damping", [0.0, 0.5])
@pytest.mark.parametrize("integrator", ["radau", "genalpha", "explicit"])
@pytest.mark.slow_cases("explicit-0.5", "genalpha-0.5", "radau-0.0")
def test_energy_is_conserved_while_the_material_flows(integrator, damping):
    """The rope falls on the ground, from which the weight hauls it up."""
    settings = SETTINGS | {"integrator": integrator, "tol": 1e-5, "output_step": 0.02}
    run = laid(damping=damping, weight=14.0, height=-0.03).run(0.3, **settings)
    assert run["bed.touching"].max() > 0.3 and run["bed.force"][:, 1].max() > 2
    assert np.ptp(run["weight.position"][:, 1]) > 0.02
    assert np.abs(run.energy_balance().relative).max() < 1e-5
    other = laid(damping=damping, weight=14.0, height=-0.03).run(0.3, **SETTINGS | {"tol": 1e-6, "output_step": 0.02})
    assert np.abs(run["weight.position"] - other["weight.position"]).max() < 1e-4


@pytest.mark.parametrize("damping", [0.0, 0.5])
def test_tangent(damping):
    engine = Engine(build(laid(height=-0.015, damping=damping)))
    engine.start(duration=1.0, output_step=1.0, tol=1e-6, step=0.02, first_step=0.02, method=GeneralisedAlpha(0.8))
    at = 1e-4 * np.random.default_rng(1).standard_normal(engine.unknowns)
    matrix = engine.linearise(0.02, at)[1]
    assert np.abs(of_a_step(engine, 0.02, at, 1e-7) - matrix).max() < 1e-6 * np.abs(matrix).max()


def test_a_rope_at_rest_on_the_ground_agrees_with_a_cable():
    """A cable of the stress-free length of the span between the same points, laid on the same ground."""
    scene = laid(height=-0.3, elements=16)
    scene = scene.replace("line", length=scene.ropes["line"].drawn(scene.bodies).free_length)
    rest = scene.equilibrium()
    assert 0.3 < rest["bed.touching"] < 1.0
    run = scene.run(0.3, initial=rest, **SETTINGS)
    assert np.abs(run["weight.position"] - rest["weight.position"]).max() < 1e-7
    assert scene.modes(3, rest).frequency[-1] > 0.1
    span = rest.section_forces("line", method="constitutive")
    first = span.s.values[span.span.values == 0]
    cable = fu.Scene()
    start, end = rest["line.position"][0], rest["line.position"][np.argmin(np.abs(rest["line.s"] - first[-1]))]
    cable.cable("line", start=start.tolist(), end=end.tolist(), rest_length=float(np.ptp(first)), elements=16,
                element="cable8p", strain="engineering", membrane="assumed", **rope_of(2e4, 0.5, 0, 1e-3))
    for s in (0.0, cable.cables["line"].length):
        cable.pin("line", s=s)
    cable.surface("ground", fu.Plane(point=(0, -0.3, 0)))
    cable.contact("line", "ground", **BED)
    other = cable.equilibrium()
    assert rest["bed.force"][1] == pytest.approx(other["bed.force"][1], rel=1e-3)
    assert rest["bed.penetration"] == pytest.approx(other["bed.penetration"], rel=1e-3)


def test_mirrored():
    runs = [laid(side=side).run(0.3, **SETTINGS)["weight.position"] for side in (1, -1)]
    assert np.abs(runs[1] - runs[0] * [-1, 1, 1]).max() < 1e-8


@pytest.mark.slow
def test_a_planar_scene_and_its_twin_in_space():
    runs = [laid(dim).run(0.3, **SETTINGS) for dim in (2, 3)]
    assert np.abs(runs[0]["weight.position"] - runs[1]["weight.position"]).max() < 1e-3
    assert runs[1]["bed.touching"].max() > 0.3


def test_resumed_bit_for_bit_and_from_a_file(tmp_path):
    whole = check_file_and_resume(laid(), tmp_path, 8, **SETTINGS | {"duration": 0.6})
    assert np.isnan(whole["bed.first"][0]) and np.nanmax(whole["bed.last"]) < 6


def test_deep_penetration_is_noted():
    with pytest.warns(fu.FunicularWarning, match="below its surface"):
        run = laid(stiffness=200.0).run(0.5, **SETTINGS)
    assert any('contact "bed" is up to' in message for message in run.report["messages"])


@pytest.mark.parametrize(("given", "words"), [
    ({"restitution": 0.5, "stiffness": None}, "is a rope"),
    ({"points": [(0, 0, 0)]}, "takes no points"), ({"b": "drum"}, "elements of at most"),
    ({"a": "top"}, 'is a sheave of rope "line"'),
])
def test_refused(given, words):
    scene = laid().without("bed")
    scene.surface("drum", fu.Cylinder(0.05, 1.0), at=(3, -0.2, 0))
    given = {"a": "line", "b": "ground"} | BED | given
    with pytest.raises(fu.SceneError) as caught:
        scene.contact(given.pop("a"), given.pop("b"), **{k: v for k, v in given.items() if v is not None})
    assert words in str(caught.value)


def test_refused_without_mass():
    with pytest.raises(fu.SceneError, match="has mass=False"):
        laid().replace("line", mass=False)
