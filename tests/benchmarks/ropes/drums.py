"""A drum winds and pays out a heavy elastic rope with a load: the equation of waves on the rope that is out.

Out are the stress-free coordinates S from s (in store) to the end. With xi = (S - s)/l, l their length, the fields
x (place below the run-on point) and v (velocity of the material) over 0 <= xi <= 1 obey, at fixed xi,
x' = v + s' (1 - xi)/l x_xi and rho v' = rho s' (1 - xi)/l v_xi + T_xi/l + rho g, T = EA (lambda - 1 + damping lambda'),
lambda = x_xi/l, with x = 0 at the run-on point and the load at the other end. Winding takes up s' = V/lambda at the
run-on point, of the rim's speed V; what is paid out has the stretch that it was wound with: s' = V/lambda(s) of the
store. The material at the run-on point then moves at -s' lambda of the side that is out (it creeps).
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from .case import Case, numbers

GRAVITY = 9.81
EA, DENSITY, LOAD, DAMPING, STORE, OUT = 1e6, 0.8, 500.0, 5e-3, 12.0, 20.0
CORNERS = ((0.0, 0.5), (0.5, 4.0), (4.0, 4.5), (4.5, 5.0), (5.0, 8.0))
"""Between them the rim's speed is smooth; it changes its sign at 4.5 s."""


def rim(t: float) -> float:
    """Return the speed at which the rim winds, m/s."""
    return float(np.interp(t, (0, 0.5, 4, 5), (0, 1, 1, -1)))


def chebyshev(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Return n + 1 points from 0 to 1 and the matrix of derivatives of the polynomial through values there."""
    x = np.cos(np.pi / n * np.arange(n + 1))
    weights = np.r_[2, np.ones(n - 1), 2] * (-1.0) ** np.arange(n + 1)
    D = np.outer(weights, 1 / weights) / (x[:, None] - x + np.eye(n + 1))
    return (1 - x) / 2, -2 * (D - np.diag(D.sum(1)))



def wind(n: int = 10, tol: float = 1e-8) -> tuple[float, ...]:
    """Load below the run-on point, and growth of the store, at 2, 4, 6, 8 s, by polynomials of degree n.

    n = 8 to 24 with tolerances of 1e-7 to 1e-9 differ by less than 1e-6 m.
    """
    heavy, light = 1 + LOAD * GRAVITY / EA, DENSITY * GRAVITY / EA  # stretch above the load, its growth over a metre
    out = brentq(lambda l: l * heavy + light * l**2 / 2 - OUT, OUT / 2, OUT)
    xi, D = chebyshev(n)
    wound = None  # stretch over s, where the drum has wound; what was there before has that of the first instant

    def stretch(y):
        return D @ np.r_[0, y[1:n + 1]] / (STORE + out - y[0])

    def rates(t, y):
        length, V, lam = STORE + out - y[0], rim(t), stretch(y)
        taken = V / (lam[0] if V >= 0 or wound is None else wound(max(y[0], STORE)))
        v = np.r_[-taken * lam[0], y[n + 1:]]
        tension = EA * (lam - 1 + DAMPING * D @ v / length)
        flow = taken * (1 - xi) / length
        acceleration = flow * (D @ v) + D @ tension / (length * DENSITY) + GRAVITY
        acceleration[-1] = GRAVITY - tension[-1] / LOAD
        return np.r_[taken, (v + flow * lam * length)[1:], acceleration[1:]]

    S = xi * out
    y = np.r_[STORE, (S * heavy + light * (out * S - S**2 / 2))[1:], np.zeros(n)]
    loads, stores, s, profile = [], [], [STORE], [stretch(y)[0]]
    for start, end in CORNERS:
        run = solve_ivp(rates, (start, end), y, method="Radau", rtol=tol, atol=tol * 1e-2, dense_output=True)
        y = run.y[:, -1]
        for t in (2.0, 4.0, 6.0, 8.0):
            if start < t <= end:
                loads.append(run.sol(t)[n])
                stores.append(run.sol(t)[0] - STORE)
        if end <= 4.5:
            states = run.sol(np.linspace(start, end, 400)[1:]).T
            s, profile = s + [each[0] for each in states], profile + [stretch(each)[0] for each in states]
        if end == 4.5:
            wound = PchipInterpolator(s, profile, extrapolate=True)
    return (*loads, *stores)


CASES = [
    Case("drum", "a drum winds a heavy elastic rope and pays it out",
         (*numbers("load at 2 s, load at 4 s, load at 6 s, load at 8 s", "m", "18.2374 16.2577 17.2388 19.2477", 1e-3,
                   absolute=True),
          *numbers("store at 2 s, store at 4 s, store at 6 s, store at 8 s", "m", "1.74096 3.7309 2.73585 .74599", 1e-3,
                   absolute=True)), wind),
]
