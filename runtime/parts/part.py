"""The base of the parts of a scene, and its messages on entries that it refuses.

Annotations are no texts: pydantic would evaluate those of the base once more for each kind of part.
"""

import inspect
from collections.abc import Iterable, Iterator, Mapping
from functools import cache, cached_property
from itertools import chain
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Self, get_args

from pydantic import BaseModel, ConfigDict, PlainValidator, ValidationError, model_validator

from ..base.deferred import dataclass
from ..errors import SceneError, near, shown_path
from .plugins import no_plugins
from .quantity import Quantity
from .schemas import AXIS, DIRECTION, HOLDER, ORIENTATION, POINT, TABLE_OF, About, Check, Turning, checked
from .validation import NAMES_A_PART, show, shown

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
    from pydantic.fields import FieldInfo
    from pydantic_core import ErrorDetails
else:
    ModelMetaclass = type(BaseModel)  # pydantic exports its metaclass in no other way


def parameters_of(kind: "type[Part]") -> list[inspect.Parameter]:
    """Return the entries of a part as parameters: positional ones of its kind, required ones, others, its name.

    None stands for a default that is not fixed.
    """
    known = kind.model_fields  # pydantic takes a while for each look
    fields = {keyword: known[name] for keyword, name in kind.keywords().items()}
    others = [name for name in fields if name not in kind.positional]
    others.sort(key=lambda name: (not fields[name].is_required(), name == "name"))
    return [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=_default(fields[name]))
            for name in (*kind.positional, *others) if name in fields]


def _default(field: "FieldInfo") -> Any:
    """Return the default of a field in a signature."""
    if field.is_required():
        return inspect.Parameter.empty
    default = None if field.default_factory is not None else field.default
    return default.as_given() if isinstance(default, Part) else default


class _TranslatingType(ModelMetaclass):
    """Makes a constructor call raise `SceneError`.

    A model inside another one does not pass here and reports to pydantic, which knows the path to it.
    """

    @property
    def __signature__(cls) -> inspect.Signature:  # noqa: N805  it is a metaclass
        """The entries of the part, for `help`, notebooks and editors; pydantic shows ``**data``."""
        return inspect.Signature(parameters_of(cls))  # type: ignore[arg-type]  # its one user is Part

    @__signature__.setter
    def __signature__(cls, made: Any) -> None:  # noqa: N805
        """Ignore the signature that pydantic makes, of annotations with all their validators."""

    def __call__(cls, /, *given: Any, **data: Any) -> Any:  # noqa: N805  it is a metaclass
        known = cls.keywords()  # type: ignore[attr-defined]  # of its one user, Part
        positional = [name for name in cls.positional if name in known]  # type: ignore[attr-defined]
        data |= dict(zip(positional, given, strict=False))
        if len(given) > len(positional):
            example = ", ".join(f"{name}=..." for name in list(inspect.signature(cls).parameters)[:max(2, len(given))])
            raise SceneError(cls.__name__, f"takes its values by name, got {len(given)} without one",
                             f"write {cls.__name__}({example})")
        complaints: list[ErrorDetails] = []
        try:
            made = super().__call__(**{name: value for name, value in data.items() if name in known})
            if data.keys() <= known.keys():
                return made
        except ValidationError as error:
            complaints = error.errors(include_url=False)
        place = cls.title(data)  # type: ignore[attr-defined]
        found = [*(SceneError(place, *_unknown(name, known), entry=name) for name in data if name not in known),
                 *(_of_complaint(place, each, known) for each in complaints
                   if each["type"] != "default_factory_not_called")]
        found[0].errors = tuple(found)
        raise found[0]


