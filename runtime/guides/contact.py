"""
Contact: a sea bed, a ball, two ropes
=====================================

Three kinds of contact exist. A cable may lie on a surface along its length. Points of a body strike a surface without
penetration. A cable crosses a cable or a bar at one point. Each is compared with a closed form. Lists, or "all", make
many pairs: ``scene.contact(["ball", "rope"], "all")``. Distant pairs cost next to nothing.
"""

# %%
# A mooring line on the sea bed
# -----------------------------
#
# A force of 150 N along the bed and the weight of 14 m upwards pull a line of 30 m. By the catenary 14 m are lifted and
# 16 m lie on the bed. The line is drawn in this shape; it differs by its bending.

from math import pi, sqrt

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

RADIUS, MODULUS, G = 0.01, 1e8, 9.81
WEIGHT = 7800 * pi * RADIUS**2 * G
PULL, LYING, LIFTED = 150.0, 16.0, 14.0
lifted = np.linspace(0, LIFTED, 30)
x = np.append(np.linspace(0, LYING, 30)[:-1], LYING + PULL / WEIGHT * np.arcsinh(WEIGHT * lifted / PULL))
y = np.append(np.zeros(29), PULL / WEIGHT * (np.sqrt(1 + (WEIGHT * lifted / PULL) ** 2) - 1))


def mooring(**law: float) -> fu.Equilibrium:
    """Return the line at rest on the bed."""
    scene = fu.Scene()
    line = scene.cable("line", points=np.stack([x, y + RADIUS, 0 * x], axis=1), rest_length=LYING + LIFTED,
                       elements=60, element="cable8p", law="engineering_exact", rest="straight",
                       section=fu.Circle(radius=RADIUS),
                       material=fu.Material(youngs_modulus=MODULUS, poisson_ratio=0, density=7800))
    scene.pin(line, s=0)
    scene.force(line, s=LYING + LIFTED, value=(PULL, WEIGHT * LIFTED, 0))
    scene.surface("bed", fu.Plane())
    scene.contact(line, "bed", name="lying", **law)
    return scene.equilibrium()


smooth = mooring()
anchor, end = -smooth["line@0.force"][0], smooth["line.position"][-1]
print(f"touch-down at {smooth['lying.last']:.3f} m, {anchor:.3f} N at the anchor, the end {end[1]:.3f} m high")
assert abs(smooth["lying.last"] - LYING) < sqrt(MODULUS * pi * RADIUS**4 / 4 / PULL)  # the bending length
assert abs(anchor / PULL - 1) < 1e-9
assert abs(end[1] - RADIUS - y[-1] - WEIGHT * LIFTED**2 / 2 / (MODULUS * pi * RADIUS**2)) < 5e-4  # and its stretch

# %%
# Penetration
# -----------
#
# The bed is a spring, and ``penetration`` its largest depth. The default ``stiffness`` lets the weight sink in by 1 %
# of the radius. Ten times that stiffness gives a tenth of the depth, and smaller steps. A stiffness is sufficient when
# results no longer change with it.

stiff = mooring(stiffness=10 * WEIGHT / (0.01 * RADIUS))
for state in (smooth, stiff):
    print(f"{1e3 * state['lying.penetration']:.3f} mm deep, touch-down at {state['lying.last']:.3f} m")
assert 0.01 * RADIUS < smooth["lying.penetration"] < 0.02 * RADIUS
assert 7 < smooth["lying.penetration"] / stiff["lying.penetration"] < 13
assert np.abs(stiff["line.position"][-1] - end).max() < 5e-4

# %%
# With friction
# -------------
#
# In statics, friction acts against the displacement of each point from where it is drawn. This line is drawn without
# its stretch. It stretches away from the anchor, and friction reduces the force there by the coefficient times the
# weight on the bed. Ropes have friction in runs alone.

rough = mooring(friction=0.3)
print(f"{-rough['line@0.force'][0]:.1f} N at the anchor, {-rough['lying.friction_force'][0]:.1f} N by friction")
assert abs(-rough["line@0.force"][0] - (PULL - 0.3 * WEIGHT * LYING)) < 0.3 * WEIGHT * 0.05  # that of 5 cm

# %%
# A ball that bounces
# -------------------
#
# ``restitution`` makes the contact of a body hard: an impact is an event that multiplies the normal speed by -e. Each
# bounce is e² as high as the last, and they end at t (1 + e)/(1 - e), with the time t of the first fall. With a
# ``stiffness`` and a ``damping`` c an impact takes time, and v - ln(1 + c v)/c is equal before and after.

