"""Files of MoorDyn read as scenes, beside MoorDyn.

    python tests/benchmarks/moordyn_files.py [--out FILE.csv] [--moordyn 1]

One line on a bed, and two lines to a clump weight that a third one holds. MoorDyn 2.7.2 moves to rest, with more water
than in a run at first; --moordyn 1 runs it again, where it is installed (pip install moordyn). CPU in s.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import tempfile
import time
import warnings
from pathlib import Path

import funicular as fu
import numpy as np
from table import arguments, show

HEAD = """--------------------- MoorDyn Input File ------------------------------------
{title}
---------------------- LINE TYPES -----------------------------------
TypeName   Diam    Mass/m     EA     BA/-zeta    EI         Cd     Ca     CdAx    CaAx
(name)     (m)     (kg/m)     (N)    (N-s/-)     (N-m^2)    (-)    (-)    (-)     (-)
"""
POINTS = """---------------------- POINTS -----------------------------
ID Attachment X Y Z M V CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
"""
LINES = """---------------------- LINES -----------------------------------------
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name) (#) (#) (m) (-) (-)
"""
OPTIONS = """---------------------- OPTIONS -----------------------------------------
0 writeLog
rk4 tScheme
{dt} dtM
9.81 g
1 disableOutput
1 disableOutTime
{depth} WtrDpth
3e5 kBot
3e4 cBot
1.0 dtIC
{still} TmaxIC
4.0 CdScaleIC
1e-7 threshIC
--------------------- need this line ------------------
"""
LINE = (HEAD + "main 0.0766 113.35 7.536e8 7.536e5 0 2.0 1.0 0.4 0\n" + POINTS
        + "1 Fixed 0 0 -200 0 0 0 0\n2 Coupled 796.732 0 -14 0 0 0 0\n" + LINES + "1 main 1 2 835.35 {n} -\n" + OPTIONS)
CLUMP = (HEAD + "chain 0.1 150 5e8 -0.8 0 1.6 1.0 0.1 0.0\nrope 0.15 20 1e7 1e5 1000 1.2 1.0 0.1 0.0\n" + POINTS
         + "1 Fixed 0 100 -100 0 0 0 0\n2 Fixed 0 -100 -100 0 0 0 0\n3 Free 120 0 -50 5000 0.8 1.5 0.5\n"
         "4 Coupled 160 0 -10 0 0 0 0\n" + LINES + "1 chain 1 3 170 {n} -\n2 chain 2 3 170 {n} -\n3 rope 3 4 55 {n} -\n"
         + OPTIONS)
CASES = {"a line on a bed": (LINE, {"depth": 200, "dt": 0.0005, "still": 300, "n": 80}, "line_1", (796.732, 0, -14)),
         "lines to a clump weight": (CLUMP, {"depth": 100, "dt": 0.001, "still": 300, "n": 20}, "line_3",
                                     (160, 0, -10))}
"""File, its numbers, the line at the fairlead, and the place of the fairlead, m."""
MOORDYN = {"a line on a bed": (908206.4, 631512.0), "lines to a clump weight": (320500.5, 389212.2)}
"""Forces of MoorDyn 2.7.2 on the fairlead, along and down, N: means of the last 60 s of 360 s."""


def text_of(case: str) -> str:
    """Return the file of a case."""
    text, numbers, *_ = CASES[case]
    return text.format(title=case, **numbers)


def ours(case: str, folder: Path) -> np.ndarray:
    """Return the force on the fairlead at rest, along and down, N."""
    file = folder / "lines.txt"
    file.write_text(text_of(case), encoding="utf-8")
    scene, line = fu.read_moordyn(file), CASES[case][2]
    force = np.asarray(scene.equilibrium()[f"{line}@{scene.cables[line].length:g}.force"])
    return np.abs(force[[0, 2]])


def theirs(case: str, folder: Path) -> np.ndarray:
    """Return that of MoorDyn, N."""
    import moordyn  # which only this needs

    file = folder / "lines.txt"
    file.write_text(text_of(case), encoding="utf-8")
    place = list(map(float, CASES[case][3]))
    system = moordyn.Create(str(file))
    moordyn.SetVerbosity(system, moordyn.LEVEL_NONE)
    moordyn.Init(system, place, [0.0] * 3)
    found = [np.array(moordyn.Step(system, place, [0.0] * 3, float(t), 1.0)) for t in range(360)]
    moordyn.Close(system)
    return np.abs(np.mean(found[-60:], axis=0)[[0, 2]])


def main() -> None:
    """Print the table."""
    given = arguments(__doc__, moordyn=(0, "1: run MoorDyn again", 0))
    warnings.simplefilter("ignore", fu.FunicularWarning)
    rows = []
    for case, known in MOORDYN.items():
        with tempfile.TemporaryDirectory() as folder:
            begin = time.process_time()
            found = ours(case, Path(folder))
            cpu = time.process_time() - begin
            reference = theirs(case, Path(folder)) if given.moordyn else known
        rows += [{"case": case, "force": where, "funicular": value, "MoorDyn 2.7.2": other, "off": value / other - 1,
                  "CPU, s": cpu} for where, value, other in zip(("along, N", "down, N"), found, reference, strict=True)]
    show(rows, given.out)


if __name__ == "__main__":
    main()
