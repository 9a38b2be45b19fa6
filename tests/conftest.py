"""Fixtures of more than one test file; scenes are in shared_scenes.py, expectations in expectations.py."""

import sys
from types import ModuleType

import pytest
from fake_recording import fake_recording
from funicular.results import recording
from interrupted_runs import SETTINGS, WRITES, content, kill, short
from slow_cases import pytest_collection_modifyitems, pytest_itemcollected
from validation import pytest_addoption, validated

__all__ = ["pytest_addoption", "pytest_collection_modifyitems", "pytest_itemcollected", "validated"]


def pytest_terminal_summary(terminalreporter, config):
    """Print which tests the default run leaves out."""
    if "not browser" in config.option.markexpr:
        terminalreporter.write_line("Browser tests were left out. To run them: pip install -e '.[test,browser]', "
                                    "install Chromium and npm, and python -m pytest -m browser")


@pytest.fixture
def engine(monkeypatch, tmp_path):
    """Replace solve.motion.run by a mock with recordings made by hand, in an empty directory."""
    module = ModuleType("funicular.solve.motion.run")
    module.outcome = {}
    module.calls = []

    def simulate(scene, settings, on_progress, **_):
        module.calls.append(settings)
        on_progress(settings.duration / 2)
        yield 0  # the end of a stage
        return fake_recording(scene, **module.outcome)

    module.simulate = simulate
    monkeypatch.setitem(sys.modules, "funicular.solve.motion.run", module)
    monkeypatch.setattr(recording, "recorded", lambda recorded, *_: recorded)
    monkeypatch.chdir(tmp_path)
    return module


@pytest.fixture
def quick_pictures(monkeypatch):
    """Draw pictures coarsely and without a layout of their parts, and films of a few pictures."""
    from funicular.view import plot, video

    monkeypatch.setitem(plot.STYLE, "savefig.dpi", 40)
    monkeypatch.setitem(plot.STYLE, "figure.constrained_layout.use", False)
    monkeypatch.setattr(video, "DEFAULT_DURATION", 0.4)


@pytest.fixture(scope="module")
def uninterrupted(tmp_path_factory):
    """Return the content of the file of an uninterrupted run."""
    path = tmp_path_factory.mktemp("whole") / "x.nc"
    short().run(**SETTINGS, save=path)
    return content(path)


@pytest.fixture
def stopped(tmp_path):
    """Return the file of a run that was killed half-way."""
    path = tmp_path / "x.nc"
    kill(short(), path, WRITES // 2, **SETTINGS)
    return path
