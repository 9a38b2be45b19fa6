"""Notes on output rows include all rows, also those on disk of a streamed run: struts, strains, springs."""

import importlib
import json
import pkgutil

import numpy as np
import pytest
from funicular import (
    Circle,
    ConvergenceError,
    FunicularWarning,
    Material,
    Pulse,
    Ramp,
    Rectangle,
    Scene,
    SceneError,
    TableSignal,
)
from funicular.model.build import build
from funicular.solve import notes
from funicular.solve.motion import row_stream
from funicular.solve.notes.note import Note
from funicular.solve.notes.row_notes import NOTES, RowNotes
from shared_scenes import cable_scene

RADIUS, MODULUS = 1e-3, 1e8
EULER = np.pi**2 * MODULUS * np.pi / 4 * RADIUS**4


def strut() -> Scene:
    """Return a straight strut of 1 m, compressed beyond Euler's load for the first half of the run alone."""
    scene = cable_scene("strut", pins=(0,), gravity=(0, 0, 0), elements=4, element="cable8p",
                        section=Circle(radius=RADIUS),
                        material=Material(youngs_modulus=MODULUS, poisson_ratio=0, density=1000, damping_time=1e-3))
    scene.pin("strut", s=1.0)
    scene.force("strut", s=0.5, value=(-40 * EULER, 0, 0), scale=Pulse(start=0, end=0.02))
    return scene


def squeezed() -> Scene:
    """Return a cable with a reduced strain, compressed by a tenth for the first half of the run alone."""
    scene = cable_scene(pins=(0,), gravity=(0, 0, 0), elements=4, element="cable8p", membrane="reduced",
                        section=Rectangle(height=0.05, width=0.05),
                        material=Material(youngs_modulus=1e6, poisson_ratio=0, density=1000, damping_time=1e-2))
    scene.motion("wire", s=1.0, displacement=(Pulse(start=0, end=0.02, height=-0.1), 0, 0))
    return scene


def met(length=0.5, stays=False) -> Scene:
    """Return a body that is drawn through the other end of its spring, or placed there."""
    scene = Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(-1, 0, 0))
    signal = Ramp(start=0, end=0.02) if stays else TableSignal(time=(0, 0.02, 0.04), value=(0, 1, 1.5))
    scene.joint("prismatic", (0, 0, 0), ("A", (1, 0, 0)), axis=(1, 0, 0), distance=signal)
    scene.spring("A", (0, 0, 0), stiffness=10.0, length=length, name="coil")
    return scene


SCENES = {"perfectly straight": strut, "was compressed by": squeezed, 'spring "coil": at t': met}
SETTINGS = {"duration": 0.04, "output_step": 1e-3, "tol": 1e-3, "integrator": "radau", "progress": False}


def noted(run, said: str) -> list[str]:
    return [message for message in run.report["messages"] if said in message]


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("said", SCENES)
def test_rows_on_disk_are_noted_too(said, tmp_path, monkeypatch):
    """The last rows of a streamed run have no compression any more."""
    whole = SCENES[said]().run(**SETTINGS)
    monkeypatch.setattr(row_stream, "MAX_BUFFERED_BYTES", 1.0)
    streamed = SCENES[said]().run(**SETTINGS, save=tmp_path / "run.nc")
    assert len(noted(whole, said)) == 1
    assert noted(streamed, said) == noted(whole, said)


class Recorded:
    """Simulates an engine with recorded rows of a scene without contact."""

    def __init__(self, rows: dict[str, np.ndarray]):
        self._rows = rows

    def rows(self) -> dict[str, np.ndarray]:
        return self._rows

    def deepest(self, kind: str) -> np.ndarray:
        return np.zeros(0)

    def farthest(self, kind: str) -> np.ndarray:
        return np.zeros(0)


