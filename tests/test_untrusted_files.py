"""Files are data: nothing that a scene, its arrays or its results say is run. Libraries: test_user_elements.py."""

import pickle
import re
import zipfile

import numpy as np
import pytest
from funicular import Scene, SceneError
from funicular.scene_file import loads
from shared_scenes import CABLE

MARKER = []


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
