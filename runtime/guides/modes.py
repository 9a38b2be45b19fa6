"""
Natural frequencies about an equilibrium
========================================

Natural frequencies depend on the state about which the scene vibrates. A beam, a beam under axial load and a hanging
chain are compared with their closed forms.
"""

# %%
# A beam on two supports
# ----------------------
#
# The frequencies of a slender beam, free to move along at one end, are f_n = (n π / L)² √(E I / (ρ A)) / 2π. The
# results converge with the fourth power of the number of elements.

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

LENGTH, HEIGHT = 2.0, 0.02
STEEL = fu.Material(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850)
SECTION = fu.Rectangle(height=HEIGHT, width=HEIGHT)
AREA, SECOND_MOMENT = HEIGHT**2, HEIGHT**4 / 12


def beam(elements: int, gravity=(0, 0, 0)) -> fu.Scene:
    """Return a beam on a pin and a roller."""
    scene = fu.Scene(gravity=gravity)
    scene.cable("beam", start=(0, 0, 0), end=(LENGTH, 0, 0), elements=elements, element="cable8p", section=SECTION,
                material=STEEL)
    scene.pin("beam", s=0.0)
    scene.motion("beam", s=LENGTH, displacement=("free", 0, 0))
    return scene


n = np.arange(1, 4)
exact = (n * np.pi / LENGTH) ** 2 * np.sqrt(STEEL.youngs_modulus * SECOND_MOMENT / (STEEL.density * AREA)) / (2 * np.pi)
print("closed form:", *(f"{f:.4f} Hz" for f in exact))
for elements in (2, 4, 8, 16):
    found = beam(elements).modes(3).frequency
    print(f"{elements:2d} elements:", *(f"{abs(f / e - 1):.1e}" for f, e in zip(found, exact, strict=True)))
assert abs(beam(16).modes(3).frequency / exact - 1).max() < 1e-4

# %%
# Under axial load
# ----------------
#
# Tension raises the frequencies, compression lowers them: f_1 = f_1(0) √(1 + P / P_cr), with Euler's load P_cr = π² E I
# / L². At P = -P_cr the beam buckles. ``about`` is the equilibrium under the load.

critical = np.pi**2 * STEEL.youngs_modulus * SECOND_MOMENT / LENGTH**2
loads, found = np.linspace(-0.95, 3, 9), []
for load in loads:
    scene = beam(8)
    scene.force("beam", s=LENGTH, value=(load * critical, 0, 0))
    found.append(scene.modes(1, about=scene.equilibrium()).frequency[0])

figure, axes = plt.subplots(figsize=(7, 3.4), layout="constrained")
axes.plot(loads, found, "o", label="funicular, 8 elements")
fine = np.linspace(-1, 3, 200)
axes.plot(fine, exact[0] * np.sqrt(1 + fine), label="closed form", zorder=0)
axes.set(xlabel="axial load over Euler's load", ylabel="Hz", title="lowest frequency")
axes.legend(frameon=False)
assert np.abs((found / exact[0]) ** 2 - (1 + loads)).max() < 2e-3

# %%
# A hanging chain
# ---------------
#
# A hanging chain has stiffness by its weight alone: f_n = j_0n / 2 √(g / L) / 2π, with the zeros of a Bessel function.
# The drawn chain has no tension yet, so that ``about`` matters.

from scipy.special import jn_zeros

scene = fu.Scene(gravity=(0, -9.81, 0))
scene.cable("chain", start=(0, 0, 0), end=(0, -LENGTH, 0), elements=16, element="cable8p",
            section=fu.GeneralSection(area=1e-4, second_moment_about_z=1e-17), material=STEEL)
scene.pin("chain", s=0.0)
rest = scene.equilibrium()
hanging = scene.modes(3, about=rest).frequency
bessel = jn_zeros(0, 3) / 2 * np.sqrt(9.81 / LENGTH) / (2 * np.pi)
for number, (mine, theirs) in enumerate(zip(hanging, bessel, strict=True), start=1):
    print(f"mode {number}: {mine:.5f} Hz, closed form {theirs:.5f} Hz")
assert abs(hanging / bessel - 1).max() < 5e-3

# %%
# Mode shapes are results by name, one row a mode.

shape = scene.modes(3, about=rest)["chain.displacement"]
print("shapes of the nodes:", shape.shape)
