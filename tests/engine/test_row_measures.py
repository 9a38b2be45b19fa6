"""Measures of many elements in many rows, for the notes on a run, are those of NumPy."""

import numpy as np
import pytest
from funicular.engine import (
    around_elements,
    chord_lengths,
    moments_along,
    quadratic_forms,
    slope_lengths,
    straight_rows,
    tension_work,
    turned_tension,
)
from funicular.model.middle_strain import gauss_rule

ROWS, NODES, VECTORS = 6, 5, 2
RANDOM = np.random.default_rng(5)


def nodal(dim: int) -> np.ndarray:
    return RANDOM.normal(size=(ROWS, NODES, VECTORS, dim))


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("own", [1, NODES - 1])
def test_lengths_of_slopes(dim, own):
    vectors, shapes = nodal(dim), RANDOM.normal(size=(3, own, 2 * VECTORS))
    shapes[..., 1] = 0.0
    e = np.concatenate([vectors[:, :-1], vectors[:, 1:]], axis=2)
    expected = np.linalg.norm(np.einsum("pek,tekd->pted", np.broadcast_to(shapes, (3, NODES - 1, 4)), e), axis=-1)
    vectors[:, :-1, 1] = np.nan  # without weight
    np.testing.assert_allclose(slope_lengths(shapes, vectors[:, :-1], e[:, :, VECTORS:]), expected, rtol=1e-12)


def test_moments_are_those_of_the_line_of_best_fit():
    positions, weights = (np.array(each) for each in gauss_rule(5))
    values = RANDOM.normal(size=(5, ROWS, NODES))
    columns = values.reshape(5, -1)
    fit = np.polynomial.polynomial.polyfit(positions, columns, 1, w=np.sqrt(weights))
    apart = columns - fit[0] - np.outer(positions, fit[1])
    expected = np.array([weights @ columns, weights @ columns**2, weights @ apart**2])
    np.testing.assert_allclose(moments_along(values, positions, weights).reshape(3, -1), expected, rtol=1e-9)


def test_chords_of_all_nodes_and_of_some():
    r = nodal(3)[:, :, 0]
    np.testing.assert_allclose(chord_lengths(r), np.linalg.norm(np.diff(r, axis=1), axis=-1), rtol=1e-14)
    np.testing.assert_allclose(chord_lengths(r, [0, 3, 4]), np.linalg.norm(np.diff(r[:, [0, 3, 4]], axis=1), axis=-1),
                               rtol=1e-14)
    with pytest.raises(ValueError, match="no such nodes"):
        chord_lengths(r, [0, NODES])


@pytest.mark.parametrize("before", [False, True])
@pytest.mark.parametrize("straight", [[1, 0, 1, 1, 0, 1], [1, 1, 0, 1, 0, 0], [0, 0, 0, 0, 0, 0]])
def test_rows_count_as_straight_beside_another_one(straight, before):
    r = np.zeros((ROWS, 3, 2))
    r[:, :, 0] = [0, 1, 2]
    r[:, 1, 1] = np.where(straight, 0.0, 0.1)
    here = np.array(straight, dtype=bool)
    beside = np.append(here[1:], True) | np.append(before, here[:-1])
    assert np.array_equal(straight_rows(r, 1e-12, before), here & beside)


@pytest.mark.parametrize("elements", [1, NODES - 1])
def test_quadratic_forms(elements):
    vectors, m = nodal(3), RANDOM.normal(size=(elements, 2 * VECTORS, 2 * VECTORS))
    e = np.concatenate([vectors[:, :-1], vectors[:, 1:]], axis=2)
    np.testing.assert_allclose(quadratic_forms(m, vectors), 0.5 * np.sum(e * (m @ e), axis=(1, 2, 3)), rtol=1e-12)


def test_the_work_of_a_tension_by_spans():
    n, first = NODES - 1, [0, 3]
    strain, EA, h = 0.1 * RANDOM.normal(size=(ROWS, n)), RANDOM.uniform(1, 2, n), RANDOM.uniform(1, 2, n)
    apart = RANDOM.uniform(0, 3, (ROWS, len(first)))
    length, tension = h * (1 + strain), np.abs(EA * strain)
    force, along = (np.add.reduceat(each, first, axis=1) for each in (tension * length, length))
    expected = (EA * strain**2) @ h + np.maximum(force - force / along * apart, 0).sum(axis=1)
    np.testing.assert_allclose(tension_work(strain, EA, h, apart, first), expected, rtol=1e-12)
    with pytest.raises(ValueError, match="differ in number"):
        tension_work(strain, EA, h, apart, [0])


def test_the_turn_and_the_strain_around_an_element():
    vectors, strain, element = nodal(2), RANDOM.normal(size=(ROWS, NODES - 1)), np.array([0, 1, 2, 3, 3, 0])
    found = around_elements(vectors, 1, strain, element)
    for row, at in enumerate(element):
        first, last = max(at - 1, 0), min(at + 2, NODES - 1)
        a, b = vectors[row, first, 1], vectors[row, last, 1]
        assert found[0, row] == pytest.approx(a @ b / np.linalg.norm(a) / np.linalg.norm(b), rel=1e-12)
        assert found[1, row] == pytest.approx(strain[row, first:last].mean(), rel=1e-12)


@pytest.mark.parametrize("lengths, bends", [(1, 1.0), (ROWS, 1.0), (1, 0.0)])
def test_the_tension_of_a_line_that_turns(lengths, bends):
    cosine, strain = RANDOM.uniform(-1.1, 1.1, ROWS), 0.1 * RANDOM.normal(size=ROWS)
    force, h, EA = RANDOM.uniform(0, 2, ROWS), RANDOM.uniform(0.1, 1, lengths), 3.0
    half = np.maximum(np.arccos(np.clip(cosine, -1, 1)) / 2, 1e-9)
    tension = np.maximum(EA * strain, force / (2 * np.sin(half)))
    angle = 2 * np.arcsin(np.minimum(force / (2 * tension), 1))
    EI = bends * float(np.median(h**2 * tension))  # some elements are longer than the bend, and some shorter
    with np.errstate(divide="ignore"):
        longer = h * np.sqrt(tension / EI)
    error = np.where(longer > 1, np.minimum(0.1 * longer, 0.3) * angle**2, 0)
    assert EI == 0.0 or 0 < np.count_nonzero(longer > 1) < ROWS
    found = turned_tension(cosine, strain, force, h, EA, EI, 0.1, 0.3, 1e-9)
    np.testing.assert_allclose(found, [error.sum(), angle.sum(), tension.sum()], rtol=1e-12)
    with pytest.raises(ValueError, match="differ in number"):
        turned_tension(cosine, strain, force[1:], h, EA, EI, 0.1, 0.3, 1e-9)
