"""The pages Validation and Speed agree with their records, and each row of Validation has its test."""

import ast
import json
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import aims
import pytest
import records
import table
import validation
from print_pages import BEGIN, END, PAGES, SUBJECTS
from printed import FOLDER, cell, markdown, scripts
from speed_page import SPEED
from validation_page import STUDIES

ROOT = Path(__file__).parents[2]
SECTIONS = [*SPEED, *STUDIES]
TABLES = [of for section in SECTIONS for of in section.tables]
ROWS = validation.recorded()


@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_what_its_records_say(name):
    assert (FOLDER / name).read_text(encoding="utf-8") == PAGES[name](), "python tests/benchmarks/print_pages.py"


@cache
def functions(file: str) -> dict[str, ast.FunctionDef]:
    """Return the tests of a file by name; methods include the name of their class."""
    found = {}
    for node in ast.parse((ROOT / file).read_text(encoding="utf-8")).body:
        inside = node.body if isinstance(node, ast.ClassDef) else [node]
        before = f"{node.name}::" if isinstance(node, ast.ClassDef) else ""
        found |= {before + each.name: each for each in inside if isinstance(each, ast.FunctionDef)}
    return {name: each for name, each in found.items() if "validated" in [given.arg for given in each.args.args]}


def test_each_row_of_validation_names_a_test_and_each_test_has_a_row():
    named = {tuple(row["test"].partition("[")[0].split("::", 1)) for row in ROWS}
    there = {(file.relative_to(ROOT).as_posix(), name) for file in (ROOT / "tests").rglob("test_*.py")
             for name in functions(file.relative_to(ROOT).as_posix()) if name.rpartition("::")[2].startswith("test_")}
    assert named == there
    assert len(named) > 40


@pytest.mark.slow
def test_each_row_of_validation_is_a_test_that_pytest_collects():
    """The names include parameters, which a change may rename."""
    files = sorted({row["test"].partition("::")[0] for row in ROWS})
    command = [sys.executable, "-m", "pytest", "-o", "addopts=", "--collect-only", "-q", *files]
    found = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    assert {row["test"] for row in ROWS} <= set(found.splitlines())


def test_rows_of_validation_keep_their_bounds():
    for row in ROWS:
        assert row["subject"] in SUBJECTS
        assert row["source"] and row["quantity"]
        expected, _, part = row["bound"].partition(" ± ")
        if part:
            assert row["error"] == pytest.approx(float(expected), rel=0.01 * float(part.removesuffix(" %")) + 5e-3)
        else:
            assert row["error"] <= float(expected) * 1.05  # two digits are on record


def test_a_comparison_fails_beyond_its_bound_and_without_a_record(request, monkeypatch):
    check = request.getfixturevalue("validated")
    given = {"bound": 0.1, "source": "closed form"}
    with pytest.raises(AssertionError, match=r"1\.2, not 1 to 0\.1"):
        check("Statics", "a case", "large", 1.0, 1.2, **given)
    with pytest.raises(AssertionError, match=r"--record-validation tests/project/test_measured_pages\.py"):
        check("Statics", "a case", "unknown", 1.0, 1.0, **given)
    with pytest.raises(AssertionError, match="a name of its own"):
        check("Statics", "a case", "unknown", 1.0, 1.0, **given)
    known = [validation.row(request.node.nodeid, "Statics", "a case", name, 1.0, 1.0, **given) for name in "qrst"]
    monkeypatch.setattr(validation, "recorded", lambda: known)
    check("Statics", "a case", "q", 1.0, 1.05, **given)
    for name, reference, changed in (("r", 1.0, {"bound": 0.2}), ("s", 1.0, {"source": "another"}), ("t", 1.01, {})):
        with pytest.raises(AssertionError, match="record it"):
            check("Statics", "a case", name, reference, 1.05, **given | changed)


def test_of_arrays_the_largest_error_is_compared(request):
    made = validation.row("t", "Statics", "c", "q", [1.0, 2.0], [1.01, 2.1], bound=0.1, source="s")
    assert (made["reference"], made["ours"], made["error"]) == ("2", "2.1", 0.05)


def test_scripts_of_pages_exist_and_records_are_of_scripts():
    assert {of.script for of in TABLES} <= set(scripts())
    assert {file.stem for file in records.FOLDER.glob("*.json")} <= {*scripts(), "validation"}
    for section in SECTIONS:
        assert not section.test or (ROOT / section.test).is_file(), section.title


