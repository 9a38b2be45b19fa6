"""Ctrl-C at any instant gives a run or KeyboardInterrupt, whole files, and no lock or partial change."""

import contextlib
import gc
import os
import random
import signal
import sys
import threading
from collections import Counter
from functools import partial
from itertools import count
from types import FrameType

import funicular as fu
import numpy as np
import pytest
from difficult_scenes import tied
from funicular import engine as engine_module
from funicular.base import interruptions
from funicular.base.interruptions import check_interrupted, interruptible, uninterrupted, was_interrupted
from funicular.results import recording
from funicular.results.locks import lock
from funicular.results.recording import recorded
from funicular.solve.linear.threads import one_blas_thread
from funicular.solve.motion import run as solve_run
from interrupted_runs import content, short
from viewed_scenes import spatial

PACKAGE = os.path.dirname(fu.__file__)

SETTINGS = {"duration": 0.1, "output_step": 0.005, "tol": 1e-3, "progress": False}


class Instants:
    """Counts the instants of an action, lines of the package and instructions of the interrupt handler, and sends
    SIGINT at one of them.
    """

    def __init__(self, at: int = 0):
        self.at, self.passed = at, 0

    def __enter__(self):
        self._before = sys.gettrace()
        sys.settrace(self._of_frame)
        return self

    def __exit__(self, *exception: object) -> None:
        sys.settrace(self._before)

    def _of_frame(self, frame: FrameType, event: str, argument: object):
        file = frame.f_code.co_filename
        if not file.startswith((PACKAGE, contextlib.__file__)):
            return None
        frame.f_trace_opcodes = file == interruptions.__file__
        return self._within

    def _within(self, frame: FrameType, event: str, argument: object):
        self.passed += event in ("line", "opcode")
        if self.passed == self.at and event in ("line", "opcode"):
            signal.raise_signal(signal.SIGINT)
        return self._within


def spring_on_cable() -> fu.Scene:
    scene = short()
    scene.spring("A", (0.2, -1, 0), stiffness=10.0, name="guy")
    return scene


def estimated(folder):
    return spring_on_cable().run(**SETTINGS, estimate=True)


def saved(folder, **settings):
    return spring_on_cable().run(**SETTINGS, save=folder / "x.nc", **settings)


def resumed(folder):
    with contextlib.suppress(fu.ResultFileError):  # there is nothing to resume
        return saved(folder, resume=True)
    return saved(folder)


def written(folder):
    scene = spring_on_cable()
    run = scene.run(**SETTINGS)
    run.save(folder / "copy.nc")
    run.save_html(folder / "page.html")
    fu.Scene.from_toml(scene.to_toml())
    return run


def swept(folder):
    fu.sweep(short(), {"A.mass": [1.0, 2.0, 3.0]}, keep=["A.position"], save=folder / "sweep.nc", workers=0,
             **SETTINGS)


ACTIONS = {"estimate": estimated, "save": saved, "save and estimate": partial(saved, estimate=True),
           "at rest": partial(saved, initial="equilibrium"), "resume": resumed, "written": written, "sweep": swept}


def check_left(folder, outcome) -> str:
    """Check the state after an interruption; return a word for it."""
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    assert interruptions._Now.depth == 0 and not interruptions._Now.is_noted
    assert one_blas_thread._inside == 0
    for name in os.listdir(folder):
        assert name in ("x.nc", "x.nc.state", "copy.nc", "page.html", "sweep.nc"), name
        descriptor = os.open(folder / name, os.O_RDWR)
        lock(descriptor)  # or Taken
        os.close(descriptor)
        if name in ("x.nc", "copy.nc"):
            assert fu.load_run(folder / name).status in ("completed", "interrupted", "unfinished")
    if isinstance(outcome, KeyboardInterrupt):
        return "KeyboardInterrupt"
    if outcome is None:
        return "sweep"
    assert outcome.status in ("completed", "interrupted")
    assert len(outcome.time) == len(outcome["A.position"]) > 0
    if (folder / "x.nc").exists():
        assert content(folder / "x.nc") == {name: outcome[name].tobytes() for name in ["time", *outcome.keys()]}
    return outcome.status


def trials(action, folder, count: int, seed: int) -> Counter:
    """Interrupt an action at random instants; return the number of each outcome."""
    for name in ("first", "whole"):  # the first time brings modules
        (folder / name).mkdir()
        with Instants() as instants:
            action(folder / name)
    found, random_ones = Counter(), random.Random(seed)
    gc.disable()  # what is left open must not be closed by chance
    try:
        for k in range(count):
            here, outcome = folder / str(k), None
            here.mkdir()
            try:
                with Instants(random_ones.randrange(1, instants.passed)):
                    outcome = action(here)
                found[check_left(here, outcome)] += 1
            except KeyboardInterrupt as error:  # whose traceback keeps what was open then
                found[check_left(here, error)] += 1
            if outcome is not None and outcome.status == "interrupted" and (here / "x.nc").exists():
                check_goes_on(action, here, folder / "whole")
    finally:
        gc.enable()
    return found


def check_goes_on(action, folder, whole) -> None:
    """Check that an interrupted run continues to the same numbers."""
    settings = {} if action is resumed else {"resume": True}
    assert action(folder, **settings).status == "completed"
    assert content(folder / "x.nc") == content(whole / "x.nc")
    assert sorted(os.listdir(folder)) == ["x.nc"]


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("name", ACTIONS)
def test_ctrl_c_at_random_instants(name, tmp_path):
    assert trials(ACTIONS[name], tmp_path, 6, seed=28).total() == 6


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("name", ACTIONS)
def test_ctrl_c_at_500_random_instants(name, tmp_path):
    found = trials(ACTIONS[name], tmp_path, 72, seed=5)
    print(name, dict(found))
    assert found.total() == 72 and found["KeyboardInterrupt"] and len(found) > 1