E, DROP, DAMPING = 0.7, 0.5, 0.2027
scene = fu.Scene(gravity=(0, -G, 0))
scene.surface("ground", fu.Plane())
scene.rigid_body("ball", mass=1.0, inertia=(4e-3, 4e-3, 4e-3), position=(0, DROP + 0.1, 0))
scene.contact("ball", "ground", radius=0.1, name="foot", restitution=E)
hard = scene.run(duration=2.5, output_step=0.005, tol=1e-5)
soft = scene.replace("foot", restitution=None, stiffness=1e6, damping=DAMPING).run(2.5, output_step=0.005, tol=1e-5)

struck = np.array([event["time"] for event in hard.events if event["what"] == "struck"])
heights = G * np.diff(struck)[:5] ** 2 / 8
print("heights in m", np.round(heights, 4), f"at rest after {struck[-1]:.3f} s")
assert np.abs(heights / (DROP * E ** (2 * np.arange(1, 6))) - 1).max() < 1e-6
assert abs(struck[-1] - sqrt(2 * DROP / G) * (1 + E) / (1 - E)) < 1e-3

came, left = (np.array([event["time"] for event in soft.events if event["what"] == what][:5])
              for what in ("came into contact", "lost contact"))
speeds = np.append(sqrt(2 * G * DROP), G * (came[1:] - left[:-1]) / 2)
print("restitution of soft impacts", np.round(speeds[1:] / speeds[:-1], 3))
kept = speeds[:-1] - np.log1p(DAMPING * speeds[:-1]) / DAMPING
assert np.abs((-speeds[1:] - np.log1p(-DAMPING * speeds[1:]) / DAMPING) / kept - 1).max() < 2e-2

# %%
# Damping
# -------
#
# The contact of a cable always has a stiffness, which returns the energy. Without ``damping`` a rope that falls on a
# table bounces; one that is held down chatters, and creeps in spite of friction.

figure, (ball, table) = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
for run, label in ((hard, "restitution 0.7"), (soft, "stiffness and damping")):
    ball.plot(run.time, run["ball.position"][:, 1] - 0.1, label=label)
ball.set(xlabel="time in s", ylabel="m", title="height of the ball")
for damping in (0.0, 10.0):
    scene = fu.Scene()
    scene.cable("rope", start=(0, 0.02, 0), end=(1, 0.02, 0), elements=10, element="cable8p",
                section=fu.Circle(radius=0.01), material=fu.Material(youngs_modulus=1e7, poisson_ratio=0, density=2000))
    scene.surface("table", fu.Plane())
    scene.contact("rope", "table", stiffness=1e6, damping=damping, name="lying")
    run = scene.run(duration=0.5, output_step=0.005, tol=1e-3)
    force = run["lying.force"][:, 1] / (2000 * pi * 0.01**2 * G)
    table.plot(run.time, 1e3 * (run["rope.position"][:, 5, 1] - 0.01), label=f"damping {damping:g} s/m")
    print(f"in the second half: from {force[50:].min():.2f} to {force[50:].max():.2f} weights")
    assert np.ptp(force[50:]) < 0.1 if damping else np.ptp(force[50:]) > 5
table.set(xlabel="time in s", ylabel="mm", title="height of the rope's middle")
_ = ball.legend(frameon=False), table.legend(frameon=False)

# %%
# Two ropes that cross
# --------------------
#
# ``crossing`` acts at the closest points, which move along both lines. Two ropes of 1 m hang at right angles; the ends
# of the upper one are lowered to 5 cm below the others. The elastica gives a force of 0.188161 N.

scene = fu.Scene(gravity=(0, 0, -G))
for name, along, z, down in (("lower", (0.4, 0), 0.0, 0.0), ("upper", (0, 0.4), 0.02, 0.07)):
    scene.cable(name, start=(-along[0], -along[1], z), end=(*along, z), rest_length=1.0, shape="hanging", elements=14,
                element="cable12", law="engineering_exact", rest="straight", section=fu.Circle(radius=0.005),
                material=fu.Material(youngs_modulus=1e6, poisson_ratio=0.5, density=1000))
    _ = [scene.motion(name, s=s, displacement=(0, 0, -down)) for s in (0.0, 1.0)]
scene.crossing("upper", "lower", stiffness=1e5, name="crossing")
crossed = scene.equilibrium()
print(f"{crossed['crossing.normal_force']:.5f} N at {crossed['crossing.s']:.3f} m of the upper rope")
assert abs(crossed["crossing.normal_force"] / 0.188161 - 1) < 5e-3 and abs(crossed["crossing.s"] - 0.5) < 1e-6
