"""Error against time of a load on a rope without mass, beside Exudyn's reeving springs and MuJoCo's tendons.

The swinging Atwood of ropes/swings.py: the errors are those of the load at 1 and 3 s against the inextensible solution,
so that the stretch of the axial stiffness is in them; before 2 s the wrap passes 180 degrees. CPU seconds are the least
of alternating repetitions: of the solver, and of the whole call from the scene on. Exudyn runs its AVX2 build without
range checks on one thread, MuJoCo its Runge-Kutta method; their times are those of the solver.

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
STEPS = (300, 900, 3000, 9000, 30000)
DAMPING = 1e-3
"""Retardation time of the ropes, s."""


R, FREE, ANGLE = 0.3, 4.0, 0.5
"""Radius of the sheave in m, free length of the load in m, angle of its tangent in rad."""
BODIES = ((5.5, -R, -3.0), (5.0, R * cos(ANGLE) + FREE * sin(ANGLE), R * sin(ANGLE) - FREE * cos(ANGLE)))
"""Mass in kg and place in m of the counterweight and of the load."""
PULL = 50.0
"""Tension as drawn, N."""


def free_length(EA: float) -> float:
    """Return the stress-free length of the rope, m."""
    return (3 + FREE + R * (pi - ANGLE)) / (1 + PULL / EA)


def places() -> np.ndarray:
    """Return the places of the load at 1 and 3 s (2, 2), m."""
    case = next(case for case in CASES if case.key == "swinging Atwood")
    return np.array(case.reference()[:6]).reshape(3, 2)[[0, 2]]


def ours(EA: float, tol: float) -> tuple[np.ndarray, float, float]:
    """Return the places of the load at 1 and 3 s, and CPU seconds of the solver and of the whole call."""
    begin = time.process_time()
    run = atwood(EA).run(3.0, output_step=1.0, tol=tol, integrator="radau", progress=False)
    whole = time.process_time() - begin
    return run["load.position"][[1, 3], :2], run.report["time_s"]["solve_cpu"], whole


def by_exudyn(EA: float, steps: int) -> tuple[np.ndarray, float, float]:
    """Return the same of Exudyn, with NaN for the place at 1 s and the whole call."""
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
    exu.config.printToConsole = False
    container = exu.SystemContainer()
    system = container.AddSystem()
    ground = system.AddObject(ObjectGround())
    markers, nodes = [system.AddMarker(MarkerBodyRigid(bodyNumber=ground, localPosition=[0, 0, 0]))], []
    for mass, x, y in BODIES:
        nodes.append(system.AddNode(NodeRigidBody2D(referenceCoordinates=[x, y, 0])))
        body = system.AddObject(ObjectRigidBody2D(mass=mass, inertia=mass, nodeNumber=nodes[-1]))
        markers.append(system.AddMarker(MarkerBodyRigid(bodyNumber=body)))
        weighed = system.AddMarker(MarkerBodyMass(bodyNumber=body))
        system.AddLoad(Gravity(markerNumber=weighed, loadVector=[0, -9.81, 0]))
    system.AddObject(ReevingSystemSprings(
        markerNumbers=[markers[1], markers[0], markers[2]], stiffnessPerLength=EA, dampingPerLength=EA * DAMPING,
        regularizationForce=-1, referenceLength=free_length(EA),
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
    place = np.array(system.GetNodeOutput(nodes[-1], exu.OutputVariableType.Position)[:2])
    return np.stack([np.full(2, np.nan), place]), seconds, float("nan")


def by_mujoco(EA: float, steps: int) -> tuple[np.ndarray, float, float]:
    """Return the same of MuJoCo, with NaN for the whole call."""
    import mujoco
    L = free_length(EA)
    bodies = "".join(f"""<body pos="{x} {y} 0"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/>
        <inertial pos="0 0 0" mass="{mass}" diaginertia="1 1 1"/><site name="at_{k}"/></body>"""
                     for k, (mass, x, y) in enumerate(BODIES))
    model = mujoco.MjModel.from_xml_string(f"""<mujoco>
        <option timestep="{3 / steps}" gravity="0 -9.81 0" integrator="RK4"><flag contact="disable"/></option>
        <worldbody><geom name="sheave" type="cylinder" size="{R} 0.1" contype="0" conaffinity="0"/>
        <site name="above" pos="0 {2 * R} 0"/>{bodies}</worldbody>
        <tendon><spatial stiffness="{EA / L}" damping="{EA * DAMPING / L}" springlength="{L}">
        <site site="at_0"/><geom geom="sheave" sidesite="above"/><site site="at_1"/></spatial></tendon></mujoco>""")
    data, found = mujoco.MjData(model), []
    begin = time.process_time()
    for part in (steps // 3, steps - steps // 3):
        mujoco.mj_step(model, data, part)
        found.append(np.array(BODIES[1][1:]) + data.qpos[2:4])
    return np.stack(found), time.process_time() - begin, float("nan")


def main() -> None:
    """Measure and print."""
    options = parser(__doc__, repetitions=(5, "runs of each setting, the least time of which counts")).parse_args()
    warnings.simplefilter("ignore")
    exact, rows = places(), []
    codes = [("funicular", ours, "tol", TOLS)]
    for name, package, run in (("Exudyn", "exudyn", by_exudyn), ("MuJoCo", "mujoco", by_mujoco)):
        if importlib.util.find_spec(package) is not None:
            codes.append((name, run, "steps", STEPS))
    for EA in few(STIFFNESSES):
        for name, run, kind, settings in codes:
            for setting in few(settings):
                found = [run(EA, setting) for _ in range(options.repetitions)]
                rows.append({"code": name, "EA, N": f"{EA:g}", "setting": f"{kind} {setting:g}",
                             "error at 1 s, m": float(np.abs(found[0][0] - exact)[0].max()),
                             "error at 3 s, m": float(np.abs(found[0][0] - exact)[1].max()),
                             "solver CPU s": min(each[1] for each in found),
                             "whole call CPU s": min(each[2] for each in found)})
    show(rows, options.out)


if __name__ == "__main__":
    main()
