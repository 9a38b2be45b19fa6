"""The configuration of Sphinx, which `build.py` copies beside the collected sources."""

import logging
import warnings

import funicular
from funicular.guides.site.build import place_in_order

project = "funicular"
author = "The funicular authors"
copyright = "The funicular authors"
release = version = funicular.__version__

extensions = ["myst_parser", "sphinx_gallery.gen_gallery"]
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
