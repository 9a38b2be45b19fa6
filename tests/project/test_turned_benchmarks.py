"""The scenes of the benchmarks turned to z up: the planar choice has all results of the spatial scene."""

import warnings

import choice_scenes
import funicular as fu
import model_scenes
import numpy as np
import pytest
from funicular.choice.candidates import possible
from funicular.choice.planar import planar_of
from funicular.choice.remeshing import coarsest, remade
from funicular.parts.kinds import TURNING
from funicular.parts.quantity import DIRECTION, NODAL_VECTORS, POINT
from turned_scenes import ASKEW, UPRIGHT, differences, turned_scene

pytestmark = pytest.mark.slow

ALL = ({f"choice: {name}": each for name, each in choice_scenes.SCENES.items()}
       | {f"model: {name}": each for name, each in model_scenes.SCENES.items()})

NOT_PLANAR = ("rider on a soft rope", "modal link", "steel and rubber", "free fall", "follower force", "cable robot",
              "Princeton blade")
"""Scenes that leave any plane, by the ends of their names; modes of the modal link do."""


def of_spatial_elements(scene):
    """Return a scene with the finest spatial model of each cable, on a mesh that the model permits."""
    models = {name: possible(scene, cable).finest.of(cable.given_elements or coarsest(scene, cable) or 1)
              for name, cable in scene.cables.items()}
    return remade(scene, models)


def run(scene, duration, steps=50):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        return scene.run(duration, step=duration / steps, output_step=duration / 10, integrator="genalpha",
                         initial="drawn", progress=False)


@pytest.mark.parametrize("name", ALL)
def test_results_are_those_of_the_spatial_scene(name):
    """The bound is 1e-9, or the difference of planar and spatial kernels in z = 0 where that is larger."""
    scene, duration = ALL[name].make(), min(ALL[name].duration, 0.1)
    if not scene.cables:
        return
    if scene.dim == 2:
        compare_written_planar(scene, duration)
        return
    scene = of_spatial_elements(scene)
    if name.endswith(NOT_PLANAR):
        assert planar_of(scene).scene is planar_of(turned_scene(scene, *UPRIGHT)).scene is None
        return
    flat, upright = planar_of(scene), turned_scene(scene, *UPRIGHT)
    found = planar_of(upright)
    assert flat.scene is not None and found.scene is not None, (flat, found)
    there = differences(run(flat.scene, duration), run(scene, duration))
    here = differences(run(found.scene, duration), run(upright, duration))
    wrong = {result: value for result, value in here.items() if value > max(1e-9, 1.5 * there[result])}
    assert not wrong, wrong
    if not name.endswith("whip"):  # a curve by Akima's spline, which is another one in other axes
        assert planar_of(turned_scene(scene, *ASKEW)).scene is not None


def compare_written_planar(scene, duration):
    """Compare a scene of planar elements with its copy turned upright: x stays, y becomes z.

    Quaternions turn the axes of bodies and round inertia and points; stiff cables on wheels amplify this to 1e-8 in
    accelerations and forces.
    """
    flat, upright = run(scene, duration, 500), run(turned_scene(scene, *UPRIGHT), duration, 500)
    for name in flat:
        if TURNING.get(name.rpartition(".")[2]) in (POINT, DIRECTION, NODAL_VECTORS):
            size = max(1.0, np.abs(flat[name]).max(initial=0.0))
            assert np.abs(upright[name][..., 1]).max(initial=0.0) == 0 or name.endswith("moment"), name
            turned = np.stack([upright[name][..., 0], upright[name][..., 2], -upright[name][..., 1]], axis=-1)
            least = 1e-7 if name.endswith(("acceleration", "force", "moment")) else 1e-9
            assert np.abs(turned - flat[name]).max(initial=0.0) < least * size, name
