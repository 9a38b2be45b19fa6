"""Cables of several pieces: against closed forms, across every joint, with everything that acts on a cable."""

import warnings

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from funicular.parts.scene_text import read
from funicular.results.animation.clips import of_scene
from interrupted_runs import check_file_and_resume
from pieces import SECTION, SOFT, STIFF, cantilever, elongation, law_of, riser, two_ropes, waves
from slack_lines import LAZY_WAVES, MESHES, lazy_wave

ELEMENTS = "cable12", "cable18", "beam24", "cable8p", "beam12p"
DIRECTORS = {"cable12": (0, 0, 1), "cable18": (0, 0, 1), "beam24": (0, 0, 1)}


def taut(element: str, lengths=(5.0, 5.0), materials=(SOFT, STIFF), elements: int = 10, **entries) -> fu.Scene:
    """Return a taut cable of pieces between two pins 10.02 m apart."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.cable("w", start=(0, 0, 0), end=(10.02, 0, 0), element=element, rest="straight", **law_of(element),
                up=DIRECTORS.get(element, (0, 1, 0)), pieces=[
                    fu.Piece(length=length, section=SECTION, material=material, elements=elements)
                    for length, material in zip(lengths, materials, strict=True)], **entries)
    scene.pin("w", s=0)
    scene.pin("w", s=sum(lengths))
    return scene


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_bar_of_two_materials(element):
    found, closed = elongation(element, 2)
    assert found == pytest.approx(closed, rel=1e-12)


@pytest.mark.parametrize("element", ["cable8p", "beam12p"])
def test_waves_at_a_joint(element):
    for found, closed in waves(element, 40):
        assert found == pytest.approx(closed, rel=1e-3)


@pytest.mark.parametrize("element", ["cable12", "cable8p"])
def test_a_stepped_cantilever(element):
    errors = [np.abs(found / closed - 1) for found, closed in (cantilever(element, n) for n in (5, 10))]
    assert (errors[1] < 4e-5).all()
    assert (errors[0][1:] > 10 * errors[1][1:]).all(), "of the fourth order"


def test_two_ropes_in_line_are_a_catenary_by_pieces():
    force, closed = two_ropes("cable8p", 40)
    assert force == pytest.approx(closed, rel=1e-8)


def test_a_lazy_wave_from_one_cable():
    one, three = riser(MESHES[100]).equilibrium(), lazy_wave(LAZY_WAVES["80 m"], MESHES[100]).equilibrium()
    assert np.asarray(one["riser@0.force"]) == pytest.approx(np.asarray(three["upper@0.force"]), rel=1e-9)
    frequencies = [np.asarray(rest.scene.modes(6, about=rest).frequency) for rest in (one, three)]
    # rounding of the stiffness: 1e-16 of the forces of stretching in a wave of bending, the second and the sixth most
    assert frequencies[0] == pytest.approx(frequencies[1], rel=1e-8)
    more = one.scene.modes(14, about=one)
    assert frequencies[0] == pytest.approx(more.frequency[:6], rel=1e-8)


def test_equal_pieces_are_a_uniform_cable():
    apart = taut("cable12", (4.0, 6.0), (SOFT, SOFT), 12)
    whole = fu.Scene(gravity=(0, -9.81, 0))
    nodes = [*np.arange(12) * 4 / 12, *(4 + np.arange(13) * 6 / 12)]
    whole.cable("w", start=(0, 0, 0), end=(10.02, 0, 0), element="cable12", rest="straight", strain="engineering",
                up=(0, 0, 1), section=SECTION, material=SOFT, nodes=nodes, rest_length=10.0)
    whole.pin("w", s=0)
    whole.pin("w", s=10)
    runs = [scene.run(duration=0.02, tol=1e-4, output_step=0.01) for scene in (apart, whole)]
    assert np.array_equal(*(run["w.nodal_vectors"] for run in runs))


@pytest.mark.parametrize("element", ELEMENTS)
def test_section_forces_pass_through_joints(element):
    """At rest the moment, too, to 5 %: the mesh resolves a part of the bending beside the joint alone."""
    scene = taut(element)
    run = scene.run(duration=0.05, tol=1e-6, output_step=0.05)
    for state, errors in ((scene.equilibrium(), {"force": 1e-4, "moment": 0.05}), (run, {"force": 1e-4})):
        at = [state.section_forces("w", s=np.array([s])) for s in (5 - 1e-7, 5 + 1e-7)]
        for name, error in errors.items():
            before, after = (np.asarray(each[name]).reshape(-1, 3)[-1] for each in at)
            assert after == pytest.approx(before, abs=error * np.abs(before).max()), name


@pytest.mark.parametrize("element", ["cable12", "cable8p", "beam24", "beam12p"])
@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit"])
def test_a_slide_passes_a_joint(element, integrator):
    """The energy of the rider and the cable stays, and the rider keeps its speed along the cable."""
    scene = taut(element, elements=6)
    scene.rigid_body("A", mass=0.2, inertia=(1e-3, 1e-3, 1e-3), position=tuple(scene.cables["w"].point(4.8)),
                     velocity=(20, 0, 0))
    scene.slide("A", along="w", s=4.8, name="trolley")
    run = scene.run(duration=0.02, tol=1e-5, output_step=0.002, integrator=integrator)
    assert run["trolley.s"][-1] > 5.1
    energy = sum(np.asarray(run[f"energy.{name}"]) for name in ("kinetic", "elastic", "potential"))
    assert np.ptp(energy) < 1e-3 * float(run["energy.kinetic"][0])
    assert run["A.velocity"][-1, 0] == pytest.approx(20, rel=2e-3)


@pytest.mark.parametrize("element", ["cable8p", "beam12p", "cable12"])
def test_places_beyond_a_joint_are_those_of_the_drawing(element):
    """Parts that are placed on a bent cable beyond two nodes of one place lie on it."""
    def bent(stiff):
        scene = fu.Scene()
        return scene.cable("rope", points=[(0, 0, 0), (0.5, -0.1, 0), (1, 0, 0)], rest="straight", element=element,
                           up=(0, 1, 0), pieces=[fu.Piece(length=0.4, section=SECTION, material=SOFT, elements=2),
                                                 fu.Piece(length=0.6, section=SECTION, material=stiff, elements=3)])
    unlike, alike = bent(STIFF), bent(SOFT)
    assert len(unlike.nodal_vectors) == len(alike.nodal_vectors) + 1
    for s in (0.1, 0.4, 0.45, 0.6, 0.9, 1.0):
        np.testing.assert_allclose(unlike.point(s), alike.point(s), atol=1e-12)
        np.testing.assert_allclose(unlike.slope(s), alike.slope(s), atol=1e-12)


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit"])
def test_a_joint_passes_the_direction_up(integrator):
    """A cable in space of unlike pieces swings through the vertical, whatever `up` its axes were drawn with."""
    def tip(up):
        scene = fu.Scene(gravity=(0, -9.81, 0))
        material = [fu.Material(youngs_modulus=E, poisson_ratio=0, density=1000) for E in (1e6, 2e6)]
        rope = scene.cable("rope", start=(0, 0, 0), end=(1, 0, 0), element="cable12", up=up, pieces=[
            fu.Piece(length=0.5, section=fu.Circle(radius=0.01), material=each, elements=2) for each in material])
        scene.pin(rope, s=0.0)
        positions = scene.run(duration=1.5, tol=1e-5, output_step=0.05, integrator=integrator)["rope.nodal_vectors"]
        assert positions[:, -1, 0, 0].min() < -0.5 and positions[-1, -1, 0, 0] > 0.4  # there and back
        return positions[:, -1, 0]
    np.testing.assert_allclose(tip((0, 1, 0)), tip((0, 0, 1)), atol=5e-5)


def test_the_energy_scheme_takes_pieces_that_share_slopes():
    """Others it refuses: their joints have no discrete gradient."""
    heavy = SOFT.remade({"density": 2 * SOFT.density})
    run = taut("cable8p", materials=(SOFT, heavy), elements=4).run(duration=0.05, step=1e-3, output_step=0.01,
                                                                    integrator="energy")
    energy = sum(np.asarray(run[f"energy.{name}"]) for name in ("kinetic", "elastic", "potential"))
    assert np.ptp(energy) < 1e-10 * np.abs(energy).max()
    with refused('cable "w": integrator "energy" has no discrete gradient of the joint of its pieces; give them one '
                 "axial stiffness and thermal_expansion, or take another integrator"):
        taut("cable8p").run(duration=0.01, step=1e-3, output_step=0.01, integrator="energy")


def test_damping_by_pieces():
    """The second piece alone is damped: the same dissipation as of two tied cables."""
    damped = SOFT.remade({"damping_time": 1e-3, "mass_damping": 2.0})
    one = taut("cable8p", (5.0, 5.0), (SOFT, damped))
    two = fu.Scene(gravity=(0, -9.81, 0))
    for name, start, material in (("a", 0.0, SOFT), ("b", 5.01, damped)):
        two.cable(name, start=(start, 0, 0), end=(start + 5.01, 0, 0), element="cable8p", rest="straight",
                  strain="engineering", rest_length=5.0, section=SECTION, material=material, elements=10)
    two.tie("a", s=5, to="b", at=0)
    two.pin("a", s=0)
    two.pin("b", s=5)
    lost = [float(scene.run(duration=0.2, step=5e-4, output_step=0.2)["energy.dissipated"][-1])
            for scene in (one, two)]
    assert lost[0] > 0
    assert lost[0] == pytest.approx(lost[1], rel=1e-9)


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_run_resumes_bit_for_bit(element, tmp_path):
    check_file_and_resume(taut(element, elements=4), tmp_path, 8, duration=0.02, tol=1e-4, output_step=0.001)


def test_scene_files():
    scene = riser(MESHES[100])
    text = scene.to_toml()
    assert read(text, "x.toml", fu.Scene).to_toml() == text
    first, *others = scene.cables["riser"].pieces
    finer = scene.replace("riser", pieces=[first.remade({"elements": 2 * first.elements}), *others])
    assert finer.cables["riser"].elements == scene.cables["riser"].elements + first.elements


def test_a_number_of_a_piece_is_adjusted():
    """The length of a piece is found for a force, and the scene with it has that force; parts keep their places in the
    pieces.
    """
    scene = taut("cable8p", elements=4)
    scene.force("w", s=5, value=(0, -50, 0), name="at_joint")
    scene.force("w", s=7.5, value=(0, -30, 0), name="beyond")
    wanted = 1.1 * float(np.asarray(scene.equilibrium()["w@10.force"])[0])
    found = scene.equilibrium(adjust={"w.pieces.0.length": (4.98, 5.0)}, to={"w@0.force.x": -wanted})
    again = found.scene.equilibrium()
    assert float(np.asarray(again["w@0.force"])[0]) == pytest.approx(-wanted, rel=1e-6)
    length = found.scene.cables["w"].pieces[0].length
    assert length < 5
    assert [load.s for load in found.scene.loads.values()] == pytest.approx([length, length + 2.5], rel=1e-12)


def test_a_sweep_over_the_length_of_a_piece():
    """The weight on the upper end of a hanging line of two materials."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.cable("w", start=(0, 0, 0), end=(0, -2, 0), element="cable8p", rest="straight", pieces=[
        fu.Piece(length=1, section=SECTION, material=material, elements=2) for material in (SOFT, STIFF)])
    scene.pin("w", s=0)
    lengths = [0.9, 1.1]
    table = fu.sweep(scene, {"w.pieces.1.length": lengths}, keep=["w@0.force.y"], workers=0, initial="equilibrium",
                     duration=0.01, step=0.005, output_step=0.01)
    weight = (SOFT.density + STIFF.density * np.array(lengths)) * SECTION.area * 9.81
    assert np.asarray(table["w@0.force.y"])[:, 0] == pytest.approx(weight, rel=1e-9)


