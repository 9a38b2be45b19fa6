"""The pictures of a film: a figure of which only the moving parts are drawn anew.

Matplotlib is imported when a picture is made.
"""

from __future__ import annotations

from collections.abc import Iterator
from operator import methodcaller
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import FunicularError, near
from .animation import Animation, Clip, Quantity, at_frame, material_marks, period
from .plot import CLIP_COLOURS, MARKERS, SEGMENTS, SIZES, PlanePanel, colour_scale
from .projections import Directions, Projection, all_points, directions
from .surfaces import body_reach

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable

SIZE, DPI = (9.6, 5.4), 100
"""Size of a picture in inches, and dots per inch."""
AZIMUTH, ELEVATION = 0.55, 0.35
"""Direction of view of a spatial scene, from its main view, rad."""
MARGIN = 0.07

class Film:
    """A figure that shows an animation at given times."""

    def __init__(self, animation: Animation, clips: tuple[Clip, ...], colour: str | None, pace: float):
        """colour: the key of a quantity along cables that colours them; pace: ratio of motion to film time."""
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self.animation, self.clips, self.pace = animation, clips, pace
        self.canvas: Any = FigureCanvasAgg(Figure(figsize=SIZE, dpi=DPI))
        figure = self.canvas.figure
        seen = directions(animation)
        self.view = seen.front if seen.flat else oblique(seen)
        self.colour, shown = colour, _quantities(clips, colour)
        self.scale: ScalarMappable | None = (
            colour_scale(np.concatenate([each.values.ravel() for each in shown])) if shown else None)
        self.axes: Axes = figure.add_axes((0.07, 0.1, 0.77 if colour else 0.9, 0.8))
        self.box = _corners(animation, seen)
        self._set_limits()
        self.panel = PlanePanel(self.axes, self.view)
        if seen.flat:
            self.axes.set(xlabel=f"{self.view.names[0]} / m", ylabel=f"{self.view.names[1]} / m")
        else:
            self.axes.set_axis_off()
            self._draw_box(seen)
        if self.scale is not None:
            figure.colorbar(self.scale, cax=figure.add_axes((0.87, 0.15, 0.015, 0.7)),
                            label=f"{shown[0].label} / {shown[0].unit}")
        self.caption = figure.text(0.02, 0.94, "", fontsize=11, animated=True)
        title = f"{animation.title}, {clips[0].label}" if animation.arrangement == "menu" else animation.title
        figure.text(0.98, 0.94, title, fontsize=11, ha="right", color="0.35")

    def pictures(self, times: np.ndarray) -> Iterator[np.ndarray]:
        """Yield the pictures (height, width, 3) in bytes of the motion at these times."""
        self.canvas.draw()
        fixed = {*self.axes.get_children()}
        background = self.canvas.copy_from_bbox(self.canvas.figure.bbox)
        unit = self.animation.time_unit
        pace = f"   (played at {self.pace:.3g} times its speed)" * (unit == "s")
        for time in times:
            self.canvas.restore_region(background)
            for number, clip in enumerate(self.clips):
                self._draw(clip, frame_at(clip, float(time)), CLIP_COLOURS[number % len(CLIP_COLOURS)])
            moving = [artist for artist in self.axes.get_children() if artist not in fixed]
            for artist in sorted(moving, key=methodcaller("get_zorder")):
                self.axes.draw_artist(artist)
                artist.remove()
            self.caption.set_text(f"{self.animation.time_label} {time:.4g} {unit}".rstrip() + pace)
            self.canvas.figure.draw_artist(self.caption)
            yield np.asarray(self.canvas.buffer_rgba())[..., :3].copy()

    def _set_limits(self) -> None:
        """Set equal scales about the middle of the extents, bodies included, in the shape of the axes."""
        places = [self.view.of(self.box)]
        for body in (body for clip in self.clips for body in clip.bodies):
            positions, reach = self.view.of(body.position), body_reach(body)
            places += [positions - reach, positions + reach]
        reached = np.concatenate(places)
        low, high = reached.min(axis=0), reached.max(axis=0)
        box = self.axes.get_position()
        across, up = SIZE[0] * box.width, SIZE[1] * box.height
        size = (1 + 2 * MARGIN) * max((high[0] - low[0]) / across, (high[1] - low[1]) / up, 1e-9)
        middle = (low + high) / 2
        self.axes.set_xlim(middle[0] - size * across / 2, middle[0] + size * across / 2)
        self.axes.set_ylim(middle[1] - size * up / 2, middle[1] + size * up / 2)

    def _draw_box(self, seen: Directions) -> None:
        """Draw the edges of the bounding box, with the lengths of three of them."""
        corners = self.box.reshape(2, 2, 2, 3)
        drawn = self.view.of(corners)
        for axis, name in enumerate(seen.names):
            for edge in np.moveaxis(drawn, axis, 0).reshape(2, 4, 2).swapaxes(0, 1):
                self.axes.plot(*edge.T, color="0.85", linewidth=0.8, zorder=0)
            first = np.moveaxis(drawn, axis, 0)[:, 0, 0]
            length = np.linalg.norm(np.diff(np.moveaxis(corners, axis, 0)[:, 0, 0], axis=0))
            self.axes.annotate(f"{name}: {length:.3g} m", first.mean(axis=0), fontsize=8, color="0.45", ha="center",
                               va="top")

    def _draw(self, clip: Clip, frame: int, colour: str) -> None:
        """Draw a clip at a frame."""
        from matplotlib.collections import LineCollection
        from matplotlib.colors import to_rgba

        for body in clip.bodies:
            if body.shape["kind"] != "wheel" and "sheet" not in body.shape:
                self.panel.line(body.position[: frame + 1], color="0.6", linewidth=0.7, zorder=1)
            self.panel.body(body, frame, float(clip.time[frame]), to_rgba(colour))
        for cable in clip.cables:
            points = self.view.of(cable.position[frame])
            lines = LineCollection(list(np.stack([points[:-1], points[1:]], axis=1)), linewidths=3, colors=colour,
                                   zorder=2, capstyle="round")
            for quantity in cable.quantities:
                if quantity.key == self.colour and self.scale is not None:
                    values = quantity.values[frame]
                    lines.set_color(list(map(tuple, self.scale.to_rgba((values[:-1] + values[1:]) / 2))))
            self.axes.add_collection(lines, autolim=False)
            if len(marked := material_marks(cable, frame)):
                self.panel.line(marked, linestyle="", marker=".", markersize=4, color="0.1", zorder=3)
        for segment in clip.segments:
            start, end = at_frame(segment.start, frame), at_frame(segment.end, frame)
            if segment.kind == "load":
                self.panel.arrow(start, end, None)
            else:
                self.panel.line(np.stack([start, end]), color="0.3", zorder=4, **SEGMENTS[segment.kind])
        for mark in clip.marks:
            self.panel.line(at_frame(mark.position, frame)[None], marker=MARKERS[mark.kind], linestyle="",
                            color="0.15", zorder=5, markersize=np.sqrt(SIZES[mark.kind]))


