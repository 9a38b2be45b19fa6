"""
Verify and benchmark
====================

Two questions about any result: are the equations right, and how much accuracy does the time buy? One command answers
each.
"""

# %%
# Are the equations right?
# ------------------------
#
# ``funicular verify`` compiles the checked-in C and compares every derivative with what it is the derivative of, by
# four methods that share nothing: 50-digit evaluation of the symbolic expression, the complex step, central differences
# with step control, and invariances such as "a rigid motion stores no energy". For one element:

import csv
import os
import subprocess
import sys
from pathlib import Path

import matplotlib.pyplot as plt

import funicular as fu


def funicular(*arguments: str) -> str:
    """Return what the command prints."""
    return subprocess.run([sys.executable, "-m", "funicular", *arguments], check=True, capture_output=True, text=True,
                          env={**os.environ, "COLUMNS": "110"}).stdout


report = funicular("verify", "cable8p_green_linear")
print("\n".join(line[:110] for line in report.splitlines()[:12]), "\n...")
print(report.splitlines()[-1])

# %%
# Does the code come from the derivation?
# ---------------------------------------
#
# ``funicular derive --check`` derives in memory and compares with the files, byte by byte. One sign changed by hand is
# found here, and by ``verify``, too.

print(funicular("derive", "--check", "cable8p").strip().splitlines()[-1])

# %%
# What does accuracy cost?
# ------------------------
#
# ``funicular bench SCENE`` runs a scene over integrators, tolerances and meshes, computes its own reference and that
# one's error, and tabulates error against CPU time. The error of time and the error of the mesh are told apart.

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
# Below the dotted line a smaller ``tol`` buys nothing: the mesh is what is wrong then. Compare speeds at equal error
# only: a fast run with an error ten times as large is a slow one.

for row in rows:
    print(f"{row['integrator']:9} tol {row['tol']:6} error {float(row['time_error']):.1e} in "
          f"{1e3 * float(row['cpu_s']):.0f} ms, {row['steps']} steps")

# %%
# How far one run is off
# ----------------------
#
# ``estimate=True`` measures both errors of a run by two more: of smaller steps, and on a mesh of twice the elements.

scene = fu.load_scene("paper51")
run = scene.run(duration=0.3, output_step=0.02, tol=1e-3, estimate=True)
errors = run.report["errors"]
print(f"steps {errors['time']:.1e}, mesh {errors['mesh']:.1e}, both {errors['both']:.1e} of the largest motion")
assert errors["time"] < 1e-3 < errors["mesh"]

# %%
# The mesh is too coarse for this ``tol``; the guide on choosing a model shows what finds the right one.
#
# Which errors count is for you to say: ``quantities`` names the results whose error chooses the steps, and
# ``absolute_tol`` in m is allowed beside ``tol``. What rings without being named costs no steps then. Where all of a
# motion counts, leave both out.

named = scene.run(duration=0.3, output_step=0.02, tol=1e-3, absolute_tol=1e-4, quantities=["A.position"])
print(*named.report["messages"], sep="\n")
