"""
Long runs: save, stop, resume
=============================

Long runs write their results to a file while they compute. A run that was stopped resumes to the same numbers, bit for
bit.
"""

# %%
# The scene
# ---------
#
# A cable of thirty elements falls from the horizontal and swings without damping for a minute.

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

scene = fu.Scene(gravity=(0, -9.81, 0))
scene.cable("cable", start=(0, 0, 0), end=(1, 0, 0), elements=30, element="cable8p", section=fu.Circle(radius=0.01),
            material=fu.Material(youngs_modulus=2e7, poisson_ratio=0.3, density=1200))
scene.pin("cable", s=0.0)
folder = Path(tempfile.mkdtemp())
settings = {"duration": 60.0, "output_step": 0.05, "tol": 1e-3, "integrator": "genalpha"}

# %%
# Results on disk
# ---------------
#
# With ``save``, rows go to a netCDF file about every half second, and a checkpoint ``long.nc.state`` stands beside it.
# The progress function of this run stops it, as Ctrl-C, a killed process or a full disk would.


class EnoughError(Exception):
    """The stand-in for a power cut."""


def until_40_seconds(time: float) -> None:
    """Stop the run once it has reached 40 s of motion."""
    if time > 40.0:
        raise EnoughError


try:
    scene.run(**settings, save=folder / "long.nc", progress=until_40_seconds)
except EnoughError:
    print("stopped; in the folder:", *sorted(path.name for path in folder.iterdir()))

unfinished = fu.load_run(folder / "long.nc")
print(f"{unfinished.status}: {len(unfinished.time)} rows, up to t = {unfinished.time[-1]:.2f} s")

# %%
# Resume
# ------
#
# ``resume=True`` continues with the same scene and settings. The command is ``funicular run long.toml -o long.nc
# --resume``.

run = scene.run(**settings, save=folder / "long.nc", resume=True)
print(f"{run.status}: {len(run.time)} rows")

# %%
# The numbers equal those of an uninterrupted run.

whole = scene.run(**settings)
for name in ("cable.nodal_vectors", "energy.elastic"):
    assert np.array_equal(run[name], whole[name]), name
print("bit for bit the same")

# %%
# Drift
# -----
#
# An integrator should not change the energy over many swings. ``"genalpha"`` damps vibrations that its step does not
# resolve; ``"energy"`` keeps energy and momenta to rounding, at a fixed step too.

kept = scene.run(duration=60.0, output_step=0.05, step=2e-3, integrator="energy")
figure, axes = plt.subplots(figsize=(8, 3.2), layout="constrained")
for name, each in {'"genalpha", tol 1e-3': run, '"energy", step 2 ms': kept}.items():
    total = sum(each[f"energy.{kind}"] for kind in ("kinetic", "elastic", "potential"))
    exchanged = each.energy_balance().exchanged
    axes.plot(each.time, (total - total[0]) / exchanged, label=name)
    print(f"{name}: total energy changed by {abs(total - total[0]).max() / exchanged:.1e} of the energy exchanged")
axes.set(xlabel="time in s", ylabel="change of the total energy", title="relative to the energy exchanged")
axes.legend(frameon=False)

# %%
# Contents of the file
# --------------------
#
# The file contains scene, settings and report. Every row has a checksum: a damaged file is refused, or read without its
# damaged rows with ``salvage=True``.

print(unfinished.scene.to_toml().splitlines()[0])
print({name: value for name, value in run.report["settings"].items() if name in ("tol", "integrator", "duration")})
