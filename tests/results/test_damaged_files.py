"""Damaged result files and checkpoints, and forged ones with correct checksums, are refused without a crash."""

import json
import re
import struct
import subprocess
import sys
import warnings
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
import xarray
from funicular import FunicularError, FunicularWarning, ResultFileError, load_run
from funicular.model.build import build
from funicular.results import netcdf_header
from funicular.results.checkpoints import Checkpoint
from funicular.results.checksums import row_checksums
from funicular.results.netcdf import File
from funicular.results.resume_facts import start_of
from interrupted_runs import SETTINGS, content, resumed, short, signed


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> tuple[bytes, dict[str, bytes], dict, int]:
    """Return the file of a finished run: bytes, arrays, report, and the start of the rows."""
    path = tmp_path_factory.mktemp("whole") / "x.nc"
    short().run(**SETTINGS, save=path)
    file = File(path)
    return path.read_bytes(), content(path), load_run(path).report, path.stat().st_size - file.rows * file.row_bytes


def is_refused_or_the_same(path: Path, data: bytes, whole) -> bool:
    path.write_bytes(data)
    try:
        assert (content(path), load_run(path).report) == whole[1:3]
        return False
    except ResultFileError as error:
        assert str(error).startswith(f"{path}: ")
        return True


def flipped(data: bytes, at: int, bit: int) -> bytes:
    return data[:at] + bytes([data[at] ^ 1 << bit]) + data[at + 1:]


def test_a_flipped_bit_is_found(whole, tmp_path):
    """250 bits in the rows and 250 in the header; only blanks after the report change nothing."""
    data, _, _, begin = whole
    random = np.random.default_rng(1)
    for least, most in ((begin, len(data)), (0, begin)):
        found = [is_refused_or_the_same(tmp_path / "x.nc", flipped(data, at, random.integers(8)), whole)
                 for at in random.integers(least, most, size=250)]
        assert all(found) if least else sum(found) > 25


def test_every_bit_of_the_number_of_rows_and_of_the_format(whole, tmp_path):
    data = whole[0]
    at = data.index(b"funicular_format") + 24
    for place in (4, at):
        for byte in range(place, place + 4):
            for bit in range(8):
                assert is_refused_or_the_same(tmp_path / "x.nc", flipped(data, byte, bit), whole)


def test_a_file_cut_short_is_found(whole, tmp_path):
    data = whole[0]
    for size in (*np.random.default_rng(2).integers(0, len(data), size=100), len(data) - 1):
        assert is_refused_or_the_same(tmp_path / "x.nc", data[:size], whole)


def test_overwritten_pages_are_found(whole, tmp_path):
    """Zeros, as after a power cut, and pages from elsewhere in the file."""
    data, random = whole[0], np.random.default_rng(3)
    for at in random.integers(0, len(data) - 512, size=50):
        other = random.integers(0, len(data) - 512)
        for page in (bytes(512), data[other : other + 512]):
            damaged = data[:at] + page + data[at + 512:]
            assert damaged == data or is_refused_or_the_same(tmp_path / "x.nc", damaged, whole) or at < whole[3]


def test_damaged_rows_are_named_and_the_others_can_be_read(whole, tmp_path):
    data, arrays, report, begin = whole
    path, row = tmp_path / "x.nc", (len(data) - begin) // 21
    for at in (3, 7):
        data = flipped(data, begin + at * row + 40, 3)
    path.write_bytes(data)
    message = re.escape(f"{path}: 2 of its 21 output times are damaged, those of the rows 3, 7; take a copy of it, run "
                        "the scene again, or read the other times with load_run(path, salvage=True)")
    with pytest.raises(ResultFileError, match=f"^{message}$"):
        load_run(path)
    with pytest.warns(FunicularWarning, match=r"2 of its 21 output times are damaged, those of .* 3, 7; they are left"):
        run = load_run(path, salvage=True)
    kept = np.delete(np.arange(21), [3, 7])
    for name in ("time", *run.keys()):
        expected = np.frombuffer(arrays[name]).reshape(21, -1)[kept]
        np.testing.assert_array_equal(run[name].reshape(19, -1), expected)
    run.save(tmp_path / "kept.nc")
    assert content(tmp_path / "kept.nc") == {name: run[name].tobytes() for name in arrays}
    with pytest.warns(FunicularWarning):
        load_run(path, salvage=True).save(path)  # over itself
    assert len(load_run(path).time) == 19 and load_run(path).report == report


