"""Introduction and studies of the page Validation, whose first part are the rows of tests/validation.py."""

from __future__ import annotations

from printed import Row, Section, Table

INTRODUCTION = """A row compares a figure of funicular with a closed form, a published number, another code or a
converged solution of another method. Its test asserts the bound each time the tests run, and wrote what stands under
`ours`. Errors are over the reference, or over a scale that the test names where a reference may be zero. A row shows
the largest error of all elements, laws and integrators that it lists under `with`. The record has each by itself
([measured/validation.json](measured/validation.json)). Studies follow: errors over many scenes and meshes.
[Speed](speed.md) has the cost."""


SUBJECTS = ("Elements", "Limits of elements", "Statics", "Modes", "Section forces", "Slides", "Bodies and mechanisms",
            "Ropes with memory", "Contact", "Fluid", "Catenaries", "Machines", "Linear models")
"""What `subject` of a row may be, in the order of the page. Limits: errors that an element keeps on any mesh."""


def under_a_rider(rows: list[Row]) -> list[Row]:
    """Return rows of 24 elements with the rider at 0.3 of one."""
    return [row for row in rows if row["elements"] == 24 and row["rider at"] not in ("node", "middle")]


FORCES = {"mean": "mean, N", "sigma": "σ, N", "max": "max, N", "min": "min, N", "uplift": "uplift, mm"}

def closest(rows: list[Row]) -> list[Row]:
    """Return for each case and integrator the figure closest to its upper bound."""
    found: dict[tuple[str, str], Row] = {}
    for row in rows:
        if isinstance(row["bound"], int | float) and row["bound"] > 0 and row["value"] is not None:
            before = found.setdefault((row["case"], row["integrator"]), row)
            if row["value"] / row["bound"] > before["value"] / before["bound"]:
                found[row["case"], row["integrator"]] = row
    return list(found.values())


