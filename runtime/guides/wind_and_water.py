"""
A mooring in a current
======================

A buoy under water holds 60 m of line above the sea bed. The guide computes its offset in a current, its period, and its
motion when the tide turns; then lift and galloping of a line in wind.
"""

# %%
# The mooring
# -----------
#
# The line is heavier than water, the buoy lighter. The current is a table over the height. ``normal`` and
# ``tangential`` are the drag coefficients across and along the line. ``added_mass`` is the accelerated water relative
# to the displaced water: 1 for a round line, 0.5 for a sphere.

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

height = np.array([-5.0, 0, 15, 30, 45, 70])
current = np.zeros((6, 3))
current[:, 0] = 0.3, 0.4, 0.8, 1.1, 1.3, 1.5
sea = fu.VelocityTable(y=height, velocity=current)


def mooring(added_mass: bool = True, **fluid) -> fu.Scene:
    """Return the mooring in a fluid described by these arguments, with or without the inertia of the water."""
    scene = fu.Scene()
    line = scene.cable("line", start=(0, 0, 0), end=(0, 60, 0), elements=16, element="cable12", strain="engineering",
                       section=fu.GeneralSection(area=7.07e-4, second_moment_about_z=1e-10),
                       material=fu.Material(youngs_modulus=3e9, poisson_ratio=0.0, density=1400))
    scene.pin(line, s=0.0)
    buoy = scene.rigid_body("buoy", mass=100.0, inertia=(5, 5, 5), position=(0, 60, 0))
    scene.joint("spherical", (line, 60.0), buoy)
    scene.fluid("sea", density=1025, **fluid)
    water = {"line": 1.0, "buoy": 0.5} if added_mass else {"line": None, "buoy": None}
    scene.drag(line, normal=1.2, tangential=0.02, diameter=0.03, added_mass=water["line"])
    scene.drag(buoy, area=0.8, coefficient=0.5, volume=0.5, added_mass=water["buoy"])
    return scene


# %%
# Equilibrium
# -----------
#
# At rest, weight, buoyancy and drag balance.

scene = mooring(table=sea)
rest = scene.equilibrium()
carried, sunk = rest["buoy.position"][0], 60 - rest["buoy.position"][1]
pull = np.linalg.norm(rest["line@0.force"])
print(f"the buoy is carried {carried:.2f} m away and {sunk:.2f} m down; the anchor bears {1e-3 * pull:.2f} kN")
assert abs(rest["line@0.force"] + rest["drag_1.force"] + rest["drag_2.force"] - 9.81 * np.array(
    [0, 1400 * 7.07e-4 * 60 + 100, 0])).max() < 1e-3

# %%
# Modes
# -----
#
# Modes leave damping out. Added mass lowers the first frequency: the buoy of 100 kg moves with half of the 512 kg that
# it displaces, and the line with its own volume of water.

still = [mooring(added_mass, velocity=(0, 0, 0)) for added_mass in (False, True)]
found = [each.modes(4, about=each.equilibrium()).frequency for each in still]
slow = [frequencies[frequencies > 1e-3][0] for frequencies in found]  # the buoy is free to turn about the line
print(f"first period {1 / slow[0]:.2f} s without the inertia of the water, {1 / slow[1]:.2f} s with it")
pendulum = np.sqrt((100 + 1400 * 7.07e-4 * 20) / (100 + 256 + (1400 + 1025) * 7.07e-4 * 20))
assert abs(slow[1] / slow[0] - pendulum) < 0.01  # a rod that swings about its foot counts with a third of its mass

# %%
# A turning tide
# --------------
#
# A signal of time multiplies the table: the current stops within a minute and returns from the other side. The
# acceleration of the fluid acts as well.

tide = fu.TableSignal(time=[0, 20, 80, 100, 200], value=[1, 1, -1, -1, -1], interpolation="linear")
turning = mooring(table=sea, scale=tide)
run = turning.run(duration=200, initial=rest, tol=1e-4, output_step=1.0)
x = run["buoy.position"][:, 0]
print(f"the buoy goes from {x[0]:.2f} m to {x[-1]:.2f} m; largest force on the anchor "
      f"{1e-3 * np.linalg.norm(run['line@0.force'], axis=1).max():.2f} kN")
