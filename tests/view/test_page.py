"""The 3D page without a browser: storage of arrays, omitted data, content of the file."""

import json
import re
from dataclasses import fields, replace
from pathlib import Path
from typing import get_args, get_type_hints

import numpy as np
import page_animations as animations
import pytest
from funicular import ResultFileError
from funicular.view.animation import (
    DIMENSIONS,
    Animation,
    BodyShape,
    CableShape,
    Clip,
    Curve,
    Mark,
    Quantity,
    Segment,
)
from funicular.view.decimation import MAX_FRAMES, MAX_ROWS, MIN_COLOUR_RANGE, decimated, even_frames
from funicular.view.page import described, is_exaggerable, page, period, write_page
from funicular.view.page_arrays import FLOAT_BITS, Packer, power_of_two, unpack
from funicular.view.plot import MARKERS, SEGMENTS, SIZES
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

SOURCE = Path(__file__).parents[2] / "runtime" / "view" / "page_source"
MAPPINGS = {BodyShape: {"quantities"}}
"""Fields with arrays by name."""
SHAPES = hnp.array_shapes(min_dims=1, max_dims=3, max_side=7)


def numbers(limit: float):
    return hnp.arrays(np.float64, SHAPES, elements=st.floats(-limit, limit) | st.just(np.nan))


@given(numbers(1e3), st.floats(1e-6, 1.0))
def test_fixed_numbers_come_back_to_half_a_step(values, step):
    packer = Packer()
    packer.fixed(values, step)
    read, = unpack(packer.text(), packer.descriptions)
    np.testing.assert_array_equal(np.isnan(read), np.isnan(values))
    assert np.nan_to_num(np.abs(read - values)).max() <= step / 2 * (1 + 1e-9)


@given(numbers(1e30))
def test_floats_come_back_to_half_a_bit(values):
    packer = Packer()
    packer.floats(values)
    read, = unpack(packer.text(), packer.descriptions)
    normal = np.where(np.abs(values) < 1e-30, 0, values)
    np.testing.assert_allclose(read, normal, rtol=2.0 ** -(FLOAT_BITS + 1) * 1.01, atol=1e-29)


@given(hnp.arrays(np.int32, SHAPES), hnp.arrays(np.int32, SHAPES))
def test_integers_come_back(first, second):
    packer = Packer()
    assert (packer.integers(first), packer.integers(second)) == (0, 1)
    for read, given_ in zip(unpack(packer.text(), packer.descriptions), (first, second), strict=True):
        np.testing.assert_array_equal(read, given_)


def test_a_step_that_is_too_small_is_refused():
    with pytest.raises(ValueError, match=r"a step of 9\.31323e-10 is too small for numbers up to 10$"):
        Packer().fixed(np.array([10.0, np.nan]), 1e-9)


def test_smooth_motion_is_small():
    """A travelling wave of a million numbers takes less than a bit per number: its differences are small."""
    animation = animations.wave(stations=1000, frames=1000)
    packer = Packer()
    packer.fixed(animation.clips[0].cables[0].position[..., 1], power_of_two(1e-4))
    assert len(packer.text()) < 1e6 / 2


def test_the_page_has_the_positions_of_the_run():
    animation = animations.paper51()
    header, text = described(animation)
    arrays = unpack(text, header["arrays"])
    clip, drawn = animation.clips[0], header["clips"][0]
    step = header["arrays"][drawn["bodies"][0]["position"]]["step"]
    assert step < 2e-5
    position = arrays[drawn["bodies"][0]["position"]] + header["origin"]
    np.testing.assert_allclose(position, clip.bodies[0].position, rtol=0, atol=step / 2 * 1.001)
    np.testing.assert_allclose(arrays[drawn["time"]], clip.time, rtol=0, atol=1e-9)
    force = arrays[drawn["curves"][0]["values"]]
    np.testing.assert_allclose(force, clip.curves[0].values, rtol=2.0**-FLOAT_BITS, atol=1e-12)


def test_a_place_far_from_the_origin_keeps_its_digits():
    animation = animations.twisted()
    clip, away = animation.clips[0], np.array([1e6, -2e6, 3e5])
    moved = replace(clip, bodies=(), marks=(), segments=(),
                    cables=tuple(replace(c, position=c.position + away, reference=c.reference + away)
                                 for c in clip.cables))
    header, text = described(replace(animation, clips=(moved,)))
    cable = header["clips"][0]["cables"][0]
    read = unpack(text, header["arrays"])[cable["position"]].astype(np.float32).astype(float) + header["origin"]
    s = clip.cables[0].s
    kept = np.abs(s[:, None] - unpack(text, header["arrays"])[cable["s"]]).argmin(axis=0)
    np.testing.assert_allclose(read - away, clip.cables[0].position[:, kept], atol=3e-6)


