"""`funicular derive`: same bytes, drift found and named, operation counts that only move on purpose."""

import hashlib
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from funicular.derive import drift, emit, sources
from funicular.derive.families import families
from funicular.derive.verify_compile import compiler

# Arithmetic operations per call. A ceiling moves down when a kernel gets cheaper, up only on purpose.
CEILINGS = {
    "beam24_mass": 58,
    "beam24_gravity": 26,
    "beam24_inertia_force": 120,
    "beam24_stiffness": 310,
    "beam24_energy": 485,
    "beam24_elastic_force": 756,
    "beam24_elastic_tangent": 5124,
    "beam24_damping_force": 991,
    "beam24_damping_tangent": 8797,
    "beam24_dissipation": 692,
    "beam24_position": 94,
    "rigid_point": 207,
    "rigid_inertia_force": 45,
    "rigid_inertia_tangent": 48,
    "rigid_kinetic_energy": 31,
    "slide_beam24_rigid_constraint": 615,
    "slide_beam24_rigid_terms": 1673,
    "slide_beam24_rigid_residual": 213,
    "slide_beam24_rigid_tangent": 292,
}


@pytest.fixture(scope="module")
def derived() -> dict[str, str]:
    """Every generated file, from the specs."""
    return drift.generate()


@pytest.fixture
def copy(tmp_path, monkeypatch, derived) -> Path:
    """A generated folder of its own, up to date."""
    monkeypatch.setattr(drift, "folder", lambda: tmp_path)
    drift.write(derived)
    return tmp_path


@pytest.fixture
def remembered(monkeypatch, derived):
    """A whole check without a new derivation."""
    monkeypatch.setattr(drift, "generate", lambda names=None, show=False: dict(derived))


def test_checked_in_files_agree_with_the_specs_within_a_minute(capsys):
    start = time.perf_counter()
    code = drift.main([], check=True)
    assert code == 0, capsys.readouterr().out
    assert time.perf_counter() - start < 60


def test_two_hash_seeds_give_the_same_bytes(derived):
    script = ("import hashlib; from funicular.derive import drift; "
              "print({n: hashlib.sha256(t.encode()).hexdigest() for n, t in drift.generate().items()})")
    expected = str({n: hashlib.sha256(t.encode()).hexdigest() for n, t in derived.items()})
    for seed in ("1", "4242"):
        run = subprocess.run([sys.executable, "-c", script], env={**os.environ, "PYTHONHASHSEED": seed},
                             capture_output=True, text=True, check=True)
        assert run.stdout.strip() == expected


def _edited(folder: Path) -> None:
    file = folder / "rigid.c"
    file.write_text(file.read_text().replace("arm_x", "arm_X", 1))


def _missing(folder: Path) -> None:
    (folder / "registry.c").unlink()


def _extra(folder: Path) -> None:
    (folder / "old_element.c").write_text("/* left behind */\n")


def _stale(folder: Path) -> None:
    manifest = json.loads((folder / "manifest.json").read_text())
    old, new = manifest["families"]["rigid"]["spec_hash"], "0123456789abcdef"
    for name in ("manifest.json", "rigid.c"):
        (folder / name).write_text((folder / name).read_text().replace(old, new))


def _line_ends(folder: Path) -> None:
    (folder / "kernels.h").write_bytes((folder / "kernels.h").read_bytes().replace(b"\n", b"\r\n"))


def _no_manifest(folder: Path) -> None:
    (folder / "manifest.json").write_text("{broken")


@pytest.mark.parametrize(("damage", "told", "mended"), [
    (_edited, ("differs: generated/rigid.c", "-    const fu_real arm_X", "+    const fu_real arm_x"), True),
    (_missing, ("missing: generated/registry.c",), True),
    (_extra, ("extra: generated/old_element.c", "delete"), False),
    (_stale, ("stale (its spec has changed): generated/rigid.c", "- * spec hash 0123456789abcdef"), True),
    (_line_ends, ("differs: generated/kernels.h", "line ends"), True),
    (_no_manifest, ("differs: generated/manifest.json",), True),
], ids=lambda v: v.__name__.strip("_") if callable(v) else "")
def test_check_names_what_is_wrong_and_the_command_that_mends_it(copy, remembered, capsys, damage, told, mended):
    assert drift.main([], check=True) == 0
    damage(copy)
    before = {p.name: p.read_bytes() for p in copy.iterdir()}
    capsys.readouterr()
    assert drift.main([], check=True) == 1
    out, err = capsys.readouterr()
    assert all(text in out for text in told), out
    assert ("`funicular derive` mends it" in err) == mended
    assert {p.name: p.read_bytes() for p in copy.iterdir()} == before, "a check writes nothing"
    assert drift.main([]) == 0
    assert drift.main([], check=True) == (0 if mended else 1)


