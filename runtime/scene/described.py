"""The description of a scene: parts are added, replaced, read, written and checked."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any, Self, TypeVar, cast

from ..errors import SceneError, near
from ..parts.event import Event
from ..parts.kinds import plural_of
from ..parts.modal_body import ModalBody
from ..parts.pairs import pairs_of
from ..parts.part import Part
from ..parts.scene_methods import SceneMethods
from ..parts.scene_text import dumps, read
from ..parts.validation import shown

if TYPE_CHECKING:
    from ..parts.body_shape import Shape

P = TypeVar("P", bound=Part)

MAX_LISTED = 20
"""Number of parts that a message names."""


class DescribedScene(SceneMethods):
    """Base of scenes: parts are checked as they are added."""

    def add(self, part: P) -> P:
        """Add a part, completed from the scene; the methods for each kind end here.

        Returns the part as in the scene. Raises SceneError.
        """
        check_of, _, check_apart_from_ropes, check_plane = _checks()
        if part.is_named():
            if part.given_name is None:
                part = part.model_copy(update={"name": self.free_name(type(part))})
            self.check_name(part)
        if isinstance(part, ModalBody):
            part = part.with_modes_by(_modes_of_mesh)
        check_plane(self, part)
        check_apart_from_ropes(self, part)
        part = check_of(part)(self, part)
        self.put(part)
        return part

    def add_pairs(self, kind: type[P], entries: Mapping[str, Any]) -> list[P]:
        """Add parts of many pairs, such as contacts, by lists among the keywords of `kind`.

        Returns the parts as in the scene, pairs of the first entry of the list first. Raises SceneError; then none of
        them is added.
        """
        _, check_all_of, check_apart_from_ropes, check_plane = _checks()
        pairs = pairs_of(self, kind, entries)
        ends, given = kind.positional, entries.get("name")
        one = kind(**{**entries, **dict(zip(ends, pairs[0], strict=True))})
        numbered = self.free_names(kind, kind.kind if given is None else given, len(pairs))
        names = [{ends[0]: a, ends[1]: b, "name": name} for (a, b), name in zip(pairs, numbered, strict=True)]
        check_plane(self, one)
        if self.ropes:
            for each in names:
                check_apart_from_ropes(self, one.model_copy(update=each))
        parts = cast(list[P], check_all_of(self, one, names))
        for part in parts:
            self.put(part)
        return parts

    def replace(self, part: Part | str, **changes: Any) -> Self:
        """Return a scene like this one with other values of one part, checked as any scene is; this one stays.

        part: its name, or the part itself; changes: by keywords of the part, as in ``scene.replace("trolley",
        friction=fu.Friction(coefficient=0.1))``; None restores the default. Raises SceneError.

        >>> import funicular as fu
        >>> scene = fu.load_scene("paper51")
        >>> scene.replace("A", mass=2.0).bodies["A"].mass, scene.bodies["A"].mass
        (2.0, 1.0)
        """
        return self.changed([(self._part(part), changes)])

    def without(self, *parts: Part | str) -> Self:
        """Return a scene without some parts and those that refer to them, checked as any scene is; this one stays.

        parts: their names, or the parts themselves. Parts that refer to them, such as supports, slides and loads of a
        cable, are named in the new scene's ``messages``. Raises SceneError.

        >>> import funicular as fu
        >>> scene = fu.load_scene("paper51")
        >>> scene.without("A").messages
        ['without rigid_body "A", slide "trolley" was left out, too']
        """
        gone = [self._part(part) for part in parts]
        names = _names_of(gone)
        left, also = [part for part in self.parts() if all(part is not each for each in gone)], []
        while hanging := [part for part in left if not names.isdisjoint(part.refers_to())]:
            also += hanging
            names |= _names_of(hanging)
            left = [part for part in left if all(part is not each for each in hanging)]
        made = self.with_parts(left)
        if also:
            were = "was" if len(also) == 1 else "were"
            made.messages.append(f"without {_listing(gone)}, {_listing(also)} {were} left out, too")
        return made

    def _part(self, part: Part | str) -> Part:
        """Return the part of a name, or this part where it is the scene's. Raises SceneError."""
        parts = list(self.parts())
        for each in parts:
            if each is part or (isinstance(part, str) and each.given_name == part):
                return each
        names = [each.given_name for each in parts if each.given_name is not None]
        if isinstance(part, str):
            raise SceneError("scene", f'there is no part "{part}"', near(part, names))
        raise SceneError("scene", f"has no such part: {shown(part)}", "give its name, or a part that the scene holds")

    @classmethod
    def from_toml(cls, text: str, origin: str = "scene", directory: str | os.PathLike[str] = "",
                  libraries: Iterable[str | os.PathLike[str]] = ()) -> Self:
        """Return a scene from the text of a scene file; ``origin``: its name in messages.

        directory: base of relative paths in the text, by default the working directory; libraries: directories of
        elements that the text may load. Raises SceneError.
        """
        return read(text, origin, cls, directory, libraries)

    def to_toml(self) -> str:
        """Return the scene as the text of a scene file."""
        return dumps(self)

    def check(self) -> None:
        """Check the scene as a whole, as `run` does first. Raises SceneError."""
        from ..checks.whole_scene import check_scene  # likewise

        check_scene(self)

    def __repr__(self) -> str:
        """Return the number of parts of each kind in a line."""
        counts = ", ".join(_counted(len(names), kind.replace("_", " ")) for kind, names in self._names().items())
        return f"<funicular.Scene: {counts or 'empty'}>"

    def _names(self) -> dict[str, list[str]]:
        """Return the names of the parts by kind, of supports those in results."""
        found: dict[str, list[str]] = {}
        for part in self.parts():
            name = part.given_name or getattr(part, "label", part.kind)
            found.setdefault(part.kind, []).append(str(name))
        return found


@cache
def _checks() -> tuple[Callable[..., Any], ...]:
    """Return `check_of`, `check_all_of`, `check_apart_from_ropes` and `check_plane`, imported once."""
    from ..checks.adding import check_all_of, check_of  # not needed to read saved runs
    from ..checks.rope_placement import check_apart_from_ropes  # likewise
    from ..checks.whole_scene import check_plane  # likewise

    return check_of, check_all_of, check_apart_from_ropes, check_plane


def _names_of(parts: list[Part]) -> set[str]:
    """Return the names by which other parts refer to these; names of events are separate."""
    return {part.given_name for part in parts if part.given_name is not None and part.group != Event.group}


def _listing(parts: list[Part]) -> str:
    """Return the names of parts as text."""
    named = [part.where for part in parts[:MAX_LISTED]]
    return ", ".join(named) + (f" and {len(parts) - MAX_LISTED} more" if len(parts) > MAX_LISTED else "")


def _counted(number: int, thing: str) -> str:
    """Return a number of things as text."""
    return f"{number} {thing if number == 1 else plural_of(thing)}"


def _modes_of_mesh(body: ModalBody) -> Shape:
    """Return the modes of a modal body described by a beam."""
    from ..solve.modes.body_modes import of_mesh  # brings SciPy

    return of_mesh(body)
