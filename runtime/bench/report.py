"""The output of `funicular bench`: a table, a CSV file, and the picture of work against precision."""

from __future__ import annotations

import csv
import io
import math
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from rich import box
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from ..base.written_files import write_text, write_whole
from ..results.trajectories import unit
from ..view.files import folder_for_pictures
from ..view.plot import STYLE
from .bench import COUNTS, Bench, Row

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LINES, MARKERS = ("-", "--", ":", "-."), "osD^v"


def statements(result: Bench) -> list[str]:
    """Return the convergence of the references, a line each."""
    lines = []
    for mesh, reference in result.references.items():
        unresolved = sum(row.mesh == mesh and row.failed is None and not result.is_resolved(row) for row in result.rows)
        line = (f"reference on {mesh}: tol {' and '.join(f'{tol:.3g}' for tol in reference.tols)} agree to "
                f"{reference.agreement:.1e} of the motion")
        lines.append(line + (f"; {unresolved} of the rows come too near to it, they are marked <" if unresolved
                             else ", a tenth of any row's time error or less"))
    if result.finest is not None:
        errors = ", ".join(f"{mesh} to {reference.mesh_error:.1e}" for mesh, reference in result.references.items())
        lines.append(f"reference of all meshes: {result.finest.mesh}; with it agree {errors}")
    return lines


def print_table(result: Bench, console: Console) -> None:
    """Print the rows and the statements on a terminal."""
    table = Table(box=box.SIMPLE, padding=0, pad_edge=False)
    table.add_column("integrator", no_wrap=True)
    table.add_column("mesh", no_wrap=True)
    for heading in ("tol", "steps", "Newton", "set-up\nms", "CPU\ns", "time\nerror", "mesh\nerror", "both"):
        table.add_column(heading, justify="right", no_wrap=True)
    for row in result.rows:
        start = [row.integrator, str(row.mesh), f"{row.tol:.0e}"]
        if row.failed is not None:
            table.add_row(*start, "failed")
            continue
        counts = [str(row.counts.get(name, "")) for name in ("steps", "newton_iterations")]
        error = f"{'' if result.is_resolved(row) else '<'}{row.time_error:.1e}"
        table.add_row(*start, *counts, f"{1e3 * row.set_up_s:.1f}", f"{row.cpu_s:.2g}", error,
                      _number(result.references[row.mesh].mesh_error), _number(row.total_error))
    console.print(table)
    for line in [*statements(result), *failures(result)]:
        console.print(escape(line), soft_wrap=True, highlight=False)


def failures(result: Bench) -> list[str]:
    """Return the messages of failed combinations, a line each, for all tolerances with the same message."""
    failed: dict[tuple[str, str, str], list[str]] = {}
    for row in result.rows:
        if row.failed is not None:
            failed.setdefault((row.integrator, str(row.mesh), row.failed), []).append(f"{row.tol:g}")
    return [f"failed: {integrator} on {mesh}, tol {', '.join(tols)}: {why}" for (integrator, mesh, why), tols in
            failed.items()]


def _number(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.1e}"


def record(result: Bench, row: Row) -> dict[str, object]:
    """Return a row of the CSV file."""
    reference = result.references.get(row.mesh)
    errors = {f"time error {name} / {unit(result.scene, name)}": row.errors.get(name, "") for name in
              result.grid.outputs}
    return {
        "integrator": row.integrator, "mesh": str(row.mesh), "elements": row.elements or "", "tol": row.tol,
        "status": row.failed or "completed", "cpu_s": row.cpu_s, "set_up_s": row.set_up_s,
        **{name: row.counts.get(name, "") for name in COUNTS},
        "time_error": row.time_error, "reference_agreement": reference.agreement if reference else math.nan,
        "mesh_error": reference.mesh_error if reference else math.nan, "total_error": row.total_error, **errors,
    }


def save(result: Bench, directory: Path, name: str) -> list[Path]:
    """Write ``name``.csv and ``name``.png into the directory; returns the paths. Raises ResultFileError."""
    table, picture = directory / f"{name}.csv", directory / f"{name}.png"
    folder_for_pictures(directory)
    rows, text = [record(result, row) for row in result.rows], io.StringIO()
    writer = csv.DictWriter(text, rows[0])
    writer.writeheader()
    writer.writerows(rows)
    write_text(table, text.getvalue(), "the results")
    if not any(row.failed is None for row in result.rows):
        return [table]
    write_whole(picture, partial(draw, result), "the results")
    return [table, picture]


def draw(result: Bench, path: Path) -> None:
    """Write the picture of a result to a PNG file."""
    from matplotlib import rc_context  # takes 0.5 s
    from matplotlib.figure import Figure

    with rc_context(STYLE):
        figure = Figure(figsize=(7, 4.6))
        axes = figure.add_subplot()
        draw_on(axes, result)
        axes.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=2, fontsize=9)
        figure.savefig(path)


def draw_on(axes: Axes, result: Bench) -> None:
    """Draw the time error over CPU seconds, a colour an integrator and a line style a mesh, and the mesh errors."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter  # as above

    meshes = list(result.references)
    for colour, integrator in enumerate(result.grid.integrators):
        for mesh, line, marker in zip(meshes, LINES, MARKERS, strict=False):
            rows = [row for row in result.rows if (row.integrator, row.mesh, row.failed) == (integrator, mesh, None)]
            if rows:
                axes.loglog([row.cpu_s for row in rows], [row.time_error for row in rows], linestyle=line,
                            marker=marker, markersize=4.5, color=f"C{colour}",
                            label=f"{integrator}, {rows[0].elements} elements")
    for mesh, line in zip(meshes, LINES, strict=False):
        error = result.references[mesh].mesh_error
        if error > 0:
            axes.axhline(error, color="0.55", linewidth=0.9, linestyle=line, zorder=0)
            axes.annotate(f"mesh error, {mesh}", (1, error), xycoords=("axes fraction", "data"), ha="right",
                          va="bottom", fontsize=8, color="0.4")
    axes.margins(x=0.06)
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda seconds, _: f"{seconds:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel("CPU time of the integration / s")
    axes.set_ylabel("time error / largest motion")
