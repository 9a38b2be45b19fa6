"""
Choose a model for a tolerance
==============================

Element, law, mesh and integrator decide what a run costs and how accurate it is. Leave them out and give a tolerance:
``choose`` selects them. This guide shows the selection, its reasons, and its true error.
"""

# %%
# A scene without elements
# ------------------------
#
# A rubber strip is clamped at one end and released from the horizontal. Without ``elements`` a scene can be drawn,
# saved and checked; it has no equations yet.

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
# The selection
# -------------
#
# ``choose`` makes a few short runs on coarse meshes. Halving the elements shows the convergence of the mesh. The shear
# energy, and a run of a softer strip, show the error of elements without shear. Two integrators are compared. All
# errors are relative to the largest motion.

DURATION = 0.4
choice = strip().choose(1e-2, duration=DURATION)
print(choice)

# %%
# The star marks the selection. The other rows estimate cost and error of the alternatives.
#
# Estimates against true errors
# -----------------------------
#
# The following runs repeat this for four tolerances. The reference has 48 beam elements and a hundredth of the error in
# time.

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
# Selection within a run
# ----------------------
#
# ``model="auto"`` selects before the run. So does any run of a scene without ``elements``. ``run.scene`` is the
# selected scene; the report gives the reasons.

run = strip().run(duration=DURATION, tol=1e-2, model="auto")
print(run.report["choice"]["models"], *run.report["choice"]["reasons"], sep="\n- ")
print(run.scene.to_toml())

# %%
# Given values stay: a cable with ``elements`` keeps its mesh, one with ``element`` its element and law. ``free="all"``
# selects them anew. ``quantities`` names the results whose error counts:

kept = strip(element="cable12").choose(1e-2, duration=DURATION, quantities=["strip@0.moment"])
print(kept)

# %%
# A moment needs a finer mesh than the motion. The command is ``funicular choose SCENE.toml --tol 1e-2 -o CHOSEN.toml``.
# The guide on elements and laws has rules that need no run.
