"""The command line. The modules of a command are imported when it is called, so that all commands start quickly."""

from __future__ import annotations

import json
import os
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TextIO

import typer

from ..base.written_files import write_text
from ..errors import ConvergenceError, EndOfCableError, FunicularError, FunicularWarning, RopeLeftError
from ..scene.file import bundled_scenes, load_scene
from .start import EXIT_INTERRUPTED, INTERRUPTED, raise_at_ctrl_c

if TYPE_CHECKING:
    from ..results.run import Run


class _Commands(typer.core.TyperGroup):
    """All commands; errors and warnings of funicular are a line on stderr each, and an error ends a command with 1."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command of the context."""
        def tell(message: Warning | str, category: type[Warning], filename: str, lineno: int,
                 file: TextIO | None = None, line: str | None = None) -> None:
            if not issubclass(category, FunicularWarning):
                return show(message, category, filename, lineno, file, line)
            print(f"note: {message}", file=sys.stderr)

        code = 1
        with warnings.catch_warnings():
            warnings.simplefilter("always", FunicularWarning)
            show, warnings.showwarning = warnings.showwarning, tell
            try:
                raise_at_ctrl_c()
                return super().invoke(ctx)
            except FunicularError as error:
                text = f"error: {error}"
            except MemoryError:
                text = "error: that takes more memory than this machine has"
            except KeyboardInterrupt:
                text, code = INTERRUPTED, EXIT_INTERRUPTED
        print(text, file=sys.stderr)
        raise typer.Exit(code)


app = typer.Typer(cls=_Commands, no_args_is_help=True, pretty_exceptions_enable=False)

Libraries = Annotated[list[Path] | None, typer.Option(
    "--library", metavar="DIR", help="your own elements that the scene may load, machine code; repeatable")]


def _bundled(incomplete: str) -> list[str]:
    """Return names of bundled scenes with this beginning, for completion; without any, the shell completes paths."""
    return [name for name in bundled_scenes() if name.startswith(incomplete)]


SceneName = Annotated[str, typer.Argument(metavar="SCENE", help="a scene file, or the name of a bundled scene",
                                          autocompletion=_bundled)]
Duration = Annotated[float | None, typer.Option(help="s, instead of the scene's")]
Tolerance = Annotated[float | None, typer.Option(help="error aimed at, instead of the scene's")]
Integrator = Annotated[str | None, typer.Option(help="instead of the scene's")]
Names = Annotated[list[str] | None, typer.Argument(metavar="[NAME]...", help="only these; all if none is given")]


def _print_version(wanted: bool) -> None:
    """Print name and version, and end the command."""
    if wanted:
        from funicular import __version__

        print(f"funicular {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[bool, typer.Option("--version", callback=_print_version, is_eager=True,
                                          help="print the version and exit")] = False,
) -> None:
    """Very flexible cables and whatever slides along them."""


