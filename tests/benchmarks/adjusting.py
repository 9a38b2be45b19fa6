"""CPU time of `equilibrium(adjust=, to=)` of an overhead line by its number of spans, in the plane z = 0 and in another
one.

The adjusted parameters are lengths of droppers for heights of the contact wire, and the length of the wire for its
tension; heights of supports for those of the messenger; loads on the contact wire for its heights. Then the form of the
55 m line (`funicular.catenary.form`), and ropes between posts, with lengths for their sags.

    python adjusting.py [--most SPANS] [--out FILE.csv]
"""

from __future__ import annotations

import time

import funicular as fu
import numpy as np
from funicular import catenary
from funicular.solve.statics import static_problem
from pantographs import line55
from table import arguments, few, show

G, SPAN, ELEMENTS = 9.81, 55.0, 22
X = np.array([4.5, 10.25, 16, 21.75, 27.5, 33.25, 39, 44.75, 50.5])
SAG = 0.055 * (1 - ((X - 27.5) / 23) ** 2)
CONTACT = {"tension": 22e3, "area": 150e-6, "modulus": 100e9, "bending": 179.0, "mass": 1.35}
MESSENGER = {"tension": 16e3, "area": 120e-6, "modulus": 97e9, "bending": 111.0, "mass": 1.08}
PLANES = {"z = 0": np.eye(3), "y = 0": np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])}
"""Axes as columns: along the line, up, and across."""


def wire(scene: fu.Scene, axes: np.ndarray, name: str, height: float, excess: float, data: dict,
         spans: int) -> fu.Cable:
    """Add a wire that is longer than a span by an excess under its given tension."""
    area, modulus = data["area"], data["modulus"]
    section = fu.GeneralSection(area=area, second_moment_about_z=data["bending"] / modulus)
    length = spans * (SPAN + excess) / (1 + data["tension"] / (modulus * area))
    return scene.cable(name, start=axes @ [0, height, 0], end=axes @ [spans * SPAN, height, 0], up=axes[:, 1],
                       elements=spans * ELEMENTS, element="cable8p", section=section, strain="engineering",
                       rest_length=length,
                       material=fu.Material(youngs_modulus=modulus, poisson_ratio=0.3, density=data["mass"] / area))


def line(spans: int, axes: np.ndarray) -> fu.Scene:
    """Return the line with droppers of one length, many of them slack."""
    scene = fu.Scene(gravity=axes @ [0, -G, 0])
    contact = wire(scene, axes, "contact", 0.0, 0.0, CONTACT, spans)
    messenger = wire(scene, axes, "messenger", 1.2, 0.03, MESSENGER, spans)
    for s in (0, messenger.length):
        scene.pin(messenger, s=s)
    for k in range(1, spans):
        scene.spring(axes @ [k * SPAN, 2.2, 0], (messenger, k / spans * messenger.length), name=f"support_{k}",
                     stiffness=500e3, length=1.0)
    up = int(np.argmax(np.abs(axes[:, 1])))
    for s in (0, contact.length):
        scene.motion(contact, s=s, displacement=["free" if k == up else 0 for k in range(3)])
    for name, at in places(spans).items():
        upper, lower = at * messenger.length, at * contact.length
        scene.spring((messenger, upper), (contact, lower), name=name, stiffness=200e3 / 0.85, length=0.85,
                     tension_only=True)
        scene.force(messenger, s=upper, value=axes @ [0, -G * (0.195 + 0.117 * 0.85), 0])
        scene.force(contact, s=lower, value=axes @ [0, -G * 0.165, 0])
    return scene


def places(spans: int) -> dict[str, float]:
    """Return the names of the droppers, and their positions as shares of the wires' lengths."""
    return {f"dropper_{span}_{k}": (span + x / SPAN) / spans for span in range(spans) for k, x in enumerate(X)}


def droppers(scene: fu.Scene, spans: int, up: str) -> tuple[dict, dict]:
    """Return parameters and targets: droppers for heights of the contact wire, and its length for its tension."""
    return ({**{f"{name}.length": (0.3, 1.5) for name in places(spans)}, "contact.rest_length": "free"},
            {**heights(scene, spans, up), "contact@0.force.x": -CONTACT["tension"]})


def supports(scene: fu.Scene, spans: int, up: str) -> tuple[dict, dict]:
    """Return heights of the supports, for those of the messenger there."""
    length = scene.cables["messenger"].length
    return ({f"support_{k}.a.{up}": "free" for k in range(1, spans)},
            {f"messenger@{k / spans * length:.12g}.position.{up}": 1.2 + 0.02 * np.sin(k) for k in range(1, spans)})


