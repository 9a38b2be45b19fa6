"""Winds and currents as tables in time and space: interpolation, edges, files, planes, refusals."""

from functools import cache

import funicular as fu
import numpy as np
import pytest
from derivatives import error_by_drags
from expectations import unaccounted

WATER, G = 1000.0, 9.81
ROPE = {"section": fu.Circle(radius=0.01), "material": fu.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=2000)}
TIME, X, Y, Z = np.linspace(0, 1, 5), np.array([-1, 0, 1, 2, 4.0]), np.linspace(-3, 2, 7), np.array([-2, -1, 0.5, 2.0])


def cubic_flow(t, x, y, z):
    """Return velocities (..., 3), cubic along each axis, which splines represent exactly."""
    return np.stack([0.3 * t**3 - 0.1 * t * x + 0.02 * y**3, 0.1 * x**2 * z + t**2, 0.05 * z**3 - 0.1 * x * y], axis=-1)


def linear_flow(t, x, y, z):
    return np.stack([0.3 * t - 0.1 * x * y, 0.1 * x + z * t, 0.2 - 0.1 * y * z], axis=-1)


def table(flow=cubic_flow, interpolation="cubic"):
    grid = np.meshgrid(TIME, X, Y, Z, indexing="ij")
    return fu.VelocityTable(time=TIME, x=X, y=Y, z=Z, velocity=flow(*grid), interpolation=interpolation)


@pytest.mark.parametrize(("flow", "interpolation"), [(cubic_flow, "cubic"), (linear_flow, "linear")])
def test_it_goes_through_its_values_and_has_its_polynomials_between_them(flow, interpolation):
    made, random = table(flow, interpolation), np.random.default_rng(3)
    t = random.uniform(0, 1, 50)
    place = random.uniform([-1, -3, -2], [4, 2, 2], (50, 3))
    assert np.abs(made.value(t, place) - flow(t, *place.T)).max() < 1e-12
    assert made.value(np.array([0.5]), np.array([[9.0, 0, 0]]))[0] == pytest.approx(
        flow(0.5, np.array(4.0), np.array(0.0), np.array(0.0)))
    made_again = fu.VelocityTable(y=Y, velocity=np.stack([Y, Y**3, 0 * Y], axis=-1))
    assert made_again.value(np.zeros(1), np.array([[7.0, 1.3, -5.0]]))[0] == pytest.approx([1.3, 1.3**3, 0])


def test_a_turned_table_has_splines_of_its_own():
    made, place, axes = table(), np.array([[0.4, -1.2, 0.7]]), np.eye(3)[:, [1, 2, 0]]
    before = made.value(np.array([0.3]), place)
    assert made.turned(axes).value(np.array([0.3]), place)[0] == pytest.approx(before[0] @ axes)
    assert np.array_equal(made.splines(2)[2], made.splines(3)[2][..., :2])
    assert np.array_equal(made.value(np.array([0.3]), place), before)


