"""
Your own element
================

A spec of one page describes an element. One command derives its equations, verifies every derivative, compiles it and
measures it; a scene then names it. The example is a cable with continuous curvature.
"""

# %%
# The spec
# --------
#
# Position, slope and curvature at both ends are six conditions for a polynomial of degree five. ``laws`` names the
# elastic energy: Green's strain and the exact curvature.

import subprocess
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

SPEC = '''
from funicular.derive.spec import Element, x

QUINTIC = Element(
    name="quintic_plane",
    dim=2,
    basis=(1, x, x**2, x**3, x**4, x**5),
    nodal_vectors=("r", "r_x", "r_xx"),
    director="",
    laws=("green_exact",),
    doc="planar cable, quintic, C2 along the cable",
    source="quintic Hermite interpolation",
)
'''
Path("quintic_plane.py").write_text(SPEC, encoding="utf-8")

# %%
# Derive, check, compile
# ----------------------
#
# The command is ``funicular derive --spec quintic_plane.py --out quintic_plane``; it takes half a minute. It prints the
# checks: every output against 50 digits, every derivative by four methods, rigid motion, symmetry and totals.

command = [sys.executable, "-m", "funicular", "derive", "--spec", "quintic_plane.py", "--out", "quintic_plane"]
report = subprocess.run(command, check=True, capture_output=True, text=True).stdout
print("\n".join(line[:96] for line in report.splitlines()[-14:]))

# %%
# Use it
# ------
#
# A scene names the element and its directory. The scene of the first guide is made with both elements.


def first_scene(elements: int, **element) -> fu.Scene:
    """Return the first guide's scene with another element."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.cable("wire", start=(0, 0, 0), end=(1.5, 0, 0), elements=elements, section=fu.Circle(radius=0.02),
                material=fu.Material(youngs_modulus=4e7, poisson_ratio=0.0, density=4200), **element)
    scene.pin("wire", s=0.0)
    scene.pin("wire", s=1.5)
    scene.rigid_body("A", mass=1.0, inertia=(1e-3, 1e-3, 1e-3), position=(0.25, 0, 0), velocity=(1, 0, 0))
    scene.slide("A", along="wire", s=0.25, name="trolley")
    return scene


settings = {"duration": 0.4, "tol": 1e-6, "output_step": 0.01}
own = {"element": "quintic_plane", "library": "quintic_plane"}

# %%
# Convergence
# -----------
#
# The mesh error falls faster. The reference is the path of the body with 24 quintic elements.

reference = first_scene(24, **own).run(**settings)["A.position"]
motion = np.linalg.norm(reference - reference[0], axis=1).max()
figure, axes = plt.subplots(figsize=(6.5, 3.6), layout="constrained")
for name, element in {"cable8p": {"element": "cable8p"}, "quintic_plane": own}.items():
    meshes = [3, 6, 12]
    runs = [first_scene(elements, **element).run(**settings)["A.position"] for elements in meshes]
    errors = [np.linalg.norm(run - reference, axis=1).max() / motion for run in runs]
    axes.loglog(meshes, errors, "o-", label=name)
    print(f"{name:14}", *(f"{elements} elements {error:.1e}, " for elements, error in zip(meshes, errors, strict=True)))
axes.set(xlabel="elements", ylabel="error over motion", title="path of the body")
axes.legend(frameon=False)

# %%
# The command refuses a spec that cannot work before it writes anything: dependent nodal conditions, a basis without
# rigid motion, an energy that changes under rigid motion.

bad = SPEC.replace("x**4, x**5", "x**4, x**4*x**2").replace("quintic_plane", "bad")
Path("bad.py").write_text(bad.replace("(1, x,", "(1, x**6,"), encoding="utf-8")
command[-3:] = "bad.py", "--out", "bad"
refused = subprocess.run(command, check=False, capture_output=True, text=True)
print(refused.stderr.strip()[:300])
assert refused.returncode != 0
