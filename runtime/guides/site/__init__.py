"""The documentation as a site: guides, reference, commands and scene files, made with Sphinx."""