@app.command()
def run(
    scene: SceneName,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="netCDF file to write (default: SCENE.nc, here)")
                      ] = None,
    plot: Annotated[bool, typer.Option("--plot", help="draw pictures next to the netCDF file")] = False,
    plot_dir: Annotated[Path | None, typer.Option(help="draw pictures in this directory")] = None,
    forces: Annotated[bool, typer.Option("--forces", help="draw tension and moment along the cables, too")] = False,
    duration: Duration = None,
    tol: Tolerance = None,
    absolute_tol: Annotated[float | None, typer.Option(help="error allowed beside it, m")] = None,
    quantities: Annotated[str | None, typer.Option(help="results that alone count in the error, such as "
                                                   "A.position,trolley.s")] = None,
    step: Annotated[float | None, typer.Option(help="fixed step in s, instead of the scene's")] = None,
    integrator: Integrator = None,
    spectral_radius: Annotated[float | None, typer.Option(help="of genalpha and energy, instead of the scene's: 1 "
                                                          "keeps all vibrations")] = None,
    model: Annotated[str | None, typer.Option(help="auto: choose elements that the scene leaves out, for tol")] = None,
    resume: Annotated[bool, typer.Option("--resume", help="continue a run that was killed or interrupted")] = False,
    estimate: Annotated[bool, typer.Option("--estimate", help="estimate the errors of steps and mesh, by two more runs")
                        ] = False,
    library: Libraries = None,
) -> None:
    """Simulate a scene and write its results during the run.

    When the run stops early, the file has the results so far, and --resume continues from there. Exit code: 1 for an
    error, 130 after Ctrl-C.
    """
    from ..parts.file_paths import save_path
    from ..results.files import check_writable

    described = load_scene(scene, library or ())
    named = save_path(described.run_settings) if output is None else output
    path = named or Path(f"{Path(scene).stem}.nc")
    pictures = plot_dir or (path.parent if plot or forces else None)
    if pictures is not None:
        check_writable(_existing(pictures) / "picture.png")
    stopped = None
    try:
        result = described.run(duration, tol=tol, absolute_tol=absolute_tol, quantities=_listed(quantities),
                               step=step, integrator=integrator, spectral_radius=spectral_radius, model=model,
                               save=path if named is None else output, resume=resume, estimate=estimate or None)
    except (EndOfCableError, RopeLeftError, ConvergenceError) as error:
        result, stopped = error.run, error
    _report(result, path, pictures, forces)
    if stopped is not None:
        raise stopped
    if result.status == "interrupted":
        raise typer.Exit(EXIT_INTERRUPTED)


@app.command()
def choose(
    scene: SceneName,
    tol: Annotated[float | None, typer.Option(help="error of model, mesh and time, instead of the scene's")] = None,
    duration: Duration = None,
    quantities: Annotated[str | None, typer.Option(help="results that count, such as A.position,trolley.force "
                                                   "(default: the motion)")] = None,
    free: Annotated[str, typer.Option(help="unset: choose what the scene leaves out; all: choose all")] = "unset",
    unequal: Annotated[bool, typer.Option("--unequal", help="try elements of unequal lengths, too")] = False,
    output: Annotated[Path | None, typer.Option("-o", "--output", metavar="FILE.toml",
                                                help="scene file to write, with the chosen models")] = None,
    library: Libraries = None,
) -> None:
    """Choose element, law and mesh of each cable, and the integrator, for a tolerance, and say why."""
    described = load_scene(scene, library or ())
    chosen = described.choose(tol, duration=duration, quantities=_listed(quantities) or (), free=free, unequal=unequal)
    print(chosen)
    if output is not None:
        write_text(output, chosen.scene.to_toml())
        print(f"written: {output}")


def _existing(directory: Path) -> Path:
    """Return the nearest existing directory of a path; the others are created when they are needed."""
    return next((d for d in (directory, *directory.parents) if os.path.exists(d)), directory)


def _report(run: Run, path: Path, pictures: Path | None, forces: bool) -> None:
    from rich import box
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    rows = run.summary_rows()
    if len(run.time):
        rows.append(("results", str(path)))
    if pictures is not None and len(run.time):
        written = run.save_plots(pictures, f"{path.stem}-", forces)
        rows.append(("pictures", "\n".join(map(str, written))))
    table = Table(box=box.SIMPLE, show_header=False)
    table.add_column(style="bold")
    table.add_column(overflow="fold")
    for heading, text in rows:
        table.add_row(heading, escape(text))
    Console().print(table)


