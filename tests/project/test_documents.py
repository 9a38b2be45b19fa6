"""Everything that guides/pages names exists, and the number of words is bounded."""

import ast
import re

import funicular
import pytest
from funicular.guides.site import printed as printing
from funicular.guides.site.parts_page import meanings_of
from funicular.parts.kinds import PARTS
from funicular.parts.scene_text import SETTINGS
from pages import PAGES, ROOT, SUBJECTS, page

FOLDER = ROOT / "runtime" / "guides" / "pages"
CONCEPTS = "runtime/guides/pages/concepts.md"
MACHINES = "runtime/guides/pages/machines.md"
HAND_WRITTEN = [path for path in PAGES if "Printed by" not in page(path).text[:200]]
REFERENCE = ["runtime/README.md", *(path for path in SUBJECTS if path in HAND_WRITTEN)]
GUIDES = sorted((ROOT / "runtime/guides").glob("*.py"))
MAX_WORDS = {"page": 700, "all": 12_500}
"""Of a page of the reference, and of all pages by hand and the texts of guides."""
WANTED = ("saddle", "sheave", "haul rope", "winch", "temperature", "moving load", "float", "mooring", "dropper",
          "buffer", "brake", "tube", "cable robot", "footbridge", "crane", "pantograph", "tether", "belt")
WANTED_CONCEPTS = ("sliding joint", "eq 16", "eq 34", "floating frame", "redundant constraints", "Hunt-Crossley",
                   "restitution", "Coulomb friction, its energy", "capstan", "end stop", "closest points",
                   "dropper slackness", "membrane", "Morison", "added mass, its tangent", "waterplane",
                   "spectral radius", "discrete gradient", "root finding", "arc-length continuation",
                   "dynamic relaxation", "section force recovery", "mesh estimate", "checkpoint")
"""Words that users look for."""


def rows_of(path: str) -> list[list[str]]:
    """Return the cells of the rows of a page's table, without its head."""
    return [[cell.strip() for cell in line.strip("|").split("|")]
            for line in page(path).text.splitlines() if line.startswith("|")][2:]


@pytest.mark.parametrize(("path", "wanted"), [(MACHINES, WANTED), (CONCEPTS, WANTED_CONCEPTS)])
def test_a_table_has_what_users_look_for(path, wanted):
    found = " ".join(row[0] for row in rows_of(path))
    assert [word for word in wanted if word not in found] == []


def test_each_concept_is_two_steps_from_the_front_page():
    assert CONCEPTS in page("README.md").links
    for row in rows_of(CONCEPTS):
        for cell in row[1:]:
            targets = re.findall(r"\]\(([^)#]+)", cell)
            assert targets, row
            assert [target for target in targets if not (FOLDER / target).is_file()] == [], row


def test_each_machine_names_parts_that_exist():
    """`test_names_of_the_package_exist` tests the keywords of all pages."""
    for row in rows_of(MACHINES):
        assert len(row) == 4, row
        named = re.findall(r"\b(?:scene|fu|funicular)\.(\w+)", row[1])
        assert {"catenary", *PARTS} & set(named), row
        for name in named:
            assert name == "catenary" or hasattr(funicular, name) or hasattr(funicular.Scene, name), row
        assert not re.search(r"`(\w+)`", row[2]), "guides are links"


def test_each_machine_has_a_guide_or_says_what_is_not_modelled():
    for row in rows_of(MACHINES):
        assert "](" in row[2] or row[3], row


def test_printed_pages_are_what_the_code_says():
    for name, text in printing.printed().items():
        assert (FOLDER / name).read_text(encoding="utf-8") == text, \
            "write it anew: python -m funicular.guides.site.printed"


def test_an_installed_package_prints_no_pages(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(printing, "FOLDER", tmp_path / "pages")
    assert printing.main() == 1
    assert capsys.readouterr().err.endswith("print them in a copy of the repository\n")
    assert not (tmp_path / "pages").exists()


def test_every_argument_and_result_of_every_part_is_printed():
    printed = page("runtime/guides/pages/parts.md").text
    for part in PARTS.values():
        section = printed.split(f"\n### {part.__name__}\n")[1].split("\n### ")[0]
        rows = set(re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE))
        assert rows == {*part.keywords(), *part.results}, part


@pytest.mark.parametrize("part", [*PARTS.values(), *SETTINGS.values()], ids=lambda part: part.__name__)
def test_docstrings_say_what_each_argument_is(part):
    assert [name for name in part.keywords() if not meanings_of(part).get(name)] == []


def test_documents_tell_of_today():
    past = r"\b((was|were) tried|no longer|used to (be|have|take)|previously|formerly|until now|originally)\b"
    documents = [path for path in ROOT.rglob("*.md") if not {".venv", "node_modules"} & set(path.parts)]
    assert len(documents) > 40
    assert [path for path in documents if re.search(past, path.read_text(encoding="utf-8"))] == []


def words(text: str) -> int:
    """Return the number of words of a text; rules and the frames of tables have no letters."""
    return len([word for word in text.split() if re.search(r"\w", word)])


def prose(text: str) -> str:
    """Return a page without printed lists, blocks of code and the targets of links."""
    text = re.sub(r"<!-- scripts.*?end of scripts -->|^```.*?^```|^    .*?$", "", text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"\]\([^)]*\)", "]", text)


def told(guide: str) -> str:
    """Return the docstring and the texts of a guide."""
    lines = [line for line in guide.splitlines() if line.startswith("#") and not line.startswith("# %%")]
    return "\n".join([ast.get_docstring(ast.parse(guide)) or "", *lines])


def test_pages_are_short():
    """The option -s prints the number of words of each page."""
    found = {path: words(prose(page(path).text)) for path in HAND_WRITTEN}
    found["page_source"] = words(prose(page("runtime/view/page_source/README.md").text))
    found |= {path.name: words(told(path.read_text(encoding="utf-8"))) for path in GUIDES}
    print("", *(f"{number:6d} {path}" for path, number in found.items()), f"{sum(found.values()):6d} in all", sep="\n")
    assert {path: found[path] for path in REFERENCE if found[path] > MAX_WORDS["page"]} == {}
    assert sum(found.values()) <= MAX_WORDS["all"]


@pytest.mark.parametrize("path", SUBJECTS)
def test_every_page_is_in_the_table_of_the_reference_and_on_the_site(path):
    name = path.split("/")[-1]
    assert f"guides/pages/{name}" in page("runtime/README.md").links
    assert f"\n{name.removesuffix('.md')}\n" in (ROOT / "runtime/guides/site/index.md").read_text(encoding="utf-8")
