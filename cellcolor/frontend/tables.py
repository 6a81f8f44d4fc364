"""Tables: the strict, unchanging values that scenes and setups are made of.

A table is the same whether a TOML file has it or Python makes it: every key is known, units stand
in the names, and what a file may not say cannot be said in Python either.
"""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Annotated, Any, ClassVar, Generic, Self, TypeVar

import numpy as np
from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    FiniteFloat,
    SerializerFunctionWrapHandler,
    ValidationError,
    model_serializer,
)

from cellcolor.data.wording import beyond_turns, looks_like_degrees
from cellcolor.errors import InputError, naming
from cellcolor.files.documents import first_fault, read_text
from cellcolor.files.writing import path_of
from cellcolor.registered import find, load

Positive = Annotated[FiniteFloat, Field(gt=0)]
NotNegative = Annotated[FiniteFloat, Field(ge=0)]
Vector = tuple[FiniteFloat, FiniteFloat, FiniteFloat]


def _within_turns(turns: int) -> BeforeValidator:
    """Refuses angles beyond this many full circles: they must be degrees."""

    def check(angle: Any) -> Any:
        if isinstance(angle, (int, float)) and math.isfinite(angle) and beyond_turns(angle, turns):
            raise ValueError(looks_like_degrees(angle))
        return angle

    return BeforeValidator(check)


IN_RADIANS = _within_turns(1)
"""The last mark of a field with an angle: before its own range, degrees are named as such."""
Angle = Annotated[FiniteFloat, IN_RADIANS]
Angles = tuple[Angle, Angle, Angle]
# There are joints that turn by more than a full circle either way.
JointAngle = Annotated[FiniteFloat, _within_turns(2)]
# Far beyond what an arm covers, well within what distances can be computed of.
Length = Annotated[FiniteFloat, Field(ge=1e-6, le=1e6)]
Coordinate = Annotated[FiniteFloat, Field(ge=-1e6, le=1e6)]
Position = tuple[Coordinate, Coordinate, Coordinate]


class Table(BaseModel):
    """A table of a scene or setup.

    Lists and arrays of numpy are taken for tuples. Keys in ``NEWER`` came after others; they are
    not written where they have their default, so that older surfaces stay the same to the byte.

    Raises:
        InputError: an unknown or missing key, a value of the wrong type or out of range; names the
            key.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)
    NEWER: ClassVar[tuple[str, ...]] = ()

    def __init__(self, /, **content: Any) -> None:
        try:
            self.__pydantic_validator__.validate_python(_settled(content), self_instance=self)
        except ValidationError as error:
            raise _fault(error) from error

    # Without this mark pydantic would call __init__ for a table inside another one, and the error
    # would not know where in the outer one it is.
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    @model_serializer(mode="wrap")
    def _newer_if_given(self, whole: SerializerFunctionWrapHandler) -> dict[str, Any]:
        content: dict[str, Any] = whole(self)
        for name in self.NEWER:
            usual = type(self).model_fields[name].get_default(call_default_factory=True)
            if getattr(self, name) == usual:
                content.pop(name, None)
        return content

    def __hash__(self) -> int:
        """Pydantic's own does not bear keys that hold tables with names of the user's."""
        values = (getattr(self, name) for name in type(self).model_fields)
        held = (frozenset(v.items()) if isinstance(v, dict) else v for v in values)
        return hash((type(self), *held))

    def varied(self, **changes: Any) -> Self:
        """The same table with some keys changed.

        A mapping for a key that holds a table changes keys of that table, unless it has a ``kind``
        of its own: then it is a new one.

        Raises:
            InputError: as when the table is made; names the key.
        """
        content = {name: getattr(self, name) for name in type(self).model_fields}
        for key, change in changes.items():
            old = content.get(key)
            if isinstance(change, Mapping) and isinstance(old, Table) and "kind" not in change:
                try:
                    change = old.varied(**change)
                except InputError as error:
                    place = f"{key}.{error.field}" if error.field else key
                    raise InputError(None, place, error.message) from error
            content[key] = change
        return type(self)(**content)


class FileTable(Table):
    """A table that is a whole file, or could be.

    Attributes:
        folder: what the names of other files in it are relative to.
        file: where it was read, for errors; None for one that was made or varied in Python.
    """

    folder: Annotated[Path, BeforeValidator(lambda name: Path(name)), Field(exclude=True)] = Path()
    file: Annotated[Path | None, Field(exclude=True)] = None

    @classmethod
    def read(cls, file: str | PathLike[str]) -> Self:
        """Read a TOML file.

        Raises:
            InputError: unreadable, not TOML, or what :class:`Table` refuses; names the file and
                the key.
        """
        path = path_of(file)
        content = _toml(path)
        for name in FileTable.model_fields:
            if name in content:
                raise InputError(str(path), name, "unknown key")
        with naming(path):
            return cls(**content, folder=path.parent, file=path)

    def varied(self, **changes: Any) -> Self:
        """The same table with some keys changed; see :meth:`Table.varied`."""
        return super().varied(**({"file": None} | changes))


def _toml(file: Path) -> dict[str, Any]:
    text = read_text(file)
    if _LONG_KEY.search(text):  # tomllib takes memory with the square of a key's parts
        raise InputError(str(file), None, "not usable TOML: a key of more than 50 parts")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(str(file), None, f"not TOML: {error}") from error
    except RecursionError as error:
        raise InputError(str(file), None, "not usable TOML: nested too deeply") from error
    except ValueError as error:
        message = "not usable TOML: a number with too many digits"
        raise InputError(str(file), None, message) from error


_LONG_KEY = re.compile(r"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){50}""")


