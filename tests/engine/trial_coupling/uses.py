"""Where the trial coupling appears: prints what runs, states of rest, files and the page say of a tow, as JSON."""

import json
import sys
import warnings
from pathlib import Path

import funicular as fu
import numpy as np
from funicular.derive.theory.command import build
from funicular.scene.schema import scene_schema
from scene_stub import stub

warnings.simplefilter("ignore")
FOLDER = Path(sys.argv[1])
RUBBER = fu.Material(youngs_modulus=1e6, poisson_ratio=0.0, density=1000)
UP = {"y": np.eye(3), "z": np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])}
"""Axes of scenes, by the direction in which the tow pulls."""
CENTRE, RADIUS = (0.8, 0.0, 0.0), 0.3
"""Of the rail."""


def scene(velocity=1.0, offset=0.0, strength=3.0, element="cable12", up="y"):
    turned = UP[up]
    made = fu.Scene(gravity=(0, 0, 0))
    made.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=4, element=element, section=fu.Circle(radius=0.01),
               material=RUBBER, up=turned @ (0, 1, 0))
    made.pin("wire", s=0.0)
    made.pin("wire", s=1.0)
    made.tow(("wire", 0.5), start=turned @ (0.5, offset, 0), velocity=turned @ (0, velocity, 0),
             centre=turned @ CENTRE, radius=RADIUS, stiffness=50.0, strength=strength, name="T")
    return made


def run(made, integrator="radau", **settings):
    return made.run(0.2, output_step=0.01, integrator=integrator, progress=False, **{"tol": 1e-6} | settings)


def balance(of):
    """Return the largest change of energy that nothing accounts for, over the work from outside."""
    total = (of["energy.kinetic"] + of["energy.elastic"] + of["energy.potential"] + of["energy.dissipated"]
             - of["energy.external"])
    return float(np.abs(total - total[0]).max() / np.abs(of["energy.external"]).max())


found = {"integrators": {}, "page": {}}
for name in ("radau", "genalpha", "explicit", "energy"):
    made = run(scene(), name)
    events = made.report["events"]
    wheel = made["wire.nodal_vectors"][:, 2, 0] - CENTRE
    found["integrators"][name] = {"balance": balance(made), "status": made.status, "force": made["T.force"].tolist(),
                                  "reaction": made["T.reaction"].tolist(),
                                  "off_rail": float(np.abs(np.linalg.norm(wheel, axis=1) - RADIUS).max()),
                                  "events": [[each["name"], each["what"], each["time"]] for each in events]}
rest = scene(velocity=0.0, offset=0.05, strength=1e3).equilibrium()
before, after = (rest.section_forces("wire", 0.5, side=side)["force"].values[0] for side in ("before", "after"))
found["rest"] = {"force": rest["T.force"].tolist(), "reaction": rest["T.reaction"].tolist(),
                 "stretch": float(rest["T.stretch"]), "jump": (before - after).tolist()}
turned = run(scene(element="cable8p", up="z"))
flat = run(scene(element="cable8p"))
found["plane"] = {name: float(np.abs(turned[f"T.{name}"] - flat[f"T.{name}"] @ UP["z"].T).max())
                  for name in ("force", "reaction", "position")}


def stop(time):
    """Interrupt a run once the tow has broken, whose state has a flag and a number of that."""
    if time > 0.185:
        raise KeyboardInterrupt


kept, path = scene(), FOLDER / "kept.nc"
whole = kept.run(0.2, output_step=0.01, tol=1e-6, progress=False)
halves = [kept.run(0.2, output_step=0.01, tol=1e-6, save=path, **more)
          for more in ({"progress": stop}, {"progress": False, "resume": True})]
found["resumed"] = [halves[0].status] + [bool(np.array_equal(whole[name], halves[1][name])) for name in whole.keys()]
found["file"] = fu.load_run(path)["T.position"].tolist()
again = fu.Scene.from_toml(kept.to_toml())
found["scene_file"] = [again.tows["T"].stiffness, "[[tow]]" in kept.to_toml()]
found["schema"] = "tow" in scene_schema()["properties"]
found["stub"] = "def tow(" in stub()
found["page"] = [mark.name for mark in made.animation().clips[0].marks]
found["vectors"] = sorted(name for name in made.dataset.data_vars if name.startswith("T."))
pages, faults = build("tow", FOLDER)
found["theory"] = {"faults": faults, "formulas": pages[0].read_text(encoding="utf-8").count("<math id=")}
print(json.dumps(found))
