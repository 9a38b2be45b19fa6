"""Stages that kernels share stand once; the results equal those of separate copies."""

import re
from dataclasses import replace

import pytest
from funicular.derive import catalogue
from funicular.derive.codegen import rendering as emit
from funicular.derive.codegen import sharing
from funicular.derive.codegen.family import Family
from funicular.derive.codegen.loops import Section
from funicular.derive.codegen.repeats import Item
from funicular.derive.laws.kernels import Kernels
from written_out import stages, written_out

NAMES = ["cable8p", "cable8p_green_linear", "cable8p_engineering_linear"]
HEADER = "cable8p_stages.h"


@pytest.fixture(scope="module")
def derived() -> list[emit.Derived]:
    return [emit.derive(family) for family in catalogue.named(NAMES).values()]


def one_by_one(text: str) -> str:
    """Return the text with one declaration per constant, which makes the comparison independent of line breaks."""
    lists = r"const fu_real\n((?:        .*,\n)*        .*;)"
    return re.sub(lists, lambda found: re.sub(r" {8}(.*)[,;]", r"    const fu_real \1;", found[1]).lstrip(), text)


def test_a_kernel_is_what_it_is_with_its_own_stages(derived, monkeypatch):
    shared = emit.render(derived, NAMES, lambda done: None)
    monkeypatch.setattr(sharing, "MIN_SHARED_CHARACTERS", 10**9)
    apart = emit.render(derived, NAMES, lambda done: None)
    assert stages(shared[HEADER])
    assert not stages(apart[HEADER])
    for name in NAMES:
        without_titles = re.sub(r"^    /\* .* \*/\n", "", apart[f"{name}.c"], flags=re.MULTILINE)
        inside = written_out(shared[f"{name}.c"], stages(shared[HEADER]))
        inside = re.sub(r"^(    )?/\* .* \*/\n+(?=/\*|#ifndef|FU_KERNEL|void|    )", "", inside, flags=re.MULTILINE)
        kernels = r"^[A-Z_ ]*void .*?^}$"
        found = [re.findall(kernels, one_by_one(text), re.MULTILINE | re.DOTALL) for text in (inside, without_titles)]
        assert found[0] == found[1]
        assert len(found[0]) == len(next(d for d in derived if d.family.name == name).programs)


def test_a_stage_stands_once_and_is_used_twice_at_least(derived):
    files = emit.render(derived, NAMES, lambda done: None)
    text = "\n".join(files[name] for name in [HEADER, *(f"{name}.c" for name in NAMES)])
    defined = [name for name, _ in re.findall(r"^#define (CABLE8P_\w+) (\\)$", text, re.MULTILINE)]
    assert len(set(defined)) == len(defined)
    assert all(len(re.findall(rf"^    {name}$", text, re.MULTILINE)) >= 2 for name in defined)
    bodies = [lines for name in files for lines in stages(files[name]).values()]
    assert len(set(bodies)) == len(bodies)


def trial(kernels: dict[str, str]) -> tuple[dict, str]:
    """Return the sections of a stage with these assignments to a, b, c, ... by kernel, after sharing, and the macros.
    """
    family = Family("trial", "", list, ())
    sections = {kernel: [Section("stage", [], [Item(f"{name} = x", name) for name in names])]
                for kernel, names in kernels.items()}
    found = sharing.share({"trial": family}, {"trial": sections})
    return {kernel: " ".join(" ".join(of[0].lines).replace("const fu_real", "").replace(" = x", "").split())
            for kernel, of in sections.items()}, "\n".join(stage.text for stage in found.get("trial", []))


def test_a_part_that_stages_have_alike_is_cut_where_the_kernels_part(monkeypatch):
    monkeypatch.setattr(sharing, "MIN_SHARED_CHARACTERS", len("const fu_real a = x;") + 1)
    one, two, three = (f"TRIAL_PART_OF_STAGE{number}" for number in ("", "_2", "_3"))
    kernels, macros = trial({"k": "abcdefg", "l": "abcdz", "m": "cdefy"})
    assert kernels == {"k": f"{one} {two} {three} g;", "l": f"{one} {two} z;", "m": f"{two} {three} y;"}
    assert f"/* part of stage: of k and 2 more */\n#define {two} " in macros
    kernels, _ = trial({"k": "abcdefg", "l": "abcdz", "m": "cdefy", "n": "-dc"})  # c and d the other way round
    assert kernels == {"k": f"{one} c, d; {two} g;", "l": f"{one} c, d, z;", "m": f"c, d; {two} y;", "n": "-, d, c;"}


def test_families_of_no_group_have_no_header(derived):
    alone = [replace(d, family=replace(d.family, group="")) for d in derived]
    files = emit.render(alone, NAMES, lambda done: None)
    assert HEADER not in files
    for name in NAMES:
        kernels, known = files[f"{name}.c"].partition("#include")[2], stages(files[f"{name}.c"])
        assert "_stages.h" not in kernels
        assert all(used in known for used in re.findall(r"^    ([A-Z]\w*)$", kernels, re.MULTILINE))


def test_all_families_of_a_group_are_derived_together():
    every = catalogue.families()
    assert catalogue.whole_groups(["rigid"]).keys() == {"rigid"}
    assert catalogue.whole_groups(["cable18", "rigid"]).keys() == {
        "rigid", *(name for name, family in every.items() if family.group == "cable18")}


@pytest.mark.parametrize("name", [name for name, family in catalogue.families().items()
                                  if "step_stiffness" in family.shared])
def test_the_stiffness_of_a_step_is_what_the_law_that_takes_it_would_derive(name):
    family = catalogue.families()[name]
    other = catalogue.families()[family.shared["step_stiffness"]]
    own, taken = (Kernels(family.element, law).step_stiffness().prune() for law in (family.law, other.law))
    assert [stage.definitions for stage in own.stages] == [stage.definitions for stage in taken.stages]
    assert (own.values["k"] == taken.values["k"]).all()
