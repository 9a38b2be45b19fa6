"""Derivatives of the structural law's strains half way, through the components of r_x there: chain rule by hand.

Stretch and shears are functions of these components alone, and they, with the curvatures, of the scalars: the mean
components in the nodes' frames and the Gibbs vector between these. Two steps cost less than one.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import sympy as sp

from ...codegen.program import DirectionalDerivative
from .structural import Configuration

ZERO = sp.S.Zero


class MidspanStrains:
    """V, the sum of resultants times strains half way, the resultants constant, and its derivatives by the scalars.

    strains (strains, scalars) and gradient (scalars) are named expressions.
    """

    def __init__(self, configuration: Configuration, resultants: Sequence[sp.Expr]):
        self.program, self.components = configuration.program, configuration.components
        self.scalars = [s for s in (*configuration.mean, *configuration.gibbs) if s.is_Symbol]
        constant, n = {r: ZERO for r in resultants if r.is_Symbol}, len(self.components)
        self.by_component, self.by_scalar = (
            [DirectionalDerivative(self.program, f"d_{s.name}", constant | dict.fromkeys(symbols, ZERO) | {s: sp.S.One})
             for s in symbols] for symbols in (self.components, self.scalars))
        along, curvature = configuration.middle[:n], configuration.middle[n:]
        by_component = self._named("d", _columns(self.by_component, along))
        self.turned = self._named("d", _columns(self.by_scalar, self.components))
        bent = self._named("d", _columns(self.by_scalar, curvature))
        self.strains = np.vstack([self._named("d", by_component.dot(self.turned)), bent])
        self.forces = self._named("F", np.array(resultants[:n]).dot(by_component))
        self.gradient = self._named("V", self.forces.dot(self.turned) + np.array(resultants[n:]).dot(bent))

    def _named(self, name: str, values: np.ndarray) -> np.ndarray:
        named = [self.program.define(f"{name}_{'_'.join(str(i + 1) for i in index)}", values[index])
                 for index in np.ndindex(*values.shape)]
        return np.array(named, dtype=object).reshape(values.shape)

    def hessian(self) -> np.ndarray:
        """Return the second derivatives of V by the scalars."""
        forces = self._symmetric("F", _columns(self.by_component, self.forces))
        moved = self._named("dF", forces.dot(self.turned))
        for by, rates in zip(self.by_scalar, moved.T, strict=True):
            by.known |= {f: rate for f, rate in zip(self.forces, rates, strict=True) if f.is_Symbol}
        return self._symmetric("V", _columns(self.by_scalar, self.gradient))

    def _symmetric(self, name: str, values: np.ndarray) -> np.ndarray:
        """Return the upper half, named, on both sides."""
        upper = self._named(name, np.triu(values))
        return np.asarray(upper + np.triu(upper, 1).T)


def _columns(derivations: Sequence[DirectionalDerivative], values: Sequence[sp.Expr] | np.ndarray) -> np.ndarray:
    return np.stack([by.array(np.array(values)) for by in derivations], axis=-1)
