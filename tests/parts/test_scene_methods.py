"""The methods of a scene follow from the fields of the parts; the stubs for editors agree with them."""

import inspect
import re
from pathlib import Path

import funicular as fu
import pytest
from funicular.parts.kinds import KINDS
from scene_stub import FILE, stub

MATERIAL = fu.Material(youngs_modulus=1e9, poisson_ratio=0, density=1000)
WIRE = {"start": (0, 0, 0), "end": (1, 0, 0), "elements": 2, "section": fu.Circle(radius=0.01), "material": MATERIAL}


def test_the_stub_is_that_of_the_fields():
    assert Path(FILE).read_text(encoding="utf-8") == stub(), "run `python tests/scene_stub.py`"


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.kind)
def test_help_tells_keywords_defaults_and_meaning(kind):
    method = getattr(fu.Scene, kind.kind)
    parameters = inspect.signature(method).parameters
    assert set(parameters) == {"self", *kind.keywords()}
    for keyword, field in kind.keywords().items():
        described = kind.model_fields[field]
        assert (parameters[keyword].default is inspect.Parameter.empty) == described.is_required()
    assert " ".join(kind.__doc__.split()) in " ".join(method.__doc__.split())
    assert method.__name__ == kind.kind and method.__qualname__ == f"Scene.{kind.kind}"


def test_signatures():
    assert str(inspect.signature(fu.Scene.pin)) == "(self, cable, *, s)"
    assert str(inspect.signature(fu.Scene.tie)) == "(self, cable, *, s, to, at, rotation='rigid', name=None)"
    assert str(inspect.signature(fu.Scene.spring)) == (
        "(self, a, b, *, stiffness=None, damping=0.0, length=None, tension_only=False, free_play=0.0, table=None, "
        "name=None)")


def test_none_is_what_is_not_given():
    scene = fu.Scene()
    wire = scene.cable("wire", **WIRE, law=None, rest_length=None)
    assert wire == fu.Scene().cable("wire", **WIRE)
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0.5, 0, 0))
    assert scene.slide("A", along=wire, s=0.5, name=None).name == "A_on_wire"
    with pytest.raises(fu.SceneError, match='cable "other": up must be 3 numbers, got None'):
        scene.cable("other", **WIRE, up=None)


@pytest.mark.parametrize(("call", "error", "complaint"), [
    (lambda scene: scene.cable("wire", **WIRE, elemnts=3), fu.SceneError,
     'cable "wire": "elemnts" is not known here; did you mean "elements"?'),
    (lambda scene: scene.rigid_body("A", mass=1, position=(0, 0, 0)), fu.SceneError,
     'rigid_body "A": inertia is missing'),
    (lambda scene: scene.pin(), fu.SceneError, "cable is missing"),
    (lambda scene: scene.pin("wire", 0.0), TypeError,
     "Scene.pin() takes 1 argument without keyword (cable), 2 were given"),
    (lambda scene: scene.joint("weld", "A", "B", "C"), TypeError,
     "Scene.joint() takes 3 arguments without keyword (kind, a, b), 4 were given"),
    (lambda scene: scene.pin("wire", cable="wire", s=0), TypeError, "Scene.pin() got cable twice"),
])
def test_wrong_calls_are_refused(call, error, complaint):
    with pytest.raises(error, match=re.escape(complaint)):
        call(fu.Scene())
