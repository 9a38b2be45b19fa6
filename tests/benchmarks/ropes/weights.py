"""Weights on ropes over sheaves that move straight up and down, and loops at a steady state: closed forms."""

from __future__ import annotations

from math import cosh, log, pi, sinh, sqrt

from scipy.optimize import brentq

from .case import Case, numbers

GRAVITY = 9.81


def two_weights() -> tuple[float, ...]:
    """Acceleration, tensions, least friction that sticks, and acceleration without friction: Newton's second law."""
    m1, m2, R, inertia = 1.0, 1.2, 0.22, 0.90
    a = (m2 - m1) * GRAVITY / (m1 + m2 + inertia / R**2)
    light, heavy = m1 * (GRAVITY + a), m2 * (GRAVITY - a)
    return a, light, heavy, log(heavy / light) / pi, (m2 - m1) * GRAVITY / (m1 + m2)


def heavy_rope() -> tuple[float, ...]:
    """Way at 1 and 2 s, tensions beside the sheave and the force on it at 2 s, from rest with 5 m on each side.

    (m1 + m2 + rho L + I/R²) x'' = (m2 - m1) g + 2 rho g x, L with the arc. The force on the sheave is the one upwards
    that holds it: what the two sides and the arc weigh, less 2 rho x'² by which the arc turns momentum round. (The arc
    has the horizontal momentum 2 R rho x' besides, which needs 2 R rho x'' sideways.)
    """
    m1, m2, rho, R, inertia, side = 2.0, 2.5, 0.5, 0.2, 0.1, 5.0
    mass = m1 + m2 + rho * (2 * side + pi * R) + inertia / R**2
    rate, level = sqrt(2 * rho * GRAVITY / mass), (m2 - m1) / (2 * rho)
    x1, x2 = level * (cosh(rate) - 1), level * (cosh(2 * rate) - 1)
    v, a = level * rate * sinh(2 * rate), level * rate**2 * cosh(2 * rate)
    up, down = (m1 + rho * (side - x2)) * (GRAVITY + a), (m2 + rho * (side + x2)) * (GRAVITY - a)
    return x1, x2, up, down, up + down + rho * pi * R * GRAVITY - 2 * rho * v**2


def free_rope() -> tuple[float, ...]:
    """Rate of the growth, and when, where and on which side (-1: the light one) a rope without weights leaves its wrap.

    x'' = g x/l of the whole rope of length 2 l = 2 m. The groove presses with P/R and a part of the weight,
    P = T - rho x'² at the foot; T/rho is (side - x) (g + x'') on the light side.
    """
    R, start, length = 0.1, 0.04, 2.0
    rate = sqrt(2 * GRAVITY / length)
    side = (length - pi * R) / 2

    def pressure(x: float, sense: int) -> float:
        return (side + sense * x) * (GRAVITY - sense * rate**2 * x) - rate**2 * (x**2 - start**2)

    lost = {sense: brentq(pressure, start, side, args=(sense,)) for sense in (-1, 1)
            if pressure(start, sense) * pressure(side, sense) < 0}
    sense = min(lost, key=lost.get)
    x = lost[sense]
    return rate, float(_arcosh(x / start) / rate), x, sense


def _arcosh(x: float) -> float:
    return log(x + sqrt(x**2 - 1))


def tackle() -> tuple[float, ...]:
    """Acceleration of the load and tensions (haul, fall from the fixed sheave, fall to the anchor): two falls.

    The haul moves at 2 a, turns the fixed sheave at 2 a/R and the one of the block at a/R.
    """
    M, m, J, R = 400.0, 230.0, 0.08, 0.12
    a = (2 * m - M) * GRAVITY / (4 * m + M + 5 * J / R**2)
    haul = m * (GRAVITY - 2 * a)
    fall = haul - 2 * J * a / R**2
    return a, haul, fall - J * a / R**2, fall


def ropeway() -> tuple[float, ...]:
    """Tensions at the drive and its torque: loop of a ropeway with cars up and down, steady and straight.

    At the drive above each side has half of the tension weight, the rope's weight over the height, and its cars with
    the resistance across the slope, which the side that goes up adds and the other one takes off. S is the length of
    the slope. Resistance counts cars alone.
    """
    H, S, rho, R, weight, resistance = 300.0, 1000.0, 6.0, 2.0, 80e3, 0.02
    slope, level = H / S, sqrt(1 - (H / S) ** 2)
    both = weight / 2 + rho * GRAVITY * H
    tight = both + 4 * 800 * GRAVITY * (slope + resistance * level)
    slack = both + 4 * 400 * GRAVITY * (slope - resistance * level)
    return tight, slack, (tight - slack) * R


CASES = [
    Case("two weights", "two weights on a massless rope over a sheave",
         (*numbers("acceleration", "m/s²", ".0943494", 1e-5), *numbers("light side, heavy side", "N",
          "9.90435 11.65878", 1e-5), *numbers("least friction", "1", ".0519118", 1e-5),
          *numbers("acceleration without friction", "m/s²", ".8918182", 1e-5)), two_weights),
    Case("heavy rope", "two weights on a heavy rope over a sheave",
         (*numbers("way at 1 s, way at 2 s", "m", ".212739 1.031986", 1e-4),
          *numbers("light side, heavy side, force on the sheave", "N", "43.94538 47.37991 92.73664", 1e-4)),
         heavy_rope),
    Case("free rope", "a rope slides off a frictionless held sheave",
         (*numbers("rate", "1/s", "3.132092", 1e-4), *numbers("wrap lost at", "s", "1.091759", 1e-4),
          *numbers("way", "m", ".611731", 1e-4), *numbers("side", "1", "-1", 0.0)), free_rope),
    Case("tackle", "tackle of two falls",
         (*numbers("acceleration", "m/s²", ".436719", 1e-5),
          *numbers("haul, fall to the anchor, fall from the fixed sheave", "N", "2055.4093 2048.1307 2050.5569", 1e-5)),
         tackle),
    Case("ropeway", "loop of a ropeway, steady",
         (*numbers("tight, slack", "N", "67674.52 62067.34", 1e-3), *numbers("torque", "N m", "11214.36", 1e-3)),
         ropeway),
]
