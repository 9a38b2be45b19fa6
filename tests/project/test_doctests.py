"""The examples in docstrings run and print their stated output."""

import doctest
from importlib import import_module
from pathlib import Path

import funicular
import pytest

ROOT = Path(funicular.__file__).parent
MODULES = [".".join(("funicular", *path.relative_to(ROOT).with_suffix("").parts))
           for path in sorted(ROOT.rglob("*.py"))
           if ">>> " in path.read_text(encoding="utf-8") and "guides" not in path.parts]


def test_there_are_some():
    assert {"funicular.scene.described", "funicular.results.run", "funicular.parts.signal"} <= set(MODULES)


@pytest.mark.parametrize("name", MODULES)
def test_examples(name):
    found = doctest.testmod(import_module(name))
    assert found.attempted and not found.failed
