"""Results of a run in memory are computed when they are read, part by part or all at once."""

import copy
import pickle

import funicular as fu
import numpy as np
import pytest
from funicular.model import part_states

SCENES = "paper51", "paper52_modal", "cable_car", "elevator", "mooring_on_bed", "overhead_span", "slewing_crane"


def short_run(name):
    return fu.load_scene(name).run(0.02, output_step=0.01, tol=1e-2, initial="drawn", progress=False)


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("name", SCENES)
def test_results_of_one_part_are_those_among_all(name):
    whole, parts = short_run(name), short_run(name)
    names = whole.keys()
    one_by_one = {each: parts.variables[each] for each in reversed(names)}
    assert parts.keys() == names
    for each, variable in whole.variables.items():
        assert variable[:1] + variable[2:] == one_by_one[each][:1] + one_by_one[each][2:]
        np.testing.assert_array_equal(variable.values, one_by_one[each].values, strict=True)
        assert parts[each] is one_by_one[each].values


def test_one_result_takes_few_calls_of_others(monkeypatch):
    seen, states = [], part_states.body_state
    monkeypatch.setattr(part_states, "body_state", lambda *given: seen.append(1) or states(*given))
    run = short_run("paper51")
    assert "trolley.s" in run and run["wire.position"].shape == (3, 4, 3) and not seen
    assert run["A.position"] is run["A.position"] and len(seen) == 1
    assert "A.absent" not in run and "absent" not in run and "A.position.y" not in run


def test_parts_that_join_the_scene_later_have_no_results():
    scene = fu.load_scene("paper51")
    run = scene.run(0.02, output_step=0.01, tol=1e-2, progress=False)
    scene.rigid_body("later", mass=1, inertia=(1, 1, 1), position=(5, 0, 0))
    scene.pin("wire", s=0.5)
    assert run.keys() == short_run("paper51").keys()


def test_copies_hold_all_results():
    run = short_run("paper51")
    for other in (copy.deepcopy(run.variables), pickle.loads(pickle.dumps(run.variables)), run.variables):
        assert list(other) == run.keys()
        assert all(np.array_equal(other[name].values, run[name]) for name in run)
