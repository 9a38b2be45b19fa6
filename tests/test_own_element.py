"""The user's own elements: a spec file outside the package becomes a library; a bad one gets told what it lacks."""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import funicular
import numpy as np
import pytest
from funicular import load_run
from funicular.cli import app
from funicular.derive.catalogue import families
from funicular.derive.elements.cable18 import CABLE18
from funicular.derive.user_elements import command, load
from funicular.derive.user_elements.load import SpecError
from funicular.errors import SceneError
from funicular.generated import kernels
from funicular.kernels.elements import built_in, gauge, manifest
from funicular.kernels.libraries import LibraryError, manifest_digest
from funicular.kernels.libraries import load as load_library
from funicular.scene_file import load_scene, loads
from funicular.view.plot import save_plots
from pages import page
from shared_scenes import SQUARE, TABLE_1
from typer.testing import CliRunner

SPEC = '''
from funicular.derive.spec import Element, x, y, z

MINE = Element(
    name="mine8p",
    dim=2,
    basis=(1, x, x**2, x**3),
    nodal_vectors=("r", "r_x"),
    director="",
    laws=("green_linear",),
    doc="planar cable",
    source="a test",
)
'''
LAW = '''
import sympy as sp
from funicular.derive.laws.cable.cable import Cable


class Own(Cable):
    """A cable with the green strain and the linear curvature, but for what stands below."""

    name, stiffness_of = "own", "green_linear"

    def __init__(self, gram):
        super().__init__(gram, "green", "linear")
'''


def spec(path: Path, *changes: tuple[str, str], law: str = "") -> Path:
    """A spec file: the planar cable, changed, with a law of its own."""
    text = SPEC
    if law:
        text = LAW + law + text.replace('("green_linear",)', "(Own,)")
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    file = path / "mine.py"
    file.write_text(text, encoding="utf-8")
    return file


def refused(file: Path, out: Path) -> str:
    """What the command says of a spec that it refuses; nothing may be written."""
    with pytest.raises(SpecError) as told:
        command.main(file, out)
    assert not out.exists()
    assert [p.name for p in out.parent.iterdir()] == [file.name], "nothing is left behind"
    return str(told.value)


@pytest.fixture(scope="module")
def told(tmp_path_factory) -> tuple[Path, str]:
    """A library of the planar cable, and what the command said of it."""
    folder = tmp_path_factory.mktemp("own")
    told = CliRunner().invoke(app, ["derive", "--spec", str(spec(folder)), "--out", str(folder / "new" / "library")])
    assert told.exit_code == 0, told.output
    return folder / "new" / "library", told.output


@pytest.fixture(scope="module")
def made(told) -> Path:
    return told[0]


def test_the_command_derives_verifies_compiles_and_times(told):
    made, text = told
    for part in ("operations", "bytes of code", "rounding", "µs a call", "mine8p_green_linear_elastic_tangent",
                 'element = "mine8p"'):
        assert part in text
    assert {p.suffix for p in made.iterdir()} == {".c", ".h", ".json", ".so"}
    assert [p.name for p in made.parent.iterdir()] == ["library"]


def test_its_kernels_are_those_of_the_same_element_here(made):
    own = load_library(made).kernels
    random = np.random.default_rng(1)
    l, e, S = 0.7, random.normal(size=(4, 2)), [3.0, 2.0]
    A = own.mine8p_green_linear_stiffness(l, S)
    for name, inputs in (("elastic_force", (l, e, A)), ("damping_tangent", (l, e, 2 * e, A, 0.1, 3.0))):
        here = getattr(kernels, families()["cable8p_green_linear"].kernel(name))(*inputs)
        np.testing.assert_allclose(getattr(own, f"mine8p_green_linear_{name}")(*inputs), here, rtol=1e-14, atol=1e-14)
    N, r = own.mine8p_position(l=l, at=[0.1, 0, 0], e=e)
    assert (N.shape, r.shape) == ((4,), (2,))