balance = run.energy_balance()
assert np.abs(np.array(balance.residual)).max() < 1e-3 * balance.exchanged
assert abs(x[-1] + x[0]) < 0.1  # the other side's rest

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
for k, time in enumerate((0, 50, 60, 70, 200)):
    shape = run["line.nodal_vectors"][time, :, 0]
    left.plot(shape[:, 0], shape[:, 1], color=plt.cm.viridis(k / 4), label=f"{time} s")
left.set(xlabel="x in m", ylabel="y in m", title="the line", aspect="equal")
left.legend(frameon=False)
right.plot(run.time, x)
right.set(xlabel="time in s", ylabel="m", title="the buoy along the current")

# %%
# Lift
# ----
#
# A stranded or iced line has lift, a force across the flow. A taut line leans across the wind by the angle whose
# tangent is lift over drag.

air = fu.Scene(gravity=(0, 0, 0))
wire = air.cable("wire", start=(0, 0, 0), end=(0, 0, 50), rest_length=49.9, elements=12, element="cable12",
                 section=fu.Circle(radius=0.01),
                 material=fu.Material(youngs_modulus=7e10, poisson_ratio=0.3, density=2700))
air.pin(wire, s=0.0)
air.pin(wire, s=wire.length)
air.fluid("wind", density=1.25, velocity=(25, 0, 0))
air.drag(wire, normal=1.1, lift=0.4)
middle = air.equilibrium()["wire.position"][6]
print(f"the middle is blown {1e3 * middle[0]:.1f} mm along and {1e3 * middle[1]:.1f} mm across the wind")
assert abs(middle[1] / middle[0] - 0.4 / 1.1) < 1e-4

# %%
# Galloping of an iced conductor
# ------------------------------
#
# Ice gives a conductor an asymmetric section. A ``polar`` tabulates drag and lift over the angle between flow and
# ``chord``; the section of a beam defines the chord. Where lift falls faster with the angle than drag allows,
# vibrations across the wind grow at Den Hartog's rate.

angle = np.linspace(-np.pi, np.pi, 73)
ice = fu.Polar(angle=angle, drag=np.full(73, 1.0), lift=-1.5 * np.sin(2 * angle).round(9), interpolation="cubic")
line = fu.Scene(gravity=(0, 0, 0))
iced = line.cable("iced", start=(0, 0, 0), end=(0, 0, 50), rest_length=49.9, elements=12, element="beam24",
                  law="structural", section=fu.Circle(radius=0.01),
                  material=fu.Material(youngs_modulus=7e10, poisson_ratio=0.3, density=2700, damping_time=1e-3))
line.clamp(iced, s=0.0)
line.clamp(iced, s=iced.length)
line.fluid("wind", density=1.25, velocity=(10, 0, 0))
line.drag(iced, polar=ice, chord=(0, 0, -1), diameter=0.03)  # downwind: the local z is along -x
rest = line.equilibrium()
push = np.zeros_like(rest["iced.nodal_vectors"])
push[:, 0, 1] = 0.01 * np.sin(np.pi * np.linspace(0, 1, 13))
gallop = line.run(20, initial={"iced.nodal_vectors": rest["iced.nodal_vectors"], "iced.nodal_velocity": push},
                  tol=1e-3, output_step=0.05)
swing = np.abs(gallop["iced.position"][:, 6, 1])
early, late = swing[gallop.time < 5].max(), swing[gallop.time > 15].max()
expected = np.exp(-15 * 1.25 * 10 * 0.03 * (1.0 - 3.0) / (4 * 2700 * np.pi * 0.01**2))
print(f"the middle swings {late / early:.1f} times as far after 15 s, to {1e3 * late:.0f} mm; expected {expected:.1f}")
assert abs(late / early / expected - 1) < 0.1
