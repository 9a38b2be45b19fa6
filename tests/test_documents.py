"""The pages of guides/pages: what stands on them is there, and their number of words is bounded."""

import re

import funicular
from funicular.parts.kinds import PARTS
from pages import page

MACHINES = "runtime/guides/pages/machines.md"
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