def test_its_kernels_say_what_they_take(made):
    force = load_library(made).kernels.mine8p_green_linear_elastic_force
    with pytest.raises(TypeError, match=re.escape("mine8p_green_linear_elastic_force takes (l, e, A)")):
        force(0.7, np.zeros(8))
    with pytest.raises(ValueError, match=re.escape("argument e must have shape (4, 2), got (7,)")):
        force(0.7, np.zeros(7), [1, 1])


def test_an_unchanged_spec_makes_nothing_anew(made, capsys):
    before = {p.name: p.stat().st_mtime_ns for p in made.iterdir()}
    command.main(made.parents[1] / "mine.py", made)
    assert "up to date" in capsys.readouterr().out
    assert {p.name: p.stat().st_mtime_ns for p in made.iterdir()} == before


def test_a_changed_spec_replaces_the_library_also_in_a_process_that_has_it_open(made, tmp_path):
    out = tmp_path / "library"
    shutil.copytree(made, out)
    (old,) = [*load_library(out).elements["mine8p"].laws]
    (tmp_path / "kept.c").write_text("of an older library, says its manifest, which is wrong")
    _change(out, lambda content: content["files"].update({"../kept.c": "0"}))
    command.main(spec(tmp_path, ("green_linear", "engineering_linear")), out)
    assert (tmp_path / "kept.c").exists()
    (new,) = [*load_library(out).elements["mine8p"].laws]
    assert (old, new) == ("green_linear", "engineering_linear")
    stretched = [[0, 0], [2, 0], [2, 0], [2, 0]]
    assert load_library(out).kernels.mine8p_engineering_linear_energy(1.0, stretched, [2.0, 0.0]) == pytest.approx(1.0)
    assert {p.suffix: p.name for p in out.iterdir() if p.suffix == ".c" and "linear" in p.name} == {
        ".c": "mine8p_engineering_linear.c"}
    assert len(list(out.glob("*.so"))) == 1


# --- what a spec can lack ------------------------------------------------------------------------------------


@pytest.mark.parametrize(("changes", "told"), [
    ([("1, x, x**2, x**3", "1, x, x**2, sp.sin(x)"), ("from funicular", "import sympy as sp\nfrom funicular")],
     "basis[3] = sin(x) is not a polynomial"),
    ([("x**3)", "x**3 + x**2)")], "basis[3] = x**3 + x**2 is not a monomial"),
    ([("x**3)", "z*x)")], "basis[3] = x*z has z, but dim is 2"),
    ([("x**3)", "sp.Symbol('r_1')*x)"), ("from funicular", "import sympy as sp\nfrom funicular")],
     "r is not linear in the nodal vectors: basis[3] = r_1*x depends on r_1"),
    ([("(1, x,", "(x, ")], "no rigid motion: the basis has no constant"),
    ([("1, x, x**2, x**3", "1, x**2, x**3, x**4")], "no constant strain: the basis has no x"),
    ([("x**3)", "x**2)")], "basis[3] = x**2 stands twice"),
    ([("x**3)", "x**4)")], "the basis has x**4 without x**3"),
    ([("x**3)", "x**3, x**4)")],
     "the nodal conditions are singular (4 conditions, 5 functions): undetermined: x**2 - 2*x**3/l + x**4/l**2"),
    ([('"r_x")', '"r_x", "r_xx")')],
     "the nodal conditions are singular (6 conditions, 4 functions): dependent conditions: l**2*r_xx1/6 + 2*l*r_x1/3 "
     "+ l*r_x2/3 + r_1 - r_2 = 0 for every function of the basis"),
    ([("1, x, x**2, x**3", "1, x, x**2, y"), ('("green_linear",)', '("continuum",)')],
     "the nodal conditions are singular: dependent conditions: l*r_x1/2 + l*r_x2/2 + r_1 - r_2 = 0 for every "
     "function of the basis; undetermined: y, zero in every nodal condition"),
    ([('"r_x")', '"theta")')], "nodal vector 'theta' is not known in 2 dimensions"),
    ([('"r_x")', '"r_z")')], "nodal vector 'r_z' is not known in 2 dimensions"),
    ([('("r", "r_x")', '("r_x", "r")')], "the first nodal vector must be the position r"),
    ([('director=""', 'director="r_y"')], 'the director "r_y" is no nodal vector'),
    ([('("green_linear",)', '("green_linear")')], "laws must be a tuple of names or classes, got 'green_linear'"),
    ([('("green_linear",)', '("green_lineal",)')], 'law "green_lineal" is not known; did you mean "green_linear"?'),
    ([('("green_linear",)', '("continuum",)')], "law continuum needs the section's deformation, but the basis has no "),
    ([("x**3)", "x**3, y, x*y)"), ('"r_x")', '"r_x", "r_y")')], "law green_linear knows the centreline alone"),
    ([('"mine8p"', '"cable12"')], 'funicular has a family "cable12" of its own'),
    ([('"mine8p"', '"8mine"')], "the name must be letters, digits and _"),
    ([("dim=2", "dim=4")], "dim must be 2 or 3, got 4"),
], ids=lambda v: v[:40] if isinstance(v, str) else "")
def test_an_element_that_cannot_be_is_told_its_property(tmp_path, changes, told):
    message = refused(spec(tmp_path, *changes), tmp_path / "library")
    assert message.startswith(f"{tmp_path / 'mine.py'}: element \"")
    assert told in message


