"""
Ropes over sheaves and drums: hoists, capstans, belts, cranes
=============================================================

A rope runs over sheaves: its elements stay between the tangent points, and the material moves through them. Results
stand beside closed forms.
"""

# %%
# Two weights
# -----------
#
# The route names what the rope passes, in its order. With ``side="right"`` the sheave lies on the right of the rope as
# it runs. A sheave with ``inertia`` turns, by ``friction`` alone; without both the rope slides over it freely. With
# ``model="stick"`` friction holds the rope; regularised friction, the default, lets it creep at a part of ``velocity``.

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

G, R, INERTIA = 9.81, 0.22, 0.9
ROPE = {"section": fu.Circle(radius=3e-4),
        "material": fu.Material(youngs_modulus=2e11, poisson_ratio=0.3, density=4000, damping_time=1e-3)}


def two_weights(light: float, heavy: float, **sheave: object) -> fu.Scene:
    """Return two weights on a rope of 1 g/m over a sheave."""
    scene = fu.Scene()
    for name, mass, x in (("light", light, -R), ("heavy", heavy, R)):
        scene.rigid_body(name, mass=mass, inertia=(1, 1, 1), position=(x, -2, 0))
    scene.rope("rope", route=[fu.Anchor("light"), fu.Sheave("top", at=(0, 0, 0), radius=R, side="right", **sheave),
                              fu.Anchor("heavy")], tension=10.7, elements=1, **ROPE)
    return scene


run = two_weights(1.0, 1.2, inertia=INERTIA, friction=fu.Friction(coefficient=0.1, model="stick")).run(
    1.0, output_step=0.1, tol=1e-4, integrator="radau", progress=False)
expected = 0.2 * G / (2.2 + INERTIA / R**2)
found = -2 * (run["heavy.position"][-1, 1] + 2)
print(f"acceleration {found:.4f} m/s², in closed form {expected:.4f} m/s²")
assert abs(found - expected) < 1e-3 * expected

# %%
# Euler's belt equation
# ---------------------
#
# A held sheave is a capstan: where the rope slides, its tensions differ by the factor exp(mu phi).

run = two_weights(1.0, 4.0, friction=0.3).run(0.5, output_step=0.1, tol=1e-4, integrator="radau", progress=False)
ratio = run["top.tension_off"][-1] / run["top.tension_on"][-1]
print(f"tensions {ratio:.4f}, exp(mu phi) {np.exp(0.3 * run['top.wrap_angle'][-1]):.4f}")
assert abs(ratio / np.exp(0.3 * np.pi) - 1) < 5e-3

# %%
# At rest friction holds a load between two limits, those of ``scene.equilibrium(impending=...)``.

scene = fu.Scene()
scene.rigid_body("load", mass=10, inertia=(1, 1, 1), position=(R, -2, 0))
scene.rope("rope", route=[fu.Anchor(at=(-R, -2, 0)), fu.Sheave("held", at=(0, 0, 0), radius=R, side="right",
                                                               friction=0.3), fu.Anchor("load")],
           tension=10 * G, elements=1, **ROPE)
limits = scene.equilibrium().rope_tensions("rope").sel(span="ground to held", end="start")
print(f"10 kg hang on {float(limits.min()):.1f} to {float(limits.max()):.1f} N")
assert abs(limits.sel(limit="hoisting") / (10 * G * np.exp(0.3 * np.pi)) - 1) < 5e-3

# %%
# A pendulum meets a peg
# ----------------------
#
# A rope leaves a sheave and touches it again. ``contact=False``: it begins apart.

scene = fu.Scene()
scene.rigid_body("bob", mass=1, inertia=(1, 1, 1), position=(-2 * np.sin(0.7), -2 * np.cos(0.7), 0))
scene.rope("rope", route=[fu.Anchor(at=(0, 0, 0)),
                          fu.Sheave("peg", at=(0.3, -1, 0), radius=0.1, side="left", contact=False), fu.Anchor("bob")],
           tension=7.5, elements=1, **ROPE)
run = scene.run(2.0, output_step=0.02, tol=1e-4, integrator="radau", progress=False)
for event, expected in zip(run.events, (0.862144, 1.773524), strict=True):
    print(f"the rope {event['what']} at {event['time']:.4f} s; a massless one at {expected:.4f} s")
    assert abs(event["time"] - expected) < 1e-2

