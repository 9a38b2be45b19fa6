"""`funicular derive` gives the same bytes, finds and names drift, and keeps operation counts below their ceilings."""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from ast import literal_eval
from dataclasses import asdict, replace
from pathlib import Path

import pytest
from funicular.derive import pipeline
from funicular.derive.catalogue import families
from funicular.derive.codegen import drift, provenance
from funicular.derive.codegen import rendering as emit
from funicular.derive.codegen.family import Family, FamilyError
from funicular.derive.codegen.program import Program
from funicular.derive.verify.compiled import compiler
from funicular.generated import described
from funicular.kernels.elements import of_manifest
from import_contracts import TOP
from installed import runnable_tree
from operation_ceilings import CEILINGS, POINT_LAW

FRESH = ["rigid", "beam12p"]
"""Families that are derived anew here: a body, and the group of an element with its laws. The drift check of .ci/run
derives every family, twice, with different hash seeds.
"""


def hashes(files: dict[str, str]) -> dict[str, str]:
    return {name: hashlib.sha256(text.encode()).hexdigest() for name, text in files.items()}


@pytest.fixture(scope="module")
def derived() -> dict[str, str]:
    """Return the generated files as checked in."""
    return {name: drift.current(name) for name in (*drift.record()["files"], *emit.COMMON, drift.MANIFEST)}


@pytest.fixture
def copy(tmp_path, monkeypatch, derived) -> Path:
    """Return a separate, up-to-date copy of the generated folder."""
    monkeypatch.setattr(drift, "folder", lambda: tmp_path)
    drift.write(derived)
    return tmp_path


@pytest.fixture
def remembered(monkeypatch, derived):
    """Return a check that accepts the checked-in files as those of the specs."""
    monkeypatch.setattr(pipeline, "generate", lambda names=None, show=False: dict(derived))


def test_no_spec_and_no_tool_has_changed_since_the_checked_in_files_were_made():
    assert pipeline.changed() == [], "`funicular derive` derives these anew"
    assert drift.extra(families()) == []


def test_another_process_and_hash_seed_give_the_bytes_that_are_checked_in(derived):
    script = ("from funicular.derive import pipeline; from test_derive import FRESH, hashes; "
              "print(hashes(pipeline.generate(FRESH)))")
    other = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True,
                           cwd=Path(__file__).parent,
                           env={**os.environ, "PYTHONHASHSEED": "4242", "PYTHONPATH": str(TOP / "tests")})
    made, checked_in = literal_eval(other.stdout), hashes(derived)
    assert {f"{name}.c" for name in (*FRESH, "beam12p_structural")} < set(made)
    assert made == {name: checked_in[name] for name in made}


def _edited(folder: Path) -> None:
    file = folder / "rigid.c"
    file.write_text(file.read_text().replace("void rigid_point(", "void rigid_Point("))


def _missing(folder: Path) -> None:
    (folder / "registry.c").unlink()


def _extra(folder: Path) -> None:
    (folder / "old_element.c").write_text("/* left behind */\n")


EXTRA = ("old.pxd", "old.so", "kernels.so", "kernels.abi3.so", "old.inc", "notes.txt", "Makefile", "old.pyc",
         ".hidden.h", "sub/beam24.c", "sub/deep/__init__.py", "__pycache__/old.cpython-311.pyc", "__pycache__/x.so")


def _more_extra(folder: Path) -> None:
    for name in EXTRA:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text("")
    (folder / "empty").mkdir()
    (folder / "linked").symlink_to(folder)


def _stale(folder: Path) -> None:
    _edited(folder)
    manifest = folder / "manifest.json"
    manifest.write_text(re.sub(r'("bodies/rigid.py": )"\w+"', r'\1"0123456789abcdef"', manifest.read_text()))


def _line_ends(folder: Path) -> None:
    (folder / "kernels.h").write_bytes((folder / "kernels.h").read_bytes().replace(b"\n", b"\r\n"))


def _no_manifest(folder: Path) -> None:
    (folder / "manifest.json").write_text("{broken")


