"""The guides are scripts of one page that run; the site made of them has no broken link and no warning."""

import os
import re
import runpy
from pathlib import Path
from urllib.parse import unquote

import funicular.guides
import matplotlib
import pytest
from funicular.derive.elements import ELEMENTS
from funicular.guides.site.build import ORDER

FOLDER = Path(funicular.guides.__file__).parent
GUIDES = sorted(path for path in FOLDER.glob("*.py") if path.stem != "__init__")
QUICK = ("first_scene", "modes")
"""Those that the default run executes; the site's test executes all."""


def test_all_have_a_place_in_the_gallery():
    assert sorted(ORDER) == [guide.stem for guide in GUIDES]


@pytest.mark.parametrize("guide", GUIDES, ids=lambda guide: guide.stem)
def test_form(guide):
    text = guide.read_text(encoding="utf-8")
    assert 60 <= text.count("\n") <= 150
    assert re.match(r'"""\n\S.*\n=+\n\n', text), "a title, underlined"
    assert max(map(len, text.splitlines())) <= 120


@pytest.mark.parametrize("guide", [guide for guide in GUIDES if guide.stem in QUICK], ids=lambda guide: guide.stem)
def test_runs(guide, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    matplotlib.use("Agg")
    runpy.run_path(str(guide))
    matplotlib.pyplot.close("all")


@pytest.mark.site
def test_site(tmp_path):
    """Sphinx runs all guides; a warning, such as a link that leads nowhere, is an error."""
    from funicular.guides.site.build import build

    os.environ["MPLBACKEND"] = "Agg"
    work, out = tmp_path / "work", tmp_path / "site"
    work.mkdir()
    assert build(out, work) == 0
    pages = {path.relative_to(out).as_posix() for path in out.rglob("*.html")}
    assert {"index.html", "reference.html", "scene_files.html", "command_line.html", "api.html"} <= pages
    assert {"theory.html", "theory/theory.html", *(f"theory/{name}.html" for name in ELEMENTS)} <= pages
    assert {f"guides/{guide.stem}.html" for guide in GUIDES} <= pages
    for page in pages:  # it is read offline
        text = (out / page).read_text(encoding="utf-8")
        assert not re.search(r'<(?:script|link|img)[^>]*(?:src|href)="(?:https?:)?//', text), page
        for link in re.findall(r'<a\b[^>]*\bhref="([^"#?]+)', text):
            if not re.match(r"[a-z]+:", link):
                assert (out / page).parent.joinpath(unquote(link)).exists(), f"{page} links to {link}"
