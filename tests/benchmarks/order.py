"""Order of the integration of the first scene: errors as the step is halved.

    python tests/benchmarks/order.py [--out FILE.csv]

s of the slide and y of the body against tests/reference/paper51.csv, root mean square over the output times; ``ratio``
is the error of the step before over this one's: 4 for the second order, 2 for the first. Below steps of 0.25 ms the
vibrations of the cable's section (period 0.3 ms, some 1e-7 m) limit the errors until 20 µs resolve them.

``from rest`` starts the scheme from zero accelerations and loses one order, since the velocities keep the error of the
first step. An order is also lost if s is treated as a multiplier. With constraints r(s) - p = 0 and f . r'(s) = 0, and
C_q' times all algebraic unknowns as the force, the increment of s in the step multiplies f . r'_q, which acts like f
applied at s one step ahead; the energy then changes with the first power of the step as well. Here the force on the
cable is that of f alone.
"""

import numpy as np
from paper51 import REFERENCE, integrate
from table import arguments, few, show

STEPS = [2e-3 / 2**k for k in range(6)] + [2e-5, 1e-5]


def main() -> None:
    """Measure and print."""
    options = arguments(__doc__)
    rows = []
    for from_rest in (False, True):
        before = None
        for step in few(STEPS):
            engine, _ = integrate(step=step, from_rest=from_rest)
            found = engine.rows()
            deviations = found["s"][:, 0] - REFERENCE["s_m"], found["q"][:, -6] - REFERENCE["y_m"]
            errors = [float(np.sqrt(np.mean(d**2))) for d in deviations]
            ratios = ["" if before is None else a / b for a, b in zip(before or errors, errors, strict=True)]
            start = "from rest" if from_rest else "eq 38"
            rows.append({"start": start, "step": step, "s_rms_m": errors[0], "s_ratio": ratios[0]})
            rows[-1] |= {"y_rms_m": errors[1], "y_ratio": ratios[1]}
            before = errors
    show(rows, options.out)


if __name__ == "__main__":
    main()
