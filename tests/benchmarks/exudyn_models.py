"""The side-by-side scenes in Exudyn: its cable and its sliding joint, in its fastest configuration.

Its AVX2 build without range checks, one thread, sparse solver, modified Newton, no output during the timing. Its Newton
tolerance is 1e-6 in place of the default 1e-8, which is below its rounding on fine stiff meshes and only costs time
there.
"""
# ruff: noqa: E402 (its import reads sys.exudynFast)

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

sys.exudynFast = True

import exudyn as exu
import numpy as np
from exudyn.beams import GenerateBeamElementsAlongLine
from exudyn.itemInterface import (
    Gravity,
    MarkerBodyBeamShape,
    MarkerBodyMass,
    MarkerBodyPosition,
    NodeGenericData,
    NodePoint,
    ObjectANCFCable,
    ObjectJointSliding,
    ObjectMassPoint,
    SensorNode,
)

NEWTON_TOLERANCE = 1e-6
GRAVITY = 9.81
HELD = [1, 1, 1, 0, 0, 0]
"""Coordinates of a pinned node that are fixed: those of its position."""


class StoppedError(Exception):
    """The run did not reach its end."""


@dataclass
class System:
    """A system ready to run, and the node of the compared path."""

    container: exu.SystemContainer
    system: exu.MainSystem
    node: int


def pendulum(elements: int, youngs_modulus: float) -> System:
    """The flexible pendulum; the node is its tip."""
    container, system = _empty()
    cable = _cable(system, elements, 1.0, 0.02, youngs_modulus, 7200.0, HELD, None)
    return _assembled(container, system, cable.nodes[-1])


def sliding_mass(elements: int, youngs_modulus: float, mass: float) -> System:
    """The sliding mass on its pinned cable; the node is the mass."""
    length, start = 1.5, 0.25
    container, system = _empty()
    cable = _cable(system, elements, length, 0.05, youngs_modulus, 4200.0, HELD, HELD)
    node = system.AddNode(NodePoint(referenceCoordinates=[start, 0, 0], initialVelocities=[1, 0, 0]))
    body = system.AddObject(ObjectMassPoint(mass=mass, nodeNumber=node))
    weighed = system.AddMarker(MarkerBodyMass(bodyNumber=body))
    system.AddLoad(Gravity(markerNumber=weighed, loadVector=[0, -GRAVITY, 0]))
    rider = system.AddMarker(MarkerBodyPosition(bodyNumber=body))
    ridden = [system.AddMarker(MarkerBodyBeamShape(bodyNumber=number)) for number in cable.elements]
    first = int(start / length * elements)
    state = system.AddNode(NodeGenericData(initialCoordinates=[first, start], numberOfDataCoordinates=2))
    system.AddObject(ObjectJointSliding(
        markerNumbers=[rider, ridden[first]], slidingMarkerNumbers=ridden,
        slidingMarkerOffsets=[length / elements * k for k in range(elements)], nodeNumber=state,
        constrainRotations=[0, 0, 0], constrainTranslations=[1, 1, 1]))
    return _assembled(container, system, node)


@dataclass
class _Cable:
    nodes: list[int]
    elements: list[int]


def _empty() -> tuple[exu.SystemContainer, exu.MainSystem]:
    exu.config.printToConsole = False
    container = exu.SystemContainer()
    return container, container.AddSystem()


def _cable(system, elements, length, thickness, youngs_modulus, density, held_start, held_end) -> _Cable:
    area, second_moment = thickness**2, thickness**4 / 12
    template = ObjectANCFCable(massPerLength=density * area, bendingStiffness=youngs_modulus * second_moment,
                               axialStiffness=youngs_modulus * area)
    made = GenerateBeamElementsAlongLine(
        system, [0, 0, 0], [length, 0, 0], elements, beamTemplate=template, gravity=[0, -GRAVITY, 0],
        groundConstraintsStart=held_start, groundConstraintsEnd=held_end)
    return _Cable(made["nodes"], made["elements"])


def _assembled(container, system, node: int) -> System:
    system.Assemble()
    return System(container, system, node)


def _settings(duration: float, steps: int) -> exu.SimulationSettings:
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.active = False
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = duration
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.timeIntegration.newton.relativeTolerance = NEWTON_TOLERANCE
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    settings.parallel.numberOfThreads = 1
    return settings


def _solve(made: System, settings: exu.SimulationSettings) -> None:
    try:
        made.system.SolveDynamic(settings)
    except exu.SolverError as error:
        raise StoppedError(f"stopped at t = {made.system.systemData.GetTime():g} s") from error


def cpu_seconds(make: Callable[[], System], duration: float, steps: int) -> float:
    """CPU seconds of the solver alone."""
    made = make()
    settings = _settings(duration, steps)
    begin = time.process_time()
    _solve(made, settings)
    return time.process_time() - begin


def last_position(made: System, duration: float, steps: int) -> list[float]:
    """Run a system to its end; return the position of the node, m."""
    _solve(made, _settings(duration, steps))
    return made.system.GetNodeOutput(made.node, exu.OutputVariableType.Position).tolist()


def trajectory(make: Callable[[], System], duration: float, steps: int, outputs: int) -> np.ndarray:
    """Return the path (outputs + 1, 3) of the node, m; steps must be a multiple of the outputs."""
    made = make()
    sensor = made.system.AddSensor(SensorNode(nodeNumber=made.node, storeInternal=True,
                                              outputVariableType=exu.OutputVariableType.Position))
    made.system.Assemble()
    settings = _settings(duration, steps)
    settings.solution.sensors.active = True
    settings.solution.sensors.writePeriod = duration / steps
    _solve(made, settings)
    every = made.system.GetSensorStoredData(sensor)
    rows = every[:: steps // outputs]
    if rows.shape != (outputs + 1, 4) or abs(rows[:, 0] - np.linspace(0, duration, outputs + 1)).max() > 1e-9:
        raise StoppedError(f"stopped at t = {every[-1, 0]:g} s")
    return rows[:, 1:]
