"""
Slackline
=========

A person stands on a slackline of 25 m. The guide computes the sag, the natural frequencies, and the forces on the
anchors when the person jumps off.
"""

# %%
# The line
# --------
#
# The webbing of 25 mm by 2.5 mm has a pretension of 2 kN. ``cable12`` bends and stretches in space, without torsion;
# bending hardly matters here. ``rest_length`` is shorter than the distance of the anchors by the strain F / (E A).

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

SPAN, PRETENSION, MODULUS = 25.0, 2000.0, 1.2e9
AREA = 0.025 * 0.0025
rest_length = SPAN / (1 + PRETENSION / (MODULUS * AREA))

scene = fu.Scene(gravity=(0, -9.81, 0))
line = scene.cable("line", start=(0, 1, 0), end=(SPAN, 1, 0), rest_length=rest_length, elements=20,
                   element="cable12", section=fu.GeneralSection(area=AREA, second_moment_about_z=3e-11),
                   material=fu.Material(youngs_modulus=MODULUS, poisson_ratio=0.3, density=1100, damping_time=2e-3))
scene.pin(line, s=0.0)
scene.pin(line, s=rest_length)

# %%
# A person in the middle
# ----------------------
#
# A body of 75 kg stands for the person. Its mass centre is on the line, since a spherical joint would not keep it
# upright above.

person = scene.rigid_body("person", mass=75, inertia=(1, 1, 1), position=(SPAN / 2, 1, 0))
scene.joint("spherical", person, (line, rest_length / 2), name="feet")

rest = scene.equilibrium()
sag = 1 - rest["person.position"][1]
tension = float(rest.section_forces(line, s=[1.0]).tension[0])
by_hand = 75 * 9.81 / 2 / np.sin(np.arctan(sag / (SPAN / 2)))
print(f"sag {sag:.3f} m, tension {tension:.0f} N; the weight and that sag ask for {by_hand:.0f} N")
assert abs(tension / by_hand - 1) < 0.01

# %%
# Modes
# -----
#
# The modes are about the equilibrium, with its tension. The slowest is a pendulum: the person swings sideways below the
# anchors, with √(g / sag) / 2π. Vertical and longitudinal modes follow.

modes = scene.modes(8, about=rest)
for number, frequency in enumerate(modes.frequency):
    if frequency > 0.01:  # the joint leaves the person's three turns free: they have no frequency
        moved = abs(modes["person.displacement"][number])
        print(f"{frequency:.3f} Hz, the person moves along {'xyz'[int(moved.argmax())]} by {moved.max():.2f}")
pendulum = np.sqrt(9.81 / sag) / (2 * np.pi)
print(f"pendulum of the length of the sag: {pendulum:.3f} Hz")

# %%
# A jump
# ------
#
# The person leaves: a signal removes the weight within 20 ms from a line at rest.

free = fu.Scene(gravity=(0, -9.81, 0))
free.add(scene.cables["line"])
free.pin("line", s=0.0)
free.pin("line", s=rest_length)
free.force("line", s=rest_length / 2, value=(0, -75 * 9.81, 0), scale=fu.Ramp(start=0, end=0.02, before=1, after=0))
run = free.run(duration=2.0, tol=1e-4, output_step=0.005, initial="equilibrium")
print(run.summary())

middle = run["line.position"][:, 10, 1]
anchor = np.linalg.norm(run["line@0.force"], axis=1)
figure, (height, force) = plt.subplots(2, 1, figsize=(8, 5), sharex=True, layout="constrained")
height.plot(run.time, middle - 1)
height.set(ylabel="m", title="height of the middle over the anchors")
force.plot(run.time, 1e-3 * anchor)
force.axhline(1e-3 * PRETENSION, color="0.6", linestyle=":", label="pretension")
force.set(xlabel="time in s", ylabel="kN", title="pull on an anchor")
force.legend(frameon=False)
print(f"highest {middle.max() - 1:.2f} m over the anchors, largest pull {1e-3 * anchor.max():.2f} kN")

# %%
# The stored energy vibrates in the line, and damping dissipates it.

balance = run.energy_balance()
print(f"energy balance: off by {abs(balance.relative).max():.1e}; "
      f"damping took {run['energy.dissipated'][-1]:.1f} J of {run['energy.elastic'][0]:.0f} J in 2 s")