def test_a_nodal_condition_that_is_not_linear(tmp_path):
    law = """
from funicular.derive.spec import Element as Base


class Stretch(Base):
    def nodal_conditions(self, functions):
        rows = super().nodal_conditions(functions)
        rows[1, :] = rows[1, :].applyfunc(lambda slope: slope**2)  # |r'|^2, a scalar
        return rows
"""
    message = refused(spec(tmp_path, ("MINE = Element(", "MINE = Stretch("), law=law), tmp_path / "library")
    assert "r is not linear in the nodal vectors: the nodal condition r_x1 is not linear in r" in message


STRAIN = """
    def _axial_strain(self, program, name, a1):
        return program.define(name, {strain})
"""
ENERGY = """
    def energy(self, program, A, c, w):
        return super().energy(program, A, c, w) + {more}
"""


@pytest.mark.parametrize(("law", "told"), [
    # the strain of a beginner: r_x of the first node along the global x, and not its length
    (STRAIN.format(strain="program.symbols['e'][1, 0] - 1"),
     "the energy is not objective: a rigid rotation changes it from "),
    (ENERGY.format(more="A[0] * w * program.symbols['e'][2, 0]**2"),
     "the energy is not objective: a rigid translation changes it from "),
    (STRAIN.format(strain="sp.Abs(a1)"), "the energy has a kink: kernel mine8p_own_energy has Abs in Abs(a1_0)"),
    (STRAIN.format(strain="a1 + sp.sqrt(a1**2)"),
     "the energy has a kink in its slope: along r_1[x] its second derivative "),
    (ENERGY.format(more="A[1] * w * sp.sqrt(c[-1].dot(c[-1]))"), "the energy has a kink: along r_1[x] its slope is -"),
    (ENERGY.format(more="A[1] * w / c[-1].dot(c[-1])"),
     "the energy is not a finite number: kernel mine8p_own_energy, at the straight reference"),
    (STRAIN.format(strain="sp.sin(a1)"), "kernel mine8p_own_energy is not plain arithmetic: sin(a1_0)"),
    (STRAIN.format(strain="a1 + sp.Rational(1, 10)"), "the undeformed element is not at rest: it stores "),
    ("    def forces(self, program, A, c, w):\n        return 2 * super().forces(program, A, c, w)\n",
     "checks of verification fail, the first: mine8p_own_elastic_force: f["),
    ("    def damping_forces(self, program, *given):\n        raise RuntimeError('not written yet')\n",
     "line 14: RuntimeError: not written yet"),
], ids=["rotation", "translation", "abs", "slack", "root", "pole", "sine", "rest", "stress", "raises"])
def test_a_law_that_cannot_be_is_told_its_property(tmp_path, law, told, capsys):
    message = refused(spec(tmp_path, law=law), tmp_path / "library")
    assert message.startswith(f"{tmp_path / 'mine.py'}")
    assert told in message, message


