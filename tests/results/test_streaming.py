"""Runs that write while they compute: killed at any instant, they leave a whole file and continue to the same numbers.
"""

import fcntl

import pytest
import xarray
from funicular import (
    Circle,
    EndOfCableError,
    FunicularWarning,
    Harmonic,
    Material,
    ResultFileError,
    Scene,
    SceneError,
    TableSignal,
    load_run,
)
from funicular.integrators import OF_EQUATIONS
from funicular.results import streaming
from funicular.results.netcdf import File
from interrupted_runs import (
    ANEW,
    SETTINGS,
    SOFT,
    WRITES,
    Killed,
    content,
    failing,
    file_refused,
    kill,
    resumed,
    short,
    signed,
)
from numpy.testing import assert_array_equal
from shared_scenes import cable_scene


def test_the_file_holds_what_a_run_in_memory_has(uninterrupted):
    run = short().run(**SETTINGS)
    assert {name: run[name].tobytes() for name in ["time", *run.keys()]} == uninterrupted


def test_results_do_not_depend_on_when_they_are_written(uninterrupted, tmp_path, monkeypatch):
    monkeypatch.setattr(streaming, "CHECKPOINT_INTERVAL", -1.0)
    left = failing(monkeypatch, WRITES, Killed())
    short().run(**SETTINGS, save=tmp_path / "x.nc")
    assert left == [0]  # so that the next test goes through all of them
    assert content(tmp_path / "x.nc") == uninterrupted
    assert [p.name for p in tmp_path.iterdir()] == ["x.nc"]


@pytest.mark.parametrize("writes", [*range(0, 12), *range(13, WRITES - 5, 4), *range(WRITES - 5, WRITES)])
def test_dying_in_the_middle_of_a_write(uninterrupted, tmp_path, writes):
    path, state = tmp_path / "x.nc", tmp_path / "x.nc.state"
    kill(short(), path, writes, **SETTINGS)
    assert path.exists() == (writes > 2)  # its first row, the number of rows, its name
    assert state.exists() == (writes > 3)
    if path.exists():
        with xarray.open_dataset(path) as dataset:
            assert dataset["time"].values.tobytes() == content(path)["time"]
        assert all(uninterrupted[name].startswith(values) for name, values in content(path).items())
    if state.exists():
        if load_run(path).status == "unfinished":
            run = resumed(path)
            assert (run.status, len(run.report["resumed_at_s"])) == ("completed", 1)
            assert not state.exists()
        assert content(path) == uninterrupted


@pytest.mark.filterwarnings("ignore:initial velocities broke a joint")
@pytest.mark.parametrize("method", [*({"integrator": name} for name in OF_EQUATIONS),
                                    {"integrator": "energy", "spectral_radius": 0.5}],
                         ids=lambda method: "-".join(map(str, method.values())))
def test_every_integrator_goes_on_exactly(tmp_path, monkeypatch, method):
    """With a motion of discontinuous rate, a spring, a follower force, damping and a hinge; stopped twice."""
    settings = {"duration": 0.05, "output_step": 0.001, "tol": 1e-4, **method}
    everything().run(**settings, save=tmp_path / "whole.nc")
    monkeypatch.setattr(streaming, "CHECKPOINT_INTERVAL", -1.0)
    for writes, resume in ((40, False), (50, True)):
        with monkeypatch.context() as patch:
            failing(patch, writes, Killed())
            with pytest.raises(Killed):
                everything().run(**settings, save=tmp_path / "x.nc", resume=resume)
        seen = load_run(tmp_path / "x.nc").events
    run = everything().run(**settings, save=tmp_path / "x.nc", resume=True)
    assert 0 < run.report["resumed_at_s"][0] < run.report["resumed_at_s"][1] < 0.05
    assert content(tmp_path / "x.nc") == content(tmp_path / "whole.nc")
    again, whole = run.report, load_run(tmp_path / "whole.nc").report
    assert len(whole["events"]) > len(seen) > 0 and whole["events"][: len(seen)] == seen
    differ = {"time_s", "us_per_step", "solve_cpu_s", "resumed_at_s", "settings"}
    assert {name: value for name, value in again.items() if name not in differ} == {
        name: value for name, value in whole.items() if name not in differ}


