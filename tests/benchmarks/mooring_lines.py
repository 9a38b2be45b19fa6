"""Error against time of a mooring line whose upper end surges, beside MoorDyn.

A chain of 835.35 m in 186 m of water (diameter 76.6 mm, 113.35 kg/m, EA 7.536e8 N, damping time 1 ms), drag 2.0 across
and 0.4 along, added mass 1.0, bed of 3e5 N/m³ and 3e4 N s/m³; the upper end surges by 4 m in 10 s, for 60 s. The
compared quantity is the tension at the upper end every 0.1 s from 10 s on; its error is the largest one over the range
of the tension. Each code has its own converged tension: funicular a fine mesh with a small tolerance, MoorDyn the limit
of two meshes of lumped masses. Their distance is printed: MoorDyn's added mass is a force on accelerations (Morison),
that of funicular the kinetic energy of the fluid.

CPU seconds are the least of alternating repetitions: of the run from a state of rest on, and with the scene and its
state of rest. A mesh of funicular has its short elements where the line leaves the bed; those of a line of MoorDyn
have one length. MoorDyn holds the velocity of the upper end between its calls: the error of an interval of 0.1 s, at
which funicular writes its output, is 3e-2, so that it is also called more often.

    pip install '.[bench]' && python tests/benchmarks/mooring_lines.py [--out FILE.csv] [--repetitions 3]
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import contextlib
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from functools import cache, partial
from pathlib import Path

import funicular as fu
import numpy as np
from table import few, parser, show

DIAMETER, MASS, EA, DAMPING_TIME, LENGTH = 0.0766, 113.35, 7.536e8, 1e-3, 835.35
FAR, HIGH = 796.732, 186.0
"""Place of the upper end from the anchor, m."""
BED_STIFFNESS, BED_DAMPING = 3e5, 3e4
"""Of the bed for an area of line, N/m³ and N s/m³."""
ACROSS, ALONG, ADDED = 2.0, 0.4, 1.0
AMPLITUDE, PERIOD = 2.0, 10.0
WATER, GRAVITY = 1025.0, 9.81
DURATION, OUTPUT, SETTLED = 60.0, 0.1, 10.0
Found = tuple[np.ndarray, float, float]
"""Tension (times,) in N; CPU seconds of the run, and of all."""


NODES = (0.0, 150.0, 200.0, 250.0, 300.0, 350.0, 471.0, 593.0, 714.0, LENGTH)
"""Of a mesh with short elements where the line leaves the bed, at s from 190 m to 270 m, m."""


def scene(mesh: int | tuple[float, ...]) -> fu.Scene:
    """Return the line of funicular; mesh: number of its elements, or their nodes, m."""
    made, area = fu.Scene(gravity=(0, -GRAVITY, 0)), np.pi / 4 * DIAMETER**2
    line = made.cable("line", start=(0, 0, 0), end=(FAR, HIGH, 0), rest_length=LENGTH, element="cable8p",
                      strain="engineering", **{"elements" if isinstance(mesh, int) else "nodes": mesh},
                      section=fu.GeneralSection(area=area, second_moment_about_z=1e-10),
                      material=fu.Material(youngs_modulus=EA / area, poisson_ratio=0.0, density=MASS / area,
                                           damping_time=DAMPING_TIME))
    made.pin(line, s=0.0)
    surge = fu.Harmonic(amplitude=AMPLITUDE, frequency=1 / PERIOD, phase=-np.pi / 2, offset=AMPLITUDE)
    made.motion(line, s=LENGTH, displacement=[surge, 0.0, 0.0])
    made.surface("bed", fu.Plane(point=(0, -DIAMETER / 2, 0), normal=(0, 1, 0)))
    stiffness = BED_STIFFNESS * DIAMETER
    sunk = (MASS - WATER * area) * GRAVITY / stiffness  # of the line at rest: contact's damping is relative to it
    made.contact(line, "bed", stiffness=stiffness, damping=BED_DAMPING * DIAMETER / (stiffness * sunk),
                 radius=DIAMETER / 2, name="lying")
    made.fluid("sea", density=WATER)
    made.drag(line, normal=ACROSS, tangential=ALONG, diameter=DIAMETER, added_mass=ADDED)
    return made


def ours(mesh: int | tuple[float, ...], **settings) -> Found:
    """Run funicular."""
    begin = time.process_time()
    made = scene(mesh)
    rest = made.equilibrium()
    ready = time.process_time()
    run = made.run(duration=DURATION, output_step=OUTPUT, initial=rest, progress=False, **settings)
    tension = np.linalg.norm(run[f"line@{LENGTH:g}.force"], axis=1)
    end = time.process_time()
    return tension, end - ready, end - begin


INPUT = f"""---------------------- LINE TYPES -----------------------------------
TypeName   Diam    Mass/m     EA     BA/-zeta    EI         Cd     Ca     CdAx    CaAx
(name)     (m)     (kg/m)     (N)    (N-s/-)     (N-m^2)    (-)    (-)    (-)     (-)
main {DIAMETER} {MASS} {EA:.8e} {EA * DAMPING_TIME:.8e} 0 {ACROSS} {ADDED} {ALONG} 0
---------------------- POINTS -----------------------------
ID Attachment X Y Z M V CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Fixed 0 0 -200 0 0 0 0
2 Coupled {FAR} 0 {HIGH - 200} 0 0 0 0
---------------------- LINES -----------------------------------------
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name) (#) (#) (m) (-) (-)
1 main 1 2 {LENGTH} {{segments}} -
---------------------- OPTIONS -----------------------------------------
0 writeLog
rk4 tScheme
{{step}} dtM
{GRAVITY} g
1 disableOutput
1 disableOutTime
200 WtrDpth
{BED_STIFFNESS} kBot
{BED_DAMPING} cBot
1.0 dtIC
20 TmaxIC
4.0 CdScaleIC
1e-4 threshIC
--------------------- need this line ------------------
"""


@contextlib.contextmanager
def without_output() -> Iterator[None]:
    """Discard what the process prints, also in C."""
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)


def theirs(segments: int, step: float, coupling: float) -> Found:
    """Run MoorDyn by a Runge-Kutta method of order 4; step: its largest step; coupling: interval of its calls, s."""
    import moordyn

    begin = time.process_time()
    with tempfile.TemporaryDirectory() as folder, without_output():
        path = Path(folder) / "line.txt"
        path.write_text(INPUT.format(segments=segments, step=step), encoding="ascii")
        system = moordyn.Create(str(path))
        moordyn.SetVerbosity(system, moordyn.LEVEL_NONE)
        moordyn.Init(system, [FAR, 0, HIGH - 200], [0, 0, 0])
    ready = time.process_time()
    force, omega = np.zeros((round(DURATION / coupling) + 1, 3)), 2 * np.pi / PERIOD
    for k in range(len(force) - 1):
        t = k * coupling
        place = FAR + AMPLITUDE - AMPLITUDE * np.cos(omega * t)
        force[k + 1] = moordyn.Step(system, [place, 0, HIGH - 200], [AMPLITUDE * omega * np.sin(omega * t), 0, 0], t,
                                    coupling)
    end = time.process_time()
    moordyn.Close(system)
    return np.linalg.norm(force, axis=1)[:: round(OUTPUT / coupling)], end - ready, end - begin


def settled(tension: np.ndarray) -> np.ndarray:
    """Return the tension from the settled time on."""
    return tension[round(SETTLED / OUTPUT):]


def distance(tension: np.ndarray, reference: np.ndarray) -> float:
    """Return the largest difference over the range of the reference."""
    return float(np.abs(settled(tension) - settled(reference)).max() / np.ptp(settled(reference)))


@cache
def converged_ours(elements: int) -> np.ndarray:
    """Return the converged tension of funicular."""
    return ours(elements, tol=1e-5, integrator="genalpha")[0]


@cache
def converged_theirs(segments: int, step: float) -> np.ndarray:
    """Return the limit of MoorDyn's tension at two meshes of order 2, coupled every 0.01 s."""
    coarse, fine = (theirs(n, h, 0.01)[0] for n, h in ((segments // 2, 2 * step), (segments, step)))
    return fine + (fine - coarse) / 3


OURS: list[tuple[int | tuple[float, ...], dict]] = [
    *((mesh, {"integrator": "genalpha", "step": h})
      for mesh, h in ((4, 0.1), (6, 0.1), (10, 0.1), (NODES, 0.1), (16, 0.1), (20, 0.05))),
    *((n, {"integrator": one, "tol": tol}) for n, tol in ((6, 1e-2), (10, 1e-3)) for one in ("genalpha", "auto"))]
THEIRS = [(5, 0.05, 0.1), (10, 0.025, 0.1), (20, 0.02, 0.1), (10, 0.025, 0.025), (20, 0.02, 0.02), (40, 0.01, 0.01)]
"""Segments, step near the limit of stability and interval of calls, s."""


def main() -> None:
    """Measure and print."""
    options = parser(__doc__, repetitions=(3, "runs of each setting, the least time of which counts"),
                     elements=(80, "of the converged mesh; MoorDyn's has twice as many", 8)).parse_args()
    warnings.simplefilter("ignore")
    reference = converged_ours(options.elements)
    limit = converged_theirs(2 * options.elements, 0.05 / options.elements)
    cases: list[tuple[str, int, str, Callable[[], Found], np.ndarray]] = []
    for mesh, settings in few(OURS):
        said = ", ".join(f"{key} {value}" if key != "integrator" else value for key, value in settings.items())
        n, graded = (mesh, "") if isinstance(mesh, int) else (len(mesh) - 1, ", graded")
        cases.append(("funicular", n, said + graded, partial(ours, mesh, **settings), reference))
    cases += [("MoorDyn", n, f"rk4, step {h}, calls {c}", partial(theirs, n, h, c), limit) for n, h, c in few(THEIRS)]
    taken: list[list[Found]] = [[] for _ in cases]
    for _ in range(options.repetitions):
        for found, case in zip(taken, cases, strict=True):
            found.append(case[3]())
    show([{"code": code, "elements": n, "setting": said, "error": distance(found[0][0], own),
           "run, CPU s": min(each[1] for each in found), "whole call, CPU s": min(each[2] for each in found)}
          for (code, n, said, _, own), found in zip(cases, taken, strict=True)], options.out)
    print()
    show([{"the converged tensions": "of both codes", "distance over the range": distance(limit, reference),
           "range, N": float(np.ptp(settled(reference))), "largest, N": float(settled(reference).max())}],
         table="converged")


if __name__ == "__main__":
    main()
