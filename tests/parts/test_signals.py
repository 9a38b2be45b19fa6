"""Signals: values, smoothness, refusals."""

import itertools

import numpy as np
import pytest
from expectations import refused
from funicular import Harmonic, Pulse, Ramp, SceneError, TableSignal
from funicular.parts.signal import Constant, Integral, signal
from numpy.testing import assert_allclose

TIMES = np.linspace(-0.5, 3.5, 801)
EVERY = [
    Constant(constant=2.0),
    TableSignal(time=[0, 0.5, 2, 3], value=[0, 1, -1, 4]),
    TableSignal(time=[0, 0.5, 2, 3], value=[0, 1, -1, 4], interpolation="linear"),
    Ramp(start=0.5, end=2, before=1, after=-3),
    Pulse(start=1, end=3),
    Pulse(start=1, end=3, rise=0.25, height=-2),
    Harmonic(amplitude=2, frequency=0.7, phase=0.3, offset=1),
]
SMOOTH = [s for s in EVERY if not isinstance(s, TableSignal)]


@pytest.mark.parametrize("each", EVERY, ids=lambda s: s.form)
def test_value_is_what_pieces_and_sine_say(each):
    breaks, coefficients = each.pieces()
    assert breaks.shape == (len(coefficients) + 1,) and coefficients.shape[1] == 7
    assert np.all(np.diff(breaks) > 0)
    for t in (*TIMES[::50], *breaks):
        k = min(max(np.searchsorted(breaks, t, side="right") - 1, 0), len(coefficients) - 1)
        polynomial = sum(c * (t - breaks[k]) ** power for power, c in enumerate(coefficients[k]))
        amplitude, w, phase = each.sine
        sine = amplitude * np.sin(w * t + phase)
        assert_allclose(each.value(t), polynomial + sine, rtol=1e-13, atol=1e-13)


@pytest.mark.parametrize("each", SMOOTH, ids=lambda s: s.form)
@pytest.mark.parametrize("derivative", [0, 1])
def test_derivatives_are_those_of_values_everywhere(each, derivative):
    """Across all breaks the second derivative is continuous."""
    h = 1e-6
    slope = (each.value(TIMES + h, derivative) - each.value(TIMES - h, derivative)) / (2 * h)
    assert_allclose(slope, each.value(TIMES, derivative + 1), atol=3e-3)


def test_a_table_passes_through_its_points_and_stays_beyond_them():
    time, value = [0, 0.5, 2, 3], [0, 1, -1, 4]
    for kind in ("cubic", "linear"):
        table = TableSignal(time=time, value=value, interpolation=kind)
        assert_allclose(table.value(time), value, atol=1e-14)
        assert_allclose(table.value([-9, 99]), [0, 4], atol=1e-14)
    assert table.value(1.25) == 0.0
    assert_allclose(TableSignal(time=[0, 1, 2, 4], value=[0, 1, 8, 64]).value(3), 27, rtol=1e-14)


def test_ramps_and_pulses():
    assert Ramp(start=1, end=3).value([0, 1, 2, 3, 4]).tolist() == [0, 0, 0.5, 1, 1]
    assert Pulse(start=1, end=3).value([0, 1, 2, 3, 4]).tolist() == [0, 0, 1, 0, 0]
    assert Pulse(start=1, end=3, rise=0.5, height=4).value([1, 1.25, 1.5, 2, 2.5, 2.75, 3]).tolist() == [
        0, 2, 4, 4, 4, 2, 0]


def test_numbers_and_tables_are_signals():
    assert signal(3).value(0.1) == 3
    assert signal({"form": "ramp", "start": 0, "end": 1}) == Ramp(start=0, end=1)
    assert signal(EVERY[1]) is EVERY[1]


@pytest.mark.parametrize(("make", "complaint"), [
    (lambda: Ramp(start=1, end=1), "Ramp: end must be after start 1 s, got 1 s"),
    (lambda: Ramp(start=0, end=np.nan), "Ramp: end must be finite, got nan s"),
    (lambda: Pulse(start=1, end=0.5), "Pulse: end must be after start 1 s, got 0.5 s"),
    (lambda: Pulse(start=0, end=1, rise=0.6), "Pulse: rise must not exceed half of the pulse, 0.5 s, got 0.6 s"),
    (lambda: Harmonic(amplitude=1, frequency=0), "Harmonic: frequency must be positive, got 0 Hz"),
    (lambda: Harmonic(amplitde=1, frequency=1), 'Harmonic: "amplitde" is not known here; did you mean "amplitude"?'),
    (lambda: TableSignal(time=[0], value=[1]), "TableSignal: time must be a list of 2 numbers or more, got [0]"),
    (lambda: TableSignal(time=[0, 1], value=[1, 2, 3]),
     "TableSignal: time and value must be of equal length, got 2 and 3"),
    (lambda: TableSignal(time=[0, 2, 1], value=[1, 2, 3]), "TableSignal: time must increase, got 1 s after 2 s"),
    (lambda: TableSignal(time=[0, 1], value=[1, "2"]), "TableSignal: value must be a number, got '2'"),
    (lambda: TableSignal(time=[0, 1], value=[1, 2], interpolation="cubik"),
     'TableSignal: interpolation "cubik" is not known; did you mean "cubic"?'),
])
def test_refused(make, complaint):
    with refused(complaint):
        make()


@pytest.mark.parametrize("interpolation", ["cubic", "linear"])
def test_a_table_ends_on_its_slope(interpolation):
    """A motion at the end of a run does not stop suddenly; afterwards the value is constant."""
    table = TableSignal(time=[0, 1, 2, 3], value=[0, 2, 4, 6], interpolation=interpolation)
    assert table.value(3.0, derivative=1) == pytest.approx(2)
    assert table.value(3.0) == pytest.approx(6)
    assert table.value(3.1, derivative=1) == 0
    assert table.value(3.1) == 6


@pytest.mark.parametrize("rate", [*EVERY, Ramp(start=-2, end=-1, after=3), TableSignal(time=[2, 3], value=[5, 7])],
                         ids=lambda s: s.form)
def test_the_integral_of_a_signal(rate):
    """The integral from t = 0 in both directions, across all breaks and beyond."""
    way = Integral(rate=rate, start=0.7)
    assert_allclose(way.value(0.0), 0.7, rtol=1e-14)
    for derivative in (0, 1):
        assert_allclose(way.value(TIMES, derivative + 1), rate.value(TIMES, derivative), rtol=1e-12, atol=1e-12)
    for end in (*rate.pieces()[0], -3.3, 0.9, 2.2, 9.0):
        breaks = rate.pieces()[0]
        inside = breaks[breaks * (breaks - end) < 0]
        places = np.sort([0.0, *inside, end])
        x, w = np.polynomial.legendre.leggauss(40)
        pieces = [(b - a) / 2 * w @ rate.value((a + b) / 2 + (b - a) / 2 * x)
                  for a, b in itertools.pairwise(places)]
        assert_allclose(way.value(end), 0.7 + np.sign(end) * sum(pieces), rtol=1e-12, atol=1e-12)


def test_an_integral_is_not_integrated_again():
    with pytest.raises(SceneError, match=r"^Integral: rate is an integral: the degree"):
        Integral(rate=Integral(rate=EVERY[0]))
