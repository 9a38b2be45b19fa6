"""Input files of MoorDyn read as scenes: against MoorDyn's forces, what is left out, refusals, the command."""

from pathlib import Path

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from funicular.cli.main import app
from moordyn_files import CLUMP, LINE, MOORDYN, ours
from typer.testing import CliRunner

NUMBERS = {"title": "t", "n": 4, "depth": 100, "dt": 0.01, "still": 0}


def written(folder: Path, text: str) -> Path:
    file = folder / "lines.txt"
    file.write_text(text, encoding="utf-8")
    return file


def of(folder: Path, *changes: tuple[str, str], text: str = CLUMP) -> fu.Scene:
    """Return the scene of a file with changes of its text."""
    text = text.format(**NUMBERS)
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    return fu.read_moordyn(written(folder, text))


@pytest.mark.parametrize("case", MOORDYN)
def test_forces_at_rest_are_those_of_moordyn(case, tmp_path, validated):
    bound = 2e-4 if case == "a line on a bed" else 1e-3  # the clump weight still swings in MoorDyn
    validated("Fluid", case, "force on the fairlead, along and down", MOORDYN[case], ours(case, tmp_path), unit="N",
              bound=bound, source="MoorDyn 2.7.2")


def test_each_number_arrives(tmp_path):
    scene = of(tmp_path)
    chain, rope = scene.cables["line_1"], scene.cables["line_3"]
    assert (chain.length, chain.elements, rope.length) == (170, 4, 55)
    assert chain.section.area * chain.material.youngs_modulus == pytest.approx(5e8)
    assert rope.section.second_moment_about_z * rope.material.youngs_modulus == pytest.approx(1000)
    assert chain.section.area * chain.material.density == pytest.approx(150)
    assert chain.material.damping_time == pytest.approx(0.8 * 170 / 4 * np.sqrt(150 / 5e8))
    assert rope.material.damping_time == pytest.approx(1e5 / 1e7)
    drag = scene.drags["line_1_water"]
    assert (drag.normal, drag.tangential, drag.added_mass, drag.diameter) == (1.6, 0.1, 1.0, 0.1)
    assert drag.added_mass_form == "morison"
    clump = scene.drags["point_3_water"]
    assert (clump.on, clump.area, clump.volume, clump.added_mass) == ("point_3", 1.5, 0.8, 0.5)
    assert scene.point_masses["point_3"].mass == 5000
    assert len(scene.ties) == 2
    assert {(pin.cable, pin.s) for pin in scene.pins} == {("line_1", 0), ("line_2", 0), ("line_3", 55)}
    assert scene.contacts["line_1_on_bed"].stiffness == pytest.approx(3e5 * 0.1)
    assert scene.fluids["sea"].density == 1025
    assert scene.gravity == (0, 0, -9.81)


def test_bodies_hold_points(tmp_path):
    bodies = ("---------------------- POINTS", "--- BODIES ---\nID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG I V CdA Ca\n"
              "(#) ...\n1 Fixed 160 0 -10 0 0 90 0 0 0 0 0 0\n2 Free 120 0 -50 0 0 0 5000 0|0|-1 100|100|50 0.8 2 0.5\n"
              "---------------------- POINTS")
    scene = of(tmp_path, bodies, ("3 Free 120 0 -50 5000 0.8 1.5 0.5", "3 Body2 0 0 1 0 0 0 0"),
               ("4 Coupled 160 0 -10", "4 Body1 2 0 0"))
    assert scene.cables["line_3"].point(55) == pytest.approx((160, 2, -10)), "turned by 90 degrees about z"
    assert len(scene.joints) == 3
    assert scene.joints["point_3_1"].b.at == (0, 0, 1)
    body = scene.bodies["body_2"]
    assert (body.mass, body.centre, body.inertia[2][2]) == (5000, (0, 0, -1), 50)
    assert scene.equilibrium()["body_2.position"][2] < -40


