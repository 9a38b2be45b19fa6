"""Pantographs below catenaries: contact force and uplift, their convergence and cost.

    python tests/benchmarks/pantographs.py [--out FILE.csv] [--what reference|data|line55|kinds|cost|linear]

reference: the reference model of EN 50318:2002, which is withdrawn, at 250 and 300 km/h: 10 spans of 60 m, a pantograph
of two masses, assessed in spans 5 and 6 by the contact force below 20 Hz. The first rows are the ranges of the standard
and the figures of a published code; the others are computed. The standard gives neither the lengths of the droppers,
nor the uplift force, nor the frequency dependence of the damping. Assumed are, for both speeds, a sag of 5 mm, 120 N on
the frame, which sets the mean without validating it, and the damping ratio of 0.005 at 20 Hz, in proportion to mass,
which is more at lower frequencies. Sag and damping are chosen to meet the ranges, and are not validated either. Axial
stiffnesses are assumed (150 mm² and 120 mm² of copper alloys). No conformity to any standard is claimed, and the
edition of 2018 has another model.

data: the influence of each unknown, from a level wire with the damping ratio at 10 Hz on.

line55: the 55 m line with a pantograph of three masses at 275 and 320 km/h, one, and two at a distance of 200 m.

kinds: the reference model at 300 km/h with a pantograph of arms and hinges, with its equivalent masses, and with
staggers of 0.2 m.

cost: CPU seconds per simulated second, and the error of the standard deviation against a tolerance of 1 mm; numbers of
spans.

linear: the linear model of motion about rest beside the equations of the wires: the reference model at 250 and 300
km/h, two pantographs on the 55 m line, of which the second loses contact, and 3 to 60 spans.

Columns: mean, sigma, mean ± 3 sigma, largest and least force in N, the largest uplift at the masts of the section in
mm, the time without contact in %, steps and CPU seconds per simulated second.
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from funicular import catenary
from table import Parser, few, parser, show

ACCEPTED = {250: ("110-120", "26-31", "190-210", "20-40", "175-210", "50-75", "48-55", "0"),
            300: ("110-120", "32-40", "210-230", "-5-20", "190-225", "30-55", "55-65", "0")}
"""Ranges of EN 50318:2002: mean, sigma, statistical maximum and minimum, maximum, minimum, uplift, loss."""
PUBLISHED = {250: (118.2, 27.6, 201.1, 35.5, 193.7, 70.3, 52.2, ""),
             300: (118.7, 32.8, 213.2, 19.2, 195.4, 54.7, 59.7, "")}
COLUMNS = ("mean", "sigma", "mean+3s", "mean-3s", "max", "min", "uplift", "loss %")

FINE, USUAL, COARSE = (0.5, 0.5), (1.0, 1.0), (2.0, 2.0)
"""Longest elements of contact wire and messenger, m."""
FILTER_LENGTH = 18.0
"""m: beyond the section that is judged, so far the run goes on: the filter looks ahead."""
MATERIAL = 1e-4
"""s: damping time of the wires' material, without which waves above 50 Hz have hardly any damping."""


TOL = 5e-3
"""m: absolute_tol of the runs, the default; with 2e-2 m the standard deviation is up to 2.4 % larger."""


def reference(spans: int = 10, frequency: float = 20.0, sag: float = 5e-3, material: float = MATERIAL,
              axial: float = 1.0, dropper: float = 0.0, clamp: float = 0.0) -> catenary.Line:
    """Return the line of EN 50318:2002, with the damping ratio 0.005 at a frequency, in Hz.

    sag in m; material: damping time in s; axial: of the assumed stiffness; dropper in kg/m, clamp in kg: their masses.
    """
    damping = {"mass_damping": catenary.mass_damping(0.005, frequency), "damping_time": material}
    return catenary.Line(
        spans=spans, span=60.0, height=1.2, support=50e3, steady_arm=catenary.SteadyArm(stiffness=300),
        contact=catenary.Wire(mass=1.35, tension=20e3, axial_stiffness=axial * 15e6, bending_stiffness=195, **damping),
        messenger=catenary.Wire(mass=1.07, tension=16e3, axial_stiffness=axial * 12e6, bending_stiffness=131.7,
                                **damping),
        droppers=catenary.Droppers(at=[5, 10.5, 17, 23.5, 30, 36.5, 43, 49.5, 55], stiffness=100e3, sag=sag,
                                   mass=dropper, messenger_clamp=clamp, contact_clamp=clamp))


TWO_MASSES = catenary.Pantograph(masses=[7.2, 15], stiffness=[4200, 50], damping=[10, 90], uplift=120)


def line55(spans: int = 10, frequency: float = 10.0) -> catenary.Line:
    """Return the 55 m line, as tests/statics/test_catenary.py has it."""
    damping = {"mass_damping": catenary.mass_damping(0.005, frequency), "damping_time": MATERIAL}
    return catenary.Line(
        spans=spans, span=55.0, height=1.2, support=500e3,
        contact=catenary.Wire(mass=1.35, tension=22e3, axial_stiffness=15e6, bending_stiffness=179, **damping),
        messenger=catenary.Wire(mass=1.08, tension=16e3, axial_stiffness=11.64e6, bending_stiffness=111, **damping),
        droppers=catenary.Droppers(at=[4.5, 10.25, 16, 21.75, 27.5, 33.25, 39, 44.75, 50.5], sag=0.055,
                                   axial_stiffness=200e3, mass=0.117, messenger_clamp=0.195, contact_clamp=0.165))


