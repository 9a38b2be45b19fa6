"""
Cable robot: three carriages move a camera
==========================================

A camera hangs from three cables of fixed length. Their upper ends move with carriages on three towers. The guide
computes how well the camera follows a circle, the forces of the motors, and the effect of cable stretch.
"""

# %%
# Towers and camera
# -----------------
#
# Three towers stand on a circle of 5 m. A cable of 8 m runs from each to the camera. The camera stays below the
# triangle of the carriages, so that its weight keeps all cables taut.

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

ANGLES = np.radians([90, 210, 330])
TOWERS = 5.0 * np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)  # x, z
CENTRE, RADIUS, PERIOD, MASS, LENGTH = np.array([0.0, 2.0, 0.0]), 1.0, 8.0, 60.0, 8.0

# %%
# Positions of the carriages
# --------------------------
#
# The camera follows a circle in a level plane. The height of a carriage above it is √(L² - d²), with the horizontal
# distance d from tower to camera.


def wanted(time: np.ndarray) -> np.ndarray:
    """Return (time, 3): where the camera should be; it comes out to the circle within three seconds."""
    out = RADIUS * fu.Ramp(start=0.5, end=3.5).value(time)
    turned = 2 * np.pi * np.maximum(time - 2.0, 0) / PERIOD
    return CENTRE + np.stack([out * np.cos(turned), 0 * time, out * np.sin(turned)], axis=-1)


time = np.linspace(-1, 12, 131)  # from before the start on, where nothing moves
heights = []
for tower in TOWERS:
    at = wanted(time)
    across = np.linalg.norm(at[:, [0, 2]] - tower, axis=1)
    heights.append(at[:, 1] + np.sqrt(LENGTH**2 - across**2))

# %%
# The scene
# ---------
#
# A carriage is a body on a prismatic joint with the ground. The signal ``distance`` prescribes its position, whatever
# the force. A light cable is a spring between carriage and camera.


def robot(stiffness: float) -> fu.Scene:
    """Return the robot with cables of a stiffness in N/m."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("camera", mass=MASS, inertia=(1, 1, 1), position=CENTRE)
    for k, (tower, height) in enumerate(zip(TOWERS, heights, strict=True)):
        at = (tower[0], height[0], tower[1])
        scene.rigid_body(f"carriage_{k}", mass=5.0, inertia=(0.1, 0.1, 0.1), position=at)
        scene.joint("prismatic", at, f"carriage_{k}", axis=(0, 1, 0), name=f"motor_{k}",
                    distance=fu.TableSignal(time=time, value=height - height[0]))
        scene.spring(f"carriage_{k}", "camera", stiffness=stiffness, damping=stiffness / 300,
                     length=LENGTH, name=f"cable_{k}")
    return scene


# %%
# Motion along the circle
# -----------------------
#
# The run starts from rest, with the cables stretched by the weight of the camera.

figure, (path, pull) = plt.subplots(1, 2, figsize=(9.5, 4), layout="constrained")
for stiffness in (2e4, 5e5):
    run = robot(stiffness).run(duration=12.0, tol=1e-5, output_step=0.05, initial="equilibrium")
    error = run["camera.position"] - wanted(run.time)
    sag, off = -error[0, 1], np.linalg.norm(error[:, [0, 2]], axis=1).max()
    path.plot(*run["camera.position"][:, [0, 2]].T, label=f"{stiffness:.0e} N/m")
    print(f"{stiffness:.0e} N/m: hangs {1e3 * sag:.1f} mm low at rest, at most {1e3 * off:.1f} mm off the circle, "
          f"{run.report['steps']} steps")
path.plot(*wanted(run.time)[:, [0, 2]].T, "k:", label="wanted")
path.set(xlabel="x in m", ylabel="z in m", title="seen from above", aspect="equal")
path.legend(frameon=False, fontsize="small")

# %%
# Forces of the motors
# --------------------
#
# The tensions are compared with a third of the weight over the cosine of the slope.

for k in range(3):
    pull.plot(run.time, run[f"cable_{k}.tension"], label=f"cable {k}")
pull.set(xlabel="time in s", ylabel="N", title=f"tension, {stiffness:.0e} N/m")
pull.legend(frameon=False, fontsize="small")
down = (heights[0][0] - CENTRE[1]) / LENGTH
by_hand = MASS * 9.81 / 3 / down
print(f"tension at rest {run['cable_0.tension'][0]:.1f} N, by hand {by_hand:.1f} N")
assert abs(run["cable_0.tension"][0] / by_hand - 1) < 2e-3

force = np.max([abs(run[f"motor_{k}.force"][:, 1]).max() for k in range(3)])
print(f"largest force of a motor {force:.0f} N; energy balance off by {abs(run.energy_balance().relative).max():.0e}")
