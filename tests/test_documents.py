"""The pages of guides/pages: what stands on them is there, and their number of words is bounded."""

import re

import funicular
import pytest
from funicular.guides.site.printed import PRINTED
from funicular.parts.kinds import PARTS
from pages import ROOT, SUBJECTS, page

FOLDER = ROOT / "runtime" / "guides" / "pages"
MACHINES = "runtime/guides/pages/machines.md"
HAND_WRITTEN = ["runtime/README.md", *(path for path in SUBJECTS if path.split("/")[-1] not in PRINTED)]
MOST_WORDS = {"a page": 700, "all": 5300}
"""Outside of blocks of code."""
WANTED = ("saddle", "sheave", "haul rope", "winch", "temperature", "moving load", "float", "mooring", "dropper",
          "buffer", "brake", "tube", "cable robot", "footbridge", "crane", "pantograph", "tether", "belt")
"""Words that users look for."""


def rows_of_machines() -> list[list[str]]:
    """Cells of the rows of the table of machines, without its head."""
    return [[cell.strip() for cell in line.strip("|").split("|")]
            for line in page(MACHINES).text.splitlines() if line.startswith("|")][2:]


def test_machines_has_what_users_look_for():
    found = " ".join(row[0] for row in rows_of_machines())
    assert [word for word in WANTED if word not in found] == []


def test_each_machine_names_parts_that_exist():
    """Their keywords are tested with those of all pages (`test_names_of_the_package_exist`)."""
    for row in rows_of_machines():
        assert len(row) == 4, row
        named = re.findall(r"\b(?:scene|fu|funicular)\.(\w+)", row[1])
        assert {"catenary", *PARTS} & set(named), row
        for name in named:
            assert name == "catenary" or hasattr(funicular, name) or hasattr(funicular.Scene, name), row
        assert not re.search(r"`(\w+)`", row[2]), "guides are links"


def test_each_machine_has_a_guide_or_says_what_is_not_modelled():
    for row in rows_of_machines():
        assert "](" in row[2] or row[3], row


@pytest.mark.parametrize("name", PRINTED)
def test_printed_pages_are_what_the_code_says(name):
    assert (FOLDER / name).read_text(encoding="utf-8") == PRINTED[name](), \
        "write it anew: python -m funicular.guides.site.printed"


def test_every_argument_and_result_of_every_part_is_printed():
    printed = page("runtime/guides/pages/parts.md").text
    for part in PARTS.values():
        section = printed.split(f"\n### {part.__name__}\n")[1].split("\n### ")[0]
        rows = set(re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE))
        assert rows == {*part.keywords(), *part.results}, part


def words(path: str) -> int:
    """Number of words of a page outside of its blocks of code."""
    return len(re.sub(r"^```.*?^```", "", page(path).text, flags=re.MULTILINE | re.DOTALL).split())


def test_pages_are_short():
    """Run with -s it prints the number of words of each page."""
    found = {path: words(path) for path in HAND_WRITTEN}
    print("", *(f"{number:5d} {path}" for path, number in found.items()), f"{sum(found.values()):5d} in all", sep="\n")
    assert {path: number for path, number in found.items() if number > MOST_WORDS["a page"]} == {}
    assert sum(found.values()) <= MOST_WORDS["all"]
