"""`funicular verify` accepts the checked-in code and names a kernel that was changed."""

from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from funicular.derive.catalogue import families
from funicular.derive.codegen import rendering as emit
from funicular.derive.codegen.program import Argument
from funicular.derive.laws.cable.cable import Cable
from funicular.derive.verify import command as verify
from funicular.derive.verify.compiled import CompilerError, compiler
from funicular.derive.verify.methods import CEILINGS, METHODS, Finding, Relation, examine
from funicular.derive.verify.report import Report
from written_out import copy_written_out


@pytest.fixture
def generated(tmp_path) -> Path:
    """Return a copy of the generated C, for changes."""
    copy_written_out(tmp_path)
    return tmp_path


def broken(folder: Path, file: str, old: str, new: str) -> None:
    text = (folder / file).read_text()
    assert text.count(old) == 1, f"{old!r} stands {text.count(old)} times in {file}"
    (folder / file).write_text(text.replace(old, new))


def body(folder: Path, file: str, kernel: str) -> str:
    """Return the text of one kernel."""
    text = (folder / file).read_text()
    start = text.index(f"void {kernel}(")
    return text[start : text.index("\n}\n", start)]


def break_output(folder: Path, file: str, kernel: str, entry: str) -> None:
    """Change the sign of one output."""
    old = body(folder, file, kernel)
    (line,) = [row for row in old.splitlines() if row.strip().startswith(f"{entry} = ")]
    value = line.partition(" = ")[2].rstrip(";")
    new = old.replace(line, f"    {entry} = -({value});")
    (folder / file).write_text((folder / file).read_text().replace(old, new))


def test_what_is_checked_in_passes(capsys):
    """`funicular verify` in CI goes over all families."""
    names = ["cable8p", "planar_rigid", "planar_surface"]
    assert verify.main(names) == 0
    out = capsys.readouterr().out
    assert all(name in out for name in [*names, *METHODS])
    assert "FAIL" not in out


def test_a_piped_table_shortens_no_name(capsys):
    relation = Relation("k" * 100, "output", "t" * 200, 1, None)
    report = Report()
    finding = Finding("k" * 100, relation, shape=(1,))
    for method in METHODS:
        finding.take(method, np.ones(1), np.ones(1), 1.0)
    report.add("family", finding)
    assert report.show() == 0
    out = capsys.readouterr().out
    assert all(name in out for name in ["k" * 100, "t" * 200, *METHODS])


@pytest.mark.parametrize(("family", "outputs"), [
    ("rigid", ["point: bias[1]", "point: p_q[4]", "inertia_force: f[5]", "kinetic_energy: T[0]"]),
    ("planar_rigid", ["wrench: K[8]"]),
    ("slide_cable8p_planar_rigid", ["terms: W[0]"]),
    ("beam12p", ["follower_force: K[2]"]),
    ("cable12", ["moment: f[4]"]),
])
@pytest.mark.slow_cases("slide_cable8p_planar_rigid-outputs2", "planar_rigid-outputs1")
def test_a_sign_changed_in_an_output_is_found_and_named(generated, capsys, family, outputs):
    changed = [(f"{family}_{kernel}", entry) for kernel, entry in (text.split(": ") for text in outputs)]
    for kernel, entry in changed:
        break_output(generated, f"{family}.c", kernel, entry)
    assert verify.main([family], generated) == 1
    out = capsys.readouterr().out
    assert "analytic" in out and "difference" in out
    programs = {p.name: p for p in families()[family].build()}
    for kernel, entry in changed:
        name, _, index = entry.partition("[")
        place = np.unravel_index(int(index.rstrip("]")), programs[kernel].values[name].shape)
        assert f"{kernel}: {name} is not" in out
        assert f"{name}[{', '.join(map(str, place))}]" in out


def change_sign(folder: Path, family: str, kernel: str, definition: str) -> None:
    """Turn the first sum of a definition into a difference."""
    text = (folder / f"{family}.c").read_text()
    old = body(folder, f"{family}.c", f"{family}_{kernel}")
    head, found, tail = old.partition(f"{definition} = ")
    assert found and " + " in tail.partition(";")[0]
    (folder / f"{family}.c").write_text(text.replace(old, head + found + tail.replace(" + ", " - ", 1)))


def test_signs_changed_inside_an_element_are_found(generated, capsys):
    break_output(generated, "beam24.c", "beam24_mass", "m[5]")
    assert verify.main(["beam24"], generated) == 1
    out = capsys.readouterr().out
    assert "m[0, 5]" in out
    assert "beam24: mass symmetric" in out
    assert "beam24_gravity: Q is not" not in out


@pytest.mark.parametrize(("family", "definition", "constant"), [
    ("beam12p_continuum", "K_t0_t1[i][j]", 7), ("cable8p_engineering_exact", "K_t0_t0[i][j]", 1)])