STUDIES = [
    Section(
        "Error against tol",
        """`integrator="auto"` on 36 scenes: tops, flexible links, taut cables, buckling, friction, end stops.
References are by the explicit method at 1e-10. The largest errors belong to friction under a normal force that
vibrates about zero, and to friction that stops. `"genalpha"` by itself controls positions alone: with fast
rotations, friction or prescribed motions its error can be 10 to 100 `tol`, and a note says so. The second table has the
CPU time of `"auto"` over that of the cheapest integrator that keeps `tol`.""",
        [Table("choice",
               {"tol": "tol", "runs": "runs", "within tol": "within tol", "median error/tol": "median error/tol",
                "largest error/tol": "largest error/tol", "of": "of"},
               table="by tolerance", options="--every --repetitions 3"),
         Table("choice",
               {"tol": "tol", "median": "median", "above 1.2": "above 1.2", "above 1.5": "above 1.5", "of": "of",
                "largest": "largest", "scene": "scene"},
               table="cost over the best", options="--every --repetitions 3")],
        test="tests/motion/test_tolerance.py"),
    Section(
        "Notes on errors",
        """Random scenes that an engineer could draw, each at `tol` 1e-3 and 1e-4. `noted` runs carry a note that
their error may be large; `silent` ones do not. The silent runs beyond 3 `tol` have ropes that snap taut near the end
of the run.""",
        [Table("notes",
               {"error": "error", "runs": "runs", "noted": "noted", "silent": "silent"},
               table="counts",
               options="--scenes 300")],
        test="tests/motion/test_notes_are_true.py"),
    Section(
        "Order of convergence",
        """The slide's arc-length s and the body's y of the first scene, root mean square of their errors as the
step of generalised-alpha is halved. Starting from zero accelerations instead of eq 38 loses one order.""",
        [Table("order",
               {"start": "start", "step": "step, s", "s_rms_m": "s, m", "s_ratio": "ratio", "y_rms_m": "y, m",
                "y_ratio": "ratio"})],
        test="tests/parts/test_first_scene.py"),
    Section(
        "Model for a tolerance",
        """`scene.choose(tol, free="all")`: true error of the chosen model over `tol`, against the converged motion
of the finest model at hand. `kept`: whether the choice says that the model keeps `tol`. `resolved`: distance of the
reference from its own limit, over `tol`; beyond 1 the error says nothing. `cost`: CPU time over that of the cheapest
model by brute force. `choice`: CPU time of the choice over that of the run.""",
        [Table("model_choice",
               {"scene": "scene", "tol": "tol", "error/tol": "error/tol", "kept": "kept", "resolved": "resolved",
                "ratio": "cost", "choice": "choice", "model": "chosen"},
               options="--brute-force cached"),
         Table("model_choice",
               {"scene": "scene", "s": "duration, s", "tol": "tol", "error/tol": "error/tol", "choice": "choice",
                "run ms": "run, ms", "chosen": "chosen"},
               table="full length",
               options="--full-length",
               text="""Bundled scenes over the durations of their files."""),
         Table("model_shocks",
               {"scene": "scene", "tol": "tol", "error/tol": "error/tol", "kept": "kept", "chosen": "chosen"},
               text="""Riders near the wave speed, impacts, contact, one-sided springs, friction, water; the error
is against three times the elements and a hundredth of the tolerance of time.""")],
        test="tests/sweeps/test_choice.py"),
    Section(
        "Elements of unequal lengths",
        """`scene.choose(tol, unequal=True)` beside equal elements, both against the mesh for the tightest tolerance
with every element halved. A taut cable bends beside clamps and point forces over √(EI/N), here 0.03 of its length.""",
        [Table("unequal",
               {"scene": "scene", "tol": "tol", "elements_equal": "equal elements", "error_equal": "error",
                "cpu_s_equal": "CPU s", "elements_unequal": "unequal elements (u)", "error_unequal": "error",
                "cpu_s_unequal": "CPU s"})],
        test="tests/sweeps/test_unequal_choice.py"),
    Section(
        "Example 5.2 of the paper",
        """A link below the cable with a ball at its end: rigid, modal, or of absolute nodal coordinates; its ball
in mm from that of the rigid link. The three agree while the link bends little.

![The ball's acceleration with three kinds of link, as soft as in the print and 100 times as stiff](paper52.png)""",
        [Table("paper52",
               {"link": "link", "mm off rigid, 0.5 s": "0.5 s", "mm off rigid, 1.0 s": "1.0 s",
                "mm off rigid, 1.5 s": "1.5 s", "error": "error in time", "CPU s": "CPU s"},
               options="--plots .")],
        test="tests/motion/test_paper52.py"),
    Section(
        "Ropes over sheaves",
        """Runs beside closed forms, ordinary differential equations of ropes without mass, and chains of masses that
touch a groove. Errors over the reference, of places, angles and lengths in their unit; `bar` is what the tests assert.
Cases "no mass" are those of ropes without mass.""",
        [Table("sheaves",
               {"case": "case", "quantity": "quantity", "run": "run", "reference": "reference", "error": "error",
                "bar": "bar", "CPU s": "CPU s"}),
         Table("sheaves",
               {"series": "series", "number": "number", "error": "error", "order": "order"},
               table="refinements",
               text="""The load of a heavy rope by elements a span, the tension that a held cylinder bears by zones,
the same load by steps."""),
         Table("sheaves",
               {"case": "case", "quantity": "quantity", "without": "without", "with": "with", "share": "share"},
               table="left out",
               text="What the references leave out: the bending of the belt, the wraps of the elevator.")],
        test="tests/motion/test_rope_cases.py"),
    Section(
        "Planar and spatial",
        """Planar elements give the results of spatial ones where their kinematics are equal.

![Height of the rider by four elements; distance between planar and spatial ones](planar.png)""",
        [Table("planar",
               {"planar": "planar", "spatial": "spatial", "law": "law", "ν": "ν", "x, y / m": "x, y, m",
                "s / m": "s, m", "force / N": "force, N", "why": "why"},
               options="--plot planar.png")],
        test="tests/parts/test_planar_scene.py"),
    Section(
        "Crossing a node",
        """Jump of a rider's acceleration at the nodes of a cable of 2 MPa under 5 kg: r'' of cubic elements jumps,
that of quintic ones does not.

![Acceleration of a rider over its position, and its change in a step](crossing.png)""",
        [Table("crossing",
               {"element": "element", "step / s": "step, s", "crossings": "crossings",
                "median jump / (m/s²)": "median jump, m/s²", "largest": "largest"},
               options="--plot crossing.png")]),
    Section(
        "Tension beside a point force",
        """Taut rope of 24 elements with 84 kg at rest at 0.3 of an element, by `membrane`: errors of the tension by
the elastic law on three elements, of positions in m, of the pin's force. Cable elements are too stiff along
themselves where their slope changes. Positions are of the first order with all three, as no polynomial has the kink.
`"reduced"` is for taut ropes at small strain: it is stable only below 1 % of compression, and axial waves need four
times the elements.""",
        [Table("taut_rope",
               {"element": "element", "membrane": "membrane", "tension": "tension", "at nodes": "at nodes",
                "position": "position, m", "rider": "rider, m", "force": "force"},
               table="rest",
               rows=under_a_rider)],
        test="tests/kernels/test_membrane.py"),
    Section(
        "Mooring line by mesh",
        """Errors in m and N against the elastic catenary, of end, touch-down and tension at the anchor. The
constant part is the bending of the line, √(EI/H) = 72 mm, which the catenary leaves out. The rope over a drum holds
and slides at parts of the capstan's limit.""",
        [Table("contact",
               {"elements": "elements", "friction": "friction", "stiffness": "stiffness, N/m²", "end": "end, m",
                "touch-down": "touch-down, m", "tension": "tension, N", "penetration": "penetration, m"},
               table="mooring"),
         Table("contact",
               {"case": "case", "friction": "friction", "holds": "holds", "slides": "slides"},
               table="drum")],
        test="tests/contact/test_contact.py"),
    Section(
        "Friction by springs",
        """Error over `tol`, with the steps at 1e-6; references by explicit steps at 1e-10.""",
        [Table("friction_springs",
               {"scene": "scene", "integrator": "integrator", "tol 1e-03": "1e-3", "tol 1e-04": "1e-4",
                "tol 1e-05": "1e-5", "tol 1e-06": "1e-6", "steps": "steps"},
               table="tolerances")],
        test="tests/contact/test_friction_springs.py"),
    Section(
        "Slack lines by mesh",
        """`scene.equilibrium` of lines drawn straight. References: another program for the lazy-wave cables, the
elastic catenary without bending for ropes and wire.""",
        [Table("slack_lines",
               {"line": "line", "elements": "elements", "force, N": "force, N", "off": "error",
                "curvature, 1/m": "curvature, 1/m", "off ": "error", "CPU, ms": "CPU ms"})],
        test="tests/statics/test_slack_lines.py"),
    Section(
        "Contact force below a catenary",
        """The reference model of EN 50318:2002 (withdrawn), forces below 20 Hz in two spans in the middle. The
standard prints neither the lengths of the droppers nor the uplift force: 120 N act on the frame, so that **the mean
is set, and not validated**. Sag (5 mm) and damping (0.005 at 20 Hz, in proportion to mass) are chosen to meet the
ranges; axial stiffnesses are assumed. No conformity to any standard is claimed, and the edition of 2018 has another
model.""",
        [Table("pantographs",
               {"km/h": "km/h", "what": "by", "mean": "mean, N", "sigma": "σ, N", "mean+3s": "mean + 3 σ",
                "mean-3s": "mean - 3 σ", "max": "max, N", "min": "min, N", "uplift": "uplift, mm",
                "loss %": "loss, %"},
               table="reference",
               options="--what reference"),
         Table("pantographs",
               {"km/h": "km/h", "what": "data", "sigma": "σ, N", "mean+3s": "mean + 3 σ", "min": "min, N",
                "uplift": "uplift, mm"},
               table="data",
               options="--what data",
               text="""Unknown data, changed one at a time from a level wire with the damping ratio 0.005 at 10 Hz."""),
         Table("pantographs",
               {"km/h": "km/h", "what": "pantograph", "mean": "mean, N", "sigma": "σ, N", "max": "max, N",
                "min": "min, N", "uplift": "uplift, mm", "loss %": "loss, %"},
               table="line55",
               options="--what line55",
               text="""The 55 m line with a pantograph of three masses, spans 7 and 8 of 12, and two of them 200 m
apart. There is no reference; meshes of 1 m and 0.5 m are compared."""),
         Table("catenary_sections",
               {"case": "case", "quantity": "quantity", "funicular": "ours", "reference": "reference",
                "error": "error"},
               text="""Unequal spans; wires with held ends beside two strings with springs between, and with balance
weights; the impulse of all contacts in an overlap of two sections, and of two strips, beside the momentum of the
pantograph.""")],
        test="tests/statics/test_catenary.py"),
    Section(
        "Hard cases",
        """Nodes crossed at 0.1 and 100 m/s, riders of 1e-9 to 1e4 times the cable's mass, steel beside rubber,
buckling, a whip, 10 km from the origin, steps a hundred times too large, chatter, free play. A cell has
the figure closest to its bound, its value and the bound: errors over the largest motion, balances over
the energy exchanged, residuals in m, counts of steps. A run that fails says when, where and why.""",
        [Table("hard",
               {"case": "case"},
               by=("integrator", "{figure} {value} of {bound}"),
               rows=closest)],
        test="tests/motion/test_hard_cases.py"),
]
