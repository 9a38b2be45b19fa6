"""The JSON Schema of scene files accepts bundled scenes and rejects what the fields of parts reject."""

import json
import tomllib

import jsonschema
import pytest
from funicular import bundled_scenes, load_scene
from funicular.parts.kinds import PARTS
from funicular.scene.schema import scene_schema
from shared_scenes import CABLE
from typer.testing import CliRunner

SCHEMA = scene_schema()
VALIDATOR = jsonschema.Draft7Validator(SCHEMA)


def test_it_is_a_schema_of_all_parts():
    jsonschema.Draft7Validator.check_schema(SCHEMA)
    assert set(PARTS) < set(SCHEMA["properties"])
    for name, part in PARTS.items():
        fields = SCHEMA["properties"][name]["items"]
        assert set(part.keywords()) - {"curve", "function"} == set(fields["properties"])
        assert fields["description"]


@pytest.mark.parametrize("name", list(bundled_scenes()))
def test_bundled_scenes_fit(name):
    VALIDATOR.validate(tomllib.loads(bundled_scenes()[name].read_text()))
    VALIDATOR.validate(tomllib.loads(load_scene(name).to_toml()))


SLIDE = CABLE + '[[slide]]\nbody = "A"\nalong = "wire"\ns = 0.25\n'


@pytest.mark.parametrize(("text", "path"), [
    (CABLE + "elemnts = 3", ["cable", 0]),
    (CABLE.replace("= 3", '= "3"'), ["cable", 0, "elements"]),
    (CABLE.replace("height = 0.05", "height = -0.05"), ["cable", 0, "section"]),
    (CABLE.replace('"rectangle"', '"rectangel"'), ["cable", 0, "section"]),
    (SLIDE + 'frame = "tangnt"', ["slide", 0, "frame"]),
    (SLIDE + 'at_end = { stop = "hard", restitution = 2 }', ["slide", 0, "at_end"]),
    (SLIDE + "velocity = { form = \"ramp\", begin = 0 }", ["slide", 0, "velocity"]),
    (SLIDE.replace('along = "wire"\n', ""), ["slide", 0]),
    ("[run]\nduration = 1\ntol = -1", ["run", "tol"]),
    ("[[pinn]]\ns = 0", []),
    ("[cable]\nname = 'wire'", ["cable"]),
])
def test_mistakes_do_not_fit(text, path):
    errors = list(VALIDATOR.iter_errors(tomllib.loads(text)))
    assert [list(error.absolute_path) for error in errors] == [path]


def test_what_it_takes_in_short_forms():
    VALIDATOR.validate(tomllib.loads(SLIDE + 'velocity = { form = "ramp", start = 0, end = 2 }\nat_end = "leave"'))
    VALIDATOR.validate(tomllib.loads(SLIDE.replace('"A"', "[0.25, 0, 0]") + "velocity = 0.5"))
    VALIDATOR.validate(tomllib.loads(SLIDE.replace('"A"', '["link", 0.5]')))


def test_the_command_writes_it(tmp_path):
    from funicular.cli.main import app

    out = tmp_path / "scene.schema.json"
    assert CliRunner().invoke(app, ["schema", "-o", str(out)]).exit_code == 0
    assert json.loads(out.read_text()) == SCHEMA
    assert json.loads(CliRunner().invoke(app, ["schema"]).output) == SCHEMA