@pytest.mark.slow_cases("beam12p_continuum-K_t0_t1[i][j]-7")
def test_signs_changed_inside_a_law_are_found(generated, capsys, family, definition, constant):
    change_sign(generated, family, "elastic_tangent", definition)
    break_output(generated, f"{family}.c", f"{family}_stiffness", f"A[{constant}]")
    assert verify.main([family], generated) == 1
    out = capsys.readouterr().out
    assert f"{family}_elastic_tangent: K is not df/de" in out
    assert f"A[{constant}]" in out
    assert f"{family}_elastic_force: f is not" not in out, "a fault shows in its own kernel and nowhere else"
    assert f"{family}_energy: U is not" not in out


@pytest.mark.slow
def test_an_energy_that_is_wrong_in_spec_and_text_alike_is_found(generated, capsys, monkeypatch):
    """The derivatives then agree with one another; the integral of the shape functions differs."""
    right, name = Cable.points, "cable8p_green_exact"
    monkeypatch.setattr(Cable, "points", lambda self, n: [replace(p, weight=p.weight * (1 + 1e-12))
                                                          for p in right(self, n)])
    texts = emit.render([emit.derive(families()[name])], [name], lambda done: None)
    (generated / f"{name}.c").write_text(texts[f"{name}.c"])
    assert verify.main([name], generated) == 1
    out = capsys.readouterr().out
    assert f"{name}_energy: U is not the law's integral" in out
    assert f"{name}_dissipation: P is not the law's integral" in out
    assert f"{name}_elastic_force: f is not" not in out
    assert "tangent: K is not" not in out


@pytest.mark.slow
def test_signs_changed_inside_the_slide_are_found(generated, capsys):
    file, kernel = "slide_cable12_rigid.c", "slide_cable12_rigid_terms"
    for entry in ("W[1]", "s_bias[0]", "H[7]"):
        break_output(generated, file, kernel, entry)
    assert verify.main(["slide_cable12_rigid"], generated) == 1
    out = capsys.readouterr().out
    for output in ("W", "s_bias", "H"):
        assert f"{kernel}: {output} is not" in out
    assert f"{kernel}: Q_d is not" not in out
    assert "H null on motions that keep the joint" in out


def test_an_output_left_unwritten_is_found(generated, capsys):
    line = next(row for row in body(generated, "rigid.c", "rigid_point").splitlines() if " bias[2] = " in row)
    broken(generated, "rigid.c", line + "\n", "")
    assert verify.main(["rigid"], generated) == 1
    assert "rigid_point: bias is not" in capsys.readouterr().out


def test_what_does_not_compile_is_reported_with_the_compilers_words(generated, capsys):
    broken(generated, "rigid.c", "        dt_p_x =", "        dt_p_x +=")
    assert verify.main(["rigid"], generated) == 1
    err = capsys.readouterr().err
    assert "generated/rigid.c does not compile" in err
    assert "funicular derive --check" in err


def test_no_compiler_is_reported(monkeypatch, capsys):
    monkeypatch.setattr("shutil.which", lambda name: None)
    with pytest.raises(CompilerError):
        compiler()
    assert verify.main(["rigid"]) == 1
    assert "no C compiler found" in capsys.readouterr().err


def test_an_unknown_name_gets_the_near_ones(capsys):
    assert verify.main(["rigd"]) == 1
    assert 'no spec "rigd"; did you mean rigid' in capsys.readouterr().err


def test_an_output_without_a_relation_is_missed():
    """`funicular verify` requires a relation for every output."""
    for name in ("rigid", "cable12", "cable8p_green_linear"):
        family = families()[name]
        programs = family.build()
        assert verify.uncovered(family, programs) == []
        programs[0].outputs.append(Argument("news", (3,), "m", "not verified yet"))
        assert verify.uncovered(family, programs) == [f"{programs[0].name}: news"]


def test_each_method_finds_a_derivative_that_is_slightly_wrong(generated, tmp_path):
    """Each method rejects a path whose derivative is wrong by three ceilings, and accepts the correct one."""
    import mpmath

    family = families()["rigid"]
    with mpmath.workdps(50):
        kinds = verify.prepare(family, generated, tmp_path).kinds()
        state = {"mass": np.float64(2.0), "w": np.arange(1.0, 7.0), "J": np.diag([1.0, 2.0, 3.0])}

        def energy(k, s, t, j, off=0.0):
            w = s["w"].copy()
            w[0] = w[0] + t * (1 + off)
            return k("kinetic_energy", s, w=w)["T"]

        momentum = {"kernel": "kinetic_energy", "output": "T", "text": "m v", "order": 1,
                    "of": lambda k, s: s["mass"] * s["w"][0]}
        assert examine("T", Relation(path=energy, **momentum), kinds, [state]).failed == []
        for method in ("50 digits", "complex step", "central"):
            wrong = partial(energy, off=3 * CEILINGS[method, 1])
            assert method in examine("T", Relation(path=wrong, **momentum), kinds, [state]).failed
