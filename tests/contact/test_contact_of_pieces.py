"""Contact of cables of pieces, each with its radius, and of parts of a cable: closed forms, refusals."""

from math import pi

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from interrupted_runs import check_file_and_resume

G, STIFFNESS = 9.81, 2e4
RADII = 0.01, 0.03
RUBBER, STEEL = (fu.Material(youngs_modulus=E, poisson_ratio=0, density=1000) for E in (1e6, 2e6))
UP = {"cable8p": (0, 1, 0), "beam12p": (0, 1, 0), "cable12": (0, 0, 1), "beam24": (0, 1, 0)}


def scene_of(element="cable8p", materials=(RUBBER, RUBBER), elements=16, radii=RADII, y=RADII[1], *, hinge=False,
             apart=False) -> fu.Scene:
    """Return a line of two pieces, thin and thick, along x at a height over the ground; apart: of two cables and a
    tie, free with a hinge.
    """
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.surface("ground", fu.Plane())
    kind = {"element": element, "up": UP[element]}
    sections = [fu.Circle(radius=radius) for radius in radii]
    if apart:
        for k, (name, section, material) in enumerate(zip("wv", sections, materials, strict=True)):
            scene.cable(name, start=(k, y, 0), end=(k + 1, y, 0), section=section, material=material,
                        elements=elements, **kind)
        scene.tie("w", s=1, to="v", at=0, rotation="free" if hinge else "rigid")
    else:
        scene.cable("w", start=(0, y, 0), end=(2, y, 0), **kind, pieces=[
            fu.Piece(length=1, section=section, material=material, elements=elements, hinge=hinge and k == 1)
            for k, (section, material) in enumerate(zip(sections, materials, strict=True))])
    return scene


@pytest.mark.parametrize(("element", "materials"), [("cable8p", (RUBBER, RUBBER)), ("cable12", (RUBBER, STEEL)),
                                                    ("beam12p", (RUBBER, STEEL))])
def test_each_piece_rests_on_its_radius(element, materials):
    """At the ends the height is the radius less the weight over the stiffness, up to the decay of the step of the radii
    along a beam on an elastic foundation; the ground carries all of the weight.
    """
    scene = scene_of(element, materials)
    scene.motion("w", s=0, displacement=(0, "free", 0))
    scene.contact("w", "ground", stiffness=STIFFNESS, name="bed")
    state = scene.equilibrium()
    weights = RUBBER.density * pi * np.square(RADII) * G
    heights = state["w.position"][[0, -1], 1]
    bending = [material.youngs_modulus * pi * radius**4 / 4 for material, radius in zip(materials, RADII, strict=True)]
    decay = np.exp(-(STIFFNESS / (4 * np.array(bending))) ** 0.25)
    errors = np.abs(heights - (RADII - weights / STIFFNESS))
    assert (errors < (RADII[1] - RADII[0]) * decay + 1e-9).all()
    assert float(state["bed.force"][1]) == pytest.approx(weights.sum(), rel=1e-9)
    assert 1.5 < float(state["bed.touching"]) < 1.95, "the thin piece rises towards the joint"
    assert (float(state["bed.first"]), float(state["bed.last"])) == pytest.approx((0, 2), abs=1e-9)
    assert scene.contacts["bed"].radius is None


