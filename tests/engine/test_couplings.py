"""The engine calls couplings through their tables of operations; integrators and the run name no kind."""

import re
from pathlib import Path

import pytest

ENGINE = Path(__file__).parents[2] / "runtime" / "engine"
KIND = re.compile(r"\bfu_(?:slide|joint|spring|load|resistance|end_stop|buffer|stick)(?:_\w+)?\b"
                  r"|\bmodel->(?:slides|n_slides)\b")


@pytest.mark.parametrize("path", sorted(ENGINE.glob("integrators/*.c")), ids=lambda path: path.stem)
def test_integrators_know_no_kind_of_coupling(path):
    assert not KIND.findall(path.read_text())


@pytest.mark.parametrize("path", sorted(ENGINE.glob("run/*.c")), ids=lambda path: path.stem)
def test_a_run_knows_no_kind_of_coupling_and_no_kind_of_event(path):
    assert not KIND.findall(path.read_text())


def test_each_type_of_coupling_stands_in_the_list_once():
    listed = [f"fu_{kind}_type" for kind in re.findall(r"^    (?:ALONE|WITH_EVENTS)\((\w+)\)",
                                                     (ENGINE / "events" / "list.c").read_text(), re.M)]
    defined = [name for path in ENGINE.glob("couplings/*/*.c")
               for name in re.findall(r"^const fu_coupling_type (\w+) =", path.read_text(), re.M)]
    assert defined and sorted(listed) == sorted(defined)
