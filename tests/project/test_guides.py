"""The guides are scripts of one page that run; their site has no broken link and no warning."""

import os
import re
import runpy
import subprocess
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


def test_links_to_guides_are_told_from_links_to_scripts_of_their_names():
    from funicular.guides.site.build import _moved

    text = "[a](../../runtime/guides/contact.py) [b](contact.py) [c](validation.md#fluid) [d](measured)"
    assert _moved(text, "tests/benchmarks/README.md") == "[a](guides/contact) b [c](validation.md#fluid) d"


def test_a_site_without_its_pages_is_refused(tmp_path, monkeypatch, capsys):
    """An installed package lacks the pages beside the code; a site without them is refused."""
    from funicular.guides.site import __main__ as command
    from funicular.guides.site import build

    monkeypatch.setattr(build, "REPOSITORY", tmp_path / "site-packages")
    monkeypatch.setattr(command.sys, "argv", ["site", str(tmp_path / "out")])
    assert command.main() == 1
    said = capsys.readouterr().err
    assert said.startswith(f"error: site: {tmp_path}/site-packages has no runtime/README.md, derive/README.md, tests")
    assert said.endswith("build the site in a copy of the repository\n")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("failed", [0, 1])
def test_a_site_that_fails_leaves_the_older_one(failed, tmp_path, monkeypatch):
    """A mock replaces Sphinx, which takes minutes."""
    from funicular.guides.site import build

    def sphinx(command: list[str], check: bool) -> subprocess.CompletedProcess:
        made = Path(command[-1])
        (made / "guides").mkdir(parents=True)
        (made / "index.html").write_text("newer")
        (made / "guides" / "a.html").write_text("newer")
        return subprocess.CompletedProcess(command, failed)

    monkeypatch.setattr(build, "_collect", lambda work: 0)
    monkeypatch.setattr(build.subprocess, "run", sphinx)
    (tmp_path / "work").mkdir()
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "index.html").write_text("older")
    assert build.build(tmp_path / "out", tmp_path / "work") == failed
    assert (tmp_path / "out" / "index.html").read_text() == ("older" if failed else "newer")
    assert (tmp_path / "out" / "guides").exists() != failed


@pytest.mark.site
def test_site(tmp_path):
    """Sphinx runs all guides; a warning, such as a broken link, is an error."""
    from funicular.guides.site.build import build

    os.environ["MPLBACKEND"] = "Agg"
    work, out = tmp_path / "work", tmp_path / "site"
    work.mkdir()
    assert build(out, work) == 0
    pages = {path.relative_to(out).as_posix() for path in out.rglob("*.html")}
    assert {"index.html", "reference.html", "parts.html", "methods.html", "machines.html", "command_line.html"} <= pages
    assert {"theory.html", "theory/theory.html", *(f"theory/{name}.html" for name in ELEMENTS)} <= pages
    assert {f"guides/{guide.stem}.html" for guide in GUIDES} <= pages
    for page in pages:  # it is read offline
        text = (out / page).read_text(encoding="utf-8")
        assert not re.search(r'<(?:script|link|img)[^>]*(?:src|href)="(?:https?:)?//', text), page
        for link in re.findall(r'<a\b[^>]*\bhref="([^"#?]+)', text):
            if not re.match(r"[a-z]+:", link):
                assert (out / page).parent.joinpath(unquote(link)).exists(), f"{page} links to {link}"
