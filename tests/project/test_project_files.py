"""The files for contributors, citation and development agree with the package and name existing things."""

import ast
import re
import subprocess
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [str(path.relative_to(ROOT)) for pattern in ("*.md", "*/README.md", "tests/*/README.md")
         for path in ROOT.glob(pattern) if not path.parent.name.startswith(".")]  # not of caches


def text(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def project() -> dict:
    return tomllib.loads(text("pyproject.toml"))["project"]


def test_one_version(project):
    assert re.search(r"^version: (\S+)$", text("CITATION.cff"), re.MULTILINE)[1] == project["version"]
    assert re.search(r"^## (\S+)", text("CHANGELOG.md"), re.MULTILINE)[1] == project["version"]


def test_one_licence(project):
    assert re.search(r"^license: (\S+)$", text("CITATION.cff"), re.MULTILINE)[1] == project["license"]


def test_contributing_names_files_that_exist():
    named = set(re.findall(r"`((?:derive|runtime|tests|generated|\.ci)/[\w./]*)`", text("CONTRIBUTING.md")))
    assert len(named) > 5
    named = {path for path in named if not re.search(r"/[A-Z]+\b", path)}  # which the reader chooses
    assert [path for path in sorted(named) if not (ROOT / path).exists()] == []


@pytest.mark.parametrize("page", PAGES)
def test_pages_link_to_what_exists(page):
    """Pictures are included; the source distribution contains all files of the repository."""
    links = re.findall(r"\]\((?!https?:|#)([^)#\s]+)", text(page))
    assert [link for link in links if not (ROOT / page).parent.joinpath(link).exists()] == []


def test_python_versions_are_those_of_the_metadata(project):
    """CI runs the oldest and the newest version of the classifiers."""
    oldest = project["requires-python"].removeprefix(">=")
    named = re.findall(r":: (3\.\d+)$", "\n".join(project["classifiers"]), re.MULTILINE)
    run = re.search(r"python: \[(.*)\]", text(".github/workflows/ci.yml"))[1].replace('"', "").split(", ")
    assert (named[0], run) == (oldest, [named[0], named[-1]])


def test_actions_are_pinned_by_hash():
    used = [line for file in (ROOT / ".github/workflows").glob("*.yml")
            for line in re.findall(r"uses: (.*)", file.read_text(encoding="utf-8"))]
    assert len(used) > 5
    assert [line for line in used if not re.fullmatch(r"[\w/-]+@[0-9a-f]{40}  # v\d+\.\d+\.\d+", line)] == []
    assert len({line.split("@")[0] for line in used}) == len(set(used)), "two versions of one action"


def test_files_for_the_community():
    """The files that hosting services look for exist, and forms have their required entries."""
    names = ["SECURITY.md", "CODE_OF_CONDUCT.md", "CONTRIBUTING.md", ".github/pull_request_template.md",
             ".github/ISSUE_TEMPLATE/config.yml"]
    assert [name for name in names if not (ROOT / name).is_file()] == []
    for form in set((ROOT / ".github/ISSUE_TEMPLATE").glob("*.yml")) - {ROOT / names[-1]}:
        found = form.read_text(encoding="utf-8")
        assert re.findall(r"^(\w+):", found, re.MULTILINE) == ["name", "description", "title", "labels", "body"], form
        names_of_fields = re.findall(r"^    id: (\w+)$", found, re.MULTILINE)
        assert len(re.findall(r"^  - type:", found, re.MULTILINE)) == len(set(names_of_fields))


def test_dependency_groups_name_extras(project):
    groups = tomllib.loads(text("pyproject.toml"))["dependency-groups"]
    named = [re.fullmatch(r"funicular\[(\w+)\]", each)[1] for name in ("test", "docs") for each in groups[name]]
    assert set(named) <= set(project["optional-dependencies"])
    assert {each["include-group"] for each in groups["dev"] if isinstance(each, dict)} == set(groups) - {"dev"}


def test_the_source_distribution_has_the_files_of_the_top_folder():
    listed = " ".join(re.findall(r"^include (.*)", text("MANIFEST.in"), re.MULTILINE)).split()
    assert {path.name for path in ROOT.glob("*.md")} | {path.name for path in ROOT.glob("*.bib")} <= {*listed}


@pytest.mark.skipif(not (ROOT / ".git").exists(), reason="not in a repository")
def test_the_repository_has_no_output_of_runs_at_its_top():
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    assert {Path(name).suffix for name in listed if "/" not in name} <= {
        "", ".md", ".toml", ".in", ".cff", ".bib", ".yaml"}


def test_the_changelog_is_short():
    assert len(text("CHANGELOG.md").splitlines()) <= 60


def test_the_paper_has_what_its_journal_asks_for():
    """Sections and length follow the Journal of Open Source Software, 2026; citations and entries agree."""
    paper = text("paper.md")
    head, body = paper.removeprefix("---\n").split("\n---\n")
    keys = re.findall(r"^(\w+):", head, re.MULTILINE)
    assert {"title", "tags", "authors", "affiliations", "date", "bibliography"} <= {*keys}
    assert re.findall(r"^# (.*)", body, re.MULTILINE) == [
        "Summary", "Statement of need", "State of the field", "Software design", "Research impact statement",
        "AI usage disclosure", "Acknowledgements", "References"]
    assert 750 <= len(body.split()) <= 1750
    entries = re.findall(r"^@\w+\{(\w+),", text("paper.bib"), re.MULTILINE)
    assert sorted(entries) == sorted(set(re.findall(r"@(\w+)", body)))


def functions():
    """Yield every function of the package with its place."""
    for folder in ("runtime", "derive"):
        for file in sorted((ROOT / folder).rglob("*.py")):
            for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
                if isinstance(node, ast.FunctionDef):
                    yield f"{file.relative_to(ROOT)}:{node.lineno} {node.name}", node


def test_functions_are_below_60_lines():
    assert [where for where, node in functions() if node.end_lineno - node.lineno >= 59] == []


def test_docstrings_are_sentences():
    words = {where: len((ast.get_docstring(node) or "").split()) for where, node in functions()}
    assert [where for where, count in words.items() if where.startswith("runtime") and 0 < count <= 3] == []


def test_the_packages_are_listed():
    """Setuptools does not search mapped folders: the list must name each folder with an __init__.py."""
    listed = set(tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["setuptools"]["packages"])
    folders = {".".join([package, *file.parent.relative_to(ROOT / top).parts])
               for top, package in (("runtime", "funicular"), ("derive", "funicular.derive"),
                                    ("generated", "funicular.generated"))
               for file in (ROOT / top).rglob("__init__.py")}
    assert folders <= listed
    assert listed - folders == {"funicular.scenes", "funicular.derive.codegen.templates"}  # data alone
