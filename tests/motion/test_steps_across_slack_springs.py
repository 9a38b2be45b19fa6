"""Steps across springs that become slack or taut, by integrator: closed forms, instants, energy, landings."""

import funicular as fu
import numpy as np
import pytest

INTEGRATORS = ("explicit", "radau", "genalpha", "energy")
MASS = 2.0


class Pair:
    """A mass between two droppers beside a spring: both pull within `reach` of the middle, one alone beyond. Sines of
    two frequencies, from the middle at this speed.
    """

    reach, speed = 0.02, 0.5

    def __init__(self, stiffness, beside=0.0):
        self.stiffness, self.beside = stiffness, beside
        within, beyond = beside + 2 * stiffness, beside + stiffness
        self.within, self.beyond = np.sqrt(within / MASS), np.sqrt(beyond / MASS)
        self.left = np.sqrt(self.speed**2 - (self.within * self.reach)**2)  # speed at the ends of the reach
        self.shift = stiffness * self.reach / beyond
        self.first = np.arcsin(self.within * self.reach / self.speed) / self.within
        self.out = 2 * np.arctan2(self.left / self.beyond, self.reach + self.shift) / self.beyond

    def scene(self):
        scene = fu.Scene(gravity=(0, 0, 0))
        scene.rigid_body("m", mass=MASS, inertia=(1, 1, 1), position=(0, 0, 0), velocity=(self.speed, 0, 0))
        for name, side in (("left", -1), ("right", 1)):
            scene.spring((side, 0, 0), "m", name=name, stiffness=self.stiffness, length=1 - self.reach,
                         tension_only=True)
        if self.beside:
            scene.spring((-1, 0, 0), "m", name="beside", stiffness=self.beside, length=1.0)
        return scene

    def instants(self, duration):
        """Return the instants at which the droppers become slack and taut, right and left by turns."""
        times, t = [], self.first
        while t < duration:
            times += [t, t + self.out]
            t += self.out + 2 * self.first
        return np.array([time for time in times if time < duration])

    def __call__(self, time):
        half = 2 * self.first + self.out
        turns, t = np.divmod(np.asarray(time) + self.first, half)
        s = t - 2 * self.first
        inner = self.speed / self.within * np.sin(self.within * (t - self.first))
        outer = ((self.reach + self.shift) * np.cos(self.beyond * s) + self.left / self.beyond * np.sin(self.beyond * s)
                 - self.shift)
        return np.where(turns % 2 == 0, 1, -1) * np.where(t < 2 * self.first, inner, outer)


def energy_of(run):
    return sum(run[f"energy.{part}"] for part in ("kinetic", "elastic", "potential", "dissipated"))


def told(run):
    return [(event["what"], event["name"]) for event in run.events]


TURNS = [("became slack", "right"), ("became taut", "right"), ("became slack", "left"), ("became taut", "left")]


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_pair_of_droppers_that_unload_and_reload_follows_its_sines(integrator):
    exact, duration = Pair(300.0), 1.0
    run = exact.scene().run(duration=duration, output_step=0.02, integrator=integrator, tol=1e-8)
    instants = exact.instants(duration)
    assert np.abs(run["m.position"][:, 0] - exact(run.time)).max() < 1e-8
    assert told(run) == (TURNS * 9)[:len(instants)]
    assert len(instants) >= 6
    assert np.abs([event["time"] for event in run.events] - instants).max() < 2e-8
    assert np.ptp(energy_of(run)) < (1e-12 if integrator == "energy" else 1e-8)


