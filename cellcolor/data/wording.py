"""Numbers and lists as a person would say them, and how large shares and prices may be."""

from __future__ import annotations

import math
from collections.abc import Iterable

from cellcolor.errors import InputError


def count(number: int, thing: str, things: str | None = None) -> str:
    """``1 segment``, ``2 segments``; the plural has an s unless another one is given."""
    return f"{number} {thing if number == 1 else things or thing + 's'}"


def lift_offs_of(segments: int) -> int:
    """One between each two segments; where nothing is covered there is none either."""
    return max(0, segments - 1)


def segments_and_lift_offs(segments: int) -> str:
    """``2 segments, 1 lift-off``."""
    return f"{count(segments, 'segment')}, {count(lift_offs_of(segments), 'lift-off')}"


def listed(things: Iterable[object]) -> str:
    """``3``, ``3 and 4``, ``3, 4 and 7``; ``none`` if there is none."""
    *first, last = list(map(str, things)) or ["none"]
    return f"{', '.join(first)} and {last}" if first else last


def span(least: int, most: int | None) -> str:
    """``3``, ``3 to 5``; ``3 or more`` if there is no most."""
    if most is None:
        return f"{least} or more"
    return str(least) if least == most else f"{least} to {most}"


def in_meters(lengths: Iterable[float]) -> str:
    """``0.4 x 0.4 x 0.12 m``: lengths in three digits."""
    return f"{' x '.join(f'{length:.3g}' for length in lengths)} m"


def looks_like_millimeters(*lengths: float) -> str:
    """``15 looks like millimeters: 0.015 m?``, of one number given in meters or of several."""
    given = ", ".join(f"{length:g}" for length in lengths)
    meant = ", ".join(f"{length / 1000:g}" for length in lengths)
    return f"{given} look{'' if len(lengths) > 1 else 's'} like millimeters: {meant} m?"


def looks_like_degrees(angle: float) -> str:
    """``180 looks like degrees: 3.1416 rad?``, of a number given in radians."""
    return f"{angle:g} looks like degrees: {math.radians(angle):.5g} rad?"


def beyond_turns(angle: float, turns: int) -> bool:
    """Whether an angle in rad is more than so many full circles: then it must be degrees."""
    return abs(angle) > 2 * math.pi * turns + 0.01  # 6.2832 is a full circle as well


MOST_PRICE = 1_000_000
"""Of a change-over, in lift-offs. Prices are added in floating point, which has 53 bits: up to this
limit a sum is right to far less than a thousandth of a lift-off."""

_BINARY = 1e-6
"""How far 1000 times a price with three decimals may be from a whole number, in floating point."""


def check_share(name: str, share: float | None) -> None:
    """Refuse a share that is not from 0 to 1; None is none.

    Raises:
        InputError: it is not.
    """
    if share is not None and not 0 <= share <= 1:
        raise InputError(None, name, f"must be from 0 to 1, is {share:g}")


def check_change_over(price: float) -> None:
    """Refuse what a change-over cannot cost: less than the lift-off that it takes, for example.

    Raises:
        InputError: it is out of its range, or finer than a thousandth of a lift-off.
    """
    if not 1 <= price <= MOST_PRICE:
        message = f"must be a number from 1 to {MOST_PRICE}, is {price:g}"
        raise InputError(None, "change_over", message)
    if abs(1000 * price - round(1000 * price)) > _BINARY:
        message = f"must have no more than three decimals, is {price}"
        raise InputError(None, "change_over", message)
