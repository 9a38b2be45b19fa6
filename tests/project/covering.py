"""Covering arrays of strength two: few rows, one level of each factor per row, in which every pair of levels occurs.

The array is adaptive. Each row is answered before the next one: accepted, or refused for a set of its levels. Later
rows avoid that set, so that one refusal hides no other pair. The same answers give the same rows.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import combinations

Level = tuple[str, str]
"""A factor and one of its levels."""

Row = dict[str, str]
"""By factor, one of its levels."""


def pairs_of(row: Mapping[str, str]) -> Iterator[frozenset[Level]]:
    """Yield the pairs of levels in a row."""
    return map(frozenset, combinations(row.items(), 2))


class CoveringArray:
    """The open pairs of levels, and the sets of levels that were refused.

    factors: levels by factor; the first level of each is neutral. pairs: the pairs to cover, all by default.
    """

    def __init__(self, factors: Mapping[str, Sequence[str]], pairs: Sequence[frozenset[Level]] | None = None):
        self.factors = {factor: list(levels) for factor, levels in factors.items()}
        self.open = dict.fromkeys(all_pairs(factors) if pairs is None else pairs)
        self.refused: list[frozenset[Level]] = []
        self.masked: list[frozenset[Level]] = []
        self._used: Counter[Level] = Counter()

    def rows(self) -> Iterator[Row]:
        """Yield rows until no pair is open; each must be answered by `worked` or `refuse`."""
        while self.open:
            pair = next(iter(self.open))
            row = self._row(pair)
            if row is None:  # each row with this pair has a refused set
                self._close([pair])
                self.masked.append(pair)
            else:
                before = len(self.open), len(self.refused)
                yield row
                assert (len(self.open), len(self.refused)) != before, f"the row {row} was not answered"

    def worked(self, row: Row) -> None:
        """Close the pairs of a row."""
        self._close(list(pairs_of(row)))

    def refuse(self, levels: frozenset[Level]) -> None:
        """Exclude a set of levels, and close the pairs that this makes impossible."""
        self.refused.append(levels)
        self._close([pair for pair in self.open if levels <= pair])

    def _close(self, pairs: Sequence[frozenset[Level]]) -> None:
        for pair in pairs:
            self.open.pop(pair, None)

    def _row(self, pair: frozenset[Level]) -> Row | None:
        """Return a row with this pair and many other open ones; None if every such row has a refused set."""
        row = dict(pair)
        if not self._is_possible(row):
            return None
        row = self._filled(row, [factor for factor in self.factors if factor not in row])
        if row is not None:
            self._used.update(row.items())
        return row

    def _filled(self, row: Row, left: list[str]) -> Row | None:
        """Return the row completed by a search with backtracking."""
        if not left:
            return row
        factor, *others = left
        for level in sorted(self.factors[factor], key=lambda level: self._worth(row, (factor, level))):
            longer = row | {factor: level}
            if self._is_possible(longer) and (found := self._filled(longer, others)) is not None:
                return found
        return None

    def _worth(self, row: Row, level: Level) -> tuple[int, int]:
        """Return the sort key of the levels of a factor: most open pairs first, then least used."""
        return -sum(frozenset((level, other)) in self.open for other in row.items()), self._used[level]

    def _is_possible(self, row: Row) -> bool:
        levels = set(row.items())
        return not any(refused <= levels for refused in self.refused)


def all_pairs(factors: Mapping[str, Sequence[str]]) -> list[frozenset[Level]]:
    """Return every pair of levels of two factors."""
    return [frozenset(((one, a), (other, b))) for (one, of_one), (other, of_other) in combinations(factors.items(), 2)
            for a in of_one for b in of_other]


def smallest(row: Row, neutral: Mapping[str, Sequence[str]], is_so: Callable[[Row], bool],
             guesses: Sequence[frozenset[str]] = ()) -> frozenset[Level]:
    """Return a minimal set of levels of a row for which a statement holds: without any one of them it fails.

    neutral: by factor, levels with which the statement must also hold if the factor is irrelevant. Factors with several
    of them come last, when few other levels can hide their effect. guesses: sets of factors that may have the levels;
    the first with which the statement holds leaves out all others at once.
    """
    order = sorted(row, key=lambda factor: len(neutral[factor]))
    found, part = dict(row), set()
    for factors in guesses:
        left = [factor for factor in order if factor in factors or len(neutral[factor]) > 1]
        guessed = {factor: level if factor in left else neutral[factor][0] for factor, level in row.items()}
        if is_so(guessed):
            order, found = left, guessed
            break
    for factor in order:
        others = [other for other in neutral[factor] if other != row[factor]]
        if all(is_so(found | {factor: other}) for other in others):
            found[factor] = neutral[factor][0]
        else:
            part.add((factor, row[factor]))
    return frozenset(part)
