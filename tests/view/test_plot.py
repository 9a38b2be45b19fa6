"""The content of pictures. Their appearance was inspected on bundled scenes and a spatial one."""

import matplotlib.pyplot as pyplot
import numpy as np
import pytest
from fake_recording import fake_recording
from funicular import Circle, FunicularError, Material, ResultFileError, Scene, load_scene
from funicular.parts.settings import RunSettings
from funicular.results.pictures import save_plots
from funicular.results.run import Run
from funicular.view.plot import shape_figure
from funicular.view.projections import directions
from matplotlib.image import imread
from viewed_scenes import spatial

SETTINGS = RunSettings(duration=1.0)
SOFT = Material(youngs_modulus=1e6, density=1000, poisson_ratio=0.3)


@pytest.fixture(autouse=True)
def no_window():
    pyplot.switch_backend("Agg")
    yield
    pyplot.close("all")


@pytest.fixture
def run():
    scene = load_scene("paper51")
    return Run.from_recording(fake_recording(scene), scene, SETTINGS, Scene.from_toml)


def legend(figure) -> list[str]:
    return [text.get_text() for each in figure.legends for text in each.get_texts()]


def test_files(run, tmp_path):
    written = save_plots(run, tmp_path / "new", "a-")
    assert [p.name for p in written] == ["a-shape.png", "a-acceleration.png", "a-slide.png", "a-energy.png"]
    for path in written:
        assert np.ptp(imread(path)[..., :3]) > 0.9  # black on white, not an empty page


def test_unwritable_directory(run, tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(ResultFileError, match=r"file: the pictures cannot be written here: File exists$"):
        save_plots(run, tmp_path / "file")


def test_labels_have_units_and_names(run):
    shape = run.plot()
    assert (shape.axes[0].get_xlabel(), shape.axes[0].get_ylabel()) == ("x / m", "y / m  (stretched 5 : 1)")
    assert shape.axes[0].get_aspect() == 5
    assert legend(shape) == ["path of A", "pin", "slide trolley"]
    assert [a.get_ylabel() for a in run.plot("slide").axes] == ["arc-length s / m", "s rate / (m/s)"]
    assert run.plot("energy").axes[0].get_ylabel() == "change of energy / J"
    assert run.plot("acceleration").axes[0].get_ylabel() == "y-acceleration / (m/s²)"
    with pytest.raises(FunicularError, match=r'no picture "forces-wyre" of a run; did you mean "forces-wire"\?'):
        run.plot("forces-wyre")


def test_the_path_is_that_of_the_body(run):
    path = next(line for line in run.plot().axes[0].lines if line.get_label() == "path of A")
    np.testing.assert_array_equal(np.transpose(path.get_data()), run["A.position"][:, :2])


def test_a_tall_shape_is_not_stretched(run):
    run["wire.nodal_vectors"][..., 0, 1] *= 30
    shape = run.plot().axes[0]
    assert (shape.get_aspect(), shape.get_ylabel()) == (1, "y / m")


def test_what_does_not_slide_is_drawn_too():
    scene = Scene()
    scene.cable("rope", start=(0, 0, 0), end=(1, 0, 0), elements=1, section=Circle(radius=0.01), material=SOFT)
    scene.motion("rope", s=0, displacement=(0, 0, 0))
    scene.rigid_body("ball", mass=1, inertia=(1, 1, 1), position=(0.5, 1, 0))
    assert legend(scene.run(0.01).plot()) == ["path of ball", "pin"]


def test_spatial_scenes_have_four_views():
    figure = spatial().plot()
    space, *planes = figure.axes
    assert (space.get_xlabel(), space.get_ylabel(), space.get_zlabel()) == ("x / m", "y / m", "z / m")
    assert {axes.get_title(loc="left"): (axes.get_xlabel(), axes.get_ylabel()) for axes in planes} == {
        "side": ("y / m", "z / m"), "front": ("x / m", "z / m"), "from above": ("x / m", "y / m")}
    assert legend(figure) == ["spring", "lever arm", "load", "clamp", "pin", "joint", "slide trolley", "ground"]


def test_supports_that_move_are_drawn_where_they_go():
    figure = spatial().run(0.5, output_step=0.05, tol=1e-2, progress=False).plot()
    assert "moved pin" in legend(figure)
    front = next(axes for axes in figure.axes if axes.get_title(loc="left") == "front")
    moved = next(dots for dots in front.collections if dots.get_label() == "moved pin")
    u = np.linspace(0, 0.5, 11)  # of the ramp's 1 s
    x = 0.4 * (10 * u**3 - 15 * u**4 + 6 * u**5)
    np.testing.assert_allclose(moved.get_offsets(), np.stack([x, 0 * x], axis=1), atol=1e-9)


def test_every_view_of_a_flat_scene(run):
    assert len(shape_figure(run.animation(), every_view=True).axes) == 5  # and the colours of times


def test_states_of_rest_and_modes():
    scene = load_scene("paper51")
    assert len(scene.equilibrium().plot().axes) == 1
    titles = [axes.get_title() for axes in scene.modes(3, as_drawn=True).plot().axes]
    assert [title.partition(":")[0] for title in titles] == ["mode 1", "mode 2", "mode 3"]


def hanging(end, gravity):
    scene = Scene(gravity=gravity)
    scene.cable("rope", start=(0, 0, 0), end=end, elements=1, section=Circle(radius=0.01), material=SOFT, up=(1, 2, 3))
    return scene


@pytest.mark.parametrize(
    ("end", "gravity", "names"),
    [
        ((1, 0, 0), (0, -9.81, 0), ("x", "y")),
        ((0, 1, 1), (0, 0, -9.81), ("y", "z")),
        ((0, -1, 0), (0, -9.81, 0), ("x", "y")),
        ((3, 0, 4), (0, 0, 0), ("(0.6, 0, 0.8)", "y")),
    ],
)
def test_the_main_view(end, gravity, names):
    seen = directions(hanging(end, gravity).animation())
    assert seen.flat and seen.front.names == names
    np.testing.assert_allclose(seen.matrix.T @ seen.matrix, np.eye(3), atol=1e-15)
    assert np.linalg.det(seen.matrix) > 0


def test_a_scene_without_a_slide(tmp_path):
    scene = load_scene("paper51")
    recording = fake_recording(scene)
    recording.parts |= {"slides": {}, "bodies": {}}
    dict.clear(scene.slides)
    dict.clear(scene.bodies)
    written = save_plots(Run.from_recording(recording, scene, SETTINGS, Scene.from_toml), tmp_path)
    assert [p.name for p in written] == ["shape.png", "energy.png"]


@pytest.mark.filterwarnings("error")
def test_a_run_that_stopped_at_once(tmp_path):
    scene = load_scene("paper51")
    recording = fake_recording(scene)
    recording.time = recording.time[:1]
    for group in (recording.cables, *recording.parts.values()):
        for arrays in group.values():
            arrays |= {k: v[:1] for k, v in arrays.items() if k not in ("node_s", "vector_names")}
    recording.energy = {k: v[:1] for k, v in recording.energy.items()}
    assert len(save_plots(Run.from_recording(recording, scene, SETTINGS, Scene.from_toml), tmp_path)) == 4