class Part(BaseModel, metaclass=_TranslatingType):
    """Base of the parts of a scene: frozen, and strict about names."""

    model_config = ConfigDict(frozen=True, defer_build=True, protected_namespaces=())  # built when first used

    kind: ClassVar[str] = ""
    """Its name in messages and scene files; the class name where this is empty."""

    group: ClassVar[str] = ""
    """The attribute of a scene that holds such parts."""

    tag: ClassVar[str] = ""
    """The entry of a table that says which kind of a `Family` it describes; also the attribute that names the kind."""

    positional: ClassVar[tuple[str, ...]] = ("name",)
    """Keywords that are also positional arguments."""

    takes_lists: ClassVar[bool] = False
    """Whether the two positional entries may be lists where parts are added, see `pairs`."""

    parts_within: ClassVar["tuple[type[Part], ...]"] = ()
    """Classes of parts in it whose names are names of results."""
    results: ClassVar[dict[str, Quantity]] = {}
    """Its results, beside the nodal vectors of cables and the modes of bodies."""

    of_scene: ClassVar[tuple[str, ...]] = ()
    """Its fields that repeat a value of the scene where they were not given: scene files leave them out."""

    def __setattr__(self, name: str, value: Any) -> None:
        """Refuse changes, which the scene would not check."""
        if name in type(self).model_fields or name in self.keywords():
            example = f'scene.replace("{self.given_name}", {name}=...)' if self.given_name else f"{name}=..."
            raise SceneError(self.where, f"{name} cannot be changed once the part is made",
                             f"make another part, or another scene: {example}")
        super().__setattr__(name, value)

    def as_given(self) -> Any:
        """Return its short form in Python and scene files, by default itself."""
        return self

    @classmethod
    def title(cls, data: dict[str, Any]) -> str:
        """Return the name in messages of a part with these entries."""
        kind = cls.kind or cls.__name__
        return f'{kind} "{data["name"]}"' if isinstance(data.get("name"), str) else kind

    @classmethod
    def keywords(cls) -> Mapping[str, str]:
        """Return the fields of a part by keyword."""
        return _keywords(cls)

    @classmethod
    def is_named(cls) -> bool:
        """Return whether such parts have names."""
        return "name" in _keywords(cls)

    def entries(self) -> dict[str, Any]:
        """Return its entries by keyword, defaults included, None left out."""
        given = {keyword: getattr(self, field) for keyword, field in self.keywords().items()}
        return {keyword: value for keyword, value in given.items() if value is not None}

    def field_values(self, given: bool = False) -> dict[str, Any]:
        """Return its values by field; given: only those that were given.

        pydantic's model_dump turns Ctrl-C into an error of its own.
        """
        return {name: getattr(self, name) for name in type(self).model_fields
                if not given or name in self.model_fields_set}

    def remade(self, changes: Mapping[str, Any]) -> Self:
        """Return a part with changes of its entries, by keyword; None leaves an entry out."""
        return type(self)(**self.entries_with(changes))

    def entries_with(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        """Return the entries with changes, by keyword; None leaves an entry out."""
        return {keyword: value for keyword, value in {**self.as_made().entries(), **changes}.items()
                if value is not None}

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Return a copy with other values of fields, which count as given, in a quarter of the time of pydantic's,
        which allows for entries beside the fields.
        """
        if deep or self.__pydantic_private__ is not None:
            return super().model_copy(update=update, deep=deep)
        return self._copied(update or {}, self.__pydantic_fields_set__.union(update or ()))

    def __copy__(self) -> Self:
        """Return a copy with the same values."""
        return self.model_copy() if self.__pydantic_private__ is None else super().__copy__()

    def _copied(self, update: Mapping[str, Any], given: set[str]) -> Self:
        """Return a copy with other values, without what was computed of the old; given: fields that were given."""
        made, put, values = object.__new__(type(self)), object.__setattr__, self.__dict__
        if update and len(values) > len(fields := type(self).model_fields):
            values = {name: values[name] for name in fields}
        put(made, "__dict__", {**values, **update})
        put(made, "__pydantic_fields_set__", given)
        put(made, "__pydantic_extra__", None)
        put(made, "__pydantic_private__", None)
        return made

    def completed(self, found: Mapping[str, Any]) -> Self:
        """Return this part with values, by field, that its scene found; they count as not given."""
        if self.__pydantic_private__ is None:
            return self._copied(found, {*self.__pydantic_fields_set__})
        made = self.model_copy(update=dict(found))
        made.model_fields_set.intersection_update(self.model_fields_set)
        return made

    def as_made(self) -> Self:
        """Return this part without the values that its scene found, except its name."""
        values, given = self.__dict__, self.__pydantic_fields_set__
        found = [name for name in _completed_fields(type(self)) if values[name] is not None and name not in given]
        return self.completed(dict.fromkeys(found)) if found else self

    def refers_to(self) -> Iterator[str]:
        """Yield the names of the parts that it needs in a scene."""
        kind = type(self)
        naming = _naming_fields(kind)
        for name in kind.model_fields:
            value = getattr(self, name)
            if isinstance(value, Part):
                yield from value.refers_to()
            elif isinstance(value, str) and name in naming:
                yield value

    def named_within(self) -> "Iterator[Part]":
        """Yield the parts in it whose names are names of results, as its own."""
        return iter(())

    @property
    def given_name(self) -> str | None:
        """Return its name, None where it has none yet."""
        return getattr(self, "name", None)

    @property
    def where(self) -> str:
        """Return its name in messages."""
        return self.title(vars(self))

    def off_plane(self) -> Iterator[str]:
        """Yield, in words, its quantities and those of its parts that leave the plane z = 0 of a planar scene.

        A part with the axes of its holder leaves its vectors to that.
        """
        about = about_fields(type(self))
        for name, value in self:
            turning = about.get(name)
            if isinstance(value, Part):
                yield from (f"{name} {quantity}" for quantity in value.off_plane())
            elif isinstance(turning, Turning) and isinstance(value, tuple) and turning.lies and turning.of != HOLDER:
                across = ACROSS.get(turning.turns, slice(0))
                vectors = value if isinstance(value[0], tuple) else (value,)
                yield from (f"{name} {show(each, turning.unit)}" for each in vectors if any(each[across]))

    @classmethod
    def model_rebuild(cls, **options: Any) -> bool | None:
        """Make the validator of the part, at its first use, without plugins of pydantic."""
        with no_plugins():
            return super().model_rebuild(**options)

    @model_validator(mode="before")
    @classmethod
    def _knows_all_names(cls, data: Any) -> Any:
        if isinstance(data, dict):
            known = cls.keywords()
            if not data.keys() <= known.keys():
                raise ValueError(*_unknown(next(key for key in data if key not in known), known))
        return data


Part.__annotations__.clear()  # of class attributes, which pydantic would evaluate once more for each kind of part


@cache
def _keywords(kind: type[Part]) -> Mapping[str, str]:
    """Return the fields of a kind of part by keyword."""
    return MappingProxyType({field.alias or name: name for name, field in kind.model_fields.items()})


@cache
def _completed_fields(kind: type[Part]) -> tuple[str, ...]:
    """Return the fields of a kind of part that a scene may complete: those without a value by default."""
    return tuple(name for name, field in kind.model_fields.items()
                 if name != "name" and field.default_factory is None and field.default is None)


ACROSS = {POINT: slice(2, 3), DIRECTION: slice(2, 3), AXIS: slice(2), ORIENTATION: slice(1, 3)}
"""Components that are zero in the plane z = 0."""


def names_a_part(field: "FieldInfo") -> bool:
    """Return whether a field holds the name of another part."""
    return any(mark is NAMES_A_PART for mark in _marks(field))


@cache
def _naming_fields(kind: type[Part]) -> frozenset[str]:
    """Return the fields of a kind of part that hold names of other parts."""
    return frozenset(name for name, field in kind.model_fields.items() if names_a_part(field))


@cache
def about_fields(kind: type[Part]) -> dict[str, About]:
    """Return how vectors turn, the cables of arc-lengths, and paths, by field of a kind of part."""
    return {name: mark.about for name, field in kind.model_fields.items() for mark in _marks(field)
            if isinstance(mark, Check) and mark.about is not None}


def _marks(field: "FieldInfo") -> Iterator[Any]:
    """Yield types, marks and checks in the annotation of a field."""

    def inner(annotation: Any) -> Iterator[Any]:
        for each in (*get_args(annotation), *getattr(annotation, "__metadata__", ())):
            yield each
            yield from inner(each)

    return chain(field.metadata, inner(field.annotation))


def _unknown(name: str, known: Iterable[str]) -> tuple[str, str]:
    """Return cause and remedy for an unknown name."""
    return f'"{shown_path(name)}" is not known here', near(name, known)


def _of_complaint(place: str, complaint: "ErrorDetails", known: Mapping[str, str]) -> SceneError:
    """Return the error of a part at a place from a complaint of pydantic; known: its fields by keyword."""
    loc = complaint["loc"]
    if loc and loc[0] in known.values():  # pydantic names a default by its field
        loc = next(keyword for keyword, field in known.items() if field == loc[0]), *loc[1:]
    path, remedy = ".".join(map(str, loc)), None
    match complaint["type"]:
        case "value_error":
            cause, remedy = (*complaint["ctx"]["error"].args, None)[:2]
        case "missing":
            cause = "is missing"
        case "model_type":
            name = complaint["ctx"]["class_name"]
            cause = f"must be a {name} or a table of its values, got {shown(complaint['input'])}"
        case _:
            message = complaint["msg"]
            cause = f"{message[:1].lower() + message[1:]}, got {shown(complaint['input'])}"
    return SceneError(place, f"{path} {cause}".strip(), remedy, str(loc[0]) if loc else None)


@dataclass(frozen=True)
class Family:
    """Alternative kinds of one field, given as a part or as a table such as {shape="circle", radius=0.01}.

    name: in the JSON Schema of scene files; example: of a value, in messages; kinds: that the entry `Part.tag` of a
    table names; base: class of all values of the field, by default the kinds.
    """

    name: str
    example: str
    kinds: tuple[type[Part], ...]
    base: type[Part] | None = None

    def __post_init__(self) -> None:
        FAMILIES[self.name] = self

    @cached_property
    def by_tag(self) -> dict[str, type[Part]]:
        """Return the kinds by their names in tables."""
        return {getattr(kind, kind.tag): kind for kind in self.kinds}

    @property
    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema of a table, a reference for `scene.schema`."""
        return {TABLE_OF: self.name}

    def checked(self) -> PlainValidator:
        """Return the check of a part of this family."""
        return checked(self.part, self.schema)

    def part(self, value: Any, *remedy: str) -> Any:
        """Return the part that a value is or describes; remedy: for a value that is neither. Raises ValueError."""
        if isinstance(value, self.base or self.kinds):
            return value
        if not isinstance(value, dict):
            raise ValueError(f"must be {self.example}, got {shown(value)}", *remedy)
        known, tag = self.by_tag, self.kinds[0].tag
        data = dict(value)
        kind = data.pop(tag, None)
        if kind is None:
            raise ValueError(f"has no {tag}", "known: " + ", ".join(known))
        if not isinstance(kind, str):
            raise ValueError(f"has the {tag} {shown(kind)}, not a name", "known: " + ", ".join(known))
        if kind not in known:
            raise ValueError(f'has the unknown {tag} "{kind}"', near(kind, known))
        return known[kind].model_validate(data)


FAMILIES: dict[str, Family] = {}
"""All families by name."""
