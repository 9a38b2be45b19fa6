"""Bundled scenes of machines: a cable car over a support, a zip line with a buffer."""

import numpy as np
import pytest
from expectations import energy_error
from funicular import load_scene

G = 9.81


def test_a_cable_car_climbs_over_the_support():
    scene = load_scene("cable_car")
    run = scene.run(duration=24.0, tol=1e-3)
    weight = G * sum(body.mass for body in scene.bodies.values())
    assert np.abs(run["cabin.velocity"][0]).max() == 0
    assert np.abs(run["cabin.acceleration"][0]).max() < 0.5, "from rest: the drive takes the carriage alone"
    w, _, _, z = run["carriage.orientation"][0]
    rest = weight * np.sin(2 * np.arctan2(z, w))
    pull = weight / G * 1.5  # of 6 m/s in 4 s; the rope gives way at first, and the cabin hangs back
    assert rest < run["upper_wheel.traction"][0] < rest + pull
    rates = run["upper_wheel.s_rate"][run.time.searchsorted([10, 19])]
    np.testing.assert_allclose(rates, [6, 2.5], rtol=1e-5)  # genalpha keeps the drive's s, and its rate to 2.2e-6
    support = scene.cables["track"].length / 2
    assert run["lower_wheel.s"][0] < support < run["lower_wheel.s"][-1]
    wheels = run["upper_wheel.s"] - run["lower_wheel.s"]
    np.testing.assert_allclose(wheels, 1.2, rtol=3e-3)  # of the carriage, along a rope that bends and stretches
    assert energy_error(run) < 2e-3
    assert max(run["hinge.residual"].max(), run["upper_wheel.residual"].max()) < 1e-9 * 200  # metres of rope


def test_the_track_rope_slides_over_the_saddle():
    """The tension is equal on both sides; the support carries the tension times the turn, and the weight in between.

    A rope pinned to the support has 242 kN below it and 200 kN above.
    """
    rest = load_scene("cable_car").equilibrium()
    forces = rest.section_forces("track")
    assert (forces.tension.min(), forces.tension.max()) == (pytest.approx(220.0e3, rel=2e-3),
                                                            pytest.approx(226.1e3, rel=2e-3))
    s = float(rest["saddle.s"])
    below, above = rest.section_forces("track", s=[s - 9.0, s + 9.0])["force"].values
    np.testing.assert_allclose(np.linalg.norm(below), np.linalg.norm(above), rtol=0.01)  # 18 m of rope rise by 3.6 m
    turn = np.arccos(below @ above / np.linalg.norm(below) / np.linalg.norm(above))
    weight = 8300 * 1.1e-3 * G * 18.0
    assert np.linalg.norm(rest["saddle.force"]) == pytest.approx(np.linalg.norm(below) * turn + weight, rel=0.01)


def test_a_zip_line_ends_in_its_buffer():
    scene = load_scene("zip_line")
    run = scene.run()
    length, buffer = scene.cables["rope"].length, scene.slides["wheels"].at_end
    entered, left = run.events[:2]
    assert (entered["what"], left["what"]) == ("entered the buffer", "left the buffer")
    assert entered["s"] == pytest.approx(length - buffer.length)
    assert length - buffer.length < run["wheels.s"].max() < length, "it stops before the end"
    drop = scene.bodies["rider"].position[1] - run["rider.position"][:, 1].min()
    before = run.time < entered["time"]
    assert 0.7 * np.sqrt(2 * G * drop) < run["wheels.s_rate"][before].max() < np.sqrt(2 * G * drop)
    assert (np.diff(run["energy.dissipated"]) > -1e-9).all()
    assert energy_error(run) < 1e-3  # measured: 5e-5


def test_the_droppers_of_an_overhead_span_get_their_lengths_and_become_slack():
    rest = load_scene("overhead_span").equilibrium()
    lengths = [rest.scene.point_forces[f"dropper_{k}"].length for k in range(9)]
    np.testing.assert_allclose(lengths[:5], [1.017, 0.896, 0.810, 0.758, 0.741], atol=2e-3)  # of a published line
    run = rest.scene.run(duration=0.3, output_step=0.005, initial=rest)
    tension = np.array([run[f"dropper_{k}.tension"] for k in range(9)])
    assert tension[:, 0].min() > 40.0
    assert tension.min() == 0.0
    assert {event["what"] for event in run.events} == {"became slack", "became taut"}
    assert energy_error(run) < 1e-4
