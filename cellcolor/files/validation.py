"""Values made in Python: checked for the same types as values read from JSON."""

from __future__ import annotations

import json
import re
from abc import ABC, abstractmethod
from dataclasses import fields
from functools import cache
from types import NoneType
from typing import Any, TypeVar, get_args, get_type_hints

import numpy as np
from pydantic import ConfigDict, TypeAdapter, ValidationError
from pydantic.fields import FieldInfo

from cellcolor.errors import InputError
from cellcolor.files.documents import field_name, first_fault

T = TypeVar("T")

_STRICT = ConfigDict(strict=True, allow_inf_nan=False)


class LeftToNumpy(ABC):
    """Annotates members that are arrays of numpy, which :func:`settle` has made by it."""

    @abstractmethod
    def of(self, content: Any, member: str) -> Any:
        """The array of what was given for a member.

        Raises:
            InputError: it cannot be made of that.
        """


def settle(value: object) -> None:
    """Hold a dataclass's members to their annotations, and normalise what Python knows more of.

    Lists and arrays become tuples, numbers of numpy Python's own; anything else that JSON would
    not take for the member (``True`` for a number, 2.0 for an integer) is refused, with the
    sentence that JSON would be refused with. To be called first in ``__post_init__``.

    Raises:
        InputError: a member is not what its annotation says.
    """
    kind: Any = type(value)
    names, adapter, arrays = _members(kind)
    given = tuple([getattr(value, name) for name in names])
    try:
        settled = _settled(adapter, given)
    except ValidationError as error:
        place, message = _first_fault(error)
        raise InputError(None, field_name((names[int(place[0])], *place[1:])), message) from error
    for name, before, content in zip(names, given, settled, strict=True):
        if content is not before:
            object.__setattr__(value, name, content)
    for name, array, optional in arrays:
        content = getattr(value, name)
        if content is not None or not optional:
            object.__setattr__(value, name, array.of(content, name))


def _settled(adapter: TypeAdapter[T], given: Any) -> T:
    """The content as they are if they can be, which they can wherever they came from JSON."""
    try:
        return adapter.validate_python(given)
    except ValidationError:
        return adapter.validate_python(plain(given))


def validate_python(adapter: TypeAdapter[T], content: Any, member: str) -> T:
    """Hold the content of a member against a schema; the first fault becomes the error."""
    try:
        return _settled(adapter, content)
    except ValidationError as error:
        place, message = _first_fault(error)
        raise InputError(None, field_name((member, *place)), message) from error


def _first_fault(error: ValidationError) -> tuple[tuple[int | str, ...], str]:
    place, message = first_fault(error)
    # Lists and arrays are taken as well, and JSON's sentence is the one that says so.
    return place, re.sub("valid (tuple|list)$", "valid array", message)


def plain(content: Any) -> Any:
    """Lists and arrays as tuples, numbers of numpy as Python's; all else as it is."""
    if isinstance(content, np.ndarray):
        content = content.tolist()
    if isinstance(content, np.generic):
        return content.item()
    if isinstance(content, (list, tuple)):
        return tuple([part if type(part) is int else plain(part) for part in content])
    return content


def json_content(content: Any, member: str) -> Any:
    """Free content as it comes back from JSON.

    Raises:
        InputError: JSON has no text for it.
    """
    try:
        return json.loads(json.dumps(content, allow_nan=False))
    except (TypeError, ValueError, RecursionError) as error:
        raise InputError(None, member, f"cannot be written as JSON: {error}") from error


@cache
def _members(
    kind: Any,
) -> tuple[list[str], TypeAdapter[tuple[Any, ...]], list[tuple[str, LeftToNumpy, bool]]]:
    """The names of a dataclass's members, the schema of their values as one tuple; and the names
    of those that are arrays, with what makes them and whether they may be None."""
    hints = get_type_hints(kind, include_extras=True)
    names, arrays = [], []
    for member in fields(kind):
        hint = hints[member.name]
        optional = NoneType in get_args(hint)
        own = get_args(hint)[0] if optional else hint
        marks = [mark for mark in getattr(own, "__metadata__", ()) if isinstance(mark, LeftToNumpy)]
        if marks:
            arrays.append((member.name, marks[0], optional))
        else:
            names.append(member.name)
    types = tuple(_without_alias(hints[name]) for name in names)
    return names, TypeAdapter(tuple[types], config=_STRICT), arrays  # type: ignore[valid-type]


def _without_alias(hint: Any) -> Any:
    """The annotation of a member without its name in a file."""
    metadata = getattr(hint, "__metadata__", ())
    if any(isinstance(part, FieldInfo) for part in metadata):
        return hint.__origin__
    return hint
