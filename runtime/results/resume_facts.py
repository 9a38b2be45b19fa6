"""What must be the same for a run to go on from a checkpoint: digests of its scene, programs and start."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from copy import copy
from pathlib import Path

import numpy
import scipy
from funicular.generated import kernels

from .. import engine
from ..kernels.libraries import load
from ..model.model import Model
from ..parts.scene_data import SceneData
from ..parts.scene_text import dumps
from ..parts.settings import RunSettings


def facts_of(scene: SceneData, settings: RunSettings) -> dict:
    """Return what is known of a run before it starts, as `Facts` of a checkpoint have it."""
    alone = copy(scene)
    alone.run_settings = {}
    said = {name: value for name, value in settings.field_values().items() if name not in ("save", "estimate")}
    return {"scene": _digest(dumps(alone).encode()), "settings": json.loads(json.dumps(said, default=str)),
            "programs": programs_of(scene.libraries)}


def _digest(*parts: bytes) -> str:
    """Return the sha256 of bytes one after the other, in hexadecimal digits."""
    digest = hashlib.sha256()
    for part in parts:
        digest.update(part)
    return digest.hexdigest()


def programs_of(libraries: Iterable[str]) -> str:
    """Return the digest of the machine code that computes a run; libraries: directories of its elements."""
    files = [engine.__file__, kernels.__file__]
    versions = f"{numpy.__version__} {scipy.__version__}"
    return _digest(versions.encode(), *(Path(file).read_bytes() for file in files),
                   *(load(library).digest.encode() for library in libraries))


def start_of(model: Model) -> str:
    """Return the digest of the state that a run starts from."""
    places = [(slide.s, slide.element, slide.director.tolist()) for slide in model.slides]
    return _digest(model.q.tobytes(), model.v.tobytes(), repr(places).encode())
