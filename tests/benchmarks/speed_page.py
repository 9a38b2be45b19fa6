"""Sections of the page Speed: other codes first, then the cost of funicular by itself."""

from __future__ import annotations

from printed import Row, Section, Table, cell

CONDITIONS = """Time never stands alone: each row has its error, or the command shows it. Errors of a motion are the
largest distance of a node or body from the reference, over the largest motion in the scene. CPU times are of one
thread, where nothing else is said, and of the machine and load that the line above each table names. Codes that are
compared take turns in one run. [Validation](validation.md) has the references."""

KERNELS = [f"{law}_{what}" for law in ("cable8p_green_exact", "cable12_green_exact", "cable18_green_exact",
                                       "beam12p_continuum", "beam24_continuum", "beam24_structural")
           for what in ("elastic_force", "elastic_tangent")]
"""Of all kernels those that the page shows."""


def kernels(rows: list[Row]) -> list[Row]:
    """Return the rows of KERNELS."""
    return [row for row in rows if row["kernel"] in KERNELS]


def rods(rows: list[Row]) -> list[Row]:
    """Return rows with the figures of a cell; the rod without bending is an experiment of its own."""
    found = []
    for row in rows:
        second = f"; {cell(row['second'])}" if row["second"] != "" else ""
        seconds = f" in {cell(row['cpu_s'])} s" if row["cpu_s"] != "" else ""
        found.append(row | {"figures": f"{cell(row['error'])}{second}{seconds}"})
        if row["solver"].endswith("bending=False"):
            found[-1] |= {"experiment": f"{row['experiment']}, no bending", "solver": "funicular"}
    return found


