"""
Droppers: planned heights, slack and taut
=========================================

The contact wire of a railway hangs by droppers from a messenger. The guide finds dropper lengths for a planned height
of the wire, then lifts the wire: a dropper pulls, but does not push. Lengths are compared with published ones, forces
with those of strings.
"""

# %%
# A span with droppers of one length
# ----------------------------------
#
# Two wires span 55 m under the tension of weights. Each dropper is a spring with ``tension_only``: below its length it
# has no force. With equal lengths some of nine droppers are slack.

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

SPAN, G = 55.0, 9.81
X = np.array([4.5, 10.25, 16, 21.75, 27.5, 33.25, 39, 44.75, 50.5])
DROPPERS = [f"dropper_{k}" for k in range(9)]


def wire(scene: fu.Scene, name: str, height: float, tension: float, area: float, modulus: float, bending: float,
         mass: float, excess: float = 0.0) -> fu.Cable:
    """Return a wire that is as long as the span, and by an excess longer, under its tension."""
    return scene.cable(name, start=(0, height, 0), end=(SPAN, height, 0), elements=44, element="cable8p",
                       strain="engineering", rest_length=(SPAN + excess) / (1 + tension / (modulus * area)),
                       section=fu.GeneralSection(area=area, second_moment_about_z=bending / modulus),
                       material=fu.Material(youngs_modulus=modulus, poisson_ratio=0.3, density=mass / area,
                                            mass_damping=0.05, damping_time=1e-4))


scene = fu.Scene()
contact = wire(scene, "contact", 0.0, 22e3, 150e-6, 100e9, 179.0, 1.35)
messenger = wire(scene, "messenger", 1.2, 16e3, 120e-6, 97e9, 111.0, 1.08, excess=0.03)
for s in (0.0, messenger.length):
    scene.pin(messenger, s=s)
for s in (0.0, contact.length):
    scene.motion(contact, s=s, displacement=(0, "free", 0))  # the arm at the mast leaves it free to rise
for name, x in zip(DROPPERS, X, strict=True):
    upper, lower = x / SPAN * messenger.length, x / SPAN * contact.length
    scene.spring((messenger, upper), (contact, lower), name=name, stiffness=235e3, length=0.85, tension_only=True)
    scene.force(messenger, s=upper, value=(0, -G * 0.294, 0))  # its clamp, and its own weight
    scene.force(contact, s=lower, value=(0, -G * 0.165, 0))

guess = scene.equilibrium()
slack = [name for name in DROPPERS if guess[f"{name}.tension"] == 0.0]
print(f"droppers of one length: {len(slack)} of 9 are slack")
assert 0 < len(slack) < 9

# %%
# Lengths for planned heights
# ---------------------------
#
# The plan is a parabola that sags by 55 mm between the outer droppers, 22 kN in the wire and 16 kN in the messenger.
# ``adjust`` names the variables with their limits, ``to`` the same number of targets. The force of a slack dropper does
# not depend on its length; the search takes this into account.

sag = 0.055 * (1 - ((X - 27.5) / 23) ** 2)
heights = {f"contact@{x / SPAN * contact.length:.9g}.position.y": -y for x, y in zip(X, sag, strict=True)}
rest = scene.equilibrium(
    adjust={f"{name}.length": (0.3, 1.5) for name in DROPPERS} | {"contact.rest_length": "free",
                                                                  "messenger.rest_length": "free"},
    to=heights | {"contact@0.force.x": -22e3, "messenger@0.force.x": -16e3})

lengths = np.array([rest.adjusted[f"{name}.length"] for name in DROPPERS])
forces = np.array([rest[f"{name}.tension"] for name in DROPPERS])
published = np.array([1.017, 0.896, 0.810, 0.758, 0.741])
print("lengths in m", np.round(lengths, 3), "forces in N", np.round(forces, 1))
print(f"{rest.adjustment.iterations} iterations, misfit {rest.adjustment.misfits[-1]:.1e}")
assert np.abs(lengths[:5] - published).max() < 2e-3
assert abs(forces.sum() / 742.9 - 1) < 2e-2  # strings; the bending of the wires carries the rest to the masts
assert rest.adjustment.iterations <= 6

# %%
# An impossible target
# --------------------

try:
    rest.scene.equilibrium(adjust=["dropper_4.length"], to={"dropper_4.tension": -50.0})
except fu.EquilibriumError as error:
    print(error)
    assert "which pulls alone, would push" in str(error)

# %%
# Uplift and release
# ------------------
#
# A force of 200 N lifts the middle and ends within 10 ms. Steps end where a dropper becomes slack or taut, unless
# ``tol`` permits a deferred event; the report gives the times of both.

lifted = rest.scene
push = fu.TableSignal(time=[0, 0.2, 0.21, 1], value=[0, 1, 0, 0])
lifted.force("contact", s=lifted.cables["contact"].length / 2, value=(0, 200.0, 0), scale=push)
run = lifted.run(duration=0.8, output_step=0.002, tol=1e-3, initial=rest)
tension = np.array([run[f"{name}.tension"] for name in DROPPERS])
print(f"{len(run.events)} changes of droppers, {int((tension == 0).sum(axis=0).max())} slack at once")
assert tension.min() >= 0.0
assert (tension == 0).sum(axis=0).max() >= 3
for name in DROPPERS:  # slack and taut take turns
    words = [event["what"] for event in run.events if event["name"] == name]
    assert words == (["became slack", "became taut"] * len(words))[:len(words)]

figure, (force, height) = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
force.plot(run.time, tension[[0, 2, 4]].T, label=[DROPPERS[k] for k in (0, 2, 4)])
force.set(xlabel="time in s", ylabel="N", title="forces of droppers")
force.legend(frameon=False)
middle = run["contact.position"][:, 22, 1]
height.plot(run.time, 1e3 * (middle - middle[0]))
height.set(xlabel="time in s", ylabel="mm", title="uplift in the middle")
uplift = 1e3 * (middle.max() - middle[0])
print(f"largest uplift {uplift:.0f} mm")

# %%
# Droppers as plain springs
# -------------------------
#
# Plain springs lift the messenger with the wire, and the middle rises less.

plain = lifted
for name in DROPPERS:
    plain = plain.replace(name, tension_only=False)
other = plain.run(duration=0.8, output_step=0.002, tol=1e-3, initial=plain.equilibrium(start=rest))
held = 1e3 * np.ptp(other["contact.position"][:100, 22, 1])
print(f"uplift until the force leaves: {held:.0f} mm with droppers that push")
assert held < 1e3 * np.ptp(middle[:100])