# ---- saved data


def interrupting(left: int):
    """Return a progress function that interrupts at its n-th call."""
    calls = count(1)

    def progress(_: float) -> None:
        if next(calls) == left:
            raise KeyboardInterrupt

    return progress


SCENES = {"in space": spatial, "tied": tied, "spring on cable": spring_on_cable,
          **{name: partial(fu.load_scene, name) for name in ("paper51", "cable_car")}}


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("name", SCENES)
def test_a_saved_run_may_end_at_its_first_row(name, tmp_path):
    """The file has the first row, and the engine none."""
    run = SCENES[name]().run(100.0, output_step=100.0, tol=1e-9, integrator="explicit", progress=interrupting(1),
                             save=tmp_path / "x.nc")
    assert run.status == "interrupted" and len(run.time) == 1
    assert {len(run[name]) for name in run if run.variables[name].dims[:1] == ("time",)} == {1}
    assert sorted(os.listdir(tmp_path)) == ["x.nc", "x.nc.state"]


def test_the_run_stays_where_its_estimate_is_interrupted(tmp_path, monkeypatch):
    whole, real = short().run(**SETTINGS), engine_module.Engine.advance
    runs = count(1)

    def second_is_interrupted(engine, on_progress, *given, **settings):
        if next(runs) == 2:
            signal.raise_signal(signal.SIGINT)
        return real(engine, on_progress, *given, **settings)

    class Interrupted(engine_module.Engine):
        advance = second_is_interrupted

    monkeypatch.setattr(solve_run, "Engine", Interrupted)
    with pytest.warns(fu.FunicularWarning, match="errors are not estimated: that was interrupted"):
        run = short().run(**SETTINGS, estimate=True, save=tmp_path / "x.nc")
    assert run.status == "completed" and "errors" not in run.report
    assert np.array_equal(run["A.position"], whole["A.position"])
    assert fu.load_run(tmp_path / "x.nc").report["messages"][-1].endswith("that was interrupted")


def test_a_finished_run_is_not_lost(monkeypatch):
    def late(*given):
        signal.raise_signal(signal.SIGINT)
        return recorded(*given)

    monkeypatch.setattr(recording, "recorded", late)
    with pytest.warns(fu.FunicularWarning, match="the interruption came after the end of the run"):
        assert short().run(**SETTINGS).status == "completed"


@pytest.mark.parametrize("at", range(1, 60, 4))
def test_settings_as_text_pass_ctrl_c_on(at):
    """Pydantic replaces exceptions during serialisation by errors of its own."""
    settings = fu.RunSettings(duration=1.0)
    with pytest.raises(KeyboardInterrupt), Instants(at):
        for _ in range(20):
            settings.field_values()
    assert settings.field_values() == settings.model_dump()
    assert settings.field_values(given=True) == settings.model_dump(exclude_unset=True) == {"duration": 1.0}


# ---- the mechanism


def ctrl_c() -> None:
    signal.raise_signal(signal.SIGINT)


def test_ctrl_c_is_noted_and_passed_on_at_the_end():
    done = []
    with pytest.raises(KeyboardInterrupt), uninterrupted():
        ctrl_c()
        done.append("outer")
        with uninterrupted():
            ctrl_c()
            done.append("inner")
        done.append("after")
    assert done == ["outer", "inner", "after"]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_what_was_noted_comes_where_work_may_be_interrupted():
    done = []
    with uninterrupted():
        ctrl_c()
        with pytest.raises(KeyboardInterrupt), interruptible():
            done.append("not reached")
        with pytest.raises(KeyboardInterrupt), interruptible():
            with uninterrupted():
                ctrl_c()
                done.append("reached")
            done.append("not reached")
        ctrl_c()
        with pytest.raises(KeyboardInterrupt):
            check_interrupted()
        check_interrupted()
        ctrl_c()
        assert was_interrupted() and not was_interrupted()
    assert done == ["reached"]


def test_a_second_one_does_not_interrupt_the_tidying_of_the_first():
    tidied = []
    with uninterrupted():
        try:
            with interruptible():
                ctrl_c()
        except KeyboardInterrupt:
            ctrl_c()
            tidied.append("whole")
        assert was_interrupted()
    assert tidied == ["whole"]


def test_another_handler_is_called_and_stays():
    calls = []
    before = signal.signal(signal.SIGINT, lambda *_: calls.append("called"))
    try:
        with uninterrupted():
            ctrl_c()
            assert calls == []
            with interruptible():
                assert calls == ["called"]
                ctrl_c()
                ctrl_c()
        assert calls == ["called"] * 3
        ctrl_c()
        assert calls == ["called"] * 4
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("handler", [signal.SIG_IGN, signal.SIG_DFL])
def test_without_a_handler_in_python_nothing_changes(handler):
    before = signal.signal(signal.SIGINT, handler)
    try:
        with uninterrupted(), interruptible():
            assert signal.getsignal(signal.SIGINT) == handler
            check_interrupted()
    finally:
        signal.signal(signal.SIGINT, before)


def test_other_threads_take_no_part():
    def work() -> None:
        with uninterrupted(), interruptible():
            found.append(interruptions._Now.depth)

    found: list[int] = []
    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert found == [0]
