"""The user's own elements: from a spec file outside the package to a verified, compiled and timed library."""