@app.command()
def view(
    files: Annotated[list[str], typer.Argument(metavar="FILE...", autocompletion=_bundled, help=
                                               "results of runs (.nc), drawn over each other, or a scene")],
    output: Annotated[Path | None, typer.Option("-o", "--output", help="page to write (default: FILE.html, here)")
                      ] = None,
    open_it: Annotated[bool, typer.Option("--open", help="open the page in the browser")] = False,
    equilibrium: Annotated[bool, typer.Option("--equilibrium", help="of a scene, its state of rest")] = False,
    relaxed: Annotated[bool, typer.Option("--relaxed", help="of a scene, where a damped motion comes to rest")] = False,
    path: Annotated[bool, typer.Option("--path", help="of a scene, the load path to its state of rest")] = False,
    modes: Annotated[int | None, typer.Option(help="of a scene, number of modes; about its rest with --equilibrium")
                     ] = None,
    as_drawn: Annotated[bool, typer.Option("--as-drawn", help="of --modes, also where forces do not balance as drawn")
                        ] = False,
    png: Annotated[Path | None, typer.Option(help="a picture with several views, instead of the page")] = None,
    gif: Annotated[Path | None, typer.Option(help="a film, instead of the page")] = None,
    mp4: Annotated[Path | None, typer.Option(help="a film, instead of the page")] = None,
    vtk: Annotated[Path | None, typer.Option(metavar="DIR", help="files for ParaView, instead of the page")] = None,
    speed: Annotated[float | None, typer.Option(help="of films: how many times as fast as the motion")] = None,
    colour: Annotated[str | None, typer.Option(help="of films: a quantity along cables, such as tension")] = None,
    library: Libraries = None,
) -> None:
    """Show runs, or a scene as drawn, at rest or in its modes, as a page for a browser or as other pictures."""
    from .view import Outputs, Wanted
    from .view import view as write

    outputs = Outputs(output, png, [film for film in (gif, mp4) if film], vtk, speed, colour)
    written = write(files, Wanted(equilibrium, relaxed, path, modes, as_drawn), outputs, open_it, library or ())
    for file in written:
        print(f"written: {file}")


@app.command()
def sweep(
    scene: SceneName,
    values: Annotated[list[str], typer.Option("--set", metavar="PATH=VALUES", help="a parameter such as "
                      "wire.material.youngs_modulus, A.velocity.x or run.tol, and its values: 1,2,3 or "
                      "first:last:number, with :log for equal ratios; to draw samples low:high or low:high:log; "
                      "repeatable")],
    keep: Annotated[list[str], typer.Option(help="results with commas between, such as A.position,trolley.force.y; "
                                            "repeatable")],
    output: Annotated[Path | None, typer.Option("-o", "--output", help="netCDF file to write (default: SCENE-sweep.nc, "
                                                "here)")] = None,
    method: Annotated[str, typer.Option(help="grid: all combinations; list: the first values of all, the second ones, "
                                        "...; random, latin: samples")] = "grid",
    samples: Annotated[int | None, typer.Option(help="how many are drawn")] = None,
    seed: Annotated[int, typer.Option(help="of the generator that draws them")] = 0,
    workers: Annotated[int | None, typer.Option(help="processes (default: one for each processor)")] = None,
    serial: Annotated[bool, typer.Option("--serial", help="compute in this process alone, without Dask")] = False,
    cluster: Annotated[str | None, typer.Option(metavar="ADDRESS", help="of a Dask scheduler, such as "
                                                "tcp://127.0.0.1:8786, whose workers are taken")] = None,
    batch: Annotated[int | None, typer.Option(help="points that a worker gets at once (default: by time)")] = None,
    estimate: Annotated[bool, typer.Option("--estimate", help="only estimate the cost, from a sample")] = False,
    record_invalid: Annotated[bool, typer.Option("--record-invalid", help="record scenes that cannot be simulated as "
                                                 "failed, and do not refuse the sweep")] = False,
    retry_failed: Annotated[bool, typer.Option("--retry-failed", help="compute failed points again")] = False,
    duration: Duration = None,
    tol: Tolerance = None,
    output_step: Annotated[float | None, typer.Option(help="s, instead of the scene's")] = None,
    integrator: Integrator = None,
    library: Libraries = None,
) -> None:
    """Run a scene at many values of its parameters, into one file.

    The same command resumes a stopped sweep. Exit code: 1 for an error, 130 after Ctrl-C.
    """
    from .sweep import run_sweep

    given = {"duration": duration, "tol": tol, "output_step": output_step, "integrator": integrator}
    options = {"keep": _listed(",".join(keep)), "method": method, "samples": samples, "seed": seed,
               "workers": 0 if serial else workers, "record_invalid": record_invalid,
               **{name: value for name, value in given.items() if value is not None}}
    if not run_sweep(scene, values, output or Path(f"{Path(scene).stem}-sweep.nc"), library or [], estimate, options,
                     cluster=cluster, batch=batch, retry_failed=retry_failed):
        raise typer.Exit(EXIT_INTERRUPTED)


