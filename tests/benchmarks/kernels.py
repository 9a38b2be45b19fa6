"""Speed of the generated kernels, and of their derivation and compilation.

    python tests/benchmarks/kernels.py [--out FILE.csv] [--repetitions 7] [--derivations 1] [--builds 1]

Every kernel in a C loop on one thread, compiled as the package is, on its verification sample: microseconds per call
(median, and minimum, of alternating repetitions), operations by the manifest, bytes of code; the aim, and the time of
other programs, if known. Then the kernels of several elements at once (blocks.py), CPU seconds to derive each family,
and seconds to build a clean clone without a compiler cache. --derivations 0 and --builds 0 leave the last two out.

The aims: the table's; the whole family derived in 120 s of one core; the build in 60 s.
"""

import json
import tempfile
import tomllib
from pathlib import Path
from statistics import median

import blocks
import making
from funicular.derive.catalogue import families
from funicular.derive.codegen import drift
from funicular.derive.verify import timing
from funicular.derive.verify.compiled import compile_units, compiler
from funicular.generated import described
from funicular.generated import kernels as compiled
from table import Parser, arguments, few, show

AIMS = {
    ("cable12", "elastic_force"): 0.08, ("cable12", "elastic_tangent"): 0.6,
    ("beam24", "elastic_force"): 0.2, ("beam24", "elastic_tangent"): 1.2,
    ("cable8p", "elastic_force"): 0.04, ("cable8p", "elastic_tangent"): 0.3,
    ("beam12p", "elastic_force"): 0.1, ("beam12p", "elastic_tangent"): 0.6,
}
# Measured on a 2-core machine, one thread. Project Chrono's tangents are finite differences for the cable; its 24
# coordinates have a reduced quadrature (pre-integrated). Exudyn's cable includes the assembly.
OTHERS = {
    ("cable12", "elastic_force"): "Chrono 0.367, Exudyn 0.35",
    ("cable12", "elastic_tangent"): "Chrono 4.96, Exudyn 9",
    ("beam24", "elastic_force"): "Chrono 0.322 (quadrature 0.690)",
    ("beam24", "elastic_tangent"): "Chrono 2.59 (quadrature 6.99)",
}


def options() -> list[str]:
    """Return the compiler options of the package's own build."""
    if Parser.smallest:
        return ["-std=c11", "-O0"]
    modules = tomllib.loads((making.ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["setuptools"]
    (given,) = (m["extra-compile-args"] for m in modules["ext-modules"] if m["name"] == "funicular.generated.kernels")
    return ["-std=c11", *(flag for flag in given if flag.startswith("-O"))]


def rows(repetitions: int) -> list[dict]:
    """Return the table of kernels."""
    manifest = json.loads((drift.folder() / "manifest.json").read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as folder:
        flags = [*options(), f"-I{drift.folder()}"]
        measured = few(families().values())
        units = compile_units((drift.folder() / f"{family.name}.c" for family in measured), flags, Path(folder))
        program = timing.build(measured, manifest, compiled, units, flags, Path(folder))
        times, sizes = timing.times(program, repetitions), timing.code_sizes(program)
    every = {name: kernel for name, kernel in described(manifest).items() if name in times}
    none = {operation: 0 for kernel in every.values() for operation in kernel["operations"]}
    found = []
    for name, kernel in every.items():
        of = kernel["family"].partition("_")[0], name.removeprefix(kernel["family"] + "_")
        found.append({"kernel": name, "us": median(times[name]), "least": min(times[name]), "aim": AIMS.get(of, ""),
                      "operations": sum(kernel["operations"].values()), **none | kernel["operations"],
                      "bytes": sizes.get(name, ""), "others_us": OTHERS.get(of, "")})
    return found


def main() -> None:
    """Measure and print."""
    given = arguments(__doc__, repetitions=(7, "of the round of kernels"),
                        derivations=(1, "of every family", 0), builds=(1, "of a clean clone", 0))
    print("compiled with", *compiler(), *options())
    table = rows(given.repetitions)
    show(table, given.out, "kernels")
    over = [f"{row['kernel']} {row['us'] / row['aim']:.2g}" for row in table if row["aim"] and row["us"] > row["aim"]]
    print("over its aim, times:", ", ".join(over) or "none")
    if not given.smallest and (several := blocks.rows(given.repetitions)):  # blocks.py has its own smallest run
        show(several, table="blocks")
    if given.derivations:
        taken = [making.derivation() for _ in range(given.derivations)]
        least = {name: min(times[name] for times in taken) for name in taken[0]}
        print("derived, CPU s:", ", ".join(f"{name} {value:.1f}" for name, value in least.items()))
        print(f"derived, all: {sum(least.values()):.0f} s of one core (aim 120)")
    for _ in range(given.builds):
        wall, cpu = making.build()
        print(f"built: {wall:.0f} s, {cpu:.0f} s of CPU (aim 60)")


if __name__ == "__main__":
    main()
