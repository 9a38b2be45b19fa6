"""Modal bodies in scenes: bad input, scene files, results in files."""

import numpy as np
import pytest
import xarray
from funicular import Material, Rectangle, Scene, SceneError, load_run
from funicular.scene.file import loads

BEAM = {"start": (0, 0, 0), "end": (0.5, 0, 0), "section": Rectangle(height=0.03, width=0.02),
        "material": Material(youngs_modulus=2e7, poisson_ratio=0.3, density=1100)}


def arrays() -> dict:
    """Return the arrays of a box of eight corners with two shear modes."""
    nodes = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1.0)])
    modes = np.zeros((2, 8, 3))
    modes[0, :, 0], modes[1, :, 1] = nodes[:, 1] * nodes[:, 2], nodes[:, 0] * nodes[:, 2]
    return {"nodes": nodes, "modes": modes, "masses": np.full(8, 0.5), "stiffness": np.diag([90.0, 100.0])}


def added(folder, changes=None, without=(), **more):
    made = {name: array for name, array in (arrays() | (changes or {})).items() if name not in without}
    np.savez(folder / "box.npz", **made)
    scene = Scene()
    scene.modal_body("box", **({"data": folder / "box.npz", "position": (0, 0, 0)} | more))
    return scene


def changed(name, change):
    array = arrays()[name].copy()
    change(array)
    return {name: array}


def asymmetric(K):
    K[0, 1] = 5.0


def negative(K):
    K[1, 1] = -100.0


def parallel(modes):
    modes[1] = modes[0] + 0.1 * modes[1]


@pytest.mark.parametrize(("changes", "message"), [
    ({"modes": np.zeros((2, 5, 3))},
     r'modal_body "box": array modes are not from that mesh: must be of shape \(any, 8, 3\)'),
    ({"rotations": np.zeros((1, 8, 3))}, r"array rotations are not from that mesh: must be of shape \(2, 8, 3\)"),
    ({"masses": np.ones(7)}, r"array masses must be of shape \(8\), got \(7,\)"),
    ({"masses": -np.ones(8)}, r"array masses must not be negative, and not all zero, got -1 kg at least"),
    ({"stiffness": np.eye(3)}, r"array stiffness must be of shape \(2, 2\), got \(3, 3\)"),
    ({"nodes": np.full((8, 3), np.nan)}, "array nodes must be finite"),
    (changed("stiffness", asymmetric), "array stiffness must be symmetric, got 5 and 0 N/m for modes 1 and 2"),
    (changed("stiffness", negative), "array stiffness must not be negative, got the eigenvalue -100 N/m"),
    (changed("modes", parallel), "modes 1 and 2 are not orthogonal in the mass: .* take orthogonal=False"),
])
def test_arrays_are_checked(tmp_path, changes, message):
    with pytest.raises(SceneError, match=message):
        added(tmp_path, changes)


def test_what_is_missing_or_too_much_is_said(tmp_path):
    with pytest.raises(SceneError, match='has no array masses'):
        added(tmp_path, without=("masses",))
    with pytest.raises(SceneError, match="there is no file"):
        Scene().modal_body("box", data=tmp_path / "none.npz", position=(0, 0, 0))
    (tmp_path / "bad.npz").write_text("no arrays")
    with pytest.raises(SceneError, match="could not be read"):
        Scene().modal_body("box", data=tmp_path / "bad.npz", position=(0, 0, 0))
    with pytest.raises(SceneError, match="position is missing"):
        added(tmp_path, position=None)
    with pytest.raises(SceneError, match="has data and start"):
        added(tmp_path, start=(0, 0, 0))
    with pytest.raises(SceneError, match='modal_body "bar": section is missing; give start, end, section and mat'):
        Scene().modal_body("bar", start=(0, 0, 0), end=(1, 0, 0))
    with pytest.raises(SceneError, match="leave out position and orientation"):
        Scene().modal_body("bar", **BEAM, position=(0, 0, 0))
    with pytest.raises(SceneError, match='boundary "clamped" is not known'):
        Scene().modal_body("bar", **BEAM, boundary="clamped")