def _corners(animation: Animation, seen: Directions) -> np.ndarray:
    """Return the corners (8, 3) of the bounding box along the directions."""
    places = all_points(animation) @ seen.matrix
    ends = np.stack([places.min(axis=0), places.max(axis=0)])
    corners = np.array([[x, y, z] for x in ends[:, 0] for y in ends[:, 1] for z in ends[:, 2]])
    return np.asarray(corners @ seen.matrix.T)


def frame_at(clip: Clip, time: float) -> int:
    """Return the number of the frame of a clip nearest to a time, modulo the period of a repeated clip."""
    distance, whole = clip.time - time, period(clip)
    if whole is not None:
        distance = (distance + whole / 2) % whole - whole / 2
    return int(np.argmin(np.abs(distance)))


def oblique(seen: Directions) -> Projection:
    """Return the view of a spatial scene from the side and from above."""
    across = np.cos(AZIMUTH) * seen.across + np.sin(AZIMUTH) * seen.depth
    into = np.cross(seen.up, across)
    return Projection(across, np.cos(ELEVATION) * seen.up + np.sin(ELEVATION) * into, ("", ""))


def _quantities(clips: tuple[Clip, ...], key: str | None) -> list[Quantity]:
    """Return the quantities of a key along all cables, none for None. Raises FunicularError."""
    every = [quantity for clip in clips for cable in clip.cables for quantity in cable.quantities]
    found = [quantity for quantity in every if quantity.key == key]
    if key is not None and not found:
        raise FunicularError(f'cables have no quantity "{key}"; {near(key, {each.key: None for each in every})}')
    return found
