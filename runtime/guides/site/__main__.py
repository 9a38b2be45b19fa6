"""Builds the site: ``python -m funicular.guides.site DIR``. Needs the extra `docs`; the guides are run."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from funicular.errors import FunicularError

from .build import build


def main() -> int:
    """Build the site into the directory that is given; returns 1 where something is wrong."""
    if len(sys.argv) != 2:
        print("usage: python -m funicular.guides.site DIR", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as work:
        try:
            return build(Path(sys.argv[1]), Path(work))
        except FunicularError as error:
            print(f"error: {error}", file=sys.stderr)
            return 1


if __name__ == "__main__":
    sys.exit(main())
