"""Section forces: bars in tension, arcs in bending, and balance with loads at the end of a cable."""

import numpy as np
import pytest
from funicular.derive.elements import ELEMENTS
from funicular.derive.verify.samples.shapes import reference, rotation, section
from funicular.generated import kernels
from funicular.model.constants import element_constants
from test_elements import CABLES, LAWS, arc, at_rest, cable_stiffness, force_of_strain

E, SIDE = 1e6, 0.1
MOMENTS = section(SIDE, SIDE)


def stiffness(name: str, law: str) -> np.ndarray:
    """Return S of a square section of a material with Young's modulus E and no lateral contraction."""
    if law == "structural":
        EA, GA, EI = E * SIDE**2, E * SIDE**2 / 2, E * SIDE**4 / 12
        return np.array([EA, GA, GA, EI, EI, EI, EA, EA, GA, 0.0] if ELEMENTS[name].dim == 3 else [EA, GA, EI, EA])
    if law.startswith("continuum"):
        dim = ELEMENTS[name].dim
        pairs = dim * (dim - 1) // 2
        return np.outer(E * np.concatenate([np.ones(dim), np.zeros(pairs), np.full(pairs, 0.5)]), MOMENTS)
    return cable_stiffness(law, *E * MOMENTS[:2])


def kernel(*name: str):
    return getattr(kernels, "_".join(name))


@pytest.mark.parametrize(("name", "law"), LAWS)
@pytest.mark.parametrize("stretch", [-0.1, 1e-6, 0.2])
def test_a_bar_in_tension(name, law, stretch):
    """N = E A strain along the bar, times its stretch with Green's strain; other components are zero."""
    element = ELEMENTS[name]
    F = np.eye(element.dim)
    F[0, 0] += stretch
    turn = rotation(np.random.default_rng(3), element.dim)
    e = reference(element, 0.8) @ (turn @ F).T
    forces = kernel(name, law, "section_forces")
    force, moment, axes, strain = forces(0.8, 0.3, e, stiffness(name, law), *at_rest(name, law, 0.8))
    t = np.zeros(3)
    t[: element.dim] = turn[:, 0]
    engineering = law.startswith(("engineering", "structural"))
    expected = stretch if engineering else stretch + stretch**2 / 2
    N = E * SIDE**2 * force_of_strain(law, expected) * (1 if engineering else 1 + stretch)
    np.testing.assert_allclose(force, N * t, atol=1e-11)
    np.testing.assert_allclose(moment, 0, atol=1e-11)
    np.testing.assert_allclose(axes[0], t, atol=1e-15)
    np.testing.assert_allclose(strain, [expected, 0, 0, 0, 0, 0], atol=1e-14)


@pytest.mark.parametrize(("name", "law"), CABLES)
def test_an_arc_in_bending(name, law):
    """M = E I kappa about the normal of the arc's plane, up to interpolation."""
    l = 0.2
    e = arc(ELEMENTS[name], l)
    _, moment, _, strain = kernel(name, law, "section_forces")(l, l / 2, e, stiffness(name, law))
    np.testing.assert_allclose(strain[3:], [0, 0, 1], rtol=2e-3)
    np.testing.assert_allclose(moment, [0, 0, E * SIDE**4 / 12], rtol=2e-3)


class Cantilever:
    """A clamped cantilever of length 1 with a dead load at its end, solved by Newton's method on the kernels alone."""

    def __init__(self, name: str, law: str, n: int, load: np.ndarray):
        self.element, self.law, self.family, self.l, self.n = ELEMENTS[name], law, f"{name}_{law}", 1 / n, n
        self.S, self.load = stiffness(name, law), load[: self.element.dim]
        self.at_rest = at_rest(name, law, self.l)
        per_node, dim = len(self.element.nodal_vectors), self.element.dim
        self.size = 2 * per_node * dim
        self.step = per_node * dim
        one = reference(self.element, self.l).reshape(2, per_node, dim)
        nodes = np.repeat(one[:1], n + 1, axis=0)
        nodes[:, 0, 0] = np.linspace(0, 1, n + 1)
        self.q = nodes.ravel()
        # clamped: all but the length of r_x and the free part of r_xx
        free = [v == "r_xx" for v in self.element.nodal_vectors for _ in range(dim)]
        free[dim] = True
        self.free = np.concatenate([free, np.ones(n * self.step, dtype=bool)])
        self.solve()

    def elements(self):
        return [slice(k * self.step, k * self.step + self.size) for k in range(self.n)]

    def solve(self):
        A = element_constants(None, self.element.name, self.law, self.l, self.S, *self.at_rest)
        force, tangent = kernel(self.family, "elastic_force"), kernel(self.family, "elastic_tangent")
        for part in np.linspace(0.1, 1, 10):
            for _ in range(30):
                f, K = np.zeros(len(self.q)), np.zeros((len(self.q), len(self.q)))
                for s in self.elements():
                    e = self.q[s].reshape(-1, self.element.dim)
                    f[s] += force(self.l, e, A).ravel()
                    K[s, s] += tangent(self.l, e, A)
                last = len(self.q) - self.step
                f[last : last + self.element.dim] -= part * self.load
                change = np.linalg.solve(K[np.ix_(self.free, self.free)], -f[self.free])
                self.q[self.free] += change
                if np.abs(change).max() < 1e-10:
                    break
            else:
                raise AssertionError("no equilibrium")

    def worst(self) -> tuple[float, float]:
        """Return errors of force and moment at element middles of the free half, relative to the load and its lever.

        Within a depth or two of the clamp, which prevents lateral strain, a solid section has another stress.
        """
        forces = kernel(self.family, "section_forces")
        position = kernel(self.element.name, "position")
        load, end = np.zeros(3), np.zeros(3)
        load[: self.element.dim] = self.load
        last = len(self.q) - self.step
        end[: self.element.dim] = self.q[last : last + self.element.dim]
        errors = []
        for s in self.elements()[self.n // 2 :]:
            e = self.q[s].reshape(-1, self.element.dim)
            force, moment, *_ = forces(self.l, self.l / 2, e, self.S, *self.at_rest)
            arm = end.copy()
            arm[: self.element.dim] -= position(self.l, (self.l / 2, 0, 0), e)[1]
            errors.append((np.abs(force - load).max(), np.abs(moment - np.cross(arm, load)).max()))
        return tuple(np.max(errors, axis=0) / np.linalg.norm(load))


@pytest.mark.parametrize(("name", "law"), LAWS)
def test_the_resultants_balance_a_load_on_the_end(name, law):
    """P L^2/(E I) about 1, out of the section's planes: errors of the second order in the element's length at least."""
    load = E * SIDE**4 / 12 * np.array([0.3, -1.0, 0.6])
    coarse, fine = (Cantilever(name, law, n, load).worst() for n in (4, 8))
    assert max(fine) < 0.01
    for far, near in zip(coarse, fine, strict=True):
        assert near < max(far / 3, 1e-4)
