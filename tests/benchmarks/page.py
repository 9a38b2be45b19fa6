"""Frames per second of the 3D page with software rendering in a headless browser; its size and the time to write it.

    python tests/benchmarks/page.py [--out FILE.csv]

needs Chromium or Chrome, and ``pip install -e '.[test,browser]'``. A graphics card is many times as fast.
"""

import statistics
import sys
import tempfile
import time
from pathlib import Path

from funicular.view.animation import Animation
from funicular.view.page import write_page
from table import arguments, few, show

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[1] / "view"))
SIZE = {"width": 1200, "height": 800}
FRAMES = 60


def measured(name: str, animation: Animation, folder: Path, started) -> dict:
    """Return a row of the table: name, stations and frames, size, time to write, frames per second."""
    from browser import Opened  # needs playwright, which the command line is read without

    begin = time.perf_counter()
    path = write_page(animation, folder / "page.html")
    writing = time.perf_counter() - begin
    page = Opened(started, path, viewport=SIZE)
    seconds = statistics.median(page(f"f.measure({FRAMES})")[5:])
    stations = page("f.data.clips[0].cables.reduce((sum, cable) => sum + cable.s.values.length, 0)")
    frames = page("f.data.clips[0].time.length")
    page.context.close()
    return {"page": name, "stations": stations, "frames": frames, "MB": path.stat().st_size / 1e6, "written s": writing,
            "frames per second": 1 / seconds}


def main() -> None:
    """Print the table."""
    given = arguments(__doc__)
    import page_animations as animations
    from browser import browser

    cases = {
        "example 5.1": animations.paper51(),
        "twisted beam, rectangular section": animations.twisted(),
        "waves along 2,000 elements": animations.wave(),
    }
    with browser() as started, tempfile.TemporaryDirectory() as folder:
        show([measured(name, animation, Path(folder), started) for name, animation in few(cases.items())],
             given.out)


if __name__ == "__main__":
    main()
