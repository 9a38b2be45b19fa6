"""`funicular derive --explain`: stages, operations by term, shared subexpressions and reasons of a kernel."""

import pytest
from funicular.cli.main import app
from funicular.derive import explain
from funicular.derive.catalogue import families
from funicular.derive.codegen.program import Program
from typer.testing import CliRunner


@pytest.fixture
def program() -> Program:
    """f = (s1 + s2)^3 b with s_i = a + i b: the operations can be counted by hand."""
    made = Program("trial", "trial", "")
    a, b = made.input("a", (), "m", ""), made.input("b", (), "m", "")
    made.stage("sums")
    both = [made.define(f"s{k}", a + k * b) for k in (2, 3)]
    total = made.define("total", sum(both))
    made.output("f", [total**3 * b], "m", "")
    return made


def test_terms_have_their_operations_uses_and_savings(program):
    found = {term.name: (term.definitions, term.operations, term.uses, term.saved) for term in explain.terms(program)}
    assert found == {"s#": (2, 4, 2, 0), "total": (1, 1, 3, 2), "f": (1, 3, 0, 0)}
    assert sum(operations for _, operations, *_ in found.values()) == sum(program.operations().values())


def test_without_intermediate_results_each_use_costs_the_whole_expression(program):
    assert explain.written_out(program) == 3 + 3 * (1 + 2 + 2)


def told(capsys, *names: str) -> str:
    assert explain.main([*names]) == 0
    return capsys.readouterr().out


def test_a_family_is_explained_by_the_sources_that_derived_it(capsys):
    text = told(capsys, "planar_frame")
    assert "derive/couplings/frame.py\n    The frame of two vectors" in text
    assert "derive/couplings/joint.py" not in text
    assert all(p.name in text for p in families()["planar_frame"].build())


def test_a_law_names_no_source_of_other_laws(capsys):
    text = told(capsys, "cable8p_green_linear_elastic_force")
    assert "derive/laws/cable/cable.py" in text
    assert not any(f"derive/laws/{other}" in text for other in ("continuum", "structural", "cable/assumed"))
    assert "CABLE8P_FORCES_ON_STRAIN_VECTORS" in text, "a stage that other kernels share"
    assert "cable8p_green_linear_elastic_tangent:" not in text, "a kernel's name explains that kernel alone"


def test_an_unknown_kernel_or_family_gets_the_near_ones(capsys):
    assert explain.main(["planar_frame_axis"]) == 1
    assert 'no kernel "planar_frame_axis"; did you mean planar_frame_axes' in capsys.readouterr().err
    assert explain.main(["beam42"]) == 1
    assert 'no spec "beam42"; did you mean beam24' in capsys.readouterr().err


@pytest.mark.parametrize(("options", "text"), [
    (["--explain"], "--explain needs a NAME"),
    (["--watch"], "--watch needs a NAME"),
    (["--explain", "--check", "frame"], "exclude each other"),
    (["--watch", "frame", "--spec", "a.py", "--out", "b"], "go together, and with nothing else"),
])
def test_options_that_do_not_go_together_are_refused(options, text):
    result = CliRunner().invoke(app, ["derive", *options])
    assert result.exit_code == 2
    assert text in " ".join(result.output.replace("│", " ").split())
