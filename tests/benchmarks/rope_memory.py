"""Ropes with memory: viscosity, friction between wires and working curves beside closed forms, by integrator.

    python tests/benchmarks/rope_memory.py [--out FILE.csv]

A rope of 10 m without weight, a standard linear solid: stiffness EA for long times, EA + K for short ones. Its end is
pulled by a force (creep), moved and held (relaxation), and moved harmonically (loss in a cycle). A rope whose end is
turned to and fro, with friction between its wires: bilinear loops of the moment by the curvature. A rope of fibres
that is stretched, let go, stretched further and let go again: its working curves.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from funicular import Circle, Harmonic, Material, Ramp, Run, Scene, TensionTable
from funicular.parts.signal import CombinedSignal
from table import arguments, few, show

L, RADIUS = 10.0, 0.005
EA, K, TAU = 8e4, 3e4, 0.2
FORCE, SHIFT, BEGIN = 800.0, 0.02, 0.2
FREQUENCY, CYCLES = 1.5, 6
"""Hz, and cycles until the last one, which is measured."""
ROPE = Material(youngs_modulus=EA / (np.pi * RADIUS**2), poisson_ratio=0.3, density=1.0)
"""So light that its waves take a thousandth of `BEGIN`."""
RISE = Ramp(start=0.0, end=BEGIN)
TURN, BENT, SLIP, TURNS = 0.05, 1.5, 0.01875, 2
"""rad, N m², N m: half the range of the end's angle, stiffness and limit of friction, which slides from half of the
curvature on; and cycles."""
LENGTH, PERIOD, WIRES = 2.0, 2.0, 0.5
"""m, s, and N m²: of the rope that is bent; of loose wires."""
INTEGRATORS = "genalpha", "radau", "explicit", "linear"
FIBRES = TensionTable(strain=[0, 0.05, 0.1], force=[0, 0.05 * EA, 0.1 * EA])
"""Straight, so that all areas are closed forms."""
PERMANENT, BEND = 0.4, 0.5
STOPS = (0.2, 0.4), (0.4, 0.2), (0.6, 0.6), (0.8, 0.45), (1.0, 0.6)
"""s, and m: times and displacements between which the end of the rope of fibres moves, without becoming slack."""
CURVES = {"linear": {}, "quadratic": {"bend": BEND}, "exponential": {"bend": BEND}}


def rope(element: str = "cable8p", density: float = ROPE.density) -> Scene:
    """Return the rope, clamped at its start."""
    scene = Scene(gravity=(0, 0, 0))
    scene.cable(
        "rope",
        start=(0, 0, 0),
        end=(L, 0, 0),
        elements=2,
        element=element,
        section=Circle(radius=RADIUS),
        material=ROPE.remade({"density": density}),
        strain="engineering",
    )
    scene.pin("rope", s=0.0)
    scene.relaxation("rope", stiffness=K, time=TAU, name="viscosity")
    return scene


def pulled(element: str = "cable8p") -> Scene:
    """Return the rope under a force that rises and stays."""
    scene = rope(element)
    scene.force("rope", s=L, value=(FORCE, 0, 0), scale=RISE)
    return scene


def after_rise(kernel: Callable[[np.ndarray], np.ndarray], time: np.ndarray) -> np.ndarray:
    """Return (T,): the integral of kernel(t - s) times the rate of `RISE` at s, by Gauss's rule, with s the times of
    the rise up to t.
    """
    places, weights = np.polynomial.legendre.leggauss(40)
    end = np.minimum(time, BEGIN)[:, None]
    s = end * (1 + places) / 2
    x = s / BEGIN
    return np.sum(kernel(time[:, None] - s) * 30 * x**2 * (1 - x) ** 2 / BEGIN * end / 2 * weights, axis=1)


def creep(time: np.ndarray) -> np.ndarray:
    """Return the displacement (T,) of the end of the pulled rope, m, by its creep compliance."""
    retardation = TAU * (EA + K) / EA
    return FORCE * L * after_rise(lambda t: 1 / EA - K / (EA * (EA + K)) * np.exp(-t / retardation), time)


def moved(element: str = "cable8p") -> Scene:
    """Return the rope whose end moves and stays."""
    scene = rope(element)
    scene.motion("rope", s=L, displacement=(Ramp(before=0, after=SHIFT, start=0, end=BEGIN), *[0, 0]))
    return scene


def relaxation(time: np.ndarray) -> np.ndarray:
    """Return the tension (T,) of the spring of the moved rope, N."""
    return K * SHIFT / L * after_rise(lambda t: np.exp(-t / TAU), time)


def shaken(element: str = "cable8p") -> Scene:
    """Return the rope whose end moves harmonically."""
    scene = rope(element)
    scene.motion(
        "rope", s=L, displacement=(Harmonic(amplitude=-SHIFT, frequency=FREQUENCY, phase=np.pi / 2, offset=SHIFT), 0, 0)
    )
    return scene


def loss() -> float:
    """Return the energy that the shaken rope takes in a cycle, J, by its loss modulus."""
    x = 2 * np.pi * FREQUENCY * TAU
    return np.pi * SHIFT**2 / L * K * x / (1 + x**2)


def lost(run: Run) -> float:
    """Return the energy that the shaken rope takes in the last cycle of a run, J."""
    dissipated = np.interp([(CYCLES - 1) / FREQUENCY, CYCLES / FREQUENCY], run.time, run["energy.dissipated"])
    return float(np.diff(dissipated)[0])


def displacement(run: Run) -> np.ndarray:
    """Return the displacement (T,) of the end of a rope, m."""
    return run["rope.nodal_vectors"][:, -1, 0, 0] - L


VISCOUS = {
    "creep": (pulled, displacement, creep, "displacement, m"),
    "relaxation": (moved, lambda run: run["viscosity.tension"].mean(axis=1), relaxation, "tension, N"),
}


def of_viscosity(case: str, integrator: str, tol: float = 1e-7) -> dict:
    """Return the row of creep or relaxation: the largest error over time."""
    scene, result, closed_form, quantity = VISCOUS[case]
    run = scene().run(3.0, output_step=0.05, integrator=integrator, tol=tol)
    found, exact = result(run), closed_form(run.time)
    at = np.argmax(np.abs(found - exact))
    return row(case, integrator, quantity, found[at], exact[at], np.abs(exact).max(), run)


def of_loss(integrator: str, tol: float = 1e-7) -> dict:
    """Return the row of the loss in a cycle."""
    run = shaken().run(CYCLES / FREQUENCY, output_step=1 / (20 * FREQUENCY), integrator=integrator, tol=tol)
    return row("harmonic", integrator, "loss in a cycle, J", lost(run), loss(), loss(), run)


def bent(element: str = "cable8p", elements: int = 4) -> Scene:
    """Return a rope whose end turns to and fro, with friction between its wires; it is too light to vibrate."""
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("rope", start=(0, 0, 0), end=(LENGTH, 0, 0), elements=elements, element=element,
                section=Circle(radius=RADIUS), strain="engineering", material=Material(
                    youngs_modulus=WIRES / (np.pi * RADIUS**4 / 4), poisson_ratio=0.3, density=0.05))
    scene.clamp("rope", s=0.0)
    scene.motion("rope", s=LENGTH, rotation=((0, 0, 1), Harmonic(amplitude=-TURN, frequency=1 / PERIOD, phase=np.pi / 2,
                                                                 offset=TURN)))
    scene.wire_friction("rope", stiffness=BENT, moment=SLIP, name="wires")
    return scene


def loop(time: np.ndarray) -> np.ndarray:
    """Return the moment (T,) of friction of the bent rope, N m, by the curvature at times that have its extremes."""
    moment, found = 0.0, [0.0]
    for change in np.diff(TURN / LENGTH * (1 - np.cos(2 * np.pi * time / PERIOD))):
        moment = float(np.clip(moment + BENT * change, -SLIP, SLIP))
        found.append(moment)
    return np.array(found)


def of_friction(integrator: str, tol: float = 1e-5, **how: float) -> list[dict]:
    """Return the rows of the moment, and of the energy of the last cycle."""
    run = bent().run(TURNS * PERIOD, output_step=PERIOD / 40, integrator=integrator, tol=tol, **how)
    moment, exact = run["wires.moment"][..., 2], loop(run.time)
    at = np.unravel_index(np.argmax(np.abs(moment - exact[:, None])), moment.shape)
    lost, whole = run["energy.dissipated"][-1] - run["energy.dissipated"][-41], 4 * SLIP * (TURN - SLIP / BENT * LENGTH)
    return [row("bending", integrator, "moment, N m", moment[at], exact[at[0]], SLIP, run),
            row("bending", integrator, "loss in a cycle, J", lost, whole, whole, run)]


def fibres(curve: str = "linear", element: str = "cable8p", density: float = ROPE.density, elements: int = 2) -> Scene:
    """Return a rope of fibres with working curves, pinned at its start."""
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("rope", start=(0, 0, 0), end=(L, 0, 0), elements=elements, element=element, membrane="tabulated",
                section=Circle(radius=RADIUS, tension_table=FIBRES), material=ROPE.remade({"density": density}))
    scene.pin("rope", s=0.0)
    scene.working_curve("rope", permanent=PERMANENT, form=curve, **CURVES[curve], name="worked")
    return scene


def stretched(curve: str = "linear", element: str = "cable8p") -> Scene:
    """Return a rope of fibres whose end goes from stop to stop."""
    scene, before = fibres(curve, element), (0.0, 0.0)
    ramps, changes = [], []
    for stop in STOPS:
        ramps.append(Ramp(start=before[0], end=stop[0]))
        changes.append(stop[1] - before[1])
        before = stop
    scene.motion("rope", s=L, displacement=(CombinedSignal(signals=ramps, factors=changes), 0, 0))
    return scene


def shape(curve: str, x: np.ndarray) -> np.ndarray:
    """Return the share of the force at the highest strain by the share x of the way to it."""
    return {"linear": x, "quadratic": x * (1 - BEND + BEND * x),
            "exponential": np.expm1(BEND * x) / np.expm1(BEND)}[curve]


def mean_of_shape(curve: str) -> float:
    """Return the mean of the shape."""
    return {"linear": 0.5, "quadratic": 0.5 - BEND / 6, "exponential": 1 / BEND - 1 / np.expm1(BEND)}[curve]


def working_tension(curve: str, strain: np.ndarray) -> np.ndarray:
    """Return the tension (T, ...) of the rope of fibres, N, by strains of a history that has its extremes."""
    highest = np.maximum.accumulate(strain, axis=0)
    low = PERMANENT * highest
    with np.errstate(invalid="ignore"):
        x = np.where(highest > 0, (strain - low) / (highest - low), 0.0)
    return EA * np.where(strain < highest, highest * shape(curve, np.maximum(x, 0.0)), strain)


def working_loss(curve: str, highest: float) -> float:
    """Return the energy that the rope of fibres has lost by a highest strain, J."""
    return L * EA * highest**2 * (0.5 - (1 - PERMANENT) * mean_of_shape(curve))


def of_working_curve(integrator: str, curve: str = "linear", tol: float = 1e-5, **how: float) -> list[dict]:
    """Return the rows of the tension, and of the energies that both first loadings have cost."""
    run = stretched(curve).run(STOPS[-1][0], output_step=0.01, integrator=integrator, tol=tol, **how)
    times = np.concatenate([[0.0], [stop[0] for stop in STOPS]])
    end = sum(Ramp(start=a, end=b).value(run.time) * change for a, b, change in zip(
        times, times[1:], np.diff([0.0, *(stop[1] for stop in STOPS)]), strict=False))
    tension, exact = run["worked.tension"], working_tension(curve, np.asarray(end) / L)
    at = np.unravel_index(np.argmax(np.abs(tension - exact[:, None])), tension.shape)
    case, found = f"working curve, {curve}", []
    for time, highest in ((0.5, STOPS[0][1]), (STOPS[-1][0], STOPS[2][1])):
        lost, whole = np.interp(time, run.time, run["energy.dissipated"]), working_loss(curve, highest / L)
        found.append(row(case, integrator, f"loss up to {highest:g} m, J", lost, whole, whole, run))
    return [row(case, integrator, "tension, N", tension[at], exact[at[0]], np.abs(exact).max(), run), *found]


def row(case: str, integrator: str, quantity: str, found: float, exact: float, size: float, run: Run) -> dict:
    """Return a row with the error over the size of the quantity, and that of the energies over the work."""
    energies = run["energy.kinetic"] + run["energy.elastic"] + run["energy.dissipated"] - run["energy.external"]
    return {
        "case": case,
        "integrator": integrator,
        "quantity": quantity,
        "found": float(found),
        "reference": float(exact),
        "error": float(abs(found - exact) / size),
        "energy": float(np.ptp(energies) / np.abs(run["energy.external"]).max()),
        "steps": run.report["steps"],
    }


def main() -> None:
    """Measure and print."""
    options = arguments(__doc__)
    cases = [lambda i, c=case: of_viscosity(c, i) for case in VISCOUS] + [of_loss]
    rows = [case(integrator) for case in few(cases) for integrator in few(INTEGRATORS)]
    rows += [each for curve in few(CURVES) for integrator in few(INTEGRATORS[:3])
             for each in of_working_curve(integrator, curve)]
    show([*rows, *of_friction("radau"), *of_friction("genalpha", step=1e-3)], options.out)


if __name__ == "__main__":
    main()
