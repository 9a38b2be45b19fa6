"""Ropes keep their material, do not drift, and agree with limits: a straight cable, one zone without friction."""

import funicular as fu
import numpy as np
import pytest
from ropes.scenes import rope_of

FRICTION = fu.Friction(coefficient=0.3, velocity=1e-2)
pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")


def two_sheaves() -> fu.Scene:
    """Return two weights on a rope over one sheave and under another one, with friction."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    for name, x, mass in (("A", -0.2, 2.0), ("B", 1.2, 2.4)):
        scene.rigid_body(name, mass=mass, inertia=(1, 1, 1), position=(x, -1.5, 0), velocity=(0.3, 0, 0))
    made = {"radius": 0.2, "friction": FRICTION, "zones": 3, "inertia": 0.02}
    scene.rope("rope", route=[fu.Anchor("A"), fu.Sheave("one", at=(0, 0, 0), side="right", **made),
                              fu.Sheave("other", at=(1, 0, 0), side="right", **made), fu.Anchor("B")],
               tension=20.0, elements=2, **rope_of(2e4, 0.1, 0, 1e-4))
    return scene


def belt() -> fu.Scene:
    """Return a belt that is driven."""
    scene = fu.Scene(gravity=(0, 0, 0))
    made = {"radius": 0.1, "side": "left", "friction": FRICTION, "zones": 3}
    scene.rope("rope", closed=True, tension=100.0, elements=1, route=[
        fu.Sheave("one", at=(0, 0, 0), velocity=fu.TableSignal(time=[0, 0.3, 1], value=[0, 9, 9],
                                                               interpolation="linear"), **made),
        fu.Sheave("other", at=(0.4, 0, 0), inertia=0.05, damping=0.1, **made)], **rope_of(1e4, 0.5, 0, 1e-3))
    return scene


def ends_of_spans(scene: fu.Scene, run: fu.Run) -> np.ndarray:
    """Return (time, spans, 2): the material coordinates of the ends of spans, m."""
    rope = scene.ropes["rope"]
    points, at, ends = 4, 0, []
    position, s = run["rope.position"], run["rope.s"]
    for elements in rope.elements_of_spans:
        # a wrap follows a span: its points are those at the radius of a sheave
        ends.append(s[:, [at, at + points * elements]])
        at += points * elements
        centres = np.array([sheave.at.point[:2] for sheave in rope.sheaves])
        while at + 1 < s.shape[1] and any(abs(np.linalg.norm(position[0, at + 1, :2] - c) - sheave.radius) < 1e-9
                                          for c, sheave in zip(centres, rope.sheaves, strict=True)):
            at += 1
    return np.stack(ends, axis=1)


@pytest.mark.parametrize("integrator", ["genalpha", "radau", pytest.param("explicit", marks=pytest.mark.slow)])
@pytest.mark.parametrize("made", [two_sheaves, belt])
def test_material_is_neither_made_nor_lost(made, integrator):
    """The material that runs on a sheave less that which runs off is the change of what lies on it, and the lengths of
    all spans and wraps of an open rope add up to that of the rope, to rounding.
    """
    scene = made()
    run = scene.run(0.2, output_step=0.02, tol=1e-5, integrator=integrator)
    ends = ends_of_spans(scene, run)
    if made is two_sheaves:
        whole = (ends[:, :, 1] - ends[:, :, 0]).sum(axis=1) + (ends[:, 1:, 0] - ends[:, :-1, 1]).sum(axis=1)
        assert whole == pytest.approx(scene.route_of(scene.ropes["rope"]).free_length, abs=1e-14)
    ran_on, ran_off = ends[0, :-1, 1] - ends[:, :-1, 1], ends[0, 1:, 0] - ends[:, 1:, 0]
    on_sheaves = ends[:, 1:, 0] - ends[:, :-1, 1]
    assert np.abs(ran_on - ran_off - (on_sheaves - on_sheaves[0])).max() < 1e-14
    assert np.abs(np.diff(ran_on, axis=0)).max() > 1e-3  # it moves
    assert (np.diff(run["rope.s"], axis=1) > 0).all()


@pytest.mark.slow
def test_a_hundred_thousand_steps():
    """A load swings below a sheave, on which its rope is laid down and taken up. Neither the balance of energy (1e-5 of
    what is exchanged) nor the tangent points (4e-15 m) nor the swing drift.
    """
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("L", mass=2.0, inertia=(1, 1, 1), position=(0.2, -1.5, 0), velocity=(0.8, 0, 0))
    scene.rope("rope", route=[fu.Anchor(at=(-1, -1, 0)), fu.Sheave("top", at=(0, 0, 0), radius=0.2), fu.Anchor("L")],
               tension=20.0, elements=1, **rope_of(2e4, 0.05, 0, 1e-3))
    run = scene.run(100.0, output_step=0.5, step=1e-3, integrator="genalpha")
    assert run.report["steps"] == 100_000
    off, swings = np.abs(run.energy_balance().relative), np.abs(run["L.position"][:, 0] - 0.2)
    assert off.max() < 5e-5 and off[-40:].max() < 3 * off[:40].max()
    assert run["top.residual"].max() < 1e-13
    assert np.ptp(run["rope.s"][:, -1]) == 0.0
    assert swings[-40:].max() == pytest.approx(swings[:40].max(), rel=2e-3)


@pytest.mark.parametrize(("R", "wrap", "elements", "bound"), [(100.0, 2e-2, 8, 1e-5), (1000.0, 2e-3, 1, 1e-4)])
def test_a_very_large_sheave_is_a_straight_rope(R, wrap, elements, bound):
    """A rope on an arc of 2 m of a frictionless sheave stretches, while its load is pulled, as a straight cable."""
    free, tension, EA = 60.0, 1000.0, 1e6
    angle = np.pi / 2 + np.array([wrap, -wrap]) / 2
    feet = R * np.stack([np.cos(angle), np.sin(angle)], axis=1) - (0, R)
    along = np.stack([np.sin(angle), -np.cos(angle)], axis=1)
    start, end = feet[0] - free * along[0], feet[1] + free * along[1]
    made, total = rope_of(EA, 0.5, 0), 2 * free + R * wrap
    time = np.linspace(0, 0.4, 100)
    pull = tension + 500.0 * np.sin(np.clip(time / 0.1, 0, 1) * np.pi / 2) ** 2

    def pulled(at, direction):
        scene = fu.Scene(gravity=(0, 0, 0))
        scene.rigid_body("L", mass=20.0, inertia=(1, 1, 1), position=at)
        scene.joint("prismatic", at, "L", axis=(*direction, 0))
        scene.force("L", value=(*direction, 0), scale=fu.TableSignal(time=time, value=pull))
        return scene

    rope, straight = pulled((*end, 0), along[1]), pulled((total, 0, 0), (1, 0))
    top = fu.Sheave("top", at=(0, -R, 0), radius=R, side="right")
    rope.rope("rope", route=[fu.Anchor(at=(*start, 0)), top, fu.Anchor("L")], tension=tension, elements=elements,
              **made)
    straight.cable("rope", start=(0, 0, 0), end=(total, 0, 0), elements=2 * elements, element="cable8p",
                   strain="engineering", membrane="assumed", rest_length=total / (1 + tension / EA), **made)
    straight.pin("rope", s=0.0)
    straight.joint("spherical", ("rope", straight.cables["rope"].length), "L")
    settings = {"duration": 0.4, "output_step": 0.01, "tol": 1e-5, "integrator": "radau"}
    run, other = rope.run(**settings), straight.run(**settings)
    moved = (run["L.position"] - run["L.position"][0])[:, :2] @ along[1]
    assert moved.max() > 0.08
    assert np.abs(moved - other["L.position"][:, 0] + total).max() < bound * moved.max()


def test_zones_without_friction_are_one():
    """Without weight the tension is the same in all zones: the load as by one zone, with a friction of 1e-12."""
    def run(**sheave):
        scene = fu.Scene(gravity=(0, 0, 0))
        for name, x, force in (("A", -0.2, -40.0), ("B", 0.2, -50.0)):
            scene.rigid_body(name, mass=2.0, inertia=(1, 1, 1), position=(x, -1.5, 0))
            scene.force(name, value=(0, force, 0))
        scene.rope("rope", route=[fu.Anchor("A"), fu.Sheave("top", at=(0, 0, 0), radius=0.2, **sheave),
                                  fu.Anchor("B")], tension=40.0, elements=2, **rope_of(2e4, 0.01, 0, 1e-4))
        return scene.run(0.2, output_step=0.02, tol=1e-8, integrator="radau")

    one, many = run(), run(friction=1e-12, zones=8)
    assert np.abs(one["B.position"] - many["B.position"]).max() < 1e-8
    assert np.abs(one["top.tension_on"] - many["top.tension_on"]).max() < 1e-3
