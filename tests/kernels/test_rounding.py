"""`funicular verify` measures rounding against 50 digits, and finds a kernel that loses digits unnecessarily."""

import math
import re
from pathlib import Path

import mpmath
import numpy as np
import pytest
import sympy as sp
from funicular.derive.catalogue import families
from funicular.derive.codegen.program import Program
from funicular.derive.verify import command as verify
from funicular.derive.verify.inputs import KINDS, Input, inputs
from funicular.derive.verify.numbers import Numbers, exact, real
from funicular.derive.verify.rounding import ENTRY, NORM, measure
from funicular.derive.verify.samples import states
from funicular.generated import kernels
from written_out import copy_written_out


@pytest.fixture
def generated(tmp_path) -> Path:
    """Return a copy of the generated C, for changes."""
    copy_written_out(tmp_path)
    return tmp_path


def compiled(name: str) -> Numbers:
    """Return the kernels of a family as installed."""
    programs = families()[name].build()

    def call(kernel, given):
        outputs = next(p.outputs for p in programs if p.name == kernel)
        results = getattr(kernels, kernel)(*given)
        return dict(zip((a.name for a in outputs), results if len(outputs) > 1 else [results], strict=True))

    return real(name, programs, call)


def given(name: str) -> dict[str, list[tuple[Input, dict]]]:
    """Return the inputs of a family by kind, with their samples."""
    found = {kind: [] for kind in KINDS}
    for each, sample in inputs(families()[name], states(families()[name], compiled(name))):
        found[each.kind].append((each, sample))
    return found


def row(out: str, kernel: str) -> str:
    """Return the row of a kernel in the table of rounding."""
    table = out.partition("Rounding against 50 digits")[2].partition("Invariances")[0]
    return next(line for line in table.splitlines() if f" {kernel} " in line)


def test_the_table_has_every_kernel_and_kind(capsys):
    assert verify.main(["cable8p_green_exact"]) == 0
    out = capsys.readouterr().out
    assert all(kind in out for kind in KINDS)
    for program in families()["cable8p_green_exact"].build():
        figures = re.findall(r" (\d[\d.e+]*|-)(?= )", row(out, program.name))
        varies = any(a.name == "e" for a in program.inputs)
        assert len(figures) == len(KINDS) + 1
        assert ("-" in figures) == (not varies), "kinds that make no difference to a kernel have no figure"


def test_an_expanded_form_is_found_by_the_digits_it_loses_far_away(generated, capsys):
    """The chord of the energy as a difference of products loses one digit near the origin, and many far from it."""
    file = generated / "beam12p_continuum.c"
    head, energy, tail = file.read_text().partition("void beam12p_continuum_energy(")
    assert "w*(-e[0] + e[6])" in tail
    file.write_text(head + energy + tail.replace("w*(-e[0] + e[6])", "(w*e[6] - w*e[0])", 1))
    assert verify.main(["beam12p_continuum"], generated) == 1
    out = capsys.readouterr().out
    assert "FAIL" in row(out, "beam12p_continuum_energy")
    assert "beam12p_continuum_energy: U[0] loses digits on input of the kind far origin" in out
    assert "energy: U is not" not in out, "near the origin nothing shows"
    assert "FAIL" not in row(out, "beam12p_continuum_elastic_force")


@pytest.mark.slow
def test_products_that_are_zero_are_found_by_their_rounding(generated, capsys):
    """r_x is along i, so that j . r_x adds rounding alone to C_s: comparable with C_s where the joint is closed."""
    file = generated / "slide_cable12_rigid.c"
    text = file.read_text()
    line = next(row for row in text.splitlines() if row.startswith("    C_s[1] = d_"))
    file.write_text(text.replace(line, line[:-1] + " + (ds_r_x*j_x + ds_r_y*j_y + ds_r_z*j_z);"))
    assert verify.main(["slide_cable12_rigid"], generated) == 1
    out = capsys.readouterr().out
    assert "FAIL" in row(out, "slide_cable12_rigid_constraint")
    assert "slide_cable12_rigid_constraint: C_s[1] loses digits on input of the kind tiny strain" in out
    assert "C_s is not dC/ds" not in out


