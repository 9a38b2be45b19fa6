"""Digests of scene, programs and initial state, which must be the same when a run is resumed from a checkpoint."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from copy import copy
from pathlib import Path
from typing import Any

import numpy
import scipy
from funicular.generated import kernels

from .. import engine
from ..kernels.libraries import load
from ..model.model import Model
from ..parts.scene_data import SceneData
from ..parts.scene_text import dumps
from ..parts.settings import RunSettings


def facts_of(scene: SceneData, settings: RunSettings) -> dict[str, Any]:
    """Return the facts of a checkpoint that are known before the run starts."""
    bare = copy(scene)
    bare.run_settings = {}
    given = {name: value for name, value in settings.field_values().items() if name not in ("save", "estimate")}
    return {"scene": _digest(dumps(bare).encode()), "settings": json.loads(json.dumps(given, default=str)),
            "programs": programs_of(scene.libraries)}


def _digest(*parts: bytes) -> str:
    """Return the sha256 of joined bytes, in hexadecimal digits."""
    return hashlib.sha256(b"".join(parts)).hexdigest()


def programs_of(libraries: Iterable[str]) -> str:
    """Return the digest of the machine code of a run; libraries: directories of user elements."""
    files = [engine.__file__, kernels.__file__]
    versions = f"{numpy.__version__} {scipy.__version__}"
    return _digest(versions.encode(), *(Path(file).read_bytes() for file in files),
                   *(load(library).digest.encode() for library in libraries))


def start_of(model: Model) -> str:
    """Return the digest of the initial state, in which zeros of both signs and numbers of all types are the same."""
    places = [each for slide in model.slides for each in (slide.s, slide.element, *slide.director.ravel())]
    arrays = (numpy.asarray(each, dtype=float) + 0.0 for each in (model.q, model.v, places))
    return _digest(*(each.tobytes() for each in arrays))
