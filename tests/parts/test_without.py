"""Scenes without a part and its dependants; the parts of a scene are read-only."""

import copy
import pickle

import funicular as fu
import pytest
from expectations import refused
from funicular.parts.kinds import PARTS
from funicular.parts.scene_data import _groups
from funicular.parts.scene_text import _words, plain_data

ROPE = {"elements": 2, "element": "cable12", "section": fu.Circle(radius=0.01),
        "material": fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000)}


def everything() -> fu.Scene:
    """Return a scene with a part of every kind, most of them attached to others; names differ from words of scene
    files.
    """
    scene = fu.Scene()
    scene.cable("n-rope", start=(0, 0, 0), end=(2, 0, 0), **ROPE)
    scene.cable("n-second", start=(2, 0, 0), end=(4, 0, 0), **ROPE)
    scene.cable("n-beam", start=(1, 5, 0), end=(1, 5, 1), **ROPE | {"element": "beam24", "law": "structural",
                                                                    "up": (0, 1, 0)})
    scene.pin("n-rope", s=0.0)
    scene.clamp("n-beam", s=0.0)
    scene.motion("n-second", s=2.0, displacement=(0, 0, 0))
    scene.tie("n-rope", s=2.0, to="n-second", at=0.0, name="n-tie")
    scene.rigid_body("n-body", mass=1.0, inertia=(1, 1, 1), position=(1, 0, 0))
    scene.rigid_body("n-hook", mass=1.0, inertia=(1, 1, 1), position=(1, -1, 0))
    scene.modal_body("n-bar", start=(0, -3, 0), end=(1, -3, 0), elements=3, modes=3, section=fu.Circle(radius=0.05),
                     material=ROPE["material"])
    scene.joint("spherical", "n-body", ("n-hook", (0, 1, 0)), name="n-joint")
    scene.slide("n-body", along="n-rope", s=1.0, name="n-slide")
    scene.force("n-hook", value=(0, 1, 0), name="n-force")
    scene.distributed_force("n-rope", value=(0, 1, 0), name="n-side")
    scene.moment("n-body", value=(0, 0, 1), name="n-moment")
    scene.spring(("n-rope", 1.0), ("n-bar", (0.5, 0, 0)), stiffness=1.0, name="n-spring")
    scene.fluid(density=1.2, name="n-air")
    scene.drag("n-rope", normal=1.0, name="n-drag")
    scene.ice("n-second", thickness=0.01, name="n-ice")
    scene.point_mass("n-rope", s=0.5, mass=0.1, name="n-clump")
    scene.relaxation("n-rope", stiffness=1e3, time=0.5, name="n-relaxation")
    scene.wire_friction("n-rope", stiffness=0.5, moment=0.1, name="n-wires")
    scene.cable("n-fibres", **ROPE | {"start": (0, 0, 5), "end": (2, 0, 5), "membrane": "tabulated",
                                      "section": fu.Circle(radius=0.01, tension_table=fu.TensionTable(
                                          strain=(0, 0.1), force=(0, 1e3)))})
    scene.working_curve("n-fibres", permanent=0.3, name="n-worked")
    scene.crossing("n-rope", "n-beam", stiffness=1e3, name="n-crossing")
    scene.surface("n-floor", shape=fu.Plane(normal=(0, 1, 0), point=(0, -9, 0)))
    scene.surface("n-deck", on="n-hook", shape=fu.Plane(normal=(0, 1, 0), point=(0, -2, 0)))
    scene.contact("n-body", "n-deck", stiffness=1e3, name="n-contact")
    scene.event("n-event", quantity="n-slide.s", value=0.5)
    scene.event("n-body", quantity="n-hook.position.y", value=-2.0)  # events have names of their own
    return scene


def around_a_rope() -> fu.Scene:
    """Return a planar scene with a rope, which `everything` cannot have."""
    scene = fu.Scene()
    for k, name in enumerate(("n-load", "n-carrier", "n-other")):
        scene.rigid_body(name, mass=1.0, inertia=(1, 1, 1), position=(2 * k, 3 * (k % 2), 0))
    scene.rope("n-hoist", route=[fu.Anchor("n-load"), fu.Sheave("n-top", at="n-carrier", radius=0.2),
                                 fu.Anchor("n-other", at=(0.1, 0, 0))],
               section=fu.Circle(radius=0.001), material=ROPE["material"], tension=100.0)
    scene.force("n-other", value=(0, 1, 0), name="n-force")
    return scene


