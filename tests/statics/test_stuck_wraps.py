"""Modes of ropes that stick to their sheaves, against closed forms."""

import funicular as fu
import numpy as np
import pytest
from funicular.model.build import build
from funicular.solve.modes.stuck_wraps import stuck_wraps

G, R, EA, MASS, INERTIA, LENGTH = 9.81, 0.25, 2e4, 5.0, 0.2, 2.0
THIN = {"section": fu.Circle(radius=1e-3),
        "material": fu.Material(youngs_modulus=EA / (np.pi * 1e-6), poisson_ratio=0.3, density=1.0)}


def pair(**sheave) -> fu.Scene:
    """Return two equal weights on a light rope over a rough sheave."""
    scene = fu.Scene(gravity=(0, -G, 0))
    for name, x in (("A", -R), ("B", R)):
        scene.rigid_body(name, mass=MASS, inertia=(1, 1, 1), position=(x, -LENGTH, 0))
    scene.rope("rope", route=[fu.Anchor("A"), fu.Sheave("top", at=(0, 0, 0), radius=R, friction=0.3, zones=3, **sheave),
                              fu.Anchor("B")], tension=MASS * G, elements=1, **THIN)
    return scene


def vertical(scene: fu.Scene) -> np.ndarray:
    """Return the angular frequencies above zero of the modes in which a weight moves up and down."""
    found = scene.modes(8, about=scene.equilibrium(seek_stable=False), wraps="stick")
    moves = np.maximum(*(np.abs(found[f"{name}.displacement"][:, 1]) for name in "AB")) > 1e-3  # equal modes may mix
    assert found.messages[-1] == 'modes have ropes that stick to sheave "top"'
    return found.angular_frequency[moves & (found.angular_frequency > 1)]


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
def test_a_held_and_a_free_sheave():
    """k = EA/l of each free side: sqrt(k/m), and with the rim J/R² between both sqrt(k (1/m + 2 R²/J))."""
    k = EA / LENGTH * (1 + MASS * G / EA)
    alike, opposite = np.sqrt(k / MASS), np.sqrt(k * (1 / MASS + 2 * R**2 / INERTIA))
    assert vertical(pair()) == pytest.approx([alike, alike], rel=1e-4)  # modes of both sides
    assert vertical(pair(inertia=INERTIA)) == pytest.approx(np.sort([alike, opposite]), rel=1e-4)


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
def test_a_pendulum_rolls_on_a_held_sheave():
    """Its foot moves along the groove, on which the rope is laid down or taken up: l w² = g with the free length l, and
    without a rate of growth, as what hangs on the other side does not move.
    """
    found = pair().modes(3, about=pair().equilibrium(seek_stable=False), wraps="stick")
    assert not found.growth_rate.any()
    scene = pair()
    swings = scene.modes(8, about=scene.equilibrium(seek_stable=False), wraps="stick")
    across = (np.abs(swings["A.displacement"][:, 0]) > 0.5) & (swings.angular_frequency > 1)
    assert swings.angular_frequency[across][0] == pytest.approx(np.sqrt(G / LENGTH), rel=1e-3)


@pytest.mark.parametrize("inertia", [0.0, INERTIA])
def test_a_scene_that_turns_as_a_whole_does_not_slide(inertia):
    """Sheaves turn with their carrier, relative to which their rotation counts."""
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, place in (("A", (-R, -LENGTH, 0)), ("B", (R, -1.0, 0)), ("S", (0.1, 0.2, 0))):
        scene.rigid_body(name, mass=MASS, inertia=(1, 1, 1), position=place)
    top = fu.Sheave("top", at=("S", (-0.1, -0.2, 0)), radius=R, friction=0.3, zones=3, inertia=inertia)
    scene.rope("rope", route=[fu.Anchor("A"), top, fu.Anchor("B")], tension=50.0, elements=1, **THIN)
    model = build(scene)
    rates = np.zeros(model.n_dof)
    for node in (span.node(k) for span in model.ropes[0].spans for k in range(2)):
        vectors = model.q[node].reshape(2, 2)
        rates[node] = np.stack([-vectors[:, 1], vectors[:, 0]], axis=1).ravel()
    for body in model.bodies:
        x, y = model.q[body.configuration : body.configuration + 2]
        rates[body.dof : body.dof + 3] = -y, x, 1.0
    free = model.unknown_of_dof >= 0
    size = model.unknown_of_dof.max() + 1
    motion = np.zeros(size)
    motion[model.unknown_of_dof[free]] = rates[free]
    rows = stuck_wraps(model, model.q, size)
    assert rows.shape[0] == 4 and np.abs(rows.toarray()).max(axis=1).min() > 0.9
    assert np.abs(rows @ motion).max() < 1e-8


def test_other_words_are_refused():
    with pytest.raises(fu.SceneError, match="wraps"):
        pair().modes(1, wraps="glued")
