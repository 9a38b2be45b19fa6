"""An equilibrium has the results of a run for each part: the same names, with the values at the start of a run."""

import numpy as np
import pytest
from funicular import Anchor, Circle, Material, Plane, Scene, Sheave, TensionTable
from funicular.parts.kinds import KINDS

SOFT = Material(youngs_modulus=4e6, poisson_ratio=0, density=1000, damping_time=1e-2)
THIN = Circle(radius=0.01)


def rope(scene, name, y, element="cable12", **given):
    """Add a cable of 1 m along x at a height y, held at its start."""
    scene.cable(name, start=(0, y, 0), end=(1, y, 0), elements=6, element=element, section=THIN, material=SOFT,
                up=(0, 1, 0), **given)


def of_supports() -> Scene:
    """Return a scene with a clamp, a motion, a pin, a tie, a joint, a spring, a drag, memory of a rope."""
    scene = Scene()
    rope(scene, "beam", 1.0, "beam24")
    scene.clamp("beam", s=0)
    rope(scene, "line", 0.0)
    scene.motion("line", s=0, displacement=(0, 0.01, 0))
    scene.cable("link", start=(1, 0, 0), end=(1.5, 0, 0), elements=3, element="cable12", section=THIN, material=SOFT)
    scene.tie("line", s=1.0, to="link", at=0, rotation="free", name="breakpoint")
    scene.pin("link", s=0.5)
    scene.rigid_body("A", mass=0.05, inertia=(1e-3,) * 3, position=(1, 1, 0.2))
    scene.joint("spherical", ("beam", 1.0), ("A", (0, 0, -0.2)), name="hinge")
    scene.spring("A", (1, 2, 0.2), stiffness=5.0, length=0.9, name="string")
    scene.fluid("air", density=1.2, velocity=(3, 0, 0))
    scene.drag("line", normal=1.0, name="wind")
    scene.ice("link", thickness=0.01, name="rime")
    scene.relaxation("link", stiffness=50.0, time=0.1, name="viscosity")
    scene.cable("fibres", start=(0, 0, 2), end=(0, -1, 2), elements=2, element="cable12", membrane="tabulated",
                section=THIN.remade({"tension_table": TensionTable(strain=(0, 0.1), force=(0, 1e3))}), material=SOFT)
    scene.pin("fibres", s=0)
    scene.working_curve("fibres", permanent=0.3, name="worked")
    scene.wire_friction("link", stiffness=0.01, moment=1e-4, name="wires")
    return scene


def of_slides() -> Scene:
    """Return a scene with a driven slide, one tied to the axes of a beam, and a free one."""
    scene = Scene()
    rope(scene, "line", 0.0)
    rope(scene, "beam", 1.0, "beam24")
    for name in ("line", "beam"):
        scene.pin(name, s=0)
        scene.pin(name, s=1.0)
    scene.clamp("beam", s=0.5)
    for name, y, x in (("A", 0.0, 0.3), ("B", 1.0, 0.7), ("C", 0.0, 0.7)):
        scene.rigid_body(name, mass=0.2, inertia=(1e-3,) * 3, position=(x, y, 0))
    scene.slide("A", along="line", drive=0.3, name="drive")
    scene.slide("B", along="beam", drive=0.7, frame="tangent", name="trolley")
    scene.slide("C", along="line", s=0.7, name="free")
    return scene