def interpolated(s, at, values):
    """Return values (T, P) at stations ``at``, interpolated to ``s``, frame by frame."""
    return np.stack([np.interp(s, at, row) for row in values])


def test_stations_that_nobody_sees_are_left_out():
    """The drawing error is below a quarter of a pixel of 2000 in all frames."""
    s, time = np.linspace(0, 10, 801), np.linspace(0, 1, 100)
    y = np.sin(np.pi * s / 10) * np.cos(2 * np.pi * time)[:, None]
    position = np.stack([np.broadcast_to(s, y.shape), y, 0 * y], axis=-1)
    tension = np.where(s < 10 * time[:, None], 1.0, 2.0)  # a jump that moves
    cable = CableShape("rope", s, position, None, {"shape": "circle", "diameter": 0.1}, position[0])
    for quantities, most in (((), 200), ((Quantity("tension", "tension", "N", tension),), 801)):
        clip = Clip("c", time, (replace(cable, quantities=quantities),))
        few, notes = decimated(clip, size=10.0)
        drawn = few.cables[0]
        assert 10 < len(drawn.s) <= most
        assert np.abs(interpolated(s, drawn.s, drawn.position[..., 1]) - y).max() < 0.25 * 10 / 2000
        for quantity in drawn.quantities:
            assert np.abs(interpolated(s, drawn.s, quantity.values) - tension).max() <= 1.0001 / 128
        assert bool(notes) == (len(drawn.s) < len(s))


def test_a_straight_cable_needs_two_stations():
    s = np.linspace(0, 1, 50)
    position = np.stack([s, 0 * s, 0 * s], axis=-1)[None]
    cable = CableShape("bar", s, position, None, {"shape": "circle", "diameter": 0.1}, position[0])
    clip, notes = decimated(Clip("c", np.zeros(1), (cable,)), 1.0)
    assert len(clip.cables[0].s) == 2
    assert "2 of 50 stations" in notes[0]


def test_frames_are_even_over_time():
    time = np.concatenate([np.linspace(0, 1, 5000), np.linspace(1.001, 10, 900)])  # close together in the beginning
    kept = even_frames(time, MAX_FRAMES)
    assert len(kept) <= MAX_FRAMES
    assert (kept[0], kept[-1]) == (0, len(time) - 1)
    assert np.diff(time[kept]).max() < 0.021


def test_all_that_moves_loses_the_same_frames():
    frames = 3000
    time = np.linspace(0, 3, frames)
    line = np.stack([time, 2 * time, 0 * time], axis=-1)
    body = BodyShape("b", line, np.tile([1.0, 0, 0, 0], (frames, 1)), {"kind": "sphere", "radius": 0.1}, line.copy(),
                     {"speed": ("m/s", time)})
    clip = Clip("c", time, bodies=(body,), marks=(Mark("m", "slide", line), Mark("g", "ground", line[:1])),
                segments=(Segment("s", "spring", line[:1], line),))
    few, notes = decimated(clip, 3.0)
    assert len(few.time) <= MAX_FRAMES
    assert any(f"{len(few.time)} of 3000 frames" in note for note in notes)
    for moving in (few.bodies[0].position, few.bodies[0].reference, few.marks[0].position, few.segments[0].end):
        np.testing.assert_array_equal(moving[:, 0], few.time)
    np.testing.assert_array_equal(few.bodies[0].quantities["speed"][1], few.time)
    assert len(few.marks[1].position) == len(few.segments[0].start) == 1


def test_long_curves_keep_their_extremes():
    time = np.linspace(0, 1, 50_000)
    values = np.stack([np.sin(40 * time), np.cos(7 * time)], axis=-1)
    values[31_234] = [9.0, -9.0]  # a single row
    clip = Clip("c", time[:2], curves=(Curve("f", "force", "N", ("x", "y"), time, values),))
    few, notes = decimated(clip, 1.0)
    curve = few.curves[0]
    assert len(curve.time) <= MAX_ROWS
    assert (curve.values.max(), curve.values.min()) == (9.0, -9.0)
    assert "extremes" in notes[0]


@pytest.mark.parametrize(("count", "closed"), [(24, False), (25, True)])
def test_the_period_of_a_mode(count, closed):
    """The last frame equals the first one, or precedes it by one step."""
    clip = animations.modes().clips[0]
    if closed:
        cable = clip.cables[0]
        again = replace(cable, position=np.concatenate([cable.position, cable.position[:1]]), quantities=())
        clip = replace(clip, cables=(again,), time=np.append(clip.time, 0.5))
    assert len(clip.time) == count
    assert period(clip) == pytest.approx(0.5)
    assert period(replace(clip, periodic=False)) is None


def test_what_slides_needs_a_reference_that_goes_along():
    clip = animations.paper51().clips[0]
    assert not is_exaggerable(clip)
    marks = tuple(replace(m, reference=m.position - [0, 0.01, 0]) if m.kind == "slide" else m for m in clip.marks)
    assert is_exaggerable(replace(clip, marks=marks))
    assert is_exaggerable(replace(clip, periodic=True))
    assert is_exaggerable(animations.twisted().clips[0])