def _settled(content: Any) -> Any:
    """Lists and arrays as tuples, numbers of numpy as Python's; all else as it is.

    Strict validation takes no list for a tuple, and TOML's arrays are lists.
    """
    if isinstance(content, dict):
        return {key: _settled(item) for key, item in content.items()}
    if isinstance(content, (np.ndarray, np.generic)) and content.ndim < 2:  # larger: of a mesh
        content = content.tolist()
    return tuple(map(_settled, content)) if isinstance(content, (list, tuple)) else content


_GONE = {
    "border_length_m": "for exact borders give the object a finer mesh, by max_edge_m (of a file) "
    "or target_vertices (of a shape)",
    "faces_file": "give these faces as the object, and the whole part as the collision_object",
}
"""Keys that files of earlier versions have, and what takes their place."""


def _fault(error: ValidationError) -> InputError:
    """The first fault: ``("object", "radius_m")`` as ``object.radius_m``."""
    place, message = first_fault(error)
    if message == "unknown key" and place[-1] in _GONE:
        message = f"is no longer known: {_GONE[str(place[-1])]}"
    key = ""
    for part in place:
        key += f"[{part}]" if isinstance(part, int) else f".{part}" if key else part
    return InputError(None, key or None, message)


T = TypeVar("T")
Kind = TypeVar("Kind", bound=Table)


class Registry(Generic[T]):
    """Classes of one sort, such as all parts, by the name that files have for them."""

    def __init__(self, group: str, base: type[T], own: Mapping[str, str]) -> None:
        """Register the classes of this package.

        Args:
            group: of entry points, in which other distributions register theirs.
            base: what every class has to be derived from.
            own: the classes of this package by name, each written as ``module:class``.
        """
        self._group, self.base, self._own = group, base, own

    def find(self, name: str, field: str | None = None) -> type[T]:
        """The class of that name, which a file has in a field.

        Raises:
            InputError: no class has this name, or two have it; it cannot be imported; or it is not
                derived from the base class.
        """
        point = find(name, self._own, self._group, field)
        loaded = load(point, field)
        if not (isinstance(loaded, type) and issubclass(loaded, self.base)):
            message = f"{name!r} ({point.value}) is no {self.base.__name__}"
            raise InputError(None, field, message)
        return loaded


def of_kind(registry: Registry[Kind], content: object) -> Kind:
    """Read a file's table as the class that its key ``kind`` names; take a value as it is.

    Validators of pydantic call this, so errors are raised in the way that pydantic expects.
    """
    if isinstance(content, registry.base):
        return content
    if not isinstance(content, Mapping):
        raise ValueError("must be a table with a kind")
    kind = content.get("kind")
    if not isinstance(kind, str):
        raise ValueError("needs a kind, in quotation marks")
    try:
        found = registry.find(kind)
    except InputError as error:
        raise ValueError(error.message) from error
    return found.model_validate(content)
