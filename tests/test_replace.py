"""Scenes made of others with a part changed."""

import funicular as fu
import pytest
from expectations import refused


def test_replace_returns_a_changed_scene():
    scene = fu.load_scene("cable_car")
    slide = next(iter(scene.slides))
    changed = scene.replace(slide, friction=fu.Friction(coefficient=0.05))
    assert changed.slides[slide].friction == fu.Friction(coefficient=0.05) != scene.slides[slide].friction
    assert changed.to_toml() != scene.to_toml()
    assert changed.replace(slide, friction=scene.slides[slide].friction).to_toml() == scene.to_toml()
    assert changed.run_settings == scene.run_settings


def test_replace_checks_and_names():
    scene = fu.load_scene("paper51")
    with refused('scene: there is no part "wires"; did you mean "wire"?'):
        scene.replace("wires", elements=4)
    with refused('cable "wire": elements must be a whole number, 1 or more, got 0'):
        scene.replace("wire", elements=0)
    with pytest.raises(fu.SceneError, match='"element_count" is not known here'):
        scene.replace("wire", element_count=3)
    pin = scene.pins[1]
    assert scene.replace(pin, s=1.0).pins[1].s == 1.0
    with refused('cable "wire": elements cannot be changed once the part is made; make another part, or another scene: '
                 'scene.replace("wire", elements=...)'):
        scene.cables["wire"].elements = 4
