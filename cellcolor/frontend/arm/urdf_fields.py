"""Numbers and places in a URDF's elements, read strictly: every fault names file and field."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from pathlib import Path

from cellcolor.errors import InputError


def named(file: Path, xml: ET.Element, tag: str) -> dict[str, ET.Element]:
    """The elements with a tag by their names, each of which stands once.

    Raises:
        InputError: one has no name, or two have the same.
    """
    found: dict[str, ET.Element] = {}
    for element in xml.findall(tag):
        name = element.get("name")
        if not name or name in found:
            fault = "stands twice" if name else "has no name"
            raise InputError(str(file), f"{tag}[{name or len(found)}]", fault)
        found[name] = element
    return found


def number(file: Path, field: str, element: ET.Element | None, attribute: str) -> float:
    """A finite number that has to be there.

    Raises:
        InputError: it is missing, or no such number.
    """
    text = None if element is None else element.get(attribute)
    if text is None:
        raise InputError(str(file), field, f"{attribute!r} is missing")
    return finite(file, f"{field}.{attribute}", text)


def finite(file: Path, field: str, text: str) -> float:
    """A finite number.

    Raises:
        InputError: it is none.
    """
    try:
        value = float(text)
    except ValueError as error:
        raise InputError(str(file), field, f"{text!r} is not a number") from error
    if not math.isfinite(value):
        raise InputError(str(file), field, f"{text!r} is not finite")
    return value


def triple(file: Path, field: str, text: str) -> list[float]:
    """Three finite numbers.

    Raises:
        InputError: it is not.
    """
    values = [finite(file, field, part) for part in text.split()]
    if len(values) != 3:
        raise InputError(str(file), field, f"needs three numbers, has {len(values)}")
    return values


def check_origin(file: Path, field: str, element: ET.Element) -> None:
    """Hold an element's ``<origin>``, if there is one, to three numbers each.

    Raises:
        InputError: it has others.
    """
    origin = element.find("origin")
    if origin is not None:
        for attribute in ("xyz", "rpy"):
            triple(file, f"{field}.origin.{attribute}", origin.get(attribute, "0 0 0"))
