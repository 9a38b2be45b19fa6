"""`Scene.equilibrium`, `Scene.modes` and starts from an equilibrium, with mocks of the solvers."""

import sys
from types import ModuleType, SimpleNamespace

import pytest
from expectations import refused
from fake_recording import fake_recording
from funicular import EquilibriumError, Scene, load_scene
from funicular.results import recording
from funicular.results.equilibrium import Equilibrium
from funicular.results.modes import Modes


class State(Equilibrium):
    """A state without a solution behind it."""

    def __init__(self):
        pass

    def check_fits(self, scene, any_mesh=False):
        pass

    def check_stable(self):
        pass


@pytest.fixture
def solvers(monkeypatch):
    """Return mocks of the modules of funicular.solve, with their recorded calls."""
    calls = SimpleNamespace(static=[], modal=[], model=[])
    static, modal, model = (ModuleType(f"funicular.solve.{name}")
                            for name in ("statics.static", "modes.modes", "motion.run"))

    def equilibrium(scene, settings, start, made):
        calls.static.append(settings)
        return State()

    def modes(scene, n, about, as_drawn, stick):
        calls.modal.append((n, about, as_drawn))
        assert not stick
        return "modes"

    def simulate(scene, settings, on_progress, **start):
        calls.model.append((settings.initial, start))
        yield 0  # the end of a stage
        return fake_recording(scene)

    static.equilibrium, modal.modes, model.simulate = equilibrium, modes, simulate
    for module in (static, modal, model):
        monkeypatch.setitem(sys.modules, module.__name__, module)
    monkeypatch.setattr(recording, "recorded", lambda recorded, *_: recorded)
    monkeypatch.setattr(Modes, "of", lambda found, *_: found)
    return calls


def test_settings_and_defaults_reach_the_solver(solvers):
    scene = load_scene("paper51")
    scene.equilibrium()
    scene.equilibrium_settings = {"load_steps": 7, "tolerance": 1e-6}
    scene.equilibrium(tolerance=1e-8, method="arc_length")
    others = {"largest_step": 0.1, "seek_stable": True, "scale_gravity": True, "impending": None, "wraps": "slip",
              "adjust": None, "to": None}
    assert [settings.model_dump() for settings in solvers.static] == [
        {"load_steps": 1, "tolerance": 1e-9, "max_iterations": 50, "method": "newton", **others},
        {"load_steps": 7, "tolerance": 1e-8, "max_iterations": 50, "method": "arc_length", **others}]


def test_a_run_starts_as_drawn_or_from_an_equilibrium(solvers):
    scene = load_scene("paper51")
    scene.run()
    state = scene.equilibrium()
    scene.run(initial=state)
    scene.run_settings["initial"] = "equilibrium"
    scene.run()
    scene.run(initial="drawn")
    initial = [name for name, _ in solvers.model]
    assert initial == ["drawn", "equilibrium", "equilibrium", "drawn"]
    assert [start["initial"] is None for _, start in solvers.model] == [True, False, False, True]
    assert solvers.model[1][1]["initial"] is state
    assert len(solvers.static) == 2


def test_a_motion_may_start_off_its_place_in_an_equilibrium(solvers):
    scene = load_scene("paper51")
    scene.motion("wire", s=0.5, displacement=(0, 0.1, 0))
    scene.run(initial="equilibrium")
    assert len(solvers.model) == 1


def test_modes(solvers):
    scene = load_scene("paper51")
    state = scene.equilibrium()
    assert scene.modes(3) == scene.modes(4, about=state) == scene.modes(5, as_drawn=True) == "modes"
    assert solvers.modal == [(3, None, False), (4, state, False), (5, None, True)]


@pytest.mark.parametrize(("call", "complaint"), [
    (lambda s: s.equilibrium(load_steps=0), "equilibrium: load_steps must be a whole number, 1 or more, got 0"),
    (lambda s: s.equilibrium(tolerance=1), "equilibrium: tolerance must lie inside (0, 1), got 1"),
    (lambda s: s.equilibrium(max_iterations=2.5),
     "equilibrium: max_iterations must be a whole number, 1 or more, got 2.5"),
    (lambda s: s.equilibrium(method="arclength"),
     'equilibrium: method "arclength" is not known; did you mean "arc_length"?'),
    (lambda s: s.modes(0), "modes: n must be a whole number, 1 or more, got 0"),
    (lambda s: s.modes(1, about=3), "scene: the state to start from must be one that equilibrium() returned, got 3"),
    (lambda s: s.run(initial=3), "scene: the state to start from must be one that equilibrium() returned, got 3"),
    (lambda s: s.run(initial="rest"), 'run: initial "rest" is not known; known: drawn, equilibrium, relaxed, state'),
])
def test_refused(solvers, call, complaint):
    with refused(complaint):
        call(load_scene("paper51"))
    assert solvers.model == solvers.static == solvers.modal == []


def test_an_empty_scene(solvers):
    for call in (Scene().equilibrium, lambda: Scene().modes(1)):
        with refused("scene: is empty: there is nothing to simulate; add a cable or a rigid body"):
            call()


def test_the_error_keeps_what_was_reached():
    error = EquilibriumError("no equilibrium beyond 0.4 of the loads", "state", 0.4)
    assert (str(error), error.state, error.load_fraction) == ("no equilibrium beyond 0.4 of the loads", "state", 0.4)