THREE_MASSES = catenary.Pantograph(masses=[7.5, 9, 6], stiffness=[7000, 15500, 160], damping=[45, 0.1, 100],
                                   uplift=120)


def passage(line: catenary.Line, pantographs: dict[str, tuple[catenary.Pantograph, float]], kmh: float,
            longest: tuple[float, float], **settings):
    """Return a run of pantographs by name, each with its place at the start (m), up to 20 m before the end."""
    scene = catenary.scene(line, longest)
    for name, (pantograph, start) in pantographs.items():
        catenary.add_pantograph(scene, pantograph, start, kmh / 3.6, name)
    return scene.run(progress=False, **settings)


def figures(run, sections, name: str = "pantograph", **filtering) -> tuple[float, ...]:
    """Return the figures of the columns for the first of these sections."""
    found = catenary.assess(run, sections, name, **filtering)
    start, end = sections[0]
    masts = found.uplift.sel(mast=slice(start + 1, end + 1))
    first = found.isel(section=0)
    return (*(float(first[key]) for key in ("mean", "standard_deviation", "statistical_maximum", "statistical_minimum",
                                            "maximum", "minimum")),
            1e3 * float(masts.max()), 100 * float(first.loss_share))


def row(kmh: float, what: str, values, run=None) -> dict:
    """Return a row of the table."""
    cost = ("", "", "") if run is None else (
        run.report["unknowns"], run.report["steps"], run.report["time_s"]["solve_cpu"] / float(run.time[-1]))
    return {"km/h": kmh, "what": what, **{key: round(v, 1) if isinstance(v, float) else v
                                          for key, v in zip(COLUMNS, values, strict=True)},
            **dict(zip(("unknowns", "steps", "cpu s/s"), cost, strict=True))}


