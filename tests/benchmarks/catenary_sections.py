"""Catenaries of unequal spans, warm and cold, with overlaps and tilting heads, beside strings and balances of forces.

    python tests/benchmarks/catenary_sections.py [--out FILE.csv]

The spans are those of the 55 m line of pantographs.py, and two shorter ones. spans: heights of the contact wire at the
droppers beside the given ones, and the weight that the droppers bear. temperature: tensions of wires with held ends
beside two strings with springs between them, of the same stress-free lengths; with balance weights the tension at the
weights. overlaps: a passage through three spans with two contact wires; the mean force at 20 m/s beside the uplift
force less that of the lowest spring. heads: the impulse of the strips beside the momentum of all masses; one strip that
is part of its head beside a collector without one.
"""

from __future__ import annotations

import funicular as fu
import numpy as np
from funicular import catenary
from pantographs import line55
from scipy.optimize import root
from table import arguments, few, show

GRAVITY = 9.81
EXPANSION = 1.7e-5
USUAL, COARSE = (1.0, 1.0), (2.0, 2.0)


def line(spans: int = 1, bending: float = 1.0, **changes: object) -> catenary.Line:
    """Return the 55 m line with wires that expand; bending: factor of their bending stiffness."""
    wires = {name: getattr(line55(), name) for name in ("contact", "messenger")}
    wires = {name: wire.remade({"thermal_expansion": EXPANSION, "bending_stiffness": bending * wire.bending_stiffness})
             for name, wire in wires.items()}
    return line55(spans).remade(wires | changes)


def unequal(**changes: object) -> catenary.Line:
    """Return three unequal spans, each with droppers of its own."""
    first = line55().droppers
    others = [first.remade({"at": at, "sag": sag}) for at, sag in (
        ([5, 12, 20, 28, 36, 43], [0, 0.02, 0.03, 0.035, 0.02, 0]), ([4, 11, 18, 25, 32, 39, 46], 0.04))]
    return line(3, span=[55.0, 48.0, 50.0], droppers=[first, *others], **changes)


SPAN, RISE, OVERLAP = 55.0, 0.5, 3
"""Length of each span; height of the anchors over the running wire, m; spans in common."""


def overlapping(staggered: bool = False, **changes: object) -> list[catenary.Line]:
    """Return two sections of four and five spans, with three in common: six spans in all.

    From the middle of the overlap on, the contact wire of the first rises on a parabola to its anchor, and that of the
    second comes down as its mirror image. staggered: the wires are at 0.1 m on both sides of the track's middle there.
    """
    usual = line55().droppers
    x, height = np.array(usual.at), catenary.End(height=RISE)

    def rising(spans: int) -> list[catenary.Droppers]:
        """Return the droppers of a line that rises at its end."""
        middle, found = (spans - OVERLAP / 2) * SPAN, [usual] * (spans - OVERLAP)
        for k in range(spans - OVERLAP, spans):
            up = RISE * np.clip((k * SPAN + x - middle) / (OVERLAP * SPAN / 2), 0, None) ** 2
            found.append(usual.remade({"sag": -up}))
        return found

    falling = [each.remade({"sag": each.depths[::-1]}) for each in rising(5)[::-1]]
    sides = [{"stagger": each} if staggered else {} for each in (
        [0.2, 0.1, 0.1, 0.1, 0.1], [-0.1, -0.1, -0.1, -0.1, -0.2, 0.2])]
    return [line(len(droppers), span=[SPAN] * len(droppers), droppers=droppers, ends=ends, **side, **changes)
            for droppers, ends, side in ((rising(4), (catenary.End(), height), sides[0]),
                                         (falling, (height, catenary.End()), sides[1]))]


CHAIN = {"stiffness": [4200, 50], "damping": [10, 90], "uplift": 120}
COLLECTOR = catenary.Pantograph(masses=[7.2, 15], **CHAIN)
SPRUNG = catenary.Head(mass=3.0, inertia=0.3, strip_mass=1.0, strip_stiffness=4e3, strip_damping=20.0)
RIGID = catenary.Head(mass=3.0, inertia=0.3)
ONE = catenary.Head(mass=3.0, inertia=0.3, strips=[0.0], tilt_stiffness=1e3)


