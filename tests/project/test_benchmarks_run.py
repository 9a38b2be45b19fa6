"""Every script of tests/benchmarks runs with --smallest, its first case, within seconds."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest
import records
from printed import scripts
from speed_page import SPEED
from validation_page import STUDIES

FOLDER = Path(__file__).parents[1] / "benchmarks"
MAIN = {path.stem for path in FOLDER.glob("*.py") if '\nif __name__ == "__main__"' in path.read_text("utf-8")}
SCRIPTS = sorted(MAIN - {"print_pages"})
PEERS = {"exudyn_side_by_side": "exudyn", "exudyn_whole_calls": "exudyn", "many_scenes": "exudyn",
         "cosserat": "cosseratbench", "page": "playwright",
         "sweep": "distributed", "mooring_lines": "moordyn"}
"""What some of them need besides."""
TABLES = [table for section in [*SPEED, *STUDIES] for table in section.tables]
SELECTED: set[str] = set()
"""Scripts whose smallest run makes none of the tables that the pages show."""


def test_every_script_takes_its_command_line_from_table():
    assert SCRIPTS == sorted(scripts())


@pytest.mark.slow
@pytest.mark.parametrize("script", SCRIPTS)
def test_a_script_runs_at_its_smallest(script, tmp_path, monkeypatch):
    if (peer := PEERS.get(script)) and importlib.util.find_spec(peer) is None:
        pytest.skip(f"{peer} is not installed")
    record = tmp_path / f"{script}.json"
    done = subprocess.run([sys.executable, FOLDER / f"{script}.py", "--smallest", "--json", record], cwd=tmp_path,
                          capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    assert done.stdout.strip()
    monkeypatch.setattr(records, "FOLDER", tmp_path)
    recorded = records.load(record)
    printed = [each for each in TABLES if each.script == script and each.table in recorded]
    assert printed or script not in {each.script for each in TABLES} - SELECTED
    for each in printed:
        each.markdown()  # its keys are those of the script
