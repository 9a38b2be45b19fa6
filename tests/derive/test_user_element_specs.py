"""An invalid spec of a user's element is refused by the property that it lacks, and nothing is written."""

import os
import re
from pathlib import Path

import pytest
from funicular.cli.main import app
from funicular.derive.user_elements import command
from funicular.derive.user_elements.load import SpecError
from typer.testing import CliRunner
from user_element_specs import spec


def refused(file: Path, out: Path) -> str:
    """Return the message that refuses a spec; nothing may be written."""
    with pytest.raises(SpecError) as error:
        command.main(file, out)
    assert not out.exists()
    assert [p.name for p in out.parent.iterdir()] == [file.name], "nothing is left behind"
    return str(error.value)


@pytest.mark.parametrize(("changes", "part"), [
    ([("1, x, x**2, x**3", "1, x, x**2, sp.sin(x)"), ("from funicular", "import sympy as sp\nfrom funicular")],
     "basis[3] = sin(x) is not a polynomial"),
    ([("x**3)", "x**3 + x**2)")], "basis[3] = x**3 + x**2 is not a monomial"),
    ([("x**3)", "z*x)")], "basis[3] = x*z has z, but dim is 2"),
    ([("x**3)", "sp.Symbol('r_1')*x)"), ("from funicular", "import sympy as sp\nfrom funicular")],
     "r is not linear in the nodal vectors: basis[3] = r_1*x depends on r_1"),
    ([("(1, x,", "(x, ")], "no rigid motion: the basis has no constant"),
    ([("1, x, x**2, x**3", "1, x**2, x**3, x**4")], "no constant strain: the basis has no x"),
    ([("x**3)", "x**2)")], "basis[3] = x**2 stands twice"),
    ([("1, x, x**2, x**3", "1, x"), ('"r", "r_x"', '"r",')],
     "law green_linear resists bending, but no function of the basis is curved along x"),
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
def test_an_element_that_cannot_be_is_refused_with_its_property(tmp_path, changes, part):
    message = refused(spec(tmp_path, *changes), tmp_path / "library")
    assert message.startswith(f"{tmp_path / 'mine.py'}: element \"")
    assert part in message


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


@pytest.mark.parametrize(("law", "part"), [
    # a beginner's strain: the component of r_x along the global x instead of its length
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
@pytest.mark.slow_cases("stress")
def test_a_law_that_cannot_be_is_refused_with_its_property(tmp_path, law, part, capsys):
    message = refused(spec(tmp_path, law=law), tmp_path / "library")
    assert message.startswith(f"{tmp_path / 'mine.py'}")
    assert part in message, message


def test_a_law_without_a_name(tmp_path):
    file = spec(tmp_path, law="    pass\n")
    text = file.read_text()
    file.write_text(text.replace('name, stiffness_of = "own", "green_linear"', 'stiffness_of = "green_linear"'))
    assert "law Own has no class attribute name" in refused(file, tmp_path / "library")


def test_two_elements_of_one_name(tmp_path):
    file = spec(tmp_path)
    file.write_text(file.read_text() + "from dataclasses import replace\nTWIN = replace(MINE, doc='another')\n")
    assert "defines two elements of the name mine8p" in refused(file, tmp_path / "library")


@pytest.mark.parametrize(("text", "part"), [
    ("x = 1\ny = (2\n", ":2: is not Python: '(' was never closed"),
    ("x = 1\n\ny = 1 / 0\n", ", line 3: ZeroDivisionError: division by zero"),
    ("from funicular.derive.spec import Elephant\n", ", line 1: ImportError: cannot import name 'Elephant'"),
    ("x = 1\n", ": defines no element; write NAME = Element(...)"),
    ("from funicular.derive.spec import Element\nE = Element(name='e')\n", ", line 2: TypeError: "),
])
def test_a_file_that_is_no_spec_is_refused_with_its_line(tmp_path, text, part):
    file = tmp_path / "mine.py"
    file.write_text(text)
    assert refused(file, tmp_path / "library").startswith(f"{file}{part}")


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
    result = CliRunner().invoke(app, ["derive", *words])
    assert result.exit_code == 2
    assert "go together" in result.output
