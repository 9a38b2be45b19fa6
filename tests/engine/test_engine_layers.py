"""Calls and includes of the engine's C files run down the layers, without circles."""

import re
from pathlib import Path

import pytest

ENGINE = Path(__file__).parents[2] / "runtime" / "engine"
LAYERS = ["base", "linear", "bodies", "couplings", "equations", "events", "integrators", "run", "host"]
"""From the lowest to the highest."""

DEFINITIONS = (r"^(?!static)(?:\w+ (?:\*|const )*)+\*?(fu_\w+)\([^;{]*\)\n\{",
               r"^const \w+ (?:\*const )?(fu_\w+)(?:\[\])? = ")


def code(path: Path) -> str:
    return re.sub(r"/\*.*?\*/", "", path.read_text(encoding="utf-8"), flags=re.DOTALL)


SOURCES = {path.relative_to(ENGINE).as_posix(): code(path) for path in sorted(ENGINE.rglob("*.c"))}
HEADERS = {path.relative_to(ENGINE).as_posix(): code(path) for path in sorted(ENGINE.rglob("*.h"))}


def level(file: str) -> int:
    return LAYERS.index(file.split("/")[0])


def home() -> dict[str, str]:
    """Return by name of a function or a table the file that defines it."""
    return {name: file for file, text in SOURCES.items() for pattern in DEFINITIONS
            for name in re.findall(pattern, text, re.MULTILINE)}


def uses() -> set[tuple[str, str, str]]:
    """Return (user, definer, name) of all uses of functions and tables across files."""
    of = home()
    return {(file, of[name], name) for file, text in SOURCES.items() for name in re.findall(r"\bfu_\w+", text)
            if of.get(name, file) != file}


def circles(graph: dict[str, set[str]]) -> list[list[str]]:
    """Return the sets of files that reach each other (strongly connected components, Tarjan 1972)."""
    index, low, stack, found = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for to in sorted(graph[node]):
            if to not in index:
                visit(to)
            if to in stack:
                low[node] = min(low[node], low[to])
        if low[node] == index[node]:
            at = stack.index(node)
            found.append(sorted(stack[at:]))
            del stack[at:]

    for node in graph:
        if node not in index:
            visit(node)
    return [circle for circle in found if len(circle) > 1]


def test_sources_are_found():
    assert len(SOURCES) > 100
    assert len(uses()) > 700


def test_calls_run_down_the_layers():
    assert [use for use in sorted(uses()) if level(use[0]) < level(use[1])] == []


def test_includes_run_down_the_layers():
    up = [(file, to) for file, text in {**SOURCES, **HEADERS}.items()
          for to in re.findall(r'#include "(\w+/.*?)"', text)
          if level(file) < level(to)]
    assert up == []


def test_no_files_call_each_other_in_a_circle():
    graph = {file: set() for file in SOURCES}
    for file, to, _ in uses():
        graph[file].add(to)
    assert circles(graph) == []


def test_circles_are_found():
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"a", "d"}, "d": set()}) == [["a", "b", "c"]]


@pytest.mark.parametrize("file", sorted(HEADERS))
def test_no_header_gathers_others(file):
    """Each file includes the headers that it uses; no header only includes others."""
    text = HEADERS[file]
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    assert lines, f"{file} declares nothing"


def test_cython_includes_the_public_headers():
    """A public header says so in its first line; all others are private to the engine."""
    public = {file for file in HEADERS if (ENGINE / file).read_text(encoding="utf-8").startswith("/* Public: ")}
    interface = (ENGINE / "cython" / "engine.pxi").read_text(encoding="utf-8")
    assert public == set(re.findall(r'#include "(.*?)"', interface))
    assert len(public) <= 16, "the interface of the engine has sixteen headers: put the declaration in one of them"


def test_a_kind_of_coupling_has_one_header():
    kinds = [file.split("/")[1] for file in HEADERS if file.startswith("couplings/") and "/common/" not in file]
    assert sorted(kinds) == sorted(path.name for path in (ENGINE / "couplings").iterdir()
                                   if path.is_dir() and path.name != "common")


def test_functions_are_declared_in_the_layer_that_defines_them():
    of = home()
    elsewhere = [(file, name, of[name]) for file, text in HEADERS.items()
                 for name in re.findall(r"^(?:\w+ (?:\*|const )*)+\*?(fu_\w+)\([^{;]*\);", text, re.MULTILINE)
                 if name in of and level(of[name]) != level(file)]
    assert elsewhere == []
