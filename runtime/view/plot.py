"""Pictures of an animation by Matplotlib, which is imported when a picture is made."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from .animation import Animation, BodyShape, Clip, at_frame
from .projections import Directions, Projection, all_points, directions
from .surfaces import outline, placed_surface, spoke, wave_lines

if TYPE_CHECKING:
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure
    from matplotlib.typing import RcKeyType

STYLE: dict[RcKeyType, Any] = {
    "font.size": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "0.9",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "axes.linewidth": 0.7,
    "axes.xmargin": 0,
    "lines.linewidth": 1.4,
    "legend.frameon": False,
    "figure.constrained_layout.use": True,
    "savefig.dpi": 160,
}
SNAPSHOTS = 11
"""Times in a picture of a motion."""
MAX_IN_LEGEND = 8
"""Bodies and slides in a legend."""
MARKERS = {"pin": "^", "clamp": "s", "tie": "P", "joint": "o", "slide": "o", "ground": "X", "point": "."}
SIZES = {"pin": 60, "clamp": 55, "tie": 40, "joint": 16, "slide": 26, "ground": 45, "point": 12}
SEGMENTS: dict[str, dict[str, Any]] = {
    "spring": {"linestyle": (0, (1, 1)), "linewidth": 1.6},
    "hanger": {"linestyle": "-", "linewidth": 0.8},
    "lever": {"linestyle": "-", "linewidth": 1.0},
    "joint": {"linestyle": (0, (5, 1)), "linewidth": 1.2},
}
LOAD_COLOUR = "#b3261e"
WAVE_LINES, MAX_CELLS = 9, 32
"""Of the surface of a fluid: lines each way in an oblique view, and cells along a side in perspective."""
ROUNDING = 1e-9
PANEL_HEIGHT = 0.45
"""Height of a flat picture over its width."""
MENU_CLIPS = 6
"""Clips of a menu in a picture."""
PATHS = ((0, (4, 2)), (0, (1, 1.2)), (0, (6, 1.5, 1, 1.5)), (0, (3, 1, 1, 1, 1, 1)))
"""Line styles of the paths of bodies, in turn."""
CLIP_COLOURS = ("#1f6f8b", "#c8553d", "#5b8e3e", "#7b5ea7", "#b08900")
"""Colours of several clips in one picture, in turn."""

Points = Callable[[np.ndarray], np.ndarray]
"""Projects points (..., 3) to the coordinates (..., 2 or 3) of axes."""


def shape_figure(animation: Animation, figure: Figure | None = None, every_view: bool = False) -> Figure:
    """Return a figure of cables and bodies at a few times, coloured by time; modes in a panel each.

    A scene in one plane is drawn in that plane; another one, or any with every_view, in perspective and from the front,
    the side and above. figure: a new one by default.
    """
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    seen = directions(animation)
    with rc_context(STYLE):
        figure = figure or Figure()
        if animation.arrangement == "menu":
            _draw_menu(animation, seen, figure)
        elif seen.flat and not every_view:
            figure.set_size_inches(8, 3.9)
            axes = figure.add_subplot()
            _draw_all(animation, [PlanePanel(axes, seen.front, stretch=_stretch(animation, seen))], figure)
        else:
            figure.set_size_inches(10, 7.2)
            grid = figure.add_gridspec(2, 2)
            panels: list[Panel] = [SpacePanel(figure.add_subplot(grid[0, 0], projection="3d"), seen)]
            panels += [PlanePanel(figure.add_subplot(grid[row, column]), projection, title)
                       for row, column, projection, title in ((0, 1, seen.side, "side"), (1, 0, seen.front, "front"),
                                                              (1, 1, seen.top, "from above"))]
            _draw_all(animation, panels, figure)
    return figure


def _stretch(animation: Animation, seen: Directions) -> float:
    """Return the round factor by which the vertical scale of a flat scene can be exaggerated, 1 for none."""
    width, height = np.ptp(seen.front.of(all_points(animation)), axis=0)
    if not width > 0:
        return 1.0
    limit = PANEL_HEIGHT * width / max(1.24 * height, 1e-3 * width)
    return max((f * 10.0**e for e in range(7) for f in (1, 2, 5) if f * 10**e <= limit), default=1.0)


class Panel:
    """Axes for the parts of a clip at some of its frames."""

    def __init__(self, axes: Any, points: Points):
        self.axes, self.points = axes, points

    def line(self, points: np.ndarray, **look: Any) -> None:
        """Draw a line through points (n, 3)."""
        self.axes.plot(*self.points(points).T, **look)

    def dots(self, points: np.ndarray, **look: Any) -> None:
        """Draw points (n, 3)."""
        self.axes.scatter(*self.points(points).T, **look)

    def arrow(self, start: np.ndarray, end: np.ndarray, label: str | None) -> None:
        """Draw an arrow from point to point (3,)."""
        self.line(np.stack([start, end]), color=LOAD_COLOUR, linewidth=1.2, zorder=3, label=label)

    def body(self, body: BodyShape, frame: int, time: float, colour: Any) -> None:
        """Draw the shape of a body at a frame and its time."""
        raise NotImplementedError

    def finish(self) -> None:
        """Set scales and labels after drawing."""
        raise NotImplementedError


class PlanePanel(Panel):
    """A projection on a plane."""

    def __init__(self, axes: Any, projection: Projection, title: str = "", stretch: float = 1.0):
        """stretch: of the vertical scale; bodies are dots then, since their shapes would be distorted."""
        super().__init__(axes, projection.of)
        self.projection, self.title, self.stretch = projection, title, stretch

    def arrow(self, start: np.ndarray, end: np.ndarray, label: str | None) -> None:
        """Draw an arrow with a head from point to point (3,)."""
        super().arrow(start, end, label)
        self.axes.annotate("", self.points(end), self.points(start), zorder=4,
                           arrowprops={"arrowstyle": "-|>", "color": LOAD_COLOUR, "shrinkA": 0, "shrinkB": 0})

    def body(self, body: BodyShape, frame: int, time: float, colour: Any) -> None:
        """Draw the outline of a body's shape, of a wheel with its wide spoke, or a dot; of water lines on its surface.
        """
        shape: Mapping[str, Any] = body.shape
        if shape["kind"] == "water" and (seen := self.projection.foreshortened(shape["up"])) > ROUNDING:
            edge_on = seen > 1 - ROUNDING
            for line in wave_lines(body, frame, time, 1 if edge_on else WAVE_LINES):
                self.line(line, color=(*colour[:3], 1.0 if edge_on else 0.4), linewidth=0.8, zorder=3)
            return
        if self.stretch > 1:
            self.dots(body.position[frame : frame + 1], color=colour, marker="h", s=48, edgecolors="0.1",
                      linewidths=0.7, zorder=4)
            return
        corners = outline(self.projection.of(placed_surface(body, frame, time)[0]))
        is_wheel = body.shape["kind"] == "wheel"
        self.axes.fill(*corners.T, facecolor=(*colour[:3], 0.0 if is_wheel else 0.25), edgecolor=colour, linewidth=0.8,
                       zorder=3)
        if is_wheel:
            self.line(spoke(body, frame), color=colour, linewidth=1.8, zorder=3)

    def finish(self) -> None:
        """Set equal scales, or a vertical one exaggerated by the factor in its label."""
        axes, stretch = self.axes, self.stretch
        axes.margins(0.04, 0.12)
        axes.set_aspect(stretch, adjustable="datalim")
        axes.set_xlabel(f"{self.projection.names[0]} / m")
        axes.set_ylabel(f"{self.projection.names[1]} / m" + (f"  (stretched {stretch:g} : 1)" if stretch > 1 else ""))
        if self.title:
            axes.set_title(self.title, fontsize=9, color="0.35", loc="left")


class SpacePanel(Panel):
    """A view in perspective."""

    def __init__(self, axes: Any, seen: Directions):
        super().__init__(axes, lambda points: points @ seen.matrix)
        self.names = seen.names

    def body(self, body: BodyShape, frame: int, time: float, colour: Any) -> None:
        """Draw the surface of a body's shape."""
        from mpl_toolkits.mplot3d.art3d import Poly3DCollection

        if body.shape["kind"] == "water":
            cells = [min(each, MAX_CELLS) for each in body.shape["cells"]]  # type: ignore[attr-defined]
            body = replace(body, shape={**body.shape, "cells": cells})
        vertices, triangles = placed_surface(body, frame, time)
        self.axes.add_collection3d(Poly3DCollection(self.points(vertices)[triangles], facecolors=(*colour[:3], 0.35),
                                                    edgecolors="none"))

    def finish(self) -> None:
        """Set equal scales about the middle of the picture."""
        from matplotlib.ticker import MaxNLocator

        axes = self.axes
        limits = np.array([axes.get_xlim(), axes.get_ylim(), axes.get_zlim()])
        span = np.maximum(np.ptp(limits, axis=1), 0.2 * np.ptp(limits, axis=1).max())
        for middle, size, set_limits in zip(limits.mean(axis=1), span,
                                            (axes.set_xlim, axes.set_ylim, axes.set_zlim), strict=True):
            set_limits(middle - size / 2, middle + size / 2)
        axes.set_box_aspect(span, zoom=1.05)
        axes.view_init(elev=22, azim=-60)
        for axis, size in zip((axes.xaxis, axes.yaxis, axes.zaxis), span, strict=True):
            axis.set_major_locator(MaxNLocator(max(2, round(6 * size / span.max()))))
            axis.labelpad = 2 + 6 * size / span.max()
        axes.tick_params(labelsize=8, pad=1)
        for set_label, name in zip((axes.set_xlabel, axes.set_ylabel, axes.set_zlabel), self.names, strict=True):
            set_label(f"{name} / m")