def test_a_name_derives_and_writes_that_family_alone(copy, monkeypatch):
    rigid, beam = copy / "rigid.c", copy / "beam24.c"
    good = rigid.read_text()
    rigid.write_text("damaged")
    beam.write_text("damaged too")
    seen = []
    derive = emit.derive
    monkeypatch.setattr(emit, "derive", lambda family: seen.append(family.name) or derive(family))
    assert drift.main(["rigid"]) == 0
    assert seen == ["rigid"]
    assert rigid.read_text() == good
    assert beam.read_text() == "damaged too"


def test_a_name_keeps_the_other_families_as_the_manifest_has_them(copy, derived):
    drift.main(["rigid"])
    manifest, whole = json.loads((copy / "manifest.json").read_text()), json.loads(derived["manifest.json"])
    assert manifest == whole
    del manifest["families"]["slide_beam24_rigid"]
    (copy / "manifest.json").write_text(json.dumps(manifest))
    drift.main(["rigid"])
    assert "slide_beam24_rigid" not in (copy / "kernels.h").read_text(), "a family not derived yet stays out"


def test_check_of_a_name_gives_the_command_with_the_name(copy, capsys):
    (copy / "rigid.c").write_text("damaged")
    assert drift.main(["rigid"], check=True) == 1
    assert "`funicular derive rigid` mends it" in capsys.readouterr().err


def test_an_unknown_name_gets_the_near_ones(capsys):
    assert drift.main(["beam42"]) == 1
    assert 'no spec "beam42"; did you mean beam24' in capsys.readouterr().err


def test_a_folder_that_cannot_be_written_is_told(copy, monkeypatch, capsys):
    (copy / "rigid.c").write_text("damaged")

    def refuse(*args, **kwargs):
        raise PermissionError(13, "Permission denied", "rigid.c")

    monkeypatch.setattr(Path, "write_text", refuse)
    assert drift.main(["rigid"]) == 1
    assert "rigid.c" in capsys.readouterr().err


def test_operation_counts_stay_below_their_ceilings(derived):
    kernels = json.loads(derived["manifest.json"])["kernels"]
    counts = {name: sum(k["operations"].values()) for name, k in kernels.items()}
    assert set(counts) == set(CEILINGS), "a new kernel needs its ceiling here"
    over = {name: f"{count} > {CEILINGS[name]}" for name, count in counts.items() if count > CEILINGS[name]}
    assert not over


def test_the_manifest_holds_the_hashes_of_the_files(derived):
    manifest = json.loads(derived["manifest.json"])
    assert manifest["files"] == {n: hashlib.sha256(t.encode()).hexdigest() for n, t in derived.items()
                                 if n != "manifest.json"}
    for name, family in manifest["families"].items():
        preamble = derived[f"{name}.c"].partition("*/")[0]
        assert f"funicular derive {name}" in preamble
        assert family["spec_hash"] in preamble
        for kernel, entry in manifest["kernels"].items():
            if entry["family"] == name:
                assert f" *   {kernel}: " in preamble


def test_the_spec_hash_covers_all_that_decides_a_family():
    beam = set(sources.deciding(families()["beam24"].modules))
    assert beam >= {"elements/beam24.py", "element_kernels.py", "gram.py", "gram_tangent.py", "moments.py", "spec.py",
                    "stages.py", "printer.py", "emit.py", "templates/family.c.jinja"}
    slide = set(sources.deciding(families()["slide_beam24_rigid"].modules))
    assert slide >= {"joints/slide.py", "elements/beam24.py", "bodies/rigid.py", "frames.py", "stages.py"}
    assert "joints/slide.py" not in beam
    assert not any(name.startswith("verify") for name in beam | slide)


@pytest.mark.parametrize("numbers", [[], ["-DFU_COMPLEX"]], ids=["real", "complex"])
def test_generated_c_has_no_warnings(copy, numbers):
    units = sorted(str(copy / f"{name}.c") for name in [*families(), "registry"])
    command = [*compiler(), "-std=c11", "-Wall", "-Wextra", "-Werror", "-pedantic", "-fsyntax-only", *numbers, *units]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