def test_bodies_may_begin_turned_and_may_be_pinned(tmp_path):
    bodies = ("---------------------- POINTS", "--- BODIES ---\nID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG I V CdA Ca\n"
              "(#) ...\n1 CoupledPinned 120 0 -50 30 20 90 5000 0 100 0.8 0.5|0.2 0.5\n---------------------- POINTS")
    scene = of(tmp_path, bodies, ("3 Free 120 0 -50 5000 0.8 1.5 0.5", "3 Body1 0 2 1 0 0 0 0"))
    body, end = scene.bodies["body_1"], scene.cables["line_3"].point(0)
    x, y, z = np.radians([30, 20, 90])
    rotation = (np.array([[1, 0, 0], [0, np.cos(x), -np.sin(x)], [0, np.sin(x), np.cos(x)]])
                @ np.array([[np.cos(y), 0, np.sin(y)], [0, 1, 0], [-np.sin(y), 0, np.cos(y)]])
                @ np.array([[np.cos(z), -np.sin(z), 0], [np.sin(z), np.cos(z), 0], [0, 0, 1]]))
    assert end == pytest.approx(np.array([120, 0, -50]) + rotation @ [0, 2, 1])
    assert body.point((0.0, 2.0, 1.0)) == pytest.approx(end)
    assert scene.joints["body_1_held"].kind == "joint" and len(scene.joints) == 4
    assert any("give its joint a motion" in note for note in scene.messages)
    assert any("none of rotations" in note for note in scene.messages)


def test_an_axial_law_from_a_file(tmp_path):
    (tmp_path / "rope.dat").write_text("rope\nstrain tension\n- N\n-0.1 0\n0 0\n0.01 2e4\n0.03 1e5\n", encoding="utf-8")
    scene = of(tmp_path, ("1e7 1e5", "rope.dat 1e5"))
    table = scene.cables["line_3"].section.tension_table
    assert (table.strain, table.force) == ((0.0, 0.01, 0.03), (0.0, 2e4, 1e5))
    scene.equilibrium()
    with refused(f"{tmp_path / 'bad.dat'}, line 5: tension must be a number, got 'x'; files are read of the axial "
                 "stiffness alone: give one number, and the law in the scene written"):
        (tmp_path / "bad.dat").write_text("rope\n\n\n0 0\n0.01 x\n", encoding="utf-8")
        of(tmp_path, ("1e7 1e5", "bad.dat 1e5"))


@pytest.mark.parametrize("dampings", [(4e9,), (4e9, 11e6)])
def test_static_and_dynamic_stiffness(dampings, tmp_path):
    """The impedance is that of MoorDyn's two springs in series, each beside its dashpot."""
    static, dynamic, (slow, fast) = 1.4e8, 1.6e8, (*dampings, 0.0)[:2]
    scene = of(tmp_path, ("1e7 1e5", f"{static}|{dynamic} {'|'.join(map(str, dampings))}"))
    material, section = scene.cables["line_3"].material, scene.cables["line_3"].section
    branch = scene.branches["line_3_viscosity"]
    EA = material.youngs_modulus * section.area
    for p in 1j * np.array([1e-3, 1e-2, 0.1, 1, 10, 100]):
        first, second = dynamic * static / (dynamic - static) + slow * p, dynamic + fast * p
        ours = EA * (1 + material.damping_time * p) + branch.stiffness * branch.time * p / (1 + branch.time * p)
        assert ours == pytest.approx(first * second / (first + second), rel=1e-12)


FIBRES = ("1e7 1e5", "SYROPE:rope.dat|1.5e8|23 5e10|1e5")
HIGHEST, MEAN, TOP = 1.3e6, 4e5, 0.0225
SHARE = MEAN / HIGHEST
CURVES = {"LINEAR": (0.3, 0.0, SHARE, 1.0), "QUADRATIC": (0.25, 1.0, SHARE**0.5, 2 * SHARE**0.5),
          "EXP": (0.2, 1.5, np.log1p(SHARE * np.expm1(1.5)) / 1.5, 1.5 * (SHARE + 1 / np.expm1(1.5)))}
"""k1, k2, and of the shape from 0 to 1 the place and the slope where it is MEAN over HIGHEST."""


def fibres(folder: Path, form: str, k1: float, k2: float, points: str = "0 0\n0.0225 1.3e6\n0.06 4.4e6\n") -> fu.Scene:
    """Return the scene of a file with a rope of fibres."""
    (folder / "rope.dat").write_text(f"curve.dat OWC of loading\n{form} WCType\n{k1} k1\n{k2} k2\n", encoding="utf-8")
    (folder / "curve.dat").write_text("rope\nstrain tension\n- N\n" + points, encoding="utf-8")
    tensions = f"--- SYROPE IC ---\nLine(s) Tmax0 Tmean0\n(-) (N) (N)\n3 {HIGHEST} {MEAN}\n"
    return of(folder, FIBRES, ("---------------------- OPTIONS", tensions + "--- OPTIONS"))


