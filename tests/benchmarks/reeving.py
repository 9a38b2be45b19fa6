"""Error against time of a load on a rope without mass, beside Exudyn's reeving springs.

The swinging Atwood of ropes/swings.py: the error is that of the load at 3 s against the inextensible solution, so that
the stretch of the axial stiffness is in it. CPU seconds are the least of alternating repetitions: of the solver, and of
the whole call from the scene on. Exudyn runs its AVX2 build without range checks on one thread, its time is that of
the solver.

    python tests/benchmarks/reeving.py [--out FILE.csv] [--repetitions 5]
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import importlib.util
import sys
import time
import warnings
from math import cos, pi, sin

import numpy as np
from ropes import CASES
from ropes.massless_runs import atwood
from table import few, parser, show

STIFFNESSES = (1e6, 1e7)
TOLS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
STEPS = (300, 1000, 3000, 10000, 30000)
DAMPING = 1e-3
"""Retardation time of the ropes, s."""


def place() -> np.ndarray:
    """Return the place of the load at 3 s, m."""
    case = next(case for case in CASES if case.key == "swinging Atwood")
    return np.array(case.reference()[4:6])


def ours(EA: float, tol: float) -> tuple[np.ndarray, float, float]:
    """Return the place of the load, and CPU seconds of the solver and of the whole call."""
    begin = time.process_time()
    run = atwood(EA).run(3.0, output_step=1.0, tol=tol, integrator="radau", progress=False)
    whole = time.process_time() - begin
    return run["load.position"][-1, :2], run.report["time_s"]["solve_cpu"], whole


def theirs(EA: float, steps: int) -> tuple[np.ndarray, float, float]:
    """Return the same of Exudyn, with NaN for the whole call."""
    sys.exudynFast = True
    import exudyn as exu
    from exudyn.itemInterface import (
        Gravity,
        MarkerBodyMass,
        MarkerBodyRigid,
        NodeRigidBody2D,
        ObjectGround,
        ObjectRigidBody2D,
        ReevingSystemSprings,
    )
    R, free, angle = 0.3, 4.0, 0.5
    exu.config.printToConsole = False
    container = exu.SystemContainer()
    system = container.AddSystem()
    ground = system.AddObject(ObjectGround())
    markers, nodes = [system.AddMarker(MarkerBodyRigid(bodyNumber=ground, localPosition=[0, 0, 0]))], []
    for mass, x, y in ((5.5, -R, -3.0), (5.0, R * cos(angle) + free * sin(angle), R * sin(angle) - free * cos(angle))):
        nodes.append(system.AddNode(NodeRigidBody2D(referenceCoordinates=[x, y, 0])))
        body = system.AddObject(ObjectRigidBody2D(mass=mass, inertia=mass, nodeNumber=nodes[-1]))
        markers.append(system.AddMarker(MarkerBodyRigid(bodyNumber=body)))
        weighed = system.AddMarker(MarkerBodyMass(bodyNumber=body))
        system.AddLoad(Gravity(markerNumber=weighed, loadVector=[0, -9.81, 0]))
    system.AddObject(ReevingSystemSprings(
        markerNumbers=[markers[1], markers[0], markers[2]], stiffnessPerLength=EA, dampingPerLength=EA * DAMPING,
        regularizationForce=-1, referenceLength=(3 + free + R * (pi - angle)) / (1 + 50 / EA),
        sheavesAxes=exu.Vector3DList([[0, 0, 1], [0, 0, -1], [0, 0, 1]]), sheavesRadii=[0, R, 0]))
    system.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = settings.solution.sensors.active = False
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = steps, 3.0
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.timeIntegration.newton.relativeTolerance = 1e-6
    settings.parallel.numberOfThreads = 1
    begin = time.process_time()
    system.SolveDynamic(settings)
    seconds = time.process_time() - begin
    return np.array(system.GetNodeOutput(nodes[-1], exu.OutputVariableType.Position)[:2]), seconds, float("nan")


def main() -> None:
    """Measure and print."""
    options = parser(__doc__, repetitions=(5, "runs of each setting, the least time of which counts")).parse_args()
    warnings.simplefilter("ignore")
    exact, rows = place(), []
    codes = [("funicular", ours, "tol", TOLS)]
    if importlib.util.find_spec("exudyn") is not None:
        codes.append(("Exudyn", theirs, "steps", STEPS))
    for EA in few(STIFFNESSES):
        for name, run, kind, settings in codes:
            for setting in few(settings):
                found = [run(EA, setting) for _ in range(options.repetitions)]
                rows.append({"code": name, "EA, N": f"{EA:g}", "setting": f"{kind} {setting:g}",
                             "error, m": float(np.abs(found[0][0] - exact).max()),
                             "solver CPU s": min(each[1] for each in found),
                             "whole call CPU s": min(each[2] for each in found)})
    show(rows, options.out)


if __name__ == "__main__":
    main()
