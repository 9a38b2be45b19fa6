"""The structural law against published statics (CASES B1, B3 to B6): a small Newton on the kernels alone.

Clamped: position and section (r_y, r_z); the length and direction of r_x are free, as a sheared beam needs.
"""

import numpy as np
import pytest
from funicular.derive.elements import ELEMENTS
from funicular.derive.verify_states import reference, rotation
from funicular.generated import kernels


def rectangle(E, nu, height, width, dim, torsion=None, factor=None):
    """S of a rectangle, with Cowper's shear factor if no other is given."""
    area, EIz, EIy = height * width, E * width * height**3 / 12, E * height * width**3 / 12
    G = E / (2 * (1 + nu))
    GA = G * area * (10 * (1 + nu) / (12 + 11 * nu) if factor is None else factor)
    if dim == 2:
        return np.array([E * area, GA, EIz, E * area])
    return np.array([E * area, GA, GA, G * (EIy + EIz) / E if torsion is None else G * torsion, EIy, EIz,
                     E * area, E * area, G * area])


def straight(dim, length, n):
    nodes = np.zeros((n + 1, dim + 1, dim))
    nodes[:, 0, 0] = np.linspace(0, length, n + 1)
    nodes[:, 1:] = np.eye(dim)
    return nodes


def arc(radius, angle, n):
    turn = np.linspace(0, angle, n + 1)
    s, c, zero = np.sin(turn), np.cos(turn), 0 * turn
    return np.stack([np.stack([radius * s, radius * (1 - c), zero], 1), np.stack([c, s, zero], 1),
                     np.stack([-s, c, zero], 1), np.stack([zero, zero, zero + 1], 1)], axis=1)