def test_a_law_without_a_name(tmp_path):
    file = spec(tmp_path, law="    pass\n")
    text = file.read_text()
    file.write_text(text.replace('name, stiffness_of = "own", "green_linear"', 'stiffness_of = "green_linear"'))
    assert "law Own has no class attribute name" in refused(file, tmp_path / "library")


def test_two_elements_of_one_name(tmp_path):
    file = spec(tmp_path)
    file.write_text(file.read_text() + "from dataclasses import replace\nTWIN = replace(MINE, doc='another')\n")
    assert "defines two elements of the name mine8p" in refused(file, tmp_path / "library")


@pytest.mark.parametrize(("text", "told"), [
    ("x = 1\ny = (2\n", ":2: is not Python: '(' was never closed"),
    ("x = 1\n\ny = 1 / 0\n", ", line 3: ZeroDivisionError: division by zero"),
    ("from funicular.derive.spec import Elephant\n", ", line 1: ImportError: cannot import name 'Elephant'"),
    ("x = 1\n", ": defines no element; write NAME = Element(...)"),
    ("from funicular.derive.spec import Element\nE = Element(name='e')\n", ", line 2: TypeError: "),
])
def test_a_file_that_is_no_spec_is_told_with_its_line(tmp_path, text, told):
    file = tmp_path / "mine.py"
    file.write_text(text)
    assert refused(file, tmp_path / "library").startswith(f"{file}{told}")


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(SpecError, match="cannot be read: No such file or directory"):
        command.main(tmp_path / "mine.py", tmp_path / "library")


def test_without_a_compiler(tmp_path, monkeypatch):
    monkeypatch.setattr("shutil.which", lambda name: None)
    assert "no C compiler found" in refused(spec(tmp_path), tmp_path / "library")


def test_where_nothing_can_be_written(tmp_path, monkeypatch):
    file = spec(tmp_path)
    with pytest.raises(SpecError, match=re.escape(f"cannot be written: {file} is not a directory")):
        command.main(file, file / "library")
    monkeypatch.setattr(os, "access", lambda path, mode: False)  # root may write anywhere
    with pytest.raises(SpecError, match=re.escape(f"cannot be written: {tmp_path} is not writable")):
        command.main(file, tmp_path / "library")


def test_a_directory_of_something_else_is_left_alone(tmp_path):
    (tmp_path / "work").mkdir()
    (tmp_path / "work" / "thesis.txt").write_text("chapter 1")
    with pytest.raises(SpecError, match="is not empty and holds no library"):
        command.main(spec(tmp_path), tmp_path / "work")
    assert [p.name for p in (tmp_path / "work").iterdir()] == ["thesis.txt"]


@pytest.mark.parametrize("words", [["--spec", "a.py"], ["--out", "d"], ["cable12", "--spec", "a.py", "--out", "d"],
                                   ["--check", "--spec", "a.py", "--out", "d"]])
def test_the_options_go_together(words):
    told = CliRunner().invoke(app, ["derive", *words])
    assert told.exit_code == 2
    assert "go together" in told.output


# --- libraries in scenes ----------------------------------------------------------------------------------------


@pytest.fixture
def copied(made, tmp_path) -> Path:
    """A copy of the library, to damage."""
    return Path(shutil.copytree(made, tmp_path / "library"))


def _change(folder: Path, change) -> None:
    content = json.loads((folder / "manifest.json").read_text())
    change(content)
    (folder / "manifest.json").write_text(json.dumps(content))


def test_a_library_of_another_version_is_refused_with_what_mends_it(copied, made):
    _change(copied, lambda content: content.update(interface="0123456789abcdef"))
    with pytest.raises(LibraryError) as told:
        load_library(copied)
    assert "was made for another version of funicular: its tables of kernels are laid out as 0123456789abcdef" in str(
        told.value)
    assert f"`funicular derive --spec {made.parents[1] / 'mine.py'} --out {copied}`" in str(told.value)


