"""Points of sweeps: grids, lists, samples; paths into scenes, their checks, and messages."""

from functools import partial

import numpy as np
import pytest
import scipy.stats
from funicular import Circle, Friction, LogUniform, Material, Scene, SceneError, Uniform, load_scene
from funicular.cli.sweep import parameter_of
from funicular.parts.paths import Variants, label_of, path_of, unit_of
from funicular.sweeps.parameters import points_of
from shared_scenes import changed
from sweep_subjects import scene


def test_grid_has_all_combinations_the_last_fastest():
    points = points_of({"a": [1, 2], "b": ["x", "y", "z"]})
    assert points.shape == (2, 3) and points.number == 6
    assert [tuple(points.point(k).values()) for k in range(6)] == [
        (1, "x"), (1, "y"), (1, "z"), (2, "x"), (2, "y"), (2, "z")]
    assert type(points.point(0)["a"]) is int


def test_list_takes_the_first_values_of_all():
    points = points_of({"a": [1.0, 2.0], "b": [True, False]}, "list")
    assert [tuple(points.point(k).values()) for k in range(2)] == [(1.0, True), (2.0, False)]


@pytest.mark.parametrize("method", ["random", "latin"])
def test_samples_have_their_distributions_and_their_seed(method):
    given = {"a": Uniform(2, 4), "b": LogUniform(1e6, 1e9), "c": scipy.stats.norm(10, 0.1)}
    points = points_of(given, method, 400, seed=3)
    a, b, c = points.columns.values()
    assert scipy.stats.kstest(a, "uniform", (2, 2)).pvalue > 1e-3
    assert scipy.stats.kstest(np.log(b), "uniform", (np.log(1e6), np.log(1e3))).pvalue > 1e-3
    assert scipy.stats.kstest(c, "norm", (10, 0.1)).pvalue > 1e-3
    again, other = points_of(given, method, 400, seed=3), points_of(given, method, 400, seed=4)
    assert points.digest == again.digest != other.digest


def test_latin_samples_fill_each_of_n_equal_parts_once():
    column = points_of({"a": Uniform(0, 50)}, "latin", 50).columns["a"]
    assert sorted(column.astype(int)) == list(range(50))


@pytest.mark.parametrize("given, words", [
    (({"a": []},), "the list of values of a is empty"),
    (({"a": "abc"},), "must be a list"),
    (({"a": [1, "x"]},), "all numbers, all texts"),
    (({"a": [(1, 2)]},), "sweep one component of a vector, such as a.x"),
    (({"a": [1.0, 2.0, 1.0]},), "a has the value 1.0 twice"),
    (({"a": [1, 2], "b": [1]}, "list"), "different numbers of values: a 2, b 1"),
    (({"a": Uniform(0, 1)},), 'add method="latin"'),
    (({"a": [1]}, "latin", 5), "must be a distribution"),
    (({"a": Uniform(0, 1)}, "latin"), "needs a number of samples"),
    (({"a": Uniform(0, 1)}, "lattin", 5), 'did you mean "latin"'),
    (({"a": [10**400]},), "too many digits"),
    (({},), "takes parameters by name"),
])
def test_points_that_make_no_sense_are_refused(given, words):
    with pytest.raises(SceneError, match=words):
        points_of(*given)


@pytest.mark.parametrize("make", [lambda: Uniform(2, 1), lambda: LogUniform(1, 1)])
def test_distributions_rise(make):
    with pytest.raises(SceneError, match="high must be above low"):
        make()


