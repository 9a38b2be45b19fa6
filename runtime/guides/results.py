"""
Results as arrays, datasets and tables
======================================

A run holds named NumPy arrays. ``run.dataset`` gives them units and dimensions as an xarray dataset, for selection,
combination and plots.
"""

# %%
# Names
# -----
#
# ``run.keys()`` lists all results. ``run.variables`` gives meaning, unit and dimensions of each. The error for an
# unknown name lists similar ones.

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

scene = fu.load_scene("paper51")
run = scene.run(duration=1.0, tol=1e-4, output_step=0.01)
for name in run.keys()[:8]:
    dims, _, unit, meaning = run.variables[name]
    print(f"{name:24} {unit:12} {meaning}, over {', '.join(dims)}")

try:
    run["trolley.forse"]
except fu.UnknownResultError as error:
    print(error)

# %%
# NumPy
# -----
#
# Time is the first dimension, components are the last. The lowest position of the body, its time, and the speed then:

height = run["A.position"][:, 1]
lowest = int(height.argmin())
print(f"{1e3 * height[lowest]:.1f} mm at t = {run.time[lowest]:.2f} s, "
      f"at {np.linalg.norm(run['A.velocity'][lowest]):.2f} m/s")

# %%
# Forces in sections
# ------------------
#
# ``section_forces`` returns a dataset over time and s: force and moment, tension, shear, strain, curvature. The balance
# with loads and inertia makes them accurate on coarse meshes.

forces = run.section_forces("wire", s=np.linspace(0.01, 1.49, 75))
then = forces.isel(time=lowest)
figure, (tension, moment) = plt.subplots(1, 2, figsize=(9, 3.2), layout="constrained")
then.tension.plot(ax=tension)
tension.set(xlabel="s in m", ylabel="N", title=f"tension at t = {run.time[lowest]:.2f} s")
then.moment.sel(xyz="z").plot(ax=moment)
moment.axvline(run["trolley.s"][lowest], color="0.6", linestyle=":")
moment.set(xlabel="s in m", ylabel="N m", title="bending moment")

# %%
# xarray
# ------
#
# ``run.dataset`` selects by name and time, averages and interpolates.

dataset = run.dataset
mean = float(dataset["trolley.force"].sel(time=slice(0.2, 0.8), xyz="y").mean())
print(f"mean force on the body from 0.2 to 0.8 s, upwards: {mean:.2f} N")
print(dataset["wire.nodal_vectors"].dims, dataset["wire.nodal_vectors"].attrs["units"])

# %%
# Several runs along a new dimension
# ----------------------------------
#
# ``fu.combine`` makes one dataset of runs with equal results and times. It includes the reports.

masses = [0.5, 1.0, 2.0]
study = fu.combine([scene.replace("A", mass=mass).run(duration=1.0, tol=1e-4, output_step=0.01) for mass in masses],
                   mass=masses)
sag = study["A.position"].sel(xyz="y").min(dim="time")
print({float(m): f"{1e3 * float(v):.1f} mm" for m, v in zip(sag.mass, sag, strict=True)})
assert np.all(np.diff(sag) < 0)  # the heavier the body, the lower it gets

# %%
# A table
# -------
#
# With pandas, ``dataset[...].to_dataframe()`` makes a table. NumPy alone writes a file for a spreadsheet.

columns = np.column_stack([run.time, run["trolley.s"], run["trolley.force"][:, 1]])
np.savetxt("trolley.csv", columns, delimiter=",", header="time_s,s_m,force_y_N", comments="", fmt="%.9g")
print(open("trolley.csv").readline().strip())

# %%
# The file
# --------
#
# ``run.save("paper51.nc")`` writes netCDF. ``fu.load_run`` opens it as a run, ``xarray.open_dataset`` as a dataset.

run.save("paper51.nc")
again = fu.load_run("paper51.nc")
assert np.array_equal(again["A.position"], run["A.position"])
print(again)
