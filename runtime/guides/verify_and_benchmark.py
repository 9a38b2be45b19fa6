"""
Verify and benchmark
====================

Two commands check the equations, and measure the accuracy that computing time buys.
"""

# %%
# Are the equations right?
# ------------------------
#
# ``funicular verify`` compiles the checked-in C and compares every derivative by four independent methods: 50-digit
# evaluation of the symbolic expression, the complex step, central differences with step control, and invariances such
# as zero energy of a rigid motion. For one element:

import csv
import os
import subprocess
import sys
from pathlib import Path

import matplotlib.pyplot as plt

import funicular as fu


def funicular(*arguments: str) -> str:
    """Return the output of the command."""
    return subprocess.run([sys.executable, "-m", "funicular", *arguments], check=True, capture_output=True, text=True,
                          env={**os.environ, "COLUMNS": "110"}).stdout


report = funicular("verify", "cable8p_green_linear")
print("\n".join(line[:110] for line in report.splitlines()[:12]), "\n...")
print(report.splitlines()[-1])

# %%
# Does the code come from the derivation?
# ---------------------------------------
#
# ``funicular derive --check`` derives in memory and compares with the files, byte by byte. Both commands find a sign
# changed by hand.

print(funicular("derive", "--check", "cable8p").strip().splitlines()[-1])

# %%
# What does accuracy cost?
# ------------------------
#
# ``funicular bench SCENE`` runs a scene over integrators, tolerances and meshes, computes a reference with its own
# error, and tabulates error against CPU time, for time and mesh apart.

funicular("bench", "paper51", "--integrators", "radau,genalpha,explicit", "--tols", "1e-2,1e-3,1e-4,1e-5", "--elements",
          "x1", "--duration", "0.3", "--repetitions", "1", "--out", ".")
with Path("paper51-bench.csv").open(encoding="utf-8") as file:
    rows = list(csv.DictReader(file))

figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
for integrator in dict.fromkeys(row["integrator"] for row in rows):
    own = [row for row in rows if row["integrator"] == integrator]
    axes.loglog([float(row["cpu_s"]) for row in own], [float(row["time_error"]) for row in own], "o-", label=integrator)
axes.axhline(float(rows[0]["mesh_error"]), color="0.6", linestyle=":", label="error of the mesh")
axes.set(xlabel="CPU time in s", ylabel="error over motion", title="paper51, 3 elements, 0.3 s")
axes.legend(frameon=False)

# %%
# Below the dotted line the mesh dominates the error, and a smaller ``tol`` gains nothing. Compare speeds at equal error
# only.

for row in rows:
    print(f"{row['integrator']:9} tol {row['tol']:6} error {float(row['time_error']):.1e} in "
          f"{1e3 * float(row['cpu_s']):.0f} ms, {row['steps']} steps")

# %%
# The errors of one run
# ---------------------
#
# ``estimate=True`` measures both errors by two more runs: with smaller steps, and with twice the elements.

scene = fu.load_scene("paper51")
run = scene.run(duration=0.3, output_step=0.02, tol=1e-3, estimate=True)
errors = run.report["errors"]
print(f"steps {errors['time']:.1e}, mesh {errors['mesh']:.1e}, both {errors['both']:.1e} of the largest motion")
assert errors["time"] < 1e-3 < errors["mesh"]

# %%
# This mesh is too coarse for the ``tol``. The guide on choosing a model finds a sufficient one.
#
# ``quantities`` names the results whose error controls the steps; ``absolute_tol`` in m is permitted beside ``tol``.
# Vibrations of other results then cost no steps. Leave both out where the whole motion counts.

named = scene.run(duration=0.3, output_step=0.02, tol=1e-3, absolute_tol=1e-4, quantities=["A.position"])
print(*named.report["messages"], sep="\n")
