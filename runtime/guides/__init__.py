"""Guides: scripts that run, each on one page; `python -m funicular.guides.site DIR` makes a site of them."""