def everything() -> Scene:
    scene = Scene()
    material = Material(youngs_modulus=4e6, poisson_ratio=0, density=4200, damping_time=1e-4)
    for name, start, end in (("wire", (0, 0, 0), (1.5, 0, 0)), ("arm", (1.5, 0, 0), (1.5, -0.5, 0))):
        scene.cable(name, start=start, end=end, elements=3, element="cable12", section=Circle(radius=0.01),
                    material=material, up=(0, 0, 1))
    # its breakpoints lie inside steps
    polygon = TableSignal(time=(0, 0.0105, 0.0305, 0.06), value=(0, 0, 1e-4, 0), interpolation="linear")
    scene.motion("wire", s=0.0, displacement=(0, Harmonic(amplitude=0.01, frequency=5.0), polygon))
    scene.pin("arm", s=0.5)
    scene.tie("wire", s=1.5, to="arm", at=0.0, rotation="free")
    scene.rigid_body("A", mass=1.0, inertia=(1e-3, 2e-3, 3e-3), position=(0.48, 0, 0), velocity=(1, 0, 0),
                     angular_velocity=(1, 2, 3))
    scene.slide("A", along="wire", s=0.48, name="trolley")
    scene.spring("A", (0.5, 1, 0), stiffness=50.0, damping=1.0)
    scene.force("wire", s=1.0, value=(2, 0, 0), follower=True)
    scene.event("passes", quantity="wire.position.y", s=1.0, value=-0.001)
    scene.event("late", quantity="trolley.s", value=0.52)
    scene.event("turned", function=lambda time, state: state["A.orientation"][1] - 0.01)
    return scene


def test_rows_are_written_between_checkpoints(tmp_path, monkeypatch):
    """The run pauses once in ten rows, and its clock is slower than its steps."""
    monkeypatch.setattr(streaming, "CHECKPOINT_INTERVAL", 1e9)
    monkeypatch.setattr(streaming, "ROWS_INTERVAL", 0.0)
    path, seen = tmp_path / "x.nc", []
    settings = {"duration": 0.15, "output_step": 5e-4, "step": 5e-6}
    run = short().run(**settings, save=path, progress=lambda time: seen.append((time, load_run(path).time[-1])))
    assert len(seen) > 3 and all(time - written < 5e-4 + 5e-6 for time, written in seen)
    memory = short().run(**settings)
    assert all(run[name].tobytes() == memory[name].tobytes() for name in run.keys())


def test_an_equilibrium_to_start_from(tmp_path):
    scene = cable_scene(pins=(0.0,), **SOFT)
    scene.pin("wire", s=1.0)
    settings, path = {"duration": 0.1, "tol": 1e-3}, tmp_path / "x.nc"
    scene.run(**settings, initial="equilibrium", save=tmp_path / "whole.nc")
    kill(scene, path, 100, **settings, initial="equilibrium")
    with file_refused(path, "its run cannot be resumed from another state" + ANEW):
        scene.run(**settings, initial=scene.equilibrium(load_steps=3, tolerance=1e-5), save=path, resume=True)
    scene.run(**settings, initial=scene.equilibrium(), save=path, resume=True)
    assert content(path) == content(tmp_path / "whole.nc")


def test_ctrl_c_leaves_what_there_is_and_goes_on(uninterrupted, tmp_path):
    path = tmp_path / "x.nc"

    def stop(time: float) -> None:
        if time > 0.095:
            raise KeyboardInterrupt

    with pytest.warns(FunicularWarning, match=r"interrupted at .*, and resume continues the run$"):
        run = short().run(**SETTINGS, save=path, progress=stop)
    assert (run.status, load_run(path).status) == ("interrupted", "interrupted")
    assert len(run.time) == 11
    resumed(path)
    assert content(path) == uninterrupted
    assert [p.name for p in tmp_path.iterdir()] == ["x.nc"]


@pytest.mark.parametrize("method", ["add_report", "truncate"])
def test_dying_when_it_goes_on_after_ctrl_c(uninterrupted, tmp_path, monkeypatch, method):
    """The report of the older file has more times than the resumed one; it must not be taken."""
    path = tmp_path / "x.nc"

    def stop(time: float) -> None:
        if time > 0.095:
            raise KeyboardInterrupt

    def die(*given) -> None:
        raise Killed

    monkeypatch.setattr(streaming, "CHECKPOINT_INTERVAL", 1e9)
    with pytest.warns(FunicularWarning, match="interrupted"):
        short().run(**SETTINGS, save=path, progress=stop)
    with monkeypatch.context() as patch:
        patch.setattr(File, method, die)
        with pytest.raises(Killed):
            resumed(path)
    assert len(load_run(path).time) == 11
    resumed(path)
    assert content(path) == uninterrupted


def test_a_run_that_ends_early_leaves_its_rows_and_no_checkpoint(tmp_path):
    path = tmp_path / "x.nc"
    with pytest.raises(EndOfCableError) as stopped:
        short(5.0).run(duration=0.5, output_step=0.01, tol=1e-3, save=path)
    run = load_run(path)
    assert run.status == "end_of_cable" and 0.2 < run.time[-1] < 0.4
    assert_array_equal(stopped.value.run["trolley.s"], run["trolley.s"])
    assert run["trolley.s"][-1] == pytest.approx(1.5, abs=1e-9)
    assert [p.name for p in tmp_path.iterdir()] == ["x.nc"]
    with file_refused(path, r"its run has ended \(end_of_cable\): there is nothing to resume" + ANEW):
        short(5.0).run(duration=0.5, output_step=0.01, tol=1e-3, save=path, resume=True)


