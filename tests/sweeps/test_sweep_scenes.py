"""Points of sweeps on threads are the runs of scenes with these values, bit for bit: all bundled scenes, and numbers of
each kind of part in them.
"""

import funicular as fu
import numpy as np
import pytest
from funicular.parts.material import Material
from funicular.parts.paths import label_of

SETTINGS = {"duration": 0.004, "output_step": 0.002, "tol": 1e-3}
KEPT = ["energy.kinetic", "energy.elastic", "energy.potential"]
LONG = {"aerial_tramway", "catenary", "mooring", "overhead_span", "paper52_modal", "slewing_crane"}
"""Scenes that take half a second and more for each point."""
MAX_NUMBERS = 2
"""Numbers of each kind of part that change."""
SCENES = [pytest.param(name, marks=[pytest.mark.slow] * (name in LONG)) for name in fu.bundled_scenes()]


def numbers(scene: fu.Scene) -> dict[str, tuple[float, fu.Scene]]:
    """Return changed numbers by path, with the scenes that have them: some of a part of each kind, and gravity."""
    found, seen = {}, set()
    for part in scene.parts():
        label = label_of(part)
        if label is None or type(part) in seen:
            continue
        seen.add(type(part))
        entries = part.as_made().entries()
        plain = [key for key, value in entries.items() if isinstance(value, float) and value][:MAX_NUMBERS]
        for key in plain:
            value = 1.001 * entries[key]
            found[f"{label}.{key}"] = value, (part, {key: value})
        if isinstance(material := entries.get("material"), Material):
            value = 1.1 * material.density
            found[f"{label}.material.density"] = value, (part, {"material": material.remade({"density": value})})
    made = {}
    for path, (value, (part, changes)) in found.items():
        try:
            changed = scene.replace(part, **changes)
            changed.check()
        except fu.SceneError:  # such as the place of a support between two nodes
            continue
        made[path] = value, changed
    heavier = (0.0, 1.1 * scene.gravity[1], 0.0)
    return made | {"gravity.y": (heavier[1], scene.changed([], gravity=heavier))}


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("name", SCENES)
def test_each_point_is_the_run_of_its_scene(name):
    scene = fu.load_scene(name)
    scene.run_settings = {"initial": scene.run_settings["initial"]} if "initial" in scene.run_settings else {}
    changed, before = numbers(scene), {}
    for path in changed:
        head, _, rest = path.partition(".material.") if ".material." in path else path.rpartition(".")
        part = next((each for each in scene.parts() if label_of(each) == head), None)
        before[path] = (scene.gravity[1] if part is None else part.material.density if ".material." in path
                        else part.as_made().entries()[rest])
    points = {path: [value if path == other else before[path] for other in changed]
              for path, (value, _) in changed.items()}
    found = fu.sweep(scene, points, method="list", keep=KEPT, workers=2, batch=4, progress=False, **SETTINGS)
    assert len(changed) > 1 and set(found.status.values) == {"completed"}
    for k, (path, (_, made)) in enumerate(changed.items()):
        run = made.run(**SETTINGS, progress=False)
        for kept in KEPT:
            assert np.array_equal(found[kept].values[k], run[kept]), (path, kept)
        message = str(found.message.values[k]).removesuffix("...")  # of a long one the file has the beginning
        assert "; ".join(run.report["messages"]).startswith(message)
