"""Notes of runs that end before their duration, by an event or at the end of a cable."""

import warnings

import pytest
from funicular import Circle, EndOfCableError, Material, Scene


def buckling(ending: str | None):
    """Return a cable that buckles in too large steps, beside a body that moves 100 m; `ending` stops the run near its
    end.
    """
    scene = Scene(gravity=(0, 0, 0))
    wire = scene.cable("c", start=(0, 0, 0), end=(1, 0, 0), elements=6, element="cable12", rest_length=0.98,
                       section=Circle(radius=0.01),
                       material=Material(youngs_modulus=1e8, poisson_ratio=0.0, density=1000.0))
    scene.pin(wire, s=0.0)
    scene.rigid_body("b", mass=1.0, inertia=(1, 1, 1), position=(0, 50, 0), velocity=(100, 0, 0))
    if ending == "event":
        scene.event("far", quantity="b.position.x", value=99.0, action="stop")
    if ending == "end_of_cable":
        track = scene.cable("track", start=(0, 20, 0), end=(1, 20, 0), elements=1, element="cable12",
                            section=Circle(radius=0.1),
                            material=Material(youngs_modulus=1e8, poisson_ratio=0.0, density=1000.0))
        scene.clamp(track, s=0.0)
        scene.clamp(track, s=track.length)
        scene.rigid_body("rider", mass=1e-3, inertia=(1e-5,) * 3, position=(0.01, 20, 0), velocity=(1, 0, 0))
        scene.slide("rider", along=track, s=0.01)
    return scene


def run(ending: str | None):
    """Return the run of a scene that ends early."""
    progress = interrupt if ending == "interrupted" else False
    try:
        return buckling(ending).run(1.0, tol=1e-3, integrator="radau", progress=progress)
    except EndOfCableError as error:
        return error.run


def interrupt(seconds):
    if seconds > 0.99:
        raise KeyboardInterrupt


@pytest.mark.parametrize("ending", ["event", "end_of_cable", "interrupted"])
def test_runs_that_end_early_have_the_notes_of_those_that_end_in_time(ending):
    """Unexplained energy, compression and growth of errors."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        whole, early = run(None), run(ending)
    assert (whole.status, early.status) == ("completed", ending)
    assert abs(early.energy_balance().relative).max() > 0.1
    for said in ("energy balance is off", "perfectly straight", "small differences grow"):
        for each in (whole, early):
            assert any(said in message for message in each.report["messages"]), (said, each.report["messages"])