def loads(scene: fu.Scene, spans: int, up: str) -> tuple[dict, dict]:
    """Return forces on the contact wire below the droppers, for its heights there."""
    length = scene.cables["contact"].length
    down = [-float(axis == up) for axis in "xyz"]
    for name, at in places(spans).items():
        scene.force("contact", s=at * length, value=down, name=f"load_{name}")
    return ({f"load_{name}.value.{up}": "free" for name in places(spans)},
            {name: value - 0.02 for name, value in heights(scene, spans, up).items()})


CASES = {"droppers": droppers, "supports": supports, "loads": loads}


def heights(scene: fu.Scene, spans: int, up: str) -> dict[str, float]:
    """Return the heights of the contact wire at the droppers, by their names."""
    length = scene.cables["contact"].length
    return {f"contact@{at * length:.12g}.position.{up}": -sag
            for at, sag in zip(places(spans).values(), np.tile(SAG, spans).tolist(), strict=True)}


def adjusted(case: str, spans: int, plane: str) -> tuple[float, fu.Equilibrium]:
    """Return the CPU seconds, and the state with the given values."""
    scene = line(spans, PLANES[plane])
    adjust, to = CASES[case](scene, spans, "xyz"[int(np.argmax(np.abs(PLANES[plane][:, 1])))])
    begin = time.process_time()
    rest = scene.equilibrium(adjust=adjust, to=to)
    return time.process_time() - begin, rest


def row(case: str, spans: int) -> dict:
    """Return the row of a line with a number of spans."""
    found = {plane: adjusted(case, spans, plane) for plane in PLANES}
    last = found["z = 0"][1].adjustment
    return {"adjusted": case, "spans": spans, "parameters": len(last.values),
            **{f"seconds, {plane}": seconds for plane, (seconds, _) in found.items()},
            "iterations": last.iterations, "misfit": last.misfits[-1]}


def ropes(spans: int) -> tuple[fu.Scene, list[str], dict[str, float]]:
    """Return ropes of one length between posts, which are stiff springs, with lengths for sags from 1 to 2 m."""
    scene, heights = fu.Scene(gravity=(0, -G, 0)), {}
    area, modulus = MESSENGER["area"], MESSENGER["modulus"]
    section = fu.GeneralSection(area=area, second_moment_about_z=MESSENGER["bending"] / modulus)
    steel = fu.Material(youngs_modulus=modulus, poisson_ratio=0.3, density=MESSENGER["mass"] / area)
    for k in range(spans):
        rope = scene.cable(f"rope_{k}", start=(k * SPAN, 0, 0), end=((k + 1) * SPAN, 0, 0), elements=ELEMENTS,
                           element="cable8p", section=section, material=steel, rest_length=SPAN + 0.06)
        heights[f"{rope.name}@{rope.length / 2:.12g}.position.y"] = -1.5 + 0.5 * np.cos(k)
        if k:
            scene.tie(rope, s=0, to=f"rope_{k - 1}", at=rope.length, rotation="free")
            scene.spring((k * SPAN, -8, 0), (rope, 0), name=f"post_{k}", stiffness=50e3, length=8.0)
            scene.spring((k * SPAN + 8, 0, 0), (rope, 0), name=f"stay_{k}", stiffness=500e3, length=8.0)
        else:
            scene.pin(rope, s=0)
    scene.pin(rope, s=rope.length)
    return scene, [f"rope_{k}.rest_length" for k in range(spans)], heights


def wires(case: str, size: float) -> dict:
    """Return the row of the form of a span with elements of a length in m, or of a number of ropes."""
    built, plain = [], static_problem.build
    static_problem.build = lambda scene: built.append(scene) or plain(scene)
    begin = time.process_time()
    if case == "form":
        rest = catenary.form(line55(), longest=(size, size)).rest
    else:
        scene, adjust, to = ropes(int(size))
        rest = scene.equilibrium(adjust=adjust, to=to)
    seconds, static_problem.build = time.process_time() - begin, plain
    last = rest.adjustment
    return {"adjusted": case, "size": size, "parameters": len(last.values), "seconds": seconds, "scenes": len(built),
            "iterations": last.iterations, "misfit": last.misfits[-1]}


def main() -> None:
    """Measure and print."""
    options = arguments(__doc__, most=(30, "spans"))
    adjusted("droppers", 1, "z = 0")  # imports
    show([row(case, spans) for case in few(CASES) for spans in (1, 3, 10, 30, 100)
          if spans <= options.most and (spans > 1 or case != "supports")], options.out, "line")
    show([wires(case, size) for case, sizes in few((("form", (1.0, 0.5, 0.25)), ("ropes", (3, 10))))
          for size in few(sizes)], table="wires")


if __name__ == "__main__":
    main()
