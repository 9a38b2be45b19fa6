"""Error against time: a scene over a grid of integrators, meshes and tolerances.

Errors are norms of trajectories: the largest distance from a reference over the output times, relative to the largest
motion of the outputs of the same unit, as ``tol`` is. ``time error``: from the converged motion of the same mesh, a run
with a tolerance below all of the grid, confirmed by a second tolerance. ``mesh error``: of this converged motion from
the one on a mesh with every element of the finest one halved. Times are CPU seconds of the integration without set-up.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from statistics import median

import numpy as np

from ..errors import FunicularError, FunicularWarning, SceneError, near
from ..integrators import AUTO, INTEGRATORS, OF_EQUATIONS
from ..parts.cable import Cable
from ..parts.rope import Rope
from ..parts.settings import RunSettings
from ..parts.validation import MAX_COUNT
from ..results.run import Run
from ..results.trajectories import check_output, default_outputs, distance, relative, trajectory
from ..scene.scene import Scene

TOLS = (1e-2, 1e-3, 1e-4, 1e-5)
MESHES = ("x1", "x2")
REFERENCE_TOL_RATIOS = (1 / 20, 1 / 80)
"""Tolerances of the two reference runs of a mesh, over the smallest of the grid; the last one is the reference."""

GRID_SETTINGS = ("duration", "tol", "step", "output_step", "integrator", "save")
"""Settings of a scene file that the grid replaces."""

MAX_REPEATED_SECONDS = 1.0
"""CPU seconds above which a run is not repeated: disturbances are small beside it."""

COUNTS = ("steps", "rejected_steps", "newton_iterations", "factorisations")


@dataclass(frozen=True)
class Mesh:
    """``count`` times the scene's elements in each cable and span of a rope, or that number of elements in each."""

    count: float
    factor: bool

    @classmethod
    def parse(cls, text: str) -> Mesh:
        """Return the mesh of a text such as x2 (a factor) or 24 (a number of elements). Raises SceneError."""
        if (match := re.fullmatch(r"(x?)(\d+(?:\.\d*)?|\.\d+)", text.strip())) is None:
            raise SceneError("bench", f'elements: "{text}" is neither a factor nor a number of elements',
                             "write x2 for twice the scene's elements, or 24 for 24 in each cable")
        mesh = cls(float(match[2]), bool(match[1]))
        if not (mesh.factor or mesh.count % 1 == 0) or mesh.count <= 0:
            raise SceneError("bench", f'elements: "{text}" is not a number of elements', "write a whole one, 1 or more")
        if mesh.count > MAX_COUNT:
            raise SceneError("bench", f"elements: {mesh.count:g} exceeds {MAX_COUNT}")
        return mesh

    def __str__(self) -> str:
        """Return the mesh as it is written on the command line."""
        return f"{'x' * self.factor}{self.count:g}"

    def elements(self, cable: Cable) -> int:
        """Return the number of elements of this mesh in ``cable``."""
        return self._of(cable.where, cable.elements)

    def elements_of_spans(self, rope: Rope) -> tuple[int, ...]:
        """Return the numbers of elements of this mesh in the spans of ``rope``."""
        return tuple(self._of(rope.where, given) for given in rope.elements_of_spans)

    def total(self, scene: Scene) -> int:
        """Return the number of elements of this mesh in a scene."""
        return (sum(map(self.elements, scene.cables.values()))
                + sum(sum(self.elements_of_spans(rope)) for rope in scene.ropes.values()))

    def _of(self, where: str, given: int) -> int:
        count = self.count * given if self.factor else self.count
        if count % 1:
            raise SceneError(where, f"{self} of its {given} elements is {count:g}",
                             "take a factor that leaves a whole number")
        return int(count)

    def twice(self) -> Mesh:
        """Return the mesh with every element halved."""
        return replace(self, count=2 * self.count)

    def scene(self, scene: Scene) -> Scene:
        """Return the scene on this mesh. Raises SceneError, also where a support then stands on no node."""
        made = scene.remeshed(self.elements, self.elements_of_spans)
        made.run_settings = {name: value for name, value in scene.run_settings.items() if name not in GRID_SETTINGS}
        return made