def with_head(head: catenary.Head) -> catenary.Pantograph:
    """Return the pantograph with a head in the place of its collector, of the same mass in all."""
    strips = 0.0 if head.strip_stiffness is None else head.strip_mass * len(head.strips)
    return catenary.Pantograph(masses=[7.2 - head.mass - strips, 15], tilting_head=head, **CHAIN)


def passage(scene: fu.Scene, pantograph: catenary.Pantograph, start: float, speed: float, **settings: object) -> fu.Run:
    """Return a run of a pantograph from a place (m) on at a speed (m/s)."""
    catenary.add_pantograph(scene, pantograph, start, speed)
    return scene.run(progress=False, **settings)


def vertical_impulse(run: fu.Run) -> tuple[float, float]:
    """Return the vertical impulse of all contacts of a run, and that by the momentum of the masses, N s."""
    names = catenary.contacts(run)
    found = np.trapezoid(sum(run[f"{name}.force"][:, 1] for name in names), run.time)
    bodies = [body for name, body in run.scene.bodies.items() if name != "pantograph_base"]
    momentum = sum(body.mass * np.diff(run[f"{body.name}.velocity"][[0, -1], 1])[0] for body in bodies)
    pulled = np.trapezoid(CHAIN["uplift"] - run["pantograph_spring_2.tension"], run.time)
    return float(found), float(pulled - momentum)


def heights_off(of: catenary.Line, rest: fu.Equilibrium) -> np.ndarray:
    """Return by how much the contact wire is above its given heights at the droppers, in m."""
    wire = rest["contact.position"]
    return np.array([wire[np.argmin(np.abs(wire[:, 0] - span.start - x)), 1] + depth for span in of.each
                     for x, depth in zip(span.droppers.at, span.droppers.depths, strict=True)])


def strings(of: catenary.Line, temperature: float) -> np.ndarray:
    """Return the tensions of contact wire and messenger of one span with held ends (2,), N; temperature in K.

    Two strings with springs between, the contact wire level at its ends: unknown are both tensions and the heights of
    the contact wire at the droppers. Stress-free lengths are those of the state at 0 K.
    """
    (span,), wires, droppers = of.each, (of.contact, of.messenger), of.droppers
    x, length = np.array(droppers.at), span.length
    ends = np.array([x[0], length - x[-1]])
    carried = np.diff(np.concatenate([[0.0], (x[1:] + x[:-1]) / 2, [length]]))
    influence = np.minimum.outer(x, x) * (length - np.maximum.outer(x, x)) / length

    def longer(points: np.ndarray, heights: np.ndarray, bend: float) -> float:
        """Return by how much parabolas of a curvature between points are longer than their projection."""
        gaps = np.diff(points)
        return float((np.diff(heights) ** 2 / gaps + bend**2 * gaps**3 / 12).sum() / 2)

    def state(tensions: np.ndarray, heights: np.ndarray, warm: float) -> tuple[np.ndarray, ...]:
        """Return forces and distances of the droppers, and the stress-free lengths of both wires at 0 K."""
        growth = [(1 + tension / wire.axial_stiffness) * (1 + EXPANSION * warm)
                  for tension, wire in zip(tensions, wires, strict=True)]
        own = [GRAVITY * wire.mass * wire.stretch / each for wire, each in zip(wires, growth, strict=True)]
        kinks = np.diff(np.concatenate([[0.0], np.diff(heights) / np.diff(x), [0.0]]))
        forces = own[0] * carried + GRAVITY * droppers.contact_clamp - tensions[0] * kinks
        upper = -(own[1] * x * (length - x) / 2 + influence @ (forces + GRAVITY * of.hanging)) / tensions[1]
        bends = own / tensions
        over = [longer(x, heights, bends[0]) + float((bends[0] ** 2 * ends**3).sum() / 6),
                longer(np.array([0.0, *x, length]), np.array([0.0, *upper, 0.0]), bends[1])]
        return forces, of.height + upper - heights, (length + np.array(over)) / growth

    reference = np.array([wire.tension for wire in wires])
    forces, distances, free = state(reference, -droppers.depths, 0.0)
    lengths = distances / (1 + forces / droppers.axial_stiffness)

    warm = lengths * droppers.growth(temperature)

    def gap(unknown: np.ndarray) -> np.ndarray:
        pulls, apart, now = state(unknown[:2] * 1e4, unknown[2:], temperature)
        return np.concatenate([1e3 * (now - free), apart - warm * (1 + pulls / droppers.axial_stiffness)])

    found = root(gap, np.concatenate([reference / 1e4, -droppers.depths]), method="lm", tol=1e-14)
    assert np.abs(found.fun).max() < 1e-8, found
    return np.asarray(found.x[:2] * 1e4)


