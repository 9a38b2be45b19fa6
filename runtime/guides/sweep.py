"""
Sweeps: one scene at many values
================================

How far does a cable sag under a trolley, for which stiffness and which friction? A sweep runs the scene at all
combinations, on all cores, into one labelled dataset; and samples of uncertain values tell how uncertain an answer is.
"""

# %%
# A grid
# ------
#
# Parameters are paths into the scene, by the names of scene files. ``keep`` names the results to keep; a function of
# the run makes a number of it. ``workers=0`` computes here; without it, all cores share the points by Dask (``pip
# install 'funicular[sweep]'``). On the command line: ``funicular sweep paper51 --set
# wire.material.youngs_modulus=3e8:5e8:5 --set trolley.friction.coefficient=0,0.1,0.2 --keep A.position,trolley.force``.

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
# Dimensions are the parameters, so that one selects by value. The numbers are those of single runs, bit for bit.

point = grid.sel({stiffness: 4e8, friction: 0.1})
alone = scene.replace("trolley", friction=fu.Friction(coefficient=0.1)).run(duration=0.6, output_step=0.02, tol=1e-3)
assert np.array_equal(point["position"], alone["A.position"])

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
for mu in grid[friction].values:
    left.plot(grid[stiffness] / 1e9, 1e3 * grid["sag"].sel({friction: mu}), "o-", label=f"friction {mu:g}")
    right.plot(grid.time, grid["position"].sel({stiffness: 4e8, friction: mu}, method="nearest").sel(xyz="x"))
left.set(xlabel="Young's modulus in GPa", ylabel="mm", title="sag under the trolley")
right.set(xlabel="time in s", ylabel="x in m", title="the trolley's way, at 0.4 GPa")
left.legend(frameon=False)
assert np.all(np.diff(grid["sag"], axis=0) < 0)  # the stiffer the cable, the less it sags
assert np.all(np.diff(grid["position"].isel(time=-1).sel(xyz="x"), axis=1) < 0)  # friction holds the trolley back

# %%
# Stop, go on
# -----------
#
# Points are in the file as soon as they are computed. The same call goes on with a sweep that was stopped, also by a
# power cut, and computes no point twice; a finished one is opened at once. Another sweep into the file is refused.

again = fu.sweep(scene, parameters, keep={"position": "A.position", "force": "trolley.force", "sag": sag},
                 save=folder / "grid.nc", **settings)
assert again.attrs["finished"] == 15 and again["seconds"].equals(grid["seconds"])
try:
    fu.sweep(scene, {friction: [0.3]}, keep=["A.position"], save=folder / "grid.nc", **settings)
except fu.ResultFileError as error:
    print(error)

# %%
# Points that fail
# ----------------
#
# At 6 m/s the trolley runs off the cable's end. That point has its error and NaN; the others go on.

speeds = fu.sweep(scene, {"A.velocity.x": [0.5, 1.0, 6.0]}, keep={"sag": sag}, **settings)
for speed, status, message in zip(speeds["A.velocity.x"].values, speeds.status.values, speeds.message.values,
                                  strict=True):
    print(f"{speed:g} m/s: {status} {message}")
assert list(np.isnan(speeds["sag"])) == [False, False, True]

# %%
# Samples
# -------
#
# A Latin hypercube fills the ranges of several uncertain values evenly. Here mass and density vary by a tenth, the
# start by 0.1 m/s; there is then one dimension, ``point``, with the parameters along it. For other kinds of scatter
# give a frozen distribution of scipy.stats.

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
# The cable's own weight counts most, then how fast the trolley is across: at 1 kg it is a twelfth of the cable.

assert np.corrcoef(samples["wire.material.density"], samples.sag)[0, 1] > 0.8
assert np.corrcoef(samples["A.velocity.x"], samples.sag)[0, 1] < -0.3

# %%
# Your own loop
# -------------
#
# ``fu.run_many`` runs scenes that a program makes, on threads. A scene that fails is returned as its error.

variants = [scene.replace("A", mass=mass) for mass in (0.5, 1.0, 2.0)]
for kept in fu.run_many(variants, keep=["A.position"], duration=0.6, tol=1e-3):
    print(kept if isinstance(kept, fu.FunicularError) else f"{1e3 * kept['A.position'][:, 1].min():.1f} mm")
