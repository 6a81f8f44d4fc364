"""JSON files as text and back, strict, with the field named in every error; fingerprints."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Collection, Sequence
from os import PathLike
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError
from pydantic_core import ErrorDetails

from cellcolor.errors import InputError, naming
from cellcolor.files.writing import path_of

T = TypeVar("T")


def _no_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    document = dict(pairs)
    if len(document) != len(pairs):
        names = [name for name, _ in pairs]
        repeated = next(name for name in names if names.count(name) > 1)
        raise InputError(None, repeated, "member appears twice in one object")
    return document


def _no_constant(text: str) -> Any:
    raise InputError(None, None, f"{text} is not a JSON number")


def parse_json(text: str) -> dict[str, Any]:
    """Parse one JSON object; refuses NaN, infinities and repeated members.

    Raises:
        InputError: not JSON, or not an object.
    """
    try:
        document = json.loads(text, object_pairs_hook=_no_repeats, parse_constant=_no_constant)
    except json.JSONDecodeError as error:
        raise InputError(
            None, None, f"not JSON: {error.msg} at line {error.lineno} column {error.colno}"
        ) from error
    except RecursionError as error:
        raise InputError(None, None, "not usable JSON: nested too deeply") from error
    except ValueError as error:
        # Python converts no integers with thousands of digits; it takes too long.
        raise InputError(None, None, "not usable JSON: a number with too many digits") from error
    if not isinstance(document, dict):
        raise InputError(None, None, "must be a JSON object")
    return document


def is_json(line: str) -> bool:
    """Whether a line is a JSON text of its own."""
    try:
        json.loads(line)
    except (ValueError, RecursionError):  # too many digits are no JSONDecodeError
        return False
    return True


def read_text(path: str | PathLike[str]) -> str:
    """A file's text.

    Raises:
        InputError: the file is missing, unreadable or not UTF-8.
    """
    try:
        return path_of(path).read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise InputError(str(path), None, "not UTF-8 text") from error
    except OSError as error:
        raise InputError(str(path), None, error.strerror or "cannot be read") from error
    except ValueError as error:  # a name with a zero character
        raise InputError(str(path), None, "is not a file name") from error


def read_document(path: str | PathLike[str]) -> dict[str, Any]:
    """The JSON object in a file.

    Raises:
        InputError: the file is missing, unreadable, not UTF-8 or not a JSON object.
    """
    text = read_text(path)
    with naming(path):
        return parse_json(text)


def take_body(
    document: dict[str, Any], expected: str, added: Sequence[Sequence[str]] = ()
) -> dict[str, Any]:
    """The document without ``format`` and ``version``, both of which must be the expected ones.

    Args:
        added: the members that version 2 added, those that version 3 added, and so on; those of
            members as ``member.name``.
    """
    body = dict(document)
    found = body.pop("format", None)
    if found != expected:
        raise InputError(None, "format", f"must be {expected!r}, is {found!r}")
    version = body.pop("version", None)
    newest = 1 + len(added)
    if type(version) is not int or not 1 <= version <= newest:
        known = "1" if newest == 1 else f"1 to {newest}" if newest > 2 else "1 or 2"
        raise InputError(None, "version", f"must be {known}, is {version!r}")
    for later, names in enumerate(added[version - 1 :], start=version + 1):
        for name in names:
            *outer, last = name.split(".")
            holder: Any = body
            for part in outer:
                holder = holder.get(part) if isinstance(holder, dict) else None
            if isinstance(holder, dict) and last in holder:
                message = f"is a member of version {later}, but the file says version {version}"
                raise InputError(None, name, message)
    return body


def validate(adapter: TypeAdapter[T], body: dict[str, Any]) -> T:
    """Hold a parsed JSON object against a schema; the first fault becomes the error."""
    try:
        # Through JSON again, since strict validation takes lists for tuples only there.
        return adapter.validate_json(json.dumps(body))
    except RecursionError as error:
        raise InputError(None, None, "not usable JSON: nested too deeply") from error
    except ValidationError as error:
        place, message = first_fault(error)
        raise InputError(None, field_name(place), message) from error


def first_fault(error: ValidationError) -> tuple[tuple[int | str, ...], str]:
    """Where a schema is broken first, and how.

    A name that is not known goes before one that is missing: of a misspelt name it is the cause.
    """
    faults = error.errors(include_url=False)
    unknown = (fault for fault in faults if fault["type"] in _UNKNOWN)
    first = next(unknown, faults[0])
    place = first["loc"]
    if first["type"] not in _UNKNOWN:
        # What pydantic calls the kind that it tried, of several that a member may have, is no key.
        place = tuple(part for part in place if isinstance(part, int) or "[" not in part)
    if first["type"] == "missing":
        return place, "is missing"
    if first["type"] not in _UNKNOWN:
        return place, _shown(first)
    from difflib import get_close_matches

    missing = [
        str(fault["loc"][-1])
        for fault in faults
        if fault["type"] == "missing" and fault["loc"][:-1] == place[:-1]
    ]
    close = get_close_matches(str(place[-1]), missing, n=1)
    return place, f"unknown key; is {close[0]!r} meant?" if close else "unknown key"


def _shown(fault: ErrorDetails) -> str:
    """What is wrong with a value, and the value if it is short."""
    message = fault["msg"].removeprefix("Value error, ")  # pydantic's for a ValueError
    given = fault["input"]
    simple = given is None or isinstance(given, (bool, int, float, str))
    if fault["type"] in _OF_ONE_VALUE and simple and len(repr(given)) <= MOST_SHOWN:
        return f"{message}, is {json.dumps(given, ensure_ascii=False)}"
    return message


MOST_SHOWN = 60
"""Characters of a value in a message."""

_OF_ONE_VALUE = ("int_type", "int_from_float", "float_type", "string_type", "literal_error")
_UNKNOWN = ("extra_forbidden", "unexpected_keyword_argument")


def field_name(location: tuple[int | str, ...]) -> str:
    """``("cells", 3, "loops", 0)`` as ``cells[3].loops[0]``."""
    text = ""
    for part in location:
        if isinstance(part, int):
            text += f"[{part}]"
        elif part.replace("_", "").isalnum():
            text += f".{part}" if text else part
    return text


def dump_lines(document: dict[str, Any], one_per_line: Collection[str]) -> str:
    """JSON text with a member a line, and the elements of some members a line each.

    That keeps instances and solutions readable and their differences small.
    """
    members = []
    for name, value in document.items():
        if name in one_per_line and value:
            items = ",\n  ".join(_dump(item) for item in value)
            members.append(f"{_dump(name)}: [\n  {items}\n ]")
        else:
            members.append(f"{_dump(name)}: {_dump(value)}")
    return "{" + ",\n ".join(members) + "}\n"


def _dump(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False)


def sha256_of(content: Any) -> str:
    """The fingerprint of JSON content of lists, objects, integers and text.

    The text is ASCII, without spaces, members in alphabetical order. Numbers that are no integers
    have no canonical text and must not be in it.
    """
    text = json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode("ascii")).hexdigest()
