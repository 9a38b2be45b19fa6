"""
Crane with a swinging load
==========================

A trolley travels along a girder and stops. The load swings on its hoisting rope. The guide computes the swing, its
dependence on the speed profile, and the moment in the girder.
"""

# %%
# Girder, trolley, load
# ---------------------
#
# The girder is a steel box of 20 m, pinned at both ends. The trolley is a body on a driven slide: ``velocity``
# prescribes its motion. The load hangs from a distance joint of 6 m, a model of a taut rope without stretch.

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

SPEED, FROM, TO = 1.5, 3.0, 15.0
AREA = 0.05

scene = fu.Scene(gravity=(0, -9.81, 0))
girder = scene.cable("girder", start=(0, 0, 0), end=(20, 0, 0), elements=8, element="cable8p",
                     section=fu.GeneralSection(area=AREA, second_moment_about_z=5e-3),
                     material=fu.Material(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850, damping_time=5e-4))
scene.pin(girder, s=0.0)
scene.motion(girder, s=20.0, displacement=("free", 0, 0))  # a roller: free along the girder

trolley = scene.rigid_body("trolley", mass=2000, inertia=(500, 500, 500), position=(FROM, 0, 0))
load = scene.rigid_body("load", mass=8000, inertia=(4000, 4000, 4000), position=(FROM, -6, 0))
scene.joint("distance", trolley, load, name="rope")


# %%
# A profile of speed
# ------------------
#
# The trolley accelerates for ``ramp`` seconds, travels, and decelerates for the same time. The period of the load is
# near 2 π √(l/g) = 4.9 s. A ramp of one period leaves no swing.


def travel(ramp: float) -> fu.TableSignal:
    """Return the speed over time that takes the trolley from FROM to TO."""
    cruise = (TO - FROM) / SPEED - ramp
    return fu.TableSignal(time=[0, ramp, ramp + cruise, 2 * ramp + cruise, 60], value=[0, SPEED, SPEED, 0, 0],
                          interpolation="linear")


PERIOD = 2 * np.pi * np.sqrt(6 / 9.81)
RAMPS = {"1.5 s": 1.5, "one period": PERIOD}
runs = {}
for name, ramp in RAMPS.items():
    scene_of = fu.Scene.from_toml(scene.to_toml())
    scene_of.slide("trolley", along="girder", s=FROM, name="drive", velocity=travel(ramp), frame="tangent")
    runs[name] = scene_of.run(duration=25.0, tol=1e-5, output_step=0.02, initial="equilibrium")
    print(f"{name}: {runs[name].report['steps']} steps, {runs[name].report['time_s']['total']:.2f} s")

# %%
# The swing
# ---------

figure, (angle, power) = plt.subplots(2, 1, figsize=(8, 5.5), sharex=True, layout="constrained")
for name, run in runs.items():
    hang = run["load.position"] - run["trolley.position"]
    swing = np.degrees(np.arctan2(hang[:, 0], -hang[:, 1]))
    angle.plot(run.time, swing, label=f"ramp: {name}")
    power.plot(run.time, 1e-3 * run["drive.traction"] * run["drive.s_rate"], label=name)
    after = run.time > (TO - FROM) / SPEED + RAMPS[name]
    print(f"ramp {name}: swing while travelling {abs(swing).max():.2f}°, left over {abs(swing[after]).max():.2f}°")
angle.set(ylabel="degrees", title="angle of the rope")
angle.legend(frameon=False)
power.set(xlabel="time in s", ylabel="kW", title="power of the drive")

# %%
# The girder
# ----------
#
# The girder carries its own weight, the trolley and the load. The bending moment at mid-span follows from the balance
# of the girder's part beside it. The swinging load makes it larger than a load at rest.

run = runs["1.5 s"]
sag = run["trolley.position"][:, 1].min()
moment = run.section_forces("girder", s=10.0).moment.values[..., 2].ravel()
by_hand = 10_000 * 9.81 * 20 / 4 + AREA * 7850 * 9.81 * 20**2 / 8
print(f"largest sag {-1e3 * sag:.1f} mm; moment at mid-span at most {1e-3 * abs(moment).max():.0f} kN m, "
      f"by hand for a load at rest there {1e-3 * by_hand:.0f} kN m")
left = abs(run.energy_balance().relative).max()
print(f"energy balance: off by {left:.1e} of the energy exchanged")
assert left < 1e-3

# %%
# Next steps: a rope with elements (``scene.cable``) stretches; a signal ``distance=`` of the joint hoists while
# travelling.
