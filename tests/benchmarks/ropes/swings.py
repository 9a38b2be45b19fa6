"""Loads that swing on a massless inextensible rope over a frictionless or held circle: ordinary differential equations.

Coordinates in the plane: the foot, where the rope leaves the circle, is at the angle a from the x axis, and the load l
beyond it along the tangent: r = R (cos a, sin a) + l (sin a, -cos a). Its velocity is u along the rope, u = l' - R a',
and l a' across it. All by steps of order 8 at a relative tolerance of 1e-12.
"""

from __future__ import annotations

from math import acos, asin, atan2, cos, degrees, hypot, pi, sin, sqrt

import numpy as np
from scipy.integrate import solve_ivp

from .case import Case, numbers

GRAVITY = 9.81
TIGHT = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13}


def place(R: float, a: float, l: float) -> tuple[float, float]:
    """Return the load from the angle of the foot and the free length."""
    return R * cos(a) + l * sin(a), R * sin(a) - l * cos(a)


def atwood() -> tuple[float, ...]:
    """Load at 1, 2, 3 s, and wraps, of a load that swings on one side with a weight straight down on the other.

    Lagrange's equations of (M + m) u²/2 + m l² a'²/2 with u = l' - R a'; the weight rises by u. Energy is kept to
    1e-11 J.
    """
    R, M, m = 0.3, 5.5, 5.0

    def rates(t, y):
        s, a, u, w = y  # s = l - R a
        l = s + R * a
        return [u, w, (m * l * w**2 + m * GRAVITY * cos(a) - M * GRAVITY) / (M + m),
                -(2 * u * w + R * w**2 + GRAVITY * sin(a)) / l]

    times = (1.0, 2.0, 3.0)
    found = solve_ivp(rates, (0, times[-1]), [4 - R * 0.5, 0.5, 0, 0], t_eval=times, **TIGHT).y
    places = [x for s, a in zip(found[0], found[1], strict=True) for x in place(R, a, s + R * a)]
    return (*places, *(degrees(pi - a) for a in found[1]))


def hauled() -> tuple[float, ...]:
    """Angle at 2, 4, 5 s and tension of a pendulum whose rope is hauled in over the circle."""
    R, m, start = 0.25, 50.0, 8 - 0.25 * 0.15

    def haul(t):
        v = min(t / 0.5, 1.0)
        return v, (t**2 if t < 0.5 else t - 0.25), (2.0 if t < 0.5 else 0.0)

    def rates(t, y):
        v, run, _ = haul(t)
        l = start - run + R * y[0]
        return [y[1], -(-2 * v * y[1] + R * y[1] ** 2 + GRAVITY * sin(y[0])) / l]

    times = (2.0, 4.0, 5.0)
    first = solve_ivp(rates, (0, 0.5), [0.15, 0], **TIGHT)
    a, w = solve_ivp(rates, (0.5, times[-1]), first.y[:, -1], t_eval=times, **TIGHT).y
    length = [start - haul(t)[1] + R * x for t, x in zip(times, a, strict=True)]
    return (*a, *(m * (GRAVITY * np.cos(a) + np.array(length) * w**2)))


