"""What all values share: strict types, arrays that nobody can change, files of a format."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, fields
from functools import cache
from os import PathLike
from typing import Annotated, Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, GetCoreSchemaHandler, NonNegativeInt, TypeAdapter
from pydantic_core import CoreSchema

from cellcolor.errors import InputError
from cellcolor.files.documents import read_as, take_body, validate
from cellcolor.files.validation import LeftToNumpy, settle

Count = NonNegativeInt


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


class Document(Value):
    """A value that is read from files of one format."""

    __slots__ = ()
    FORMAT: ClassVar[str]
    ADDED: ClassVar[tuple[tuple[str, ...], ...]] = ()
    """The members that version 2 added, those that version 3 added, and so on; those of members as
    ``member.name``."""

    @classmethod
    def from_document(cls, document: dict[str, Any]) -> Self:
        """The value of a parsed JSON object.

        Raises:
            InputError: anything that the format forbids, with the member.
        """
        body = take_body(document, cls.FORMAT, cls.ADDED)
        found: Self = validate(adapter_of(cls), body)
        return found

    @classmethod
    def read(cls, path: str | PathLike[str]) -> Self:
        """The value in a file.

        Raises:
            InputError: the file cannot be read or holds something that the format forbids.
        """
        return read_as(path, cls.from_document)


class AboutAFile(Document):
    """What is said about a file, whose name is in ``file``."""

    __slots__ = ()

    def to_document(self) -> dict[str, Any]:
        """The JSON object, the file's name first."""
        value: Any = self
        members = asdict(value)
        return {"file": members.pop("file"), "format": self.FORMAT, "version": 1} | members


adapter_of: Callable[[Any], TypeAdapter[Any]] = cache(TypeAdapter)
"""What reads the JSON object of a dataclass."""


def given_members(value: Any) -> dict[str, Any]:
    """The members of a dataclass that are not None, by name, in their order."""
    members = {field.name: getattr(value, field.name) for field in fields(value)}
    return {name: content for name, content in members.items() if content is not None}


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


@dataclass(frozen=True)
class _InFile(LeftToNumpy):
    """An array's annotation: what stands for it in a file."""

    form: Any

    def __get_pydantic_core_schema__(
        self, _source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return handler.generate_schema(self.form)


Numbers = Annotated[NDArray[np.float64], _InFile(list[float])]
Integers = Annotated[NDArray[np.int64], _InFile(list[int])]
Truths = Annotated[NDArray[np.bool_], _InFile(list[bool])]
Rows = Annotated[NDArray[np.float64], _InFile(list[list[float]])]
RowsOfThree = Annotated[NDArray[np.float64], _InFile(list[tuple[float, float, float]])]
Triples = Annotated[NDArray[np.int64], _InFile(list[tuple[int, int, int]])]


def rows_of(content: Any, width: int, member: str) -> NDArray[np.float64]:
    """An array (k, width) of finite float64.

    Raises:
        InputError: it has another shape, or something in it is no finite number.
    """
    array = _array(content, np.float64, "iuf", "numbers", member)
    if array.size == 0:
        array = array.reshape(0, width)
    if array.ndim != 2 or array.shape[1] != width:
        raise InputError(None, member, f"each entry needs {width} numbers")
    return _finite(array, member)


def numbered_rows(content: Any, member: str) -> NDArray[np.float64]:
    """An array (k, m) of float64, NaN allowed, of whatever width.

    Raises:
        InputError: it has another shape, or something in it is infinite or no number.
    """
    array = _array(content, np.float64, "iuf", "numbers", member)
    if array.ndim != 2:
        raise InputError(None, member, "must be rows of numbers")
    bad = np.argwhere(np.isinf(array))
    if len(bad):
        raise InputError(None, f"{member}[{bad[0][0]}][{bad[0][1]}]", "is infinite")
    return _settled(array)


def rows_of_three(content: Any, member: str) -> NDArray[np.float64]:
    """An array (k, 3) of finite float64; see :func:`rows_of`."""
    return rows_of(content, 3, member)


def numbers(content: Any, member: str) -> NDArray[np.float64]:
    """An array (k,) of finite float64.

    Raises:
        InputError: it has another shape, or something in it is no finite number.
    """
    return _finite(_flat(_array(content, np.float64, "iuf", "numbers", member), member), member)


def integers(content: Any, member: str) -> NDArray[np.int64]:
    """An array (k,) of int64.

    Raises:
        InputError: it has another shape, or something in it is no integer.
    """
    return _settled(_flat(_array(content, np.int64, "iu", "integers", member), member))


def truths(content: Any, member: str) -> NDArray[np.bool_]:
    """An array (k,) of true and false.

    Raises:
        InputError: it has another shape, or something in it is neither.
    """
    return _settled(_flat(_array(content, np.bool_, "b", "true or false", member), member))


def _array(content: Any, kind: type, kinds: str, text: str, member: str) -> NDArray[Any]:
    try:
        array = np.array(content)
    except ValueError as error:  # rows of different lengths
        raise InputError(None, member, f"must be rows of {text} of one length") from error
    if array.size and array.dtype.kind not in kinds:
        raise InputError(None, member, f"must be {text}")
    return array.astype(kind)


def _flat(array: NDArray[Any], member: str) -> NDArray[Any]:
    if array.ndim != 1:
        raise InputError(None, member, "must be one row")
    return array


def _finite(array: NDArray[Any], member: str) -> NDArray[Any]:
    bad = np.argwhere(~np.isfinite(array))
    if len(bad):
        place = "".join(f"[{number}]" for number in bad[0])
        raise InputError(None, f"{member}{place}", "is not a finite number")
    return _settled(array)


def _settled(array: NDArray[Any]) -> NDArray[Any]:
    array.setflags(write=False)
    return array
