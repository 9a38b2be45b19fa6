"""Error of the chosen model on other scenes: riders near and above the wave speed of their cable, impacts, contact,
crossings, one-sided springs, friction, slack cables, water.

    python tests/benchmarks/model_shocks.py [--only WORDS] [--tols 1e-2,1e-3] [--finer 3] [--out FILE.csv]

``error/tol`` is that of the motion of the chosen model against ``--finer`` times its elements, run with a hundredth
of the chosen tolerance by the automatic integrator, over the largest motion and over tol. ``choice`` is the CPU time of
the choice over that of the run.
"""

from __future__ import annotations

import time
import warnings
from dataclasses import replace

import funicular as fu
import numpy as np
from choice_scenes import SCENES as TIMED
from choice_scenes import Subject
from funicular.choice.motion import motion
from funicular.choice.remeshing import remade
from funicular.results.trajectories import distance, largest_change
from hard_cases import crossings
from table import few, parser, show

WAVE = np.sqrt(0.05 * 0.4e9 * 1.05 / 4200)
"""Speed of transverse waves of the riders' rope, m/s."""
TIMES = 20


def rider(mach: float) -> Subject:
    """A rider at a multiple of the wave speed of a taut rope, pushed down."""
    def make() -> fu.Scene:
        scene = crossings.pinned_rope(gravity=(0, 0, 0), elements=12, rest_length=1.5 / 1.05,
                                      section=fu.Circle(radius=5e-3))
        crossings.ride(scene, 0.03, 1.01 * mach * WAVE)
        scene.force("A", value=(0, -50, 0))
        return scene
    return Subject(make, 1.2 / (mach * WAVE))


def thrown() -> fu.Scene:
    """A soft cable thrown obliquely on the ground."""
    scene = fu.Scene()
    line = scene.cable("line", start=(0, 0.15, 0), end=(1.5, 0.5, 0), elements=20, element="cable8p",
                       section=fu.Circle(radius=0.01), velocity=(1.0, -2.0, 0),
                       material=fu.Material(youngs_modulus=2e7, poisson_ratio=0.0, density=1100, damping_time=1e-3))
    scene.surface("ground", fu.Plane())
    scene.contact(line, "ground", stiffness=2e5, damping=0.5, friction=0.3)
    return scene


def pushed_wire(speed: float = 55.0) -> fu.Scene:
    """A head on a carriage moves along under a taut wire with a wave speed of 94 m/s, and is pressed against it."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(0, 0, 0), end=(20, 0, 0), elements=40, element="cable8p",
                rest_length=20 / (1 + 1000 / (4e9 * np.pi * 8e-3**2)), section=fu.Circle(radius=8e-3),
                material=fu.Material(youngs_modulus=4e9, poisson_ratio=0.3, density=600))
    scene.pin("wire", s=0)
    scene.pin("wire", s=scene.cables["wire"].length)
    y = -8e-3
    scene.rigid_body("carriage", mass=1000.0, inertia=(1, 1, 1), position=(4, y - 1, 0), velocity=(speed, 0, 0))
    scene.rigid_body("head", mass=0.5, inertia=(1, 1, 1), position=(4, y, 0), velocity=(speed, 0, 0))
    scene.joint("prismatic", (4, y - 1, 0), "carriage", axis=(1, 0, 0), velocity=speed)
    scene.joint("prismatic", "carriage", "head", axis=(0, 1, 0))
    scene.force("head", value=(0, 50, 0))
    scene.crossing("wire", "head", name="contact", side=(0, 1, 0), stiffness=5e4, damping=0.05)
    return scene


def snatched() -> fu.Scene:
    """A body falls until a tension-only rope stops it, at the middle of a taut cable."""
    scene = fu.Scene()
    scene.cable("rope", start=(0, 0, 0), end=(8, 0, 0), rest_length=7.95, elements=16, element="cable8p",
                section=fu.Circle(radius=6e-3),
                material=fu.Material(youngs_modulus=2e9, poisson_ratio=0.3, density=1100, damping_time=1e-3))
    scene.pin("rope", s=0)
    scene.pin("rope", s=7.95)
    scene.rigid_body("A", mass=4.0, inertia=(0.1, 0.1, 0.1), position=(4, -0.8, 0))
    scene.spring(("rope", 7.95 / 2), "A", name="dropper", stiffness=5e4, length=1.0, tension_only=True)
    return scene


def struck() -> fu.Scene:
    """A ball flies at a bed, and a cable holds it back: hard contact, and a cable that snaps taut."""
    scene = fu.Scene()
    scene.cable("leash", curve=lambda u: (u, 0.2 + 0.1 * u + 0.3 * np.sin(np.pi * u), 0), rest="straight",
                elements=12, element="cable8p", section=fu.Circle(radius=4e-3),
                material=fu.Material(youngs_modulus=5e7, poisson_ratio=0.3, density=1100, damping_time=1e-3))
    scene.pin("leash", s=0)
    scene.surface("ground", fu.Plane())
    scene.rigid_body("ball", mass=0.5, inertia=(1e-3,) * 3, position=(1, 0.3, 0), velocity=(3, -3, 0))
    scene.joint("spherical", ("leash", scene.cables["leash"].length), "ball", name="eye")
    scene.contact("ball", "ground", restitution=0.6, friction=0.2, radius=0.05, name="bounce")
    return scene


def towed() -> fu.Scene:
    """A line in a stream across it: drag, lift, added mass."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.cable("line", start=(0, 0, 0), end=(0, -10, 0), elements=12, element="cable12",
                section=fu.Circle(radius=0.01), up=(1, 0, 0),
                material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=2000))
    scene.pin("line", s=0)
    scene.fluid(density=1025.0, velocity=(2.0, 0, 0))
    scene.drag("line", normal=1.2, tangential=0.02, lift=0.3, added_mass=1.0)
    return scene