def test_aims_are_compared_with_the_other_records():
    recorded = records.load(records.FOLDER / "aims.json")["aims"]["rows"]
    assert recorded == [{key: records.plain(value) for key, value in aim.row().items()} for aim in aims.AIMS]


def test_readme_lists_every_script_and_is_short():
    text = (FOLDER / "README.md").read_text(encoding="utf-8")
    assert set(re.findall(r"^\| \[(\w+)\]\(\1\.py\) \| \S", text, re.MULTILINE)) == set(scripts())
    by_hand = text.partition(BEGIN)[0] + text.partition(END)[2]
    assert len(by_hand.split()) < 900


def test_front_page_has_the_figures_of_the_records():
    text = re.sub(r"\s+", " ", (ROOT / "README.md").read_text(encoding="utf-8"))
    rows = records.load(records.FOLDER / "choice.json")["measured"]["rows"]
    within, worst = sum(row["error/tol"] <= 1 for row in rows), max(row["error/tol"] for row in rows)
    assert f"{within} of {len(rows)} errors are within `tol`, the largest is {worst:.2g} `tol`" in text
    first = {row["setting"]: row for row in records.load(records.FOLDER / "first_scene.json")["measured"]["rows"]}
    row = first["tol 0.0001"]
    assert f"error of the motion {cell(row['motion'])}, in {row['cpu_s']:.2g} s of CPU time" in text
    faster = [row["times faster"] for row in records.load(records.FOLDER / "exudyn_side_by_side.json")["times"]["rows"]]
    many = f"{sum(ratio >= 5 for ratio in faster)} of {len(faster)} cells"
    said = f"at least 5 times less CPU time of the solver, without set-up, in {many}, {min(faster):.2g} times in the"
    assert f"{said} least favourable one" in text
    whole = [row["times faster, call"] for row in
             records.load(records.FOLDER / "exudyn_whole_calls.json")["measured"]["rows"]]
    assert f"set-up included, take {min(whole):.2g} to {max(whole):.3g} times less" in text
    seconds: dict[tuple, dict[str, float]] = {}
    for row in records.load(records.FOLDER / "cosserat.json")["peers"]["rows"]:
        if row["cpu_s"]:
            seconds.setdefault((row["experiment"], row["elements"]), {})[row["solver"]] = row["cpu_s"]
    ratios = [each / of["funicular"] for of in seconds.values() for name, each in of.items() if "funicular" not in name]
    assert f"{min(ratios):.2g} to {max(ratios):.3g} times less CPU time" in text


def test_pages_tell_of_today():
    for name in PAGES:
        assert not re.search(r"\b(before|was tried|no longer)\b", (FOLDER / name).read_text(encoding="utf-8").replace(
            "tension before the force", "").replace("moment before the force", "")), name


def test_show_records_tables_and_adds_to_those_of_its_own_run(tmp_path, monkeypatch, capsys):
    file = tmp_path / "script.json"
    records.save(file, {"one": {"measured": "2020-01-01", "conditions": "", "rows": [{"a": 0}]},
                        "other": {"measured": "2020-01-01", "conditions": "", "rows": [{"b": 0}]}})
    monkeypatch.setattr(sys, "argv", ["script.py", "--json", str(file), "--smallest"])
    table.arguments("A script.")
    table.show([{"a": 1.23456, "b": float("nan"), "c": "x|y"}], table="one")
    table.show([{"a": 2}], table="one")
    found = json.loads(file.read_text(encoding="utf-8"))
    assert found["one"]["rows"] == [{"a": 1.235, "b": None, "c": "x|y"}, {"a": 2}]
    assert found["other"]["rows"] == [{"b": 0}]
    assert found["one"]["measured"] != "2020-01-01" and "cores" in found["one"]["conditions"]
    monkeypatch.setattr(table.Parser, "json", None)
    monkeypatch.setattr(sys, "argv", ["script.py", "--json", "--smallest"])
    with pytest.raises(SystemExit):
        table.arguments("A script.")
    assert "--smallest measures nothing" in capsys.readouterr().err


def test_cells():
    found = [cell(value) for value in (None, True, 12, 12345, 0.0, 1e-3, 1.26e-12, 0.0123, 12.345, 2.5e6, "a|b")]
    assert found == ["", "yes", "12", "12,345", "0", "1e-3", "1.3e-12", "0.0123", "12.3", "2.5e6", "a\\|b"]
    assert markdown(["a", "b", "c"], [["x", "1", ""], ["x", "2", "3"]]) == [
        "| a | b | c |", "|---|---|---|", "| x | 1 | |", "| | 2 | 3 |"]
