"""Linear algebra of a Newton step: correct, with a cost in proportion to the number of elements."""

import numpy as np
import pytest
from difficult_scenes import SCENES as DIFFICULT
from funicular import Circle, Material, Scene
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model import cutting, fewest_operations, unknowns
from funicular.model.build import build
from linear_cost import SCENES, ladder, scene
from shared_scenes import cable_scene


def started(scene: Scene) -> Engine:
    engine = Engine(build(scene))
    status, _ = engine.start(duration=1.0, output_step=0.1, tol=1e-4, step=0.0, method=GeneralisedAlpha(0.8),
                             first_step=1e-3)
    assert status is None
    return engine


def rope(youngs_modulus=1e7, damping_time=0.0) -> Scene:
    """Return a rope with two slides on one element and one on the last: border columns that begin in different places.
    """
    scene = cable_scene(length=2, pins=(0.0, 2.0), elements=7, element="cable12", section=Circle(radius=0.01),
                        strain="green", material=Material(youngs_modulus=youngs_modulus, poisson_ratio=0.3,
                                                          density=1000, damping_time=damping_time))
    for k, s in enumerate((0.6, 0.8, 1.9)):
        scene.rigid_body(f"A{k}", mass=0.1, inertia=(1e-4, 1e-4, 1e-4), position=(s, 0, 0), velocity=(1, 0, 0))
        scene.slide(f"A{k}", along="wire", s=s)
    return scene


def solution_error(engine: Engine, h: float, size: float) -> tuple[float, str]:
    """Return the relative error of a solve against NumPy, and the factorisation of the band."""
    rng = np.random.default_rng(3)
    _, matrix = engine.linearise(h, size * rng.standard_normal(engine.unknowns))
    right = rng.standard_normal(engine.unknowns)
    expected = np.linalg.solve(matrix, right)
    found, how = engine.solve(right)
    return float(np.abs(found - expected).max() / np.abs(expected).max()), how


@pytest.mark.parametrize("name", DIFFICULT)
def test_solves_any_newton_system(name):
    error, _ = solution_error(started(DIFFICULT[name]()), 1e-3, 1e-3)
    assert error < 1e-10


def two_ropes() -> Scene:
    """Return one rope with damping and one without."""
    made = rope(damping_time=1e-2)
    made.cable("other", start=(0, 1, 0), end=(2, 1, 0), elements=5, element="cable12", section=Circle(radius=0.01),
               material=Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1000))
    made.pin("other", s=0.0)
    return made


@pytest.mark.parametrize(("made", "size", "how"), [
    (rope(), 1e-4, "symmetric"),
    (two_ropes(), 1e-3, "symmetric and unpivoted"),
    (rope(damping_time=1e-2), 1e-3, "unpivoted"),  # Kelvin-Voigt: not symmetric, but for a little
    (rope(damping_time=1e-2), 1e-2, "pivoted"),
    (rope(youngs_modulus=1e9), 1e-1, "pivoted"),  # crumpled: indefinite
], ids=["symmetric", "each by its way", "nearly symmetric", "unsymmetric", "indefinite"])
def test_band_is_factored_as_it_allows(made, size, how):
    error, found = solution_error(started(made), 1e-3, size)
    assert found == how
    assert error < 1e-9


TWISTED_SIZE = 1024
"""Unknowns of a chain from which on it is eliminated from both ends (FU_TWISTED_FROM)."""


@pytest.mark.parametrize(("name", "elements"), [
    *(("pendulum", n) for n in range(171, 175)),  # unknowns beyond multiples of eight: 0, 6, 4, 2
    ("three riders", 180), ("three cables", 186), ("ring", 186), ("ladder", 200)])
def test_long_chains_are_solved_from_both_ends(name, elements):
    engine = started(scene(name, elements))
    assert engine.band[0] >= TWISTED_SIZE
    error, how = solution_error(engine, 1e-4, 1e-6)
    assert how == "symmetric"
    assert error < 1e-9


@pytest.mark.parametrize("half", [0.25, 0.75])
def test_long_chains_that_are_not_definite_are_factored_with_pivots(half):
    """Either half of the chain, or its middle, is compressed."""
    made = scene("pendulum", 180)
    engine = started(made)
    rng = np.random.default_rng(3)
    change = np.zeros(engine.unknowns)
    at = int(half * len(change))
    change[at - 60:at + 60] = 1e-2 * rng.standard_normal(120)
    _, matrix = engine.linearise(1e-1, change)
    right = rng.standard_normal(engine.unknowns)
    expected = np.linalg.solve(matrix, right)
    found, how = engine.solve(right)
    assert how == "pivoted"
    assert np.abs(found - expected).max() < 1e-7 * np.abs(expected).max()