def bundled(name: str, duration: float) -> Subject:
    """A bundled scene over a part of its duration, from the start of its file."""
    initial = fu.load_scene(name).run_settings.get("initial", "drawn")
    return Subject(lambda: fu.load_scene(name), duration, initial)


SCENES = {f"rider at {mach:g} times the wave speed": rider(mach) for mach in (0.9, 1.0, 1.1, 1.5, 2.0, 3.0)} | {
    name: TIMED[name] for name in (
        "rider at twice the wave speed", "hard stop", "buffer", "buckling", "slack goes taut", "whip",
        "friction, vibrating", "friction, undamped", "friction that stops", "stick", "two riders",
        "taut cable, struck", "driven slide")} | {
    "thrown on the ground": Subject(thrown, 0.4), "wire pushed by a head": Subject(pushed_wire, 0.15),
    "wire pushed by a fast head": Subject(lambda: pushed_wire(130.0), 0.1),
    "falls into a dropper": Subject(snatched, 0.5), "ball on a leash": Subject(struck, 0.4),
    "towed line": Subject(towed, 1.5), "mooring": bundled("mooring", 60.0),
    "mooring_on_bed": bundled("mooring_on_bed", 2.0),
    "rope_over_drum": bundled("rope_over_drum", 0.5), "overhead_span": bundled("overhead_span", 0.5),
    "catenary": bundled("catenary", 0.2)}


class Stopwatch:
    """Ends a reference that takes too long."""

    def __init__(self, seconds: float):
        self.end = time.process_time() + seconds

    def __call__(self, reached: float) -> None:
        if time.process_time() > self.end:
            raise TimeoutError("too long")


def _factor(elements: int, finer: int) -> int:
    """Return the refinement of a mesh for a reference: to 64 elements at least, and less for large meshes."""
    return max(finer if elements <= 100 else 2, -(-64 // elements))


def row(name: str, tol: float, finer: int, seconds: float = 60.0) -> dict:
    """Return one row of the table."""
    subject = SCENES[name]
    found: dict = {"scene": name, "tol": tol, "error/tol": float("nan"), "estimate": float("nan"), "kept": False,
                   "probes": 0, "choice": float("nan"), "chosen": ""}
    try:
        choice = subject.make().choose(tol, duration=subject.duration, initial=subject.initial, free="all")
    except fu.FunicularError as error:
        return found | {"chosen": f"refused: {error}"[:150]}
    models = "; ".join(dict.fromkeys(map(str, choice.models.values())))
    found |= {"estimate": choice.error / tol, "kept": choice.kept, "probes": choice.probes,
              "chosen": f"{models}, {choice.integrator} {choice.time_tol:.1g}"}
    settings = {"output_step": subject.duration / TIMES, "initial": subject.initial}
    try:
        begin = time.process_time()
        run = choice.scene.run(**settings, progress=Stopwatch(seconds))
        found["choice"] = choice.seconds / (time.process_time() - begin)
        fine = remade(choice.scene, {cable: replace(model, elements=_factor(model.elements, finer) * model.elements)
                                     for cable, model in choice.models.items()})
        exact = fine.run(**settings | {"tol": choice.time_tol / 100, "integrator": "auto"},
                         progress=Stopwatch(seconds))
    except (fu.FunicularError, TimeoutError) as error:
        return found | {"chosen": f"{found['chosen']}: {error}"[:150]}
    points = motion(fine, exact)
    return found | {"error/tol": distance(motion(run.scene, run), points) / largest_change(points) / tol}


def main() -> None:
    """Measure and print."""
    options = parser(__doc__)
    options.add_argument("--only", default="", help="scenes whose name holds this")
    options.add_argument("--tols", default="1e-2,1e-3", help="tolerances")
    options.add_argument("--finer", type=int, default=3, help="elements of the reference over those chosen")
    options = options.parse_args()
    warnings.simplefilter("ignore", fu.FunicularWarning)
    rows = []
    for name in few(name for name in SCENES if options.only in name):
        for tol in map(float, few(options.tols.split(","))):
            rows.append(row(name, tol, options.finer))
            print(rows[-1], flush=True)
    show(rows, options.out)


if __name__ == "__main__":
    main()