def test_a_mass_matrix_that_is_not_positive_definite_is_refused(tmp_path):
    turning = arrays()["modes"].copy()
    turning[1] = np.cross((0, 0, 1.0), arrays()["nodes"])
    scene = added(tmp_path, {"modes": turning})
    with pytest.raises(SceneError, match='modal_body "box": its mass matrix is not positive definite: the turn about z'
                                         ", mode 2 together move no mass"):
        scene.run(duration=0.1)
    line = arrays()["nodes"] * [1, 0, 0]
    scene = added(tmp_path, {"nodes": line, "modes": arrays()["modes"][:1] + 1e-3, "stiffness": np.eye(1)})
    with pytest.raises(SceneError, match="not positive definite: the turn about x moves no mass"):
        scene.run(duration=0.1)


def test_modes_that_are_not_orthogonal_are_taken_when_said(tmp_path):
    scene = added(tmp_path, changed("modes", parallel), orthogonal=False)
    M = scene.bodies["box"].shape.modal_mass
    assert M[0, 1] == pytest.approx(4.0)
    squares = np.linalg.eigvals(np.linalg.solve(M, arrays()["stiffness"]))
    np.testing.assert_allclose(np.sort(scene.bodies["box"].shape.vibrations[0]), np.sort(squares))


def test_what_does_not_know_modal_bodies_says_so():
    scene = Scene()
    scene.modal_body("bar", **BEAM)
    with pytest.raises(SceneError, match='modal_body "bar": integrator "energy" does not support modal bodies; take'):
        scene.run(duration=0.1, integrator="energy", step=1e-3)


def test_a_point_is_a_node_or_goes_with_its_section(tmp_path):
    bar = Scene().modal_body("bar", **BEAM, boundary="attached")
    at, phi, psi = bar.attachment_modes((0.5, 0.015, 0))
    np.testing.assert_allclose(phi, bar.shape.modes[:, -1] + np.cross(psi, (0, 0.015, 0)))
    np.testing.assert_allclose(bar.point(at), (0.5, 0.015, 0), atol=1e-15)
    with pytest.raises(ValueError, match=r"\(0.47, 0, 0\) m is no node of the body"):
        bar.attachment_modes((0.47, 0, 0))
    box = added(tmp_path).bodies["box"]
    np.testing.assert_array_equal(box.attachment_modes((1, 1, 1))[1], box.shape.modes[:, 7])
    with pytest.raises(ValueError, match="is no node of the body"):
        box.attachment_modes((1, 1, 0.9))


def test_in_a_planar_scene_modes_must_stay_in_the_plane():
    scene = Scene()
    scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=2, element="cable8p", section=BEAM["section"],
                material=BEAM["material"])
    with pytest.raises(SceneError, match='modal_body "bar": mode 1 leaves the plane z = 0'):
        scene.modal_body("bar", **BEAM)
    scene.modal_body("bar", **BEAM, element="beam12p", angular_velocity=(0, 0, 5))
    planar = scene.run(duration=0.1, tol=1e-8, output_step=0.1)
    alone = Scene()
    alone.modal_body("bar", **BEAM, element="beam12p", angular_velocity=(0, 0, 5))
    spatial = alone.run(duration=0.1, tol=1e-8, output_step=0.1)
    np.testing.assert_allclose(planar["bar.nodes"], spatial["bar.nodes"], atol=1e-7)


def test_scene_files_and_results_hold_it(tmp_path):
    scene = added(tmp_path, velocity=(1, 0, 0), angular_velocity=(0, 1, 2), damping_ratio=0.02)
    scene.modal_body("bar", **BEAM, modes=3, boundary="attached")
    again = loads(scene.to_toml(), "text")
    assert again.bodies == scene.bodies
    assert again.to_toml() == scene.to_toml()
    relative = scene.to_toml().replace(str(tmp_path / "box.npz"), "box.npz")
    assert loads(relative, "text", tmp_path).bodies["box"].mass == 4.0
    run = scene.run(duration=0.02, output_step=0.01)
    run.save(tmp_path / "run.nc")
    kept = load_run(tmp_path / "run.nc")
    assert kept["bar.modal_coordinates"].shape == (3, 3)
    np.testing.assert_array_equal(kept["box.nodes"], run["box.nodes"])
    with xarray.open_dataset(tmp_path / "run.nc") as dataset:
        assert dataset["bar.nodes"].dims == ("time", "bar.node", "xyz")
    xarray.Dataset({name: (tuple(f"{name}_{k}" for k in range(a.ndim)), a) for name, a in arrays().items()}).to_netcdf(
        tmp_path / "box.nc")
    assert added(tmp_path, data=tmp_path / "box.nc").bodies["box"].mass == 4.0