def on_the_line(R: float, r: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return foot, direction and free length of a rope off a groove about z, at z = 0, to a load at r (3).

    Clairaut: the foot at R/cos f, with the fleet angle f, and the direction e without a part along the foot's radius.
    With q = l cos f: q⁴ + (R² - x² - y²) q² + R² z² = 0.
    """
    square = r[0] ** 2 + r[1] ** 2
    q = np.sqrt(((square - R**2) + np.sqrt((square - R**2) ** 2 - 4 * R**2 * r[2] ** 2)) / 2)
    l = np.sqrt(q**2 + r[2] ** 2)
    p = R * l / q
    n = np.array([p * r[0] - q * r[1], p * r[1] + q * r[0]]) / square  # r = p n + q t, t = n turned clockwise
    foot = np.array([p * n[0], p * n[1], 0 * p])
    return foot, (r - foot) / l, l


def fleet() -> tuple[float, ...]:
    """Load at .5, 1, 1.5, 2 s, and wraps, of a load that swings out of the groove's plane, weight straight down.

    The gradient of the rope's length R phi + l by the load's place is the direction e, so m r'' = m g - T e, and the
    weight rises by e . r': M (e . r'' + e' . r') = T - M g, e' by a complex step. Energy is kept to 1e-10 J.
    """
    R, M, m = 0.3, 5.5, 5.0
    down = np.array([0.0, -GRAVITY, 0.0])

    def rates(t, y):
        r, v = y[:3], y[3:]
        e = on_the_line(R, r)[1]
        turning = on_the_line(R, r + 1e-30j * v)[1].imag / 1e-30
        tension = (GRAVITY + e @ down + turning @ v) / (1 / M + 1 / m)
        return [*v, *(down - tension / m * e)]

    times = (0.5, 1.0, 1.5, 2.0)
    found = solve_ivp(rates, (0, times[-1]), [1.8, -3.2, 0.12, 0, 0, 0.4], t_eval=times, **TIGHT).y[:3].T
    feet = [on_the_line(R, r)[0] for r in found]
    return (*found.ravel(), *(180 - degrees(atan2(foot[1], foot[0])) for foot in feet))


def fleet_at_rest() -> tuple[float, ...]:
    """Foot (angle and distance from the axis), fleet angle, and length of the rope from 180 deg, at rest: closed form.

    The load's place is given in whole micrometres, which leaves 6e-5 deg and 1e-6 m open: the published foot and length
    are off by 6e-6 deg and 1e-6 m, so that a bar of 1e-8 has to be taken from what this function returns.
    """
    R = 0.3
    r = np.array([0.809249, -0.495093, 0.126487])
    foot, e, l = on_the_line(R, r)
    angle = atan2(foot[1], foot[0])
    return degrees(angle), hypot(foot[0], foot[1]), degrees(acos(hypot(e[0], e[1]))), R * (pi - angle) + l


def peg() -> tuple[float, ...]:
    """Times at which the wrap returns, is lost and returns, and load at 1, 2, 4, 6 s: a pendulum meets a peg.

    Free: a pendulum of length L about the origin. Around the peg: the rope from the origin touches it first at the
    angle of the line at the return, and the foot moves along it. The load's velocity is across the line before and
    after, and continuous, so that the rate of its angle grows by L over the free length, and falls by it at the loss.
    """
    L, R, centre, start = 2.0, 0.1, (0.3, -1.0), -0.7
    away, between = hypot(*centre), atan2(centre[0], -centre[1])
    touched = between - asin(R / away)  # angle of the line, from straight down, at which it touches the peg's left side
    reach = sqrt(away**2 - R**2)  # from the origin to that point

    def swing(around):
        def rates(t, y):
            l = L - reach - R * (y[0] - touched) if around else L
            return [y[1], (R * y[1] ** 2 if around else 0.0) / l - GRAVITY * sin(y[0]) / l]
        return rates

    def meets(t, y):
        return y[0] - touched

    meets.terminal = True
    times, found, events = (1.0, 2.0, 4.0, 6.0), {}, []
    t, y, around = 0.0, [start, 0.0], False
    while t < times[-1]:
        meets.direction = -1 if around else 1
        run = solve_ivp(swing(around), (t, times[-1]), y, events=meets, dense_output=True, **TIGHT)
        for at in times:
            if t <= at <= run.t[-1]:
                a = run.sol(at)[0]
                l = L - reach - R * (a - touched)
                found[at] = ((centre[0] - R * cos(a) + l * sin(a), centre[1] - R * sin(a) - l * cos(a)) if around
                             else (L * sin(a), -L * cos(a)))
        (turned, rate), ratio = run.y[:, -1], L / (L - reach)
        t, y, around = run.t[-1], [turned, rate / ratio if around else rate * ratio], not around
        if run.status == 1:
            events.append(t)
    return (*events[:3], *(x for at in times for x in found[at]))


FLEET_PLACES = ("x at .5 s, y at .5 s, z at .5 s, x at 1 s, y at 1 s, z at 1 s, x at 1.5 s, y at 1.5 s, z at 1.5 s, "
                "x at 2 s, y at 2 s, z at 2 s", "m",
                "1.307986 -3.284786 0.258888 0.113846 -3.295445 0.214013 -0.928685 -3.010472 0.001239 "
                "-1.047408 -2.777202 -0.214354")
FLEET_WRAPS = numbers("wrap at .5 s, wrap at 1 s, wrap at 1.5 s, wrap at 2 s", "deg",
                      "163.1684 183.2525 202.6084 206.4800", 0.01, absolute=True)

CASES = [
    Case("swinging Atwood", "a load swings on a massless rope, counterweight straight down, frictionless",
         (*numbers("x at 1 s, y at 1 s, x at 2 s, y at 2 s, x at 3 s, y at 3 s", "m",
                   ".205949 -3.591360 -1.487701 -3.054866 .909086 -2.996471", 1e-4, absolute=True),
          *numbers("wrap at 1 s, wrap at 2 s, wrap at 3 s", "deg", "181.5 211.0 168.6", 1e-4)), atwood),
    Case("fleet angle", "the same out of the groove's plane",
         (*numbers(*FLEET_PLACES, 1e-4, absolute=True), *FLEET_WRAPS), fleet),
    Case("fleet angle with mass", "the same, of a rope of 1 g/m",
         (*numbers(*FLEET_PLACES, 1e-3, absolute=True), *FLEET_WRAPS), fleet),
    Case("fleet angle at rest", "a rope off the groove's plane, at rest",
         (*numbers("foot", "deg", "39.918838", 1e-8, uncertainty=6e-5),
          *numbers("foot from the axis", "m", ".302955", 1e-8), *numbers("fleet angle", "deg", "8.0087", 1e-8),
          *numbers("length", "m", "1.641327", 1e-8, uncertainty=1e-6)), fleet_at_rest),
    Case("peg", "a pendulum meets a peg",
         (*numbers("wrap returns, wrap is lost, wrap returns again", "s", ".862144 1.773524 3.497812", 1e-4),
          *numbers("x at 1 s, y at 1 s, x at 2 s, y at 2 s, x at 4 s, y at 4 s, x at 6 s, y at 6 s", "m",
                   ".729494 -1.821200 -.288229 -1.979122 1.000556 -1.537541 -.008924 -1.999980", 1e-4, absolute=True)),
         peg),
    Case("pendulum hauled in", "a rope is hauled in over a held circle while its load swings",
         (*numbers("angle at 2 s, angle at 4 s, angle at 5 s", "rad", "-.138155 .106832 .268046", 1e-3),
          *numbers("tension at 2 s, tension at 4 s, tension at 5 s", "N", "495.062 514.762 478.167", 1e-3)), hauled),
]
