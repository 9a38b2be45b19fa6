"""Parts that name a rope or a sheave are refused with the reason."""

import funicular as fu
import pytest

ROPE = {"section": fu.Circle(radius=1e-3), "tension": 10.0,
        "material": fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000)}


def scene() -> fu.Scene:
    made = fu.Scene()
    for name, x in (("A", -0.2), ("B", 0.2)):
        made.rigid_body(name, mass=1, inertia=(1, 1, 1), position=(x, -1, 0))
    made.rope("hoist", route=[fu.Anchor("A"), fu.Sheave("top", at=(0, 0, 0), radius=0.2), fu.Anchor("B")], **ROPE)
    made.cable("wire", start=(1, 0, 0), end=(2, 0, 0), elements=2, element="cable8p", section=fu.Circle(radius=0.01),
               material=ROPE["material"])
    made.surface("bed", fu.Plane(point=(0, -9, 0), normal=(0, 1, 0)))
    made.fluid("water", density=1000, velocity=(1, 0, 0))
    return made


CONNECTED = {
    "pin": lambda s, n: s.pin(n, s=0.0), "clamp": lambda s, n: s.clamp(n, s=0.0),
    "motion": lambda s, n: s.motion(n, s=0.0, displacement=(0, fu.Ramp(start=0, end=1), 0)),
    "tie": lambda s, n: s.tie(n, s=0.0, to="wire", at=0.0), "tie to": lambda s, n: s.tie("wire", s=0.0, to=n, at=0.0),
    "spring": lambda s, n: s.spring((n, 0.5), "A", stiffness=1.0),
    "contacts": lambda s, n: s.contact(["A", "wire"], n, stiffness=1e3),
    "joint": lambda s, n: s.joint("spherical", "A", n), "along": lambda s, n: s.slide("A", along=n, s=0.5),
    "rider": lambda s, n: s.slide((n, 0.0), along="wire", s=0.5),
    "force": lambda s, n: s.force(n, value=(1, 0, 0)),
    "line load": lambda s, n: s.distributed_force(n, value=(1, 0, 0)),
    "moment": lambda s, n: s.moment(n, value=(0, 0, 1)), "drag": lambda s, n: s.drag(n, normal=1.0),
    "contact": lambda s, n: s.contact(n, "bed", stiffness=1e3), "on": lambda s, n: s.contact("wire", n, stiffness=1e3),
    "surface": lambda s, n: s.surface("deck", fu.Plane(point=(0, 0, 0), normal=(0, 1, 0)), on=n),
    "crossing": lambda s, n: s.crossing(n, "wire", stiffness=1e3, radius=0.01),
    "crossed": lambda s, n: s.crossing("wire", n, stiffness=1e3, radius=0.01),
    "rope": lambda s, n: s.rope("other", route=[fu.Anchor(n), fu.Sheave("over", at=(0, 3, 0), radius=0.2),
                                                fu.Anchor(at=(4, 0, 0))], **ROPE)}


@pytest.mark.parametrize("part", CONNECTED)
def test_no_part_can_be_connected_to_a_sheave(part):
    made = scene()
    with pytest.raises(fu.SceneError, match='"top" is a sheave of rope "hoist", to which no other part can be '
                       "connected; take a body that"):
        CONNECTED[part](made, "top")
    assert made.to_toml() == scene().to_toml()


OWN_MESSAGES = {"along": 'm away from rope "hoist" at s =', "rider": 'body: s of rope "hoist" must lie within a span',
                "joint": "", "spring": "", "line load": "", "drag": "", "contact": "",  # can be connected
                "force": 'acts on rope "hoist" and needs the stress-free arc-length s there',
                "moment": 'acts on rope "hoist", whose sections have no axes on which a moment could act',
                "contacts": 'there is no surface "hoist"', "on": 'there is no surface "hoist"'}


@pytest.mark.parametrize("part", [part for part in CONNECTED if OWN_MESSAGES.get(part, part)])
def test_few_parts_can_be_connected_to_a_rope(part):
    made = scene()
    others = '"hoist" is a rope, to which only joints, springs, slides, loads, drags and contacts can be connected'
    with pytest.raises(fu.SceneError, match=OWN_MESSAGES.get(part, others)):
        CONNECTED[part](made, "hoist")
    assert made.to_toml() == scene().to_toml()


@pytest.mark.parametrize("quantity", ["hoist.position.y", "top.tension_on"])
def test_no_event_watches_its_results(quantity):
    with pytest.raises(fu.SceneError, match=r"whose results cannot be watched; watch a body, or give function="):
        scene().event(quantity=quantity, value=1.0)