@dataclass(frozen=True)
class Grid:
    """Combinations to run; outputs as in `trajectories.check_output`, duration and output_step in s."""

    integrators: tuple[str, ...]
    meshes: tuple[Mesh, ...]
    tols: tuple[float, ...]
    outputs: tuple[str, ...]
    duration: float
    output_step: float
    repetitions: int


def grid(scene: Scene, *, integrators: Sequence[str] | None = None, elements: Sequence[str] | None = None,
         tols: Sequence[float] = TOLS, outputs: Sequence[str] | None = None, duration: float | None = None,
         output_step: float | None = None, repetitions: int = 5) -> Grid:
    """Return a checked grid, by default with all integrators of the scene's equations, and `MESHES`. Raises SceneError.
    """
    for name, values in (("integrators", integrators), ("elements", elements), ("tols", tols), ("outputs", outputs)):
        if values is not None and not len(values):
            raise SceneError("bench", f"{name}: the list is empty", "name one, or leave it out")
    integrators = tuple(integrators or OF_EQUATIONS)
    for name in integrators:
        if name not in (AUTO, *INTEGRATORS):
            raise SceneError("bench", f'there is no integrator "{name}"', near(name, (AUTO, *INTEGRATORS)))
    for tol in tols:
        if not 0 < tol < 1:
            raise SceneError("bench", f"tols: a tolerance must lie inside (0, 1), got {tol:g}")
    if repetitions < 1:
        raise SceneError("bench", f"repetitions must be 1 or more, got {repetitions}")
    if repetitions > MAX_COUNT:
        raise SceneError("bench", f"repetitions must not exceed {MAX_COUNT}, got {repetitions}")
    outputs = tuple(outputs or default_outputs(scene))
    for name in outputs:
        check_output(scene, name)
    duration = scene.run_settings.get("duration") if duration is None else duration
    if duration is None:
        raise SceneError("bench", "the scene file gives no duration", "give one: --duration")
    settings = RunSettings(duration=duration, **{} if output_step is None else {"output_step": output_step})
    return Grid(integrators, tuple(map(Mesh.parse, elements or MESHES)), tuple(sorted(tols, reverse=True)), outputs,
                settings.duration, settings.duration / 50 if output_step is None else settings.output_step, repetitions)


@dataclass
class Reference:
    """The converged motion of one mesh, by output; agreement: relative, of its two tolerances, the last its own."""

    mesh: Mesh
    motion: dict[str, np.ndarray]
    tols: tuple[float, ...]
    agreement: float
    mesh_error: float = np.nan


@dataclass
class Row:
    """One combination: relative errors, and errors by output in its unit; failed: the error message, or None."""

    integrator: str
    mesh: Mesh
    tol: float
    elements: int = 0
    failed: str | None = None
    cpu: list[float] = field(default_factory=list)
    set_up: list[float] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)
    time_error: float = np.nan
    total_error: float = np.nan
    errors: dict[str, float] = field(default_factory=dict)

    @property
    def cpu_s(self) -> float:
        """Return the median CPU seconds of the integration."""
        return median(self.cpu) if self.cpu else np.nan

    @property
    def set_up_s(self) -> float:
        """Return the median seconds of the set-up."""
        return median(self.set_up) if self.set_up else np.nan


@dataclass
class Bench:
    """The result: rows in the order of the grid, a reference for each mesh that has one, and the one of all meshes."""

    scene: Scene
    grid: Grid
    rows: list[Row]
    references: dict[Mesh, Reference]
    finest: Reference | None

    def is_resolved(self, row: Row) -> bool:
        """Return whether the error of the reference is at most a tenth of the row's time error."""
        return row.failed is None and self.references[row.mesh].agreement <= 0.1 * row.time_error


