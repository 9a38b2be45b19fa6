"""Without `fcntl` and parts of `os`, as on Windows: the same files, and one run per file.

Mocks use `flock` in place of the locks of Windows and count the locked bytes. Windows itself is not tested.
"""

import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest
from funicular import load_run
from funicular.base import operating_system

WITHOUT = """
import ctypes, fcntl, os, sys, types
import numpy, pydantic, scipy.linalg  # others may use what goes now

def locking(descriptor, mode, size):
    assert (os.lseek(descriptor, 0, os.SEEK_CUR), mode, size) == (2**31 - 2, "LK_NBLCK", 1)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        raise PermissionError(13, "Permission denied") from error

sys.modules["msvcrt"] = types.SimpleNamespace(locking=locking, LK_NBLCK="LK_NBLCK")
real, sys.modules["fcntl"] = fcntl, None
for name in ("pread", "preadv", "pwrite", "sysconf", "sched_getaffinity", "O_NOFOLLOW", "O_CLOEXEC"):
    vars(os).pop(name, None)

class Kernel32:
    def GlobalMemoryStatusEx(self, status):
        assert status[0] == len(bytes(status)) == 64
        status[1] = 2**33
        return 1

ctypes.windll = types.SimpleNamespace(kernel32=Kernel32())
import funicular as fu
"""
RUN = """
scene = fu.load_scene("paper51")
run = scene.run(duration=0.05, output_step=0.01, integrator="genalpha", step=1e-3{settings})
{after}
"""


def python(code: str, folder: Path) -> str:
    done = subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def run(settings: str = ', save="x.nc"', after: str = "") -> str:
    return RUN.format(settings=settings, after=after)


@pytest.mark.slow
def test_results_are_the_same_bits(tmp_path):
    for name, before in (("with", "import funicular as fu"), ("without", WITHOUT)):
        (tmp_path / name).mkdir()
        python(before + run(after='run.save("saved.nc")'), tmp_path / name)
    for file in ("x.nc", "saved.nc"):
        there, here = (load_run(tmp_path / name / file) for name in ("without", "with"))
        assert there.status == "completed"
        assert all(np.array_equal(there[name], here[name]) for name in here.keys())


def test_files_are_read_and_runs_resumed(tmp_path):
    stop = """
def stop(time):
    if time > 0.02:
        raise KeyboardInterrupt
"""
    python(WITHOUT + stop + run(', save="x.nc", progress=stop', 'assert run.status == "interrupted", run.status'),
           tmp_path)
    again = 'assert run.status == "completed"; assert len(fu.load_run("x.nc").time) == 6'
    python(WITHOUT + run(', save="x.nc", resume=True', again), tmp_path)
    assert [file.name for file in tmp_path.iterdir()] == ["x.nc"]


def refusal(folder: Path, before: str = "") -> str:
    """Return the message of a run that is denied its file."""
    return python(f"{WITHOUT}\n{before}\ntry:{textwrap.indent(run(), '    ')}\n"
                  "except fu.ResultFileError as error: print(error)", folder)


def test_one_run_a_file(tmp_path):
    (tmp_path / "x.nc").touch()
    assert "another run is writing it" in refusal(tmp_path, 'taken = open("x.nc"); real.flock(taken, real.LOCK_EX)')


def test_links_are_refused(tmp_path):
    (tmp_path / "victim").write_text("untouched")
    (tmp_path / ".x.nc.part").symlink_to("victim")
    assert ".x.nc.part beside it is a link; delete the link" in refusal(tmp_path)
    assert (tmp_path / "victim").read_text() == "untouched"


def test_machine_memory():
    assert operating_system.machine_memory() == pytest.approx(memory_of_this_machine(), rel=0.01)


def memory_of_this_machine() -> int:
    """The value of the kernel is the reference."""
    lines = Path("/proc/meminfo")
    if not lines.exists():
        pytest.skip("this system has no /proc/meminfo to compare with")
    return 1024 * int(lines.read_text().split()[1])
