"""Pictures of a run, as PNG files. Matplotlib is imported only here, and only when pictures are made."""

from __future__ import annotations

import os
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..errors import ResultFileError, shown_path
from ..parts.attachment import Attachment
from ..parts.modal_body import ModalBody
from ..parts.scene_data import SceneData
from ..results.quantities import ENERGIES
from ..results.run import Run
from ..results.section_forces import even, jumps, of_run, with_sides
from ..rotations import rotate

if TYPE_CHECKING:
    from matplotlib.axes import Axes
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
POINTS_PER_ELEMENT = 24


class View(NamedTuple):
    """The plane that is looked at: unit vectors across and up (3,), and their names."""

    across: np.ndarray
    up: np.ndarray
    names: tuple[str, str]


def save_plots(run: Run, directory: str | os.PathLike, prefix: str = "", forces: bool = False) -> list[Path]:
    """Draw what the run holds: shape, acceleration, slide, energy; if asked for, the forces in each cable.

    The files are ``directory/<prefix><picture>.png``; pictures without anything to show are left out.
    Returns their paths. Raises ResultFileError.
    """
    from matplotlib import rc_context

    drawers = {"shape": draw_shape, "acceleration": draw_acceleration, "slide": draw_slide, "energy": draw_energy}
    if forces:
        drawers |= {f"forces-{name}": partial(draw_section_forces, cable=name) for name in run.scene.cables}
    directory, written = Path(directory), []
    if "\0" in os.fspath(directory):
        raise ResultFileError(f"{shown_path(directory)}: the pictures cannot be written here: this is no path")
    try:
        directory.mkdir(parents=True, exist_ok=True)
        for name, draw in drawers.items():
            with rc_context(STYLE):
                figure = draw(run)
                if figure is not None:
                    written.append(directory / f"{prefix}{name}.png")
                    figure.savefig(written[-1])
    except OSError as error:
        where = shown_path(directory)
        raise ResultFileError(f"{where}: the pictures cannot be written here: {error.strerror}") from error
    return written


def view_of(scene: SceneData) -> View:
    """Return the vertical plane of the first cable; y is up without gravity."""
    gravity = np.array(scene.gravity)
    up = -gravity / np.linalg.norm(gravity) if gravity.any() else np.array([0.0, 1.0, 0.0])
    candidates = [cable.point(cable.length) - cable.point(0.0) for cable in scene.cables.values()]
    candidates += list(np.eye(3))  # for vertical cables and for none
    level = [c - np.dot(c, up) * up for c in candidates]
    across = next(v for v, c in zip(level, candidates, strict=True)
                  if np.linalg.norm(v) > 1e-6 * np.linalg.norm(c))  # not those of rings, whose ends meet
    across = across / np.linalg.norm(across)
    return View(across, up, (_axis_name(across), _axis_name(up)))


def _axis_name(direction: np.ndarray) -> str:
    for name, axis in zip("xyz", np.eye(3), strict=True):
        if np.allclose(direction, axis):
            return name
    return "({:.3g}, {:.3g}, {:.3g})".format(*direction)


def centreline(nodal_vectors: np.ndarray, node_s: np.ndarray) -> np.ndarray:
    """Return the points (..., points, 3) of the centreline, cubic between nodes.

    nodal_vectors: (..., nodes, vectors, 3) with r and r_x first; node_s: (nodes,) in m.
    """
    r, slope = nodal_vectors[..., 0, :], nodal_vectors[..., 1, :]
    length = np.diff(node_s)[:, None, None]
    t = np.linspace(0, 1, POINTS_PER_ELEMENT, endpoint=False)[:, None]
    points = (
        (1 + 2 * t) * (1 - t) ** 2 * r[..., :-1, None, :]
        + t * (1 - t) ** 2 * length * slope[..., :-1, None, :]
        + t**2 * (3 - 2 * t) * r[..., 1:, None, :]
        - t**2 * (1 - t) * length * slope[..., 1:, None, :]
    )
    inner = points.reshape(*points.shape[:-3], -1, 3)
    return np.concatenate([inner, r[..., -1:, :]], axis=-2)


def rider_path(run: Run, slide: str) -> np.ndarray:
    """Return (time, 3): where the rider's point of ``slide`` was, in m."""
    return attachment_path(run, run.scene.slides[slide].rider)


