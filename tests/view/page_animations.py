"""Animations for the tests of the page: of bundled scenes and of synthetic ones."""

from functools import cache

import numpy as np
from funicular import load_scene
from funicular.results.run import Run
from funicular.results.section_forces.forces import of_run
from funicular.view.animation import (
    Animation,
    BodyShape,
    CableShape,
    Clip,
    Curve,
    EventMark,
    Mark,
    Quantity,
    Segment,
)

PER_ELEMENT = 8


def centre_line(run: Run, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return s (P,) in m, and the positions (T, P, 3): cubic between nodes."""
    cable, vectors = run.scene.cables[name], run[f"{name}.nodal_vectors"]
    r, slope, length = vectors[..., 0, :], vectors[..., 1, :], cable.length / cable.elements
    t = np.linspace(0, 1, PER_ELEMENT, endpoint=False)[:, None]
    inner = ((1 + 2 * t) * (1 - t) ** 2 * r[:, :-1, None] + t * (1 - t) ** 2 * length * slope[:, :-1, None]
             + t**2 * (3 - 2 * t) * r[:, 1:, None] - t**2 * (1 - t) * length * slope[:, 1:, None])
    points = np.concatenate([inner.reshape(len(r), -1, 3), r[:, -1:]], axis=1)
    return np.linspace(0, cable.length, points.shape[1]), points


def cable_shape(run: Run, name: str) -> CableShape:
    cable = run.scene.cables[name]
    s, position = centre_line(run, name)
    tension = of_run(run, name, s[None], method="constitutive")["tension"]
    section = cable.section
    described = ({"shape": "rectangle", "height": section.height, "width": section.width}
                 if hasattr(section, "height") else {"shape": "unknown", "size": 2 * np.sqrt(section.area / np.pi)})
    up = np.broadcast_to(-np.array(run.scene.gravity) / np.linalg.norm(run.scene.gravity), position.shape)
    return CableShape(name, s, position, up if "height" in described else None, described, position[0],
                      (Quantity("tension", "tension", "N", tension),))


def body_shape(run: Run, name: str, size: list[float], offset: list[float]) -> BodyShape:
    speed = np.linalg.norm(run[f"{name}.velocity"], axis=-1)
    return BodyShape(name, run[f"{name}.position"], run[f"{name}.orientation"],
                     {"kind": "box", "size": size, "offset": offset}, run[f"{name}.position"][0],
                     {"speed": ("m/s", speed)})


def clip_of(run: Run, label: str, sizes: dict[str, tuple[list[float], list[float]]]) -> Clip:
    """Return the clip of a run of a bundled scene; ``sizes``: size and offset of each body's box in m."""
    cables = tuple(cable_shape(run, name) for name in run.scene.cables)
    marks = []
    for pin in run.scene.supports:
        cable = next(c for c in cables if c.name == pin.cable)
        where = int(np.argmin(np.abs(cable.s - pin.s)))
        marks.append(Mark(f"pin at s = {pin.s:g} m", "pin", cable.position[:1, where]))
    curves = [Curve(f"{name}.force", f"force of {name}", "N", ("x", "y", "z"), run.time, run[f"{name}.force"])
              for name in run.scene.slides]
    energies = tuple(name for name in ("kinetic", "elastic", "potential", "dissipated") if f"energy.{name}" in run)
    curves.append(Curve("energy", "energy", "J", energies, run.time,
                        np.stack([run[f"energy.{name}"] for name in energies], axis=-1)))
    for name, slide in run.scene.slides.items():
        marks.append(Mark(name, "slide", run[f"{slide.rider.on}.position"], f"slide of {slide.rider.on}"))
        sides = np.stack([of_run(run, slide.along, run[f"{name}.s"][:, None], side=side)["tension"][:, 0]
                          for side in ("before", "after")], axis=-1)
        curves.append(Curve(f"{slide.along}.tension@{name}", f"tension at {name}", "N", ("before", "after"), run.time,
                            sides))
    events = tuple(EventMark(float(e["time"]), str(e.get("name", e.get("kind", "event")))) for e in run.events)
    return Clip(label, run.time, cables, tuple(body_shape(run, name, *sizes[name]) for name in run.scene.bodies),
                tuple(marks), (), tuple(curves), events)


@cache
def paper51() -> Animation:
    """Example 5.1 of the paper, 51 frames."""
    run = load_scene("paper51").run(1.0, tol=1e-4, output_step=0.02)
    clip = clip_of(run, "paper51", {"A": ([0.1, 0.07, 0.07], [0.0, 0.0, 0.0])})
    return Animation("Example 5.1 of the paper", (clip,), (0.0, 1.0, 0.0), planar=False)


def twisted(frames: int = 41, stations: int = 60) -> Animation:
    """A clamped beam bent into a helix and twisted, with a spring, a lever arm and a load at its end."""
    time, s = np.linspace(0, 2, frames), np.linspace(0, 1, stations)
    turn = np.sin(np.pi * time / 4)[:, None] * s * np.pi
    bend = 0.8 * np.sin(np.pi * time / 4)[:, None] * s
    x, y = np.broadcast_to(s, turn.shape), -0.35 * bend * s
    position = np.stack([x, y, 0.25 * bend * np.sin(3 * s)], axis=-1)
    axis = np.stack([0 * turn, np.cos(turn), np.sin(turn)], axis=-1)
    cable = CableShape("beam", s, position, axis, {"shape": "rectangle", "height": 0.09, "width": 0.03}, position[0],
                       (Quantity("twist", "twist", "rad", turn),))
    end = position[:, -1]
    half = turn[:, -1] / 2
    quaternion = np.stack([np.cos(half), np.sin(half), 0 * half, 0 * half], axis=-1)
    bodies = (BodyShape("disc", end, quaternion,
                        {"kind": "cylinder", "radius": 0.09, "length": 0.03, "axis": [1, 0, 0], "offset": [0, 0, 0]},
                        end[0]),)
    ground, arm = np.array([[1.0, -0.75, 0.0]]), end + 0.2 * axis[:, -1]
    segments = (Segment("spring", "spring", ground, end), Segment("arm", "lever", end, arm),
                Segment("pull", "load", arm, arm + np.array([0.15, 0, 0])))
    marks = (Mark("clamp", "clamp", position[:1, 0], "all held"), Mark("foot", "pin", ground))
    curve = Curve("twist", "twist of the end", "rad", (), time, turn[:, -1])
    clip = Clip("twisting", time, (cable,), bodies, marks, segments, (curve,), (EventMark(1.0, "half-way"),))
    return Animation("A beam that twists", (clip,), (0.0, 1.0, 0.0), planar=False)


def modes(count: int = 3, frames: int = 24) -> Animation:
    """The modes of a taut string, each over one period; the last frame is one step before the first."""
    s = np.linspace(0, 10, 81)
    clips = []
    for k in range(1, count + 1):
        period = 0.5 / k
        time = np.arange(frames) / frames * period
        rest = np.stack([s, 0 * s, 0 * s], axis=-1)
        moved = 0.5 * np.sin(k * np.pi * s / 10) * np.cos(2 * np.pi * time / period)[:, None]
        position = rest + moved[..., None] * np.array([0.0, 1.0, 0.0])
        cable = CableShape("string", s, position, None, {"shape": "circle", "diameter": 0.05}, rest,
                           (Quantity("displacement", "displacement", "m", np.abs(moved)),))
        pins = tuple(Mark(f"pin {x:g}", "pin", np.array([[x, 0.0, 0.0]])) for x in (0.0, 10.0))
        clips.append(Clip(f"mode {k}: {1 / period:g} Hz", time, (cable,), marks=pins, periodic=True,
                          details={"frequency": f"{1 / period:g} Hz"}))
    return Animation("Modes of a string", tuple(clips), (0.0, 1.0, 0.0), planar=True, arrangement="menu")


def wave(stations: int = 2001, frames: int = 1000) -> Animation:
    """A cable with travelling waves that needs all its stations, for the speed of the picture."""
    s, time = np.linspace(0, 100, stations), np.linspace(0, 10, frames)
    phase = 2 * np.pi * (s / 1.0 - time[:, None])
    position = np.stack([np.broadcast_to(s, phase.shape), np.sin(phase), np.cos(phase)], axis=-1)
    cable = CableShape("wave", s, position, None, {"shape": "circle", "diameter": 0.2}, position[0],
                       (Quantity("height", "height", "m", position[..., 1]),))
    return Animation("Waves", (Clip("waves", time, (cable,)),), (0.0, 0.0, 1.0), planar=False)
