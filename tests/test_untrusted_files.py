"""Files are data: nothing that a scene, its arrays or its results say is run. Libraries: test_user_elements.py."""

import io
import pickle
import re
import zipfile

import numpy as np
import pytest
import xarray
from funicular import Scene, SceneError, VelocityTable
from funicular.parts import data_files
from funicular.scene_file import loads
from shared_scenes import CABLE

MARKER = []
MANY = 100_000


class Hostile:
    def __reduce__(self):
        return MARKER.append, ("it ran",)


def test_arrays_of_a_modal_body_are_no_pickles(tmp_path):
    objects = np.empty(1, object)
    objects[0] = Hostile()
    np.savez(tmp_path / "objects.npz", nodes=objects)
    with zipfile.ZipFile(tmp_path / "member.npz", "w") as archive:
        archive.writestr("nodes.npy", pickle.dumps(Hostile()))
    for name in ("bare.npz", "bare.nc"):
        (tmp_path / name).write_bytes(pickle.dumps(Hostile()))
    for file in tmp_path.iterdir():
        with pytest.raises(SceneError, match=re.escape(f'"{file}" ') + "(could not be read|has no array)"):
            Scene().modal_body("box", data=file, position=(0, 0, 0))
    assert not MARKER


@pytest.mark.parametrize(("text", "message"), [
    (CABLE + 'curve = "lambda u: (u, 0, 0)"\n', 'curve must be a function of u from 0 to 1, got'),
    (CABLE + '[[event]]\nfunction = "lambda time, state: 0"\n', "must be a function of (time, state), got"),
    (CABLE + '[run]\nduration = 1.0\nsave = "/home/me/.profile"\n',
     '[run]: save = "/home/me/.profile" in a scene file must end in .nc; choose another name, or give it on the'),
])
def test_text_is_no_function_and_results_replace_no_other_file(text, message):
    with pytest.raises(SceneError, match=re.escape(message)):
        loads(text, "scene.toml")


@pytest.mark.parametrize("text", [
    "a" + ".a" * MANY + " = 1\n", "[cable" + ' . "a"' * MANY + "]\n", "[run]\nsave = {a" + ".'a'" * MANY + " = 1}\n"])
def test_keys_of_very_many_parts_are_refused_at_once(text):
    """Python's reader takes time and memory by the square of their number: a minute, and gigabytes, for 100,000."""
    line = text.rstrip().count("\n") + 1
    with pytest.raises(SceneError, match=rf"^x\.toml, line {line}: has a key of more than 100 parts with dots between"):
        loads(text, "x.toml")


def test_other_dots_are_read():
    numbers = "[" + ", ".join(["[0.5, 1.5, .0]".replace(".0", "0.0")] * 500) + "]"
    with pytest.raises(SceneError, match="points"):  # which are read, and all the same
        loads(CABLE.replace("start", f"points = {numbers}\nstart"), "x.toml")


def test_very_long_names_are_shown_in_part():
    with pytest.raises(SceneError) as refused:
        loads("a" * 1_000_000 + " = 1\n" + "".join(f"a{k} = 1\n" for k in range(1000)), "x.toml")
    assert len(str(refused.value)) < 10_000 and "20 errors, and perhaps more" in str(refused.value)


@pytest.mark.parametrize("add", [
    lambda scene, file: scene.modal_body("box", data=file, position=(0, 0, 0)),
    lambda scene, file: scene.fluid(density=1.2, velocity=VelocityTable(file=file))])
def test_arrays_are_measured_before_they_are_read(add, tmp_path):
    """A header of 1.5e9 numbers asked for 11 GiB."""
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (1_500_000_000,)})
    with zipfile.ZipFile(tmp_path / "large.npz", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("nodes.npy", header.getvalue() + bytes(1_500_000))
    with pytest.raises(SceneError, match=r'"\S+large\.npz" has arrays of 1500000000 numbers, most of them in nodes; at '
                                         r"most 100000000 are read; take a coarser grid"):
        add(Scene(), tmp_path / "large.npz")


def test_variables_of_netcdf_are_measured_before_they_are_read(tmp_path, monkeypatch):
    xarray.Dataset({"nodes": ("n", np.zeros(50))}).to_netcdf(tmp_path / "large.nc", engine="scipy")
    monkeypatch.setattr(data_files, "MOST_IN_FILE", 49)
    with pytest.raises(SceneError, match="has arrays of 50 numbers, most of them in nodes; at most 49 are read"):
        Scene().modal_body("box", data=tmp_path / "large.nc", position=(0, 0, 0))