def attachment_path(run: Run, attachment: Attachment) -> np.ndarray:
    """Return (time, 3): where an attachment was, in m."""
    if attachment.on is None:
        return np.broadcast_to(attachment.point, (len(run.time), 3))
    body = run.scene.bodies.get(attachment.on)
    if isinstance(body, ModalBody):
        node = np.argmin(np.linalg.norm(body.shape.nodes - attachment.point, axis=1))
        return run[f"{attachment.on}.nodes"][:, node]
    if body is not None:
        return run[f"{attachment.on}.position"] + rotate(run[f"{attachment.on}.orientation"], attachment.point)
    points = centreline(run[f"{attachment.on}.nodal_vectors"], run.coords[f"{attachment.on}.node"].values)
    return points[:, round(attachment.arc_length / run.scene.cables[attachment.on].length * (points.shape[1] - 1))]


def attached_points(run: Run) -> dict[str, np.ndarray]:
    """Return (time, points, 3) by body: where slides and joints are attached, of those that are attached at more than
    one point.
    """
    paths_of: dict[str, list] = {}
    ends = [slide.rider for slide in run.scene.slides.values()]
    ends += [end for joint in run.scene.joints.values() for end in (joint.a, joint.b)]
    for end in ends:
        if end.on in run.scene.bodies:
            paths_of.setdefault(end.on, []).append(attachment_path(run, end))
    return {name: np.stack(paths, axis=1) for name, paths in paths_of.items() if len(paths) > 1}


