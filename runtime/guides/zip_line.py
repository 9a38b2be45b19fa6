"""
Zip line with friction and a buffer
===================================

A rider of 80 kg runs down 120 m of steel rope and brakes into a spring buffer. The guide computes the speed, the stroke
of the buffer, and the force on the anchor.
"""

# %%
# The rope
# --------
#
# The steel rope of 12 mm spans platforms 12 m apart in height. The bending stiffness of its wires is far below that of
# a bar, so that area and second moment are given. ``rest_length`` is 0.2 m less than the distance of the pins: the rope
# is taut without load.

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

START, END = np.array([0.0, 12.0, 0.0]), np.array([120.0, 0.0, 0.0])

scene = fu.Scene(gravity=(0, -9.81, 0))
rope = scene.cable("rope", start=START, end=END, rest_length=120.4, elements=24, element="cable8p",
                   section=fu.GeneralSection(area=7.2e-5, second_moment_about_z=1e-10),
                   material=fu.Material(youngs_modulus=1e11, poisson_ratio=0.3, density=8600,
                                        damping_time=1e-3, mass_damping=0.1))
scene.pin(rope, s=0.0)
scene.pin(rope, s=120.4)

# %%
# Trolley and rider
# -----------------
#
# The rider hangs 1.2 m below the trolley from a swivel. Both start 3 m down the rope.

along = (END - START) / np.linalg.norm(END - START)
at = START + 3.0 / 120.4 * (END - START)
trolley = scene.rigid_body("trolley", mass=4.0, inertia=(0.02, 0.05, 0.05), position=at)
rider = scene.rigid_body("rider", mass=80.0, inertia=(8, 2, 8), position=at - np.array([0, 1.2, 0]))
scene.joint("revolute", trolley, (rider, (0, 1.2, 0)), name="swivel")

# %%
# The rolling resistance is 1 % of the force across the rope; air drag is a force against the speed. The buffer on the
# last 9 m of the rope has a spring and a damper.

wheels = scene.slide(trolley, along=rope, s=3.0, name="wheels",
                     friction=fu.Friction(rolling=0.01, viscous=2.0, velocity=0.01),
                     at_end=fu.Buffer(length=9.0, stiffness=350.0, damping=120.0))

# %%
# The ride
# --------

run = scene.run(duration=25.0, tol=1e-4, output_step=0.05)
print(run.summary())
for event in run.events:
    print(f"{event['name']} {event['what']} at t = {event['time']:.2f} s, s = {event['s']:.2f} m")

# %%
# The rope is loaded suddenly and swings. The buffer throws the rider back.

s, speed = run["wheels.s"], run["wheels.s_rate"]
tension = run.section_forces(rope, s=wheels).tension

figure, axes = plt.subplots(3, 1, figsize=(8, 6.5), sharex=True, layout="constrained")
axes[0].plot(run.time, s)
axes[0].axhline(120.4 - 9.0, color="0.6", linestyle=":", label="buffer begins")
axes[0].set(ylabel="s in m", title="place on the rope")
axes[0].legend(frameon=False)
axes[1].plot(run.time, 3.6 * speed)
axes[1].set(ylabel="km/h", title="speed along the rope")
axes[2].plot(run.time, 1e-3 * tension)
axes[2].set(xlabel="time in s", ylabel="kN", title="tension of the rope beside the rider")

# %%
# Design values
# -------------
#
# They are the largest force on the anchor and the stroke.

anchor = np.linalg.norm(run["rope@0.force"], axis=1)
stroke = s.max() - (120.4 - 9.0)
print(f"largest speed {3.6 * speed.max():.1f} km/h, at s = {s[speed.argmax()]:.0f} m")
print(f"upper anchor: {1e-3 * anchor.max():.2f} kN at t = {run.time[anchor.argmax()]:.1f} s")
print(f"stroke of the buffer: {stroke:.2f} m of 9 m")

# %%
# A finer mesh and tolerance change the stroke by millimetres.

finer = scene.replace("rope", elements=48).run(duration=25.0, tol=1e-5, output_step=0.05)
change = finer["wheels.s"].max() - s.max()
print(f"with 48 elements and tol 1e-5 the stroke changes by {1e3 * change:.1f} mm")
assert abs(change) < 0.02

# %%
# A heavier rider
# ---------------
#
# ``replace`` returns a scene with one part changed. The runs form one dataset along a new dimension.

masses = [50.0, 80.0, 110.0]
runs = [scene.replace("rider", mass=mass).run(duration=25.0, tol=1e-3, output_step=0.05) for mass in masses]
rides = fu.combine(runs, mass=masses)
for mass in masses:
    ride = rides.sel(mass=mass)
    print(f"{mass:.0f} kg: {3.6 * float(ride['wheels.s_rate'].max()):.1f} km/h, "
          f"stroke {float(ride['wheels.s'].max()) - 111.4:.2f} m")