def test_a_damaged_library_is_refused(copied):
    (shared,) = copied.glob("*.so")
    shared.write_bytes(shared.read_bytes()[:-1])
    with pytest.raises(LibraryError, match=r"is damaged: kernels-.*so is not the file that was made; make it"):
        load_library(copied)
    shared.unlink()
    with pytest.raises(LibraryError, match=r"cannot be loaded here: .*No such file"):
        load_library(copied)


@pytest.mark.parametrize("text", ["{broken", "{}", "[]"])
def test_a_directory_without_a_library(tmp_path, text):
    with pytest.raises(LibraryError, match=re.escape("is none: manifest.json cannot be read")):
        load_library(tmp_path)
    (tmp_path / "manifest.json").write_text(text)
    with pytest.raises(LibraryError, match=re.escape("is none: its manifest.json is not that of a library")):
        load_library(tmp_path)


def cable(scene: funicular.Scene, **given):
    return scene.cable("wire", start=(0, 0, 0), end=(1.5, 0, 0), elements=3, section=SQUARE, material=TABLE_1, **given)


def test_a_scene_says_what_is_wrong_with_its_library(tmp_path, made):
    scene = funicular.Scene()
    with pytest.raises(SceneError, match=r'cable "wire": library "[^"]*" is none: .*make one with'):
        cable(scene, element="mine8p", library=tmp_path)
    with pytest.raises(SceneError, match=re.escape('cable "wire": library must be a directory, got 3')):
        cable(scene, element="mine8p", library=3)
    with pytest.raises(SceneError, match=re.escape(f'element "mine" is not known in library "{made}"')):
        cable(scene, element="mine", library=made)


# --- a file alone loads nothing ----------------------------------------------------------------------------------

HOSTILE = """
#include <stdio.h>
__attribute__((constructor)) static void runs(void) { fclose(fopen("%s", "w")); }
const char fu_all[64];
"""


@pytest.fixture
def hostile(tmp_path) -> tuple[Path, Path]:
    """A library without kernels, whole as far as its manifest tells, and the file that appears when it is loaded."""
    folder, marker = tmp_path / "hostile", tmp_path / "it-ran"
    folder.mkdir()
    (tmp_path / "hostile.c").write_text(HOSTILE % marker)
    subprocess.run(["cc", "-shared", "-fPIC", "-o", folder / "kernels.so", tmp_path / "hostile.c"], check=True)
    described(folder, folder / "kernels.so")
    return folder, marker


def described(folder: Path, shared: Path, name: str = "") -> None:
    """A manifest of one element, its digests right."""
    here = manifest()
    content = {"interface": here["interface"], "elements": {"cable12": here["elements"]["cable12"]}, "kernels": {},
               "tools": {}, "families": {}, "files": {},
               "library": {"spec": "x.py", "file": name or shared.name,
                           "sha256": hashlib.sha256(shared.read_bytes()).hexdigest()}}
    content["library"]["digest"] = manifest_digest(content)
    (folder / "manifest.json").write_text(json.dumps(content))


def naming(library) -> str:
    scene = funicular.Scene()
    cable(scene, element="cable12")
    scene.pin("wire", s=0.0)
    scene.run_settings = {"duration": 0.01, "tol": 1e-3}
    return scene.to_toml().replace('element = "cable12"', f'element = "cable12"\nlibrary = "{library}"')


def not_allowed(library: Path) -> str:
    return re.escape(f'cable "wire": takes its element from the library "{library}", which is machine code, and a file '
                     f"alone may not load that; if you trust this directory, allow it: in Python with "
                     f'libraries=["{library}"], on the command line with --library {library}')


