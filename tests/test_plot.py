"""Pictures: what they draw. That they look right was judged by eye, on the bundled scene."""

import numpy as np
import pytest
from fake_recording import fake_recording
from funicular import Circle, Material, ResultFileError, Scene, load_scene
from funicular.parts.settings import RunSettings
from funicular.results.run import Run
from funicular.view.plot import centreline, draw_energy, draw_shape, draw_slide, rider_path, save_plots, view_of
from matplotlib.image import imread

SETTINGS = RunSettings(duration=1.0)


@pytest.fixture
def run():
    scene = load_scene("paper51")
    return Run.from_recording(fake_recording(scene), scene, SETTINGS, Scene.from_toml)


def test_files(run, tmp_path):
    written = save_plots(run, tmp_path / "new", "a-")
    assert [p.name for p in written] == ["a-shape.png", "a-acceleration.png", "a-slide.png", "a-energy.png"]
    for path in written:
        assert np.ptp(imread(path)[..., :3]) > 0.9  # black on white, not an empty page


def test_unwritable_directory(run, tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(ResultFileError, match=r"file: the pictures cannot be written here: File exists$"):
        save_plots(run, tmp_path / "file")


def test_the_centreline_is_an_exact_cubic():
    s = np.array([0.0, 0.5, 2.0])
    x, dx = s**3 - s, 3 * s**2 - 1
    vectors = np.zeros((1, 3, 2, 3))
    vectors[0, :, 0, 0], vectors[0, :, 1, 0] = x, dx
    vectors[0, :, 0, 1], vectors[0, :, 1, 1] = s, 1
    points = centreline(vectors, s)[0]
    np.testing.assert_allclose(points[:, 0], points[:, 1] ** 3 - points[:, 1], atol=1e-14)
    assert len(points) == 2 * 24 + 1
    assert tuple(points[-1]) == (6, 2, 0)


def test_the_rider_lies_on_the_drawn_path(run):
    np.testing.assert_array_equal(rider_path(run, "trolley"), run["A.position"])


def test_labels_have_units(run):
    shape = draw_shape(run).axes[0]
    assert (shape.get_xlabel(), shape.get_ylabel()) == ("x / m", "y / m  (stretched 5 : 1)")
    assert shape.get_aspect() == 5
    assert [a.get_ylabel() for a in draw_slide(run).axes] == ["arc-length s / m", "s rate / (m/s)"]
    assert draw_energy(run).axes[0].get_ylabel() == "change of energy / J"


def test_a_tall_shape_is_not_stretched(run):
    run["wire.nodal_vectors"][..., 0, 1] *= 30
    shape = draw_shape(run).axes[0]
    assert (shape.get_aspect(), shape.get_ylabel()) == (1, "y / m")


def test_what_does_not_slide_is_drawn_too():
    scene = Scene()
    soft = Material(youngs_modulus=1e6, density=1000, poisson_ratio=0.3)
    scene.cable("rope", start=(0, 0, 0), end=(1, 0, 0), elements=1, section=Circle(radius=0.01), material=soft)
    scene.motion("rope", s=0, displacement=(0, 0, 0))
    scene.rigid_body("ball", mass=1, inertia=(1, 1, 1), position=(0.5, 1, 0))
    shape = draw_shape(scene.run(0.01)).axes[0]
    assert [t.get_text() for t in shape.get_legend().get_texts()] == ["body", "moved"]


def hanging(end, gravity):
    scene = Scene(gravity=gravity)
    soft = Material(youngs_modulus=1e6, density=1000, poisson_ratio=0.3)
    scene.cable("rope", start=(0, 0, 0), end=end, elements=1, section=Circle(radius=0.01), material=soft, up=(1, 2, 3))
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
def test_view(end, gravity, names):
    view = view_of(hanging(end, gravity))
    assert view.names == names
    np.testing.assert_allclose(
        [view.across @ view.across, view.up @ view.up, view.across @ view.up], [1, 1, 0], atol=1e-15
    )


def test_a_scene_without_a_slide(tmp_path):
    scene = load_scene("paper51")
    recording = fake_recording(scene)
    recording.parts |= {"slides": {}, "bodies": {}}
    scene.slides.clear()
    scene.bodies.clear()
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