def _snapshots(run: Run) -> tuple[np.ndarray, ScalarMappable]:
    """Return the numbers of the few times that are drawn, and the colours of times."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    shown = np.unique(np.linspace(0, len(run.time) - 1, SNAPSHOTS).round().astype(int))
    return shown, ScalarMappable(Normalize(run.time[0], max(run.time[-1], run.time[0] + 1e-9)), "viridis")


def draw_shape(run: Run) -> Figure | None:
    """Return the cables at a few times, coloured by time, with the riders and their paths; None without cables."""
    from matplotlib.figure import Figure

    scene = run.scene
    if not scene.cables:
        return None
    view = view_of(scene)
    plane = np.array([view.across, view.up])
    shown, colour = _snapshots(run)
    figure = Figure(figsize=(8, 3.6))
    axes = figure.add_subplot()
    for name in scene.cables:
        shapes = centreline(run[f"{name}.nodal_vectors"][shown], run.coords[f"{name}.node"].values) @ plane.T
        for index, shape in zip(shown, shapes, strict=True):
            axes.plot(*shape.T, color=colour.to_rgba(run.time[index]), zorder=2)
    for points in attached_points(run).values():
        for index in shown:
            axes.plot(*(points[index] @ plane.T).T, color=colour.to_rgba(run.time[index]), linewidth=2.2, zorder=2)
    for number, name in enumerate(scene.slides):
        path = rider_path(run, name) @ plane.T
        axes.plot(
            *path.T,
            color="0.25",
            linewidth=0.9,
            linestyle=(0, (4, 2)),
            zorder=3,
            label=None if number else "path of the rider",
        )
        axes.scatter(
            path[shown, 0],
            path[shown, 1],
            c=colour.to_rgba(run.time[shown]),
            s=42,
            edgecolors="0.1",
            linewidths=0.8,
            zorder=4,
            label=None if number else "rider",
        )
    riding = {slide.body for slide in scene.slides.values()}
    for number, name in enumerate(name for name in scene.bodies if name not in riding):
        path = run[f"{name}.position"] @ plane.T
        axes.plot(*path.T, color="0.25", linewidth=0.9, linestyle=":", zorder=3)
        axes.scatter(path[shown, 0], path[shown, 1], c=colour.to_rgba(run.time[shown]), marker="h", s=48,
                     edgecolors="0.1", linewidths=0.8, zorder=4, label=None if number else "body")
    for marker, label, supports in (("^", "pin", scene.pins), ("s", "clamp", scene.clamps),
                                    ("D", "moved", scene.motions)):
        if supports:
            at = np.array([scene.cables[support.cable].point(support.s) for support in supports]) @ plane.T
            axes.scatter(at[:, 0], at[:, 1], marker=marker, s=60, color="0.1", zorder=5, label=label)
    _set_scales(axes, view)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3)
    figure.colorbar(colour, ax=axes, label="time / s", pad=0.02, fraction=0.04)
    return figure


def _set_scales(axes: Axes, view: View) -> None:
    """Set equal scales, or exaggerate the upright one by a round factor that its label states."""
    axes.margins(0.04, 0.12)
    width, height = np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim())
    most = 0.42 * width / height  # the height of a picture that the page can take, over its width
    exaggeration = max((f * 10**e for e in range(-1, 7) for f in (1, 2, 5) if f * 10**e <= most), default=0.1)
    exaggeration = max(exaggeration, 1)
    axes.set_aspect(exaggeration, adjustable="datalim")
    note = f"  (stretched {exaggeration:g} : 1)" if exaggeration > 1 else ""
    axes.set_xlabel(f"{view.names[0]} / m")
    axes.set_ylabel(f"{view.names[1]} / m{note}")


def draw_acceleration(run: Run) -> Figure | None:
    """Return the bodies' accelerations upwards over time, the paper's Fig. 5; None without a slide or a body."""
    from matplotlib.figure import Figure

    bodies = list(run.scene.bodies)
    if not (bodies and run.scene.slides):
        return None
    view = view_of(run.scene)
    marker = "." if len(run.time) <= 200 else ""  # a coarse output should look like one
    figure = Figure(figsize=(7, 3.4))
    axes = figure.add_subplot()
    for body in bodies:
        axes.plot(run.time, run[f"{body}.acceleration"] @ view.up, marker=marker, markersize=4, label=f"body {body}")
    axes.set_xlabel("time / s")
    axes.set_ylabel(f"{view.names[1]}-acceleration / (m/s²)")
    axes.legend(loc="best")
    return figure


def draw_slide(run: Run) -> Figure | None:
    """Draw place and speed of the riders along their cables over time; None without a slide."""
    from matplotlib.figure import Figure

    slides = run.scene.slides
    if not slides:
        return None
    figure = Figure(figsize=(7, 4.6))
    place, speed = figure.subplots(2, sharex=True)
    nodes = np.unique(np.concatenate([run.coords[f"{slide.along}.node"].values for slide in slides.values()]))
    for s in nodes:
        place.axhline(s, color="0.6", linewidth=0.7, linestyle=":")
    place.plot([], [], color="0.6", linewidth=0.7, linestyle=":", label="nodes of the cable")
    for name in slides:
        place.plot(run.time, run[f"{name}.s"], label=f"slide {name}")
        speed.plot(run.time, run[f"{name}.s_rate"])
    place.grid(axis="y", visible=False)
    place.set_ylabel("arc-length s / m")
    place.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)
    speed.set_ylabel("s rate / (m/s)")
    speed.set_xlabel("time / s")
    return figure


def draw_section_forces(run: Run, cable: str) -> Figure:
    """Draw tension and size of the moment along a cable, at a few times, coloured by time, on both sides of jumps."""
    from matplotlib.figure import Figure

    described, (shown, colour) = run.scene.cables[cable], _snapshots(run)
    fixed = jumps(run.scene, cable)
    riders = [run[f"{name}.s"][shown] for name, slide in run.scene.slides.items() if slide.along == cable]
    places = np.concatenate([np.broadcast_to(fixed, (len(shown), len(fixed))), *(s[:, None] for s in riders)], axis=1)
    s = with_sides(described, even(described), places)
    forces = of_run(run, cable, s, shown)
    figure = Figure(figsize=(7, 4.8))
    tension, moment = figure.subplots(2, sharex=True)
    for k, time in enumerate(run.time[shown]):
        tension.plot(s[k], forces["tension"][k], color=colour.to_rgba(time))
        moment.plot(s[k], np.linalg.norm(forces["moment"][k], axis=-1), color=colour.to_rgba(time))
    tension.set_ylabel("tension / N")
    moment.set_ylabel("moment / (N m)")
    moment.set_xlabel(f"arc-length s of {cable} / m")
    figure.colorbar(colour, ax=[tension, moment], label="time / s", pad=0.02, fraction=0.04)
    return figure


def draw_energy(run: Run) -> Figure:
    """Return the changes of the energies since the start, and how well they cancel."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7, 4.8))
    changes, error = figure.subplots(2, sharex=True, height_ratios=(2.2, 1))
    for name in (name for name in ENERGIES if f"energy.{name}" in run):
        energy = run[f"energy.{name}"]
        if name in ("kinetic", "elastic", "potential") or energy.any():
            changes.plot(run.time, energy - energy[0], label=name)
    changes.axhline(0, color="0.4", linewidth=0.7)
    changes.set_ylabel("change of energy / J")
    changes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)
    error.plot(run.time, run.energy_balance().relative, color="0.2")
    error.axhline(0, color="0.4", linewidth=0.7)
    error.set_ylabel("sum of changes /\nenergy exchanged")
    error.ticklabel_format(axis="y", style="sci", scilimits=(-2, 2), useMathText=True)
    error.set_xlabel("time / s")
    return figure
