"""Pictures of water with waves: the surface at the time of each frame, in every kind of picture."""

from functools import cache

import funicular as fu
import numpy as np
import pytest
from funicular.view.film import oblique
from funicular.view.page import described
from funicular.view.plot import PlanePanel, shape_figure
from funicular.view.projections import directions
from funicular.view.surfaces import placed_surface, surface
from funicular.view.vtk import frame_arrays
from viewed_scenes import riser, sea


@cache
def run() -> fu.Run:
    return sea().run(1.2, output_step=0.3, tol=1e-2, progress=False)


def water(animation):
    return next(body for body in animation.clips[0].bodies if body.name == "sea")


def test_the_surface_is_where_the_fluid_has_it_at_each_frame():
    animation, fluid = run().animation(), run().scene.fluids["sea"]
    heights = []
    for frame, time in enumerate(animation.clips[0].time):
        vertices = placed_surface(water(animation), frame, float(time))[0]
        np.testing.assert_allclose(vertices[:, 1], 0.5 + fluid.elevation(time, vertices), atol=1e-12)
        heights.append(vertices[:, 1])
    assert 0.8 < np.max(heights) - 0.5 < 1.2
    assert np.abs(np.diff(heights, axis=0)).max() > 0.3
    assert frame_arrays(animation.clips[0], 2)[0][-len(vertices):] == pytest.approx(
        placed_surface(water(animation), 2, float(animation.clips[0].time[2]))[0])


def test_a_crest_has_cells_enough():
    """At least ten a length of the shortest wave along each side; level water has those of a plane."""
    scene = run().scene
    shape = water(run().animation()).shape
    shortest = [fu.Wave(amplitude=0.2, period=period).wave_number(9.81, 12.0) for period in (2.5, 2.0)]
    across = max(shortest[0] / np.sqrt(2), shortest[1])
    along = max(shortest[0] / np.sqrt(2), scene.fluids["sea"].wave_numbers(9.81)[0])
    found = {2 * shape["size"] / cells for cells in shape["cells"]}
    for k in (along, across):
        assert any(cell <= 2 * np.pi / k / 10 for cell in found)
    level = next(body for body in riser().animation().clips[0].bodies if body.name == "sea").shape
    assert level["cells"] == [24, 24]
    assert level["waves"].shape == (0, 6)
    assert not surface(level)[0][:, 1].any()


@pytest.mark.parametrize(("picture", "waves"), [("scene", 3), ("rest", 0), ("modes", 0)])
def test_statics_and_modes_have_level_water(picture, waves):
    made = {"scene": lambda: sea().animation(), "rest": lambda: sea().equilibrium().animation(),
            "modes": lambda: sea().modes(1, as_drawn=True).animation()}[picture]()
    assert len(water(made).shape["waves"]) == waves


def test_the_page_has_the_list_of_waves_with_all_digits():
    animation = run().animation()
    shape = next(body for body in described(animation)[0]["clips"][0]["bodies"] if body["name"] == "sea")["shape"]
    assert shape["waves"] == water(animation).shape["waves"].tolist()
    assert np.array(shape["waves"])[:, 0] == pytest.approx([0.7, 0.3, 0.2])
    assert len(str(shape)) < 1200


def test_plots_draw_the_waves_of_the_last_frame_once():
    animation = run().animation()
    panel = shape_figure(animation).axes[0]
    lines = [line for line in panel.lines if len(line.get_xdata()) == water(animation).shape["cells"][1] + 1]
    x, y = max((np.array(line.get_data()) for line in lines), key=lambda points: np.ptp(points[0]))
    time, middle = run().time[-1], water(animation).position[-1, 2]
    places = np.stack([x, 0 * x, 0 * x + middle], axis=-1)
    np.testing.assert_allclose(y, 0.5 + run().scene.fluids["sea"].elevation(time, places), atol=1e-6)
    assert not any("sea" in text for text in panel.get_legend_handles_labels()[1])


def test_films_draw_lines_on_the_surface():
    from matplotlib.figure import Figure

    animation = run().animation()
    axes = Figure().add_subplot()
    PlanePanel(axes, oblique(directions(animation))).body(water(animation), 1, 0.3, (0.1, 0.4, 0.8, 1.0))
    assert len(axes.lines) == 18
    assert not axes.patches
