"""The checked-in bundle of the page agrees with its source."""

import shutil
import subprocess
from pathlib import Path

import pytest
from funicular.view import page

pytestmark = pytest.mark.browser

SOURCE = Path(page.__file__).with_name("page_source")


def test_the_bundle_is_what_its_source_gives(tmp_path):
    npm = shutil.which("npm")
    if npm is None:
        pytest.skip("npm is not installed: the bundle of the page is not compared with its source")
    copy = shutil.copytree(SOURCE, tmp_path / "source", ignore=shutil.ignore_patterns("node_modules", "dist"))
    for command in (["ci", "--no-audit", "--no-fund"], ["run", "build"]):
        done = subprocess.run([npm, *command], cwd=copy, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
    for built in sorted((copy / "dist").iterdir()):
        assert built.read_bytes() == (SOURCE / "dist" / built.name).read_bytes(), (
            f"{built.name} is not what the source gives: npm ci && npm run build in runtime/view/page_source")
    assert {f.name for f in (SOURCE / "dist").iterdir()} == {f.name for f in (copy / "dist").iterdir()}


def test_no_machine_is_named_in_the_lock_file():
    text = (SOURCE / "package-lock.json").read_text(encoding="utf-8")
    assert "resolved" not in text
    assert "http" not in text.replace("https://opencollective.com", "")
