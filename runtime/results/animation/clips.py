"""Animations of runs, scenes, equilibria, load paths and modes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ...errors import FunicularError
from ...model.model import Model
from ...parts.modal_body import ModalBody
from ...parts.scene_data import SceneData
from ...solve.modes.modes import Modes
from ...solve.statics.rest_state import RestState, in_loads
from ...view.animation import Animation, BodyShape, CableShape, Clip, Curve, EventMark, Mark
from ..recorded import Recorded
from ..section_forces.balance_limits import out_of_balance
from . import sources
from .bodies import body_shape
from .cables import cable_shapes, modal_line, stations
from .curves import curves, events, thinned
from .frames import Frames, no_forces
from .marks import arrow_length, marks, segments
from .references import references
from .ropes import rope_shape, stations_of, wheel_shape
from .surfaces import level_shapes, surface_shape

MAX_FRAMES = 600
"""Largest number of frames of a run."""
MAX_POINTS = 2_000_000
"""Largest number of points of all cables over all frames; with more points there are fewer frames."""
PERIOD_FRAMES = 48
"""Frames of one period of a mode."""
MODE_DISPLACEMENT = 0.08
"""Largest displacement of a mode in its picture, over the size of the scene."""
MODE_ROTATION = 0.6
"""Largest rotation of a body or a sheave in the picture of a mode, rad."""
MIN_AMPLITUDE = 1e-6
"""Smallest displacement over `MODE_DISPLACEMENT`, and rotation in rad, that is reported."""
MAX_NODES = 200
"""Largest number of drawn nodes of a modal body whose nodes are on no line."""


def of_run(run: Recorded, title: str, frames: int = MAX_FRAMES, with_results: bool = True) -> Animation:
    """Return the animation of a run, of at most ``frames`` output times. Raises FunicularError without any.

    with_results: with quantities along cables and curves, or positions alone, which is faster.
    """
    if not len(run.time):
        raise FunicularError("the run has no output times to show")
    notes = list(run.report["messages"])
    points = (sum(len(stations(cable)) for cable in run.scene.cables.values())
              + sum(map(stations_of, run.scene.ropes.values())))
    chosen = thinned(len(run.time), max(2, min(frames, MAX_POINTS // max(1, points))))
    if len(chosen) < len(run.time):
        notes.append(f"{len(chosen)} of the run's {len(run.time)} output times are drawn")
    if not with_results:
        places = replace(sources.of_run(run, chosen), section_forces=no_forces)
        return _animation(run.scene, title, [_clip(places, title, notes)], notes)
    notes += [_by_law(name, "the run is large") for name, cable in run.scene.cables.items()
              if not sources.is_balanced(len(chosen), len(stations(cable)))]
    notes += _out_of_balance(run.scene, run.model, is_rest=False)
    notes += [f'tension along "{name}" is that of the elastic law, without damping'
              for name, rope in run.scene.ropes.items() if rope.material.damping_time > 0]
    clip = _clip(sources.of_run(run, chosen), title, notes)
    clip = replace(clip, curves=tuple(curves(run, notes)), events=tuple(events(run)), details=dict(run.summary_rows()))
    return _animation(run.scene, title, [clip], notes)


def _by_law(cable: str, why: str) -> str:
    """Return the note of a cable whose forces are not computed by balance."""
    return f'tension of "{cable}" is that of the elastic law, not in balance with the loads: {why}'


def _out_of_balance(scene: SceneData, model: Model, is_rest: bool) -> list[str]:
    """Return a note for each cable with loads that results do not contain."""
    found = ((name, out_of_balance(scene, model, number, is_rest)) for number, name in enumerate(scene.cables))
    return [_by_law(name, f"{error.place} {error.cause}") for name, error in found if error is not None]


def of_scene(scene: SceneData, title: str) -> Animation:
    """Return the picture of a scene as it is drawn."""
    notes = [*scene.messages]
    return _animation(scene, title, [_clip(sources.of_scene(scene), title, notes)], notes)


def of_equilibrium(state: RestState, title: str) -> Animation:
    """Return the picture of a state of rest."""
    notes = [*state.messages, *_out_of_balance(state.scene, state.model, is_rest=True)]
    clip = _clip(sources.of_states([state]), title, notes)
    return _animation(state.scene, title, [replace(clip, time=np.zeros(1), details=details(state))], notes)


def details(state: RestState) -> dict[str, str]:
    """Return the properties of a state of rest in words."""
    return {"stability": "stable" if state.stable else f"{state.unstable_directions} unstable directions",
            "load": in_loads(state.load_fraction), "residual": f"{state.residual:.2g} N"}


def of_path(state: RestState, title: str) -> Animation:
    """Return the animation of the states on the load path of one; its time is the load factor if that increases."""
    notes, states = [*state.messages, *_out_of_balance(state.scene, state.model, is_rest=True)], state.path
    if len(states) < 2:
        raise FunicularError("the equilibrium has one state on its path; find it with load_steps or "
                             'method="arc_length" for a path to see')
    load = np.array([each.load_fraction for each in states])
    rises = bool(np.all(np.diff(load) > 0))
    time = load if rises else np.arange(len(states), dtype=float)
    frames = sources.of_states(states)
    clip = _clip(frames, title, notes)
    shown = [] if rises else [Curve("load_factor", "load factor", "", (), time, load)]
    shown += [Curve(f"{cable.name}.displacement", f"{cable.name}: largest displacement", "m", (), time,
                    np.linalg.norm(cable.position - cable.reference, axis=-1).max(axis=1)) for cable in clip.cables]
    shown += [Curve(f"{cable.name}.tension", f"{cable.name}: largest tension", "N", (), time, q.values.max(axis=1))
              for cable in clip.cables for q in cable.quantities if q.key == "tension"]
    shown += [Curve(f"{body.name}.position", f"{body.name}: position", "m", ("x", "y", "z"), time, body.position)
              for body in clip.bodies]
    stable = np.array([each.stable for each in states])
    changes = np.flatnonzero(stable[1:] != stable[:-1]) + 1
    found = [EventMark(float(time[k]), "stable from here" if stable[k] else "unstable from here") for k in changes]
    clip = replace(clip, time=time, curves=tuple(shown), events=tuple(found), details=details(state))
    made = _animation(state.scene, title, [clip], notes)
    return replace(made, time_label="load factor" if rises else "state on the path", time_unit="")


def of_modes(modes: Modes, scene: SceneData, about: Mapping[str, np.ndarray], title: str) -> Animation:
    """Return one clip per mode, about a state given by name; the first frame has the largest displacement."""
    notes = [*modes.messages]
    swing = MODE_DISPLACEMENT * scene_size(sources.of_scene(scene))
    phase = 2 * np.pi * np.arange(PERIOD_FRAMES) / PERIOD_FRAMES
    clips = []
    for k in range(len(modes)):
        frequency, growth = float(modes.frequency[k]), float(modes.growth_rate[k])
        what = f"{frequency:.4g} Hz" if frequency > 0 or growth == 0 else f"grows by {growth:.4g} 1/s"
        turns = [float(np.linalg.norm(modes[f"{name}.rotation"][k])) for name in scene.bodies]
        turns += [abs(float(modes[f"{name}.angle"][k])) for name in _wheels(scene)]
        largest = min(swing, MODE_ROTATION / max([*turns, 1e-300]))
        clip = _clip(sources.of_mode(modes, k, scene, about, largest, phase), f"mode {k + 1}: {what}",
                     [] if k else notes)
        drawn = _amplitude(largest, largest * max([*turns, 0.0]))
        clips.append(replace(clip, time=phase / (2 * np.pi * frequency) if frequency > 0 else phase / (2 * np.pi),
                             segments=tuple(each for each in clip.segments if each.kind != "load"), periodic=True,
                             details={"frequency": what, "drawn with": drawn}))
    notes.append(f"modes have no size of their own: they are drawn with displacements of at most {swing:.3g} m "
                 f"and turns of at most {MODE_ROTATION:g} rad")
    return replace(_animation(scene, title, clips, notes), arrangement="menu")


def _wheels(scene: SceneData) -> list[str]:
    """Return the names of all sheaves and drums."""
    return [wheel.name for rope in scene.ropes.values() for wheel in rope.wheels]


def _amplitude(moved: float, turned: float) -> str:
    """Return the largest displacement and rotation of a mode in its picture in words, without rounding errors."""
    words = [f"{moved:.3g} m"] * (moved > MIN_AMPLITUDE * MODE_DISPLACEMENT)
    words += [f"a turn of {turned:.3g} rad"] * (turned > MIN_AMPLITUDE)
    return " and ".join(words) + " at most"


def overlaid(animations: Sequence[Animation]) -> Animation:
    """Return one animation with the clips of several, drawn together, with the axes of the first."""
    first, *others = animations
    if not others:
        return first
    names = [each.title for each in animations]
    if len(set(names)) < len(names):
        names = [f"{number}: {name}" for number, name in enumerate(names, start=1)]
    clips = tuple(replace(clip, label=name) for name, each in zip(names, animations, strict=True)
                  for clip in each.clips)
    notes = tuple(f"{name}: {note}" for name, each in zip(names, animations, strict=True) for note in each.notes)
    return replace(first, title=" and ".join(names), clips=clips, notes=notes,
                   planar=all(each.planar for each in animations))


def _animation(scene: SceneData, title: str, clips: list[Clip], notes: list[str]) -> Animation:
    x, y, z = upward(scene).tolist()
    return Animation(title, tuple(clips), (x, y, z), _is_planar(clips), notes=tuple(dict.fromkeys(notes)))


def upward(scene: SceneData) -> np.ndarray:
    """Return the unit vector (3,) against gravity, or y without gravity."""
    gravity = np.array(scene.gravity)
    return -gravity / np.linalg.norm(gravity) if gravity.any() else np.array([0.0, 1.0, 0.0])


def _is_planar(clips: list[Clip]) -> bool:
    """Return whether all centre lines and bodies stay in a plane z = const. to a thousandth of their size."""
    points = [cable.position.reshape(-1, 3) for clip in clips for cable in clip.cables]
    points += [body.position for clip in clips for body in clip.bodies]
    if not points:
        return False
    size = np.ptp(np.concatenate(points), axis=0)
    return bool(size[2] <= 1e-3 * size.max())


def scene_size(frames: Frames) -> float:
    """Return the diagonal in m of the bounding box of cables, ropes and bodies over all frames; 1 m of a single point.
    """
    return float(np.linalg.norm(_extents(frames))) or 1.0


def _extents(frames: Frames) -> np.ndarray:
    """Return the extents (3,) in m of the bounding box of cables, ropes and bodies over all frames."""
    points = _positions(frames)
    points += [frames.value(f"{name}.nodes") for name, body in frames.scene.bodies.items()
               if isinstance(body, ModalBody)]
    return np.ptp(np.concatenate([each.reshape(-1, 3) for each in points]), axis=0) if points else np.zeros(3)


def _positions(frames: Frames) -> list[np.ndarray]:
    """Return the positions (T, n, 3) of the nodes of each cable and points of each rope, (T, 3) of each body, in m."""
    return [frames.value(f"{name}.nodal_vectors")[:, :, cable.kind_of_element.nodal_vectors.index("r")]
            for name, cable in frames.scene.cables.items()
            ] + [frames.value(f"{name}.position") for name in (*frames.scene.ropes, *frames.scene.bodies)]


def _centre(frames: Frames) -> np.ndarray:
    """Return the mean position (3,) in m of cables and bodies in the first frame."""
    points = [each[0].reshape(-1, 3) for each in _positions(frames)]
    return np.asarray(np.concatenate(points).mean(axis=0)) if points else np.zeros(3)


def _clip(frames: Frames, label: str, notes: list[str]) -> Clip:
    """Return the clip of frames; notes: receives failures."""
    size, refs = scene_size(frames), references(frames)
    cables: list[CableShape] = [shape for name in frames.scene.cables for shape in cable_shapes(frames, name, notes)]
    cables += [rope_shape(frames, name) for name in frames.scene.ropes]
    bodies: list[BodyShape] = []
    points: list[Mark] = []
    for name, body in frames.scene.bodies.items():
        if not isinstance(body, ModalBody):
            bodies.append(body_shape(frames, refs, name, notes))
        elif (line := modal_line(frames, name)) is not None:
            cables.append(line)
        else:
            points += _cloud(frames, name)
    centre = _centre(frames)
    bodies += [wheel_shape(frames, refs, rope, wheel) for rope in frames.scene.ropes.values() for wheel in rope.wheels]
    bodies += [surface_shape(frames, name, centre, size) for name in frames.scene.surfaces]
    bodies += level_shapes(frames, centre, size)
    return Clip(label, frames.time, tuple(cables), tuple(bodies), (*marks(frames, refs, size), *points),
                tuple(segments(frames, refs, size, arrow_length(_extents(frames), size))))


def _cloud(frames: Frames, name: str) -> list[Mark]:
    """Return the nodes of a modal body as points."""
    nodes = frames.value(f"{name}.nodes")
    return [Mark(name, "point", nodes[:, k], f'node {k} of "{name}"') for k in thinned(nodes.shape[1], MAX_NODES)]
