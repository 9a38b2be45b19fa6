"""Loads that move and change: figures of beams and slides beside closed forms, with every integrator.

    python tests/benchmarks/changing_loads.py [--out FILE.csv]

A force F crosses a simply supported beam at the constant speed v, α = v L/π sqrt(ρA/EI) (case M1); deflections of its
middle are over F L³/48EI. A train of three axles crosses it and leaves it. A brake decelerates a slide until it
sticks.
"""

from __future__ import annotations

import numpy as np
from funicular import Friction, Material, Ramp, Rectangle, Run, Scene, TableSignal
from funicular.parts.signal import Integral
from table import arguments, few, show

L, DEPTH = 10.0, 0.1
STEEL = Material(youngs_modulus=2e11, poisson_ratio=0.0, density=7800)
EI, LINE = STEEL.youngs_modulus * DEPTH**4 / 12, STEEL.density * DEPTH**2
DEFLECTION_RATIO = 1e-6
"""Static deflection under the force at mid-span, over the length: the beam stays linear."""
F = 48 * EI / L**2 * DEFLECTION_RATIO
PUBLISHED = {0.1: 1.0964535, 0.25: 1.2576098, 0.5: 1.7054452, 0.617: 1.7316740, 1.0: 1.5480737}
"""Largest deflection by α while the force is on the beam, over the static one."""
INTEGRATORS = "genalpha", "radau", "explicit", "energy", "linear"
TRAIN = {"offsets": (0.0, -3.0, -5.0), "shares": (1.0, 0.5, 2.0)}
MODES = np.arange(1, 400)
SPEED, COEFFICIENT, CLOSING = 3.0, 0.2, Ramp(start=0.2, end=1.2)
BRAKING = "genalpha", "radau", "explicit"
"""Integrators that take friction."""


def beam(element: str = "cable8p", elements: int = 16) -> Scene:
    """Return a scene of a simply supported beam without weight."""
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("beam", start=(0, 0, 0), end=(L, 0, 0), elements=elements, element=element, up=(0, 1, 0),
                section=Rectangle(height=DEPTH, width=DEPTH), material=STEEL)
    scene.pin("beam", s=0.0)
    scene.pin("beam", s=L)
    return scene


def speed_of(alpha: float) -> float:
    """Return the speed of a force, m/s."""
    return alpha * np.pi / L * np.sqrt(EI / LINE)


def crossing(alpha: float, until: float = 1.0, element: str = "cable8p", **train: tuple[float, ...]) -> Scene:
    """Return a beam that a force crosses from t = 0; until: the end of its motion, in crossings; train: its axles."""
    scene, time = beam(element), until * L / speed_of(alpha)
    scene.force("beam", s=TableSignal(time=[0, time], value=[0, until * L], interpolation="linear"), value=(0, -F, 0),
                name="load", **train)
    return scene