@pytest.mark.parametrize("free", ["unset", "all"])
def test_a_choice_of_elements_for_pieces(free):
    """The pieces keep the ratio of their numbers of elements; the choice keeps the tolerance, and shear of slender
    pieces counts little though their curvature jumps at the joint.
    """
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.cable("w", start=(0, 0, 0), end=(1, 0, 0), rest="straight", up=(0, 1, 0), pieces=[
        fu.Piece(length=0.6, section=fu.Circle(radius=0.01), material=SOFT, elements=4),
        fu.Piece(length=0.4, section=fu.Circle(radius=0.006), material=STIFF, elements=2)])
    scene.clamp("w", s=0)
    settings = {"duration": 0.1, "tol": 1e-2}
    choice = scene.choose(**settings, free=free)
    elements = [piece.elements for piece in choice.scene.cables["w"].pieces]
    assert elements == [4, 2] if free == "unset" else elements[0] == 2 * elements[1] > 2
    assert choice.scene.cables["w"].element == "cable8p", str(choice)
    finer = choice.scene.replace("w", pieces=[piece.remade({"elements": 16})
                                              for piece in choice.scene.cables["w"].pieces])
    tips = [each.run(duration=0.1, tol=tol, output_step=0.02)["w.nodal_vectors"][:, -1, 0]
            for each, tol in ((choice.scene, choice.scene.run_settings["tol"]), (finer, 1e-5))]
    assert np.abs(tips[0] - tips[1]).max() < 1e-2 * np.abs(tips[1] - tips[1][0]).max()


