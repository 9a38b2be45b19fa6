"""The trial of an integrator at the start of a run: its cost, its effects, and its record in a saved run."""

from itertools import pairwise

import funicular as fu
import mooring_lines
import numpy as np
import pytest
from choice import farthest, motion, references, simulate
from funicular.integrators import Explicit, GeneralisedAlpha, Radau
from funicular.results import streaming
from funicular.solve.motion import integrator_choice, trial_run
from funicular.solve.motion.integrator_choice import Rival
from hard_cases.case import positions
from pendulum import pendulum
from ringing import run_of
from ringing_scenes import SCENES as RINGING
from sliding import sliding_mass

GENALPHA = GeneralisedAlpha()


@pytest.mark.parametrize("name", ["pendulum, 8, E 7e8", "first scene", "flexible link", "steel and rubber",
                                  "two riders", "friction that stops", "stick", "zip line"])
def test_genalpha_begins_where_tol_is_loose(name):
    """With a part of tol its error is within tol, with less work than radau."""
    run, radau = (simulate(name, tol=1e-2, integrator=integrator) for integrator in ("auto", "radau"))
    exact = references()[name]
    assert run.report["integrator"] == "genalpha"
    assert farthest(positions(run), exact) <= 1e-2 * motion(exact)
    assert run.report["newton_iterations"] < radau.report["evaluations"]


@pytest.mark.parametrize("tol", [1e-2, 1e-3])
def test_genalpha_begins_with_moving_supports_where_drag_stops_the_cable(tol):
    """Vibrations that the support excites do not grow; without the sea they may."""
    line = mooring_lines.scene(6)
    runs = [line.run(duration=20.0, output_step=0.5, initial="equilibrium", progress=False, **settings)
            for settings in ({"tol": tol}, {"tol": 1e-6, "integrator": "radau"})]
    auto, exact = (positions(run) for run in runs)
    assert runs[0].report["integrator"] == "genalpha"
    assert 0.02 * tol <= farthest(auto, exact) / motion(exact) <= tol
    dry = line.without("sea").run(duration=0.5, initial="equilibrium", progress=False, tol=tol)
    assert dry.report["integrator"] != "genalpha"


@pytest.mark.parametrize("name", ["shaken support", "double pendulum", "heavy top on a spring"])
def test_genalpha_does_not_begin_where_its_estimate_misses_the_error(name):
    assert simulate(name, tol=1e-2).report["integrator"] != "genalpha"


def test_genalpha_takes_the_place_of_radau_where_slides_cross_many_elements():
    """The counted work decides; the run begins anew, within tol."""
    tol, settings = 5e-4, {"output_step": 0.02, "progress": False}
    scene = sliding_mass(48, strain="engineering", youngs_modulus=0.4e9)
    run, radau = (scene.run(0.2, tol=tol, integrator=name, **settings) for name in ("auto", "radau"))
    exact = scene.run(0.2, integrator="radau", tol=1e-6, **settings)["A.position"]
    moved = np.linalg.norm(exact - exact[0], axis=1).max()
    assert run.report["integrator"] == "genalpha" and "radau on trial" in run.report["integrator_reason"]
    assert np.linalg.norm(run["A.position"] - exact, axis=1).max() <= tol * moved
    assert run.report["newton_iterations"] < 0.2 * radau.report["evaluations"]


@pytest.mark.parametrize("name", ["rigid link", "hard stop"])
def test_a_method_returns_whose_rival_costs_more_than_expected(name, monkeypatch):
    """The cost of radau is an estimate, here far too low; those of both methods are measured in turn, once each."""
    plain = simulate(name, tol=1e-2)
    monkeypatch.setattr(integrator_choice, "MAX_LOW_ORDER_COST_RATIO", 0.4)
    returned = simulate(name, tol=1e-2)
    reason = returned.report["integrator_reason"]
    assert reason.index("genalpha on trial took") < reason.index("radau on trial took")
    assert returned.report["integrator"] == "genalpha"
    assert np.array_equal(positions(returned), positions(plain))


def test_the_cost_of_a_stability_limit_is_certain():
    limited, estimated = Rival(Explicit(), 1e4), Rival(Radau(), 1e4, Rival(Explicit(), 5e4))
    assert trial_run.next_rival(Radau(), 2e4, limited) is None
    assert trial_run.next_rival(GENALPHA, 2e4, estimated) == Rival(GENALPHA, 2e4)
    assert trial_run.next_rival(GENALPHA, 9e4, estimated) is estimated.rival


