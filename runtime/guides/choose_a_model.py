"""
Choose a model for a tolerance
==============================

A cable's element, law and mesh, and the integrator, decide what a run costs and how much it errs. Leave them out, say
what error you can bear, and let them be chosen. This guide shows what is chosen, why, and how true that is.
"""

# %%
# A scene without elements
# ------------------------
#
# A rubber strip is clamped at one end and let go from the horizontal. ``elements`` is left out. Such a scene can be
# drawn, saved and checked, but it has no equations yet.

import time

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu


def strip(**model) -> fu.Scene:
    """Return a strip of 1 m that starts level."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.cable("strip", start=(0, 0, 0), end=(1, 0, 0), section=fu.Rectangle(height=0.02, width=0.02),
                material=fu.Material(youngs_modulus=2e6, poisson_ratio=0.3, density=1100), **model)
    scene.clamp("strip", s=0.0)
    return scene


# %%
# What is chosen
# --------------
#
# ``choose`` makes a few short runs on coarse meshes. Halving the elements shows how fast the mesh converges; the
# energy of shear, with a run of a softer strip, shows what an element without shear leaves out; two integrators are
# compared. All errors are over the largest motion in the scene.

DURATION = 0.4
choice = strip().choose(1e-2, duration=DURATION)
print(choice)

# %%
# The star marks what was chosen. The other rows are what it would cost and err to do it in another way. These are
# estimates: the run itself is the test of them.
#
# How true that is
# ----------------
#
# The same for four tolerances, against 48 beam elements with a hundredth of the error in time.

exact_scene = strip(elements=48, element="beam24", law="structural")
exact = exact_scene.run(duration=DURATION, tol=1e-6, output_step=DURATION / 40)["strip.position"][:, -1]
size = np.linalg.norm(exact - exact[0], axis=1).max()
tols, errors, costs = [3e-2, 1e-2, 3e-3, 1e-3], [], []
for tol in tols:
    choice = strip().choose(tol, duration=DURATION)
    begin = time.process_time()
    run = choice.scene.run(output_step=DURATION / 40)
    costs.append(time.process_time() - begin)
    errors.append(np.linalg.norm(run["strip.position"][:, -1] - exact, axis=1).max() / size)
    print(f"tol {tol:g}: {choice.models['strip']}, {choice.integrator}: the tip errs by {errors[-1]:.1e}, estimated "
          f"{choice.error:.1e}, {1e3 * costs[-1]:.0f} ms")
    assert errors[-1] <= 3 * tol

figure, axes = plt.subplots(figsize=(5.5, 3.6), layout="constrained")
axes.loglog(tols, errors, "o-", label="error of the tip")
axes.loglog(tols, tols, "k:", label="tolerance")
axes.set(xlabel="tol", ylabel="error over the largest motion")
axes.legend(frameon=False)

# %%
# In one go
# ---------
#
# A run with ``model="auto"`` chooses first. So does any run of a scene whose elements were left out. ``run.scene`` is
# the chosen scene, an ordinary one, and the report tells what was chosen.

run = strip().run(duration=DURATION, tol=1e-2, model="auto")
print(run.report["choice"]["models"], *run.report["choice"]["reasons"], sep="\n- ")
print(run.scene.to_toml())

# %%
# What you give stays: a cable with ``elements`` keeps its mesh, one with ``element`` its element and law.
# ``free="all"`` chooses all the same. Name ``quantities`` where not the whole motion counts:

kept = strip(element="cable12").choose(1e-2, duration=DURATION, quantities=["strip@0.moment"])
print(kept)

# %%
# A moment takes a finer mesh than a motion does. On the command line the same is ``funicular choose SCENE.toml --tol
# 1e-2 -o CHOSEN.toml``. For a rule of thumb without a run, see the guide on elements and laws.
