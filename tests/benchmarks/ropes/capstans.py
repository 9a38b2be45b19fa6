"""Ropes that slide, or are about to, on held cylinders: Eytelwein's equation, with weight and with speed."""

from __future__ import annotations

from math import exp, pi, sqrt

from .case import Case, numbers


def capstans() -> tuple[float, ...]:
    """Ratio of the tensions, e^(mu theta)."""
    return tuple(exp(mu * theta) for mu, theta in ((0.1, pi), (0.3, pi), (0.3, 3 * pi)))


def moving_capstan() -> tuple[float, ...]:
    """Tight side at rest of speed and in acceleration, and the speed at which the slack side leaves the wrap.

    P = T - rho v² presses, so P' = mu P + rho R a over the angle: P = (P0 + rho R a/mu) e^(mu theta) - rho R a/mu. The
    friction opposes the motion, which is towards the tight side.
    """
    mu, theta, R, rho, slack, v = 0.3, 2 * pi, 0.1, 0.5, 30.0, 6.0

    def tight(a: float) -> float:
        drag = rho * R * a / mu
        return (slack - rho * v**2 + drag) * exp(mu * theta) - drag + rho * v**2

    return tight(0.0), tight(15.0), sqrt(slack / rho)


def held_cylinder() -> tuple[float, ...]:
    """Longest heavy side that mu = .1 and .3 hold: a heavy rope over a horizontal cylinder, at rest.

    T/(rho g) = t obeys t' = R cos(phi) + mu (t + R sin(phi)) over the angle phi from the foot of the light side, t(0)
    its length. Solution: t = A e^(mu phi) + C sin(phi) + D cos(phi), C = R (1 - mu²)/(1 + mu²), D = -2 mu R/(1 + mu²).
    """
    R, light = 0.051, 0.15
    return tuple((light + 2 * mu * R / (1 + mu**2)) * exp(mu * pi) + 2 * mu * R / (1 + mu**2) for mu in (0.1, 0.3))


CASES = [
    Case("capstan", "tight over slack side of a capstan: .1 over pi, .3 over pi, .3 over 3 pi",
         numbers("mu .1 over pi, mu .3 over pi, mu .3 over 3 pi", "1", "1.369108 2.566332 16.90202", 1e-5), capstans),
    Case("moving capstan", "a rope slides over a capstan at 6 m/s",
         (*numbers("tight side, tight side in acceleration", "N", "97.03274 110.99790", 1e-4),
          *numbers("wrap lost above", "m/s", "7.745967", 1e-4)), moving_capstan),
    Case("held cylinder", "a heavy rope over a held cylinder, at rest",
         numbers("mu .1 holds to, mu .3 holds to", "m", ".22929 .48507", 1e-3), held_cylinder),
]
