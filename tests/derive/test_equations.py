"""Every equation of the paper has one place in the sources, which README names."""

from collections import Counter

from equations import EQUATIONS, TOP, table, tags


def test_each_equation_has_exactly_one_tag():
    count = Counter(number for number, _ in tags())
    assert {n: count[n] for n in EQUATIONS} == dict.fromkeys(EQUATIONS, 1)
    assert count.keys() == set(EQUATIONS), "the paper has no others"


def test_the_table_of_the_readme_is_made_from_the_tags():
    assert table() in (TOP / "README.md").read_text(encoding="utf-8"), "paste what tests/derive/equations.py prints"
