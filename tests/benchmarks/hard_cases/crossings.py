"""Riders that cross nodes slowly, fast, back and forth, start on one, share an element, overtake."""

from functools import cache

import numpy as np
from funicular import Circle, Material, Scene

from .case import BALANCE, CONVERGED, HELD, Subject, figures, simulate

HERE = Subject()
ROPE = {"element": "cable12", "strain": "engineering", "section": Circle(radius=0.0282),
        "material": Material(youngs_modulus=0.4e9, poisson_ratio=0.0, density=4200)}
"""Stiffness and mass of the paper's cable."""


def pinned_rope(gravity=(0, -9.81, 0), *, elements=6, **changed) -> Scene:
    """1.5 m of horizontal rope, held at both ends."""
    scene = Scene(gravity=gravity)
    scene.cable("wire", **{"start": (0, 0, 0), "end": (1.5, 0, 0), "elements": elements} | ROPE | changed)
    scene.pin("wire", s=0.0)
    scene.pin("wire", s=scene.cables["wire"].length)
    return scene


def ride(scene: Scene, s: float, speed: float, name="A", mass=1.0):
    """A small body on the wire."""
    wire = scene.cables["wire"]
    body = scene.rigid_body(name, mass=mass, inertia=(1e-3 * mass,) * 3, position=wire.point(s),
                            velocity=speed * wire.axes_at(s)[0])
    return scene.slide(body, along=wire, s=s)


def rider(s: float, speed: float, mass=1.0, **rope) -> Scene:
    """One rider on the pinned rope."""
    scene = pinned_rope(**rope)
    ride(scene, s, speed, mass=mass)
    return scene


@cache
def reference(s: float, speed: float, duration: float):
    """The converged motion of one rider."""
    return simulate(rider(s, speed), duration, **CONVERGED)


@HERE.case("crossing a node at 0.1 m/s", crossings=(1, 1), error=5e-5, balance=BALANCE, residual=HELD, gap=HELD)
def slowly(integrator):
    found = simulate(rider(0.495, 0.1), 0.1, integrator=integrator)
    return figures(found, reference(0.495, 0.1, 0.1))


@HERE.case("crossing nodes at 100 m/s", crossings=(5, 5),
           error={"genalpha": 1.5e-5, "energy": 3e-6, "explicit": 3e-6, "radau": 3e-6},
           balance=BALANCE, residual=HELD, gap=HELD)
def fast(integrator):
    found = simulate(rider(0.1, 100.0), 0.0135, integrator=integrator)
    return figures(found, reference(0.1, 100.0, 0.0135))


@HERE.case("crossing three nodes in a step", crossings=(5, 5), error=1e-5, balance=1e-4, residual=HELD, gap=HELD)
def several_in_a_step(integrator):
    """Steps of 7 ms are divided at every node: the travel of the rider is accurate, the motion of the cable coarse."""
    step = 0.0135 / 2 if integrator != "explicit" else 1e-4
    found = simulate(rider(0.1, 100.0), 0.0135, integrator=integrator, step=step, output_step=0.0135 / 2)
    return figures(found) | {"error": abs(found["A.position"][-1, 0] - 1.45) / 1.35}


def pulled(s: float, speed: float) -> Scene:
    """No weight: a force of 2 N pulls the rider back along a straight cable, x = s + v t - t²."""
    scene = rider(s, speed, gravity=(0, 0, 0), elements=3)
    scene.force("A", value=(-2, 0, 0))
    return scene


def turning(speed: float):
    def measure(integrator):
        run = simulate(pulled(0.75, speed), 1.2, integrator=integrator)
        exact = 0.75 + speed * run.time - run.time**2
        found = figures(run) | {"error": float(np.abs(run["A.position"][:, 0] - exact).max()),
                                "end": float(run.time[-1]), "force": float(np.abs(run["A_on_wire.force"]).max())}
        return found

    return measure