ax = plt.subplots(figsize=(5, 4))[1]
ax.plot(*run["bob.position"][:, :2].T)
ax.plot(*run["rope.position"][::15, :, :2].T, color="gray")
ax.set(xlabel="x (m)", ylabel="y (m)", aspect="equal")

# %%
# In space
# --------
#
# With ``element="cable12"`` the rope leaves the plane, and each sheave has an ``axis``, which turns with its body. The
# load below swings out of the plane of the groove. With ``mass=False`` the rope is straight between sheaves.

scene = fu.Scene()
scene.rigid_body("weight", mass=5.5, inertia=(1, 1, 1), position=(-0.3, -3, 0), velocity=(0, 0.0131, 0))
scene.rigid_body("load", mass=5, inertia=(1, 1, 1), position=(1.8, -3.2, 0.12), velocity=(0, 0, 0.4))
top = fu.Sheave("top", at=(0, 0, 0), axis=(0, 0, 1), radius=0.3, side="right")
scene.rope("rope", element="cable12", route=[fu.Anchor("weight"), top, fu.Anchor("load")], tension=45, elements=1,
           **ROPE)
run = scene.run(2.0, output_step=0.02, tol=1e-4, integrator="radau", progress=False)
without = scene.replace("rope", mass=False).run(2.0, output_step=2.0, tol=1e-4, integrator="radau", progress=False)
at, straight = (each["load.position"][-1] for each in (run, without))
print("load after 2 s at ({:.3f}, {:.3f}, {:.3f}) m; without mass at ({:.3f}, {:.3f}, {:.3f}) m".format(*at, *straight))
assert np.linalg.norm(at - straight) < 2e-3 and np.linalg.norm(straight - [-1.047408, -2.777202, -0.214354]) < 1e-2

fig, ax = plt.subplots(figsize=(5, 3))
for name in ("fleet_angle_on", "fleet_angle_off"):
    ax.plot(run.time, np.degrees(run[f"top.{name}"]), label=name)
ax.set(xlabel="time (s)", ylabel="fleet angle (degrees)")
ax.legend()

# %%
# A belt
# ------
#
# A closed rope has no anchors. The installed scene ``belt_drive`` drives one pulley and brakes the other: between both
# the belt creeps, as its stretch falls where it runs off the driver.

run = fu.load_scene("belt_drive").run(progress=False)
speeds = [np.gradient(run[f"{name}.angle"], run.time)[-20:].mean() for name in ("driver", "driven")]
print(f"driver {speeds[0]:.3f} rad/s, driven pulley {speeds[1]:.3f} rad/s; tensions "
      f"{run['driver.tension_on'][-1]:.0f} and {run['driver.tension_off'][-1]:.0f} N")
assert abs(speeds[1] - 11.308) < 0.02

fig, ax = plt.subplots(figsize=(6, 3))
for name in ("tension_on", "tension_off"):
    ax.plot(run.time, run[f"driver.{name}"], label=name)
ax.set(xlabel="time (s)", ylabel="tension at the driver (N)")
ax.legend()
# %%
# A crane
# -------
#
# A `Drum` at an end of the route winds the rope and pays it out. The installed scene ``tower_crane`` has a winch on the
# ground, and sheaves on a trolley and on the load.

run = fu.load_scene("tower_crane").run(progress=False)
wound = run["winch.length_in_store"]
print(f"wound {wound[-1] - wound[0]:.2f} m, load lifted by {np.ptp(run['load.position'][:, 1]):.2f} m; "
      f"winch at most {run['winch.power'].max() / 1e3:.1f} kW")
assert abs((wound[-1] - wound[0]) / np.ptp(run["load.position"][:, 1]) - 2) < 0.02

fig, (path, power) = plt.subplots(1, 2, figsize=(8, 3.4))
path.plot(run["load.position"][:, 0], run["load.position"][:, 1])
path.set(xlabel="x of the load (m)", ylabel="y (m)", aspect="equal")
power.plot(run.time, run["winch.power"] / 1e3)
power.set(xlabel="time (s)", ylabel="power of the winch (kW)")
fig.tight_layout()
plt.show()
