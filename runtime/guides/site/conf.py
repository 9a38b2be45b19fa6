"""Sphinx's configuration; `build.py` copies it beside the sources that it collects."""

import logging
import warnings

import funicular
from funicular.guides.site.build import place_in_order
from sphinx.application import Sphinx

project = "funicular"
author = "The funicular authors"
copyright = "The funicular authors"
release = version = funicular.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.autosummary", "sphinx.ext.doctest",
              "sphinx_gallery.gen_gallery"]
html_theme = "furo"
html_title = "funicular"
html_extra_path = ["extra"]
html_static_path = ["static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False
exclude_patterns = ["guides_source"]
myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence"]
autodoc_typehints = "signature"
autodoc_member_order = "bysource"
suppress_warnings = ["config.cache"]

sphinx_gallery_conf = {
    "examples_dirs": "guides_source",
    "gallery_dirs": "guides",
    "within_subsection_order": place_in_order,
    "filename_pattern": r"\.py",
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_memory": False,
    "show_signature": False,
    "capture_repr": (),
    "min_reported_time": 1e9,
    "write_computation_times": False,
    "remove_config_comments": True,
}

warnings.filterwarnings("ignore", category=DeprecationWarning)
logging.getLogger("funicular").setLevel(logging.WARNING)


def with_tables(app: Sphinx, what: str, name: str, thing: object, options: object, lines: list[str]) -> None:
    """Turn the tables of docstrings, which are as Markdown has them, into those of reStructuredText."""
    found: list[str] = []
    for line in lines:
        if not line.startswith("|"):
            found.append(line)
        elif not set(line) <= set("|- "):
            if not found or not found[-1].startswith("    "):
                found += [".. list-table::", "    :header-rows: 1", ""]
            cells = [cell.strip() for cell in line.strip("|").split("|")]
            found += [("    * - " if k == 0 else "      - ") + cell for k, cell in enumerate(cells)]
    lines[:] = found


def setup(app: Sphinx) -> None:
    """Register what this configuration adds."""
    app.connect("autodoc-process-docstring", with_tables)