def test_a_scene_file_does_not_load_a_library(hostile, tmp_path):
    folder, marker = hostile
    (tmp_path / "link").symlink_to(folder)
    (tmp_path / "mine").mkdir()
    file = tmp_path / "scene.toml"
    for named in (folder, "hostile", "./mine/../hostile", "link", "mine/../link/."):
        file.write_text(naming(named))
        for allowed in ((), (tmp_path,), (tmp_path / "mine", "hostile")):  # from another working directory
            with pytest.raises(SceneError, match=not_allowed(folder)):
                load_scene(file, libraries=allowed)
        told = CliRunner().invoke(app, ["run", str(file), "-o", str(tmp_path / "x.nc"), "--library", str(tmp_path)])
        assert told.exit_code == 1 and re.search(not_allowed(folder), told.stderr)
        assert CliRunner().invoke(app, ["bench", str(file)]).exit_code == 1
    with pytest.raises(SceneError, match=re.escape("cable \"wire\": library must be a directory, got '")):
        loads(naming("a\\u0000b"), "x")
    assert not marker.exists()
    load_scene(file, libraries=[folder])  # it has no kernels, but now it is loaded
    assert marker.exists()


def test_all_libraries_of_a_file_are_looked_at_first(hostile, tmp_path):
    folder, marker = hostile
    second = naming(tmp_path / "other").split("[[cable]]")[1].split("[[")[0].replace('"wire"', '"second"')
    with pytest.raises(SceneError, match=r'cable "second": takes its element from the library "[^"]*/other", which'):
        loads(naming(folder) + "\n[[cable]]" + second, "x", libraries=[folder])
    assert not marker.exists()


def test_a_file_of_results_does_not_load_a_library(hostile, tmp_path):
    folder, marker = hostile
    run = loads(naming("x").replace('library = "x"\n', ""), "x").run()
    run.scene_toml = naming(folder)
    run.save(tmp_path / "x.nc")
    read = load_run(tmp_path / "x.nc")
    assert len(read.time) == 101 and read["wire.nodal_vectors"].shape[0] == 101
    for use in (lambda: read.scene, lambda: read.section_forces("wire"), lambda: save_plots(read, tmp_path / "new")):
        with pytest.raises(SceneError, match="the scene of the run: " + not_allowed(folder)):
            use()
    assert not marker.exists()


def test_a_manifest_leads_to_no_file_elsewhere(hostile, tmp_path):
    folder, marker = hostile
    shared = (folder / "kernels.so").rename(tmp_path / "kernels.so")
    for name in ("../kernels.so", str(shared)):
        described(folder, shared, name)
        with pytest.raises(LibraryError, match=r"cannot be loaded here: .*No such file"):
            load_library(folder)
    (folder / "kernels.so").symlink_to(shared)
    described(folder, shared)
    with pytest.raises(LibraryError, match=r"is damaged: kernels\.so is not the file that was made"):
        load_library(folder)
    assert not marker.exists()


def test_an_allowed_library_is_used(made, tmp_path):
    """By its directory or a link to it; a run that was made with it reads its scene back."""
    scene = funicular.Scene()
    cable(scene, element="mine8p", library=made)
    scene.pin("wire", s=0.0)
    run = scene.run(duration=0.01, tol=1e-3, save=tmp_path / "x.nc")
    assert run.scene.cables["wire"].library == str(made)
    (tmp_path / "link").symlink_to(made)
    (tmp_path / "scene.toml").write_text(run.scene_toml.replace(str(made), "link"))
    for allowed in (made, tmp_path / "link"):
        assert load_scene(tmp_path / "scene.toml", libraries=[allowed]).cables["wire"].library == str(made)
        assert load_run(tmp_path / "x.nc", libraries=[allowed]).section_forces("wire").sizes["time"] == 101
    told = CliRunner().invoke(app, ["run", str(tmp_path / "scene.toml"), "--duration", "0.01", "--plot", "--forces",
                                    "-o", str(tmp_path / "y.nc"), "--library", "nowhere", "--library", str(made)])
    assert told.exit_code == 0, told.output


