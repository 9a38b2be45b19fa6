"""Dataclasses whose methods are made with their first object behave as those of the standard library."""

import copy
import dataclasses
import pickle
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import FrozenInstanceError, field, fields, replace

import pytest
from funicular.base.deferred import dataclass


def pair(decorate):
    """Return a frozen class, and one of keywords that extends a plain one, by a decorator."""

    @decorate(frozen=True)
    class Point:
        x: float
        y: float = 2.0
        label: str = field(default="", compare=False)
        tags: list[str] = field(default_factory=list, repr=False, compare=False)

        def __post_init__(self):
            self.tags.append(f"made at {self.x}")

    @decorate
    class Base:
        first: int
        found: int = field(init=False)

    @decorate(kw_only=True)
    class Extended(Base):
        second: int = 3
        third: dict[str, int]

    return Point, Base, Extended


OURS, THEIRS = pair(dataclass), pair(dataclasses.dataclass)


@pytest.mark.parametrize("kind", [0, 2])
def test_methods_are_those_of_the_standard_library(kind):
    """Representation, equality, order of parameters, default values and the refusal of others."""
    arguments, named, change = [((1.0,), {}, {"x": 5.0}), None, ((1,), {"third": {"a": 1}}, {"second": 5})][kind]
    ours, theirs, other = (made[kind](*arguments, **named) for made in (OURS, THEIRS, OURS))
    if kind == 2:
        ours.found = theirs.found = other.found = 7
    assert repr(ours) == repr(theirs)
    assert vars(ours) == vars(theirs)
    assert ours == other == copy.copy(ours) and ours != theirs
    assert replace(ours, **change).__dict__.items() >= change.items()
    vars(other).update(change)
    assert ours != other
    assert [each.name for each in fields(ours)] == [each.name for each in fields(theirs)]
    for wrong in (lambda made: made(), lambda made: made(*arguments, 1, 2, 3, 4, 5), lambda made: made(unknown=1)):
        for classes in (OURS, THEIRS):
            with pytest.raises(TypeError, match="argument"):
                wrong(classes[kind])


def test_frozen_objects_are_keys_and_others_not():
    """Equal frozen objects are one key, whatever their fields that are not compared; they cannot be changed."""
    point = OURS[0](1.0)
    assert len({point, OURS[0](1.0, label="other"), OURS[0](2.0)}) == 2
    with pytest.raises(FrozenInstanceError, match="x"):
        point.x = 3.0
    with pytest.raises(FrozenInstanceError, match="x"):
        del point.x
    with pytest.raises(TypeError, match="unhashable"):
        hash(OURS[2](1, third={}))


def test_methods_of_a_class_stay():
    """A class keeps the methods that it defines, and a class without comparison compares by identity."""

    @dataclass(eq=False)
    class Named:
        x: int

        def __repr__(self):
            return "named"

    assert repr(Named(1)) == "named"
    assert Named(1) != Named(1)


def test_objects_of_another_process_are_compared():
    """An object that comes from another process completes its class."""
    code = ("import pickle, sys; from funicular.parts.schemas import Place; "
            "sys.stdout.buffer.write(pickle.dumps([Place('wire'), Place('wire')]))")
    sent = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True).stdout
    read = (f"import pickle; a, b = pickle.loads({sent!r}); assert a == b and a is not b and {{a}} == {{b}}; "
            "from dataclasses import fields; print(len(fields(a)))")
    assert subprocess.run([sys.executable, "-c", read], check=True, capture_output=True, text=True).stdout == "2\n"
    assert pickle.loads(sent)[0] == pickle.loads(sent)[1]


def test_threads_make_the_first_objects():
    """Many threads make the first object of a class at the same time."""
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        for _ in range(50):

            @dataclass(frozen=True)
            class Made:
                x: int
                y: list[int] = field(default_factory=list)

            with ThreadPoolExecutor(4) as pool:
                assert [made.x for made in pool.map(Made, range(8))] == [*range(8)]
    finally:
        sys.setswitchinterval(interval)
