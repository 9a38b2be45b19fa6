"""`funicular bench`: its errors are true, its reference is converged, and a failure is reported without ending the
rest.
"""

import csv
import re

import numpy as np
import pytest
from funicular import Material, Rectangle, Scene, SceneError
from funicular.bench.bench import Mesh, bench, grid
from funicular.cli.main import app
from shared_scenes import cable_scene
from typer.testing import CliRunner

TOLS = (1e-3, 1e-4)
DURATION = 0.2


def swing() -> Scene:
    """Return a planar pendulum with a pin at an inner node, which refuses meshes of odd numbers."""
    scene = cable_scene("rope", pins=(0.5,), elements=2, element="cable8p", section=Rectangle(height=0.02, width=0.02),
                        material=Material(youngs_modulus=2e6, poisson_ratio=0.0, density=7200))
    scene.run_settings = {"duration": DURATION, "step": 0.01}
    return scene


@pytest.fixture(scope="module")
def benchmark(tmp_path_factory):
    """Return the standard output of the command, the rows of its CSV file, and its directory."""
    directory = tmp_path_factory.mktemp("bench")
    (directory / "swing.toml").write_text(swing().to_toml())
    result = CliRunner().invoke(app, ["bench", str(directory / "swing.toml"), "--integrators", "genalpha", "--tols",
                                      "1e-3,1e-4", "--elements", "x1,x2,3", "--outputs", "rope.tip,rope@0.2",
                                      "--repetitions", "1", "--out", str(directory / "out")])
    assert (result.exit_code, result.stderr) == (0, "")
    with (directory / "out" / "swing-bench.csv").open(encoding="utf-8") as file:
        return result.stdout, list(csv.DictReader(file)), directory / "out"


def test_every_combination_has_a_row(benchmark):
    _, rows, directory = benchmark
    assert [(row["integrator"], row["mesh"], float(row["tol"])) for row in rows] == [
        ("genalpha", mesh, tol) for mesh in ("x1", "x2", "3") for tol in TOLS]
    assert (directory / "swing-bench.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    for row in rows[:4]:
        assert float(row["cpu_s"]) > 0 and float(row["set_up_s"]) > 0 and int(row["steps"]) > 10


def test_errors_are_distances_from_the_converged_motion(benchmark):
    """The reference is computed with steps of equal size."""
    given = {"output_step": DURATION / 50, "integrator": "genalpha"}
    exact = swing().run(DURATION, step=2e-5, **given)["rope.nodal_vectors"][:, -1, 0]
    for row in benchmark[1][:2]:
        run = swing()
        run.run_settings = {}
        found = run.run(DURATION, tol=float(row["tol"]), **given)["rope.nodal_vectors"][:, -1, 0]
        error = np.linalg.norm(found - exact, axis=1).max()
        assert float(row["time error rope.tip / m"]) == pytest.approx(error, rel=0.05)
        assert float(row["time_error"]) >= error / np.linalg.norm(exact - exact[0], axis=1).max() * 0.95


def test_the_reference_is_converged_and_says_so(benchmark):
    stdout, rows, _ = benchmark
    for first, second in (rows[0:2], rows[2:4]):
        assert 0 < float(first["reference_agreement"]) < 0.1 * float(second["time_error"])
        assert 2 < float(first["time_error"]) / float(second["time_error"]) < 50
    agreements = re.findall(r"reference on x[12]: tol 5e-06 and 1.25e-06 agree to (\S+) of the motion", stdout)
    assert [float(a) for a in agreements] == pytest.approx([float(rows[k]["reference_agreement"]) for k in (0, 2)],
                                                           rel=0.1)
    assert 0 < float(rows[2]["mesh_error"]) < 0.5 * float(rows[0]["mesh_error"])
    assert "reference of all meshes: x4; with it agree x1 to" in stdout


def test_a_combination_that_fails_is_reported(benchmark):
    stdout, rows, _ = benchmark
    why = 'pin on "rope": s must be a node of the cable, got 0.5 m; nodes are at 0, 0.333333333, 0.666666667, 1 m'
    assert [row["status"] for row in rows] == ["completed"] * 4 + [why] * 2
    assert f"failed: genalpha on 3, tol 0.001, 0.0001: {why}" in stdout


def test_a_run_that_stops_early_is_reported():
    """A rider leaves its cable, and the reference does not reach the end either."""
    scene = swing()
    scene.rigid_body("A", mass=1.0, inertia=(1e-3, 1e-3, 1e-3), position=(0.9, 0, 0), velocity=(5, 0, 0))
    scene.slide("A", along="rope", s=0.9)
    result = bench(scene, grid(scene, elements=["x1"], tols=[1e-2], outputs=["A.position"], repetitions=1))
    assert 'ran off the end of cable "rope"' in result.rows[0].failed


@pytest.mark.parametrize(("given", "message"), [
    ({"integrators": ["gen-alpha"]}, 'bench: there is no integrator "gen-alpha"; did you mean "genalpha"?'),
    ({"outputs": ["rope.top"]}, 'bench: there is no output "rope.top"; did you mean "rope.tip"?'),
    ({"outputs": ["rope@1.5"]}, 'bench: there is no output "rope@1.5"'),
    ({"elements": ["2x"]}, 'bench: elements: "2x" is neither a factor nor a number of elements'),
    ({"elements": ["2.5"]}, 'bench: elements: "2.5" is not a number of elements'),
    ({"tols": [0.0]}, "bench: tols: a tolerance must lie inside (0, 1), got 0"),
    ({"repetitions": 0}, "bench: repetitions must be 1 or more, got 0"),
])
def test_bad_input_is_refused_before_anything_runs(given, message):
    with pytest.raises(SceneError) as caught:
        grid(swing(), **given)
    assert str(caught.value).startswith(message)


def test_a_factor_must_leave_whole_elements():
    assert Mesh.parse("x1.5").elements(swing().cables["rope"]) == 3
    with pytest.raises(SceneError, match=r'cable "rope": x1.25 of its 2 elements is 2.5; take a factor that leaves'):
        Mesh.parse("x1.25").scene(swing())
