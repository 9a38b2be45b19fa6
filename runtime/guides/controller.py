"""
Controller beside a simulation
==============================

A scene runs in steps, and a program gives its inputs in between: here a controller that damps the sway of a crane. Each
step has the length of the controller's sample, 1 ms.
"""

# %%
# Crane with an input
# -------------------
#
# The trolley is on a rail. Its drive prescribes the velocity, which is the input; the path names it as in sweeps. The
# load hangs from a distance joint of 6 m.

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

SAMPLE, DURATION, GOAL, FASTEST, LENGTH = 1e-3, 8.0, 6.0, 1.5, 6.0

scene = fu.Scene(gravity=(0, -9.81, 0))
trolley = scene.rigid_body("trolley", mass=2000, inertia=(500, 500, 500), position=(0, 0, 0))
load = scene.rigid_body("load", mass=8000, inertia=(4000, 4000, 4000), position=(0, -LENGTH, 0))
scene.joint("prismatic", (0, 0, 0), trolley, axis=(1, 0, 0), velocity=0.0, name="rail")
scene.joint("distance", trolley, load, name="rope")

# %%
# Controller
# ----------
#
# The load is at the distance d = x_load - x_trolley. It obeys d'' + g/l d = -x_trolley''. A velocity of 2 ζ √(g/l) d
# towards the load damps it with the ratio ζ. The rest of the velocity leads to the goal.

DAMPING = 2 * 0.4 * np.sqrt(9.81 / LENGTH)


def controlled(damping: float) -> np.ndarray:
    """Return time, place of the trolley and distance of the load, a row for each sample."""
    sim = scene.simulation(inputs=["rail.velocity"], tol=1e-4, duration=DURATION)
    rows = []
    while sim.time < DURATION - SAMPLE / 2:
        x, x_load = sim["trolley.position"][0], sim["load.position"][0]
        sim["rail.velocity"] = np.clip(0.5 * (GOAL - x), -FASTEST, FASTEST) + damping * (x_load - x)
        sim.step(SAMPLE)
        rows.append((sim.time, x, x_load - x))
    print(f"{len(rows)} samples, work of the drive {sim['energy.external']:.0f} J, notes: {sim.messages}")
    return np.array(rows)


plain, damped = controlled(0.0), controlled(DAMPING)
sways = [np.abs(rows[rows[:, 0] > DURATION - 3.0, 2]).max() for rows in (plain, damped)]
print(f"sway in the last 3 s: {sways[0]:.3f} m without damping, {sways[1]:.3f} m with it")

# %%
# Result
# ------

figure, (place, sway) = plt.subplots(2, 1, sharex=True)
for rows, name in ((plain, "place alone"), (damped, "with damping")):
    place.plot(rows[:, 0], rows[:, 1], label=name)
    sway.plot(rows[:, 0], rows[:, 2])
place.set_ylabel("trolley, m")
place.legend()
sway.set_ylabel("load - trolley, m")
sway.set_xlabel("time, s")

# %%
# States
# ------
#
# ``sim.state`` keeps a time, to which the simulation returns with the same bits: a controller that predicts tries its
# inputs so. States, inputs that rise at a rate and the end at an event are described with `Simulation`.

sim = scene.simulation(inputs=["rail.velocity"], tol=1e-4)
now, ends = sim.state, {}
for velocity in (0.5, 1.0, 1.5):
    sim.state = now
    sim["rail.velocity"] = velocity
    sim.step(1.0)
    ends[velocity] = float(sim["load.position"][0])
print(ends)
