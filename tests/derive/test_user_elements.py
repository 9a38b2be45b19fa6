"""A spec file outside the package becomes a library of elements, which scenes load."""

import hashlib
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import funicular
import numpy as np
import pytest
from funicular import load_run
from funicular.cli.main import app
from funicular.derive.catalogue import families
from funicular.derive.elements.cable18 import CABLE18
from funicular.derive.user_elements import command, load
from funicular.derive.verify.report import Report
from funicular.errors import SceneError
from funicular.generated import kernels
from funicular.kernels.elements import built_in, gauge, manifest
from funicular.kernels.libraries import LibraryError, manifest_digest
from funicular.kernels.libraries import load as load_library
from funicular.results.run import SceneText
from funicular.scene.file import load_scene, loads
from pages import page
from parameter_searches import apart, by_scenes, found_of, search_of
from shared_scenes import SQUARE, TABLE_1
from typer.testing import CliRunner
from user_element_specs import spec


@pytest.fixture(scope="module")
def derived(tmp_path_factory) -> tuple[Path, str]:
    """Return a library of the planar cable, and the output of the command."""
    folder = tmp_path_factory.mktemp("own")
    result = CliRunner().invoke(app, ["derive", "--spec", str(spec(folder)), "--out", str(folder / "new" / "library")])
    assert result.exit_code == 0, result.output
    return folder / "new" / "library", result.output


@pytest.fixture(scope="module")
def made(derived) -> Path:
    return derived[0]


def test_the_command_derives_verifies_compiles_and_times(derived):
    made, text = derived
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
    assert force.shapes == {"l": (), "e": (4, 2), "A": (2,), "f": (4, 2)}
    with pytest.raises(TypeError, match=re.escape("mine8p_green_linear_elastic_force takes (l, e, A)")):
        force(0.7, np.zeros(8))
    with pytest.raises(ValueError, match=re.escape("argument e must have shape (4, 2), got (7,)")):
        force(0.7, np.zeros(7), [1, 1])


def test_an_unchanged_spec_makes_nothing_anew(made, capsys):
    before = {p.name: p.stat().st_mtime_ns for p in made.iterdir()}
    command.main(made.parents[1] / "mine.py", made)
    assert "up to date" in capsys.readouterr().out
    assert {p.name: p.stat().st_mtime_ns for p in made.iterdir()} == before


def test_a_changed_spec_replaces_the_library_also_in_a_process_that_has_it_open(made, tmp_path, monkeypatch):
    """The fixture verifies a library; the changed one is not verified again."""
    monkeypatch.setattr(command, "examined", lambda *_: Report())
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
    with pytest.raises(LibraryError) as error:
        load_library(copied)
    assert "was made for another version of funicular: its tables of kernels are laid out as 0123456789abcdef" in str(
        error.value)
    assert f"`funicular derive --spec {made.parents[1] / 'mine.py'} --out {copied}`" in str(error.value)


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


@pytest.mark.slow
def test_its_cables_are_adjusted_by_the_derivatives_of_differences_of_scenes(made, monkeypatch):
    scene = funicular.Scene(gravity=(0.3, -9.81, 0))
    rope = scene.cable("wire", start=(0, 0, 0), end=(4, 0.3, 0), elements=8, rest_length=4.1, element="mine8p",
                       library=made, section=funicular.Circle(radius=0.01),
                       material=funicular.Material(youngs_modulus=1e7, shear_modulus=4e6, density=1500.0))
    for s in (0, rope.length):
        scene.clamp("wire", s=s)
    scene.distributed_force("wire", start=0.5, stop=2.0, value=(0, -2.0, 0), name="snow")
    scene.spring((1, 1, 0), ("wire", 1.3), name="up", stiffness=100.0, length=0.5)
    paths = ["wire.rest_length", "wire.section.radius", "wire.material.youngs_modulus", "wire.material.density",
             "gravity.y", "snow.value.y", "snow.start", "snow.stop", "up.b.1", "up.a.y"]
    search, at = search_of(scene, paths, ["wire@1.9.position.y", "wire@0.force.x"])
    assert found_of(search, at) == paths
    for found, wanted in zip(search.linear(at), by_scenes(search, at, monkeypatch), strict=True):
        assert dict(zip(paths, apart(found, wanted) < 1e-6, strict=True)) == dict.fromkeys(paths, True)


# --- a file alone loads nothing ----------------------------------------------------------------------------------

HOSTILE = """
#include <stdio.h>
__attribute__((constructor)) static void runs(void) { fclose(fopen("%s", "w")); }
const char fu_all[64];
"""


@pytest.fixture
def hostile(tmp_path) -> tuple[Path, Path]:
    """Return a library without kernels but with a valid manifest, and the file that loading it would write."""
    folder, marker = tmp_path / "hostile", tmp_path / "it-ran"
    folder.mkdir()
    (tmp_path / "hostile.c").write_text(HOSTILE % marker)
    subprocess.run(["cc", "-shared", "-fPIC", "-o", folder / "kernels.so", tmp_path / "hostile.c"], check=True)
    described(folder, folder / "kernels.so")
    return folder, marker


def described(folder: Path, shared: Path, name: str = "") -> None:
    """Return a manifest of one element with correct digests."""
    here = manifest()
    content = {"interface": here["interface"], "elements": {"cable12": here["elements"]["cable12"]},
               "arguments": {}, "kernels": {},
               "tools": {}, "families": {}, "sources": {}, "files": {},
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
                     f"alone may not load it; if you trust this directory, allow it: in Python with "
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
        result = CliRunner().invoke(app, ["run", str(file), "-o", str(tmp_path / "x.nc"), "--library", str(tmp_path)])
        assert result.exit_code == 1 and re.search(not_allowed(folder), result.stderr)
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
    run._scene_text = SceneText(naming(folder), run._scene_text.read, run.libraries)
    run.save(tmp_path / "x.nc")
    read = load_run(tmp_path / "x.nc")
    assert len(read.time) == 101 and read["wire.nodal_vectors"].shape[0] == 101
    for use in (lambda: read.scene, lambda: read.section_forces("wire"), lambda: read.save_plots(tmp_path / "new")):
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
    """A library is allowed by its directory or a link to it. Its runs read their scenes back."""
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
    result = CliRunner().invoke(app, ["run", str(tmp_path / "scene.toml"), "--duration", "0.01", "--plot", "--forces",
                                    "-o", str(tmp_path / "y.nc"), "--library", "nowhere", "--library", str(made)])
    assert result.exit_code == 0, result.output


def test_a_damaged_manifest_is_refused(copied):
    """A manifest is damaged at any place: cut short, or one byte changed, which the digests detect."""
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
        content["kernels"]["mine8p"]["absent"] = content["kernels"]["mine8p"].pop("mass")
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
    """Spec, command and scene of the text, from Python and from a file; the run equals that of cable18."""
    here = page("derive/README.md")
    text, in_python = here.of("Your own element", "python")
    assert [getattr(load_spec(tmp_path, text), name) for name in ("basis", "nodal_vectors", "director", "dim")] == [
        CABLE18.basis, CABLE18.nodal_vectors, CABLE18.director, CABLE18.dim]
    (command_line,) = (words for section, words in here.commands() if section == "Your own element")
    made = subprocess.run([sys.executable, "-m", "funicular.cli.main", *command_line[1:]], cwd=tmp_path,
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
