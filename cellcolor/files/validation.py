"""Values made in Python: checked for the same types as values read from JSON."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import fields
from functools import cache
from typing import Annotated, Any, TypeVar, get_type_hints

import numpy as np
from pydantic import AfterValidator, ConfigDict, TypeAdapter, ValidationError
from pydantic.fields import FieldInfo

from cellcolor.errors import InputError
from cellcolor.files.documents import field_name, first_fault

T = TypeVar("T")

_STRICT = ConfigDict(strict=True, allow_inf_nan=False)


def settle(value: object) -> None:
    """Hold a dataclass's members to their annotations, and normalise what Python knows more of.

    Lists and arrays become tuples, numbers of numpy Python's own; anything else that JSON would
    not take for the member (``True`` for a number, 2.0 for an integer) is refused, with the
    sentence that JSON would be refused with. To be called first in ``__post_init__``.

    Raises:
        InputError: a member is not what its annotation says.
    """
    kind: Any = type(value)
    names, adapter = _members(kind)
    given = tuple([getattr(value, name) for name in names])
    settled: tuple[Any, ...] = validated(adapter, given, names)
    for name, before, content in zip(names, given, settled, strict=True):
        if content is not before:
            object.__setattr__(value, name, content)


def validated(adapter: TypeAdapter[T], given: tuple[Any, ...], names: Sequence[str]) -> T:
    """Hold the content of members against a schema of all of them; the first fault becomes the
    error.

    Content is left as it is if it can be, which it can wherever it came from JSON.
    """
    try:
        return adapter.validate_python(given)
    except ValidationError as error:
        # A ValueError of ours is about content that is of the right kind.
        faults = error.errors(include_url=False, include_context=False, include_input=False)
        other = {fault["loc"][0] for fault in faults if fault["type"] != "value_error"}
    try:
        return adapter.validate_python(
            tuple([plain(own) if k in other else own for k, own in enumerate(given)])
        )
    except ValidationError as error:
        (number, *place), message = first_fault(error)
        # Lists and arrays are taken as well, and JSON's sentence is the one that says so.
        message = re.sub("valid (tuple|list)$", "valid array", message)
        raise InputError(None, field_name((names[int(number)], *place)), message) from error


def plain(content: Any) -> Any:
    """Lists and arrays as tuples, numbers of numpy as Python's; all else as it is."""
    if isinstance(content, np.ndarray):
        content = content.tolist()
    if isinstance(content, np.generic):
        return content.item()
    if isinstance(content, (list, tuple)):
        return tuple([part if type(part) is int else plain(part) for part in content])
    return content


def _through_json(content: Any) -> Any:
    try:
        return json.loads(json.dumps(content, allow_nan=False))
    except (TypeError, ValueError, RecursionError) as error:
        raise ValueError(f"cannot be written as JSON: {error}") from error


FreeContent = Annotated[dict[str, Any], AfterValidator(_through_json)]
"""Whatever JSON has a text for, as it comes back from there."""

Ascending = Annotated[tuple[int, ...], AfterValidator(lambda own: tuple(sorted(own)))]
"""Integers whose order means nothing."""


@cache
def _members(kind: Any) -> tuple[list[str], TypeAdapter[tuple[Any, ...]]]:
    """The names of a dataclass's members, and the schema of their values as one tuple."""
    hints = get_type_hints(kind, include_extras=True)
    names = [member.name for member in fields(kind)]
    types = tuple(_without_alias(hints[name]) for name in names)
    return names, TypeAdapter(tuple[types], config=_STRICT)  # type: ignore[valid-type]


def _without_alias(hint: Any) -> Any:
    """The annotation of a member without its name in a file."""
    metadata = getattr(hint, "__metadata__", ())
    if any(isinstance(part, FieldInfo) for part in metadata):
        return hint.__origin__
    return hint
