"""Every script of tests/benchmarks still runs, with --smallest: the first of its cases, seconds each."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parent / "benchmarks"
SCRIPTS = sorted(path.stem for path in FOLDER.glob("*.py") if '__name__ == "__main__"' in path.read_text("utf-8"))
PEERS = {"exudyn_side_by_side": "exudyn", "many_scenes": "exudyn", "cosserat": "cosseratbench", "page": "playwright",
         "sweep": "distributed"}
"""What some of them need besides."""


def test_every_script_takes_its_command_line_from_table():
    for script in SCRIPTS:
        assert "from table import" in (FOLDER / f"{script}.py").read_text("utf-8"), script


@pytest.mark.slow
@pytest.mark.parametrize("script", SCRIPTS)
def test_a_script_runs_at_its_smallest(script, tmp_path):
    if (peer := PEERS.get(script)) and importlib.util.find_spec(peer) is None:
        pytest.skip(f"{peer} is not installed")
    done = subprocess.run([sys.executable, FOLDER / f"{script}.py", "--smallest"], cwd=tmp_path, capture_output=True,
                          text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    assert done.stdout.strip()
