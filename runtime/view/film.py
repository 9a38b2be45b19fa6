"""A figure that shows an animation at one time after the other, its background drawn once.

Matplotlib is imported only when a picture is made.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import FunicularError, near
from .animation import Animation, BodyShape, CableShape, Clip, Mark, Segment
from .placed import outline, placed_surface
from .plot import CLIP_COLOURS, LOAD, MARKERS, SEGMENTS, SIZES
from .projections import Directions, Projection, all_points, directions
from .surfaces import surface

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

SIZE, DOTS = (9.6, 5.4), 100
"""Of a picture in inches, and dots an inch."""
TURNED, RAISED = 0.55, 0.35
"""From where a spatial scene is seen: aside from its main view and above it, in rad."""
MARGIN = 0.07

Update = Callable[[int], None]
"""Moves an artist to a frame of its clip."""


class Film:
    """A figure that shows an animation at one time after the other."""

    def __init__(self, animation: Animation, clips: tuple[Clip, ...], colour: str | None, pace: float):
        """colour: the key of a quantity along cables that colours them; pace: said in the picture."""
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self.animation, self.clips, self.pace = animation, clips, pace
        self.canvas = FigureCanvasAgg(Figure(figsize=SIZE, dpi=DOTS))
        figure = self.canvas.figure
        seen = directions(animation)
        self.view = seen.front if seen.flat else oblique(seen)
        self.colour, self.scale = colour, _quantity_scale(clips, colour)
        self.axes: Axes = figure.add_axes((0.07, 0.1, 0.77 if colour else 0.9, 0.8))
        self.box = _corners(animation, seen)
        self._set_limits()
        if seen.flat:
            self.axes.set(xlabel=f"{self.view.names[0]} / m", ylabel=f"{self.view.names[1]} / m")
        else:
            self.axes.set_axis_off()
            self._draw_box(seen)
        if self.scale is not None:
            figure.colorbar(self.scale, cax=figure.add_axes((0.87, 0.15, 0.015, 0.7)), label=_label(clips, colour))
        self.said = figure.text(0.02, 0.94, "", fontsize=11, animated=True)
        title = f"{animation.title}, {clips[0].label}" if animation.arrangement == "menu" else animation.title
        figure.text(0.98, 0.94, title, fontsize=11, ha="right", color="0.35")
        self.moving: list[tuple[int, Artist, Update]] = []
        for number, clip in enumerate(clips):
            self._add(number, clip, CLIP_COLOURS[number % len(CLIP_COLOURS)])
        self.moving.sort(key=lambda each: each[1].get_zorder())

    def pictures(self, times: np.ndarray) -> Iterator[np.ndarray]:
        """Yield the pictures (height, width, 3) in bytes of the motion at these times."""
        self.canvas.draw()
        background = self.canvas.copy_from_bbox(self.canvas.figure.bbox)
        unit = self.animation.time_unit
        pace = f"   (played at {self.pace:.3g} times its speed)" * (unit == "s")
        for time in times:
            self.canvas.restore_region(background)
            frames = [frame_at(clip, float(time)) for clip in self.clips]
            for clip, artist, update in self.moving:
                update(frames[clip])
                self.axes.draw_artist(artist)
            self.said.set_text(f"{self.animation.time_label} {time:.4g} {unit}".rstrip() + pace)
            self.canvas.figure.draw_artist(self.said)
            yield np.asarray(self.canvas.buffer_rgba())[..., :3].copy()

    def _set_limits(self) -> None:
        """Take equal scales about the middle of all that is reached, bodies whole, in the shape of the axes."""
        places = [self.view.of(self.box)]
        for body in (body for clip in self.clips for body in clip.bodies):
            reach = np.linalg.norm(surface(body.shape)[0], axis=1).max()
            positions = self.view.of(body.position)
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
        """Draw the edges of the box that holds all places, with the lengths of three of them."""
        corners = self.box.reshape(2, 2, 2, 3)
        drawn = self.view.of(corners)
        for axis, name in enumerate(seen.names):
            for edge in np.moveaxis(drawn, axis, 0).reshape(2, 4, 2).swapaxes(0, 1):
                self.axes.plot(*edge.T, color="0.85", linewidth=0.8, zorder=0)
            first = np.moveaxis(drawn, axis, 0)[:, 0, 0]
            length = np.linalg.norm(np.diff(np.moveaxis(corners, axis, 0)[:, 0, 0], axis=0))
            self.axes.annotate(f"{name}: {length:.3g} m", first.mean(axis=0), fontsize=8, color="0.45", ha="center",
                               va="top")

    def _add(self, number: int, clip: Clip, colour: str) -> None:
        """Add the artists of a clip."""
        for cable in clip.cables:
            self._add_cable(number, cable, colour)
        for body in clip.bodies:
            self._add_body(number, body, colour)
        for segment in clip.segments:
            self._add_segment(number, segment)
        for mark in clip.marks:
            self._add_mark(number, mark)

    def _add_line(self, number: int, points: Callable[[int], np.ndarray], **look: Any) -> None:
        """Add a line through points (n, 3) of a frame."""
        from matplotlib.lines import Line2D

        artist = Line2D([], [], animated=True, **look)
        self.axes.add_line(artist)

        def update(frame: int) -> None:
            artist.set_data(*self.view.of(points(frame)).T)

        self.moving.append((number, artist, update))

    def _add_body(self, number: int, body: BodyShape, colour: str) -> None:
        from matplotlib.colors import to_rgb
        from matplotlib.patches import Polygon

        patch = Polygon(np.zeros((3, 2)), facecolor=(*to_rgb(colour), 0.35), edgecolor=colour, animated=True, zorder=3)
        self.axes.add_patch(patch)

        def path(frame: int) -> np.ndarray:
            return body.position[: frame + 1]

        def update(frame: int) -> None:
            patch.set_xy(outline(self.view.of(placed_surface(body, frame)[0])))

        self._add_line(number, path, color="0.6", linewidth=0.7, zorder=1)
        self.moving.append((number, patch, update))

    def _add_segment(self, number: int, segment: Segment) -> None:
        from matplotlib.patches import FancyArrowPatch

        def ends(frame: int) -> np.ndarray:
            return np.stack([at(segment.start, frame), at(segment.end, frame)])

        if segment.kind != "load":
            self._add_line(number, ends, color="0.3", zorder=4, **SEGMENTS[segment.kind])
            return
        arrow = FancyArrowPatch((0, 0), (1, 1), arrowstyle="-|>", mutation_scale=9, color=LOAD, animated=True,
                                shrinkA=0, shrinkB=0, zorder=4)
        self.axes.add_patch(arrow)

        def update(frame: int) -> None:
            start, end = self.view.of(ends(frame)).tolist()
            arrow.set_positions(tuple(start), tuple(end))

        self.moving.append((number, arrow, update))

    def _add_mark(self, number: int, mark: Mark) -> None:
        def place(frame: int) -> np.ndarray:
            return at(mark.position, frame)[None]

        self._add_line(number, place, marker=MARKERS[mark.kind], linestyle="", color="0.15", zorder=5,
                       markersize=np.sqrt(SIZES[mark.kind]))

    def _add_cable(self, number: int, cable: CableShape, colour: str) -> None:
        from matplotlib.collections import LineCollection

        quantity = next((q for q in cable.quantities if q.key == self.colour), None)
        artist = LineCollection([], linewidths=3, colors=colour, animated=True, zorder=2, capstyle="round")
        self.axes.add_collection(artist, autolim=False)

        def update(frame: int) -> None:
            points = self.view.of(cable.position[frame])
            artist.set_segments(list(np.stack([points[:-1], points[1:]], axis=1)))
            if quantity is not None and self.scale is not None:
                values = quantity.values[frame]
                artist.set_color(self.scale.to_rgba((values[:-1] + values[1:]) / 2))

        self.moving.append((number, artist, update))


def _corners(animation: Animation, seen: Directions) -> np.ndarray:
    """Return the corners (8, 3) of the box along the directions that holds all places."""
    places = all_points(animation) @ seen.matrix
    ends = np.stack([places.min(axis=0), places.max(axis=0)])
    return np.array([[x, y, z] for x in ends[:, 0] for y in ends[:, 1] for z in ends[:, 2]]) @ seen.matrix.T


def at(values: np.ndarray, frame: int) -> np.ndarray:
    """Return the value at a frame of what may stand still."""
    return values[frame if len(values) > 1 else 0]


def frame_at(clip: Clip, time: float) -> int:
    """Return the number of the frame of a clip nearest to a time; a periodic one begins anew."""
    if clip.periodic:
        return round(time / period(clip) * len(clip.time)) % len(clip.time)
    return int(np.argmin(np.abs(clip.time - time)))


def period(clip: Clip) -> float:
    """Return the period of a clip whose last frame joins the first."""
    return float(clip.time[-1] - clip.time[0]) * len(clip.time) / (len(clip.time) - 1)


def oblique(seen: Directions) -> Projection:
    """Return the view of a spatial scene from aside and above."""
    across = np.cos(TURNED) * seen.across + np.sin(TURNED) * seen.depth
    into = np.cross(seen.up, across)
    return Projection(across, np.cos(RAISED) * seen.up + np.sin(RAISED) * into, ("", ""))


def _quantity_scale(clips: tuple[Clip, ...], key: str | None) -> Any:
    """Return the colours of a quantity along cables, None where none is asked for. Raises FunicularError."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    if key is None:
        return None
    known = {q.key: None for clip in clips for cable in clip.cables for q in cable.quantities}
    if key not in known:
        raise FunicularError(f'cables have no quantity "{key}"; {near(key, known)}')
    values = np.concatenate([q.values.ravel() for clip in clips for cable in clip.cables for q in cable.quantities
                             if q.key == key])
    return ScalarMappable(Normalize(np.nanmin(values), np.nanmax(values)), "viridis")


def _label(clips: tuple[Clip, ...], key: str | None) -> str:
    quantity = next(q for clip in clips for cable in clip.cables for q in cable.quantities if q.key == key)
    return f"{quantity.label} / {quantity.unit}"
