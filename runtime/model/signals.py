"""Models of the signals of a scene."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from ..base.deferred import dataclass
from ..parts.signal import DEGREE, Constant, Signal, Sine, switched, times_at, value_at


@dataclass
class SignalModel:
    """f(t) = polynomial piece of t - break + amplitude sin(angular_frequency t + phase); of: the signal of a scene."""

    breaks: np.ndarray
    coefficients: np.ndarray
    amplitude: float
    angular_frequency: float
    phase: float
    of: Signal | None = None

    def value(self, time: np.ndarray, derivative: int = 0) -> np.ndarray:
        """Return the signal, or a derivative of it, at the times ``time``, s."""
        sine = Sine(self.amplitude, self.angular_frequency, self.phase)
        return value_at(sine, self.breaks, self.coefficients, time, derivative)

    def times_at(self, levels: np.ndarray, until: float) -> np.ndarray:
        """Return the times, in s, between 0 and ``until`` at which the signal has one of these values, sorted."""
        sine = Sine(self.amplitude, self.angular_frequency, self.phase)
        return times_at(sine, self.breaks, self.coefficients, levels, until)

    def at(self, time: float) -> float:
        """Return the signal at a time in s."""
        return float(self.value(np.asarray(time)))


class Signals(list[SignalModel]):
    """The signals of a model; couplings know them by their numbers.

    switched: the numbers of signals that begin or end with events, the signals, and the names of both events;
    happened: the first times of events, s.
    """

    def __init__(self, signals: Iterable[SignalModel] = ()):
        super().__init__(signals)
        self.switched: list[tuple[int, Signal, str | None, str | None]] = []
        self.happened: dict[str, float] = {}

    def add(self, signal: Signal | None) -> int:
        """Store a signal and return its number, -1 for none."""
        if signal is None:
            return -1
        self.append(_model(signal))
        return len(self) - 1

    def switch(self, event: str, time: float) -> bool:
        """Begin and end signals at the first time of an event, s; return whether there are any."""
        if event in self.happened:
            return False
        self.happened[event] = time
        waiting = [each for each in self.switched if event in each[2:]]
        self._renew(waiting)
        return bool(waiting)

    def return_to(self, happened: Mapping[str, float]) -> None:
        """Return to the times of events that had happened, s."""
        self.happened = dict(happened)
        self._renew(self.switched)

    def _renew(self, changed: Iterable[tuple[int, Signal, str | None, str | None]]) -> None:
        for number, signal, when, until in changed:
            self[number] = _model(switched(signal, when, until, self.happened))

    def add_steps(self, times: np.ndarray, values: np.ndarray) -> int:
        """Store a signal that has each value from its time on and return its number, -1 for one that is always one."""
        if np.all(values == 1):
            return -1
        coefficients = np.zeros((len(times), DEGREE + 1))
        coefficients[:, 0] = values
        self.append(SignalModel(np.append(times, times[-1] + 1.0), coefficients, *Sine()))
        return len(self) - 1

    def scale(self, signal: Signal, when: str | None = None, until: str | None = None) -> tuple[int, float]:
        """Return the number and the constant factor of a scale; when, until: names of events that it begins and ends
        with.
        """
        if when is not None or until is not None:
            number = self.add(switched(signal, when, until, {}))
            self.switched.append((number, signal, when, until))
            return number, 1.0
        return (-1, float(signal.value(0.0))) if isinstance(signal, Constant) else (self.add(signal), 1.0)


def _model(signal: Signal) -> SignalModel:
    breaks, coefficients = signal.pieces()
    return SignalModel(np.asarray(breaks, dtype=float), np.asarray(coefficients, dtype=float), *signal.sine, signal)