def test_a_sweep_over_a_number_of_a_piece():
    scene = taut("cable8p", elements=4)
    moduli = [1e9, 4e9]
    table = fu.sweep(scene, {"w.pieces.1.material.youngs_modulus": moduli}, keep=["w@0.force.x"], workers=0,
                     duration=0.01, tol=1e-3, output_step=0.01)
    each = [taut("cable8p", materials=(SOFT, STIFF.remade({"youngs_modulus": E})), elements=4).run(
        duration=0.01, tol=1e-3, output_step=0.01)["w@0.force"][:, 0] for E in moduli]
    assert np.array_equal(np.asarray(table["w@0.force.x"]), each)


def test_a_picture_shows_each_piece_with_its_diameter():
    scene = taut("cable12", materials=(SOFT, SOFT))
    pieces = [piece.remade({"section": fu.Circle(radius=radius)})
              for piece, radius in zip(scene.cables["w"].pieces, (0.01, 0.02), strict=True)]
    clip, = of_scene(scene.replace("w", pieces=pieces), "x").clips
    assert [(cable.name, cable.section["diameter"]) for cable in clip.cables] == [
        ("w, piece 0", 0.02), ("w, piece 1", 0.04)]
    assert clip.cables[0].s[-1] == clip.cables[1].s[0] == 5