def times_reached(make, **settings) -> tuple[fu.Run, list[float]]:
    """Run for a second; return the times reached, in order."""
    reached: list[float] = []
    return make().run(1.0, output_step=0.02, progress=reached.append, **settings), reached


def long_trial() -> fu.Scene:
    """Return a scene whose trial radau wins."""
    return pendulum(8, 7e8, 7200)


def test_a_won_trial_is_saved_and_not_run_twice(tmp_path):
    """The times never decrease, and the file has the bits of a run in memory."""
    plain, _ = times_reached(long_trial, tol=1e-4)
    saved, reached = times_reached(long_trial, tol=1e-4, save=tmp_path / "run.nc")
    assert saved.report["integrator"] == "radau" and "explicit" in saved.report["integrator_reason"]
    assert all(before <= after for before, after in pairwise(reached))
    for name in plain.keys():
        assert np.array_equal(plain[name], saved[name])
    assert saved.report["steps"] == plain.report["steps"]


@pytest.mark.parametrize("lost", [False, True])
def test_rows_of_a_trial_that_do_not_fit_in_memory(tmp_path, monkeypatch, lost):
    """They go to an unnamed file, which a run that begins anew overwrites; an older file stays until then."""
    def run(**settings):
        if lost:
            return run_of(RINGING["twisted rod, all of its motion"], tol=1e-2, **settings)
        return times_reached(long_trial, tol=1e-4, **settings)[0]

    plain = run()
    monkeypatch.setattr("funicular.solve.motion.row_stream.MAX_BUFFERED_BYTES", 4.0 * max(1, plain["time"].nbytes))
    taken: list[bool] = []
    take = streaming.Stream._take

    def watched(stream):
        taken.append(stream.has_begun)
        take(stream)

    monkeypatch.setattr(streaming.Stream, "_take", watched)
    saved = run(save=tmp_path / "run.nc")
    assert False in taken[:-1]  # of a trial
    name = "rod0.position" if lost else "wire.nodal_vectors"
    assert np.array_equal(plain[name], saved[name]) and np.array_equal(plain["time"], saved["time"])
    assert sorted(path.name for path in tmp_path.iterdir()) == ["run.nc"]


def test_a_run_stopped_in_its_trial_leaves_a_file_and_goes_on(tmp_path):
    """Ctrl-C before the first pause after the trial."""
    def stop(time: float) -> None:
        if time > 0.1:
            raise KeyboardInterrupt

    path = tmp_path / "run.nc"
    stopped = long_trial().run(1.0, output_step=0.02, tol=1e-4, save=path, progress=stop)
    assert stopped.status == "interrupted"
    whole = long_trial().run(1.0, output_step=0.02, tol=1e-4, save=path, resume=True, progress=False)
    plain = long_trial().run(1.0, output_step=0.02, tol=1e-4, progress=False)
    assert np.array_equal(whole["wire.nodal_vectors"], plain["wire.nodal_vectors"])


def test_an_exception_in_a_trial_leaves_the_older_file(tmp_path):
    path = tmp_path / "run.nc"
    times_reached(long_trial, tol=1e-2, save=path)
    before = path.read_bytes()

    def fail(time: float) -> None:
        raise RuntimeError("stop")

    with pytest.raises(RuntimeError):
        long_trial().run(1.0, output_step=0.02, tol=1e-4, save=path, progress=fail)
    assert path.read_bytes() == before
    assert sorted(each.name for each in tmp_path.iterdir()) == ["run.nc"]


def test_work_beyond_any_count_is_no_error():
    """The alternative of a very stiff scene costs more evaluations than a C integer holds."""
    class Unseen:
        is_shown = False

    class Rated:
        time, given = 0.0, []

        def advance(self, follow, every, stream, most_evaluations, shown):
            assert most_evaluations < 2**63
            return "completed"

    for cost in (1e30, float("inf")):
        found = trial_run.on_trial(Rated(), Rival(Explicit(), cost), Radau(), 1.0, 1, Unseen, None)
        assert found == ("completed", "", 0.0)