def deflection(run: Run) -> np.ndarray:
    """Return the deflection of the middle over the static one (T,)."""
    nodes = run["beam.nodal_vectors"]
    return -nodes[:, nodes.shape[1] // 2, 0, 1] / (DEFLECTION_RATIO * L)


def by_modes(alpha: float, time: np.ndarray) -> np.ndarray:
    """Return the deflection of the middle by a force that comes at t = 0 and leaves at L/v, over the static one (T,),
    by modes of the beam (Fryba, Vibration of solids and structures under moving loads, 1972).
    """
    n, v = MODES, speed_of(alpha)
    w, W = (n * np.pi / L) ** 2 * np.sqrt(EI / LINE), n * np.pi / L * v
    at, since = np.clip(time, 0, L / v)[:, None], np.clip(time - L / v, 0, None)[:, None]
    same = np.abs(w - W) < 1e-9 * w
    over = np.where(same, 1.0, w**2 - W**2)
    place = np.where(same, (np.sin(w * at) - w * at * np.cos(w * at)) / (2 * w**2),
                     (np.sin(W * at) - W / w * np.sin(w * at)) / over)
    rate = np.where(same, at * np.sin(w * at) / 2, W * (np.cos(W * at) - np.cos(w * at)) / over)
    coordinate = place * np.cos(w * since) + rate / w * np.sin(w * since)
    return np.asarray(coordinate @ np.sin(n * np.pi / 2)) * 2 / (LINE * L) * 48 * EI / L**3


def train_by_modes(alpha: float, time: np.ndarray) -> np.ndarray:
    """Return the deflection of the middle under `TRAIN`, by superposition (T,)."""
    axles = zip(TRAIN["offsets"], TRAIN["shares"], strict=True)
    return np.asarray(sum(share * by_modes(alpha, time + offset / speed_of(alpha)) for offset, share in axles))


def of_force(alpha: float, integrator: str) -> dict:
    """Return the row of a force that crosses the beam."""
    time = L / speed_of(alpha)
    run = crossing(alpha).run(time, output_step=time / 2000, integrator=integrator, tol=1e-6)
    found = deflection(run)
    return {"case": f"M1, α {alpha:g}", "integrator": integrator, "quantity": "largest deflection",
            "found": float(found.max()), "reference": PUBLISHED[alpha],
            "error": float(abs(found.max() - PUBLISHED[alpha])), "steps": run.report["steps"]}


def of_train(alpha: float, integrator: str) -> dict:
    """Return the row of a train that crosses the beam and leaves it."""
    time = 2 * L / speed_of(alpha)
    run = crossing(alpha, 2.0, **TRAIN).run(time, output_step=time / 2000, integrator=integrator, tol=1e-6)
    found, exact = deflection(run), train_by_modes(alpha, run.time)
    at = np.argmax(np.abs(found - exact))
    return {"case": f"train of three, α {alpha:g}", "integrator": integrator, "quantity": "deflection",
            "found": float(found[at]), "reference": float(exact[at]), "error": float(abs(found[at] - exact[at])),
            "steps": run.report["steps"]}


def under_range(start: float, stop: float) -> tuple[float, float]:
    """Return the deflection of the middle at rest under F/L between two places of the first half, and in closed form:
    the integral of the influence s (3 L² - 4 s²)/48 EI; over F L³/48 EI.
    """
    scene = beam(elements=6)
    scene.distributed_force("beam", value=(0, -F / L, 0), start=start, stop=stop)
    found = -scene.equilibrium()["beam.nodal_vectors"][3, 0, 1] / (DEFLECTION_RATIO * L)
    integral = [(1.5 * L**2 * s**2 - s**4) / L**4 for s in (start, stop)]
    return float(found), integral[1] - integral[0]


def of_range() -> dict:
    """Return the row of a line load over a range of s, at rest."""
    found, exact = under_range(1.1, 4.3)
    return {"case": "line load from 1.1 to 4.3 m", "integrator": "at rest", "quantity": "deflection", "found": found,
            "reference": exact, "error": abs(found - exact), "steps": 0}


def rail(friction: Friction) -> Scene:
    """Return a mass of 2 kg at 3 m/s that slides along a rail clamped at every node, from s = 0.5 m."""
    scene = Scene()
    wire = scene.cable("rail", start=(0, 0, 0), end=(L, 0, 0), elements=8, element="cable12", material=STEEL,
                       section=Rectangle(height=DEPTH, width=DEPTH))
    for s in wire.node_s:
        scene.clamp(wire, s=s, fix="all")
    scene.rigid_body("car", mass=2.0, inertia=(1, 1, 1), position=(0.5, 0, 0), velocity=(SPEED, 0, 0))
    scene.slide("car", along="rail", s=0.5, name="wheels", friction=friction)
    return scene


def braked(by: str, model: str = "stick") -> Scene:
    """Return the rail with a brake that closes by a signal, or when the slide passes s = 2 m."""
    how = {"when": "mark"} if by == "event" else {"scale": CLOSING}
    scene = rail(Friction(coefficient=COEFFICIENT, model=model, velocity=1e-5, **how))
    scene.event("mark", quantity="wheels.s", value=2.0, direction="rising")
    return scene


def braked_speed(by: str, time: np.ndarray) -> np.ndarray:
    """Return the speed (T,) in closed form: the weight presses, v = v0 - μ g times the integral of the scale."""
    if by == "event":
        closed = np.maximum(time - 1.5 / SPEED, 0)
    else:
        closed = Integral(rate=CLOSING).value(time)
    return np.maximum(SPEED - COEFFICIENT * 9.81 * closed, 0)


def of_brake(by: str, integrator: str) -> dict:
    """Return the row of a brake that decelerates a slide until it sticks."""
    run = braked(by).run(2.4, output_step=0.01, integrator=integrator, tol=1e-6)
    found, exact = run["wheels.s_rate"], braked_speed(by, run.time)
    at = np.argmax(np.abs(found - exact))
    return {"case": f"brake by {'an event' if by == 'event' else 'a signal'}", "integrator": integrator,
            "quantity": "speed, m/s", "found": float(found[at]), "reference": float(exact[at]),
            "error": float(abs(found[at] - exact[at])), "steps": run.report["steps"]}


def main() -> None:
    """Measure and print."""
    options = arguments(__doc__)
    cases = [lambda i, a=alpha: of_force(a, i) for alpha in PUBLISHED] + [lambda i: of_train(0.25, i)]
    rows = [case(integrator) for case in few(cases) for integrator in few(INTEGRATORS)]
    rows += [of_brake(by, each) for by in few(("signal", "event")) for each in few(BRAKING)]
    show([*rows, of_range()], options.out)


if __name__ == "__main__":
    main()
