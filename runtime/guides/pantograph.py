"""
A pantograph below a catenary
=============================

A contact wire hangs by droppers from a messenger. A pantograph presses against it from below at 275 km/h. The guide
computes the lengths of the droppers, the contact force, and losses of contact.
"""

# %%
# The line
# --------
#
# The spans of 55 m with nine droppers each have data of a published study. The droppers pull only. They hold the
# contact wire, under 22 kN, on a parabola of 55 mm. The scene is planar; ``stagger=0.2`` would hold the wire to both
# sides of the track in turn.

import matplotlib.pyplot as plt
import numpy as np

from funicular import catenary

damping = {"mass_damping": catenary.mass_damping(0.005, frequency=5.0), "damping_time": 1e-4}
line = catenary.Line(
    spans=4, span=55.0, height=1.2, support=500e3,
    contact=catenary.Wire(mass=1.35, tension=22e3, axial_stiffness=15e6, bending_stiffness=179, **damping),
    messenger=catenary.Wire(mass=1.08, tension=16e3, axial_stiffness=11.64e6, bending_stiffness=111, **damping),
    droppers=catenary.Droppers(at=[4.5, 10.25, 16, 21.75, 27.5, 33.25, 39, 44.75, 50.5], sag=0.055,
                               axial_stiffness=200e3, mass=0.117, messenger_clamp=0.195, contact_clamp=0.165))

# %%
# Form finding
# ------------
#
# ``form`` finds the lengths of droppers and wires for one span by ``scene.equilibrium(adjust=, to=)``; the other spans
# repeat it by symmetry. Bending increases the forces of the outer droppers above those of strings. The lengths agree
# with the published ones.

form = catenary.form(line, (1.0, 2.0))
print("lengths", np.round(form.lengths[:5], 3), "m")
print("forces ", np.round(form.tensions[:5], 1), "N, of strings", np.round(line.strings.forces[:5], 1), "N")
assert np.abs(form.lengths[:5] - [1.017, 0.896, 0.810, 0.758, 0.741]).max() < 2e-3
assert abs(form.tensions[0] / 191.35 - 1) < 0.02

# %%
# The passage
# -----------
#
# The pantograph is a chain of three masses over a base that the train moves: collector, upper and lower frame. The
# uplift force acts on the lowest mass. ``catenary.JointedPantograph`` has arms and rods with hinges.
#
# The default elements have 1 m; the elements here are longer, to save time.

pantograph = catenary.Pantograph(masses=[7.5, 9, 6], stiffness=[7000, 15500, 160], damping=[45, 0.1, 100], uplift=120)
print(f"waves run at {3.6 * line.contact.wave_speed:.0f} km/h")
assert abs(3.6 * line.contact.wave_speed / 460 - 1) < 2e-3

scene = catenary.scene(catenary.form(line, (2.0, 4.0)))
catenary.add_pantograph(scene, pantograph, at=20.0, speed=275 / 3.6)
run = scene.run(progress=False)

# %%
# Contact force
# -------------
#
# Contact forces are assessed below 20 Hz, by mean and standard deviation over the two middle spans. The mean is the
# uplift force less the force of the lowest spring. On this coarse mesh the standard deviation is about a tenth too
# large; ``tests/benchmarks/pantographs.py`` shows its convergence.

found = catenary.assess(run)
for name in ("mean", "standard_deviation", "statistical_minimum", "maximum", "minimum"):
    print(f"{name.replace('_', ' '):20} {float(found[name][0]):6.1f} N")
print(f"largest uplift at a mast {1e3 * float(found.uplift[1:-1].max()):.0f} mm")
print(f"{int(found.losses[0])} losses of contact, {1e3 * float(found.loss_time[0]):.1f} ms")
assert 100 < float(found["mean"][0]) < 120

figure, (force, uplift, droppers) = plt.subplots(3, 1, figsize=(9, 9), layout="constrained")
catenary.plot_force(run, force)
catenary.plot_uplift(run, uplift)
catenary.plot_droppers(run, droppers, span=2, droppers=[1, 3, 5])

# %%
# Slack droppers
# --------------
#
# The collector lifts the wire, and droppers become slack. The run lists the times.

slack = [event for event in run.events if event["name"] == "dropper_3_5" and event["what"] == "became slack"]
there = 20.0 + 275 / 3.6 * slack[0]["time"]
print(f"dropper 5 of span 3 is slack for the first time as the collector is {137.5 - there:.1f} m before it")
assert abs(137.5 - there) < 25