def slides(count: int, first: float = 0.0) -> Scene:
    """Return a rope with slides that move along it, from a share of its length on; the rope has three elements a slide.
    """
    length = float(count)
    scene = cable_scene(length=length, pins=(0.0, length), elements=3 * count, element="cable12",
                        section=Circle(radius=0.01), strain="green",
                        material=Material(youngs_modulus=1e8, poisson_ratio=0.3, density=2000))
    for k in range(count):
        s = length * (first + (1 - first) * (k + 0.5) / count)
        scene.rigid_body(f"A{k}", mass=0.3, inertia=(1e-3, 1e-3, 1e-3), position=(s, 0, 0), velocity=(1, 0, 0.1))
        scene.slide(f"A{k}", along="wire", s=s)
    return scene


@pytest.mark.parametrize(("first", "is_band"), [(0.0, True), (0.97, False)], ids=["apart", "close together"])
def test_many_slides_are_coupled_to_those_beside_them_alone(first, is_band):
    engine = started(slides(48, first))
    error, _ = solution_error(engine, 1e-3, 1e-5)
    assert error < 1e-10
    unknowns, lower, upper = engine.banded_front
    assert (unknowns > 0) == is_band
    if is_band:
        assert max(lower, upper) < unknowns / 8


def test_the_band_of_many_slides_is_as_wide_for_more_of_them():
    widths = []
    for count in (48, 96):
        engine = started(slides(count))
        solution_error(engine, 1e-3, 1e-5)
        widths.append(engine.banded_front[1:])
    assert widths[0] == widths[1]


def test_columns_of_slides_take_memory_in_proportion_to_them():
    """A slide is on one part of the cable at a time: it has one strip for each of its unknowns, and not one a part."""
    strips = [len(build(slides(count)).newton.strips) for count in (48, 96, 192)]
    assert strips[2] - strips[1] == pytest.approx(2 * (strips[1] - strips[0]), rel=0.05)


@pytest.mark.parametrize("integrator", ["genalpha", "energy", "radau"])
def test_dividing_a_cable_with_many_slides_changes_nothing_but_rounding(integrator, monkeypatch):
    """Slides pass from one part of the cable to the next. Steps of 20 ms fail, and rounding decides on their halves."""
    def motion() -> np.ndarray:
        run = slides(28).run(duration=0.6, output_step=0.6, step=5e-3, integrator=integrator)
        return run["wire.nodal_vectors"][-1]

    def chains() -> int:
        return len(build(slides(28)).chains) - 1

    divided = motion()
    assert chains() > 5
    for module in (cutting, unknowns):
        monkeypatch.setattr(module, "MAX_ATTACHMENTS", 10**9)
    assert chains() == 1
    whole = motion()
    assert not np.array_equal(divided, whole)
    np.testing.assert_allclose(divided, whole, rtol=0, atol=1e-9)


@pytest.mark.parametrize(("name", "shared"), [("three cables", 3), ("ring", 3), ("ladder", 9)])
def test_joins_leave_the_band_as_narrow_as_one_cable(name, shared):
    """The border contains the positions where more than two elements meet, and one of a ring."""
    tied, alone = build(scene(name, 120)), build(scene("pendulum", 40))
    assert tied.width == alone.width == 11
    assert tied.n_border_dof - 6 * len(tied.bodies) == shared


def test_many_joins_widen_the_band_where_that_is_cheaper():
    assert build(ladder(120, rungs=30)).n_border_dof == 0


@pytest.mark.parametrize("integrator", ["genalpha", "energy", "radau", "explicit"])
@pytest.mark.parametrize("name", ["three cables", "ring", "ladder"])
def test_a_border_changes_nothing_but_rounding(name, integrator, monkeypatch):
    def motion() -> np.ndarray:
        run = scene(name, 12).run(duration=0.01, output_step=0.01, step=2e-4, integrator=integrator)
        return np.concatenate([run[f"{cable}.nodal_vectors"][-1] for cable in run.scene.cables])

    def border() -> int:
        return Engine(build(scene(name, 12))).band[2]

    with_border, size = motion(), border()
    monkeypatch.setattr(fewest_operations, "_in_chains",
                        lambda incidence: (np.arange(incidence.shape[1]), incidence.shape[1]))
    monkeypatch.setattr(fewest_operations, "ordered", fewest_operations.ordered.__wrapped__)  # without its cache
    assert border() < size
    without = motion()
    assert not np.array_equal(without, with_border)
    np.testing.assert_allclose(without, with_border, rtol=0, atol=1e-13)


@pytest.mark.parametrize("name", SCENES)
def test_memory_and_factored_entries_are_linear_in_the_elements(name):
    engines = [Engine(build(scene(name, n))) for n in (60, 120, 240)]
    memory = np.array([engine.memory for engine in engines])
    assert memory[2] - memory[1] == pytest.approx(2 * (memory[1] - memory[0]), rel=1e-12)
    unknowns, widths, borders = np.array([engine.band for engine in engines]).T
    assert len(set(widths)) == len(set(borders)) == 1
    assert unknowns[2] - unknowns[1] == 2 * (unknowns[1] - unknowns[0])