@pytest.mark.parametrize("integrator", ["genalpha", "energy", "explicit", "radau"])
@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_cable_of_pieces_is_two_cables_with_a_tie(integrator, friction):
    runs = []
    for apart in (False, True):
        scene = scene_of(elements=3, y=0.04, apart=apart, hinge=True)
        scene.contact(["w", "v"] if apart else "w", "ground", stiffness=STIFFNESS, friction=friction, name="bed")
        runs.append(scene.run(duration=0.15, step=5e-4, output_step=0.03, integrator=integrator))
    one, two = runs
    assert float(one["bed.penetration"].max()) > 0
    assert one["bed.force"] == pytest.approx(two["bed_1.force"] + two["bed_2.force"], rel=1e-7, abs=1e-6)
    assert one["bed.touching"] == pytest.approx(two["bed_1.touching"] + two["bed_2.touching"], abs=1e-7)
    assert one["energy.dissipated"] == pytest.approx(two["energy.dissipated"], rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("materials", [(RUBBER, RUBBER), (RUBBER, STEEL)])
def test_a_part_without_contact_sinks_through(materials):
    """Contact from the joint on is that of the second of two cables, and the first part hangs below the ground."""
    found = []
    for apart in (False, True):
        scene = scene_of(materials=materials, elements=8, radii=(0.01, 0.01), y=0.01, apart=apart,
                         hinge=materials[0] is not materials[1])
        scene.pin("w", s=0)
        scene.pin("v" if apart else "w", s=1 if apart else 2)
        if apart:
            scene.contact("v", "ground", stiffness=STIFFNESS, name="bed")
        else:
            scene.contact("w", "ground", stiffness=STIFFNESS, name="bed", start=1)
        found.append(scene.equilibrium())
    one, two = found
    lowest = one["w.position"][:9, 1].min()
    assert lowest < -0.01
    assert lowest == pytest.approx(two["w.position"][:, 1].min(), rel=1e-6)
    assert one["bed.force"] == pytest.approx(two["bed.force"], rel=1e-6, abs=1e-9)
    assert float(one["bed.last"]) == pytest.approx(1 + float(two["bed.last"]), abs=1e-6)


def test_modes_do_not_depend_on_the_division_of_a_contact():
    """The contact ends at s = 0.797 m, between two points of the rule."""
    frequencies = []
    for parts in ([(None, None)], [(None, 0.5), (0.5, None)]):
        scene = scene_of()
        for start, stop in parts:
            scene.contact("w", "ground", stiffness=STIFFNESS, start=start, stop=stop)
        scene.motion("w", s=0, displacement=(0, "free", 0))
        frequencies.append(scene.modes(6, about=scene.equilibrium()).frequency)
    assert frequencies[0] == pytest.approx(frequencies[1], rel=1e-9)


def test_section_forces_modes_and_files_know_the_part(tmp_path):
    scene = scene_of(elements=4, y=0.0297, materials=(RUBBER, STEEL))
    scene.motion("w", s=0, displacement=(0, "free", 0))
    scene.contact("w", "ground", stiffness=STIFFNESS, name="thick", start=1.25, stop=2)
    scene.contact("w", "ground", stiffness=STIFFNESS, name="thin", stop=0.75)
    state = scene.equilibrium()
    force = np.asarray(state.section_forces("w", s=[1.1])["force"]).ravel()
    weights = RUBBER.density * pi * np.square(RADII) * G
    assert abs(force[1]) == pytest.approx(abs(float(state["thin.force"][1]) - weights @ [1, 0.1]), rel=1e-6)
    assert (scene.modes(3, about=state).frequency > 0).all()
    check_file_and_resume(scene, tmp_path, 6, duration=0.012, step=2e-4, output_step=0.001)


def test_wrong_parts_are_refused():
    scene = scene_of(elements=4)
    with refused('contact "bed": start must be a node of the cable, got 0.1 m; nodes are at 0, 0.25, 0.5, 0.75, 1, '
                 "1.25, 1.5, 1.75, 2 m"):
        scene.contact("w", "ground", start=0.1, name="bed")
    scene.contact("w", "ground", stop=1, name="bed")
    with refused('contact "again": "w" and "ground" have the contact "bed" already; leave one of them out, or give '
                 "them start and stop"):
        scene.contact("w", "ground", start=0.5, name="again")
    scene.contact("w", "ground", start=1, name="other")
    with pytest.raises(fu.SceneError, match="stop must be beyond start"):
        scene.contact("w", "ground", start=1, stop=0.5)
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 1, 0))
    with refused('contact "ball": start is an arc-length of a cable, and "A" is a body; leave start out'):
        scene.contact("A", "ground", start=0, stiffness=1e3, name="ball")