def test_a_damaged_manifest_is_refused(copied):
    """At any place: cut short, or a byte of it changed, which digests find where the words do not."""
    whole, random = (copied / "manifest.json").read_bytes(), np.random.default_rng(3)
    for at in random.integers(len(whole), size=100):
        for damaged in (whole[:at], whole[:at] + bytes([whole[at] ^ 1 << random.integers(8)]) + whole[at + 1:]):
            (copied / "manifest.json").write_bytes(damaged)
            try:
                assert json.loads(damaged) == json.loads(whole) and load_library(copied)  # a blank may become another
            except ValueError:
                pass
            except AssertionError:
                with pytest.raises(LibraryError):
                    load_library(copied)
    for lack in (lambda m: m.pop("kernels"), lambda m: m["library"].pop("file"), lambda m: m["library"].update(file=3),
                 lambda m: m["elements"]["mine8p"].update(dim="2"), lambda m: m.update(elements=[])):
        (copied / "manifest.json").write_bytes(whole)
        _change(copied, lack)
        with pytest.raises(LibraryError, match=r"is none: its manifest\.json is not that of a library"):
            load_library(copied)
    (copied / "manifest.json").write_text("[" * 100_000)
    with pytest.raises(LibraryError, match=r"is none: its manifest\.json is not that of a library"):
        load_library(copied)


def test_a_library_without_a_kernel_that_it_names(copied):
    def rename(content):
        content["kernels"]["mine8p_absent"] = content["kernels"].pop("mine8p_mass")
        content["library"]["digest"] = manifest_digest(content)

    _change(copied, rename)
    with pytest.raises(LibraryError, match=r"is damaged: kernels-.*\.so lacks what its manifest\.json names: .*absent"):
        load_library(copied)


def test_gauge_of_nodal_vectors():
    assert list(gauge(("r", "r_x", "r_xx", "r_y", "r_z", "r_xy"), 0.8, 0.3, 0.2)) == pytest.approx(
        [1, 0.1, 0.01, 0.3, 0.2, 0.03])


def test_elements_are_those_that_are_generated():
    assert {"beam24", "cable12", "cable18", "beam12p", "cable8p"} <= set(built_in())
    assert built_in()["cable18"].nodal_vectors == ("r", "r_x", "r_xx")
    assert [kind.is_cable for kind in map(built_in().get, ("beam24", "cable12", "beam12p", "cable8p"))] == [
        False, True, False, True]


# --- derive/README.md -------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_the_example_of_the_readme_is_cable18(tmp_path, monkeypatch):
    """Its spec, its command, its scene in Python and as a file; the run is that of cable18."""
    here = page("derive/README.md")
    text, in_python = here.of("Your own element", "python")
    assert [getattr(load_spec(tmp_path, text), name) for name in ("basis", "nodal_vectors", "director", "dim")] == [
        CABLE18.basis, CABLE18.nodal_vectors, CABLE18.director, CABLE18.dim]
    (command_line,) = (words for section, words in here.commands() if section == "Your own element")
    made = subprocess.run([sys.executable, "-m", "funicular.cli", *command_line[1:]], cwd=tmp_path,
                          capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    space = {}
    monkeypatch.chdir(tmp_path)
    exec(in_python, space)
    in_toml = space["scene"].to_toml()
    assert f'library = "{tmp_path / "quintic"}"\n' in in_toml
    (tmp_path / "scene.toml").write_text(in_toml.replace(f'"{tmp_path / "quintic"}"', '"quintic"'))
    monkeypatch.chdir("/")
    from_file = load_scene(tmp_path / "scene.toml", libraries=[tmp_path / "quintic"])
    from_file = from_file.run(duration=0.3, output_step=0.01)
    in_toml = in_toml.replace(f'library = "{tmp_path / "quintic"}"\n', "").replace('"quintic"', '"cable18"')
    reference = loads(in_toml, "README.md").run(duration=0.3, output_step=0.01)
    assert len(reference.time) == 31
    for run in (space["run"], from_file):
        np.testing.assert_allclose(*(r.section_forces("wire", s=0.7)["tension"] for r in (run, reference)), atol=1e-6)
        for name in ("A.position", "wire.nodal_vectors"):  # compilers may round differently, but no more than that
            np.testing.assert_allclose(run[name], reference[name], rtol=0, atol=1e-9, err_msg=name)


def load_spec(folder: Path, text: str):
    (folder / "quintic.py").write_text(text)
    (element,) = load.elements(folder / "quintic.py")
    return element