def bench(scene: Scene, grid: Grid, tell: Callable[[str], None] = lambda text: None) -> Bench:
    """Run the grid; tell: a function that takes a line on the present run.

    A combination that fails has a row with its message.
    """
    result = Bench(scene, grid, [], {}, None)
    scenes: dict[Mesh, Scene] = {}
    failures: dict[Mesh, str] = {}
    for mesh in grid.meshes:
        tell(f"reference, {mesh} elements")
        try:
            scenes[mesh] = mesh.scene(scene)
            result.references[mesh] = _reference(scenes[mesh], mesh, grid)
        except FunicularError as error:
            failures[mesh] = str(error)
    _compare_meshes(result, tell)
    for integrator in grid.integrators:
        for mesh in grid.meshes:
            result.rows += [Row(integrator, mesh, tol, failed=failures.get(mesh)) for tol in grid.tols]
    for turn in range(grid.repetitions):
        for row in result.rows:
            if row.failed is None and (turn == 0 or row.cpu[0] < MAX_REPEATED_SECONDS):
                tell(f"turn {turn + 1} of {grid.repetitions}: {row.integrator}, {row.mesh} elements, tol {row.tol:g}")
                _measure(result, row, scenes[row.mesh])
    return result


def _run(scene: Scene, grid: Grid, integrator: str, tol: float,
         finer: int = 1) -> tuple[Run, dict[str, np.ndarray]]:
    """Return a run and its outputs at the times of the grid; finer: factor of the number of output times in the run."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FunicularWarning)  # the same notes for every run of the grid
        run = scene.run(grid.duration, tol=tol, output_step=grid.output_step / finer, integrator=integrator,
                        progress=False)
    if run.status == "interrupted":
        raise KeyboardInterrupt
    return run, {name: trajectory(scene, run, name)[::finer] for name in grid.outputs}


def _reference(scene: Scene, mesh: Mesh, grid: Grid) -> Reference:
    tols = tuple(min(grid.tols) * factor for factor in REFERENCE_TOL_RATIOS)
    check = _run(scene, grid, "auto", tols[0])[1]
    motion = _run(scene, grid, "auto", tols[1], finer=2)[1]  # other steps even where the output times set them
    return Reference(mesh, motion, tols, relative(scene, check, motion))


def _compare_meshes(result: Bench, tell: Callable[[str], None]) -> None:
    """Add the errors of the meshes, from a mesh with every element of the finest one halved."""
    if not result.references or not (result.scene.cables or result.scene.ropes):
        return
    mesh = max(result.references, key=lambda mesh: mesh.total(result.scene)).twice()
    tell(f"reference of all meshes, {mesh} elements")
    try:
        tol = min(result.grid.tols) * REFERENCE_TOL_RATIOS[0]
        motion = _run(mesh.scene(result.scene), result.grid, "auto", tol)[1]
    except FunicularError:
        return  # without a mesh error: the table shows that there is none
    result.finest = Reference(mesh, motion, (tol,), np.nan, 0.0)
    for reference in result.references.values():
        reference.mesh_error = relative(result.scene, reference.motion, motion)


def _measure(result: Bench, row: Row, scene: Scene) -> None:
    exact = result.references[row.mesh].motion
    try:
        run, motion = _run(scene, result.grid, row.integrator, row.tol)
    except FunicularError as error:
        row.failed = str(error)
        return
    row.cpu.append(run.report["time_s"]["solve_cpu"])
    row.set_up.append(run.report["time_s"]["set_up"])
    row.elements = (sum(cable.elements for cable in scene.cables.values())
                    + sum(rope.n_elements for rope in scene.ropes.values()))
    row.counts = {name: run.report[name] for name in COUNTS if name in run.report}
    row.time_error = relative(scene, motion, exact)
    row.errors = {name: distance(motion[name], exact[name]) for name in exact}
    if result.finest is not None:
        row.total_error = relative(scene, motion, result.finest.motion)