def linear(stiffness):
    """Return the mass beside a spring alone, at the same speed."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("m", mass=MASS, inertia=(1, 1, 1), position=(0, 0, 0), velocity=(Pair.speed, 0, 0))
    scene.spring((-1, 0, 0), "m", name="beside", stiffness=stiffness, length=1.0)
    return scene


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("tol", [1e-2, 1e-3, 1e-4])
def test_steps_go_over_what_changes_little(integrator, tol):
    """The error hardly exceeds that without changes; instants are as accurate as positions."""
    exact, settings = Pair(3.0, 300.0), {"duration": 2.0, "output_step": 2.0, "integrator": integrator, "tol": tol}
    run, smooth = exact.scene().run(**settings), linear(304.5).run(**settings)
    instants = exact.instants(2.0)
    assert told(run) == (TURNS * 30)[:len(instants)]
    passed = sum(event.get("passed", False) for event in run.events)
    assert passed == len(instants) if integrator == "energy" else passed > 0
    motion, omega = Pair.speed / np.sqrt(304.5 / MASS), np.sqrt(304.5 / MASS)
    error = abs(run["m.position"][-1, 0] - exact(2.0))
    assert error < 1.2 * abs(smooth["m.position"][-1, 0] - motion * np.sin(2 * omega)) + tol * motion
    late = np.abs([event["time"] for event in run.events] - instants).max()
    assert late < 2 * (error / motion + tol) / omega
    if integrator == "energy":
        assert np.ptp(energy_of(run)) < 1e-12


def bouncing():
    """Return 10 g on a tension-only spring of 100 kN/m, on which it bounces for a millisecond at a time."""
    scene = fu.Scene()
    scene.rigid_body("m", mass=0.01, inertia=(1e-6,) * 3, position=(0, -1, 0), velocity=(0, -0.2, 0))
    scene.spring((0, 0, 0), "m", name="wire", stiffness=1e5, length=1.0, tension_only=True)
    return scene


@pytest.mark.parametrize("integrator", ["explicit", "radau"])
@pytest.mark.parametrize("tol", [1e-2, 1e-4])
def test_a_stage_alone_that_meets_a_spring_makes_no_energy(integrator, tol):
    """Steps of the flight are longer than the spring is taut: stages, and not the end, would meet it."""
    run = bouncing().run(duration=0.25, output_step=0.0125, integrator=integrator, tol=tol)
    assert len(run.events) == 12
    assert np.ptp(energy_of(run)) < tol * np.ptp(run["energy.kinetic"])


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_fixed_steps_go_over_none_but_where_energy_has_a_mean_force(integrator):
    run = Pair(300.0).scene().run(duration=1.0, output_step=0.02, integrator=integrator, step=2e-3)
    assert len(run.events) >= 6
    assert {event.get("passed", False) for event in run.events} == {integrator == "energy"}


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_damper_is_landed_on(integrator):
    """Its force is discontinuous where it becomes taut, and so is its dissipation."""
    scene = fu.Scene()
    scene.rigid_body("m", mass=MASS, inertia=(1, 1, 1), position=(0, -1, 0), velocity=(0, -0.2, 0))
    scene.spring((0, 0, 0), "m", name="wire", stiffness=1e3, damping=1.0, length=1.0, tension_only=True)
    run = scene.run(duration=0.5, output_step=0.05, integrator=integrator, tol=1e-2)
    assert run.events
    assert not any(event.get("passed") for event in run.events)


@pytest.mark.parametrize("dim", [2, 3])
def test_the_mean_force_over_several_pieces_keeps_energy_at_any_step(dim):
    """Steps across a whole table, on a spring that swings about its end."""
    table = {"extension": [-0.2, -0.05, 0.0, 0.1, 0.3], "tension": [-90, -30, 0, 10, 60]}
    scene = fu.Scene(gravity=(0, -9.81, 0)) if dim == 2 else fu.Scene(gravity=(0, -9.81, -1.0))
    velocity = (3.0, -4.0, 0.0) if dim == 2 else (3.0, -4.0, 1.0)
    scene.rigid_body("m", mass=MASS, inertia=(1, 1, 1), position=(0, -1, 0), velocity=velocity)
    scene.spring((0, 0, 0), "m", name="wire", length=1.0, table=table)
    run = scene.run(duration=2.0, output_step=0.1, integrator="energy", step=0.05)
    assert run.report["steps"] == 40
    assert np.ptp(energy_of(run)) < 1e-12 * np.ptp(run["energy.kinetic"])