PIECE = fu.Piece(length=5, section=SECTION, material=SOFT, elements=4)


@pytest.mark.parametrize(("entries", "message"), [
    ({"pieces": [PIECE], "section": SECTION}, 'cable "w": has pieces and section; leave section out: each piece has '
                                              'its own section'),
    ({"pieces": [PIECE], "rest_length": 5.0}, 'cable "w": has pieces and rest_length; leave rest_length out: each '
                                              'piece has its own length'),
    ({"pieces": []}, 'cable "w": pieces must be a list of pieces'),
    ({"pieces": [{"length": -1, "section": SECTION, "material": SOFT, "elements": 1}]}, "length must be positive"),
    ({"points": [(0, 0, 0), (1, 1, 0), (2, 0, 0)], "start": None, "end": None, "pieces": [PIECE]},
     "is drawn curved and has pieces, whose stress-free shape is straight"),
    ({"curve": lambda u: (np.cos(6 * u), np.sin(6 * u), 0), "start": None, "end": None, "rest": "straight",
      "up": (0, 0, 1), "pieces": [PIECE.remade({"material": material, "elements": 1, "length": length})
                                  for material, length in ((SOFT, 0.3), (STIFF, 5.7))]},
     "element 2 of 2 cannot follow the curve"),
    ({}, "section is missing"),
    ({"pieces": [PIECE, PIECE.remade({"length": 1e-5, "elements": 20})]},
     "pieces.1 of 1e-05 m has elements of 5e-07 m: the longest of the cable is 2.5e+06 times as long, at most 1e+06 "
     "times is allowed"),
])
def test_bad_pieces_are_refused(entries, message):
    given = {"start": (0, 0, 0), "end": (5, 0, 0), **entries}
    with pytest.raises(fu.SceneError) as error:
        fu.Scene().cable("w", **{name: value for name, value in given.items() if value is not None})
    assert message in str(error.value)


def test_drags_of_parts_that_do_not_fit_are_refused():
    scene = taut("cable12")
    scene.fluid("sea", density=1000)
    with refused('drag "drag_1": start must be a node of the cable, got 0.1 m; nodes near it are at 0, 0.5 m'):
        scene.drag("w", start=0.1, normal=1.0)
    with pytest.raises(fu.SceneError, match="stop must be beyond start"):
        scene.drag("w", start=5, stop=1, normal=1.0)
    scene.drag("w", start=0, stop=5, normal=1.0)
    scene.drag("w", start=5, normal=1.0)
    with pytest.raises(fu.SceneError, match='has the drag "drag_1" already'):
        scene.drag("w", start=4, stop=6, normal=1.0)


@pytest.mark.parametrize("materials", [(SOFT, SOFT), (SOFT, STIFF)])
def test_a_drag_acts_on_the_part_that_it_names(materials):
    """Beyond a joint, too, that has two nodes: buoyancy alone, of the part of the length."""
    scene = taut("cable12", materials=materials)
    scene.fluid("sea", density=1000)
    scene.drag("w", start=7, stop=9, normal=0.0, tangential=0.0, name="d")
    state = scene.equilibrium()
    assert float(state["d.force"][1]) == pytest.approx(1000 * SECTION.area * 2 * 9.81, rel=1e-12)
    before, after = (np.asarray(state.section_forces("w", s=[s])["force"]).ravel() for s in (6.99999, 9.00001))
    weight = materials[1].density * SECTION.area * 9.81
    assert abs(after[1] - before[1]) == pytest.approx(2 * (weight - 1000 * SECTION.area * 9.81), rel=1e-4)


