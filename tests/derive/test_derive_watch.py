"""`funicular derive --watch` derives, compiles, verifies and times one family at every save of a source."""

from dataclasses import replace

import pytest
from funicular.derive import watch
from funicular.derive.catalogue import families
from funicular.derive.codegen import drift

NAME = "planar_frame"


@pytest.fixture
def untouched():
    """generated/ is not written."""
    def stamps() -> dict:
        return {path.name: path.stat().st_mtime_ns for path in drift.folder().iterdir() if path.is_file()}

    before = stamps()
    yield
    assert stamps() == before


def test_a_round_verifies_and_times_the_family(untouched, capfd):
    assert watch.round_of([NAME]) == 0
    out = capfd.readouterr().out
    assert out.count("the same") == len(families()[NAME].build())
    assert f"{NAME}: derived in" in out
    assert "; all agree" in out


def test_a_spec_with_a_wrong_sign_fails_with_the_place_and_shows_its_operations(untouched, capfd, monkeypatch):
    family = families()[NAME]

    def wrong() -> list:
        programs = family.build()
        motion = next(p for p in programs if p.name == f"{NAME}_motion")
        motion.values[motion.outputs[-1].name] *= -3
        return programs

    monkeypatch.setattr(watch, "named", lambda names: {NAME: replace(family, build=wrong)})
    assert watch.round_of([NAME]) > 0
    out = capfd.readouterr().out
    assert "failures, the first: planar_frame_motion" in out
    rows = [line.split() for line in out.splitlines()]
    here, there = next(map(int, row[1:3]) for row in rows if row[:1] == [f"{NAME}_motion"] and len(row) == 4)
    assert here > there


def test_an_unfinished_spec_shows_its_error_and_the_next_family_goes_on(untouched, capfd, monkeypatch):
    def unfinished() -> list:
        raise ZeroDivisionError("not yet")

    every = families() | {"trial": replace(families()[NAME], name="trial", build=unfinished)}
    monkeypatch.setattr(watch, "named", lambda names: {name: every[name] for name in names})
    assert watch.round_of(["trial", NAME]) == 1
    out, err = capfd.readouterr()
    assert "ZeroDivisionError: not yet" in err
    assert "; all agree" in out


def test_saves_are_seen_however_a_file_changes(tmp_path):
    spec, other = tmp_path / "elements" / "spec.py", tmp_path / "notes.txt"
    spec.parent.mkdir()
    spec.write_text("a = 1\n")
    saves = watch.saves(tmp_path, pause=0.0)
    assert next(saves) == {spec}
    other.write_text("no source")
    spec.write_text("a = 10\n")
    assert next(saves) == {spec}
    new = spec.with_name("new.py")
    new.write_text("")
    assert next(saves) == {new}
    spec.unlink()
    assert next(saves) == {spec}


def test_each_save_has_a_round_and_an_unknown_family_none(monkeypatch, capsys):
    rounds = []
    monkeypatch.setattr(watch, "saves", lambda folder: iter([{folder}, {folder}]))
    monkeypatch.setattr(watch, "in_own_process", rounds.append)
    assert watch.main([NAME]) == 0
    assert rounds == [[NAME]] * 2
    assert watch.main(["beam42"]) == 1
    assert rounds == [[NAME]] * 2
    assert 'no spec "beam42"; did you mean beam24' in capsys.readouterr().err


@pytest.mark.slow
def test_a_round_reads_the_modules_anew_in_a_process_of_its_own(untouched, capfd):
    watch.in_own_process([NAME])
    assert "; all agree" in capfd.readouterr().out
