"""What all values share: strict types, arrays that nobody can change, files of a format."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, fields
from functools import cache
from os import PathLike
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import (
    AllowInfNan,
    ConfigDict,
    GetCoreSchemaHandler,
    NonNegativeInt,
    TypeAdapter,
    ValidationError,
)
from pydantic_core import CoreSchema, PydanticCustomError, core_schema, to_jsonable_python

from cellcolor.errors import InputError, naming
from cellcolor.files.documents import (
    dump_lines,
    is_json,
    parse_json,
    read_document,
    read_text,
    take_body,
    validate,
)
from cellcolor.files.validation import settle

if TYPE_CHECKING:
    import cellcolor

Count = NonNegativeInt

adapter_of: Callable[[Any], TypeAdapter[Any]] = cache(TypeAdapter)
"""What reads the JSON object of a dataclass."""


class Value:
    """A frozen dataclass whose members are what their annotations say.

    Lists and arrays are taken for tuples.

    Raises:
        InputError: a member is of another type; names the member.
    """

    __slots__ = ()
    __pydantic_config__ = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)

    def __post_init__(self) -> None:
        settle(self)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self}>"

    @classmethod
    def from_document(cls, document: dict[str, Any]) -> Self:
        """The value of a parsed JSON object.

        Raises:
            InputError: anything that the format forbids, with the member.
        """
        found: Self = validate(adapter_of(cls), document)
        return found

    def to_document(self) -> dict[str, Any]:
        """The JSON object, without members that are left at their defaults."""
        return self._dumped(short=True)

    def _dumped(self, short: bool) -> dict[str, Any]:
        found: dict[str, Any] = adapter_of(type(self)).dump_python(
            self, mode="json", by_alias=True, exclude_defaults=short
        )
        return found


class Document(Value):
    """A value that is read from files of one format."""

    __slots__ = ()
    FORMAT: ClassVar[str]
    ADDED: ClassVar[tuple[tuple[str, ...], ...]] = ()
    """The members that version 2 added, those that version 3 added, and so on; those of members as
    ``member.name``."""
    ALWAYS: ClassVar[tuple[str, ...]] = ()
    """Members that are written even if they are left at their defaults."""
    LINES: ClassVar[tuple[str, ...]] = ()
    """Members whose elements are written a line each."""
    LAST: ClassVar[tuple[str, ...]] = ()
    """Members that are written after all others."""

    @classmethod
    def from_document(cls, document: dict[str, Any]) -> Self:
        return super().from_document(take_body(document, cls.FORMAT, cls.ADDED))

    def to_document(self) -> dict[str, Any]:
        head = {"format": self.FORMAT, "version": 1 + len(self.ADDED)}
        given, whole = self._dumped(short=True), self._dumped(short=False)
        names = [name for name in whole if name in given or name in self.ALWAYS]
        names.sort(key=lambda name: name in self.LAST)
        return head | {name: given.get(name, whole[name]) for name in names}

    def to_json(self) -> str:
        """The file's text."""
        return dump_lines(self.to_document(), self.LINES)

    @classmethod
    def read(cls, path: str | PathLike[str]) -> Self:
        """The value in a file.

        Raises:
            InputError: the file cannot be read or holds something that the format forbids.
        """
        document = read_document(path)
        with naming(path):
            return cls.from_document(document)


def read_one_of(path: str | PathLike[str], kinds: Collection[type[Document]]) -> Any:
    """The value in a file of one of several formats; of a file of JSON Lines that in the first.

    Raises:
        InputError: the file cannot be read, has another format, or holds something that its format
            forbids.
    """
    text = read_text(path)
    with naming(path):
        head = text.partition("\n")[0]
        document = parse_json(head if is_json(head) else text)
        for kind in kinds:
            if document.get("format") == kind.FORMAT:
                return kind.from_document(document)
        known = " or ".join(repr(kind.FORMAT) for kind in kinds)
        raise InputError(None, "format", f"must be {known}, is {document.get('format')!r}")


class AboutAFile(Document):
    """What is said about a file, whose name is in ``file``; None where it is not named."""

    __slots__ = ()

    def to_document(self) -> dict[str, Any]:
        """The JSON object, the file's name first."""
        members = self._dumped(short=False)
        file = members.pop("file")
        head = {} if file is None else {"file": file}
        return head | {"format": self.FORMAT, "version": 1} | members


def named_members(value: Any, *names: str) -> dict[str, Any]:
    """Some members and properties of a dataclass as JSON has them, in this order."""
    found: dict[str, Any] = to_jsonable_python({name: getattr(value, name) for name in names})
    return found


class Drawn:
    """What can be drawn."""

    __slots__ = ()

    def plot(self, path: str | PathLike[str] | None = None, **view: Any) -> cellcolor.Drawing:
        """Draw it: ``cellcolor.show``.

        Args:
            path: a file .html, .png or .svg; None draws without writing, for notebooks.
            view: what else to look at, see ``cellcolor.show``.

        Raises:
            InputError: the extra ``viz`` is not installed, or the file cannot be written.
        """
        import cellcolor  # the whole package's face, which only somebody who looks at it needs

        return cellcolor.show(self, path, **view)  # type: ignore[arg-type]


