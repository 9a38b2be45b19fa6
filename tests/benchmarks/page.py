"""Frames per second of the 3D page, drawn by software in a headless browser; its size and the time to write it.

    python tests/benchmarks/page.py

needs Chromium or Chrome, and ``pip install -e '.[test,browser]'``. A graphics card is many times as fast.
"""

import statistics
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import page_animations as animations
from browser import Opened, browser
from funicular.view.animation import Animation
from funicular.view.page import write_page

SIZE = {"width": 1200, "height": 800}
FRAMES = 60


def measured(name: str, animation: Animation, folder: Path, started) -> str:
    """Return a row of the table: name, stations and frames, size, time to write, frames per second."""
    begin = time.perf_counter()
    path = write_page(animation, folder / "page.html")
    writing = time.perf_counter() - begin
    page = Opened(started, path, viewport=SIZE)
    seconds = statistics.median(page(f"f.measure({FRAMES})")[5:])
    stations = page("f.data.clips[0].cables.reduce((sum, cable) => sum + cable.s.values.length, 0)")
    frames = page("f.data.clips[0].time.length")
    page.context.close()
    return (f"| {name} | {stations} | {frames} | {path.stat().st_size / 1e6:.2f} MB | {writing:.1f} s "
            f"| {1 / seconds:.0f} |")


def main() -> None:
    """Print the table."""
    cases = {
        "example 5.1": animations.paper51(),
        "twisted beam, rectangular section": animations.twisted(),
        "waves along 2,000 elements": animations.wave(),
    }
    print("| page | stations drawn | frames | size | written in | frames per second |\n|---|---|---|---|---|---|")
    with browser() as started, tempfile.TemporaryDirectory() as folder:
        for name, animation in cases.items():
            print(measured(name, animation, Path(folder), started))


if __name__ == "__main__":
    main()