class Beam:
    """A cantilever of equal elements, stress-free as its nodes (n + 1, vectors, dim) stand, under loads on its end."""

    def __init__(self, nodes, length, S):
        self.dim, self.n, self.l = nodes.shape[2], len(nodes) - 1, length / (len(nodes) - 1)
        family = {2: "beam12p", 3: "beam24"}[self.dim] + "_structural"
        self.kernel = {k: getattr(kernels, f"{family}_{k}") for k in ("stiffness", "elastic_force", "elastic_tangent")}
        self.q, self.step = nodes.ravel().copy(), nodes[0].size
        self.slices = [slice(k * self.step, (k + 2) * self.step) for k in range(self.n)]
        self.A = [self.kernel["stiffness"](self.l, self._e(s), S) for s in self.slices]
        self.free = np.ones(len(self.q), dtype=bool)
        self.free[: self.step] = False
        self.free[self.dim : 2 * self.dim] = True

    def _e(self, part):
        return self.q[part].reshape(-1, self.dim)

    @property
    def end(self):
        """Nodal vectors of the free end."""
        return self.q[-self.step :].reshape(-1, self.dim)

    def assembled(self):
        f, K = np.zeros(len(self.q)), np.zeros((len(self.q), len(self.q)))
        for s, A in zip(self.slices, self.A, strict=True):
            f[s] += self.kernel["elastic_force"](self.l, self._e(s), A).ravel()
            K[s, s] += self.kernel["elastic_tangent"](self.l, self._e(s), A)
        return f, K

    def solve(self, load, steps=10):
        """`load(part, end)` gives the forces on the end's vectors and their derivative; slopes move 0.4 at most."""
        last = slice(len(self.q) - self.step, len(self.q))
        slopes = np.tile(np.repeat(np.arange(self.step // self.dim) > 0, self.dim), self.n + 1)[self.free]
        for part in np.linspace(1 / steps, 1, steps):
            for _ in range(60):
                f, K = self.assembled()
                Q, Q_e = load(part, self.end)
                f[last] -= Q.ravel()
                K[last, last] -= Q_e
                change = np.linalg.solve(K[np.ix_(self.free, self.free)], -f[self.free])
                self.q[self.free] += change * min(1, 0.4 / np.abs(change[slopes]).max())
                if np.abs(change[slopes]).max() < 1e-9:
                    break
            else:
                raise AssertionError(f"no equilibrium at {part:g} of the load")
        return self.end[0]


def force(*components):
    def load(part, end):
        Q = np.zeros(end.shape)
        Q[0] = part * np.array(components)
        return Q, np.zeros((Q.size, Q.size))
    return load


def moment(M):
    """About z, on the director r_y: what does its work on the director's turning."""
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])

    def load(part, end):
        Q, Q_e, y = np.zeros(end.shape), np.zeros((end.size, end.size)), end[2]
        Q[2] = part * M * turn @ y / (y @ y)
        Q_e[4:, 4:] = part * M * (turn / (y @ y) - 2 * np.outer(turn @ y, y) / (y @ y) ** 2)
        return Q, Q_e
    return load


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("n", [1, 3])
def test_one_element_is_timoshenkos_beam(dim, n):
    """CASES B3, small load: w 8.09903382e-4; what is off is of the second order in w/L."""
    tip = Beam(straight(dim, 2, n), 2, rectangle(2.07e11, 0.3, 0.5, 0.1, dim)).solve(force(*(0, -62500, 0)[:dim]), 1)
    assert -tip[1] == pytest.approx(8.09903382e-4, rel=1e-6)


def test_a_stout_cantilever_converges_to_reissners_beam():
    """CASES B3, large load: u 0.15097119, w 0.71056873."""
    errors = []
    for n in (2, 4, 8):
        tip = Beam(straight(2, 2, n), 2, rectangle(2.07e11, 0.3, 0.5, 0.1, 2)).solve(force(0, -62.5e6))
        errors.append(np.abs([2 - tip[0] - 0.15097119, -tip[1] - 0.71056873]))
    assert errors[2].max() < 5e-5
    assert (np.log2(errors[0] / errors[2]) / 2 > 2).all()


@pytest.mark.parametrize(("alpha", "w", "u"), [(1, 0.301720773800, 0.056433236284), (5, 0.713791523612, 0.387628360724),
                                               (10, 0.810609024880, 0.554995597754)])
def test_the_elastica_with_fourth_order(alpha, w, u):
    """CASES B1, so slender (1000) that stretch and shear are 1e-6."""
    S = rectangle(1e9, 0.3, 1e-3, 1e-3, 2)
    errors = []
    for n in (4, 8):
        tip = Beam(straight(2, 1, n), 1, S).solve(force(0, alpha * S[2]), steps=20)
        errors.append(np.abs([tip[1] - w, 1 - tip[0] - u]).max())
    assert errors[1] < 1e-3
    assert np.log2(errors[0] / errors[1]) > 3.7


@pytest.mark.parametrize("turns", [1, 2])
def test_an_end_moment_rolls_a_cantilever_up(turns):
    """CASES B4: at 45 degrees an element the rotation between nodes is off by 1e-6, the end by what follows from it."""
    S = rectangle(1e6, 0.3, 0.01, 0.01, 2)
    tip = Beam(straight(2, 1, 8 * turns), 1, S).solve(moment(2 * np.pi * turns * S[2]), steps=20 * turns)
    np.testing.assert_allclose(tip, 0, atol=5e-6)


@pytest.mark.parametrize(("load", "torsion", "expected"), [
    (300, 1 / 6, (58.77912, 22.24478, 40.19189)), (600, 1 / 6, (47.15044, 15.68480, 53.47486)),
    (300, 0.141, (58.54051, 22.11524, 40.47479)), (600, 0.141, (46.89677, 15.56033, 53.60486))])
def test_the_45_degree_bend(load, torsion, expected):
    """CASES B5, curved and stress-free at the start; 8 elements, to 1e-4 of the radius."""
    S = rectangle(1e7, 0, 1, 1, 3, torsion, factor=5 / 6)
    tip = Beam(arc(100, np.pi / 4, 8), 100 * np.pi / 4, S).solve(force(0, 0, load), steps=15)
    np.testing.assert_allclose(tip, expected, atol=0.02)


@pytest.mark.parametrize(("degrees", "uy", "uz"), [(0, 0.0107136, 0), (30, 0.0101455, 0.0794517),
                                                   (45, 0.0088874, 0.1090359), (60, 0.0066533, 0.1299171),
                                                   (90, 0, 0.1462530)])
def test_the_princeton_beam(degrees, uy, uz):
    """CASES B6, 8.896 N across a blade: bending in two planes couples through twist."""
    height, width, angle = 12.3777e-3, 3.2024e-3, np.radians(degrees)
    series = sum(np.tanh(k * np.pi * height / 2 / width) / k**5 for k in (1, 3, 5, 7, 9))
    torsion = height * width**3 * (1 / 3 - 64 / np.pi**5 * width / height * series)
    S = rectangle(71.7e9, 0.31, height, width, 3, torsion)
    tip = Beam(straight(3, 0.508, 8), 0.508, S).solve(force(0, -8.896 * np.cos(angle), 8.896 * np.sin(angle)))
    np.testing.assert_allclose(np.abs(tip[1:]), [uy, uz], atol=1.2e-5)


@pytest.mark.parametrize("name", ["beam12p", "beam24"])
def test_only_rigid_motions_cost_nothing(name):
    """As many zero eigenvalues as rigid motions, straight or bent: no hourglass."""
    element = ELEMENTS[name]
    dim, random = element.dim, np.random.default_rng(5)
    rigid = dim * (dim + 1) // 2
    for bend in (0.0, 0.3):
        e = reference(element, 0.8)
        e[element.n_vectors // 2 :] @= rotation(random, dim, bend).T
        e[element.n_vectors // 2 :][0] = reference(element, 0.8)[element.n_vectors // 2]
        S = rectangle(1.0, 0.3, 1.0, 1.0, dim)
        A = getattr(kernels, f"{name}_structural_stiffness")(0.8, e, S)
        K = getattr(kernels, f"{name}_structural_elastic_tangent")(0.8, e, A)
        values = np.linalg.eigvalsh(K)
        assert np.abs(values[:rigid]).max() < 1e-14
        assert values[rigid] > 1e-3


def test_a_curved_rest_shape_turns_without_force():
    nodes = arc(1.0, 0.9, 2)[:2].reshape(8, 3)
    S = rectangle(1.0, 0.3, 0.5, 0.3, 3)
    A = kernels.beam24_structural_stiffness(0.45, nodes, S)
    e = nodes @ rotation(np.random.default_rng(2), 3).T
    assert np.abs(kernels.beam24_structural_elastic_force(0.45, e, A)).max() < 1e-15


def test_twist_meets_the_torsion_constant():
    """Turned by an angle at its end: G J angle / l, up to the fraction that stands for the arctangent."""
    S, angle = rectangle(1.0, 0.25, 0.5, 0.3, 3, torsion=0.02), 0.3
    e = reference(ELEMENTS["beam24"], 0.8)
    A = kernels.beam24_structural_stiffness(0.8, e, S)
    e[6:8, 1:] = [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]
    U = kernels.beam24_structural_energy(0.8, e, A)[0]
    assert U == pytest.approx(0.4 * 0.02 * angle**2 / 2 / 0.8, rel=1e-7)


def test_the_planar_beam_is_the_spatial_one_in_a_plane():
    flat, space = (reference(ELEMENTS[name], 0.7) for name in ("beam12p", "beam24"))
    bent = flat + np.random.default_rng(4).normal(size=flat.shape) * 0.1
    space[[0, 1, 2, 4, 5, 6], :2] = bent
    f = kernels.beam12p_structural_elastic_force(
        0.7, bent, kernels.beam12p_structural_stiffness(0.7, flat, rectangle(1.0, 0.3, 0.5, 0.4, 2)))
    spatial = kernels.beam24_structural_elastic_force(0.7, space, kernels.beam24_structural_stiffness(
        0.7, reference(ELEMENTS["beam24"], 0.7), rectangle(1.0, 0.3, 0.5, 0.4, 3)))
    np.testing.assert_allclose(spatial[[0, 1, 2, 4, 5, 6], :2], f, rtol=1e-13, atol=1e-15)
    np.testing.assert_allclose(spatial[:, 2], 0, atol=1e-16)
    np.testing.assert_allclose(spatial[[3, 7]], 0, atol=1e-16)