def test_the_file_is_complete_and_small():
    text = page(animations.paper51())
    assert len(text) < 300_000
    assert re.findall(r'(?:src|href)="(?!data:)', text) == []
    assert "default-src 'none'" in text
    assert "@@" not in text
    assert "Permission is hereby granted" in text  # three.js asks for its licence in every copy


def test_names_cannot_break_the_page():
    hostile = '</script><script>alert("x")</script> @@header@@ <!--'
    animation = animations.twisted()
    text = page(replace(animation, title=hostile, clips=(replace(animation.clips[0], label=hostile),)))
    assert text.count("<script") == 4  # header, arrays, viewer, loader
    header = re.search(r'id="header">(.*?)</script>', text, re.DOTALL)[1]
    assert json.loads(header)["clips"][0]["label"] == hostile


def test_what_does_not_fit_is_refused():
    animation = animations.twisted()
    clip = animation.clips[0]
    wrong = replace(clip, bodies=(replace(clip.bodies[0], position=np.zeros((3, 3))),))
    with pytest.raises(ValueError, match=r'clip "twisting": body "disc": position has the shape \(3, 3\), \(41, 3\)'):
        page(replace(animation, clips=(wrong,)))
    with pytest.raises(ValueError, match=r'clip "twisting": its times must rise'):
        page(replace(animation, clips=(replace(clip, time=clip.time[::-1]),)))
    with pytest.raises(ValueError, match="without a clip"):
        page(Animation("nothing", (), (0.0, 1.0, 0.0), False))
    odd = replace(clip, bodies=(replace(clip.bodies[0], shape={"kind": "cone"}),))
    with pytest.raises(ValueError, match='no shape "cone"'):
        page(replace(animation, clips=(odd,)))


def test_every_kind_of_mark_and_segment_is_drawn_everywhere():
    """The kinds are those of Mark and Segment; plots draw by MARKERS, SIZES, SEGMENTS, the page by DRAW and WIDTHS."""
    marks, segments = (set(get_args(get_type_hints(part)["kind"])) for part in (Mark, Segment))
    drawn = set(re.findall(r"^  (\w+)\(c\) \{", (SOURCE / "src/symbols.js").read_text(encoding="utf-8"), re.MULTILINE))
    widths = re.search(r"WIDTHS = \{(.*?)\}", (SOURCE / "src/lines.js").read_text(encoding="utf-8"))[1]
    assert marks == set(MARKERS) == set(SIZES) == drawn
    assert segments == {*SEGMENTS, "load"} == set(re.findall(r"(\w+):", widths))


def test_python_and_the_page_have_the_same_smallest_range_of_colours():
    text = (SOURCE / "src/main.js").read_text(encoding="utf-8")
    assert float(re.search(r"MIN_COLOUR_RANGE = ([\d.e-]+);", text)[1]) == MIN_COLOUR_RANGE


def test_every_array_of_a_part_has_its_dimensions():
    for kind, dims in DIMENSIONS.items():
        assert {field.name for field in fields(kind) if "ndarray" in field.type} == {*dims, *MAPPINGS.get(kind, ())}


def test_a_page_that_cannot_be_written(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(ResultFileError, match=r"file/a\.html: the page cannot be written here: Not a directory$"):
        write_page(animations.twisted(), tmp_path / "file" / "a.html")


def luminance(colour: str) -> float:
    """Return the relative luminance of #rrggbb (WCAG 2.1)."""
    channels = [int(colour[i: i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return float(np.dot(linear, [0.2126, 0.7152, 0.0722]))


@pytest.mark.parametrize("theme", [0, 1], ids=["light", "dark"])
def test_contrast(theme):
    """Text has a contrast of at least 4.5, meaningful lines of at least 3 (WCAG 2.1, AA)."""
    block = re.findall(r":root.*?\}", (SOURCE / "style.css").read_text(encoding="utf-8"), re.DOTALL)[theme]
    colours = dict(re.findall(r"--([\w-]+): (#\w{6})", block))
    series = re.findall(r"#\w{6}", re.findall(r"(?:light|dark): \[(.*?)\]",
                                              (SOURCE / "src/colours.js").read_text(encoding="utf-8"))[theme])

    def contrast(a: str, b: str) -> float:
        high, low = sorted((luminance(a), luminance(b)), reverse=True)
        return (high + 0.05) / (low + 0.05)

    for text in ("ink", "muted", "accent"):
        for ground in ("panel", "canvas"):
            assert contrast(colours[text], colours[ground]) >= 4.5, (text, ground)
    for line in (*series, *(colours[name] for name in ("cable", "segment", "load"))):
        assert contrast(line, colours["panel"]) >= 3, line
