"""Figures of speed that the project aims at, beside those of the records.

    python tests/benchmarks/aims.py [--run] [--out FILE.csv]

--run first runs the scripts of these records one after the other, each with --json. The first result of a process is
measured here: it imports funicular, loads and runs a bundled scene, and reads a result; CPU seconds and the largest
memory, the least of five, with the byte code that an installation has.

Errors stand beside the times in the tables of the scripts: a ratio to another code is that at the error named, or at a
smaller one of funicular; spans of a catenary count where the standard deviation of the contact force is within 1 % of
that by the equations of the wires; an integrator is the best one where it keeps tol.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import records
from printed import FOLDER
from table import few, parser, show

Row = dict[str, Any]
SCRIPTS = {"exudyn_whole_calls": (), "mooring_lines": (), "relaxation": (), "pantographs": ("--what", "linear"),
           "choice": ("--every", "--repetitions", "3"), "many_parts": (), "contact": (), "many_scenes": (),
           "lazy_wave": ()}
"""Scripts whose records are read, with their options."""
FIRST_RESULT = """
import resource
import funicular as fu
fu.load_scene("paper51").run(progress=False)["A.position"]
used = resource.getrusage(resource.RUSAGE_SELF)
print(used.ru_utime + used.ru_stime, used.ru_maxrss / 1e3)
"""


def rows(script: str, table: str = "measured", **where: Any) -> list[Row]:
    """Return the recorded rows with these values."""
    found = records.load(records.FOLDER / f"{script}.json")[table]["rows"]
    return [row for row in found if all(row[key] == value for key, value in where.items())]


def whole(case: str, elements: int, error: float, what: str = "call") -> float:
    """Return the ratio of CPU time of Exudyn over that of funicular, of whole calls or of the solver."""
    return rows("exudyn_whole_calls", case=case, elements=elements, error=error)[0][f"times faster, {what}"]


def mooring(error: float, setting: str = "") -> float:
    """Return the least CPU time of a mooring line by funicular below an error."""
    return min(row["run, CPU s"] for row in rows("mooring_lines", code="funicular")
               if row["error"] <= error and row["setting"].startswith(setting))


def beside_moordyn(elements: int) -> float:
    """Return the ratio to the run of MoorDyn with this number of segments and its finest step, at its error."""
    theirs = rows("mooring_lines", code="MoorDyn", elements=elements)[-1]
    return theirs["run, CPU s"] / mooring(theirs["error"])


def automatic_mooring() -> float:
    """Return the largest ratio of "auto" to the same tolerance of generalised-alpha."""
    of = {row["setting"]: row["run, CPU s"] for row in rows("mooring_lines", code="funicular")}
    return max(of[name] / of[name.replace("auto", "genalpha")] for name in of if name.startswith("auto"))


def passage(kmh: int) -> float:
    """Return CPU seconds a second of the cheapest setting within 1 %."""
    found = [row for row in rows("pantographs", "linear", **{"km/h": kmh}) if row["sigma"]]
    exact = next(row["sigma"] for row in found if row["what"].startswith("genalpha"))
    return min(row["cpu s/s"] for row in found if abs(row["sigma"] / exact - 1) <= 0.01)


def of_the_best(limit: float) -> float:
    """Return the share of cells in % where "auto" costs at most so many times the best integrator that keeps tol."""
    found = rows("choice", "cost over the best")
    return 100 * (1 - sum(row[f"above {limit:g}"] for row in found) / sum(row["of"] for row in found))


def part(scene: str, parts: int) -> Row:
    """Return the row of a scene of many parts."""
    return rows("many_parts", scene=scene, parts=parts)[0]


def scenes(integrator: str) -> float:
    """Return scenes a second and core of the first scene by the cheapest method on one."""
    return max(row["scenes per CPU s"] for row in rows("many_scenes", scene="first scene")
               if row["method"].startswith(integrator))


def lazy_wave(integrator: str) -> float:
    """Return the CPU time of a heaving cable with tol 0.01, with added mass."""
    return rows("lazy_wave", setting=f"{integrator}, tol 0.01", **{"added mass": "1.0"})[0]["run, CPU s"]


@dataclass(frozen=True)
class Aim:
    """A figure that is aimed at: at most ``aim``, or at least where larger figures are better."""

    what: str
    unit: str
    measured: Callable[[], float]
    aim: float
    is_least: bool = False

    def row(self) -> Row:
        """Return the row of the table."""
        found = float(self.measured())
        reached = found >= self.aim if self.is_least else found <= self.aim
        return {"figure": self.what, "unit": self.unit, "measured": found,
                "aim": f"{'≥' if self.is_least else '≤'} {self.aim:g}", "reached": "yes" if reached else "no"}


FASTER = "times faster than Exudyn"
AIMS = [
    *(Aim(f"sliding mass of 3 elements, whole call, error {error:g}", FASTER,
          lambda error=error: whole("sliding mass", 3, error), aim, True) for error, aim in ((1e-2, 2), (1e-3, 3))),
    *(Aim(f"the same, solver alone, error {error:g}", FASTER,
          lambda error=error: whole("sliding mass", 3, error, "solver"), 5, True) for error in (1e-2, 1e-3)),
    *(Aim(f"pendulum of {elements} elements, whole call, error 0.001", FASTER,
          lambda elements=elements: whole("pendulum, E 2e+06", elements, 1e-3), aim, True)
      for elements, aim in ((8, 5), (32, 8))),
    Aim("first result of a process", "CPU s", lambda: rows("aims", "first result")[0]["CPU s"], 0.4),
    Aim("first result of a process", "MB", lambda: rows("aims", "first result")[0]["MB"], 70),
    *(Aim(f"mooring line at the error of {elements} segments of MoorDyn", "times faster than MoorDyn",
          lambda elements=elements: beside_moordyn(elements), 3, True) for elements in (20, 40)),
    Aim('mooring line by "auto"', "times the CPU of genalpha", automatic_mooring, 1.3),
    Aim("equilibrium of a line", "ms", lambda: rows("relaxation", "at rest", scene="line of 20 elements")[0]["ms"], 5),
    *(Aim(f"ten spans of a catenary at {kmh} km/h, σ within 1 %", "CPU s/s", lambda kmh=kmh: passage(kmh), 0.3)
      for kmh in (250, 300)),
    Aim('"auto" at most 1.2 times the best integrator', "% of 180 runs", lambda: of_the_best(1.2), 90, True),
    Aim('"auto" at most 1.5 times the best integrator', "% of 180 runs", lambda: of_the_best(1.5), 100, True),
    Aim("200 slides on a cable", "µs a step and slide",
        lambda: part("slides, 0.1 ms", 200)["us_per_step_and_part"], 4),
    Aim("net of 1,024 bodies", "ms a step", lambda: 1.024 * part("net, 1 ms", 1024)["us_per_step_and_part"], 4),
    Aim("net of 1,024 bodies", "MB", lambda: part("net, 1 ms", 1024)["MB"], 80),
    Aim("10,000 pairs far apart", "ms a step more",
        lambda: 1e-3 * float(rows("contact", "far apart")[0]["step, us more"]), 0.06),
    Aim("10,000 pairs far apart", "s to add", lambda: float(rows("contact", "far apart")[0]["add, s"]), 0.1),
    *(Aim(f"first scene by {name}", "scenes a second and core", lambda name=name: scenes(name), aim, True)
      for name, aim in (("genalpha", 300), ("auto", 200))),
    *(Aim(f"heaving lazy-wave cable of 150 elements, 36 s, by {name}", "CPU s", lambda name=name: lazy_wave(name), aim)
      for name, aim in (("genalpha", 0.5), ("auto", 0.6)))]


def first_result() -> Row:
    """Return CPU seconds and memory of the first result of a process."""
    given = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    found = [tuple(map(float, subprocess.run([sys.executable, "-c", FIRST_RESULT], check=True, capture_output=True,
                                             text=True, env=given).stdout.split())) for _ in few(range(5))]
    return {"process": "import, load and run paper51, one result", "CPU s": min(cpu for cpu, _ in found),
            "MB": min(size for _, size in found)}


def main() -> None:
    """Print the tables."""
    command = parser(__doc__)
    command.add_argument("--run", action="store_true", help="first renew the records of the scripts")
    given = command.parse_args()
    for script, options in SCRIPTS.items() if given.run else ():
        subprocess.run([sys.executable, str(FOLDER / f"{script}.py"), *options, "--json"], check=True)
    show([first_result()], None, "first result")
    show([aim.row() for aim in few(AIMS)], given.out, "aims")


if __name__ == "__main__":
    main()