def snapshots(frames: int) -> np.ndarray:
    """Return the numbers of the few frames in a picture, out of so many."""
    return np.unique(np.linspace(0, frames - 1, SNAPSHOTS).round().astype(int))


def colour_scale(values: np.ndarray) -> ScalarMappable:
    """Return the colours of values from the smallest to the largest."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    low, high = np.nanmin(values), np.nanmax(values)
    return ScalarMappable(Normalize(low, max(high, low + 1e-9)), "viridis")


def _draw_all(animation: Animation, panels: list[Panel], figure: Figure) -> None:
    """Draw all clips on all panels, with a legend and a colour bar of the times."""
    from matplotlib.colors import to_rgba

    several, moves = len(animation.clips) > 1, max(len(clip.time) for clip in animation.clips) > 1
    colour = colour_scale(np.concatenate([clip.time for clip in animation.clips]))
    for panel in panels:
        for number, clip in enumerate(animation.clips):
            frames = snapshots(len(clip.time))
            if several:
                colours: list[Any] = [to_rgba(CLIP_COLOURS[number % len(CLIP_COLOURS)])] * len(frames)
            else:
                colours = [tuple(colour.to_rgba(time)) if moves else to_rgba("#1f6f8b") for time in clip.time[frames]]
            draw_clip(panel, clip, frames, colours, clip.label if several else None)
        panel.finish()
    handles, labels = panels[0].axes.get_legend_handles_labels()
    once = dict(zip(labels, handles, strict=True))
    if once:
        figure.legend(once.values(), once.keys(), loc="outside upper center", ncols=min(len(once), 4), fontsize=9)
    if moves and not several:
        unit = f" / {animation.time_unit}" if animation.time_unit else ""
        figure.colorbar(colour, ax=[panel.axes for panel in panels], label=f"{animation.time_label}{unit}", pad=0.02,
                        fraction=0.04)


def _draw_menu(animation: Animation, seen: Directions, figure: Figure) -> None:
    """Draw each clip in its panel: at its first frame, half a period later, and at rest."""
    from matplotlib.colors import to_rgba

    clips = animation.clips[:MENU_CLIPS]
    rows = -(-len(clips) // 2)
    figure.set_size_inches(9, 2.6 * rows + 0.4)
    for number, clip in enumerate(clips, start=1):
        axes = figure.add_subplot(rows, min(2, len(clips)), number, **({} if seen.flat else {"projection": "3d"}))
        panel = PlanePanel(axes, seen.front) if seen.flat else SpacePanel(axes, seen)
        for cable in clip.cables:
            panel.line(cable.reference, color="0.6", linewidth=0.8, linestyle=(0, (4, 2)))
        frames = np.array([0, len(clip.time) // 2])
        draw_clip(panel, clip, frames, [to_rgba("#1f6f8b"), (*to_rgba("#1f6f8b")[:3], 0.3)], None, named=False)
        panel.finish()
        axes.set_title(clip.label, fontsize=9)


def draw_clip(panel: Panel, clip: Clip, frames: np.ndarray, colours: list[Any], label: str | None,
              named: bool = True) -> None:
    """Draw a clip at some of its frames, each in its colour; label: of the clip; named: with parts in the legend."""
    for cable in clip.cables:
        for frame, colour in zip(frames, colours, strict=True):
            panel.line(cable.position[frame], color=colour, label=label, zorder=2)
            label = None
    for number, body in enumerate(clip.bodies):
        called = body.name if named and number < MAX_IN_LEGEND else None
        still = "sheet" in body.shape
        if len(frames) > 2 and not still and body.shape["kind"] != "wheel":  # which is held
            panel.line(body.position, color="0.25", linewidth=0.9, linestyle=PATHS[number % len(PATHS)], zorder=3,
                       label=called and f"path of {called}")
        for frame, colour in list(zip(frames, colours, strict=True))[-1 if still else 0 :]:
            panel.body(body, frame, float(clip.time[frame]), colour)  # sheets of all times would hide the picture
    for name, segment in _named_once(clip.segments):
        label = name if named else None
        if segment.kind == "load":  # arrows of all times would hide the picture
            panel.arrow(at_frame(segment.start, frames[-1]), at_frame(segment.end, frames[-1]), label)
            continue
        for frame, colour in zip(frames, colours, strict=True):
            panel.line(np.stack([at_frame(segment.start, frame), at_frame(segment.end, frame)]), color=colour,
                       zorder=3, label=label, **SEGMENTS[segment.kind])
            label = None
    for name, mark in _named_once(clip.marks):
        rides = mark.kind in ("slide", "joint", "point", "tie")
        positions = mark.position[frames] if len(mark.position) > 1 else mark.position
        panel.dots(positions, marker=MARKERS[mark.kind], s=SIZES[mark.kind], zorder=5,
                   c=colours if rides and len(positions) == len(colours) else ["0.1"] * len(positions),
                   edgecolors="0.1", linewidths=0.7, label=name if named else None)


def _named_once(parts: tuple[Any, ...]) -> Iterator[tuple[str | None, Any]]:
    """Yield parts with their labels in a legend: slides by name, others by kind, each label once."""
    known: set[str] = set()
    for part in parts:
        name = f"slide {part.name}" if part.kind == "slide" else "lever arm" if part.kind == "lever" else part.kind
        if part.kind in ("pin", "clamp") and len(part.position) > 1:
            name = f"moved {name}"
        yield (None if name in known or len(known) > MAX_IN_LEGEND else name), part
        known.add(name)
