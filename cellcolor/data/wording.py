"""Numbers and lists as a person would say them."""

from __future__ import annotations

from collections.abc import Iterable

__all__ = ["count", "listed", "span"]


def count(number: int, thing: str, things: str | None = None) -> str:
    """``1 segment``, ``2 segments``; the plural has an s unless another one is given."""
    return f"{number} {thing if number == 1 else things or thing + 's'}"


def listed(things: Iterable[object]) -> str:
    """``3``, ``3 and 4``, ``3, 4 and 7``; ``none`` if there is none."""
    *first, last = list(map(str, things)) or ["none"]
    return f"{', '.join(first)} and {last}" if first else last


def span(least: int, most: int | None) -> str:
    """``3``, ``3 to 5``; ``3 or more`` if there is no most."""
    if most is None:
        return f"{least} or more"
    return str(least) if least == most else f"{least} to {most}"
