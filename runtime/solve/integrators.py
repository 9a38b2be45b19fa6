"""The ways through time as the engine takes them, and the choice between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import splu

from ..engine import Engine
from ..model.model import Model
from ..parts.scene_data import SceneData
from ..parts.settings import RunSettings
from ..parts.slide import Slide
from .condensation import condensed

STABLE = 4.5
"""Of the explicit method: its step times the highest angular frequency, where step control holds it (its imaginary
stability interval is 5.96)."""
STABLE_DAMPING = 6.0
"""The same for the highest rate of decay (the real interval is 6.40)."""
COST_OF_IMPLICIT = 4e3
"""Evaluations of eq 38 that a radian of the motion as a whole costs the implicit method at tol = 1e-4, by
tests/benchmarks/choice.py; they grow with the third root of 1/tol."""
KINKS = 2.0
"""What friction multiplies that by: where a normal force turns round, friction has a kink, which only short steps find.
Vibrations of it count as well, by what they make of the sign, and radau would damp them."""
ITERATIONS = 20


@dataclass(frozen=True)
class GeneralisedAlpha:
    """alpha_m, alpha_f, beta, gamma for a spectral radius at infinite frequency (Chung & Hulbert 1993)."""

    spectral_radius: float
    name, order, error_overestimate, retry_factor = "genalpha", 2, 2.0, 0.0

    @property
    def parameters(self) -> tuple[float, float, float, float]:
        """As fu_genalpha has them."""
        alpha_m = (2 * self.spectral_radius - 1) / (self.spectral_radius + 1)
        alpha_f = self.spectral_radius / (self.spectral_radius + 1)
        return alpha_m, alpha_f, (1 - alpha_m + alpha_f) ** 2 / 4, 0.5 - alpha_m + alpha_f


@dataclass(frozen=True)
class EnergyMomentum:
    """Keeps energy and momenta to rounding (Simo & Tarnow 1992; Gonzalez 1996); with a spectral radius below 1 at
    infinite frequency momenta alone, while algorithmic dissipation takes energy from the fast vibrations of cables
    (engine/integrators/algorithmic_dissipation.c).
    """

    spectral_radius: float = 1.0
    name, order, error_overestimate, retry_factor = "energy", 2, 1.0, 0.0

    @property
    def parameters(self) -> tuple[float, float, float, float]:
        """As fu_algorithmic has them: lag in steps, viscosity, inertia, and the weight that follows from them.

        The modulus 1 + inertia p^2 + viscosity p lag p/(1 + lag p) of elasticity and algorithmic stress is to be
        (1 + p/a)^3/(1 + lag p), with p = -a where (1 + p/2)/(1 - p/2) is minus the spectral radius.
        """
        a = 2 * (1 + self.spectral_radius) / (1 - self.spectral_radius) if self.spectral_radius < 1 else np.inf
        lag, inertia, viscosity = 3 / a, 1 / (3 * a**2), 8 / (9 * a)
        return lag, viscosity, inertia, 2 * viscosity * lag / (2 * lag + 1) + 2 * inertia


class Explicit:
    """The Runge-Kutta method of order 8 of Dormand & Prince (Hairer, Norsett & Wanner 1993, DOP853), as scipy has it.

    Steps are chosen by its error estimate of order 7. Methods of order 5 have a third of its imaginary stability
    interval for each evaluation, so that it is the cheaper one at any tolerance.
    """

    name, error_overestimate, retry_factor = "explicit", 1.0, 0.0

    def __init__(self) -> None:
        from scipy.integrate import DOP853  # 30 ms, for this method alone

        self.A, self.b, self.c = np.array(DOP853.A), np.array(DOP853.B), np.array(DOP853.C)
        self.error, self.coarse = np.array(DOP853.E5), np.array(DOP853.E3)
        self.order = DOP853.error_estimator_order


class Radau:
    """Radau IIA of three stages, of order 5 (Hairer & Wanner 1996, IV.5 and IV.8), from its nodes.

    Steps are chosen by an embedded estimate of order 3 and, for vibrations, by one of the method's own order that
    follows from it (engine/integrators/radau.c). After a step that failed the next ones stay below ``retry_factor`` of
    it for a while: factorisations are dear.
    """

    name, order, error_overestimate, retry_factor = "radau", 3, 1.0, 0.65

    def __init__(self) -> None:
        root = np.sqrt(6.0)
        self.c = np.array([(4 - root) / 10, (4 + root) / 10, 1.0])
        powers = np.arange(3)
        values = self.c[:, None] ** powers  # of monomials at the nodes; their integrals from 0 to the nodes
        self.A = (self.c[:, None] ** (powers + 1) / (powers + 1)) @ np.linalg.inv(values)
        self.A_inverse = np.linalg.inv(self.A)
        eigenvalues, vectors = np.linalg.eig(self.A_inverse)
        real = int(np.argmin(np.abs(eigenvalues.imag)))
        up = int(np.argmax(eigenvalues.imag))
        self.gamma, self.alpha, self.beta = eigenvalues[real].real, eigenvalues[up].real, -eigenvalues[up].imag
        self.T = np.column_stack([vectors[:, real].real, vectors[:, up].real, vectors[:, up].imag])
        self.T_inverse = np.linalg.inv(self.T)
        # weights with 1/gamma at the start, of order 3; less those of the method, over gamma's share and by A^-1
        at_start = 1 / self.gamma
        embedded = np.linalg.solve(values.T, 1 / (powers + 1) - at_start * (powers == 0))
        self.error = (embedded - self.A[-1]) @ self.A_inverse / at_start


Integrator = GeneralisedAlpha | Radau | Explicit | EnergyMomentum


def choose(settings: RunSettings, scene: SceneData, model: Model,
           engine: Engine) -> tuple[Integrator, str]:
    """The integrator of a run, and why it is that one. "auto" takes the cheaper by stiffness and tolerance."""
    fixed = GeneralisedAlpha(settings.spectral_radius)
    if settings.integrator != "auto":
        made = {"genalpha": lambda: fixed, "explicit": Explicit, "radau": Radau,
                "energy": lambda: EnergyMomentum(settings.spectral_radius)}[settings.integrator]()
        return made, "as asked for"
    if settings.step is not None:
        return fixed, "the step is fixed: genalpha holds at any"
    if "spectral_radius" in settings.model_fields_set:
        return fixed, "spectral_radius is given, which is genalpha's"
    frequency, decay = fastest_rates(model, engine)
    decay = max(decay, *(regularised_decay(scene, slide) for slide in scene.slides.values()), 0.0)
    slow = slowest_rate(scene, model, settings.duration)
    explicit_cost = 12 * max(frequency / STABLE, decay / STABLE_DAMPING)
    implicit_cost = COST_OF_IMPLICIT * slow * (1e-4 / settings.tol) ** (1 / 3)
    if any(slide.friction is not None and slide.friction.sliding for slide in scene.slides.values()):
        implicit_cost *= KINKS
    reason = (f"stability asks the explicit method for {explicit_cost:.3g} evaluations a second (highest frequency "
              f"{frequency:.3g} rad/s" + (f", fastest decay {decay:.3g} 1/s" if decay else "")
              + f"), tol asks radau for work like {implicit_cost:.3g}")
    return (Explicit() if explicit_cost < implicit_cost else Radau()), reason


def regularised_decay(scene: SceneData, slide: Slide) -> float:
    """1/s: how fast a slow rider under its weight comes to the speed at which regularised friction lets it creep."""
    friction = slide.friction
    if friction is None or friction.sticks or slide.prescribed is not None:
        return 0.0
    return friction.sliding * float(np.linalg.norm(scene.gravity)) / friction.velocity


def slowest_rate(scene: SceneData, model: Model, duration: float) -> float:
    """rad/s of the motion as a whole: a pendulum as long as the scene, or what crosses it, or the run."""
    points = [node.vector("r") for nodes in model.nodes.values() for node in nodes]
    points += [model.q[b.configuration : b.configuration + model.dim] for b in model.bodies]
    size = float(np.max(np.ptp(points, axis=0)))
    if size == 0.0:
        return 1.0 / duration
    speed = max((float(np.linalg.norm(body.velocity)) for body in scene.bodies.values()), default=0.0)
    return max(np.sqrt(np.linalg.norm(scene.gravity) / size), speed / size, 1.0 / duration)


def fastest_rates(model: Model, engine: Engine) -> tuple[float, float]:
    """rad/s and 1/s: the highest frequency and rate of decay of the state at the start, its slides left out.

    Holding riders on their cables only lowers them.
    """
    engine.place(0.0)
    n = model.n_band + model.n_border_dof
    if n == 0:
        return 0.0, 0.0
    mass = engine.matrix(1.0, 0.0, 0.0)[:n, :n]
    stiffness = condensed(engine.matrix(0.0, 0.0, 1.0), model)[0][:n, :n]
    damping = condensed(engine.matrix(0.0, 1.0, 1.0), model)[0][:n, :n] - stiffness
    return np.sqrt(_largest(stiffness, mass)), _largest(damping, mass)


def _largest(matrix, mass) -> float:
    """About the largest eigenvalue of the symmetric part by the mass, in size: power iteration, some per cent low."""
    symmetric, factors = (matrix + matrix.T) / 2, splu(mass.tocsc())
    x = np.random.default_rng(0).normal(size=mass.shape[0])
    value = 0.0
    for _ in range(ITERATIONS):
        moved = factors.solve(symmetric @ x)
        size = np.sqrt(moved @ (mass @ moved))
        if size == 0.0:
            return 0.0
        value, x = size / np.sqrt(x @ (mass @ x)), moved / size
    return float(value)