@pytest.mark.parametrize("said", SCENES)
def test_a_checkpoint_holds_what_was_found(said):
    """Rows one by one, each time as in a resumed run."""
    scene = SCENES[said]()
    model = build(scene)
    q = np.repeat(model.q[None], 5, axis=0)
    if said == "perfectly straight":
        q[1:3, model.cables[0].coordinates].reshape(2, *model.cables[0].shape)[:, 2, 0, 0] -= 0.02
    elif said == "was compressed by":
        q[1, model.cables[0].coordinates].reshape(model.cables[0].shape)[2, 0, 0] -= 0.02
    else:
        q[2, model.bodies[0].configuration] = 0.0
    rows = {"time": np.arange(5.0), "q": q, "v": np.tile(model.v, (5, 1)), "s": np.zeros((5, 0))}
    at_once, found = RowNotes(scene, model), {}
    at_once.see(Recorded(rows))
    for k in range(5):
        resumed = RowNotes(scene, model)
        if found:
            resumed.go_on(json.loads(json.dumps(found)))
        resumed.see(Recorded({name: values[k : k + 1] for name, values in rows.items()}))
        found = resumed.found
    assert len([note for note in at_once.notes() if said in note]) == 1
    assert resumed.notes() == at_once.notes()


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
def test_a_body_that_turns_by_radians_within_a_fixed_step_is_noted():
    """Its axes have no defined error in such steps."""
    def turning(rate: float, **step):
        scene = Scene(gravity=(0, 0, 0))
        scene.rigid_body("A", mass=1.0, inertia=(1, 2, 3), position=(0, 0, 0), angular_velocity=(0, rate, 0.1))
        return scene.run(0.1, output_step=0.01, progress=False, **step).report["messages"]

    assert turning(1000.0, step=0.01)[-1].startswith('body "A" turns by 10')
    assert turning(10.0, step=0.01) == turning(1000.0) == []


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("rate", [10.0, 100.0])
def test_the_steps_of_energy_see_how_fast_a_body_turns(rate):
    """By translation alone, 17 steps gave axes 149 degrees off after 1 s at 100 rad/s."""
    scene = Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("A", mass=1.0, inertia=(2, 2, 2), position=(0, 0, 0), angular_velocity=(0, rate, 0))
    run = scene.run(1.0, tol=1e-4, output_step=0.1, integrator="energy", progress=False)
    turned = 2 * np.arctan2(run["A.orientation"][-1, 2], run["A.orientation"][-1, 0])
    assert abs((turned - rate + np.pi) % (2 * np.pi) - np.pi) < 1e-4 * 9.81 / 2  # of the way that it falls, at 1 m
    assert noted(run, "errors may be") == []


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
def test_a_spring_of_no_length_has_no_direction_to_lose():
    assert noted(met(length=0.0).run(**SETTINGS), "direction is lost") == []


def test_a_body_that_is_put_on_the_end_of_its_spring_is_noted():
    """Rounding decides the direction of the 5 N of its spring."""
    said = (r'spring "coil": at t = 0.02 s both ends are at \(0, 0, 0\) m: its direction is lost; keep them apart, '
            "or take length=0 where they may coincide")
    with pytest.warns(FunicularWarning, match=said):
        met(stays=True).run(**SETTINGS)


def test_a_spring_of_no_length_may_start_with_its_points_at_one_place():
    """A zero length needs no direction; a spring whose length follows from there is refused."""
    scene = Scene(gravity=(0, -10, 0))
    scene.rigid_body("A", mass=2.0, inertia=(1, 1, 1), position=(0, 0, 0))
    with pytest.raises(SceneError, match="its direction is lost"):
        scene.spring((0, 0, 0), "A", stiffness=50.0)
    scene.spring((0, 0, 0), "A", stiffness=50.0, length=0.0)
    np.testing.assert_allclose(scene.equilibrium()["A.position"], [0, -0.4, 0], atol=1e-12)
    time = np.pi / 5  # a period and a quarter of sqrt(50/2) rad/s, less a quarter
    np.testing.assert_allclose(scene.run(time, progress=False, tol=1e-6)["A.position"][-1, 1], -0.8, rtol=1e-5)


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit"])
@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
def test_a_distance_that_is_driven_to_nothing_is_named(integrator):
    """The message names the distance and no masses."""
    scene = Scene()
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(0, -1, 0))
    scene.joint("distance", (0, 0, 0), "A", name="winch",
                distance=TableSignal(time=(0, 1, 2), value=(1, 0, -1), interpolation="linear"))
    with pytest.raises(ConvergenceError, match=r'^joint "winch": at t = 1 s both ends are at .* its direction is '
                                               'lost; keep them apart, or take kind="spherical"'):
        scene.run(2.0, output_step=0.1, integrator=integrator, progress=False)


def test_notes_are_those_of_the_parts_of_a_model():
    """Each note names what it measures; a scene without that has no such note."""
    scene = Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(0, 0, 0))
    assert {*RowNotes(scene, build(scene)).found["notes"]} == {"FastTurns"}
    assert all(note.measures for note in NOTES)


def test_the_list_of_notes_is_complete():
    """A note that is not in `row_notes.NOTES` would measure nothing."""
    for module in pkgutil.iter_modules(notes.__path__, f"{notes.__name__}."):
        importlib.import_module(module.name)
    assert set(NOTES) == set(Note.__subclasses__()), "add the new note to NOTES of runtime/solve/notes/row_notes.py"
