"""A role of kernels is found by its name in derivation, verification and theory; no list names the roles."""

from importlib import import_module
from pathlib import Path

import funicular.derive
import pytest
from funicular.derive.catalogue import families
from funicular.derive.theory import scopes
from funicular.derive.theory.contents import chapter_of, chapters, main_families

DERIVE = Path(funicular.derive.__path__[0])
ROLES = sorted({family.role for family in families().values()})


@pytest.mark.parametrize("role", ROLES)
def test_each_role_has_samples_relations_invariances_and_a_scope(role):
    samples, relations, invariances = (import_module(f"funicular.derive.verify.{part}.{role}")
                                       for part in ("samples", "relations", "invariances"))
    assert callable(samples.sample)
    for module in (relations, invariances):
        assert callable(getattr(module, role)), f"{module.__name__}: a function {role}"
    assert callable(vars(scopes)[f"{role}_scope"]), f"derive/theory/scopes.py: a function {role}_scope"


def test_the_theory_has_a_chapter_of_each_role():
    assert sorted(main_families()) == ROLES
    of_roles = {chapter_of(families()[name]) for name in main_families().values()}
    assert of_roles <= {*chapters()}


def test_each_chapter_is_in_the_theory_or_on_the_page_of_a_family():
    written = {path.relative_to(DERIVE).with_suffix("").as_posix() for path in DERIVE.rglob("*.md")} - {"README"}
    written.remove("couplings/point_law")  # of laws other than springs, of which the package has none
    shown = {*chapters(), *map(chapter_of, families().values())}
    elements = {f"elements/{family.element.name}" for family in families().values() if family.element}
    left = written - shown - elements
    assert not left, f"{sorted(left)}: enter these in THEORY of derive/theory/contents.py"
