"""A belt that drives one pulley by another, steady: string with stretch, and with its own inertia."""

from __future__ import annotations

from math import degrees, log, pi

from scipy.optimize import fsolve

from .case import Case, numbers

EA, DENSITY, LENGTH = 7600.0, 0.872421, 1.1938052  # of the stress-free belt
EI = 1.3333e-3
"""Bending is left out: EI/R² = .13 N is 2e-4 of the tight side's tension, 7e-4 of the slack one's."""
R, SPAN, FRICTION, DRIVER, DAMPER, LOAD = 0.1, 0.1 * pi, 0.5, 12.0, 2.0, 25.0


def steady() -> tuple[float, ...]:
    """Tensions, speed of the driven pulley, slip arc (of 180 deg) and torque at the steady state: two equations.

    The same stress-free length c passes everywhere in a second, so that speeds are v = c lambda. A pulley sticks where
    the belt arrives, driver and driven pulley at the speeds of the tight and slack sides, and slips over the same arc
    before it leaves. P = T - rho0 c² lambda presses: P grows by e^(mu theta) over the slip arc, and torques are
    R (P_t - P_s). Unknown are the stretches of both sides, from the torque and from the stress-free length, which on
    the slip arcs is the integral of R dP/(mu P lambda), lambda = (P + EA)/(EA - rho0 c²).
    """
    def state(stretches):
        tight, slack = stretches
        c = DRIVER * R / tight
        flux = DENSITY * c**2
        P = [EA * (stretch - 1) - flux * stretch for stretch in (tight, slack)]
        arc = log(P[0] / P[1]) / FRICTION
        slipping = R * (EA - flux) / (FRICTION * EA) * log(P[0] / (P[0] + EA) * (P[1] + EA) / P[1])
        length = (SPAN + R * (pi - arc)) * (1 / tight + 1 / slack) + 2 * slipping
        return length, R * (P[0] - P[1]), c * slack / R, arc

    def gaps(stretches):
        length, torque, speed, _ = state(stretches)
        return length / LENGTH - 1, torque / (LOAD + DAMPER * speed) - 1

    tight, slack = fsolve(gaps, [1.08, 1.02], xtol=1e-13)
    _, torque, speed, arc = state((tight, slack))
    return EA * (tight - 1), EA * (slack - 1), speed, degrees(arc), torque


CASES = [
    Case("belt", "a belt drives a loaded pulley, steady",
         (*numbers("tight, slack", "N", "663.170 186.936", 1e-3), *numbers("driven", "rad/s", "11.30840", 1e-4),
          *numbers("slip arc", "deg", "145.573", 1e-3), *numbers("torque", "N m", "47.61680", 1e-3)), steady),
]