@pytest.mark.parametrize("path, value, get", [
    ("wire.material.youngs_modulus", 3e8, lambda s: s.cables["wire"].material.youngs_modulus),
    ("wire.section.height", 0.04, lambda s: s.cables["wire"].section.height),
    ("wire.elements", 4, lambda s: s.cables["wire"].elements),
    ("wire.law", "structural", lambda s: s.cables["wire"].law),
    ("A.velocity.x", 0.5, lambda s: s.bodies["A"].velocity[0]),
    ("A.inertia.2.2", 0.0015, lambda s: s.bodies["A"].inertia[2][2]),
    ("trolley.friction.coefficient", 0.3, lambda s: s.slides["trolley"].friction.coefficient),
    ("wire@1.5.s", 0.75, lambda s: s.pins[1].s),
    ("gravity.y", -1.6, lambda s: s.gravity[1]),
    ("run.tol", 1e-5, lambda s: s.run_settings["tol"]),
    ("equilibrium.load_steps", 3, lambda s: s.equilibrium_settings["load_steps"]),
])
def test_paths_lead_to_the_value(path, value, get):
    base = scene()
    before = get(base) if path not in ("trolley.friction.coefficient", "equilibrium.load_steps") else None
    made = changed(base, {path: value})
    assert get(made) == value != before
    assert made.to_toml() != base.to_toml() == scene().to_toml()


def test_the_temperature_of_the_scene_is_that_of_its_cables_without_their_own():
    base = Scene(temperature=10.0)
    common = {"elements": 1, "section": Circle(radius=0.01),
              "material": Material(youngs_modulus=1e9, poisson_ratio=0, density=1000, thermal_expansion=1e-5)}
    base.cable("a", start=(0, 0, 0), end=(1, 0, 0), **common)
    base.cable("b", start=(0, 1, 0), end=(1, 1, 0), temperature=3.0, **common)
    made = changed(base, {"temperature": -5.0})
    assert [made.cables[name].temperature for name in "ab"] == [-5.0, 3.0]
    assert [base.cables[name].temperature for name in "ab"] == [10.0, 3.0]


def test_what_is_not_swept_stays():
    base = scene()
    made = changed(base, {"A.velocity.x": 0.5})
    assert made.bodies["A"].velocity == (0.5, 0, 0)
    assert made.to_toml().replace("0.5, 0.0, 0.0]", "1.0, 0.0, 0.0]", 1) == base.to_toml()


def test_several_values_of_one_part_are_changed_at_once():
    """A change one by one would pass through a static coefficient below the sliding one."""
    base = scene().replace("trolley", friction=Friction(coefficient=0.1, static_coefficient=0.1))
    values = {"trolley.friction.coefficient": 0.4, "trolley.friction.static_coefficient": 0.5}
    friction = changed(base, values).slides["trolley"].friction
    assert (friction.coefficient, friction.static_coefficient) == (0.4, 0.5)


def test_a_part_and_what_stands_on_it_are_changed_at_once():
    base = scene()
    made = changed(base, {"wire.end.x": 2.0, "wire@1.5.s": 2.0})
    assert made.cables["wire"].length == 2.0 and made.pins[1].s == 2.0


def outcome(change) -> tuple | str:
    """Return the text and the messages of a changed scene, or why it is refused."""
    try:
        made = change()
    except SceneError as error:
        return str(error)
    return made.to_toml(), made.messages


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("name", ["aerial_tramway", "block_and_tackle", "cable_car", "elevator", "paper51", "zip_line"])
def test_parts_before_the_first_that_changes_are_added_once(name, monkeypatch):
    """Scenes, messages and refusals are those of a change of the whole scene, which stays."""
    base, added, add = load_scene(name), [], Scene.add
    before, parts = base.to_toml(), [*base.parts()]
    monkeypatch.setattr(Scene, "add", lambda self, part: added.append(part) or add(self, part))
    for number, part in enumerate(parts):
        entries = part.as_made().entries()
        key = next((key for key, value in entries.items() if isinstance(value, float) and value), None)
        if key is None or label_of(part) is None:
            continue
        path = path_of(base, f"{label_of(part)}.{key}")
        variants = Variants(base, [path])
        for value in (entries[key], 1.0001 * entries[key], -entries[key]):
            added.clear()
            found = outcome(partial(variants.at, {path: value}))
            assert len(added) <= len(parts) - number
            assert found == outcome(partial(base.changed, [(part, {key: value})]))
    assert base.to_toml() == before


