"""What ropes cost: operations of an element through which the material moves, and a step of a crane by the length in
store.
"""

import json

import funicular as fu
from funicular.derive.codegen import drift
from funicular.generated import described

FLOWING = {"cable8p": "span_cable8p", "cable12": "span_cable12"}
"""Families of kernels of spans, by the element from which each comes."""
LAW = "engineering_exact_assumed"
VECTORS = 4
"""Vectors of an element: places and slopes of both ends."""
TERMS = {"force": ("elastic_force",), "inertia": ("inertia",), "tangent": ("elastic_tangent", "inertia_tangent")}
"""Kernels of spans, by term."""
STORES = (10.0, 1000.0)
"""Lengths in store, m."""


def operations() -> list[dict]:
    """Return the operations of force, inertia and tangent of each element, at rest and flowing, and their ratio.

    The inertia of an element at rest is its mass matrix, of its vectors, times accelerations: two operations an entry.
    """
    kernels = described(json.loads((drift.folder() / "manifest.json").read_text(encoding="utf-8")))
    rows = []
    for element, span in FLOWING.items():
        count = {name: sum(kernel["operations"].values()) for name, kernel in kernels.items()}
        coordinates = kernels[f"{span}_mass_matrix"]["outputs"][0]["shape"][0] - 2
        still = {"force": count[f"{element}_{LAW}_elastic_force"], "inertia": 2 * VECTORS * coordinates,
                 "tangent": count[f"{element}_{LAW}_elastic_tangent"]}
        flowing = {term: sum(count[f"{span}_{name}"] for name in names) for term, names in TERMS.items()}
        for numbers in (still, flowing):
            numbers["all"] = sum(numbers.values())
        rows += [{"element": element, "term": term, "at rest": still[term], "flowing": flowing[term],
                  "ratio": flowing[term] / still[term]} for term in flowing]
    return rows


def crane(store: float) -> fu.Scene:
    """Return the installed tower crane with a length in store, m."""
    scene = fu.load_scene("tower_crane")
    route = [item.model_copy(update={"length_in_store": store}) if isinstance(item, fu.Drum) else item
             for item in scene.ropes["hoist"].route]
    return scene.replace("hoist", route=route)


def step_of(store: float, duration: float = 20.0) -> tuple[float, int, int]:
    """Return CPU seconds of the solver, steps and iterations of the crane in fixed steps."""
    report = crane(store).run(duration, step=0.02, output_step=1.0, integrator="genalpha", progress=False).report
    return report["time_s"]["solve_cpu"], report["steps"], report["newton_iterations"]


def stores(repetitions: int) -> list[dict]:
    """Return the cost of a step by the length in store: the least of alternating repetitions."""
    found = [[step_of(store) for store in STORES] for _ in range(repetitions)]
    best = [min(each[k][0] for each in found) for k in range(len(STORES))]
    return [{"store, m": store, "steps": found[0][k][1], "iterations": found[0][k][2],
             "us a step": 1e6 * best[k] / found[0][k][1], "us an iteration": 1e6 * best[k] / found[0][k][2],
             "ratio of steps": best[k] / best[0]} for k, store in enumerate(STORES)]