@pytest.mark.parametrize("form", CURVES)
def test_ropes_of_fibres(form, tmp_path):
    """Working curves below the highest tension, and the impedance of fast changes at the mean tension."""
    k1, k2, place, slope = CURVES[form]
    scene = fibres(tmp_path, form, k1, k2)
    cable, curve, branch = (of["line_3" + name] for of, name in (
        (scene.cables, ""), (scene.working_curves, "_curve"), (scene.branches, "_viscosity")))
    first = cable.section.tension_table.numbers()
    low = k1 * TOP
    strain = low + place * (TOP - low)
    assert curve.force_at(first, np.array([strain]), np.array([TOP])) == pytest.approx(MEAN, rel=1e-4)  # 20 segments
    assert curve.highest_tension == HIGHEST
    static, dynamic = slope * HIGHEST / (TOP - low), 1.5e8 + 23 * MEAN
    for p in 1j * np.array([1e-4, 1e-3, 0.1, 10]):
        first, second = dynamic * static / (dynamic - static) + 5e10 * p, dynamic + 1e5 * p
        ours = (static + cable.material.damping_time * cable.material.youngs_modulus * cable.section.area * p
                + branch.stiffness * branch.time * p / (1 + branch.time * p))
        assert ours == pytest.approx(first * second / (first + second), rel=1e-9)
    assert fu.Scene.from_toml(scene.to_toml()).to_toml() == scene.to_toml()


def test_a_working_curve_by_its_slope_is_that_from_the_highest_tension(tmp_path):
    """LINEAR with k1 in N, and a file of first loading whose points begin above 0 and are more than a table takes."""
    strains = np.linspace(0.002, 0.06, 30)
    scene = fibres(tmp_path, "LINEAR", 1.2e8, 0, "".join(f"{x} {HIGHEST * x / TOP * (1 + x)}\n" for x in strains))
    table, curve = scene.cables["line_3"].section.tension_table, scene.working_curves["line_3_curve"]
    top = table.strain_at(HIGHEST)
    assert top * (1 - curve.permanent) == pytest.approx(HIGHEST / 1.2e8, rel=1e-12)
    assert len(table.strain) == 20
    said = "\n".join(scene.messages)
    for part in ("curve.dat: begins at the strain 0.002", "20 of 31 points are taken", "the working curve is that from",
                 "the stiffness of fast changes is that of the mean tension"):
        assert part in said, said


BAD_FIBRES = {
    "k1": ("QUADRATIC", 1.2, 1.0, "rope.dat, line 3: k1 must be from 0 to below 1 with QUADRATIC, got 1.2"),
    "form": ("CUBIC", 0.2, 1.0, "rope.dat, line 2: WCType 'CUBIC' is not known; known: LINEAR, QUADRATIC, EXP"),
    "stiff": ("LINEAR", 0.8, 0.0, "lines.txt, line 20: the stiffness of fast changes, 159200000 N at the mean tension "
              "400000 N, must be above that of slow ones there, 288888889 N"),
}


@pytest.mark.parametrize("case", BAD_FIBRES)
def test_refusals_of_ropes_of_fibres(case, tmp_path):
    *given, message = BAD_FIBRES[case]
    with refused(f"{tmp_path}/{message}"):
        fibres(tmp_path, *given)


def test_what_it_leaves_out_is_said(tmp_path):
    options = ("9.81 g", "9.81 g\n1 WaveKin\nbed.txt SeafloorFile\n3 depthCharge")
    scene = of(tmp_path, options, ("2 Fixed 0 -100 -100 0", "2 Fixed 0 -100 -100 7"),
               ("4 Coupled", "5 Free 0 0 0 0 0 0 0\n4 Coupled"), ("--------------------- need", "--- CONTROL ---\nChan "
                "Line\n() ()\n1 1\n--------------------- need"))
    said = "\n".join(scene.messages)
    for part in ("waves are left out", "the sea floor is even here", "the option 'depthCharge' is not known",
                 "M, V and CdA of a point that is not free are left out", "the point has no line and is left out",
                 "in the place of its pin give a motion", "control are left out"):
        assert part in said, said