def test_what_needs_one_section_says_so():
    scene = taut("cable8p")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with pytest.raises(fu.SceneError, match="several materials"):
            _ = scene.cables["w"].material


def hinged(element: str, by_tie: bool) -> fu.Scene:
    """Return a line under its weight, of two pieces with a hinge, or of two cables with a free tie between them."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    ends, up = [(0, 0, 0), (5, -1, 0), (9.9, 0, 0)], DIRECTORS.get(element, (0, 1, 0))
    if by_tie:
        for name, start, end, material in zip("wv", ends, ends[1:], (SOFT, STIFF), strict=False):
            scene.cable(name, start=start, end=end, element=element, rest="straight", rest_length=5.0, up=up,
                        section=SECTION, material=material, elements=6, **law_of(element))
        scene.tie("w", s=5, to="v", at=0, rotation="free")
        scene.pin("v", s=5)
    else:
        scene.cable("w", start=ends[0], end=ends[2], element=element, rest="straight", up=up, **law_of(element),
                    pieces=[fu.Piece(length=5.0, section=SECTION, material=material, elements=6,
                                     hinge=material is STIFF) for material in (SOFT, STIFF)])
        scene.pin("w", s=10)
    scene.pin("w", s=0)
    scene.point_mass("w", s=5, mass=20.0)
    return scene


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_hinge_is_a_free_tie(element):
    """At rest, in modes and in the section forces beside it; it carries no moment."""
    one, other = (hinged(element, by_tie) for by_tie in (False, True))
    rests = one.equilibrium(), other.equilibrium()
    force = [np.asarray(rest["w@0.force"]) for rest in rests]
    assert force[0] == pytest.approx(force[1], rel=1e-7, abs=1e-9)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)  # on frequencies near zero that rounding hides
        frequencies = [np.asarray(rest.scene.modes(5, about=rest).frequency) for rest in rests]
    assert frequencies[0] == pytest.approx(frequencies[1], rel=1e-6, abs=1e-5)
    at = [rest.section_forces("w", s=[2.0, 5 - 1e-7]) for rest in rests]
    assert np.asarray(at[0]["force"]) == pytest.approx(np.asarray(at[1]["force"]), rel=1e-5, abs=1e-5)
    assert np.asarray(at[0]["moment"])[0] == pytest.approx(np.asarray(at[1]["moment"])[0], rel=1e-5)
    assert np.abs(np.asarray(at[0]["moment"])[1]).max() < 1e-5 * np.abs(np.asarray(at[0]["moment"])[0]).max()


@pytest.mark.parametrize(("radius", "elements", "pieces"), [(0.01, 2, 2), (0.01, 6, 2), (0.01, 4, 3)])
def test_pieces_of_beams_turn_freely_beside_hinges(radius, elements, pieces):
    """Each about its own line: as many zeros, and no mode twice. Rounding of a zero was below the shift of the inverse
    at which it was sought, and another mode was found in its stead."""
    scene, materials = fu.Scene(gravity=(0, -9.81, 0)), (SOFT, STIFF)
    scene.cable("w", start=(0, 0, 0), end=(4.95 * pieces, 0, 0), element="beam24", law="structural", rest="straight",
                up=(0, 0, 1), pieces=[fu.Piece(length=5.0, section=fu.Circle(radius=radius), material=materials[k % 2],
                                               elements=elements, hinge=k > 0) for k in range(pieces)])
    scene.pin("w", s=0)
    scene.pin("w", s=5 * pieces)
    rest = scene.equilibrium()
    few, more = (np.asarray(scene.modes(n, about=rest).frequency) for n in (pieces + 2, pieces + 6))
    assert np.count_nonzero(few) == 2 and not few[:pieces].any()
    assert few == pytest.approx(more[:len(few)], rel=1e-6)
    apart = np.diff(more[pieces:])  # two neighbours of one swing have no equal frequencies
    assert (apart > 1e-4 * more[pieces]).all()


@pytest.mark.parametrize("element", ["cable12", "cable8p"])
@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit", "energy"])
def test_a_hinge_moves_as_a_free_tie(element, integrator):
    runs = [hinged(element, by_tie).equilibrium() for by_tie in (False, True)]
    given = {"step": 1e-4} if integrator == "energy" else {"tol": 1e-6}
    ends = []
    for rest in runs:
        rest.scene.force("w", s=2.0, value=(0, 300.0, 0))
        ends.append(rest.scene.run(duration=0.01, initial=rest, output_step=0.01, integrator=integrator, **given))
    assert ends[0]["w.position"][-1, :6] == pytest.approx(ends[1]["w.position"][-1, :6], abs=1e-6)


def test_a_hinge_resumes_and_is_refused_where_something_slides(tmp_path):
    scene = hinged("cable8p", False)
    assert read(scene.to_toml(), "scene", fu.Scene).to_toml() == scene.to_toml()
    check_file_and_resume(scene, tmp_path, 8, duration=0.02, tol=1e-4, output_step=0.001)
    with refused('slide "x": moves along cable "w", whose tangent may jump at the hinge at 5 m; leave the hinge out, '
                 "or end a cable on each side and join them by a tie"):
        scene.slide(tuple(scene.cables["w"].point(2.0)), along="w", s=2.0, name="x")
    with refused('cable "v": begins with a piece at a hinge, which joins a piece to the one before it; leave hinge out '
                 "of the first piece"):
        scene.cable("v", start=(0, 0, 0), end=(5, 0, 0), element="cable8p", rest="straight", pieces=[fu.Piece(
            length=5.0, section=SECTION, material=SOFT, elements=2, hinge=True)])


TAPER = 0.1, 0.05
"""Diameters at the start and at the end of a cone, m."""


def cone(tol: float, element: str = "cable8p") -> fu.Scene:
    """Return a cantilever of 2 m, a cone, clamped at its thick start."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("w", start=(0, 0, 0), end=(2, 0, 0), element=element, rest="straight", **law_of(element),
                up=DIRECTORS.get(element, (0, 1, 0)), pieces=fu.tapered([0, 2], TAPER, material=STIFF, tol=tol))
    scene.clamp("w", s=0)
    return scene


