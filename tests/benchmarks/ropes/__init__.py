"""Reference solutions of ropes that run over sheaves and drums, by numpy and scipy alone.

Each case has published numbers, the bar that a run of a rope is to keep, and an independent solution, which can be
refined: `Case.reference`. motion/test_rope_references.py compares the two.
"""

from . import belts, capstans, chains, drums, elevators, swings, waves, weights
from .case import Case, Quantity

CASES: list[Case] = [*weights.CASES, *swings.CASES, *chains.CASES, *capstans.CASES, *drums.CASES,
                     *belts.CASES, *elevators.CASES, *waves.CASES]

__all__ = ["CASES", "Case", "Quantity"]
