"""Films of an animation: GIF by Pillow, MP4 by imageio-ffmpeg. Matplotlib is imported when a picture is made."""

from __future__ import annotations

import os
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from ..base.written_files import write_whole
from ..errors import FunicularError, shown_path
from .animation import Animation, Clip, period
from .files import PICTURES, extra
from .film import Film
from .plot import STYLE

FRAME_RATE = 25
"""Pictures per second."""
DEFAULT_DURATION = 8.0
"""Seconds."""
MAX_PICTURES = 3000
PERIODS = 3
"""Periods of a mode in its film."""
KINDS = (".gif", ".mp4")


def write_video(animation: Animation, path: str | os.PathLike[str], speed: float | None = None,
                colour: str | None = None) -> Path:
    """Write a film of an animation, .gif or .mp4, and return its path; see `Viewable.save_video`.

    The clips of a menu, such as modes, follow one another. Raises ResultFileError; FunicularError.
    """
    from matplotlib import rc_context

    path = Path(path)
    if path.suffix.lower() not in KINDS:
        raise FunicularError(f"{shown_path(path)}: a film ends in {' or '.join(KINDS)}")
    together = [(clip,) for clip in animation.clips] if animation.arrangement == "menu" else [animation.clips]
    timings = [film_times(clips, speed) for clips in together]
    settings: dict[Any, Any] = {**STYLE, "figure.constrained_layout.use": False}
    write = _write_gif if path.suffix.lower() == ".gif" else _write_mp4
    with rc_context(settings):
        pictures = chain.from_iterable(Film(animation, clips, colour, pace).pictures(times)
                                       for clips, (times, pace) in zip(together, timings, strict=True))
        return write_whole(path, lambda part: write(part, pictures), PICTURES)


def film_times(clips: tuple[Clip, ...], speed: float | None) -> tuple[np.ndarray, float]:
    """Return the times of the motion of the pictures of a film, and the ratio of motion to film time.

    Raises FunicularError for a speed that is not positive, for a film that would be too long, and for a single frame.
    """
    first, last = min(clip.time[0] for clip in clips), max(clip.time[-1] for clip in clips)
    if not last > first:
        raise FunicularError("there is one frame, which makes no film; take save_png, or --png")
    if (whole := period(clips[0])) is not None:
        last = first + PERIODS * whole
    pace = (last - first) / DEFAULT_DURATION if speed is None else float(speed)
    if not (np.isfinite(pace) and pace > 0):
        raise FunicularError(f"the speed of a film must be positive, got {speed}")
    pictures = int(np.ceil((last - first) / pace * FRAME_RATE)) + 1
    if pictures > MAX_PICTURES:
        raise FunicularError(f"the film would have {pictures} pictures, at most {MAX_PICTURES} are made; take a "
                             f"speed of {(last - first) * FRAME_RATE / MAX_PICTURES:.3g} or more")
    return np.minimum(first + pace / FRAME_RATE * np.arange(pictures), last), pace


def _write_gif(path: Path, pictures: Iterator[np.ndarray]) -> None:
    from PIL import Image

    palette = (Image.fromarray(picture).quantize(128, dither=Image.Dither.NONE) for picture in pictures)
    first = next(palette)
    first.save(path, save_all=True, append_images=palette, duration=1000 // FRAME_RATE, loop=0)


def _write_mp4(path: Path, pictures: Iterator[np.ndarray]) -> None:
    """Write an H.264 film. Raises FunicularError without imageio-ffmpeg."""
    ffmpeg = extra("imageio_ffmpeg", "video")
    first = next(pictures)
    writer = ffmpeg.write_frames(os.fspath(path), first.shape[1::-1], fps=FRAME_RATE, codec="libx264", quality=8,
                                 macro_block_size=2)
    writer.send(None)
    try:
        writer.send(first.tobytes())
        for picture in pictures:
            writer.send(picture.tobytes())
    finally:
        writer.close()
    if not _is_whole(path):  # ffmpeg does not report a full disk
        raise OSError(0, "the film was cut short; free disk space")


def _is_whole(path: Path) -> bool:
    """Return whether an MP4 has all its boxes (ISO/IEC 14496-12, 4.2); the index is the last one."""
    kinds, remaining = set(), path.stat().st_size
    with path.open("rb") as file:
        while remaining >= 8:
            size, kind = int.from_bytes(file.read(4), "big"), file.read(4)
            head = 8
            if size == 1:
                size, head = int.from_bytes(file.read(8), "big"), 16
            if not head <= size <= remaining:
                return False
            kinds.add(kind)
            remaining -= size
            file.seek(size - head, os.SEEK_CUR)
    return remaining == 0 and {b"moov", b"mdat"} <= kinds
