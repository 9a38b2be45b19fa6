"""Functions of time as data: scales of loads and prescribed motions.

The engine takes a signal as a piecewise polynomial plus at most one sine:
f(t) = Σ_k coefficients[piece, k] (t - breaks[piece])^k + amplitude sin(angular_frequency t + phase).
A further form is one class with ``pieces`` and one entry in `SIGNALS`.
"""

import cmath
import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import comb, pi
from numbers import Real
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, NamedTuple, Self

import numpy as np
from pydantic import Field, model_validator

from .part import Family, Part
from .schemas import Check, checked
from .validation import check_function, finite, list_of, one_of, positive, show

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms, and for type checkers

DEGREE = 6
"""Of the integral of a smooth rise; FU_SIGNAL_TERMS in engine/base/common.h is one more."""
Time = Annotated[float, finite("s")]
Value = Annotated[float, finite()]

MIN_INTERVAL = 1e-12, 1e-14
"""Between two times of a signal: in s, and relative to the times."""

CANCELLATION_TOLERANCE = 1e-12
"""Of the largest term: rounding of a sum that is zero."""
ROOT_TOLERANCE = 1e-12
"""Rounding of the times and places at which a signal has a value, as a fraction."""
TURN_TOLERANCE = 1e-6
"""Imaginary part of a root of the rate, as a fraction of its interval, with which it is an extreme of the signal."""
_RISE = np.array([0, 0, 0, 10, -15, 6, 0])
"""The polynomial from 0 to 1 over [0, 1] whose first and second derivatives vanish at both ends."""


class Sine(NamedTuple):
    """amplitude sin(angular_frequency t + phase), in rad and s."""

    amplitude: float = 0.0
    angular_frequency: float = 0.0
    phase: float = 0.0


