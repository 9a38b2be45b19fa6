"""A modal body against the published numbers of a flexible slider-crank, by kernels and by a scene."""

import numpy as np
import pytest
from expectations import energy_error
from funicular.engine import Engine
from funicular.integrators import Explicit
from funicular.model.build import build
from funicular.model.redundant_constraints import drop_redundant_rows
from slider_crank import ACCELERATIONS, CRANK, END, ROD, SPEED, START, Rod, machine

UNDEFORMED = {"angle": -0.33119284248796127, "slider": 0.16971948685427088,
              "modes": [-1.38889669e-04, 2.07548746e-05, -1.54297445e-05, -2.52393284e-05]}
"""At 0.1 s, by Rod(axial_mass=1).run(tol=1e-9, start={"q": [0] * 5, "v": [-75, 0, 0, 0, 0]}), in 2 min."""
JOINTS = ("shaft", "crank_pin", "piston_pin", "cylinder")


def turned(orientation) -> float:
    """Return the rotation about z by an angle in rad."""
    w, _, _, z = orientation
    return np.arctan2(2 * w * z, w * w - z * z)


def test_accelerations_at_the_start_are_the_published_ones():
    """To the precision of the published velocities, nine digits."""
    found = Rod().accelerations(0.0, np.array(START["q"]), np.array(START["v"]))
    np.testing.assert_allclose(found, ACCELERATIONS, rtol=1e-6, atol=5e-8)


def test_the_end_is_carried_as_published_only_with_the_published_mass():
    """The mass of the axial modes determines their accelerations, so that the start shows the difference."""
    right = Rod(axial_mass=1.0).accelerations(0.0, np.array(START["q"]), np.array(START["v"]))
    assert abs(right[4] / ACCELERATIONS[4] - 1) > 0.1


@pytest.mark.slow
def test_the_motion_is_the_published_one():
    """At 0.1 s, after two and a half turns. Converged: angle to 3e-11, slider to 3e-11 m; relative errors of the modal
    coordinates 3e-7, 2e-7, 2e-6, 4e-6, since the start has nine digits.
    """
    found = Rod().run(tol=1e-6)
    assert abs(found["angle"] - END["angle"]) < 1e-9
    assert abs(found["slider"] - END["slider"]) < 1e-9
    assert abs(found["off"]) < 1e-11
    np.testing.assert_allclose(found["modes"], END["modes"], rtol=2e-5)


def started(folder) -> tuple:
    """Return the scene's model at the published start, which is slightly deformed: engine, and the position of the rod
    in q and v.
    """
    model = build(machine(folder))
    rod, slider = (next(body for body in model.bodies if body.name == name) for name in ("rod", "slider"))
    angle, angle_rate = START["q"][0], -CRANK * SPEED / (ROD + START["q"][4])
    model.q[rod.configuration + 3 : rod.configuration + 7] = np.cos(angle / 2), 0, 0, np.sin(angle / 2)
    model.q[rod.configuration + 7 : rod.configuration + 11] = START["q"][1:]
    model.v[rod.dof + 3 : rod.dof + 10] = 0, 0, angle_rate, *START["v"][1:]
    model.q[slider.configuration] = CRANK + ROD + START["q"][4]
    model.v[slider.dof] = START["v"][4]
    engine = Engine(model)
    drop_redundant_rows(model, engine)
    engine.start(duration=0.1, output_step=0.1, tol=1e-8, step=0.0, method=Explicit(), first_step=1e-5)
    return engine, rod, slider


def test_the_scene_starts_with_the_published_accelerations(tmp_path):
    engine, rod, _ = started(tmp_path)
    found = engine.rows()["acceleration"][0][rod.dof + 5 : rod.dof + 10]
    # the velocities, given to nine digits, are projected on the joints
    np.testing.assert_allclose(found, ACCELERATIONS, rtol=1e-6, atol=1e-6)


def test_the_scene_ends_where_it_was_published(tmp_path, validated):
    engine, rod, slider = started(tmp_path)
    assert engine.advance(lambda _: None) == "completed"
    q = engine.rows()["q"][-1]
    given = {"source": "IVP test set, slider crank", "variant": "explicit"}
    validated("Bodies and mechanisms", "slider crank with a flexible rod, at 0.1 s", "angle of the rod", END["angle"],
              float(turned(q[rod.configuration + 3 : rod.configuration + 7])), unit="rad", scale=1.0, bound=2e-10,
              **given)
    validated("Bodies and mechanisms", "slider crank with a flexible rod, at 0.1 s", "position of the slider",
              END["slider"], float(q[slider.configuration]), unit="m", scale=1.0, bound=2e-10, **given)
    validated("Bodies and mechanisms", "slider crank with a flexible rod, at 0.1 s", "modal coordinates", END["modes"],
              q[rod.configuration + 7 : rod.configuration + 11], bound=1e-5, **given)


@pytest.mark.parametrize(("integrator", "tol", "place", "modes"), [("explicit", 1e-8, 1e-10, 5e-6),
                                                                    ("radau", 1e-6, 5e-8, 6e-3)])
@pytest.mark.slow_cases("radau-1e-06-5e-08-0.006")
def test_the_scene_from_an_undeformed_start_runs_as_the_kernels_do(tmp_path, integrator, tol, place, modes):
    """With the correct axial mass, not 15 times of it."""
    run = machine(tmp_path, axial_mass=1.0).run(0.1, output_step=0.01, tol=tol, integrator=integrator)
    assert not run.report["messages"], "nothing is redundant, nothing has to be closed"
    assert max(run[f"{joint}.residual"].max() for joint in JOINTS) < 1e-12
    assert energy_error(run) < 1e-5
    assert abs(turned(run["rod.orientation"][-1]) - UNDEFORMED["angle"]) < place
    assert abs(run["slider.position"][-1, 0] - UNDEFORMED["slider"]) < place
    np.testing.assert_allclose(run["rod.modal_coordinates"][-1], UNDEFORMED["modes"], rtol=modes)