def resting(flow):
    """Return a cable in a flow, whose only force is drag."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(0, 0, 0), end=(2, -1, 0.5), elements=3, element="cable12", **ROPE)
    scene.fluid("sea", density=WATER, table=flow, scale=fu.Harmonic(amplitude=0.2, frequency=0.4, offset=1))
    scene.drag("wire", normal=1.2, tangential=0.1, added_mass=1.0)
    return scene


@pytest.mark.parametrize("interpolation", ["cubic", "linear"])
def test_the_engine_has_its_velocities_and_their_derivatives(interpolation):
    """The inertial force on a very heavy body: rho V (DU/Dt + C (dU/dt + (grad U)' U))."""
    flow, place, h = cubic_flow if interpolation == "cubic" else linear_flow, np.array([0.4, -1.2, 0.7]), 1e-5
    C = np.diag([0.5, 0.8, 1.1])
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("rock", mass=1e12, inertia=(1e12,) * 3, position=place)
    signal = fu.Harmonic(amplitude=0.2, frequency=0.4, offset=1)
    scene.fluid("sea", density=WATER, table=table(flow, interpolation), scale=signal)
    scene.drag("rock", volume=1e-3, added_mass=C)
    run = scene.run(0.9, step=0.1, output_step=0.3, integrator="explicit")
    for t, force in zip(run.time, run["drag_1.force"], strict=True):
        def velocity(t, r):
            return signal.value(t) * flow(t, *r)
        ends = [[velocity(t, place + h * side * e) for e in np.eye(3)] for side in (1, -1)]
        gradient = (np.array(ends[0]) - np.array(ends[1])).T / (2 * h)
        by_time = (velocity(t + h, place) - velocity(t - h, place)) / (2 * h)
        exact = by_time + gradient @ velocity(t, place) + C @ by_time + gradient.T @ C @ velocity(t, place)
        assert force == pytest.approx(WATER * 1e-3 * exact, rel=1e-7, abs=1e-8)


@cache
def accurate():
    """Return the reference run, computed once."""
    return resting(table()).run(0.8, tol=1e-9, integrator="explicit", output_step=0.1)


@pytest.mark.parametrize("integrator", ["genalpha", "energy", "explicit", "radau"])
@pytest.mark.slow_cases("energy", "genalpha")
def test_all_integrators_run_in_it(integrator):
    run = resting(table()).run(0.8, tol=1e-6, integrator=integrator, output_step=0.1)
    assert np.abs(run["wire.nodal_vectors"] - accurate()["wire.nodal_vectors"]).max() < 1e-5
    assert unaccounted(run) < 1e-4


def test_newtons_matrix_is_the_derivative_of_its_residual():
    """The matrix of drag contains no second derivatives of the velocity."""
    assert error_by_drags(resting(table()).replace("drag_1", added_mass=None)) < 1e-4


def test_a_uniform_table_is_a_uniform_velocity():
    runs = []
    for more in ({"velocity": (0.5, 0.2, 0.1)},
                 {"table": fu.VelocityTable(x=[-9, 0, 5, 9], velocity=np.tile([0.5, 0.2, 0.1], (4, 1)))}):
        scene = fu.Scene()
        wire = scene.cable("wire", start=(0, 0, 0), end=(2, -1, 0), elements=3, **ROPE)
        scene.pin(wire, s=0.0)
        scene.rigid_body("ball", mass=2.0, inertia=(1e-3,) * 3, position=(1, 1, 0))
        scene.fluid(density=WATER, **more)
        scene.drag(wire, normal=1.2)
        scene.drag("ball", area=0.02, volume=1e-3)
        runs.append(scene.run(0.3, tol=1e-7, integrator="radau", output_step=0.1))
    assert np.abs(runs[0]["wire.nodal_vectors"] - runs[1]["wire.nodal_vectors"]).max() < 1e-10
    assert np.abs(runs[0]["ball.position"] - runs[1]["ball.position"]).max() < 1e-10


def test_planar_scenes_take_it_in_any_plane():
    runs = []
    for element in ("cable8p", "cable12"):
        scene = fu.Scene(gravity=(0, 0, -G))
        wire = scene.cable("wire", start=(1, 0.5, 12), end=(3, 0.5, 14), elements=4, element=element, up=(0, 0, 1),
                           strain="engineering", **ROPE)
        scene.pin(wire, s=0.0)
        height, x = np.linspace(8, 16, 5), np.linspace(-2, 6, 6)
        velocity = np.zeros((6, 5, 3))
        velocity[..., 0] = 3 + height + np.sin(x)[:, None]
        velocity[..., 2] = 0.3 * x[:, None]
        scene.fluid(density=1.25, table=fu.VelocityTable(x=x, z=height, velocity=velocity))
        scene.drag(wire, normal=1.2, tangential=0.01)
        runs.append(scene.run(0.3, tol=1e-9, integrator="radau", output_step=0.05))
    planar, spatial = runs
    assert np.abs(planar["wire.nodal_vectors"] - spatial["wire.nodal_vectors"]).max() < 1e-8
    forces = [np.array(run.section_forces("wire", 1.0)["force"]) for run in runs]
    assert np.abs(forces[0] - forces[1]).max() < 1e-5


def test_a_run_notes_what_leaves_it_and_when():
    """A ball in free fall leaves through the lower edge, y = -1, below which the velocity is constant."""
    scene = fu.Scene()
    scene.rigid_body("ball", mass=2.0, inertia=(1e-3,) * 3, position=(0, 0, 0))
    scene.fluid("wind", density=1.2, table=fu.VelocityTable(y=[-1, 0, 1, 2], velocity=[[1, 0, 0]] * 4))
    scene.drag("ball", area=1e-9, name="small")
    with pytest.warns(fu.FunicularWarning, match='drag "small" leaves the table of its fluid at t = 0.4515'):
        run = scene.run(0.8, tol=1e-8, output_step=0.1)
    (event,) = run.report["events"]
    assert event["time"] == pytest.approx((2 / G) ** 0.5, abs=1e-8)
    assert event["what"] == "leaves the table of its fluid"
    assert any("leaves the table" in message for message in run.report["messages"])


def test_a_run_that_ends_with_the_table_is_not_beyond_it():
    scene = fu.Scene()
    scene.rigid_body("ball", mass=2.0, inertia=(1e-3,) * 3, position=(0, 0, 0))
    scene.fluid(density=1.2, table=fu.VelocityTable(time=[0, 0.1, 0.5, 0.7], velocity=[[1, 0, 0]] * 4))
    scene.drag("ball", area=0.1)
    run = scene.run(0.7, tol=1e-6, output_step=0.1)
    assert run.report["events"] == []
    with pytest.warns(fu.FunicularWarning, match="at t = 0.7 s"):
        scene.run(0.8, tol=1e-6, output_step=0.1)


def test_no_gust_is_missed():
    """A gust of a hundredth of the run acts on a ball at rest, whose steps would be longer."""
    for interpolation in ("linear", "cubic"):
        scene = fu.Scene(gravity=(0, 0, 0))
        scene.rigid_body("ball", mass=2.0, inertia=(1e-3,) * 3, position=(0, 0, 0))
        time = np.array([0, 5, 5.05, 5.1, 10]) if interpolation == "linear" else np.linspace(0, 10, 201)
        velocity = np.zeros((len(time), 3))
        velocity[np.searchsorted(time, 5.05 - 1e-9)] = 30, 0, 0
        scene.fluid(density=1.2, table=fu.VelocityTable(time=time, velocity=velocity, interpolation=interpolation))
        scene.drag("ball", area=0.1)
        runs = [scene.run(10, tol=1e-4, output_step=1, integrator=integrator) for integrator in ("radau", "explicit")]
        assert runs[0]["ball.velocity"][-1, 0] > 0.3
        assert runs[0]["ball.velocity"][-1, 0] == pytest.approx(runs[1]["ball.velocity"][-1, 0], rel=1e-3)


@pytest.mark.parametrize("suffix", [".nc", ".npz", "uvw.nc"])
def test_files_say_the_same(tmp_path, suffix):
    xarray = pytest.importorskip("xarray")
    grid = np.meshgrid(TIME, X, Y, Z, indexing="ij")
    velocity, path = cubic_flow(*grid), tmp_path / f"flow{suffix}"
    coords = {"time": ("time", TIME, {"units": "s"}), "x": ("x", X, {"units": "m"}), "y": Y, "z": Z}
    if suffix == ".npz":
        np.savez(path, time=TIME, x=X, y=Y, z=Z, velocity=velocity)
    elif suffix == ".nc":
        data = xarray.Dataset({"velocity": (("xyz", "time", "x", "z", "y"), velocity.transpose(4, 0, 1, 3, 2))}, coords)
        data.to_netcdf(path, engine="scipy")
    else:
        axes = ("time", "x", "y", "z")
        data = xarray.Dataset({name: (axes, velocity[..., k]) for k, name in enumerate("uvw")}, coords)
        data.to_netcdf(path, engine="scipy")
    made = fu.VelocityTable(file=str(path))
    assert np.abs(made.grid.velocity - velocity).max() == 0
    if suffix != ".npz":
        assert np.abs(fu.VelocityTable.of(data).grid.velocity - velocity).max() == 0
    scene = resting(made)
    text = scene.to_toml()
    assert f"file = \"{path}\"" in text
    local = text.replace(str(path), path.name)
    (tmp_path / "scene.toml").write_text(local)
    again = fu.load_scene(tmp_path / "scene.toml")
    assert again.fluids["sea"].table.grid.velocity.shape == velocity.shape
    assert again.run(0.01, step=1e-3)["wire.nodal_vectors"].shape == (101, 4, 2, 3)


def test_scene_files_hold_it():
    scene = fu.Scene()
    scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=3, **ROPE)
    scene.fluid("air", density=1.2, table=fu.VelocityTable(
        y=[-5, 0, 5], velocity=[[1, 0, 0], [2, 0, 0], [3, 0, 0]], interpolation="linear"))
    scene.drag("wire", normal=1.0)
    text = scene.to_toml()
    assert fu.Scene.from_toml(text).to_toml() == text
    assert 'table = {y = [-5.0, 0.0, 5.0], velocity = [[1.0, 0.0, 0.0]' in text


STILL = [[0, 0, 0]] * 4
REFUSED = {
    "nothing": (lambda: fu.VelocityTable(), "velocity is missing"),
    "no axis": (lambda: fu.VelocityTable(velocity=[1, 0, 0]), "none of time, x, y and z"),
    "shape": (lambda: fu.VelocityTable(x=[0, 1, 2, 3], velocity=[[0, 0, 0]] * 3), r"must have the shape \(4, 3\)"),
    "ragged": (lambda: fu.VelocityTable(x=[0, 1], velocity=[[0, 0, 0], [1, 2]]), "lists of numbers in lists"),
    "not finite": (lambda: fu.VelocityTable(x=[0, 1], velocity=[[0, 0, 0], [1, float("nan"), 2]]),
                   r"must be finite, got nan at the indices \[1, 1\]"),
    "few": (lambda: fu.VelocityTable(x=[0, 1, 2], velocity=STILL[:3]), "cubic splines need four"),
    "overshoot": (lambda: fu.VelocityTable(time=[0, 4.9, 5, 5.1, 5.2, 20],
                                           velocity=[[v, 0, 0] for v in (0, 0, 9, 0, 0, 0)]),
                  r"beyond its values, to -?\d+.* between time = 5.2 s and 20 s"),
    "decreasing": (lambda: fu.VelocityTable(x=[0, 2, 1, 3], velocity=STILL), "x must increase"),
    "file and numbers": (lambda: fu.VelocityTable(file="a.nc", x=[0, 1]), "has file and x"),
    "no file": (lambda: fu.VelocityTable(file="none.nc"), 'there is no file "none.nc"'),
    "two velocities": (lambda: fu.Fluid(density=1, velocity=(1, 0, 0), table=fu.VelocityTable(
        x=[0, 1, 2, 3], velocity=STILL)), "has a table and a velocity"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_bad_input_is_refused(case):
    make, message = REFUSED[case]
    with pytest.raises(fu.SceneError, match=message):
        make()


def test_what_begins_outside_is_refused():
    scene = fu.Scene()
    scene.cable("wire", start=(0, 0, 0), end=(5, 0, 0), elements=3, **ROPE)
    scene.fluid("sea", density=WATER, table=fu.VelocityTable(x=[0, 1, 2, 3], velocity=STILL))
    with pytest.raises(fu.SceneError, match='begins at x = 5 m, outside of the table of fluid "sea", which goes'):
        scene.drag("wire", normal=1.0)


def test_an_equilibrium_beyond_it_says_so():
    scene = fu.Scene()
    wire = scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=4, **ROPE)
    scene.pin(wire, s=0.0)
    scene.fluid(density=WATER, table=fu.VelocityTable(y=[-0.5, 0, 1, 2], velocity=[[1, 0, 0]] * 4))
    scene.drag(wire, normal=1.0)
    with pytest.warns(fu.FunicularWarning, match="outside of the table of its fluid along y"):
        scene.equilibrium()


def test_a_table_that_leaves_a_skew_plane_by_rounding_stays_in_it():
    a, b = np.linalg.qr(np.array([[1, 2], [2, -1], [2, 5.0]]))[0].T
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(0, 0, 0), end=a, up=b, elements=3, element="cable8p", **ROPE)
    scene.fluid(density=WATER, table=fu.VelocityTable(x=[-1, 0, 1, 2], velocity=[0.7 * a + 0.2 * b] * 4))
    assert "wire" in scene.cables and scene.plane is not None


def test_a_table_across_the_plane_is_refused():
    scene = fu.Scene()
    scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=3, element="cable8p", **ROPE)
    with pytest.raises(fu.SceneError, match=r"table .* leaves the plane"):
        scene.fluid(density=WATER, table=fu.VelocityTable(x=[-1, 0, 1, 2], velocity=[[1, 0, 0.1]] * 4))