class Signal(Part):
    """Base of the functions of time."""

    tag = "form"
    form: ClassVar[str]

    def pieces(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the polynomials: increasing breaks (n+1,) in s, and coefficients (n, 7) of powers of t - breaks[k].

        The first piece also holds before all breaks, and the last one after them.
        """
        raise NotImplementedError

    @property
    def sine(self) -> Sine:
        """Return the sine that is added to the polynomials."""
        return Sine()

    @property
    def is_known(self) -> bool:
        """Return whether its pieces are those of all times, and not those of the start of a simulation alone."""
        return True

    def value(self, time: "ArrayLike", derivative: int = 0) -> np.ndarray:
        """Return the signal, or a derivative of it, at times of any shape, in s."""
        return value_at(self.sine, *self.pieces(), time, derivative)


def value_at(sine: Sine, breaks: np.ndarray, coefficients: np.ndarray, time: "ArrayLike",
             derivative: int = 0) -> np.ndarray:
    """Return a derivative of a piecewise polynomial plus a sine at times of any shape."""
    time = np.asarray(time, dtype=float)
    result = np.zeros(time.shape)
    if len(coefficients):
        piece = np.clip(np.searchsorted(breaks, time, side="right") - 1, 0, len(coefficients) - 1)
        since = time - breaks[piece]
        for power in range(DEGREE, derivative - 1, -1):
            factor = np.prod(np.arange(power - derivative + 1, power + 1))
            result = result * since + factor * coefficients[piece, power]
    amplitude, w, phase = sine
    return result + amplitude * w**derivative * np.sin(w * time + phase + derivative * pi / 2)


def times_at(sine: Sine, breaks: np.ndarray, coefficients: np.ndarray, levels: np.ndarray, until: float
             ) -> np.ndarray:
    """Return the times, in s, after 0 and before ``until`` at which a signal has one of the values ``levels``, sorted.

    A sine is that of a signal whose polynomials are constant.
    """
    found = [np.zeros(0)]
    if sine.amplitude:
        x = (np.asarray(levels) - coefficients[0, 0]) / sine.amplitude
        angle = np.arcsin(x[np.abs(x) <= 1])
        angles = np.concatenate([angle, pi - angle]) - sine.phase
        turns = 2 * pi * np.arange(-1, 2 + until * sine.angular_frequency / (2 * pi))
        found.append(((angles % (2 * pi))[:, None] + turns).ravel() / sine.angular_frequency)
    ends = np.concatenate([[-np.inf], breaks[1:-1], [np.inf]])
    for k, row in enumerate(coefficients):
        low, high = max(ends[k], 0.0), min(ends[k + 1], until)
        if low < high and row[1:].any():
            for level in levels:
                found.append(_roots(row, level, low - breaks[k], high - breaks[k]) + breaks[k])
    times = np.unique(np.concatenate(found))
    return times[(times > 0) & (times < until)]


def _roots(row: np.ndarray, level: float, low: float, high: float) -> np.ndarray:
    """Return the real places between ``low`` and ``high`` at which a polynomial, by ascending powers, has a value."""
    if np.isfinite(high):
        reach = np.abs(row[1:]) @ np.maximum(abs(low), abs(high)) ** np.arange(1, len(row))
        if abs(level - row[0]) > reach:
            return np.zeros(0)
    if not row[2:].any():
        roots = np.array([(level - row[0]) / row[1]])
    else:
        given = np.roots([*row[:0:-1], row[0] - level])
        roots = given.real[np.abs(given.imag) <= ROOT_TOLERANCE * np.abs(given)]
    slack = ROOT_TOLERANCE * (high - low) if np.isfinite(high) else 0.0
    return roots[(roots >= low - slack) & (roots <= high + slack)]


def presence_of(s: Signal, offset: float, length: float) -> tuple[np.ndarray, np.ndarray] | None:
    """Return when a place s + offset is in [0, length]: times, in s, and whether it is there from each of them on, the
    first time is 0; None of a sine that leaves it.
    """
    sine, (breaks, coefficients) = s.sine, s.pieces()
    if sine.amplitude:
        middle = coefficients[0, 0] + offset
        stays = not coefficients[:, 1:].any() and abs(sine.amplitude) <= min(middle, length - middle)
        return (np.zeros(1), np.ones(1, dtype=bool)) if stays else None
    levels = np.array([0.0, length]) - offset
    times = np.unique([*times_at(sine, breaks, coefficients, levels, np.inf), *breaks[breaks > 0]])
    starts = np.append(0.0, times)
    middle = np.append((starts[1:] + starts[:-1]) / 2, starts[-1] + 1.0)
    place, slack = value_at(sine, breaks, coefficients, middle) + offset, ROOT_TOLERANCE * length
    there = (place >= -slack) & (place <= length + slack)
    changes = np.append(True, there[1:] != there[:-1])
    return starts[changes], there[changes]


def _check_apart(times: Iterable[float]) -> None:
    """Raise ValueError where rounding does not separate two successive times (s)."""
    for one, other in itertools.pairwise(times):
        least = max(MIN_INTERVAL[0], MIN_INTERVAL[1] * max(abs(one), abs(other)))
        if not other - one >= least:
            raise ValueError(f"times must be {show(least, 's')} apart or more, got {other - one:.3g} s between "
                             f"{one!r} s and {other!r} s")


def check_switched(scale: "Signal", when: str | None, until: str | None) -> None:
    """Raise ValueError for the scale of what begins or ends with an event, if it is a sine, which has no ends."""
    if (when is not None or until is not None) and scale.sine.amplitude:
        raise ValueError("scale is a sine, which cannot begin or end with an event",
                         "take a TableSignal of its values")


class Constant(Signal):
    """A ``constant`` value, in a scene a plain number."""

    form = "constant"
    constant: Value

    def as_given(self) -> float:
        """Return the constant value itself."""
        return self.constant

    def pieces(self) -> tuple[np.ndarray, np.ndarray]:
        """Return its polynomials between breaks, see `Signal.pieces`."""
        return np.array([0.0, 1.0]), np.eye(1, DEGREE + 1) * self.constant


ONE = Constant.model_construct(constant=1.0)
"""The factor of one, made without a validation, whose schema is built when first used."""


class TableSignal(Signal):
    """Values at given times; before the first time and after the last one the value stays.

    time: s
    value: one for each time
    interpolation: "cubic" (a spline, twice continuously differentiable, not-a-knot) or "linear". A prescribed motion
        should be cubic: the rate of straight lines jumps
    """

    form = "table"
    time: Annotated[tuple[float, ...], list_of("s", least=2)]
    values: Annotated[tuple[float, ...], list_of("", least=2)] = Field(alias="value")
    interpolation: Annotated[str, one_of(("cubic", "linear"))] = "cubic"

    @model_validator(mode="after")
    def _is_a_function(self) -> "TableSignal":
        check_function(self.time, "time", "s", self.values, "value")
        _check_apart(self.time)
        return self

    def pieces(self) -> tuple[np.ndarray, np.ndarray]:
        """Return its polynomials between breaks, see `Signal.pieces`."""
        time, values = np.array(self.time), np.array(self.values)
        breaks = np.array([time[0] - 1, *time, time[-1] + 1])
        breaks[-2] = np.nextafter(time[-1], np.inf)  # a run that ends with the table ends on its slope
        coefficients = np.zeros((len(breaks) - 1, DEGREE + 1))
        coefficients[0, 0], coefficients[1:, 0] = values[0], values
        if self.interpolation == "linear":
            coefficients[1:-1, 1] = np.diff(values) / np.diff(time)
        else:
            from scipy.interpolate import CubicSpline  # would double the time of `import funicular`

            coefficients[1:-1, :4] = CubicSpline(time, values).c[::-1].T
        return breaks, coefficients


class _Steps(Signal):
    """Base of signals that rise and fall between constant values."""

    start: Time
    end: Time

    @model_validator(mode="after")
    def _takes_time(self) -> Self:
        if not self.start < self.end:
            raise ValueError(f"end must be after start {show(self.start, 's')}, got {show(self.end, 's')}")
        self._check_duration()
        _check_apart(self._steps[0])
        return self

    def _check_duration(self) -> None:
        """Raise ValueError where other times do not fit between start and end."""

    @property
    def _steps(self) -> tuple[list[float], list[float]]:
        """Return times in s, and the values at them."""
        raise NotImplementedError

    def pieces(self) -> tuple[np.ndarray, np.ndarray]:
        """Return smooth rises from value to value, constant before and after, see `Signal.pieces`."""
        times, values = self._steps
        breaks = np.array([times[0] - 1, *times, times[-1] + 1])
        coefficients = np.zeros((len(breaks) - 1, DEGREE + 1))
        coefficients[:, 0] = [values[0], *values]
        for k, (duration, change) in enumerate(zip(np.diff(times), np.diff(values), strict=True), start=1):
            coefficients[k] += change * _RISE / duration ** np.arange(DEGREE + 1)
        return breaks, coefficients


class Ramp(_Steps):
    """A rise between two times, without a jump of the second derivative.

    start, end: times, s
    before: value before
    after: value after

    >>> import funicular as fu
    >>> fu.Ramp(start=1.0, end=3.0, after=10.0).value([0.0, 2.0, 4.0]).tolist()
    [0.0, 5.0, 10.0]
    """

    form = "ramp"
    before: Value = 0.0
    after: Value = 1.0

    @property
    def _steps(self) -> tuple[list[float], list[float]]:
        return [self.start, self.end], [self.before, self.after]


class Pulse(_Steps):
    """A rise from 0 and a fall to 0.

    start, end: times, s
    rise: duration of the rise from start and of the fall to end, each as a `Ramp`, s; by default half of the pulse
    height: value between
    """

    form = "pulse"
    rise: Annotated[float, positive("s")] | None = None
    height: Value = 1.0

    def _check_duration(self) -> None:
        half = (self.end - self.start) / 2
        if self.rise is not None and self.rise > half * (1 + 1e-12):
            raise ValueError(f"rise must not exceed half of the pulse, {show(half, 's')}, got {show(self.rise, 's')}")

    @property
    def _steps(self) -> tuple[list[float], list[float]]:
        half = (self.end - self.start) / 2
        if self.rise is None or self.rise >= half * (1 - 1e-12):
            return [self.start, self.start + half, self.end], [0.0, self.height, 0.0]
        return ([self.start, self.start + self.rise, self.end - self.rise, self.end],
                [0.0, self.height, self.height, 0.0])


class Harmonic(Signal):
    """A sine: ``offset`` + ``amplitude`` sin(2π frequency t + phase).

    amplitude: of the sine
    frequency: Hz
    phase: rad
    offset: mean value
    """

    form = "harmonic"
    amplitude: Value
    frequency: Annotated[float, positive("Hz")]
    phase: Annotated[float, finite("rad")] = 0.0
    offset: Value = 0.0

    def pieces(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the constant polynomial, see `Signal.pieces`."""
        return Constant(constant=self.offset).pieces()

    @property
    def sine(self) -> Sine:
        """Return the sinusoidal part of the signal."""
        return Sine(self.amplitude, 2 * pi * self.frequency, self.phase)


class Integral(Signal):
    """The integral of ``rate`` over time, ``start`` at t = 0, exact in each piece; only in code."""

    form = "integral"
    rate: Signal
    start: Value = 0.0

    @model_validator(mode="after")
    def _fits(self) -> "Integral":
        if isinstance(self.rate, Integral):
            raise ValueError("rate is an integral: the degree of its integral is too high")
        return self

    def pieces(self) -> tuple[np.ndarray, np.ndarray]:
        """Return its polynomials between breaks, see `Signal.pieces`."""
        breaks, rates = self.rate.pieces()
        powers = np.arange(1, DEGREE + 1)
        coefficients = np.zeros(rates.shape)
        coefficients[:, 1:] = rates[:, :-1] / powers
        gains = np.sum(coefficients[:, 1:] * np.diff(breaks)[:, None] ** powers, axis=1)
        coefficients[1:, 0] = np.cumsum(gains)[:-1]
        first = int(np.clip(np.searchsorted(breaks, 0.0, side="right") - 1, 0, len(rates) - 1))
        at_zero = np.sum(coefficients[first] * (0.0 - breaks[first]) ** np.arange(DEGREE + 1))
        amplitude, _, phase = self.sine
        coefficients[:, 0] += self.start - at_zero - amplitude * np.sin(phase)
        return breaks, coefficients

    @property
    def sine(self) -> Sine:
        """Return the integral of the sine of the rate: a quarter of a period late."""
        amplitude, w, phase = self.rate.sine
        return Sine(amplitude / w if amplitude else 0.0, w, phase - pi / 2)

    @property
    def is_known(self) -> bool:
        """Return whether its rate is, see `Signal.is_known`."""
        return self.rate.is_known


class Switched(Signal):
    """Zero until the time ``begin``, s, from there ``signal`` by the time since then, and zero again from ``end`` on;
    begin None: always zero; -inf: ``signal`` by the time itself; end None: without an end; only in code.
    """

    form = "switched"
    signal: Signal
    begin: float | None = None
    end: float | None = None

    def pieces(self) -> tuple[np.ndarray, np.ndarray]:
        """Return its polynomials between breaks, see `Signal.pieces`."""
        if self.begin is None or (self.end is not None and self.end <= self.begin):
            return Constant(constant=0.0).pieces()
        breaks, coefficients = self.signal.pieces()
        if self.begin != -np.inf:
            first = int(np.clip(np.searchsorted(breaks, 0.0, side="right") - 1, 0, len(coefficients) - 1))
            at_begin = _shifted(coefficients[first : first + 1], -breaks[first : first + 1])
            later = breaks[first + 1 : -1]
            breaks = self.begin + np.array([-1.0, 0.0, *later, max([0.0, *later]) + 1.0])
            coefficients = np.concatenate([np.zeros((1, DEGREE + 1)), at_begin, coefficients[first + 1 :]])
        if self.end is not None:
            kept = max(int(np.searchsorted(breaks[:-1], self.end, side="left")), 1)
            first = min(breaks[0], self.end - 1.0)
            coefficients = np.concatenate([_shifted(coefficients[:1], np.array([first - breaks[0]])),
                                           coefficients[1:kept], np.zeros((1, DEGREE + 1))])
            breaks = np.array([first, *breaks[1:kept], self.end, self.end + 1.0])
        return breaks, coefficients


def switched(signal: Signal, when: str | None, until: str | None, happened: Mapping[str, float]) -> Signal:
    """Return a signal that begins and ends with events; happened: the first times of events, s."""
    if when is None and until is None:
        return signal
    return Switched(signal=signal, begin=-np.inf if when is None else happened.get(when),
                    end=None if until is None else happened.get(until))


class CombinedSignal(Signal):
    """The sum of ``factors`` times ``signals``, whose sines have one frequency; only in code."""

    form = "combined"
    signals: tuple[Signal, ...]
    factors: tuple[float, ...]

    def pieces(self) -> tuple[np.ndarray, np.ndarray]:
        """Return its polynomials between the breaks of all its signals, see `Signal.pieces`."""
        given = [(factor, *signal.pieces()) for factor, signal in zip(self.factors, self.signals, strict=True)]
        inner = [breaks for _, breaks, coefficients in given if len(coefficients) > 1]
        breaks = np.unique(np.concatenate(inner)) if inner else given[0][1]
        total = np.zeros((len(breaks) - 1, DEGREE + 1))
        middle = (breaks[1:] + breaks[:-1]) / 2
        for factor, own, coefficients in given:
            piece = np.clip(np.searchsorted(own, middle, side="right") - 1, 0, len(coefficients) - 1)
            total += factor * _shifted(coefficients[piece], breaks[:-1] - own[piece])
        return breaks, total

    @property
    def sine(self) -> Sine:
        """Return the sum of the sines, added as complex amplitudes."""
        sines = [(factor, signal.sine) for factor, signal in zip(self.factors, self.signals, strict=True)]
        total = sum((factor * sine.amplitude * cmath.exp(1j * sine.phase) for factor, sine in sines), 0j)
        return Sine(abs(total), next((sine.angular_frequency for _, sine in sines if sine.amplitude), 0.0),
                    cmath.phase(total))

    @property
    def is_known(self) -> bool:
        """Return whether all its signals are, see `Signal.is_known`."""
        return all(signal.is_known for signal in self.signals)


def _shifted(coefficients: np.ndarray, by: np.ndarray) -> np.ndarray:
    """Return the coefficients (n, 7) of polynomials of t as polynomials of t - by, by (n,)."""
    made = np.zeros(coefficients.shape)
    for power in range(DEGREE + 1):
        for lower in range(power + 1):
            made[:, lower] += coefficients[:, power] * comb(power, lower) * by ** (power - lower)
    return made


def combined(factors: Sequence[float], signals: Sequence[Signal]) -> Signal:
    """Return the sum of factors times signals in its simplest form: 0 where all terms cancel to rounding.

    Raises ValueError(cause) for sines of several frequencies.
    """
    if len({signal.sine.angular_frequency for signal in signals if signal.sine.amplitude}) > 1:
        raise ValueError("is a sum of sines of several frequencies along the axes of the plane")
    terms = [(f, s) for f, s in zip(factors, signals, strict=True) if f and s != Constant(constant=0.0)]
    constants = [factor * signal.constant for factor, signal in terms if isinstance(signal, Constant)]
    if len(constants) == len(terms):
        total = sum(constants)
        is_zero = abs(total) <= CANCELLATION_TOLERANCE * max(map(abs, constants), default=0.0)
        return Constant(constant=0.0 if is_zero else total)
    if len(terms) == 1 and terms[0][0] == 1.0:
        return terms[0][1]
    made = CombinedSignal(signals=tuple(s for _, s in terms), factors=tuple(f for f, _ in terms))
    return Constant(constant=0.0) if _vanishes(made) else made


def _vanishes(made: CombinedSignal) -> bool:
    """Return whether the terms of a sum cancel at all times to rounding."""
    if not made.is_known:
        return False
    breaks, total = made.pieces()
    terms = [abs(factor) * max(np.abs(signal.value(breaks)).max(), abs(signal.sine.amplitude))
             for factor, signal in zip(made.factors, made.signals, strict=True)]
    times = np.diff(breaks)[:, None] ** np.arange(DEGREE + 1)
    return bool(max(np.abs(total * times).max(), made.sine.amplitude) <= CANCELLATION_TOLERANCE * max(terms))


SIGNALS = Family("signal", "a number or a signal such as Ramp(start=0, end=1)", (TableSignal, Ramp, Harmonic, Pulse),
                 Signal)


def signal(value: Any) -> Signal:
    """Return the signal that a signal, a number or a table describes. Raises ValueError."""
    if isinstance(value, Real) and not isinstance(value, bool):
        return Constant.model_validate({"constant": value})
    made: Signal = SIGNALS.part(value)
    return made


def signals_of(part: Part) -> Iterator[tuple[str, Signal]]:
    """Yield the names and signals of a part and of the parts in it."""
    for name, value in part:
        for each in value if isinstance(value, tuple | list) else (value,):
            if isinstance(each, Signal):
                yield name, each
            elif isinstance(each, Part):
                yield from ((f"{name}.{inner}", signal) for inner, signal in signals_of(each))


AnySignal = Annotated[Signal, checked(signal, {"anyOf": [{"type": "number"}, SIGNALS.schema]})]


def extremes(made: Signal) -> tuple[float, float]:
    """Return bounds of a signal over all times: those of its polynomials, less and plus its sine's amplitude.

    What is 0 to rounding is 0.
    """
    breaks, coefficients = made.pieces()
    found = []
    for piece, length in zip(coefficients, np.diff(breaks), strict=True):
        turns = np.roots(np.polynomial.polynomial.polyder(piece)[::-1])
        inside = turns.real[(np.abs(turns.imag) <= TURN_TOLERANCE * length) & (turns.real > 0) & (turns.real < length)]
        values = np.polynomial.polynomial.polyval(np.array([0.0, *inside, length]), piece)
        rounding = CANCELLATION_TOLERANCE * np.abs(piece * length ** np.arange(len(piece))).max()
        found.append(np.where(np.abs(values) <= rounding, 0.0, values))
    values, amplitude = np.concatenate([*found, [0.0] * (not found)]), abs(made.sine.amplitude)
    return float(values.min() - amplitude), float(values.max() + amplitude)


def varying(limit: Check) -> Check:
    """Return the check of a number, kept as a number, or of a signal, at all times within the limit of another check.
    """
    def check(value: Any) -> float | Signal:
        if isinstance(value, Real) and not isinstance(value, bool):
            return limit.func(value)  # type: ignore[call-arg]  # a function of the value alone
        made = signal(value)
        if isinstance(made, Constant):
            return check(made.constant)
        try:
            limit.func(extremes(made)[0])  # type: ignore[call-arg]
        except ValueError as error:
            raise ValueError(f"{error.args[0]}, the least value of the signal", *error.args[1:]) from None
        return made

    return checked(check, {"anyOf": [limit.json_schema_input_type.schema, SIGNALS.schema]})


def at_start(value: "float | Signal") -> float:
    """Return a number, or the value of a signal at t = 0."""
    return float(value.value(0.0)) if isinstance(value, Signal) else value
