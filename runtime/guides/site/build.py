"""Collects the sources of the site in a separate directory, and runs Sphinx there; nothing else is written."""

from __future__ import annotations

import json
import posixpath
import re
import shutil
import subprocess
import sys
from pathlib import Path

from funicular.errors import FunicularError
from funicular.scene.schema import scene_schema
from funicular.base.written_files import write_whole

SITE = Path(__file__).parent
GUIDES = SITE.parent
REPOSITORY = GUIDES.parents[1]
"""The repository of the package, which an installed package lacks."""

PAGES = {"runtime/README.md": "reference.md", "derive/README.md": "derivation.md",
         "tests/benchmarks/README.md": "benchmarks.md", "tests/benchmarks/validation.md": "validation.md",
         "tests/benchmarks/speed.md": "speed.md",
         **{page.relative_to(REPOSITORY).as_posix(): page.name for page in sorted(GUIDES.glob("pages/*.md"))}}
"""Pages beside the code, and their names in the site."""

ORDER = ("first_scene", "choose_an_element", "choose_a_model", "cable_car", "crane", "zip_line", "pantograph",
         "cable_robot", "controller", "sheaves", "slackline", "slack_and_taut", "your_own_rope_law", "droppers",
         "contact", "wind_and_water", "modes", "results", "sweep", "fit_and_rank", "long_runs", "your_own_element",
         "verify_and_benchmark", "c_kernels")
"""Guides in the order of the gallery: first steps, examples, special subjects."""

GALLERY_HEADER = """Guides
======

Each is a script that runs; its pictures and numbers are what it printed when this site was built.
"""

THEORY = """# Theory

All equations in the order of the paper, with its equation numbers, and a page for each element: its use, limits,
measured errors and formulas. They are made from the specs of the C kernels, and each formula was compared with the
compiled kernel when this site was built. Formulas are MathML: a browser shows them without a script.

"""


def build(out: Path, work: Path) -> int:
    """Build the site and return 0, or 1 if the theory is wrong or Sphinx warned: then ``out`` stays as it was.

    work: an empty directory. Raises FunicularError where pages are missing, as in an installed package.
    """
    if missing := [page for page in PAGES if not (REPOSITORY / page).is_file()]:
        raise FunicularError(f"site: {REPOSITORY} has no {', '.join(missing)}: an installed funicular is without the "
                             "pages beside its code; build the site in a copy of the repository")
    sources, made = work / "sources", work / "made"
    sources.mkdir()
    failed = _collect(sources) or subprocess.run(
        [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", str(sources), str(made)],
        check=False).returncode
    if not failed:
        shutil.copytree(made, out, dirs_exist_ok=True, ignore=shutil.ignore_patterns(".doctrees"), copy_function=(
            lambda file, target: write_whole(target, lambda part: shutil.copyfile(file, part), "the site")))
    return failed


def _collect(work: Path) -> int:
    """Collect the sources of the site in an empty directory; return 1 if the theory is wrong."""
    for file in (*SITE.glob("*.md"), SITE / "conf.py"):
        shutil.copy(file, work)
    shutil.copytree(SITE / "static", work / "static")
    shutil.copytree(GUIDES, work / "guides_source", ignore=shutil.ignore_patterns("site", "pages", "__*"))
    (work / "guides_source" / "GALLERY_HEADER.rst").write_text(GALLERY_HEADER, encoding="utf-8")
    for page, name in PAGES.items():
        text = (REPOSITORY / page).read_text(encoding="utf-8")
        (work / name).write_text(_moved(text, page), encoding="utf-8")
        for picture in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", text):
            (work / picture).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy((REPOSITORY / page).parent / picture, work / picture)
    (work / "command_line.md").write_text(command_line(), encoding="utf-8")
    (work / "extra").mkdir()
    (work / "extra" / "funicular.schema.json").write_text(json.dumps(scene_schema(), indent=1), encoding="utf-8")
    theory = [sys.executable, "-m", "funicular", "theory", "-o", str(work / "extra" / "theory")]
    if subprocess.run(theory, check=False).returncode:
        return 1
    (work / "theory.md").write_text(theory_page(work / "extra"), encoding="utf-8")
    return 0


def place_in_order(filename: str | Path) -> int:
    """Return the place of a guide's file in the gallery."""
    return ORDER.index(Path(filename).stem)


def _moved(text: str, page: str) -> str:
    """Return a page with links to other pages and to guides of the site; other links lose their target."""
    def link(found: re.Match[str]) -> str:
        words, target = found.groups()
        if target.startswith(("#", "http")):
            return found[0]
        path, mark, anchor = target.partition("#")
        whole = posixpath.normpath(posixpath.join(posixpath.dirname(page), path))
        name = PAGES.get(whole) or PAGES.get(f"{whole}/README.md")
        if name is not None:
            return f"[{words}]({name}{mark}{anchor})"
        if REPOSITORY / whole in (GUIDES / f"{guide}.py" for guide in ORDER):
            return f"[{words}](guides/{Path(whole).stem})"
        return found[0] if path.endswith(".png") and "/" not in posixpath.normpath(path) else words

    return re.sub(r"(?<!!)\[([^\]]*)\]\(([^)]+)\)", link, text)


def command_line() -> str:
    """Return the reference of the command line, as typer writes it."""
    command = [sys.executable, "-m", "typer", "funicular.cli.main", "utils", "docs", "--name", "funicular"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return re.sub(r"^# `funicular`", "# Command line", text, flags=re.MULTILINE)


def theory_page(extra: Path) -> str:
    """Return the page that links to the documents in extra/theory, the whole theory first."""
    lines = []
    for html in sorted((extra / "theory").glob("*.html"), key=lambda path: (path.stem != "theory", path.stem)):
        name = html.relative_to(extra).as_posix()
        title = "The theory, from eq 1 to 38" if html.stem == "theory" else f"The element {html.stem}"
        tex = html.with_suffix(".tex").relative_to(extra).as_posix()
        lines.append(f'- <a href="{name}">{title}</a> (<a href="{tex}">LaTeX</a>)')
    return THEORY + "\n".join(lines) + "\n"
