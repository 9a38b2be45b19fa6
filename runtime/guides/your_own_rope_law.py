"""
A rope's own law, against a test machine's curve
================================================

Ropes of fibres do not stretch in proportion to their tension. The curve of a test machine becomes the law of a cable.
Here the curve is made up, with noise.
"""

# %%
# The curve of the machine
# ------------------------
#
# A specimen of 5 m of polyester becomes stiffer with tension. The error of the forces is 0.5 kN.

import matplotlib.pyplot as plt
import numpy as np

import funicular as fu

SPECIMEN, BREAKING = 5.0, 1.0e6  # m, N


def true_force(strain: np.ndarray) -> np.ndarray:
    """Return the force of the made-up rope, N."""
    return BREAKING * (6.0 * strain + 30.0 * strain**2 + 900.0 * strain**3)


random = np.random.default_rng(4)
extension = np.linspace(0, 0.30, 200)
measured = true_force(extension / SPECIMEN) + random.normal(scale=500.0, size=200)

# %%
# From the curve to a table
# -------------------------
#
# ``fu.TensionTable`` takes up to 20 points, here of a least-squares fit through the origin. Between them the force is
# a cubic that increases, beyond them it is straight. A table from zero strain on pulls alone.

strain = extension / SPECIMEN
powers = np.stack([strain**k for k in (1, 2, 3)], axis=1)
coefficients, *_ = np.linalg.lstsq(powers, measured, rcond=None)
points = np.linspace(0, strain[-1], 13)
table = fu.TensionTable(strain=points, force=np.stack([points**k for k in (1, 2, 3)], axis=1) @ coefficients)

# %%
# The same test in funicular
# --------------------------
#
# The table belongs to the section. Young's modulus gives bending and damping alone.

AREA = np.pi * 0.03**2
section = fu.GeneralSection(area=AREA, second_moment_about_z=0.0, tension_table=table)
polyester = fu.Material(youngs_modulus=6.0 * BREAKING / AREA, poisson_ratio=0.3, density=800.0)


def machine(pulled: float, membrane: str = "tabulated", of: fu.GeneralSection = section) -> float:
    """Return the force of a specimen at an extension, N."""
    test = fu.Scene(gravity=(0, 0, 0))
    test.cable("specimen", start=(0, 0, 0), end=(SPECIMEN + pulled, 0, 0), elements=4, element="cable8p",
               strain="engineering", membrane=membrane, rest_length=SPECIMEN, rest="straight", section=of,
               material=polyester)
    test.pin("specimen", s=0)
    test.pin("specimen", s=SPECIMEN)
    return float(-test.equilibrium()["specimen@0.force"][0])


pulled = np.linspace(0.02, 0.30, 8)
found = np.array([machine(x) for x in pulled])
errors = found - true_force(pulled / SPECIMEN)
print(f"largest error of the law: {np.abs(errors).max():.0f} N of {found.max():.0f} N")
assert np.abs(errors).max() < 1500.0
residual = np.array([machine(x) for x in extension[10::20]]) - measured[10::20]
print(f"scatter of the measurement about the law: {residual.std():.0f} N")
assert residual.std() < 1000.0

# %%
# What a constant stiffness gets wrong
# ------------------------------------
#
# A stiffness that is right at the end of the curve is wrong at the mean tension of a line of 400 m.

SPAN, LINE = 410.0, 400.0


def line(membrane: str, of: fu.GeneralSection, material: fu.Material, end: float = SPAN) -> float:
    """Return the horizontal force of the line, N."""
    scene = fu.Scene()
    scene.cable("line", start=(0, 0, 0), end=(end, 0, 0), elements=32, element="cable8p", strain="engineering",
                membrane=membrane, rest_length=LINE, rest="straight", section=of, material=material)
    scene.pin("line", s=0)
    scene.pin("line", s=LINE)
    return float(-scene.equilibrium()["line@0.force"][0])


secant = fu.Material(youngs_modulus=measured[-1] / strain[-1] / AREA, poisson_ratio=0.3, density=800.0)
plain = fu.GeneralSection(area=AREA, second_moment_about_z=0.0)
by_table = [line("tabulated", section, polyester, SPAN + x) for x in (0.0, 0.1)]
by_secant = [line("full", plain, secant, SPAN + x) for x in (0.0, 0.1)]
stiffness = [np.diff(forces)[0] / 0.1e3 for forces in (by_table, by_secant)]
print(f"pull {by_table[0] / 1e3:.1f} kN by the table, {by_secant[0] / 1e3:.1f} kN by a secant modulus")
print(f"stiffness of the line {stiffness[0]:.2f} and {stiffness[1]:.2f} kN/m")
assert by_secant[0] > 1.1 * by_table[0]

# %%
# Frequencies about the mean tension
# ----------------------------------
#
# Modes take the slope of the table at the state of rest: waves along the rope have the speed √(N'/ρA).

taut = 0.03
test = fu.Scene(gravity=(0, 0, 0))
test.cable("rope", start=(0, 0, 0), end=(SPECIMEN * (1 + taut), 0, 0), elements=16, element="cable8p",
           membrane="tabulated", rest_length=SPECIMEN, rest="straight", section=section, material=polyester)
test.pin("rope", s=0)
test.pin("rope", s=SPECIMEN)
frequencies = test.modes(40, about=test.equilibrium()).frequency
slope = coefficients @ [1, 2 * taut, 3 * taut**2]
along = np.sqrt(slope / (800.0 * AREA)) / (2 * SPECIMEN)
nearest = frequencies[np.argmin(np.abs(frequencies - along))]
print(f"first frequency along the rope: {nearest:.2f} Hz, {along:.2f} Hz from the fitted slope")
assert abs(nearest / along - 1) < 0.01

figure, axes = plt.subplots(figsize=(6, 3.6), layout="constrained")
axes.plot(100 * strain, measured / 1e3, ".", markersize=3, label="machine (made up)")
axes.plot(100 * pulled / SPECIMEN, found / 1e3, "o-", label="cable with the table")
axes.plot(100 * strain, strain / strain[-1] * measured[-1] / 1e3, "--", label="secant modulus")
axes.set(xlabel="strain in %", ylabel="force in kN")
axes.legend(frameon=False)
