"""Each coupling describes its outputs once, by fields in C, which Python reads."""

from dataclasses import fields

import funicular as fu
import numpy as np
import pytest
from funicular.engine import OUTPUTS, Engine, outputs_by_name
from funicular.model.build import build
from funicular.model.kinds import COUPLINGS, in_order
from funicular.model.model import SlideModel
from funicular.parts.kinds import KINDS, TURNING, turning_by_name
from funicular.parts.plane import Plane
from funicular.parts.plane_axes import PlaneAxes
from funicular.parts.quantity import TURNS, Quantity, of_engine, vector_of_time

UPRIGHT = PlaneAxes(Plane.across(np.array([0.0, -1, 0]), np.zeros(3)), {}, 1.0)


@pytest.mark.parametrize("kind", OUTPUTS)
def test_outputs_say_unit_and_turning(kind):
    for name, output in OUTPUTS[kind].items():
        assert output.units and output.turns in TURNS, f"{kind}.{name}"
        assert (output.size == 3) == bool(output.turns), f"{kind}.{name}: three numbers are a vector, others are none"


def test_each_output_is_a_result_of_a_part():
    """A new output of the engine needs an entry with a description in `results` of its part."""
    known = {name for kind in KINDS for part in (kind, *kind.parts_within) for name in part.results}
    known |= {"angle_on", "angle_off", "touches", "aside", "drive", "drawn_length",
              "free_length"}  # taut_rope_states.py
    assert {name for fields in OUTPUTS.values() for name in fields} <= known


def test_results_of_parts_have_the_units_of_the_engine():
    assert of_engine("slide", "force", "").units == "N" and of_engine("crossing", "position", "").turns == "point"
    slide = next(kind for kind in KINDS if kind.kind == "slide")
    assert slide.results["multiplier"].dims == ("time", "normal") and slide.results["traction"].dims == ("time",)


def test_outputs_by_name_are_views_of_the_row():
    rows = np.arange(2 * 14.0).reshape(2, 14)
    found = outputs_by_name("crossing", rows)
    assert [*found] == [*OUTPUTS["crossing"]] and sum(values.size for values in found.values()) == rows.size
    assert found["force"].tolist() == [[0, 1, 2], [14, 15, 16]] and found["sticking"].tolist() == [13, 27]
    with pytest.raises(ValueError, match="a crossing has 14 numbers, not 13"):
        outputs_by_name("crossing", rows[:, :13])


def test_a_vector_says_how_it_turns():
    with pytest.raises(ValueError, match="for a vector"):
        Quantity(("time", "xyz"), "m", "a vector of a new name")
    with pytest.raises(ValueError, match="nothing for a number"):
        Quantity(("time",), "m", "a number", "direction")


def test_a_vector_of_a_new_name_is_turned_by_its_declaration():
    results = {"normal": vector_of_time("1", "normal of the surface"), "place": vector_of_time("m", "place", "point")}
    found = turning_by_name([results])
    assert found["normal"] == "direction" and found["place"] == "point"
    with pytest.raises(ValueError, match='"normal" turn as "direction" and as "point"'):
        turning_by_name([results, {"normal": vector_of_time("m", "a place", "point")}])


def test_a_result_without_a_declaration_is_refused():
    values = np.array([[1.0, 2.0, 0.0]])
    assert UPRIGHT.out("A", "force", values).tolist() == [[1, 0, 2]]
    assert UPRIGHT.out("A", "penetration", values[0]).tolist() == [1, 2, 0]
    for turn in (UPRIGHT.out, UPRIGHT.into):
        with pytest.raises(KeyError, match="unheard_of"):
            turn("A", "unheard_of", values)


def test_every_result_of_a_part_has_a_turning():
    parts = {part for kind in KINDS for part in (kind, *kind.parts_within)}
    assert {name for part in parts for name in part.results} <= set(TURNING)


def test_the_model_has_one_list_of_couplings():
    """Each kind of coupling is a type of the engine. The list has the order of the kinds."""
    model = build(fu.load_scene("cable_car"))
    kinds = [kind.name for kind in COUPLINGS]
    numbers = [kinds.index(coupling.type) for coupling in model.couplings]
    without = {"dead load", "load", "line load", "span", "wrap_point"}
    assert numbers == sorted(numbers) and {*OUTPUTS} == {*kinds} - without
    assert in_order(reversed(model.couplings[:1] + model.couplings[-1:])) == [model.couplings[0], model.couplings[-1]]
    assert [*model.of(SlideModel)] == model.slides and model.slides
    assert [each.name for each in fields(model) if isinstance(getattr(model, each.name), list)] == [
        "cables", "ropes", "bodies", "couplings", "signals", "motions", "tables"]


def test_all_groups_of_couplings_have_results():
    groups = {kind.group for kind in COUPLINGS}
    assert all(kind.results for kind in KINDS if kind.group in groups - {"loads"})
    assert {kind.group for kind in COUPLINGS if kind.name in OUTPUTS} == groups - {"loads"}


def test_a_state_of_rest_keeps_forces_by_kind():
    state = fu.load_scene("cable_car").equilibrium()
    kept, model = state.static_state, build(fu.load_scene("cable_car"))
    assert kept["slide"].shape == (len(model.slides), 2) and kept["crossing"].shape == (0, 0)
    assert np.abs(kept["joint"]).max() > 0


def test_forces_that_are_not_kept_begin_at_zero():
    model = build(fu.load_scene("catenary"))
    engine = Engine(model)
    engine.set_state(0.0, **engine.state())
    kept = engine.state()
    assert model.crossings[0].n_forces and kept["crossing"].shape == (1, 0)