def test_a_row_that_fails_names_its_kernel(generated, capsys):
    file = generated / "rigid.c"
    text = file.read_text()
    line = next(row for row in text.splitlines() if row.startswith("    bias[1] = "))
    file.write_text(text.replace(line, line.replace("= ", "= -(")[:-1] + ");"))
    assert verify.main(["rigid"], generated) == 1
    failed = [line for line in capsys.readouterr().out.splitlines() if "FAIL" in line]
    assert failed
    assert all("rigid_point" in line for line in failed)


def test_the_unit_is_what_conditioning_allows():
    """(1 + x)² - 1 computed from the sum loses digits that x alone need not lose; x (2 + x) loses none."""
    x = sp.Symbol("x")

    def multiples(form, at):
        program = Program("test_form", "", "")
        program.input("x", (), "1", "")
        program.stage("sum")
        program.output("y", [form(program.define("a", 1 + x))], "1", "")
        function = sp.lambdify([x], form(1 + x), "math")

        def call(kernel, given):
            return {"y": np.array([function(*(v.item() for v in given))])}

        with mpmath.workdps(50):
            kinds = {"exact": exact("test", [program])}
            kinds["real"] = Numbers("test", [program], call, math, lambda v: v.astype(float))
            kinds["complex"] = Numbers("test", [program], call, math, lambda v: v.astype(complex))
            state = {"x": np.float64(at)}
            return measure(program, "form", kinds, Input("ordinary", state, state))

    for form, at, lost in ((lambda a: a * a - 1, 1e-9, True), (lambda a: a * a - 1, 0.3, False),
                           (lambda a: x * (2 + x), 1e-9, False)):
        found = multiples(form, at)
        assert found.failed == lost
        assert found.entry > 1e5 if lost else found.entry < 4
        assert found.place == "y[0]"


def test_what_is_not_a_number_fails():
    (program,) = (p for p in families()["rigid"].build() if p.name == "rigid_kinetic_energy")

    def broken(kernel, given):
        return {a.name: np.full(a.shape, np.nan) for a in program.outputs}

    (sample, _), *_ = given("rigid")["ordinary"]
    with mpmath.workdps(50), np.errstate(all="ignore"):
        kinds = {"exact": exact("rigid", [program])}
        kinds["real"] = Numbers("rigid", [program], broken, math, lambda v: v.astype(float))
        kinds["complex"] = Numbers("rigid", [program], broken, math, lambda v: v.astype(complex))
        found = measure(program, "kinetic_energy", kinds, sample)
    assert found.failed
    assert not found.entry <= ENTRY or not found.norm <= NORM


@pytest.mark.parametrize("name", ["beam24_continuum", "cable18_green_exact", "cable8p_engineering_linear"])
@pytest.mark.slow_cases("cable18_green_exact")
def test_the_kinds_of_input_are_what_they_say(name):
    element, found = families()[name].element, given(name)
    positions = np.array(element.is_position)
    for each, _ in found["tiny strain"]:
        e, l = each.state["e"], float(each.state["l"])
        assert 1e-11 < abs(np.linalg.norm(e[positions][1] - e[positions][0]) / l - 1) < 1e-7
    for each, _ in found["large rotation"]:
        tangents = each.state["e"][[k for k, v in enumerate(element.names) if v.startswith("r_x") and v[3:].isdigit()]]
        first, last = tangents[0], tangents[-1]
        assert first @ last < -0.4 * np.linalg.norm(first) * np.linalg.norm(last)
    for each, sample in found["far origin"]:
        for name in ("e", "e_next"):
            moved = each.state[name] - sample[name]
            lengths = np.linalg.norm(moved[positions], axis=1) / float(sample["l"])
            assert lengths == pytest.approx(1e4)
            assert np.all(moved[~positions] == 0)
        assert each.sizes is sample, "being far away is no excuse"
        assert each.changed(sample) == {"e", "e_next"}
