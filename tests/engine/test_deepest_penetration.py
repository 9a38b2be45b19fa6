"""The reported penetration agrees with the energy, also between rows."""

import re

import funicular as fu
import numpy as np
import pytest
from funicular.model.build import build
from funicular.results import streaming
from funicular.solve.notes.penetrations import Penetrations
from interrupted_runs import Killed, failing

SETTINGS = {"duration": 0.8, "output_step": 0.1, "tol": 1e-5, "progress": False}
DEEPEST = 2.0 * np.sqrt(3.0 / 1e3)
"""m: of the ball that is dropped, where its spring has all of its energy, m v^2/2 = k d^2/2."""
INTEGRATORS = ["genalpha", "radau", "explicit", "energy"]


def told_depth(run) -> float:
    """Return the depth in m of the one note on penetration."""
    (told,) = [message for message in run.report["messages"] if "keeps it up" in message]
    return float(re.search(r"up to ([0-9.e-]+) m", told)[1])


def dropped() -> fu.Scene:
    """Return a scene of a ball that falls on the ground and touches it from 0.2 to 0.37 s."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.surface("ground", fu.Plane())
    scene.rigid_body("ball", mass=3.0, inertia=(1, 1, 1), position=(0, 0.5, 0), velocity=(0, -2.0, 0))
    scene.contact("ball", "ground", radius=0.1, stiffness=1e3)
    return scene


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize(("speed", "stiffness"), [(2.0, 1e3), (0.7, 50.0)])
def test_the_penetration_at_rows_is_what_the_energy_allows(integrator, speed, stiffness):
    """A linear penalty stores all energy at the turning point, where a row is: m v^2/2 = k d^2/2."""
    mass, radius = 3.0, 0.1
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.surface("ground", fu.Plane())
    scene.rigid_body("ball", mass=mass, inertia=(1, 1, 1), position=(0, 0.5, 0), velocity=(0, -speed, 0))
    scene.contact("ball", "ground", radius=radius, stiffness=stiffness)
    duration = 0.8 / speed + np.pi * np.sqrt(mass / stiffness)  # down, half a cycle, up: deepest half-way
    with pytest.warns(fu.FunicularWarning, match="below its surface"):
        run = scene.run(duration, output_step=duration / 2, integrator=integrator, tol=1e-5, progress=False)
    deepest = speed * np.sqrt(mass / stiffness)
    assert run["contact_1.penetration"][1] == pytest.approx(deepest, rel=1e-4)
    assert told_depth(run) == pytest.approx(deepest, rel=1e-2)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_the_penetration_between_rows_is_told(integrator):
    """The ball is off the ground at both rows."""
    with pytest.warns(fu.FunicularWarning, match="below its surface"):
        run = dropped().run(0.8, output_step=0.8, integrator=integrator, tol=1e-5, progress=False)
    assert run["contact_1.penetration"].max() == 0.0
    assert told_depth(run) == pytest.approx(DEEPEST, rel=1e-2)


def test_the_penetration_before_a_checkpoint_is_told(tmp_path, monkeypatch):
    """The ball has left the ground when the run is killed. The resumed run reports the depth."""
    monkeypatch.setattr(streaming, "CHECKPOINT_INTERVAL", 0.0)
    left = failing(monkeypatch, 1_000_000, Killed())
    with pytest.warns(fu.FunicularWarning, match="below its surface"):
        whole = dropped().run(**SETTINGS, save=tmp_path / "whole.nc")
    left[0], path = 1_000_000 - left[0] - 8, tmp_path / "killed.nc"
    with pytest.raises(Killed):
        dropped().run(**SETTINGS, save=path)
    left[0] = 1_000_000
    with pytest.warns(fu.FunicularWarning, match="below its surface"):
        run = dropped().run(**SETTINGS, save=path, resume=True)
    assert run.report["resumed_at_s"][0] > 0.4
    assert run["contact_1.penetration"].max() < 0.98 * DEEPEST  # no row tells it
    assert told_depth(run) == told_depth(whole) == pytest.approx(DEEPEST, rel=1e-2)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_lines_that_pass_through_each_other_are_told(integrator):
    """A heavy bar passes the axis of a wire between two rows. The depth equals that of a run with rows of 1 ms."""
    scene = fu.Scene(gravity=(0, 0, 0))
    wire = scene.cable("wire", start=(-1, 0, 0), end=(1, 0, 0), elements=4, element="cable12",
                       section=fu.Circle(radius=0.02),
                       material=fu.Material(youngs_modulus=1e7, density=1000, poisson_ratio=0.3))
    scene.pin(wire, s=0.0)
    scene.pin(wire, s=2.0)
    scene.rigid_body("bar", mass=1.0, inertia=(1, 1, 1), position=(0.1, 0, -0.1), velocity=(0, 0, 2.0))
    crossing = scene.crossing(wire, "bar", axis=(0, 1, 0), length=1.0, stiffness=200.0, radius=0.05)
    with pytest.warns(fu.FunicularWarning, match="beyond the contact of its lines"):
        run = scene.run(0.6, output_step=0.6, integrator=integrator, tol=1e-4, progress=False)
        fine = scene.run(0.6, output_step=0.001, integrator="radau", tol=1e-5, progress=False)
    assert told_depth(run) == pytest.approx(float(fine[f"{crossing.name}.penetration"].max()), rel=1e-2)


@pytest.mark.parametrize(("force", "told"), [(0.0, 0), (5.0, 1)])
def test_at_rest_lines_that_touch_are_told(force, told):
    """Beyond the end of a line there is no contact, even past its axis."""
    scene = fu.Scene()
    wire = scene.cable("wire", start=(-1, 0, 0), end=(1, 0, 0), elements=4, element="cable12",
                       section=fu.Circle(radius=0.005),
                       material=fu.Material(youngs_modulus=1e7, density=1000, poisson_ratio=0.3))
    scene.crossing(wire, None, at=(0, 0, -0.2), axis=(0, 1, 0), length=0.5, radius=0.01, stiffness=1e3)
    crossing = np.zeros((1, 14))
    crossing[0, 3:5] = force, 0.21
    found = Penetrations(scene, build(scene))
    found.see_rest({"contact": np.zeros((1, 0, 10)), "crossing": crossing[None]}, engine=None)
    assert len(found.notes()) == told
    assert all("0.21 m beyond the contact of its lines" in note for note in found.notes())


@pytest.mark.parametrize("shape", [
    fu.Plane(point=(0, 0.25, 0)), fu.Cylinder(radius=0.5, length=4, axis=(0, 0, 1), at=(0, -0.3, 0)),
    fu.Sphere(radius=0.5, at=(0, -0.3, 0)), fu.Capsule(radius=0.5, length=1, axis=(0, 0, 1), at=(0, -0.3, 0)),
    fu.Box(size=(1, 0.4, 1)), fu.HeightField.of(lambda x: 0.24 + 0.01 * np.cos(x), np.linspace(-3, 3, 25))],
    ids=lambda shape: shape.kind)
def test_a_centreline_lies_on_every_surface(shape):
    """The radii 0 and 1e-6 give the same state, and no note on penetration."""
    def on_bed(radius):
        scene = fu.Scene(gravity=(0, -9.81, 0))
        line = scene.cable("line", start=(-2, 0.3, 0.01), end=(2, 0.3, 0.01), elements=40, element="cable12",
                           section=fu.GeneralSection(area=3e-4, second_moment_about_z=1e-9,
                                                     second_moment_about_y=1e-9),
                           material=fu.Material(youngs_modulus=1e8, poisson_ratio=0, density=7800, damping_time=1e-2))
        scene.pin(line, s=0)
        scene.pin(line, s=4)
        scene.surface("bed", shape)
        scene.contact(line, "bed", radius=radius, stiffness=2e3, name="c")
        return scene

    zero, tiny = (on_bed(radius).equilibrium() for radius in (0.0, 1e-6))
    assert zero["c.penetration"] > 1e-3  # a thousand times the tiny radius
    assert tiny["c.penetration"] == pytest.approx(zero["c.penetration"], abs=2e-6)
    notes = [*zero.messages, *tiny.messages, *on_bed(0.0).run(0.01, output_step=0.01).report["messages"]]
    assert not any("e-06 m" in note for note in notes)
    assert "radius = 0.0" in on_bed(0.0).to_toml()