@pytest.mark.parametrize("element", ["cable12", "cable8p"])
@pytest.mark.parametrize("tol", [0.04, 0.01, 0.0025])
def test_a_cone_by_pieces(element, tol):
    """Elongation 4 F L/(pi E d0 d1) and deflection 64 F L^3/(3 pi E d0^3 d1) err by less than tol."""
    (d0, d1), E, force = TAPER, STIFF.youngs_modulus, 1e-3
    for along, closed in (((force, 0, 0), 4 * 2 / (d0 * d1)), ((0, force, 0), 64 * 2**3 / (3 * d0**3 * d1))):
        scene = cone(tol, element)
        scene.force("w", s=2, value=along)
        moved = float(np.linalg.norm(scene.equilibrium()["w.position"][-1] - (2, 0, 0)))
        assert moved == pytest.approx(force * closed / (np.pi * E), rel=tol)
    mass = np.pi / 12 * 2 * (d0**2 + d0 * d1 + d1**2) * STIFF.density
    assert scene.cables["w"].mass == pytest.approx(mass, rel=tol / 6)


def test_a_tapered_tube_and_refusals():
    pieces = fu.tapered([0, 1, 3], [0.2, 0.1, 0.1], inner_diameter=[0.16, 0.0, 0.0], material=STIFF, elements=2)
    assert pieces[0].section.inner_radius == pytest.approx(0.08 * 0.95)
    assert isinstance(pieces[-1].section, fu.Circle) and pieces[-1].length == 2
    assert sum(piece.length for piece in pieces) == pytest.approx(3)
    for given, message in (
            (([0, 1], [0.1]), "s and diameter must be of equal length, got 2 and 1"),
            (([1, 2], [0.1, 0.1]), "s must begin at 0 and have 2 places or more, got (1, 2) m"),
            (([0, 1], [0.1, 0.0]), "must be positive, got 0 m"),
            (([0, 1], [1.0, 1e-3]), "takes more than 1000 pieces; give a larger tol"),
            (([0, 1, 1], [0.1, 0.1, 0.1]), "s must increase, got 1 m after 1 m")):
        with refused(f"tapered: {message}"):
            fu.tapered(*given, material=STIFF)
    with pytest.raises(fu.SceneError, match="inner_radius"):
        fu.tapered([0, 1], [0.1, 0.1], inner_diameter=[0.2, 0.2], material=STIFF)