def test_a_new_run_takes_the_place_of_a_stopped_one(stopped, uninterrupted):
    short().run(**SETTINGS, save=stopped)
    assert content(stopped) == uninterrupted
    assert [p.name for p in stopped.parent.iterdir()] == ["x.nc"]


def test_a_run_that_cannot_start_leaves_the_older_file(uninterrupted, tmp_path):
    path = tmp_path / "x.nc"
    short().run(**SETTINGS, save=path)
    with pytest.raises(SceneError, match=r"bytes of results, more than the .* that are free on the disk"):
        short().run(duration=1.0, output_step=1e-12, save=path)
    assert content(path) == uninterrupted


def test_full_disk(tmp_path, monkeypatch, uninterrupted):
    monkeypatch.setattr(streaming, "CHECKPOINT_INTERVAL", -1.0)
    path = tmp_path / "x.nc"
    with monkeypatch.context() as patch:
        failing(patch, 30, OSError(28, "No space left on device"))
        with file_refused(path, "the results could not be written: No space left on device; its first 10 times "
                                "are whole; free disk space, and resume the run"):
            short().run(**SETTINGS, save=path)
    assert len(load_run(path).time) == 10
    assert {p.name for p in tmp_path.iterdir()} == {"x.nc", "x.nc.state"}
    resumed(path)
    assert content(path) == uninterrupted


def test_what_cannot_be_resumed(stopped, tmp_path):
    state, whole = tmp_path / "x.nc.state", (tmp_path / "x.nc.state").read_bytes()
    with file_refused(tmp_path / "y.nc", "there is no run to resume: there is no such file" + ANEW):
        resumed(tmp_path / "y.nc")
    with pytest.raises(ResultFileError, match=r"^run: there is nothing to resume without a file of results; name it"):
        short().run(**SETTINGS, resume=True)
    with file_refused(stopped, "its run was started with tol = 0.001, and cannot be resumed with 0.01; "
                               "resume it with the sett"):
        resumed(stopped, tol=1e-2)
    with file_refused(stopped, "its run was started with duration = 0.2, and cannot be resumed with 0.3;"):
        resumed(stopped, duration=0.3)
    other = short()
    other.pin("wire", s=0.75)
    with file_refused(stopped, "its run cannot be resumed with another scene" + ANEW):
        other.run(**SETTINGS, save=stopped, resume=True)
    for damaged in (whole[:-1], whole[:20], b"", whole.replace(b"{", b"[", 1), whole[:-1] + bytes([whole[-1] ^ 1])):
        state.write_bytes(damaged)
        with file_refused(stopped, r"its checkpoint x\.nc\.state is damaged" + ANEW):
            resumed(stopped)
    state.write_bytes(signed(whole.replace(b'"programs": "', b'"programs": "0')))
    with file_refused(stopped, "its run cannot be resumed with another version of funicular, NumPy or SciPy" + ANEW):
        resumed(stopped)
    state.write_bytes(whole)
    File(stopped, writable=True).truncate(3)
    with file_refused(stopped, "it has 3 times, but its checkpoint is of the one after 10"):
        resumed(stopped)
    state.unlink()
    with file_refused(stopped, r"its checkpoint x\.nc\.state is missing" + ANEW):
        resumed(stopped)


def test_auto_goes_on_with_the_same_integrator(stopped):
    """A given spectral radius decides for genalpha, even with its default value."""
    with file_refused(stopped, "its run was started with spectral_radius = None, and cannot be resumed with 0.9"):
        resumed(stopped, spectral_radius=0.9)


def test_two_runs_do_not_write_one_file(stopped):
    writing = File(stopped, writable=True)
    fcntl.flock(writing.descriptor, fcntl.LOCK_EX)
    for resume in (False, True):
        with file_refused(stopped, "another run is writing it; wait for its end, or give another name$"):
            short().run(**SETTINGS, save=stopped, resume=resume)


def test_a_report_longer_than_its_room(tmp_path, monkeypatch, uninterrupted):
    monkeypatch.setattr(streaming, "REPORT_SPARE", 0)
    run = short().run(**SETTINGS, save=tmp_path / "x.nc")
    assert run.status == "completed"
    assert content(tmp_path / "x.nc") == uninterrupted
    assert [p.name for p in tmp_path.iterdir()] == ["x.nc"]


def test_a_run_read_from_its_file_can_be_saved_again(tmp_path, uninterrupted):
    run = short().run(**SETTINGS, save=tmp_path / "x.nc")
    run.save(tmp_path / "y.nc")
    assert content(tmp_path / "y.nc") == uninterrupted
    run.save(tmp_path / "x.nc")
    assert content(tmp_path / "x.nc") == uninterrupted
    assert load_run(tmp_path / "x.nc").report == run.report