for difference in (0, 1e-14, -1e-14, 1e-9, -1e-9, 1e-3):
    HERE.case(f"a rider that turns round on a node, {difference:g} m/s too fast", error=1e-11, balance=1e-10,
              residual=1e-12, gap=1e-12, force=1e-9, end=(1.2, 1.2),
              crossings=(2, 2) if difference > 1e-4 else (0, 0) if difference < -1e-10 else (0, 2))(
                  turning(1 + difference))


def thrown_up(speed: float) -> Scene:
    """Up a cable that climbs and sags."""
    return rider(0.45, speed, end=(1.3, 0.75, 0), elements=3)


@HERE.case("a rider that turns round on a node of a sagging cable", apart=2.0, balance=BALANCE, residual=HELD, gap=HELD,
           slow=["energy", "explicit", "radau"])
def turning_on_a_sagging_cable(integrator):
    """`apart`: distance of two riders, one that just enters the next element and one that just does not, over the
    product of time and their difference of speed, 1 µm/s.
    """
    settings = {"integrator": integrator, "step": 1e-3 if integrator != "explicit" else 2e-4}
    run = lambda speed: simulate(thrown_up(speed), 0.5, output_step=0.02, **settings)  # noqa: E731
    slow, quick = 1.5, 2.5
    while quick - slow > 1e-6:
        middle = (slow + quick) / 2
        slow, quick = (slow, middle) if run(middle).report["element_crossings"] else (middle, quick)
    runs = run(slow), run(quick)
    apart = float(np.abs(runs[0]["A.position"] - runs[1]["A.position"]).max()) / ((quick - slow) * 0.5)
    return figures(runs[1]) | {"apart": apart}


@HERE.case("at rest on a node", error=1e-12, balance=BALANCE, residual=HELD, gap=HELD, rejected=50, steps=20_000)
def resting(integrator):
    """On the middle node of a swinging cable, where it stays by symmetry."""
    run = simulate(rider(0.75, 0.0, elements=2), 0.5, integrator=integrator)
    return figures(run) | {"error": float(np.abs(run["A_on_wire.s"] - 0.75).max())}


@HERE.case("a start on a node", error=8e-5, balance=BALANCE, residual=HELD, gap=HELD, apart=3e-9)
def starting(integrator):
    """`apart`: difference of starts 1 nm before and behind the node, over the motion, which must be continuous there.
    """
    runs = [simulate(rider(s, 1.0), 0.5, integrator=integrator, step=5e-4 if integrator == "genalpha" else None)
            for s in (0.5, 0.5 - 1e-9, 0.5 + 1e-9)]
    apart = max(float(np.abs(run["A.position"] - runs[0]["A.position"]).max()) for run in runs[1:])
    return figures(runs[0], reference(0.5, 1.0, 0.5)) | {"apart": apart}


def two(first: tuple[float, float], second: tuple[float, float]) -> Scene:
    """Riders that start at s (m) with a speed (m/s)."""
    scene = rider(*first, elements=4)
    ride(scene, *second, name="B")
    return scene


@cache
def two_exact(first, second, duration: float):
    """Their converged motion."""
    return simulate(two(first, second), duration, **CONVERGED)


@HERE.case("two slides on one element", error=1e-4, balance=BALANCE, residual=HELD, gap=HELD)
def on_one_element(integrator):
    """From 3 mm apart they stay within an element of 375 mm, except at its ends."""
    start = (0.27, 1.0), (0.273, 1.0)
    return figures(simulate(two(*start), 0.4, integrator=integrator), two_exact(*start, 0.4))


@HERE.case("one slide overtakes another", error=1e-4, balance=BALANCE, residual=HELD, gap=HELD, passed=(1, 1))
def overtaking(integrator):
    """At 2 m/s past one of 0.5 m/s; both ride the same point of the cable for an instant."""
    start = (0.3, 2.0), (0.45, 0.5)
    run = simulate(two(*start), 0.4, integrator=integrator)
    passed = np.sum(np.diff(np.sign(run["A_on_wire.s"] - run["B_on_wire.s"])) != 0)
    return figures(run, two_exact(*start, 0.4)) | {"passed": int(passed)}