@app.command()
def bench(
    scene: SceneName,
    integrators: Annotated[str | None, typer.Option(help="names with commas between (default: all)")] = None,
    tols: Annotated[str, typer.Option(help="tolerances")] = "1e-2,1e-3,1e-4,1e-5",
    elements: Annotated[str, typer.Option(help="meshes: x2 is twice the scene's elements, 24 is 24 a cable")] = "x1,x2",
    outputs: Annotated[str | None, typer.Option(help="compared results, such as A.position,trolley.s,wire.tip,"
                                                "wire@0.5 (default: bodies, slides, a point of each cable)")] = None,
    duration: Duration = None,
    output_step: Annotated[float | None, typer.Option(help="s (default: a fiftieth of the duration)")] = None,
    repetitions: Annotated[int, typer.Option(help="of each run below 1 s, in turns; times are medians")] = 5,
    out: Annotated[Path, typer.Option(metavar="DIR", help="where SCENE-bench.csv and .png are written")] = Path(),
    library: Libraries = None,
) -> None:
    """Measure error against time over integrators, tolerances and meshes.

    The reference is computed, too, and its own error is reported, as are combinations that fail.
    """
    from rich.console import Console

    from ..bench.bench import bench, grid
    from ..bench.report import print_table, save
    from ..results.files import check_writable

    described, name = load_scene(scene, library or ()), f"{Path(scene).stem}-bench"
    try:
        numbers = [float(word) for word in _listed(tols) or ()]
    except ValueError as error:
        raise typer.BadParameter(f"--tols: {error}") from None
    tried = grid(described, integrators=_listed(integrators), tols=numbers, elements=_listed(elements),
                 outputs=_listed(outputs), duration=duration, output_step=output_step, repetitions=repetitions)
    check_writable(_existing(out) / f"{name}.csv")
    with Console(stderr=True).status("") as status:
        result = bench(described, tried, status.update)
    print_table(result, Console())
    for path in save(result, out, name):
        print(f"written: {path}")


def _listed(text: str | None) -> list[str] | None:
    return None if text is None else [word.strip() for word in text.split(",") if word.strip()]


@app.command("import")
def import_file(
    program: Annotated[str, typer.Argument(metavar="PROGRAM", help="that the file is for: moordyn, version 2")],
    file: Annotated[Path, typer.Argument(metavar="FILE")],
    output: Annotated[Path | None, typer.Option("-o", "--output", metavar="FILE.toml",
                                                help="scene file to write (default: beside FILE)")] = None,
) -> None:
    """Write a scene file from the input file of another program, and print what it leaves out."""
    from ..exchange.moordyn import read_moordyn

    if program != "moordyn":
        raise typer.BadParameter(f"{program!r}: the files of moordyn are read")
    made, path = read_moordyn(file), output or file.with_suffix(".toml")
    write_text(path, made.to_toml())
    for note in made.messages:
        print(f"note: {note}", file=sys.stderr)
    print(f"written: {path}")


