"""The contracts on imports in pyproject.toml hold, and a violation of each is found."""

import ast

import pytest
from import_contracts import TOP, broken_contracts, installed_tree

VIOLATIONS = {
    "a part that imports a check": ("parts/spring.py", "from ..checks import placement", "Layers of the package"),
    "a check that imports the model": ("checks/frames.py", "from ..model import build", "Layers of the package"),
    "the model that imports a solver": ("model/build.py", "from ..solve import modes", "Layers of the package"),
    "a solver that imports results": ("solve/modes/modes.py", "from ..results import run", "Layers of the package"),
    "results that import the scene": ("results/run.py", "from ..scene import Scene", "Layers of the package"),
    "for type checkers": ("parts/spring.py", "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n"
                                "    from ..scene import Scene", "Layers of the package"),
    "within a function": ("parts/spring.py", "def later():\n    from ..scene import Scene", "Layers of the package"),
    "a circle": ("parts/material.py", "from . import cable", "No circles"),
    "a solver that derives": ("solve/modes/modes.py", "from funicular.derive import catalogue",
                               "Simulation does without"),
    "derivation that takes a part": ("derive/spec.py", "from funicular.parts import cable", "Derivation takes"),
    "generated code that derives": ("generated/__init__.py", "from funicular.derive import catalogue", "Generated"),
}


def test_contracts_are_kept(tmp_path):
    installed_tree(tmp_path)
    assert broken_contracts(tmp_path) == ""


@pytest.mark.parametrize("name", VIOLATIONS)
def test_a_violation_is_found(tmp_path, name):
    file, line, contract = VIOLATIONS[name]
    installed_tree(tmp_path)
    with open(tmp_path / "funicular" / file, "a", encoding="utf-8") as changed:
        changed.write(f"\n{line}\n")
    complaint = broken_contracts(tmp_path)
    assert any(each.startswith(contract) and each.endswith("BROKEN") for each in complaint.splitlines()), complaint


def test_an_import_within_a_function_has_a_reason():
    """Only heavy modules are imported late, and a comment or the docstring of the module gives the reason."""
    unexplained = []
    for file in sorted((TOP / "runtime").rglob("*.py")):
        text = file.read_text(encoding="utf-8")
        lines, tree = text.splitlines(), ast.parse(text)
        if " imported " in (ast.get_docstring(tree) or ""):
            continue
        for function in ast.walk(tree):
            if not isinstance(function, ast.FunctionDef):
                continue
            late = [node.lineno for node in ast.walk(function) if isinstance(node, ast.Import | ast.ImportFrom)]
            if late and not any("#" in lines[k - 1] for k in range(min(late) - 1, max(late) + 1)):
                unexplained.append(f"{file.relative_to(TOP)}:{late[0]}")
    assert unexplained == []
