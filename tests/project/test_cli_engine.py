"""The command line with the compiled engine, started as by a user."""

import os
import signal
import subprocess
import sys
import sysconfig
import time
from functools import partial

import numpy as np
import pytest
from funicular import EndOfCableError, load_run, load_scene

COMMAND = [sys.executable, "-m", "funicular"]
SCRIPT = [os.path.join(sysconfig.get_path("scripts"), "funicular")]

# background jobs of a shell ignore Ctrl-C, as would their children; the tested commands must not
listen = partial(signal.signal, signal.SIGINT, signal.default_int_handler)


def funicular(*args: str, cwd) -> subprocess.CompletedProcess:
    return subprocess.run([*COMMAND, *args], cwd=cwd, capture_output=True, text=True)


def test_first_scene(tmp_path):
    done = funicular("run", "paper51", "--plot", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    run = load_run(tmp_path / "paper51.nc")
    np.testing.assert_allclose(run.time, np.linspace(0, 1, 501), atol=1e-12)
    np.testing.assert_allclose(run["A.position"][-1], [1.321065114, -0.00445160328, 0], atol=1e-4)
    assert len(list(tmp_path.glob("paper51-*.png"))) == 4


@pytest.mark.parametrize("from_file", [True, False])
def test_algorithmic_dissipation_is_asked_for(tmp_path, from_file):
    scene = load_scene("paper51")
    settings = {"duration": 0.02, "tol": 1e-3}
    asked = {"integrator": "energy", "spectral_radius": 0.5}
    scene.run_settings = settings | (asked if from_file else {})
    (tmp_path / "scene.toml").write_text(scene.to_toml())
    options = () if from_file else ("--integrator", "energy", "--spectral-radius", "0.5")
    done = funicular("run", "scene.toml", *options, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    run = load_run(tmp_path / "scene.nc")
    assert {name: run.report[name] for name in asked} == asked
    assert run["energy.dissipated"][-1] > 0


def near_the_end():
    """Return a scene whose body starts 0.1 m before the end and arrives after about 0.1 s."""
    scene = load_scene("paper51")
    text = scene.to_toml().replace("position = [0.25,", "position = [1.4,").replace("\ns = 0.25\n", "\ns = 1.4\n")
    return text.replace("tol = 1e-05", "tol = 1e-3")


def test_end_of_cable(tmp_path):
    (tmp_path / "end.toml").write_text(near_the_end())
    done = funicular("run", "end.toml", cwd=tmp_path)
    assert done.returncode == 1
    message = done.stderr.strip()
    assert message.startswith("error: ") and "\n" not in message
    assert '"trolley"' in message and '"wire"' in message and "end" in message
    run = load_run(tmp_path / "end.nc")
    assert run.status == "end_of_cable"
    assert 0.05 < run.time[-1] < 0.15
    assert np.all(run["trolley.s"] <= 1.5 + 1e-9)
    assert np.all(np.isfinite(run["A.position"]))
    assert np.max(run["trolley.residual"]) < 1e-9


def test_end_of_cable_in_python(tmp_path):
    (tmp_path / "end.toml").write_text(near_the_end())
    with pytest.raises(EndOfCableError) as stopped:
        load_scene(tmp_path / "end.toml").run()
    assert stopped.value.run["trolley.s"][-1] == pytest.approx(1.5, abs=1e-9)


def test_ctrl_c_keeps_what_was_computed(tmp_path):
    long = [*COMMAND, "run", "paper51", "--step", "1e-7", "-o", "x.nc"]
    process = subprocess.Popen(long, cwd=tmp_path, stderr=subprocess.PIPE, text=True, preexec_fn=listen)
    end = time.monotonic() + 60
    while not any(tmp_path.iterdir()) and time.monotonic() < end:  # until the first rows are written
        time.sleep(0.1)
    time.sleep(1)  # the whole run takes minutes
    process.send_signal(signal.SIGINT)
    _, message = process.communicate(timeout=30)
    assert process.returncode == 130
    assert message.startswith("note: ") and "Traceback" not in message
    run = load_run(tmp_path / "x.nc")
    assert run.status == "interrupted"
    assert 0 < len(run.time) < 501


AT_IMPORT = """
import signal, sys
class Finder:
    def find_spec(self, name, *_):
        if name == {!r}:
            signal.raise_signal(signal.SIGINT)
sys.meta_path.insert(0, Finder())
"""


@pytest.mark.parametrize(("module", "command"), [
    ("numpy", COMMAND), ("numpy", SCRIPT), ("typer", COMMAND), ("typer", SCRIPT), ("funicular.results.files", SCRIPT),
    ("scipy", COMMAND)])
def test_ctrl_c_while_the_command_starts(module, command, tmp_path):
    """SIGINT comes at an import of the package, of the command line, of the command, or of its work."""
    (tmp_path / "sitecustomize.py").write_text(AT_IMPORT.format(module))
    done = subprocess.run([*command, "run", "paper51"], cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(tmp_path)},
                          capture_output=True, text=True, preexec_fn=listen)
    assert (done.returncode, done.stderr, done.stdout) == (130, "interrupted\n", "")
    assert not list(tmp_path.glob("paper51*"))


def test_imported_elsewhere_the_package_leaves_ctrl_c_alone():
    code = "import signal, funicular; print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, preexec_fn=listen)
    assert done.stdout == "True\n"


def test_progress_reaches_the_caller():
    seen = []
    load_scene("paper51").run(step=5e-5, progress=seen.append)
    assert seen == sorted(seen) and len(seen) > 1
    assert 0 <= seen[0] and seen[-1] <= 1
