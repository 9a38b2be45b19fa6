"""Linear models (`Scene.linearise`) against closed forms: matrices, poles, responses.

    python tests/benchmarks/linear_models.py [--out FILE.csv] [--elements 20]

The scenes are those of tests/motion/linear_scenes.py: a cart with a pendulum, which hangs or stands; a crane whose
trolley has a damper; a string of `--elements` cubic elements, `cable8p`, with a damper at its free end; a bead on a
string without mass. `error` is the largest deviation from the reference, of poles over the largest pole, of others over
the largest value. `states` is the number of states.
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import sys
from pathlib import Path

import numpy as np
from table import arguments, show

sys.path.append(str(Path(__file__).parents[1] / "motion"))

from linear_scenes import G, bead, cart_and_pendulum, crane, crane_reference, string, string_reference

MASS = np.array([[2.7, 0.63], [0.63, 0.03 + 0.7 * 0.9**2]])
"""Of the cart with the pendulum, by x and the angle."""


def row(case: str, quantity: str, states: int, found: np.ndarray, reference: np.ndarray, bound: float) -> dict:
    """Return a row of the table: the error of numbers, each set in the order of its imaginary and real parts."""
    found, reference = (_ordered(np.asarray(each, dtype=complex)) for each in (found, reference))
    error = float(np.abs(found - reference).max() / np.abs(reference).max())
    return {"case": case, "quantity": quantity, "states": states, "error": error, "bound": bound}


def _ordered(numbers: np.ndarray) -> np.ndarray:
    """Return numbers by rising imaginary, then real part."""
    return numbers[np.lexsort((np.round(numbers.real, 6), np.round(numbers.imag, 6)))]


def cart(upright: bool) -> list[dict]:
    """Return the rows of the cart with the pendulum."""
    linear = cart_and_pendulum(upright=upright).linearise(["push.value.x"], ["hinge.force.x"])
    case = "cart and pendulum, " + ("upright" if upright else "hanging")
    couple = MASS * [[1, -1], [-1, 1]] if upright else MASS
    weight = (-1 if upright else 1) * 0.63 * G
    by_angle, by_push = np.linalg.solve(couple, [0, -weight]), np.linalg.solve(couple, [1, 0])
    arm = -0.9 if upright else 0.9
    on_load = 0.7 * np.array([by_angle[0] + arm * by_angle[1], by_push[0] + arm * by_push[1]])
    pole = np.sqrt(complex(by_angle[1]))
    return [row(case, "A21", 4, linear.A[2:, 1], by_angle, 1e-10), row(case, "B", 4, linear.B[2:, 0], by_push, 1e-10),
            row(case, "hinge force, C and D", 4, [linear.C[0, 1], linear.D[0, 0]], on_load, 1e-10),
            row(case, "poles", 4, linear.poles, [0, 0, pole, -pole], 1e-10)]


def main() -> None:
    options = arguments(__doc__, elements=(20, "of the string", 4))
    rows = cart(False) + cart(True)
    linear = crane().linearise(["push.value.x"], ["trolley.position.x"])
    poles, over = crane_reference(1.0)
    rows.append(row("crane", "poles", 4, linear.poles, [0, *poles], 1e-8))
    rows.append(row("crane", "x/u at 1 rad/s", 4, linear.response(angular_frequency=1.0)[0], [over], 1e-8))
    linear = string(options.elements).linearise()
    above = linear.poles[linear.poles.imag > 0]
    above = above[np.argsort(above.imag)][:2]
    rows.append(row("string with a damper", "two poles", len(linear.states), above, string_reference(), 1e-3))
    linear = bead().linearise()
    lowest = [min(abs(pole) for pole in linear.poles if abs(pole) > 1.0)]
    rows.append(row("bead on a string", "frequency", len(linear.states), lowest, [np.sqrt(200.0)], 1e-6))
    show(rows, options.out)


if __name__ == "__main__":
    main()
