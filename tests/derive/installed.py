"""A copy of the package in which `funicular derive` runs, so that a test can damage or edit it."""

import shutil
from importlib.util import find_spec
from pathlib import Path

from import_contracts import TOP, installed_tree

TEMPLATES = "derive/codegen/templates"


def runnable_tree(directory: Path) -> Path:
    """Copy Python files, templates and the compiled engine to the places of an installed package; return the package.
    """
    installed_tree(directory)
    package = directory / "funicular"
    shutil.copytree(TOP / TEMPLATES, package / TEMPLATES, dirs_exist_ok=True)
    engine = Path(find_spec("funicular.engine").origin)
    (package / "engine.py").unlink()
    shutil.copy(engine, package / engine.name)
    return package
