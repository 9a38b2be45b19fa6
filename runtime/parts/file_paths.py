"""Paths of results in a scene file: they stay below the folder of the file, which may come from a stranger."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path, PureWindowsPath
from typing import Any, Self

from ..errors import SceneError

GIVE = "give it on the command line (-o) or in Python (save=)"
"""The remedy for a refused path."""


class FilePath(str):
    """An output path of a scene file; ``folder``: of the file."""

    folder: str

    def __new__(cls, text: str, folder: str | os.PathLike[str] = "") -> Self:
        """Return the path; folder: of the file, by default the working directory."""
        made = super().__new__(cls, text)
        made.folder = os.fspath(folder)
        return made

    def __getnewargs__(self) -> tuple[str, str]:  # type: ignore[override]  # str's own has one
        """Return text and folder, for copies and other processes."""
        return str(self), self.folder

    def check(self) -> None:
        """Raise ValueError(cause, remedy) where the path leaves the folder or names another kind of file."""
        if not self.endswith(".nc"):  # a scene file must not replace other files
            raise ValueError(f'save = "{self}" in a scene file must end in .nc', f"choose another name, or {GIVE}")
        words = PureWindowsPath(self)  # with drives and both slashes
        if words.drive or words.root or ".." in words.parts:
            raise ValueError(f'save = "{self}" in a scene file must stay below the folder of the file',
                             f"choose a name without folders above, or {GIVE}")

    def placed(self) -> Path:
        """Return the path below the folder, without links. Raises SceneError."""
        try:
            self.check()
        except ValueError as error:
            raise SceneError("run", error.args[0], error.args[1], "save") from None
        path = Path(os.path.realpath(self.folder or os.curdir))
        for word in Path(self).parts:
            path = path / word
            if path.is_symlink():
                raise SceneError("run", f'save = "{self}" in a scene file leads over the link {path}',
                                 f"choose another name, or {GIVE}", "save")
        return path


def save_path(settings: Mapping[str, Any]) -> Path | None:
    """Return the path to which a run saves its results, None without one. Raises SceneError."""
    save = settings.get("save")
    return save.placed() if isinstance(save, FilePath) else None if save is None else Path(save)