def judge(kmh: float, longest=USUAL, tol=TOL, uplift=120.0, spans=10, settings=None, **line):
    """Return the run of the reference model until after its two spans in the middle, and its figures there."""
    middle = 60.0 * (spans // 2)
    pantograph = catenary.Pantograph(masses=TWO_MASSES.masses, stiffness=TWO_MASSES.stiffness,
                                     damping=TWO_MASSES.damping, uplift=uplift)
    run = passage(reference(spans, **line), {"pantograph": (pantograph, 20.0)}, kmh, longest, absolute_tol=tol,
                  **{"duration": (middle + 60.0 + FILTER_LENGTH - 20.0) / (kmh / 3.6), **(settings or {})})
    return run, figures(run, [(middle - 60.0, middle + 60.0)])


CONVERGENCE = {"1 m": {}, "tolerance / 5": {"tol": TOL / 5}, "tolerance x 4": {"tol": 4 * TOL},
               "2 m": {"longest": COARSE}, "0.5 m": {"longest": FINE}, "16 spans": {"spans": 16},
               "24 spans": {"spans": 24}}
LEVEL = {"sag": 0.0, "frequency": 10.0}
DATA = {"level, damped at 10 Hz": {}, "damped at 30 Hz": {"frequency": 30.0}, "sag 10 mm": {"sag": 0.01},
        "sag 5 mm, damped at 20 Hz": {"sag": 5e-3, "frequency": 20.0}, "uplift force 114 N": {"uplift": 114.0},
        "droppers 0.1 kg/m, clamps 0.2 kg": {"dropper": 0.1, "clamp": 0.2}, "axial stiffness x 1.5": {"axial": 1.5},
        "damping time of the material x 10": {"material": 1e-3}}


def reference_rows(speeds=(250, 300), variants=CONVERGENCE) -> list[dict]:
    """Return the table of the reference model."""
    rows = []
    for kmh in few(speeds):
        rows += [row(kmh, "EN 50318:2002", ACCEPTED[kmh]), row(kmh, "a published code", PUBLISHED[kmh])]
        for what, variant in few(variants.items()):
            run, values = judge(kmh, **({"longest": COARSE, "tol": 40 * TOL} if Parser.smallest else variant))
            rows.append(row(kmh, what, values, run))
            print(rows[-1], flush=True)
    return rows


def data_rows() -> list[dict]:
    """Return the influence of unknown data."""
    return reference_rows(variants={what: {"tol": 4 * TOL, **LEVEL, **change} for what, change in DATA.items()})


def line55_rows() -> list[dict]:
    """Return the table of the 55 m line, spans 7 and 8 of 12."""
    rows = []
    for kmh in (275, 320):
        for longest in (USUAL, FINE):
            for starts in ((220.0,), (220.0, 20.0)):
                pantographs = {f"p{k + 1}": (THREE_MASSES, start) for k, start in enumerate(starts)}
                run = passage(line55(12), pantographs, kmh, longest, absolute_tol=TOL)
                for name in pantographs:
                    what = f"{name} of {len(starts)}, {longest[0]} m"
                    rows.append(row(kmh, what, figures(run, [(330.0, 440.0)], name), run))
                    print(rows[-1], flush=True)
    return rows


def kinds_rows() -> list[dict]:
    """Return the table of a pantograph with joints, its equivalent masses, and staggers."""
    jointed, level = catenary.JointedPantograph(uplift=120), reference()
    # an arm of this length adds nothing to the vertical stiffness of the model
    staggered = level.remade({"stagger": 0.2, "steady_arm": catenary.SteadyArm(stiffness=300, length=1e3)})
    rows = []
    for what, line, pantograph in (("arms and hinges", level, jointed), ("its masses", level, jointed.equivalent()),
                                   ("two masses, staggers", staggered, TWO_MASSES)):
        run = passage(line, {"pantograph": (pantograph, 20.0)}, 300, USUAL, absolute_tol=TOL,
                      duration=(360.0 + FILTER_LENGTH - 20.0) / (300 / 3.6))
        rows.append(row(300, what, figures(run, [(240.0, 360.0)]), run))
        print(rows[-1], flush=True)
    return rows


COSTS = ((0.2, {"output_step": 2e-3}), (0.2, {"output_step": 1e-3}), (0.05, {"output_step": 2e-3}), (0.02, {}),
         (0.01, {}), (TOL, {}), (2e-3, {}), (0.2, {"output_step": 2e-3, "spectral_radius": 0.8}),
         (0.2, {"output_step": 1e-3, "spectral_radius": 0.8}), (0.02, {"spectral_radius": 0.8}),
         (TOL, {"step": 1e-3}), (3.0, {"integrator": "radau"}), (1.0, {"integrator": "radau"}),
         (0.2, {"integrator": "radau"}), (0.02, {"integrator": "radau"}),
         (0.2, {"integrator": "linear", "output_step": 2e-3}), (TOL, {"integrator": "linear"}))
"""absolute_tol and other settings."""


def cost_rows() -> list[dict]:
    """Return errors and costs at 300 km/h, and their growth with the spans."""
    finest = judge(300, tol=1e-3)[1]
    rows = []
    for tol, settings in COSTS:
        run, values = judge(300, tol=tol, settings=settings)
        rows.append({**row(300, f"tol {tol:g} m {settings}", values, run),
                     "error of sigma %": 100 * (values[1] / finest[1] - 1)})
        print(rows[-1], flush=True)
    for spans in (5, 10, 20, 40):
        run = passage(reference(spans), {"pantograph": (TWO_MASSES, 20.0)}, 300, USUAL, absolute_tol=2e-1, duration=0.5)
        rows.append({**row(300, f"{spans} spans", ("",) * len(COLUMNS), run), "error of sigma %": ""})
        print(rows[-1], flush=True)
    return rows


LINEAR_STEPS = ({"step": 2e-3}, {"step": 1.5e-3, "output_step": 3e-3}, {"step": 1e-3}, {"step": 5e-4})
"""Settings of runs by the linear model."""


def linear_rows() -> list[dict]:
    """Return figures and costs by the linear model, and by the equations of the wires."""
    settings = [{}, *({"integrator": "linear"} | each for each in LINEAR_STEPS)]
    rows = []
    for kmh in few((250, 300)):
        for each in few(settings):
            run, values = judge(kmh, settings=each)
            rows.append(row(kmh, named(each), values, run))
            print(rows[-1], flush=True)
    two = {"p1": (THREE_MASSES, 220.0), "p2": (THREE_MASSES, 20.0)}
    for each in few(settings[:3]):
        run = passage(line55(12), two, 320, USUAL, absolute_tol=TOL, **each)
        for name in two:
            rows.append(row(320, f"{name} of 2, {named(each)}", figures(run, [(330.0, 440.0)], name), run))
            print(rows[-1], flush=True)
    for spans in few((3, 10, 30, 60)):
        run = passage(reference(spans), {"pantograph": (TWO_MASSES, 20.0)}, 300, USUAL, duration=0.5,
                      integrator="linear", step=2e-3)
        rows.append(row(300, f"{spans} spans, {named({'integrator': 'linear', 'step': 2e-3})}",
                        ("",) * len(COLUMNS), run))
        print(rows[-1], flush=True)
    return rows


TABLES = {"reference": reference_rows, "data": data_rows, "line55": line55_rows, "kinds": kinds_rows,
          "cost": cost_rows, "linear": linear_rows}


def named(settings: dict) -> str:
    """Return settings of the integrator in words."""
    return f"linear, {1e3 * settings['step']:g} ms" if settings else f"genalpha, tol {TOL:g} m"


def main() -> None:
    """Print the tables asked for."""
    command = parser(__doc__)
    command.add_argument("--what", choices=tuple(TABLES), default="reference")
    given = command.parse_args()
    show(TABLES[given.what](), given.out, given.what)


if __name__ == "__main__":
    np.set_printoptions(precision=3)
    main()