@pytest.mark.parametrize("path, unit", [
    ("wire.material.youngs_modulus", "Pa"), ("A.mass", "kg"), ("A.velocity.x", "m/s"), ("gravity.y", "m/s²"),
    ("temperature", "K"),
    ("run.duration", "s"), ("run.tol", ""), ("wire.section.height", "m"), ("wire.elements", "")])
def test_units(path, unit):
    base = scene()
    assert unit_of(base, path_of(base, path)) == unit


@pytest.mark.parametrize("path, words", [
    ("wir.material", 'no part "wir", nor a table of settings of that name; did you mean "wire".*there are wire, '),
    ("wire.materiel.youngs_modulus", 'wire has no "materiel"; did you mean "material".*known: .*section'),
    ("run.tolerance", 'run has no "tolerance".*known: duration, tol'),
    ("run.save", 'run has no "save"'),
    ("gravity", 'names no entry; write such as "gravity.x"'),
    ("gravity.w", 'gravity has no "w"'),
    ("temperature.x", 'temperature has no entries; write "temperature"'),
    ("wire", "names no entry"),
])
def test_paths_that_lead_nowhere_are_refused(path, words):
    with pytest.raises(SceneError, match=words) as error:
        path_of(scene(), path)
    assert str(error.value).startswith(f'sweep of "{path}": ')
    assert str(error.value).count("known: ") <= 1


@pytest.mark.parametrize("path, words", [
    ("A.mass.x", 'A.mass, 1, has no entries; write "A.mass"'),
    ("A.velocity.w", 'has no entry "w"; write x, y, z'),
    ("wire.material.youngs_moduls", 'cable "wire": material "youngs_moduls" is not known here; did you mean'),
    ("wire.section.heigt", "section.* is not known here"),
])
def test_entries_that_are_not_there_are_refused_with_the_value(path, words):
    base = scene()
    with pytest.raises(SceneError, match=words):
        changed(base, {path: 1.0})


@pytest.mark.parametrize("text, method, values", [
    ("A.mass=1,2.5", "grid", [1, 2.5]),
    ("wire.elements=2:6:3", "grid", [2, 4, 6]),
    ("A.mass=1:2:3", "grid", [1.0, 1.5, 2.0]),
    ("E=1e8:1e10:3:log", "grid", [1e8, 1e9, 1e10]),
    ("run.integrator=radau,genalpha", "list", ["radau", "genalpha"]),
    ("x=true,false", "list", [True, False]),
    ("A.mass=1:2", "latin", Uniform(1, 2)),
    ("A.mass=1:2:log", "random", LogUniform(1, 2)),
])
def test_values_on_the_command_line(text, method, values):
    name, found = parameter_of(text, method)
    assert name == text.partition("=")[0]
    if isinstance(values, list):
        assert found == pytest.approx(values) if isinstance(values[0], int | float) else found == values
        assert list(map(type, found)) == list(map(type, values))
    else:
        assert found == values


@pytest.mark.parametrize("text, method", [("A.mass", "grid"), ("A.mass=", "grid"), ("=1", "grid"), ("a=1:2", "grid"),
                                          ("a=1:2:3", "latin"), ("a=1:2:0", "grid"), ("a=0:2:3:log", "grid"),
                                          ("a=2:1", "latin"), ("a=x:y:3", "grid")])
def test_values_that_make_no_sense_are_refused(text, method):
    with pytest.raises(SceneError, match="--set"):
        parameter_of(text, method)


def test_bundled_scenes_have_units_for_all_numbers_of_their_parts():
    base = load_scene("zip_line")
    assert unit_of(base, path_of(base, "rope.rest_length")) == "m"
