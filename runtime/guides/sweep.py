"""
Sweeps: one scene for many values
=================================

How far does a cable sag under a trolley, for which stiffness and friction? A sweep runs a scene for all combinations of
values into one labelled dataset. Samples of uncertain values give the scatter of a result.
"""

# %%
# A grid
# ------
#
# Parameters are paths into the scene, by the names of scene files. ``keep`` names results, or functions of the run.
# ``workers=0`` computes in this process; otherwise Dask distributes the points over all cores (``pip install
# 'funicular[sweep]'``). The command is ``funicular sweep paper51 --set wire.material.youngs_modulus=3e8:5e8:5 --set
# trolley.friction.coefficient=0,0.1,0.2 --keep A.position,trolley.force``.

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

scene = fu.load_scene("paper51")
folder = Path(tempfile.mkdtemp())
stiffness, friction = "wire.material.youngs_modulus", "trolley.friction.coefficient"
settings = {"duration": 0.6, "output_step": 0.02, "tol": 1e-3, "workers": 0, "progress": False}


def sag(run: fu.Run) -> float:
    """Return the lowest height of the body, in m below its start."""
    return -run["A.position"][:, 1].min()


parameters = {stiffness: np.linspace(3e8, 5e8, 5), friction: [0.0, 0.1, 0.2]}
grid = fu.sweep(scene, parameters, keep={"position": "A.position", "force": "trolley.force", "sag": sag},
                save=folder / "grid.nc", on_cost=print, **settings)
print(grid)

# %%
# The parameters are dimensions, for selection by value. The numbers equal those of single runs, bit for bit.

point = grid.sel({stiffness: 4e8, friction: 0.1})
alone = scene.replace("trolley", friction=fu.Friction(coefficient=0.1)).run(duration=0.6, output_step=0.02, tol=1e-3)
assert np.array_equal(point["position"], alone["A.position"])

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
for mu in grid[friction].values:
    left.plot(grid[stiffness] / 1e9, 1e3 * grid["sag"].sel({friction: mu}), "o-", label=f"friction {mu:g}")
    right.plot(grid.time, grid["position"].sel({stiffness: 4e8, friction: mu}, method="nearest").sel(xyz="x"))
left.set(xlabel="Young's modulus in GPa", ylabel="mm", title="sag under the trolley")
right.set(xlabel="time in s", ylabel="x in m", title="position of the trolley, at 0.4 GPa")
left.legend(frameon=False)
assert np.all(np.diff(grid["sag"], axis=0) < 0)  # the stiffer the cable, the less it sags
assert np.all(np.diff(grid["position"].isel(time=-1).sel(xyz="x"), axis=1) < 0)  # friction holds the trolley back

# %%
# Interruption
# ------------
#
# Each point is in the file as soon as it is computed. The same call continues an interrupted sweep and opens a finished
# one. A different sweep into the same file is refused.

again = fu.sweep(scene, parameters, keep={"position": "A.position", "force": "trolley.force", "sag": sag},
                 save=folder / "grid.nc", **settings)
assert again.attrs["finished"] == 15 and again["seconds"].equals(grid["seconds"])
try:
    fu.sweep(scene, {friction: [0.3]}, keep=["A.position"], save=folder / "grid.nc", **settings)
except fu.ResultFileError as error:
    print(error)

# %%
# Failed points
# -------------
#
# At 6 m/s the trolley leaves the cable. That point has its error message and NaN; the others continue.

speeds = fu.sweep(scene, {"A.velocity.x": [0.5, 1.0, 6.0]}, keep={"sag": sag}, **settings)
for speed, status, message in zip(speeds["A.velocity.x"].values, speeds.status.values, speeds.message.values,
                                  strict=True):
    print(f"{speed:g} m/s: {status} {message}")
assert list(np.isnan(speeds["sag"])) == [False, False, True]

# %%
# Samples
# -------
#
# A Latin hypercube fills the ranges of several uncertain values evenly, along one dimension ``point``. Mass and density
# vary by a tenth, the start by 0.1 m/s. Frozen distributions of scipy.stats give other kinds of scatter.

uncertain = {"A.mass": fu.Uniform(0.9, 1.1), "wire.material.density": fu.Uniform(3780, 4620),
             "A.velocity.x": fu.Uniform(0.9, 1.1)}
samples = fu.sweep(scene, uncertain, method="latin", samples=40, seed=1, keep={"sag": sag}, **settings)
print(f"sag: {1e3 * float(samples.sag.mean()):.1f} mm, standard deviation {1e3 * float(samples.sag.std()):.2f} mm")

figure, axes = plt.subplots(1, 3, figsize=(9, 3), sharey=True, layout="constrained")
for axis, name in zip(axes, uncertain, strict=True):
    axis.plot(samples[name], 1e3 * samples.sag, ".")
    correlation = np.corrcoef(samples[name], samples.sag)[0, 1]
    axis.set(xlabel=f"{name} in {samples[name].attrs['units']}", title=f"correlation {correlation:.2f}")
axes[0].set(ylabel="sag in mm")

# %%
# The weight matters most.

assert np.corrcoef(samples["wire.material.density"], samples.sag)[0, 1] > 0.8
assert np.corrcoef(samples["A.velocity.x"], samples.sag)[0, 1] < -0.3

# %%
# Your own loop
# -------------
#
# ``fu.run_many`` runs the scenes of a list on threads. It returns the error of a scene that fails.

variants = [scene.replace("A", mass=mass) for mass in (0.5, 1.0, 2.0)]
for kept in fu.run_many(variants, keep=["A.position"], duration=0.6, tol=1e-3):
    print(kept if isinstance(kept, fu.FunicularError) else f"{1e3 * kept['A.position'][:, 1].min():.1f} mm")