def of_contacts() -> Scene:
    """Return crossing lines, a line on a bed, a body on a floor, and a modal body."""
    scene = Scene()
    for name, y, x, z in (("low", 0.0, 0.5, 0), ("high", 0.015, 0, 0.5)):
        scene.cable(name, start=(-x, y, -z), end=(x, y, z), elements=5, element="cable12", section=THIN, material=SOFT)
        scene.pin(name, s=0)
        scene.pin(name, s=1.0)
    scene.crossing("low", "high", stiffness=1e4, name="touch")
    rope(scene, "laid", 2.0)
    scene.pin("laid", s=0)
    scene.surface("bed", Plane(point=(0, 1.99, 0), normal=(0, 1, 0)))
    scene.contact("laid", "bed", stiffness=1e3, radius=0.01, name="lie")
    scene.rigid_body("A", mass=1.0, inertia=(1e-3,) * 3, position=(3, 0.1, 0))
    scene.surface("floor", Plane(point=(0, 0, 0), normal=(0, 1, 0)))
    scene.contact("A", "floor", points=[(x, -0.1, z) for x, z in ((0.1, 0.1), (-0.1, 0.1), (0, -0.1))], restitution=0.0,
                  name="stand")
    scene.modal_body("bar", start=(4, 0, 0), end=(5, 0, 0), section=THIN, material=SOFT, modes=2)
    scene.joint("weld", (4, 0, 0), "bar", name="held")
    return scene


def of_ropes() -> Scene:
    """Return a rope with a weight over a sheave."""
    scene = Scene()
    scene.rigid_body("A", mass=4.0, inertia=(1e-2,) * 3, position=(0.3, -2, 0))
    scene.rope("line", route=[Anchor(at=(-0.3, -1, 0)), Sheave("top", at=(0, 0, 0), radius=0.3, side="right"),
                              Anchor("A")], section=Circle(radius=1e-3), tension=40.0, elements=2,
               material=Material(youngs_modulus=1e10, poisson_ratio=0.3, density=5000, damping_time=1e-2))
    return scene


SCENES = {"supports": of_supports, "slides": of_slides, "contacts": of_contacts, "ropes": of_ropes}


def test_every_kind_of_part_with_results_is_there():
    there = {part.kind for make in SCENES.values() for part in make().parts()}
    assert {kind.kind for kind in KINDS if kind.results} <= there


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("make", SCENES.values(), ids=SCENES)
def test_a_state_of_rest_tells_what_a_run_tells(make):
    scene = make()
    rest = scene.equilibrium()
    run = scene.run(duration=1e-3, output_step=1e-3, tol=1e-5, initial=rest)
    names = {name for name in run.keys() if not name.startswith("energy.")}
    assert names <= set(rest.keys())
    assert set(rest.keys()) - names == {f"{cable}.position" for cable in scene.cables}
    for name in sorted(names):
        largest = max(1.0, float(np.abs(np.nan_to_num(run[name])).max()))
        loose = 1e-3 if name.endswith(("acceleration", "rate")) else 1e-6
        np.testing.assert_allclose(rest[name], run[name][0], rtol=0, atol=loose * largest, err_msg=name)


def test_a_path_and_a_relaxation_tell_the_same():
    scene = of_slides()
    rest = scene.equilibrium()
    for other in (scene.equilibrium(load_steps=2).path[0], scene.relax()):
        assert set(other.keys()) == set(rest.keys())
    assert scene.relax()["drive.traction"] == pytest.approx(rest["drive.traction"], rel=1e-6)


def test_a_target_names_what_a_drive_pulls():
    """A drive holds a weight on a straight incline: m g sin of its angle."""
    scene = Scene()
    scene.cable("rail", start=(0, 0, 0), end=(4, 3, 0), elements=4, element="cable12", section=Circle(radius=0.05),
                material=Material(youngs_modulus=2e11, poisson_ratio=0.3, density=1e-3))
    for s in (0.0, 1.25, 2.5, 3.75, 5.0):
        scene.pin("rail", s=s)
    scene.rigid_body("A", mass=10.0, inertia=(1, 1, 1), position=(2, 1.5, 0))
    scene.slide("A", along="rail", drive=2.5, name="winch")
    rest = scene.equilibrium()
    assert rest["winch.traction"] == pytest.approx(10 * 9.81 * 0.6, rel=1e-6)
    heavier = scene.equilibrium(adjust={"A.mass": "free"}, to={"winch.traction": 100.0})
    assert heavier.adjusted["A.mass"] == pytest.approx(100 / 9.81 / 0.6, rel=1e-6)
