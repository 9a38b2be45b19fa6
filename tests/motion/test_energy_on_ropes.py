"""What acts on ropes by the energy-momentum integrator: grips by joints and springs, rams, slides, loads and drag."""

from itertools import pairwise

import funicular as fu
import numpy as np
import pytest
from expectations import unaccounted
from interrupted_runs import killed_and_resumed
from ropes.scenes import rope_of
from test_energy_of_ropes import momenta

pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
STEP = {"integrator": "energy", "progress": False}


def loaded(kind: str, dim: int = 2, damping: float = 0.0) -> fu.Scene:
    """Return a load that swings below a sheave, against a weight, with what acts on its rope at the middle of the span.

    The sheave lets the point pass ends of elements.
    """
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("L", mass=2.0, inertia=(1, 1, 1), position=(0.2, -2.5, 0), velocity=(0.4, 0, 0.2 * (dim == 3)))
    scene.rigid_body("W", mass=3.0, inertia=(1, 1, 1), position=(-0.2, -2.0, 0))
    top = fu.Sheave("top", at=(0, 0, 0), radius=0.2, side="right", axis=(0, 0, 1))
    rope = scene.rope("rope", route=[fu.Anchor("W"), top, fu.Anchor("L")], tension=20.0, elements=6,
                      element="cable8p" if dim == 2 else "cable12", **rope_of(2e4, 0.05, 0.01 * (dim == 2), damping))
    start, end = scene.route_of(rope).arc_lengths(0.0)[1]
    s = float(start + 0.51 * (end - start))
    x, y, z = rope.point(scene.bodies, s)
    if kind in ("loads", "drag"):
        if kind == "loads":
            scene.force("rope", s=s, value=(2, 0, 0), scale=fu.Ramp(start=0.5, end=1.0, after=0.1))
            scene.distributed_force("rope", value=(1, -2, 0), start=s - 0.3)
        else:
            scene.fluid("air", density=1.2, velocity=(5, 0, 0))
            scene.drag("rope", diameter=0.02, name="wind")
        return scene
    beside = {"spherical": (0, -0.1), "slide": (0, 0)}.get(kind, (0.1, -0.3))
    scene.rigid_body("G", mass=0.2, inertia=(0.1, 0.1, 0.1), position=(x + beside[0], y + beside[1], z))
    if kind == "slide":
        scene.slide("G", along="rope", s=s)
    elif kind == "ram":
        scene.joint("distance", ("rope", s), "G", velocity=fu.Ramp(start=0, end=0.4, before=0.1, after=0.4), name="ram")
    elif kind in ("spring", "damper"):
        scene.spring(("rope", s), ("G", (0.05, 0, 0)), stiffness=20.0, length=0.3, damping=float(kind == "damper"))
    else:
        scene.joint(kind, ("rope", s), ("G", (0, 0.1 * (kind == "spherical"), 0)), name="grip")
    return scene


def free(kind: str) -> fu.Scene:
    """Return a rope over a sheave on one of three bodies that drift and rotate freely, and a fourth that holds to it
    and moves relative to it.
    """
    scene, spin, drift = fu.Scene(gravity=(0, 0, 0)), 0.8, np.array([0.3, 0.2, 0])

    def add(name: str, mass: float, at: np.ndarray, more: float = 0.0) -> None:
        scene.rigid_body(name, mass=mass, inertia=(1, 1, 0.3), position=at.tolist(), angular_velocity=(0, 0, spin),
                         velocity=(drift + np.array([more - spin * at[1], spin * at[0], 0])).tolist())

    for name, mass, at in (("A", 4.4, (-0.25, -2.5)), ("B", 4.0, (0.9, -2.5)), ("C", 6.0, (0, 0.1))):
        add(name, mass, np.array([*at, 0.0]))
    top = fu.Sheave("top", at=("C", (0, -0.1, 0)), radius=0.25, side="right")
    rope = scene.rope("rope", route=[fu.Anchor("A"), top, fu.Anchor("B")], tension=42.0, elements=4,
                      **rope_of(2e3, 0.3, 0.02, 0.0))
    for name in "AB":
        scene.spring((name, (0, 0, 0)), ("C", (0, 0, 0)), stiffness=20.0, length=4.7)
    start, end = scene.route_of(rope).arc_lengths(0.0)[1]
    s = float(start + 0.51 * (end - start))
    beside = np.zeros(3) if kind == "slide" else np.array([0.1, -0.2, 0])
    add("D", 1.0, rope.point(scene.bodies, s) + beside, 0.0 if kind == "spherical" else 1.0)
    if kind == "slide":
        scene.slide("D", along="rope", s=s)
    elif kind == "spring":
        scene.spring(("rope", s), "D", stiffness=50.0, length=0.1)
    else:
        scene.joint(kind, ("rope", s), ("D", tuple(-beside) if kind == "spherical" else (0, 0, 0)))
    return scene


KINDS = ["spherical", "distance", "spring", "slide"]


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("kind", [*KINDS, "ram", "damper", "loads", "drag"])
@pytest.mark.slow_cases("ram-3", "distance-3", "spring-3", "damper-3", "spherical-3", "loads-3", "slide-3")
def test_energy_is_kept_and_agrees_with_radau(kind, dim):
    """The rope flows by .1 to .3 m past its nodes, which are .4 m apart."""
    run = loaded(kind, dim).run(0.4, output_step=0.05, step=1e-3, **STEP)
    radau = loaded(kind, dim).run(0.4, output_step=0.05, tol=1e-4, integrator="radau", progress=False)
    assert unaccounted(run) < 1e-12 * run["energy.kinetic"].max()  # measured: 7e-14 at most
    for name in ("W", "L", *(["G"] if "G.position" in run else [])):
        place, other = run[f"{name}.position"], radau[f"{name}.position"]
        assert np.abs(place - other).max() < 2e-4
    assert np.ptp(run["W.position"], axis=0).max() > 0.08


@pytest.mark.parametrize("kind", KINDS)
def test_momenta_are_kept_to_rounding(kind):
    """Also while the rope flows past the point."""
    first, *others = (momenta(duration, free(kind)) for duration in (1e-3, 0.05, 0.4))
    assert max(np.abs(other - first).max() for other in others) < 1e-13 * np.abs(first).max()  # measured: 4e-15
    run = free(kind).run(0.4, output_step=0.1, step=1e-3, **STEP)
    assert unaccounted(run) < 1e-13 * run["energy.kinetic"].max()


@pytest.mark.parametrize("kind", ["spherical", "spring", "slide", "loads"])
def test_order_in_time_is_two(kind):
    scene = loaded(kind, damping=1e-2)
    ends = [scene.run(0.2, output_step=0.2, step=step, **STEP) for step in (2e-3, 1e-3, 5e-4)]
    first, second = (np.abs(a["L.position"][-1] - b["L.position"][-1]).max() for a, b in pairwise(ends))
    assert 3.7 < first / second < 4.3


def test_resumed_bit_for_bit(tmp_path):
    scene = loaded("slide")
    settings = STEP | {"duration": 0.2, "output_step": 0.01, "step": 1e-3}
    whole = scene.run(**settings)
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 15, **settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)
