"""The elastic catenary (H. M. Irvine, Cable Structures, MIT Press 1981, section 1.4): forces at the ends of a cable."""

import numpy as np
from scipy.optimize import fsolve


def end_forces(span: float, rise: float, length: float, weight: float, axial: float) -> tuple[float, float]:
    """Return the horizontal force, and the upward force of the support at the start, N.

    span, rise: of the end relative to the start, m. length: unstretched, m. weight: N/m. axial: EA in N.
    """
    def gaps(unknown):
        H, V = np.exp(unknown[0]), unknown[1]
        U = V - weight * length
        along = H * length / axial + H / weight * (np.arcsinh(V / H) - np.arcsinh(U / H))
        down = length / axial * (V + U) / 2 + H / weight * (np.hypot(1, V / H) - np.hypot(1, U / H))
        return along - span, down + rise

    chord = np.hypot(span, rise)
    sag = np.sqrt(max(3 / 8 * chord * (length - chord), 1e-4 * chord))
    H = weight * span**2 / (8 * sag)
    logarithm, V = fsolve(gaps, [np.log(H), weight * length / 2 - H * rise / span], xtol=1e-13)
    return float(np.exp(logarithm)), float(V)