def test_a_file_whose_rows_are_all_damaged_has_none_to_read(whole, tmp_path):
    data, _, _, begin = whole
    (tmp_path / "x.nc").write_bytes(data[:begin] + bytes(len(data) - begin))
    with pytest.raises(ResultFileError, match="21 of its 21 output times are damaged"):
        load_run(tmp_path / "x.nc", salvage=True)


def test_other_readers_see_the_checksums_as_a_variable(whole, tmp_path):
    (tmp_path / "x.nc").write_bytes(whole[0])
    with xarray.open_dataset(tmp_path / "x.nc") as dataset:
        assert dataset["row_checksum"].dims == ("time",) and dataset["row_checksum"].dtype == float
        assert json.loads(dataset.attrs["report"])["status"] == "completed"
    run = load_run(tmp_path / "x.nc")
    assert "row_checksum" not in run and "row_checksum" not in run.coords


def test_a_file_without_checksums_is_read_with_a_warning(whole, tmp_path):
    """As written by older versions and by xarray."""
    (tmp_path / "x.nc").write_bytes(whole[0])
    load_run(tmp_path / "x.nc").dataset.to_netcdf(tmp_path / "y.nc", engine="scipy")
    with pytest.warns(FunicularWarning, match=r"y\.nc: has no checksums, as an older funicular or another program"):
        assert content(tmp_path / "y.nc") == whole[1]


def test_each_bit_of_a_row_changes_its_checksum():
    """Also each of 200 random pairs of bits, and the order of words."""
    random = np.random.default_rng(4)
    words = random.integers(0, 2**64, size=60, dtype=np.uint64)
    (sum_,) = row_checksums(words[None])
    bits = np.left_shift(np.uint64(1), np.arange(64, dtype=np.uint64))
    single = (words[None, None] ^ (np.eye(60, dtype=np.uint64)[:, None] * bits[:, None])).reshape(-1, 60)
    assert (row_checksums(single) != sum_).all()
    for k, j in random.integers(0, len(single), size=(200, 2)):
        assert k == j or row_checksums((single[k] ^ single[j] ^ words)[None])[0] != sum_
    swapped = words.copy()
    swapped[[3, 4]] = swapped[[4, 3]]
    assert row_checksums(swapped[None])[0] != sum_ and row_checksums(np.zeros((1, 9), np.uint64))[0] != 0


# --- forged, with the right checksums ---------------------------------------------------------------------------


def with_right_checksum(data: bytes) -> bytes:
    """Return a file with a changed header and a correct checksum, if it can still be parsed."""
    try:
        _, _, places, entries = netcdf_header.parsed(data)
        first = min(entry.begin for entry in entries.values() if entry.in_rows)
        at, size = places["header_checksum"]
        return data[:at] + netcdf_header.header_checksum(data[:first], places).encode() + data[at + size :]
    except (ValueError, LookupError, struct.error, UnicodeDecodeError, OverflowError):
        return data


def test_forged_headers_are_refused_or_read(whole, tmp_path):
    """Each number is replaced by others, each word is changed."""
    data, _, _, begin = whole
    path, random = tmp_path / "x.nc", np.random.default_rng(5)
    values = [struct.pack(">i", v) for v in (-1, 0, 1, 2, 7, 2**31 - 1, -(2**31), 1 << 24)]
    text = data.index(b"{"), data.rindex(b"}")
    places = [at for at in range(4, begin - 4, 4) if not text[0] - 12000 < at < text[1]]
    for at in random.permutation(places)[:250]:
        new = values[random.integers(len(values))]
        path.write_bytes(with_right_checksum(data[:at] + new + data[at + 4 :]))
        use(path)
    for at in random.permutation(begin)[:100]:
        path.write_bytes(with_right_checksum(flipped(data, at, random.integers(8))))
        use(path)