BAD = {
    "law": ("5e8", "5e8|6e8|0.4", 6, "the axial law '5e8|6e8|0.4' is not read; known: a number, a file of strain and "
            "tension, static|dynamic stiffness, SYROPE:file|stiffness|its growth"),
    "stiffness": ("5e8", "5e8|4e8", 6, "EA must be static|dynamic stiffness, the dynamic one larger, got '5e8|4e8'"),
    "EA": ("5e8", "-5e8", 6, "EA must be positive, got -500000000"),
    "dampings": ("-0.8 0 1.6", "1e6|1e5 0 1.6", 6, "BA must have no more numbers than EA, got '1e6|1e5'"),
    "mass": ("150 5e8", "0 5e8", 6, "Mass/m must be positive, got 0"),
    "type": ("1 chain 1 3", "1 chian 1 3", 18, "there is no line type 'chian'; did you mean \"chain\"?"),
    "point": ("1 chain 1 3", "1 chain 9 3", 18, "there is no point '9'; known: 1, 2, 3, 4"),
    "rod": ("1 chain 1 3", "1 chain R1A 3", 18, "ends at rod 'R1A', and rods are not read; give the end a point, and "
            "add a rigid body to the scene written"),
    "held": ("4 Coupled", "4 Turbine1", 14, "the attachment 'Turbine1' is not read; known: Fixed, Coupled, Free, "
             "Body#"),
    "twice": ("2 Fixed", "1 Fixed", 12, "there is already a line '1' of points; give each its own ID"),
    "short": ("3 4 55 4 -", "3 4", 20, "UnstrLen is missing, number 5 of the line"),
    "length": ("3 4 55 4 -", "3 4 -55 4 -", 20, "UnstrLen must be positive and NumSegs a whole number, got -55 m and "
               "4"),
    "columns": ("ID LineType AttachA AttachB UnstrLen", "Line LineType UnstrLen", 16, "has the columns of MoorDyn-1; "
                "give those of MoorDyn-2: ID LineType AttachA AttachB UnstrLen NumSegs Outputs"),
    "heading": ("- OPTIONS -", "- OPTOINS -", 21, "the heading 'OPTOINS' is not known; known: LINE TYPES, ROD TYPES, "
                "BODIES, RODS, POINTS, LINES, SYROPE IC, FAILURE, CONTROL, OPTIONS, OUTPUT"),
    "depth": ("100 WtrDpth", "bed.txt WtrDpth", 28, "WtrDpth must be a number, got 'bed.txt'; files are read of "
              "the axial stiffness alone: give one number, and the law in the scene written"),
    "nan": ("0 100 -100", "0 nan -100", 11, "Y must be a number, got 'nan'; files are read of the axial stiffness "
            "alone: give one number, and the law in the scene written"),
}


@pytest.mark.parametrize("case", BAD)
def test_refusals_name_the_line(case, tmp_path):
    old, new, line, message = BAD[case]
    with refused(f"{tmp_path / 'lines.txt'}, line {line}: {message}"):
        of(tmp_path, (old, new))


def test_other_files_are_refused(tmp_path):
    with refused(f"{tmp_path / 'none.txt'}: cannot be read: No such file or directory"):
        fu.read_moordyn(tmp_path / "none.txt")
    with refused(f"{tmp_path / 'lines.txt'}: has no line types; a table of them has the heading --- LINE TYPES ---"):
        fu.read_moordyn(written(tmp_path, "nothing\n"))
    with pytest.raises(fu.SceneError, match=r"lines.txt, line 18: cable \"line_1\": start and end must be different"):
        of(tmp_path, ("1 chain 1 3", "1 chain 1 1"))


def test_the_command_writes_a_scene(tmp_path):
    file = written(tmp_path, LINE.format(**NUMBERS | {"depth": 200}))
    result = CliRunner().invoke(app, ["import", "moordyn", str(file)])
    assert result.exit_code == 0, result.output
    scene = fu.load_scene(tmp_path / "lines.toml")
    assert scene.to_toml() == fu.read_moordyn(file).to_toml()
    assert "note: " in result.output and "written: " in result.output
    run = scene.run(duration=0.1)
    assert np.ptp(run["line_1.position"], axis=0).max() < 1e-3, "it begins at rest"
    assert CliRunner().invoke(app, ["import", "orcaflex", str(file)]).exit_code == 2