class WithArrays:
    """A dataclass with arrays; ``==`` of two arrays is neither true nor false by itself."""

    __slots__ = ()

    def __eq__(self, other: object) -> bool:
        return same_members(self, other) if type(self) is type(other) else NotImplemented

    __hash__ = None  # type: ignore[assignment]  # arrays could be changed


def same_members(one: Any, other: Any) -> bool:
    """Whether two dataclasses of one type hold the same; NaN in an array equals NaN."""
    return all(
        _same(getattr(one, field.name), getattr(other, field.name))
        for field in fields(one)
        if field.compare
    )


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray):
        return np.array_equal(one, other, equal_nan=one.dtype.kind == "f")
    return bool(one == other)


_KINDS: dict[type, tuple[str, str]] = {
    np.float64: ("iuf", "numbers"),
    np.int64: ("iu", "integers"),
    np.bool_: ("b", "true or false"),
}
"""Kinds of numpy that may become one, and what they are called."""


@dataclass(frozen=True)
class ArrayOf:
    """An array's annotation: what stands for it in a file, and what it has to be.

    What it makes is an array of its own, which nobody can change.

    Attributes:
        form: the annotation of what stands for it in a file.
        dtype: of the array.
        width: of its rows, 0 for any; None for an array that is one row.
        gaps: whether NaN is allowed.
    """

    form: Any
    dtype: type
    width: int | None = None
    gaps: bool = False

    def __get_pydantic_core_schema__(
        self, _source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        form = handler.generate_schema(self.form)
        listed = core_schema.plain_serializer_function_ser_schema(lambda own: own.tolist())
        return core_schema.json_or_python_schema(
            core_schema.no_info_after_validator_function(self._made, form),
            core_schema.no_info_wrap_validator_function(self._taken, form),
            serialization=listed,
        )

    def _taken(self, content: Any, handler: Callable[[Any], Any]) -> NDArray[Any]:
        """The array of what Python has, an array or the same as in a file."""
        kinds, text = _KINDS[self.dtype]
        if not isinstance(content, np.ndarray):
            content = handler(content)
        elif content.size and content.dtype.kind not in kinds:
            raise ValueError(f"must be {text}, is an array of {content.dtype}")
        return self._made(content)

    def _made(self, content: Any) -> NDArray[Any]:
        text = _KINDS[self.dtype][1]
        try:
            array: NDArray[Any] = np.array(content, dtype=self.dtype)
        except OverflowError as error:
            raise ValueError("a number is too large") from error
        except ValueError as error:  # rows of different lengths
            raise ValueError(f"must be rows of {text} of one length") from error
        if not array.size and self.width is not None and array.ndim < 2:
            array = array.reshape(0, self.width)
        if array.ndim != (1 if self.width is None else 2):
            raise ValueError(f"must be {'one row' if self.width is None else f'rows of {text}'}")
        if self.width and array.shape[1] != self.width:
            raise ValueError(f"each entry needs {self.width} numbers")
        bad = np.argwhere(np.isinf(array) if self.gaps else ~np.isfinite(array))
        if len(bad):
            fault = PydanticCustomError("value_error", "is not a finite number")
            place = tuple(bad[0].tolist())
            raise ValidationError.from_exception_data(
                "", [{"type": fault, "loc": place, "input": None}]
            )
        array.setflags(write=False)
        return array


_Number = Annotated[float, AllowInfNan()]  # what is no finite number is refused by the array
_Rows = tuple[tuple[_Number, ...], ...]
_Threes = tuple[tuple[_Number, _Number, _Number], ...]
Numbers = Annotated[NDArray[np.float64], ArrayOf(tuple[_Number, ...], np.float64)]
Integers = Annotated[NDArray[np.int64], ArrayOf(tuple[int, ...], np.int64)]
Truths = Annotated[NDArray[np.bool_], ArrayOf(tuple[bool, ...], np.bool_)]
Rows = Annotated[NDArray[np.float64], ArrayOf(_Rows, np.float64, 0)]
RowsWithGaps = Annotated[NDArray[np.float64], ArrayOf(_Rows, np.float64, 0, gaps=True)]
RowsOfThree = Annotated[NDArray[np.float64], ArrayOf(_Threes, np.float64, 3)]
Triples = Annotated[NDArray[np.int64], ArrayOf(tuple[tuple[int, int, int], ...], np.int64, 3)]


def check_lengths(value: Any, names: Collection[str], length: int, of: str) -> None:
    """Refuse members of another length than they need; one that is None needs none.

    Raises:
        InputError: names the member.
    """
    for name in names:
        content = getattr(value, name)
        if content is not None and len(content) != length:
            raise InputError(None, name, f"has {len(content)} entries for {length} {of}")
