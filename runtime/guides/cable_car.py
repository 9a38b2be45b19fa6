"""
Cable car over a support
========================

A haulage drives a carriage of two wheels up a track rope, over the support between two spans, and back. A cabin hangs
from the carriage. The guide computes its swing, the power of the drive, and the forces in rope and support.
"""

# %%
# The scene
# ---------
#
# The scene is installed with the package: a locked-coil rope of 40 mm over 200 m, anchored at both towers; a carriage
# on two slides; a cabin of 1.5 t on a hinge 4 m below. A table prescribes the speed. On the support the rope slides
# over a saddle, modelled by an eyelet: a slide whose rider is a point of the ground.

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

scene = fu.load_scene("cable_car")
for slide in scene.slides.values():
    rider = slide.body or "a point of the support"
    print(f"{slide.name}: {rider} on {slide.along} at s = {slide.s:.2f} m, {'driven' if slide.is_driven else 'free'}")
rope = scene.cables["track"]
print(f"rope: {rope.length:.2f} m in {rope.elements} elements of {rope.element}")

# %%
# At rest
# -------
#
# The rope is drawn straight and taut. Under its own weight and the car's it sags:

rest = scene.equilibrium()
tension = rest.section_forces("track").tension
print(f"tension {1e-3 * float(tension.min()):.0f} to {1e-3 * float(tension.max()):.0f} kN; "
      f"the car hangs {scene.bodies['cabin'].position[1] - rest['cabin.position'][1]:.2f} m lower than drawn")

# %%
# The tension is equal on both sides of the saddle.

saddle = float(rest["saddle.s"])
below, above = 1e-3 * rest.section_forces("track", s=[saddle - 8, saddle + 8]).tension.values
print(f"{below:.0f} kN below the saddle, {above:.0f} kN above, "
      f"the saddle bears {1e-3 * np.linalg.norm(rest['saddle.force']):.1f} kN")
assert abs(below / above - 1) < 0.01

# %%
# Up and back
# -----------
#
# ``tol`` is relative to the motion, here 180 m: 1e-5 is 2 mm.

run = scene.run(duration=80.0, tol=1e-5, output_step=0.05, initial=rest)
print(run.summary())

# %%
# The haulage slows down before the support and stops at the top. The cabin swings after each change of speed. The scene
# contains no damping by wind or hinge.

car, cabin = run["carriage.position"], run["cabin.position"]
hang = cabin - car
swing = np.degrees(np.arctan2(hang[:, 0], -hang[:, 1]))
speed = run["upper_wheel.s_rate"]
power = run["upper_wheel.traction"] * speed

figure, axes = plt.subplots(4, 1, figsize=(8, 8.5), sharex=True, layout="constrained")
axes[0].plot(run.time, run["upper_wheel.s"])
axes[0].axhline(101.82, color="0.6", linestyle=":", label="support")
axes[0].set(ylabel="s in m", title="place of the upper wheel")
axes[0].legend(frameon=False)
axes[1].plot(run.time, swing)
axes[1].set(ylabel="degrees", title="swing of the cabin")
axes[2].plot(run.time, 1e-3 * power)
axes[2].set(ylabel="kW", title="power of the haulage")
axes[3].plot(run.time, 1e-3 * np.linalg.norm(run["saddle.force"], axis=1))
axes[3].set(xlabel="time in s", ylabel="kN", title="force between saddle and rope")
print(f"the rope slides over the saddle by {1e3 * np.ptp(run['saddle.s']):.0f} mm; "
      f"swing at most {abs(swing).max():.1f}°, power at most {1e-3 * power.max():.0f} kW, "
      f"back at most {-1e-3 * power.min():.0f} kW")

# %%
# By hand
# -------
#
# In steady motion the haulage lifts the weight of the car. The slope of the track is 0.2 on average.

steady = (run.time > 6) & (run.time < 13)
lift = (180 + 1500) * 9.81 * run["carriage.velocity"][steady, 1]
print(f"mean power between 6 and 13 s {1e-3 * power[steady].mean():.1f} kW, weight lifted {1e-3 * lift.mean():.1f} kW")
assert abs(power[steady].mean() / lift.mean() - 1) < 0.1

# %%
# Sizing
# ------
#
# The largest tension of the whole run sizes the rope. Bending over wheels and saddle adds to its stress.

forces = run.section_forces("track", s=np.linspace(1, 200, 60))
worst = forces.tension.max(dim="time")
print(f"largest tension {1e-3 * float(worst.max()):.0f} kN = {1e-6 * float(worst.max()) / 1.1e-3:.0f} MPa of the metal")

# %%
# Next step: ``scene.replace("cabin", mass=2500)`` makes the cabin heavier.