EACH_PART = [(make, k) for make in (everything, around_a_rope) for k in range(len(list(make().parts())))]


def named(parts) -> set[str]:
    return {part.given_name for part in parts if part.given_name is not None and part.kind != "event"}


def hanging(scene, gone) -> list:
    """Return the parts whose text names a removed one, recursively: a search without knowledge of fields."""
    names, found = named([gone]), [gone]
    while more := [part for part in scene.parts() if all(part is not each for each in found) and any(
            word.partition(".")[0] in names for entry, value in plain_data(part).items() if entry != "name"
            for word in _words(value))]:
        found += more
        names |= named(more)
    return found


def places(scene, parts) -> list[int]:
    return [k for k, part in enumerate(scene.parts()) if any(part is each for each in parts)]


def test_the_scene_has_all_kinds():
    assert {part.kind for make in (everything, around_a_rope) for part in make().parts()} == set(PARTS)


@pytest.mark.parametrize(("make", "number"), EACH_PART)
def test_a_part_goes_with_what_hangs_on_it(make, number):
    scene = make()
    text, part = scene.to_toml(), list(scene.parts())[number]
    gone = hanging(scene, part)
    made = scene.without(part)
    left = [each.where for k, each in enumerate(scene.parts()) if k not in places(scene, gone)]
    assert [each.where for each in made.parts()] == left
    assert scene.to_toml() == text
    assert fu.Scene.from_toml(made.to_toml()).to_toml() == made.to_toml()
    said = [message for message in made.messages if message.startswith("without ")]
    assert len(said) == (len(gone) > 1)
    for each in gone[1:]:
        assert each.where in said[0]


def test_by_name_and_several_at_once():
    scene = everything()
    assert scene.without("n-force", "n-moment").loads.keys() == {"n-side"}
    messages = scene.without("n-rope").messages
    assert messages[-1].startswith('without cable "n-rope", point_mass "n-clump", pin on "n-rope", tie "n-tie", ')
    assert "n-hook" in scene.without("n-body").bodies and "n-slide" not in scene.without("n-body").slides
    assert scene.without().to_toml() == scene.to_toml()
    with refused('scene: there is no part "n-ropes"; did you mean "n-rope"?'):
        scene.without("n-ropes")


def test_a_scene_without_its_rider_runs():
    run = fu.load_scene("paper51").without("A").run(0.02, output_step=0.01, progress=False)
    assert run.status == "completed" and 'slide "trolley" was left out, too' in " ".join(run.report["messages"])


CHANGES = {
    "dict": [lambda parts: parts.__delitem__("wire"), lambda parts: parts.__setitem__("wire", None),
             lambda parts: parts.pop("wire"), lambda parts: parts.popitem(), lambda parts: parts.clear(),
             lambda parts: parts.update(wire=None), lambda parts: parts.setdefault("b", None),
             lambda parts: parts.__ior__({})],
    "list": [lambda parts: parts.__delitem__(0), lambda parts: parts.__setitem__(0, None), lambda parts: parts.pop(),
             lambda parts: parts.append(None), lambda parts: parts.extend([]), lambda parts: parts.insert(0, None),
             lambda parts: parts.remove(parts[0]), lambda parts: parts.clear(), lambda parts: parts.sort(),
             lambda parts: parts.reverse(), lambda parts: parts.__iadd__([]), lambda parts: parts.__imul__(2)],
}


@pytest.mark.parametrize("group", _groups())
def test_what_a_scene_shows_is_for_reading(group):
    scene = everything()
    parts, text = getattr(scene, group), scene.to_toml()
    for change in CHANGES["dict" if isinstance(parts, dict) else "list"]:
        with pytest.raises(fu.SceneError, match=r'its parts are for reading; .* scene\.without\("wire"\)$'):
            change(parts)
    with refused(f"scene: {group} cannot be set; add parts with the scene's methods for their kinds"):
        setattr(scene, group, {})
    assert scene.to_toml() == text


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda scene: pickle.loads(pickle.dumps(scene)), fu.Scene.copied])
def test_copies_are_scenes_of_their_own(copied):
    scene = everything()
    made = copied(scene)
    assert made.to_toml() == scene.to_toml()
    made.rigid_body("more", mass=1.0, inertia=(1, 1, 1), position=(5, 0, 0))
    made.pin("n-second", s=1.0)
    assert "more" not in scene.bodies and len(scene.pins) == 1
    with pytest.raises(fu.SceneError, match="for reading"):
        made.bodies.clear()
