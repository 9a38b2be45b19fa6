"""Drives of sheaves that do nothing are refused."""

import funicular as fu
import pytest
from expectations import refused


@pytest.mark.parametrize("inertia", [0.0, 0.1])
@pytest.mark.parametrize("friction", [{}, {"friction": 0.0}, {"friction": fu.Friction(coefficient=0.0)}])
@pytest.mark.parametrize("drive", ["velocity", "angle", "torque"])
def test_a_drive_needs_friction(drive, friction, inertia):
    """The rope did not notice such a drive."""
    given = {"at": (0, 3, 0), "radius": 0.3, "inertia": inertia, drive: 2.0} | friction
    complaint = (f"has {drive}, but no friction with the rope, which it then never moves; give its friction, or leave "
                 f"{drive} out")
    if drive == "torque" and not inertia:
        complaint = "has torque, but no inertia; give its inertia in kg m²"
    with refused(f'sheave "top": {complaint}'):
        fu.Sheave("top", **given)
    fu.Sheave("top", **given | {"friction": 0.3, "inertia": 0.1})


def test_a_drum_has_no_friction():
    fu.Drum("top", at=(0, 3, 0), radius=0.3, side="left", length_in_store=1.0, velocity=2.0)
