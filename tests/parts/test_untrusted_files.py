"""Files are data: scenes, arrays and results execute no code. Libraries: test_user_elements.py."""

import io
import json
import os
import pickle
import re
import zipfile

import numpy as np
import pytest
import xarray
from funicular import FunicularError, Scene, SceneError, VelocityTable, load_scene
from funicular.base import bounded_files
from funicular.scene.file import loads
from funicular.view.mesh_files import read_mesh
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
    """The TOML reader needs time and memory in proportion to the square of the number of keys' parts: a minute and
    gigabytes for 100,000.
    """
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
    """A header that announces 1.5e9 numbers would allocate 11 GiB."""
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (1_500_000_000,)})
    with zipfile.ZipFile(tmp_path / "large.npz", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("nodes.npy", header.getvalue() + bytes(1_500_000))
    with pytest.raises(SceneError, match=r'"\S+large\.npz" has arrays of 1500000000 numbers, most of them in nodes; at '
                                         r"most 100000000 are read; take a coarser grid"):
        add(Scene(), tmp_path / "large.npz")


def test_variables_of_netcdf_are_measured_before_they_are_read(tmp_path, monkeypatch):
    xarray.Dataset({"nodes": ("n", np.zeros(50))}).to_netcdf(tmp_path / "large.nc", engine="scipy")
    monkeypatch.setattr(bounded_files, "MAX_NUMBERS", 49)
    with pytest.raises(SceneError, match="has arrays of 50 numbers, most of them in nodes; at most 49 are read"):
        Scene().modal_body("box", data=tmp_path / "large.nc", position=(0, 0, 0))


def sparse(path, size):
    """Make a sparse file of zeros; return its path."""
    path.touch()
    os.truncate(path, size)
    return path


@pytest.mark.parametrize("name", ["large.npz", "large.nc"])
def test_bytes_of_arrays_are_bounded(name, tmp_path):
    file = sparse(tmp_path / name, 1_000_000_001)
    with pytest.raises(SceneError, match=r'^modal_body "box": .*"\S+large\.\w+" has 1000000001 bytes; at most '
                                         "1000000000 are read; take a coarser grid"):
        Scene().modal_body("box", data=file, position=(0, 0, 0))


def test_members_of_one_name_are_all_measured(tmp_path, monkeypatch):
    """NumPy reads the member "nodes" in place of "nodes.npy", whose size was checked."""
    monkeypatch.setattr(bounded_files, "MAX_NUMBERS", 49)
    with zipfile.ZipFile(tmp_path / "two.npz", "w") as archive:
        for name, size in (("nodes", 50), ("nodes.npy", 1)):
            with archive.open(name, "w") as member:
                np.save(member, np.zeros(size))
    with pytest.raises(SceneError, match="has arrays of 51 numbers, most of them in nodes; at most 49 are read"):
        Scene().modal_body("box", data=tmp_path / "two.npz", position=(0, 0, 0))


def test_the_text_of_a_scene_is_bounded(tmp_path):
    with pytest.raises(SceneError, match=r"large\.toml: has 50000001 bytes; at most 50000000 are read; keep long tab"):
        load_scene(sparse(tmp_path / "large.toml", 50_000_001))


@pytest.mark.parametrize("name", ["large.stl", "large.glb", "large.gltf"])
def test_bytes_of_meshes_are_bounded(name, tmp_path):
    pytest.importorskip("trimesh")
    with pytest.raises(FunicularError, match=r"large\.\w+: has 200000001 bytes; at most 200000000 are read; take"):
        read_mesh(sparse(tmp_path / name, 200_000_001))


def gltf(path, buffer="corners.bin", count=3, parts=1, nodes=1):
    """Write a glTF file of a triangle; return its path. parts: its surfaces; nodes: the number of their instances."""
    (path.parent / "corners.bin").write_bytes(np.eye(3, dtype="<f4").tobytes())
    stored = {} if count > 3 else {"bufferView": 0}
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [*range(nodes)]}],
        "nodes": [{"mesh": 0}] * nodes, "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}] * parts}],
        "accessors": [{"componentType": 5126, "count": count, "type": "VEC3"} | stored],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": buffer, "byteLength": 36}]}))
    return path


def test_a_mesh_is_read_with_its_files(tmp_path):
    pytest.importorskip("trimesh")
    vertices, triangles = read_mesh(gltf(tmp_path / "t.gltf", parts=2, nodes=3))
    assert len(triangles) == 6 and sorted(map(tuple, np.unique(vertices, axis=0))) == [(0, 0, 1), (0, 1, 0), (1, 0, 0)]


@pytest.mark.parametrize(("given", "message"), [
    ({"count": 10**12}, "has surfaces of 6000000000000 numbers, most of them in array 0; at most 100000000 are read"),
    ({"count": -10**12}, "cannot be read as a mesh: an array has a negative length"),
    ({"buffer": "/dev/zero"}, 'it names "/dev/zero", which is no file in its folder or below'),
    ({"buffer": "../far.bin"}, 'it names "../far.bin", which is no file in its folder or below'),
    ({"buffer": "link.bin"}, 'it names "link.bin", which is no file in its folder or below'),
    ({"buffer": "large.bin"}, "has 200000000 bytes; at most 1999")])
def test_what_a_mesh_names_is_bounded(given, message, tmp_path):
    pytest.importorskip("trimesh")
    (tmp_path / "far.bin").write_bytes(bytes(36))
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "link.bin").symlink_to("/dev/zero")
    sparse(tmp_path / "folder" / "large.bin", 200_000_000)
    with pytest.raises(FunicularError, match=re.escape(message)):
        read_mesh(gltf(tmp_path / "folder" / "t.gltf", **given))


@pytest.mark.parametrize(("given", "total"), [({"parts": 100}, 909), ({"nodes": 100}, 900)])
def test_a_surface_that_is_used_many_times_counts_as_often(given, total, tmp_path, monkeypatch):
    pytest.importorskip("trimesh")
    monkeypatch.setattr(bounded_files, "MAX_NUMBERS", 899)
    with pytest.raises(FunicularError, match=f"has surfaces of {total} numbers, .* at most 899 are read; take a coar"):
        read_mesh(gltf(tmp_path / "t.gltf", **given))
