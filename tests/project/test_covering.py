"""The covering array: every pair of levels occurs; refused pairs are found and hide no others."""

from itertools import combinations

import pytest
from covering import CoveringArray, all_pairs, pairs_of, smallest

FACTORS = {"a": ["0", "1", "2", "3", "4", "5"], "b": ["0", "1", "2", "3"], "c": ["0", "1", "2", "3"],
           "d": ["0", "1"], "e": ["0", "1", "2"]}
NEUTRAL = {factor: levels[:1] for factor, levels in FACTORS.items()}


def ask(array: CoveringArray, refused=()) -> list[dict[str, str]]:
    """Return the accepted rows where these sets of levels are refused."""
    found = []
    for row in array.rows():
        conflict = next((levels for levels in refused if levels <= set(row.items())), None)
        if conflict is None:
            found.append(row)
            array.worked(row)
        else:
            array.refuse(smallest(row, NEUTRAL, lambda row: any(levels <= set(row.items()) for levels in refused)))
    return found


def test_every_pair_occurs_in_few_rows():
    rows = ask(CoveringArray(FACTORS))
    assert {pair for row in rows for pair in pairs_of(row)} == set(all_pairs(FACTORS))
    assert all(row.keys() == FACTORS.keys() for row in rows)
    assert len(rows) <= 30  # 24 is the least: all pairs of the two largest factors


def test_the_same_rows_each_time():
    assert ask(CoveringArray(FACTORS)) == ask(CoveringArray(FACTORS))


def test_only_the_pairs_that_are_given():
    some = all_pairs(FACTORS)[::7]
    rows = ask(CoveringArray(FACTORS, some))
    assert set(some) <= {pair for row in rows for pair in pairs_of(row)}
    assert len(rows) < len(ask(CoveringArray(FACTORS)))


def test_a_new_level_enters():
    more = FACTORS | {"c": [*FACTORS["c"], "new"]}
    seen = {pair for row in ask(CoveringArray(more)) for pair in pairs_of(row)}
    assert set(all_pairs(more)) == seen


@pytest.mark.parametrize("refused", [
    [frozenset({("a", "1"), ("b", "2")})],
    [frozenset({("a", "1"), ("b", "2")}), frozenset({("c", "3"), ("d", "1")}), frozenset({("a", "3"), ("e", "2")})],
    [frozenset({("a", "1"), ("b", "2"), ("c", "1")})],
])
def test_refused_sets_are_found_and_hide_no_pair(refused):
    array = CoveringArray(FACTORS)
    seen = {pair for row in ask(array, refused) for pair in pairs_of(row)}
    assert {levels for levels in refused if len(levels) == 2} == set(all_pairs(FACTORS)) - seen
    assert {*array.refused} <= {*refused} and not array.masked


def test_a_pair_that_others_make_impossible_is_told():
    """With a = 1 and b = 2, both levels of d are refused: the pair is in no accepted row."""
    refused = [frozenset({("a", "1"), ("b", "2"), ("d", "0")}), frozenset({("a", "1"), ("b", "2"), ("d", "1")})]
    array = CoveringArray(FACTORS)
    array.refused += refused
    rows = list(ask(array, refused))
    assert frozenset({("a", "1"), ("b", "2")}) in array.masked
    assert not any(row["a"] == "1" and row["b"] == "2" for row in rows)


def test_a_row_that_is_not_answered():
    with pytest.raises(AssertionError, match="was not answered"):
        list(CoveringArray(FACTORS).rows())


def test_the_smallest_set():
    row = {"a": "1", "b": "2", "c": "3", "d": "1", "e": "0"}
    for n in (1, 2, 3):
        for levels in map(frozenset, combinations([item for item in row.items() if item[1] != "0"], n)):
            assert smallest(row, NEUTRAL, lambda row: levels <= set(row.items())) == levels  # noqa: B023


def test_a_neutral_level_has_part_in_it_where_another_one_does_not():
    row, levels = {"a": "0", "b": "2", "c": "3", "d": "1", "e": "0"}, frozenset({("a", "0"), ("b", "2")})
    found = smallest(row, NEUTRAL | {"a": ["0", "1"]}, lambda row: levels <= set(row.items()))
    assert found == levels


def test_a_guess_leaves_out_all_other_factors_at_once():
    row, levels = {"a": "1", "b": "2", "c": "3", "d": "1", "e": "2"}, frozenset({("b", "2"), ("c", "3")})
    asked = []

    def is_so(row):
        asked.append(row)
        return levels <= row.items()

    for guesses, questions in (([], 5), ([{"b", "c"}], 3), ([{"a", "b"}, {"b", "c", "d"}], 5), ([{"d", "e"}], 6)):
        asked.clear()
        assert smallest(row, NEUTRAL, is_so, guesses) == levels
        assert len(asked) == questions