def use(path: Path) -> None:
    """Use results as a user would; only errors of funicular may occur."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FunicularWarning)
            run = load_run(path)
        for name in run.keys():
            assert run[name] is not None
        assert repr(run) and run.keys()
    except FunicularError:
        pass


def test_forged_reports_are_refused(whole, tmp_path):
    path, data = tmp_path / "x.nc", whole[0]
    for report in ([], {}, {"status": "completed"}, {"status": 3, "message": "", "messages": [], "settings": {}},
                   {**whole[2], "messages": "text"}, {**whole[2], "events": [3]}, {**whole[2], "rows": "21"},
                   {**whole[2], "rows": 20}, {**whole[2], "time_s": {"total": "1"}}):
        path.write_bytes(data)
        text = json.dumps(report) if report else '{"a": ' + "[" * 5000
        assert File(path, writable=True).add_report(text)
        with pytest.raises(ResultFileError, match=f"^{path}: is damaged: "):
            load_run(path)


def test_forged_facts_of_a_checkpoint_are_refused(stopped):
    state = stopped.with_name("x.nc.state")
    good = Checkpoint.read(state)
    facts = good.facts.model_dump()
    forged = [facts | change for change in (
        {"rows": 0}, {"rows": -1}, {"rows": "10"}, {"rows": 1.5}, {"rows": 2**40}, {"rows": True},
        {"rows": facts["rows"] - 1}, {"elapsed_s": "1"}, {"elapsed_s": float("nan")}, {"events": {}}, {"events": ["x"]},
        {"resumed_at_s": 1.0}, {"settings": []}, {"start": None}, {"more": 1})]
    forged += [{key: value for key, value in facts.items() if key != name} for name in facts]
    for text in [*map(json.dumps, forged), "[]", "", "3", "[" * 100_000, "1" * 5000]:
        state.write_bytes(signed(b"\n" + text.encode() + b"\n" + good.state))
        with pytest.raises(ResultFileError, match=r"its checkpoint x\.nc\.state is damaged; start the run anew"):
            resumed(stopped)
        assert load_run(stopped).events == []
        assert load_run(stopped).report["messages"] == ["its events are unknown: there is no valid "
                                                        "checkpoint x.nc.state"] or text == json.dumps(forged[6])
    good.write(state)
    assert resumed(stopped).status == "completed"


FORGE = """
import json, shutil, struct, sys, warnings
from collections import Counter
from pathlib import Path
import numpy as np
sys.path.insert(0, {tests!r})
warnings.simplefilter("ignore")
from interrupted_runs import SETTINGS, short, resumed
from funicular import FunicularError
from funicular.results.checkpoints import Checkpoint
path, kept = Path("x.nc"), Path("kept")
state = Path("x.nc.state")
good = Checkpoint.read(kept / "x.nc.state")
random, errors = np.random.default_rng({seed}), Counter()
ints = [struct.pack("i", v) for v in (-1, 2, 3, 4, 5, 1000, 2**31 - 1, -(2**31), 1 << 20)]
doubles = [struct.pack("d", v) for v in (float("nan"), float("inf"), -1.0, 1e300, -1e300, 1e-300, 1e9)]
for _ in range({times}):
    value = (ints + doubles)[random.integers(len(ints) + len(doubles))]
    at = 4 * random.integers((len(good.state) - 8) // 4)
    if random.random() < 0.5:  # the numbers at the end: flags, indices, steps
        at = len(good.state) - 8 - 4 * random.integers(150)
    for name in ("x.nc", "x.nc.state"):
        shutil.copy(kept / name, name)
    Checkpoint(good.facts, good.state[:at] + value + good.state[at + len(value):]).write(state)
    try:
        run = resumed(path)
        assert np.isfinite(run["A.position"]).all()
    except FunicularError as error:
        errors[str(error)] += 1
print(json.dumps(errors))
"""


def forged_states(folder: Path, times: int, seed: int) -> Counter:
    """Return the errors of runs that go on from forged states, with their numbers."""
    code = FORGE.format(tests=str(Path(__file__).parents[1]), times=times, seed=seed)
    (folder / "kept").mkdir()
    for name in ("x.nc", "x.nc.state"):
        (folder / name).rename(folder / "kept" / name)
    done = subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr  # and no signal
    return Counter(json.loads(done.stdout))


def damaged(errors: Counter) -> int:
    return sum(number for text, number in errors.items() if "is damaged" in text)


def test_forged_states_are_refused_or_run(stopped):
    """Indices out of range and invalid numbers, in a separate process, which a crash would end."""
    errors = forged_states(stopped.parent, 60, seed=6)
    assert damaged(errors) > 5, errors


@pytest.mark.slow
def test_many_forged_states(stopped):
    errors = forged_states(stopped.parent, 500, seed=7)
    assert damaged(errors) > 60, errors


def test_zeros_of_both_signs_are_one_state():
    """The sign of a zero may depend on the scenes that a process has built before, which does not bar from resuming."""
    model, other = build(short()), build(short())
    other.q, other.v = (np.where(values == 0.0, -0.0, values) for values in (other.q, other.v))
    other.slides[0].element = np.int64(other.slides[0].element)
    assert np.signbit(other.q).any() and start_of(other) == start_of(model)
    other.q[-1] += 1e-15
    assert start_of(other) != start_of(model)
