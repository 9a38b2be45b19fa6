"""
First scene
===========

A body of 1 kg slides along a cable of 1.5 m between two pins: example 5.1 of the paper. This guide describes the scene,
runs it, plots it, and measures its errors. It takes a second.
"""

# %%
# Describe
# --------
#
# A scene holds data in SI units. The cable is drawn from ``start`` to ``end`` with three equal elements. The ``height``
# of its section is along ``up``.

import funicular as fu

scene = fu.Scene(gravity=(0, -9.81, 0))
wire = scene.cable("wire", start=(0, 0, 0), end=(1.5, 0, 0), elements=3,
                   section=fu.Rectangle(height=0.05, width=0.05), up=(0, 1, 0),
                   material=fu.Material(youngs_modulus=0.4e9, poisson_ratio=0.0, density=4200))
scene.pin(wire, s=0.0)
scene.pin(wire, s=1.5)

# %%
# The body starts at 0.25 m with 1 m/s. A slide joins its origin to the centreline of the cable; ``s`` is the arc-length
# of the undeformed cable.

body = scene.rigid_body("A", mass=1.0, inertia=(1e-3, 1e-3, 1e-3), position=(0.25, 0, 0), velocity=(1, 0, 0))
scene.slide(body, along=wire, s=0.25, name="trolley")

# %%
# Run
# ---
#
# ``tol`` is the required error of positions, relative to the largest motion. It determines integrator and steps. The
# summary reports both, and the energy balance.

run = scene.run(duration=1.0, tol=1e-5, output_step=0.01)
print(run.summary())

# %%
# Look
# ----
#
# Results are NumPy arrays by name, time first. The body passes the middle, and moves up and down with the cable.

import matplotlib.pyplot as plt

figure, (path, force) = plt.subplots(1, 2, figsize=(9, 3.2), layout="constrained")
path.plot(run["A.position"][:, 0], 1e3 * run["A.position"][:, 1])
path.set(xlabel="x in m", ylabel="y in mm", title="path of the body")
force.plot(run.time, run["trolley.force"][:, 1])
force.axhline(9.81, color="0.6", linestyle=":")
force.set(xlabel="time in s", ylabel="N", title="force on the body, upwards")

# %%
# Trust
# -----
#
# Three numbers measure the quality of a run: the distance of the body from the cable, the energy balance, and the
# difference to a run at a smaller ``tol``.

finer = scene.run(duration=1.0, tol=1e-7, output_step=0.01)
balance = run.energy_balance()
difference = abs(run["A.position"] - finer["A.position"]).max()
print(f"distance of the body to the cable: {run['trolley.residual'].max():.1e} m")
print(f"energy balance: off by {abs(balance.relative).max():.1e} of the energy exchanged")
print(f"difference to a run at tol=1e-7: {difference:.1e} m in a motion of 1 m")
assert difference < 1e-5

# %%
# These are errors in time. A run with more elements measures the error of the mesh.

fine = scene.replace("wire", elements=12).run(duration=1.0, tol=1e-5, output_step=0.01)
mesh = abs(run["A.position"] - fine["A.position"]).max()
print(f"3 elements against 12: {1e3 * mesh:.2f} mm")

# %%
# Keep
# ----
#
# ``run.save("first.nc")`` writes netCDF, which ``fu.load_run`` and xarray open. ``scene.to_toml()`` returns the text of
# a scene file for ``funicular run first.toml``.

print(scene.to_toml()[:160], "...")
