"""Forces of the structural law: from the resultants of its strains to the nodal vectors, and rates of the strains."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import sympy as sp

from ...algebra.tangent_frame import spatial
from ...codegen.program import DirectionalDerivative
from .midspan_strains import MidspanStrains
from .structural import Configuration

ZERO = sp.S.Zero
Slot = tuple[str, int]  # "x" and a place, or "y", "z" and a node


class Velocity:
    """Rates of a configuration's parts and strains when the nodal vectors move with v."""

    def __init__(self, configuration: Configuration, v: np.ndarray):
        program, law = configuration.program, configuration.law
        program.stage("spins of the frames, rates of the strains")
        at = {name.partition("_")[2]: spatial(v[k]) for k, name in enumerate(law.element.names)}
        slopes = [at["x1"], spatial(configuration.half_way(v, "_rate")), at["x2"]]
        self.directors = [(at[f"y{n}"], at.get(f"z{n}", spatial([0, 0, 0]))) for n in (1, 2)]
        self.configuration, rates = configuration, dict.fromkeys(configuration.parts, ZERO)
        spins = [[program.define(f"spin{n + 1}_{k + 1}", s) for k, s in enumerate(frame.spin(*self.directors[n]))]
                 for n, frame in enumerate(configuration.frames)]
        speeds = [*(slope[j] for slope in slopes for j in law.axes), *(spin[k] for spin in spins for k in law.spins)]
        for speed, motion in zip(speeds, configuration.motions, strict=True):
            rates = {s: rates[s] + speed * motion[s] for s in rates}
        for frame, spin, directors in zip(configuration.frames, spins, self.directors, strict=True):
            rates |= {s: value for s, value in frame.rates(spin, *directors).items() if s not in rates}
        self.rate = DirectionalDerivative(program, "v", {s: program.define(f"v_{s.name}", r) for s, r in rates.items()})

    def strains(self) -> list[sp.Expr]:
        """Return the rates of the strains."""
        configuration, program = self.configuration, self.configuration.program
        n = len(configuration.strains) - 2 * len(configuration.law.across)
        found = [self.rate(s) for s in configuration.strains[:n]]
        for terms in across(configuration).values():
            found.append(sum((configuration.directors[n][j].dot(self.directors[n][i]) for n, i, j in terms), ZERO))
        return [program.define(f"rate_{name}", r) for name, r in zip(configuration.law.names, found, strict=True)]


def across(configuration: Configuration) -> dict[int, list[tuple[int, int, int]]]:
    """Return the strains of the section by index: their gradients by director i of a node are its director j, as (node,
    i, j).
    """
    law = configuration.law
    first = len(configuration.strains) - 2 * len(law.across)
    return {first + n * len(law.across) + p: [(n, a - 1, b - 1) for a, b in dict.fromkeys(((i, j), (j, i)))]
            for n in range(2) for p, (i, j) in enumerate(law.across)}


class Forces:
    """Generalised forces of resultants: on r_x at the three places, moments on the frames, forces on the directors.

    V is the sum of resultants times strains, the resultants constant: its derivatives by a motion of the parts are the
    forces.
    """

    def __init__(self, configuration: Configuration, resultants: Sequence[sp.Expr]):
        self.configuration, self.program, self.law = configuration, configuration.program, configuration.law
        self.resultants, n = resultants, len(self.law.axes)
        self.program.stage("forces on the parts")
        curvature = slice(3 * n, 3 * n + len(self.law.spins))
        self.midspan = MidspanStrains(configuration, [*resultants[n:2 * n], *resultants[curvature]])
        self.by_part = self._by_part()
        along = [sum((d * motion[s] for s, d in self.by_part.items()), ZERO) for motion in configuration.motions]
        self.slopes = [self.program.vector(f"f_x{tag}", along[place * n:(place + 1) * n])
                       for place, tag in enumerate("1m2")]
        self.moments = [np.array([self.program.define(f"moment{node + 1}_{k + 1}", along[configuration.turn(node, k)])
                                  if k in self.law.spins else ZERO for k in range(3)]) for node in range(2)]
        self.directors = [frame.forces(self.program, str(node + 1), self.moments[node])
                          for node, frame in enumerate(configuration.frames)]

    @property
    def constant_resultants(self) -> dict[sp.Symbol, sp.Expr]:
        """Return the resultants, which V does not differentiate."""
        return {r: ZERO for r in self.resultants if r.is_Symbol}

    def _by_part(self) -> dict[sp.Symbol, sp.Expr]:
        """Return dV by each scalar part."""
        configuration, n = self.configuration, len(self.law.axes)
        by_scalar = dict(zip(self.midspan.scalars, self.midspan.gradient, strict=True))
        values: dict[sp.Symbol, sp.Expr] = {}
        for i in self.law.axes:
            values |= {configuration.along[node][i]: self.resultants[2 * n * node + i] for node in range(2)}
            values |= {p[i]: by_scalar[configuration.mean[i]] / 2 for p in configuration.between}
        return values | {g: by_scalar[g] for g in configuration.gibbs if g.is_Symbol}

    def nodal(self) -> np.ndarray:
        """Return forces on the nodal vectors."""
        own = {("x", 0): self.slopes[0], ("x", 1): self.slopes[1], ("x", 2): self.slopes[2]}
        own |= {(name, n): force for n, forces in enumerate(self.directors)
                for name, force in zip("yz", forces, strict=True)}
        for index, terms in across(self.configuration).items():
            for node, i, j in terms:
                gradient = self.configuration.directors[node][j]
                own["yz"[i], node] = own["yz"[i], node] + self.resultants[index] * gradient
        self.program.stage("forces on the nodal vectors")
        element = self.law.element
        f = np.array([self.program.vector(f"f_{name}", sum(c * spatial(own[slot]) for slot, c in terms)[: element.dim])
                      for name, terms in zip(element.names, self.slots, strict=True)])
        f[0] = -sum(f[k] for k, position in enumerate(element.is_position) if position and k)
        return f

    @property
    def slots(self) -> list[list[tuple[Slot, sp.Expr]]]:
        """Return what each nodal vector moves: r_x at a place, or a director of a node; and how much."""
        found = []
        for k, name in enumerate(self.law.element.names):
            vector, node = name.partition("_")[2][:-1], int(name[-1]) - 1
            scale = self.configuration.w if not vector else 1
            terms = [] if vector in ("y", "z") else [(("x", 1), self.law.half_way[k] * scale)]
            found.append([*terms, *([((vector, 2 * node if vector == "x" else node), sp.S.One)] if vector else [])])
        return found
