"""Refinement of mesh, zones and steps of ropes: each series tends to its limit.

- mesh: the load of the heavy swinging Atwood at 1 s with n elements a span, against 16;
- zones: the tension that a held cylinder bears with n zones, against the closed form (capstans.held_cylinder);
- steps: the same load with equal steps, against a run with a tolerance of 1e-9.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import log

import numpy as np

from .capstans import held_cylinder
from .scenes import over_one, rope_of, swing
from .sliding_runs import held_on_cylinder


def swinging_load(elements: int = 2, **settings: object) -> np.ndarray:
    """Return the place (3,) of the load of the heavy swinging Atwood at 1 s, in m."""
    scene = swing(4.4, 4.0, 0.25, 2.5, 3.0, 0.6)
    over_one(scene, 0.25, ("counterweight", "load"), elements=elements, tension=42.0,
             given=rope_of(8e4, 0.3 * (1 + 42 / 8e4), 0, 1e-4))
    return scene.run(1.0, output_step=1.0, progress=False, **settings)["load.position"][-1]


def distance(one: np.ndarray, other: np.ndarray) -> float:
    """Return the largest difference."""
    return float(np.abs(np.subtract(one, other)).max())


@dataclass(frozen=True)
class Series:
    """Errors over a number that refines: elements, zones, or steps a second.

    numbers: rising; reference: returns what the errors are of; result: of a number; unit: of the errors, 1 where they
    are relative.
    """

    name: str
    unit: str
    numbers: tuple[int, ...]
    reference: Callable[[], np.ndarray]
    result: Callable[[int], np.ndarray]

    def rows(self) -> Iterator[dict]:
        """Yield the number, the error, and the order from the number before."""
        reference, before = self.reference(), (0, 0.0)
        for n in self.numbers:
            error = distance(self.result(n), reference)
            order = log(before[1] / error) / log(n / before[0]) if before[0] else float("nan")
            yield {"series": self.name, "number": n, "error": error, "unit": self.unit, "order": order}
            before = n, error


FINE = {"tol": 1e-9, "integrator": "radau"}


def _at_steps(integrator: str) -> Callable[[int], np.ndarray]:
    return lambda n: swinging_load(step=1 / n, integrator=integrator)


SERIES = [
    Series("elements of a span", "m", (1, 2, 4, 8), lambda: swinging_load(16, tol=1e-8, integrator="radau"),
           lambda n: swinging_load(n, tol=1e-8, integrator="radau")),
    Series("zones of a wrap", "1", (2, 4, 8, 16), lambda: np.ones(1),
           lambda n: np.array([held_on_cylinder(0.3, n) / held_cylinder()[1]])),
    Series("steps a second, genalpha", "m", (250, 500, 1000, 2000), lambda: swinging_load(**FINE),
           _at_steps("genalpha")),
    Series("steps a second, radau", "m", (50, 100, 200), lambda: swinging_load(**FINE), _at_steps("radau")),
]
