"""Steps a hundred times too large, a hundred thousand steps, spectral radius from 0 to 1, the paper's scene refined."""

from functools import cache

import numpy as np
from funicular import ConvergenceError, Material, Rectangle, Scene
from paper51 import REFERENCE
from sliding import sliding_mass

from .cables import SCENES
from .case import BALANCE, CONVERGED, HELD, Subject, balance, error, figures, largest_motion, reference, simulate
from .crossings import rider

HERE = Subject()
COARSE = {"a rider": (lambda: rider(0.25, 1.0, elements=3), 1.0), **SCENES}


def too_large(name: str):
    def measure(integrator):
        """The step is a tenth of the duration, 30 to 1000 times that of tol. `error / told`: relative to the summed
        estimates of the report; `told`: number of notes on it; explicit methods must stop instead.
        """
        scene, duration = COARSE[name]
        exact = reference(*COARSE[name])
        times = duration / 10 / exact.report["largest_step_s"]
        try:
            run = simulate(scene(), duration, step=duration / 10, output_step=duration / 10, integrator=integrator)
        except ConvergenceError as failed:
            return {"stopped": 1, "kept": len(failed.run.time), "times too large": times}
        found = error(run, exact)
        estimate = run.report["sum_of_local_error_estimates_m"] / largest_motion(exact)
        told = [note for note in run.report["messages"] if "take a smaller step" in note]
        return {"stopped": 0, "error": found, "error / told": found / estimate, "told": len(told),
                "quiet error": 0.0 if told else found, "balance": balance(run), "times too large": times}

    return measure


STABLE = {"genalpha": 5, "energy": 5, "radau": 5}

for name in COARSE:
    HERE.case(f"too large a step: {name}", stopped=dict.fromkeys(STABLE, (0, 0)) | {"explicit": (1, 1)},
              kept={"explicit": (2, 20)}, **{
                  "error / told": STABLE, "quiet error": dict.fromkeys(STABLE, 1e-2),
                  "times too large": (30, 1e4)})(too_large(name))


def soft() -> Scene:
    """A rider of 1 kg swings to and fro in a soft planar cable, over its middle node."""
    scene = Scene()
    scene.cable("wire", start=(0, 0, 0), end=(1.5, 0, 0), elements=2, element="cable8p",
                section=Rectangle(height=0.05, width=0.05),
                material=Material(youngs_modulus=4e6, poisson_ratio=0.0, density=4200))
    scene.pin("wire", s=0.0)
    scene.pin("wire", s=1.5)
    scene.rigid_body("A", mass=1.0, inertia=(1e-3,) * 3, position=(0.5, 0, 0))
    scene.slide("A", along="wire", s=0.5)
    return scene


def long(spectral_radius: float):
    def measure(integrator):
        """100,000 steps of 1 ms, some 80 node passages, 100 periods. `growth`, `loss`: of energy, over that exchanged;
        `drift`: of the joint between the first and the last tenth, m. The projection of genalpha's velocities at each
        passage changes the energy by 1e-5, of either sign.
        """
        run = simulate(soft(), 100.0, step=1e-3, output_step=0.1, spectral_radius=spectral_radius,
                       integrator=integrator)
        relative, tenth = run.energy_balance().relative, len(run.time) // 10
        residual = run["A_on_wire.residual"]
        return figures(run) | {"growth": float(relative.max()), "loss": float(-relative.min()),
                               "drift": float(residual[-tenth:].max() - residual[:tenth].max())}

    return measure


HERE.case("100,000 steps", integrators=["energy", "explicit", "radau"], steps=(1e5, 1.01e5),
          crossings=(40, 200), residual=1e-11, gap=1e-11, drift=1e-12,
          growth={"energy": 1e-12, "explicit": 1e-12, "radau": 1e-12},
          loss={"energy": 1e-12, "explicit": 1e-9, "radau": 6e-4},
          slow=["energy", "explicit", "radau"])(long(1.0))
HERE.case("100,000 steps, spectral radius 0.9", integrators=["genalpha"], steps=(1e5, 1.01e5), crossings=(40, 200),
          residual=1e-11, gap=1e-11, drift=1e-12, growth=1e-5, loss=1e-2)(long(0.9))
HERE.case("100,000 steps, spectral radius 0.5", integrators=["genalpha"], steps=(1e5, 1.01e5), growth=1e-5, loss=0.1,
          residual=1e-11, gap=1e-11, drift=1e-12, slow=["genalpha"])(long(0.5))


def of_radius(spectral_radius: float):
    def measure(integrator):
        run = simulate(rider(0.25, 1.0, elements=3), 0.6, spectral_radius=spectral_radius, integrator=integrator)
        return figures(run, radius_reference()) | {"loss": float(-run.energy_balance().relative.min())}

    return measure


@cache
def radius_reference():
    return simulate(rider(0.25, 1.0, elements=3), 0.6, **CONVERGED)


for spectral_radius in (0.0, 0.25, 0.5, 0.75, 1.0):
    HERE.case(f"spectral radius {spectral_radius:g}", integrators=["genalpha"], error=4e-4, balance=2e-3,
              residual=HELD, gap=HELD)(of_radius(spectral_radius))


@cache
def finest(element: str):
    """The paper's scene on 30 elements, the rider at 1 s."""
    return simulate(sliding_mass(30, element), 1.0, tol=1e-4, output_step=0.01)


def paper(elements: int, tol: float):
    def measure(integrator):
        """`from the reference`: difference to the independent solution with 3 elements, over its largest motion; `from
        30 elements`: of the rider's position.
        """
        run = simulate(sliding_mass(elements, "beam24"), 1.0, tol=tol, output_step=0.01, integrator=integrator)
        found = figures(run)
        if elements == 3:
            exact = np.column_stack([REFERENCE["x_m"], REFERENCE["y_m"]])
            found["from the reference"] = float(np.abs(run["A.position"][:, :2] - exact).max() / np.ptp(exact[:, 0]))
        else:
            found["from 30 elements"] = float(np.abs(run["A.position"] - finest("beam24")["A.position"]).max())
        return found

    return measure


HERE.case("the paper's scene, 3 elements", crossings=(2, 2), residual=HELD, gap=HELD, balance=BALANCE,
          slow=["explicit"], **{"from the reference": 1e-4})(paper(3, 1e-4))
HERE.case("the paper's scene, 30 elements", integrators=["genalpha"], slow=["genalpha"], crossings=(21, 21),
          residual=HELD, gap=HELD, balance=BALANCE)(paper(30, 1e-4))
HERE.case("the paper's scene, 300 elements", integrators=["genalpha"], slow=["genalpha"], crossings=(214, 214),
          residual=HELD, gap=HELD, balance=1e-3, rejected=250, **{"from 30 elements": 5e-4})(paper(300, 1e-3))


@HERE.case("a steel wire, 300 elements", integrators=["genalpha"], residual=HELD, gap=HELD, balance=1e-2, rejected=200,
           steps=300)
def steel(integrator):
    """Vibrations of 1e6 Hz, which no step resolves and short steps to output times must not excite. If they do, the
    energy grows by its own amount within the run, or the run ends.
    """
    return figures(simulate(sliding_mass(300, "beam24", youngs_modulus=2e11), 0.25, tol=1e-3, output_step=0.01,
                            integrator=integrator))
