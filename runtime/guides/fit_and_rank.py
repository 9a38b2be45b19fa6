"""
Fit a model, and rank its parameters
====================================

The path of a trolley was measured. Which stiffness of the cable and which friction explain it, and which uncertain
values matter most? SciPy and SALib answer, with a sweep as their function.
"""

# %%
# The measurement
# ---------------
#
# A run replaces the experiment: 0.43 GPa, a friction of 0.12, and a camera with an error of 0.2 mm. The fit does not
# know these values.

import matplotlib.pyplot as plt
import numpy as np
from SALib.analyze import sobol as sobol_analysis
from SALib.sample import sobol as sobol_sample
from scipy.optimize import least_squares

import funicular as fu

STIFFNESS, FRICTION, NOISE = "wire.material.youngs_modulus", "trolley.friction.coefficient", 2e-4
SETTINGS = {"duration": 0.6, "output_step": 0.02, "tol": 1e-4}

scene = fu.load_scene("paper51")
truth = fu.sweep(scene, {STIFFNESS: [0.43e9], FRICTION: [0.12]}, keep=["A.position"], workers=0, **SETTINGS)
path = truth["A.position"][0, 0].values[:, :2]
measured = path + NOISE * np.random.default_rng(7).standard_normal(path.shape)

# %%
# A function of many points
# -------------------------
#
# All points that an optimiser requests together form one sweep: ``method="list"`` takes one value of each parameter per
# point. Without ``workers=0`` the points are distributed over all cores, which is worthwhile for points of seconds, or
# hundreds of points.


def paths(stiffness: np.ndarray, friction: np.ndarray) -> np.ndarray:
    """Return (points, time, 2): the trolley's path in the plane, in m, for stiffnesses in GPa and frictions."""
    found = fu.sweep(scene, {STIFFNESS: 1e9 * stiffness, FRICTION: friction}, method="list", keep=["A.position"],
                     workers=0, progress=False, **SETTINGS)
    assert (found.status == "completed").all()
    return found["A.position"].values[:, :, :2]


# %%
# The fit
# -------
#
# ``least_squares`` needs the residuals in units of the camera's error, and their derivatives: four runs for central
# differences, in one sweep.

STEPS = np.array([1e-3, 1e-3])
rounds: list[np.ndarray] = []


def left(x: np.ndarray) -> np.ndarray:
    """Return (measurements,) at x, stiffness and friction."""
    rounds.append(x.copy())
    return ((paths(x[:1], x[1:])[0] - measured) / NOISE).ravel()


def derivatives(x: np.ndarray) -> np.ndarray:
    """Return (measurements, 2) at x."""
    points = x + np.array([[1, 0], [-1, 0], [0, 1], [0, -1]]) * STEPS
    found = paths(*points.T) / NOISE
    return np.stack([(found[0] - found[1]).ravel() / (2 * STEPS[0]), (found[2] - found[3]).ravel() / (2 * STEPS[1])], 1)


fit = least_squares(left, x0=[0.3, 0.02], jac=derivatives, bounds=([0.1, 0.0], [0.58, 0.5]))
spread = np.sqrt(np.diag(np.linalg.inv(fit.jac.T @ fit.jac)))
print(f"stiffness {fit.x[0]:.4f} ± {spread[0]:.4f} GPa, friction {fit.x[1]:.4f} ± {spread[1]:.4f}, "
      f"in {len(rounds)} rounds; mean square of the residuals: {np.mean(fit.fun**2):.2f}")
assert np.all(abs(fit.x - [0.43, 0.12]) < 4 * spread) and 0.6 < np.mean(fit.fun**2) < 1.5

figure, (left_axis, right_axis) = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
left_axis.plot(*(1e3 * measured.T), ".", label="measured")
for k, label in ((0, "first guess"), (-1, "fit")):
    left_axis.plot(*(1e3 * paths(rounds[k][:1], rounds[k][1:])[0].T), label=label)
left_axis.set(xlabel="x in mm", ylabel="y in mm", title="path of the trolley")
left_axis.legend(frameon=False)
right_axis.plot(*np.transpose(rounds), "o-")
right_axis.plot(0.43, 0.12, "r*", markersize=14)
right_axis.set(xlabel="stiffness in GPa", ylabel="friction", title="rounds of the fit, and the truth")

# %%
# Sensitivity
# -----------
#
# Sobol's indices divide the variance of a result among its causes. SALib draws the points, a sweep computes them, SALib
# analyses them. The total index includes interactions.

problem = {"num_vars": 4, "names": [STIFFNESS, FRICTION, "A.mass", "wire.material.density"],
           "bounds": [[0.38e9, 0.48e9], [0.08, 0.16], [0.8, 1.2], [4000.0, 4400.0]]}
drawn = sobol_sample.sample(problem, 32, calc_second_order=False, seed=1)
answers = {"sag": lambda run: -run["A.position"][:, 1].min(), "travel": lambda run: run["trolley.s"][-1]}
found = fu.sweep(scene, dict(zip(problem["names"], drawn.T, strict=True)), method="list", keep=answers, workers=0,
                 **SETTINGS | {"tol": 1e-3})
assert (found.status == "completed").all()

figure, axes = plt.subplots(figsize=(7, 3.4), layout="constrained")
total = {}
for k, answer in enumerate(answers):
    index = sobol_analysis.analyze(problem, found[answer].values, calc_second_order=False, seed=1)
    total[answer] = index["ST"]
    axes.bar(np.arange(4) + 0.3 * k - 0.15, index["ST"], 0.28, yerr=index["ST_conf"], label=answer)
    print(f"{answer}:", *(f"{name} {share:.2f}" for name, share in zip(problem["names"], index["ST"], strict=True)))
axes.set(xticks=range(4), xticklabels=["stiffness", "friction", "mass", "density"], ylabel="total Sobol index",
         title=f"{len(drawn)} runs")
axes.legend(frameon=False)

# %%
# The stiffness determines the sag of the trolley, the friction its travel.

assert np.argmax(total["sag"]) == 0 and np.argmax(total["travel"]) == 1
