"""
Slack and taut cables: equilibrium and section forces
=====================================================

A rope hangs between two towers, once longer than the span and once shorter. The guide computes shape and tension as
functions of the length, and compares them with the catenary.
"""

# %%
# A slack rope
# ------------
#
# The span is 50 m, the rope 52 m. Drawn straight it would be compressed; the search finds the hanging shape, and
# reports it in its messages.

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import brentq

import funicular as fu

SPAN, RADIUS, DENSITY = 50.0, 0.01, 7850.0
WEIGHT = np.pi * RADIUS**2 * DENSITY * 9.81  # N/m


def rope_of(length: float, elements: int = 20) -> fu.Scene:
    """Return a rope of some length between two pins at a distance of SPAN."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.cable("rope", start=(0, 0, 0), end=(SPAN, 0, 0), rest_length=length, elements=elements, element="cable8p",
                section=fu.Circle(radius=RADIUS),
                material=fu.Material(youngs_modulus=1e11, poisson_ratio=0.3, density=DENSITY))
    scene.pin("rope", s=0.0)
    scene.pin("rope", s=length)
    return scene


slack = rope_of(52.0).equilibrium()
for message in slack.messages:
    print(message)

# %%
# The catenary
# ------------
#
# An inextensible rope without bending stiffness hangs as y = a cosh(x / a), with 2 a sinh(L / 2a) equal to its length.
# Its tension at mid-span is a times its weight per metre.

a = brentq(lambda a: 2 * a * np.sinh(SPAN / (2 * a)) - 52.0, 10, 200)
sag_of_catenary = a * (np.cosh(SPAN / (2 * a)) - 1)
forces = slack.section_forces("rope")
sag = -slack["rope.position"][:, 1].min()
print(f"sag {sag:.3f} m, catenary {sag_of_catenary:.3f} m")
print(f"tension at mid-span {float(forces.tension.min()):.1f} N, catenary {a * WEIGHT:.1f} N")
assert abs(sag / sag_of_catenary - 1) < 2e-3
assert abs(float(forces.tension.min()) / (a * WEIGHT) - 1) < 1e-2

# %%
# From slack to taut
# ------------------
#
# Below the span, the tension is E A times the strain; above it, the catenary gives the tension. The equilibrium covers
# both.

lengths = np.concatenate([np.linspace(49.9, 50.2, 13), np.linspace(50.3, 53, 7)])
tension, sags = [], []
for length in lengths:
    rest = rope_of(float(length)).equilibrium()
    tension.append(float(rest.section_forces("rope").tension.max()))
    sags.append(-rest["rope.position"][:, 1].min())

stiff = 1e11 * np.pi * RADIUS**2 * np.maximum(SPAN / lengths - 1, 0)
figure, (pull, drop) = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
pull.semilogy(lengths, 1e-3 * np.array(tension), "o-", markersize=3, label="equilibrium")
pull.semilogy(lengths[stiff > 0], 1e-3 * stiff[stiff > 0], ":", label="E A times strain")
pull.set(xlabel="length of the rope in m", ylabel="kN", title="largest tension")
pull.legend(frameon=False)
drop.plot(lengths, sags, "o-", markersize=3)
drop.set(xlabel="length of the rope in m", ylabel="m", title="sag")

# %%
# A load on the rope
# ------------------
#
# The largest tension, and the moment at a clamp or below a load, size the rope. The section forces follow from balance
# with the loads, so that a coarse mesh is sufficient.

loaded = rope_of(50.2)
loaded.force("rope", s=15.06, value=(0, -2000, 0))
rest = loaded.equilibrium()
forces = rest.section_forces("rope")
worst = int(forces.tension.argmax())
stress = float(forces.tension[worst]) / (np.pi * RADIUS**2)
print(f"largest tension {1e-3 * float(forces.tension[worst]):.2f} kN at s = {float(forces.s[worst]):.2f} m: "
      f"{1e-6 * stress:.0f} MPa")
left, right = rest["rope@0.force"], rest["rope@50.2.force"]
print(f"the anchors carry {left[1] + right[1]:.1f} N upwards, weight and load are {WEIGHT * 50.2 + 2000:.1f} N")
assert abs(left[1] + right[1] - WEIGHT * 50.2 - 2000) < 1e-3

# %%
# A pulley held by friction
# -------------------------
#
# Equilibrium leaves friction out: a pulley rolls to the lowest point. ``relax`` damps a motion until it rests. With
# friction the pulley can rest on any slope below the coefficient; the result is one state of many.

held = rope_of(51.0)
held.rigid_body("pulley", mass=100, inertia=(1, 1, 1), position=(5, 0, 0))
held.slide("pulley", along="rope", s=5.1, friction=fu.Friction(coefficient=0.1, model="stick"), name="wheel")
rest = held.relax()
print(rest.messages[0])
print(f"the pulley stays at s = {float(rest['wheel.s']):.2f} m of 51, {rest['pulley.position'][1]:.3f} m high")
assert rest.residual < 2e-6 * 100 * 9.81