PEERS = [
    Section(
        "Aims",
        """Figures that decide how fast answers are, and what is aimed at. The sections below have the errors beside
them.""",
        [Table("aims", {"figure": "figure", "unit": "unit", "measured": "measured", "aim": "aim", "reached": "reached"},
               table="aims")]),
    Section(
        "Side by side with Exudyn",
        """CPU time in s until the path of the tip or of the mass has the error at the head of the column: funicular
/ Exudyn, and in brackets their ratio. Both codes run interleaved on one thread each, set-up excluded, Exudyn with
its fast build. A time in brackets was not reached and is extrapolated. With 32 and 128 elements both codes converge
to the same motion to 1e-6; with fewer, the quadrature of the bending differs, and each is measured against its own
converged motion. At 1e-2 and 1e-3 a sliding mass takes hardly more steps than there are outputs, which funicular's
time contains and Exudyn's does not. Exudyn's sliding joint is of first order in the step, the slide of funicular of
second.""",
        [Table("exudyn_side_by_side",
               {"case": "scene", "elements": "elements"},
               table="times",
               by=("error", "{best / s} / {exudyn / s} ({times faster})"),
               options="--limit 6 --plot exudyn_side_by_side.png"),
         Table("exudyn_side_by_side",
               {"case": "scene", "elements": "elements"},
               table="times",
               by=("error", "{best} {setting}; {their steps}; {auto/best}"),
               options="--limit 6",
               text="""The settings: integrator and `tol` (or fixed step in s) of funicular; steps of Exudyn; time
of `integrator="auto"` over that of the best other integrator.

![Error over CPU time of both, case by case](exudyn_side_by_side.png)"""),
         Table("exudyn_whole_calls",
               {"case": "scene", "elements": "elements", "error": "error", "setting": "setting",
                "their steps": "their steps", "our solver / ms": "solver, ms", "their solver / ms": "theirs, ms",
                "times faster, solver": "ratio", "our call / ms": "whole call, ms", "their call / ms": "theirs, ms",
                "times faster, call": "ratio"},
               text="""Whole calls beside their solvers, at loose errors and with few elements, where set-up counts: the
description of the scene, its set-up, the run, and in funicular labelled results at 51 times with the notes on them; in
Exudyn the description, the assembly and the run, without outputs. CPU ms, the least of alternating repetitions; the
fastest setting that reaches the error counts, without interpolation.""")]),
    Section(
        "Rods beside PyElastica and MuJoCo",
        """The experiments of [cosseratbench](https://pypi.org/project/cosseratbench): the error that each
experiment scores and CPU time. All codes have the number of elements that the experiment asks for; the crossing is
run with 50, too, because its metric gives 2.5e-4 to the exact shape on 51. The reference of the catenary leaves
bending out. The second figure of the crossing is the lift; the capstan's error is a slide in m, nil by theory. [The
solver](../../runtime/guides/pages/cosseratbench.md) is part of the package.""",
        [Table("cosserat",
               {"experiment": "experiment", "elements": "elements"},
               table="peers",
               by=("solver", "{figures}"),
               rows=rods),
         Table("cosserat",
               {"experiment": "experiment", "elements": "elements", "error": "error"},
               table="meshes",
               options="--meshes",
               text="""The error with half, once and twice the elements. A constant error belongs to the reference
(bending of the catenary, linear theory of cantilever and pendulum) or to the contact stiffness.""")]),
    Section(
        "Ropes over sheaves beside Exudyn and MuJoCo",
        """Two weights on a rope without mass, one of which swings: errors of its place against the inextensible
solution, and the least CPU time of the solver. MuJoCo's tendon leaves the sheave where the wrap passes 180 degrees,
between 1 and 2 s.""",
        [Table("reeving",
               {"code": "code", "EA, N": "EA, N", "setting": "setting", "error at 1 s, m": "error at 1 s, m",
                "error at 3 s, m": "error at 3 s, m", "solver CPU s": "solver, s",
                "whole call CPU s": "whole call, s"}),
         Table("sheaves",
               {"element": "element", "term": "term", "at rest": "at rest", "flowing": "flowing", "ratio": "ratio"},
               table="operations",
               text="""Operations of an element of a cable, and of one through which the material of a rope moves."""),
         Table("sheaves",
               {"store, m": "store, m", "steps": "steps", "iterations": "iterations", "us a step": "µs a step",
                "us an iteration": "µs an iteration"},
               table="stores",
               text="The tower crane in fixed steps by the length on its winch.")]),
    Section(
        "Mooring lines",
        """A chain of 835 m with drag, added mass and a bed, whose upper end surges by 4 m in 10 s: 60 s beside MoorDyn.
The error is the largest one of the tension at the upper end over its range, each code against its own converged
tension. The whole call has the description of the line and its state of rest in it.""",
        [Table("mooring_lines",
               {"code": "code", "elements": "elements", "setting": "setting", "error": "error",
                "run, CPU s": "run, s", "whole call, CPU s": "whole call, s"}),
         Table("mooring_lines",
               {"the converged tensions": "the converged tensions", "range, N": "range, N", "largest, N": "largest, N",
                "distance over the range": "distance over the range"},
               table="converged",
               text="""MoorDyn's added mass is a force on accelerations, that of funicular the kinetic energy of the
fluid.""")]),
    Section(
        "A lazy-wave cable",
        """A cable in 80 m of water with a buoyant part, on a bed, drag on all of it: 150 elements, 36 s, its hang-off
heaves by 3 m in 12 s. Errors are of the tension at the hang-off in the last period, over its range, from a converged
run.""",
        [Table("lazy_wave",
               {"added mass": "added mass", "setting": "setting", "integrator": "integrator", "steps": "steps",
                "error": "error", "error of mean": "of its mean", "error of min": "of its minimum",
                "error of max": "of its maximum", "run, CPU s": "run, s", "whole call, CPU s": "whole call, s"}),
         Table("lazy_wave",
               {"added mass": "added mass", "mean, N": "mean, N", "others' mean, N": "others", "min, N": "minimum, N",
                "others' min, N": "others ", "max, N": "maximum, N", "others' max, N": "others  "},
               table="converged",
               text="Others: two programs that agree without added mass, and one with Morison's.")]),
    Section(
        "Many scenes",
        """Variants of a scene of 3 elements, with riders of 0.5 to 2 kg, one second each, `tol=1e-3`. Description,
set-up, run and results count. The last column is the time with Python's lock, which bounds what further threads
give.""",
        [Table("many_scenes",
               {"scene": "scene", "method": "method", "error": "error", "CPU ms a scene": "CPU ms a scene",
                "of them locked": "of them locked"})]),
    Section(
        "Kernels",
        """One call of a generated kernel. Project Chrono differentiates the forces of its cable numerically and
integrates its 24 coordinates by a reduced quadrature; Exudyn's time contains the assembly. Kernels are exact to
rounding: `funicular verify` prints the error of each.""",
        [Table("kernels",
               {"kernel": "kernel", "operations": "operations", "us": "µs", "others_us": "others, µs"},
               table="kernels",
               rows=kernels),
         Table("blocks",
               {"kernel": "kernel", "ns_block": "ns an element", "ns_single": "one by one", "gain": "ratio",
                "of_peak": "of peak"},
               rows=kernels,
               text="""With AVX2, forces and most tangents are evaluated for four elements at once, with the same
bits. The peak counts fused multiply-adds, which the kernels do not use.""")]),
]

