"""Recording of a run: the rows of the engine as named arrays in three dimensions, and the report."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from ..base.deferred import dataclass
from ..checks.velocity_jumps import velocity_jumps
from ..engine import Engine
from ..model.model import Model
from ..model.part_states import States, part_states
from ..parts.modal_body import ModalBody
from ..parts.scene_data import SceneData
from ..parts.settings import RunSettings
from ..solve.motion.run import FAILED_STATUSES, Simulated
from ..solve.notes.coincident_points import CoincidentPoints
from ..solve.notes.diagnosis import RESULTS_KEPT, rope_left, stopped
from .quantities import ENERGIES, Variable, labelled


@dataclass
class Rows:
    """Output rows as plain arrays by name, time first, in SI units, vectors with three components.

    parts: the ``results`` of the classes of parts, by group and label; cables: nodal vectors; modal: coordinates of
    modal bodies.
    """

    cables: dict[str, dict[str, np.ndarray]]
    modal: dict[str, dict[str, np.ndarray]]
    parts: dict[str, dict[str, dict[str, np.ndarray]]]
    energy: dict[str, np.ndarray]


@dataclass
class Recording:
    """The rows of a run that are still in memory, as the engine has them, its status and report.

    scene: in the axes of the model; coords: of the results.
    """

    model: Model
    scene: SceneData
    rows: dict[str, np.ndarray]
    coords: dict[str, Variable]
    status: str
    message: str
    report: dict[str, Any]

    def variables(self, alone: str | None = None) -> dict[str, Variable]:
        """Return the labelled results by name; alone: only those of this part, or of "energy"."""
        return labelled(named(self.model, self.scene, self.rows, alone))


def named(model: Model, scene: SceneData, rows: dict[str, np.ndarray], alone: str | None = None) -> Rows:
    """Return the engine's rows by name; alone: only those of this part, or of "energy"."""
    found = part_states(model, scene, States.of_rows(rows), alone)
    energy = {name: rows[name] for name in ENERGIES} if alone in (None, "energy") else {}
    return Rows(found.cables, found.modal, found.parts, energy)


def coordinates(model: Model, time: np.ndarray) -> dict[str, Variable]:
    """Return the labelled coordinates of the results of a model; time: of the rows, in s."""
    coords = {
        "time": Variable(("time",), time, "s", "time"),
        "xyz": Variable(("xyz",), np.array(["x", "y", "z"]), "1", "axis"),
    }
    for cable in model.cables:
        node, vector = f"{cable.name}.node", f"{cable.name}.vector"
        coords[node] = Variable((node,), cable.mesh.node_s, "m", "undeformed arc-length of the node")
        coords[vector] = Variable((vector,), np.array(cable.vectors), "1", "nodal vector")
    for body in model.bodies:
        if body.shape is not None:
            mode, node = f"{body.name}.mode", f"{body.name}.node"
            coords[mode] = Variable((mode,), np.arange(1, body.modes + 1), "1", "mode")
            coords[node] = Variable((node,), np.arange(len(body.shape.fields.nodes)), "1", "node")
    return coords


def recorded(simulation: Simulated, scene: SceneData, settings: RunSettings, timed: bool = True) -> Recording:
    """Return the rows of the engine by name, and the report on the run; timed: with the times of slides and joints,
    whose measurement takes up to 0.1 ms.
    """
    begin = time.perf_counter()
    model, engine, status = simulation.model, simulation.engine, simulation.status
    statistics = engine.statistics
    costs, rows = _costs(model, engine) if timed else {}, engine.rows()
    coords = coordinates(model, rows["time"])
    results = time.perf_counter() - begin
    seconds = {"set_up": simulation.set_up_s, "start": simulation.start_s, "results": simulation.notes_s + results,
               "total": simulation.total_s + results}
    report = {
        "status": status,
        "integrator": engine.integrator,
        "integrator_reason": simulation.reason,
        "spectral_radius": simulation.spectral_radius,
        "tol": settings.tol if settings.step is None else None,
        "absolute_tol": engine.absolute_tol if settings.step is None else None,
        "quantities": None if settings.quantities is None or settings.step is not None else list(settings.quantities),
        "step": settings.step,
        "unknowns": model.n_band + model.n_border_dof + model.n_extra,
        "kernels": model.kernels,
        "messages": simulation.messages,
        "events": simulation.event_handler.happened,
        **statistics,
        "time_s": seconds | statistics["time_s"] | {"solve_cpu": simulation.solve_cpu_s},
        "us_per_step": costs,
        "modes": {body.name: body.modes_in_words for body in scene.bodies.values() if isinstance(body, ModalBody)},
    }
    return Recording(
        model, scene, rows, coords,
        status="no_convergence" if status in FAILED_STATUSES else status,
        message=_message(simulation, scene, settings),
        report=report,
    )


def _costs(model: Model, engine: Engine) -> dict[str, float]:
    """Return the time per step of each slide and joint in µs, summed for a slide that ties its rider's axes."""
    found: dict[str, float] = {}
    if any(coupling.reports_cost for coupling in model.couplings):
        for coupling, seconds in zip(model.couplings, engine.costs(), strict=True):
            if coupling.reports_cost:
                found[coupling.name] = found.get(coupling.name, 0.0) + 1e6 * float(seconds)
    return found


def _message(simulation: Simulated, scene: SceneData, settings: RunSettings) -> str:
    model, engine, status = simulation.model, simulation.engine, simulation.status
    when = f"t = {engine.time:.6g} s of {settings.duration:.6g} s"
    match status:
        case "end_of_cable":
            slide = model.slides[engine.stopped_slide]
            cable = model.cables[slide.cable]
            end = "end" if engine.stopped_s > 0.5 * cable.mesh.total else "start"
            return (f'slide "{slide.name}": ran off the {end} of cable "{cable.name}" at {when}; {RESULTS_KEPT}')
        case "rope_left":
            cause, remedy = rope_left(model, *engine.left)
            return f"{cause} at {when}; {RESULTS_KEPT}; {remedy}"
        case _ if status in FAILED_STATUSES:
            now, q, *_ = engine.now()
            points = CoincidentPoints(scene, model)
            points.see({"time": np.array([now]), "q": q[None]})
            jumps = [each for each in velocity_jumps(scene.as_drawn, settings.duration) if each in simulation.messages]
            return "; ".join([*points.notes(), stopped(model, engine, status, settings), *jumps])
        case "event":
            return f"stopped by {simulation.event_handler.stopped_by} at {when}"
        case "interrupted":
            remedy = "" if settings.save is None else ", and resume continues the run"
            return f"interrupted at {when}; {RESULTS_KEPT}{remedy}"
    return f"completed {settings.duration:.6g} s"
