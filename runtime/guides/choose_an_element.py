"""
Choose an element, a law, and a mesh
====================================

The smallest element that describes the motion is the fastest, and often the most accurate. This guide compares the
elements on a clamped rubber strip that bends under its own weight: error against cost.
"""

# %%
# What each element describes
# ---------------------------
#
# ========== ======= ======================= =======================================
# element    space   coordinates of a node   describes
# ========== ======= ======================= =======================================
# cable8p    plane   r, r_x                  stretch, bending
# cable12    space   r, r_x                  stretch, bending (equal in all directions)
# cable18    space   r, r_x, r_xx            the same, with continuous curvature
# beam12p    plane   r, r_x, r_y             and shear, deforming sections
# beam24     space   r, r_x, r_y, r_z        and torsion, two bending stiffnesses
# ========== ======= ======================= =======================================
#
# Beams have a law. ``"structural"`` is the law of a beam (stretch, shear, torsion, bending). ``"continuum"`` is the law
# of a solid, as in the paper; it locks in bending unless its elements are short.

import time

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

RUBBER = fu.Material(youngs_modulus=2e6, poisson_ratio=0.3, density=1100)


def strip(element: str, elements: int, **law) -> fu.Scene:
    """Return a strip of 0.5 m, clamped at its start, that starts level."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.cable("strip", start=(0, 0, 0), end=(0.5, 0, 0), elements=elements, element=element,
                section=fu.Rectangle(height=0.01, width=0.02), up=(0, 1, 0), material=RUBBER, **law)
    scene.clamp("strip", s=0.0)
    return scene


# %%
# At rest
# -------
#
# The end sags by 0.47 m, nearly the length. The reference is 64 elements of ``beam12p`` with the structural law.

exact = strip("beam12p", 64, law="structural").equilibrium()["strip.position"][-1]
kinds = {"cable8p": {}, "beam12p": {"law": "structural"}, "beam12p, continuum": {"law": "continuum"},
         "beam24": {"law": "structural"}}
figure, (error_axes, cost_axes) = plt.subplots(1, 2, figsize=(9.5, 3.6), layout="constrained")
meshes = [2, 4, 8, 16, 32]
for kind, law in kinds.items():
    errors = [np.linalg.norm(strip(kind.split(",")[0], n, **law).equilibrium()["strip.position"][-1] - exact) / 0.5
              for n in meshes]
    error_axes.loglog(meshes, errors, "o-", markersize=3, label=kind)
    print(f"{kind:20}", *(f"{error:.1e}" for error in errors))
error_axes.set(xlabel="elements", ylabel="error of the end over length", title="equilibrium")
error_axes.legend(frameon=False, fontsize="small")
assert errors[-1] < 1e-3

# %%
# Cables converge fast to a result without shear, here 3e-4 off. The continuum locks: 32 of its elements are less
# accurate than 4 of the structural beam.
#
# In motion
# ---------
#
# The strip now falls for half a second. Torsion and section vibrations, which this scene does not need, make a beam
# stiff and costly.


def fall(kind: str, n: int, **law) -> tuple[np.ndarray, float]:
    """Return the path of the end, and the CPU seconds that the run took."""
    scene = strip(kind.split(",")[0], n, **law)
    begin = time.process_time()
    run = scene.run(duration=0.5, tol=1e-4, output_step=0.01)
    return run["strip.position"][:, -1], time.process_time() - begin


path, _ = fall("cable8p", 64)
for kind, law in kinds.items():
    if kind != "beam12p, continuum":
        found = [fall(kind, n, **law) for n in (2, 4, 8)]
        errors = [np.abs(end - path).max() / np.abs(path - path[0]).max() for end, _ in found]
        cost_axes.loglog([1e3 * cost for _, cost in found], errors, "o-", markersize=3, label=kind)
cost_axes.set(xlabel="CPU time in ms", ylabel="error of the end over its motion", title="motion, tol 1e-4")
cost_axes.legend(frameon=False, fontsize="small")

# %%
# Rules of thumb
# --------------
#
# - A planar scene needs planar elements: ``cable8p`` is ``cable12`` without the third direction, and faster.
# - Without torsion and shear, take a cable. The wires of a rope slip: give its area and second moment.
# - Torsion, or bending that differs across: ``beam24`` with ``law="structural"``.
# - Accelerations of a rider that passes nodes, or of a contact wire: ``cable18``, whose curvature is continuous.
# - Double the elements once. If the result moves too much, double again.