def tensions(scene: fu.Scene) -> np.ndarray:
    """Return the tensions of contact wire and messenger at the first mast of a scene (2,), N."""
    rest = scene.equilibrium()
    return -np.array([float(rest[f"{name}@0.force"][0]) for name in ("contact", "messenger_1")])


def row(case: str, quantity: str, found: float, reference: float, scale: float | None = None) -> dict[str, object]:
    """Return a row of the table; scale: of the error, by default the reference."""
    return {"case": case, "quantity": quantity, "funicular": f"{found:.8g}", "reference": f"{reference:.8g}",
            "error": abs(found - reference) / abs(reference if scale is None else scale)}


def spans_rows() -> list[dict]:
    """Return the rows of unequal spans."""
    made = unequal()
    form = catenary.form(made, USUAL)
    rest = catenary.scene(form).equilibrium()
    own = GRAVITY * (made.contact.mass * made.length + 22 * 0.165)
    return [row("unequal spans", "largest height off, m", float(np.abs(heights_off(made, rest)).max()), 0.0, 1.0),
            row("unequal spans", "contact wire borne by droppers, N", float(form.tensions.sum()), own)]


def temperature_rows() -> list[dict]:
    """Return the rows of held ends and of balance weights."""
    held, ends = catenary.form(line(bending=0.01), (0.5, 0.5)), (catenary.End(), catenary.End(weights=True))
    weighed, rows = catenary.form(unequal(ends=ends), COARSE), []
    for temperature in few((-40.0, -20.0, 20.0, 40.0)):
        found, exact = tensions(catenary.scene(held, temperature=temperature)), strings(held.line, temperature)
        rows += [row(f"held ends, {temperature:g} K", f"tension of the {name}, N", *each)
                 for name, *each in zip(("contact wire", "messenger"), found, exact, strict=True)]
        scene = catenary.scene(weighed, temperature=temperature)
        at = [scene.cables["contact"].length]
        pulled = float(scene.equilibrium().section_forces("contact", s=at)["tension"][0])
        rows.append(row(f"weights, {temperature:g} K", "tension of the contact wire, N", pulled, 22e3))
    return rows


def overlap_rows() -> list[dict]:
    """Return the rows of a passage through an overlap."""
    forms, rows = [catenary.form(each, COARSE) for each in overlapping()], []
    for speed, (start, end) in few({20.0: (105.0, 170.0), 60.0: (80.0, 200.0)}.items()):
        run = passage(catenary.scene(forms, overlaps=OVERLAP), COLLECTOR, start, speed, duration=(end - start) / speed)
        found = catenary.assess(run, [(110.0, 165.0)])
        case = f"overlap, {speed:g} m/s"
        rows += [row(case, "impulse of both contacts, N s", *vertical_impulse(run)),
                 row(case, "losses of contact", float(found.losses[0]), 0.0, 1.0)]
        if speed == 20.0:
            spring = run["pantograph_spring_2.tension"]
            rows.append(row(case, "mean force, N", float(found.force.mean()), CHAIN["uplift"] - float(spring.mean())))
    return rows


def head_rows() -> list[dict]:
    """Return the rows of heads that tilt."""
    form = catenary.form(line(2), COARSE)

    def run_of(pantograph: catenary.Pantograph) -> fu.Run:
        return passage(catenary.scene(form), pantograph, 20.0, 50.0, duration=1.2, output_step=1e-3)

    rows = [row(f"{name}, 50 m/s", "impulse of both strips, N s", *vertical_impulse(run_of(with_head(head))))
            for name, head in few({"strips on springs": SPRUNG, "rigid strips": RIGID}.items())]
    one, usual = (run_of(each)["pantograph_contact.normal_force"] for each in (with_head(ONE), COLLECTOR))
    at = int(np.argmax(np.abs(one - usual)))
    return [*rows, row("one rigid strip, 50 m/s", "force of a collector, N", float(one[at]), float(usual[at]))]


TABLES = spans_rows, temperature_rows, overlap_rows, head_rows


def main() -> None:
    """Print the table."""
    given = arguments(__doc__)
    show([each for rows in few(TABLES) for each in rows()], given.out)


if __name__ == "__main__":
    main()