def contents(folder: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_what_a_build_and_an_import_leave_is_no_drift(copy, remembered):
    for name in ("kernels.c", "kernels.cpython-311-x86_64-linux-gnu.so", "kernels.cp313-win_amd64.pyd",
                 "__pycache__/__init__.cpython-312.pyc"):
        (copy / name).parent.mkdir(exist_ok=True)
        (copy / name).write_text("")
    assert drift.extra(families()) == []


@pytest.mark.parametrize(("damage", "texts", "mended"), [
    (_edited, ("differs: generated/rigid.c", "-void rigid_Point(", "+void rigid_point("), True),
    (_missing, ("missing: generated/registry.c",), True),
    (_extra, ("extra: generated/old_element.c", "delete"), False),
    (_more_extra, tuple(f"extra: generated/{name} (" for name in (*EXTRA, "empty", "linked")), False),
    (_stale, ("stale (its spec has changed): generated/rigid.c", "-void rigid_Point(",
              '-  "bodies/rigid.py": "0123456789abcdef"'), True),
    (_line_ends, ("differs: generated/kernels.h", "line ends"), True),
    (_no_manifest, ("differs: generated/manifest.json",), True),
], ids=lambda v: v.__name__.strip("_") if callable(v) else "")
def test_check_names_what_is_wrong_and_the_command_that_mends_it(copy, remembered, capsys, damage, texts, mended):
    assert pipeline.main([], check=True) == 0
    damage(copy)
    before = contents(copy)
    capsys.readouterr()
    assert pipeline.main([], check=True) == 1
    out, err = capsys.readouterr()
    assert all(text in out for text in texts), out
    assert ("`funicular derive` mends it" in err) == mended
    assert contents(copy) == before, "a check writes nothing"
    assert pipeline.main([]) == 0
    assert pipeline.main([], check=True) == (0 if mended else 1)


def test_a_name_derives_and_writes_that_family_alone(copy, monkeypatch):
    rigid, beam = copy / "rigid.c", copy / "beam24.c"
    good = rigid.read_text()
    rigid.write_text("damaged")
    beam.write_text("damaged too")
    seen = []
    derive = emit.derive
    monkeypatch.setattr(emit, "derive", lambda family: seen.append(family.name) or derive(family))
    assert pipeline.main(["rigid"]) == 0
    assert seen == ["rigid"]
    assert rigid.read_text() == good
    assert beam.read_text() == "damaged too"


def test_a_name_keeps_the_other_families_as_the_manifest_has_them(copy, derived):
    pipeline.main(["rigid"])
    manifest, whole = json.loads((copy / "manifest.json").read_text()), json.loads(derived["manifest.json"])
    assert manifest == whole
    del manifest["families"]["slide_beam24_rigid"]
    (copy / "manifest.json").write_text(json.dumps(manifest))
    pipeline.main(["rigid"])
    assert "slide_beam24_rigid" not in (copy / "kernels.h").read_text(), "a family not derived yet stays out"


def test_check_of_a_name_gives_the_command_with_the_name(copy, capsys):
    (copy / "rigid.c").write_text("damaged")
    assert pipeline.main(["rigid"], check=True) == 1
    assert "`funicular derive rigid` mends it" in capsys.readouterr().err


def test_an_unknown_name_gets_the_near_ones(capsys):
    assert pipeline.main(["beam42"]) == 1
    assert 'no spec "beam42"; did you mean beam24' in capsys.readouterr().err


def test_a_folder_that_cannot_be_written_is_reported(copy, monkeypatch, capsys):
    (copy / "rigid.c").write_text("damaged")

    def refuse(*args, **kwargs):
        raise PermissionError(13, "Permission denied", "rigid.c")

    monkeypatch.setattr(Path, "write_text", refuse)
    assert pipeline.main(["rigid"]) == 1
    assert "rigid.c" in capsys.readouterr().err


def test_operation_counts_stay_below_their_ceilings(derived):
    manifest = json.loads(derived["manifest.json"])
    counts = {name: sum(k["operations"].values()) for name, k in described(manifest).items()}
    ceilings = {f"{family}_{kernel}": n for family, each in CEILINGS.items() for kernel, n in each.items()}
    others = [law for law in manifest["point_laws"] if law not in CEILINGS]
    of_others = {f"{law}_{kernel}": n for law in others for kernel, n in POINT_LAW.items()}
    ceilings |= {name: n for name, n in of_others.items() if name in counts}
    assert set(counts) == set(ceilings), "a new kernel needs its ceiling in operation_ceilings.py"
    over = {name: f"{count} > {ceilings[name]}" for name, count in counts.items() if count > ceilings[name]}
    assert not over


def test_kernels_of_a_role_that_differ_are_refused_or_declared():
    """A table has one signature: a kernel with another one is refused, or declared as different."""
    def family(name, parameters, **more):
        program = Program(f"{name}_area", "area", "")
        program.output("A", [sum(program.input(p, (), "m", "side") for p in parameters)], "m", "area")
        return emit.Derived(Family(name, "", list, (), role="shape", **more), [program])

    square, box = family("square", "a"), family("box", "ab")
    with pytest.raises(FamilyError, match=r'role "shape": .* kernel area .* square has \(fu_real a, fu_real \*A\), '
                                        r"box has \(fu_real a, fu_real b, fu_real \*A\).* Family.outside_table"):
        emit.render([square, box], [], print)
    with pytest.raises(FamilyError, match=r"other has \(none\)"):
        emit.render([square, replace(family("other", "a"), programs=[])], [], print)
    apart = [family("square", "a", outside_table=("area",)), family("box", "ab", outside_table=("area",))]
    header = emit.render(apart, [], print)["kernels.h"]
    assert "void square_area(fu_real a, fu_real *A);" in header
    assert "(*area)" not in header


def test_a_scene_knows_of_a_law_what_its_spec_says(derived):
    """The manifest has the traits of the specs, and the runtime reads all of them."""
    elements = json.loads(derived["manifest.json"])["elements"]
    for family in families().values():
        if family.role == "law":
            known = of_manifest({"elements": elements})[family.element.name].laws[family.law]
            said = asdict(family.traits) | {"stiffness_of": family.stiffness_of, "shared": family.shared,
                                            "discrete_gradient": "discrete_force" not in family.missing}
            del said["damped_like"], said["relaxed_like"]  # whose kernels those are, `shared` tells
            assert asdict(known) == said
            assert known.straight in {"", *family.element.laws}


def test_hashes_stand_in_the_manifest_alone(derived):
    manifest, every = json.loads(derived["manifest.json"]), families().values()
    of_families = {name: derived[name] for family in every for name in drift.of(family)}
    assert manifest["files"] == {name: emit.digest(text) for name, text in of_families.items()}
    assert manifest["sources"] == provenance.hashes(every)
    assert not any(re.search(r"\b(?=\d*[a-f])[0-9a-f]{16,}\b", text) for text in of_families.values())
    for name in manifest["families"]:
        preamble = derived[f"{name}.c"].partition("*/")[0]
        assert f"funicular derive {name}" in preamble
        assert manifest["families"][name]["source"] in preamble.replace("\n *", "")


def edit(monkeypatch, file: str, old: str, new: str) -> None:
    """Present a source of derive/ as edited in one place."""
    read = provenance._read
    assert read(file).decode().count(old) == 1
    monkeypatch.setattr(provenance, "_read",
                        lambda name: read(name).replace(old.encode(), new.encode()) if name == file else read(name))


@pytest.mark.parametrize(("file", "old", "new"), [
    ("codegen/c_printer.py", "Return the C text of an expression.", "Return an expression as C text."),
    ("codegen/c_printer.py", "# SymPy's printer knows", "# The printer of SymPy knows"),
    ("codegen/c_printer.py", "C text of SymPy expressions, the same", "SymPy expressions as C text: the same"),
    ("codegen/sharing.py", "Shortest stage, or part of one, that", "Least size of a stage or a part that"),
], ids=["docstring", "comment", "module", "constant"])
def test_docstrings_and_comments_of_a_source_change_nothing(monkeypatch, file, old, new):
    edit(monkeypatch, file, old, new)
    assert pipeline.changed() == []
    assert provenance.hashes(families().values()) == drift.record()["sources"]


@pytest.mark.parametrize(("file", "old", "new"), [
    ("bodies/rigid.py", '= "rigid body"', '= "stiff body"'),
    ("bodies/rigid.py", "DOC, SOURCE = ", "import itertools\nDOC, SOURCE = "),
    ("bodies/rigid.py", "= \"rigid\", 3, 7, 6", "= \"rigid\", 3, 7, 6.0"),
], ids=["text", "statement", "type"])
def test_any_other_edit_of_a_spec_has_its_families_derived(monkeypatch, file, old, new):
    edit(monkeypatch, file, old, new)
    assert {"rigid", "modal", "slide_cable12_rigid"} <= set(pipeline.changed())
    assert not {"cable12", "planar_spring", "crossing"} & set(pipeline.changed())


def test_a_source_that_others_wait_for_keeps_its_old_hash(copy, monkeypatch):
    """After an edit that concerns several families, `derive NAME` leaves the others to the next `derive`."""
    recorded = drift.record()
    edit(monkeypatch, "couplings/resistance.py", "RESISTANCES = ", "import itertools\nRESISTANCES = ")
    both = ["resistance", "planar_resistance"]
    assert pipeline.main(both[1:]) == 0
    assert drift.record() == recorded
    assert pipeline.changed() == both
    assert pipeline.main(both) == 0
    assert pipeline.changed() == []


def test_another_version_of_a_tool_has_all_families_derived_whatever_one_of_them_was_since(copy):
    manifest = copy / "manifest.json"
    manifest.write_text(manifest.read_text().replace('"sympy": "', '"sympy": "0.'))
    assert pipeline.changed() == [*families()]
    assert pipeline.main(["frame"]) == 0
    assert pipeline.changed() == [*families()]


@pytest.mark.slow
def test_a_word_in_the_doc_of_an_element_changes_its_file_and_the_manifest(tmp_path):
    """Edits of the spec, then of the printer, in a copy of the package: the files that `funicular derive` writes."""
    package = runnable_tree(tmp_path)
    shutil.copytree(TOP / "generated", package / "generated", dirs_exist_ok=True)

    def written(file: str, old: str, new: str) -> tuple[set[str], int]:
        source, before = package / file, contents(package / "generated")
        assert source.read_text().count(old) == 1
        source.write_text(source.read_text().replace(old, new))
        script = "import sys; from funicular.derive.pipeline import main; sys.exit(main([]))"
        subprocess.run([sys.executable, "-c", script], cwd=tmp_path, check=True, capture_output=True)
        after = contents(package / "generated")
        changed = {path.name for path in {*before, *after} if before.get(path) != after.get(path)
                   and path.parent.name != "__pycache__"}
        rows = [set(one[package / "generated" / "manifest.json"].splitlines()) for one in (before, after)]
        return changed, len(rows[1] - rows[0])

    assert written("derive/elements/cable8p.py", "planar ANCF cable", "plane ANCF cable") == (
        {"cable8p.c", "manifest.json"}, 3)  # the doc, and the hashes of spec and file
    assert written("derive/codegen/c_printer.py", "Return the C text of an expression.", "Print.") == (set(), 0)


def test_the_hashed_sources_are_all_that_decide_a_family():
    beam = set(provenance.deciding(families()["beam24"].modules))
    assert beam >= {"elements/beam24.py", "elements/kernels.py", "algebra/section_integrals.py", "spec.py",
                    "codegen/program.py", "codegen/c_printer.py", "codegen/rendering.py",
                    "codegen/templates/family.c.jinja"}
    law = set(provenance.deciding(families()["cable12_green_exact"].modules))
    assert law >= {"elements/cable12.py", "laws/kernels.py", "laws/cable/cable.py", "algebra/gram.py",
                   "algebra/gram_tangent.py", "algebra/section_integrals.py"}
    assert not any(name.startswith(("algebra/gram", "laws")) for name in beam)
    assert {"laws/__init__.py", "laws/stress_free.py"} <= law, "a package and its module, by one import"
    slide = set(provenance.deciding(families()["slide_beam24_rigid"].modules))
    assert slide >= {"couplings/slide.py", "elements/beam24.py", "bodies/rigid.py", "algebra/tangent_frame.py",
                     "codegen/program.py"}
    assert "couplings/slide.py" not in beam | law
    assert not any(name.startswith("verify") for name in beam | law | slide)


@pytest.mark.parametrize("numbers", [[], ["-DFU_COMPLEX"]], ids=["real", "complex"])
def test_generated_c_has_no_warnings(copy, numbers):
    """The families derived here and those of a slide; .ci/run compiles all families in this way."""
    names = (*FRESH, "cable8p_green_linear", "slide_cable8p_planar_rigid", "registry")
    units = [str(copy / f"{name}.c") for name in names]
    command = [*compiler(), "-std=c11", "-Wall", "-Wextra", "-Werror", "-pedantic", "-fsyntax-only", *numbers, *units]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