ALONE = [
    Section(
        "First scene",
        """Example 5.1 of the paper, one second. `motion` is against steps of 10 µs; the other errors are against an
independent solution, over the range of each quantity. The release excites a vibration of the section (0.3 ms, 1e-7
m), which is a tenth of the range of accelerations.""",
        [Table("first_scene",
               {"setting": "setting", "integrator": "integrator", "steps": "steps", "motion": "error of the motion",
                "y": "of y", "y_acceleration": "of y-acceleration", "energy": "energy", "cpu_s": "CPU s"})],
        test="tests/parts/test_first_scene.py"),
    Section(
        "Work and precision",
        """`funicular bench SCENE` measures error against time on a user's own scene. The picture shows example 5.1,
and the same with 5 kg on a cable of 2 MPa.

![Time error over CPU time of two scenes, mesh errors marked](work_precision.png)

    .venv/bin/python tests/benchmarks/work_precision.py --plot work_precision.png"""),
    Section(
        "Scenes that ring",
        """Vibrations that a tolerance need not resolve: rods turned beyond their critical twist, a stretched cable
let go. Beside each run stands the cheapest fixed step with no larger an error. The limit is `tol` and `absolute_tol`
over the motion of what counts.""",
        [Table("ringing",
               {"scene": "scene", "tol": "tol", "limit": "limit", "error": "error", "integrator": "integrator",
                "steps": "steps", "CPU s": "CPU s", "best fixed": "best fixed step", "its error": "its error",
                "its CPU s": "its CPU s"})],
        test="tests/motion/test_ringing.py"),
    Section(
        "Cost against elements",
        """CPU time in µs a step and an element. Steps of 20 µs of generalised-alpha with one matrix for all steps.
LAPACK factors the band of a cable; riders, slides and shared nodes are its border.""",
        [Table("linear_cost",
               {"scene": "scene"},
               by=("elements", "{us_per_step_and_element}"),
               options="--plot linear_cost.png",
               text="""![Time and memory of a step against elements](linear_cost.png)""")],
        test="tests/engine/test_linear_cost.py"),
    Section(
        "Cost against bodies",
        """Rods of 0.1 kg let go level, generalised-alpha with steps of 1 ms. The error is against a quarter of the
step. Unknowns are eliminated front by front in the order of the scene's graph; chains and trees fill in no more than
a joint, loops fill in more.""",
        [Table("bodies",
               {"scene": "scene", "bodies": "bodies", "error": "error", "us_per_step": "µs a step",
                "us_per_step_and_body": "µs a step and body", "iterations_per_step": "iterations a step",
                "multiplications": "multiplications a body", "set_up_s": "set-up, s"})]),
    Section(
        "Many parts",
        """Slides on one cable with three elements for each, and nets of bodies; generalised-alpha. An exponent is that
of the number of parts, from one row to the next. A cable with more than 24 slides is divided into substructures, and
the equations of its slides are a band in the order in which they stand on it. Rotations of bodies that are held at
their mass centres alone are eliminated by themselves.""",
        [Table("many_parts",
               {"scene": "scene", "parts": "parts", "us_per_step_and_part": "µs a step and part",
                "exponent": "exponent", "iterations_per_step": "iterations a step",
                "factorisations_per_step": "factorisations a step", "MB": "MB",
                "exponent_of_memory": "exponent of memory"})],
        test="tests/engine/test_linear_cost.py"),
    Section(
        "Threads",
        """Wall time of a step with one thread over that with two, `genalpha`, `cable12`, with the same bits. Steps
of 20 µs keep one matrix; steps for `tol=1e-3` take a new one in every tenth step. Fewer than 250 elements are not
shared.""",
        [Table("threads",
               {"scene": "scene", "steps": "steps"},
               by=("elements", "{ratio}"))],
        test="tests/engine/test_threads.py"),
    Section(
        "Iterations of a step",
        """Newton iterations and factorisations a step of generalised-alpha, medians over scenes; the record has
each scene.""",
        [Table("iterations",
               {"setting": "setting", "scenes": "scenes", "largest error": "largest error",
                "iterations": "iterations", "factored": "factorisations"},
               table="medians")]),
    Section(
        "Slack and taut",
        """Springs that pull alone become slack and taut. `passed` counts events inside of a step; the other events
end one. Errors are against radau with a tolerance of 1e-9, over the largest motion; on catenaries tolerance and
error are in m.""",
        [Table("slack_events",
               {"scene": "scene", "integrator": "integrator", "tol": "tol", "error": "error",
                "iterations": "iterations", "evaluations": "evaluations", "factorisations": "factorisations",
                "passed": "passed"},
               table="tolerances",
               options="--scene overhead_span thrown table ropes catenary_1 catenary_3 catenary_10"),
         Table("slack_events",
               {"integrator": "integrator", "tol": "tol", "median": "median error/tol",
                "largest": "largest error/tol", "newton_iterations": "iterations", "evaluations": "evaluations",
                "factorisations": "factorisations", "passed": "passed"},
               table="random",
               options="--random 25",
               text="""Bodies on five ropes and a spring, of random mass, stiffnesses and velocities, 0.3 s each.""")]),
    Section(
        "Contact",
        """An evaluation of all forces of a cable of 1,000 elements; then pairs that are far apart.""",
        [Table("contact",
               {"1,000 elements": "1,000 elements", "touching, m": "touching, m", "forces, us": "forces, µs"},
               table="forces"),
         Table("contact",
               {"far apart": "far apart", "add, s": "adding, s", "run but steps, s": "run without steps, s",
                "forces, us": "forces, µs", "step, us more": "a step, µs more than without pairs"},
               table="far apart")]),
    Section(
        "Contact force below a catenary, cost",
        """Ten spans at 300 km/h, CPU seconds a simulated second. The error is that of σ in time, against a
tolerance of 0.001 m.""",
        [Table("pantographs",
               {"what": "setting", "sigma": "σ, N", "error of sigma %": "error of σ, %", "min": "least force, N",
                "steps": "steps", "cpu s/s": "CPU s/s"},
               table="cost",
               options="--what cost"),
         Table("pantographs",
               {"what": "pantograph", "mean": "mean, N", "sigma": "σ, N", "max": "max, N", "min": "min, N",
                "uplift": "uplift, mm", "unknowns": "unknowns", "cpu s/s": "CPU s/s"},
               table="kinds",
               options="--what kinds",
               text="""Kinds of pantographs on the reference model at 300 km/h."""),
         Table("pantographs",
               {"km/h": "km/h", "what": "pantograph and method", "sigma": "σ, N", "max": "max, N", "min": "min, N",
                "uplift": "uplift, mm", "loss %": "loss, %", "unknowns": "unknowns", "steps": "steps",
                "cpu s/s": "CPU s/s"},
               table="linear",
               options="--what linear",
               text="""`integrator="linear"`: one matrix about rest, with the droppers and the contact as they are;
the reference model, two pantographs on the 55 m line, and numbers of spans, of which the first 0.5 s.""")]),
    Section(
        "A footbridge under walkers",
        """20 elements on two supports, at resonance with the paces of walkers whom slides drive along the deck, 13.3 s.
The error is that of the deflection at mid-span, against ten modes of the beam with the moving masses.
`integrator="linear"` has one matrix for all steps, and condenses each slide onto its forces.""",
        [Table("footbridge",
               {"walkers": "walkers", "integrator": "integrator", "step, ms": "step, ms",
                "deflection, mm": "deflection, mm", "error %": "error, %", "steps": "steps",
                "factorisations": "factorisations", "iterations a step": "iterations a step", "cpu s": "CPU s"})],
        test="tests/motion/test_linear_model.py"),
    Section(
        "A state with given values",
        """`scene.equilibrium(adjust=, to=)`: lengths of droppers to heights of the contact wire, heights of
supports, loads; spans of 55 m with nine droppers and 22 elements a span in each wire. CPU time in s.""",
        [Table("adjusting",
               {"adjusted": "adjusted", "spans": "spans", "parameters": "parameters",
                "seconds, z = 0": "in the plane z = 0", "seconds, y = 0": "in the plane y = 0",
                "iterations": "iterations", "misfit": "misfit"},
               table="line"),
         Table("adjusting",
               {"adjusted": "adjusted", "size": "size", "parameters": "parameters", "seconds": "CPU s",
                "scenes": "scenes built", "iterations": "iterations", "misfit": "misfit"},
               table="wires",
               text="""The form of the 55 m line by the length of its elements in m, and ropes from post to post, by
their number.""")],
        test="tests/statics/test_adjusted_line.py"),
    Section(
        "To rest",
        """`scene.relax` from the place drawn, beside `scene.equilibrium`; CPU time in ms. `apart` is the largest
distance of both states in m. The last column is the kinetic energy, over the energy lost, without resets of
velocities.""",
        [Table("relaxation",
               {"scene": "scene", "steps": "steps", "resets": "resets", "ms": "ms",
                "equilibrium_ms": "equilibrium, ms", "apart_m": "apart, m",
                "kinetic_left": "kinetic energy without resets"}),
         Table("relaxation",
               {"scene": "scene", "unknowns": "unknowns", "iterations": "iterations", "residual_N": "residual, N",
                "ms": "ms"},
               table="at rest",
               text="""`scene.equilibrium` of small scenes.""")],
        test="tests/statics/test_relaxation.py"),
    Section(
        "Set-up",
        """CPU time in ms of a run beside its steps. Calls are those of Python and C functions, which do not depend
on the machine.""",
        [Table("setup",
               {"name": "scene", "scene": "scene made", "checks": "checks", "model": "model", "engine": "engine",
                "choice": "choice of the integrator", "start": "start", "set-up": "set-up", "calls": "calls"})],
        test="tests/parts/test_setup.py"),
    Section(
        "Sweeps",
        """Points that take no time, with results of 606 numbers each, on worker processes. Results are those of a
plain loop bit for bit.""",
        [Table("sweep",
               {"batch": "points in a batch", "CPU ms a task, here": "CPU ms a task, here",
                "ms a task and worker": "ms a task and worker", "points a second": "points a second"},
               table="empty points")],
        test="tests/sweeps/test_sweep_workers.py"),
    Section(
        "The 3D page",
        """Drawn by software, without a graphics card.""",
        [Table("page",
               {"page": "page", "stations": "stations", "frames": "frames", "MB": "MB", "written s": "written, s",
                "frames per second": "frames per second"})]),
]

SPEED = PEERS + ALONE