@app.command()
def export(
    kind: Annotated[str, typer.Argument(metavar="KIND", help="c: a program in C11")],
    scene: SceneName,
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="to write, new, empty or of an earlier export")],
    duration: Duration = None,
    tol: Tolerance = None,
    step: Annotated[float | None, typer.Option(help="fixed step in s, instead of the scene's")] = None,
    output_step: Annotated[float | None, typer.Option(help="s, instead of the scene's")] = None,
    integrator: Integrator = None,
    spectral_radius: Annotated[float | None, typer.Option(help="of genalpha and energy")] = None,
    inputs: Annotated[list[str] | None, typer.Option("--input", metavar="PATH", help="a load, drive, motion or "
                      "velocity of a fluid that is given while it runs, such as push.value.x; may be repeated")] = None,
    library: Libraries = None,
) -> None:
    """Write the run of a scene as a program that needs no Python."""
    if kind != "c":
        raise typer.BadParameter(f"{kind!r}: scenes are exported as c")
    made = load_scene(scene, library or ()).export_c(folder, duration, tol=tol, step=step, output_step=output_step,
                                                     integrator=integrator, spectral_radius=spectral_radius,
                                                     inputs=inputs or ())
    for note in made.messages:
        print(f"note: {note}", file=sys.stderr)
    print(f"written: {made.folder}: integrator {made.integrator}, {len(made.values)} values a row; make builds the "
          "example")


@app.command()
def scenes() -> None:
    """List the bundled scenes."""
    for name, path in bundled_scenes().items():
        print(f"{name}\t{path}")


@app.command()
def schema(
    output: Annotated[Path | None, typer.Option("-o", "--output", help="file to write (default: print it)")] = None,
) -> None:
    """Write the JSON Schema of scene files, with which editors complete and check them.

    Editors with Taplo look for it in the first line of a scene file: #:schema ./funicular.schema.json
    """
    from ..scene.schema import scene_schema

    text = json.dumps(scene_schema(), indent=1, ensure_ascii=False) + "\n"
    if output is None:
        print(text, end="")
    else:
        write_text(output, text)


@app.command()
def derive(
    names: Names = None,
    check: Annotated[bool, typer.Option("--check", help="write nothing; fail if the files differ")] = False,
    spec: Annotated[Path | None, typer.Option(help="a Python file with elements of your own, instead")] = None,
    out: Annotated[Path | None, typer.Option(help="the directory for the library of --spec")] = None,
    watch: Annotated[bool, typer.Option("--watch", help="on every save of a spec, derive, compile, verify and time the "
                                        "named family alone; generated/ stays as it is")] = False,
    explain: Annotated[bool, typer.Option("--explain", help="print how the named families or kernels were derived: "
                                          "stages, operations, shared subexpressions, reasons")] = False,
) -> None:
    """Derive the equations and write or check generated/, or make a library of your own elements."""
    if (spec is None) != (out is None) or (spec is not None and (names or check or watch or explain)):
        raise typer.BadParameter("--spec FILE and --out DIR go together, and with nothing else")
    if check + watch + explain > 1:
        raise typer.BadParameter("--check, --watch and --explain exclude each other: give one of them")
    if (watch or explain) and not names:
        raise typer.BadParameter(f"{'--watch' if watch else '--explain'} needs a NAME, such as cable12_green_exact")
    if watch:
        from funicular.derive.watch import main as watch_families

        raise typer.Exit(watch_families(names or []))
    if explain:
        from funicular.derive.explain import main as explain_kernels

        raise typer.Exit(explain_kernels(names or []))
    if spec is None or out is None:
        from funicular.derive.pipeline import main

        raise typer.Exit(main(names or [], check))
    from funicular.derive.user_elements.command import main as make_library

    make_library(spec, out)


@app.command()
def verify(names: Names = None) -> None:
    """Check the derivatives and invariances of the generated kernels."""
    from funicular.derive.verify.command import main

    raise typer.Exit(main(names or []))


@app.command()
def theory(
    name: Annotated[str | None, typer.Argument(metavar="[NAME]", help="theory, an element, or a family of kernels "
                                               "(default: the theory and all elements)")] = None,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="where the files are written")] = Path(),
) -> None:
    """Write the equations as HTML and LaTeX, from the specs of the kernels, and check them against the kernels."""
    from funicular.derive.theory.command import main

    raise typer.Exit(main(name, output))


if __name__ == "__main__":
    app()
